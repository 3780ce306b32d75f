//! The reference values of every safety condition of a pose. lizard-kinematics computes them in floating point, at the
//! exact angles of the core's pose and independently of the core.

use std::fmt;

use fastrand::Rng;
use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::Margin;
use lizard_core::numbers::calibration::Calibration;
use lizard_core::numbers::part::{End, Servo, Side};
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::{Angle, Scale, Sine, Sweep};
use lizard_host_tests::{NamedRobot, rng, robots};
use lizard_kinematics::{Check, InfeasiblePose, Limits, Mechanism, Solution};
use lizard_proof::LENGTH_BAND_STEPS;
use lizard_robot::{CoreRobot, Robot, STEPS_PER_DEGREE};

/// The largest allowed error of a margin due to the guard's arithmetic, as a sine. Rounding of lengths adds to it.
const MARGIN_TOLERANCE: f64 = 0.002;
/// The smallest type-2 limit that robot.toml may set, as a sine. Below this value, the guard must only detect that a
/// margin is small.
pub const MIN_TYPE2_LIMIT: f64 = 0.1;

/// The ten margins in the order in which the guard checks them.
pub const MARGINS: [Margin; 10] = [
    Margin::Type2(End::Head),
    Margin::Type2(End::Tail),
    Margin::Type1(Servo::A1),
    Margin::Type1(Servo::A2),
    Margin::Type1(Servo::A3),
    Margin::Type1(Servo::A4),
    Margin::Leg(Servo::A1),
    Margin::Leg(Servo::A2),
    Margin::Leg(Servo::A3),
    Margin::Leg(Servo::A4),
];

/// The five-bar of each of the first six margins: 0 is the head, 1 is the tail. The other four margins belong to legs.
pub const MARGIN_FIVE_BARS: [usize; 6] = [0, 1, 0, 0, 1, 1];

/// Converts an angle of the core to degrees between 0 and 360.
fn to_degrees(angle: Angle) -> f64 {
    f64::from(angle.0) * 360.0 / 65536.0
}

/// Converts a margin of the core to a sine.
pub fn to_sine(margin: Sine) -> f64 {
    f64::from(margin.0) / 32768.0
}

/// Returns the number of the core's length steps per millimetre at a scale.
pub fn steps_per_mm(scale: Scale) -> f64 {
    f64::from(1u32 << scale.bits)
}

/// Computes the exact pulse width of a servo at a sweep of the core, us.
pub fn exact_width_us(servo: &lizard_robot::servo::Servo, sweep: i32) -> f64 {
    servo.neutral_us + servo.us_per_degree * f64::from(sweep) / STEPS_PER_DEGREE
}

/// Returns the exact angles of the core's pose in the chassis frame, deg.
pub fn chassis_angles_deg(core_robot: &CoreRobot, pose: &Pose) -> [f64; 4] {
    pose.angles(&core_robot.neutral_angles()).map(to_degrees)
}

/// The values of all safety conditions of a pose, computed in floating point, and the guard's tolerances.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    /// The margins as sines, in the order of [`MARGINS`]. The type-2 margins have the sign of K2, which is negative for
    /// crossed crank tips.
    pub margins: [f64; 10],
    /// The sliders' strokes, which are their lengths minus their nominal lengths, mm.
    pub strokes_mm: [f64; 2],
    /// K2 of head and tail: the signed distance between the crank tips along the base, mm.
    pub k2_mm: [f64; 2],
    /// True for each condition that is violated according to lizard-kinematics. Crossed crank tips count as a violated
    /// type-2 margin.
    pub violated: [bool; 12],
    limits: Limits,
    pub tolerances: Tolerances,
}

/// The guard's largest allowed error in each value of [`Reference`].
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    pub margins: [f64; 10],
    strokes_mm: [f64; 2],
    k2_mm: [f64; 2],
}

impl Reference {
    /// Computes all conditions for a pose.
    ///
    /// # Errors
    /// Fails if a five-bar or a side does not close.
    pub fn compute(robot: &Robot, pose: &Pose) -> Result<Self, InfeasiblePose> {
        let core_robot = robot.firmware();
        let angles = chassis_angles_deg(core_robot, pose);
        let solution = robot.lizard().solve(&angles.into())?;
        let k2_mm = [solution.head.gap.x, solution.tail.gap.x];
        let mut margins = [0.0; 10];
        for (margin, (_, value)) in margins.iter_mut().zip(solution.margins.iter()) {
            *margin = value;
        }
        for (type2, k2) in margins.iter_mut().zip(k2_mm) {
            *type2 = type2.copysign(k2);
        }
        let length_tolerance_mm = |scale| LENGTH_BAND_STEPS / steps_per_mm(scale);
        let k2_tolerances_mm =
            End::ALL.map(|end| length_tolerance_mm(core_robot.link_lengths(end).scale()));
        let [
            [head_type2, a1_type1, a2_type1],
            [tail_type2, a4_type1, a3_type1],
        ] = End::ALL
            .map(|end| five_bar_tolerances(robot, &solution, end, k2_tolerances_mm[end as usize]));
        let mut violated = [false; 12];
        for violation in robot.limits().violations(&solution) {
            violated[condition_index(violation.check)] = true;
        }
        Ok(Self {
            violated,
            margins,
            strokes_mm: [solution.left.s, solution.right.s],
            k2_mm,
            limits: *robot.limits(),
            tolerances: Tolerances {
                margins: [
                    head_type2,
                    tail_type2,
                    a1_type1,
                    a2_type1,
                    a3_type1,
                    a4_type1,
                    MARGIN_TOLERANCE,
                    MARGIN_TOLERANCE,
                    MARGIN_TOLERANCE,
                    MARGIN_TOLERANCE,
                ],
                strokes_mm: Side::ALL
                    .map(|side| length_tolerance_mm(core_robot.slider(side).scale)),
                k2_mm: k2_tolerances_mm,
            },
        })
    }

