//! The gaits of a film's walks, named by the user or recognised by their paths.

use std::cell::OnceCell;
use std::fmt::Write as _;

use lizard_film::{Gait, Likeness, Measured, Trouble, rest};
use lizard_robot::{CheckedGait, Robot};

use crate::expected::expected;
use crate::watched_film::{Walk, WatchedFilm};

/// Least speed of the gaits that are considered if the user names none, mm/s at a pace of 1.
const MIN_SPEED: f64 = 3.0;

/// A gait and the path that it is predicted to take.
#[derive(Debug)]
pub(crate) struct Candidate<'a> {
    pub gait: &'a CheckedGait,
    pub expected: Gait,
}

impl<'a> Candidate<'a> {
    fn new(robot: &Robot, gait: &'a CheckedGait, pace: f64) -> Self {
        let expected = expected(robot, gait, pace);
        Self { gait, expected }
    }

    pub(crate) fn name(&self) -> &'a str {
        self.gait.name()
    }
}

/// A measured walk whose gait is known.
#[derive(Debug)]
pub struct NamedWalk<'f> {
    pub(crate) walk: Walk<'f>,
    /// Index of the walk's gait in [`Gaits::candidates`].
    pub(crate) gait: usize,
    pub(crate) measured: Measured,
}

/// The gaits that a film may show.
#[derive(Debug)]
pub struct Gaits<'a> {
    robot: &'a Robot,
    pace: f64,
    /// The gaits that the user names, in their order.
    named: Vec<Candidate<'a>>,
    /// All gaits that are fast enough to be considered; computed on first use.
    all: OnceCell<Vec<Candidate<'a>>>,
}

