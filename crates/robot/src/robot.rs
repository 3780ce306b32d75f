//! A complete robot.toml: configuration, gaits, and the section of flash computed from them.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use lizard_avr::Region;
use lizard_contact::{Drive, GroundContact, Motors, Prediction, Strut, Travel};
use lizard_core::numbers::gaits::{Gait, Step};
use lizard_core::numbers::section::{Content, MAX_NAME_BYTES, REGION_BYTES};
use lizard_kinematics::{Limits, Lizard, Pose, Solution, wrap};
use toml::de::DeTable;

use crate::checks::{CheckedGait, Effort, HIGH_UTILISATION};
use crate::config::servo::FORWARD_TURN_SIGN;
use crate::config::{
    self, Inputs, LegPlan, Parts, Plate, RobotConfig, Servo, ServoType, SpeedLimits, Supplies,
};
use crate::file::{self, Error, ReadResult, Table};
use crate::gaits::{Routine, define, routine};
use crate::tables::{CellMaps, CoreRobot, Tables, keep_section, numbers};

/// A robot, all of whose values and gaits have been checked.
#[derive(Debug, Clone)]
pub struct Robot {
    pub(crate) config: RobotConfig,
    gaits: Vec<CheckedGait>,
    routines: Vec<Routine>,
    content: Content,
    /// The section of flash that the core reads on a host, without the maps of certified cells.
    section: Arc<[u8]>,
    /// The core's view of the robot, whose section is never freed; created at first use.
    firmware: OnceLock<CoreRobot>,
}

impl PartialEq for Robot {
    fn eq(&self, other: &Self) -> bool {
        self.config == other.config
            && self.gaits == other.gaits
            && self.routines == other.routines
            && self.content == other.content
    }
}

