//! A whole robot.toml.

use std::path::Path;

use lizard_core::gait::MOST_WAVES;
use lizard_kinematics::{Limits, Lizard, Pose, Solution, wrap};
use toml::de::DeTable;

use crate::audit;
use crate::checked_gait::CheckedGait;
use crate::coil::Coil;
use crate::core_robot::CoreRobot;
use crate::define;
use crate::drive::Drive;
use crate::error::{Checked, Error, Fault, Problem};
use crate::file;
use crate::ground::Ground;
use crate::legs::LegPlan;
use crate::measure::Measures;
use crate::numbers::Numbers;
use crate::parts::Parts;
use crate::plate::Plate;
use crate::reader::{self, Section};
use crate::servo::{self, FORWARD, Pace, Servo};
use crate::strut::Strut;
use crate::supply::Supplies;
use crate::syntax;
use crate::table::{Tables, Unfit};
use crate::tabled_gait::TabledGait;
use crate::travel::{Prediction, Travel};

/// A robot whose every value and gait has been checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    measures: Measures,
    gaits: Vec<CheckedGait>,
    firmware: CoreRobot,
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
            Self::walking(self.measures.clone(), &Section::root(table, &["gait"])?)
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
            problem: Problem::Syntax(syntax::mistake(
                text,
                fault.span().map_or(text.len(), |span| span.start),
                fault.message(),
            )),
        })?;
        let table = document.get_ref();
        read(table).map_err(|Fault { key, problem }| Error {
            file,
            line: reader::line(text, table, &key),
            key,
            problem,
        })
    }

    fn read(table: &DeTable) -> Checked<Self> {
        let root = Section::root(
            table,
            &[
                "links", "leg", "servo", "limits", "supply", "body", "feet", "ground", "parts",
                "gait",
            ],
        )?;
        Self::walking(Measures::read(&root)?, &root)
    }

    /// A body with the gaits of a file.
    fn walking(measures: Measures, root: &Section) -> Checked<Self> {
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
        let firmware = CoreRobot::new(Numbers::new(&measures, tables));
        let gaits = gaits.into_iter().enumerate().map(|(index, gait)| {
            let gait = TabledGait::new(gait, index, firmware.tables());
            match audit::check(&gait, &measures, &firmware) {
                Ok(audit) => Ok(CheckedGait::new(gait, audit)),
                Err(problem) => Err(problem.at(key(gait.name()))),
            }
        });
        Ok(Self {
            gaits: gaits.collect::<Checked<_>>()?,
            measures,
            firmware,
        })
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

    /// The same with a spring from the shop hung in it.
    pub fn strut_of(&self, coil: &Coil) -> Strut {
        Strut::of_coil(self.legs(), self.measures.neutral(), self.parts(), coil)
    }

    /// The length of a spring inside its hooks as it hangs in a strut, mm.
    pub fn hung(&self) -> f64 {
        Strut::hung(self.legs(), self.parts())
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

    /// The robot as the core reads it, in its firmware and on a host.
    pub fn firmware(&self) -> &CoreRobot {
        &self.firmware
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
