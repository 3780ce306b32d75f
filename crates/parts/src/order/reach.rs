//! A check that every screw can be put in and turned in the order of the guide.
//!
//! A screw is pushed in along its axis, head last, so a space as long as the screw and as wide as the head must be free
//! above the head. A screwdriver or hex key, which holds the head while the nut is turned, must also fit there. A
//! socket must fit around the nut. A nut that is sunk into a part is pushed in with a finger; the part then keeps the
//! nut from turning, as a pocket does for a hexagonal head.
//!
//! When a screw is turned, all bodies of the earlier stages are in place, and all bodies of the screw's own stage
//! except the screw and its nut, so the order within a stage does not matter. On the bench, only those bodies are
//! considered that the step has added to the link or leg of the same servo. A screw whose nut comes in a later step is
//! pushed in at its own stage, and turned when the nut comes. A pad moves with its screw, so it is no obstacle; the key
//! reaches the screw through the pad's hole.
//!
//! The servos are at neutral. If a screw cannot be reached at neutral, a search finds the nearest accepted pose at
//! which the screw can be reached, and the guide describes this pose.

use std::fmt;

use lizard_kinematics::{Pose, Solution, Vector};

use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Kind, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::order_heights;
use crate::order::steps::{Step, TurningPlace};

/// Radius of a screwdriver or hex key, mm.
const TOOL_RADIUS: f64 = 2.0;
/// Length of a screwdriver or hex key above the screw's head, mm.
const TOOL_LENGTH: f64 = 30.0;
/// Radius of the hex key for an M3 button head (2 mm across flats) in a pad's hole, mm.
const HEX_KEY_RADIUS: f64 = 1.2;
/// Wall thickness of a socket around a nut, mm.
const SOCKET_WALL: f64 = 1.0;
/// Length of a socket beyond its nut, mm.
const SOCKET_LENGTH: f64 = 10.0;
/// Angles by which the search for a pose turns one servo, deg.
const SEARCH_ANGLES: [f64; 12] = [
    5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0,
];
/// Number of angles per servo in the grid of poses that is searched if turning one servo is not enough.
const GRID_ANGLES_PER_SERVO: u32 = 9;

/// An operation on a screw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScrewOperation {
    /// Pushing the screw in along its axis.
    Push,
    /// Turning or holding the screw at its head.
    Turn,
    /// Pushing in or turning the screw's nut.
    FitNut,
}

/// A screw that another body blocks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{screw} {operation} at step {step} of the guide: {obstacle} is in the way")]
pub struct BlockedScrew {
    /// Step of the guide, from 1.
    pub step: usize,
    /// Name of the screw.
    pub screw: String,
    /// Operation that the obstacle prevents.
    pub operation: ScrewOperation,
    /// Name of the body in the way.
    pub obstacle: String,
}

impl fmt::Display for ScrewOperation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Push => "cannot be pushed in",
            Self::Turn => "cannot be turned",
            Self::FitNut => "cannot get its nut",
        })
    }
}

/// A pose of the servos at which some screws can be reached.
#[derive(Clone, Debug, PartialEq)]
pub struct AccessPose {
    /// Step of the guide, from 1.
    pub step: usize,
    /// Names of the screws that cannot be reached at neutral.
    pub screws: Vec<String>,
    /// Servo angles, deg, servo order.
    pub pose: [f64; 4],
}

/// A space that must be free: a vertical prism over a shape, in the chassis frame.
struct FreeSpace {
    /// Outline as seen from above.
    shape: Shape,
    /// Heights of the bottom and the top, mm.
    z: [f64; 2],
}

/// The axis of a screw in the robot.
struct ScrewAxis {
    /// Position as seen from above, chassis frame, mm.
    position: Vector,
    /// Radius of the screw's head, mm.
    head_radius: f64,
    /// Length of the screw below its head, mm.
    length: f64,
    /// Height of the head's outer face, mm above the chassis plate's top.
    head_face_z: f64,
    /// Direction from the tip to the head: 1 if the head is at the top, otherwise -1.
    direction: f64,
}

impl ScrewAxis {
    /// Makes a cylinder about the axis from a height up, or down if `length` is negative.
    fn cylinder(&self, radius: f64, from: f64, length: f64) -> FreeSpace {
        let to = from + length;
        let (shape, z) = (Shape::disc(self.position, radius), order_heights(from, to));
        FreeSpace { shape, z }
    }
}

/// The robot at the pose at which its screws are mounted.
struct PosedAssembly<'a> {
    assembly: &'a Assembly,
    pose: &'a Solution,
}