impl Robot {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// Fails if the file cannot be read, is longer than [`crate::MAX_FILE_BYTES`], is not UTF-8 text, or is invalid.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        Self::parse(&Self::read_text(path)?).map_err(|error| error.in_file(path))
    }

    /// Reads the text of a robot.toml.
    ///
    /// # Errors
    /// Fails if the file cannot be read, is longer than [`crate::MAX_FILE_BYTES`], or is not UTF-8 text.
    pub fn read_text(path: &Path) -> Result<String, Error> {
        file::read_text(path).map_err(|problem| Error::new("", problem).in_file(path))
    }

    /// Reads and checks the text of a robot.toml. Skips a byte order mark at the start.
    ///
    /// # Errors
    /// Fails if the text is invalid.
    pub fn parse(text: &str) -> Result<Self, Error> {
        file::parse(text, Self::read)
    }

    /// Returns this robot with only two gaits: `stand`, and the gait that `table`, a table of robot.toml, defines.
    /// Checks the gait.
    ///
    /// # Errors
    /// Fails if the table is invalid, if the gait violates a limit, or if the robot's section is too large.
    pub fn with_gait(&self, table: &str) -> Result<Self, Error> {
        // The table is first parsed alone: below, the second line number in a message would not be corrected.
        file::parse(table, |_| Ok(()))?;
        let robot = file::parse(&format!("{STAND}{table}"), |document| {
            let root = Table::root(document, &["gait"])?;
            Self::with_config(self.name(), self.config.clone(), &root)
        });
        robot.map_err(|mut error| {
            let added_line_count = STAND.lines().count();
            let line = error.line.filter(|line| *line > added_line_count);
            error.line = line.map(|line| line - added_line_count);
            error
        })
    }

    /// Reads and checks all tables of a robot.toml.
    fn read(table: &DeTable) -> ReadResult<Self> {
        let root = Table::root(table, &TOP_LEVEL_KEYS)?;
        let name = read_name(&root)?;
        let mut config = RobotConfig::read(&root)?;
        let robot = Self::with_config(name, config.clone(), &root)?;
        let Some(rail) = &mut config.supplies.rail else {
            return Ok(robot);
        };
        let (ground, motors) = (robot.ground(), robot.motors());
        let simulate = |gait: &CheckedGait| Effort::simulate(gait, ground, &motors);
        let efforts: Vec<Effort> = robot.gaits().iter().map(simulate).collect();
        let volts = robot.servo_type().supply_volts;
        let utilisations = efforts.iter().map(|effort| effort.utilisation(1.0, 1.0));
        rail.derive_slow_threshold(utilisations.fold(0.0, f64::max), HIGH_UTILISATION, volts);
        // The torque-speed line is proportional to the supply voltage. A utilisation limit is therefore equivalent to a
        // supply voltage that is lower by the same factor.
        let [_, stop, _] = rail.thresholds;
        let paces = efforts
            .iter()
            .map(|effort| effort.find_max_pace(HIGH_UTILISATION * stop / volts));
        config.supplies.set_slow_pace(paces.fold(1.0, f64::min));
        Self::with_config(name, config, &root)
    }

    /// Reads and checks the gaits of a robot with this configuration, and computes its tables.
    fn with_config(name: &str, config: RobotConfig, root: &Table) -> ReadResult<Self> {
        let gaits = define::read_gaits(root, &config)?;
        let names: Vec<&str> = gaits.iter().map(|gait| gait.name.as_str()).collect();
        let routines = routine::read_routines(root, &names, &config.inputs)?;
        let tables = Tables::new(&gaits)?;
        let content = numbers::build_content(name, &config, &tables, &routines);
        let tables = Arc::new(tables);
        let length = content.section_length();
        if length > usize::from(REGION_BYTES) {
            return Err(size_error(&content, length));
        }
        let section: Arc<[u8]> = content.section_bytes().into();
        let flash = Region::new(&section);
        let core_error = || {
            let message = "the firmware would reject this robot: its numbers are invalid";
            Error::new("", message)
        };
        let core_robot =
            lizard_core::numbers::robot::Robot::unchecked(flash).ok_or_else(core_error)?;
        let check_gait =
            |(index, gait)| CheckedGait::new(gait, index, &tables, &config, &core_robot);
        let gaits = gaits.into_iter().enumerate().map(check_gait);
        let gaits = gaits.collect::<ReadResult<_>>()?;
        lizard_core::numbers::robot::Robot::open(flash).map_err(|_| core_error())?;
        Ok(Self {
            gaits,
            routines,
            config,
            content,
            section,
            firmware: OnceLock::new(),
        })
    }

    /// The robot's name, which the firmware prints when it starts.
    pub fn name(&self) -> &str {
        &self.content.name
    }

    /// Builds the robot's section of flash, at most [`REGION_BYTES`] bytes. It contains the maps of certified cells if
    /// there is room; without the maps, the firmware computes the distance from the limits at every pose.
    pub fn section(&self) -> Vec<u8> {
        self.section_with_maps()
            .unwrap_or_else(|| self.content.section_bytes())
    }

    /// True if the section has room for the maps of certified cells.
    pub fn has_room_for_maps(&self) -> bool {
        self.section_with_maps().is_some()
    }

    /// An upper bound on the CPU cycles in which the console finds the name of the last gait or routine. A test
    /// compares the bound with the simulated UNO.
    #[must_use]
    pub fn max_search_cycles(&self) -> usize {
        const CYCLES_PER_SEARCH: usize = 6_000;
        const CYCLES_PER_NAME: usize = 1_400;
        const CYCLES_PER_CHARACTER: usize = 92;
        let names = self.gaits.iter().map(CheckedGait::name);
        let names = names.chain(self.routines.iter().map(Routine::name));
        let search_cycles = |name: &str| CYCLES_PER_NAME + CYCLES_PER_CHARACTER * name.len();
        CYCLES_PER_SEARCH + names.map(search_cycles).sum::<usize>()
    }

    /// Builds the section with the maps; `None` if it is longer than [`REGION_BYTES`].
    fn section_with_maps(&self) -> Option<Vec<u8>> {
        let maps = self.cell_maps();
        let content = Content {
            maps: [maps.head, maps.tail, maps.left, maps.right],
            ..self.content.clone()
        };
        Some(content.section_bytes()).filter(|section| section.len() <= usize::from(REGION_BYTES))
    }

    /// The robot's numbers as stored in its section.
    pub const fn content(&self) -> &Content {
        &self.content
    }

    /// The lengths of all links.
    pub fn lizard(&self) -> &Lizard {
        &self.config.lizard
    }

    /// The servos A1, A2, A3, A4.
    pub fn servos(&self) -> &[Servo; 4] {
        &self.config.servos
    }

    /// The type of the servos, with their supply voltage.
    pub fn servo_type(&self) -> &ServoType {
        &self.config.servo_type
    }

    /// The supply voltages of the reports, V: the servos' supply voltage, and the thresholds `slow` and `stop`.
    pub fn reported_volts(&self) -> [f64; 3] {
        let supplies = self.supplies();
        let [slow, stop, _] = supplies
            .rail
            .map_or(supplies.board_thresholds, |rail| rail.thresholds);
        [self.servo_type().supply_volts, slow, stop]
    }

    /// The servos' motors and the joint friction, at the servos' supply voltage.
    pub fn motors(&self) -> Motors {
        self.motors_at_volts(self.servo_type().supply_volts)
    }

    /// The servos' motors and the joint friction, at a supply voltage in V.
    pub fn motors_at_volts(&self, volts: f64) -> Motors {
        self.motors_with_type(self.servo_type(), volts)
    }

    /// The motors of another servo type at a supply voltage in V, and the joint friction.
    pub fn motors_with_type(&self, servo_type: &ServoType, volts: f64) -> Motors {
        let create_motor = |servo: &Servo| servo_type.motor(volts, servo.us_per_degree);
        Motors {
            per_servo: self.servos().each_ref().map(create_motor),
            joint_friction: self.config.joint_friction,
        }
    }

    /// Limits of the margins and the slider travels.
    pub fn limits(&self) -> &Limits {
        &self.config.limits
    }

    /// Speed limits of the servos.
    pub fn speed_limits(&self) -> &SpeedLimits {
        &self.config.speed_limits
    }

    /// Thresholds of the board's supply and of the servos' rail.
    pub fn supplies(&self) -> &Supplies {
        &self.config.supplies
    }

    /// The pins of the inputs, if any.
    pub fn inputs(&self) -> &Inputs {
        &self.config.inputs
    }

    /// Dimensions of the parts to print and to buy.
    pub fn parts(&self) -> &Parts {
        &self.config.parts
    }

    /// The drive between each servo's link and its leg.
    pub fn drive(&self) -> &Drive {
        &self.ground().drive
    }

    /// A slotted strut of this robot's size, whose spring has this preload (N) and rate (N/mm).
    pub fn strut_with_spring(&self, preload: f64, spring_rate: f64) -> Strut {
        Strut {
            preload,
            spring_rate,
            ..self.own_strut()
        }
    }

    /// A slotted strut of this robot's size with the spring of its parts.
    pub fn own_strut(&self) -> Strut {
        config::own_strut(self.legs(), self.config.neutral_angles(), self.parts())
    }

    /// The length of a spring mounted in a strut, measured inside its hooks, mm.
    pub fn mounted_spring_length(&self) -> f64 {
        config::mounted_spring_length(self.legs(), self.parts())
    }

    /// The legs seen from above, in servo order.
    pub fn legs(&self) -> &[LegPlan; 4] {
        &self.config.legs
    }

    /// The chassis seen from above.
    pub fn plate(&self) -> Plate {
        Plate::new(self.legs(), self.parts())
    }

    /// The contact model of this robot on its floor.
    pub fn ground(&self) -> &GroundContact {
        &self.config.ground
    }

    /// The gaits in the order of the file; the first is `stand`.
    pub fn gaits(&self) -> &[CheckedGait] {
        &self.gaits
    }

    /// The routines in the order of the file.
    pub fn routines(&self) -> &[Routine] {
        &self.routines
    }

    /// The routine with this name, whose words are separated by hyphens or spaces; `None` if there is none.
    pub fn routine(&self, name: &str) -> Option<&Routine> {
        let name = name.replace(' ', "-");
        self.routines.iter().find(|routine| routine.name() == name)
    }

    /// The gait with this name, whose words are separated by hyphens or spaces; `None` if there is none.
    pub fn gait(&self, name: &str) -> Option<&CheckedGait> {
        let name = name.replace(' ', "-");
        self.gaits.iter().find(|gait| gait.name() == name)
    }

    /// Finds the gait that a console line names. A space and a number of cycles may follow the name.
    pub fn find_gait_in_line(&self, line: &str) -> Option<&CheckedGait> {
        let name = line.trim_end_matches(|c: char| c.is_ascii_digit());
        let counted_gait = || name.ends_with(' ').then(|| self.gait(name.trim_end()))?;
        self.gait(line).or_else(counted_gait)
    }

    /// The core's view of this robot on a host, without the maps of certified cells, which do not change any decision.
    pub fn core(&self) -> lizard_core::numbers::robot::Robot<'_> {
        // The section was validated when the robot was read, so this does not fail.
        lizard_core::numbers::robot::Robot::unchecked(Region::new(&self.section))
            .unwrap_or(lizard_core::numbers::robot::Robot::NONE)
    }

    /// The core's view of this robot for a simulation of the core. Its section stays in memory until the program
    /// ends; the view from [`Robot::core`] borrows the section from this robot instead.
    pub fn firmware(&self) -> &CoreRobot {
        self.firmware.get_or_init(|| {
            CoreRobot::unchecked(keep_section(&self.section)).unwrap_or(CoreRobot::NONE)
        })
    }

    /// Returns the robot with routines as if no contact ever closed: a wait takes one frame, a gait that only a contact
    /// ends takes one cycle, and every other step takes its count or time.
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

    /// Computes the maps of certified cells, in which the guard provably accepts every pose.
    pub fn cell_maps(&self) -> CellMaps {
        CellMaps::new(self.lizard(), &self.content)
    }

    /// The neutral pose of the servos.
    pub fn neutral_pose(&self) -> Pose {
        self.config.neutral_angles().into()
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
        let neutral_angles = self.config.neutral_angles();
        std::array::from_fn(|i| FORWARD_TURN_SIGN[i] * wrap(angles[i] - neutral_angles[i]))
    }

    /// Predicts the body's displacement while the servos go through these angles (deg, chassis frame, servo order),
    /// according to the contact model with rigid legs. Returns a result even if it depends on differences between the
    /// pads that cannot be measured.
    pub fn predict_travel(&self, angles: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        self.ground()
            .with_rigid_drive()
            .compute_travel(angles.into_iter().map(|angles| self.sweeps(angles)))
    }

    /// Predicts the displacement over one cycle of a gait on the robot's own floor.
    pub fn predict(&self, gait: &CheckedGait) -> Prediction {
        gait.predict(self.ground())
    }
}

