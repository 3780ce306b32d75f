//! The robot as URDF, the format of ROS: a tree of links, without a floor.
//!
//! URDF cannot close a loop. The legs are parallelograms that follow their servos exactly, so the legs' joints mimic
//! the servos' joints. Couplers, sleeves and rods are free. At each joint where a loop is cut, a pair of frames marks
//! the two points that must coincide.

use std::f64::consts::FRAC_PI_2;

use lizard_kinematics::Vector;
use lizard_robot::servo::SERVO_NAMES;

use crate::layers::body::Mount;
use crate::model::cut_joints::CutJoint;
use crate::model::material::Material;
use crate::model::meshes;
use crate::model::node::{Freedom, Node};
use crate::model::text::{MILLI, escape_attribute, format_metres, round};
use crate::model::writer::Writer;

/// The link on the floor under the chassis: x forward, y to the left, z up, as ROS requires.
const BASE_LINK: &str = "base_link";

impl Writer<'_> {
    /// Writes the whole file. `folder` is the path or URL of the meshes.
    pub(super) fn write_urdf(mut self, folder: &str) -> String {
        let name = escape_attribute(&self.scene.name);
        self.xml.write(format_args!(
            r#"<?xml version="1.0"?>
            <robot name="{name}">"#
        ));
        for Material { name, colour } in Material::ALL {
            self.xml.write(format_args!(
                r#"<material name="{name}">
                    <color rgba="{colour}"/>
                </material>"#
            ));
        }
        self.xml
            .write(format_args!(r#"<link name="{BASE_LINK}"/>"#));
        for node in self.nodes() {
            self.write_urdf_link(node, folder);
            self.write_urdf_joint(node);
        }
        for cut_joint in self.list_cut_joints() {
            self.write_coinciding_frames(&cut_joint);
        }
        self.xml.write("</robot>");
        self.xml.text
    }

    fn write_urdf_link(&mut self, node: Node, folder: &str) {
        let (name, inertia) = (node.identifier(), self.compute_inertia(node));
        let centre = format_metres(inertia.centre_of_mass());
        let kilograms = round(inertia.mass * MILLI);
        let [xx, yy, zz, xy, xz, yz] = inertia.format_tensor();
        self.xml.write(format_args!(
            r#"<link name="{name}">
                <inertial>
                    <origin xyz="{centre}" rpy="0 0 0"/>
                    <mass value="{kilograms}"/>
                    <inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="{xy}" ixz="{xz}" iyz="{yz}"/>
                </inertial>"#
        ));
        for material in meshes::list_materials(self.visible_pieces(), node) {
            let file = format!("{folder}{}", meshes::format_mesh_name(node, material));
            let (file, name) = (escape_attribute(&file), material.name);
            self.xml.write(format_args!(
                r#"<visual>
                    <geometry>
                        <mesh filename="{file}" scale="0.001 0.001 0.001"/>
                    </geometry>
                    <material name="{name}"/>
                </visual>"#
            ));
        }
        if let Node::Pad(servo) = node {
            let centre = format_metres(self.dome_centre(servo));
            let radius = round(self.assembly.robot().parts().pad.radius * MILLI);
            self.xml.write(format_args!(
                r#"<collision>
                    <origin xyz="{centre}" rpy="0 0 0"/>
                    <geometry>
                        <sphere radius="{radius}"/>
                    </geometry>
                </collision>"#
            ));
        }
        self.xml.write("</link>");
    }

    fn write_urdf_joint(&mut self, node: Node) {
        let range = self.joint_range(node);
        let (kind, axis) = match (node.freedom(), range) {
            // URDF has no springs, so the feet are fixed to their leaves.
            (Freedom::Free | Freedom::SlidesVertically, _) => ("fixed", None),
            (Freedom::TurnsAboutZ, Some(_)) => ("revolute", Some("0 0 1")),
            (Freedom::TurnsAboutZ, None) => ("continuous", Some("0 0 1")),
            (Freedom::SlidesAlongX, _) => ("prismatic", Some("1 0 0")),
        };
        let (position, yaw) = self.position_and_yaw(node);
        let (parent, yaw) = match self.parent(node) {
            Some(parent) => (parent.identifier(), yaw),
            None => (BASE_LINK.to_owned(), yaw - FRAC_PI_2),
        };
        let (position, yaw) = (format_metres(position), round(yaw));
        let (name, child) = (self.joint_name(node), node.identifier());
        self.xml.write(format_args!(
            r#"<joint name="{name}" type="{kind}">
                <parent link="{parent}"/>
                <child link="{child}"/>
                <origin xyz="{position}" rpy="0 0 {yaw}"/>"#
        ));
        if let Some(axis) = axis {
            self.xml.write(format_args!(r#"<axis xyz="{axis}"/>"#));
            if let Some([min, max]) = range {
                let [effort, velocity] = self.effort_and_velocity(node).unwrap_or_default();
                self.xml.write(format_args!(
                    r#"<limit lower="{min}" upper="{max}" effort="{effort}" velocity="{velocity}"/>"#
                ));
            }
            let [damping, friction] = self.damping_and_friction(node);
            self.xml.write(format_args!(
                r#"<dynamics damping="{damping}" friction="{friction}"/>"#
            ));
        }
        if let Some((servo, factor)) = mimicked_servo(node) {
            let servo = SERVO_NAMES[servo];
            self.xml.write(format_args!(
                r#"<mimic joint="{servo}" multiplier="{factor}"/>"#
            ));
        }
        self.xml.write("</joint>");
    }

    /// Writes the two frames of a cut joint, one on each body.
    fn write_coinciding_frames(&mut self, cut_joint: &CutJoint) {
        let [first, second] = cut_joint.bodies;
        let point_on_first = Vector::new(cut_joint.x, 0.0);
        let point = self.placement(first).map(point_on_first);
        let point_on_second = self.placement(second).unmap(point);
        let halves = [(first, point_on_first), (second, point_on_second)];
        for (number, (node, position)) in (1..).zip(halves) {
            let frame = format!("closing_{}_{number}", cut_joint.identifier());
            let parent = node.identifier();
            let position = format_metres([position.x, position.y, 0.0]);
            self.xml.write(format_args!(
                r#"<link name="{frame}"/>
                <joint name="{frame}_joint" type="fixed">
                    <parent link="{parent}"/>
                    <child link="{frame}"/>
                    <origin xyz="{position}" rpy="0 0 0"/>
                </joint>"#
            ));
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
