//! A complete robot.toml: measures, gaits, and the section of flash made from them.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use lizard_avr::Region;
use lizard_contact::{Drive, Ground, Motors, Prediction, Strut, Travel};
use lizard_core::numbers::gaits::{Gait, Step};
use lizard_core::numbers::section::{Content, MAX_NAME_BYTES, SPACE_BYTES};
use lizard_kinematics::{Limits, Lizard, Pose, Solution, wrap};
use toml::de::DeTable;

use crate::checks::{CheckedGait, Effort, HIGH_LINE_SHARE};
use crate::file::{self, Checked, Error, Section, UnlocatedError};
use crate::gaits::{Routine, define, routine};
use crate::measures::servo::FORWARD_TURN_SIGN;
use crate::measures::{
    self, Coil, Inputs, LegPlan, Measures, Parts, Plate, Servo, ServoType, SpeedLimits, Supplies,
};
use crate::tables::{CellMaps, CoreRobot, Tables, flash, numbers};

/// A robot of which every value and every gait has been checked.
#[derive(Debug, Clone)]
pub struct Robot {
    measures: Measures,
    gaits: Vec<CheckedGait>,
    routines: Vec<Routine>,
    content: Content,
    /// The section of flash, without the maps of certified cells, that the core reads on a host.
    section: Arc<[u8]>,
    /// The core's view of the robot, whose section is never freed; created at its first use.
    firmware: OnceLock<CoreRobot>,
}

impl PartialEq for Robot {
    fn eq(&self, other: &Self) -> bool {
        self.measures == other.measures
            && self.gaits == other.gaits
            && self.routines == other.routines
            && self.content == other.content
    }
}