/// A table that defines `stand`, the first gait of every valid robot.
pub(crate) const STAND: &str = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";

/// The top-level keys of the file: its tables, and `name`.
pub(crate) const TOP_LEVEL_KEYS: [&str; 14] = [
    "name", "links", "leg", "servo", "joints", "limits", "supply", "input", "body", "feet",
    "ground", "parts", "gait", "routine",
];

/// Reads the robot's name from the top of the file.
fn read_name<'a>(root: &Table<'a>) -> ReadResult<&'a str> {
    let name = root.text_or("name", "robot")?;
    let is_allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if name.is_empty() || name.len() > MAX_NAME_BYTES || !name.chars().all(is_allowed) {
        let message =
            format!("must be at most {MAX_NAME_BYTES} lower-case letters, digits and hyphens");
        return Err(Error::new("name", message));
    }
    Ok(name)
}

/// Creates the error for a robot whose section has too many `bytes`. The message states the number of bytes for the
/// waveforms, the gaits and the routines.
fn size_error(content: &Content, bytes: usize) -> Error {
    let excess_bytes = bytes - usize::from(REGION_BYTES);
    let wave_count = content.waves.len();
    let wave_bytes = std::mem::size_of_val(content.waves.as_slice());
    let gait_count = content.gaits.len();
    let gait_bytes = gait_count * size_of::<Gait>() + content.names.len();
    let routines = content.gaits.iter().filter(|gait| gait.is_routine());
    let routine_count = routines.count();
    let step_bytes = std::mem::size_of_val(content.steps.as_slice());
    let routine_text = match routine_count {
        0 => String::new(),
        _ => format!(", {routine_count} of them routines, whose steps take {step_bytes}"),
    };
    let message = format!(
        "the robot exceeds the board's limit of {REGION_BYTES} bytes by {excess_bytes}; {wave_count} waveforms take {wave_bytes} bytes, {gait_count} gaits with their names take {gait_bytes}{routine_text}; remove gaits, starting with those whose waveform no other gait uses"
    );
    Error::with_own_subject("gait", message)
}
