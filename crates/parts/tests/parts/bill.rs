//! Tests of the bill of materials: its counts, masses, prices and options, and the effect of the struts' springs.

use lizard_parts::{Assembly, Bill, Item, Kind, SpringEffect};

use crate::{GRAIN_ROBOT, ROBOTS, SLOTTED_STRUTS_TOML, compute_bill};

/// Computes the assembly and the bill of a robot in `robots/`, with more lines of TOML appended.
fn build_assembly_and_bill(name: &str, more_toml: &str) -> (Assembly, Bill) {
    let assembly = crate::build_assembly(name, more_toml);
    let bill = compute_bill(&assembly);
    (assembly, bill)
}

#[test]
fn every_body_is_printed_or_bought() {
    for name in ["paper", "large", "unequal"] {
        let (assembly, bill) = build_assembly_and_bill(name, "");
        let count_bodies = |is_counted: fn(&Kind) -> bool| {
            let bodies = assembly.bodies().iter();
            bodies.filter(|body| is_counted(&body.kind)).count()
        };
        let printed_count: usize = bill.printed.iter().map(|item| item.count).sum();
        let expected = count_bodies(|kind| kind.is_printed());
        assert_eq!(printed_count, expected, "{name}");
        let expected = count_bodies(|kind| matches!(kind, Kind::Screw(_) | Kind::HexScrew(_)));
        assert_eq!(bill.count_bought("screw M3"), expected);
        let expected = count_bodies(|kind| *kind == Kind::Nut);
        assert_eq!(bill.count_bought("lock nut"), expected);
        assert_eq!(bill.count_bought("servo SG-90"), 4);
        assert_eq!(bill.count_bought("tension spring"), 0, "{name}");
    }
}

#[test]
fn a_symmetric_robot_has_its_centre_of_mass_in_the_middle() {
    let (_, paper_bill) = build_assembly_and_bill("paper", "");
    // Only board and supply are asymmetric, and they balance each other within the tolerance.
    let [forward, left, _] = paper_bill.centre_of_mass;
    assert!(forward.abs().max(left.abs()) < 1.0, "{forward} {left} mm");
    let grams = paper_bill.grams;
    assert!((350.0..450.0).contains(&grams), "{grams} g");
    let (_, large_bill) = build_assembly_and_bill("large", "");
    assert!(large_bill.grams > paper_bill.grams);
}

#[test]
fn the_mass_in_each_robot_file_is_that_of_its_bill_in_whole_grams() {
    for name in ROBOTS.into_iter().chain([GRAIN_ROBOT]) {
        let (assembly, bill) = build_assembly_and_bill(name, "");
        let body = assembly.robot().ground().body;
        assert_eq!(body, bill.body_values(), "{name}");
        assert!(!bill.differs_from(&body), "{name}");
    }
    let (assembly, _) = build_assembly_and_bill("paper", "");
    assert_eq!(lizard_robot::Body::DEFAULT, assembly.robot().ground().body);
}

#[test]
fn every_row_to_buy_has_a_price_and_the_prices_add_up() {
    let (_, bill) = build_assembly_and_bill("paper", "");
    let price_of = |item: &Item| item.price.expect("each bought item has a price class");
    let price_classes = bill.bought.iter().map(price_of);
    assert_eq!(bill.euros, lizard_parts::PriceClass::sum(price_classes));
    assert!(bill.radio.iter().all(|item| item.price.is_some()));
    assert!(bill.printed.iter().all(|item| item.price.is_none()));
    let [min, max] = bill.euros;
    assert!(min > 50 && max < 300, "{min} to {max} euros");
    let text = bill.to_string();
    let sum_phrase = format!("is {min} to {max} euros");
    assert!(text.contains(&sum_phrase), "{text}");
    assert_eq!(bill.count_bought("resistor 10 kOhm"), 4);
    assert_eq!(bill.count_bought("terminal strip, 12 ways"), 2);
}

