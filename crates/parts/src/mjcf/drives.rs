//! What closes the loops, and the motors that follow pulses.

use lizard_robot::FRAMES_PER_SECOND;
use lizard_robot::servo::NAMES;

use super::closed;
use super::node::Node;
use super::text::{MILLI, metres, round};
use super::writer::Writer;
use crate::layers::body::Mount;

/// At this error a servo turns with all that it has, deg.
const FULL: f64 = 3.0;

impl Writer<'_> {
    pub(super) fn loops(&mut self) {
        self.open("equality", &[]);
        for closed in closed::all(self.assembly, self.scene.pull.is_some()) {
            let [first, second] = closed.bodies.map(Node::name);
            self.element(
                "connect",
                &[
                    ("name", closed.name),
                    ("body1", first),
                    ("body2", second),
                    ("anchor", metres([closed.at.x, closed.at.y, 0.0])),
                ],
            );
        }
        self.xml.end_element();
    }

    pub(super) fn actuators(&mut self) {
        self.open("actuator", &[]);
        let stall = self.scene.motor.stall * MILLI;
        for (servo, name) in NAMES.iter().enumerate() {
            let joint = match self.plays() {
                true => Node::Horn(servo),
                false => Node::Of(Mount::Link(servo)),
            };
            let (least, most) = self.assembly.robot().servos()[servo].travel();
            let [least, most] = [least, most].map(|angle| round(angle.to_radians()));
            self.element(
                "position",
                &[
                    ("name", (*name).to_owned()),
                    ("joint", joint.name()),
                    ("kp", round(stall / FULL.to_radians()).to_string()),
                    ("forcerange", format!("{} {}", round(-stall), round(stall))),
                    ("ctrlrange", format!("{least} {most}")),
                ],
            );
        }
        self.xml.end_element();
    }

    /// A keyframe for each frame of 20 ms: its time, and the angles for the servos.
    pub(super) fn course(&mut self) {
        let Some(course) = &self.scene.course else {
            return;
        };
        self.open("keyframe", &[]);
        for (frame, targets) in course.frames.iter().enumerate() {
            let time = round(frame as f64 / FRAMES_PER_SECOND);
            let targets = targets.map(|angle| round(angle.to_radians()).to_string());
            self.element(
                "key",
                &[
                    ("name", format!("{} {time:.2}", course.gait)),
                    ("time", time.to_string()),
                    ("ctrl", targets.join(" ")),
                ],
            );
        }
        self.xml.end_element();
    }
}
