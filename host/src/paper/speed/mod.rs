//! `lizard speed`: how fast the closed form is, compared with numpy and with the time of
//! its sines and arc tangents alone.

use std::hint::black_box;
use std::io::{self, Write};
use std::process::{Command, Stdio};
use std::time::Instant;

use lizard_kinematics::{Lanes, Lizard, Pose, Real, Solution};
use pulp::{Arch, Simd, WithSimd};
use serde::Serialize;

use crate::json;
use crate::{Failure, RobotFile};

const SCRIPT: &str = include_str!("numpy_solve.py");

/// What each pose yields, in this order in the script too.
const RESULTS: usize = 22;

/// Largest difference that is rounding, deg, mm or margin.
const ROUNDING: f64 = 1e-9;

/// Passes over all poses; the fastest counts.
const PASSES: usize = 5;

/// Measure how many poses are solved per second on one core, compared with numpy and a
/// lower bound of the time.
///
/// The same poses are solved here and by the same closed form in numpy (python3 with
/// numpy, if there is one), and the results are compared; if they differ by more than
/// 1e-9, the exit code is 1. The lower bound is the time of the four sine-cosine pairs
/// and six arc tangents of each pose, computed in the same way.
#[derive(clap::Args)]
pub struct Args {
    /// Number of poses
    #[arg(long, default_value_t = 1_000_000, value_parser = clap::value_parser!(u32).range(1..=20_000_000))]
    poses: u32,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

#[derive(Serialize)]
struct Report {
    poses: usize,
    /// In lanes of [`LANES`], with whatever vectors the machine has.
    poses_per_second: f64,
    /// As `lizard solve` and the firmware's build do it.
    one_by_one_poses_per_second: f64,
    /// Time of the sines and arc tangents alone over the whole time.
    floor_share: f64,
    numpy: Option<Numpy>,
}

#[derive(Serialize)]
struct Numpy {
    version: String,
    /// Over whole columns, as numpy is usually written.
    poses_per_second: f64,
    /// Our poses per second over that.
    times_faster: f64,
    /// The same in blocks that fit the cache, the best numpy can do.
    blocks_poses_per_second: f64,
    /// Our poses per second over that.
    times_faster_than_blocks: f64,
    /// Largest difference between the two, deg, mm or margin.
    worst_difference: f64,
}

/// Measures and prints.
///
/// # Errors
/// A wrong robot.toml, results that differ from the reference, an output that cannot
/// be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let poses = poses(args.poses as usize, robot.neutral().into());
    let mut results = vec![[0.0; RESULTS]; poses.len()];
    let vectors = Arch::new();
    let seconds = fastest(|| {
        vectors.dispatch(SolveAll {
            lizard: robot.lizard(),
            poses: &poses,
            results: &mut results,
        });
        black_box(&results);
    });
    let one_by_one = fastest(|| {
        for (pose, result) in poses.iter().zip(&mut results) {
            *result = solve(robot.lizard(), pose);
        }
        black_box(&results);
    });
    let floor = fastest(|| {
        black_box(vectors.dispatch(Transcendentals(&poses)));
    });
    let rate = poses.len() as f64 / seconds;
    let report = Report {
        poses: poses.len(),
        poses_per_second: rate,
        one_by_one_poses_per_second: poses.len() as f64 / one_by_one,
        floor_share: floor / seconds,
        numpy: numpy(robot.lizard(), &poses, &results, rate)?,
    };
    let mut out = io::stdout().lock();
    if args.json {
        json::line(&mut out, &report)?;
        return agree(&report);
    }
    writeln!(
        out,
        "forward solution of the whole robot, one core, {} poses",
        report.poses
    )?;
    writeln!(
        out,
        "  closed form   {:8.2} million poses/s, {LANES} at once",
        rate / 1e6
    )?;
    writeln!(
        out,
        "                {:8.2} million poses/s, one by one",
        report.one_by_one_poses_per_second / 1e6
    )?;
    match &report.numpy {
        Some(numpy) => writeln!(
            out,
            "  numpy {:7} {:8.2} million poses/s over whole columns, {:.1} times slower\n\
            \x20               {:8.2} million poses/s in blocks that fit the cache, {:.1} times slower\n\
            \x20               results differ by {:.0e} at most",
            numpy.version,
            numpy.poses_per_second / 1e6,
            numpy.times_faster,
            numpy.blocks_poses_per_second / 1e6,
            numpy.times_faster_than_blocks,
            numpy.worst_difference
        )?,
        None => writeln!(out, "  numpy         not found (apt install python3-numpy)")?,
    }
    writeln!(
        out,
        "  floor         {:8.0} % of the time is sines, cosines and arc tangents",
        100.0 * report.floor_share
    )?;
    agree(&report)
}

