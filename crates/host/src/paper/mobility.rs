//! `lizard pose --show freedoms`: degrees of freedom, counted and measured.
//!
//! Counting (Gruebler) assumes that no two joints impose the same constraint; the rank of the
//! constraints at a pose does not assume it. Here every moving link has three velocities (vx,
//! vy of its point at the origin, and omega), every joint gives two rows, and the degrees of
//! freedom are the columns less the rank.
//!
//! At a type-2 singularity the number of freedoms is the same, but the servos do not control one
//! of them. So the rank is computed again with the driven cranks locked, which adds a row for
//! each crank. A link that can still move then is loose.

use lizard_kinematics::{Lizard, Side, Solution, Vector};
use nalgebra::{DMatrix, DVector, SVD};
use serde::Serialize;

use crate::Failure;
use crate::shared::json;

/// Singular values below this share of the largest count as zero, so that a singular
/// pose typed with seven digits is found.
const RANK_TOLERANCE: f64 = 1e-7;

/// Links slower than this share of the fastest count as standing still.
const MAX_STILL_SPEED: f64 = 1e-3;

/// The unit of length, mm, that makes rows in mm and in radians comparable.
const LENGTH: f64 = 50.0;

/// A mechanism: joints that connect links. Link 0 is fixed.
struct Mechanism {
    name: &'static str,
    links: usize,
    joints: Vec<Joint>,
    /// The numbers of the links that a servo drives.
    driven: Vec<usize>,
    /// Groups of links, each with the message if one moves while the driven links are locked.
    parts: &'static [(&'static [usize], &'static str)],
}

/// A joint between two links.
struct Joint {
    links: [usize; 2],
    kind: Kind,
}

/// The kind of a joint and its place, in the pose that is examined.
enum Kind {
    /// A pin at a point, mm.
    Revolute(Vector),
    /// A prismatic joint through a point along a direction of length one.
    Prismatic(Vector, Vector),
}

/// The degrees of freedom of a mechanism, with the field names of `--json`.
#[derive(Serialize)]
struct Report {
    mechanism: &'static str,
    links: usize,
    joints: usize,
    /// Gruebler's count, 3 (N - 1 - j) + sum f: N links, j joints with f freedoms each.
    gruebler: i64,
    /// Rows of the constraint Jacobian.
    constraints: usize,
    /// Columns of the constraint Jacobian.
    velocities: usize,
    rank: usize,
    /// Columns minus rank.
    freedoms: usize,
    /// Degrees of freedom with the driven cranks locked; 0 if no link can move then.
    locked_freedoms: usize,
    /// Messages for the parts that move while the cranks are locked.
    loose: Vec<&'static str>,
    /// Smallest singular value divided by the largest, for the Jacobian with the driven cranks locked; it approaches
    /// 0 at a singularity.
    conditioning: f64,
}

/// Prints the degrees of freedom of the body and of each leg.
///
/// # Errors
/// Fails if the output cannot be written.
pub fn print(lizard: &Lizard, solution: &Solution, json: bool) -> Result<(), Failure> {
    let legs = ["leg LF (A1)", "leg RF (A2)", "leg RH (A3)", "leg LH (A4)"];
    let mut all = vec![body_mechanism(lizard, solution)];
    all.extend((0..4).map(|i| leg_mechanism(lizard, solution, i, legs[i])));
    let reports: Vec<Report> = all.iter().map(measure).collect();
    json::print_json_or(json, &reports, || text(&reports))
}

