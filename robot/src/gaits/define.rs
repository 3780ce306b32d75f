//! Gait definitions in robot.toml: each has a waveform, a path, or another gait from
//! which it is derived.

use std::collections::HashMap;

use lizard_core::gait::{LONGEST_NAME, MOST_GAITS};
use lizard_core::settings::key;
use lizard_core::word::Word;
use lizard_kinematics::End;

use crate::file::{Checked, Hint, Problem, Section};
use crate::gaits::gait::{Gait, Stride};
use crate::gaits::harmonic::Harmonic;
use crate::gaits::path::Path;
use crate::gaits::path_leg::PathLeg;
use crate::gaits::waveform::Waveform;
use crate::measures::Measures;
use crate::measures::servo::LEGS;

const KEYS: [&str; 12] = [
    "period",
    "waveform",
    "duty",
    "amplitude",
    "start",
    "order",
    "gain",
    "reverse",
    "mirror",
    "like",
    "head",
    "tail",
];
const WAVEFORMS: [&str; 3] = ["still", "wave", "held"];
const REFERENCES: [&str; 3] = ["reverse", "mirror", "like"];

/// Every gait of the file, in its order, references resolved.
pub(crate) fn gaits(root: &Section, body: &Measures) -> Checked<Vec<Gait>> {
    let section = root.open("gait")?;
    let names = section.names();
    for name in &names {
        check_name(name).map_err(|problem| problem.at(section.path(name)))?;
    }
    if names.len() > MOST_GAITS {
        return Err(Problem::Many {
            found: names.len(),
            most: MOST_GAITS,
        }
        .at("gait"));
    }
    check_keys(&section, &names)?;
    if names.first() != Some(&"stand") {
        return Err(Problem::Stand.at("gait"));
    }
    let mut resolver = Resolver {
        section,
        names,
        body,
        known: HashMap::new(),
        chain: Vec::new(),
    };
    let gaits = resolver
        .names
        .clone()
        .into_iter()
        .map(|name| resolver.resolve(name))
        .collect::<Checked<Vec<_>>>()?;
    let still = |stride: &Stride| stride.waveform == Waveform::Still;
    if gaits[0].strides.iter().all(still) {
        Ok(gaits)
    } else {
        Err(Problem::Moving.at("gait.stand"))
    }
}

/// The memory keeps the gait of `boot` by a number made of its name.
fn check_keys(section: &Section, names: &[&str]) -> Checked<()> {
    let mut known = HashMap::new();
    for name in names {
        let written = name
            .bytes()
            .map(|byte| if byte == b'-' { b' ' } else { byte });
        if let Some(other) = known.insert(key(written), *name) {
            return Err(Problem::SameKey(other.to_string()).at(section.path(name)));
        }
    }
    Ok(())
}

fn check_name(name: &str) -> Result<(), Problem> {
    let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if !name.chars().all(letters) || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
        return Err(Problem::Name(
            "it must be lower-case letters, digits and dashes, a letter first",
        ));
    }
    if name.len() > LONGEST_NAME {
        return Err(Problem::LongName {
            length: name.len(),
            most: LONGEST_NAME,
        });
    }
    if name.ends_with('-') || name.contains("--") {
        return Err(Problem::Name("a dash stands for a blank between two words"));
    }
    let word = name.split('-').next().unwrap_or(name);
    if Word::find(word.as_bytes()).is_some() {
        return Err(Problem::Command(word.to_string()));
    }
    Ok(())
}

struct Resolver<'a> {
    section: Section<'a>,
    names: Vec<&'a str>,
    body: &'a Measures,
    known: HashMap<&'a str, Gait>,
    /// The gaits that wait for the one being resolved.
    chain: Vec<&'a str>,
}

impl<'a> Resolver<'a> {
    fn resolve(&mut self, name: &'a str) -> Checked<Gait> {
        if let Some(gait) = self.known.get(name) {
            return Ok(gait.clone());
        }
        self.chain.push(name);
        let one = self.section.section(name, &KEYS)?;
        let gait = match manner(&one)? {
            "waveform" => waveform(name, &one, self.body)?,
            "head or tail" => path(name, &one, self.body)?,
            reference => self.derived(name, &one, reference)?,
        };
        self.chain.pop();
        self.known.insert(name, gait.clone());
        Ok(gait)
    }

