"""The ROS node: publishes a robot's `joint_states`, and drives it by `cmd_vel`. The logic is in `lizard.ros`."""

import threading
from contextlib import closing

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import JointState

from lizard import Model, Robot, RobotError
from lizard.ros import JOINTS, Driver, joint_values


class Lizard(Node):
    """A robot at a serial port (parameter `port`), or a simulated one; the parameter `robot` is its robot.toml."""

    def __init__(self) -> None:
        super().__init__("lizard")
        port = self.declare_parameter("port", "").value
        file = self.declare_parameter("robot", "").value
        self.every = self.declare_parameter("every", 2).value
        self.model = Model.from_toml(file) if file else Model.default()
        self.robot = Robot(port) if port else Robot.simulated(self.model)
        self.driver = Driver(self.robot, self.model)
        self.states = self.create_publisher(JointState, "joint_states", 10)
        self.create_subscription(Twist, "cmd_vel", self.drive, 1)
        self.create_timer(0.1, self.stop_if_silent)
        threading.Thread(target=self.publish, daemon=True).start()

    def publish(self) -> None:
        """Publishes the joints in every n-th frame (parameter `every`) until the port is gone, also after a reset."""
        while rclpy.ok():
            try:
                with closing(self.robot.watch(self.every)) as frames:
                    for frame in frames:
                        if not rclpy.ok():
                            return
                        state = JointState()
                        state.header.stamp = self.get_clock().now().to_msg()
                        state.name = list(JOINTS)
                        state.position = joint_values(self.model, frame.pose).tolist()
                        self.states.publish(state)
            except RobotError as error:
                if rclpy.ok():
                    self.get_logger().error(str(error))
            except OSError as error:
                self.get_logger().fatal(str(error))
                rclpy.try_shutdown()

    def drive(self, twist: Twist) -> None:
        """Drives at a velocity of `cmd_vel`."""
        self.attempt(self.driver.drive, twist.linear.x, twist.angular.z)

    def stop_if_silent(self) -> None:
        """Stops the robot when velocities no longer arrive."""
        self.attempt(self.driver.stop_if_silent)

    def attempt(self, action, *arguments) -> None:
        """Performs an action that the robot may refuse, and logs the refusal."""
        try:
            action(*arguments)
        except (RobotError, OSError) as error:
            self.get_logger().error(str(error), throttle_duration_sec=1.0)


def main() -> None:
    """Runs the node, and stops the robot at the end."""
    rclpy.init()
    node = Lizard()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
        node.attempt(node.driver.stop)
        node.robot.close()
