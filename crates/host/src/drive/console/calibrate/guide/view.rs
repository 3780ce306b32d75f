//! The screen for each step of a calibration.

use std::io::{Read, Write};

use crate::shared::ink::SERVO_PLACES;

use super::step::{STEPS, Step};
use super::{Guide, SCALE_TURNS_DEG, SIGN_TURNS_DEG};

/// The contents of the screen in one step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct View {
    /// The title of the step.
    pub title: String,
    /// The lines of instructions for the user.
    pub instructions: Vec<String>,
    /// The keys that have an effect in this step.
    pub keys: String,
    /// The result of the last key, in words.
    pub message: String,
}

impl<P: Read + Write> Guide<'_, P> {
    /// The screen for the current step.
    pub fn view(&self) -> View {
        let servo_name = |index: usize| format!("A{}, {}", index + 1, SERVO_PLACES[index]);
        let next_keys = "Enter: next    b: back    q: cancel, nothing is saved";
        let (title, text, keys): (String, String, &str) = match self.step() {
            Step::Begin => (
                "before you begin".to_owned(),
                "The servos need a supply of their own, 5 V and 3 A.\n\
                 Lift the robot off the table: its legs will move.\n\
                 Nothing is kept before the last step. Leave at any time with q."
                    .to_owned(),
                "Enter: next    q: cancel, nothing is saved",
            ),
            Step::Horns => {
                let angle_line = |index| {
                    format!(
                        "    {:<16} {:6.2} deg\n",
                        servo_name(index),
                        self.neutral_angles[index]
                    )
                };
                let angles: String = (0..4).map(angle_line).collect();
                let text = format!(
                    "Every servo stands in its middle now, and holds.\n\
                     Take the horns off. Press each crank on as near to its angle as the\n\
                     teeth allow, and fasten its screw. Angles from the robot's right,\n\
                     counter-clockwise, seen from above:\n\n\
                     {angles}\n\
                     If the horns are on already, go on."
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
                     or until it mirrors the one on the other side. Left and up turn it\n\
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
                "Most servos turn one degree for 10 us, and parts as designed touch\n\
                 nowhere: then go on. If a crank turns too far or not far enough, or if a\n\
                 part would touch another, set scales and limits now."
                    .to_owned(),
                "y: set them    Enter: leave them as they are    b: back    q: leave",
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
                    "The crank of A{} never turns beyond its limits. Where a part would\n\
                     touch another, end its travel before that angle. Left and right move the\n\
                     first limit counter-clockwise and back, up and down the second one.\n\n    \
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
                let hint = match self.is_walking {
                    true => "It walks. The space bar ends it.",
                    false => "The space bar starts it, and ends it.",
                };
                (
                    "a test walk".to_owned(),
                    format!("Put the robot on the floor, with room in front of it.\n{hint}"),
                    "space: start, stop    Enter: next    b: back    q: cancel, nothing is saved",
                )
            }
            Step::Save => {
                let mut text = "This will be kept in the board:\n\n".to_owned();
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
                "The board has saved it and starts with it from now on.\n\
                 `lizard calibrate backup FILE` keeps a copy on this machine."
                    .to_owned(),
                "Enter: end    b: back to change something",
            ),
        };
        View {
            title: format!("Step {} of {}: {title}", self.step_index + 1, STEPS.len()),
            instructions: text.lines().map(str::to_owned).collect(),
            keys: keys.to_owned(),
            message: self.message.clone(),
        }
    }
}
