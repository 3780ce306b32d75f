//! Generator of random, valid robots without symmetry.
//!
//! In the paper's robot, left equals right, head equals tail and every margin's limit is 0.3. Code that confuses two of
//! these numbers still works with this robot. In a random robot all lengths, servos and limits differ, except that both
//! sides of the chassis are equal and the leg is a parallelogram. The generator writes the text of a robot.toml, and
//! [`Robot::parse`] rejects invalid robots, so each result is a robot that a user could build. Each robot has a gait
//! that moves, and about half of the robots measure the voltage of their servo rail.

use fastrand::Rng;
use lizard_core::numbers::gaits::{Gait, Wave};
use lizard_core::numbers::section::REGION_BYTES;
use lizard_kinematics::{End, Leg, Limits, Links, Lizard, Side};
use lizard_robot::Robot;

/// Number of drafts of a robot after which the generator fails.
const MAX_DRAFT_COUNT: usize = 1000;

/// The pins to which a servo may be connected.
const PINS: [&str; 17] = [
    "D2", "D3", "D4", "D5", "D6", "D7", "D8", "D9", "D10", "D11", "D12", "A0", "A1", "A2", "A3",
    "A4", "A5",
];

/// Names of the servos in robot.toml.
const SERVO_NAMES: [&str; 4] = ["A1", "A2", "A3", "A4"];

/// Names of the legs in robot.toml, in the order of their servos.
const LEG_NAMES: [&str; 4] = ["LF", "RF", "RH", "LH"];

/// Returns a random valid robot and the text of its robot.toml.
///
/// # Panics
/// If no draft is a valid robot, which would be an error in the generator.
pub fn random_robot(rng: &mut Rng) -> (String, Robot) {
    (0..MAX_DRAFT_COUNT)
        .find_map(|_| {
            let base = RobotBase::generate(rng)?;
            let mut toml = base.toml.clone();
            Robot::parse(&toml).ok()?;
            for gait in random_gaits(rng, &base) {
                toml = with_allowed_gait(toml, &gait);
            }
            if rng.bool() {
                toml += &random_rail(rng, &base.pins);
            }
            let robot = Robot::parse(&toml).ok()?;
            let has_moving_gait = robot.gaits().iter().any(|gait| gait.has_movement());
            has_moving_gait.then_some((toml, robot))
        })
        .expect("one of the drafts is a valid robot")
}

/// Returns a robot with as many additional gaits as fit in flash. No space is left for the maps of certified cells. The
/// names of the additional gaits have `name_length` characters and differ only in the last two.
///
/// # Panics
/// If the robot is invalid or has no gait that moves.
pub fn with_many_gaits(toml: &str, name_length: usize) -> Robot {
    let robot = Robot::parse(toml).expect("the text describes a valid robot");
    let gait = robot.gaits().iter().find(|gait| gait.has_movement());
    let gait_name = gait.expect("the robot has a gait that moves").name();
    // Leaves space for one more waveform, which the additional gaits may need.
    let used_bytes = robot.content().section_bytes().len() + size_of::<Wave>();
    let free_bytes = usize::from(REGION_BYTES).saturating_sub(used_bytes);
    let gaits = (0..free_bytes / (size_of::<Gait>() + name_length)).map(|number| {
        let name = format!("{:n<1$}{number:02}", "on-and-o", name_length - 2);
        format!("[gait.{name}]\nlike = \"{gait_name}\"\n")
    });
    Robot::parse(&format!("{toml}{}", gaits.collect::<String>()))
        .expect("copies of a valid gait are valid")
}

