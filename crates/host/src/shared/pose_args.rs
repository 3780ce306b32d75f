//! The options for a pose.

use lizard_kinematics::Pose;

use crate::shared::quantity::Quantity;

/// The servo angles' names in servo order, A1 to A4. Columns, options and keys are in this order everywhere.
pub const ANGLE_NAMES: [&str; 4] = ["theta1", "theta4", "theta8", "theta5"];

/// The options `--theta1`, `--theta4`, `--theta8` and `--theta5`.
#[derive(clap::Args, Debug, Default)]
#[command(allow_negative_numbers = true)]
pub struct PoseArgs {
    /// Servo A1, front left, degrees
    #[arg(long, value_name = "DEG", value_parser = Quantity::ANGLE.parser(), help_heading = "Pose",
          requires_all = ["theta4", "theta8", "theta5"])]
    theta1: Option<f64>,
    /// Servo A2, front right, degrees
    #[arg(long, value_name = "DEG", value_parser = Quantity::ANGLE.parser(), help_heading = "Pose",
          requires_all = ["theta1", "theta8", "theta5"])]
    theta4: Option<f64>,
    /// Servo A3, back right, degrees
    #[arg(long, value_name = "DEG", value_parser = Quantity::ANGLE.parser(), help_heading = "Pose",
          requires_all = ["theta1", "theta4", "theta5"])]
    theta8: Option<f64>,
    /// Servo A4, back left, degrees
    #[arg(long, value_name = "DEG", value_parser = Quantity::ANGLE.parser(), help_heading = "Pose",
          requires_all = ["theta1", "theta4", "theta8"])]
    theta5: Option<f64>,
}

impl PoseArgs {
    /// Returns the pose; `None` if no option is given. clap requires all four or none.
    pub fn to_pose(&self) -> Option<Pose> {
        Some(Pose {
            theta1: self.theta1?,
            theta4: self.theta4?,
            theta8: self.theta8?,
            theta5: self.theta5?,
        })
    }
}
