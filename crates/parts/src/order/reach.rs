//! A check that every screw can be put in and turned in the order of the guide.
//!
//! A screw is pushed in along its axis from the side of its head. So the space above its head must be free, as long
//! as the screw and as wide as its head. A hex key holds the head while the nut is turned, so a [`KEY_SIZE`] must also
//! fit above the head. A socket goes over the nut and needs the room of a [`SOCKET_SIZE`]. A nut that is sunk into a
//! part is pushed in with a finger; the part then keeps it from turning, as a pocket does for a hexagonal head.
//!
//! When a screw is turned, all bodies of the earlier stages are in place, and all bodies of its own stage except
//! the screw and its nut. So the order within a stage does not matter. On the bench, only those bodies count that
//! the step has added to the link or leg of the same servo. A screw whose nut comes in a later step is pushed in at
//! its own stage, and turned when the nut comes. A pad moves with the screw in it; the key reaches that screw
//! through the pad's hole.
//!
//! The servos are at neutral. If a screw cannot be reached at neutral, a search finds the nearest pose that the guard
//! accepts and at which the screw can be reached, and the guide names that pose.

use std::fmt;

use lizard_kinematics::{Pose, Solution, Vector};

use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Kind};
use crate::layers::shape::Shape;
use crate::order::steps::{Step, TurningPlace};

/// Radius of a screwdriver or hex key, and its length above the head, mm.
pub const KEY_SIZE: [f64; 2] = [2.0, 30.0];
/// Radius of the bare hex key for an M3 button head, 2 mm across flats, in the hole of a pad, mm.
const HEX_KEY_RADIUS: f64 = 1.2;
/// Wall thickness of a socket around a nut, and the socket's length beyond the nut, mm.
pub const SOCKET_SIZE: [f64; 2] = [1.0, 10.0];
/// Angles by which one servo is turned in the search for a pose, deg.
const SEARCH_ANGLES: [f64; 12] = [
    5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0,
];
/// Number of angles per servo in the grid of poses that are searched if turning one servo is not enough.
const GRID_ANGLES_PER_SERVO: u32 = 9;

/// An operation on a screw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScrewOperation {
    /// Pushing the screw in along its axis.
    Push,
    /// Turning or holding the screw at its head.
    Turn,
    /// Pushing the screw's nut in, or turning it.
    FitNut,
}

/// A screw that another body blocks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{screw} {operation} at step {step} of the guide: {obstacle} is in the way")]
pub struct BlockedScrew {
    /// The step of the guide, from 1.
    pub step: usize,
    /// The name of the screw.
    pub screw: String,
    /// The operation that is impossible.
    pub operation: ScrewOperation,
    /// The name of the body in the way.
    pub obstacle: String,
}

impl fmt::Display for ScrewOperation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Push => "cannot be pushed in",
            Self::Turn => "cannot be turned",
            Self::FitNut => "cannot be given its nut",
        })
    }
}

/// A pose to which the servos are turned so that some screws can be reached.
#[derive(Clone, Debug, PartialEq)]
pub struct AccessPose {
    /// The step of the guide, from 1.
    pub step: usize,
    /// The screws that cannot be reached at neutral.
    pub screws: Vec<String>,
    /// Angles, deg, servo order.
    pub pose: [f64; 4],
}

/// A space that must be free: a vertical prism over a shape, in the chassis frame.
struct FreeSpace {
    /// The outline as seen from above.
    shape: Shape,
    /// Heights of the bottom and the top, mm.
    z: [f64; 2],
}

/// The axis of a screw in the robot.
struct ScrewAxis {
    /// The axis as seen from above, chassis frame, mm.
    position: Vector,
    /// Radius of the screw's head, mm.
    head_radius: f64,
    /// Length of the screw below its head, mm.
    length: f64,
    /// Height of the head's outer face, mm above the chassis plate's top.
    head_face_z: f64,
    /// 1 if the head is at the top, else -1.
    direction: f64,
}

impl ScrewAxis {
    /// The cylinder about the axis that begins at a height and has a length; one of negative length extends down.
    fn cylinder(&self, radius: f64, from: f64, length: f64) -> FreeSpace {
        let to = from + length;
        FreeSpace {
            shape: Shape::disc(self.position, radius),
            z: [from.min(to), from.max(to)],
        }
    }
}

