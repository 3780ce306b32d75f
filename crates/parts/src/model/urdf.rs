//! The robot as URDF, the format of ROS: a tree of links, without a floor.
//!
//! URDF cannot close a loop. The legs are parallelograms that follow their servos exactly, so the legs' joints mimic
//! the servos' joints. Couplers, sleeves and rods are free. At each joint where a loop is cut, a pair of frames marks
//! the two points that must coincide.

use std::f64::consts::FRAC_PI_2;

use lizard_robot::servo::SERVO_NAMES;

use crate::layers::body::Mount;
use crate::model::cut_joints::{CutJoint, list_cut_joints};
use crate::model::material::Material;
use crate::model::meshes;
use crate::model::node::{Freedom, Node};
use crate::model::text::{MILLI, escape_attribute, format_metres, round};
use crate::model::writer::Writer;

/// The link on the floor under the chassis: x forward, y to the left, z up, as ROS requires.
const BASE_LINK: &str = "base_link";

impl Writer<'_> {
    /// Writes the whole file. `folder` is the path or URL of the meshes.
    pub(super) fn write_urdf(&mut self, folder: &str) {
        let name = escape_attribute(&self.scene.name);
        self.xml.write_declaration();
        self.xml.open(format!(r#"robot name="{name}""#));
        for Material { name, colour } in Material::ALL {
            self.xml.open(format!(r#"material name="{name}""#));
            self.xml.write_empty(format!(r#"color rgba="{colour}""#));
            self.xml.close();
        }
        self.xml.write_empty(format!(r#"link name="{BASE_LINK}""#));
        for node in self.nodes() {
            self.write_urdf_link(node, folder);
            self.write_urdf_joint(node);
        }
        for cut_joint in list_cut_joints(self.assembly, self.scene.strut_spring.is_some()) {
            self.write_coinciding_frames(&cut_joint);
        }
    }

    fn write_urdf_link(&mut self, node: Node, folder: &str) {
        self.xml
            .open(format!(r#"link name="{}""#, node.identifier()));
        let inertia = self.compute_inertia(node);
        let [xx, yy, zz, xy, xz, yz] = inertia.format_tensor();
        self.xml.open("inertial");
        self.write_origin(inertia.centre_of_mass(), 0.0);
        self.xml
            .write_empty(format!(r#"mass value="{}""#, round(inertia.mass * MILLI)));
        self.xml.write_empty(format!(
            r#"inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="{xy}" ixz="{xz}" iyz="{yz}""#
        ));
        self.xml.close();
        for material in meshes::list_materials(self.visible_pieces(), node) {
            self.xml.open("visual");
            self.xml.open("geometry");
            let mesh_name = meshes::format_mesh_name(node, material);
            let file = escape_attribute(&format!("{folder}{mesh_name}"));
            self.xml.write_empty(format!(
                r#"mesh filename="{file}" scale="0.001 0.001 0.001""#
            ));
            self.xml.close();
            self.xml
                .write_empty(format!(r#"material name="{}""#, material.name));
            self.xml.close();
        }
        if let Node::Pad(servo) = node {
            self.xml.open("collision");
            self.write_origin(self.dome_centre(servo), 0.0);
            self.xml.open("geometry");
            let radius = round(self.assembly.robot().parts().pad.radius * MILLI);
            self.xml.write_empty(format!(r#"sphere radius="{radius}""#));
            self.xml.close();
            self.xml.close();
        }
        self.xml.close();
    }

    fn write_urdf_joint(&mut self, node: Node) {
        let range = self.joint_range(node);
        let kind = match (node.freedom(), range) {
            // URDF has no springs, so the feet are fixed to their leaves.
            (Freedom::Free | Freedom::SlidesVertically, _) => "fixed",
            (Freedom::TurnsAboutZ, Some(_)) => "revolute",
            (Freedom::TurnsAboutZ, None) => "continuous",
            (Freedom::SlidesAlongX, _) => "prismatic",
        };
        let placement = self.placement_on_parent(node);
        let (parent, height, base_yaw) = match self.parent(node) {
            Some(parent) => (parent.identifier(), 0.0, 0.0),
            None => (BASE_LINK.to_owned(), self.chassis_height(), -FRAC_PI_2),
        };
        let yaw = placement.x_axis.angle().to_radians() + base_yaw;
        let name = self.joint_name(node);
        self.write_urdf_connection(&name, kind, &parent, &node.identifier());
        self.write_origin([placement.origin.x, placement.origin.y, height], yaw);
        if kind != "fixed" {
            let axis = match node.freedom() {
                Freedom::SlidesAlongX => "1 0 0",
                _ => "0 0 1",
            };
            self.xml.write_empty(format!(r#"axis xyz="{axis}""#));
            if let Some([min, max]) = range {
                let [effort, velocity] = self.effort_and_velocity(node).unwrap_or_default();
                self.xml.write_empty(format!(
                    r#"limit lower="{min}" upper="{max}" effort="{effort}" velocity="{velocity}""#
                ));
            }
            let [damping, friction] = self.damping_and_friction(node);
            self.xml.write_empty(format!(
                r#"dynamics damping="{damping}" friction="{friction}""#
            ));
        }
        if let Some((servo, factor)) = mimicked_servo(node) {
            let servo = SERVO_NAMES[servo];
            self.xml
                .write_empty(format!(r#"mimic joint="{servo}" multiplier="{factor}""#));
        }
        self.xml.close();
    }

    /// Opens a joint's element and writes the joint's parent and child. The caller closes the element.
    fn write_urdf_connection(&mut self, name: &str, kind: &str, parent: &str, child: &str) {
        self.xml
            .open(format!(r#"joint name="{name}" type="{kind}""#));
        self.xml.write_empty(format!(r#"parent link="{parent}""#));
        self.xml.write_empty(format!(r#"child link="{child}""#));
    }

    fn write_origin(&mut self, position: [f64; 3], yaw: f64) {
        let (position, yaw) = (format_metres(position), round(yaw));
        self.xml
            .write_empty(format!(r#"origin xyz="{position}" rpy="0 0 {yaw}""#));
    }

    /// Writes the two frames of a cut joint, one on each body.
    fn write_coinciding_frames(&mut self, cut_joint: &CutJoint) {
        let [first, second] = cut_joint.bodies;
        let point = self.placement(first).map(cut_joint.point);
        let point_on_second = self.placement(second).unmap(point);
        let halves = [(first, cut_joint.point), (second, point_on_second)];
        for (number, (node, position)) in (1..).zip(halves) {
            let frame = format!("closing_{}_{number}", cut_joint.identifier());
            self.xml.write_empty(format!(r#"link name="{frame}""#));
            let joint = format!("{frame}_joint");
            self.write_urdf_connection(&joint, "fixed", &node.identifier(), &frame);
            self.write_origin([position.x, position.y, 0.0], 0.0);
            self.xml.close();
        }
    }
}

/// The servo that a body's joint mimics, and the factor of the angle; `None` if the joint mimics no servo.
fn mimicked_servo(node: Node) -> Option<(usize, i8)> {
    match node {
        Node::OnMount(Mount::Crank(servo) | Mount::Follower(servo)) => Some((servo, 1)),
        // Feet and struts keep their direction on the chassis, so they turn by the opposite angle on their parent.
        Node::OnMount(Mount::Foot(servo) | Mount::Strut(servo)) => Some((servo, -1)),
        _ => None,
    }
}
