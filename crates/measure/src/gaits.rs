//! The gaits of a film's walks, named by the user or recognised from their paths.

use std::cell::OnceCell;
use std::fmt::Write as _;

use lizard_film::{Gait, GaitMatch, MeasuredGait, Trouble, shortest_rest};
use lizard_robot::{CheckedGait, Robot};

use crate::named_film::{NamedFilm, Walk};
use crate::predicted_gait::predict_gait;

/// Smallest speed of the gaits that are considered if the user names none, mm/s at a pace of 1.
const MIN_SPEED: f64 = 3.0;

/// A gait and the path that it is predicted to take.
#[derive(Debug)]
pub(crate) struct Candidate<'a> {
    pub gait: &'a CheckedGait,
    pub predicted_gait: Gait,
}

impl<'a> Candidate<'a> {
    fn new(robot: &Robot, gait: &'a CheckedGait, pace: f64) -> Self {
        let predicted_gait = predict_gait(robot, gait, pace);
        Self {
            gait,
            predicted_gait,
        }
    }

    pub(crate) fn name(&self) -> &'a str {
        self.gait.name()
    }
}

/// A walk in a film, and its measured gait.
#[derive(Debug)]
pub struct MeasuredWalk<'f> {
    pub(crate) walk: Walk<'f>,
    /// Index of the walk's gait in [`Gaits::candidates`].
    pub(crate) candidate_index: usize,
    pub(crate) measured_gait: MeasuredGait,
}

/// The gaits that a film may show.
#[derive(Debug)]
pub struct Gaits<'a> {
    robot: &'a Robot,
    /// Pace as a multiple of each gait's own.
    pace: f64,
    /// The gaits that the user names, in their order.
    named_candidates: Vec<Candidate<'a>>,
    /// All gaits that are fast enough to be considered; computed at the first use.
    all_candidates: OnceCell<Vec<Candidate<'a>>>,
}

