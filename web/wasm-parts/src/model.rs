//! The model that the page shows: bodies, printed parts, and the steps of the guide.

use lizard_kinematics::Vector;
use lizard_parts::{
    Assembly, Bill, File, Meeting, Mount, Part, Placement, PrintToBody, Step, Unfit, coupon,
    papers, part_files, steps,
};
use lizard_robot::Robot;
use lizard_robot::servo::FORWARD;
use serde::Serialize;
use tsify::Tsify;

/// The reason why the parts of a robot cannot be made.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Refused {
    /// The reason, as a message.
    pub refused: String,
    /// The parts that meet, if that is the reason.
    #[tsify(type = "Meeting | null")]
    pub meeting: Option<Meeting>,
}

impl Refused {
    fn of(error: impl ToString) -> Self {
        Self {
            refused: error.to_string(),
            meeting: None,
        }
    }
}

impl From<Unfit> for Refused {
    fn from(unfit: Unfit) -> Self {
        Self {
            meeting: unfit.meeting(),
            ..Self::of(unfit)
        }
    }
}

/// A body of the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct BodyEntry {
    /// The unique name.
    pub name: String,
    /// The kind of body, in a word or two.
    pub kind: &'static str,
    /// The index of the mount that it moves with.
    pub mount: usize,
    /// The servo that it belongs to, 0 to 3; `None` for chassis and sides.
    pub servo: Option<usize>,
    /// The step of the guide that adds it, from 1; 0 for none.
    pub step: usize,
    /// Lift in the guide's exploded picture, as a share.
    pub lift: f64,
    /// The index of the printed part; `None` for bought bodies.
    pub part: Option<usize>,
    /// The solid's position in its mount's frame: the columns of a 4 x 4 matrix.
    pub place: [f64; 16],
    /// The index of its solid.
    pub solid: usize,
}

/// A printed part.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct PartEntry {
    /// The name.
    pub name: String,
    /// The name of its files, without folder and ending.
    pub file: String,
    /// The number of pieces needed.
    pub count: usize,
}

/// A step of the guide.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct StepEntry {
    /// The headline.
    pub title: &'static str,
    /// The instructions, as Markdown.
    pub words: String,
}

/// The complete model except the triangles.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct ModelEntry {
    /// Every body of the robot.
    pub bodies: Vec<BodyEntry>,
    /// Every printed part that the robot has.
    pub parts: Vec<PartEntry>,
    /// The steps of the guide.
    pub steps: Vec<StepEntry>,
    /// The number of mounts.
    pub mounts: usize,
    /// Distance from the plate's top down to the soles of the feet, mm.
    pub floor: f64,
    /// The number of calls of [`Model::files`] that make all files.
    pub files: usize,
}

/// A robot's parts.
pub struct Model {
    assembly: Assembly,
    parts: Vec<Part>,
    mounts: Vec<Mount>,
    steps: Vec<Step>,
}

impl Model {
    /// Reads the model of a robot.toml.
    ///
    /// # Errors
    /// Fails for a wrong robot.toml, or a robot of which no parts can be made.
    pub fn read(toml: &str) -> Result<Self, Refused> {
        let robot = Robot::parse(toml).map_err(Refused::of)?;
        let assembly = Assembly::new(&robot);
        assembly.check_measures()?;
        let mut mounts: Vec<Mount> = Vec::new();
        for body in assembly.bodies() {
            if !mounts.contains(&body.mount) {
                mounts.push(body.mount);
            }
        }
        Ok(Self {
            parts: assembly.parts(),
            steps: steps(robot.drive().strut().is_some()),
            assembly,
            mounts,
        })
    }

    /// The model for the page, without triangles.
    #[must_use]
    pub fn entry(&self) -> ModelEntry {
        let mut soles: f64 = 0.0;
        let mut bought = self.needed().count();
        let bodies = self.assembly.bodies().iter().map(|body| {
            soles = soles.min(body.z()[0]);
            let of_body = |part: &Part| part.bodies.contains(&body.name);
            let part = self.needed().position(of_body);
            let motion = part.map(|part| self.parts[part].print_to_body(body));
            let step = self.steps.iter().position(|step| step.adds(body));
            let solid = part.unwrap_or_else(|| {
                bought += 1;
                bought - 1
            });
            BodyEntry {
                name: body.name.clone(),
                kind: body.kind.word(),
                mount: self.mount(body.mount),
                servo: body.mount.servo(),
                step: step.map_or(0, |step| step + 1),
                lift: step.map_or(0.0, |step| (self.steps[step].lift)(body)),
                part,
                place: matrix(motion),
                solid,
            }
        });
        let bodies = bodies.collect();
        let part = |part: &Part| PartEntry {
            name: part.name.clone(),
            file: part.file(),
            count: part.count(),
        };
        let step = |step: &Step| StepEntry {
            title: step.title,
            words: step.words.clone(),
        };
        ModelEntry {
            bodies,
            parts: self.needed().map(part).collect(),
            steps: self.steps.iter().map(step).collect(),
            mounts: self.mounts.len(),
            floor: -soles,
            files: self.ordered().count() + 1,
        }
    }