    /// A gait that starts from another.
    fn derived(
        &mut self,
        name: &'a str,
        one: &Section<'a>,
        reference: &'static str,
    ) -> Checked<Gait> {
        only(one, &[reference, "period", "gain"], reference)?;
        let key = one.path(reference);
        let base = one.text(reference)?;
        if !self.names.contains(&base) {
            let hint = Hint::new(base, &self.names);
            return Err(Problem::NoSuchGait {
                name: base.to_string(),
                hint,
            }
            .at(key));
        }
        if self.chain.contains(&base) {
            let circle = [self.chain.as_slice(), &[base]].concat().join(" -> ");
            return Err(Problem::Circle(circle).at(key));
        }
        let mut gait = self.resolve(base)?;
        match reference {
            "reverse" => gait.reversed = !gait.reversed,
            "mirror" => gait = gait.mirrored(),
            _ => {}
        }
        gait.name = name.to_string();
        gait.period = period(one, Some(gait.period))?;
        Ok(gait.scaled(gains(one)?))
    }
}

/// Which of the ways to give a gait this one uses.
fn manner(one: &Section) -> Checked<&'static str> {
    let path = one.has("head") || one.has("tail");
    let mut ways: Vec<&'static str> = REFERENCES.into_iter().filter(|key| one.has(key)).collect();
    ways.extend(one.has("waveform").then_some("waveform"));
    ways.extend(path.then_some("head or tail"));
    match ways.as_slice() {
        [way] => Ok(way),
        _ => Err(
            Problem::OneOf("waveform, a path (head, tail), reverse, mirror, like")
                .at(one.key.clone()),
        ),
    }
}

/// Refuses keys that mean nothing together with `with`.
fn only(one: &Section, allowed: &[&str], with: &str) -> Checked<()> {
    match one.names().into_iter().find(|name| !allowed.contains(name)) {
        Some(name) => Err(Problem::Conflict(with.to_string()).at(one.path(name))),
        None => Ok(()),
    }
}

fn waveform(name: &str, one: &Section, body: &Measures) -> Checked<Gait> {
    let word = one.text("waveform")?;
    let with = format!("waveform = \"{word}\"");
    let strides = match word {
        "still" => {
            only(one, &["waveform", "period"], &with)?;
            [Stride::STILL; 4]
        }
        "wave" => {
            only(
                one,
                &["waveform", "period", "duty", "amplitude", "start", "gain"],
                &with,
            )?;
            let waveform = Waveform::Wave {
                duty: one.number("duty", 0.05, 0.95, "of the cycle")?,
            };
            let amplitude = amplitude(one)?;
            let starts = legs(
                &one.section("start", &LEGS)?,
                None,
                0.0,
                1.0,
                "of the cycle",
            )?;
            starts.map(|start| Stride {
                waveform: waveform.clone(),
                start,
                amplitude,
            })
        }
        "held" => {
            only(
                one,
                &["waveform", "period", "amplitude", "order", "gain"],
                &with,
            )?;
            let amplitude = amplitude(one)?;
            order(one)?.map(|turn| Stride {
                waveform: Waveform::Held { turn },
                start: 0.0,
                amplitude,
            })
        }
        word => {
            let hint = Hint::new(word, &WAVEFORMS);
            return Err(Problem::Word {
                word: word.to_string(),
                hint,
            }
            .at(one.path("waveform")));
        }
    };
    finish(name, one, body, strides)
}

