//! The model that the page shows: bodies, printed parts and the steps of the assembly guide.

use lizard_kinematics::Vector;
use lizard_parts::{
    Assembly, Bill, BuildError, CollidingPair, Mount, OutputFile, Part, Placement, PrintTransform,
    Step, build_coupon, build_steps, make_documents, make_part_files,
};
use lizard_robot::Robot;
use lizard_robot::servo::FORWARD_TURN_SIGN;
use serde::Serialize;
use tsify::Tsify;

/// The refusal of a request for a robot's parts.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Refusal {
    /// The reason, as a message.
    pub reason: String,
    /// The two parts that overlap or come too close; `None` if there is another reason.
    #[tsify(type = "CollidingPair | null")]
    pub colliding_pair: Option<CollidingPair>,
}

impl Refusal {
    fn without_pair(error: impl ToString) -> Self {
        Self {
            reason: error.to_string(),
            colliding_pair: None,
        }
    }
}

impl From<BuildError> for Refusal {
    fn from(error: BuildError) -> Self {
        Self {
            colliding_pair: error.colliding_pair(),
            ..Self::without_pair(error)
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
    /// The index of the body's mount, the frame of reference in which the body is fixed.
    pub mount: usize,
    /// The index of the servo to which the body belongs; `None` for chassis and sides.
    pub servo: Option<usize>,
    /// The number of the guide's step that adds the body, from 1; 0 if no step adds it.
    pub step: usize,
    /// Lift of the body in the guide's exploded picture, as a multiple of the standard lift; negative moves it down.
    pub lift: f64,
    /// The index of the body's printed part; `None` for bought bodies.
    pub part: Option<usize>,
    /// The solid's placement in the mount's frame: the columns of a homogeneous 4 x 4 matrix.
    pub matrix: [f64; 16],
    /// The index of the body's solid in [`Model::make_solids`].
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
pub struct GuideStepEntry {
    /// The headline of the step.
    pub title: &'static str,
    /// The instructions, as Markdown.
    pub instructions: String,
}

/// The description of a model, without triangles.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct ModelDescription {
    /// Every body of the robot.
    pub bodies: Vec<BodyEntry>,
    /// Every printed part that the robot has.
    pub parts: Vec<PartEntry>,
    /// The steps of the guide.
    pub steps: Vec<GuideStepEntry>,
    /// The number of mounts.
    pub mount_count: usize,
    /// Distance from the plate's top down to the soles of the feet, mm.
    pub sole_depth: f64,
    /// The number of groups of files, of which each call of [`Model::make_files`] makes one.
    pub file_group_count: usize,
}

/// The model of a robot: bodies, parts and the guide's steps.
pub struct Model {
    pub(crate) assembly: Assembly,
    parts: Vec<Part>,
    mounts: Vec<Mount>,
    steps: Vec<Step>,
}

impl Model {
    /// Makes the model for a robot.toml.
    ///
    /// # Errors
    /// Fails if robot.toml is invalid, or if the robot's parts cannot be made.
    pub fn from_toml(toml: &str) -> Result<Self, Refusal> {
        let robot = Robot::parse(toml).map_err(Refusal::without_pair)?;
        let assembly = Assembly::new(&robot);
        assembly.check_dimensions()?;
        let mut mounts: Vec<Mount> = Vec::new();
        for body in assembly.bodies() {
            if !mounts.contains(&body.mount) {
                mounts.push(body.mount);
            }
        }
        Ok(Self {
            parts: assembly.collect_parts(),
            steps: build_steps(robot.drive().strut().is_some()),
            assembly,
            mounts,
        })
    }

    /// Describes the model for the page, without triangles.
    pub fn describe(&self) -> ModelDescription {
        let mut sole_z: f64 = 0.0;
        let mut next_bought_index = self.needed_parts().count();
        let bodies = self.assembly.bodies().iter().map(|body| {
            sole_z = sole_z.min(body.z()[0]);
            let part = self.needed_parts().position(|part| part.prints_body(body));
            let transform = part.map(|part| self.parts[part].transform_to_body(body));
            let step_index = self.steps.iter().position(|step| step.adds(body));
            let solid = part.unwrap_or_else(|| {
                next_bought_index += 1;
                next_bought_index - 1
            });
            BodyEntry {
                name: body.name.clone(),
                kind: body.kind.word(),
                mount: self.mount_index(body.mount),
                servo: body.mount.servo(),
                step: step_index.map_or(0, |index| index + 1),
                lift: step_index.map_or(0.0, |index| (self.steps[index].lift)(body)),
                part,
                matrix: to_matrix(transform),
                solid,
            }
        });
        let bodies = bodies.collect();
        let make_part_entry = |part: &Part| PartEntry {
            name: part.name.clone(),
            file: part.file_stem(),
            count: part.count(),
        };
        let make_step_entry = |step: &Step| GuideStepEntry {
            title: step.title,
            instructions: step.instructions.clone(),
        };
        ModelDescription {
            bodies,
            parts: self.needed_parts().map(make_part_entry).collect(),
            steps: self.steps.iter().map(make_step_entry).collect(),
            mount_count: self.mounts.len(),
            sole_depth: -sole_z,
            file_group_count: self.ordered_parts().count() + 1,
        }
    }

    /// Returns the parts of which the robot is built, without their alternatives.
    pub(crate) fn needed_parts(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(|part| part.replaces.is_none())
    }

    fn mount_index(&self, mount: Mount) -> usize {
        let index = self.mounts.iter().position(|candidate| *candidate == mount);
        index.expect("every body's mount is in the list")
    }

    /// Returns the placement of every mount in the chassis frame: x and y of its origin, mm, and the unit vector of its
    /// x axis. `angles` are the servo angles (deg, chassis frame), and `lags` are the lags of the legs behind the
    /// servos (deg, foot forward positive). `None` if a loop does not close.
    pub fn place_mounts(&self, angles: [f64; 4], lags: [f64; 4]) -> Option<Vec<[f64; 4]>> {
        let pose = self.assembly.robot().lizard().solve(&angles.into()).ok()?;
        let plans = &self.assembly.layout().legs;
        let placements = self.mounts.iter().map(|&mount| {
            let driven_placement = self.assembly.placement(mount, &pose);
            let leg_angle_and_points = |servo: usize| {
                let leg_angle = angles[servo] - FORWARD_TURN_SIGN[servo] * lags[servo];
                (leg_angle, plans[servo].points_at(angles[servo], leg_angle))
            };
            let Placement { origin, x_axis } = match mount {
                Mount::Crank(servo) | Mount::Follower(servo) => Placement {
                    x_axis: Vector::from_angle(leg_angle_and_points(servo).0),
                    ..driven_placement
                },
                Mount::Foot(servo) => Placement {
                    origin: leg_angle_and_points(servo).1.joints[0],
                    ..driven_placement
                },
                Mount::Strut(servo) => {
                    let [from, to] = leg_angle_and_points(servo).1.strut_anchors;
                    let direction = to - from;
                    Placement::new(from, direction * (1.0 / direction.length()))
                }
                _ => driven_placement,
            };
            [origin.x, origin.y, x_axis.x, x_axis.y]
        });
        Some(placements.collect())
    }

    /// Returns all parts in the order of `lizard parts`: the test coupon with its rod, and the robot's parts with their
    /// alternatives.
    fn ordered_parts(&self) -> impl Iterator<Item = Part> {
        let coupon = build_coupon(self.assembly.robot().parts());
        coupon.into_iter().chain(self.parts.iter().cloned())
    }

    /// Makes one group of the files that `lizard parts` writes: the files of one part, or, as the last group, the bill
    /// of materials and the guide. Returns no files for a larger `group`.
    ///
    /// # Errors
    /// Fails if the layers of a part do not form a closed body, or if a screw cannot be reached.
    pub fn make_files(&self, group: usize) -> Result<Vec<OutputFile>, Refusal> {
        let robot = self.assembly.robot();
        if let Some(part) = self.ordered_parts().nth(group) {
            return Ok(make_part_files(&part, robot.parts().kerf)?);
        }
        if group > self.ordered_parts().count() {
            return Ok(Vec::new());
        }
        let pose = robot.lizard().solve(&robot.neutral_pose());
        let pose = pose.map_err(Refusal::without_pair)?;
        let bill = Bill::compute(&self.assembly, &self.parts, &pose);
        Ok(make_documents(&self.assembly, &bill, &pose)?)
    }

    /// Proves that no two parts overlap or come too close at any pose that the guard accepts. Returns the smallest
    /// distance between two parts that are not designed to touch, mm; `None` if no such pair was checked.
    ///
    /// # Errors
    /// Returns the two parts that overlap most, or else come closest.
    pub fn prove(&self, progress: impl FnMut(usize, usize)) -> Result<Option<f64>, Refusal> {
        let proof = self.assembly.prove(progress);
        proof.check().map_err(BuildError::from)?;
        Ok(proof.separate_pairs.first().map(|pair| pair.lower_bound))
    }
}

/// Returns the homogeneous matrix, column by column, of a solid's placement in its mount's frame; `None` gives the
/// identity.
fn to_matrix(transform: Option<PrintTransform>) -> [f64; 16] {
    let transform = transform.unwrap_or(PrintTransform {
        is_flipped: false,
        lift: 0.0,
        frame: Placement::CHASSIS,
    });
    let (Placement { origin, x_axis }, lift) = (transform.frame, transform.lift);
    let z_sign = if transform.is_flipped { -1.0 } else { 1.0 };
    let y_axis = x_axis.rotated_left() * z_sign;
    [
        x_axis.x, x_axis.y, 0.0, 0.0, y_axis.x, y_axis.y, 0.0, 0.0, 0.0, 0.0, z_sign, 0.0,
        origin.x, origin.y, lift, 1.0,
    ]
}

#[cfg(test)]
mod tests;
