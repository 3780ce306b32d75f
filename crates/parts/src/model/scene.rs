//! The conditions of a simulation: feet, springs, servos and floor, and the servos' target angles.

use lizard_robot::{CheckedGait, FRAMES_PER_SECOND, Motors, Robot};

use super::floor::Floor;
use crate::bodies::assembly::Assembly;

/// Values that are missing in robot.toml or that an experiment changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Name of the model.
    pub name: String,
    /// Excess length of each foot, mm, servo order.
    pub excess_lengths: [f64; 4],
    /// Stiffness of a foot's leaf, N/mm.
    pub leaf_stiffness: f64,
    /// Ratio of a pad's backward friction to its forward friction.
    pub friction_ratio: f64,
    /// Spring in each slotted strut; `None` for rigid struts.
    pub strut_spring: Option<StrutSpring>,
    /// Play between a servo's horn and its link to either side, deg.
    pub play: f64,
    /// Motors of the servos, and friction of the joints.
    pub motors: Motors,
    /// Dry friction of each pin, N mm, in addition to the friction in `motors`; pins that close loops have no friction.
    pub pin_friction: f64,
    /// Floor under the robot.
    pub floor: Floor,
    /// Shape of the pads.
    pub pads: Pads,
    /// Factor of the masses of all parts that move relative to the chassis; the removed mass is added to the chassis.
    pub limb_mass_factor: f64,
    /// True if the servos drive in bursts, as analogue ones do.
    pub drives_in_bursts: bool,
    /// Target angles of the servos; `None` if the robot stands still.
    pub trajectory: Option<Trajectory>,
    /// True to include the shapes of the parts; without them, the file is one fiftieth as long.
    pub has_shapes: bool,
}

impl Scene {
    /// Creates the scene of the standing robot according to its robot.toml.
    pub fn for_assembly(assembly: &Assembly) -> Self {
        let (drive, ground) = (assembly.robot().drive(), assembly.robot().ground());
        let stance = ground.stance;
        Self {
            name: "lizard".to_owned(),
            excess_lengths: [stance.twist, 0.0, 0.0, 0.0],
            leaf_stiffness: stance.stiffness,
            friction_ratio: ground.friction_ratio,
            strut_spring: drive.strut().map(|strut| StrutSpring {
                preload: strut.preload,
                rate: strut.spring_rate,
            }),
            play: drive.play,
            motors: assembly.robot().motors(),
            pin_friction: 0.0,
            floor: Floor::for_robot(assembly.robot()),
            pads: Pads::Domes(assembly.robot().parts().pad.radius),
            limb_mass_factor: 1.0,
            drives_in_bursts: false,
            trajectory: None,
            has_shapes: true,
        }
    }
}

/// The shape of the pads under the feet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pads {
    /// Smooth domes of this radius, mm.
    Domes(f64),
    /// Printed domes with the radius of `[parts.pad]`: stacked discs of this height, mm, with sharp edges.
    Terraces(f64),
    /// Flat discs of this diameter, mm.
    Flat(f64),
}

/// A tension spring in a slotted strut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrutSpring {
    /// Tension of the spring while it holds the leg's screw at the slot's inner end, N.
    pub preload: f64,
    /// Rate of the spring, N/mm.
    pub rate: f64,
}

/// The servos' target angles, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Name of the gait.
    pub gait_name: String,
    /// Servo targets in each frame of 20 ms: sweeps from neutral, deg, counter-clockwise positive, servo order.
    pub frames: Vec<[f64; 4]>,
    /// Start of the cycles to measure, s from the first frame.
    pub measure_start: f64,
    /// Period of a cycle, s.
    pub period: f64,
    /// Number of cycles to measure.
    pub measured_cycle_count: u32,
}

/// Duration of the motion from neutral to the gait's first pose, s.
const APPROACH_DURATION_S: f64 = 0.4;
/// Duration of the pause in the gait's first pose, until the body is at rest, s.
const SETTLE_DURATION_S: f64 = 0.3;

impl Trajectory {
    /// Creates the trajectory of `cycle_count` cycles of a gait at its own pace, after a slow approach from neutral,
    /// with the angles of the firmware's tables. The last `measured_cycle_count` cycles are measured.
    pub fn for_gait(
        robot: &Robot,
        gait: &CheckedGait,
        cycle_count: u32,
        measured_cycle_count: u32,
    ) -> Self {
        let angles_at = |seconds: f64| {
            let phase = (gait.phase_at(seconds) * 65536.0).round() as i64;
            gait.table_angles(phase.rem_euclid(65536) as u16)
        };
        let to_sweeps = |angles: [f64; 4]| -> [f64; 4] {
            std::array::from_fn(|i| lizard_kinematics::wrap(angles[i] - robot.servos()[i].neutral))
        };
        let start_sweeps = to_sweeps(angles_at(0.0));
        let start_s = APPROACH_DURATION_S + SETTLE_DURATION_S;
        let period = gait.period();
        let end_s = start_s + f64::from(cycle_count) * period;
        let targets_at = |frame: usize| {
            let time_s = frame as f64 / FRAMES_PER_SECOND;
            match time_s < start_s {
                true => start_sweeps.map(|sweep| sweep * (time_s / APPROACH_DURATION_S).min(1.0)),
                false => to_sweeps(angles_at(time_s - start_s)),
            }
        };
        let last_frame = (end_s * FRAMES_PER_SECOND).ceil() as usize;
        Self {
            gait_name: gait.name().to_owned(),
            frames: (0..=last_frame).map(targets_at).collect(),
            measure_start: start_s + f64::from(cycle_count - measured_cycle_count) * period,
            period,
            measured_cycle_count,
        }
    }
}
