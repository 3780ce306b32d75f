//! The gaits of a film's walks: as the user names them, or as their paths show them.

use std::cell::OnceCell;
use std::fmt::Write as _;

use lizard_film::{Gait, Likeness, Measured, Trouble, rest};
use lizard_robot::{CheckedGait, Robot};

use super::expected::expected;
use super::film::{Walk, WatchedFilm};
use crate::Failure;
use crate::shared::suggestion::did_you_mean;

/// Speed of the slowest gait that is looked for where the user names none, mm/s at full pace.
const SLOWEST: f64 = 3.0;

/// A gait and the path that it is predicted to take.
pub(super) struct Candidate<'a> {
    pub gait: &'a CheckedGait,
    pub expected: Gait,
}

impl<'a> Candidate<'a> {
    fn new(robot: &Robot, gait: &'a CheckedGait, pace: f64) -> Self {
        let expected = expected(robot, gait, pace);
        Self { gait, expected }
    }

    pub(super) fn name(&self) -> &'a str {
        self.gait.name()
    }
}

/// A walk whose gait is known, measured.
pub(super) struct NamedWalk<'f> {
    pub walk: Walk<'f>,
    /// Number of its gait in [`Gaits::known`].
    pub gait: usize,
    pub measured: Measured,
}

/// The gaits that a film may show.
pub(super) struct Gaits<'a> {
    robot: &'a Robot,
    pace: f64,
    /// The gaits that the user names, in their order.
    named: Vec<Candidate<'a>>,
    /// All that go somewhere; computed when they are asked for.
    all: OnceCell<Vec<Candidate<'a>>>,
}

impl<'a> Gaits<'a> {
    /// The gaits of these names.
    ///
    /// # Errors
    /// Fails for a name that no gait has, or one that moves no servo.
    pub(super) fn new(robot: &'a Robot, names: &[String], pace: f64) -> Result<Self, Failure> {
        let named = names.iter().map(|name| {
            let gait = find(robot, name)?;
            Ok(Candidate::new(robot, gait, pace))
        });
        Ok(Self {
            robot,
            pace,
            named: named.collect::<Result<_, Failure>>()?,
            all: OnceCell::new(),
        })
    }

    /// The gaits that walks are called by: those that the user names, or else all.
    pub(super) fn known(&self) -> &[Candidate<'a>] {
        match self.named.is_empty() {
            true => self.all(),
            false => &self.named,
        }
    }

    fn all(&self) -> &[Candidate<'a>] {
        self.all.get_or_init(|| {
            let moving = self.robot.gaits().iter().filter(|gait| gait.moves());
            let all = moving.map(|gait| Candidate::new(self.robot, gait, self.pace));
            // A gait that stays in its place pauses for longer than a robot between two walks.
            let goes = |own: &Candidate| own.expected.speed() > SLOWEST * self.pace;
            all.filter(goes).collect()
        })
    }