/// The robot at the pose at which its screws are put in.
struct PosedAssembly<'a> {
    assembly: &'a Assembly,
    pose: &'a Solution,
}

impl PosedAssembly<'_> {
    /// The axis of a screw; `None` for other bodies.
    fn screw_axis(&self, body: &Body) -> Option<ScrewAxis> {
        /// Length of a servo's own screws, mm.
        const SERVO_SCREW_LENGTH: f64 = 8.0;
        let length = match body.kind {
            Kind::Screw(length) | Kind::HexScrew(length) => length,
            Kind::ServoScrew => SERVO_SCREW_LENGTH,
            _ => return None,
        };
        let diameter_of = |i: usize| body.prisms[i].filled_shapes[0].diameter();
        let last_index = body.prisms.len().checked_sub(1)?;
        // A screw's head is its widest layer.
        let head_index =
            (0..=last_index).max_by(|a, b| diameter_of(*a).total_cmp(&diameter_of(*b)))?;
        let (is_above, prism) = (head_index == last_index, &body.prisms[head_index]);
        let placement = self.assembly.place(body.mount, self.pose);
        Some(ScrewAxis {
            position: placement.map(prism.filled_shapes[0].middle()),
            head_radius: prism.filled_shapes[0].diameter() / 2.0,
            length,
            head_face_z: prism.z[usize::from(is_above)],
            direction: if is_above { 1.0 } else { -1.0 },
        })
    }

    /// True if a body extends into a space that none of the body's holes encloses.
    fn extends_into(&self, body: &Body, space: &FreeSpace) -> bool {
        /// Overlap that still counts as touching, mm.
        const TOUCH_TOLERANCE: f64 = 1e-6;
        let placement = self.assembly.place(body.mount, self.pose);
        let [low, high] = space.z;
        let is_beside = |z: [f64; 2]| z[0] > high - TOUCH_TOLERANCE || z[1] < low + TOUCH_TOLERANCE;
        let no_motion = Vector::default();
        let overlaps =
            |shape: &Shape| space.shape.distance(&shape.placed(&placement)) < -TOUCH_TOLERANCE;
        let encloses = |hole: &Shape| {
            space.shape.depth_in(&hole.placed(&placement), no_motion) > -TOUCH_TOLERANCE
        };
        let mut prisms = body.prisms.iter().filter(|prism| !is_beside(prism.z));
        prisms.any(|prism| {
            prism.filled_shapes.iter().any(overlaps) && !prism.cut_shapes.iter().any(encloses)
        })
    }

    /// The space that a nut needs on its screw.
    fn nut_space(&self, nut: &Body, axis: &ScrewAxis, surrounding_bodies: &[&Body]) -> FreeSpace {
        let placement = self.assembly.place(nut.mount, self.pose);
        let nut_outline = nut.prisms[0].filled_shapes[0].placed(&placement);
        let corner_radius = (nut_outline.points[0] - axis.position).length();
        // The face that touches the part, and the outer face.
        let [low, high] = nut.z();
        let (bearing_height, outer_height) = match axis.direction > 0.0 {
            true => (high, low),
            false => (low, high),
        };
        let encloses = |hole: &Shape| {
            let depth = nut_outline.depth_in(&hole.placed(&placement), Vector::default());
            hole.points.len() == 6 && depth > 0.0
        };
        let mut mount_bodies = surrounding_bodies
            .iter()
            .filter(|body| body.mount == nut.mount);
        let is_sunk = mount_bodies.any(|body| {
            body.prisms
                .iter()
                .any(|prism| prism.cut_shapes.iter().any(encloses))
        });
        let length = -axis.direction * SOCKET_SIZE[1];
        match is_sunk {
            true => FreeSpace {
                shape: nut_outline,
                ..axis.cylinder(0.0, outer_height, length)
            },
            false => axis.cylinder(
                corner_radius + SOCKET_SIZE[0],
                bearing_height,
                outer_height - bearing_height + length,
            ),
        }
    }

    /// The impossible operations on a screw once `new_bodies` are added, each with the name of the body in the way.
    fn blocked_operations(
        &self,
        screw: &Body,
        new_bodies: &[&Body],
        surrounding_bodies: &[&Body],
        is_turned_later: bool,
    ) -> Vec<(ScrewOperation, String)> {
        let Some(axis) = self.screw_axis(screw) else {
            return Vec::new();
        };
        let nut = self.assembly.body(&screw.name.replacen("screw", "nut", 1));
        let nut = nut.filter(|nut| nut.kind == Kind::Nut);
        let is_screw_or_its_nut =
            |name: &str| name == screw.name || nut.is_some_and(|nut| nut.name == name);
        let is_in =
            |list: &[&Body], body: &Body| list.iter().any(|listed| listed.name == body.name);
        let new_nut = nut.filter(|nut| is_in(new_bodies, nut));
        let is_complete = is_in(surrounding_bodies, screw)
            && nut.is_none_or(|nut| is_in(surrounding_bodies, nut));
        let is_new = is_in(new_bodies, screw);
        let leg_of_pad = screw.name.strip_prefix("screw height ");
        let pad = leg_of_pad.and_then(|leg| self.assembly.body(&format!("pad {leg}")));
        let is_pad = |body: &Body| pad.is_some_and(|pad| pad.name == body.name);
        let other_bodies = surrounding_bodies
            .iter()
            .filter(|body| !is_screw_or_its_nut(&body.name));
        let other_bodies: Vec<&Body> = other_bodies.filter(|body| !is_pad(body)).copied().collect();
        let mut spaces = Vec::new();
        if is_new {
            let space = axis.cylinder(
                axis.head_radius,
                axis.head_face_z,
                axis.direction * axis.length,
            );
            spaces.push((ScrewOperation::Push, space));
        }
        // A hexagonal head is held by its pocket.
        let needs_turning = !matches!(screw.kind, Kind::HexScrew(_));
        // The pad of a height screw, if the hex key does not fit through the pad's hole.
        let mut blocking_pad = None;
        if needs_turning && is_complete && (is_new || new_nut.is_some() || is_turned_later) {
            let key_space =
                |radius| axis.cylinder(radius, axis.head_face_z, axis.direction * KEY_SIZE[1]);
            spaces.push((ScrewOperation::Turn, key_space(KEY_SIZE[0])));
            blocking_pad = pad.filter(|pad| {
                is_in(surrounding_bodies, pad) && self.extends_into(pad, &key_space(HEX_KEY_RADIUS))
            });
        }
        if let Some(nut) = new_nut {
            spaces.push((
                ScrewOperation::FitNut,
                self.nut_space(nut, &axis, &other_bodies),
            ));
        }
        let obstacle_of = |(operation, space): (ScrewOperation, FreeSpace)| {
            let obstacle = other_bodies
                .iter()
                .find(|body| self.extends_into(body, &space))?;
            Some((operation, obstacle.name.clone()))
        };
        let pad_obstacle = blocking_pad.map(|pad| (ScrewOperation::Turn, pad.name.clone()));
        spaces
            .into_iter()
            .filter_map(obstacle_of)
            .chain(pad_obstacle)
            .collect()
    }
}