/// Fails where numpy found something else.
fn agree(report: &Report) -> Result<(), Failure> {
    match &report.numpy {
        // Not a number is no agreement.
        Some(numpy) if numpy.worst_difference.is_nan() || numpy.worst_difference > ROUNDING => {
            Err(Failure::Impossible(format!(
                "the results of numpy differ by {:.1e}, more than {ROUNDING:.0e}",
                numpy.worst_difference
            )))
        }
        _ => Ok(()),
    }
}

/// Sweep from neutral to either side that the poses cover, deg: the paper's safe
/// box.
const SWEEP: f64 = 34.0;

/// Poses all around neutral, in servo order, by additive recurrence.
fn poses(count: usize, neutral: [f64; 4]) -> Vec<[f64; 4]> {
    let steps = [
        0.856_674_883_854_502_9,
        0.733_891_856_627_125_9,
        0.628_706_720_880_788_5,
        0.538_597_257_223_611_4,
    ];
    (1..=count)
        .map(|i| {
            std::array::from_fn(|servo| {
                neutral[servo] + SWEEP * (2.0 * (i as f64 * steps[servo]).fract() - 1.0)
            })
        })
        .collect()
}

/// Poses that are solved in step.
const LANES: usize = 8;

type Block = Lanes<LANES>;

/// Poses of one block, lane by lane.
#[inline(always)]
fn block(poses: &[[f64; 4]]) -> [Block; 4] {
    let mut block = [Lanes([0.0; LANES]); 4];
    for (i, pose) in poses.iter().enumerate() {
        for (lanes, angle) in block.iter_mut().zip(pose) {
            lanes.0[i] = *angle;
        }
    }
    block
}

/// Everything that `lizard solve` prints, but for the legs' angles, which are
/// the servos'. Poses without a solution, and a last block that is not full, go
/// one by one.
struct SolveAll<'a> {
    lizard: &'a Lizard,
    poses: &'a [[f64; 4]],
    results: &'a mut [[f64; RESULTS]],
}

impl WithSimd for SolveAll<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let blocks = self.poses.chunks(LANES).zip(self.results.chunks_mut(LANES));
        for (poses, results) in blocks {
            if poses.len() == LANES {
                let solution = self.lizard.solve_lanes(&Pose::from(block(poses)));
                if self.lizard.closes(&solution).iter().all(|closes| *closes) {
                    let columns = columns(&solution);
                    for (i, result) in results.iter_mut().enumerate() {
                        for (value, column) in result.iter_mut().zip(&columns) {
                            *value = column.0[i];
                        }
                    }
                    continue;
                }
            }
            for (pose, result) in poses.iter().zip(results) {
                *result = solve(self.lizard, pose);
            }
        }
    }
}

/// One pose.
fn solve(lizard: &Lizard, pose: &[f64; 4]) -> [f64; RESULTS] {
    match lizard.solve(&Pose::from(*pose)) {
        Ok(solution) => columns(&solution),
        Err(_) => [f64::NAN; RESULTS],
    }
}

