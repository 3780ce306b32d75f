//! The robot as SDF, the format of Gazebo: with closed loops, without a floor.

use std::f64::consts::FRAC_PI_2;

use crate::model::material::Material;
use crate::model::meshes;
use crate::model::node::{Freedom, Node};
use crate::model::text::{MILLI, escape_attribute, format_metres, round};
use crate::model::writer::Writer;

/// The oldest version of SDF in which a pose may be relative to another link.
const SDF_VERSION: &str = "1.7";

impl Writer<'_> {
    /// Writes the whole file. `folder` is the path or URL of the meshes.
    pub(super) fn write_sdf(mut self, folder: &str) -> String {
        let name = escape_attribute(&self.scene.name);
        self.xml.write(format_args!(
            r#"<?xml version="1.0"?>
            <sdf version="{SDF_VERSION}">
            <model name="{name}">"#
        ));
        for node in self.nodes() {
            self.write_sdf_link(node, folder);
        }
        for node in self.nodes() {
            self.write_sdf_joint(node);
        }
        for cut_joint in self.list_cut_joints() {
            let [first, second] = cut_joint.bodies.map(Node::identifier);
            let name = cut_joint.identifier();
            let position = format_metres([cut_joint.x, 0.0, 0.0]);
            // A ball joint is enough: all axes are vertical, and a hinge would constrain their direction twice.
            self.xml.write(format_args!(
                r#"<joint name="{name}" type="ball">
                    <parent>{first}</parent>
                    <child>{second}</child>
                    <pose relative_to="{first}">{position} 0 0 0</pose>
                </joint>"#
            ));
        }
        self.xml.write("</model>\n</sdf>");
        self.xml.text
    }

    fn write_sdf_link(&mut self, node: Node, folder: &str) {
        let (position, yaw) = self.position_and_yaw(node);
        let (frame, yaw) = match self.parent(node) {
            Some(parent) => (format!(r#" relative_to="{}""#, parent.identifier()), yaw),
            // The model's x axis points forward, its y axis to the left.
            None => (String::new(), yaw - FRAC_PI_2),
        };
        let (name, position, yaw) = (node.identifier(), format_metres(position), round(yaw));
        let inertia = self.compute_inertia(node);
        let centre = format_metres(inertia.centre_of_mass());
        let kilograms = round(inertia.mass * MILLI);
        let [xx, yy, zz, xy, xz, yz] = inertia.format_tensor();
        self.xml.write(format_args!(
            r#"<link name="{name}">
                <pose{frame}>{position} 0 0 {yaw}</pose>
                <inertial>
                    <pose>{centre} 0 0 0</pose>
                    <mass>{kilograms}</mass>
                    <inertia>
                        <ixx>{xx}</ixx>
                        <iyy>{yy}</iyy>
                        <izz>{zz}</izz>
                        <ixy>{xy}</ixy>
                        <ixz>{xz}</ixz>
                        <iyz>{yz}</iyz>
                    </inertia>
                </inertial>"#
        ));
        for material in meshes::list_materials(self.visible_pieces(), node) {
            let file = format!("{folder}{}", meshes::format_mesh_name(node, material));
            let (uri, Material { name, colour }) = (escape_attribute(&file), material);
            self.xml.write(format_args!(
                r#"<visual name="{name}">
                    <geometry>
                        <mesh>
                            <uri>{uri}</uri>
                            <scale>0.001 0.001 0.001</scale>
                        </mesh>
                    </geometry>
                    <material>
                        <ambient>{colour}</ambient>
                        <diffuse>{colour}</diffuse>
                    </material>
                </visual>"#
            ));
        }
        if let Node::Pad(servo) = node {
            let centre = format_metres(self.dome_centre(servo));
            let radius = round(self.assembly.robot().parts().pad.radius * MILLI);
            let friction = self.scene.floor.friction_coefficients[servo];
            self.xml.write(format_args!(
                r#"<collision name="pad">
                    <pose>{centre} 0 0 0</pose>
                    <geometry>
                        <sphere>
                            <radius>{radius}</radius>
                        </sphere>
                    </geometry>
                    <surface>
                        <friction>
                            <ode>
                                <mu>{friction}</mu>
                                <mu2>{friction}</mu2>
                            </ode>
                        </friction>
                    </surface>
                </collision>"#
            ));
        }
        self.xml.write("</link>");
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
        let name = self.joint_name(node);
        let (parent, child) = (parent.identifier(), node.identifier());
        self.xml.write(format_args!(
            r#"<joint name="{name}" type="{kind}">
                <parent>{parent}</parent>
                <child>{child}</child>
                <axis>
                    <xyz>{axis}</xyz>"#
        ));
        if let Some([min, max]) = self.joint_range(node) {
            self.xml.write(format_args!(
                "<limit>
                    <lower>{min}</lower>
                    <upper>{max}</upper>"
            ));
            if let Some([effort, velocity]) = self.effort_and_velocity(node) {
                self.xml.write(format_args!(
                    "<effort>{effort}</effort>
                    <velocity>{velocity}</velocity>"
                ));
            }
            self.xml.write("</limit>");
        }
        let [damping, friction] = self.damping_and_friction(node);
        self.xml.write(format_args!(
            "<dynamics>
                <damping>{damping}</damping>
                <friction>{friction}</friction>"
        ));
        if let Some([reference, stiffness]) = self.spring_values(node) {
            self.xml.write(format_args!(
                "<spring_reference>{reference}</spring_reference>
                <spring_stiffness>{stiffness}</spring_stiffness>"
            ));
        }
        self.xml.write("</dynamics>\n</axis>\n</joint>");
    }
}