impl Assembly {
    /// The screws that cannot be inserted or turned in the order of these steps, with the servos at a pose.
    pub fn blocked_screws(&self, steps: &[Step], pose: &Solution) -> Vec<BlockedScrew> {
        let posed_assembly = PosedAssembly {
            assembly: self,
            pose,
        };
        let mut blocked_screws = Vec::new();
        let mut bodies_so_far: Vec<&Body> = Vec::new();
        for (step_number, step) in (1..).zip(steps) {
            let step_start = bodies_so_far.len();
            for stage in &step.stages {
                let is_added =
                    |body: &Body| bodies_so_far.iter().any(|added| added.name == body.name);
                let is_new = |body: &&Body| (stage.adds)(body) && !is_added(body);
                let new_bodies: Vec<_> = self.bodies().iter().filter(is_new).collect();
                bodies_so_far.extend(&new_bodies);
                for screw in self.bodies() {
                    let is_on_same_servos =
                        |body: &&&Body| body.mount.servos() == screw.mount.servos();
                    let surrounding_bodies: Vec<_> = match stage.turning_place {
                        TurningPlace::Robot => bodies_so_far.clone(),
                        TurningPlace::Bench => bodies_so_far[step_start..]
                            .iter()
                            .filter(is_on_same_servos)
                            .copied()
                            .collect(),
                    };
                    let is_turned_later = (stage.turns_again)(screw);
                    let blocked_operations = posed_assembly
                        .blocked_operations(
                            screw,
                            &new_bodies,
                            &surrounding_bodies,
                            is_turned_later,
                        )
                        .into_iter();
                    blocked_screws.extend(blocked_operations.map(|(operation, obstacle)| {
                        BlockedScrew {
                            step: step_number,
                            screw: screw.name.clone(),
                            operation,
                            obstacle,
                        }
                    }));
                }
            }
        }
        blocked_screws
    }

