//! The model that the page shows: bodies, printed parts, and the steps of the guide.

use lizard_kinematics::Vector;
use lizard_parts::{
    Assembly, Bill, BuildProblem, File, Meeting, Mount, Part, Placement, PrintToBody, Step, coupon,
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
    /// The two parts that overlap or come too close; `None` if the reason is another one.
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

impl From<BuildProblem> for Refused {
    fn from(unfit: BuildProblem) -> Self {
        Self {
            meeting: unfit.meeting(),
            ..Self::of(unfit)
        }
    }
}

/// A body of the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct BodyEntry {
    /// The body's unique name.
    pub name: String,
    /// The kind of body, in a word or two.
    pub kind: &'static str,
    /// The index of the mount that it moves with.
    pub mount: usize,
    /// The index of the servo that the body belongs to; `None` for chassis and sides.
    pub servo: Option<usize>,
    /// The number of the guide's step that adds the body, from 1; 0 if no step adds it.
    pub step: usize,
    /// Lift in the guide's exploded picture, as a share.
    pub lift: f64,
    /// The index of the printed part; `None` for bought bodies.
    pub part: Option<usize>,
    /// The solid's pose in the mount's frame: the columns of a homogeneous 4 x 4 matrix.
    pub place: [f64; 16],
    /// The index of the body's solid in [`Model::solids`].
    pub solid: usize,
}

/// A printed part.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct PartEntry {
    /// The part's name.
    pub name: String,
    /// The name of the part's files, without folder and extension.
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

/// The description of the complete model, except the triangles.
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
    /// The number of groups of files, which [`Model::files`] makes one per call.
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
    /// Fails for an invalid robot.toml, or a robot whose parts cannot be made.
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

    /// Describes the model for the page, without triangles.
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

    /// The parts that the robot is built of, without the alternatives to them.
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
            let Placement {
                origin: at,
                x_axis: turn,
            } = match mount {
                Mount::Crank(servo) | Mount::Follower(servo) => Placement {
                    x_axis: Vector::direction(leg(servo).0),
                    ..as_led
                },
                Mount::Foot(servo) => Placement {
                    origin: leg(servo).1.joints[0],
                    ..as_led
                },
                Mount::Strut(servo) => {
                    let [from, to] = leg(servo).1.strut;
                    let along = to - from;
                    Placement {
                        origin: from,
                        x_axis: along * (1.0 / along.length()),
                    }
                }
                _ => as_led,
            };
            [at.x, at.y, turn.x, turn.y]
        });
        Some(places.collect())
    }

    /// All parts in the order in which `lizard parts` makes them: the coupon, if any, then also the alternatives.
    fn ordered(&self) -> impl Iterator<Item = Part> {
        let coupon = coupon(self.assembly.robot().parts());
        coupon.into_iter().chain(self.parts.iter().cloned())
    }

    /// Makes a group of the files that `lizard parts` writes: the files of one part, or in the last group the
    /// bill and the guide. Empty for a larger `number`.
    ///
    /// # Errors
    /// Fails for a part whose layers make no closed body, or a screw that cannot be reached.
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

    /// Proves that no two parts overlap or come too close at any pose that the guard accepts.
    ///
    /// # Errors
    /// Returns the worst two parts.
    pub fn prove(&self, progress: impl FnMut(usize, usize)) -> Result<Proved, Refused> {
        let proof = self.assembly.prove(progress);
        proof.judge().map_err(BuildProblem::from)?;
        Ok(Proved {
            least: proof.nearest().map(|near| near.proved),
        })
    }
}

/// The result of a successful proof.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Proved {
    /// Least distance between two parts that are not designed to touch, mm; `None` if no such pair was checked.
    pub least: Option<f64>,
}

/// Returns the homogeneous matrix, by columns, of a solid's pose in its mount's frame; the identity for `None`.
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
    let Placement {
        origin: at,
        x_axis: turn,
    } = frame;
    let over = if flipped { -1.0 } else { 1.0 };
    let across = turn.rotated_left() * over;
    [
        turn.x, turn.y, 0.0, 0.0, across.x, across.y, 0.0, 0.0, 0.0, 0.0, over, 0.0, at.x, at.y,
        lift, 1.0,
    ]
}

#[cfg(test)]
mod tests;