/// The results in the script's order.
#[inline(always)]
fn columns<T: Real>(s: &Solution<T>) -> [T; RESULTS] {
    let (head, tail, m, p) = (s.head_point(), s.tail_point(), &s.margins, s.passive());
    [
        p.theta2,
        p.theta3,
        p.theta6,
        p.theta7,
        head.x,
        head.y,
        tail.x,
        tail.y,
        p.phi_left,
        p.s_left,
        p.phi_right,
        p.s_right,
        m.type2[0],
        m.type2[1],
        m.type1[0],
        m.type1[1],
        m.type1[2],
        m.type1[3],
        m.leg[0],
        m.leg[1],
        m.leg[2],
        m.leg[3],
    ]
}

/// The floor: four sine-cosine pairs and six arc tangents for each pose.
struct Transcendentals<'a>(&'a [[f64; 4]]);

impl WithSimd for Transcendentals<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let mut sum = Block::of(0.0);
        for poses in self.0.chunks_exact(LANES) {
            let (sines, cosines) = Block::sin_cos_each(block(poses));
            // Six vectors that depend on those, as the joints do.
            let [a, b, c, d] = sines;
            let [e, f, g, h] = cosines;
            for angle in Block::atan2_each([a, b, c, d, a, b], [e, f, g, h, g, h]) {
                sum = sum + angle;
            }
        }
        sum.0.iter().sum()
    }
}

fn fastest(mut work: impl FnMut()) -> f64 {
    (0..PASSES)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

/// The same by numpy; none where there is no numpy.
fn numpy(
    lizard: &Lizard,
    poses: &[[f64; 4]],
    ours: &[[f64; RESULTS]],
    rate: f64,
) -> Result<Option<Numpy>, Failure> {
    let Some(python) = ["python3", "/usr/bin/python3"].into_iter().find(|python| {
        Command::new(python)
            .args(["-c", "import numpy"])
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success())
    }) else {
        return Ok(None);
    };
    let mut child = Command::new(python)
        .args([
            "-c",
            SCRIPT,
            &serde_json::to_string(&lizard.links.to_array())?,
        ])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()?;
    // The script reads everything before it writes, so this cannot block.
    let bytes: Vec<u8> = poses
        .as_flattened()
        .iter()
        .flat_map(|v| v.to_ne_bytes())
        .collect();
    if let Some(mut stdin) = child.stdin.take() {
        stdin.write_all(&bytes)?;
    }
    let output = child.wait_with_output()?;
    let broken = || Failure::Impossible("numpy's answer is cut short".to_string());
    let end = output
        .stdout
        .iter()
        .position(|&byte| byte == b'\n')
        .ok_or_else(broken)?;
    let head: serde_json::Value = serde_json::from_slice(&output.stdout[..end])?;
    let per_second = |key: &str| Some(poses.len() as f64 / head[key].as_f64()?);
    let columns = per_second("columns").ok_or_else(broken)?;
    let blocks = per_second("blocks").ok_or_else(broken)?;
    let (theirs, _) = output.stdout[end + 1..].as_chunks::<8>();
    if theirs.len() != ours.len() * RESULTS {
        return Err(broken());
    }
    let worst_difference = ours
        .as_flattened()
        .iter()
        .zip(theirs)
        // A pose without a solution here has nothing to compare.
        .filter(|(a, _)| !a.is_nan())
        .map(|(a, b)| (a - f64::from_ne_bytes(*b)).abs())
        // NaN must not pass for agreement.
        .fold(0.0, |worst: f64, difference| {
            if difference <= worst {
                worst
            } else {
                difference
            }
        });
    Ok(Some(Numpy {
        version: head["version"].as_str().unwrap_or_default().to_string(),
        poses_per_second: columns,
        times_faster: rate / columns,
        blocks_poses_per_second: blocks,
        times_faster_than_blocks: rate / blocks,
        worst_difference,
    }))
}
