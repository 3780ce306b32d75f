//! A drawn gait, in which the end point of head or tail follows a closed line.
//!
//! A line drawn by hand has corners, which no servo can follow. Therefore the line is sampled at equal distances, and
//! only the first few harmonics of the samples are kept. The robot's inverse kinematics gives the angles of the two
//! servos, and the gait is checked like any gait in a robot.toml.

use std::f64::consts::TAU;

use lizard_kinematics::{End, Vector};
use lizard_robot::edit::to_key;
use lizard_robot::{Harmonic, Path, Robot};
use serde::{Deserialize, Serialize};
use tsify::Tsify;

use crate::workspace::compute_neutral_point;

/// Number of points at which a line is sampled.
const SAMPLE_COUNT: usize = 256;
/// Number of points of the displayed path.
const SHOWN_POINT_COUNT: usize = 128;
/// Smallest amplitude of a harmonic that is written to robot.toml, mm.
const MIN_AMPLITUDE_MM: f64 = 0.05;
/// Largest number of harmonics of a path in robot.toml.
const MAX_HARMONIC_COUNT: usize = 16;

/// A gait in which the end point of head or tail follows a drawn line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Tsify)]
pub struct DrawnGait {
    /// Name of the gait in robot.toml.
    pub name: String,
    /// The five-bar whose end point follows the line: `head` or `tail`.
    #[tsify(type = "'head' | 'tail'")]
    pub end: String,
    /// Duration of a cycle, s.
    pub period: f64,
    /// Scale factor of the line about the neutral point.
    pub size: f64,
    /// Number of kept harmonics, 1 to 16.
    #[serde(rename = "terms")]
    pub harmonic_count: usize,
    /// Points of the line, mm in the frame of head or tail; the last point is joined to the first.
    pub points: Vec<[f64; 2]>,
}

impl DrawnGait {
    /// Returns the path that the end point follows; `None` for an unknown `end`, or if the line has no length.
    fn smoothed_path(&self, robot: &Robot) -> Option<Path> {
        let end = End::ALL.into_iter().find(|end| end.name() == self.end)?;
        let neutral = compute_neutral_point(robot, end);
        let scale_point = |point: &[f64; 2]| {
            [0, 1].map(|axis| neutral[axis] + self.size * (point[axis] - neutral[axis]))
        };
        let points: Vec<[f64; 2]> = self.points.iter().map(scale_point).collect();
        let samples = sample_evenly(&points)?;
        let harmonic_count = self.harmonic_count.clamp(1, MAX_HARMONIC_COUNT);
        let [(centre_x, x_harmonics), (centre_y, y_harmonics)] = [0, 1].map(|axis| {
            let values: Vec<f64> = samples.iter().map(|sample| sample[axis]).collect();
            compute_harmonics(&values, harmonic_count)
        });
        Some(Path {
            centre: [centre_x, centre_y],
            x: x_harmonics,
            y: y_harmonics,
        })
    }

    /// Formats the gait as tables of robot.toml; `None` for an unknown `end`, or if the line has no length.
    pub fn format_table(&self, robot: &Robot) -> Option<String> {
        let path = self.smoothed_path(robot)?;
        let format_series = |harmonics: &[Harmonic]| {
            let is_written = |harmonic: &&Harmonic| harmonic.amplitude >= MIN_AMPLITUDE_MM;
            let texts = harmonics.iter().filter(is_written).map(|harmonic| {
                let (k, amplitude) = (harmonic.order, harmonic.amplitude);
                let shift = harmonic.phase_shift;
                format!("{{ k = {k}, amplitude = {amplitude:.2}, shift = {shift:.4} }}")
            });
            texts.collect::<Vec<_>>().join(", ")
        };
        let ([centre_x, centre_y], x, y) =
            (path.centre, format_series(&path.x), format_series(&path.y));
        let (name, end) = (to_key(&self.name), &self.end);
        let period = (self.period * 1000.0).round() / 1000.0;
        Some(format!(
            "[gait.{name}]\nperiod = {period:?}\n[gait.{name}.{end}]\n\
             centre = [{centre_x:.2}, {centre_y:.2}]\nx = [{x}]\ny = [{y}]\n"
        ))
    }

