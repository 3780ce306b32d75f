//! The measured movements of gaits compared with the predicted movements, as text and as JSON.

use std::fmt::Write as _;

use lizard_robot::{BodyPose, Travel, UNDETERMINED_NOTE};
use lizard_video::{CyclePoint, MeasuredGait, Setup};
use serde::Serialize;

use crate::component::{COMPONENT_LABELS, Component};
use crate::gaits::{Candidate, Gaits, MeasuredWalk};
use crate::mujoco::find_mujoco_movement;
use crate::named_video::NamedVideo;
use crate::prediction_range::PredictionRange;

/// Largest deviation of a path from its prediction that counts as agreement, standard errors. The limit is larger than
/// for a single value, because it applies to the largest of 72 deviations. If all deviations are random, the largest
/// one exceeds the limit in one video out of 30.
const PATH_AGREEMENT_LIMIT: f64 = 3.5;

/// The result of a measurement. `lizard measure --json` prints its fields.
#[derive(Debug, Serialize)]
pub struct Report<'a> {
    videos: Vec<VideoReport<'a>>,
    /// The gaits, in the order of their first walks.
    pub gaits: Vec<GaitReport<'a>>,
}

/// A video and its camera.
#[derive(Debug, Serialize)]
struct VideoReport<'a> {
    #[serde(rename = "video")]
    name: &'a str,
    /// Number of frames in which the robot's pose is known.
    #[serde(rename = "frames")]
    frame_count: usize,
    camera: CameraReport,
}

/// The measured result for one gait.
#[derive(Debug, Serialize)]
pub struct GaitReport<'a> {
    /// Name of the gait.
    #[serde(rename = "gait")]
    pub name: &'a str,
    /// Pace, percent of the gait's nominal pace.
    #[serde(rename = "speed")]
    pace_percent: u8,
    walks: Vec<WalkReport<'a>>,
    /// Number of complete cycles.
    #[serde(rename = "cycles")]
    pub cycle_count: usize,
    /// Mean duration of a cycle, s.
    period: f64,
    /// Standard error of the mean duration, s.
    period_error: f64,
    /// Duration of a cycle according to robot.toml, s.
    #[serde(rename = "period_expected")]
    expected_period: f64,
    /// Distance forward in a cycle, mm, along the robot's heading at the start of the cycle.
    pub forward: Component,
    /// Distance to the left in a cycle, mm.
    pub left: Component,
    /// Turn in a cycle, deg, counter-clockwise positive.
    pub turn: Component,
    /// The movement in each cycle.
    #[serde(rename = "each")]
    cycle_movements: Vec<CycleMovement>,
    /// The mean path within a cycle, with the predicted path.
    #[serde(rename = "within")]
    pub mean_path: Vec<PhasePoint>,
    /// The mean path's largest deviation from the predicted path; `None` if no component of the movement is predicted.
    #[serde(rename = "farthest")]
    largest_deviation: Option<LargestDeviation>,
    /// Movement per cycle according to MuJoCo with ideal servos: mm forward, mm to the left, deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    mujoco: Option<[f64; 3]>,
    /// Range of the prediction when one assumption at a time is changed.
    #[serde(rename = "range")]
    prediction_range: PredictionRange,
    /// The predicted path of a cycle, at equal time steps.
    #[serde(skip)]
    pub predicted_path: &'a [BodyPose],
}

/// A walk between two rests.
#[derive(Debug, Serialize)]
struct WalkReport<'a> {
    video: &'a str,
    /// Start in the video, s, including a part of the previous rest.
    #[serde(rename = "from")]
    start_s: f64,
    /// End in the video, s, including a part of the next rest.
    #[serde(rename = "to")]
    end_s: f64,
    /// Another gait in robot.toml that the path clearly matches, if any.
    #[serde(rename = "like", skip_serializing_if = "Option::is_none")]
    matching_gait: Option<&'a str>,
}

/// A point of the path within a cycle.
#[derive(Debug, Serialize)]
pub struct PhasePoint {
    /// Phase of the cycle, 0 to 1.
    phase: f64,
    /// Distance forward since the start of the cycle, mm.
    pub forward: Component,
    /// Distance to the left since the start of the cycle, mm.
    pub left: Component,
    /// Turn since the start of the cycle, deg, counter-clockwise positive.
    pub turn: Component,
}

/// The largest deviation from the predicted path within a cycle.
#[derive(Debug, Serialize)]
struct LargestDeviation {
    /// Phase of the cycle, 0 to 1.
    phase: f64,
    /// The component of the movement, one of [`COMPONENT_LABELS`].
    #[serde(rename = "part")]
    component: &'static str,
    /// Measured minus predicted, mm or deg.
    difference: f64,
    /// Measured minus predicted, in standard errors.
    #[serde(rename = "differs")]
    standardised_difference: f64,
    /// True if the standardised difference is at most [`PATH_AGREEMENT_LIMIT`].
    agrees: bool,
}

