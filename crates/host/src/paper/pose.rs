//! `lizard pose`: computes the robot's state at one pose, or the joints of many poses.

use lizard_kinematics::{ServoMotion, Vector};

use crate::paper::{inverse, mobility, singularity, solve, velocity};
use crate::shared::quantity::Quantity;
use crate::{Failure, PoseArgs, RobotArgs};

/// Compute the robot's joints, singularities, degrees of freedom or rates at a pose
///
/// The pose is given by its servo angles, or by the end points of head and tail. Many poses
/// can be given as CSV on standard input: with the header theta1,theta4,theta8,theta5
/// (degrees, chassis frame, any order), or without a header in this order. A column `seconds`
/// is passed through, so that the output of `lizard gaits --trace` can be solved. A malformed
/// line ends the run with an error message that names the line and column, and exit code 2.
///
/// A pose is safe if it is within the robot's limits and each servo's travel. For a singular or
/// unreachable pose, the reason is printed. For an end point of head or tail, all four working
/// modes are listed (each arm bent outward or inward), each marked as reachable or not.
#[derive(clap::Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "Examples:
  lizard pose --theta1 138.59 --theta4 41.41 --theta8 318.59 --theta5 221.41
  lizard pose --json < poses.csv > solutions.jsonl
  lizard gaits --trace walk | lizard pose
  lizard pose --head 5 120 --tail 0 -125
  lizard pose --show singularities
  lizard pose --show rates --omega1 100 --omega4 -100 --alpha5 500"
)]
pub struct Args {
    #[command(flatten)]
    pose: PoseArgs,
    /// End point of the head in mm, chassis frame
    #[arg(long, num_args = 2, value_names = ["X", "Y"], value_parser = Quantity::LENGTH.parser(),
          help_heading = "Pose", conflicts_with = "theta1")]
    head: Option<Vec<f64>>,
    /// End point of the tail in mm, chassis frame
    #[arg(long, num_args = 2, value_names = ["X", "Y"], value_parser = Quantity::LENGTH.parser(),
          help_heading = "Pose", conflicts_with = "theta1")]
    tail: Option<Vec<f64>>,
    /// The subject to print; without a pose, `joints` reads poses from standard input, and the
    /// other subjects use the neutral pose
    #[arg(long, value_enum, default_value_t, conflicts_with_all = ["head", "tail"])]
    show: Subject,
    /// Print JSON; for poses from standard input, one object per line
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    servo_motion: velocity::ServoMotionArgs,
    #[command(flatten)]
    robot: RobotArgs,
}

/// The part of the result to print.
#[derive(clap::ValueEnum, Clone, Copy, Default)]
enum Subject {
    /// Every joint, the margins, and the safety of the pose
    #[default]
    Joints,
    /// The velocity matrices K (8x4, derivatives of the loop equations with respect to the servo
    /// angles) and K* (8x8, with respect to the passive joints), their determinants, and the
    /// nearest singularities
    Singularities,
    /// Degrees of freedom of body and legs, by counting and by the rank of the constraints, and
    /// the parts that can still move while the servos are locked
    Freedoms,
    /// Rates and accelerations of the passive joints, each compared with finite differences
    Rates,
}

/// Computes the pose and prints it.
///
/// # Errors
/// Fails if robot.toml is invalid, if the pose is unreachable (but `--show joints` prints the reason instead), if the
/// servos' motion is given without `--show rates`, if a line of the stream is invalid, or if the output cannot be
/// written.
pub fn run(args: Args) -> Result<(), Failure> {
    let servo_motion = ServoMotion::from(args.servo_motion);
    if servo_motion != ServoMotion::default() && !matches!(args.show, Subject::Rates) {
        let message = "the servos' rates and accelerations require --show rates";
        return Err(Failure::Input(message.to_owned()));
    }
    let robot = args.robot.load()?;
    let end_points = [&args.head, &args.tail]
        .map(|end| end.as_ref().map(|point| Vector::new(point[0], point[1])));
    if end_points.iter().any(Option::is_some) {
        return inverse::print(&robot, end_points, args.json);
    }
    let pose = args.pose.to_pose();
    let lizard = robot.lizard();
    let solve_pose = || lizard.solve(&pose.unwrap_or_else(|| robot.neutral_pose()));
    match args.show {
        Subject::Joints => solve::print(&robot, pose.as_ref(), args.json),
        Subject::Singularities => singularity::print(&robot, &solve_pose()?, args.json),
        Subject::Freedoms => mobility::print(lizard, &solve_pose()?, args.json),
        Subject::Rates => velocity::print(lizard, &solve_pose()?, &servo_motion, args.json),
    }
}
