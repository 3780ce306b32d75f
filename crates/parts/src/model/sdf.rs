//! The robot as SDF, the format of Gazebo: with closed loops, without a floor.

use std::f64::consts::FRAC_PI_2;

use crate::model::closed;
use crate::model::meshes;
use crate::model::node::{Freedom, Node};
use crate::model::scene::Pull;
use crate::model::text::{MILLI, escape_attribute, metres, round};
use crate::model::writer::Writer;

/// The oldest version of SDF in which a pose may be relative to another link.
const VERSION: &str = "1.7";

impl Writer<'_> {
    /// Writes the whole file. The meshes are in `folder`, a path or a URL.
    pub(super) fn write_sdf(&mut self, folder: &str) {
        let name = escape_attribute(&self.scene.name);
        self.xml.declaration();
        self.xml.open(format!(r#"sdf version="{VERSION}""#));
        self.xml.open(format!(r#"model name="{name}""#));
        for node in self.nodes() {
            self.write_sdf_link(node, folder);
        }
        for node in self.nodes() {
            self.write_sdf_joint(node);
        }
        for loop_joint in closed::cut_joints(self.assembly, self.scene.pull.is_some()) {
            let [first, second] = loop_joint.bodies.map(Node::identifier);
            // A ball is enough: all axes are vertical already, and a hinge would constrain their direction twice.
            self.write_sdf_connection(&loop_joint.identifier(), "ball", &first, &second);
            let position = metres([loop_joint.at.x, loop_joint.at.y, 0.0]);
            let pose = format!(r#"pose relative_to="{first}""#);
            self.xml.value(pose, format_args!("{position} 0 0 0"));
            self.xml.close();
        }
    }

    fn write_sdf_link(&mut self, node: Node, folder: &str) {
        self.xml
            .open(format!(r#"link name="{}""#, node.identifier()));
        let placement = self.place_on_parent(node);
        let turn = placement.x_axis.angle().to_radians();
        match self.parent(node) {
            Some(parent) => {
                let pose = format!(r#"pose relative_to="{}""#, parent.identifier());
                self.write_pose(&pose, [placement.origin.x, placement.origin.y, 0.0], turn);
            }
            // The model's x axis points ahead, its y axis to the left.
            None => self.write_pose("pose", [0.0, 0.0, self.height()], turn - FRAC_PI_2),
        }
        let mass = self.mass(node);
        self.xml.open("inertial");
        self.write_pose("pose", mass.centre(), 0.0);
        self.xml.value("mass", round(mass.mass * MILLI));
        self.xml.open("inertia");
        let names = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
        for (name, value) in names.into_iter().zip(mass.written_tensor()) {
            self.xml.value(name, value);
        }
        self.xml.close();
        self.xml.close();
        for material in meshes::materials_of(self.visible_pieces(), node) {
            self.xml.open(format!(r#"visual name="{}""#, material.name));
            self.xml.open("geometry");
            self.xml.open("mesh");
            let file = format!("{folder}{}", meshes::mesh_file_name(node, material));
            self.xml.value("uri", escape_attribute(&file));
            self.xml.value("scale", "0.001 0.001 0.001");
            self.xml.close();
            self.xml.close();
            self.xml.open("material");
            self.xml.value("ambient", material.colour);
            self.xml.value("diffuse", material.colour);
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
        self.write_pose("pose", self.pad_middle(servo), 0.0);
        self.xml.open("geometry");
        self.xml.open("sphere");
        let radius = round(self.assembly.robot().parts().pad.radius * MILLI);
        self.xml.value("radius", radius);
        self.xml.close();
        self.xml.close();
        for element in ["surface", "friction", "ode"] {
            self.xml.open(element);
        }
        let friction = self.scene.floor.friction[servo];
        self.xml.value("mu", friction);
        self.xml.value("mu2", friction);
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
            Freedom::Turns => ("revolute", "0 0 1"),
            Freedom::SlidesAlongX => ("prismatic", "1 0 0"),
            Freedom::SlidesVertically => ("prismatic", "0 0 1"),
        };
        let (name, parent, child) = (
            self.joint_name(node),
            parent.identifier(),
            node.identifier(),
        );
        self.write_sdf_connection(&name, kind, &parent, &child);
        self.xml.open("axis");
        self.xml.value("xyz", axis);
        if let Some([smallest, largest]) = self.range(node) {
            self.xml.open("limit");
            self.xml.value("lower", smallest);
            self.xml.value("upper", largest);
            if let Some(servo) = self.driving_servo(node) {
                let motor = &self.scene.motors.each[servo];
                self.xml.value("effort", round(motor.stall * MILLI));
                self.xml
                    .value("velocity", round(motor.no_load_speed.to_radians()));
            }
            self.xml.close();
        }
        let [damping, friction] = self.resistance(node);
        self.xml.open("dynamics");
        self.xml.value("damping", damping);
        self.xml.value("friction", friction);
        if let Some([reference, stiffness]) = self.spring_values(node) {
            self.xml.value("spring_reference", reference);
            self.xml.value("spring_stiffness", stiffness);
        }
        self.xml.close();
        self.xml.close();
        self.xml.close();
    }

    /// The position at which the spring of a body's joint is relaxed, m, and the spring's stiffness, N/m; `None` for
    /// a joint without a spring.
    fn spring_values(&self, node: Node) -> Option<[f64; 2]> {
        match (node, self.scene.pull) {
            (Node::Pad(_), _) => Some([0.0, self.leaf_spring()[0]]),
            (Node::Slot(_), Some(Pull { force, rate })) => {
                Some([-force / rate * MILLI, rate / MILLI].map(round))
            }
            _ => None,
        }
    }

    /// Opens the element of a joint and writes its parent and child. The caller closes the element.
    fn write_sdf_connection(&mut self, name: &str, kind: &str, parent: &str, child: &str) {
        self.xml
            .open(format!(r#"joint name="{name}" type="{kind}""#));
        self.xml.value("parent", parent);
        self.xml.value("child", child);
    }

    fn write_pose(&mut self, element: &str, position: [f64; 3], turn: f64) {
        let (position, turn) = (metres(position), round(turn));
        self.xml
            .value(element, format_args!("{position} 0 0 {turn}"));
    }
}
