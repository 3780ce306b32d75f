"""The ROS node: publishes a robot's `joint_states`, and drives the robot from `cmd_vel`. `lizard.ros` has the logic."""

import threading
from contextlib import closing

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import JointState

from lizard import Model, Robot, RobotError
from lizard.ros import JOINTS, Driver, joint_values


class LizardNode(Node):
    """A robot on a serial port (parameter `port`), or a simulated robot; the parameter `robot` is its robot.toml."""

    def __init__(self) -> None:
        super().__init__("lizard")
        port = self.declare_parameter("port", "").value
        robot_path = self.declare_parameter("robot", "").value
        self.frame_interval = self.declare_parameter("every", 2).value
        self.model = Model.from_toml(robot_path) if robot_path else Model.default()
        self.robot = Robot(port) if port else Robot.simulated(self.model)
        self.driver = Driver(self.robot, self.model)
        self.joint_publisher = self.create_publisher(JointState, "joint_states", 10)
        self.create_subscription(Twist, "cmd_vel", self.drive, 1)
        self.create_timer(0.1, self.stop_if_silent)
        threading.Thread(target=self.publish_joints, daemon=True).start()

    def publish_joints(self) -> None:
        """Publishes the joints in every n-th frame (parameter `every`), also after a reset, until the port closes."""
        while rclpy.ok():
            try:
                with closing(self.robot.watch(self.frame_interval)) as frames:
                    for frame in frames:
                        if not rclpy.ok():
                            return
                        state = JointState()
                        state.header.stamp = self.get_clock().now().to_msg()
                        state.name = list(JOINTS)
                        state.position = joint_values(self.model, frame.pose).tolist()
                        self.joint_publisher.publish(state)
            except RobotError as error:
                if rclpy.ok():
                    self.get_logger().error(str(error))
            except OSError as error:
                self.get_logger().fatal(str(error))
                rclpy.try_shutdown()

    def drive(self, twist: Twist) -> None:
        """Drives at the velocity received on `cmd_vel`."""
        self.run_and_log_errors(self.driver.drive, twist.linear.x, twist.angular.z)

    def stop_if_silent(self) -> None:
        """Stops the robot if no velocity has arrived for a while."""
        self.run_and_log_errors(self.driver.stop_if_silent)

    def run_and_log_errors(self, action, *args) -> None:
        """Runs an action, and logs an error of the robot or its port."""
        try:
            action(*args)
        except (RobotError, OSError) as error:
            self.get_logger().error(str(error), throttle_duration_sec=1.0)


def main() -> None:
    """Runs the node, and stops the robot at the end."""
    rclpy.init()
    node = LizardNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
        node.run_and_log_errors(node.driver.stop)
        node.robot.close()
