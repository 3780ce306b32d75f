//! The assumptions of a prediction, each changed over its plausible range: the ones that matter, and
//! how much.

use std::fmt;

use lizard_contact::{Ground, Motors, Travel};

use crate::checks::CheckedGait;
use crate::measures::ServoType;
use crate::robot::Robot;

/// Smallest change of a movement that counts, percent.
const COUNTS: f64 = 10.0;
/// Smallest movement of a cycle that counts: mm ahead, deg of turn.
const MIN_MOVEMENT: (f64, f64) = (1.0, 0.5);
/// Movements that differ by less belong to a gait and its mirror image or its reverse: mm,
/// deg.
const ALIKE: f64 = 0.02;

/// Everything that a prediction takes for granted.
#[derive(Clone, Copy)]
struct Inputs {
    ground: Ground,
    servo: ServoType,
    /// Friction of the pins, N mm, and of a slider, N.
    joints: [f64; 2],
    /// Angle that a servo turns over the angle that the firmware sends.
    scale: f64,
}

/// An assumption: its words, its unit, its value and the ends of its range, and its change.
struct Assumption {
    words: &'static str,
    unit: &'static str,
    own: fn(&Inputs) -> f64,
    ends: [f64; 2],
    change: fn(&mut Inputs, f64),
}