/// All properties of a robot except its gaits.
struct RobotBase {
    /// The scale of all lengths; about 1 for a robot of the paper's size.
    scale: f64,
    /// The servos' neutral angles, deg.
    neutral: [f64; 4],
    /// The pins of the four servos, then all other pins.
    pins: [&'static str; PINS.len()],
    lizard: Lizard,
    /// The robot.toml of a robot whose only gait is `stand`.
    toml: String,
}

impl RobotBase {
    /// Returns a random base with a safe neutral pose; `None` if no safe pose was found.
    fn generate(rng: &mut Rng) -> Option<Self> {
        let scale = 0.3 * (4.0f64 / 0.3).powf(rng.f64());
        let mut random_length = |min: f64, max: f64| round(scale * random_between(rng, min, max));
        let chassis = random_length(100.0, 170.0);
        // l0 and l5 bases; l1, l4, l6, l9 cranks; l2, l3, l7, l8 couplers; l10 and
        // l15 chassis; l11, l14, l16, l19 arms; l12, l13, l17, l18 slider halves.
        let mut links: [f64; 20] = std::array::from_fn(|link| match link {
            0 | 5 => random_length(12.0, 36.0),
            1 | 4 | 6 | 9 => random_length(22.0, 38.0),
            2 | 3 | 7 | 8 => random_length(40.0, 66.0),
            10 | 15 => chassis,
            11 | 14 | 16 | 19 => random_length(14.0, 40.0),
            _ => random_length(40.0, 50.0),
        });
        let (ground, leg_length) = (random_length(30.0, 70.0), random_length(30.0, 60.0));
        let mut limits = Limits {
            type2: round_factor(random_between(rng, 0.1, 0.5)),
            type1: round_factor(random_between(rng, 0.0, 0.4)),
            leg: round_factor(random_between(rng, 0.0, 0.5)),
            stroke_min: -round(scale * random_between(rng, 8.0, 30.0)),
            stroke_max: round(scale * random_between(rng, 8.0, 50.0)),
        };
        let mut lizard = Lizard {
            links: Links::from(links),
            leg: Leg {
                ground,
                crank: leg_length,
                coupler: ground,
                follower: leg_length,
            },
        };
        let neutral = random_neutral(rng, &lizard, &limits)?;
        // The sliders' nominal lengths follow from the neutral pose.
        let solution = lizard.solve(&neutral.into()).ok()?;
        for (side, halves) in [(Side::Left, [12, 13]), (Side::Right, [17, 18])] {
            let max_shift = 0.5 * limits.stroke_max.min(-limits.stroke_min);
            let nominal_length = solution.side(side).d + random_between(rng, -max_shift, max_shift);
            let first_fraction = random_between(rng, 0.35, 0.65);
            links[halves[0]] = round(nominal_length * first_fraction);
            links[halves[1]] = round(nominal_length * (1.0 - first_fraction));
            // The shortest length of a slider must be positive.
            limits.stroke_min = limits.stroke_min.max(-round(0.8 * nominal_length));
        }
        lizard.links = Links::from(links);
        let mut pins = PINS;
        rng.shuffle(&mut pins);
        let servos = random_servos(rng, &pins, neutral);
        let mut links_text = String::new();
        for (link, length) in links.iter().enumerate() {
            links_text += &format!("l{link} = {length}\n");
        }
        let toml = format!(
            "[links]\n{links_text}[leg]\nground = {ground}\ncrank = {leg_length}\n\
             coupler = {ground}\nfollower = {leg_length}\n\
             hip_forward = {}\nhip_side = {}\nmount = 7.5\n{servos}\
             [limits]\ntype2 = {}\ntype1 = {}\nleg = {}\nstroke_min = {}\nstroke_max = {}\n\
             slew = {}\ngait_slew = {}\n\
             [ground]\nfriction_back_over_forward = 0.8\n\
             [gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n",
            round(scale * 55.0),
            round(scale * 35.0),
            limits.type2,
            limits.type1,
            limits.leg,
            limits.stroke_min,
            limits.stroke_max,
            random_between(rng, 120.0, 500.0).round(),
            random_between(rng, 150.0, 800.0).round(),
        );
        Some(Self {
            scale,
            neutral,
            pins,
            lizard,
            toml,
        })
    }
}

/// Returns the text of the tables of A1 to A4, with random pulses.
fn random_servos(rng: &mut Rng, pins: &[&str], neutral: [f64; 4]) -> String {
    let mut text = String::new();
    for (servo, name) in SERVO_NAMES.iter().enumerate() {
        let sign = if rng.bool() { 1.0 } else { -1.0 };
        let random_us = |rng: &mut Rng, us: f64| (us + random_between(rng, -60.0, 60.0)).round();
        text += &format!(
            "[servo.{name}]\npin = \"{}\"\nneutral = {}\nneutral_us = {}\nus_per_degree = {}\n\
             min_us = {}\nmax_us = {}\n\n",
            pins[servo],
            neutral[servo],
            random_us(rng, 1500.0),
            sign * round_factor(random_between(rng, 6.0, 14.0)),
            random_us(rng, 600.0),
            random_us(rng, 2400.0),
        );
    }
    text
}

/// Returns the angles of a random neutral pose, deg; `None` if no pose was found. Each crank points 8 to 80 deg forward
/// or backward from its side of the robot. The pose's margins exceed their limits by at least `MIN_RESERVE`; the
/// strokes are not checked.
fn random_neutral(rng: &mut Rng, lizard: &Lizard, limits: &Limits) -> Option<[f64; 4]> {
    /// The smallest allowed distance of a margin from its limit, a sine.
    const MIN_RESERVE: f64 = 0.12;
    (0..200).find_map(|_| {
        let [front_left, front_right, hind_left, hind_right] =
            [(); 4].map(|()| round(random_between(rng, 8.0, 80.0)));
        let neutral = [
            180.0 - front_left,
            front_right,
            360.0 - hind_right,
            180.0 + hind_left,
        ];
        let solution = lizard.solve(&neutral.into()).ok()?;
        let stricter_limits = Limits {
            type2: limits.type2 + MIN_RESERVE,
            type1: limits.type1 + MIN_RESERVE,
            leg: limits.leg + MIN_RESERVE,
            stroke_min: f64::NEG_INFINITY,
            stroke_max: f64::INFINITY,
        };
        stricter_limits.is_safe(&solution).then_some(neutral)
    })
}

/// Returns the text of a measured rail with random thresholds, on an analogue pin that no servo uses.
fn random_rail(rng: &mut Rng, pins: &[&'static str]) -> String {
    let free_pin = pins[4..].iter().find(|pin| pin.starts_with('A'));
    let pin = free_pin.expect("four servos leave at least two of six analogue pins free");
    let ratio = round(random_between(rng, 1.5, 2.2));
    // The highest voltage at the pin is 5 V, the highest supply of the servos 9 V.
    let servo_volts = round((5.0 * ratio).min(9.0));
    let slow = round(ratio * random_between(rng, 2.4, 4.0));
    let stop = round(slow - random_between(rng, 0.15, 0.4));
    let rest = round(stop - random_between(rng, 0.15, 0.4));
    format!(
        "[servo]\nvolts = {servo_volts}\n[supply]\nreference = {}\n[supply.rail]\npin = \"{pin}\"\nratio = {ratio}\n\
         slow = {slow}\nstop = {stop}\nrest = {rest}\n",
        round_factor(random_between(rng, 1.05, 1.15)),
    )
}

/// A function that returns a gait's text for a size between 0 and 1. Some gaits ignore the size.
type SizedGait = Box<dyn Fn(f64) -> String>;

/// Returns random gaits of every kind: waves, held gaits, reversed and mirrored gaits, and paths of head and tail.
fn random_gaits(rng: &mut Rng, base: &RobotBase) -> Vec<SizedGait> {
    let mut gaits = Vec::new();
    let random_period = |rng: &mut Rng| round(random_between(rng, 0.7, 3.0));
    let format_leg_table = |values: [f64; 4]| {
        let format_pair = |(leg, value): (&&str, f64)| format!("{leg} = {value}");
        let pairs: Vec<String> = LEG_NAMES.iter().zip(values).map(format_pair).collect();
        format!("{{ {} }}", pairs.join(", "))
    };
    let mut random_factors = |min: f64, max: f64| -> [f64; 4] {
        std::array::from_fn(|_| round_factor(random_between(rng, min, max)))
    };
    let wave_starts = random_factors(0.0, 1.0);
    let wave_gains = random_factors(0.4, 1.0);
    let held_gains = random_factors(-1.0, 1.0);
    let wave_text = format!(
        "[gait.wander]\nperiod = {}\nwaveform = \"wave\"\nduty = {}\nstart = {}\ngain = {}",
        random_period(rng),
        round_factor(random_between(rng, 0.5, 0.85)),
        format_leg_table(wave_starts),
        format_leg_table(wave_gains),
    );
    let mut order = LEG_NAMES;
    rng.shuffle(&mut order);
    let held_text = format!(
        "[gait.creep-along]\nperiod = {}\nwaveform = \"held\"\norder = {order:?}\ngain = {}",
        random_period(rng),
        format_leg_table(held_gains),
    );
    for gait_text in [wave_text, held_text] {
        gaits.push(Box::new(move |size| {
            format!("{gait_text}\namplitude = {}", round_factor(30.0 * size))
        }) as SizedGait);
    }
    gaits.push(Box::new(|_| "[gait.retreat]\nreverse = \"wander\"".into()));
    gaits.push(Box::new(|_| "[gait.advance]\nreverse = \"retreat\"".into()));
    gaits.push(Box::new(|_| {
        "[gait.other-hand]\nmirror = \"creep-along\"".into()
    }));
    let period = random_period(rng);
    let curve_text = format!("[gait.curve]\nlike = \"wander\"\nperiod = {period}");
    gaits.push(Box::new(move |size| {
        let gains = [size, 1.0, 0.5 * size, -0.5 * size].map(round_factor);
        format!("{curve_text}\ngain = {}", format_leg_table(gains))
    }));
    // A path of head or tail is centred on the end point's position in the neutral pose.
    let Ok(solution) = base.lizard.solve(&base.neutral.into()) else {
        return gaits;
    };
    for (name, end) in [("look", End::Head), ("wag", End::Tail)] {
        let point = solution.end(end).end_point;
        let (period, reach) = (round(random_between(rng, 2.0, 5.0)), 12.0 * base.scale);
        let shift = round_factor(rng.f64());
        gaits.push(Box::new(move |size| {
            format!(
                "[gait.{name}]\nperiod = {period}\n[gait.{name}.{end}]\ncentre = [{}, {}]\n\
                 x = [{{ k = 1, amplitude = {} }}]\ny = [{{ k = 2, amplitude = {}, shift = {shift} }}]",
                round(point.x),
                round(point.y),
                round(reach * size),
                round(0.5 * reach * size)
            )
        }));
    }
    gaits
}

/// Adds a gait to a robot's text, in the largest size that the robot allows. Returns the text unchanged if the gait is
/// rejected in every size.
fn with_allowed_gait(toml: String, gait: &SizedGait) -> String {
    [1.0, 0.6, 0.35, 0.2, 0.1, 0.05]
        .into_iter()
        .map(|size| format!("{toml}{}\n", gait(size)))
        .find(|longer_toml| Robot::parse(longer_toml).is_ok())
        .unwrap_or(toml)
}

fn random_between(rng: &mut Rng, min: f64, max: f64) -> f64 {
    min + (max - min) * rng.f64()
}

/// Rounds a length or an angle to the two decimals of a hand-written file.
fn round(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// Rounds a factor to the four decimals of a hand-written file.
fn round_factor(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_robots_move_and_have_distinct_lengths_and_limits() {
        let mut rng = Rng::with_seed(1);
        let mut gait_count = 0;
        for _ in 0..20 {
            let (toml, robot) = random_robot(&mut rng);
            let links = robot.lizard().links;
            let pairs = [
                (links.l0, links.l5),
                (links.l1, links.l4),
                (links.l2, links.l3),
                (links.l6, links.l9),
                (links.l7, links.l8),
                (links.l11, links.l14),
                (links.l16, links.l19),
                (robot.limits().type1, robot.limits().leg),
                (robot.limits().type1, robot.limits().type2),
            ];
            let are_distinct = pairs.iter().all(|(first, second)| first != second);
            assert!(are_distinct, "{toml}");
            gait_count += robot.gaits().len();
        }
        println!("{gait_count} gaits of 20 robots");
        assert!(gait_count > 20 * 6);
    }
}
