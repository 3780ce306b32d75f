//! Tests with gaits at their limits and just beyond.

use crate::testing::{all, robot, text_before_gaits, with};
use crate::{CheckedGait, Robot};
use lizard_core::guard::hazard::{Hazard, Margin};
use lizard_core::numbers::part::{End, Servo, Side as CoreSide};
use lizard_core::numbers::units::Sine;
use lizard_kinematics::{Check, Side};

/// The smallest and largest slider travel on each side over a gait, mm.
fn travels(robot: &Robot, gait: &CheckedGait) -> [(f64, f64); 2] {
    let mut found = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for phase in (0..=u16::MAX).step_by(32) {
        let solved = robot.lizard().solve(&gait.table_angles(phase).into());
        let solved = solved.expect("a checked gait closes");
        for (found, side) in found.iter_mut().zip(Side::ALL) {
            let s = solved.side(side).s;
            *found = (found.0.min(s), found.1.max(s));
        }
    }
    found
}

const STAND: &str = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";

/// The unequal robot with sliders at nominal in its neutral pose, and one gait that moves the legs of one side, so
/// that only one slider moves.
fn lean(right: bool, limits: &[(&str, String)]) -> Result<Robot, crate::Error> {
    let legs = if right {
        "LF = 0.0, LH = 0.0"
    } else {
        "RF = 0.0, RH = 0.0"
    };
    let mut text = text_before_gaits("unequal")
        .replacen("l13 = 51.0", "l13 = 57.0", 1)
        .replacen("l18 = 57.0", "l18 = 51.4", 1);
    for (from, to) in limits {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    Robot::parse(&format!(
        "{text}{STAND}[gait.lean]\nperiod = 2.0\nwaveform = \"wave\"\nduty = 0.75\namplitude = 17.0\nstart = {{ LH = 0.0, LF = 0.25, RH = 0.5, RF = 0.75 }}\ngain = {{ {legs} }}\n"
    ))
}

#[test]
fn both_sides_count_to_the_sliders_travel() {
    for right in [false, true] {
        let robot = lean(right, &[]).expect("it leans");
        let gait = robot.gait("lean").expect("lean");
        let moving = travels(&robot, gait)[usize::from(right)];
        let (smallest, largest) = gait.audit().stroke;
        assert!(moving.0 < -5.0 && moving.1 > 3.0, "{moving:?}");
        assert!((moving.0 - smallest).abs() < 0.05, "{smallest}");
        assert!((largest - moving.1).abs() < 0.05, "{largest}");
    }
}

#[test]
fn a_slider_that_runs_out_on_one_side_alone_is_named() {
    for (right, side) in [(false, "left"), (true, "right")] {
        let robot = lean(right, &[]).expect("it leans");
        let gait = robot.gait("lean").expect("lean");
        let (smallest, largest) = travels(&robot, gait)[usize::from(right)];
        for (from, to, word) in [
            (
                "stroke_min = -19.0",
                format!("stroke_min = {:.2}", smallest + 0.5),
                "below",
            ),
            (
                "stroke_max = 41.0",
                format!("stroke_max = {:.2}", largest - 0.5),
                "above",
            ),
        ] {
            let refused = lean(right, &[(from, to)]).expect_err(word).to_string();
            let begin = format!(
                "in \"lean\" the {side} slider would run into its end: {side} slider travel "
            );
            assert!(refused.starts_with(&begin), "{refused}");
            assert!(refused.ends_with(": gait.lean)"), "{refused}");
            assert!(refused.contains(word), "{refused}");
        }
        let enough = [
            (
                "stroke_min = -19.0",
                format!("stroke_min = {:.2}", smallest - 0.2),
            ),
            (
                "stroke_max = 41.0",
                format!("stroke_max = {:.2}", largest + 0.2),
            ),
        ];
        assert!(lean(right, &enough).is_ok());
    }
}

#[test]
fn a_hazard_of_the_guard_has_the_name_of_its_condition() {
    let margin = |margin| Hazard::Margin {
        margin,
        value: Sine(0),
    };
    let stroke = |side| Hazard::Stroke { side, length: 0 };
    for (hazard, name) in [
        (margin(Margin::Type2(End::Head)), "type2_head"),
        (margin(Margin::Type2(End::Tail)), "type2_tail"),
        (margin(Margin::Type1(Servo::A2)), "type1_a2"),
        (margin(Margin::Type1(Servo::A4)), "type1_a4"),
        (margin(Margin::Leg(Servo::A1)), "leg_lf"),
        (margin(Margin::Leg(Servo::A3)), "leg_rh"),
        (stroke(CoreSide::Left), "stroke_left"),
        (stroke(CoreSide::Right), "stroke_right"),
    ] {
        assert_eq!(super::condition(&hazard).name(), name);
    }
}

#[test]
fn every_sample_of_every_servo_is_checked() {
    for (name, robot) in all() {
        for gait in robot.gaits() {
            let phases = super::phases(gait.table());
            for channel in gait.table().channels {
                for sample in (0..=u16::MAX).step_by(1024) {
                    let phase = sample.wrapping_sub(channel.offset);
                    assert!(phases.contains(&phase), "{name} {} {phase}", gait.name());
                }
            }
        }
    }
}

#[test]
fn a_swing_backward_is_as_fast_as_one_forward() {
    // All legs have a negative gain, so they swing backward.
    let against = "[gait.against]\nlike = \"walk\"\ngain = { LF = -1.0, RF = -1.0, RH = -1.0, LH = -1.0 }\n[gait.trot]";
    let robot = with("unequal", &[("[gait.trot]", against)]).expect("a gait");
    let speed = |name: &str| robot.gait(name).expect(name).audit().peak.speed;
    assert!((speed("against") - speed("walk")).abs() < 1e-9);
}

#[test]
fn a_gait_may_be_as_fast_as_its_limit() {
    let fastest = robot("unequal");
    let speed = |gait: &CheckedGait| gait.audit().peak.speed;
    let largest = fastest.gaits().iter().map(speed).fold(0.0, f64::max);
    let limit = |speed: f64| format!("gait_slew = {speed:?}");
    assert!(with("unequal", &[("gait_slew = 330.0", &limit(largest))]).is_ok());
    let refused = with("unequal", &[("gait_slew = 330.0", &limit(largest - 1e-6))]);
    let refused = refused.expect_err("it is too fast").to_string();
    assert!(refused.contains("limits.gait_slew is"), "{refused}");
}

#[test]
fn a_gait_may_use_all_of_a_servos_travel() {
    // A held leg swings exactly its amplitude to either side of neutral.
    let travel = |degrees: f64| {
        let servo = format!("us_per_degree = 8.5\nmin_us = {:?}", 1500.0 - degrees * 8.5);
        let body =
            text_before_gaits("unequal").replacen("us_per_degree = 8.5\nmin_us = 700.0", &servo, 1);
        Robot::parse(&format!(
            "{body}{STAND}[gait.sway]\nperiod = 2.0\nwaveform = \"held\"\namplitude = 17.0\norder = [\"LH\", \"LF\", \"RH\", \"RF\"]\n"
        ))
    };
    assert_eq!(travel(17.0).map(|robot| robot.gaits().len()), Ok(2));
    let refused = travel(16.9).expect_err("a tenth less").to_string();
    assert!(
        refused.starts_with("in \"sway\" servo A3 would have to turn farther than it can: ")
            && refused.contains(" is outside its travel of 299.10 to"),
        "{refused}"
    );
}

#[test]
fn every_end_of_every_travel_is_checked() {
    // A servo with only about a degree of travel on one side cannot walk.
    for (servo, smallest, largest, neutral) in [
        ("A1", "min_us = 610.0", "max_us = 2350.0", 1470.0),
        ("A2", "min_us = 560.0", "max_us = 2420.0", 1535.0),
        ("A3", "min_us = 700.0", "max_us = 2300.0", 1500.0),
        ("A4", "min_us = 590.0", "max_us = 2460.0", 1440.0),
    ] {
        for (from, to) in [
            (smallest, format!("min_us = {}", neutral - 9.0)),
            (largest, format!("max_us = {}", neutral + 9.0)),
        ] {
            let refused = with("unequal", &[(from, &to)]).expect_err(&to).to_string();
            assert!(
                refused.starts_with(&format!(
                    "in \"walk\" servo {servo} would have to turn farther"
                )),
                "{refused}"
            );
        }
    }
}

#[test]
fn each_kind_of_margin_has_the_limit_of_its_kind() {
    let unequal = robot("unequal");
    for (key, kind) in [
        ("type2 = 0.32 ", &Check::TYPE2[..]),
        ("type1 = 0.27 ", &Check::TYPE1),
        ("leg = 0.38 ", &Check::LEG),
    ] {
        let name = key.split(' ').next().expect("a name");
        let smallest = |gait: &CheckedGait| {
            let audit = gait.audit();
            let [of] = [audit.type2, audit.type1, audit.leg]
                .into_iter()
                .filter(|smallest| kind.contains(&smallest.what))
                .collect::<Vec<_>>()[..]
            else {
                panic!("{audit:?}")
            };
            of.value
        };
        let smallest = unequal.gaits().iter().map(smallest).fold(1.0, f64::min);
        let limit = |value: f64| format!("{name} = {value:?} ");
        // The firmware's guard is accurate to one or two thousandths.
        assert!(
            with("unequal", &[(key, &limit(smallest - 0.003))]).is_ok(),
            "{name}"
        );
        let refused = with("unequal", &[(key, &limit(smallest + 1e-6))]);
        let refused = refused.expect_err(name).to_string();
        assert!(refused.contains(&format!("margin {name}_")), "{refused}");
    }
}

#[test]
fn a_gait_that_only_the_firmwares_guard_rejects_is_refused() {
    // If the limit is only a step or two of the firmware's integers below the gaits' smallest margin, the
    // floating-point check still accepts, but the guard of at least one robot refuses.
    let mut refusals = Vec::new();
    for (name, key) in [
        ("paper", "leg = 0.3 "),
        ("unequal", "leg = 0.38 "),
        ("large", "type1 = 0.3 "),
        ("unequal", "type1 = 0.27 "),
    ] {
        let robot = robot(name);
        let smallest = |gait: &CheckedGait| {
            if key.starts_with("leg") {
                gait.audit().leg.value
            } else {
                gait.audit().type1.value
            }
        };
        let smallest = robot.gaits().iter().map(smallest).fold(1.0, f64::min);
        let kind = key.split(' ').next().expect("a name");
        for i in 1..10 {
            let limit = format!("{kind} = {:?} ", smallest - f64::from(i) * 1e-5);
            let refused = with(name, &[(key, &limit)]).err();
            refusals.extend(refused.map(|error| error.to_string()));
        }
    }
    assert!(!refusals.is_empty(), "no limit is too near");
    for refused in refusals {
        assert!(
            refused.contains(": margin or travel ") && refused.contains("leave it a little room ("),
            "{refused}"
        );
    }
}

#[test]
fn the_least_margins_are_those_at_their_phases() {
    for (name, robot) in all() {
        for gait in robot.gaits() {
            let audit = gait.audit();
            for smallest in [audit.type2, audit.type1, audit.leg] {
                let phase = (smallest.phase * 65536.0) as u16;
                let pose = gait.table_angles(phase).into();
                let solved = robot.lizard().solve(&pose).expect("closes");
                let (_, value) = solved
                    .conditions()
                    .find(|(what, _)| *what == smallest.what)
                    .expect("a condition");
                assert_eq!(value, smallest.value, "{name} {}", gait.name());
            }
        }
    }
}
