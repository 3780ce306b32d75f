//! The MJCF file as a whole: options, defaults, meshes and floor, then the robot.

use crate::layers::body::Mount;
use crate::model::node::Node;
use crate::model::pieces::Piece;
use crate::model::text::{escape_attribute, join_numbers, round};
use crate::model::writer::Writer;

/// Time step of the simulation, s.
const TIME_STEP_S: f64 = 0.0002;
/// `solref` of constraints and limits: time constant (s) and damping ratio.
const CONSTRAINT_SOLREF: &str = "0.002 1";
/// `solref` of contacts: time constant (s) and damping ratio. A foot that is too long would sink into a soft floor,
/// which would hide part of the error.
pub(super) const CONTACT_SOLREF: &str = "0.001 1";
/// `solimp` of constraints and limits: smallest and largest impedance, and the width of the transition, m or rad.
const CONSTRAINT_SOLIMP: &str = "0.99 0.999 0.0001";

impl Writer<'_> {
    /// Writes the whole file.
    pub(in super::super) fn write_mjcf(mut self) -> String {
        let name = escape_attribute(&self.scene.name);
        self.xml.write(format_args!(r#"<mujoco model="{name}">"#));
        self.write_options();
        let ratio = round(self.scene.friction_ratio);
        self.xml.write(format_args!(
            r#"<custom>
                <numeric name="back over forward" data="{ratio}"/>"#
        ));
        if self.scene.drives_in_bursts {
            self.xml.write(r#"<numeric name="bursts" data="1"/>"#);
        }
        if let Some(trajectory) = &self.scene.trajectory {
            let (start, period) = (round(trajectory.measure_start), round(trajectory.period));
            let cycle_count = trajectory.measured_cycle_count;
            self.xml.write(format_args!(
                r#"<numeric name="cycle" data="{start} {period} {cycle_count}"/>"#
            ));
        }
        self.xml.write("</custom>");
        self.write_assets();
        self.xml.write(
            r#"<worldbody>
                <light pos="0.3 -0.3 1" dir="-0.3 0.3 -1" type="directional"/>"#,
        );
        self.write_floor();
        self.write_body(Node::OnMount(Mount::Chassis));
        self.xml.write("</worldbody>");
        self.write_loops();
        self.write_actuators();
        self.write_sensors();
        self.write_keyframes();
        self.xml.write("</mujoco>");
        self.xml.text
    }

    fn write_options(&mut self) {
        let gravity = self.scene.floor.format_gravity();
        // Feet of a few grams chatter with MuJoCo's default contact settings.
        self.xml.write(format_args!(
            r#"<compiler angle="radian" autolimits="true"/>
            <option timestep="{TIME_STEP_S}" gravity="{gravity}" integrator="implicitfast" cone="elliptic" impratio="100" noslip_iterations="20"/>
            <visual>
                <map znear="0.01"/>
                <global offwidth="1280" offheight="960"/>
            </visual>
            <statistic extent="0.3" center="0 0 0.03"/>
            <default>
                <geom contype="0" conaffinity="0"/>
                <mesh scale="0.001 0.001 0.001"/>
                <equality solref="{CONSTRAINT_SOLREF}" solimp="{CONSTRAINT_SOLIMP}"/>
            </default>"#
        ));
    }

    fn write_assets(&mut self) {
        // Each square of the floor's checker pattern becomes 5 cm wide.
        self.xml.write(
            r#"<asset>
            <texture name="sky" type="skybox" builtin="gradient" rgb1="0.9 0.95 1" rgb2="0.6 0.7 0.8" width="256" height="256"/>
            <texture name="floor" type="2d" builtin="checker" rgb1="0.75 0.75 0.72" rgb2="0.82 0.82 0.8" width="256" height="256"/>
            <material name="floor" texture="floor" texrepeat="10 10" texuniform="true"/>"#,
        );
        for Piece { name, mesh, .. } in self.visible_pieces() {
            let corners = mesh.corners.as_flattened().iter();
            let vertices = corners.map(|coordinate| (coordinate * 1e5).round() / 1e5 + 0.0);
            let faces = mesh.triangles.as_flattened().iter();
            let (vertices, faces) = (join_numbers(vertices), join_numbers(faces));
            self.xml.write(format_args!(
                r#"<mesh name="{name}" vertex="{vertices}" face="{faces}"/>"#
            ));
        }
        self.xml.write("</asset>");
    }
}

/// Formats the attributes that make a joint's range limits stiff.
pub(super) fn format_stiff_limits() -> String {
    format!(r#"solreflimit="{CONSTRAINT_SOLREF}" solimplimit="{CONSTRAINT_SOLIMP}""#)
}