impl<'a> Gaits<'a> {
    /// Prepares the gaits that the user names, in their order; the list is empty if the user names none. `pace` is a
    /// multiple of each gait's own pace.
    pub fn new(robot: &'a Robot, named_gaits: &[&'a CheckedGait], pace: f64) -> Self {
        let candidate_of = |gait: &&'a CheckedGait| Candidate::new(robot, gait, pace);
        Self {
            robot,
            pace,
            named_candidates: named_gaits.iter().map(candidate_of).collect(),
            all_candidates: OnceCell::new(),
        }
    }

    /// The gaits that a walk can have: those that the user names, or all if the user names none.
    pub(crate) fn candidates(&self) -> &[Candidate<'a>] {
        match self.named_candidates.is_empty() {
            true => self.all_candidates(),
            false => &self.named_candidates,
        }
    }

    /// All gaits of robot.toml that are fast enough to be considered, predicted on the first call.
    fn all_candidates(&self) -> &[Candidate<'a>] {
        self.all_candidates.get_or_init(|| {
            let moving_gaits = self.robot.gaits().iter().filter(|gait| gait.has_movement());
            let candidates = moving_gaits.map(|gait| Candidate::new(self.robot, gait, self.pace));
            // A gait that hardly moves the robot would make the shortest rest between two walks too long.
            let is_fast =
                |candidate: &Candidate| candidate.predicted_gait.speed() > MIN_SPEED * self.pace;
            candidates.filter(is_fast).collect()
        })
    }

    /// Finds the walks of films, and measures the gait of each walk.
    ///
    /// # Errors
    /// Fails with a message for the user if several gaits are named and their number is not that of the walks, if a
    /// walk does not clearly match a gait, or if a walk does not fit its gait.
    pub fn measure_walks<'f>(
        &self,
        films: &'f [NamedFilm],
    ) -> Result<Vec<MeasuredWalk<'f>>, String> {
        let predicted_gaits: Vec<Gait> = self
            .candidates()
            .iter()
            .map(|candidate| candidate.predicted_gait.clone())
            .collect();
        let min_rest = shortest_rest(&predicted_gaits);
        let walks: Vec<Walk> = films.iter().flat_map(|film| film.walks(min_rest)).collect();
        let name_count = self.named_candidates.len();
        if name_count > 1 && name_count != walks.len() {
            return Err(self.count_mismatch_message(&walks, min_rest));
        }
        let measured_walks = walks.into_iter().enumerate().map(|(i, walk)| {
            let candidate_index = match name_count {
                0 => self.recognise_gait(walk)?,
                1 => 0,
                _ => i,
            };
            let candidate = &self.candidates()[candidate_index];
            let measured_gait = walk
                .film
                .analysis
                .measure(&candidate.predicted_gait, Some(walk.interval));
            let measured_gait = measured_gait.map_err(|trouble| {
                format!(
                    "{}, {}: {}",
                    walk.label(),
                    candidate.name(),
                    self.mismatch_message(walk, candidate, trouble)
                )
            })?;
            Ok(MeasuredWalk {
                walk,
                candidate_index,
                measured_gait,
            })
        });
        measured_walks.collect()
    }

    /// Measures one of the named gaits, given by its index, between two times of a film, s, or in the whole film.
    ///
    /// # Errors
    /// Fails with a message for the user if no gait has this index, or if the film does not show the gait in that time.
    pub fn measure_walk<'f>(
        &self,
        candidate_index: usize,
        film: &'f NamedFilm,
        interval: Option<[f64; 2]>,
    ) -> Result<MeasuredWalk<'f>, String> {
        let candidate = self.named_candidates.get(candidate_index);
        let candidate = candidate.ok_or_else(|| Trouble::NoGait.to_string())?;
        let walk = Walk {
            film,
            interval: interval.or_else(|| film.time_range()).unwrap_or_default(),
        };
        let measured_gait = film.analysis.measure(&candidate.predicted_gait, interval);
        let measured_gait =
            measured_gait.map_err(|trouble| self.mismatch_message(walk, candidate, trouble))?;
        Ok(MeasuredWalk {
            walk,
            candidate_index,
            measured_gait,
        })
    }

    /// Recognises the gait of a walk and returns its index; fails with a message if the walk matches no gait, or two.
    fn recognise_gait(&self, walk: Walk) -> Result<usize, String> {
        let name_of = |index: usize| self.all_candidates()[index].name();
        let (reason, needs_names) = match self.match_gait(walk) {
            GaitMatch::Unique(index) => return Ok(index),
            GaitMatch::Ambiguous { best, second_best } => (
                format!(
                    "the path is most like {}, and nearly as much like {}",
                    name_of(best),
                    name_of(second_best)
                ),
                true,
            ),
            GaitMatch::NoMatch(Trouble::GaitMismatch { .. }) => (
                "the path is like no gait of robot.toml at this pace".to_owned(),
                true,
            ),
            GaitMatch::NoMatch(trouble) => (trouble.to_string(), false),
        };
        let hint = match needs_names {
            true => "; name the gait of each walk",
            false => "",
        };
        Err(format!("{}: {reason}{hint}", walk.label()))
    }

    /// Finds which gait of robot.toml a walk shows.
    fn match_gait(&self, walk: Walk) -> GaitMatch {
        let predicted_gaits: Vec<Gait> = self
            .all_candidates()
            .iter()
            .map(|candidate| candidate.predicted_gait.clone())
            .collect();
        walk.film
            .analysis
            .match_gait(&predicted_gaits, walk.interval)
    }

    /// Finds the name of the gait that a walk clearly matches; `None` if it matches no gait, or two.
    pub(crate) fn find_matching_gait(&self, walk: Walk) -> Option<&'a str> {
        match self.match_gait(walk) {
            GaitMatch::Unique(index) => Some(self.all_candidates()[index].name()),
            _ => None,
        }
    }

    /// The message for a walk that does not fit its gait, with the gait that it matches instead.
    fn mismatch_message(&self, walk: Walk, candidate: &Candidate, trouble: Trouble) -> String {
        let matching_name = match trouble {
            Trouble::GaitMismatch { .. } | Trouble::WrongPace { .. } => {
                self.find_matching_gait(walk)
            }
            _ => None,
        };
        let matching_name = matching_name.filter(|name| *name != candidate.name());
        let match_text = matching_name.map_or(String::new(), |name| format!("; it is like {name}"));
        format!("{trouble}{match_text}")
    }

    /// The message for films whose number of walks differs from the number of names.
    fn count_mismatch_message(&self, walks: &[Walk], min_rest: f64) -> String {
        let names: Vec<&str> = self.named_candidates.iter().map(Candidate::name).collect();
        let mut text = format!(
            "{} walks between rests of {min_rest:.1} s or more, and --gait names {}: {}",
            walks.len(),
            names.len(),
            names.join(", ")
        );
        let mut unmatched_names = names;
        let mut are_all_matched = true;
        for walk in walks {
            let matching_name = self.find_matching_gait(*walk);
            let [from, to] = walk.interval;
            let _ = write!(
                text,
                "\n  {}, {:.1} s long: like {}",
                walk.label(),
                to - from,
                matching_name.unwrap_or("no gait clearly")
            );
            match matching_name.and_then(|matching_name| {
                unmatched_names
                    .iter()
                    .position(|name| *name == matching_name)
            }) {
                Some(index) => {
                    unmatched_names.remove(index);
                }
                None => are_all_matched = false,
            }
        }
        if are_all_matched && !unmatched_names.is_empty() {
            let _ = write!(text, "\nno walk is like {}", unmatched_names.join(", "));
        }
        text
    }
}
