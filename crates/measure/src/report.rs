//! The measured movements of gaits beside the predicted ones, for people and for scripts.

use std::fmt::Write as _;

use lizard_film::{CyclePoint, MeasuredGait, Setup};
use lizard_robot::{Place, Prediction, Robot, Travel, UNDECIDED_NOTE};
use serde::Serialize;

use crate::component::{COMPONENT_NAMES, Component};
use crate::engine::mujoco_movement;
use crate::gaits::{Candidate, Gaits, MeasuredWalk};
use crate::named_film::NamedFilm;
use crate::range::PredictionRange;

/// Largest difference from the prediction within a cycle, in standard errors, that counts as agreement. It is larger
/// than for a single value, since it applies to the largest of 72 differences. If all of them are random, the largest
/// exceeds it in one of 30 films.
const MAX_AGREEING_ERRORS_OF_ALL: f64 = 3.5;

/// The result of a measurement. `lizard measure --json` prints its fields by their names.
#[derive(Debug, Serialize)]
pub struct Report<'a> {
    films: Vec<FilmLine<'a>>,
    /// The gaits, in the order of their first walks.
    pub gaits: Vec<GaitReport<'a>>,
}

/// A film and its camera.
#[derive(Debug, Serialize)]
struct FilmLine<'a> {
    film: &'a str,
    /// Number of pictures in which the robot's place is known.
    pictures: usize,
    camera: CameraLine,
}

/// The result of a gait.
#[derive(Debug, Serialize)]
pub struct GaitReport<'a> {
    /// Name of the gait.
    pub gait: &'a str,
    /// Pace, percent of the gait's own.
    speed: u8,
    walks: Vec<WalkLine<'a>>,
    /// Number of complete cycles.
    pub cycles: usize,
    /// Mean duration of a cycle, s.
    period: f64,
    /// Standard error of the mean duration, s.
    period_error: f64,
    /// Duration of a cycle by robot.toml, s.
    period_expected: f64,
    /// Distance forward in a cycle, mm, in the robot's frame at the start of the cycle.
    pub forward: Component,
    /// Distance to the left in a cycle, mm.
    pub left: Component,
    /// Turn in a cycle, deg, counter-clockwise positive.
    pub turn: Component,
    /// The movement of each cycle.
    each: Vec<CycleMovement>,
    /// The mean path within a cycle, beside the predicted one.
    pub within: Vec<PhasePoint>,
    /// The largest deviation of that path from the predicted one; null if no component of the movement is predicted.
    farthest: Option<LargestDeviation>,
    /// Movement per cycle according to MuJoCo with ideal servos: mm forward, mm to the left, deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    mujoco: Option<[f64; 3]>,
    /// Range of the prediction if one assumption is wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<PredictionRange>,
    /// The predicted path of a cycle, at equal time steps.
    #[serde(skip)]
    pub predicted_path: &'a [Place],
}

/// A walk between two rests.
#[derive(Debug, Serialize)]
struct WalkLine<'a> {
    film: &'a str,
    /// Start of the walk in the film, s; includes a part of the rest before it.
    from: f64,
    /// End of the walk in the film, s; includes a part of the rest after it.
    to: f64,
    /// The gait of robot.toml that the path clearly matches, if it is not the walk's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    like: Option<&'a str>,
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
    /// The component of the movement, one of [`COMPONENT_NAMES`].
    part: &'static str,
    /// Measured minus predicted, mm or deg.
    difference: f64,
    /// Measured minus predicted, in standard errors.
    differs: f64,
    /// True if `differs` is at most [`MAX_AGREEING_ERRORS_OF_ALL`].
    agrees: bool,
}

/// The movement in a cycle: mm, mm, deg.
#[derive(Debug, Serialize)]
struct CycleMovement {
    forward: f64,
    left: f64,
    turn: f64,
}

/// The camera of a film, as the tags show it.
#[derive(Debug, Serialize)]
struct CameraLine {
    /// Height above the floor, mm.
    height: f64,
    /// Tilt from straight down, deg.
    tilt: f64,
    /// Focal length, px.
    focal: f64,
    /// Root-mean-square error of a floor tag's corner, px.
    corners: f64,
    /// True if the camera moved during the film.
    moved: bool,
    /// Height of the deck's tag above the floor as given, mm.
    deck: f64,
    /// Height of the deck's tag above the floor according to its size in the picture, mm.
    deck_by_size: f64,
}

