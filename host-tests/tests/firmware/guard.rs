//! The guard on the chip: what it refuses, and that no frame gets past it.

use fastrand::Rng;
use lizard_host::sim::analysis::instants;
use lizard_host_tests::robot;
use lizard_kinematics::{Limits, Pose, Solution};
use simulated_uno::Fidelity;

use crate::{SECOND, Status, awake, for_each};

/// The guard may differ from floating point by this much, margin and mm, for
/// lengths of 1/256 mm and sines of 1/32768.
const MARGIN: f64 = 0.002;
const STROKE: f64 = 0.05;

/// The limits, stricter by the guard's tolerance (`by` = 1) or laxer (-1).
fn limits(by: f64) -> Limits {
    let limits = robot().limits();
    Limits {
        type2: limits.type2 + by * MARGIN,
        type1: limits.type1 + by * MARGIN,
        leg: limits.leg + by * MARGIN,
        stroke_min: limits.stroke_min + by * STROKE,
        stroke_max: limits.stroke_max - by * STROKE,
    }
}

/// Whether a pose (deg, chassis frame) is safe by these limits.
fn is_safe(angles: [f64; 4], limits: &Limits) -> bool {
    let solved = robot().lizard().solve(&Pose::from(angles));
    solved.is_ok_and(|solution| limits.allow(&solution))
}

/// A pose within so many degrees of neutral, as it is typed.
fn wish(rng: &mut Rng, within: f64) -> [f64; 4] {
    std::array::from_fn(|i| {
        let angle = robot().servos()[i].neutral + within * (2.0 * rng.f64() - 1.0);
        (angle.rem_euclid(360.0) * 100.0).round() / 100.0
    })
}

/// A safe pose far from neutral, so that the way there may not be safe.
fn far(rng: &mut Rng) -> [f64; 4] {
    loop {
        let angles = wish(rng, 80.0);
        if is_safe(angles, &limits(1.0)) {
            return angles;
        }
    }
}

fn typed(angles: [f64; 4]) -> String {
    let [a1, a2, a3, a4] = angles;
    format!("pose {a1} {a2} {a3} {a4}")
}

#[test]
fn a_pose_is_accepted_exactly_where_floating_point_finds_it_safe() {
    for_each(&[20.0, 40.0, 80.0], |&within| {
        let mut rng = Rng::with_seed(within as u64);
        let mut bench = awake(Fidelity::DataSheet);
        let (mut accepted, mut refused) = (0, [0; 2]);
        for _ in 0..400 {
            let angles = wish(&mut rng, within);
            let answer = bench.say(&typed(angles));
            if is_safe(angles, &limits(1.0)) {
                assert!(answer.starts_with("ok pose"), "{angles:?}: {answer}");
                accepted += 1;
            } else if !is_safe(angles, &limits(-1.0)) {
                let code = answer
                    .strip_prefix("err ")
                    .and_then(|rest| rest.chars().next());
                match code {
                    // Within 80 deg of neutral is within every servo's travel.
                    Some('4') => refused[0] += 1,
                    Some('5') => refused[1] += 1,
                    _ => panic!("{angles:?}: {answer}"),
                }
            }
        }
        println!("within {within} deg: {accepted} accepted, {refused:?} refused");
        assert!(accepted + refused[0] + refused[1] > 380);
    });
}

/// What a refusal names, and its value: `err 4 leg margin of A1 is 0.259, ...`,
/// `err 5 left slider is at 55.35 mm, ...`.
fn told(answer: &str) -> (&str, f64) {
    let (name, rest) = answer.split_once(" is ").expect("a name and a value");
    let value = rest.trim_start_matches("at ").split([',', ' ']).next();
    let value = value.and_then(|value| value.parse().ok());
    (&name[4..], value.expect("a number"))
}

/// The same value in floating point; the name begins with its code.
fn value(solution: &Solution, name: &str) -> Option<f64> {
    let margins = &solution.margins;
    let all = [
        ("4 type-2 margin of the head", margins.type2[0]),
        ("4 type-2 margin of the tail", margins.type2[1]),
        ("4 type-1 margin of A1", margins.type1[0]),
        ("4 type-1 margin of A2", margins.type1[1]),
        ("4 type-1 margin of A3", margins.type1[2]),
        ("4 type-1 margin of A4", margins.type1[3]),
        ("4 leg margin of A1", margins.leg[0]),
        ("4 leg margin of A2", margins.leg[1]),
        ("4 leg margin of A3", margins.leg[2]),
        ("4 leg margin of A4", margins.leg[3]),
        ("5 left slider", solution.left.s),
        ("5 right slider", solution.right.s),
    ];
    let found = all.iter().find(|(known, _)| *known == name);
    found.map(|(_, value)| *value)
}

