//! The screen for each step of a calibration.

use std::io::{Read, Write};

use crate::shared::shapes::SERVO_POSITIONS;

use super::step::Step;
use super::{Guide, SCALE_TURNS_DEG, SIGN_TURNS_DEG};

/// The contents of the screen in one step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StepView {
    /// The step's title.
    pub title: String,
    /// The user's instructions, line by line.
    pub instructions: Vec<String>,
    /// The keys that have an effect in this step.
    pub keys: String,
    /// The result of the last key, in words.
    pub message: String,
}

impl<P: Read + Write> Guide<'_, P> {
    /// Returns the screen for the current step.
    pub fn view(&self) -> StepView {
        let servo_name = |index: usize| format!("A{}, {}", index + 1, SERVO_POSITIONS[index]);
        let next_keys = "Enter: next    b: back    q: cancel, nothing is saved";
        let (title, text, keys): (String, String, &str) = match self.step() {
            Step::Begin => (
                "before you begin".to_owned(),
                "The servos need their own supply, 5 V and 3 A.\n\
                 Lift the robot off the table: its legs will move.\n\
                 Nothing is saved before the last step. Leave at any time with q."
                    .to_owned(),
                "Enter: next    q: cancel, nothing is saved",
            ),
            Step::Horns => {
                let format_angle = |index| {
                    format!(
                        "    {:<16} {:6.2} deg\n",
                        servo_name(index),
                        self.neutral_angles[index]
                    )
                };
                let angles: String = (0..4).map(format_angle).collect();
                let text = format!(
                    "Every servo now holds its middle position.\n\
                     Take the horns off. Press each crank on as near to its angle as the\n\
                     teeth allow, and fasten its screw. Angles are measured from the robot's\n\
                     right, counter-clockwise, seen from above:\n\n\
                     {angles}\n\
                     If the horns are already fitted so, press Enter."
                );
                ("fit the horns".to_owned(), text, next_keys)
            }
            Step::Sign(index) => {
                let commanded_degrees = self.moved_degrees.unwrap_or(SIGN_TURNS_DEG[0]);
                let direction = if commanded_degrees < 0.0 {
                    "clockwise"
                } else {
                    "counter-clockwise"
                };
                let text = format!(
                    "The space bar moves A{} alone, by {:.0} degrees.\n\
                     Seen from above: did it turn {direction}?",
                    index + 1,
                    commanded_degrees.abs()
                );
                (
                    format!("which way does {} turn?", servo_name(index)),
                    text,
                    "space: move it    y: yes    n: no    b: back    q: cancel, nothing is saved",
                )
            }
            Step::Trim(index) => {
                let text = format!(
                    "Turn the crank of A{} with the arrow keys until it points to {:.2} deg,\n\
                     or until it mirrors the crank on the other side. Left and up turn it\n\
                     counter-clockwise, seen from above; right and down clockwise.\n\n    \
                     trim {:+.2} deg",
                    index + 1,
                    self.neutral_angles[index],
                    self.robot.calibration().servos[index].trim
                );
                (
                    format!("straighten {}", servo_name(index)),
                    text,
                    "left, right: 0.5 deg    up, down: 0.1 deg    Enter: next    b: back    q: leave",
                )
            }
            Step::OfferScales => (
                "scales and limits".to_owned(),
                "Most servos turn one degree per 10 us, and parts made as designed do not\n\
                 touch. If this is true for your robot, press Enter. If a crank turns too\n\
                 far or not far enough, or two parts would touch, set scales and limits."
                    .to_owned(),
                "y: set them    Enter: keep them    b: back    q: leave",
            ),
            Step::Scale(index) => {
                let commanded_degrees = self.moved_degrees.unwrap_or(SCALE_TURNS_DEG[0]);
                let text = format!(
                    "The space bar turns A{} alone by {:.0} degrees, so that its crank\n\
                     should point to {:.2} deg. If it does not, turn it there with the\n\
                     arrow keys.\n\n    \
                     scale {:.2} us per degree",
                    index + 1,
                    commanded_degrees.abs(),
                    (self.neutral_angles[index] + commanded_degrees).rem_euclid(360.0),
                    self.robot.calibration().servos[index].scale
                );
                (
                    format!("how far does {} turn?", servo_name(index)),
                    text,
                    "space: move it    left, right: 0.5 deg    up, down: 0.1 deg    Enter: next    b: back    q: leave",
                )
            }
            Step::Limit(index) => {
                let [min, max] = self.robot.calibration().servos[index].limit;
                let text = format!(
                    "The crank of A{} never turns beyond its limits. Where two parts would\n\
                     touch, end its travel before that angle. Left and right move the first\n\
                     limit, up and down the second; left and up move counter-clockwise.\n\n    \
                     limits {min:.2} to {max:.2} deg",
                    index + 1
                );
                (
                    format!("how far may {} turn?", servo_name(index)),
                    text,
                    "left, right: first, 1 deg    up, down: second, 1 deg    Enter: next    b: back    q: leave",
                )
            }
            Step::Walk => {
                let walk_text = match self.is_walking {
                    true => "The robot walks. The space bar stops it.",
                    false => "The space bar starts and stops the walk.",
                };
                (
                    "a test walk".to_owned(),
                    format!("Put the robot on the floor, with room in front of it.\n{walk_text}"),
                    "space: start, stop    Enter: next    b: back    q: cancel, nothing is saved",
                )
            }
            Step::Save => {
                let mut text = "The board will save these settings:\n\n".to_owned();
                for (index, settings) in self.robot.calibration().servos.iter().enumerate() {
                    let [min, max] = settings.limit;
                    text += &format!(
                        "    {:<15} sign {}  trim {:+.2}  limits {min:.2} to {max:.2}  scale {:.2}\n",
                        servo_name(index),
                        settings.dir,
                        settings.trim,
                        settings.scale
                    );
                }
                text += "\nTrims and limits in deg, scales in us per deg.";
                (
                    "save".to_owned(),
                    text,
                    "Enter: save    b: back    q: cancel, nothing is saved",
                )
            }
            Step::Saved => (
                "done".to_owned(),
                "The board has saved the calibration and uses it from now on.\n\
                 `lizard calibrate backup FILE` keeps a copy on this machine."
                    .to_owned(),
                "Enter: end    b: back to change something",
            ),
        };
        StepView {
            title: format!(
                "Step {} of {}: {title}",
                self.step_index + 1,
                self.steps.len()
            ),
            instructions: text.lines().map(str::to_owned).collect(),
            keys: keys.to_owned(),
            message: self.message.clone(),
        }
    }
}
