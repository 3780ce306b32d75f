//! The report that `make firmware` and `lizard gaits` print: the tables of gaits and routines, and notes.

use std::fmt;

use lizard_contact::{GroundContact, Prediction, Stance};
use lizard_core::numbers::section::REGION_BYTES;

use crate::checks::{Audit, CheckedGait, Effort, HIGH_UTILISATION, TableError};
use crate::config::servo::SERVO_NAMES;
use crate::reports::drive_effect::DriveEffect;
use crate::reports::routine_row::RoutineRow;
use crate::robot::Robot;

/// A row of the gait table: the checks and predictions of one gait.
#[derive(Debug, Clone, PartialEq)]
pub struct GaitRow {
    /// The gait's name in robot.toml.
    pub name: String,
    /// Duration of a cycle at full speed, s.
    pub period: f64,
    /// Smallest margins, range of the slider travels, and highest speed.
    pub audit: Audit,
    /// Error of the gait's tables over all 65 536 phases.
    pub table_error: TableError,
    /// Displacement over one cycle with ideal servos, according to the contact model.
    pub movement: Prediction,
    /// Effect of the legs' drive; `None` if the legs are rigid without play.
    pub drive_effect: Option<DriveEffect>,
    /// Highest utilisation of any servo's torque-speed line, at the servos' supply voltage.
    pub utilisation: f64,
    /// Displacement over one cycle with the servos' limited torque and speed.
    pub movement_with_servos: Prediction,
    /// True if the robot would tip over at a phase of the gait.
    pub tips_over: bool,
}

/// True if a robot on this ground would tip over at a phase of a gait: its centre of mass is not between its feet.
fn tips_over(gait: &CheckedGait, ground: &GroundContact) -> bool {
    /// Number of phases that are checked.
    const PHASE_COUNT: u16 = 256;
    (0..PHASE_COUNT).any(|i| {
        let sweeps = gait.sweeps(f64::from(i) / f64::from(PHASE_COUNT));
        let feet = ground.legs.foot_positions(sweeps);
        // If the body balances, its feet together carry four mean loads. If it tips over, a foot would have to pull:
        // the load of this foot is given as 0, and the others carry more.
        let loads = Stance::LEVEL.relative_loads(&ground.body, feet);
        loads.iter().sum::<f64>() > 4.0 + 1e-6
    })
}

impl GaitRow {
    /// True if the gait moves the robot, but its fastest servo stays below [`SLOW_SPEED_DEG_S`].
    fn is_slow(&self) -> bool {
        /// Smallest forward speed at which a gait counts as moving the robot, mm/s.
        const MIN_SPEED_MM_S: f64 = 5.0;
        /// Smallest turn rate at which a gait counts as moving the robot, deg/s.
        const MIN_TURN_RATE_DEG_S: f64 = 2.0;
        let rate = |component: Option<f64>| component.unwrap_or_default().abs() / self.period;
        let movement = &self.movement;
        let moves_robot =
            rate(movement.forward) >= MIN_SPEED_MM_S || rate(movement.turn) >= MIN_TURN_RATE_DEG_S;
        moves_robot && self.audit.peak_speed.speed < SLOW_SPEED_DEG_S
    }
}

/// The gait and routine tables of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Rows of the gait table, in the order of the file.
    pub gait_rows: Vec<GaitRow>,
    /// Rows of the routine table, in the order of the file.
    pub routine_rows: Vec<RoutineRow>,
    /// Hash that identifies the robot's parameters in flash.
    pub hash: u32,
    /// Number of waveforms that the gaits share.
    pub waveform_count: usize,
    /// Bytes of the robot's section in flash; at most [`REGION_BYTES`].
    pub section_bytes: usize,
    /// True if the console's search for a gait's name may delay a frame.
    pub may_delay_frame: bool,
    /// The robot's name.
    pub name: String,
}

/// Number of CPU cycles that the main loop may spend on a console line without delaying a frame (docs/firmware.md).
const MAX_SEARCH_CYCLES: usize = 34_000;

