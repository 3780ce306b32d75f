//! The tree of bodies, each with the joint to its parent, as MJCF.

use lizard_robot::SLOT;

use super::document::limits;
use crate::layers::body::Mount;
use crate::model::looks::Material;
use crate::model::node::{Freedom, Node};
use crate::model::scene::Pull;
use crate::model::text::{MILLI, join_numbers, metres, round};
use crate::model::writer::Writer;

impl Writer<'_> {
    pub(super) fn write_body(&mut self, node: Node) {
        let placement = self.place_on_parent(node);
        let is_chassis = self.parent(node).is_none();
        let height = if is_chassis { self.height() } else { 0.0 };
        let half_angle = placement.x_axis.angle().to_radians() / 2.0;
        let (name, position) = (
            node.name(),
            metres([placement.origin.x, placement.origin.y, height]),
        );
        let (cos, sin) = (round(half_angle.cos()), round(half_angle.sin()));
        self.xml.open(format!(
            r#"body name="{name}" pos="{position}" quat="{cos} 0 0 {sin}""#
        ));
        self.write_joint(node);
        let mass = self.mass(node);
        let (centre, grams) = (metres(mass.centre()), round(mass.mass * MILLI));
        let tensor = join_numbers(mass.written_tensor());
        self.xml.write_empty_element(format!(
            r#"inertial pos="{centre}" mass="{grams}" fullinertia="{tensor}""#
        ));
        for piece in self
            .visible_pieces()
            .iter()
            .filter(|piece| piece.node == node)
        {
            let (name, colour) = (&piece.name, Material::of(piece.kind).colour);
            self.xml
                .write_empty_element(format!(r#"geom type="mesh" mesh="{name}" rgba="{colour}""#));
        }
        if let Node::Pad(servo) = node {
            self.write_pad(servo);
            self.write_pad_site(servo);
        }
        if is_chassis {
            self.xml
                .write_empty_element(r#"site name="chassis" group="3""#);
            self.xml.write_empty_element(
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
                self.xml
                    .write_empty_element(format!(r#"freejoint name="{name}""#));
                return;
            }
            Freedom::Turns => ("hinge", "0 0 1"),
            Freedom::SlidesAlongX => ("slide", "1 0 0"),
            Freedom::SlidesVertically => ("slide", "0 0 1"),
        };
        let mut joint = format!(r#"joint name="{name}" type="{kind}" axis="{axis}""#);
        let joints = self.scene.motors.joints;
        if let Some(servo) = self.driving_servo(node) {
            // Back-EMF reduces the motor's torque as it turns faster. Seen through the gears, its rotor has far
            // more inertia than a leg, so it smooths the steps of the pulses.
            let motor = self.scene.motors.each[servo];
            let damping = round(motor.damping() * MILLI);
            let armature = round(motor.inertia() * MILLI);
            joint += &format!(r#" damping="{damping}" armature="{armature}""#);
            joint += &friction_loss(joints.drag * MILLI);
        } else if matches!(node.freedom(), Freedom::Turns) {
            joint += &friction_loss(self.scene.pin_friction * MILLI);
        }
        if matches!(node.freedom(), Freedom::SlidesAlongX) && !matches!(node, Node::Slot(_)) {
            joint += &friction_loss(joints.slider);
        }
        match (node, self.scene.pull) {
            (Node::OnMount(Mount::Link(_)), _) if self.has_play() => {
                let (play, limits) = (round(self.scene.play.to_radians()), limits());
                // Grease: it damps a link that moves freely within its play.
                joint += &format!(r#" range="{} {play}" {limits} damping="0.00001""#, -play);
            }
            (Node::Pad(_), _) => {
                let [stiffness, damping] = self.leaf_spring();
                joint += &format!(r#" stiffness="{stiffness}" damping="{damping}""#);
            }
            (Node::Slot(_), Some(Pull { force, rate })) => {
                let (end, limits) = (round(SLOT * MILLI), limits());
                let (stiffness, rest_position) =
                    (round(rate / MILLI), round(-force / rate * MILLI));
                joint += &format!(
                    r#" range="0 {end}" {limits} stiffness="{stiffness}" springref="{rest_position}" damping="0.1""#
                );
            }
            _ => {}
        }
        self.xml.write_empty_element(joint);
    }
}

/// The attributes for a joint's dry friction, N or N m; empty for a joint without friction.
fn friction_loss(friction: f64) -> String {
    match friction > 0.0 {
        // MuJoCo's default friction constraint is soft: a servo that hardly moves would have less friction.
        true => format!(
            r#" frictionloss="{}" solreffriction="0.001 1" solimpfriction="0.99 0.999 0.001""#,
            round(friction)
        ),
        false => String::new(),
    }
}