/// The assumptions in the order of robot.toml.
const ALL: [Assumption; 21] = [
    Assumption {
        words: "stall torque of a servo",
        unit: "kg cm",
        own: |taken| taken.servo.stall_kg_cm,
        ends: [1.2, 2.2],
        change: |taken, value| taken.servo.stall_kg_cm = value,
    },
    Assumption {
        words: "time of a servo for 60 deg",
        unit: "s",
        own: |taken| taken.servo.s_per_60_deg,
        ends: [0.1, 0.15],
        change: |taken, value| taken.servo.s_per_60_deg = value,
    },
    Assumption {
        words: "supply of the servos",
        unit: "V",
        own: |taken| taken.servo.volts,
        ends: [4.0, 5.2],
        change: |taken, value| taken.servo.volts = value,
    },
    Assumption {
        words: "spin-up of a servo's rotor",
        unit: "ms",
        own: |taken| taken.servo.spin_up_ms,
        ends: [2.0, 40.0],
        change: |taken, value| taken.servo.spin_up_ms = value,
    },
    Assumption {
        words: "error at the full torque",
        unit: "deg",
        own: |taken| taken.servo.full_torque_deg,
        ends: [1.0, 6.0],
        change: |taken, value| taken.servo.full_torque_deg = value,
    },
    Assumption {
        words: "dead band of a servo",
        unit: "us",
        own: |taken| taken.servo.dead_band_us,
        ends: [2.0, 20.0],
        change: |taken, value| taken.servo.dead_band_us = value,
    },
    Assumption {
        words: "angle of the servos over the one sent",
        unit: "",
        own: |taken| taken.scale,
        // A servo that trial 3 of docs/measure.md accepts: 11 or 9 us for each deg, not 10.
        ends: [0.91, 1.11],
        change: |taken, value| taken.scale = value,
    },
    Assumption {
        words: "fast digital servos",
        unit: "(0 no, 1 yes)",
        own: |_| 0.0,
        ends: [0.0, 1.0],
        change: |taken, value| {
            if value > 0.0 {
                taken.servo = ServoType {
                    volts: taken.servo.volts,
                    ..ServoType::DIGITAL
                };
            }
        },
    },
    Assumption {
        words: "rotor 2 ms and full torque at 1 deg",
        unit: "(0 no, 1 yes)",
        own: |_| 0.0,
        ends: [0.0, 1.0],
        change: |taken, value| {
            if value > 0.0 {
                taken.servo.spin_up_ms = 2.0;
                taken.servo.full_torque_deg = 1.0;
            }
        },
    },
    Assumption {
        words: "friction of pins",
        unit: "N mm",
        own: |taken| taken.joints[0],
        ends: [0.0, 20.0],
        change: |taken, value| taken.joints[0] = value,
    },
    Assumption {
        words: "friction of a slider",
        unit: "N",
        own: |taken| taken.joints[1],
        ends: [0.0, 1.0],
        change: |taken, value| taken.joints[1] = value,
    },
    Assumption {
        words: "mass",
        unit: "g",
        own: |taken| taken.ground.body.mass,
        ends: [350.0, 500.0],
        change: |taken, value| taken.ground.body.mass = value,
    },
    Assumption {
        words: "mass centre ahead",
        unit: "mm",
        own: |taken| taken.ground.body.centre[0],
        ends: [-15.0, 15.0],
        change: |taken, value| taken.ground.body.centre[0] = value,
    },
    Assumption {
        words: "friction of a pad",
        unit: "",
        own: |taken| taken.ground.friction,
        ends: [0.4, 1.2],
        change: |taken, value| taken.ground.friction = value,
    },
    Assumption {
        words: "friction backward over forward",
        unit: "",
        own: |taken| taken.ground.ratio,
        ends: [0.67, 1.5],
        change: |taken, value| taken.ground.ratio = value,
    },
    Assumption {
        words: "hips ahead of the middle",
        unit: "mm",
        own: |taken| taken.ground.feet.hip_forward,
        ends: [50.0, 60.0],
        change: |taken, value| taken.ground.feet.hip_forward = value,
    },
    Assumption {
        words: "mounting of the legs",
        unit: "deg",
        own: |taken| taken.ground.feet.mount,
        ends: [-10.0, 41.4],
        change: |taken, value| taken.ground.feet.mount = value,
    },
    Assumption {
        words: "play of a leg",
        unit: "deg",
        own: |taken| taken.ground.drive.play,
        ends: [0.0, 2.0],
        change: |taken, value| taken.ground.drive.play = value,
    },
    Assumption {
        words: "front left foot too long",
        unit: "mm",
        own: |taken| taken.ground.stance.twist,
        ends: [-1.0, 1.0],
        change: |taken, value| taken.ground.stance.twist = value,
    },
    Assumption {
        words: "stiffness of feet, that foot 0.5 mm too long",
        unit: "N/mm",
        own: |taken| taken.ground.stance.stiffness,
        ends: [0.3, 3.3],
        change: |taken, value| {
            taken.ground.stance.stiffness = value;
            taken.ground.stance.twist = 0.5;
        },
    },
    Assumption {
        words: "copies, stiff joints, friction 1, 50 g more",
        unit: "(0 no, 1 yes)",
        own: |_| 0.0,
        ends: [0.0, 1.0],
        change: |taken, value| {
            if value > 0.0 {
                taken.servo.stall_kg_cm = 1.2;
                taken.servo.s_per_60_deg = 0.15;
                taken.joints = [17.0, 0.5];
                taken.ground.friction = 1.0;
                taken.ground.body.mass += 50.0;
            }
        },
    },
];

/// An assumption's effect on each gait.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    words: &'static str,
    unit: &'static str,
    own: f64,
    ends: [f64; 2],
    /// Change of each gait's movement at both ends, percent.
    changes: Vec<[f64; 2]>,
}

/// The effects of all assumptions on gaits that lead somewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumptions {
    gaits: Vec<String>,
    /// From the largest effect to the smallest.
    rows: Vec<Row>,
}

