//! Degrees of freedom of the body and of the legs, by Gruebler's count and by the rank of the constraints.
//!
//! Gruebler's count assumes that no two joints impose the same constraint. The rank of the constraint Jacobian at a
//! pose does not need this assumption. Every moving link has three columns in the Jacobian: vx and vy of its point at
//! the origin, and omega. Every joint has two rows. The degrees of freedom are the number of columns minus the rank.
//!
//! At a type-2 singularity the number of freedoms is the same, but the servos do not control one of them. The rank is
//! therefore computed again with the driven cranks locked, which adds a row for each crank. A link that can still move
//! is loose.

use lizard_kinematics::{Lizard, Side, Solution, Vector};
use nalgebra::{DMatrix, DVector, SVD};
use serde::Serialize;

/// Fraction of the largest singular value below which a singular value counts as zero. A singular pose is still found
/// if its angles are typed with seven digits.
const RANK_TOLERANCE: f64 = 1e-7;

/// Largest speed at which a link counts as standing still, relative to the fastest link's speed.
const MAX_STILL_SPEED: f64 = 1e-3;

/// The unit of length, mm, which makes lengths comparable with angles in radians.
const LENGTH_UNIT_MM: f64 = 50.0;

/// A mechanism: joints that connect links. Link 0 is fixed.
struct Mechanism {
    /// Number of links, including link 0.
    link_count: usize,
    joints: Vec<Joint>,
    /// The numbers of the links that a servo drives.
    driven_links: Vec<usize>,
    /// Groups of links, each with the message if one of its links moves while the driven links are locked.
    link_groups: &'static [(&'static [usize], &'static str)],
}

/// A joint between two links.
struct Joint {
    links: [usize; 2],
    kind: JointKind,
}

/// The kind of a joint, with its position in the examined pose.
enum JointKind {
    /// A pin at a point, mm.
    Revolute(Vector),
    /// A prismatic joint through a point along a direction of length one.
    Prismatic(Vector, Vector),
}

/// The degrees of freedom of a mechanism.
#[derive(Serialize)]
pub struct Mobility {
    /// `body`, or the leg and its servo.
    pub mechanism: &'static str,
    /// Number of links, including the fixed link.
    #[serde(rename = "links")]
    pub link_count: usize,
    /// Number of joints.
    #[serde(rename = "joints")]
    pub joint_count: usize,
    /// Gruebler's count 3 (N - 1) - 2 j, for N links and j joints with one freedom each.
    pub gruebler: i64,
    /// Rows of the constraint Jacobian.
    #[serde(rename = "constraints")]
    pub constraint_count: usize,
    /// Columns of the constraint Jacobian.
    #[serde(rename = "velocities")]
    pub velocity_count: usize,
    /// Rank of the constraint Jacobian.
    pub rank: usize,
    /// Columns minus rank.
    pub freedoms: usize,
    /// Degrees of freedom with the driven cranks locked; 0 if no link can move.
    pub locked_freedoms: usize,
    /// Messages about the links that move while the cranks are locked.
    #[serde(rename = "loose")]
    pub loose_messages: Vec<&'static str>,
    /// Smallest singular value divided by the largest, for the Jacobian with the driven cranks locked; it approaches
    /// 0 at a singularity.
    #[serde(rename = "conditioning")]
    pub inverse_condition_number: f64,
}

/// Computes the degrees of freedom of the body and of each leg at a pose.
pub fn compute_mobilities(lizard: &Lizard, solution: &Solution) -> Vec<Mobility> {
    let leg_names = ["leg LF (A1)", "leg RF (A2)", "leg RH (A3)", "leg LH (A4)"];
    let mut mobilities = vec![Mobility::compute("body", &build_body(lizard, solution))];
    for (servo, name) in leg_names.into_iter().enumerate() {
        let leg = build_leg(lizard, solution, servo);
        mobilities.push(Mobility::compute(name, &leg));
    }
    mobilities
}

