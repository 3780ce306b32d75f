//! Walks whose true path is known: the twin's path, cycle after cycle, with the random deviations of a
//! built robot.

use fastrand::Rng;
use lizard_film::Gait;
use lizard_robot::{Place, Robot, Travel};
use lizard_twin::{ServoModel, Twin};

use crate::render::{Spot, normal};

/// Time before the start and after the stop, s.
pub const REST: f64 = 0.5;

/// A gait of the paper's robot as the twin walks it: the second cycle, from its start.
pub fn gait(name: &str) -> Gait {
    let robot = Robot::parse(include_str!("../../../robots/paper.toml")).expect("a robot");
    let gait = robot.gait(name).expect("a gait");
    let mut twin = Twin::new(&robot, ServoModel::of(&robot));
    let frames = gait.frames().count() - 1;
    let mut places = Vec::new();
    for i in 0..=2 * frames {
        let phase = gait.frames().nth(i % frames).expect("a frame").1;
        let place = twin.push_angles(gait.table_angles(phase)).place;
        if i >= frames {
            places.push(place);
        }
    }
    let relative_place = |place: &Place| {
        let travel = place.travel_from(places[0]);
        Place {
            forward: travel.forward,
            left: travel.left,
            heading: travel.turn.to_radians(),
        }
    };
    Gait {
        period: gait.period(),
        path: places.iter().map(relative_place).collect(),
    }
}

/// Number of parts of a cycle; each deviates independently, as if a foot slipped now and then.
const PARTS: usize = 12;

/// A walk of some cycles.
pub struct Walk {
    gait: Gait,
    period: f64,
    begins: Vec<Place>,
    /// The deviation of each cycle from the gait, at even intervals from its beginning to its end: mm, mm, rad.
    extras: Vec<[[f64; 3]; PARTS + 1]>,
}

/// Standard deviations of a walk and of its measures.
#[derive(Clone, Copy, Default)]
pub struct Variation {
    /// Deviation of each cycle from the gait: mm, mm, rad.
    pub cycle: [f64; 3],
    /// Deviation of the robot's clock, a share.
    pub clock: f64,
    /// Deviation of a height that a user measures, mm, and of the sheet, thousandths.
    pub ruler: f64,
}

impl Walk {
    /// Makes a walk of some cycles of a gait, from a place.
    pub fn new(
        gait: &Gait,
        start: Spot,
        cycles: usize,
        variation: Variation,
        rng: &mut Rng,
    ) -> Self {
        let mut begins = vec![Place {
            forward: start[0],
            left: start[1],
            heading: start[2],
        }];
        let mut extras = Vec::new();
        for _ in 0..cycles {
            let mut extra = [[0.0; 3]; PARTS + 1];
            for i in 1..=PARTS {
                let step = variation
                    .cycle
                    .map(|sigma| sigma * normal(rng) / (PARTS as f64).sqrt());
                extra[i] = [0, 1, 2].map(|axis| extra[i - 1][axis] + step[axis]);
            }
            let begin = begins[begins.len() - 1];
            begins.push(compose(
                compose(begin, gait.path[gait.path.len() - 1]),
                place_of(extra[PARTS]),
            ));
            extras.push(extra);
        }
        Self {
            gait: gait.clone(),
            period: gait.period * (1.0 + variation.clock * normal(rng)),
            begins,
            extras,
        }
    }

    /// The length of the film, s.
    pub fn seconds(&self) -> f64 {
        self.period * self.extras.len() as f64 + 2.0 * REST
    }

    /// The place at a time.
    pub fn at(&self, seconds: f64) -> Spot {
        let phase = ((seconds - REST) / self.period).clamp(0.0, self.extras.len() as f64 - 1e-9);
        let (cycle, cycle_share) = (phase as usize, phase.fract());
        let path = &self.gait.path;
        let position = cycle_share * (path.len() - 1) as f64;
        let (a, b, share) = (
            path[position as usize],
            path[position as usize + 1],
            position.fract(),
        );
        let mix = |coordinate: fn(&Place) -> f64| {
            coordinate(&a) + share * (coordinate(&b) - coordinate(&a))
        };
        let gait_place = place_of([
            mix(|place| place.forward),
            mix(|place| place.left),
            mix(|place| place.heading),
        ]);
        let position = cycle_share * PARTS as f64;
        let (i, share) = (position as usize, position.fract());
        let [from, to] = [
            self.extras[cycle][i],
            self.extras[cycle][(i + 1).min(PARTS)],
        ];
        let extra = [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let place = compose(compose(self.begins[cycle], gait_place), place_of(extra));
        [place.forward, place.left, place.heading]
    }
}

/// Consecutive walks, each starting where the previous one ended, with rests between them.
pub struct Show {
    /// Each walk, and the time at which its first rest begins, s.
    walks: Vec<(f64, Walk)>,
    seconds: f64,
}

impl Show {
    /// Makes walks, each of a gait and a number of cycles. Between two walks the robot rests for `rest` seconds.
    pub fn new(
        start: Spot,
        walks: &[(&Gait, usize)],
        rest: f64,
        variation: Variation,
        rng: &mut Rng,
    ) -> Self {
        let mut show = Self {
            walks: Vec::new(),
            seconds: 2.0 * REST - rest,
        };
        let mut start = start;
        for (gait, cycles) in walks {
            let walk = Walk::new(gait, start, *cycles, variation, rng);
            let start_seconds = show.seconds + rest - 2.0 * REST;
            show.seconds = start_seconds + walk.seconds();
            start = walk.at(walk.seconds());
            show.walks.push((start_seconds, walk));
        }
        show
    }

    /// The duration from the first rest to the end of the last one, s.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// The begin and end of each walk's movement, s.
    pub fn spans(&self) -> Vec<[f64; 2]> {
        let span_of = |(start_seconds, walk): &(f64, Walk)| {
            [start_seconds + REST, start_seconds + walk.seconds() - REST]
        };
        self.walks.iter().map(span_of).collect()
    }

    /// The place at a time.
    pub fn at(&self, seconds: f64) -> Spot {
        let has_begun = |(start_seconds, _): &&(f64, Walk)| start_seconds + REST <= seconds;
        let (start_seconds, walk) = self
            .walks
            .iter()
            .rev()
            .find(has_begun)
            .unwrap_or(&self.walks[0]);
        walk.at(seconds - start_seconds)
    }
}

/// The true displacement of a cycle.
pub fn truth(gait: &Gait) -> Travel {
    gait.path[gait.path.len() - 1].travel()
}

fn place_of([forward, left, heading]: [f64; 3]) -> Place {
    Place {
        forward,
        left,
        heading,
    }
}

/// Converts a place relative to `from` to a place on the floor.
fn compose(from: Place, relative: Place) -> Place {
    let [forward, left] = from.to_floor([relative.forward, relative.left]);
    place_of([forward, left, from.heading + relative.heading])
}
