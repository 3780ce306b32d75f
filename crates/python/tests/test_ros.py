"""Tests of the ROS support: the joints in the URDF, the gaits for velocities, and the node with a stand-in for ROS."""

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

NODE = Path(__file__).parents[1] / "ros"
ROBOTS = Path(__file__).parents[3] / "robots"


@pytest.mark.parametrize("robot", ["paper", "unequal", "large"])
def test_joint_values_close_every_loop_of_the_urdf(robot, program, tmp_path):
    file = ROBOTS / f"{robot}.toml"
    assert program("model", tmp_path / "a.urdf", "--robot", file).returncode == 0
    model = lizard.Model.from_toml(file)
    # MuJoCo reads URDF, too. These options make it keep every frame and ignore the meshes.
    mujoco_options = (
        '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco></robot>'
    )
    urdf = (tmp_path / "a.urdf").read_text().replace("</robot>", mujoco_options)
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
    pairs = [
        (name, f"{name[:-1]}2")
        for name in body_names
        if name.startswith("closing_") and name.endswith("_1")
    ]
    assert len(pairs) >= 4
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
        for a, b in pairs:
            assert np.abs(data.body(a).xpos - data.body(b).xpos).max() < 1e-7, (a, b)
    assert np.abs(joint_values(model, model.neutral)).max() == 0


@pytest.fixture
def robot():
    with lizard.Robot.simulated() as robot:
        yield robot


def test_the_chosen_gait_and_pace_come_nearest_to_the_velocity(robot, model):
    driver = Driver(robot, model)
    full_speeds = {
        speed.gait: (speed.forward, TURN_LEVER_ARM * speed.turn)
        for speed in driver.speeds
    }
    walk = model.gait("walk")
    assert full_speeds["walk"][0] == pytest.approx(
        walk.predict(with_servos=True).forward / 1000 / walk.period
    )
    # In `look`, two feet pull against the other two, so its direction is undecided.
    assert "look" not in full_speeds
    for forward, turn in np.random.default_rng(2).uniform(-1, 1, (200, 2)) * (
        0.06,
        0.5,
    ):
        target = (forward, TURN_LEVER_ARM * turn)
        min_distance = min(
            math.dist(target, (pace / 100 * x, pace / 100 * y))
            for x, y in full_speeds.values()
            for pace in (0, *range(10, 101))
        )
        chosen = driver.choose(forward, turn)
        x, y = full_speeds[chosen[0]] if chosen else (0, 0)
        pace = chosen[1] / 100 if chosen else 0
        assert math.dist(target, (pace * x, pace * y)) < min_distance + 1e-4
    assert driver.choose(0, 0) is None
    assert driver.choose(1, 0)[1] == 100
    assert driver.choose(0, 0.3)[0] == "left"
    assert driver.choose(-1, 0)[0] == "back"


def test_the_robot_walks_while_velocities_arrive(robot, model):
    driver = Driver(robot, model)
    for _ in range(15):
        driver.drive(0.03, 0)
        driver.stop_if_silent()
        time.sleep(0.1)
    status = robot.status()
    assert status.gait == driver.choose(0.03, 0)[0]
    assert status.speed == driver.choose(0.03, 0)[1]
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


def test_a_robot_that_stopped_by_itself_reports_the_reason_once_and_walks_again(
    robot, model
):
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


def test_the_node_publishes_joints_and_obeys_velocities(monkeypatch):
    """Uses a stand-in for `rclpy`, which no package index has."""
    published, published_while_walking, logged, callbacks = [], [], [], {}

    class Message(types.SimpleNamespace):
        def __getattr__(self, name):
            self.__dict__[name] = Message()
            return self.__dict__[name]

    class Node:
        def __init__(self, name): ...
        def declare_parameter(self, name, value):
            return types.SimpleNamespace(value=value)

        def create_publisher(self, kind, topic, depth):
            return types.SimpleNamespace(
                publish=lambda state: published.append((topic, state))
            )

        def create_subscription(self, kind, topic, callback, depth):
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
        # After a reset of the board, the node follows its poses again and reports the reset once.
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
        node.robot.ask = lambda line: (_ for _ in ()).throw(
            lizard.RobotError("refused")
        )
        callbacks["cmd_vel"](Message(linear=Message(x=-0.03), angular=Message(z=0.0)))
        raise KeyboardInterrupt

    is_running = [True]

    def shutdown():
        is_running[0] = False

    rclpy = types.ModuleType("rclpy")
    rclpy.init, rclpy.ok, rclpy.spin = lambda: None, lambda: is_running[0], spin
    rclpy.shutdown = rclpy.try_shutdown = shutdown
    for name, names in [
        ("rclpy.node", {"Node": Node}),
        ("geometry_msgs.msg", {"Twist": Message}),
        ("sensor_msgs.msg", {"JointState": Message}),
    ]:
        module = types.ModuleType(name)
        module.__dict__.update(names)
        monkeypatch.setitem(sys.modules, name, module)
    for name in ("geometry_msgs", "sensor_msgs"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    monkeypatch.setitem(sys.modules, "rclpy", rclpy)
    monkeypatch.syspath_prepend(NODE)
    from lizard_ros.node import main

    main()
    # `watch` reports the first error, `cmd_vel` the second; the gait is refused, and so is the pace at shutdown.
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
    assert f"<version>{lizard.__version__}<" in (NODE / "package.xml").read_text()
    assert f'version="{lizard.__version__}"' in (NODE / "setup.py").read_text()