fn path(name: &str, one: &Section, body: &Measures) -> Checked<Gait> {
    only(one, &["period", "head", "tail", "gain"], "a path")?;
    let mut strides = [Stride::STILL; 4];
    for end in End::ALL {
        if !one.has(end.name()) {
            continue;
        }
        let section = one.section(end.name(), &["centre", "x", "y"])?;
        let path = Path {
            centre: section.pair("centre", -255.0, 255.0, "mm")?,
            x: harmonics(&section, "x")?,
            y: harmonics(&section, "y")?,
        };
        let legs = PathLeg::pair(body.lizard, body.neutral(), end, &path)
            .map_err(|problem| problem.at(section.key.clone()))?;
        for (servo, leg) in legs {
            strides[servo] = Stride {
                waveform: Waveform::Path(Box::new(leg)),
                start: 0.0,
                amplitude: 1.0,
            };
        }
    }
    finish(name, one, body, strides)
}

fn finish(name: &str, one: &Section, body: &Measures, strides: [Stride; 4]) -> Checked<Gait> {
    let gait = Gait {
        name: name.to_string(),
        period: period(one, None)?,
        reversed: false,
        strides,
        neutral: body.neutral(),
    };
    Ok(gait.scaled(gains(one)?))
}

fn period(one: &Section, default: Option<f64>) -> Checked<f64> {
    match default {
        Some(period) => one.number_or("period", period, 0.2, 60.0, "s"),
        None => one.number("period", 0.2, 60.0, "s"),
    }
}

fn amplitude(one: &Section) -> Checked<f64> {
    one.number("amplitude", 0.0, 90.0, "deg")
}

fn gains(one: &Section) -> Checked<[f64; 4]> {
    if !one.has("gain") {
        return Ok([1.0; 4]);
    }
    legs(
        &one.section("gain", &LEGS)?,
        Some(1.0),
        -4.0,
        4.0,
        "(a factor)",
    )
}

/// A number for each leg, in servo order.
fn legs(
    section: &Section,
    default: Option<f64>,
    min: f64,
    max: f64,
    unit: &'static str,
) -> Checked<[f64; 4]> {
    let mut values = [0.0; 4];
    for (value, leg) in values.iter_mut().zip(LEGS) {
        *value = match default {
            Some(default) => section.number_or(leg, default, min, max, unit)?,
            None => section.number(leg, min, max, unit)?,
        };
    }
    Ok(values)
}

/// Each leg's place in the order of swings, in servo order.
fn order(one: &Section) -> Checked<[usize; 4]> {
    let words = one.words("order")?;
    let fault = || Problem::Order.at(one.path("order"));
    if words.len() != LEGS.len() {
        return Err(fault());
    }
    let mut turns = [0; 4];
    for (turn, leg) in turns.iter_mut().zip(LEGS) {
        *turn = words
            .iter()
            .position(|word| *word == leg)
            .ok_or_else(fault)?;
    }
    Ok(turns)
}

fn harmonics(section: &Section, name: &str) -> Checked<Vec<Harmonic>> {
    let terms = section.list(name, &["k", "amplitude", "shift"])?;
    let term = |term: Section| {
        let k = term.number("k", 1.0, 16.0, "periods in a cycle")?;
        if k.fract() != 0.0 {
            return Err(Problem::Type {
                found: k.to_string(),
                expected: "a whole number",
            }
            .at(term.path("k")));
        }
        Ok(Harmonic {
            k,
            amplitude: term.number("amplitude", -255.0, 255.0, "mm")?,
            shift: term.number_or("shift", 0.0, -1.0, 1.0, "of its period")?,
        })
    };
    terms.into_iter().map(term).collect()
}

#[cfg(test)]
mod tests {
    use crate::testing::{body, robot};
    use crate::{Error, Robot};

    fn paper_with_gaits(gaits: &str) -> Result<Robot, Error> {
        Robot::parse(&format!("{}{gaits}", body("paper")))
    }

    const STAND: &str = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";
    const WALK: &str = "[gait.walk]\nperiod = 1.0\nwaveform = \"wave\"\nduty = 0.75\namplitude = 10.0\nstart = { LH = 0.0, LF = 0.25, RH = 0.5, RF = 0.75 }\n";

