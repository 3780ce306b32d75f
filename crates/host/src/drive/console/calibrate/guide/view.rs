//! The screen for each step of a calibration.

use std::io::{Read, Write};

use crate::shared::ink::PLACES;

use super::step::{STEPS, Step};
use super::{FAR, Guide, PROOFS};

/// The contents of the screen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct View {
    /// The title of the step.
    pub title: String,
    /// The lines of instructions for the user.
    pub text: Vec<String>,
    /// The keys that have a meaning now.
    pub keys: String,
    /// The effect of the last key.
    pub message: String,
}

impl<P: Read + Write> Guide<'_, P> {
    /// The screen for the current step.
    #[must_use]
    pub fn view(&self) -> View {
        let step = |name: &str| format!("Step {} of {}: {name}", self.at + 1, STEPS.len());
        let servo = |place: usize| format!("A{}, {}", place + 1, PLACES[place]);
        let next = "Enter: next    b: back    q: leave, nothing is changed";
        let (title, text, keys): (String, Vec<String>, &str) = match self.step() {
            Step::Begin => (
                step("before you begin"),
                vec![
                    "The servos need a supply of their own, 5 V and 3 A.".to_owned(),
                    "Lift the robot off the table: its legs will move.".to_owned(),
                    "Nothing is kept before the last step. Leave at any time with q.".to_owned(),
                ],
                "Enter: next    q: leave, nothing is changed",
            ),
            Step::Horns => {
                let mut text = vec![
                    "Every servo stands in its middle now, and holds.".to_owned(),
                    "Take the horns off. Press each crank on as near to its angle as the"
                        .to_owned(),
                    "teeth allow, and fasten its screw. Angles from the robot's right,".to_owned(),
                    "counter-clockwise, seen from above:".to_owned(),
                    String::new(),
                ];
                for (place, neutral) in self.neutral.iter().enumerate() {
                    text.push(format!("    {:<16} {neutral:6.2} deg", servo(place)));
                }
                text.push(String::new());
                text.push("If the horns are on already, go on.".to_owned());
                (step("fit the horns"), text, next)
            }
            Step::Sign(place) => {
                let way = match self.moved {
                    Some(by) if by < 0.0 => "clockwise",
                    _ => "counter-clockwise",
                };
                let by = self.moved.unwrap_or(PROOFS[0]).abs();
                (
                    step(&format!("which way does {} turn?", servo(place))),
                    vec![
                        format!(
                            "The space bar moves A{} alone, by {by:.0} degrees.",
                            place + 1
                        ),
                        format!("Seen from above: did it turn {way}?"),
                    ],
                    "space: move it    y: yes    n: no    b: back    q: leave, nothing is changed",
                )
            }
            Step::Trim(place) => (
                step(&format!("straighten {}", servo(place))),
                vec![
                    format!(
                        "Turn the crank of A{} with the arrow keys until it points to {:.2} deg,",
                        place + 1,
                        self.neutral[place]
                    ),
                    "or until it mirrors the one on the other side. Left and up turn it".to_owned(),
                    "counter-clockwise, seen from above; right and down clockwise.".to_owned(),
                    String::new(),
                    format!("    trim {:+.2} deg", self.now.servo.all()[place].trim),
                ],
                "left, right: 0.5 deg    up, down: 0.1 deg    Enter: next    b: back    q: leave",
            ),
            Step::More => (
                step("scales and limits"),
                vec![
                    "Most servos turn one degree for 10 us, and parts as designed touch".to_owned(),
                    "nowhere: then go on. If a crank turns too far or not far enough, or if a"
                        .to_owned(),
                    "part would touch another, set scales and limits now.".to_owned(),
                ],
                "y: set them    Enter: leave them as they are    b: back    q: leave",
            ),
            Step::Scale(place) => {
                let by = self.moved.unwrap_or(FAR[0]);
                let end = (self.neutral[place] + by).rem_euclid(360.0);
                (
                    step(&format!("how far does {} turn?", servo(place))),
                    vec![
                        format!(
                            "The space bar turns A{} alone by {:.0} degrees, so that its crank",
                            place + 1,
                            by.abs()
                        ),
                        format!(
                            "should point to {end:.2} deg. If it does not, turn it there with the"
                        ),
                        "arrow keys.".to_owned(),
                        String::new(),
                        format!(
                            "    scale {:.2} us per degree",
                            self.now.servo.all()[place].scale
                        ),
                    ],
                    "space: move it    left, right: 0.5 deg    up, down: 0.1 deg    Enter: next    b: back    q: leave",
                )
            }
            Step::Limit(place) => {
                let [min, max] = self.now.servo.all()[place].limit;
                (
                    step(&format!("how far may {} turn?", servo(place))),
                    vec![
                        format!(
                            "The crank of A{} never turns beyond its limits. Where a part would",
                            place + 1
                        ),
                        "touch another, end its travel before that angle. Left and right move the"
                            .to_owned(),
                        "first limit counter-clockwise and back, up and down the second one."
                            .to_owned(),
                        String::new(),
                        format!("    limits {min:.2} to {max:.2} deg"),
                    ],
                    "left, right: first, 1 deg    up, down: second, 1 deg    Enter: next    b: back    q: leave",
                )
            }
            Step::Walk => (
                step("a test walk"),
                vec![
                    "Put the robot on the floor, with room in front of it.".to_owned(),
                    if self.walks {
                        "It walks. The space bar ends it.".to_owned()
                    } else {
                        "The space bar starts it, and ends it.".to_owned()
                    },
                ],
                "space: start, stop    Enter: next    b: back    q: leave, nothing is changed",
            ),
            Step::Save => {
                let mut text = vec!["This will be kept in the board:".to_owned(), String::new()];
                for (place, set) in self.now.servo.all().into_iter().enumerate() {
                    let [min, max] = set.limit;
                    text.push(format!(
                        "    {:<15} sign {}  trim {:+.2}  limits {min:.2} to {max:.2}  scale {:.2}",
                        servo(place),
                        set.dir.sign(),
                        set.trim,
                        set.scale
                    ));
                }
                text.push(String::new());
                text.push("Trims and limits in deg, scales in us per deg.".to_owned());
                (
                    step("save"),
                    text,
                    "Enter: save    b: back    q: leave, nothing is changed",
                )
            }
            Step::Saved => (
                step("done"),
                vec![
                    "The board has saved it and starts with it from now on.".to_owned(),
                    "`lizard backup FILE` keeps a copy on this machine.".to_owned(),
                ],
                "Enter: end    b: back to change something",
            ),
        };
        View {
            title,
            text,
            keys: keys.to_owned(),
            message: self.message.clone(),
        }
    }
}
