//! The robot's measurements in robot.toml, and what each of them may be.

use lizard_core::five_bar::SHORTEST_COUPLER;
use lizard_kinematics::{End, Leg, Limits, Links, Lizard, Side};

use crate::drive::Drive;
use crate::error::{Checked, Problem};
use crate::feet::{Body, Feet};
use crate::ground::{DEFAULT_FRICTION, Ground};
use crate::hips::Hips;
use crate::legs::LegPlan;
use crate::parts::Parts;
use crate::reader::Section;
use crate::scale::{self, LONGEST_BAR};
use crate::servo::{LEGS, NAMES, Pace, Servo, pin};
use crate::stance::Stance;
use crate::supply::Supplies;

/// Lengths of a robot that hobby servos move, mm.
const LENGTHS: (f64, f64) = (1.0, LONGEST_BAR);
/// Widths that a hobby servo tolerates, us; within a 4 ms slot.
const WIDTHS: (f64, f64) = (500.0, 2500.0);
/// 22 us per degree is the most that the firmware's i16 gain holds.
const GAINS: (f64, f64) = (1.0, 22.0);

/// Slower than this and a move outlasts the firmware's count of its frames.
const SLOWEST: f64 = 10.0;

/// Where what drives the legs was said before it had a table of its own.
const SPRING: &str = "[leg.drive] with kind = \"spring\", stiffness and preload, or with kind = \"strut\" and the force and rate of its spring";

const LINKS: [&str; 20] = [
    "l0", "l1", "l2", "l3", "l4", "l5", "l6", "l7", "l8", "l9", "l10", "l11", "l12", "l13", "l14",
    "l15", "l16", "l17", "l18", "l19",
];

/// All of robot.toml but the gaits.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Measures {
    pub lizard: Lizard,
    /// A1, A2, A3, A4.
    pub servos: [Servo; 4],
    pub limits: Limits,
    pub pace: Pace,
    pub ground: Ground,
    pub supplies: Supplies,
    pub parts: Parts,
    /// In servo order.
    pub legs: [LegPlan; 4],
}

impl Measures {
    /// Reads and checks the measurements; the neutral pose of what it returns is
    /// safe.
    pub fn read(root: &Section) -> Checked<Self> {
        let links = links(root)?;
        let (leg, hips, mount) = leg(root)?;
        let servos = servos(root)?;
        let (limits, pace) = limits(root)?;
        let parts = Parts::read(root)?;
        let lizard = Lizard { links, leg };
        let feet = hips.feet(&lizard, &parts, mount)?;
        let neutral = servos.map(|servo| servo.neutral);
        let legs = std::array::from_fn(|servo| {
            LegPlan::new(servo, neutral[servo], &lizard, &parts, &feet)
        });
        let drive = Drive::read(&root.open("leg")?, &legs, neutral, &parts)?;
        let measures = Self {
            servos,
            limits,
            pace,
            ground: ground(root, feet, drive)?,
            supplies: Supplies::read(root, &servos)?,
            legs,
            lizard,
            parts,
        };
        measures.fits()?;
        measures.stands()?;
        Ok(measures)
    }

    /// The servos' neutral angles, deg, chassis frame, servo order.
    pub fn neutral(&self) -> [f64; 4] {
        self.servos.map(|servo| servo.neutral)
    }