/// Builds the body with its 13 links: chassis, four cranks (with their side arms), four couplers and four slider
/// halves.
fn build_body(lizard: &Lizard, solution: &Solution) -> Mechanism {
    const CRANK_LINKS: [usize; 4] = [1, 2, 3, 4];
    let tips = solution.crank_tips();
    let shafts = lizard.shafts();
    let pin_joint = |links: [usize; 2], point: Vector| Joint {
        links,
        kind: JointKind::Revolute(point),
    };
    let shaft_joints = (0..4).map(|i| pin_joint([0, CRANK_LINKS[i]], shafts[i]));
    let mut joints: Vec<Joint> = shaft_joints.collect();
    // Head couplers 5, 6; tail couplers 7 (left), 8 (right).
    joints.push(pin_joint([CRANK_LINKS[0], 5], tips[0]));
    joints.push(pin_joint([CRANK_LINKS[1], 6], tips[1]));
    joints.push(pin_joint([5, 6], solution.head_point()));
    joints.push(pin_joint([CRANK_LINKS[3], 7], tips[3]));
    joints.push(pin_joint([CRANK_LINKS[2], 8], tips[2]));
    joints.push(pin_joint([7, 8], solution.tail_point()));
    // Slider halves: left rear 9, front 10; right rear 11, front 12.
    for (side, halves) in Side::ALL.into_iter().zip([[9, 10], [11, 12]]) {
        let ([front, rear], slider) = (side.servos(), solution.side(side));
        let [rear_tip, front_tip] =
            [slider.rear_tip, slider.front_tip].map(|tip| shafts[rear] + tip);
        joints.push(pin_joint([CRANK_LINKS[rear], halves[0]], rear_tip));
        joints.push(pin_joint([CRANK_LINKS[front], halves[1]], front_tip));
        let direction = slider.span * (1.0 / slider.d);
        joints.push(Joint {
            links: halves,
            kind: JointKind::Prismatic(rear_tip, direction),
        });
    }
    Mechanism {
        link_count: 13,
        joints,
        driven_links: CRANK_LINKS.to_vec(),
        link_groups: &[
            (&[5, 6], "the head's end point is loose (type 2)"),
            (&[7, 8], "the tail's end point is loose (type 2)"),
            (&[9, 10], "the left slider is loose"),
            (&[11, 12], "the right slider is loose"),
        ],
    }
}

/// Builds a leg's four-bar: ground 0, crank 1, coupler 2, follower 3. The origin is the crank's pivot, the axes are
/// those of the chassis frame. The spring between leg and body imposes no rigid constraint, so it is not a link.
fn build_leg(lizard: &Lizard, solution: &Solution, servo: usize) -> Mechanism {
    let crank = solution.legs[servo].direction * lizard.leg.crank;
    let ground_vector = Vector::new(lizard.leg.ground, 0.0);
    let points = [
        ([0, 1], Vector::default()),
        ([1, 2], crank),
        ([2, 3], ground_vector + crank),
        ([3, 0], ground_vector),
    ];
    let joints = points.map(|(links, point)| Joint {
        links,
        kind: JointKind::Revolute(point),
    });
    Mechanism {
        link_count: 4,
        joints: joints.into(),
        driven_links: vec![1],
        link_groups: &[(
            &[2, 3],
            "coupler and follower may go either way (change point)",
        )],
    }
}

/// Counts the body's degrees of freedom at a pose from the rank of the constraints.
pub fn count_body_freedoms(lizard: &Lizard, solution: &Solution) -> usize {
    count_freedoms(&build_body(lizard, solution))
}

/// Counts the left front leg's degrees of freedom at a pose from the rank of the constraints.
pub fn count_left_front_leg_freedoms(lizard: &Lizard, solution: &Solution) -> usize {
    count_freedoms(&build_leg(lizard, solution, 0))
}

/// Counts a mechanism's degrees of freedom if no crank is locked, from the rank of the constraints.
fn count_freedoms(mechanism: &Mechanism) -> usize {
    let free_jacobian = build_constraint_jacobian(mechanism, &[]);
    free_jacobian.ncols() - compute_rank(&free_jacobian.singular_values())
}