    /// Returns how far each margin, then each stroke, is from its limit, in units of its tolerance. Positive distances
    /// are safe. As in the guard, crossed crank tips violate the type-2 limit.
    pub fn distances_from_limits(&self) -> [f64; 12] {
        let (limits, tolerances) = (&self.limits, &self.tolerances);
        std::array::from_fn(|index| match index {
            0..2 => {
                let margin = (self.margins[index].abs() - limits.type2) / tolerances.margins[index];
                margin.min(self.k2_mm[index] / tolerances.k2_mm[index])
            }
            2..6 => (self.margins[index] - limits.type1) / tolerances.margins[index],
            6..10 => (self.margins[index] - limits.leg) / tolerances.margins[index],
            _ => {
                let stroke = self.strokes_mm[index - 10];
                let distance = (stroke - limits.stroke_min).min(limits.stroke_max - stroke);
                distance / tolerances.strokes_mm[index - 10]
            }
        })
    }

    /// Returns the smallest of the distances from the limits.
    pub fn min_distance(&self) -> f64 {
        let distances = self.distances_from_limits().into_iter();
        distances.fold(f64::INFINITY, f64::min)
    }

    /// True if K2 of a five-bar is so close to 0 that rounding may change its sign in the guard. The index is 0 for the
    /// head and 1 for the tail.
    pub fn is_at_crossing(&self, index: usize) -> bool {
        self.k2_mm[index].abs() <= self.tolerances.k2_mm[index]
    }
}

/// Returns the index of a condition among the twelve: ten margins, two strokes.
fn condition_index(check: Check) -> usize {
    // `Check` has the twelve conditions in this order, then the two conditions that the cranks are not crossed.
    match check {
        Check::UncrossedHead => Check::Type2Head as usize,
        Check::UncrossedTail => Check::Type2Tail as usize,
        _ => check as usize,
    }
}

/// Returns the tolerances of a five-bar's margins: type-2, left type-1 and right type-1. Each is the sum of the error
/// of the guard's arithmetic and the effect of an error of `length_error_mm` in the distance between the crank tips.
/// Near a singularity, where the type-2 margin is small, a length error turns the couplers by a large angle.
fn five_bar_tolerances(
    robot: &Robot,
    solution: &Solution,
    end: End,
    length_error_mm: f64,
) -> [f64; 3] {
    let end = lizard_kinematics::End::ALL[end as usize];
    let five_bar = robot.lizard().end(end);
    let (left_coupler, right_coupler) =
        (five_bar.left_coupler_length, five_bar.right_coupler_length);
    let tip_distance_mm = solution.end(end).gap.length();
    let type2 = solution.end(end).type2.abs();
    let cosine = (1.0 - type2 * type2).max(0.0).sqrt();
    [
        cosine * tip_distance_mm / (left_coupler * right_coupler),
        1.0 / left_coupler,
        1.0 / right_coupler,
    ]
    .map(|turn_per_mm| MARGIN_TOLERANCE + length_error_mm * turn_per_mm / type2)
}

/// True if a value is beyond a limit by more than the tolerance, or if a loop does not close.
pub fn is_clearly_unsafe(robot: &Robot, pose: &Pose) -> bool {
    match Reference::compute(robot, pose) {
        Ok(reference) => reference.min_distance() < -1.0,
        Err(_) => true,
    }
}

/// Returns the index of the five-bar that does not close; `None` if a side does not close.
pub fn unclosed_five_bar_index(error: &InfeasiblePose) -> Option<usize> {
    match error.mechanism {
        Mechanism::End(end) => Some(end as usize),
        Mechanism::Side(_) => None,
    }
}

/// The largest absolute value and the root mean square of many errors.
#[derive(Clone, Copy, Debug, Default)]
pub struct ErrorStatistics {
    pub max_abs: f64,
    sum_of_squares: f64,
    error_count: f64,
}

impl ErrorStatistics {
    pub fn add(&mut self, error: f64) {
        self.max_abs = self.max_abs.max(error.abs());
        self.sum_of_squares += error * error;
        self.error_count += 1.0;
    }
}

impl fmt::Display for ErrorStatistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rms = (self.sum_of_squares / self.error_count.max(1.0)).sqrt();
        write!(f, "max {:.5} rms {rms:.5}", self.max_abs)
    }
}

/// Returns every robot with its own random numbers, which start at a stream for each test.
pub fn robots_with_rngs(first_stream: u64) -> impl Iterator<Item = (&'static NamedRobot, Rng)> {
    let numbered_robots = (first_stream..).zip(robots());
    numbered_robots.map(|(stream, named_robot)| (named_robot, rng(stream)))
}

/// Returns a random pose anywhere in the servos' travel.
pub fn random_pose(rng: &mut Rng, calibration: &[Calibration; 4]) -> Pose {
    Pose(calibration.map(|servo| Sweep(rng.i16(servo.travel_min.0..=servo.travel_max.0))))
}

/// Returns a random pose in which every servo turns from neutral by at most this fraction of its travel.
pub fn random_pose_within(rng: &mut Rng, calibration: &[Calibration; 4], fraction: f64) -> Pose {
    let pose = random_pose(rng, calibration);
    let scale = |sweep: Sweep| Sweep((f64::from(sweep.0) * fraction) as i16);
    Pose(pose.0.map(scale))
}

/// True if the guard accepts a pose.
pub fn is_safe(core_robot: &CoreRobot, pose: &Pose) -> bool {
    let clearance = Clearance::measure(core_robot, pose);
    clearance.first_hazard(core_robot).is_none()
}
