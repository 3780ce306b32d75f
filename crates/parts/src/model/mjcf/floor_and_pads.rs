//! The floor and the pads on it, in the MJCF file.

use super::document::CONTACT_SOLREF;
use crate::model::floor::Floor;
use crate::model::scene::Pads;
use crate::model::text::{MILLI, format_metres, join_numbers, round};
use crate::model::writer::Writer;
use lizard_robot::GRAVITY;
use lizard_robot::servo::LEG_NAMES;

/// Height of a flat pad, mm.
const FLAT_PAD_HEIGHT: f64 = 3.0;

/// Formats the MJCF attributes of a disc with this radius and height, mm.
fn format_disc(radius: f64, height: f64) -> String {
    let [radius, half_height] = [radius, height / 2.0].map(|length| round(length * MILLI));
    format!(r#"type="cylinder" size="{radius} {half_height}""#)
}

impl Floor {
    /// Formats gravity in the frame of the inclined floor: right, forward, up, m/s^2.
    pub(super) fn format_gravity(&self) -> String {
        let (sin, cos) = self.slope.to_radians().sin_cos();
        join_numbers([0.0, -GRAVITY * sin, -GRAVITY * cos].map(round))
    }
}

impl Writer<'_> {
    pub(super) fn write_floor(&mut self) {
        self.xml.write(
            r#"<geom name="floor" type="plane" size="0 0 0.05" material="floor" conaffinity="1"/>"#,
        );
        for block in &self.scene.floor.blocks {
            let ([x, y], [width, length, height]) = (block.centre, block.size);
            // The box is twice as high as the block, with its lower half under the floor.
            let half_size = format_metres([width / 2.0, length / 2.0, height]);
            let position = format_metres([x, y, 0.0]);
            let rotation = round(block.rotation.to_radians());
            self.xml.write(format_args!(
                r#"<geom type="box" size="{half_size}" pos="{position}" euler="0 0 {rotation}" rgba="0.7 0.6 0.5 1" conaffinity="1"/>"#
            ));
        }
    }

    /// Writes a pad's contact shapes. Viewers hide these shapes (group 3) and show the printed part instead. The pad
    /// has friction only against sliding, not against turning or rolling. With `priority`, the pad's friction applies,
    /// not the floor's.
    pub(super) fn write_pad(&mut self, servo: usize) {
        let pad = self.assembly.robot().parts().pad;
        let [x, y, middle_z] = self.dome_centre(servo);
        let lowest_z = middle_z - pad.radius;
        match self.scene.pads {
            Pads::Domes(radius) => {
                let shape = format!(r#"type="sphere" size="{}""#, round(radius * MILLI));
                self.write_pad_shape(servo, "", &shape, [x, y, lowest_z + radius]);
            }
            Pads::Terraces(layer_height) => {
                // A layer has the dome's radius at half of the layer's height.
                let radius_at = |height: f64| (height * (2.0 * pad.radius - height)).sqrt();
                let heights =
                    (0..).map(|layer_index| (f64::from(layer_index) + 0.5) * layer_height);
                let heights = heights.take_while(|height| radius_at(*height) < pad.width / 2.0);
                for (layer_index, height) in heights.enumerate() {
                    let suffix = format!(" {layer_index}");
                    let position = [x, y, lowest_z + height];
                    let shape = format_disc(radius_at(height), layer_height);
                    self.write_pad_shape(servo, &suffix, &shape, position);
                }
            }
            Pads::Flat(diameter) => {
                let position = [x, y, lowest_z + FLAT_PAD_HEIGHT / 2.0];
                let shape = format_disc(diameter / 2.0, FLAT_PAD_HEIGHT);
                self.write_pad_shape(servo, "", &shape, position);
            }
        }
    }

    fn write_pad_shape(&mut self, servo: usize, suffix: &str, shape: &str, position: [f64; 3]) {
        let (leg, position) = (LEG_NAMES[servo], format_metres(position));
        let friction = self.scene.floor.friction_coefficients[servo];
        self.xml.write(format_args!(
            r#"<geom name="pad {leg}{suffix}" {shape} pos="{position}" group="3" contype="1" priority="1" condim="3" friction="{friction} 0 0" solref="{CONTACT_SOLREF}" solimp="0.95 0.99 0.0005"/>"#
        ));
    }
}