impl<'a> WalkLine<'a> {
    fn new(
        gaits: &Gaits<'a>,
        measured_walk: &MeasuredWalk<'a>,
        differs_from_prediction: bool,
    ) -> Self {
        let [from, to] = measured_walk.walk.interval;
        let name = gaits.candidates()[measured_walk.candidate_index].name();
        // Another gait matters only if the walk differs from its prediction.
        let matching_name = if differs_from_prediction {
            gaits.find_matching_gait(measured_walk.walk)
        } else {
            None
        };
        Self {
            film: &measured_walk.walk.film.name,
            from,
            to,
            like: matching_name.filter(|matching_name| *matching_name != name),
        }
    }
}

impl LargestDeviation {
    /// Finds the largest deviation, in standard errors, among the components of the movement that are predicted.
    fn find(points: &[CyclePoint], predicted: [Option<f64>; 3]) -> Option<Self> {
        let deviations = points.iter().flat_map(|point| {
            let differs = point.standardised_differences();
            (0..3).map(move |axis| (point, axis, differs[axis]))
        });
        let predicted_deviations = deviations.filter(|(_, axis, _)| predicted[*axis].is_some());
        let (point, axis, differs) =
            predicted_deviations.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))?;
        Some(Self {
            phase: point.phase,
            part: COMPONENT_NAMES[axis],
            difference: point.measured[axis].value - point.predicted[axis],
            differs,
            agrees: differs.abs() <= MAX_AGREEING_ERRORS_OF_ALL,
        })
    }

    fn line(&self, point_count: usize) -> String {
        let Self {
            phase,
            part,
            difference,
            differs,
            agrees,
        } = self;
        let verdict = if *agrees { "agrees" } else { "differs" };
        let (name, unit) = part.split_once(", ").unwrap_or((part, ""));
        format!(
            "path within a cycle {verdict}: of {point_count} phases farthest off at {phase:.2}, by {difference:+.2} {unit} {name}, \
             {:.1} errors\n",
            differs.abs()
        )
    }
}