impl PosedAssembly<'_> {
    /// Finds the axis of a screw; `None` if the body is no screw.
    fn find_screw_axis(&self, body: &Body) -> Option<ScrewAxis> {
        /// Length of a servo's own screws, mm.
        const SERVO_SCREW_LENGTH: f64 = 8.0;
        let length = match body.kind {
            Kind::Screw(length) | Kind::HexScrew(length) => length,
            Kind::ServoScrew => SERVO_SCREW_LENGTH,
            _ => return None,
        };
        let diameter = |layer: &Prism| layer.filled_shapes[0].diameter();
        let layers = body.prisms.iter();
        // A screw's head is its widest layer.
        let head = layers.max_by(|a, b| diameter(a).total_cmp(&diameter(b)))?;
        let is_above = body.prisms.last() == Some(head);
        let placement = self.assembly.placement(body.mount, self.pose);
        Some(ScrewAxis {
            position: placement.map(head.filled_shapes[0].middle()),
            head_radius: diameter(head) / 2.0,
            length,
            head_face_z: head.z[usize::from(is_above)],
            direction: if is_above { 1.0 } else { -1.0 },
        })
    }

    /// True if a body extends into a space and none of the body's holes encloses the space.
    fn extends_into(&self, body: &Body, space: &FreeSpace) -> bool {
        /// Overlap that still counts as touching, mm.
        const TOUCH_TOLERANCE: f64 = 1e-6;
        let placement = self.assembly.placement(body.mount, self.pose);
        let [low, high] = space.z;
        let is_at_height = |prism: &&Prism| {
            prism.z[0] <= high - TOUCH_TOLERANCE && prism.z[1] >= low + TOUCH_TOLERANCE
        };
        let overlaps =
            |shape: &Shape| space.shape.distance(&shape.placed(&placement)) < -TOUCH_TOLERANCE;
        let encloses = |hole: &Shape| {
            let placed_hole = hole.placed(&placement);
            space.shape.depth_in(&placed_hole, Vector::default()) > -TOUCH_TOLERANCE
        };
        let mut prisms = body.prisms.iter().filter(is_at_height);
        prisms.any(|prism| {
            prism.filled_shapes.iter().any(overlaps) && !prism.cut_shapes.iter().any(encloses)
        })
    }

    /// Computes the space that a nut needs on its screw.
    fn compute_nut_space(
        &self,
        nut: &Body,
        axis: &ScrewAxis,
        surrounding_bodies: &[&Body],
    ) -> FreeSpace {
        let placement = self.assembly.placement(nut.mount, self.pose);
        let nut_outline = nut.prisms[0].filled_shapes[0].placed(&placement);
        let corner_radius = (nut_outline.points[0] - axis.position).length();
        // The face that touches the part, and the outer face.
        let [low, high] = nut.z();
        let (bearing_z, outer_z) = match axis.direction > 0.0 {
            true => (high, low),
            false => (low, high),
        };
        let encloses = |hole: &Shape| {
            let depth = nut_outline.depth_in(&hole.placed(&placement), Vector::default());
            hole.points.len() == 6 && depth > 0.0
        };
        let bodies = surrounding_bodies.iter();
        let mount_bodies = bodies.filter(|body| body.mount == nut.mount);
        let mut prisms = mount_bodies.flat_map(|body| &body.prisms);
        let is_sunk = prisms.any(|prism| prism.cut_shapes.iter().any(encloses));
        let length = -axis.direction * SOCKET_LENGTH;
        match is_sunk {
            true => FreeSpace {
                shape: nut_outline,
                ..axis.cylinder(0.0, outer_z, length)
            },
            false => {
                let socket_length = outer_z - bearing_z + length;
                axis.cylinder(corner_radius + SOCKET_WALL, bearing_z, socket_length)
            }
        }
    }

    /// Finds the impossible operations on a screw among the surrounding bodies, after a stage has added `new_bodies`,
    /// each with the name of the obstacle. `is_turned_again` is true if the stage turns the screw again.
    fn find_blocked_operations(
        &self,
        screw: &Body,
        new_bodies: &[&Body],
        surrounding_bodies: &[&Body],
        is_turned_again: bool,
    ) -> Vec<(ScrewOperation, String)> {
        let Some(axis) = self.find_screw_axis(screw) else {
            return Vec::new();
        };
        let nut = self.assembly.body(&screw.name.replacen("screw", "nut", 1));
        let nut = nut.filter(|nut| nut.kind == Kind::Nut);
        let is_in =
            |list: &[&Body], body: &Body| list.iter().any(|listed| listed.name == body.name);
        let new_nut = nut.filter(|nut| is_in(new_bodies, nut));
        let is_complete = is_in(surrounding_bodies, screw)
            && nut.is_none_or(|nut| is_in(surrounding_bodies, nut));
        let is_new = is_in(new_bodies, screw);
        let leg_of_pad = screw.name.strip_prefix("screw height ");
        let pad = leg_of_pad.and_then(|leg| self.assembly.body(&format!("pad {leg}")));
        let own_bodies: Vec<&Body> = [Some(screw), nut, pad].into_iter().flatten().collect();
        let mut other_bodies = surrounding_bodies.to_vec();
        other_bodies.retain(|body| !is_in(&own_bodies, body));
        let make_space_above_head = |radius: f64, length: f64| {
            axis.cylinder(radius, axis.head_face_z, axis.direction * length)
        };
        let mut spaces = Vec::new();
        if is_new {
            let space = make_space_above_head(axis.head_radius, axis.length);
            spaces.push((ScrewOperation::Push, space));
        }
        // A hexagonal head is held by its pocket, so no tool has to turn it.
        let needs_turning = !matches!(screw.kind, Kind::HexScrew(_));
        // The pad in the way of the hex key, if the key does not fit through the pad's hole.
        let mut blocking_pad = None;
        if needs_turning && is_complete && (is_new || new_nut.is_some() || is_turned_again) {
            let tool_space = make_space_above_head(TOOL_RADIUS, TOOL_LENGTH);
            spaces.push((ScrewOperation::Turn, tool_space));
            let key_space = make_space_above_head(HEX_KEY_RADIUS, TOOL_LENGTH);
            let pad = pad.filter(|pad| is_in(surrounding_bodies, pad));
            blocking_pad = pad.filter(|pad| self.extends_into(pad, &key_space));
        }
        if let Some(nut) = new_nut {
            let space = self.compute_nut_space(nut, &axis, &other_bodies);
            spaces.push((ScrewOperation::FitNut, space));
        }
        let find_obstacle = |(operation, space): (ScrewOperation, FreeSpace)| {
            let mut bodies = other_bodies.iter();
            let obstacle = bodies.find(|body| self.extends_into(body, &space))?;
            Some((operation, obstacle.name.clone()))
        };
        let pad_obstacle = blocking_pad.map(|pad| (ScrewOperation::Turn, pad.name.clone()));
        let obstacles = spaces.into_iter().filter_map(find_obstacle);
        obstacles.chain(pad_obstacle).collect()
    }
}