    /// What the firmware's 16-bit integers ask of the lengths: couplers that are not
    /// short compared with the rest of their loop, and a stroke that leaves the slider a
    /// length.
    fn fits(&self) -> Checked<()> {
        for (end, names) in [
            (End::Head, ["links.l2", "links.l3"]),
            (End::Tail, ["links.l7", "links.l8"]),
        ] {
            let bars = self.lizard.end(end);
            let per_mm = scale::steps_per_mm(scale::of_loop(&bars));
            let least = f64::from(SHORTEST_COUPLER) / per_mm;
            // As the sentence shows it: what it asks for must do.
            let shown = (10.0 * least).ceil() / 10.0;
            for (key, value) in names
                .into_iter()
                .zip([bars.coupler_left, bars.coupler_right])
            {
                if value < least {
                    let least = shown;
                    return Err(Problem::ShortCoupler { value, least }.at(key));
                }
            }
        }
        let nominal = Side::ALL.map(|side| self.lizard.side(side).nominal);
        let shortest = nominal[0].min(nominal[1]);
        for (key, value) in [
            ("limits.stroke_min", self.limits.stroke_min),
            ("limits.stroke_max", self.limits.stroke_max),
        ] {
            let (min, max) = (-shortest, LONGEST_BAR);
            if !(min..=max).contains(&value) {
                return Err(Problem::Range {
                    value,
                    min,
                    max,
                    unit: "mm, so that the slider keeps a length",
                }
                .at(key));
            }
        }
        Ok(())
    }

    /// Refuses a robot that could not even stand.
    fn stands(&self) -> Checked<()> {
        let fault = |text: String| Err(Problem::Neutral(text).at("servo"));
        match self.lizard.solve(&self.neutral().into()) {
            Err(infeasible) => fault(infeasible.to_string()),
            Ok(solution) => match self.limits.violations(&solution).next() {
                Some(violation) => fault(violation.to_string()),
                None => Ok(()),
            },
        }
    }
}

/// The links of the body.
fn links(root: &Section) -> Checked<Links> {
    let section = root.section("links", &LINKS)?;
    let mut lengths = [0.0; 20];
    for (length, name) in lengths.iter_mut().zip(LINKS) {
        *length = section.number(name, LENGTHS.0, LENGTHS.1, "mm")?;
    }
    let l = Links::from(lengths);
    equal(
        "links.l15",
        l.l15,
        "links.l10",
        l.l10,
        "the chassis is a rectangle, so its two sides are equally long",
    )?;
    Ok(l)
}

/// The legs: their links, their hips, and their sweep at neutral in deg.
fn leg(root: &Section) -> Checked<(Leg, Hips, f64)> {
    let keys = [
        "ground",
        "crank",
        "coupler",
        "follower",
        "hip_forward",
        "hip_side",
        "mount",
        "drive",
    ];
    let section = root.open("leg")?;
    section.moved(&["spring", "preload"], SPRING)?;
    let section = section.only(&keys)?;
    let bar = |name| section.number(name, LENGTHS.0, LENGTHS.1, "mm");
    let leg = Leg {
        ground: bar("ground")?,
        crank: bar("crank")?,
        coupler: bar("coupler")?,
        follower: bar("follower")?,
    };
    let parallelogram = "a leg is a parallelogram, so its opposite links are equally long";
    equal(
        "leg.coupler",
        leg.coupler,
        "leg.ground",
        leg.ground,
        parallelogram,
    )?;
    equal(
        "leg.follower",
        leg.follower,
        "leg.crank",
        leg.crank,
        parallelogram,
    )?;
    let hips = Hips::read(&section)?;
    let mount = section.number("mount", -90.0, 90.0, "deg")?;
    Ok((leg, hips, mount))
}

/// What stands on the feet. A mass centre that leaves a foot in the air at neutral is
/// refused.
fn body(root: &Section, feet: &Feet) -> Checked<Body> {
    if !root.has("body") {
        return Ok(Body::DEFAULT);
    }
    let section = root.section("body", &["mass", "centre"])?;
    let mass = section.number_or("mass", Body::DEFAULT.mass, 10.0, 10_000.0, "g")?;
    let centre = match section.has("centre") {
        true => section.pair("centre", -500.0, 500.0, "mm")?,
        false => Body::DEFAULT.centre,
    };
    let body = Body { mass, centre };
    let loads = Stance::LEVEL.loads(&body, feet.at([0.0; 4]));
    match loads.iter().position(|load| *load <= 0.0) {
        Some(foot) => Err(Problem::InTheAir(LEGS[foot]).at(section.path("centre"))),
        None => Ok(body),
    }
}

