//! Stores the video that the page records, and measures the gaits in it.

use std::error::Error;

use lizard_measure::{Gaits, NamedVideo, Report, compute_deck_height};
use lizard_robot::Robot;
use lizard_video::{Frame, Setup, Tag, Video, VideoError, sheet};
use serde::{Deserialize, Serialize};
use tsify::Tsify;

/// A tag in a frame.
#[derive(Debug, Clone, PartialEq, Serialize, Tsify)]
pub struct TagEntry {
    /// The tag's id on the sheet.
    pub id: usize,
    /// The corners in the image, px, in the order top left, top right, bottom right and bottom left of the printed tag.
    #[tsify(type = "[Pixel, Pixel, Pixel, Pixel]")]
    pub corners: [[f64; 2]; 4],
}

/// A request to measure gaits in the video.
#[derive(Debug, Clone, PartialEq, Deserialize, Tsify)]
pub struct MeasureRequest {
    /// The content of robot.toml.
    pub toml: String,
    /// The pace, percent of a gait's nominal pace.
    pub speed: u8,
    /// Height of the deck tag above the floor, mm; `None` if it lies on the robot's board, whose height is computed.
    pub deck_height: Option<f64>,
    /// Measured length, mm, of the line on the sheet that should be 100 mm long.
    pub ruler_length: f64,
    /// The walks to measure. If empty, the video is split where the robot rests, and each part is assigned the gait
    /// that it matches.
    pub walks: Vec<RequestedWalk>,
}

/// A walk to measure in the video.
#[derive(Debug, Clone, PartialEq, Deserialize, Tsify)]
pub struct RequestedWalk {
    /// The gait's name.
    pub gait: String,
    /// Start and end of the walk on the video's clock, s; `None` for the whole video.
    pub during: Option<[f64; 2]>,
}

/// The measured displacements of gaits.
#[derive(Debug, Clone, PartialEq, Serialize, Tsify)]
pub struct Results {
    /// The gaits as `lizard measure --json` prints them; walks of the same gait are combined.
    #[tsify(type = "Report[]")]
    pub gaits: serde_json::Value,
    /// For each requested walk that cannot be measured, a message with its gait and the reason.
    pub problems: Vec<String>,
}

/// The video that the page's camera has recorded so far, and its analysis.
#[derive(Debug, Default)]
pub struct Camera {
    video: Video,
    /// The analysis of the video, and the setup for which it is valid; `None` after a new frame.
    cached_analysis: Option<(Setup, NamedVideo)>,
}

impl Camera {
    /// Finds the tags in a frame without adding it to the video.
    pub fn find_tags(&mut self, frame: &Frame) -> Vec<TagEntry> {
        let tags = self.video.find_tags(frame).into_iter();
        tags.map(|Tag { id, corners }| TagEntry { id, corners })
            .collect()
    }

    /// Adds the next frame, taken at `seconds` on the video's clock, and returns the frame's tags.
    ///
    /// # Errors
    /// Fails if the frame does not fit the video, or shows a tag twice.
    pub fn add_frame(&mut self, frame: &Frame, seconds: f64) -> Result<Vec<TagEntry>, VideoError> {
        self.cached_analysis = None;
        let tags = self.video.add_frame(seconds, frame)?;
        let to_entry = |(id, corners): (usize, Option<_>)| {
            let corners = corners?;
            Some(TagEntry { id, corners })
        };
        Ok(tags.into_iter().enumerate().filter_map(to_entry).collect())
    }

    /// Measures gaits in the video.
    ///
    /// # Errors
    /// Fails if robot.toml is invalid, if a requested gait does not exist or does not move the robot, if the video
    /// cannot be measured, or if a walk without a requested gait does not clearly match one.
    pub fn measure(&mut self, request: &MeasureRequest) -> Result<Results, Box<dyn Error>> {
        let robot = Robot::parse(&request.toml)?;
        let find_gait = |walk: &RequestedWalk| {
            let gait = robot.gait(&walk.gait).filter(|gait| gait.has_movement());
            gait.ok_or_else(|| format!("no gait `{}` moves this robot", walk.gait))
        };
        let lookups = request.walks.iter().map(find_gait);
        let named_gaits = lookups.collect::<Result<Vec<_>, _>>()?;
        let deck_height = request.deck_height;
        let setup = Setup {
            print_scale: request.ruler_length / sheet::RULER_LENGTH,
            deck_height: deck_height.unwrap_or_else(|| compute_deck_height(&robot)),
        };
        let gaits = Gaits::predict(&robot, &named_gaits, request.speed);
        let video = match self.cached_analysis.take() {
            Some((cached_setup, video)) if cached_setup == setup => video,
            _ => NamedVideo {
                name: "the video".to_owned(),
                analysis: self.video.analyse(setup)?,
            },
        };
        let (_, video) = self.cached_analysis.insert((setup, video));
        let videos = std::slice::from_ref(&*video);
        let mut problems = Vec::new();
        let walks = match request.walks.is_empty() {
            true => gaits.measure_walks(videos)?,
            false => {
                let measured_walks = request.walks.iter().enumerate().filter_map(|(i, walk)| {
                    let result = gaits.measure_walk(i, &videos[0], walk.during);
                    let add_problem = |reason| problems.push(format!("{}: {reason}", walk.gait));
                    result.map_err(add_problem).ok()
                });
                measured_walks.collect()
            }
        };
        let report = Report::compute(&request.toml, setup, videos, &gaits, &walks);
        Ok(Results {
            gaits: serde_json::to_value(&report.gaits)?,
            problems,
        })
    }
}
