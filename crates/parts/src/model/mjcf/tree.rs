//! The tree of bodies, each with the joint to its parent, as MJCF.

use lizard_robot::SLOT_LENGTH;

use super::document::format_stiff_limits;
use crate::layers::body::Mount;
use crate::model::material::Material;
use crate::model::node::{Freedom, Node};
use crate::model::text::{MILLI, format_metres, join_numbers, round};
use crate::model::writer::Writer;

impl Writer<'_> {
    pub(super) fn write_body(&mut self, node: Node) {
        let placement = self.placement_on_parent(node);
        let is_chassis = self.parent(node).is_none();
        let height = match is_chassis {
            true => self.chassis_height(),
            false => 0.0,
        };
        let half_angle = placement.x_axis.angle().to_radians() / 2.0;
        let name = node.name();
        let position = format_metres([placement.origin.x, placement.origin.y, height]);
        let (cos, sin) = (round(half_angle.cos()), round(half_angle.sin()));
        self.xml.open(format!(
            r#"body name="{name}" pos="{position}" quat="{cos} 0 0 {sin}""#
        ));
        self.write_joint(node);
        let inertia = self.compute_inertia(node);
        let centre = format_metres(inertia.centre_of_mass());
        let kilograms = round(inertia.mass * MILLI);
        let tensor = join_numbers(inertia.format_tensor());
        self.xml.write_empty(format!(
            r#"inertial pos="{centre}" mass="{kilograms}" fullinertia="{tensor}""#
        ));
        let pieces = self.visible_pieces().iter();
        for piece in pieces.filter(|piece| piece.node == node) {
            let (name, colour) = (&piece.name, Material::for_kind(piece.kind).colour);
            self.xml
                .write_empty(format!(r#"geom type="mesh" mesh="{name}" rgba="{colour}""#));
        }
        if let Node::Pad(servo) = node {
            self.write_pad(servo);
            self.write_pad_site(servo);
        }
        if is_chassis {
            self.xml.write_empty(r#"site name="chassis" group="3""#);
            self.xml.write_empty(
                r#"camera name="beside" mode="trackcom" pos="0.24 -0.21 0.2" xyaxes="0.66 0.75 0 -0.39 0.34 0.86""#,
            );
        }
        for child in self.nodes() {
            if self.parent(child) == Some(node) {
                self.write_body(child);
            }
        }
        self.xml.close();
    }

    /// Writes the joint of a body with its parent, under the body's name.
    pub(super) fn write_joint(&mut self, node: Node) {
        let name = node.name();
        let (kind, axis) = match node.freedom() {
            Freedom::Free => {
                self.xml.write_empty(format!(r#"freejoint name="{name}""#));
                return;
            }
            Freedom::TurnsAboutZ => ("hinge", "0 0 1"),
            Freedom::SlidesAlongX => ("slide", "1 0 0"),
            Freedom::SlidesVertically => ("slide", "0 0 1"),
        };
        let mut joint = format!(r#"joint name="{name}" type="{kind}" axis="{axis}""#);
        let joint_friction = self.scene.motors.joint_friction;
        if let Some(servo) = self.driving_servo(node) {
            // Back-EMF reduces the motor's torque as its speed rises. Reflected through the gears, the rotor's inertia
            // is far larger than a leg's, so the rotor smooths the steps of the pulses.
            let motor = self.scene.motors.per_servo[servo];
            let damping = round(motor.damping() * MILLI);
            let armature = round(motor.reflected_inertia() * MILLI);
            joint += &format!(r#" damping="{damping}" armature="{armature}""#);
            joint += &format_friction(joint_friction.pin_torque * MILLI);
        } else if matches!(node.freedom(), Freedom::TurnsAboutZ) {
            joint += &format_friction(self.scene.pin_friction * MILLI);
        }
        if matches!(node.freedom(), Freedom::SlidesAlongX) && !matches!(node, Node::SlotPin(_)) {
            joint += &format_friction(joint_friction.slider_force);
        }
        match (node, self.spring_values(node)) {
            (Node::OnMount(Mount::Link(_)), _) if self.has_play() => {
                let (play, limits) = (round(self.scene.play.to_radians()), format_stiff_limits());
                // Grease damps a link that moves freely within its play.
                joint += &format!(r#" range="{} {play}" {limits} damping="0.00001""#, -play);
            }
            (Node::Pad(_), _) => {
                let (stiffness, damping) = (self.leaf_stiffness(), self.leaf_damping());
                joint += &format!(r#" stiffness="{stiffness}" damping="{damping}""#);
            }
            (Node::SlotPin(_), Some([rest_position, stiffness])) => {
                let (slot_end, limits) = (round(SLOT_LENGTH * MILLI), format_stiff_limits());
                joint += &format!(
                    r#" range="0 {slot_end}" {limits} stiffness="{stiffness}" springref="{rest_position}" damping="0.1""#
                );
            }
            _ => {}
        }
        self.xml.write_empty(joint);
    }
}

/// Formats the attributes for a joint's dry friction, N or N m; empty if the joint has no friction.
fn format_friction(friction: f64) -> String {
    match friction > 0.0 {
        // MuJoCo's default friction constraint is soft, so a servo that hardly moves would have less friction.
        true => format!(
            r#" frictionloss="{}" solreffriction="0.001 1" solimpfriction="0.99 0.999 0.001""#,
            round(friction)
        ),
        false => String::new(),
    }
}
