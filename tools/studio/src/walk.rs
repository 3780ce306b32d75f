//! Simulates walks with known true paths: the twin's path, cycle after cycle, with random deviations as in a built
//! robot.

use fastrand::Rng;
use lizard_robot::{BodyPose, Robot, Travel};
use lizard_twin::{ServoModel, Twin};
use lizard_video::Gait;

use crate::render::{Pose, random_normal};

/// Duration of the rest before and after a walk, s.
pub const REST_S: f64 = 0.5;

/// Returns a gait of the paper's robot with the path that the twin walks in the second cycle.
pub fn paper_gait(name: &str) -> Gait {
    let robot =
        Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is valid");
    let gait = robot.gait(name).expect("the robot has this gait");
    let mut twin = Twin::new(&robot, ServoModel::for_robot(&robot));
    let phases: Vec<u16> = gait.frames().map(|(_, phase)| phase).collect();
    let frame_count = phases.len() - 1;
    let mut poses = Vec::new();
    for i in 0..=2 * frame_count {
        let angles = gait.table_angles(phases[i % frame_count]);
        let pose = twin.simulate_angles(angles).body_pose;
        if i >= frame_count {
            poses.push(pose);
        }
    }
    let relative_pose = |pose: &BodyPose| {
        let travel = pose.travel_from(poses[0]);
        to_body_pose([travel.forward, travel.left, travel.turn.to_radians()])
    };
    Gait {
        period: gait.period(),
        path: poses.iter().map(relative_pose).collect(),
    }
}

/// Number of parts of a cycle. Each part deviates independently, as if a foot slipped now and then.
const PARTS_PER_CYCLE: usize = 12;

/// A walk of several cycles of a gait.
pub struct Walk {
    gait: Gait,
    period: f64,
    /// The pose at the start of each cycle, and at the end of the last cycle.
    cycle_starts: Vec<BodyPose>,
    /// The deviation of each cycle from the gait at the ends of its parts: mm, mm, rad.
    deviations: Vec<[[f64; 3]; PARTS_PER_CYCLE + 1]>,
}

/// Standard deviations of a walk and of the user's measurements.
#[derive(Clone, Copy, Default)]
pub struct Variation {
    /// Deviation of each cycle from the gait: mm, mm, rad.
    pub cycle_deviation: [f64; 3],
    /// Relative deviation of the robot's clock.
    pub clock_deviation: f64,
    /// Deviation of a height that the user measures, mm, and of the sheet's scale, thousandths.
    pub ruler_deviation: f64,
}

impl Walk {
    /// Creates a walk of some cycles of a gait, from a pose.
    pub fn new(
        gait: &Gait,
        start: Pose,
        cycle_count: usize,
        variation: Variation,
        rng: &mut Rng,
    ) -> Self {
        let mut cycle_starts = vec![to_body_pose(start)];
        let mut deviations = Vec::new();
        for _ in 0..cycle_count {
            let mut cycle_deviations = [[0.0; 3]; PARTS_PER_CYCLE + 1];
            for i in 1..=PARTS_PER_CYCLE {
                let divisor = (PARTS_PER_CYCLE as f64).sqrt();
                let deviation = variation.cycle_deviation;
                let step = deviation.map(|sigma| sigma * random_normal(rng) / divisor);
                cycle_deviations[i] =
                    [0, 1, 2].map(|axis| cycle_deviations[i - 1][axis] + step[axis]);
            }
            let start_pose = cycle_starts[cycle_starts.len() - 1];
            let gait_end = compose(start_pose, gait.path[gait.path.len() - 1]);
            let deviation = to_body_pose(cycle_deviations[PARTS_PER_CYCLE]);
            cycle_starts.push(compose(gait_end, deviation));
            deviations.push(cycle_deviations);
        }
        Self {
            gait: gait.clone(),
            period: gait.period * (1.0 + variation.clock_deviation * random_normal(rng)),
            cycle_starts,
            deviations,
        }
    }

    /// Returns the duration of the walk with its rests, s.
    pub fn duration_s(&self) -> f64 {
        self.period * self.deviations.len() as f64 + 2.0 * REST_S
    }

