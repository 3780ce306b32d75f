//! The gaits of a video's walks, named by the user or recognised from their paths.

use std::cell::OnceCell;
use std::fmt::Write as _;

use lizard_robot::{CheckedGait, Robot};
use lizard_video::{Gait, GaitMatch, MeasuredGait, VideoError, min_rest_duration};

use crate::named_video::{NamedVideo, Walk};
use crate::predicted_gait::predict_gait;

/// Smallest speed of a gait that is considered if the user names none, mm/s at the nominal pace.
const MIN_SPEED: f64 = 3.0;

/// A gait that a walk may show, and its predicted path.
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

/// A walk in a video and its measured gait.
#[derive(Debug)]
pub struct MeasuredWalk<'f> {
    pub(crate) walk: Walk<'f>,
    /// Index of the walk's gait in [`Gaits::candidates`].
    pub(crate) candidate_index: usize,
    pub(crate) measured_gait: MeasuredGait,
}

/// The gaits that a video may show.
#[derive(Debug)]
pub struct Gaits<'a> {
    pub(crate) robot: &'a Robot,
    /// Pace, percent of each gait's nominal pace.
    pub(crate) pace_percent: u8,
    /// Pace as a multiple of each gait's nominal pace.
    pub(crate) pace: f64,
    /// The gaits that the user names, in the user's order.
    named_candidates: Vec<Candidate<'a>>,
    /// All gaits that are fast enough to be considered; predicted on the first use.
    all_candidates: OnceCell<Vec<Candidate<'a>>>,
}

