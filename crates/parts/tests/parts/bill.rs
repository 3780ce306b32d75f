//! Tests of the bill of materials: its counts, masses, prices and options, and the effect of the struts' springs.

use lizard_parts::{Assembly, Bill, Item, Kind, SpringEffect};

use crate::{SLOTTED_STRUTS_TOML, neutral_solution};

/// The assembly and the bill of a robot of `robots/`.
fn bill_of(name: &str) -> (Assembly, Bill) {
    bill_with(name, "")
}

/// The assembly and the bill of a robot of `robots/`, with more lines of TOML appended.
fn bill_with(name: &str, more_toml: &str) -> (Assembly, Bill) {
    let assembly = crate::assembly(name, more_toml);
    let bill = Bill::of(&assembly, &assembly.parts(), &neutral_solution(&assembly));
    (assembly, bill)
}

#[test]
fn every_body_is_printed_or_bought() {
    for name in ["paper", "large", "unequal"] {
        let (assembly, bill) = bill_of(name);
        let count_of = |is_counted: fn(&Kind) -> bool| {
            let bodies = assembly.bodies().iter();
            bodies.filter(|body| is_counted(&body.kind)).count()
        };
        let printed_count: usize = bill.printed.iter().map(|item| item.count).sum();
        assert_eq!(printed_count, count_of(|kind| kind.is_printed()), "{name}");
        assert_eq!(
            bill.bought_count("screw M3"),
            count_of(|kind| matches!(kind, Kind::Screw(_) | Kind::HexScrew(_)))
        );
        assert_eq!(
            bill.bought_count("lock nut"),
            count_of(|kind| *kind == Kind::Nut)
        );
        assert_eq!(bill.bought_count("servo SG-90"), 4);
        assert_eq!(bill.bought_count("tension spring"), 0, "{name}");
    }
}

#[test]
fn a_symmetric_robot_has_its_mass_centre_in_the_middle() {
    let (_, paper_bill) = bill_of("paper");
    // Everything except board and supply is symmetric, and board and supply balance each other to within the
    // tolerance.
    let error = paper_bill.centre[0].abs().max(paper_bill.centre[1].abs());
    assert!(error < 1.0, "{:?}", paper_bill.centre);
    assert!(
        (350.0..450.0).contains(&paper_bill.grams),
        "{}",
        paper_bill.grams
    );
    let (_, large_bill) = bill_of("large");
    assert!(large_bill.grams > paper_bill.grams);
}

#[test]
fn the_mass_in_each_robot_file_equals_that_of_its_bill_in_whole_grams() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots");
    let files = std::fs::read_dir(folder).expect("the folder robots/ is readable");
    let paths = files.map(|file| file.expect("the folder's entry is readable").path());
    let mut file_count = 0;
    for path in paths.filter(|path| {
        path.extension()
            .is_some_and(|extension| extension == "toml")
    }) {
        let name = path
            .file_stem()
            .and_then(|name| name.to_str())
            .expect("the file name is UTF-8");
        let (assembly, bill) = bill_of(name);
        let body = assembly.robot().ground().body;
        assert_eq!(body, bill.body_values(), "{name}");
        assert!(!bill.differs_from(&body), "{name}");
        file_count += 1;
    }
    assert!(file_count >= 4);
    let (assembly, _) = bill_of("paper");
    assert_eq!(lizard_robot::Body::DEFAULT, assembly.robot().ground().body);
}

#[test]
fn prices_are_on_every_row_to_buy_and_add_up() {
    let (_, bill) = bill_of("paper");
    let price_classes = bill
        .bought
        .iter()
        .map(|item| item.price.expect("each bought item has a price class"));
    assert_eq!(bill.euros, lizard_parts::Price::sum(price_classes));
    assert!(bill.radio.iter().all(|item| item.price.is_some()));
    assert!(bill.printed.iter().all(|item| item.price.is_none()));
    assert!(
        bill.euros[0] > 50 && bill.euros[1] < 300,
        "{:?}",
        bill.euros
    );
    let text = bill.to_string();
    let sum_sentence = format!("is {} to {} euros", bill.euros[0], bill.euros[1]);
    assert!(text.contains(&sum_sentence), "{text}");
    assert_eq!(bill.bought_count("resistor 10 kOhm"), 4);
    assert_eq!(bill.bought_count("terminal strip, 12 ways"), 2);
}