#[test]
fn inputs_are_options_that_change_neither_the_sum_nor_the_mass_of_a_bill() {
    let (_, plain_bill) = build_assembly_and_bill("paper", "");
    assert!(plain_bill.inputs.is_empty() && !plain_bill.to_string().contains("inputs"));
    let inputs_toml = "[input.button]\npin = \"A1\"\n[input.nose]\npin = \"A2\"\n";
    let (_, bill_with_both) = build_assembly_and_bill("paper", inputs_toml);
    let rows = bill_with_both.inputs.iter().map(|item| &*item.name);
    let rows: Vec<&str> = rows.collect();
    assert!(rows[0].starts_with("push button") && rows[1].starts_with("infrared"));
    let text = bill_with_both.to_string();
    assert!(rows.iter().all(|row| text.contains(row)));
    let sums = |bill: &Bill| (bill.euros, bill.grams);
    assert_eq!(sums(&bill_with_both), sums(&plain_bill));
    let (_, bill_with_nose) = build_assembly_and_bill("paper", "[input.nose]\npin = \"A2\"\n");
    assert_eq!(bill_with_nose.inputs, bill_with_both.inputs[1..]);
}

#[test]
fn the_centre_of_mass_is_formatted_in_words_and_as_toml() {
    let (_, mut bill) = build_assembly_and_bill("paper", "");
    (bill.grams, bill.centre_of_mass) = (308.4, [-0.06, -0.11, 9.7]);
    let text = "0.1 mm behind and 0.1 mm to the right of the plate's middle";
    assert_eq!(bill.describe_centre(), text);
    assert_eq!(bill.format_body_toml(), "[body]\nmass = 308.0\n");
    bill.centre_of_mass = [4.26, 0.04, 9.7];
    let text = "4.3 mm ahead and 0.0 mm to the left of the plate's middle";
    assert_eq!(bill.describe_centre(), text);
    let body = bill.body_values();
    let toml = "[body]\nmass = 308.0\ncentre = [4.3, 0.0]\n";
    assert_eq!(bill.format_body_toml(), toml);
    assert!(!bill.differs_from(&body));
    for (mass, forward) in [(280.0, 4.0), (308.0, 0.0), (330.0, 4.0)] {
        let differs = bill.differs_from(&lizard_robot::Body {
            mass,
            centre_of_mass: [forward, 0.0],
        });
        assert!(differs, "{mass} g, {forward} mm");
    }
}

#[test]
fn a_spring_holds_a_leg_against_friction_but_a_caught_foot_stalls_its_servo() {
    let (assembly, bill) = build_assembly_and_bill("paper", SLOTTED_STRUTS_TOML);
    let effect = bill.spring_effect.expect("slotted struts have springs");
    let strut_length = 28.5f64.hypot(10.0);
    assert!((assembly.layout().legs[0].strut_length - strut_length).abs() < 1e-9);
    assert!((effect.installed_length - strut_length - 3.0).abs() < 1e-9);
    // At neutral the angle between the strut and the anchor's arm is 60.8 deg. In the gait walk, a leg swings by 20 deg
    // to either side; in look, by a little more.
    let angle_deg = 10.0f64.atan2(28.5).to_degrees() + 41.409_622;
    let lever_arm_at = |swing: f64| 22.0 * (angle_deg + swing).to_radians().sin();
    let [min_lever_arm, max_lever_arm] = effect.lever_arm_range;
    assert!(lever_arm_at(-24.0) < min_lever_arm && min_lever_arm < lever_arm_at(-20.0) + 0.01);
    assert!(lever_arm_at(20.0) - 0.01 < max_lever_arm && max_lever_arm < 22.0);
    assert!((effect.preload_torque - min_lever_arm * effect.preload_force).abs() < 1e-9);
    assert!(effect.friction_torque * 1.8 < effect.preload_torque);
    // With foot and body held, the strut's screw reaches the slot's end long before the 40 deg of a walk. The torque
    // there is more than 0.7 of the stall torque of an SG-90.
    let [min_lag, max_lag] = effect.lag_range;
    let is_expected = 12.0 < min_lag && max_lag < 25.0;
    assert!(is_expected, "{min_lag} to {max_lag} deg");
    assert!((131.0..160.0).contains(&effect.torque_range[1]) && !effect.lets_servo_turn());
    // An independent check of the slot's end from the leg's plan: the strut is 5 mm longer, and the torque is the
    // spring's tension times the derivative of the strut's length with respect to the angle.
    let robot = assembly.robot();
    let extension_at = |lag: f64| {
        let angle = robot.servos()[1].neutral + 20.0;
        let [from, to] = robot.legs()[1].points_at(angle, angle - lag).strut_anchors;
        (to - from).length() - strut_length
    };
    let strut = robot.drive().strut().expect("the struts are slotted");
    let (lag_deg, torque) = strut.lag_and_torque_at_slot_end(1, 20.0);
    assert!((extension_at(lag_deg) - 5.0).abs() < 1e-6, "{lag_deg}");
    let lever_arm_mm =
        (extension_at(lag_deg + 0.01) - extension_at(lag_deg - 0.01)) / 0.02f64.to_radians();
    let force = effect.preload_force + 5.0 * effect.spring_rate;
    let error = torque / (force * lever_arm_mm) - 1.0;
    assert!(error.abs() < 1e-4, "{torque}");
    // Of the springs with which the robot still walks, only the weakest lets the servo turn.
    let weak_springs_toml = format!("{SLOTTED_STRUTS_TOML}\nforce = 2.0\nrate = 0.2");
    let (_, weak_bill) = build_assembly_and_bill("paper", &weak_springs_toml);
    let weak_effect = weak_bill.spring_effect;
    assert!(weak_effect.is_some_and(|effect| effect.lets_servo_turn()));
}

