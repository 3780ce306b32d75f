//! Tests of the check that every screw can be inserted and turned in the order of the guide.

use lizard_kinematics::Vector;
use lizard_parts::{
    Assembly, BlockedScrew, Body, BuildError, Kind, Outline, ScrewOperation, Stage, Step,
    TurningPlace, build_steps,
};

use crate::{
    ROBOTS, build_assembly, build_assembly_with_changed_body, build_slotted_assembly,
    solve_at_neutral,
};

/// Builds the steps of the guide for a robot's kind of struts.
fn build_guide_steps(assembly: &Assembly) -> Vec<Step> {
    build_steps(assembly.robot().drive().strut().is_some())
}

#[test]
fn every_screw_of_every_robot_can_be_reached() {
    for name in ROBOTS {
        for kind in ["strut", "rigid"] {
            let assembly = build_assembly(name, &format!("[leg.drive]\nkind = \"{kind}\""));
            let access_poses = assembly.find_access_poses(&build_guide_steps(&assembly));
            let access_poses = access_poses.unwrap_or_else(|blocked| panic!("{name}: {blocked}"));
            // At neutral, the follower covers a screw of its foot, so the leg, which is still on the bench, is turned.
            // In the robot `unequal`, the short arm of a strut's anchor is above the servo's seat, where no socket
            // reaches the anchor's nut, so the link is turned.
            for access_pose in access_poses {
                let expected_prefix = match access_pose.step {
                    7 => "screw foot",
                    9 if name == "unequal" => "screw anchor",
                    _ => panic!("{name}: {access_pose:?}"),
                };
                for screw in access_pose.screws {
                    assert!(screw.starts_with(expected_prefix), "{name}: {screw}");
                }
            }
        }
    }
}

/// Finds the blocked screws of the paper's robot with changed steps. The screws of the feet, which are blocked at
/// neutral in any order, are omitted.
fn find_blocked_screws(change: impl FnOnce(&mut Vec<Step>)) -> Vec<BlockedScrew> {
    let assembly = build_slotted_assembly("paper", "");
    let mut steps = build_guide_steps(&assembly);
    change(&mut steps);
    let pose = solve_at_neutral(assembly.robot());
    let mut blocked_screws = assembly.find_blocked_screws(&steps, &pose);
    blocked_screws.retain(|blocked| !blocked.screw.starts_with("screw foot"));
    blocked_screws
}

#[test]
fn a_wrong_order_is_detected() {
    assert_eq!(find_blocked_screws(|_| ()), []);
    // A link's screws are inserted from below when the struts are already under it.
    let blocked_screws = find_blocked_screws(|steps| {
        steps[4].stages[0].adds =
            |body: &Body| matches!(body.kind, Kind::Horn) || body.name.starts_with("link");
        steps[8].stages.push(Stage {
            turning_place: TurningPlace::Robot,
            adds: |body: &Body| matches!(body.kind, Kind::HexScrew(_)),
            turns_again: |_| false,
        });
    });
    let is_push = |blocked: &BlockedScrew| blocked.operation == ScrewOperation::Push;
    let is_detected = blocked_screws.iter().any(is_push);
    assert!(is_detected, "{blocked_screws:?}");
}

/// Asserts that a screw cannot be turned at any pose, because another body is in the way.
#[track_caller]
fn assert_turn_is_blocked(assembly: &Assembly, screw: &str, obstacle: &str) {
    let access_poses = assembly.find_access_poses(&build_guide_steps(assembly));
    let message = format!("{obstacle} must be reported as an obstacle");
    let blocked = access_poses.expect_err(&message);
    let expected = (screw, ScrewOperation::Turn);
    assert_eq!((&*blocked.screw, blocked.operation), expected);
    assert_eq!(blocked.obstacle, obstacle);
}

#[test]
fn a_pad_without_a_hole_for_the_key_is_detected() {
    let remove_hole = |pad: &mut Body| pad.prisms[0].cut_shapes.clear();
    let glued_assembly = build_assembly_with_changed_body("pad LF", remove_hole);
    assert_turn_is_blocked(&glued_assembly, "screw height LF", "pad LF");
    // The check finds the pad both in the step that mounts it and in the step that levels the feet.
    let steps = build_guide_steps(&glued_assembly);
    let level_step = steps.iter().position(|step| step.title == "Level the feet");
    let level_step = 1 + level_step.expect("a step levels the feet");
    let pose = solve_at_neutral(glued_assembly.robot());
    let blocked_screws = glued_assembly.find_blocked_screws(&steps, &pose);
    for step in [7, level_step] {
        let is_pad = |blocked: &BlockedScrew| blocked.step == step && blocked.obstacle == "pad LF";
        let is_found = blocked_screws.iter().any(is_pad);
        assert!(is_found, "step {step}: {blocked_screws:?}");
    }
}