    /// Finds the walks of films, and measures each with its gait.
    ///
    /// # Errors
    /// Fails if the names are not those of the walks, or no gait is clear.
    pub(super) fn walks<'f>(
        &self,
        films: &'f [WatchedFilm],
    ) -> Result<Vec<NamedWalk<'f>>, Failure> {
        let expected: Vec<Gait> = self
            .known()
            .iter()
            .map(|own| own.expected.clone())
            .collect();
        let rest = rest(&expected);
        let walks: Vec<Walk> = films.iter().flat_map(|film| film.walks(rest)).collect();
        let names = self.named.len();
        if names > 1 && names != walks.len() {
            return Err(self.other_number(&walks, rest));
        }
        let measured = walks.into_iter().enumerate().map(|(i, walk)| {
            let gait = match names {
                0 => self.recognized(walk)?,
                1 => 0,
                _ => i,
            };
            let own = &self.known()[gait];
            let measured = walk.film.watched.measure(&own.expected, Some(walk.during));
            let measured = measured.map_err(|trouble| self.not(walk, own, trouble))?;
            Ok(NamedWalk {
                walk,
                gait,
                measured,
            })
        });
        measured.collect()
    }

    /// The gait that a walk shows clearly, by its number.
    fn recognized(&self, walk: Walk) -> Result<usize, Failure> {
        let name = |number: usize| self.all()[number].name();
        let (why, hint) = match self.likeness(walk) {
            Likeness::One(number) => return Ok(number),
            Likeness::Two(best, rival) => (
                format!(
                    "the path is most like {}, and nearly as much like {}",
                    name(best),
                    name(rival)
                ),
                true,
            ),
            Likeness::None(Trouble::NotThisGait { .. }) => (
                "the path is like no gait of robot.toml at this pace".to_owned(),
                true,
            ),
            Likeness::None(trouble) => (trouble.to_string(), false),
        };
        let hint = match hint {
            true => "; name the gaits of all walks with --gait",
            false => "",
        };
        Err(Failure::Input(format!("{}: {why}{hint}", walk.at())))
    }

    /// The gait of robot.toml that a walk is like.
    fn likeness(&self, walk: Walk) -> Likeness {
        let all: Vec<Gait> = self.all().iter().map(|own| own.expected.clone()).collect();
        walk.film.watched.likeness(&all, walk.during)
    }

    /// The name of the gait that a walk is clearly like.
    pub(super) fn like(&self, walk: Walk) -> Option<&'a str> {
        match self.likeness(walk) {
            Likeness::One(number) => Some(self.all()[number].name()),
            _ => None,
        }
    }

    /// The failure of a walk that is not of its gait.
    fn not(&self, walk: Walk, own: &Candidate, trouble: Trouble) -> Failure {
        let like = match trouble {
            Trouble::NotThisGait { .. } | Trouble::AnotherPace { .. } => self.like(walk),
            _ => None,
        };
        let like = like.filter(|name| *name != own.name());
        let like = like.map_or(String::new(), |name| format!("; it is like {name}"));
        Failure::Input(format!("{}, {}: {trouble}{like}", walk.at(), own.name()))
    }

    /// The failure of films that show another number of walks than there are names.
    fn other_number(&self, walks: &[Walk], rest: f64) -> Failure {
        let names: Vec<&str> = self.named.iter().map(Candidate::name).collect();
        let mut text = format!(
            "{} walks between rests of {rest:.1} s or more, and --gait names {}: {}",
            walks.len(),
            names.len(),
            names.join(", ")
        );
        let mut missing = names;
        let mut is_clear = true;
        for walk in walks {
            let like = self.like(*walk);
            let [from, to] = walk.during;
            let _ = write!(
                text,
                "\n  {}, {:.1} s long: like {}",
                walk.at(),
                to - from,
                like.unwrap_or("no gait clearly")
            );
            match like.and_then(|like| missing.iter().position(|name| *name == like)) {
                Some(at) => {
                    missing.remove(at);
                }
                None => is_clear = false,
            }
        }
        if is_clear && !missing.is_empty() {
            let _ = write!(text, "\nno walk is like {}", missing.join(", "));
        }
        Failure::Input(text)
    }
}

/// The gait of this name, if it moves a servo.
fn find<'a>(robot: &'a Robot, name: &str) -> Result<&'a CheckedGait, Failure> {
    match robot.gait(name) {
        Some(gait) if gait.moves() => Ok(gait),
        Some(_) => Err(Failure::Input(format!("the gait `{name}` moves no servo"))),
        None => {
            let moving = robot.gaits().iter().filter(|gait| gait.moves());
            let names: Vec<&str> = moving.map(CheckedGait::name).collect();
            Err(Failure::Input(format!(
                "robot.toml has no gait `{name}`; those that move are {}{}",
                names.join(", "),
                did_you_mean(name, names)
            )))
        }
    }
}