    /// Samples the path of the end point at equal time steps, mm in the frame of head or tail. `None` for an unknown
    /// `end`, or if the line has no length.
    pub fn shown_points(&self, robot: &Robot) -> Option<Vec<[f64; 2]>> {
        let path = self.smoothed_path(robot)?;
        let point_at = |i: usize| {
            let Vector { x, y } = path.point_at(i as f64 / SHOWN_POINT_COUNT as f64);
            [x, y]
        };
        Some((0..SHOWN_POINT_COUNT).map(point_at).collect())
    }
}

/// Returns the mean and the first harmonics of values that are evenly spaced over a cycle.
fn compute_harmonics(values: &[f64], harmonic_count: usize) -> (f64, Vec<Harmonic>) {
    let compute_mean = |transform: &dyn Fn(f64, f64) -> f64| {
        let count = values.len() as f64;
        let indexed_values = values.iter().enumerate();
        let summands = indexed_values.map(|(i, value)| transform(*value, i as f64 / count));
        summands.sum::<f64>() / count
    };
    let compute_harmonic = |order: usize| {
        let order = order as f64;
        let cosine = 2.0 * compute_mean(&|value, phase| value * (TAU * order * phase).cos());
        let sine = 2.0 * compute_mean(&|value, phase| value * (TAU * order * phase).sin());
        Harmonic {
            order,
            amplitude: cosine.hypot(sine),
            // Rounded to the digits that are written; adding 0.0 turns -0.0 into 0.0.
            phase_shift: (cosine.atan2(sine) / TAU * 1e4).round() / 1e4 + 0.0,
        }
    };
    let harmonics = (1..=harmonic_count).map(compute_harmonic);
    (compute_mean(&|value, _| value), harmonics.collect())
}

/// Samples a closed line at equal distances along it; `None` if the line has no length.
fn sample_evenly(points: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    let next_point = |i: usize| points[(i + 1) % points.len()];
    let segment_length =
        |i: usize| (next_point(i)[0] - points[i][0]).hypot(next_point(i)[1] - points[i][1]);
    let lengths: Vec<f64> = (0..points.len()).map(segment_length).collect();
    let total_length: f64 = lengths.iter().sum();
    if !(total_length > 1e-6 && total_length.is_finite()) {
        return None;
    }
    let mut samples = Vec::with_capacity(SAMPLE_COUNT);
    let (mut segment, mut segment_start) = (0, 0.0);
    for i in 0..SAMPLE_COUNT {
        let distance = total_length * i as f64 / SAMPLE_COUNT as f64;
        while segment + 1 < lengths.len() && segment_start + lengths[segment] < distance {
            segment_start += lengths[segment];
            segment += 1;
        }
        let segment_fraction = match lengths[segment] > 0.0 {
            true => (distance - segment_start) / lengths[segment],
            false => 0.0,
        };
        let fraction = segment_fraction.min(1.0);
        let (from, to) = (points[segment], next_point(segment));
        samples.push([0, 1].map(|axis| from[axis] + fraction * (to[axis] - from[axis])));
    }
    Some(samples)
}

#[cfg(test)]
mod tests {
    use lizard_twin::Twin;

    use super::*;
    use crate::paper::{PAPER_TOML, load_paper_robot, load_paper_robot_and_twin};
    use crate::trial::{Alternative, EditedGait, RefusedTrial, Trial};

    /// Tries a gait on the twin's robot.
    fn try_gait(twin: &Twin, drawn_gait: DrawnGait) -> Result<Trial, RefusedTrial> {
        let trial = EditedGait::DrawnGait(drawn_gait).try_on(twin);
        trial.expect("the line has a length")
    }

    /// Makes a gait along a circle about the neutral point of head or tail.
    fn make_circular_gait(robot: &Robot, end: End, radius_mm: f64) -> DrawnGait {
        let [x, y] = compute_neutral_point(robot, end);
        let point_at = |i: usize| {
            let angle = TAU * i as f64 / 90.0;
            [x + radius_mm * angle.cos(), y + radius_mm * angle.sin()]
        };
        DrawnGait {
            name: "mine".to_string(),
            end: end.name().to_string(),
            period: 4.0,
            size: 1.0,
            harmonic_count: 3,
            points: (0..90).map(point_at).collect(),
        }
    }

