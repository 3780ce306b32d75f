//! The model that the page shows: bodies, printed parts, and the steps of the guide.

use lizard_kinematics::Vector;
use lizard_parts::{
    Assembly, Bill, BuildProblem, CollidingPair, File, Mount, Part, Placement, PrintToBody, Step,
    coupon, documents, part_files, steps,
};
use lizard_robot::Robot;
use lizard_robot::servo::FORWARD_TURN_SIGN;
use serde::Serialize;
use tsify::Tsify;

/// The reason why the parts of a robot cannot be made.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Refused {
    /// The reason, as a message.
    pub refused: String,
    /// The two parts that overlap or come too close; `None` if there is another reason.
    #[tsify(type = "Clash | null")]
    pub clash: Option<CollidingPair>,
}

impl Refused {
    fn of(error: impl ToString) -> Self {
        Self {
            refused: error.to_string(),
            clash: None,
        }
    }
}

impl From<BuildProblem> for Refused {
    fn from(problem: BuildProblem) -> Self {
        Self {
            clash: problem.colliding_pair(),
            ..Self::of(problem)
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
    /// Height by which the guide's exploded picture lifts the body, as a share of the picture's full lift.
    pub lift: f64,
    /// The index of the body's printed part; `None` for bought bodies.
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
    pub instructions: String,
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
        assembly.check_dimensions()?;
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
        let mut sole_z: f64 = 0.0;
        let mut next_bought_index = self.needed_parts().count();
        let bodies = self.assembly.bodies().iter().map(|body| {
            sole_z = sole_z.min(body.z()[0]);
            let has_body = |part: &Part| part.body_names.contains(&body.name);
            let part = self.needed_parts().position(has_body);
            let motion = part.map(|part| self.parts[part].print_to_body(body));
            let step = self.steps.iter().position(|step| step.adds(body));
            let solid = part.unwrap_or_else(|| {
                next_bought_index += 1;
                next_bought_index - 1
            });
            BodyEntry {
                name: body.name.clone(),
                kind: body.kind.word(),
                mount: self.mount_index(body.mount),
                servo: body.mount.servo(),
                step: step.map_or(0, |step| step + 1),
                lift: step.map_or(0.0, |step| (self.steps[step].lift)(body)),
                part,
                place: matrix_of(motion),
                solid,
            }
        });
        let bodies = bodies.collect();
        let part_entry = |part: &Part| PartEntry {
            name: part.name.clone(),
            file: part.file_stem(),
            count: part.count(),
        };
        let step_entry = |step: &Step| StepEntry {
            title: step.title,
            instructions: step.instructions.clone(),
        };
        ModelEntry {
            bodies,
            parts: self.needed_parts().map(part_entry).collect(),
            steps: self.steps.iter().map(step_entry).collect(),
            mounts: self.mounts.len(),
            floor: -sole_z,
            files: self.ordered_parts().count() + 1,
        }
    }

    /// The assembly of the robot.
    #[must_use]
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// Returns the parts that the robot is built of, without the alternatives to them.
    pub(crate) fn needed_parts(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(|part| part.instead_of.is_none())
    }

    fn mount_index(&self, mount: Mount) -> usize {
        let index = self.mounts.iter().position(|candidate| *candidate == mount);
        index.expect("every body's mount is in the list")
    }

    /// Returns the pose of every mount in the chassis frame: x and y of its origin, mm, and the unit vector of its x
    /// axis. `angles` are those of the servos (deg, chassis frame), `lags` those of the legs behind them (deg, foot
    /// forward positive). `None` if a loop does not close.
    #[must_use]
    pub fn mount_places(&self, angles: [f64; 4], lags: [f64; 4]) -> Option<Vec<[f64; 4]>> {
        let pose = self.assembly.robot().lizard().solve(&angles.into()).ok()?;
        let plans = &self.assembly.layout().legs;
        let places = self.mounts.iter().map(|&mount| {
            let driven_place = self.assembly.place(mount, &pose);
            let leg_at = |servo: usize| {
                let angle = angles[servo] - FORWARD_TURN_SIGN[servo] * lags[servo];
                (angle, plans[servo].place_at(angles[servo], angle))
            };
            let Placement { origin, x_axis } = match mount {
                Mount::Crank(servo) | Mount::Follower(servo) => Placement {
                    x_axis: Vector::direction(leg_at(servo).0),
                    ..driven_place
                },
                Mount::Foot(servo) => Placement {
                    origin: leg_at(servo).1.joints[0],
                    ..driven_place
                },
                Mount::Strut(servo) => {
                    let [from, to] = leg_at(servo).1.strut_anchors;
                    let direction = to - from;
                    Placement {
                        origin: from,
                        x_axis: direction * (1.0 / direction.length()),
                    }
                }
                _ => driven_place,
            };
            [origin.x, origin.y, x_axis.x, x_axis.y]
        });
        Some(places.collect())
    }

    /// Returns all parts in the order in which `lizard parts` makes them: the coupon, if any, and the robot's parts
    /// with their alternatives.
    fn ordered_parts(&self) -> impl Iterator<Item = Part> {
        let coupon = coupon(self.assembly.robot().parts());
        coupon.into_iter().chain(self.parts.iter().cloned())
    }

    /// Makes one group of the files that `lizard parts` writes: the files of one part, or, as the last group, the
    /// bill of materials and the guide. Empty for a larger `group`.
    ///
    /// # Errors
    /// Fails for a part whose layers make no closed body, or a screw that cannot be reached.
    pub fn files(&self, group: usize) -> Result<Vec<File>, Refused> {
        let robot = self.assembly.robot();
        let count = self.ordered_parts().count();
        if let Some(part) = self.ordered_parts().nth(group) {
            return Ok(part_files(&part, robot.parts().kerf)?);
        }
        if group > count {
            return Ok(Vec::new());
        }
        let pose = robot
            .lizard()
            .solve(&robot.neutral_pose())
            .map_err(Refused::of)?;
        let bill = Bill::of(&self.assembly, &self.parts, &pose);
        Ok(documents(&self.assembly, &bill, &pose)?)
    }

    /// Proves that no two parts overlap or come too close in any pose that the guard accepts. Returns the least distance
    /// between two parts that are not designed to touch, mm; `None` if no such pair was checked.
    ///
    /// # Errors
    /// Returns the two parts that overlap most, or else come closest.
    pub fn prove(&self, progress: impl FnMut(usize, usize)) -> Result<Option<f64>, Refused> {
        let proof = self.assembly.prove(progress);
        proof.judge().map_err(BuildProblem::from)?;
        Ok(proof.nearest_separate_pair().map(|pair| pair.lower_bound))
    }
}

/// Returns the homogeneous matrix, column by column, of a solid's pose in its mount's frame; the identity for `None`.
fn matrix_of(motion: Option<PrintToBody>) -> [f64; 16] {
    let identity = PrintToBody {
        is_flipped: false,
        lift: 0.0,
        frame: Placement::CHASSIS,
    };
    let PrintToBody {
        is_flipped,
        lift,
        frame,
    } = motion.unwrap_or(identity);
    let Placement { origin, x_axis } = frame;
    let z_sign = if is_flipped { -1.0 } else { 1.0 };
    let y_axis = x_axis.rotated_left() * z_sign;
    [
        x_axis.x, x_axis.y, 0.0, 0.0, y_axis.x, y_axis.y, 0.0, 0.0, 0.0, 0.0, z_sign, 0.0,
        origin.x, origin.y, lift, 1.0,
    ]
}

#[cfg(test)]
mod tests;
