"""A robot for ROS: its joints in the URDF, gaits for velocities, and the node with a stand-in for ROS."""

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
from lizard.ros import JOINTS, REACH, TIMEOUT, Driver, joint_values

NODE = Path(__file__).parents[1] / "ros"
ROBOTS = Path(__file__).parents[3] / "robots"


@pytest.mark.parametrize("robot", ["paper", "unequal", "large"])
def test_the_values_of_the_joints_close_every_loop_of_the_urdf(
    robot, program, tmp_path
):
    file = ROBOTS / f"{robot}.toml"
    assert program("model", tmp_path / "a.urdf", "--robot", file).returncode == 0
    model = lizard.Model.from_toml(file)
    # MuJoCo reads URDF, too; it is to keep every frame, and needs no meshes.
    extra = (
        '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco></robot>'
    )
    urdf = (tmp_path / "a.urdf").read_text().replace("</robot>", extra)
    read = mujoco.MjModel.from_xml_string(urdf)
    data = mujoco.MjData(read)
    follow = [
        (joint.get("name"), joint.find("mimic").attrib)
        for joint in ElementTree.fromstring(urdf).iterfind("joint[mimic]")
    ]
    assert len(follow) == 16
    ends = [read.body(number).name for number in range(read.nbody)]
    pairs = [
        (end, f"{end[:-1]}2")
        for end in ends
        if end.startswith("closing_") and end.endswith("_1")
    ]
    assert len(pairs) >= 4
    poses = model.neutral + np.random.default_rng(1).uniform(-35, 35, (400, 4))
    poses = poses[model.solve(poses).safe][:12]
    assert len(poses) == 12
    for values in joint_values(model, [model.neutral, *poses]):
        for name, value in zip(JOINTS, values, strict=True):
            data.joint(name).qpos = value
        for name, leader in follow:
            data.joint(name).qpos = (
                float(leader["multiplier"]) * data.joint(leader["joint"]).qpos
            )
        mujoco.mj_kinematics(read, data)
        for a, b in pairs:
            assert np.abs(data.body(a).xpos - data.body(b).xpos).max() < 1e-7, (a, b)
    assert np.abs(joint_values(model, model.neutral)).max() == 0


@pytest.fixture
def robot():
    with lizard.Robot.simulated() as robot:
        yield robot


def test_the_chosen_gait_and_pace_come_nearest_of_all(robot, model):
    driver = Driver(robot, model)
    full = {speed.gait: (speed.forward, REACH * speed.turn) for speed in driver.speeds}
    walk = model.gait("walk")
    assert full["walk"][0] == pytest.approx(
        walk.predict(with_servos=True).forward / 1000 / walk.period
    )
    assert "look" not in full  # two feet pull against two: nobody knows where it leads
    for forward, turn in np.random.default_rng(2).uniform(-1, 1, (200, 2)) * (
        0.06,
        0.5,
    ):
        wanted = (forward, REACH * turn)
        least = min(
            math.dist(wanted, (pace / 100 * x, pace / 100 * y))
            for x, y in full.values()
            for pace in (0, *range(10, 101))
        )
        chosen = driver.choose(forward, turn)
        x, y = full[chosen[0]] if chosen else (0, 0)
        pace = chosen[1] / 100 if chosen else 0
        assert math.dist(wanted, (pace * x, pace * y)) < least + 1e-4
    assert driver.choose(0, 0) is None
    assert driver.choose(1, 0)[1] == 100
    assert driver.choose(0, 0.3)[0] == "left"
    assert driver.choose(-1, 0)[0] == "back"


def test_the_robot_goes_as_long_as_velocities_come(robot, model):
    driver = Driver(robot, model)
    for _ in range(15):
        driver.drive(0.03, 0)
        driver.watch_over()
        time.sleep(0.1)
    status = robot.status()
    assert status.gait == driver.choose(0.03, 0)[0]
    assert status.speed == driver.choose(0.03, 0)[1]
    driver.drive(0, 0.3)
    assert robot.status().gait == "left"
    driver.watch_over()
    assert robot.is_going
    time.sleep(TIMEOUT + 0.05)
    driver.watch_over()
    assert (robot.status().gait, robot.is_going) == ("stop", False)
    driver.drive(0.01, 0)
    assert robot.status().speed < 100
    driver.drive(0, 0)
    status = robot.status()
    assert (status.gait, status.speed) == ("stop", 100)


def test_a_robot_that_stopped_by_itself_says_why_once_and_goes_on(robot, model):
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
    """With a stand-in for ROS, which no package index has."""
    published, walked, logged, callbacks = [], [], [], {}

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

        def create_subscription(self, kind, topic, act, depth):
            callbacks[topic] = act

        def create_timer(self, period, act):
            callbacks["timer"] = act

        def get_clock(self):
            return Message(now=lambda: Message(to_msg=lambda: "now"))

        def get_logger(self):
            def log(text, **_):
                logged.append(text)

            return types.SimpleNamespace(error=log, fatal=log)

    def spin(node):
        def walk():
            callbacks["cmd_vel"](
                Message(linear=Message(x=0.03), angular=Message(z=0.0))
            )

        for _ in range(10):
            walk()
            callbacks["timer"]()
            time.sleep(0.1)
        assert node.robot.is_going
        # A board that is reset is followed again, and says it once.
        node.robot._port.board.reset()
        walked.extend(published)
        published.clear()
        end = time.monotonic() + 20
        while len(published) < 20 and time.monotonic() < end:
            time.sleep(0.1)
        assert len(published) >= 20
        walk()
        walk()
        assert node.robot.is_going
        node.robot.ask = lambda line: (_ for _ in ()).throw(
            lizard.RobotError("refused")
        )
        callbacks["cmd_vel"](Message(linear=Message(x=-0.03), angular=Message(z=0.0)))
        raise KeyboardInterrupt

    up = [True]
    ros = types.ModuleType("rclpy")
    ros.init, ros.ok, ros.spin = lambda: None, lambda: up[0], spin
    ros.shutdown = ros.try_shutdown = lambda: up.clear() or up.append(False)
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
    monkeypatch.setitem(sys.modules, "rclpy", ros)
    monkeypatch.syspath_prepend(NODE)
    from lizard_ros.node import main

    main()
    # Once by the poses, once by the velocity; then by the gait, and by the pace at the end.
    assert logged == [
        "the robot no longer sends its poses",
        "the robot was reset",
        "refused",
        "refused",
    ]
    assert not up[0]
    assert len(walked) > 20
    topic, state = walked[-1]
    assert (topic, state.name, state.header.stamp) == (
        "joint_states",
        list(JOINTS),
        "now",
    )
    assert len(state.position) == len(JOINTS)
    cranks = np.array([state.position[:4] for _, state in walked])
    assert np.ptp(cranks) > 0.2


def test_the_package_for_ros_has_the_version_of_the_wheel():
    assert f"<version>{lizard.__version__}<" in (NODE / "package.xml").read_text()
    assert f'version="{lizard.__version__}"' in (NODE / "setup.py").read_text()
