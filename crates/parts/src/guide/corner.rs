//! One corner of the robot, to be printed first: a servo's seat with the pivots of its leg, the servo's link, and the
//! leg with its strut and its foot.
//!
//! Printing the corner takes three hours instead of about seventeen for the whole robot, and shows whether the servo
//! fits its opening and the horn its link, whether the bearings turn without play, and how much a foot yields.

use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};

use crate::bodies::assembly::Assembly;
use crate::bodies::builder::AssemblyBuilder;
use crate::bodies::chassis;
use crate::guide::CORNER_SERVO;
use crate::layers::body::Mount;
use crate::part::Part;

impl Assembly {
    /// Collects the printed parts of the corner of `CORNER_SERVO`, each once.
    pub fn collect_corner_parts(&self) -> Vec<Part> {
        let (servo_name, leg_name) = (SERVO_NAMES[CORNER_SERVO], LEG_NAMES[CORNER_SERVO]);
        let prisms = chassis::make_corner_prisms(&AssemblyBuilder::new(self.robot()), CORNER_SERVO);
        let mut parts = vec![Part::single(&format!("seat {servo_name}"), prisms)];
        let is_in_corner = |body_name: &str| {
            self.body(body_name).is_some_and(|body| {
                let is_coupler = matches!(body.mount, Mount::Coupler(_));
                let suffixes = [servo_name, leg_name];
                let has_suffix = suffixes.iter().any(|suffix| body.name.ends_with(suffix));
                !is_coupler && has_suffix && body.kind.is_printed()
            })
        };
        for mut part in self.collect_parts() {
            part.body_names.retain(|body_name| is_in_corner(body_name));
            if !part.body_names.is_empty() && !part.name.starts_with("spacer") {
                parts.push(part);
            }
        }
        parts
    }
}
