//! What the file has besides the robot's parts: feet, legs, servos, and the angles for
//! the servos.

use lizard_robot::{CheckedGait, FRAMES_PER_SECOND, Robot};

use crate::bodies::assembly::Assembly;

/// What a robot.toml leaves open, or what is to be tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The model's name.
    pub name: String,
    /// By how much each foot is longer than it should be, mm, servo order.
    pub long: [f64; 4],
    /// How much a foot gives under its leaf, N/mm.
    pub stiffness: f64,
    /// The spring in the slotted struts; none where struts are rigid.
    pub pull: Option<Pull>,
    /// How far a servo's link turns freely to either side of its horn, deg.
    pub play: f64,
    /// What the servos can do.
    pub motor: Motor,
    /// Their angles; none to let the robot stand.
    pub course: Option<Course>,
    /// Whether the parts can be seen; without them the file is a fiftieth as long.
    pub shapes: bool,
}

impl Scene {
    /// A robot as its robot.toml says, which stands.
    #[must_use]
    pub fn of(assembly: &Assembly, motor: Motor) -> Self {
        let (drive, stance) = (assembly.robot().drive(), assembly.robot().ground().stance);
        Self {
            name: "lizard".to_owned(),
            long: [stance.twist, 0.0, 0.0, 0.0],
            stiffness: stance.stiffness,
            pull: drive.strut().map(|strut| Pull {
                force: strut.force,
                rate: strut.rate,
            }),
            play: drive.play,
            motor,
            course: None,
            shapes: true,
        }
    }
}

/// A tension spring in a slotted strut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull {
    /// While the leg does not lag, N.
    pub force: f64,
    /// More of it for each mm that the strut grows longer, N/mm.
    pub rate: f64,
}

/// A servo's motor: the faster it turns, the less torque it has left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Without load, deg/s.
    pub rate: f64,
    /// Stalled, N mm.
    pub stall: f64,
}

/// The angles for the servos, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// The gait that it is of.
    pub gait: String,
    /// The servos' targets in each frame of 20 ms: sweeps from neutral, deg,
    /// counter-clockwise positive, servo order.
    pub frames: Vec<[f64; 4]>,
    /// When a whole cycle of it begins, s from the first frame.
    pub begin: f64,
    /// How long a cycle takes, s.
    pub period: f64,
}

/// How long a course takes from neutral to where its gait begins, and how long it waits
/// there for the body to come to rest, s.
const APPROACH: f64 = 0.4;
const REST: f64 = 0.3;

impl Course {
    /// Some cycles of a gait at its own pace, after a slow approach from neutral, with the
    /// angles of the firmware's tables. The last cycle is the one that is to be measured.
    #[must_use]
    pub fn of(robot: &Robot, gait: &CheckedGait, cycles: u32) -> Self {
        let angles = |seconds: f64| {
            let phase = (gait.phase(seconds) * 65536.0).round() as i64;
            gait.table_angles(phase.rem_euclid(65536) as u16)
        };
        let sweeps = |angles: [f64; 4]| -> [f64; 4] {
            std::array::from_fn(|i| lizard_kinematics::wrap(angles[i] - robot.servos()[i].neutral))
        };
        let start = sweeps(angles(0.0));
        let begin = APPROACH + REST;
        let period = gait.period();
        let seconds = begin + f64::from(cycles) * period;
        let frames = (0..=(seconds * FRAMES_PER_SECOND).ceil() as usize).map(|frame| {
            let now = frame as f64 / FRAMES_PER_SECOND;
            match now < begin {
                true => start.map(|sweep| sweep * (now / APPROACH).min(1.0)),
                false => sweeps(angles(now - begin)),
            }
        });
        Self {
            gait: gait.name().to_owned(),
            frames: frames.collect(),
            begin: begin + f64::from(cycles - 1) * period,
            period,
        }
    }
}