impl<'a> GaitReport<'a> {
    /// Reports the mean over all walks of a gait.
    fn new(
        robot: &Robot,
        speed: u8,
        gaits: &Gaits<'a>,
        candidate: &'a Candidate,
        walks: &[&MeasuredWalk<'a>],
    ) -> Self {
        let results: Vec<MeasuredGait> = walks
            .iter()
            .map(|walk| walk.measured_gait.clone())
            .collect();
        let measured_gait = MeasuredGait::combine(&results, &candidate.predicted_gait);
        let travel = candidate
            .predicted_gait
            .path
            .last()
            .map(|place| place.travel());
        let prediction = robot.predict(candidate.gait);
        let Prediction {
            forward,
            left,
            turn,
        } = travel.map_or(prediction, |travel| prediction.known_components_of(travel));
        let predicted_values = [forward, left, turn];
        let means = [
            measured_gait.forward,
            measured_gait.left,
            measured_gait.turn,
        ];
        let [forward, left, turn] =
            [0, 1, 2].map(|i| Component::new(means[i], predicted_values[i]));
        let differs_from_prediction = [&forward, &left, &turn]
            .iter()
            .any(|component| component.agrees == Some(false));
        let phase_point_of = |point: &CyclePoint| {
            let part_of = |i: usize| {
                let predicted_value = predicted_values[i].is_some().then_some(point.predicted[i]);
                Component::new(point.measured[i], predicted_value)
            };
            PhasePoint {
                phase: point.phase,
                forward: part_of(0),
                left: part_of(1),
                turn: part_of(2),
            }
        };
        let movement_of = |travel: &Travel| CycleMovement {
            forward: travel.forward,
            left: travel.left,
            turn: travel.turn,
        };
        Self {
            gait: candidate.name(),
            speed,
            walks: walks
                .iter()
                .map(|walk| WalkLine::new(gaits, walk, differs_from_prediction))
                .collect(),
            cycles: measured_gait.cycles.len(),
            period: measured_gait.period.value,
            period_error: measured_gait.period.error,
            period_expected: candidate.predicted_gait.period,
            forward,
            left,
            turn,
            each: measured_gait.cycles.iter().map(movement_of).collect(),
            within: measured_gait
                .cycle_path
                .iter()
                .map(phase_point_of)
                .collect(),
            farthest: LargestDeviation::find(&measured_gait.cycle_path, predicted_values),
            mujoco: None,
            range: None,
            predicted_path: &candidate.predicted_gait.path,
        }
    }

    /// The components of the movement: forward, left and turn.
    pub fn components(&self) -> [&Component; 3] {
        [&self.forward, &self.left, &self.turn]
    }

    fn text(&self) -> String {
        let mut text = format!(
            "\n{} at {} %: {} whole cycles of {:.3} s (by robot.toml {:.3} s)\n",
            self.gait, self.speed, self.cycles, self.period, self.period_expected,
        );
        for WalkLine {
            film,
            from,
            to,
            like,
        } in &self.walks
        {
            let like_text = like.map_or(String::new(), |name| format!(", more like {name}"));
            let _ = writeln!(text, "{film}, {from:.1} to {to:.1} s{like_text}");
        }
        text += "a cycle      measured      sd   error  predicted\n";
        for (name, component) in COMPONENT_NAMES.iter().zip(self.components()) {
            text += &component.line(name);
        }
        if let Some(range) = &self.range {
            text += &range.line();
        }
        if let Some([forward, left, turn]) = self.mujoco {
            let _ = writeln!(
                text,
                "MuJoCo with ideal servos: {forward:+.2} mm ahead, {left:+.2} mm left, {turn:+.2} deg"
            );
        }
        if let Some(farthest) = &self.farthest {
            text += &farthest.line(self.within.len());
        }
        text
    }
}

impl<'a> Report<'a> {
    /// Reports walks in films; walks of the same gait count together. `speed` is the pace, percent of the gait's own.
    pub fn new(
        robot: &Robot,
        speed: u8,
        setup: Setup,
        films: &'a [NamedFilm],
        gaits: &'a Gaits<'a>,
        walks: &[MeasuredWalk<'a>],
    ) -> Self {
        let mut walks_by_gait: Vec<(&Candidate, Vec<&MeasuredWalk>)> = Vec::new();
        for walk in walks {
            let candidate = &gaits.candidates()[walk.candidate_index];
            match walks_by_gait
                .iter_mut()
                .find(|(known, _)| known.name() == candidate.name())
            {
                Some((_, walks)) => walks.push(walk),
                None => walks_by_gait.push((candidate, vec![walk])),
            }
        }
        let film_line_of = |film: &'a NamedFilm| {
            let camera = &film.analysis.camera;
            FilmLine {
                film: &film.name,
                pictures: film.analysis.path.len(),
                camera: CameraLine {
                    height: camera.height,
                    tilt: camera.tilt,
                    focal: camera.focal_length,
                    corners: camera.corner_error,
                    moved: camera.has_camera_moved,
                    deck: setup.deck_height,
                    deck_by_size: camera.deck_height,
                },
            }
        };
        let gait_report_of = |(candidate, walks): &(&'a Candidate, Vec<&MeasuredWalk<'a>>)| {
            GaitReport::new(robot, speed, gaits, candidate, walks)
        };
        Self {
            films: films.iter().map(film_line_of).collect(),
            gaits: walks_by_gait.iter().map(gait_report_of).collect(),
        }
    }

    /// Adds the movements according to MuJoCo, which are known at full pace for the project's own robots. `text` is the
    /// content of the robot's file.
    pub fn with_mujoco(mut self, text: &str) -> Self {
        for gait in self.gaits.iter_mut().filter(|gait| gait.speed == 100) {
            gait.mujoco = mujoco_movement(text, gait.gait);
        }
        self
    }

    /// Adds the ranges of the predictions, which takes a second for each gait.
    pub fn with_ranges(mut self, robot: &Robot) -> Self {
        for report in &mut self.gaits {
            let gait = robot.gait(report.gait);
            let pace = f64::from(report.speed) / 100.0;
            report.range = gait.map(|gait| PredictionRange::compute(robot, gait, pace));
        }
        self
    }

    /// The report as tables, for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for film in &self.films {
            let camera = &film.camera;
            let movement_text = if camera.moved { ", moving" } else { "" };
            let _ = writeln!(
                text,
                "{}: {} pictures\n\
                 camera {:.0} mm above the floor{movement_text}, {:.0} deg from straight down; corners to {:.2} px\n\
                 deck's tag {:.0} mm above the floor, by its size {:.0} mm",
                film.film,
                film.pictures,
                camera.height,
                camera.tilt,
                camera.corners,
                camera.deck,
                camera.deck_by_size,
            );
        }
        for gait in &self.gaits {
            text += &gait.text();
        }
        let mut components = self.gaits.iter().flat_map(GaitReport::components);
        if components.any(|component| component.predicted.is_none()) {
            let _ = write!(text, "\n{UNDECIDED_NOTE}");
        }
        text
    }
}