    /// The poses to which the servos must be turned in some steps so that every screw can be reached; empty if all
    /// screws can be reached at neutral, or if the linkages do not close at neutral.
    ///
    /// # Errors
    /// Returns a screw that cannot be reached at neutral or at any of the poses that are tried.
    pub fn access_poses(&self, steps: &[Step]) -> Result<Vec<AccessPose>, BlockedScrew> {
        let mut access_poses: Vec<AccessPose> = Vec::new();
        let neutral = self.robot().neutral_pose();
        let Ok(solution) = self.robot().lizard().solve(&neutral) else {
            return Ok(access_poses);
        };
        let mut unreached_screws = self.blocked_screws(steps, &solution);
        if unreached_screws.is_empty() {
            return Ok(access_poses);
        }
        for pose in self.poses_near(neutral) {
            let blocked_at_pose = self.blocked_screws(steps, &pose);
            let is_reached = |unreached: &mut BlockedScrew| {
                let is_same_screw = |blocked: &BlockedScrew| {
                    blocked.step == unreached.step && blocked.screw == unreached.screw
                };
                !blocked_at_pose.iter().any(is_same_screw)
            };
            let angles: [f64; 4] = pose.pose.into();
            for reached_screw in unreached_screws.extract_if(.., is_reached) {
                let is_same_pose = |access_pose: &&mut AccessPose| {
                    access_pose.step == reached_screw.step && access_pose.pose == angles
                };
                match access_poses.iter_mut().find(is_same_pose) {
                    Some(access_pose) if access_pose.screws.contains(&reached_screw.screw) => {}
                    Some(access_pose) => access_pose.screws.push(reached_screw.screw),
                    None => access_poses.push(AccessPose {
                        step: reached_screw.step,
                        screws: vec![reached_screw.screw],
                        pose: angles,
                    }),
                }
            }
            if unreached_screws.is_empty() {
                access_poses.sort_by_key(|access_pose| access_pose.step);
                return Ok(access_poses);
            }
        }
        Err(unreached_screws.swap_remove(0))
    }

    /// Poses that the guard accepts: first those with one servo turned from neutral, the smallest angle first, and
    /// then the poses of a grid, the nearest to neutral first.
    fn poses_near(&self, neutral: Pose) -> Vec<Solution> {
        let neutral_angles: [f64; 4] = neutral.into();
        let mut poses = Vec::new();
        for turn in SEARCH_ANGLES {
            for (servo, turn) in (0..4).flat_map(|servo| [(servo, turn), (servo, -turn)]) {
                let mut angles = neutral_angles;
                angles[servo] += turn;
                poses.extend(self.robot().solve_if_allowed(angles));
            }
        }
        let distance_from_neutral = |solution: &Solution| {
            let angles: [f64; 4] = solution.pose.into();
            let turns = angles
                .iter()
                .zip(neutral_angles)
                .map(|(a, b)| (a - b).abs());
            turns.fold(0.0, f64::max)
        };
        let mut grid_poses: Vec<_> = self.grid_poses(GRID_ANGLES_PER_SERVO).collect();
        grid_poses.sort_by(|a, b| distance_from_neutral(a).total_cmp(&distance_from_neutral(b)));
        poses.extend(grid_poses);
        poses
    }
}
