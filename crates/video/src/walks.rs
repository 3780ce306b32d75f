//! The walks of a path: the times between two rests in which the robot moves.
//!
//! Within a cycle of a gait, the robot may stand still for a while. Only a longer standstill counts as a rest.

use crate::cycle_timing::SCALE_RANGE;
use crate::gait::{Gait, MIN_MOVEMENT, movement_in_mm, movement_length};
use crate::path::PathPoint;

/// Smallest duration of a rest, s.
const MIN_REST: f64 = 0.8;
/// Largest root-mean-square distance of a rest's poses from their mean, mm. The error of a tag's pose is smaller.
const MAX_REST_DEVIATION: f64 = 0.5;
/// Smallest number of frames of a rest.
const MIN_FRAMES: usize = 3;
/// Ratio of the shortest rest to the longest standstill within a cycle.
const MIN_REST_RATIO: f64 = 1.4;

/// Finds the walks, in which the robot moves away between two rests. Returns the start and the end of each walk, s,
/// extended at both ends by half of `min_rest_duration`. A rest lasts at least `min_rest_duration` seconds.
pub(crate) fn find_walks(path: &[PathPoint], min_rest_duration: f64) -> Vec<[f64; 2]> {
    let mut is_resting = vec![false; path.len()];
    for (first, point) in path.iter().enumerate() {
        let rest_end = point.seconds + min_rest_duration;
        let end = path.partition_point(|later_point| later_point.seconds < rest_end) + 1;
        // A rest at the start or the end of the video may have lasted longer.
        let ends = match first {
            0 => MIN_FRAMES.min(end)..end + 1,
            _ => end..end + 1,
        };
        for end in ends.map(|end| end.min(path.len())) {
            if is_still(&path[first..end], MAX_REST_DEVIATION) {
                is_resting[first..end].fill(true);
            }
        }
    }
    let mut walks = Vec::new();
    let mut begin = 0;
    for run in is_resting.chunk_by(|a, b| a == b) {
        let (is_rest, end) = (run[0], begin + run.len());
        // Includes the last frame of the rest before and the first frame of the rest after.
        let walk = &path[begin.saturating_sub(1)..(end + 1).min(path.len())];
        let [first, last] = [0, walk.len() - 1].map(|i| walk[i].seconds);
        if !is_rest && moves_away(walk) {
            // The gait may begin and end with a standstill, which looks like a rest.
            let (from, to) = (path[0].seconds, path[path.len() - 1].seconds);
            let half_rest = min_rest_duration / 2.0;
            walks.push([from.max(first - half_rest), to.min(last + half_rest)]);
        }
        begin = end;
    }
    walks
}

/// Returns the smallest duration of a rest between two walks of these gaits, s: longer than any standstill within their
/// cycles, even if the robot moves only half as far as predicted.
pub fn min_rest_duration(gaits: &[Gait]) -> f64 {
    let longest_seconds = gaits.iter().map(longest_standstill).fold(0.0, f64::max);
    (longest_seconds * MIN_REST_RATIO).max(MIN_REST)
}

/// Computes the duration of the longest standstill within a cycle, s.
fn longest_standstill(gait: &Gait) -> f64 {
    let count = gait.path.len() - 1;
    let seconds_at = |i: usize| i as f64 * gait.period / count as f64;
    let point_at = |i: usize| PathPoint {
        seconds: seconds_at(i),
        pose: gait.pose_at(i as f64 / count as f64),
    };
    let path: Vec<PathPoint> = (0..2 * count).map(point_at).collect();
    // A robot that moves less far than predicted stays within the deviation of a rest for longer.
    let max_deviation = MAX_REST_DEVIATION / SCALE_RANGE[0];
    let standstill_from = |first: usize| {
        let ends = (first + MIN_FRAMES..first + count)
            .take_while(|end| is_still(&path[first..*end], max_deviation));
        ends.last().map_or(0.0, |end| seconds_at(end - 1 - first))
    };
    (0..count).map(standstill_from).fold(0.0, f64::max)
}

/// True if the poses scatter by less than `max_deviation`, mm (root mean square).
fn is_still(path: &[PathPoint], max_deviation: f64) -> bool {
    let count = path.len() as f64;
    let movement_to = |point: &PathPoint| movement_in_mm(point.pose.travel_from(path[0].pose));
    let movements: Vec<[f64; 3]> = path.iter().map(movement_to).collect();
    let mean =
        [0, 1, 2].map(|axis| movements.iter().map(|movement| movement[axis]).sum::<f64>() / count);
    let squared_deviation = |movement: &[f64; 3]| {
        movement_length([0, 1, 2].map(|axis| movement[axis] - mean[axis])).powi(2)
    };
    path.len() >= MIN_FRAMES
        && (movements.iter().map(squared_deviation).sum::<f64>() / count).sqrt() < max_deviation
}

/// True if the robot moves away from its first pose.
fn moves_away(path: &[PathPoint]) -> bool {
    let start = path[0].pose;
    path.iter()
        .any(|point| movement_length(movement_in_mm(point.pose.travel_from(start))) > MIN_MOVEMENT)
}
