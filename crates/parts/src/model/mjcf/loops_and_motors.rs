//! Constraints that close the loops, motors, and keyframes with the servos' target angles.

use lizard_robot::FRAMES_PER_SECOND;
use lizard_robot::servo::SERVO_NAMES;

use crate::layers::body::Mount;
use crate::model::node::Node;
use crate::model::text::{MILLI, format_metres, join_numbers, round};
use crate::model::writer::Writer;

impl Writer<'_> {
    pub(super) fn write_loops(&mut self) {
        self.xml.write("<equality>");
        for cut_joint in self.list_cut_joints() {
            let [first, second] = cut_joint.bodies.map(Node::name);
            let name = cut_joint.name;
            let anchor = format_metres([cut_joint.x, 0.0, 0.0]);
            self.xml.write(format_args!(
                r#"<connect name="{name}" body1="{first}" body2="{second}" anchor="{anchor}"/>"#
            ));
        }
        self.xml.write("</equality>");
    }

    pub(super) fn write_actuators(&mut self) {
        self.xml.write("<actuator>");
        for (servo, name) in SERVO_NAMES.iter().enumerate() {
            let motor = self.scene.motors.per_servo[servo];
            let stall_torque = motor.stall_torque * MILLI;
            let gain = round(stall_torque / motor.full_torque_error.to_radians());
            let stall_torque = round(stall_torque);
            let driven_node = match self.has_play() {
                true => Node::Horn(servo),
                false => Node::OnMount(Mount::Link(servo)),
            };
            let joint = driven_node.name();
            let (min, max) = self.assembly.robot().servos()[servo].travel();
            let range = join_numbers([min, max].map(|angle| round(angle.to_radians())));
            self.xml.write(format_args!(
                r#"<position name="{name}" joint="{joint}" kp="{gain}" forcerange="{} {stall_torque}" ctrlrange="{range}"/>"#,
                -stall_torque
            ));
        }
        self.xml.write("</actuator>");
    }

    /// Writes a keyframe for each frame of 20 ms, with time and servo targets, and one for the standing robot.
    pub(super) fn write_keyframes(&mut self) {
        self.xml.write("<keyframe>");
        if let Some(trajectory) = &self.scene.trajectory {
            for (frame, targets) in trajectory.frames.iter().enumerate() {
                let gait = &trajectory.gait_name;
                let time = round(frame as f64 / FRAMES_PER_SECOND);
                let targets = join_numbers(targets.map(|angle| round(angle.to_radians())));
                self.xml.write(format_args!(
                    r#"<key name="{gait} {time:.2}" time="{time}" ctrl="{targets}"/>"#
                ));
            }
        }
        self.xml.write(r#"<key name="home" ctrl="0 0 0 0"/>"#);
        self.xml.write("</keyframe>");
    }
}