    /// The assembly of the robot.
    #[must_use]
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// The parts of the robot, without alternatives.
    pub(crate) fn needed(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(|part| part.instead_of.is_none())
    }

    fn mount(&self, mount: Mount) -> usize {
        let known = self.mounts.iter().position(|known| *known == mount);
        known.expect("a body's own")
    }

    /// The place of every mount at angles of the servos (deg, chassis frame) and lags of the
    /// legs behind them (deg, foot forward positive): x and y in mm, and the direction of the x
    /// axis. `None` if a loop does not close.
    #[must_use]
    pub fn pose(&self, angles: [f64; 4], lag: [f64; 4]) -> Option<Vec<[f64; 4]>> {
        let pose = self.assembly.robot().lizard().solve(&angles.into()).ok()?;
        let plans = &self.assembly.layout().legs;
        let places = self.mounts.iter().map(|&mount| {
            let as_led = self.assembly.place(mount, &pose);
            let leg = |servo: usize| {
                let angle = angles[servo] - FORWARD[servo] * lag[servo];
                (angle, plans[servo].at(angles[servo], angle))
            };
            let Placement { at, turn } = match mount {
                Mount::Crank(servo) | Mount::Follower(servo) => Placement {
                    turn: Vector::direction(leg(servo).0),
                    ..as_led
                },
                Mount::Foot(servo) => Placement {
                    at: leg(servo).1.joints[0],
                    ..as_led
                },
                Mount::Strut(servo) => {
                    let [from, to] = leg(servo).1.strut;
                    let along = to - from;
                    Placement {
                        at: from,
                        turn: along * (1.0 / along.length()),
                    }
                }
                _ => as_led,
            };
            [at.x, at.y, turn.x, turn.y]
        });
        Some(places.collect())
    }

    /// The parts in the order in which `lizard parts` makes them.
    fn ordered(&self) -> impl Iterator<Item = Part> {
        let coupon = coupon(self.assembly.robot().parts());
        coupon.into_iter().chain(self.parts.iter().cloned())
    }

    /// Some of the files that `lizard parts` writes: those of a part, and last the bill and the
    /// guide; none after that.
    ///
    /// # Errors
    /// Fails for a part whose layers make no body, or a screw that cannot be reached.
    pub fn files(&self, number: usize) -> Result<Vec<File>, Refused> {
        let robot = self.assembly.robot();
        let count = self.ordered().count();
        if let Some(part) = self.ordered().nth(number) {
            return Ok(part_files(&part, robot.parts().kerf)?);
        }
        if number > count {
            return Ok(Vec::new());
        }
        let pose = robot
            .lizard()
            .solve(&robot.neutral())
            .map_err(Refused::of)?;
        let bill = Bill::of(&self.assembly, &self.parts, &pose);
        Ok(papers(&self.assembly, &bill, &pose)?)
    }

    /// Proves that no two parts meet at any pose that the guard accepts.
    ///
    /// # Errors
    /// Returns the two parts that meet.
    pub fn prove(&self, progress: impl FnMut(usize, usize)) -> Result<Proved, Refused> {
        let proof = self.assembly.prove(progress);
        proof.judge().map_err(Unfit::from)?;
        Ok(Proved {
            least: proof.least().map(|near| near.proved),
        })
    }
}

/// The result of a successful proof.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Proved {
    /// Smallest distance of two parts that are not made to touch, mm.
    pub least: Option<f64>,
}

/// A place in a mount's frame as the columns of a matrix.
fn matrix(motion: Option<PrintToBody>) -> [f64; 16] {
    let as_it_lies = PrintToBody {
        flipped: false,
        lift: 0.0,
        frame: Placement::CHASSIS,
    };
    let PrintToBody {
        flipped,
        lift,
        frame,
    } = motion.unwrap_or(as_it_lies);
    let Placement { at, turn } = frame;
    let over = if flipped { -1.0 } else { 1.0 };
    let across = turn.left() * over;
    [
        turn.x, turn.y, 0.0, 0.0, across.x, across.y, 0.0, 0.0, 0.0, 0.0, over, 0.0, at.x, at.y,
        lift, 1.0,
    ]
}

#[cfg(test)]
mod tests;
