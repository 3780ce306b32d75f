"""Tests of the ROS support: the URDF's joints, the choice of gait for a velocity, and the node with a fake rclpy."""

import math
import sys
import time
import types
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

import lizard
from lizard.ros import JOINTS, TIMEOUT, TURN_LEVER_ARM, Driver, joint_values

ROS_PACKAGE_DIR = Path(__file__).parents[1] / "ros"
ROBOTS_DIR = Path(__file__).parents[3] / "robots"


@pytest.mark.parametrize("robot", ["paper", "unequal", "large"])
def test_joint_values_close_every_loop_of_the_urdf(robot, run_lizard, tmp_path):
    robot_path, urdf_path = ROBOTS_DIR / f"{robot}.toml", tmp_path / "robot.urdf"
    assert run_lizard("model", urdf_path, "--robot", robot_path).returncode == 0
    model = lizard.Model.from_toml(robot_path)
    # MuJoCo also reads URDF. With these options, it keeps every frame and ignores the meshes.
    mujoco_options = (
        '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco></robot>'
    )
    urdf = urdf_path.read_text().replace("</robot>", mujoco_options)
    mujoco_model = mujoco.MjModel.from_xml_string(urdf)
    data = mujoco.MjData(mujoco_model)
    mimic_joints = [
        (joint.get("name"), joint.find("mimic").attrib)
        for joint in ElementTree.fromstring(urdf).iterfind("joint[mimic]")
    ]
    assert len(mimic_joints) == 16
    body_names = [
        mujoco_model.body(number).name for number in range(mujoco_model.nbody)
    ]
    closing_frame_pairs = [
        (name, f"{name[:-1]}2")
        for name in body_names
        if name.startswith("closing_") and name.endswith("_1")
    ]
    assert len(closing_frame_pairs) >= 4
    poses = model.neutral + np.random.default_rng(1).uniform(-35, 35, (400, 4))
    poses = poses[model.solve(poses).safe][:12]
    assert len(poses) == 12
    for values in joint_values(model, [model.neutral, *poses]):
        for name, value in zip(JOINTS, values, strict=True):
            data.joint(name).qpos = value
        for name, mimic in mimic_joints:
            data.joint(name).qpos = (
                float(mimic["multiplier"]) * data.joint(mimic["joint"]).qpos
            )
        mujoco.mj_kinematics(mujoco_model, data)
        for a, b in closing_frame_pairs:
            assert np.abs(data.body(a).xpos - data.body(b).xpos).max() < 1e-7, (a, b)
    assert np.abs(joint_values(model, model.neutral)).max() == 0


def test_the_chosen_gait_and_pace_are_closest_to_the_velocity(robot, model):
    driver = Driver(robot, model)
    nominal_velocities = {
        velocity.gait: (velocity.forward, TURN_LEVER_ARM * velocity.turn)
        for velocity in driver.velocities
    }
    walk = model.gait("walk")
    assert nominal_velocities["walk"][0] == pytest.approx(
        walk.predict(with_servos=True).forward / 1000 / walk.period
    )
    # In `look`, two feet pull against the other two, so its direction is undetermined.
    assert "look" not in nominal_velocities
    rng = np.random.default_rng(2)
    for forward, turn in rng.uniform(-1, 1, (200, 2)) * (0.06, 0.5):
        target = (forward, TURN_LEVER_ARM * turn)
        min_distance = min(
            math.dist(target, (pace / 100 * x, pace / 100 * y))
            for x, y in nominal_velocities.values()
            for pace in (0, *range(10, 101))
        )
        chosen = driver.choose_gait(forward, turn)
        x, y = nominal_velocities[chosen[0]] if chosen else (0, 0)
        pace = chosen[1] / 100 if chosen else 0
        assert math.dist(target, (pace * x, pace * y)) < min_distance + 1e-4
    assert driver.choose_gait(0, 0) is None
    assert driver.choose_gait(1, 0)[1] == 100
    assert driver.choose_gait(0, 0.3)[0] == "left"
    assert driver.choose_gait(-1, 0)[0] == "back"


def test_the_robot_walks_while_velocities_arrive(robot, model):
    driver = Driver(robot, model)
    for _ in range(15):
        driver.drive(0.03, 0)
        driver.stop_if_silent()
        time.sleep(0.1)
    status = robot.status()
    assert status.gait == driver.choose_gait(0.03, 0)[0]
    assert status.speed == driver.choose_gait(0.03, 0)[1]
    driver.drive(0, 0.3)
    assert robot.status().gait == "left"
    driver.stop_if_silent()
    assert robot.is_going
    time.sleep(TIMEOUT + 0.05)
    driver.stop_if_silent()
    assert (robot.status().gait, robot.is_going) == ("stop", False)
    driver.drive(0.01, 0)
    assert robot.status().speed < 100
    driver.drive(0, 0)
    status = robot.status()
    assert (status.gait, status.speed) == ("stop", 100)


