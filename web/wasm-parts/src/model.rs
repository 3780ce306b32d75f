//! What is in the picture: bodies, the parts that they are printed as, and the steps of the guide.

use lizard_kinematics::Vector;
use lizard_parts::{
    Assembly, Bill, File, Lies, Mount, Part, Placement, Step, coupon, papers, part_files, steps,
};
use lizard_robot::Robot;
use lizard_robot::servo::FORWARD;
use serde::Serialize;

/// Why there are no parts of a robot.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// The sentence.
    pub refused: String,
}

impl Refused {
    fn of(error: impl ToString) -> Self {
        Self {
            refused: error.to_string(),
        }
    }
}

/// A body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyEntry {
    /// Its name.
    pub name: String,
    /// What it is, in a word or two.
    pub kind: &'static str,
    /// Which mount it moves with, an index.
    pub mount: usize,
    /// The servo that it belongs to, 0 to 3; none for what belongs to the chassis or to a side.
    pub servo: Option<usize>,
    /// The step of the guide that adds it, from 1; 0 for none.
    pub step: usize,
    /// How far the guide's exploded picture lifts it, as a share.
    pub lift: f64,
    /// The part that it is printed as, an index; none for what is bought.
    pub part: Option<usize>,
    /// Its place in its mount's frame: the columns of a 4 x 4 matrix.
    pub place: [f64; 16],
    /// Which of the solids it is, an index.
    pub solid: usize,
}

/// A printed part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartEntry {
    /// Its name.
    pub name: String,
    /// The name of its files, without folder and ending.
    pub file: String,
    /// How many are needed.
    pub count: usize,
}

/// A step of the guide.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepEntry {
    /// Its headline.
    pub title: &'static str,
    /// What to do, as Markdown.
    pub words: &'static str,
}

/// All of it but the triangles.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelEntry {
    /// Every body.
    pub bodies: Vec<BodyEntry>,
    /// Every printed part that the robot has.
    pub parts: Vec<PartEntry>,
    /// The steps of the guide.
    pub steps: Vec<StepEntry>,
    /// How many mounts there are.
    pub mounts: usize,
    /// How far the soles of the feet are below the plate's top, mm.
    pub floor: f64,
    /// How many calls of [`Model::files`] make all files.
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
    /// Of a robot.toml.
    ///
    /// # Errors
    /// What is wrong with the robot, or why no parts can be made of it.
    pub fn read(toml: &str) -> Result<Self, Refused> {
        let robot = Robot::parse(toml).map_err(Refused::of)?;
        let assembly = Assembly::new(&robot);
        assembly.measures_fit().map_err(Refused::of)?;
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

    /// What there is.
    #[must_use]
    pub fn entry(&self) -> ModelEntry {
        let mut soles: f64 = 0.0;
        let mut bought = self.needed().count();
        let bodies = self.assembly.bodies().iter().map(|body| {
            soles = soles.min(body.z()[0]);
            let of_body = |part: &Part| part.bodies.contains(&body.name);
            let part = self.needed().position(of_body);
            let lies = part.map(|part| self.parts[part].lies(body));
            let step = self.steps.iter().position(|step| step.adds(body));
            let solid = part.unwrap_or_else(|| {
                bought += 1;
                bought - 1
            });
            BodyEntry {
                name: body.name.clone(),
                kind: body.kind.word(),
                mount: self.mount(body.mount),
                servo: servo(body.mount),
                step: step.map_or(0, |step| step + 1),
                lift: step.map_or(0.0, |step| (self.steps[step].lift)(body)),
                part,
                place: matrix(lies),
                solid,
            }
        });
        let bodies = bodies.collect();
        ModelEntry {
            bodies,
            parts: self
                .needed()
                .map(|part| PartEntry {
                    name: part.name.clone(),
                    file: part.file(),
                    count: part.count(),
                })
                .collect(),
            steps: self
                .steps
                .iter()
                .map(|step| StepEntry {
                    title: step.title,
                    words: step.words,
                })
                .collect(),
            mounts: self.mounts.len(),
            floor: -soles,
            files: self.made().count() + 1,
        }
    }

    /// Its assembly.
    #[must_use]
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// The parts that the robot has; those that may be put in instead come last in the list.
    pub(crate) fn needed(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(|part| part.instead_of.is_none())
    }

    fn mount(&self, mount: Mount) -> usize {
        let mut known = self.mounts.iter();
        known
            .position(|known| *known == mount)
            .expect("a body's own")
    }

    /// Where every mount is while the servos are at these angles (deg, chassis frame) and each
    /// leg lags so far behind its servo (deg, foot forward positive): x and y in mm, and the
    /// direction of its x axis. `None` where a loop does not close.
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
    fn made(&self) -> impl Iterator<Item = Part> {
        let coupon = coupon(self.assembly.robot().parts());
        coupon.into_iter().chain(self.parts.iter().cloned())
    }

    /// Some of the files that `lizard parts` writes: of a part, and at last bill and guide.
    /// None beyond the last.
    ///
    /// # Errors
    /// A part whose layers make no body, a screw that cannot be reached.
    pub fn files(&self, number: usize) -> Result<Vec<File>, Refused> {
        let robot = self.assembly.robot();
        let count = self.made().count();
        if let Some(part) = self.made().nth(number) {
            return part_files(&part, robot.parts().kerf).map_err(Refused::of);
        }
        if number > count {
            return Ok(Vec::new());
        }
        let pose = robot
            .lizard()
            .solve(&robot.neutral())
            .map_err(Refused::of)?;
        let bill = Bill::of(&self.assembly, &self.parts, &pose);
        papers(&self.assembly, &bill, &pose).map_err(Refused::of)
    }

    /// Proves that no two parts meet at any pose that the guard accepts.
    ///
    /// # Errors
    /// The two that do.
    pub fn prove(&self, progress: impl FnMut(usize, usize)) -> Result<Proved, Refused> {
        let proof = self.assembly.prove(progress);
        let judged = proof.judge().map_err(lizard_parts::Unfit::from);
        judged.map_err(Refused::of)?;
        Ok(Proved {
            least: proof.least().map(|near| near.proved),
        })
    }
}

/// What was proved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Proved {
    /// No two parts that are not made to meet come nearer than this, mm.
    pub least: Option<f64>,
}

fn servo(mount: Mount) -> Option<usize> {
    match mount {
        Mount::Link(servo)
        | Mount::Crank(servo)
        | Mount::Follower(servo)
        | Mount::Foot(servo)
        | Mount::Strut(servo)
        | Mount::Coupler(servo) => Some(servo),
        Mount::Chassis | Mount::Sleeve(_) | Mount::Rod(_) => None,
    }
}

/// A place in a mount's frame as the columns of a matrix.
fn matrix(lies: Option<Lies>) -> [f64; 16] {
    let Some(Lies {
        flipped,
        lift,
        home: Placement { at, turn },
    }) = lies
    else {
        return matrix(Some(Lies {
            flipped: false,
            lift: 0.0,
            home: Placement::CHASSIS,
        }));
    };
    let over = if flipped { -1.0 } else { 1.0 };
    let across = turn.left() * over;
    [
        turn.x, turn.y, 0.0, 0.0, across.x, across.y, 0.0, 0.0, 0.0, 0.0, over, 0.0, at.x, at.y,
        lift, 1.0,
    ]
}

#[cfg(test)]
mod tests;
