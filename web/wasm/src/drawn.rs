//! A gait that is being drawn: the point of head or tail goes round a closed line.
//!
//! A hand's line has corners, which no servo follows. So what is kept of it is its first few
//! harmonics, gone through at an even speed. Two servos then follow by the robot's inverse
//! kinematics, and every sample is checked as that of any gait of a robot.toml. What
//! is refused comes with the nearest smaller size, about the neutral point, and the nearest
//! longer time that would do.

use std::f64::consts::TAU;
use std::fmt::Write;

use lizard_kinematics::End;
use lizard_robot::Robot;
use lizard_twin::Twin;
use serde::{Deserialize, Serialize};

use crate::room::neutral;
use crate::trial::{
    Instead, LONGEST, NoTrial, Trial, nearest, put_into, tried, with, without_gaits,
};

/// Points at which a line is sampled.
const SAMPLES: usize = 256;
/// Points of the line that is shown.
const SHOWN: usize = 128;
/// The smallest size that is offered, in hundredths.
const LEAST_SIZE: i64 = 5;
/// Harmonics smaller than this are left out, mm.
const LEAST: f64 = 0.05;
/// Most harmonics that a robot.toml takes.
const MOST_TERMS: usize = 16;

/// A gait as a line that was drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drawn {
    /// Its name in robot.toml.
    pub name: String,
    /// `head` or `tail`.
    pub end: String,
    /// Time of a round, s.
    pub period: f64,
    /// The line's size over that which was drawn, about the neutral point.
    pub size: f64,
    /// How many harmonics are kept of it, 1 to 16.
    pub terms: usize,
    /// The line, mm in the end's own frame; its end is joined to its beginning.
    pub points: Vec<[f64; 2]>,
}

/// A coordinate of the line.
struct Series {
    centre: f64,
    /// Amplitude, mm, and shift, in periods of the term; from the first harmonic on.
    terms: Vec<(f64, f64)>,
}

impl Series {
    fn of(values: &[f64], terms: usize) -> Self {
        let mean = |of: &dyn Fn(f64, f64) -> f64| {
            let each = values.iter().enumerate();
            let sum: f64 = each
                .map(|(i, value)| of(*value, i as f64 / values.len() as f64))
                .sum();
            sum / values.len() as f64
        };
        let term = |k: usize| {
            let cosine = 2.0 * mean(&|value, phase| value * (TAU * k as f64 * phase).cos());
            let sine = 2.0 * mean(&|value, phase| value * (TAU * k as f64 * phase).sin());
            // To the digits of the text, without the sign of a zero.
            let shift = (cosine.atan2(sine) / TAU * 1e4).round() / 1e4 + 0.0;
            (cosine.hypot(sine), shift)
        };
        Self {
            centre: mean(&|value, _| value),
            terms: (1..=terms.clamp(1, MOST_TERMS)).map(term).collect(),
        }
    }

    fn at(&self, phase: f64) -> f64 {
        let each = self.terms.iter().enumerate();
        let sum: f64 = each
            .map(|(i, (amplitude, shift))| {
                amplitude * (TAU * ((i + 1) as f64 * phase + shift)).sin()
            })
            .sum();
        self.centre + sum
    }

    /// As robot.toml has it.
    fn text(&self) -> String {
        let each = self.terms.iter().enumerate();
        let each = each.filter(|(_, (amplitude, _))| *amplitude >= LEAST);
        let terms: Vec<_> = each
            .map(|(i, (amplitude, shift))| {
                let k = i + 1;
                format!("{{ k = {k}, amplitude = {amplitude:.2}, shift = {shift:.4} }}")
            })
            .collect();
        format!("[{}]", terms.join(", "))
    }
}

impl Drawn {
    fn end(&self) -> Option<End> {
        End::ALL.into_iter().find(|end| end.name() == self.end)
    }

    /// Its two coordinates, at an even speed; none of a line without length.
    fn series(&self, neutral: [f64; 2]) -> Option<[Series; 2]> {
        let scaled = |of: usize, value: f64| neutral[of] + self.size * (value - neutral[of]);
        let points: Vec<[f64; 2]> = self
            .points
            .iter()
            .map(|[x, y]| [scaled(0, *x), scaled(1, *y)])
            .collect();
        let even = evenly(&points)?;
        Some([0, 1].map(|of| {
            let values: Vec<f64> = even.iter().map(|point| point[of]).collect();
            Series::of(&values, self.terms)
        }))
    }