#[test]
fn a_held_foot_stretches_its_spring_in_one_direction_only() {
    for name in ["paper", "large", "unequal"] {
        let (assembly, _) = build_assembly_and_bill(name, "");
        let robot = assembly.robot();
        for (servo, plan) in robot.legs().iter().enumerate() {
            let neutral = robot.servos()[servo].neutral;
            let is_front = servo < 2;
            let forward = lizard_robot::servo::FORWARD_TURN_SIGN[servo];
            let extension_at = |turn_deg: f64| {
                let points = plan.points_at(neutral + forward * turn_deg, neutral);
                let [from, to] = points.strut_anchors;
                (to - from).length() - plan.strut_length
            };
            assert_eq!(extension_at(5.0) > 0.5, is_front, "{name} {servo}");
            assert_eq!(extension_at(-5.0) > 0.5, !is_front, "{name} {servo}");
        }
    }
}

#[test]
fn rigid_struts_are_alternatives_that_need_the_same_screws_and_no_springs() {
    let (_, slotted_bill) = build_assembly_and_bill("paper", SLOTTED_STRUTS_TOML);
    let (assembly, rigid_bill) = build_assembly_and_bill("paper", "");
    assert_eq!(slotted_bill.count_bought("tension spring"), 4);
    assert_eq!(rigid_bill.count_bought("tension spring"), 0);
    for name in ["screw M3", "lock nut"] {
        let slotted_count = slotted_bill.count_bought(name);
        assert_eq!(rigid_bill.count_bought(name), slotted_count);
    }
    let list_rows = |items: &[Item]| -> Vec<_> {
        let items = items.iter();
        items.map(|item| (item.count, item.name.clone())).collect()
    };
    // Each bill lists the other's struts as alternatives.
    let [slotted_row, rigid_row] = ["strut", "rigid strut"].map(|name| (4, name.to_owned()));
    assert_eq!(list_rows(&slotted_bill.alternatives)[0], rigid_row);
    assert_eq!(list_rows(&rigid_bill.alternatives)[0], slotted_row);
    assert!(list_rows(&slotted_bill.printed).contains(&slotted_row));
    assert!(list_rows(&rigid_bill.printed).contains(&rigid_row));
    assert_eq!(rigid_bill.spring_effect, None);
    assert!(!assembly.robot().drive().can_lag());
    let text = rigid_bill.to_string();
    for phrase in [
        "A foot that is caught can stall its servo",
        "[leg.drive]\nkind = \"rigid\"\n",
    ] {
        assert!(text.contains(phrase), "{text}");
    }
    let text = slotted_bill.to_string();
    let halves = text.split_once("```toml\n");
    let (_, table) = halves.expect("the text contains a block of TOML");
    let halves = table.split_once("\n\n");
    let (drive_toml, _) = halves.expect("an empty line follows the keys of the drive");
    // A robot with the keys in the text has the same springs.
    let (quoted_assembly, _) = build_assembly_and_bill("paper", drive_toml);
    let quoted_effect = SpringEffect::compute(&quoted_assembly);
    let effects = [slotted_bill.spring_effect, quoted_effect];
    let [expected, actual] = effects.map(|effect| effect.expect("slotted struts have springs"));
    assert!((expected.preload_force - actual.preload_force).abs() < 0.01);
    assert!((expected.spring_rate - actual.spring_rate).abs() < 0.001);
}
