//! The table of every gait's figures, which `make firmware` and `lizard gaits` print.

use std::fmt;

use lizard_contact::Prediction;
use lizard_core::numbers::section::SPACE_BYTES;

use crate::checks::{Audit, CheckedGait, Effort, HIGH_LINE_SHARE, TableError};
use crate::measures::servo::SERVO_NAMES;
use crate::reports::round::Round;
use crate::reports::spring_cost::SpringCost;
use crate::robot::Robot;

/// The figures of a gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the gait.
    pub name: String,
    /// Duration of a cycle at full speed, s.
    pub period: f64,
    /// Smallest margins, range of the slider travels, and highest speed.
    pub audit: Audit,
    /// Error of the gait's tables over all 65 536 phases.
    pub table_error: TableError,
    /// Movement in one cycle with ideal servos, by the contact model.
    pub movement: Prediction,
    /// Effect of the legs' drive; `None` if the legs are rigid without play.
    pub spring_cost: Option<SpringCost>,
    /// Largest share of its torque-speed line that any servo uses, at the servos' own supply.
    pub line_share: f64,
    /// Movement in one cycle with the servos' limited torque and speed.
    pub driven_movement: Prediction,
}

impl Row {
    /// True if the gait moves the robot, but its fastest servo stays below [`SLOW_SPEED`].
    fn is_slow(&self) -> bool {
        /// Smallest speed ahead at which a gait counts as moving the robot, mm/s.
        const MIN_SPEED_MM_S: f64 = 5.0;
        /// Smallest rate of turn at which a gait counts as moving the robot, deg/s.
        const MIN_TURN_RATE_DEG_S: f64 = 2.0;
        let rate_of = |component: Option<f64>| component.unwrap_or_default().abs() / self.period;
        let movement = &self.movement;
        let is_walking = rate_of(movement.forward) >= MIN_SPEED_MM_S
            || rate_of(movement.turn) >= MIN_TURN_RATE_DEG_S;
        is_walking && self.audit.peak_speed.speed < SLOW_SPEED
    }
}

/// The figures of all gaits.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Rows of the table, in the order of the file.
    pub rows: Vec<Row>,
    /// Figures of the routines, in the order of the file.
    pub rounds: Vec<Round>,
    /// Hash of the tables.
    pub hash: u32,
    /// Number of waveforms that the gaits share.
    pub wave_count: usize,
    /// Bytes of the robot's section in flash; at most [`SPACE_BYTES`].
    pub section_bytes: usize,
    /// True if the console's search for a gait's name may make a frame late.
    pub has_long_search: bool,
    /// Name of the robot.
    pub name: String,
}

/// Number of CPU cycles that the main loop may spend on a console line without making a frame late
/// (docs/firmware.md).
const MAX_SEARCH_CYCLES: usize = 34_000;

/// The note for a robot whose console may need more than [`MAX_SEARCH_CYCLES`] to find a gait's name.
const LONG_SEARCH_NOTE: &str = "many gaits: `cal`, or a line that names one, may make a frame 20 ms late; \
     fewer gaits or shorter names avoid it\n";

/// The note that explains a dash in place of a prediction.
pub const UNDECIDED_NOTE: &str =
    "- undecided: two feet against two, where the smallest difference between the pads decides\n";

/// Speed of the fastest servo below which a gait counts as slow, deg/s. At an edge of 2 mm in MuJoCo, `walk` and
/// similar gaits keep nine tenths of their distance, while slow gaits lose up to a third.
const SLOW_SPEED: f64 = 200.0;

/// The note on the assumptions behind the figures of routines with inputs.
pub const WITHOUT_CONTACTS_NOTE: &str =
    "inputs: no contact closes; a wait takes one frame, a gait without an end one cycle\n";

impl Report {
    /// Computes the errors of a robot's tables and predicts its gaits and routines. Takes a moment.
    pub fn of(robot: &Robot) -> Self {
        let (ground, motors) = (robot.ground(), robot.motors());
        let row_of = |gait: &CheckedGait| {
            let movement = robot.predict(gait);
            Row {
                name: gait.name().to_string(),
                period: gait.period(),
                audit: *gait.audit(),
                table_error: gait.table_error(),
                movement,
                spring_cost: SpringCost::of(gait, ground),
                line_share: Effort::of(gait, ground, &motors).line_share(1.0, 1.0),
                driven_movement: movement
                    .known_components_of(gait.simulate_driven_cycle(ground, &motors, 1.0)),
            }
        };
        let core = robot.core();
        Self {
            rows: robot.gaits().iter().map(row_of).collect(),
            rounds: robot
                .routines()
                .iter()
                .map(|routine| Round::of(robot, routine))
                .collect(),
            hash: core.hash(),
            wave_count: core.waves().len(),
            section_bytes: robot.section().len(),
            has_long_search: robot.max_search_cycles() > MAX_SEARCH_CYCLES,
            name: robot.name().to_string(),
        }
    }
}

