//! The servos' utilisation in every gait at several supply voltages and paces, and the resulting displacement.

use std::fmt;

use lizard_contact::Prediction;

use crate::checks::{CheckedGait, Effort};
use crate::config::ServoType;
use crate::reports::report::{UNDETERMINED_NOTE, column_width, format_component, format_turn};
use crate::robot::Robot;

/// Paces in the table, percent of a gait's nominal pace: arguments of the command `speed`.
pub const PACES_PERCENT: [f64; 2] = [100.0, 50.0];

/// The results for a gait at one supply voltage and pace.
#[derive(Debug, Clone, Copy, PartialEq)]
struct OperatingPoint {
    /// Highest utilisation of any servo's torque-speed line.
    utilisation: f64,
    /// Displacement over one cycle with these servos.
    movement: Prediction,
}

/// The results for a gait at every supply voltage and pace.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    name: String,
    /// The results, indexed by pace, then by supply voltage.
    points: [[OperatingPoint; 3]; PACES_PERCENT.len()],
    /// For each supply voltage, the highest pace at which no servo exceeds its torque-speed line, percent.
    max_paces_percent: [f64; 3],
}

/// The table of the gaits that move, at three supply voltages: the servos' supply voltage, and the thresholds `slow`
/// and `stop`.
#[derive(Debug, Clone, PartialEq)]
pub struct ServoTable {
    servo_type: ServoType,
    /// The three supply voltages, V.
    supply_volts: [f64; 3],
    /// Pace limit at a low supply voltage, percent of the nominal pace.
    slow_pace_percent: u8,
    rows: Vec<Row>,
}

impl ServoTable {
    /// Predicts a robot's gaits at all supply voltages and paces. Takes a few seconds.
    pub fn compute(robot: &Robot) -> Self {
        let (servo_type, supply_volts) = (*robot.servo_type(), robot.reported_volts());
        let ground = robot.ground();
        let compute_row = |gait: &CheckedGait| {
            let effort = Effort::simulate(gait, ground, &robot.motors());
            let prediction = gait.predict(&ground.with_rigid_drive());
            let compute_point = |pace: f64, volts: f64| OperatingPoint {
                utilisation: effort.utilisation(pace / 100.0, volts / servo_type.supply_volts),
                movement: prediction.keep_determined(gait.simulate_driven_cycle(
                    ground,
                    &robot.motors_at_volts(volts),
                    pace / 100.0,
                )),
            };
            Row {
                name: gait.name().to_string(),
                points: PACES_PERCENT
                    .map(|pace| supply_volts.map(|volts| compute_point(pace, volts))),
                max_paces_percent: supply_volts
                    .map(|volts| 100.0 * effort.find_max_pace(volts / servo_type.supply_volts)),
            }
        };
        let moving_gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
        Self {
            servo_type,
            supply_volts,
            slow_pace_percent: robot.supplies().slow_pace_percent,
            rows: moving_gaits.map(compute_row).collect(),
        }
    }

    /// Writes a heading, followed by the supply voltages as the headings of the columns.
    fn write_header(
        &self,
        f: &mut fmt::Formatter,
        heading: &str,
        width: usize,
        cell_width: usize,
    ) -> fmt::Result {
        write!(f, "\n{heading:<width$}")?;
        for volts in self.supply_volts {
            write!(f, "{:>cell_width$}", format!("{volts:.2} V"))?;
        }
        writeln!(f)
    }
}

impl fmt::Display for ServoTable {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let ServoType {
            model,
            source,
            stall_torque_kg_cm,
            s_per_60_deg,
            rated_volts,
            ..
        } = self.servo_type;
        let slow_pace = self.slow_pace_percent;
        writeln!(
            f,
            "Servos: {stall_torque_kg_cm} kg cm and {s_per_60_deg} s per 60 deg at {rated_volts} V; other values from the \
             {model} ({source}).\n\
             Each column: fraction of the torque-speed line used, mm forward per cycle, and deg of turn per cycle.\n\
             Above 1 a servo falls behind its pulses. The last two voltages are the thresholds at which the robot slows\n\
             down to speed {slow_pace} or less, and stops."
        )?;
        let width = column_width(self.rows.iter().map(|row| row.name.as_str()));
        for (i, pace) in PACES_PERCENT.into_iter().enumerate() {
            self.write_header(f, &format!("speed {pace:.0}"), width, 22)?;
            for row in &self.rows {
                let cells: String = row.points[i].iter().map(format_point).collect();
                writeln!(f, "{}", format!("{:<width$}{cells}", row.name).trim_end())?;
            }
        }
        self.write_header(f, "max speed", width, 10)?;
        for row in &self.rows {
            let paces = row.max_paces_percent.map(|pace| format!("{pace:>10.0}"));
            writeln!(f, "{:<width$}{}", row.name, paces.concat())?;
        }
        let mut points = self.rows.iter().flat_map(|row| row.points.as_flattened());
        match points.all(|point| point.movement.is_determined()) {
            true => Ok(()),
            false => write!(f, "\n{UNDETERMINED_NOTE}"),
        }
    }
}

/// Formats the results at one operating point. A turn that rounds to zero is omitted.
fn format_point(point: &OperatingPoint) -> String {
    let (utilisation, turn) = (point.utilisation, format_turn(point.movement.turn));
    let forward = format_component(point.movement.forward, 1);
    format!("{utilisation:>9.2}{forward:>7}{turn:>6}")
}