impl<'a> Gaits<'a> {
    /// Predicts the gaits that the user names, in the user's order. `named_gaits` is empty if the user names none.
    /// `pace_percent` is relative to each gait's nominal pace.
    pub fn predict(robot: &'a Robot, named_gaits: &[&'a CheckedGait], pace_percent: u8) -> Self {
        let pace = f64::from(pace_percent) / 100.0;
        let to_candidate = |gait: &&'a CheckedGait| Candidate::new(robot, gait, pace);
        Self {
            robot,
            pace_percent,
            pace,
            named_candidates: named_gaits.iter().map(to_candidate).collect(),
            all_candidates: OnceCell::new(),
        }
    }

    /// Returns the gaits that a walk can have: the named gaits, or all gaits if the user names none.
    pub(crate) fn candidates(&self) -> &[Candidate<'a>] {
        match self.named_candidates.is_empty() {
            true => self.all_candidates(),
            false => &self.named_candidates,
        }
    }

    /// Returns all gaits in robot.toml that are fast enough to be considered; predicts them on the first call.
    fn all_candidates(&self) -> &[Candidate<'a>] {
        self.all_candidates.get_or_init(|| {
            let moving_gaits = self.robot.gaits().iter().filter(|gait| gait.has_movement());
            let pace = self.pace;
            let candidates = moving_gaits.map(|gait| Candidate::new(self.robot, gait, pace));
            // A gait that hardly moves the robot would make the minimum duration of a rest too long.
            let is_fast =
                |candidate: &Candidate| candidate.predicted_gait.speed() > MIN_SPEED * pace;
            candidates.filter(is_fast).collect()
        })
    }

    /// Finds the walks in videos, and measures the gait of each walk.
    ///
    /// # Errors
    /// Fails with a message for the user if the number of named gaits is larger than one and differs from the number of
    /// walks, or if a walk does not clearly match a gait, or does not match its named gait.
    pub fn measure_walks<'f>(
        &self,
        videos: &'f [NamedVideo],
    ) -> Result<Vec<MeasuredWalk<'f>>, String> {
        let min_rest = min_rest_duration(&predicted_gaits(self.candidates()));
        let walks = videos.iter().flat_map(|video| video.find_walks(min_rest));
        let walks: Vec<Walk> = walks.collect();
        let name_count = self.named_candidates.len();
        if name_count > 1 && name_count != walks.len() {
            return Err(self.format_count_mismatch(&walks, min_rest));
        }
        let measured_walks = walks.into_iter().enumerate().map(|(i, walk)| {
            let candidate_index = match name_count {
                0 => self.recognise_gait(walk)?,
                1 => 0,
                _ => i,
            };
            self.measure_as(candidate_index, walk).map_err(|message| {
                let name = self.candidates()[candidate_index].name();
                format!("{}, {name}: {message}", walk.format_label())
            })
        });
        measured_walks.collect()
    }

    /// Measures one of the named gaits, given by its index, between two times in a video, s, or in the whole video.
    ///
    /// # Errors
    /// Fails with a message for the user if no gait has this index, or if the video does not show the gait.
    pub fn measure_walk<'f>(
        &self,
        candidate_index: usize,
        video: &'f NamedVideo,
        interval: Option<[f64; 2]>,
    ) -> Result<MeasuredWalk<'f>, String> {
        if candidate_index >= self.named_candidates.len() {
            return Err(VideoError::NoGait.to_string());
        }
        let interval = interval.or_else(|| video.time_range()).unwrap_or_default();
        self.measure_as(candidate_index, Walk { video, interval })
    }

    /// Measures a candidate, given by its index, in a walk; fails with a message if the walk does not show it.
    fn measure_as<'f>(
        &self,
        candidate_index: usize,
        walk: Walk<'f>,
    ) -> Result<MeasuredWalk<'f>, String> {
        let candidate = &self.candidates()[candidate_index];
        let analysis = &walk.video.analysis;
        let measured_gait = analysis.measure(&candidate.predicted_gait, Some(walk.interval));
        let measured_gait =
            measured_gait.map_err(|error| self.format_mismatch(walk, candidate, error))?;
        Ok(MeasuredWalk {
            walk,
            candidate_index,
            measured_gait,
        })
    }

    /// Recognises the gait of a walk and returns its index; fails with a message if the walk matches no gait, or two.
    fn recognise_gait(&self, walk: Walk) -> Result<usize, String> {
        const ADVICE: &str = "; name the gait of each walk";
        let name_at = |index: usize| self.all_candidates()[index].name();
        let message = match self.match_gait(walk) {
            GaitMatch::Unique(index) => return Ok(index),
            GaitMatch::Ambiguous { best, second_best } => format!(
                "the path resembles {} and, nearly as much, {}{ADVICE}",
                name_at(best),
                name_at(second_best)
            ),
            GaitMatch::NoMatch(VideoError::GaitMismatch { .. }) => {
                format!("the path resembles no gait in robot.toml at this pace{ADVICE}")
            }
            GaitMatch::NoMatch(error) => error.to_string(),
        };
        Err(format!("{}: {message}", walk.format_label()))
    }

    /// Finds the gait in robot.toml that a walk shows.
    fn match_gait(&self, walk: Walk) -> GaitMatch {
        let gaits = predicted_gaits(self.all_candidates());
        walk.video.analysis.match_gait(&gaits, walk.interval)
    }

    /// Finds the name of the gait that a walk clearly matches; `None` if it matches no gait, or two.
    pub(crate) fn find_matching_gait(&self, walk: Walk) -> Option<&'a str> {
        match self.match_gait(walk) {
            GaitMatch::Unique(index) => Some(self.all_candidates()[index].name()),
            _ => None,
        }
    }

    /// Formats the message for a walk that does not match its gait, with the gait that it resembles instead.
    fn format_mismatch(&self, walk: Walk, candidate: &Candidate, error: VideoError) -> String {
        if let VideoError::GaitMismatch { .. } | VideoError::WrongPace { .. } = error
            && let Some(name) = self.find_matching_gait(walk)
            && name != candidate.name()
        {
            return format!("{error}; it resembles {name}");
        }
        error.to_string()
    }

    /// Formats the message for videos whose number of walks differs from the number of named gaits.
    fn format_count_mismatch(&self, walks: &[Walk], min_rest: f64) -> String {
        let names: Vec<&str> = self.named_candidates.iter().map(Candidate::name).collect();
        let mut text = format!(
            "found {} walks between rests of at least {min_rest:.1} s, but --gait names {}: {}",
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
                "\n  {}, {:.1} s long: resembles {}",
                walk.format_label(),
                to - from,
                matching_name.unwrap_or("no gait clearly")
            );
            let mut names = unmatched_names.iter();
            match names.position(|name| Some(*name) == matching_name) {
                Some(index) => {
                    unmatched_names.remove(index);
                }
                None => are_all_matched = false,
            }
        }
        if are_all_matched && !unmatched_names.is_empty() {
            let _ = write!(text, "\nno walk resembles {}", unmatched_names.join(", "));
        }
        text
    }
}

/// Returns the predicted paths of candidates.
fn predicted_gaits(candidates: &[Candidate]) -> Vec<Gait> {
    let to_gait = |candidate: &Candidate| candidate.predicted_gait.clone();
    candidates.iter().map(to_gait).collect()
}
