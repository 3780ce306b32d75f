//! A whole robot.toml.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use lizard_avr::Region;
use lizard_contact::{Drive, Ground, Prediction, Strut, Travel};
use lizard_core::numbers::gaits::{Gait, MOST_WAVES};
use lizard_core::numbers::section::{Content, LONGEST_NAME, SPACE};
use lizard_kinematics::{Limits, Lizard, Pose, Solution, wrap};
use toml::de::DeTable;

use crate::checks::{CheckedGait, audit};
use crate::file::{self, Checked, Error, Fault, Problem, Section};
use crate::gaits::define;
use crate::measures::servo::{self, FORWARD};
use crate::measures::{self, Coil, LegPlan, Measures, Pace, Parts, Plate, Servo, Supplies};
use crate::tables::{CellMaps, CoreRobot, TabledGait, Tables, Unfit, flash, numbers};

/// A robot whose every value and gait has been checked.
#[derive(Debug, Clone)]
pub struct Robot {
    measures: Measures,
    gaits: Vec<CheckedGait>,
    content: Content,
    /// What the core reads of it: the content without the maps of certified cells.
    section: Arc<[u8]>,
    /// The same for as long as the program runs, once somebody has asked for it.
    firmware: OnceLock<CoreRobot>,
}

impl PartialEq for Robot {
    fn eq(&self, other: &Self) -> bool {
        self.measures == other.measures
            && self.gaits == other.gaits
            && self.content == other.content
    }
}

