//! The walks of a path: the times in which the robot moves, between its rests.
//!
//! A gait may make the robot stand still for a part of its cycle. Only a longer standstill counts as a rest.

use crate::gait::{Gait, MIN_MOVEMENT, movement_in_mm, movement_length};
use crate::path::PathPoint;

/// Shortest rest, s.
const MIN_REST: f64 = 0.8;
/// Largest root-mean-square distance of the places in a rest from their mean, mm. The error of a tag's place is
/// smaller.
const MAX_REST_DEVIATION: f64 = 0.5;
/// Smallest number of pictures of a rest.
const MIN_PICTURES: usize = 3;
/// Ratio of the shortest rest to the longest time for which a gait stands still.
const MIN_REST_RATIO: f64 = 1.4;

/// Finds the walks: the times, s, in which the robot moves away between two rests, each extended by half of
/// `shortest_rest` at its beginning and its end. A rest lasts `shortest_rest` seconds or more.
pub(crate) fn find_walks(path: &[PathPoint], shortest_rest: f64) -> Vec<[f64; 2]> {
    let mut is_resting = vec![false; path.len()];
    for (first, point) in path.iter().enumerate() {
        let end = path
            .partition_point(|later_point| later_point.seconds < point.seconds + shortest_rest)
            + 1;
        // A rest at the beginning or at the end of the film may have lasted longer.
        let ends = match first {
            0 => MIN_PICTURES.min(end)..end + 1,
            _ => end..end + 1,
        };
        for end in ends.map(|end| end.min(path.len())) {
            if is_still(&path[first..end]) {
                is_resting[first..end].fill(true);
            }
        }
    }
    let mut walks = Vec::new();
    let mut begin = 0;
    while begin < path.len() {
        let is_rest = is_resting[begin];
        let end = (begin..path.len())
            .find(|&i| is_resting[i] != is_rest)
            .unwrap_or(path.len());
        // Includes the last picture of the rest before and the first picture of the rest after.
        let walk = &path[begin.saturating_sub(1)..(end + 1).min(path.len())];
        let [first, last] = [0, walk.len() - 1].map(|i| walk[i].seconds);
        if !is_rest && moves_away(walk) {
            // The gait may begin and end with a time in which the robot stands still, which looks like a rest.
            let from = path[0].seconds.max(first - shortest_rest / 2.0);
            walks.push([
                from,
                path[path.len() - 1].seconds.min(last + shortest_rest / 2.0),
            ]);
        }
        begin = end;
    }
    walks
}

/// The shortest rest between two walks of these gaits, s: longer than any standstill within their cycles.
pub fn shortest_rest(gaits: &[Gait]) -> f64 {
    let longest_seconds = gaits.iter().map(longest_standstill).fold(0.0, f64::max);
    (longest_seconds * MIN_REST_RATIO).max(MIN_REST)
}

/// The longest time within a cycle in which the robot stands still, s.
fn longest_standstill(gait: &Gait) -> f64 {
    let count = gait.path.len() - 1;
    let seconds_of = |i: usize| i as f64 * gait.period / count as f64;
    let point_at = |i: usize| PathPoint {
        seconds: seconds_of(i),
        place: gait.place_at(i as f64 / count as f64),
    };
    let path: Vec<PathPoint> = (0..2 * count).map(point_at).collect();
    let standstill_from = |first: usize| {
        let ends =
            (first + MIN_PICTURES..first + count).take_while(|end| is_still(&path[first..*end]));
        ends.last().map_or(0.0, |end| seconds_of(end - 1 - first))
    };
    (0..count).map(standstill_from).fold(0.0, f64::max)
}

/// True if the places scatter no more than those of a robot at rest.
fn is_still(path: &[PathPoint]) -> bool {
    let count = path.len() as f64;
    let movements: Vec<[f64; 3]> = path
        .iter()
        .map(|point| movement_in_mm(point.place.travel_from(path[0].place)))
        .collect();
    let mean =
        [0, 1, 2].map(|axis| movements.iter().map(|movement| movement[axis]).sum::<f64>() / count);
    let squared_deviation = |movement: &[f64; 3]| {
        movement_length([0, 1, 2].map(|axis| movement[axis] - mean[axis])).powi(2)
    };
    path.len() >= MIN_PICTURES
        && (movements.iter().map(squared_deviation).sum::<f64>() / count).sqrt()
            < MAX_REST_DEVIATION
}

/// True if the robot moves away from the first place.
fn moves_away(path: &[PathPoint]) -> bool {
    let start = path[0].place;
    path.iter()
        .any(|point| movement_length(movement_in_mm(point.place.travel_from(start))) > MIN_MOVEMENT)
}