impl Robot {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// Fails if the file cannot be read, is longer than [`crate::MAX_FILE_BYTES`], is not UTF-8 text, or contains a
    /// mistake.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let file = path.display().to_string();
        match file::read_text(path) {
            Ok(text) => Self::parse(&text).map_err(|error| Error { file, ..error }),
            Err(problem) => Err(UnlocatedError::new("", problem).in_file(file, None)),
        }
    }

    /// Reads and checks the text of a robot.toml. Skips a byte order mark at the start.
    ///
    /// # Errors
    /// Fails if the text contains a mistake.
    pub fn parse(text: &str) -> Result<Self, Error> {
        file::parse(text, Self::read)
    }

    /// Returns this robot with only two gaits: `stand`, and the gait that `table`, a table of robot.toml, defines.
    /// Checks that gait.
    ///
    /// # Errors
    /// Fails if the table contains a mistake, if the gait violates a limit, or if the robot's section gets too large.
    pub fn with_gait(&self, table: &str) -> Result<Self, Error> {
        /// The first gait, without which no robot is valid.
        const STAND: &str = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";
        // Parsed alone first, because the message of a syntax error may cite a second line number.
        file::parse(table, |_| Ok(()))?;
        let robot = file::parse(&format!("{STAND}{table}"), |table| {
            let root = Section::root(table, &["gait"])?;
            Self::with_measures(self.name(), self.measures.clone(), &root)
        });
        robot.map_err(|mut error| {
            let added_lines = STAND.lines().count();
            error.line = error
                .line
                .filter(|line| *line > added_lines)
                .map(|line| line - added_lines);
            error
        })
    }

    /// Reads and checks all tables of a robot.toml.
    fn read(table: &DeTable) -> Checked<Self> {
        let root = Section::root(table, &TOP_LEVEL_KEYS)?;
        let name = read_name(&root)?;
        let mut measures = Measures::read(&root)?;
        let robot = Self::with_measures(name, measures.clone(), &root)?;
        let Some(rail) = &mut measures.supplies.rail else {
            return Ok(robot);
        };
        let (ground, motors) = (robot.ground(), robot.motors());
        let effort_of = |gait: &CheckedGait| Effort::of(gait, ground, &motors);
        let efforts: Vec<Effort> = robot.gaits().iter().map(effort_of).collect();
        let volts = robot.servo_type().volts;
        let shares = efforts.iter().map(|effort| effort.line_share(1.0, 1.0));
        rail.set_slow_threshold(shares.fold(0.0, f64::max), HIGH_LINE_SHARE, volts);
        // The torque-speed line shrinks in proportion to the supply, so a share of the line at one supply is the
        // whole line at that share of the supply.
        let [_, stop, _] = rail.thresholds;
        let paces = efforts
            .iter()
            .map(|effort| effort.max_sustainable_pace(HIGH_LINE_SHARE * stop / volts));
        measures.supplies.limit_pace(paces.fold(1.0, f64::min));
        Self::with_measures(name, measures, &root)
    }

    /// Reads and checks the gaits of a robot with these measures, and computes its tables.
    fn with_measures(name: &str, measures: Measures, root: &Section) -> Checked<Self> {
        let gaits = define::read_gaits(root, &measures)?;
        let names: Vec<&str> = gaits.iter().map(|gait| gait.name.as_str()).collect();
        let routines = routine::read_routines(root, &names, &measures.inputs)?;
        let tables = Tables::new(&gaits)?;
        let content = numbers::section_content(name, &measures, &tables, &routines);
        let tables = Arc::new(tables);
        let length = content.section_length();
        if length > usize::from(SPACE_BYTES) {
            return Err(size_error(&content, length));
        }
        let section: Arc<[u8]> = content.section_bytes().into();
        let flash = Region::new(&section);
        let core_error = || {
            let message =
                "the firmware would not take this robot: its numbers cannot be worked with";
            UnlocatedError::new("", message)
        };
        let core_robot =
            lizard_core::numbers::robot::Robot::unchecked(flash).ok_or_else(core_error)?;
        let check_gait =
            |(index, gait)| CheckedGait::new(gait, index, &tables, &measures, &core_robot);
        let gaits = gaits.into_iter().enumerate().map(check_gait);
        let gaits = gaits.collect::<Checked<_>>()?;
        lizard_core::numbers::robot::Robot::open(flash).map_err(|_| core_error())?;
        Ok(Self {
            gaits,
            routines,
            measures,
            content,
            section,
            firmware: OnceLock::new(),
        })
    }

    /// The robot's name, which the firmware prints when it starts.
    pub fn name(&self) -> &str {
        &self.content.name
    }

    /// Makes the robot's section of flash, at most [`SPACE_BYTES`] bytes. It contains the maps of certified cells if
    /// there is room for them; without them the firmware computes the distance from the limits at every pose.
    pub fn section(&self) -> Vec<u8> {
        self.section_with_maps()
            .unwrap_or_else(|| self.content.section_bytes())
    }

    /// True if the section has room for the maps of certified cells.
    pub fn has_room_for_maps(&self) -> bool {
        self.section_with_maps().is_some()
    }

    /// An upper bound for the CPU cycles of the console's search for the name of the last gait or routine. A test
    /// compares the bound with the simulated UNO.
    #[must_use]
    pub fn max_search_cycles(&self) -> usize {
        const CYCLES_PER_SEARCH: usize = 6_000;
        const CYCLES_PER_NAME: usize = 1_400;
        const CYCLES_PER_CHARACTER: usize = 92;
        let names = self.gaits.iter().map(CheckedGait::name);
        let names = names.chain(self.routines.iter().map(Routine::name));
        let cycles_of = |name: &str| CYCLES_PER_NAME + CYCLES_PER_CHARACTER * name.len();
        CYCLES_PER_SEARCH + names.map(cycles_of).sum::<usize>()
    }

    /// Makes the section with the maps; `None` if it is longer than [`SPACE_BYTES`].
    fn section_with_maps(&self) -> Option<Vec<u8>> {
        let CellMaps {
            head,
            tail,
            left,
            right,
        } = self.cell_maps();
        let content = Content {
            maps: [head, tail, left, right],
            ..self.content.clone()
        };
        Some(content.section_bytes()).filter(|section| section.len() <= usize::from(SPACE_BYTES))
    }

    /// The robot's numbers as stored in its section.
    pub const fn content(&self) -> &Content {
        &self.content
    }

    /// The lengths of all links.
    pub fn lizard(&self) -> &Lizard {
        &self.measures.lizard
    }

    /// The servos A1, A2, A3, A4.
    pub fn servos(&self) -> &[Servo; 4] {
        &self.measures.servos
    }

    /// The type of the servos, with their supply.
    pub fn servo_type(&self) -> &ServoType {
        &self.measures.servo_type
    }

    /// The supply voltages of the reports, V: the servos' own, the one at which the robot slows down,
    /// and the one at which it stops.
    pub fn reported_volts(&self) -> [f64; 3] {
        let supplies = self.supplies();
        let [slow, stop, _] = supplies.rail.map_or(supplies.board, |rail| rail.thresholds);
        [self.servo_type().volts, slow, stop]
    }

    /// The servos' motors and the friction of the joints, at the servos' own supply.
    pub fn motors(&self) -> Motors {
        self.motors_at(self.servo_type().volts)
    }

    /// The servos' motors and the friction of the joints, at a supply voltage in V.
    pub fn motors_at(&self, volts: f64) -> Motors {
        self.motors_of_type(self.servo_type(), volts)
    }

    /// The motors of another type of servo at a supply voltage in V, and the friction of the joints.
    pub fn motors_of_type(&self, servo_type: &ServoType, volts: f64) -> Motors {
        let motor_of = |settings: &Servo| servo_type.motor(volts, settings.us_per_degree);
        Motors {
            per_servo: self.servos().each_ref().map(motor_of),
            joints: self.measures.joints,
        }
    }

    /// Limits of margins and sliders for every pose.
    pub fn limits(&self) -> &Limits {
        &self.measures.limits
    }

    /// Speed limits of the servos.
    pub fn speed_limits(&self) -> &SpeedLimits {
        &self.measures.speed_limits
    }

    /// Thresholds of the board's supply and of the servos' rail.
    pub fn supplies(&self) -> &Supplies {
        &self.measures.supplies
    }

    /// The pins of the inputs, if any.
    pub fn inputs(&self) -> &Inputs {
        &self.measures.inputs
    }

    /// Dimensions of the parts to print and to buy.
    pub fn parts(&self) -> &Parts {
        &self.measures.parts
    }

    /// The drive between each servo's link and its leg.
    pub fn drive(&self) -> &Drive {
        &self.ground().drive
    }

    /// A slotted strut of this robot's size, with a spring of this force (N) and rate (N/mm).
    pub fn strut_with(&self, force: f64, rate: f64) -> Strut {
        Strut {
            force,
            rate,
            ..self.strut_with_coil(&self.parts().spring)
        }
    }

    /// A slotted strut of this robot's size with this coil spring.
    pub fn strut_with_coil(&self, coil: &Coil) -> Strut {
        measures::strut_with_coil(
            self.legs(),
            self.measures.neutral_angles(),
            self.parts(),
            coil,
        )
    }

    /// The length, inside its hooks, of a spring mounted in a strut, mm.
    pub fn mounted_spring_length(&self) -> f64 {
        measures::mounted_spring_length(self.legs(), self.parts())
    }

    /// The legs seen from above, in servo order.
    pub fn legs(&self) -> &[LegPlan; 4] {
        &self.measures.legs
    }

    /// The chassis seen from above.
    pub fn plate(&self) -> Plate {
        Plate::new(self.legs(), self.parts())
    }

    /// The contact model of this robot on its floor.
    pub fn ground(&self) -> &Ground {
        &self.measures.ground
    }

    /// The gaits in the order of the file; the first is `stand`.
    pub fn gaits(&self) -> &[CheckedGait] {
        &self.gaits
    }

    /// The routines in the order of the file.
    pub fn routines(&self) -> &[Routine] {
        &self.routines
    }

    /// Finds a routine by its name, with hyphens or spaces between the words.
    pub fn routine(&self, name: &str) -> Option<&Routine> {
        let name = name.replace(' ', "-");
        self.routines.iter().find(|routine| routine.name() == name)
    }

    /// Finds a gait by its name, with hyphens or spaces between the words.
    pub fn gait(&self, name: &str) -> Option<&CheckedGait> {
        let name = name.replace(' ', "-");
        self.gaits.iter().find(|gait| gait.name() == name)
    }

    /// Finds the gait that a console line names. A space and a number of cycles may follow the name.
    pub fn gait_of_line(&self, line: &str) -> Option<&CheckedGait> {
        let name = line.trim_end_matches(|c: char| c.is_ascii_digit());
        let counted_gait = || name.ends_with(' ').then(|| self.gait(name.trim_end()))?;
        self.gait(line).or_else(counted_gait)
    }

    /// The core's view of this robot on a host, without the maps of certified cells, which change no decision.
    pub fn core(&self) -> lizard_core::numbers::robot::Robot<'_> {
        // The section was validated when the robot was read, so this does not fail.
        lizard_core::numbers::robot::Robot::unchecked(Region::new(&self.section))
            .unwrap_or(lizard_core::numbers::robot::Robot::NONE)
    }

    /// The core's view of this robot for a simulation of the core. Its section stays in memory until the program
    /// ends; the view from [`Robot::core`] borrows the section from this robot instead.
    pub fn firmware(&self) -> &CoreRobot {
        self.firmware
            .get_or_init(|| CoreRobot::unchecked(flash(&self.section)).unwrap_or(CoreRobot::NONE))
    }

    /// Returns the robot with its routines changed as if no contact ever closed: a wait takes one frame, a gait that
    /// only a contact ends takes one cycle, and every other step takes its count or time.
    #[must_use]
    pub fn without_contacts(&self) -> Self {
        let mut content = self.content.clone();
        for step in &mut content.steps {
            if step.count == Step::ENDLESS {
                step.count = 1;
                if step.kind == Step::FRAMES {
                    step.kind = Step::CYCLES;
                }
            }
        }
        Self {
            section: content.section_bytes().into(),
            content,
            firmware: OnceLock::new(),
            ..self.clone()
        }
    }

    /// Computes the cells in which the guard is proven to accept every pose.
    pub fn cell_maps(&self) -> CellMaps {
        CellMaps::new(self.lizard(), &self.content)
    }

    /// The neutral pose of the servos.
    pub fn neutral_pose(&self) -> Pose {
        self.measures.neutral_angles().into()
    }

    /// Solves the robot at servo angles (deg, chassis frame, servo order). Returns `None` if a servo does not reach
    /// its angle or the pose violates a limit.
    pub fn solve_if_allowed(&self, angles: [f64; 4]) -> Option<Solution> {
        let mut servos = self.servos().iter().zip(angles);
        if !servos.all(|(servo, angle)| servo.reaches(angle)) {
            return None;
        }
        let solution = self.lizard().solve(&angles.into()).ok()?;
        self.limits().is_safe(&solution).then_some(solution)
    }

    /// Converts servo angles (deg, chassis frame) to the legs' sweeps (deg, positive if the foot is forward), both
    /// in servo order.
    pub fn sweeps(&self, angles: [f64; 4]) -> [f64; 4] {
        let neutral_angles = self.measures.neutral_angles();
        std::array::from_fn(|i| FORWARD_TURN_SIGN[i] * wrap(angles[i] - neutral_angles[i]))
    }

    /// Predicts the movement of the body while the servos go through these angles (deg, chassis frame, servo order), by
    /// the contact model with rigid legs. Returns a result even if it depends on differences between the pads that
    /// cannot be measured.
    pub fn predict_travel(&self, angles: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        self.ground()
            .with_rigid_drive()
            .travel(angles.into_iter().map(|angles| self.sweeps(angles)))
    }

    /// Predicts the movement of one cycle of a gait on the robot's own floor.
    pub fn predict(&self, gait: &CheckedGait) -> Prediction {
        gait.predict(self.ground())
    }
}