    #[test]
    fn the_end_point_follows_the_drawn_circle() {
        let (robot, twin) = load_paper_robot_and_twin();
        for end in End::ALL {
            let drawn_gait = make_circular_gait(&robot, end, 6.0);
            let trial = try_gait(&twin, drawn_gait.clone());
            let table = trial.expect("the gait is valid").table;
            assert!(table.contains(&format!("[gait.mine.{end}]")), "{table}");
            let text = EditedGait::DrawnGait(drawn_gait).put_into(PAPER_TOML, &robot);
            let text = text.expect("the line has a length");
            let robot = Robot::parse(&text).expect("the robot with the gait is valid");
            let gait = robot.gait("mine").expect("the gait was added");
            let [x, y] = compute_neutral_point(&robot, end);
            for i in 0..50 {
                let pose = gait.pose(f64::from(i) / 50.0);
                let solution = robot.lizard().solve(&pose).expect("every loop closes");
                let point = solution.end(end).end_point;
                let distance = (point.x - x).hypot(point.y - y);
                assert!((distance - 6.0).abs() < 0.05, "{end} {i}: {distance} mm");
            }
        }
    }

    #[test]
    fn the_path_of_a_drawn_circle_is_a_circle_with_one_harmonic() {
        let robot = load_paper_robot();
        let drawn_gait = make_circular_gait(&robot, End::Head, 6.0);
        let table = drawn_gait.format_table(&robot);
        let table = table.expect("the line has a length");
        assert!(table.contains("k = 1"), "{table}");
        assert!(!table.contains("k = 2"), "{table}");
        let [x, y] = compute_neutral_point(&robot, End::Head);
        let points = drawn_gait.shown_points(&robot);
        for [px, py] in points.expect("the line has a length") {
            assert!(((px - x).hypot(py - y) - 6.0).abs() < 0.02);
        }
    }

    #[test]
    fn a_circle_that_is_too_large_is_offered_the_nearest_valid_size() {
        let (robot, twin) = load_paper_robot_and_twin();
        let large_gait = make_circular_gait(&robot, End::Head, 40.0);
        let result = try_gait(&twin, large_gait.clone());
        let alternatives = result.expect_err("the circle is too large").alternatives;
        let [Alternative { parameter, value }] = alternatives[..] else {
            panic!("only a size is offered, no period: {alternatives:?}");
        };
        assert_eq!(parameter, "size");
        let try_size = |size: f64| {
            let gait = DrawnGait {
                size,
                ..large_gait.clone()
            };
            try_gait(&twin, gait)
        };
        assert!(try_size(value).is_ok(), "{value}");
        assert!(try_size(value + 0.01).is_err(), "{value}");
    }

    #[test]
    fn a_gait_that_is_too_fast_is_offered_the_nearest_valid_period() {
        let (robot, twin) = load_paper_robot_and_twin();
        let try_period = |period: f64| {
            let gait = DrawnGait {
                period,
                ..make_circular_gait(&robot, End::Head, 8.0)
            };
            try_gait(&twin, gait)
        };
        let refused_trial = try_period(0.2).expect_err("the gait is too fast");
        let mut alternatives = refused_trial.alternatives.iter();
        let offer = alternatives.find(|alternative| alternative.parameter == "period");
        let slow_period = offer.expect("a longer period is offered").value;
        assert!(try_period(slow_period).is_ok(), "{slow_period} s");
        assert!(try_period(slow_period - 0.01).is_err(), "{slow_period} s");
    }

    #[test]
    fn a_line_without_length_gives_no_gait() {
        let (robot, twin) = load_paper_robot_and_twin();
        let mut drawn_gait = make_circular_gait(&robot, End::Tail, 0.0);
        let edited_gait = EditedGait::DrawnGait(drawn_gait.clone());
        assert!(edited_gait.try_on(&twin).is_none());
        drawn_gait.points.clear();
        assert!(drawn_gait.shown_points(&robot).is_none());
        assert!(drawn_gait.format_table(&robot).is_none());
    }
}