impl Robot {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// If it cannot be read, is longer than [`crate::LONGEST`], is not UTF-8 text,
    /// or holds a mistake.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let file = path.display().to_string();
        match file::read(path) {
            Ok(text) => Self::parse(&text).map_err(|error| Error { file, ..error }),
            Err(problem) => Err(Error {
                file,
                line: None,
                key: String::new(),
                problem,
            }),
        }
    }

    /// Reads and checks the text of a robot.toml. A byte order mark at its start
    /// is passed over.
    ///
    /// # Errors
    /// If the text holds a mistake.
    pub fn parse(text: &str) -> Result<Self, Error> {
        Self::checked(text, Self::read)
    }

    /// The same body with other gaits, which are checked: the text has the tables `gait.*`
    /// of a robot.toml, `gait.stand` first, and nothing else.
    ///
    /// # Errors
    /// If the text holds a mistake.
    pub fn with_gaits(&self, text: &str) -> Result<Self, Error> {
        Self::checked(text, |table| {
            let root = Section::root(table, &["gait"])?;
            Self::walking(self.name(), self.measures.clone(), &root)
        })
    }

    fn checked(text: &str, read: impl Fn(&DeTable) -> Checked<Self>) -> Result<Self, Error> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let file = "robot.toml".to_string();
        let document = DeTable::parse(text).map_err(|fault| Error {
            file: file.clone(),
            line: fault
                .span()
                .map(|span| text[..span.start].matches('\n').count() + 1),
            key: String::new(),
            problem: Problem::Syntax(file::mistake(
                text,
                fault.span().map_or(text.len(), |span| span.start),
                fault.message(),
            )),
        })?;
        let table = document.get_ref();
        read(table).map_err(|Fault { key, problem }| Error {
            file,
            line: file::line(text, table, &key),
            key,
            problem,
        })
    }

    fn read(table: &DeTable) -> Checked<Self> {
        let root = Section::root(
            table,
            &[
                "name", "links", "leg", "servo", "limits", "supply", "body", "feet", "ground",
                "parts", "gait",
            ],
        )?;
        let name = name(&root)?;
        Self::walking(name, Measures::read(&root)?, &root)
    }

    /// A body with the gaits of a file.
    fn walking(name: &str, measures: Measures, root: &Section) -> Checked<Self> {
        let gaits = define::gaits(root, &measures)?;
        let key = |name: &str| format!("gait.{name}");
        let tables = Tables::new(&gaits).map_err(|(gait, unfit)| {
            match unfit {
                Unfit::HalfTurn(servo) => Problem::HalfTurn {
                    servo: servo::NAMES[servo],
                },
                Unfit::Waves => Problem::ManyWaves { most: MOST_WAVES },
            }
            .at(key(&gaits[gait].name))
        })?;
        let content = numbers::content(name, &measures, &tables);
        let tables = Arc::new(tables);
        let length = content.length();
        if length > usize::from(SPACE) {
            return Err(too_large(&content, length).at("gait"));
        }
        let section: Arc<[u8]> = content.section().into();
        let flash = Region::new(&section);
        let impossible = || Problem::Impossible.at("");
        let unchecked =
            lizard_core::numbers::robot::Robot::unchecked(flash).ok_or_else(impossible)?;
        let gaits = gaits.into_iter().enumerate().map(|(index, gait)| {
            let gait = TabledGait::new(gait, index, &tables);
            match audit::check(&gait, &measures, &unchecked) {
                Ok(audit) => Ok(CheckedGait::new(gait, audit)),
                Err(problem) => Err(problem.at(key(gait.name()))),
            }
        });
        let gaits = gaits.collect::<Checked<_>>()?;
        lizard_core::numbers::robot::Robot::open(flash).map_err(|_| impossible())?;
        Ok(Self {
            gaits,
            measures,
            content,
            section,
            firmware: OnceLock::new(),
        })
    }

    /// Its name, which the firmware says when it begins.
    pub fn name(&self) -> &str {
        &self.content.name
    }

    /// Its section of flash: all that it says to the firmware, with the maps of
    /// certified cells, which take a moment to prove. At most [`SPACE`] bytes: where there
    /// is no room for the maps, the firmware measures every pose.
    pub fn section(&self) -> Vec<u8> {
        self.with_maps().unwrap_or_else(|| self.content.section())
    }

    /// Whether its section has room for the maps of certified cells.
    pub fn has_room_for_maps(&self) -> bool {
        self.with_maps().is_some()
    }

    /// The cycles, at most, that the console takes for a line whose gait is the last of all;
    /// measured on the simulated UNO, where a test compares them.
    #[must_use]
    pub fn longest_search(&self) -> usize {
        let of_gait = |gait: &CheckedGait| 1_400 + 92 * gait.name().len();
        6_000 + self.gaits().iter().map(of_gait).sum::<usize>()
    }

    /// Its section with the maps, if that is not too long.
    fn with_maps(&self) -> Option<Vec<u8>> {
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
        Some(content.section()).filter(|section| section.len() <= usize::from(SPACE))
    }

    /// Its numbers as its section has them.
    pub const fn content(&self) -> &Content {
        &self.content
    }

    /// Its links.
    pub fn lizard(&self) -> &Lizard {
        &self.measures.lizard
    }

    /// Its servos A1, A2, A3, A4.
    pub fn servos(&self) -> &[Servo; 4] {
        &self.measures.servos
    }

    /// What its poses must keep clear of.
    pub fn limits(&self) -> &Limits {
        &self.measures.limits
    }

    /// How fast its servos may turn.
    pub fn pace(&self) -> &Pace {
        &self.measures.pace
    }

    /// What is measured of its supplies.
    pub fn supplies(&self) -> &Supplies {
        &self.measures.supplies
    }

    /// What it is built of.
    pub fn parts(&self) -> &Parts {
        &self.measures.parts
    }

    /// What drives its legs.
    pub fn drive(&self) -> &Drive {
        &self.ground().drive
    }

    /// Its slotted strut, which drives its legs or would: with this force (N) and rate
    /// (N/mm) of the spring in it.
    pub fn strut_with(&self, force: f64, rate: f64) -> Strut {
        Strut {
            force,
            rate,
            ..self.strut_of(&self.parts().spring)
        }
    }

    /// The same with a spring from the shop mounted in it.
    pub fn strut_of(&self, coil: &Coil) -> Strut {
        measures::of_coil(self.legs(), self.measures.neutral(), self.parts(), coil)
    }

    /// The length of a spring inside its hooks as it hangs in a strut, mm.
    pub fn hung(&self) -> f64 {
        measures::hung(self.legs(), self.parts())
    }

    /// Its legs seen from above, servo order.
    pub fn legs(&self) -> &[LegPlan; 4] {
        &self.measures.legs
    }

    /// Its chassis seen from above.
    pub fn plate(&self) -> Plate {
        Plate::new(self.legs(), self.parts())
    }

    /// Its feet on the floor.
    pub fn ground(&self) -> &Ground {
        &self.measures.ground
    }

    /// Its gaits in the order of the file; the first is `stand`.
    pub fn gaits(&self) -> &[CheckedGait] {
        &self.gaits
    }

    /// A gait by its name; a blank in it counts as a dash.
    pub fn gait(&self, name: &str) -> Option<&CheckedGait> {
        let name = name.replace(' ', "-");
        self.gaits.iter().find(|gait| gait.name() == name)
    }

    /// The robot as the core reads it, on a host: without the maps of certified cells,
    /// which change no decision.
    pub fn core(&self) -> lizard_core::numbers::robot::Robot<'_> {
        // It was opened when the robot was read.
        lizard_core::numbers::robot::Robot::unchecked(Region::new(&self.section))
            .unwrap_or(lizard_core::numbers::robot::Robot::NONE)
    }

    /// The same for whoever runs the core, which may take as long as the program: its section
    /// stays in memory until the program ends. [`Robot::core`] keeps nothing.
    pub fn firmware(&self) -> &CoreRobot {
        self.firmware
            .get_or_init(|| CoreRobot::unchecked(flash(&self.section)).unwrap_or(CoreRobot::NONE))
    }

    /// The cells in which its guard is proved to accept every pose.
    pub fn cell_maps(&self) -> CellMaps {
        CellMaps::new(self.lizard(), &self.content)
    }

    /// The neutral pose.
    pub fn neutral(&self) -> Pose {
        self.measures.neutral().into()
    }

    /// The robot at servo angles (deg, chassis frame, servo order), if it may take this
    /// pose: its guard accepts it, and the servos reach it.
    pub fn accepted(&self, angles: [f64; 4]) -> Option<Solution> {
        let mut servos = self.servos().iter().zip(angles);
        if !servos.all(|(servo, angle)| servo.reaches(angle)) {
            return None;
        }
        let solution = self.lizard().solve(&angles.into()).ok()?;
        self.limits().allow(&solution).then_some(solution)
    }

    /// The legs' sweeps (deg, foot forward positive) at servo angles (deg,
    /// chassis frame), both in servo order.
    pub fn sweeps(&self, angles: [f64; 4]) -> [f64; 4] {
        let neutral = self.measures.neutral();
        std::array::from_fn(|i| FORWARD[i] * wrap(angles[i] - neutral[i]))
    }

    /// Where the robot gets to when its servos take these angles (deg, chassis
    /// frame, servo order) one after another, by the contact model with rigid legs,
    /// whether or not that depends on ties.
    pub fn travel(&self, angles: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        self.ground()
            .rigid()
            .travel(angles.into_iter().map(|angles| self.sweeps(angles)))
    }

    /// Where one cycle of a gait takes the robot, as [`CheckedGait::predict`] on
    /// its own floor.
    pub fn predict(&self, gait: &CheckedGait) -> Prediction {
        gait.predict(self.ground())
    }
}
/// The name at the top of the file.
fn name<'a>(root: &Section<'a>) -> Checked<&'a str> {
    if !root.has("name") {
        return Ok("robot");
    }
    let name = root.text("name")?;
    let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if name.is_empty() || name.len() > LONGEST_NAME || !name.chars().all(letters) {
        return Err(Problem::RobotName { most: LONGEST_NAME }.at("name"));
    }
    Ok(name)
}

/// What takes the room of a section that is too large.
fn too_large(content: &Content, bytes: usize) -> Problem {
    Problem::Large {
        over: bytes - usize::from(SPACE),
        most: SPACE.into(),
        waves: content.waves.len(),
        of_waves: std::mem::size_of_val(content.waves.as_slice()),
        gaits: content.gaits.len(),
        of_gaits: content.gaits.len() * size_of::<Gait>() + content.names.len(),
    }
}
