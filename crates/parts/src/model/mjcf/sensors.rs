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
        self.xml.write("<sensor>");
        for name in SERVO_NAMES {
            self.xml.write(format_args!(
                r#"<actuatorpos name="{name} angle" actuator="{name}"/>
                <actuatorvel name="{name} rate" actuator="{name}"/>
                <actuatorfrc name="{name} torque" actuator="{name}"/>"#
            ));
        }
        for leg in LEG_NAMES {
            self.xml.write(format_args!(
                r#"<touch name="load {leg}" site="pad {leg}"/>"#
            ));
        }
        self.xml.write(
            r#"<framepos name="place" objtype="xbody" objname="chassis"/>
            <framequat name="direction" objtype="xbody" objname="chassis"/>
            <velocimeter name="velocity" site="chassis"/>
            <gyro name="gyro" site="chassis"/>
            </sensor>"#,
        );
    }

    /// Writes the site that measures the load of the pad on a servo's leg.
    pub(super) fn write_pad_site(&mut self, servo: usize) {
        let radius = self.assembly.robot().parts().pad.radius;
        let (leg, position) = (LEG_NAMES[servo], format_metres(self.dome_centre(servo)));
        let size = round(SITE_RADIUS_RATIO * radius * MILLI);
        self.xml.write(format_args!(
            r#"<site name="pad {leg}" type="sphere" size="{size}" pos="{position}" group="3"/>"#
        ));
    }
}
