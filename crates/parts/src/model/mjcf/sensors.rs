//! The sensors of the MuJoCo model.

use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};

use crate::model::text::{MILLI, format_metres, round};
use crate::model::writer::Writer;

/// Ratio of a pad site's radius to its dome's radius: contacts lie slightly outside the dome.
const SITE_RADIUS_RATIO: f64 = 1.05;

impl Writer<'_> {
    /// Writes sensors for the servos' angles, rates and torques, the force on each pad, and the chassis's position,
    /// orientation and velocities.
    pub(super) fn write_sensors(&mut self) {
        let xml = &mut self.xml;
        xml.open("sensor");
        for name in SERVO_NAMES {
            for (quantity, kind) in [("angle", "pos"), ("rate", "vel"), ("torque", "frc")] {
                xml.write_empty(format!(
                    r#"actuator{kind} name="{name} {quantity}" actuator="{name}""#
                ));
            }
        }
        for leg in LEG_NAMES {
            xml.write_empty(format!(r#"touch name="load {leg}" site="pad {leg}""#));
        }
        let chassis = r#"objtype="xbody" objname="chassis""#;
        xml.write_empty(format!(r#"framepos name="place" {chassis}"#));
        xml.write_empty(format!(r#"framequat name="direction" {chassis}"#));
        xml.write_empty(r#"velocimeter name="velocity" site="chassis""#);
        xml.write_empty(r#"gyro name="gyro" site="chassis""#);
        xml.close();
    }

    /// Writes the site that measures the load of a servo's pad.
    pub(super) fn write_pad_site(&mut self, servo: usize) {
        let radius = self.assembly.robot().parts().pad.radius;
        let (leg, position) = (LEG_NAMES[servo], format_metres(self.dome_centre(servo)));
        let size = round(SITE_RADIUS_RATIO * radius * MILLI);
        self.xml.write_empty(format!(
            r#"site name="pad {leg}" type="sphere" size="{size}" pos="{position}" group="3""#
        ));
    }
}