/// The movement in one cycle: forward and left in mm, turn in deg.
#[derive(Debug, Serialize)]
struct CycleMovement {
    forward: f64,
    left: f64,
    turn: f64,
}

/// The camera of a video, estimated from the tags.
#[derive(Debug, Serialize)]
struct CameraReport {
    /// Height above the floor, mm.
    height: f64,
    /// Tilt from straight down, deg.
    tilt: f64,
    /// Focal length, px.
    #[serde(rename = "focal")]
    focal_length: f64,
    /// Root-mean-square error of a floor tag's corner, px.
    #[serde(rename = "corners")]
    corner_error: f64,
    /// True if the camera moved during the video.
    #[serde(rename = "moved")]
    has_moved: bool,
    /// Height of the deck tag above the floor as entered by the user, mm.
    #[serde(rename = "deck")]
    deck_tag_height: f64,
    /// Height of the deck tag above the floor, computed from its size in the frames, mm.
    #[serde(rename = "deck_by_size")]
    estimated_deck_tag_height: f64,
}

impl LargestDeviation {
    /// Finds the largest deviation, in standard errors, among the predicted components of the movement.
    fn find(points: &[CyclePoint], predicted: [Option<f64>; 3]) -> Option<Self> {
        let deviations = points.iter().flat_map(|point| {
            let differences = point.standardised_differences();
            (0..3).map(move |axis| (point, axis, differences[axis]))
        });
        let predicted_deviations = deviations.filter(|(_, axis, _)| predicted[*axis].is_some());
        let (point, axis, standardised_difference) =
            predicted_deviations.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))?;
        Some(Self {
            phase: point.phase,
            component: COMPONENT_LABELS[axis],
            difference: point.measured[axis].value - point.predicted[axis],
            standardised_difference,
            agrees: standardised_difference.abs() <= PATH_AGREEMENT_LIMIT,
        })
    }

    fn format_line(&self, point_count: usize) -> String {
        let verdict = if self.agrees { "agrees" } else { "differs" };
        let (name, unit) = self.component.split_once(", ").unwrap_or_default();
        format!(
            "path within a cycle {verdict}: largest deviation in {point_count} phases {:+.2} {unit} {name} at \
             phase {:.2}, {:.1} std. errors\n",
            self.difference,
            self.phase,
            self.standardised_difference.abs()
        )
    }
}

impl<'a> GaitReport<'a> {
    /// Combines all walks of a gait into a report.
    fn compute(
        robot_toml: &str,
        gaits: &Gaits<'a>,
        candidate: &'a Candidate,
        walks: &[&MeasuredWalk<'a>],
    ) -> Self {
        let robot = gaits.robot;
        let mujoco = match gaits.pace_percent {
            100 => find_mujoco_movement(robot_toml, candidate.name()),
            _ => None,
        };
        let predicted_gait = &candidate.predicted_gait;
        let measured_gaits = walks.iter().map(|walk| walk.measured_gait.clone());
        let measured_gaits: Vec<MeasuredGait> = measured_gaits.collect();
        let measured_gait = MeasuredGait::combine(&measured_gaits, predicted_gait);
        let travel = predicted_gait.path.last().map(|pose| pose.travel());
        let prediction = robot.predict(candidate.gait);
        let prediction = travel.map_or(prediction, |travel| prediction.keep_determined(travel));
        let predicted_values = [prediction.forward, prediction.left, prediction.turn];
        let forward = Component::new(measured_gait.forward, prediction.forward);
        let left = Component::new(measured_gait.left, prediction.left);
        let turn = Component::new(measured_gait.turn, prediction.turn);
        let differs_from_prediction = [&forward, &left, &turn]
            .iter()
            .any(|component| component.agrees == Some(false));
        let to_phase_point = |point: &CyclePoint| {
            let [forward, left, turn] = [0, 1, 2].map(|i| {
                let predicted_value = predicted_values[i].is_some().then_some(point.predicted[i]);
                Component::new(point.measured[i], predicted_value)
            });
            PhasePoint {
                phase: point.phase,
                forward,
                left,
                turn,
            }
        };
        let to_walk_report = |measured_walk: &&MeasuredWalk<'a>| {
            let walk = measured_walk.walk;
            // Another gait matters only if the walk differs from its prediction.
            let matching_gait = match differs_from_prediction {
                true => gaits.find_matching_gait(walk),
                false => None,
            };
            WalkReport {
                video: &walk.video.name,
                start_s: walk.interval[0],
                end_s: walk.interval[1],
                matching_gait: matching_gait.filter(|name| *name != candidate.name()),
            }
        };
        let to_cycle_movement = |travel: &Travel| CycleMovement {
            forward: travel.forward,
            left: travel.left,
            turn: travel.turn,
        };
        let cycle_path = &measured_gait.cycle_path;
        Self {
            name: candidate.name(),
            pace_percent: gaits.pace_percent,
            walks: walks.iter().map(to_walk_report).collect(),
            cycle_count: measured_gait.cycles.len(),
            period: measured_gait.period.value,
            period_error: measured_gait.period.standard_error,
            expected_period: predicted_gait.period,
            forward,
            left,
            turn,
            cycle_movements: measured_gait.cycles.iter().map(to_cycle_movement).collect(),
            mean_path: cycle_path.iter().map(to_phase_point).collect(),
            largest_deviation: LargestDeviation::find(cycle_path, predicted_values),
            mujoco,
            prediction_range: PredictionRange::compute(robot, candidate.gait, gaits.pace),
            predicted_path: &predicted_gait.path,
        }
    }