    /// Its tables for robot.toml.
    fn table(&self, neutral: [f64; 2]) -> Option<String> {
        let [x, y] = self.series(neutral)?;
        let mut text = format!(
            "[gait.{name}]\nperiod = {period:?}\n[gait.{name}.{end}]\n",
            name = self.name,
            end = self.end,
            period = (self.period * 1000.0).round() / 1000.0,
        );
        let _ = writeln!(text, "centre = [{:.2}, {:.2}]", x.centre, y.centre);
        let _ = writeln!(text, "x = {}\ny = {}", x.text(), y.text());
        Some(text)
    }

    /// The line that the point really goes along, mm in the end's own frame; none without a
    /// line.
    #[must_use]
    pub fn path(&self, robot: &Robot) -> Option<Vec<[f64; 2]>> {
        let [x, y] = self.series(neutral(robot, self.end()?))?;
        let phases = (0..SHOWN).map(|i| i as f64 / SHOWN as f64);
        Some(phases.map(|phase| [x.at(phase), y.at(phase)]).collect())
    }

    /// The text of a robot with this gait: in place of the one of its name, or below all; none
    /// without a line.
    #[must_use]
    pub fn put_into(&self, text: &str, robot: &Robot) -> Option<String> {
        let table = self.table(neutral(robot, self.end()?))?;
        Some(put_into(text, &self.name, &table))
    }

    /// Tries it on the robot of a text, which stands on this twin's floor with its servos; none
    /// without a line.
    #[must_use]
    pub fn trial(&self, text: &str, twin: &Twin) -> Option<Result<Trial, NoTrial>> {
        let neutral = neutral(twin.robot(), self.end()?);
        let rest = without_gaits(text);
        let table = self.table(neutral)?;
        Some(tried(&rest, &table, twin).map_err(|refused| NoTrial {
            refused,
            instead: self.instead(&rest, neutral),
        }))
    }

    fn instead(&self, rest: &str, neutral: [f64; 2]) -> Vec<Instead> {
        let does = |drawn: &Self| {
            let table = drawn.table(neutral);
            table.is_some_and(|table| with(rest, &table).is_ok())
        };
        let size = |hundredths: i64| Self {
            size: hundredths as f64 / 100.0,
            ..self.clone()
        };
        let period = |hundredths: i64| Self {
            period: hundredths as f64 / 100.0,
            ..self.clone()
        };
        let wanted = (self.size * 100.0).ceil() as i64 - 1;
        let smaller = nearest(wanted, LEAST_SIZE, |hundredths| does(&size(hundredths)));
        let wanted = (self.period * 100.0).floor() as i64 + 1;
        let longer = nearest(wanted, LONGEST, |hundredths| does(&period(hundredths)));
        let instead = |what, hundredths: i64| Instead {
            what,
            value: hundredths as f64 / 100.0,
        };
        let smaller = smaller.map(|size| instead("size", size));
        let longer = longer.map(|period| instead("period", period));
        smaller.into_iter().chain(longer).collect()
    }
}

