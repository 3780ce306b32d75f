//! The measured way of a gait beside the predicted one, for people and for scripts.

use std::fmt::Write as _;

use lizard_film::{Gait, Mean, Measured, Setup, Watched};
use lizard_robot::{CheckedGait, Prediction, Robot, Travel, UNDECIDED};
use serde::Serialize;

/// Distance from the prediction, in standard errors, to which a measurement agrees with it.
pub const AGREES: f64 = 2.0;

/// The result under the names of `--json`.
#[derive(Debug, Serialize)]
pub struct Report<'a> {
    gait: &'a str,
    /// Percent.
    speed: u8,
    /// Number of whole cycles, and the mean time of one with its standard error, s.
    cycles: usize,
    period: f64,
    period_error: f64,
    /// Time of a cycle by robot.toml, s.
    period_expected: f64,
    /// mm, mm, deg counter-clockwise, seen from the beginning of the cycle.
    forward: Part,
    left: Part,
    turn: Part,
    /// The movement of each cycle.
    each: Vec<Way>,
    pictures: usize,
    camera: CameraLine,
    #[serde(skip)]
    watched: &'a Watched,
}

/// One part of a cycle's movement.
#[derive(Debug, Serialize)]
struct Part {
    mean: f64,
    /// Standard deviation of single cycles.
    sd: f64,
    /// Standard error of the mean.
    error: f64,
    /// Null if two feet pull against two.
    predicted: Option<f64>,
    /// The mean less the prediction, in standard errors.
    differs: Option<f64>,
    agrees: Option<bool>,
}

#[derive(Debug, Serialize)]
struct Way {
    forward: f64,
    left: f64,
    turn: f64,
}

/// The camera as the tags show it.
#[derive(Debug, Serialize)]
struct CameraLine {
    /// mm above the floor, deg from straight down, px.
    height: f64,
    tilt: f64,
    focal: f64,
    /// Mean error of a floor tag's corner, px.
    corners: f64,
    moved: bool,
    /// Height of the deck's tag, mm: as given, and by its size.
    deck: f64,
    deck_by_size: f64,
}

impl Part {
    fn new(mean: Mean, predicted: Option<f64>) -> Self {
        // A film without any spread is a drawing; its error is not zero.
        let differs = predicted.map(|predicted| (mean.mean - predicted) / mean.error.max(1e-6));
        Self {
            mean: mean.mean,
            sd: mean.spread,
            error: mean.error,
            predicted,
            differs,
            agrees: differs.map(|differs| differs.abs() <= AGREES),
        }
    }

    fn line(&self, name: &str) -> String {
        let predicted = self
            .predicted
            .map_or("-".to_owned(), |value| format!("{value:+.2}"));
        let verdict = match (self.agrees, self.differs) {
            (Some(true), _) => "agrees".to_owned(),
            (Some(false), Some(differs)) => {
                let word = if differs > 0.0 { "more" } else { "less" };
                format!("{:.1} errors {word}", differs.abs())
            }
            _ => "-".to_owned(),
        };
        format!(
            "{name:<12}{:>+9.2}{:>8.2}{:>8.2}{predicted:>11}   {verdict}\n",
            self.mean, self.sd, self.error
        )
    }
}

impl<'a> Report<'a> {
    /// Sets a measured film beside a gait's predicted path, which it was compared with.
    pub fn new(
        robot: &Robot,
        gait: &'a CheckedGait,
        speed: u8,
        setup: Setup,
        expected: &Gait,
        watched: &'a Watched,
        measured: &Measured,
    ) -> Self {
        let way = expected.path.last().map(|place| place.travel());
        let decided = robot.predict(gait);
        let predicted = way.map_or(decided, |way| decided.keep_known(way));
        let Prediction {
            forward,
            left,
            turn,
        } = predicted;
        let sight = &watched.sight;
        let way = |travel: &Travel| Way {
            forward: travel.forward,
            left: travel.left,
            turn: travel.turn,
        };
        Self {
            gait: gait.name(),
            speed,
            cycles: measured.cycles.len(),
            period: measured.period[0],
            period_error: measured.period[1],
            period_expected: expected.period,
            forward: Part::new(measured.forward, forward),
            left: Part::new(measured.left, left),
            turn: Part::new(measured.turn, turn),
            each: measured.cycles.iter().map(way).collect(),
            pictures: watched.path.len(),
            camera: CameraLine {
                height: sight.height,
                tilt: sight.tilt,
                focal: sight.focal,
                corners: sight.error,
                moved: sight.moved,
                deck: setup.height,
                deck_by_size: sight.deck,
            },
            watched,
        }
    }

    /// The table for people.
    pub fn text(&self) -> String {
        let camera = &self.camera;
        let moves = if camera.moved { ", moving" } else { "" };
        let mut text = format!(
            "{} at {} %: {} whole cycles of {:.3} s (by robot.toml {:.3} s) in {} pictures\n\
             camera {:.0} mm above the floor{moves}, {:.0} deg from straight down; corners to {:.2} px\n\
             deck's tag {:.0} mm above the floor, by its size {:.0} mm\n\n\
             a cycle      measured      sd   error  predicted\n",
            self.gait,
            self.speed,
            self.cycles,
            self.period,
            self.period_expected,
            self.pictures,
            camera.height,
            camera.tilt,
            camera.corners,
            camera.deck,
            camera.deck_by_size,
        );
        let parts = [
            ("ahead, mm", &self.forward),
            ("left, mm", &self.left),
            ("turn, deg", &self.turn),
        ];
        for (name, part) in parts {
            text += &part.line(name);
        }
        if parts.iter().any(|(_, part)| part.predicted.is_none()) {
            let _ = write!(text, "\n{UNDECIDED}");
        }
        text
    }

    /// The robot's path as CSV: mm and degrees on the floor.
    pub fn path(&self) -> String {
        let mut text = "seconds,forward,left,heading\n".to_owned();
        for seen in &self.watched.path {
            let place = seen.place;
            let _ = writeln!(
                text,
                "{:.4},{:.3},{:.3},{:.3}",
                seen.seconds,
                place.forward,
                place.left,
                place.heading.to_degrees()
            );
        }
        text
    }
}
