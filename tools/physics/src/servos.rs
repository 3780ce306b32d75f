//! Comparison of the contact model and MuJoCo for servos that lag behind their pulses. MuJoCo uses the motors that
//! `lizard model` writes. The servos have no dead band here.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use lizard_parts::{Assembly, Scene};
use lizard_robot::Robot;

use crate::case::Case;
use crate::mujoco::make_two_cycle_scene;
use crate::results::{Displacement, DisplacementPair};
use crate::table::Component;

/// The gaits, each with the compared component of the displacement.
pub const GAITS: [(&str, Component); 4] = [
    ("walk", Component::Forward),
    ("trot", Component::Forward),
    ("crawl", Component::Forward),
    ("left", Component::Turn),
];
/// The allowed deviation of the contact model from MuJoCo, as a fraction of MuJoCo's displacement.
const MAX_DEVIATION: f64 = 0.10;

/// The paper's robot with other servos, joints, mass and pads.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    /// The variant's name in the table.
    pub name: &'static str,
    /// Lines of the table `[servo]` in robot.toml.
    servo_lines: &'static str,
    /// Lines of the table `[joints]` in robot.toml.
    joint_lines: &'static str,
    /// Friction torque of each pin in MuJoCo, N mm, instead of `drag`, the total of a leg's pins; `None` for `drag`.
    pin_torque: Option<f64>,
    /// Additional mass, g.
    extra_mass_g: f64,
    /// Friction coefficient of the pads.
    pad_friction: f64,
    /// Gaits whose deviation may exceed [`MAX_DEVIATION`], each with its own allowed deviation.
    exceptions: &'static [(&'static str, f64)],
}

const SG90: Variant = Variant {
    name: "SG-90",
    servo_lines: "",
    joint_lines: "",
    pin_torque: None,
    extra_mass_g: 0.0,
    pad_friction: 0.7,
    exceptions: &[],
};
/// Copies of the SG-90 in a heavier robot, on pads with more friction.
const SG90_COPY: Variant = Variant {
    name: "copy, 50 g more, friction 1, joints that run easily",
    servo_lines: "model = \"copy\"",
    extra_mass_g: 50.0,
    pad_friction: 1.0,
    ..SG90
};
const STIFF_JOINTS: Variant = Variant {
    name: "copy, 50 g more, friction 1, stiff joints",
    joint_lines: "drag = 17.0\nslider = 0.5",
    ..SG90_COPY
};

impl Variant {
    /// All variants, in the order of the table.
    pub const ALL: [Self; 7] = [
        SG90,
        SG90_COPY,
        STIFF_JOINTS,
        Self {
            name: "the same, but 3 N mm in each pin of MuJoCo's robot",
            pin_torque: Some(3.0),
            // The head's and tail's pins turn when a single leg swings; without their friction, the deviation is 6 %.
            exceptions: &[("crawl", 0.17)],
            ..STIFF_JOINTS
        },
        Self {
            name: "the same copy on 4.2 V",
            servo_lines: "model = \"copy\"\nvolts = 4.2",
            // The servos nearly stall; therefore small details of the robot change MuJoCo's walk by a tenth.
            exceptions: &[("walk", 0.21), ("left", 0.12)],
            ..STIFF_JOINTS
        },
        Self {
            name: "a rotor of 2 ms",
            servo_lines: "spin_up_ms = 2.0",
            ..SG90
        },
        Self {
            name: "a rotor of 2 ms, and full torque at 1 deg",
            servo_lines: "spin_up_ms = 2.0\nfull_torque_deg = 1.0",
            ..SG90
        },
    ];

    /// Loads the robot of this variant.
    ///
    /// # Panics
    /// If a line to replace is not in robots/paper.toml, or if the changed robot is invalid.
    pub fn load_robot(&self) -> Robot {
        let paper_mass = crate::load_robot("paper").ground().body.mass;
        let joint_and_servo_tables = format!(
            "[joints]\n{}\n[servo]\n{}\ndead_band_us = 0.0\n[servo.A1]",
            self.joint_lines, self.servo_lines
        );
        let ground_table = format!("[ground]\nfriction = {}", self.pad_friction);
        let [old_mass, new_mass] =
            [paper_mass, paper_mass + self.extra_mass_g].map(|mass| format!("mass = {mass:.1}"));
        let replacements: [(&str, &str); 3] = [
            ("[servo.A1]", &joint_and_servo_tables),
            ("[ground]", &ground_table),
            (&old_mass, &new_mass),
        ];
        crate::load_changed_paper(self.name, &replacements)
    }

    /// Returns the MuJoCo scene in which the robot walks two cycles of a gait; the second is measured.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn make_scene(&self, scene_name: &str, assembly: &Assembly, gait: &str) -> Scene {
        let mut scene = make_two_cycle_scene(scene_name, assembly, gait, Case::ALL[0]);
        if let Some(pin_torque) = self.pin_torque {
            (scene.pin_friction, scene.motors.joint_friction.pin_torque) = (pin_torque, 0.0);
        }
        scene
    }

    /// Simulates a gait's second cycle in the contact model and returns the displacement.
    ///
    /// # Panics
    /// If the robot has no such gait.
    pub fn simulate_contact_model(&self, gait: &str) -> Displacement {
        let robot = self.load_robot();
        let gait = robot.gait(gait).expect("the robot has this gait");
        let travel = gait.simulate_driven_cycle(robot.ground(), &robot.motors(), 1.0);
        travel.into()
    }

    /// Returns a message if the contact model deviates too much from MuJoCo in a gait; `None` if it does not, if
    /// the model has no result, or if the gait is not one of [`GAITS`].
    pub fn describe_disagreement(&self, gait: &str, results: &DisplacementPair) -> Option<String> {
        let (_, component) = GAITS.into_iter().find(|(name, _)| *name == gait)?;
        let [model, mujoco] =
            [results.model?, results.mujoco].map(|displacement| component.value(displacement));
        let exception = self.exceptions.iter().find(|(name, _)| *name == gait);
        let max_deviation = exception.map_or(MAX_DEVIATION, |(_, deviation)| *deviation);
        let deviation = model / mujoco - 1.0;
        (deviation.abs() > max_deviation).then(|| {
            let percent = 100.0 * deviation;
            format!("the model has {model:.1}, MuJoCo has {mujoco:.1}: {percent:+.0} %")
        })
    }
}

/// The results by variant and gait.
pub type ServoResults = BTreeMap<String, BTreeMap<String, DisplacementPair>>;

/// Returns the table of all variants in Markdown, with a dash for a missing result.
pub fn format_servos_table(results: &ServoResults) -> String {
    let headings = GAITS.map(|(gait, component)| format!(" {gait}, {} |", component.unit()));
    let separators = "---|".repeat(GAITS.len());
    let headings = headings.concat();
    let mut table = format!("| model, MuJoCo |{headings}\n|---|{separators}\n");
    for variant in Variant::ALL {
        _ = write!(table, "| {} |", variant.name);
        for (gait, component) in GAITS {
            let find_pair = || {
                let pair = results.get(variant.name)?.get(gait)?;
                Some((component.value(pair.model?), component.value(pair.mujoco)))
            };
            _ = match find_pair() {
                Some((model, mujoco)) => write!(table, " {model:.1}, {mujoco:.1} |"),
                None => write!(table, " - |"),
            };
        }
        table.push('\n');
    }
    table
}