impl Assembly {
    /// Finds the screws that cannot be inserted or turned in the order of these steps, with the servos at a pose.
    pub fn find_blocked_screws(&self, steps: &[Step], pose: &Solution) -> Vec<BlockedScrew> {
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
                    let mut surrounding_bodies = bodies_so_far.clone();
                    if stage.turning_place == TurningPlace::Bench {
                        surrounding_bodies.drain(..step_start);
                        let servos = screw.mount.servos();
                        surrounding_bodies.retain(|body| body.mount.servos() == servos);
                    }
                    let is_turned_again = (stage.turns_again)(screw);
                    let blocked_operations = posed_assembly.find_blocked_operations(
                        screw,
                        &new_bodies,
                        &surrounding_bodies,
                        is_turned_again,
                    );
                    for (operation, obstacle) in blocked_operations {
                        blocked_screws.push(BlockedScrew {
                            step: step_number,
                            screw: screw.name.clone(),
                            operation,
                            obstacle,
                        });
                    }
                }
            }
        }
        blocked_screws
    }

    /// Finds the poses to which the servos must be turned in some steps so that every screw can be reached; empty if
    /// all screws can be reached at neutral, or if the linkages do not close at neutral.
    ///
    /// # Errors
    /// Returns a screw that cannot be reached at neutral or at any other tried pose.
    pub fn find_access_poses(&self, steps: &[Step]) -> Result<Vec<AccessPose>, BlockedScrew> {
        let mut access_poses: Vec<AccessPose> = Vec::new();
        let neutral = self.robot().neutral_pose();
        let Ok(solution) = self.robot().lizard().solve(&neutral) else {
            return Ok(access_poses);
        };
        let mut unreached_screws = self.find_blocked_screws(steps, &solution);
        if unreached_screws.is_empty() {
            return Ok(access_poses);
        }
        for pose in self.list_poses_near(neutral) {
            let blocked_at_pose = self.find_blocked_screws(steps, &pose);
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

    /// Lists accepted poses: poses with one servo turned from neutral, by ascending angle, then the poses of a grid, by
    /// ascending distance from neutral.
    fn list_poses_near(&self, neutral: Pose) -> Vec<Solution> {
        let neutral_angles: [f64; 4] = neutral.into();
        let mut poses = Vec::new();
        for angle in SEARCH_ANGLES {
            for (servo, change) in (0..4).flat_map(|servo| [(servo, angle), (servo, -angle)]) {
                let mut angles = neutral_angles;
                angles[servo] += change;
                poses.extend(self.robot().solve_if_allowed(angles));
            }
        }
        let distance_from_neutral = |solution: &Solution| {
            let angles: [f64; 4] = solution.pose.into();
            let pairs = angles.iter().zip(neutral_angles);
            pairs.fold(0.0, |max, (a, b)| (a - b).abs().max(max))
        };
        let mut grid_poses: Vec<_> = self.grid_poses(GRID_ANGLES_PER_SERVO).collect();
        grid_poses.sort_by(|a, b| distance_from_neutral(a).total_cmp(&distance_from_neutral(b)));
        poses.extend(grid_poses);
        poses
    }
}