def test_after_a_reset_the_driver_raises_the_reason_once_and_walks_again(robot, model):
    driver = Driver(robot, model)
    driver.drive(0.03, 0)
    robot._port.board.reset()
    for _ in range(100):
        if not robot.is_going:
            break
        time.sleep(0.05)
    with pytest.raises(lizard.RobotError, match="reset"):
        driver.drive(0.03, 0)
    driver.drive(0.03, 0)
    assert robot.is_going


def test_the_node_publishes_joints_and_follows_velocity_commands(monkeypatch):
    """Uses a fake `rclpy`, since `rclpy` is not on PyPI."""
    published, published_while_walking, logged, callbacks = [], [], [], {}

    class Message(types.SimpleNamespace):
        def __getattr__(self, name):
            self.__dict__[name] = Message()
            return self.__dict__[name]

    class Node:
        def __init__(self, name): ...
        def declare_parameter(self, name, value):
            return types.SimpleNamespace(value=value)

        def create_publisher(self, msg_type, topic, depth):
            return types.SimpleNamespace(
                publish=lambda state: published.append((topic, state))
            )

        def create_subscription(self, msg_type, topic, callback, depth):
            callbacks[topic] = callback

        def create_timer(self, period, callback):
            callbacks["timer"] = callback

        def get_clock(self):
            return Message(now=lambda: Message(to_msg=lambda: "now"))

        def get_logger(self):
            def log(text, **_):
                logged.append(text)

            return types.SimpleNamespace(error=log, fatal=log)

    def spin(node):
        def send_velocity():
            callbacks["cmd_vel"](
                Message(linear=Message(x=0.03), angular=Message(z=0.0))
            )

        for _ in range(10):
            send_velocity()
            callbacks["timer"]()
            time.sleep(0.1)
        assert node.robot.is_going
        # After a reset of the board, the node publishes the joints again and logs the reset once.
        node.robot._port.board.reset()
        published_while_walking.extend(published)
        published.clear()
        deadline = time.monotonic() + 20
        while len(published) < 20 and time.monotonic() < deadline:
            time.sleep(0.1)
        assert len(published) >= 20
        send_velocity()
        send_velocity()
        assert node.robot.is_going
        node.robot._send = lambda *_: (_ for _ in ()).throw(
            lizard.RobotError("refused")
        )
        callbacks["cmd_vel"](Message(linear=Message(x=-0.03), angular=Message(z=0.0)))
        raise KeyboardInterrupt

    is_running = [True]

    def shutdown():
        is_running[0] = False

    rclpy = types.ModuleType("rclpy")
    rclpy.init, rclpy.ok, rclpy.spin = lambda: None, lambda: is_running[0], spin
    rclpy.try_shutdown = shutdown
    for module_name, attributes in [
        ("rclpy.node", {"Node": Node}),
        ("geometry_msgs.msg", {"Twist": Message}),
        ("sensor_msgs.msg", {"JointState": Message}),
    ]:
        module = types.ModuleType(module_name)
        module.__dict__.update(attributes)
        monkeypatch.setitem(sys.modules, module_name, module)
    for package in ("geometry_msgs", "sensor_msgs"):
        monkeypatch.setitem(sys.modules, package, types.ModuleType(package))
    monkeypatch.setitem(sys.modules, "rclpy", rclpy)
    monkeypatch.syspath_prepend(ROS_PACKAGE_DIR)
    from lizard_ros.node import main

    main()
    # The errors are from `watch`, from `cmd_vel`, from the refused pace, and from the refused stop at shutdown.
    assert logged == [
        "the robot no longer sends its poses",
        "the robot was reset",
        "refused",
        "refused",
    ]
    assert not is_running[0]
    assert len(published_while_walking) > 20
    topic, state = published_while_walking[-1]
    assert (topic, state.name, state.header.stamp) == (
        "joint_states",
        list(JOINTS),
        "now",
    )
    assert len(state.position) == len(JOINTS)
    cranks = np.array([state.position[:4] for _, state in published_while_walking])
    assert np.ptp(cranks) > 0.2


def test_the_ros_package_has_the_same_version_as_the_wheel():
    package, setup = (
        (ROS_PACKAGE_DIR / name).read_text() for name in ("package.xml", "setup.py")
    )
    assert f"<version>{lizard.__version__}<" in package
    assert f'version="{lizard.__version__}"' in setup