impl Assumptions {
    /// Walks a robot's gaits with its servos at both ends of every range; takes some seconds.
    pub fn of(robot: &Robot) -> Self {
        let joints = robot.motors().joints;
        let taken = Inputs {
            ground: *robot.ground(),
            servo: *robot.servo_type(),
            joints: [joints.drag, joints.slider],
            scale: 1.0,
        };
        let walked = |gait: &CheckedGait, taken: &Inputs| {
            let Motors { each, mut joints } = robot.motors_of(&taken.servo, taken.servo.volts);
            [joints.drag, joints.slider] = taken.joints;
            gait.driven_scaled(&taken.ground, &Motors { each, joints }, 1.0, taken.scale)
        };
        let gaits = different(robot, |gait| walked(gait, &taken));
        let row = |assumption: &Assumption| {
            let change = |gait: &CheckedGait, before: &Travel, end: f64| {
                let mut changed = taken;
                (assumption.change)(&mut changed, end);
                let part = main(before);
                100.0 * (part(&walked(gait, &changed)) / part(before) - 1.0)
            };
            let of = |(gait, before): &(&CheckedGait, Travel)| {
                assumption.ends.map(|end| change(gait, before, end))
            };
            Row {
                words: assumption.words,
                unit: assumption.unit,
                own: (assumption.own)(&taken),
                ends: assumption.ends,
                changes: gaits.iter().map(of).collect(),
            }
        };
        let mut rows: Vec<Row> = ALL.iter().map(row).collect();
        rows.sort_by(|a, b| b.most().total_cmp(&a.most()));
        Self {
            gaits: gaits
                .iter()
                .map(|(gait, _)| gait.name().to_string())
                .collect(),
            rows,
        }
    }
}

/// The gaits that lead somewhere, each with its movement, without mirror images and
/// reverses.
fn different(
    robot: &Robot,
    walked: impl Fn(&CheckedGait) -> Travel,
) -> Vec<(&CheckedGait, Travel)> {
    let mut gaits: Vec<(&CheckedGait, Travel)> = Vec::new();
    let rigid = robot.ground().rigid();
    for gait in robot.gaits().iter().filter(|gait| gait.moves()) {
        if !gait.predict(&rigid).is_decided() {
            continue;
        }
        let movement = walked(gait);
        let alike = |(_, other): &(_, Travel)| {
            let off = |a: f64, b: f64| (a.abs() - b.abs()).abs() < ALIKE;
            off(movement.forward, other.forward) && off(movement.turn, other.turn)
        };
        let leads = movement.forward.abs() > MIN_MOVEMENT.0 || movement.turn.abs() > MIN_MOVEMENT.1;
        if leads && !gaits.iter().any(alike) {
            gaits.push((gait, movement));
        }
    }
    gaits
}

/// The part of the movement that a gait is for: ahead, or the turn of a gait that turns on
/// the spot.
fn main(movement: &Travel) -> fn(&Travel) -> f64 {
    match movement.forward.abs() > movement.turn.abs() {
        true => |movement| movement.forward,
        false => |movement| movement.turn,
    }
}

impl Row {
    /// The largest change of a movement, percent.
    fn most(&self) -> f64 {
        let all = self.changes.as_flattened().iter();
        all.map(|change| change.abs()).fold(0.0, f64::max)
    }
}

impl fmt::Display for Assumptions {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(
            f,
            "What a cycle leads to at the least and at the greatest value, compared with the value taken, in percent.\n"
        )?;
        let width = self
            .rows
            .iter()
            .map(|row| row.words.len())
            .fold(0, usize::max);
        write!(f, "{:width$}    taken        from to         ", "")?;
        for gait in &self.gaits {
            write!(f, "{gait:>13}")?;
        }
        writeln!(f)?;
        let (count, rest): (Vec<&Row>, Vec<&Row>) =
            self.rows.iter().partition(|row| row.most() >= COUNTS);
        for row in count {
            let [least, most] = row.ends;
            let range = format!("{least} to {most} {}", row.unit);
            write!(f, "{:<width$} {:>8} {range:>19}", row.words, row.own)?;
            for [low, high] in &row.changes {
                // Adding positive zero turns a negative one positive.
                let [low, high] = [low, high].map(|change| change.round() + 0.0);
                write!(f, "{:>13}", format!("{low:+.0} {high:+.0}"))?;
            }
            writeln!(f)?;
        }
        let of = |row: &Row| {
            let [least, most] = row.ends;
            format!("  {}, {least} to {most} {}", row.words, row.unit)
                .trim_end()
                .to_string()
        };
        let rest: Vec<String> = rest.into_iter().map(of).collect();
        match rest.is_empty() {
            true => Ok(()),
            false => writeln!(f, "\nLess than {COUNTS:.0} %:\n{}", rest.join("\n")),
        }
    }
}