/// The note about a robot whose console may need more than [`MAX_SEARCH_CYCLES`] to find a gait's name.
const LONG_SEARCH_NOTE: &str = "many gaits: `cal` or a command with a gait's name may delay a frame by 20 ms; \
     fewer gaits or shorter names avoid the delay\n";

/// The note that explains a dash in place of a prediction.
pub const UNDETERMINED_NOTE: &str = "- undetermined: two feet pull against the other two, so tiny differences between the pads decide\n";

/// A gait counts as slow if its fastest servo stays below this speed. At an edge of 2 mm in MuJoCo, `walk` and similar
/// gaits keep nine tenths of their distance, but slow gaits lose up to a third.
const SLOW_SPEED_DEG_S: f64 = 200.0;

/// The note on the assumptions about routines with inputs.
pub const OPEN_INPUTS_NOTE: &str = "routines with inputs are computed with all inputs open: each wait lasts one frame, and each gait without an end one cycle\n";

impl Report {
    /// Computes the errors of a robot's tables and predicts its gaits and routines. Takes up to a few seconds.
    pub fn compute(robot: &Robot) -> Self {
        let (ground, motors) = (robot.ground(), robot.motors());
        let compute_row = |gait: &CheckedGait| {
            let movement = robot.predict(gait);
            GaitRow {
                name: gait.name().to_string(),
                period: gait.period(),
                audit: *gait.audit(),
                table_error: gait.table_error(),
                movement,
                drive_effect: DriveEffect::compute(gait, ground),
                utilisation: Effort::simulate(gait, ground, &motors).utilisation(1.0, 1.0),
                movement_with_servos: movement
                    .keep_determined(gait.simulate_driven_cycle(ground, &motors, 1.0)),
                tips_over: tips_over(gait, ground),
            }
        };
        let core = robot.core();
        let simulate_routine = |routine| RoutineRow::simulate(robot, routine);
        Self {
            gait_rows: robot.gaits().iter().map(compute_row).collect(),
            routine_rows: robot.routines().iter().map(simulate_routine).collect(),
            hash: core.hash(),
            waveform_count: core.waves().len(),
            section_bytes: robot.section().len(),
            may_delay_frame: robot.max_search_cycles() > MAX_SEARCH_CYCLES,
            name: robot.name().to_string(),
        }
    }