impl Report {
    /// Writes the table of routines, if there are any.
    fn write_rounds(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.rounds.is_empty() {
            return Ok(());
        }
        let width = column_width(self.rounds.iter().map(|round| round.name.as_str()));
        writeln!(
            f,
            "\n{:width$}                  ideal servos, mm and deg   by its servos",
            ""
        )?;
        writeln!(
            f,
            "{:width$} steps repeat      s   ahead   left    turn   ahead   left    turn",
            "routine"
        )?;
        for round in &self.rounds {
            let Round {
                name,
                step_count,
                round_count,
                seconds,
                movement,
                driven_movement,
                ..
            } = round;
            let repeat = round_count.map_or("for ever".to_string(), |count| count.to_string());
            write!(
                f,
                "{name:<width$} {step_count:>5} {repeat:>6} {seconds:>6.1}"
            )?;
            for prediction in [movement, driven_movement] {
                let [forward, left, turn] = [prediction.forward, prediction.left, prediction.turn]
                    .map(|component| format_component(component, 1));
                write!(f, " {forward:>7} {left:>6} {turn:>7}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(
            f,
            "{} gaits in {} waveforms, {} bytes of flash of {}, robot {} {:08x}\n",
            self.rows.len(),
            self.wave_count,
            self.section_bytes,
            SPACE_BYTES,
            self.name,
            self.hash
        )?;
        let has_lag = self.rows.iter().any(|row| row.spring_cost.is_some());
        let width = column_width(self.rows.iter().map(|row| row.name.as_str()));
        writeln!(
            f,
            "{:width$}  cycle      fastest  table error, deg      smallest margins       slider, mm ideal servos, mm and deg   by its servos{}",
            "",
            if has_lag { "   drive, deg and %" } else { "" }
        )?;
        writeln!(
            f,
            "{:width$}      s  deg/s servo      max     rms  type-2 type-1    leg    least   most    ahead   left    turn   line  ahead   turn{}",
            "gait",
            if has_lag { "      lag  of rigid" } else { "" }
        )?;
        for row in &self.rows {
            let Row {
                name,
                period,
                audit,
                table_error,
                movement,
                spring_cost,
                line_share,
                driven_movement,
            } = row;
            let (min_stroke, max_stroke) = audit.stroke_range;
            write!(
                f,
                "{name:<width$} {period:>6.2} {:>6.1} {:>5}   {:>6.4}  {:>6.4}  {:>6.3} {:>6.3} {:>6.3}   {:>+6.1} {:>+6.1}  ",
                audit.peak_speed.speed,
                SERVO_NAMES[audit.peak_speed.servo],
                table_error.max,
                table_error.rms,
                audit.type2.value,
                audit.type1.value,
                audit.leg.value,
                round_to(min_stroke, 1),
                round_to(max_stroke, 1),
            )?;
            write!(
                f,
                "{:>7} {:>6} {:>7}  {line_share:>5.2} {:>6} {:>6}",
                format_component(movement.forward, 2),
                format_component(movement.left, 2),
                format_component(movement.turn, 2),
                format_component(driven_movement.forward, 1),
                format_component(driven_movement.turn, 1)
            )?;
            if let Some(SpringCost {
                max_lag,
                share_of_rigid,
                ..
            }) = spring_cost
            {
                let share =
                    share_of_rigid.map_or("-".to_string(), |share| format!("{:.0}", 100.0 * share));
                write!(f, "   {max_lag:>6.2} {share:>9}")?;
            }
            writeln!(f)?;
        }
        self.write_rounds(f)?;
        if self.rounds.iter().any(|round| round.has_inputs) {
            write!(f, "\n{WITHOUT_CONTACTS_NOTE}")?;
        }
        let movements = self.rows.iter().map(|row| &row.movement);
        let mut movements = movements.chain(self.rounds.iter().map(|round| &round.movement));
        if movements.any(|movement| !movement.is_decided()) {
            write!(f, "\n{UNDECIDED_NOTE}")?;
        }
        let slow_names = self.rows.iter().filter(|row| row.is_slow());
        let slow_names: Vec<_> = slow_names.map(|row| row.name.as_str()).collect();
        if !slow_names.is_empty() {
            writeln!(
                f,
                "\nslow steps: {}\nGaits below {SLOW_SPEED:.0} deg/s lose up to a third of their distance and half of their turn at an \
                 edge of 2 mm (docs/judges.md).",
                slow_names.join(", ")
            )?;
        }
        for row in self
            .rows
            .iter()
            .filter(|row| row.line_share >= HIGH_LINE_SHARE)
        {
            write!(f, "\n{}", reserve_warning(&row.name, row.line_share))?;
        }
        if self.has_long_search {
            write!(f, "\n{LONG_SEARCH_NOTE}")?;
        }
        Ok(())
    }
}

/// The warning for a gait that leaves its servos little reserve, or no reserve.
fn reserve_warning(name: &str, line_share: f64) -> String {
    let consequence = match line_share < 1.0 {
        true => "little is left for play, a cold gear or a long wire",
        false => "above 1 a servo falls behind its pulses",
    };
    format!(
        "{name}: {line_share:.2} of its servos' torque-speed line; {consequence}: `lizard gaits --servos`\n"
    )
}

/// The width of a column that holds these names, at least 12 characters.
pub(crate) fn column_width<'a>(names: impl Iterator<Item = &'a str>) -> usize {
    names.map(str::len).fold(12, usize::max)
}

/// Formats a component of a prediction with its sign, or as a dash if it is undecided.
pub(crate) fn format_component(component: Option<f64>, decimals: usize) -> String {
    match component {
        Some(value) => format!("{:+.decimals$}", round_to(value, decimals as i32)),
        None => "-".to_string(),
    }
}

/// Formats a turn, deg; empty if there is hardly one.
pub(crate) fn format_turn(turn: Option<f64>) -> String {
    match turn {
        Some(turn) if turn.abs() < 0.05 => String::new(),
        turn => format_component(turn, 1),
    }
}

/// Rounds a value to this number of decimals. A zero loses its sign.
fn round_to(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    // Adding positive zero turns a negative one positive.
    (value * scale).round() / scale + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{robot, robot_with};

    #[test]
    fn columns_are_aligned_for_names_of_any_length() {
        for name in ["paper", "own-gaits"] {
            let text = Report::of(&robot(name)).to_string();
            let rows: Vec<&str> = text
                .lines()
                .skip(2)
                .take_while(|line| !line.is_empty())
                .collect();
            let length = rows[1].len();
            assert!(
                rows.len() > 10 && rows[1..].iter().all(|row| row.len() == length),
                "{text}"
            );
        }
    }

    #[test]
    fn gaits_that_lose_much_at_an_edge_in_mujoco_are_called_slow() {
        let slow_gaits_of = |robot: Robot| {
            let report = Report::of(&robot);
            let rows = report.rows.iter().filter(|row| row.is_slow());
            let names: Vec<_> = rows.map(|row| row.name.clone()).collect();
            let text = report.to_string();
            let note = text
                .lines()
                .find_map(|line| line.strip_prefix("slow steps: "));
            assert_eq!(note.unwrap_or_default(), names.join(", "), "{text}");
            names
        };
        for name in ["paper", "large", "unequal", "grain"] {
            assert!(slow_gaits_of(robot(name)).is_empty(), "{name}");
        }
        let turns = [
            "turn-slowly-on-the-spot-all-the-way-to-the-left",
            "turn-slowly-to-the-right",
        ];
        assert_eq!(slow_gaits_of(robot("own-gaits")), turns);
        // Such gaits lose 16 to 34 % of their distance.
        let slower_robot = robot_with(
            "own-gaits",
            &[
                ("period = 1.2\n", "period = 1.6\n"),
                (
                    "amplitude = 16.0\nstart = { LF = 0.0, RH = 0.25",
                    "amplitude = 12.5\nstart = { LF = 0.0, RH = 0.25",
                ),
            ],
        );
        let names = slow_gaits_of(slower_robot.expect("the robot is valid"));
        for gait in ["stroll", "veer-left"].into_iter().chain(turns) {
            assert!(names.iter().any(|name| name == gait), "{gait} of {names:?}");
        }
        for fast_or_still in ["stride", "nod", "wag"] {
            assert!(
                !names.iter().any(|name| name == fast_or_still),
                "{fast_or_still}"
            );
        }
    }

    #[test]
    fn a_value_that_rounds_to_zero_is_shown_without_a_minus_sign() {
        assert_eq!(
            [
                format_component(Some(-0.004), 2),
                format_component(Some(-0.006), 2),
                format_component(None, 2)
            ],
            ["+0.00", "-0.01", "-"]
        );
    }
}
