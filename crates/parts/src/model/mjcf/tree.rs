//! The tree of bodies, each with the joint to its parent, as MJCF.

use super::document::format_stiff_limits;
use crate::layers::body::Mount;
use crate::model::material::Material;
use crate::model::node::{Freedom, Node};
use crate::model::text::{MILLI, format_metres, join_numbers, round};
use crate::model::writer::Writer;

impl Writer<'_> {
    /// Writes a body with its joint and its shapes, and within it the bodies that move on it.
    pub(super) fn write_body(&mut self, node: Node) {
        let (position, yaw) = self.position_and_yaw(node);
        let (name, position) = (node.name(), format_metres(position));
        let (cos, sin) = (round((yaw / 2.0).cos()), round((yaw / 2.0).sin()));
        self.xml.write(format_args!(
            r#"<body name="{name}" pos="{position}" quat="{cos} 0 0 {sin}">"#
        ));
        self.write_joint(node);
        let inertia = self.compute_inertia(node);
        let centre = format_metres(inertia.centre_of_mass());
        let kilograms = round(inertia.mass * MILLI);
        let tensor = join_numbers(inertia.format_tensor());
        self.xml.write(format_args!(
            r#"<inertial pos="{centre}" mass="{kilograms}" fullinertia="{tensor}"/>"#
        ));
        let pieces = self.visible_pieces().iter();
        for piece in pieces.filter(|piece| piece.node == node) {
            let (name, colour) = (&piece.name, Material::for_kind(piece.kind).colour);
            self.xml.write(format_args!(
                r#"<geom type="mesh" mesh="{name}" rgba="{colour}"/>"#
            ));
        }
        if let Node::Pad(servo) = node {
            self.write_pad(servo);
            self.write_pad_site(servo);
        }
        if self.parent(node).is_none() {
            self.xml.write(
                r#"<site name="chassis" group="3"/>
                <camera name="beside" mode="trackcom" pos="0.24 -0.21 0.2" xyaxes="0.66 0.75 0 -0.39 0.34 0.86"/>"#,
            );
        }
        for child in self.nodes() {
            if self.parent(child) == Some(node) {
                self.write_body(child);
            }
        }
        self.xml.write("</body>");
    }

    /// Writes the joint of a body with its parent, under the body's name.
    pub(super) fn write_joint(&mut self, node: Node) {
        let name = node.name();
        let (kind, axis) = match node.freedom() {
            Freedom::Free => {
                self.xml
                    .write(format_args!(r#"<freejoint name="{name}"/>"#));
                return;
            }
            Freedom::TurnsAboutZ => ("hinge", "0 0 1"),
            Freedom::SlidesAlongX => ("slide", "1 0 0"),
            Freedom::SlidesVertically => ("slide", "0 0 1"),
        };
        let [damping, friction] = self.damping_and_friction(node);
        let (friction, limits) = (format_friction(friction), format_stiff_limits());
        let range = join_numbers(self.joint_range(node).unwrap_or_default());
        let attributes = match (self.driving_servo(node), node) {
            (Some(servo), _) => {
                // Back-EMF reduces the motor's torque as its speed rises. Reflected through the gears, the rotor's
                // inertia is far larger than a leg's, so the rotor smooths the steps of the pulses.
                let motor = &self.scene.motors.per_servo[servo];
                let armature = round(motor.reflected_inertia() * MILLI);
                format!(r#" damping="{damping}" armature="{armature}"{friction}"#)
            }
            (None, Node::OnMount(Mount::Link(_))) => {
                format!(r#"{friction} range="{range}" {limits} damping="{damping}""#)
            }
            (None, Node::Pad(_)) => {
                let stiffness = self.leaf_stiffness();
                format!(r#" stiffness="{stiffness}" damping="{damping}""#)
            }
            (None, Node::SlotPin(_)) => {
                let spring = self.spring_values(node);
                let [rest_position, stiffness] = spring.expect("a slot pin has a spring");
                format!(
                    r#" range="{range}" {limits} stiffness="{stiffness}" springref="{rest_position}" damping="{damping}""#
                )
            }
            _ => friction,
        };
        self.xml.write(format_args!(
            r#"<joint name="{name}" type="{kind}" axis="{axis}"{attributes}/>"#
        ));
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