    /// Writes the table of routines, if there are any.
    fn write_routines(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.routine_rows.is_empty() {
            return Ok(());
        }
        let width = column_width(self.routine_rows.iter().map(|row| row.name.as_str()));
        writeln!(
            f,
            "\n{:width$}                    ideal servos, mm and deg   with real servos",
            ""
        )?;
        writeln!(
            f,
            "{:width$} steps   repeat      s   ahead   left    turn   ahead   left    turn",
            "routine"
        )?;
        for row in &self.routine_rows {
            let round_count = row.round_count.map(|count| count.to_string());
            let repeat = round_count.unwrap_or("for ever".to_string());
            write!(
                f,
                "{:<width$} {:>5} {repeat:>8} {:>6.1}",
                row.name, row.step_count, row.seconds
            )?;
            for prediction in [row.movement, row.movement_with_servos] {
                let [forward, left, turn] = [prediction.forward, prediction.left, prediction.turn]
                    .map(|component| format_component(component, 1));
                write!(f, " {forward:>7} {left:>6} {turn:>7}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

/// Formats a number of things, in the plural unless there is one.
fn format_count(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(
            f,
            "{} in {}, {} of {} bytes of flash, robot {} {:08x}\n",
            format_count(self.gait_rows.len(), "gait"),
            format_count(self.waveform_count, "waveform"),
            self.section_bytes,
            REGION_BYTES,
            self.name,
            self.hash
        )?;
        let has_flexible_drive = self.gait_rows.iter().any(|row| row.drive_effect.is_some());
        let width = column_width(self.gait_rows.iter().map(|row| row.name.as_str()));
        let drive_headings = match has_flexible_drive {
            true => ["   drive, deg and %", "      lag % of rigid"],
            false => [""; 2],
        };
        writeln!(
            f,
            "{:width$}  cycle      fastest  table error, deg      smallest margins       slider, mm ideal servos, mm and deg   with real servos{}",
            "", drive_headings[0]
        )?;
        writeln!(
            f,
            "{:width$}      s  deg/s servo      max     rms  type-2 type-1    leg    least   most    ahead   left    turn   line  ahead   turn{}",
            "gait", drive_headings[1]
        )?;
        for row in &self.gait_rows {
            let (audit, table_error) = (&row.audit, &row.table_error);
            let (movement, movement_with_servos) = (&row.movement, &row.movement_with_servos);
            let (min_stroke, max_stroke) = audit.stroke_range;
            write!(
                f,
                "{:<width$} {:>6.2} {:>6.1} {:>5}   {:>6.4}  {:>6.4}  {:>6.3} {:>6.3} {:>6.3}   {:>+6.1} {:>+6.1}  ",
                row.name,
                row.period,
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
                "{:>7} {:>6} {:>7}  {:>5.2} {:>6} {:>6}",
                format_component(movement.forward, 2),
                format_component(movement.left, 2),
                format_component(movement.turn, 2),
                row.utilisation,
                format_component(movement_with_servos.forward, 1),
                format_component(movement_with_servos.turn, 1)
            )?;
            if let Some(effect) = &row.drive_effect {
                let fraction = effect.fraction_of_rigid;
                let percent = fraction.map(|fraction| format!("{:.0}", 100.0 * fraction));
                let percent = percent.as_deref().unwrap_or("-");
                write!(f, "   {:>6.2} {percent:>10}", effect.max_lag)?;
            }
            writeln!(f)?;
        }
        self.write_routines(f)?;
        if self.routine_rows.iter().any(|row| row.has_inputs) {
            write!(f, "\n{OPEN_INPUTS_NOTE}")?;
        }
        let movements = self.gait_rows.iter().map(|row| &row.movement);
        let mut movements = movements.chain(self.routine_rows.iter().map(|row| &row.movement));
        if movements.any(|movement| !movement.is_determined()) {
            write!(f, "\n{UNDETERMINED_NOTE}")?;
        }
        let list_names = |is_listed: fn(&&GaitRow) -> bool| {
            let rows = self.gait_rows.iter().filter(is_listed);
            let names: Vec<_> = rows.map(|row| row.name.as_str()).collect();
            names.join(", ")
        };
        let tipping_names = list_names(|row| row.tips_over);
        if !tipping_names.is_empty() {
            writeln!(
                f,
                "\ntipping gaits: {tipping_names}\nAt a phase of these gaits the centre of mass is not between the feet, \
                 and the predictions do not hold.\nMove the battery so that body.centre is nearer to the middle."
            )?;
        }
        let slow_names = list_names(|row| row.is_slow());
        if !slow_names.is_empty() {
            writeln!(
                f,
                "\nslow gaits: {slow_names}\nGaits below {SLOW_SPEED_DEG_S:.0} deg/s lose up to a third of their distance and half of their turn at an \
                 edge of 2 mm (docs/judges.md)."
            )?;
        }
        let has_little_reserve = |row: &&GaitRow| row.utilisation >= HIGH_UTILISATION;
        for row in self.gait_rows.iter().filter(has_little_reserve) {
            let warning = format_reserve_warning(&row.name, row.utilisation);
            write!(f, "\n{warning}")?;
        }
        if self.may_delay_frame {
            write!(f, "\n{LONG_SEARCH_NOTE}")?;
        }
        Ok(())
    }
}

/// Formats the warning for a gait that leaves its servos little or no reserve.
fn format_reserve_warning(name: &str, utilisation: f64) -> String {
    let consequence = match utilisation < 1.0 {
        true => "little torque is left for play, cold gears or a long wire",
        false => "above 1 a servo falls behind its pulses",
    };
    format!(
        "{name} uses {utilisation:.2} of its servos' torque-speed line: {consequence}; see `lizard gaits --servos`\n"
    )
}

/// The width of a column of names, at least 12 characters.
pub(crate) fn column_width<'a>(names: impl Iterator<Item = &'a str>) -> usize {
    names.map(str::len).fold(12, usize::max)
}

/// Formats a component of a prediction with its sign, or as a dash if it is undetermined.
pub(crate) fn format_component(component: Option<f64>, decimals: usize) -> String {
    match component {
        Some(value) => format!("{:+.decimals$}", round_to(value, decimals as i32)),
        None => "-".to_string(),
    }
}

/// Formats a turn, deg; empty if it rounds to zero.
pub(crate) fn format_turn(turn: Option<f64>) -> String {
    match turn {
        Some(turn) if turn.abs() < 0.05 => String::new(),
        turn => format_component(turn, 1),
    }
}

/// Rounds a value to this number of decimals. A zero loses its sign.
fn round_to(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    // Adding positive zero removes the sign of a negative zero.
    (value * scale).round() / scale + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{robot, valid_robot_with};

    #[test]
    fn columns_are_aligned_for_names_of_any_length() {
        for name in ["paper", "own-gaits"] {
            let text = Report::compute(&robot(name)).to_string();
            let rows = text.lines().skip(2).take_while(|line| !line.is_empty());
            let lengths: Vec<usize> = rows.map(str::len).collect();
            assert!(lengths.len() > 10, "{text}");
            assert!(
                lengths[1..].iter().all(|length| *length == lengths[1]),
                "{text}"
            );
        }
    }

    #[test]
    fn gaits_that_lose_distance_at_an_edge_are_reported_as_slow() {
        let find_slow_gaits = |robot: Robot| {
            let report = Report::compute(&robot);
            let rows = report.gait_rows.iter().filter(|row| row.is_slow());
            let names: Vec<_> = rows.map(|row| row.name.clone()).collect();
            let text = report.to_string();
            let mut lines = text.lines();
            let note = lines.find_map(|line| line.strip_prefix("slow gaits: "));
            assert_eq!(note.unwrap_or_default(), names.join(", "), "{text}");
            names
        };
        for name in ["paper", "large", "unequal", "grain"] {
            assert!(find_slow_gaits(robot(name)).is_empty(), "{name}");
        }
        let slow_turns = [
            "turn-slowly-on-the-spot-all-the-way-to-the-left",
            "turn-slowly-to-the-right",
        ];
        assert_eq!(find_slow_gaits(robot("own-gaits")), slow_turns);
        // Such gaits lose 16 to 34 % of their distance.
        let stroll_with = |mm: &str| format!("amplitude = {mm}\nstart = {{ LF = 0.0, RH = 0.25");
        let [old, new] = ["16.0", "12.5"].map(stroll_with);
        let changes = [("period = 1.2\n", "period = 1.6\n"), (&*old, &*new)];
        let names = find_slow_gaits(valid_robot_with("own-gaits", &changes));
        let is_slow = |gait: &str| names.iter().any(|name| name == gait);
        for gait in ["stroll", "veer-left"].into_iter().chain(slow_turns) {
            assert!(is_slow(gait), "{gait} is missing from {names:?}");
        }
        for fast_or_still in ["stride", "nod", "wag"] {
            assert!(!is_slow(fast_or_still), "{fast_or_still}");
        }
    }

    #[test]
    fn gaits_with_which_the_robot_tips_over_are_reported() {
        let find_tipping_gaits = |centre: &str| {
            let body = format!("mass = 435.0\ncentre = {centre}");
            let report = Report::compute(&valid_robot_with("paper", &[("mass = 435.0", &body)]));
            let text = report.to_string();
            let mut lines = text.lines();
            let names = lines.find_map(|line| line.strip_prefix("tipping gaits: "));
            names.unwrap_or_default().to_owned()
        };
        assert_eq!(find_tipping_gaits("[0.0, 0.0]"), "");
        // All legs of crawl swing back by 20 deg together, which moves the front feet from 55 to 39.6 mm.
        let names = find_tipping_gaits("[45.0, 0.0]");
        let tips = |gait: &str| names.split(", ").any(|name| name == gait);
        assert!(tips("crawl") && !tips("stand") && !tips("walk"), "{names}");
    }

    #[test]
    fn a_value_that_rounds_to_zero_is_shown_without_a_minus_sign() {
        let components = [Some(-0.004), Some(-0.006), None];
        let texts = components.map(|component| format_component(component, 2));
        assert_eq!(texts, ["+0.00", "-0.01", "-"]);
    }
}