/// The four servos.
fn servos(root: &Section) -> Checked<[Servo; 4]> {
    let section = root.section("servo", &NAMES)?;
    let mut servos = Vec::with_capacity(4);
    for name in NAMES {
        let one = section.section(
            name,
            &[
                "pin",
                "neutral",
                "neutral_us",
                "us_per_degree",
                "min_us",
                "max_us",
            ],
        )?;
        let servo = servo(&one)?;
        if let Some(other) = servos
            .iter()
            .position(|earlier: &Servo| earlier.pin == servo.pin)
        {
            let problem = Problem::PinTwice {
                pin: one.text("pin")?.to_string(),
                other: NAMES[other],
            };
            return Err(problem.at(one.path("pin")));
        }
        servos.push(servo);
    }
    Ok([servos[0], servos[1], servos[2], servos[3]])
}

fn servo(section: &Section) -> Checked<Servo> {
    let width = |name| section.number(name, WIDTHS.0, WIDTHS.1, "us");
    let text = section.text("pin")?;
    let pin = pin(text).ok_or_else(|| Problem::Pin(text.to_string()).at(section.path("pin")))?;
    let us_per_degree = section.number("us_per_degree", -f64::MAX, f64::MAX, "us")?;
    if !(GAINS.0..=GAINS.1).contains(&us_per_degree.abs()) {
        return Err(Problem::Gain(us_per_degree).at(section.path("us_per_degree")));
    }
    let servo = Servo {
        pin,
        neutral: section.number("neutral", 0.0, 360.0, "deg")?,
        neutral_us: width("neutral_us")?,
        us_per_degree,
        min_us: width("min_us")?,
        max_us: width("max_us")?,
    };
    section.less("min_us", servo.min_us, "neutral_us", servo.neutral_us)?;
    section.less("neutral_us", servo.neutral_us, "max_us", servo.max_us)?;
    Ok(servo)
}

/// What a pose must keep clear of, and how fast a servo may turn.
fn limits(root: &Section) -> Checked<(Limits, Pace)> {
    let section = root.section(
        "limits",
        &[
            "type2",
            "type1",
            "leg",
            "stroke_min",
            "stroke_max",
            "slew",
            "gait_slew",
        ],
    )?;
    let limits = Limits {
        // Below .1 the core's tables of the couplers end.
        type2: section.number("type2", 0.1, 0.95, "(a sine)")?,
        type1: section.number("type1", 0.0, 0.95, "(a sine)")?,
        leg: section.number("leg", 0.0, 0.95, "(a sine)")?,
        stroke_min: section.number("stroke_min", -LONGEST_BAR, LONGEST_BAR, "mm")?,
        stroke_max: section.number("stroke_max", -LONGEST_BAR, LONGEST_BAR, "mm")?,
    };
    section.less(
        "stroke_min",
        limits.stroke_min,
        "stroke_max",
        limits.stroke_max,
    )?;
    let speed = |name| section.number(name, SLOWEST, 1000.0, "deg/s");
    Ok((
        limits,
        Pace {
            slew: speed("slew")?,
            gait_slew: speed("gait_slew")?,
        },
    ))
}

/// The contact model.
fn ground(root: &Section, feet: Feet, drive: Drive) -> Checked<Ground> {
    const RATIO: &str = "friction_back_over_forward";
    let section = root.section("ground", &[RATIO, "friction"])?;
    Ok(Ground {
        feet,
        body: body(root, &feet)?,
        stance: Stance::read(root)?,
        friction: section.number_or("friction", DEFAULT_FRICTION, 0.05, 5.0, "(a coefficient)")?,
        ratio: section.number(RATIO, 0.1, 10.0, "(a ratio)")?,
        drive,
    })
}