#[test]
fn inputs_are_options_of_the_bill_and_change_neither_sum_nor_mass() {
    let (_, plain_bill) = bill_of("paper");
    assert!(plain_bill.inputs.is_empty() && !plain_bill.to_string().contains("inputs"));
    let inputs_toml = "[input.button]\npin = \"A1\"\n[input.nose]\npin = \"A2\"\n";
    let (_, bill_with_both) = bill_with("paper", inputs_toml);
    let rows: Vec<&str> = bill_with_both
        .inputs
        .iter()
        .map(|item| item.what.as_str())
        .collect();
    assert!(rows[0].starts_with("push button") && rows[1].starts_with("infrared"));
    assert!(
        rows.iter()
            .all(|row| bill_with_both.to_string().contains(row))
    );
    assert_eq!(
        (bill_with_both.euros, bill_with_both.grams),
        (plain_bill.euros, plain_bill.grams)
    );
    let (_, bill_with_nose) = bill_with("paper", "[input.nose]\npin = \"A2\"\n");
    assert_eq!(bill_with_nose.inputs, bill_with_both.inputs[1..]);
}

#[test]
fn a_mass_centre_is_printed_in_words_and_as_toml() {
    let (_, mut bill) = bill_of("paper");
    (bill.grams, bill.centre) = (308.4, [-0.06, -0.11, 9.7]);
    assert_eq!(
        bill.centre_in_words(),
        "0.1 mm behind and 0.1 mm to the right of"
    );
    assert_eq!(bill.body_toml(), "[body]\nmass = 308.0\n");
    bill.centre = [4.26, 0.04, 9.7];
    assert_eq!(
        bill.centre_in_words(),
        "4.3 mm ahead and 0.0 mm to the left of"
    );
    let body = bill.body_values();
    let toml = "[body]\nmass = 308.0\ncentre = [4.3, 0.0]\n";
    assert_eq!(bill.body_toml(), toml);
    assert!(!bill.differs_from(&body));
    for (mass, ahead) in [(280.0, 4.0), (308.0, 0.0), (330.0, 4.0)] {
        let centre = [ahead, 0.0];
        let differs = bill.differs_from(&lizard_robot::Body {
            mass,
            mass_centre: centre,
        });
        assert!(differs, "{mass} {ahead}");
    }
}

#[test]
fn a_spring_holds_a_leg_against_friction_but_a_caught_foot_stalls_its_servo() {
    let (assembly, bill) = bill_with("paper", SLOTTED_STRUTS_TOML);
    let hold = bill.hold.expect("slotted struts have springs");
    let strut_length = 28.5f64.hypot(10.0);
    assert!((assembly.layout().legs[0].strut_length - strut_length).abs() < 1e-9);
    assert!((hold.installed - strut_length - 3.0).abs() < 1e-9);
    // At neutral the angle between the strut and the anchor's arm is 60.8 deg. In walk a leg swings by 20 deg to
    // either side, in look by a little more.
    let angle_deg = 10.0f64.atan2(28.5).to_degrees() + 41.409_622;
    let lever_arm_at = |swing: f64| 22.0 * (angle_deg + swing).to_radians().sin();
    let [min_lever_arm, max_lever_arm] = hold.lever_arm_range;
    assert!(lever_arm_at(-24.0) < min_lever_arm && min_lever_arm < lever_arm_at(-20.0) + 0.01);
    assert!(lever_arm_at(20.0) - 0.01 < max_lever_arm && max_lever_arm < 22.0);
    assert!((hold.preload - hold.lever_arm_range[0] * hold.force).abs() < 1e-9);
    assert!(hold.friction * 1.8 < hold.preload);
    // With foot and body held, the pin reaches the slot's end long before the 40 deg of a walk. The torque there is
    // more than 0.7 of the stall torque of an SG-90.
    assert!(
        12.0 < hold.lag_range[0] && hold.lag_range[1] < 25.0,
        "{:?}",
        hold.lag_range
    );
    assert!((131.0..160.0).contains(&hold.torque_range[1]) && !hold.lets_servo_turn());
    // An independent check of the slot's end from the plan of the leg. There the strut is 5 mm longer, and the torque
    // is the spring's force times the derivative of the strut's length with respect to the angle.
    let robot = assembly.robot();
    let stretch_at = |lag: f64| {
        let angle = robot.servos()[1].neutral + 20.0;
        let [from, to] = robot.legs()[1].place_at(angle, angle - lag).strut_anchors;
        (to - from).length() - strut_length
    };
    let (lag_deg, torque) = robot
        .drive()
        .strut()
        .expect("the struts are slotted")
        .slot_end(1, 20.0);
    assert!((stretch_at(lag_deg) - 5.0).abs() < 1e-6, "{lag_deg}");
    let lever_arm_mm =
        (stretch_at(lag_deg + 0.01) - stretch_at(lag_deg - 0.01)) / 0.02f64.to_radians();
    let force = hold.force + 5.0 * hold.rate;
    assert!(
        (torque / (force * lever_arm_mm) - 1.0).abs() < 1e-4,
        "{torque}"
    );
    // Only the weakest spring with which the robot still walks lets the servo turn.
    let (_, weak_bill) = bill_with(
        "paper",
        &format!("{SLOTTED_STRUTS_TOML}\nforce = 2.0\nrate = 0.2"),
    );
    assert!(
        weak_bill
            .hold
            .expect("slotted struts have springs")
            .lets_servo_turn()
    );
}