/// The top-level keys of the file: its tables, and `name`.
pub(crate) const TOP_LEVEL_KEYS: [&str; 14] = [
    "name", "links", "leg", "servo", "joints", "limits", "supply", "input", "body", "feet",
    "ground", "parts", "gait", "routine",
];

/// Reads the robot's name from the top of the file.
fn read_name<'a>(root: &Section<'a>) -> Checked<&'a str> {
    if !root.has_key("name") {
        return Ok("robot");
    }
    let name = root.text("name")?;
    let is_allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if name.is_empty() || name.len() > MAX_NAME_BYTES || !name.chars().all(is_allowed) {
        let message =
            format!("must be at most {MAX_NAME_BYTES} lower-case letters, digits and dashes");
        return Err(UnlocatedError::new("name", message));
    }
    Ok(name)
}

/// Makes the error for a robot whose section has too many `bytes`. The message says how many bytes the waveforms, gaits
/// and routines take.
fn size_error(content: &Content, bytes: usize) -> UnlocatedError {
    let excess_bytes = bytes - usize::from(SPACE_BYTES);
    let wave_count = content.waves.len();
    let wave_bytes = std::mem::size_of_val(content.waves.as_slice());
    let gait_count = content.gaits.len();
    let gait_bytes = gait_count * size_of::<Gait>() + content.names.len();
    let routine_count = content
        .gaits
        .iter()
        .filter(|gait| gait.is_routine())
        .count();
    let step_bytes = std::mem::size_of_val(content.steps.as_slice());
    let routine_text = match routine_count {
        0 => String::new(),
        _ => format!(", {routine_count} of them routines, whose steps take {step_bytes}"),
    };
    let message = format!(
        "the robot takes {excess_bytes} bytes more than the {SPACE_BYTES} that the board has for it; {wave_count} waveforms take {wave_bytes}, {gait_count} gaits and their names {gait_bytes}{routine_text}: leave out gaits, first those whose waveform no other has"
    );
    UnlocatedError::new("gait", message)
}
