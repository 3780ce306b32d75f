//! robot.toml, read and proved: the robot's measurements and gaits for the
//! firmware's build script, the host program and the tests.
//!
//! [`Robot::load`] reads the file and checks everything in it, every sample of
//! every gait included, so a `Robot` that exists is one that can walk. From it
//! come the gaits in floating point ([`Gait`]), the tables that the firmware
//! reads ([`Tables`]) and the Rust source that carries them
//! ([`Robot::source`]).
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod accuracy;
mod audit;
mod define;
mod error;
mod firmware;
mod friction;
mod gait;
mod generate;
mod ground;
mod measure;
mod path;
mod reader;
mod report;
mod sensitivity;
pub mod servo;
mod table;
mod waveform;

use std::io::Read;
use std::path::Path as FilePath;

use lizard_kinematics::{Limits, Lizard, Pose, wrap};
use toml::de::DeTable;

pub use audit::{Audit, Least, Peak};
pub use error::{Error, Hint, Problem};
pub use firmware::Firmware;
pub use gait::{Gait, Stride};
pub use ground::{Feet, Ground, Prediction, Travel};
pub use path::{Path, PathLeg};
pub use report::{Report, Row};
pub use sensitivity::{MOUNTS, RATIOS, Sensitive, Sensitivity};
pub use servo::Servo;
pub use table::{FRAMES_PER_SECOND, STEPS_PER_DEGREE, Tables};
pub use waveform::{Harmonic, Waveform};

use error::{Checked, Fault};
use lizard_core::gait::MOST_WAVES;
use table::Unfit;
use reader::Section;

/// How fast servos may turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// In a blend or a pose, deg/s.
    pub slew: f64,
    /// In a gait, deg/s.
    pub gait_slew: f64,
}

/// A robot whose every value and gait has been checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Its links.
    pub lizard: Lizard,
    /// Its servos A1, A2, A3, A4.
    pub servos: [Servo; 4],
    /// What its poses must keep clear of.
    pub limits: Limits,
    /// How fast its servos may turn.
    pub pace: Pace,
    /// Its feet on the floor.
    pub ground: Ground,
    /// Its gaits in the order of the file; the first is `stand`.
    pub gaits: Vec<Gait>,
    /// The robot as the firmware holds it.
    pub firmware: Firmware,
    /// What the check of each gait found.
    pub audits: Vec<Audit>,
}

impl Robot {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// If it cannot be read, is longer than [`LONGEST`], is not UTF-8 text, or
    /// holds a mistake.
    pub fn load(path: impl AsRef<FilePath>) -> Result<Self, Error> {
        let path = path.as_ref();
        let file = path.display().to_string();
        match read_limited(path) {
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
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let file = "robot.toml".to_string();
        let document = DeTable::parse(text).map_err(|fault| Error {
            file: file.clone(),
            line: fault
                .span()
                .map(|span| text[..span.start].matches('\n').count() + 1),
            key: String::new(),
            problem: Problem::Syntax(fault.message().to_string()),
        })?;
        let table = document.get_ref();
        Self::read(table).map_err(|Fault { key, problem }| {
            let lines = reader::lines(text, table);
            // The line of the key, or of the nearest table that holds it.
            let within = |whole: &String| {
                key == *whole
                    || key.starts_with(&format!("{whole}."))
                    || key.starts_with(&format!("{whole}["))
            };
            let line = lines
                .iter()
                .filter(|(whole, _)| within(whole))
                .max_by_key(|(whole, _)| whole.len());
            Error {
                file,
                line: line.map(|(_, line)| *line),
                key,
                problem,
            }
        })
    }

    fn read(table: &DeTable) -> Checked<Self> {
        let root = Section::root(
            table,
            &["links", "leg", "servo", "limits", "ground", "gait"],
        )?;
        let links = measure::links(&root)?;
        let (leg, feet) = measure::leg(&root)?;
        let lizard = Lizard { links, leg };
        let servos = measure::servos(&root)?;
        let (limits, pace) = measure::limits(&root)?;
        measure::fits(&lizard, &limits)?;
        let ground = measure::ground(&root, feet)?;
        let neutral = servos.map(|servo| servo.neutral);
        stands(&lizard, &limits, neutral)?;
        let gaits = define::gaits(&root, &define::Body { lizard, neutral })?;
        let key = |index: usize, gaits: &[Gait]| format!("gait.{}", gaits[index].name);
        let tables = Tables::new(&gaits).map_err(|(gait, unfit)| {
            match unfit {
                Unfit::HalfTurn(servo) => Problem::HalfTurn {
                    servo: servo::NAMES[servo],
                },
                Unfit::Waves => Problem::ManyWaves { most: MOST_WAVES },
            }
            .at(key(gait, &gaits))
        })?;
        let firmware = Firmware::new(&lizard, &servos, &limits, &pace, tables)
            .ok_or_else(|| Problem::TooLarge.at("links"))?;
        let mut robot = Self {
            lizard,
            servos,
            limits,
            pace,
            ground,
            gaits,
            firmware,
            audits: Vec::new(),
        };
        robot.audits = (0..robot.gaits.len())
            .map(|index| {
                audit::check(&robot, index).map_err(|problem| problem.at(key(index, &robot.gaits)))
            })
            .collect::<Checked<_>>()?;
        Ok(robot)
    }

    /// The neutral pose.
    pub fn neutral(&self) -> Pose {
        self.servos.map(|servo| servo.neutral).into()
    }

    /// A gait and its index by its name; a blank in it counts as a dash.
    pub fn gait(&self, name: &str) -> Option<(usize, &Gait)> {
        let name = name.replace(' ', "-");
        self.gaits
            .iter()
            .enumerate()
            .find(|(_, gait)| gait.name == name)
    }

    /// The legs' sweeps (deg, foot forward positive) at servo angles (deg,
    /// chassis frame), both in servo order.
    pub fn sweeps(&self, angles: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|i| servo::FORWARD[i] * wrap(angles[i] - self.servos[i].neutral))
    }