#[test]
fn a_refusal_names_the_margin_and_its_value() {
    let mut bench = awake(Fidelity::DataSheet);
    let mut rng = Rng::with_seed(3);
    let mut named = 0;
    for _ in 0..200 {
        let angles = wish(&mut rng, 70.0);
        let answer = bench.say(&typed(angles));
        let Ok(solution) = robot().lizard().solve(&Pose::from(angles)) else {
            continue;
        };
        if answer.starts_with("ok") || answer.starts_with("err 3") {
            continue;
        }
        let (name, said) = told(&answer);
        let float = value(&solution, name).unwrap_or_else(|| panic!("{answer}"));
        let off = (said - float).abs();
        let most = match &answer[..5] {
            "err 5" => STROKE + 0.005,
            // A pose that is all but singular is told as singular.
            _ if float < 0.1 => 0.05,
            _ => MARGIN + 0.0005,
        };
        assert!(off <= most, "{angles:?}: {answer}, not {float}");
        named += 1;
    }
    assert!(named > 100, "{named}");
}

#[test]
fn no_frame_that_is_sent_breaks_a_limit_whatever_is_asked() {
    let cases = [
        (Fidelity::Stock, 21),
        (Fidelity::DataSheet, 22),
        (Fidelity::DataSheet, 23),
    ];
    for_each(&cases, |&(fidelity, seed)| {
        let mut rng = Rng::with_seed(seed);
        let mut bench = awake(fidelity);
        let lines: Vec<String> = robot()
            .gaits()
            .iter()
            .map(|gait| gait.name().replace('-', " "))
            .collect();
        let mut frames = Vec::new();
        for _ in 0..150 {
            let line = if rng.u64(..3) == 0 {
                rng.choice(&lines).expect("there are some").clone()
            } else {
                typed(far(&mut rng))
            };
            assert!(bench.say(&line).starts_with("ok "), "{line}");
            frames.extend(bench.run_for_frames(rng.u64(..2 * SECOND)));
        }
        let lax = limits(-1.0);
        let sent = instants(robot(), &frames);
        for at in &sent {
            let angles = at.angles.expect("four pulses");
            assert!(is_safe(angles, &lax), "{at:?}");
        }
        // Nothing jumps either: at most what the fastest gait asks for.
        let fastest = robot().pace().gait_slew / 50.0;
        for (pair, times) in sent.windows(2).zip(frames.windows(2)) {
            if times[1].start - times[0].start > lizard_host_tests::FRAME {
                continue;
            }
            let (here, there) = (pair[0].angles.expect("four"), pair[1].angles.expect("four"));
            for servo in 0..4 {
                let step = (there[servo] - here[servo]).abs();
                assert!(step <= fastest + 0.02, "{step} deg in a frame: {pair:?}");
            }
        }
        assert!(frames.len() > 5000);
    });
}

#[test]
fn a_way_that_breaks_a_limit_ends_before_it_does() {
    // Both poses are safe, and the straight way between them is not.
    let (from, to) = (
        [148.69, 27.8, 283.15, 269.65],
        [109.97, 19.06, 321.39, 288.67],
    );
    for_each(&[Fidelity::Stock, Fidelity::DataSheet], |fidelity| {
        let mut bench = awake(*fidelity);
        assert!(bench.say(&typed(from)).starts_with("ok pose"));
        bench.run_ms(2000);
        assert!(bench.say(&typed(to)).starts_with("ok pose"));
        let note = bench.next_line(500).expect("the robot tells");
        assert!(
            note.starts_with("# held in the last safe pose: type-1 margin of A4 is 0."),
            "{note}"
        );
        assert_eq!(Status::of(&mut bench).text("guard"), "held");
        let frames = bench.run_for_frames(SECOND);
        assert!(frames.iter().all(|frame| frame.widths == frames[0].widths));
        let held = instants(robot(), &frames)[0].angles.expect("four pulses");
        assert!(is_safe(held, &limits(-1.0)) && held != from);
        // It is not stuck: the way home is safe.
        assert_eq!(bench.say("stand"), "ok stand");
        bench.run_ms(2000);
        assert_eq!(bench.run_for_frames(1)[0].widths(), [24_000; 4]);
        assert_eq!(Status::of(&mut bench).text("guard"), "clear");
    });
}