    /// Returns the robot's pose at a time, s.
    pub fn pose_at(&self, seconds: f64) -> Pose {
        let phase =
            ((seconds - REST_S) / self.period).clamp(0.0, self.deviations.len() as f64 - 1e-9);
        let (cycle, cycle_fraction) = (phase as usize, phase.fract());
        // The true path is interpolated here, because `Gait::pose_at` is code under test.
        let path = &self.gait.path;
        let position = cycle_fraction * (path.len() - 1) as f64;
        let (i, fraction) = (position as usize, position.fract());
        let (a, b) = (path[i], path[i + 1]);
        let interpolate = |coordinate: fn(&BodyPose) -> f64| {
            coordinate(&a) + fraction * (coordinate(&b) - coordinate(&a))
        };
        let gait_pose = to_body_pose([
            interpolate(|pose| pose.forward),
            interpolate(|pose| pose.left),
            interpolate(|pose| pose.heading),
        ]);
        let position = cycle_fraction * PARTS_PER_CYCLE as f64;
        let (i, fraction) = (position as usize, position.fract());
        let deviations = &self.deviations[cycle];
        let [from, to] = [deviations[i], deviations[(i + 1).min(PARTS_PER_CYCLE)]];
        let deviation = [0, 1, 2].map(|axis| from[axis] + fraction * (to[axis] - from[axis]));
        let pose = compose(self.cycle_starts[cycle], gait_pose);
        let pose = compose(pose, to_body_pose(deviation));
        [pose.forward, pose.left, pose.heading]
    }
}

/// Consecutive walks with rests between them. Each walk starts at the end of the previous one.
pub struct WalkSeries {
    /// The walks, each with the time at which the rest before it begins, s.
    walks: Vec<(f64, Walk)>,
    duration_s: f64,
}

impl WalkSeries {
    /// Creates walks from gaits and their numbers of cycles. The robot rests for `rest_s` between two walks.
    pub fn new(
        start: Pose,
        walks: &[(&Gait, usize)],
        rest_s: f64,
        variation: Variation,
        rng: &mut Rng,
    ) -> Self {
        let mut series = Self {
            walks: Vec::new(),
            duration_s: 2.0 * REST_S - rest_s,
        };
        let mut start = start;
        for (gait, cycle_count) in walks {
            let walk = Walk::new(gait, start, *cycle_count, variation, rng);
            let start_s = series.duration_s + rest_s - 2.0 * REST_S;
            series.duration_s = start_s + walk.duration_s();
            start = walk.pose_at(walk.duration_s());
            series.walks.push((start_s, walk));
        }
        series
    }

    /// Returns the duration from the start of the first rest to the end of the last one, s.
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Returns the start and the end of each walk's movement, s.
    pub fn movement_spans(&self) -> Vec<[f64; 2]> {
        let movement_span = |(start_s, walk): &(f64, Walk)| {
            [start_s + REST_S, start_s + walk.duration_s() - REST_S]
        };
        self.walks.iter().map(movement_span).collect()
    }

    /// Returns the robot's pose at a time, s.
    pub fn pose_at(&self, seconds: f64) -> Pose {
        let has_started = |(start_s, _): &&(f64, Walk)| start_s + REST_S <= seconds;
        let started_walk = self.walks.iter().rev().find(has_started);
        let (start_s, walk) = started_walk.unwrap_or(&self.walks[0]);
        walk.pose_at(seconds - start_s)
    }
}

/// Returns the true displacement of a cycle.
pub fn true_displacement(gait: &Gait) -> Travel {
    gait.path[gait.path.len() - 1].travel()
}

fn to_body_pose([forward, left, heading]: [f64; 3]) -> BodyPose {
    BodyPose {
        forward,
        left,
        heading,
    }
}

/// Converts a pose relative to `from` to a pose on the floor.
fn compose(from: BodyPose, relative: BodyPose) -> BodyPose {
    let [forward, left] = from.to_floor([relative.forward, relative.left]);
    to_body_pose([forward, left, from.heading + relative.heading])
}