    /// Where the robot gets to when its servos take these angles (deg, chassis
    /// frame, servo order) one after another, by the contact model, whether or
    /// not that hangs on ties.
    pub fn travel(&self, angles: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        self.ground
            .travel(angles.into_iter().map(|angles| self.sweeps(angles)))
    }

    /// Where one cycle of a gait takes the robot, in the time order of a gait
    /// that starts at phase 0, by the contact model.
    pub fn predict(&self, gait: &Gait) -> Prediction {
        /// Steps in a cycle; twice as many change no result by 0.01 mm.
        const STEPS: usize = 1000;
        /// Enough to tell what hangs on a tie, which takes longer.
        const COARSE: usize = 250;
        let cycle = |steps: usize| {
            (0..=steps).map(move |i| gait.sweeps(gait.phase(gait.period * i as f64 / steps as f64)))
        };
        let known = self.ground.predict(cycle(COARSE));
        let travel = self.ground.travel(cycle(STEPS));
        Prediction {
            forward: known.forward.and(Some(travel.forward)),
            left: known.left.and(Some(travel.left)),
            turn: known.turn.and(Some(travel.turn)),
        }
    }

    /// The gaits as the firmware holds them.
    pub fn tables(&self) -> &Tables {
        self.firmware.tables()
    }

    /// Every gait's figures, as a table.
    pub fn report(&self) -> Report {
        Report::of(self)
    }

    /// The Rust source that the firmware includes.
    pub fn source(&self) -> String {
        generate::source(&self.firmware)
    }

    /// CRC-32 of the firmware's numbers, as its banner shows it.
    pub fn tables_hash(&self) -> u32 {
        self.firmware.hash()
    }
}

/// Bytes that a robot file may have. A real one has some thousands; more is not
/// read, because a device or a pipe may never end.
pub const LONGEST: u64 = 1 << 20;

/// The text of a file, of which no more than [`LONGEST`] bytes are read.
fn read_limited(path: &FilePath) -> Result<String, Problem> {
    let unreadable = |fault: std::io::Error| Problem::Unreadable(fault.to_string());
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(LONGEST + 1).read_to_end(&mut bytes))
        .map_err(unreadable)?;
    if bytes.len() as u64 > LONGEST {
        return Err(Problem::Huge);
    }
    String::from_utf8(bytes).map_err(|fault| {
        let before = &fault.as_bytes()[..fault.utf8_error().valid_up_to()];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        Problem::NotText(line)
    })
}

/// Refuses a robot that could not even stand.
fn stands(lizard: &Lizard, limits: &Limits, neutral: [f64; 4]) -> Checked<()> {
    let fault = |text: String| Err(Problem::Neutral(text).at("servo"));
    match lizard.solve(&neutral.into()) {
        Err(infeasible) => fault(infeasible.to_string()),
        Ok(solution) => match limits.violations(&solution).next() {
            Some(violation) => fault(violation.to_string()),
            None => Ok(()),
        },
    }
}