impl Mobility {
    /// Computes the mobility of a mechanism, whose name becomes [`Mobility::mechanism`].
    fn compute(name: &'static str, mechanism: &Mechanism) -> Self {
        let joint_count = mechanism.joints.len();
        let free_jacobian = build_constraint_jacobian(mechanism, &[]);
        let (constraint_count, velocity_count) = free_jacobian.shape();
        let rank = compute_rank(&free_jacobian.singular_values());
        let locked_jacobian = build_constraint_jacobian(mechanism, &mechanism.driven_links);
        let locked_svd = SVD::new(locked_jacobian, false, true);
        let singular_values = &locked_svd.singular_values;
        let zero_threshold = RANK_TOLERANCE * singular_values.max();
        let mut loose_messages = Vec::new();
        if let Some(directions) = &locked_svd.v_t {
            for (value, direction) in singular_values.iter().zip(directions.row_iter()) {
                if *value <= zero_threshold {
                    let speeds: Vec<f64> = (0..mechanism.link_count - 1)
                        .map(|link| direction.columns(3 * link, 3).norm())
                        .collect();
                    let max_speed = speeds.iter().copied().fold(0.0, f64::max);
                    let link_groups = mechanism.link_groups.iter();
                    loose_messages.extend(link_groups.filter_map(|(links, message)| {
                        let is_moving =
                            |link: &usize| speeds[link - 1] > MAX_STILL_SPEED * max_speed;
                        links.iter().any(is_moving).then_some(*message)
                    }));
                }
            }
        }
        loose_messages.sort_unstable();
        loose_messages.dedup();
        Self {
            mechanism: name,
            link_count: mechanism.link_count,
            joint_count,
            gruebler: 3 * (mechanism.link_count as i64 - 1) - 2 * joint_count as i64,
            constraint_count,
            velocity_count,
            rank,
            freedoms: velocity_count - rank,
            locked_freedoms: velocity_count - compute_rank(singular_values),
            loose_messages,
            inverse_condition_number: singular_values.min() / singular_values.max(),
        }
    }
}

/// Computes a matrix's rank: the number of singular values that are not zero.
fn compute_rank(singular_values: &DVector<f64>) -> usize {
    let zero_threshold = RANK_TOLERANCE * singular_values.max();
    let values = singular_values.iter();
    values.filter(|value| **value > zero_threshold).count()
}

/// Builds the constraints on the velocities of the moving links: two rows for each joint, and one row for each link
/// that is locked against turning.
fn build_constraint_jacobian(mechanism: &Mechanism, locked_links: &[usize]) -> DMatrix<f64> {
    let joint_count = mechanism.joints.len();
    let velocity_count = 3 * (mechanism.link_count - 1);
    let mut rows = DMatrix::<f64>::zeros(2 * joint_count + locked_links.len(), velocity_count);
    let mut add_entries = |row: usize, link: usize, entries: [f64; 3]| {
        if link > 0 {
            for (i, entry) in entries.into_iter().enumerate() {
                rows[(row, 3 * (link - 1) + i)] += entry;
            }
        }
    };
    for (i, joint) in mechanism.joints.iter().enumerate() {
        let [first_row, second_row] = [2 * i, 2 * i + 1];
        for (link, sign) in [(joint.links[0], 1.0), (joint.links[1], -1.0)] {
            match joint.kind {
                // Both links give the common point the same velocity, v + omega x p.
                JointKind::Revolute(point) => {
                    let [x, y] = [sign * point.x, -sign * point.y].map(|mm| mm / LENGTH_UNIT_MM);
                    add_entries(first_row, link, [sign, 0.0, y]);
                    add_entries(second_row, link, [0.0, sign, x]);
                }
                // Both links have the same omega, and the same velocity across the slide.
                JointKind::Prismatic(point, direction) => {
                    let normal = direction.rotated_left();
                    let moment = sign * point.cross(normal) / LENGTH_UNIT_MM;
                    add_entries(first_row, link, [0.0, 0.0, sign]);
                    add_entries(second_row, link, [sign * normal.x, sign * normal.y, moment]);
                }
            }
        }
    }
    for (i, &link) in locked_links.iter().enumerate() {
        add_entries(2 * joint_count + i, link, [0.0, 0.0, 1.0]);
    }
    rows
}
