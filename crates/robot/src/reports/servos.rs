//! The servos' effort in every gait at several supply voltages and paces, and the resulting movement.

use std::fmt;

use lizard_contact::Prediction;

use crate::checks::{CheckedGait, Effort};
use crate::measures::ServoType;
use crate::reports::report::{UNDECIDED_NOTE, column_width, format_component, format_turn};
use crate::robot::Robot;

/// Paces in the table, as the command `speed` takes them: percent of a gait's own pace.
pub const PACES_PERCENT: [f64; 2] = [100.0, 50.0];

/// The figures of a gait at one supply and pace.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell {
    /// Largest share of its torque-speed line that any servo uses.
    line_share: f64,
    /// Movement in one cycle with these servos.
    movement: Prediction,
}

/// The figures of a gait at every supply and pace.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    name: String,
    /// The figures, first by pace and then by supply.
    cells: [[Cell; 3]; PACES_PERCENT.len()],
    /// For each supply, the highest pace at which no servo exceeds its torque-speed line, percent.
    max_paces: [f64; 3],
}

/// The table of the gaits that move, at three supplies: the servos' own, the one at which the robot slows down, and the
/// one at which it stops.
#[derive(Debug, Clone, PartialEq)]
pub struct ServoTable {
    servo: ServoType,
    /// The three supplies, V.
    supply_volts: [f64; 3],
    /// Pace to which gaits are limited at a low supply, percent of their own pace.
    slow_pace: u8,
    rows: Vec<Row>,
}

impl ServoTable {
    /// Predicts a robot's gaits at all supplies and paces. Takes some seconds.
    pub fn of(robot: &Robot) -> Self {
        let (servo, volts) = (*robot.servo_type(), robot.reported_volts());
        let ground = robot.ground();
        let row_of = |gait: &CheckedGait| {
            let effort = Effort::of(gait, ground, &robot.motors());
            let prediction = gait.predict(&ground.with_rigid_drive());
            let cell_of = |pace: f64, volts: f64| Cell {
                line_share: effort.line_share(pace / 100.0, volts / servo.volts),
                movement: prediction.known_components_of(gait.simulate_driven_cycle(
                    ground,
                    &robot.motors_at(volts),
                    pace / 100.0,
                )),
            };
            Row {
                name: gait.name().to_string(),
                cells: PACES_PERCENT.map(|pace| volts.map(|volts| cell_of(pace, volts))),
                max_paces: volts
                    .map(|volts| 100.0 * effort.max_sustainable_pace(volts / servo.volts)),
            }
        };
        let moving_gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
        Self {
            servo,
            supply_volts: volts,
            slow_pace: robot.supplies().slow_pace,
            rows: moving_gaits.map(row_of).collect(),
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
            stall_kg_cm,
            s_per_60_deg,
            at_volts,
            ..
        } = self.servo;
        let slow_pace = self.slow_pace;
        writeln!(
            f,
            "Servos: {stall_kg_cm} kg cm and {s_per_60_deg} s for 60 deg at {at_volts} V; the rest as {model} ({source}).\n\
             The share of their torque-speed line, and one cycle: mm ahead, and deg where it turns. Above 1 a servo\n\
             falls behind its pulses. The second and the third supply are those at which the robot slows down, to\n\
             speed {slow_pace} at most, and stops."
        )?;
        let width = column_width(self.rows.iter().map(|row| row.name.as_str()));
        for (i, pace) in PACES_PERCENT.into_iter().enumerate() {
            self.write_header(f, &format!("speed {pace:.0}"), width, 22)?;
            for row in &self.rows {
                let cells: String = row.cells[i].iter().map(format_cell).collect();
                writeln!(f, "{}", format!("{:<width$}{cells}", row.name).trim_end())?;
            }
        }
        self.write_header(f, "fastest", width, 10)?;
        for Row {
            name, max_paces, ..
        } in &self.rows
        {
            let paces: String = max_paces
                .iter()
                .map(|pace| format!("{pace:>10.0}"))
                .collect();
            writeln!(f, "{name:<width$}{paces}")?;
        }
        let all_cells = self.rows.iter().flat_map(|row| row.cells.as_flattened());
        match all_cells.into_iter().all(|cell| cell.movement.is_decided()) {
            true => Ok(()),
            false => write!(f, "\n{UNDECIDED_NOTE}"),
        }
    }
}

/// Formats a cell. A turn that rounds to zero is left out.
fn format_cell(
    Cell {
        line_share,
        movement,
    }: &Cell,
) -> String {
    let turn = format_turn(movement.turn);
    format!(
        "{line_share:>9.2}{:>7}{turn:>6}",
        format_component(movement.forward, 1)
    )
}
