//! `lizard mobility`: degrees of freedom, counted and measured.
//!
//! Counting (Gruebler) trusts that no two joints say the same; the rank of the
//! constraints at a pose does not. Here every moving link has three velocities
//! (vx, vy of its point at the origin, and omega), every joint gives two rows,
//! and what the rank leaves over are the freedoms.

use std::io::{self, Write};

use lizard_kinematics::{Lizard, Side, Solution, Vector};
use nalgebra::DMatrix;
use serde::Serialize;

use crate::{Failure, PoseArgs, RobotFile};

/// Singular values below this share of the largest are zero.
const RANK_TOLERANCE: f64 = 1e-9;

/// A unit of length that makes rows in mm and in radians comparable.
const LENGTH: f64 = 50.0;

/// Degrees of freedom of body and legs, by Gruebler's count and by the rank of
/// the constraint Jacobian at a pose.
///
/// The pose is the neutral one unless given. Where a pose is singular, the rank
/// drops and a freedom appears that no servo holds.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    pose: PoseArgs,
    /// One JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// A mechanism: its joints connect links, of which number 0 does not move.
struct Mechanism {
    name: &'static str,
    links: usize,
    joints: Vec<Joint>,
}

struct Joint {
    links: [usize; 2],
    kind: Kind,
}

enum Kind {
    /// A pin at a point, mm.
    Revolute(Vector),
    /// A slide through a point along a direction of length one.
    Prismatic(Vector, Vector),
}

#[derive(Serialize)]
struct Report {
    mechanism: &'static str,
    links: usize,
    joints: usize,
    /// 3 (N - 1 - j) + sum f.
    gruebler: i64,
    /// Rows and columns of the constraint Jacobian.
    constraints: usize,
    velocities: usize,
    rank: usize,
    /// Columns less rank.
    freedoms: usize,
    /// Smallest singular value over the largest: near 0, near a singularity.
    conditioning: f64,
}

/// Counts and measures.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let pose = args.pose.get().unwrap_or_else(|| robot.neutral());
    let solution = robot
        .lizard
        .solve(&pose)
        .map_err(|infeasible| Failure::Impossible(infeasible.to_string()))?;
    let legs = [
        "leg front left",
        "leg front right",
        "leg back right",
        "leg back left",
    ];
    let mut all = vec![body(&robot.lizard, &solution)];
    all.extend((0..4).map(|i| leg(&robot.lizard, &solution, i, legs[i])));
    let reports: Vec<Report> = all.iter().map(measure).collect();
    let mut out = io::stdout().lock();
    if args.json {
        serde_json::to_writer_pretty(&mut out, &reports)?;
        writeln!(out)?;
        return Ok(());
    }
    writeln!(
        out,
        "mechanism         links  joints  Gruebler   Jacobian  rank  freedoms  conditioning"
    )?;
    for r in &reports {
        writeln!(
            out,
            "{:16} {:6} {:7} {:9}   {:>5}x{:<2} {:5} {:9}  {:12.1e}",
            r.mechanism,
            r.links,
            r.joints,
            r.gruebler,
            r.constraints,
            r.velocities,
            r.rank,
            r.freedoms,
            r.conditioning
        )?;
    }
    let loose: Vec<&Report> = reports
        .iter()
        .filter(|r| r.freedoms as i64 != r.gruebler)
        .collect();
    if loose.is_empty() {
        writeln!(
            out,
            "\nCount and rank agree: four servos hold the body, one spring each leg."
        )?;
    }
    for r in loose {
        writeln!(
            out,
            "\n{}: this pose is singular, the rank leaves {} freedoms.",
            r.mechanism, r.freedoms
        )?;
    }
    Ok(())
}

/// The 13 links of the body: chassis, four cranks with their side arms, four
/// couplers, four slider halves.
fn body(lizard: &Lizard, s: &Solution) -> Mechanism {
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
    }
}

/// A leg in a frame of its own: ground 0, crank 1, coupler 2, follower 3. The
/// spring to the body holds nothing rigidly, so it is no link.
fn leg(lizard: &Lizard, s: &Solution, servo: usize, name: &'static str) -> Mechanism {
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
    }
}

/// Freedoms of the body at a pose, by rank.
pub fn body_freedoms(lizard: &Lizard, solution: &Solution) -> usize {
    measure(&body(lizard, solution)).freedoms
}

/// Freedoms of the front left leg at a pose, by rank.
pub fn leg_freedoms(lizard: &Lizard, solution: &Solution) -> usize {
    measure(&leg(lizard, solution, 0, "leg")).freedoms
}

fn measure(mechanism: &Mechanism) -> Report {
    let joints = mechanism.joints.len();
    let velocities = 3 * (mechanism.links - 1);
    let mut rows = DMatrix::<f64>::zeros(2 * joints, velocities);
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
                // One velocity of the common point: v + omega x p.
                Kind::Revolute(p) => {
                    add(2 * i, link, [sign, 0.0, -sign * p.y / LENGTH]);
                    add(2 * i + 1, link, [0.0, sign, sign * p.x / LENGTH]);
                }
                // One omega, and one velocity across the slide.
                Kind::Prismatic(p, along) => {
                    let n = along.left();
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
    let values = rows.singular_values();
    let (largest, smallest) = (values.max(), values.min());
    let rank = values
        .iter()
        .filter(|value| **value > RANK_TOLERANCE * largest)
        .count();
    Report {
        mechanism: mechanism.name,
        links: mechanism.links,
        joints,
        gruebler: 3 * (mechanism.links as i64 - 1 - joints as i64) + joints as i64,
        constraints: 2 * joints,
        velocities,
        rank,
        freedoms: velocities - rank,
        conditioning: smallest / largest,
    }
}
