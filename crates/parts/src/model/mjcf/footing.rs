//! The floor and the pads on it, in the file.

use super::document::CONTACT;
use crate::model::floor::{Block, Floor};
use crate::model::text::{MILLI, joined, metres, round};
use crate::model::writer::Writer;
use lizard_robot::GRAVITY;
use lizard_robot::servo::LEGS;

impl Floor {
    /// Gravity as the floor feels it: right, forward, up, m/s^2.
    pub(super) fn gravity(&self) -> String {
        let (sin, cos) = self.rises.to_radians().sin_cos();
        joined([0.0, -GRAVITY * sin, -GRAVITY * cos].map(round))
    }
}

impl Writer<'_> {
    pub(super) fn floor(&mut self) {
        self.xml.leaf(
            r#"geom name="floor" type="plane" size="0 0 0.05" material="floor" conaffinity="1""#,
        );
        for Block { at: [x, y], size } in &self.scene.floor.blocks {
            // Half of it is under the floor, where nothing comes.
            let [wide, long, high] = *size;
            let (half, at) = (
                metres([wide / 2.0, long / 2.0, high]),
                metres([*x, *y, 0.0]),
            );
            self.xml.leaf(format!(
                r#"geom type="box" size="{half}" pos="{at}" rgba="0.7 0.6 0.5 1" conaffinity="1""#
            ));
        }
    }

    /// A pad. Viewers hide it and show the part. It has friction against sliding only, not
    /// against turning or rolling, and the same on all that lies on the floor.
    pub(super) fn pad(&mut self, servo: usize) {
        let radius = self.assembly.robot().parts().pad.radius;
        let (leg, at) = (LEGS[servo], metres(self.pad_middle(servo)));
        let size = round(radius * MILLI);
        let friction = self.scene.floor.friction[servo];
        self.xml.leaf(format!(
            r#"geom name="pad {leg}" type="sphere" size="{size}" pos="{at}" group="3" contype="1" priority="1" condim="3" friction="{friction} 0 0" solref="{CONTACT}" solimp="0.95 0.99 0.0005""#
        ));
    }
}