#[test]
fn a_strut_under_the_head_of_a_screw_is_detected() {
    // Heads that a key must hold from below replace the hexagonal heads, which pockets hold.
    let altered_assembly = build_slotted_assembly("unequal", "").with_changed_bodies(|bodies| {
        for body in bodies {
            if let Kind::HexScrew(length) = body.kind {
                body.kind = Kind::Screw(length);
            }
        }
    });
    assert_turn_is_blocked(&altered_assembly, "screw tip A4", "strut LH");
}

#[test]
fn a_screw_that_is_covered_at_every_pose_is_reported() {
    let covered_assembly = build_slotted_assembly("paper", "").with_changed_bodies(|bodies| {
        // The lid is as large as the plate and above the legs.
        let plate = bodies.iter().find(|body| body.name == "plate").cloned();
        let mut lid = plate.expect("the robot has a plate");
        lid.name = "deck lid".to_owned();
        for prism in &mut lid.prisms {
            prism.cut_shapes.clear();
            prism.z = prism.z.map(|z| z + 50.0);
        }
        bodies.push(lid);
    });
    let access_poses = covered_assembly.find_access_poses(&build_guide_steps(&covered_assembly));
    let blocked_screw = access_poses.expect_err("the lid must be reported as an obstacle");
    assert_eq!(blocked_screw.obstacle, "deck lid");
    let message = BuildError::from(blocked_screw).to_string();
    let expected = "at step 3 of the guide: deck lid is in the way, at every pose";
    assert!(message.contains(expected), "{message}");
}

#[test]
fn parts_that_move_together_do_not_overlap() {
    for name in ROBOTS {
        let result = build_slotted_assembly(name, "").check_dimensions();
        assert_eq!(result, Ok(()), "{name}");
    }
    // The head of a standoff's screw overlaps the boss of the board's screw.
    let altered_assembly = build_assembly_with_changed_body("screw standoff 1 above", |screw| {
        for prism in &mut screw.prisms {
            prism.filled_shapes[0].points[0].y -= 1.0;
        }
    });
    let result = altered_assembly.check_dimensions();
    let message = result
        .expect_err("the overlap must be reported")
        .to_string();
    let expected = "deck and screw standoff 1 above, which move together, overlap by 0.5";
    assert!(message.contains(expected), "{message}");
}

/// Checks the free space independently: tests the layers' outlines point by point.
#[test]
fn no_body_is_above_a_screw_head_that_can_be_reached() {
    for name in ["paper", "unequal"] {
        let assembly = build_slotted_assembly(name, "");
        let pose = solve_at_neutral(assembly.robot());
        let steps = build_guide_steps(&assembly);
        let blocked_screws = assembly.find_blocked_screws(&steps, &pose);
        let find_step = |body: &Body| steps.iter().position(|step| step.adds(body));
        let mut layers = Vec::new();
        for body in assembly.bodies() {
            let prisms = body.prisms.iter();
            layers.extend(prisms.map(|prism| (body, prism.z, Outline::from_prism(prism))));
        }
        let mut checked_count = 0;
        for screw in assembly.bodies() {
            let screw_step = find_step(screw);
            let (Kind::Screw(_), [low, high]) = (screw.kind, &screw.prisms[..]) else {
                continue;
            };
            // Only screws that are inserted from above, on the robot, are checked.
            if high.filled_shapes[0].diameter() <= low.filled_shapes[0].diameter()
                || screw_step == Some(6)
            {
                continue;
            }
            let is_blocked = |blocked: &BlockedScrew| blocked.screw == screw.name;
            if blocked_screws.iter().any(is_blocked) {
                assert!(name == "unequal" && screw.name.starts_with("screw anchor"));
                continue;
            }
            let placement = assembly.placement(screw.mount, &pose);
            let head = placement.map(high.filled_shapes[0].middle());
            let may_cover = |body: &Body| {
                let is_ignored = body.name == screw.name || body.name.starts_with("board");
                find_step(body) <= screw_step && !is_ignored
            };
            let covering_layers = layers.iter().filter(|(body, ..)| may_cover(body));
            for (body, [bottom, top], outline) in covering_layers {
                let heights = (1..60).map(|step| high.z[1] + 0.5 * f64::from(step));
                let height_count = heights.filter(|z| bottom < z && z < top).count();
                if height_count == 0 {
                    continue;
                }
                let placement = assembly.placement(body.mount, &pose);
                for direction in 0..12 {
                    let rim = head + Vector::from_angle(30.0 * f64::from(direction)) * 1.99;
                    let is_free = !outline.contains(placement.unmap(rim));
                    assert!(is_free, "{name}: {} covers {}", body.name, screw.name);
                    checked_count += height_count;
                }
            }
        }
        let is_enough = checked_count > 1000;
        assert!(is_enough, "{name}: {checked_count} points checked");
    }
}