    #[test]
    fn a_gait_reversed_twice_goes_forward() {
        let robot = robot("own-gaits");
        let reversed = |name| robot.gait(name).expect(name).is_reversed();
        assert_eq!(
            [
                "stroll",
                "stroll-back",
                "stroll-on",
                "veer-right",
                "veer-right-back",
                "veer-left-back"
            ]
            .map(reversed),
            [false, true, false, false, true, true]
        );
        let on = robot.gait("stroll-on").expect("stroll-on");
        assert_eq!((on.phase(0.6), on.period()), (0.25, 2.4));
        let back = robot.gait("stroll-back").expect("stroll-back");
        assert_eq!((back.phase(0.4), back.period()), (0.75, 1.6));
    }

    #[test]
    fn a_mirror_exchanges_the_legs_and_its_gains_count_after_it() {
        let robot = robot("own-gaits");
        let strides = |name| {
            let strides = robot.gait(name).expect(name).strides();
            strides.each_ref().map(|s| (s.amplitude, s.start))
        };
        assert_eq!(
            strides("stroll"),
            [(12.5, 0.0), (12.5, 0.5), (12.5, 0.25), (12.5, 0.75)]
        );
        assert_eq!(
            strides("veer-left"),
            [(3.75, 0.0), (12.5, 0.5), (12.5, 0.25), (3.75, 0.75)]
        );
        assert_eq!(
            strides("veer-right"),
            [(12.5, 0.5), (3.75, 0.0), (3.75, 0.75), (12.5, 0.25)]
        );
        assert_eq!(
            strides("veer-left-back"),
            [(3.75, 0.0), (15.0, 0.5), (12.5, 0.25), (3.75, 0.75)]
        );
    }

    #[test]
    fn an_order_gives_each_leg_its_turn() {
        let robot = robot("own-gaits");
        let creep = robot.gait("creep").expect("creep");
        // RF, LH, LF, RH, each in a fifth after the first, in which all hold back.
        for (leg, fifth) in [(1, 1), (3, 2), (0, 3), (2, 4)] {
            let sweeps = |phase: f64| creep.sweeps(phase)[leg];
            assert!((sweeps(0.2 * f64::from(fifth)) + 17.5).abs() < 1e-9);
            assert!((sweeps(0.2 * f64::from(fifth + 1)) - 17.5).abs() < 1e-9);
        }
    }

    #[test]
    fn a_path_leads_the_end_that_it_names_and_leaves_the_other() {
        let robot = robot("own-gaits");
        let neutral: [f64; 4] = robot.neutral().into();
        let wag = robot.gait("wag").expect("wag");
        let nod = robot.gait("nod").expect("nod");
        for i in 0..64 {
            let phase = f64::from(i) / 64.0;
            let turn = std::f64::consts::TAU * phase;
            let solved = robot.lizard().solve(&wag.pose(phase)).expect("closes");
            let tail = solved.tail.end_point;
            let (x, y) = (
                9.0 * turn.sin(),
                54.0 + 3.0 * (2.0 * turn + 0.5 * std::f64::consts::PI).sin(),
            );
            assert!((tail.x - x).hypot(tail.y - y) < 1e-9, "{tail:?}");
            assert_eq!(wag.angles(phase)[..2], neutral[..2]);
            let solved = robot.lizard().solve(&nod.pose(phase)).expect("closes");
            let head = solved.head.end_point;
            let (x, y) = (4.0 + 2.0 * turn.sin(), 56.0 + 5.0 * turn.sin());
            assert!((head.x - x).hypot(head.y - y) < 1e-9, "{head:?}");
            assert_eq!(nod.angles(phase)[2..], neutral[2..]);
        }
    }

