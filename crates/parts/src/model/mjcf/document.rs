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
    pub(in super::super) fn write_mjcf(&mut self) {
        let name = escape_attribute(&self.scene.name);
        self.xml.open(format!(r#"mujoco model="{name}""#));
        self.write_options();
        self.xml.open("custom");
        let ratio = round(self.scene.friction_ratio);
        let element = format!(r#"numeric name="back over forward" data="{ratio}""#);
        self.xml.write_empty(element);
        if self.scene.drives_in_bursts {
            let element = r#"numeric name="bursts" data="1""#;
            self.xml.write_empty(element);
        }
        if let Some(trajectory) = &self.scene.trajectory {
            let (start, period) = (round(trajectory.measure_start), round(trajectory.period));
            let cycle_count = trajectory.measured_cycle_count;
            let element = format!(r#"numeric name="cycle" data="{start} {period} {cycle_count}""#);
            self.xml.write_empty(element);
        }
        self.xml.close();
        self.write_assets();
        self.write_world();
        self.write_loops();
        self.write_actuators();
        self.write_sensors();
        self.write_keyframes();
    }

    fn write_options(&mut self) {
        let xml = &mut self.xml;
        xml.write_empty(r#"compiler angle="radian" autolimits="true""#);
        // Feet of a few grams chatter with MuJoCo's default contact settings.
        xml.write_empty(format!(
            r#"option timestep="{TIME_STEP_S}" gravity="{}" integrator="implicitfast" cone="elliptic" impratio="100" noslip_iterations="20""#,
            self.scene.floor.format_gravity()
        ));
        xml.open("visual");
        xml.write_empty(r#"map znear="0.01""#);
        xml.write_empty(r#"global offwidth="1280" offheight="960""#);
        xml.close();
        xml.write_empty(r#"statistic extent="0.3" center="0 0 0.03""#);
        xml.open("default");
        xml.write_empty(r#"geom contype="0" conaffinity="0""#);
        xml.write_empty(r#"mesh scale="0.001 0.001 0.001""#);
        xml.write_empty(format!(
            r#"equality solref="{CONSTRAINT_SOLREF}" solimp="{CONSTRAINT_SOLIMP}""#
        ));
        xml.close();
    }

    fn write_assets(&mut self) {
        const TEXTURE_SIZE: &str = r#"width="256" height="256""#;
        let pieces = self.visible_pieces();
        let xml = &mut self.xml;
        xml.open("asset");
        xml.write_empty(format!(
            r#"texture name="sky" type="skybox" builtin="gradient" rgb1="0.9 0.95 1" rgb2="0.6 0.7 0.8" {TEXTURE_SIZE}"#
        ));
        xml.write_empty(format!(
            r#"texture name="floor" type="2d" builtin="checker" rgb1="0.75 0.75 0.72" rgb2="0.82 0.82 0.8" {TEXTURE_SIZE}"#
        ));
        // Each square of the checker pattern becomes 5 cm wide.
        xml.write_empty(
            r#"material name="floor" texture="floor" texrepeat="10 10" texuniform="true""#,
        );
        for Piece { name, mesh, .. } in pieces {
            let corners = mesh.corners.as_flattened().iter();
            let vertices = corners.map(|coordinate| (coordinate * 1e5).round() / 1e5 + 0.0);
            let faces = mesh.triangles.as_flattened().iter();
            let (vertices, faces) = (join_numbers(vertices), join_numbers(faces));
            xml.write_empty(format!(
                r#"mesh name="{name}" vertex="{vertices}" face="{faces}""#
            ));
        }
        xml.close();
    }

    fn write_world(&mut self) {
        self.xml.open("worldbody");
        self.xml
            .write_empty(r#"light pos="0.3 -0.3 1" dir="-0.3 0.3 -1" type="directional""#);
        self.write_floor();
        self.write_body(Node::OnMount(Mount::Chassis));
        self.xml.close();
    }
}

/// Formats the attributes that make a joint's range limits stiff.
pub(super) fn format_stiff_limits() -> String {
    format!(r#"solreflimit="{CONSTRAINT_SOLREF}" solimplimit="{CONSTRAINT_SOLIMP}""#)
}
