//! A pose on the command line.

use lizard_kinematics::Pose;

/// `--theta1` and its three companions.
#[derive(clap::Args, Debug, Default)]
#[command(allow_negative_numbers = true)]
pub struct PoseArgs {
    /// Servo A1, front left, degrees
    #[arg(long, value_name = "DEG", value_parser = finite, help_heading = "Pose",
          requires_all = ["theta4", "theta5", "theta8"])]
    theta1: Option<f64>,
    /// Servo A2, front right, degrees
    #[arg(long, value_name = "DEG", value_parser = finite, help_heading = "Pose",
          requires_all = ["theta1", "theta5", "theta8"])]
    theta4: Option<f64>,
    /// Servo A4, back left, degrees
    #[arg(long, value_name = "DEG", value_parser = finite, help_heading = "Pose",
          requires_all = ["theta1", "theta4", "theta8"])]
    theta5: Option<f64>,
    /// Servo A3, back right, degrees
    #[arg(long, value_name = "DEG", value_parser = finite, help_heading = "Pose",
          requires_all = ["theta1", "theta4", "theta5"])]
    theta8: Option<f64>,
}

impl PoseArgs {
    /// The pose, if one was given; clap takes care that it is whole.
    pub fn get(&self) -> Option<Pose> {
        Some(Pose {
            theta1: self.theta1?,
            theta4: self.theta4?,
            theta8: self.theta8?,
            theta5: self.theta5?,
        })
    }
}

/// A finite number, for clap.
pub fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err("it must be finite".to_string()),
        Err(_) => Err("it is not a number".to_string()),
    }
}
