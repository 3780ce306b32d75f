//! The robot as SDF, the format of Gazebo: with closed loops, without a floor.

use std::f64::consts::FRAC_PI_2;

use crate::model::cut_joints::list_cut_joints;
use crate::model::meshes;
use crate::model::node::{Freedom, Node};
use crate::model::text::{MILLI, escape_attribute, format_metres, round};
use crate::model::writer::Writer;

/// The oldest version of SDF in which a pose may be relative to another link.
const SDF_VERSION: &str = "1.7";

impl Writer<'_> {
    /// Writes the whole file. `folder` is the path or URL of the meshes.
    pub(super) fn write_sdf(&mut self, folder: &str) {
        let name = escape_attribute(&self.scene.name);
        self.xml.write_declaration();
        self.xml.open(format!(r#"sdf version="{SDF_VERSION}""#));
        self.xml.open(format!(r#"model name="{name}""#));
        for node in self.nodes() {
            self.write_sdf_link(node, folder);
        }
        for node in self.nodes() {
            self.write_sdf_joint(node);
        }
        for cut_joint in list_cut_joints(self.assembly, self.scene.strut_spring.is_some()) {
            let [first, second] = cut_joint.bodies.map(Node::identifier);
            // A ball joint is enough: all axes are vertical, and a hinge would constrain their direction twice.
            self.write_sdf_connection(&cut_joint.identifier(), "ball", &first, &second);
            let position = format_metres([cut_joint.point.x, cut_joint.point.y, 0.0]);
            let pose = format!(r#"pose relative_to="{first}""#);
            self.xml.write_value(pose, format_args!("{position} 0 0 0"));
            self.xml.close();
        }
    }

    fn write_sdf_link(&mut self, node: Node, folder: &str) {
        self.xml
            .open(format!(r#"link name="{}""#, node.identifier()));
        let placement = self.placement_on_parent(node);
        let yaw = placement.x_axis.angle().to_radians();
        match self.parent(node) {
            Some(parent) => {
                let pose = format!(r#"pose relative_to="{}""#, parent.identifier());
                self.write_pose(&pose, [placement.origin.x, placement.origin.y, 0.0], yaw);
            }
            // The model's x axis points forward, its y axis to the left.
            None => self.write_pose("pose", [0.0, 0.0, self.chassis_height()], yaw - FRAC_PI_2),
        }
        let inertia = self.compute_inertia(node);
        self.xml.open("inertial");
        self.write_pose("pose", inertia.centre_of_mass(), 0.0);
        self.xml.write_value("mass", round(inertia.mass * MILLI));
        self.xml.open("inertia");
        let names = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
        for (name, value) in names.into_iter().zip(inertia.format_tensor()) {
            self.xml.write_value(name, value);
        }
        self.xml.close();
        self.xml.close();
        for material in meshes::list_materials(self.visible_pieces(), node) {
            self.xml.open(format!(r#"visual name="{}""#, material.name));
            self.xml.open("geometry");
            self.xml.open("mesh");
            let file = format!("{folder}{}", meshes::format_mesh_name(node, material));
            self.xml.write_value("uri", escape_attribute(&file));
            self.xml.write_value("scale", "0.001 0.001 0.001");
            self.xml.close();
            self.xml.close();
            self.xml.open("material");
            self.xml.write_value("ambient", material.colour);
            self.xml.write_value("diffuse", material.colour);
            self.xml.close();
            self.xml.close();
        }
        if let Node::Pad(servo) = node {
            self.write_sdf_pad(servo);
        }
        self.xml.close();
    }

    fn write_sdf_pad(&mut self, servo: usize) {
        self.xml.open(r#"collision name="pad""#);
        self.write_pose("pose", self.dome_centre(servo), 0.0);
        self.xml.open("geometry");
        self.xml.open("sphere");
        let radius = round(self.assembly.robot().parts().pad.radius * MILLI);
        self.xml.write_value("radius", radius);
        self.xml.close();
        self.xml.close();
        for element in ["surface", "friction", "ode"] {
            self.xml.open(element);
        }
        let friction = self.scene.floor.friction_coefficients[servo];
        self.xml.write_value("mu", friction);
        self.xml.write_value("mu2", friction);
        for _ in ["ode", "friction", "surface", "collision"] {
            self.xml.close();
        }
    }

    fn write_sdf_joint(&mut self, node: Node) {
        let Some(parent) = self.parent(node) else {
            return;
        };
        let (kind, axis) = match node.freedom() {
            Freedom::Free => return,
            Freedom::TurnsAboutZ => ("revolute", "0 0 1"),
            Freedom::SlidesAlongX => ("prismatic", "1 0 0"),
            Freedom::SlidesVertically => ("prismatic", "0 0 1"),
        };
        let (parent, child) = (parent.identifier(), node.identifier());
        self.write_sdf_connection(&self.joint_name(node), kind, &parent, &child);
        self.xml.open("axis");
        self.xml.write_value("xyz", axis);
        if let Some([min, max]) = self.joint_range(node) {
            self.xml.open("limit");
            self.xml.write_value("lower", min);
            self.xml.write_value("upper", max);
            if let Some([effort, velocity]) = self.effort_and_velocity(node) {
                self.xml.write_value("effort", effort);
                self.xml.write_value("velocity", velocity);
            }
            self.xml.close();
        }
        let [damping, friction] = self.damping_and_friction(node);
        self.xml.open("dynamics");
        self.xml.write_value("damping", damping);
        self.xml.write_value("friction", friction);
        if let Some([reference, stiffness]) = self.spring_values(node) {
            self.xml.write_value("spring_reference", reference);
            self.xml.write_value("spring_stiffness", stiffness);
        }
        self.xml.close();
        self.xml.close();
        self.xml.close();
    }

    /// Opens a joint's element and writes the joint's parent and child. The caller closes the element.
    fn write_sdf_connection(&mut self, name: &str, kind: &str, parent: &str, child: &str) {
        self.xml
            .open(format!(r#"joint name="{name}" type="{kind}""#));
        self.xml.write_value("parent", parent);
        self.xml.write_value("child", child);
    }

    fn write_pose(&mut self, element: &str, position: [f64; 3], yaw: f64) {
        let (position, yaw) = (format_metres(position), round(yaw));
        self.xml
            .write_value(element, format_args!("{position} 0 0 {yaw}"));
    }
}