/// Points of a closed line at even distances along it; none of one without length.
fn evenly(points: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    let next = |i: usize| points[(i + 1) % points.len()];
    let long = |i: usize| (next(i)[0] - points[i][0]).hypot(next(i)[1] - points[i][1]);
    let lengths: Vec<f64> = (0..points.len()).map(long).collect();
    let all: f64 = lengths.iter().sum();
    if !(all > 1e-6 && all.is_finite()) {
        return None;
    }
    let mut even = Vec::with_capacity(SAMPLES);
    let (mut part, mut before) = (0, 0.0);
    for i in 0..SAMPLES {
        let at = all * i as f64 / SAMPLES as f64;
        while part + 1 < lengths.len() && before + lengths[part] < at {
            before += lengths[part];
            part += 1;
        }
        let share = if lengths[part] > 0.0 {
            (at - before) / lengths[part]
        } else {
            0.0
        };
        let (from, to) = (points[part], next(part));
        even.push([0, 1].map(|of| from[of] + share.min(1.0) * (to[of] - from[of])));
    }
    Some(even)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::{TEXT, paper, with_twin};

    /// A circle about the neutral point of an end.
    fn circle(robot: &Robot, end: End, radius: f64) -> Drawn {
        let [x, y] = neutral(robot, end);
        let point = |i: usize| {
            let angle = TAU * i as f64 / 90.0;
            [x + radius * angle.cos(), y + radius * angle.sin()]
        };
        Drawn {
            name: "mine".to_string(),
            end: end.name().to_string(),
            period: 4.0,
            size: 1.0,
            terms: 3,
            points: (0..90).map(point).collect(),
        }
    }

    #[test]
    fn the_points_of_a_robot_with_it_go_round_the_circle_that_was_drawn() {
        let (robot, twin) = with_twin();
        for end in End::ALL {
            let drawn = circle(&robot, end, 6.0);
            let known = drawn.trial(TEXT, &twin).expect("a line").expect("it goes");
            assert!(
                known.table.contains(&format!("[gait.mine.{end}]")),
                "{}",
                known.table
            );
            let text = drawn.put_into(TEXT, &robot).expect("a line");
            let robot = Robot::parse(&text).expect("right");
            let gait = robot.gait("mine").expect("there");
            let [x, y] = neutral(&robot, end);
            for i in 0..50 {
                let pose = gait.pose(f64::from(i) / 50.0);
                let point = robot
                    .lizard()
                    .solve(&pose)
                    .expect("it closes")
                    .end(end)
                    .end_point;
                let away = (point.x - x).hypot(point.y - y);
                assert!((away - 6.0).abs() < 0.05, "{end} {i}: {away} mm");
            }
        }
    }

    #[test]
    fn a_circle_is_one_harmonic_and_its_line_is_the_circle() {
        let robot = paper();
        let drawn = circle(&robot, End::Head, 6.0);
        let table = drawn.table(neutral(&robot, End::Head)).expect("a line");
        assert!(
            table.contains("k = 1") && !table.contains("k = 2"),
            "{table}"
        );
        let [x, y] = neutral(&robot, End::Head);
        for [px, py] in drawn.path(&robot).expect("a line") {
            assert!(((px - x).hypot(py - y) - 6.0).abs() < 0.02);
        }
    }

    #[test]
    fn what_is_refused_comes_with_a_size_and_a_time_that_do_and_are_the_nearest() {
        let (robot, twin) = with_twin();
        let drawn = circle(&robot, End::Head, 40.0);
        let no = drawn
            .trial(TEXT, &twin)
            .expect("a line")
            .expect_err("it is too large");
        let [size] = no.instead.as_slice() else {
            panic!("no time would do: {:?}", no.instead);
        };
        assert_eq!(size.what, "size");
        let with = |size: f64| Drawn {
            size,
            ..drawn.clone()
        };
        let does = |drawn: Drawn| drawn.trial(TEXT, &twin).expect("a line").is_ok();
        assert!(
            does(with(size.value)) && !does(with(size.value + 0.01)),
            "{}",
            size.value
        );
        let fast = Drawn {
            period: 0.2,
            ..circle(&robot, End::Head, 8.0)
        };
        let no = fast
            .trial(TEXT, &twin)
            .expect("a line")
            .expect_err("it is too fast");
        let slow = no.instead.iter().find(|instead| instead.what == "period");
        let slow = slow.expect("a longer time does").value;
        let with = |period: f64| Drawn {
            period,
            ..fast.clone()
        };
        assert!(does(with(slow)) && !does(with(slow - 0.01)), "{slow}");
    }

    #[test]
    fn a_point_is_no_line() {
        let (robot, twin) = with_twin();
        let mut drawn = circle(&robot, End::Tail, 0.0);
        assert!(drawn.trial(TEXT, &twin).is_none());
        drawn.points.clear();
        assert!(drawn.path(&robot).is_none() && drawn.put_into(TEXT, &robot).is_none());
    }
}