impl<'a> Gaits<'a> {
    /// Takes the gaits that the user names, in their order, or none. `pace` is a multiple of each gait's own
    /// pace.
    pub fn new(robot: &'a Robot, named_gaits: &[&'a CheckedGait], pace: f64) -> Self {
        let candidate_of = |gait: &&'a CheckedGait| Candidate::new(robot, gait, pace);
        Self {
            robot,
            pace,
            named: named_gaits.iter().map(candidate_of).collect(),
            all: OnceCell::new(),
        }
    }

    /// The gaits that a walk can have: those that the user names, or all if the user names none.
    pub(crate) fn candidates(&self) -> &[Candidate<'a>] {
        match self.named.is_empty() {
            true => self.all(),
            false => &self.named,
        }
    }

    fn all(&self) -> &[Candidate<'a>] {
        self.all.get_or_init(|| {
            let moving_gaits = self.robot.gaits().iter().filter(|gait| gait.moves());
            let candidates = moving_gaits.map(|gait| Candidate::new(self.robot, gait, self.pace));
            // A gait that stays in its place would lengthen the least rest between two walks too much.
            let is_fast =
                |candidate: &Candidate| candidate.expected.speed() > MIN_SPEED * self.pace;
            candidates.filter(is_fast).collect()
        })
    }

    /// Finds the walks of films, and measures each as a walk of its gait.
    ///
    /// # Errors
    /// Fails with a sentence for the user if the number of names differs from that of the walks, if a walk
    /// resembles no gait clearly, or if a walk does not fit its gait.
    pub fn walks<'f>(&self, films: &'f [WatchedFilm]) -> Result<Vec<NamedWalk<'f>>, String> {
        let expected_gaits: Vec<Gait> = self
            .candidates()
            .iter()
            .map(|candidate| candidate.expected.clone())
            .collect();
        let least_rest = rest(&expected_gaits);
        let walks: Vec<Walk> = films
            .iter()
            .flat_map(|film| film.walks(least_rest))
            .collect();
        let names = self.named.len();
        if names > 1 && names != walks.len() {
            return Err(self.count_mismatch_message(&walks, least_rest));
        }
        let named_walks = walks.into_iter().enumerate().map(|(i, walk)| {
            let gait = match names {
                0 => self.recognize_gait(walk)?,
                1 => 0,
                _ => i,
            };
            let candidate = &self.candidates()[gait];
            let measured = walk
                .film
                .watched
                .measure(&candidate.expected, Some(walk.during));
            let measured = measured.map_err(|trouble| {
                format!(
                    "{}, {}: {}",
                    walk.label(),
                    candidate.name(),
                    self.mismatch_message(walk, candidate, trouble)
                )
            })?;
            Ok(NamedWalk {
                walk,
                gait,
                measured,
            })
        });
        named_walks.collect()
    }

    /// Measures one of the named gaits, given by its index, between two times of a film, s, or in all of it.
    ///
    /// # Errors
    /// Fails with a sentence for the user if no gait has this index, or if the film does not show the gait in
    /// that time.
    pub fn walk<'f>(
        &self,
        gait: usize,
        film: &'f WatchedFilm,
        during: Option<[f64; 2]>,
    ) -> Result<NamedWalk<'f>, String> {
        let candidate = self.named.get(gait);
        let candidate = candidate.ok_or_else(|| Trouble::NoGait.to_string())?;
        let walk = Walk {
            film,
            during: during.or_else(|| film.time_range()).unwrap_or_default(),
        };
        let measured = film.watched.measure(&candidate.expected, during);
        let measured =
            measured.map_err(|trouble| self.mismatch_message(walk, candidate, trouble))?;
        Ok(NamedWalk {
            walk,
            gait,
            measured,
        })
    }

    /// Recognises the gait of a walk and returns its index; fails with a message if the walk resembles no
    /// gait, or two.
    fn recognize_gait(&self, walk: Walk) -> Result<usize, String> {
        let name_of = |index: usize| self.all()[index].name();
        let (reason, has_hint) = match self.likeness(walk) {
            Likeness::One(index) => return Ok(index),
            Likeness::Two(best, rival) => (
                format!(
                    "the path is most like {}, and nearly as much like {}",
                    name_of(best),
                    name_of(rival)
                ),
                true,
            ),
            Likeness::None(Trouble::NotThisGait { .. }) => (
                "the path is like no gait of robot.toml at this pace".to_owned(),
                true,
            ),
            Likeness::None(trouble) => (trouble.to_string(), false),
        };
        let hint = match has_hint {
            true => "; name the gait of each walk",
            false => "",
        };
        Err(format!("{}: {reason}{hint}", walk.label()))
    }

    /// The gait of robot.toml that a walk resembles.
    fn likeness(&self, walk: Walk) -> Likeness {
        let expected_gaits: Vec<Gait> = self
            .all()
            .iter()
            .map(|candidate| candidate.expected.clone())
            .collect();
        walk.film.watched.likeness(&expected_gaits, walk.during)
    }

    /// Name of the gait that a walk clearly resembles; `None` if it resembles no gait, or two.
    pub(crate) fn resembled_gait(&self, walk: Walk) -> Option<&'a str> {
        match self.likeness(walk) {
            Likeness::One(index) => Some(self.all()[index].name()),
            _ => None,
        }
    }

    /// The message for a walk that does not fit its gait, with the gait that it resembles instead.
    fn mismatch_message(&self, walk: Walk, candidate: &Candidate, trouble: Trouble) -> String {
        let resembled_name = match trouble {
            Trouble::NotThisGait { .. } | Trouble::AnotherPace { .. } => self.resembled_gait(walk),
            _ => None,
        };
        let resembled_name = resembled_name.filter(|name| *name != candidate.name());
        let resembled_name =
            resembled_name.map_or(String::new(), |name| format!("; it is like {name}"));
        format!("{trouble}{resembled_name}")
    }

    /// The message for films whose number of walks differs from the number of names.
    fn count_mismatch_message(&self, walks: &[Walk], least_rest: f64) -> String {
        let names: Vec<&str> = self.named.iter().map(Candidate::name).collect();
        let mut text = format!(
            "{} walks between rests of {least_rest:.1} s or more, and --gait names {}: {}",
            walks.len(),
            names.len(),
            names.join(", ")
        );
        let mut missing_names = names;
        let mut is_clear = true;
        for walk in walks {
            let resembled_name = self.resembled_gait(*walk);
            let [from, to] = walk.during;
            let _ = write!(
                text,
                "\n  {}, {:.1} s long: like {}",
                walk.label(),
                to - from,
                resembled_name.unwrap_or("no gait clearly")
            );
            match resembled_name.and_then(|resembled_name| {
                missing_names
                    .iter()
                    .position(|name| *name == resembled_name)
            }) {
                Some(index) => {
                    missing_names.remove(index);
                }
                None => is_clear = false,
            }
        }
        if is_clear && !missing_names.is_empty() {
            let _ = write!(text, "\nno walk is like {}", missing_names.join(", "));
        }
        text
    }
}