    /// Returns the components of the movement: forward, left and turn.
    pub fn components(&self) -> [&Component; 3] {
        [&self.forward, &self.left, &self.turn]
    }

    fn format_text(&self) -> String {
        let mut text = format!(
            "\n{} at {} %: {} complete cycles of {:.3} s (robot.toml: {:.3} s)\n",
            self.name, self.pace_percent, self.cycle_count, self.period, self.expected_period,
        );
        for walk in &self.walks {
            let (video, start_s, end_s) = (walk.video, walk.start_s, walk.end_s);
            let _ = write!(text, "{video}, {start_s:.1} to {end_s:.1} s");
            if let Some(name) = walk.matching_gait {
                let _ = write!(text, ", resembles {name} more");
            }
            text.push('\n');
        }
        text += "per cycle    measured      sd   error  predicted\n";
        for (label, component) in COMPONENT_LABELS.iter().zip(self.components()) {
            text += &component.format_line(label);
        }
        text += &self.prediction_range.format_line();
        if let Some([forward, left, turn]) = self.mujoco {
            let _ = writeln!(
                text,
                "MuJoCo with ideal servos: {forward:+.2} mm ahead, {left:+.2} mm left, {turn:+.2} deg"
            );
        }
        if let Some(deviation) = &self.largest_deviation {
            text += &deviation.format_line(self.mean_path.len());
        }
        text
    }
}

impl<'a> Report<'a> {
    /// Reports the walks in videos, and combines walks of the same gait. The ranges of the predictions take a second
    /// for each gait. `robot_toml` is the text of the robot's file: for the project's own robots at full pace, the
    /// report also has the movements according to MuJoCo.
    pub fn compute(
        robot_toml: &str,
        setup: Setup,
        videos: &'a [NamedVideo],
        gaits: &'a Gaits<'a>,
        walks: &[MeasuredWalk<'a>],
    ) -> Self {
        let mut walks_by_gait: Vec<(&Candidate, Vec<&MeasuredWalk>)> = Vec::new();
        for walk in walks {
            let candidate = &gaits.candidates()[walk.candidate_index];
            let mut groups = walks_by_gait.iter_mut();
            match groups.find(|(listed, _)| listed.name() == candidate.name()) {
                Some((_, walks)) => walks.push(walk),
                None => walks_by_gait.push((candidate, vec![walk])),
            }
        }
        let to_video_report = |video: &'a NamedVideo| {
            let camera = &video.analysis.camera;
            VideoReport {
                name: &video.name,
                frame_count: video.analysis.path.len(),
                camera: CameraReport {
                    height: camera.height,
                    tilt: camera.tilt,
                    focal_length: camera.focal_length,
                    corner_error: camera.corner_error,
                    has_moved: camera.has_camera_moved,
                    deck_tag_height: setup.deck_height,
                    estimated_deck_tag_height: camera.deck_height,
                },
            }
        };
        let to_gait_report = |(candidate, walks): &(&'a Candidate, Vec<&MeasuredWalk<'a>>)| {
            GaitReport::compute(robot_toml, gaits, candidate, walks)
        };
        Self {
            videos: videos.iter().map(to_video_report).collect(),
            gaits: walks_by_gait.iter().map(to_gait_report).collect(),
        }
    }

    /// Formats the report as tables.
    pub fn format_text(&self) -> String {
        let mut text = String::new();
        for video in &self.videos {
            let camera = &video.camera;
            let movement_text = if camera.has_moved { ", moving" } else { "" };
            let _ = writeln!(
                text,
                "{}: {} frames\n\
                 camera {:.0} mm above the floor{movement_text}, {:.0} deg from straight down; corner error {:.2} px\n\
                 deck tag {:.0} mm above the floor, {:.0} mm according to its size",
                video.name,
                video.frame_count,
                camera.height,
                camera.tilt,
                camera.corner_error,
                camera.deck_tag_height,
                camera.estimated_deck_tag_height,
            );
        }
        for gait in &self.gaits {
            text += &gait.format_text();
        }
        let mut components = self.gaits.iter().flat_map(GaitReport::components);
        if components.any(|component| component.predicted.is_none()) {
            let _ = write!(text, "\n{UNDETERMINED_NOTE}");
        }
        text
    }
}