#[test]
fn a_held_foot_stretches_its_spring_in_one_direction_only() {
    for name in ["paper", "large", "unequal"] {
        let (assembly, _) = bill_of(name);
        let robot = assembly.robot();
        for (servo, plan) in robot.legs().iter().enumerate() {
            let neutral = robot.servos()[servo].neutral;
            let is_front = servo < 2;
            let forward = lizard_robot::servo::FORWARD_TURN_SIGN[servo];
            let extension_at = |turn_deg: f64| {
                let [from, to] = plan
                    .place_at(neutral + forward * turn_deg, neutral)
                    .strut_anchors;
                (to - from).length() - plan.strut_length
            };
            assert_eq!(extension_at(5.0) > 0.5, is_front, "{name} {servo}");
            assert_eq!(extension_at(-5.0) > 0.5, !is_front, "{name} {servo}");
        }
    }
}

#[test]
fn rigid_struts_are_printed_instead_and_need_no_springs() {
    let (_, sprung_bill) = bill_with("paper", SLOTTED_STRUTS_TOML);
    let (assembly, rigid_bill) = bill_with("paper", "");
    assert_eq!(sprung_bill.bought_count("tension spring"), 4);
    assert_eq!(rigid_bill.bought_count("tension spring"), 0);
    // The same screws and nuts are needed.
    for name in ["screw M3", "lock nut"] {
        assert_eq!(
            rigid_bill.bought_count(name),
            sprung_bill.bought_count(name)
        );
    }
    let rows_of = |items: &[Item]| -> Vec<_> {
        let items = items.iter();
        items.map(|item| (item.count, item.what.clone())).collect()
    };
    // Each bill lists the other's struts as alternatives.
    let [slotted_row, rigid_row] = ["strut", "rigid strut"].map(|name| (4, name.to_owned()));
    assert_eq!(rows_of(&sprung_bill.instead).first(), Some(&rigid_row));
    assert_eq!(rows_of(&rigid_bill.instead).first(), Some(&slotted_row));
    assert!(
        rows_of(&sprung_bill.printed).contains(&slotted_row)
            && rows_of(&rigid_bill.printed).contains(&rigid_row)
    );
    assert_eq!(rigid_bill.hold, None);
    assert!(!assembly.robot().drive().can_lag());
    let text = rigid_bill.to_string();
    for phrase in [
        "A foot that is caught can stall its servo",
        "[leg.drive]\nkind = \"rigid\"\n",
    ] {
        assert!(text.contains(phrase), "{text}");
    }
    let text = sprung_bill.to_string();
    let (_, table) = text
        .split_once("```toml\n")
        .expect("the text contains a block of TOML");
    let (drive_toml, _) = table
        .split_once("\n\n")
        .expect("an empty line follows the keys of the drive");
    // A robot with the quoted keys has the same springs.
    let (quoted_assembly, _) = bill_with("paper", drive_toml);
    let [expected, actual] = [sprung_bill.hold, SpringEffect::of(&quoted_assembly)]
        .map(|hold| hold.expect("slotted struts have springs"));
    assert!(
        (expected.force - actual.force).abs() < 0.01 && (expected.rate - actual.rate).abs() < 0.001
    );
}