    #[test]
    fn a_path_out_of_reach_is_refused_at_either_end_and_to_either_side() {
        let path = |end: &str, centre: &str| {
            let gaits = format!(
                "{STAND}[gait.point]\nperiod = 4.0\n[gait.point.{end}]\ncentre = {centre}\n"
            );
            paper_with_gaits(&gaits).expect_err(&gaits).to_string()
        };
        for end in ["head", "tail"] {
            for (centre, point) in [
                ("[45.0, 60.0]", "(45.00, 60.00)"),
                ("[-45.0, 60.0]", "(-45.00, 60.00)"),
                ("[0.0, 82.0]", "(0.00, 82.00)"),
            ] {
                let refused = path(end, centre);
                let expected = format!(
                    "gait.point.{end}: the point {point} mm at phase 0.0000 is out of reach of the {end}"
                );
                assert!(refused.ends_with(&expected), "{refused}");
            }
        }
    }

    #[test]
    fn a_name_may_have_48_characters() {
        let name = |length: usize| format!("{STAND}{}", WALK.replace("walk", &"w".repeat(length)));
        let longest = paper_with_gaits(&name(48)).expect("48 characters");
        assert_eq!(longest.gaits()[1].name().len(), 48);
        let longer = paper_with_gaits(&name(49)).expect_err("49").to_string();
        assert!(
            longer.contains("has 49 characters") && longer.ends_with("so it may have 48"),
            "{longer}"
        );
    }

    /// The error of a robot that has too many bytes of gaits.
    const LEAVE_OUT: &str = "leave out gaits, first those whose waveform no other has";

    #[test]
    fn a_robot_may_have_as_many_gaits_as_its_section_has_room_for() {
        let gaits = |count: usize| {
            let like = |i| format!("[gait.walk{i}]\nlike = \"walk\"\n");
            let more: String = (2..count).map(like).collect();
            format!("{STAND}{WALK}{more}")
        };
        let many = paper_with_gaits(&gaits(100)).expect("100 gaits");
        assert_eq!(many.gaits().len(), 100);
        assert_eq!(many.gait("walk99").map(|gait| gait.index()), Some(99));
        assert_eq!(
            many.gait("walk99").map(|gait| gait.table_sweeps(99)),
            many.gait("walk").map(|gait| gait.table_sweeps(99))
        );
        // Also where there is no room for its maps of cells.
        for count in 100..255 {
            match paper_with_gaits(&gaits(count)) {
                Ok(robot) => {
                    assert!(robot.section().len() <= usize::from(lizard_core::section::SPACE))
                }
                Err(error) => {
                    assert!(count > 110, "{count}");
                    assert!(error.to_string().ends_with(LEAVE_OUT), "{error}");
                    break;
                }
            }
        }
        let most = paper_with_gaits(&gaits(255)).expect_err("255").to_string();
        assert!(most.ends_with(LEAVE_OUT), "{most}");
        let more = paper_with_gaits(&gaits(256)).expect_err("256").to_string();
        assert!(
            more.ends_with(
                "gait holds 256 gaits; the firmware numbers them with a byte, so leave at most 255"
            ),
            "{more}"
        );
    }

    #[test]
    fn waveforms_are_refused_that_the_section_has_no_room_for() {
        // Walking takes one, and each nod on a line of its own two.
        let gaits = |count: usize| {
            let nod = |i: usize| {
                let x = 0.03 * (i as f64 + 1.0);
                format!(
                    "[gait.nod{i}]\nperiod = 4.0\n[gait.nod{i}.head]\ncentre = [{x:.2}, 55.0]\nx = [{{ k = 1, amplitude = 3.0 }}]\ny = [{{ k = 2, amplitude = {x:.2}, shift = 0.1 }}]\n"
                )
            };
            let more: String = (0..count).map(nod).collect();
            format!("{STAND}{WALK}{more}")
        };
        let some = paper_with_gaits(&gaits(6)).expect("13 waveforms");
        assert_eq!(some.firmware().waves().len(), 13);
        for count in [10, 127] {
            let most = paper_with_gaits(&gaits(count))
                .expect_err("too many")
                .to_string();
            assert!(most.ends_with(LEAVE_OUT), "{most}");
        }
        let more = paper_with_gaits(&gaits(128)).expect_err("257").to_string();
        assert!(more.contains("gait.nod127 needs one waveform too many: the firmware numbers them with a byte, so gaits may share 255"), "{more}");
    }
}