fn equal(
    key: &str,
    value: f64,
    other: &'static str,
    other_value: f64,
    why: &'static str,
) -> Checked<()> {
    if value == other_value {
        Ok(())
    } else {
        Err(Problem::Unequal {
            value,
            other,
            other_value,
            why,
        }
        .at(key))
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::with;

    fn refused(changes: &[(&str, &str)]) -> String {
        with("unequal", changes).expect_err("refused").to_string()
    }

    #[test]
    fn each_coupler_must_be_long_enough_for_its_own_loop() {
        // The head's bars and the tail's longer couplers are counted in 1/256 mm.
        for (from, to) in [
            ("l2 = 55.0", "l2 = 15.9"),
            ("l3 = 48.0", "l3 = 15.9"),
            ("l7 = 55.0", "l7 = 15.9"),
            ("l8 = 48.0", "l8 = 15.9"),
        ] {
            let refused = refused(&[(from, to)]);
            let key = from.split(' ').next().expect("a key");
            assert!(
                refused.contains(&format!("links.{key} is 15.9 mm, which is short"))
                    && refused.contains("at least 16.1 mm"),
                "{refused}"
            );
        }
        // A base twice as long halves the steps, for its own end alone.
        let long = refused(&[("l5 = 30.0", "l5 = 90.0"), ("l7 = 55.0", "l7 = 31.0")]);
        assert!(
            long.contains("links.l7 is 31 mm") && long.contains("at least 32.1 mm"),
            "{long}"
        );
    }

    #[test]
    fn the_neutral_pulse_of_every_servo_lies_within_its_own_pulses() {
        for name in ["A1", "A2", "A3", "A4"] {
            let text = crate::testing::text("unequal");
            let begin = text.find(&format!("[servo.{name}]")).expect(name);
            let line = |key: &str| {
                let from = begin + text[begin..].find(key).expect(key);
                let to = from + text[from..].find('\n').expect("a line's end");
                from..to
            };
            let us = |key: &str| -> f64 {
                let line = &text[line(key)];
                let value = line.split(" = ").nth(1).expect("a value");
                value.parse().expect("a number")
            };
            for (neutral, refused) in [
                (us("min_us") - 0.1, "min_us"),
                (us("min_us"), "min_us"),
                (us("max_us"), "neutral_us"),
                (us("max_us") + 0.1, "neutral_us"),
            ] {
                let mut changed = text.clone();
                changed.replace_range(line("neutral_us"), &format!("neutral_us = {neutral}"));
                let error = crate::Robot::parse(&changed)
                    .expect_err("outside")
                    .to_string();
                assert!(
                    error.contains(&format!("servo.{name}.{refused}")),
                    "{error}"
                );
            }
        }
    }

    #[test]
    fn a_stroke_leaves_the_shorter_slider_a_length() {
        for slider in [["l12 = 53.0", "l13 = 51.0"], ["l17 = 54.0", "l18 = 57.0"]] {
            let changes = [
                (slider[0], &*slider[0].replace(" 5", " 4")),
                ("stroke_min = -19.0", "stroke_min = -102.0"),
            ];
            let refused = refused(&changes);
            assert!(
                refused.contains("limits.stroke_min is -102; it must be within"),
                "{refused}"
            );
        }
    }

    #[test]
    fn each_leg_must_stand_on_the_side_where_it_was_assembled() {
        for (from, to, leg) in [
            ("neutral = 135.0", "neutral = 200.0", "leg_lf"),
            ("neutral = 47.0", "neutral = 350.0", "leg_rf"),
            ("neutral = 316.0", "neutral = 10.0", "leg_rh"),
            ("neutral = 228.0", "neutral = 170.0", "leg_lh"),
        ] {
            let refused = refused(&[(from, to)]);
            assert!(
                refused.contains(&format!(
                    "servo: the neutral pose is not safe: margin {leg} -"
                )),
                "{refused}"
            );
        }
    }
}