fn text(reports: &[Report]) -> String {
    let mut page =
        "mechanism         links  joints  Gruebler   Jacobian  rank  freedoms  locked  conditioning\n"
            .to_owned();
    for r in reports {
        page += &format!(
            "{:16} {:6} {:7} {:9}   {:>5}x{:<2} {:5} {:9} {:7}  {:12.1e}\n",
            r.mechanism,
            r.links,
            r.joints,
            r.gruebler,
            r.constraints,
            r.velocities,
            r.rank,
            r.freedoms,
            r.locked_freedoms,
            r.conditioning
        );
    }
    page +=
        "locked: freedoms left with the driven cranks locked; conditioning: of that Jacobian\n\n";
    let singular = |r: &&Report| r.freedoms as i64 != r.gruebler || r.locked_freedoms > 0;
    if !reports.iter().any(|r| singular(&r)) {
        page += "Count and rank agree: four servos hold the body, one spring each leg.\n";
    }
    for r in reports.iter().filter(singular) {
        page += &format!(
            "{} is singular here: the rank leaves {} freedoms",
            r.mechanism, r.freedoms
        );
        page += &match r.loose.as_slice() {
            [] => ".\n".to_owned(),
            loose => format!(
                ", and {} with the driven cranks locked: {}.\n",
                r.locked_freedoms,
                loose.join(", ")
            ),
        };
    }
    page
}

/// The 13 links of the body: chassis, four cranks with their side arms, four
/// couplers, four slider halves.
fn body_mechanism(lizard: &Lizard, s: &Solution) -> Mechanism {
    const CRANK: [usize; 4] = [1, 2, 3, 4];
    let tips = s.crank_tips();
    let shafts = lizard.shafts();
    let pin = |a: usize, b: usize, point: Vector| Joint {
        links: [a, b],
        kind: Kind::Revolute(point),
    };
    let mut joints: Vec<Joint> = (0..4).map(|i| pin(0, CRANK[i], shafts[i])).collect();
    // Head couplers 5, 6; tail couplers 7 (left), 8 (right).
    joints.push(pin(CRANK[0], 5, tips[0]));
    joints.push(pin(CRANK[1], 6, tips[1]));
    joints.push(pin(5, 6, s.head_point()));
    joints.push(pin(CRANK[3], 7, tips[3]));
    joints.push(pin(CRANK[2], 8, tips[2]));
    joints.push(pin(7, 8, s.tail_point()));
    // Slider halves: left rear 9, front 10; right rear 11, front 12.
    for (side, halves) in Side::ALL.into_iter().zip([[9, 10], [11, 12]]) {
        let ([front, rear], slider) = (side.servos(), s.side(side));
        let rear_tip = shafts[rear] + slider.rear_tip;
        joints.push(pin(CRANK[rear], halves[0], rear_tip));
        joints.push(pin(
            CRANK[front],
            halves[1],
            shafts[rear] + slider.front_tip,
        ));
        joints.push(Joint {
            links: halves,
            kind: Kind::Prismatic(rear_tip, slider.span * (1.0 / slider.d)),
        });
    }
    Mechanism {
        name: "body",
        links: 13,
        joints,
        driven: CRANK.to_vec(),
        parts: &[
            (&[5, 6], "the head's end point is loose (type 2)"),
            (&[7, 8], "the tail's end point is loose (type 2)"),
            (&[9, 10], "the left slider is loose"),
            (&[11, 12], "the right slider is loose"),
        ],
    }
}

/// A leg's four-bar in a frame of its own: ground 0, crank 1, coupler 2, follower 3. The
/// spring to the body imposes no rigid constraint, so it is not a link.
fn leg_mechanism(lizard: &Lizard, s: &Solution, servo: usize, name: &'static str) -> Mechanism {
    let crank = s.legs[servo].direction * lizard.leg.crank;
    let across = Vector::new(lizard.leg.ground, 0.0);
    let points = [
        ([0, 1], Vector::default()),
        ([1, 2], crank),
        ([2, 3], across + crank),
        ([3, 0], across),
    ];
    let joints = points.map(|(links, point)| Joint {
        links,
        kind: Kind::Revolute(point),
    });
    Mechanism {
        name,
        links: 4,
        joints: joints.into(),
        driven: vec![1],
        parts: &[(
            &[2, 3],
            "coupler and follower may go either way (change point)",
        )],
    }
}

/// The body's degrees of freedom at a pose, by rank.
pub fn body_freedoms(lizard: &Lizard, solution: &Solution) -> usize {
    freedoms(&body_mechanism(lizard, solution))
}

