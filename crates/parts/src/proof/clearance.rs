//! The smallest distances between parts at given poses.
//!
//! Two parts can collide only at a common height. Pairs of layers are therefore selected once by height, and at each
//! pose the distance between their shapes in plan view is measured. Holes are ignored, so the true distance is never
//! smaller than the measured distance.

use std::collections::BTreeMap;
use std::fmt;

use lizard_kinematics::Solution;
use serde::{Deserialize, Serialize};

use crate::bodies::assembly::Assembly;
use crate::layers::body::Prism;
use crate::layers::shape::Shape;

/// The smallest distance found between two bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clearance {
    /// Name of one body.
    pub first: String,
    /// Name of the other body.
    pub second: String,
    /// Servo angles at the smallest distance, deg, servo order.
    pub pose: [f64; 4],
    /// Distance between the bodies, mm; negative if they overlap.
    pub mm: f64,
}

impl fmt::Display for Clearance {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [a, b, c, d] = self.pose;
        let distance = match self.mm < 0.0 {
            true => format!("overlap by {:.2} mm", -self.mm),
            false => format!("are {:.2} mm apart", self.mm),
        };
        let (first, second) = (&self.first, &self.second);
        write!(
            f,
            "{first} and {second} {distance} at pose {a:.2} {b:.2} {c:.2} {d:.2}"
        )
    }
}

impl Assembly {
    /// Finds the pairs of bodies that come closer than `limit_mm` at some pose, by ascending distance, each pair once.
    pub fn find_close_pairs(
        &self,
        poses: impl IntoIterator<Item = Solution>,
        limit_mm: f64,
    ) -> Vec<Clearance> {
        // Pairs of shapes, each with the indices of its bodies and an enclosing disc around each shape.
        let mut pairs = Vec::new();
        let enclose = |shape: &Shape| (shape.middle(), shape.max_distance_from(shape.middle()));
        let overlap_in_height = |p: &Prism, q: &Prism| p.z[0] < q.z[1] && q.z[0] < p.z[1];
        let bodies = self.bodies();
        for (i, a) in bodies.iter().enumerate() {
            for (j, b) in bodies.iter().enumerate().skip(i + 1) {
                if self.may_touch(a, b) {
                    continue;
                }
                let layers = a.prisms.iter();
                let layers = layers.flat_map(|p| b.prisms.iter().map(move |q| (p, q)));
                for (p, q) in layers.filter(|(p, q)| overlap_in_height(p, q)) {
                    for first in &p.filled_shapes {
                        let seconds = q.filled_shapes.iter();
                        pairs.extend(seconds.map(|second| {
                            ([i, j], [(first, enclose(first)), (second, enclose(second))])
                        }));
                    }
                }
            }
        }
        let mut min_by_pair: BTreeMap<[usize; 2], ([f64; 4], f64)> = BTreeMap::new();
        for pose in poses {
            let placements = bodies.iter().map(|body| self.placement(body.mount, &pose));
            let placements: Vec<_> = placements.collect();
            for (body_indices, [(a, (a_middle, a_radius)), (b, (b_middle, b_radius))]) in &pairs {
                let [first, second] = body_indices.map(|body| &placements[body]);
                let disc_gap =
                    (second.map(*b_middle) - first.map(*a_middle)).length() - a_radius - b_radius;
                let known_min = min_by_pair.get(body_indices);
                let min_so_far = known_min.map_or(limit_mm, |(_, mm)| *mm);
                if disc_gap < min_so_far {
                    let mm = a.placed(first).distance(&b.placed(second));
                    if mm < min_so_far {
                        min_by_pair.insert(*body_indices, (pose.pose.into(), mm));
                    }
                }
            }
        }
        let to_clearance = |([i, j], (pose, mm)): ([usize; 2], _)| Clearance {
            first: bodies[i].name.clone(),
            second: bodies[j].name.clone(),
            pose,
            mm,
        };
        let mut clearances: Vec<_> = min_by_pair.into_iter().map(to_clearance).collect();
        clearances.sort_by(|a, b| a.mm.total_cmp(&b.mm));
        clearances
    }

    /// Accepted poses on a grid of `angles_per_servo` angles over each servo's travel.
    pub fn grid_poses(&self, angles_per_servo: u32) -> impl Iterator<Item = Solution> + '_ {
        let robot = self.robot();
        let angle_at = move |servo: usize, index: u32| {
            let servo = &robot.servos()[servo];
            let (low, high) = servo.travel();
            servo.neutral + low + (high - low) * f64::from(index) / f64::from(angles_per_servo - 1)
        };
        (0..angles_per_servo.pow(4)).filter_map(move |pose_index| {
            let digit_at =
                |position: u32| pose_index / angles_per_servo.pow(position) % angles_per_servo;
            robot.solve_if_allowed([0, 1, 2, 3].map(|i| angle_at(i as usize, digit_at(i))))
        })
    }
}