/// The front left leg's degrees of freedom at a pose, by rank.
pub fn leg_freedoms(lizard: &Lizard, solution: &Solution) -> usize {
    freedoms(&leg_mechanism(lizard, solution, 0, "leg"))
}

/// A mechanism's degrees of freedom with unlocked servos, by rank.
fn freedoms(mechanism: &Mechanism) -> usize {
    let free = jacobian(mechanism, &[]);
    free.ncols() - rank(&free.singular_values())
}

fn measure(mechanism: &Mechanism) -> Report {
    let joints = mechanism.joints.len();
    let free = jacobian(mechanism, &[]);
    let (constraints, velocities) = free.shape();
    let rank = rank(&free.singular_values());
    let locked = SVD::new(jacobian(mechanism, &mechanism.driven), false, true);
    let values = &locked.singular_values;
    let zero = RANK_TOLERANCE * values.max();
    let mut loose = Vec::new();
    if let Some(directions) = &locked.v_t {
        for (value, direction) in values.iter().zip(directions.row_iter()) {
            if *value <= zero {
                // Speed of each moving link in this direction.
                let speeds: Vec<f64> = (0..mechanism.links - 1)
                    .map(|link| direction.columns(3 * link, 3).norm())
                    .collect();
                let fastest = speeds.iter().copied().fold(0.0, f64::max);
                loose.extend(mechanism.parts.iter().filter_map(|(links, what)| {
                    let moves = |link: &usize| speeds[link - 1] > MAX_STILL_SPEED * fastest;
                    links.iter().any(moves).then_some(*what)
                }));
            }
        }
    }
    loose.sort_unstable();
    loose.dedup();
    Report {
        mechanism: mechanism.name,
        links: mechanism.links,
        joints,
        gruebler: 3 * (mechanism.links as i64 - 1 - joints as i64) + joints as i64,
        constraints,
        velocities,
        rank,
        freedoms: velocities - rank,
        locked_freedoms: velocities - self::rank(values),
        loose,
        conditioning: values.min() / values.max(),
    }
}

/// The number of singular values that are not zero.
fn rank(values: &DVector<f64>) -> usize {
    let zero = RANK_TOLERANCE * values.max();
    values.iter().filter(|value| **value > zero).count()
}

/// The constraints on the velocities of the moving links: two rows for each
/// joint, and one for each link that is locked against turning.
fn jacobian(mechanism: &Mechanism, locked: &[usize]) -> DMatrix<f64> {
    let joints = mechanism.joints.len();
    let velocities = 3 * (mechanism.links - 1);
    let mut rows = DMatrix::<f64>::zeros(2 * joints + locked.len(), velocities);
    let mut add = |row: usize, link: usize, entries: [f64; 3]| {
        if link > 0 {
            for (i, entry) in entries.into_iter().enumerate() {
                rows[(row, 3 * (link - 1) + i)] += entry;
            }
        }
    };
    for (i, joint) in mechanism.joints.iter().enumerate() {
        for (link, sign) in [(joint.links[0], 1.0), (joint.links[1], -1.0)] {
            match joint.kind {
                // Both links give the common point the same velocity, v + omega x p.
                Kind::Revolute(p) => {
                    add(2 * i, link, [sign, 0.0, -sign * p.y / LENGTH]);
                    add(2 * i + 1, link, [0.0, sign, sign * p.x / LENGTH]);
                }
                // Both links have the same omega, and the same velocity across the slide.
                Kind::Prismatic(p, along) => {
                    let n = along.rotated_left();
                    add(2 * i, link, [0.0, 0.0, sign]);
                    add(
                        2 * i + 1,
                        link,
                        [sign * n.x, sign * n.y, sign * p.cross(n) / LENGTH],
                    );
                }
            }
        }
    }
    for (i, &link) in locked.iter().enumerate() {
        add(2 * joints + i, link, [0.0, 0.0, 1.0]);
    }
    rows
}
