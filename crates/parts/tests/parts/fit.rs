//! Tests that no parts collide unless they are designed to touch, that wrong dimensions are detected, and that bodies
//! are consistent.

use std::collections::BTreeSet;

use crate::{ROBOTS, build_assembly, build_slotted_assembly, find_body};

#[test]
fn every_robot_has_gaps_between_its_parts() {
    for name in ROBOTS {
        let assembly = build_slotted_assembly(name, "");
        assert!(assembly.grid_poses(10).count() > 100, "{name}");
        let close_pairs = assembly.find_close_pairs(assembly.grid_poses(10), 0.2);
        assert!(close_pairs.is_empty(), "{name}: {}", close_pairs[0]);
    }
}

#[test]
fn a_wrong_dimension_makes_parts_overlap() {
    let large_head_toml = "[parts.screw]\nhead = 14.0\nhead_height = 3.0";
    for (toml, expected_first, expected_second) in [
        ("[parts]\nbar = 24.0", "follower", "follower"),
        (
            "force = 4.0\n[parts]\npivot = [6.25, -4.0]",
            "plate",
            "crank",
        ),
        ("[parts.servo]\nboss = 20.0", "link", "strut"),
        ("[parts]\nbattery = [90.0, 90.0, 30.0]", "battery", "sleeve"),
        ("[parts]\nanchor = [12.0, 5.0]", "servo", "strut"),
        (large_head_toml, "link", "screw"),
    ] {
        let assembly = build_slotted_assembly("paper", toml);
        let close_pairs = assembly.find_close_pairs(assembly.grid_poses(9), 1.0);
        let Some(pair) = close_pairs.first() else {
            panic!("{toml}: no parts are close")
        };
        assert!(pair.mm < 0.0, "{toml}: {pair}");
        let is_expected_pair =
            pair.first.contains(expected_first) && pair.second.contains(expected_second);
        assert!(is_expected_pair, "{toml}: {pair}");
    }
}

#[test]
fn bodies_have_unique_names_adjoining_layers_and_known_contacts() {
    let assembly = build_assembly("unequal", "");
    let bodies = assembly.bodies();
    let names: BTreeSet<_> = bodies.iter().map(|body| &body.name).collect();
    assert_eq!(names.len(), bodies.len(), "two bodies have the same name");
    for body in bodies {
        for pair in body.prisms.windows(2) {
            assert_eq!(pair[0].z[1], pair[1].z[0], "{}", body.name);
        }
        for prism in &body.prisms {
            assert!(prism.z[0] < prism.z[1], "{}", body.name);
        }
        for contact in &body.allowed_contacts {
            let is_known = assembly.body(contact).is_some();
            assert!(is_known, "{}: {contact} is unknown", body.name);
        }
    }
}

#[test]
fn screws_are_centred_in_the_holes_of_the_parts_that_they_hold() {
    for name in ROBOTS {
        let assembly = build_assembly(name, "");
        let mut hole_count = 0;
        for pose in assembly.grid_poses(5) {
            let bodies = assembly.bodies().iter();
            for screw in bodies.filter(|body| body.name.starts_with("screw ")) {
                let shapes = screw.prisms.iter().map(|prism| &prism.filled_shapes[0]);
                let shank = shapes.min_by(|a, b| a.diameter().total_cmp(&b.diameter()));
                let shank = shank.expect("a screw has layers");
                let centre = assembly.placement(screw.mount, &pose).map(shank.points[0]);
                for held_name in &screw.allowed_contacts {
                    let held = find_body(&assembly, held_name);
                    let frame = assembly.placement(held.mount, &pose);
                    let cuts = held.prisms.iter().flat_map(|prism| &prism.cut_shapes);
                    let holes = cuts.filter(|cut| cut.radius >= shank.radius - 0.3);
                    let errors = holes.map(|hole| (frame.map(hole.points[0]) - centre).length());
                    let error_mm = errors.fold(f64::INFINITY, f64::min);
                    let label = format!("{name}: {} in {}", screw.name, held.name);
                    assert!(error_mm < 1e-9, "{label} is off by {error_mm} mm");
                    hole_count += 1;
                }
            }
        }
        assert!(hole_count > 50, "{name}: {hole_count} holes");
    }
}

#[test]
fn a_robot_that_does_not_fit_is_refused_with_the_reason() {
    let bar_message =
        "parts.bar must be at least 7.3 mm for a screw's head and a wall on each side, but is 6 mm";
    let height_message = "parts.height must be at least 21.3 mm";
    let spring_message = "leg strut LF is 30.2 mm from screw to screw, but must be long enough to stretch its spring, which is 40.0 mm";
    // As drawn in the paper, the pivot lies under the servo's link.
    let drawn_pivot = "[parts]\npivot = [6.25, -4.0]\n[parts.spring]\nlength = 10.0";
    let near_pivot = "[parts]\npivot = [22.0, 6.0]\n[parts.spring]\nlength = 20.0";
    for (toml, phrases) in [
        (drawn_pivot, [" and ", "overlap by"]),
        (near_pivot, ["overlap by", "at pose"]),
        ("[parts]\nbar = 6.0", [bar_message, ""]),
        ("[parts]\nheight = 15.0", [height_message, ""]),
        (
            "force = 4.0\n[parts.spring]\nlength = 40.0",
            [spring_message, ""],
        ),
        ("[parts]\nthickness = 15.0", ["do not form one body", ""]),
        (
            "[parts]\nthickness = 3.0",
            ["alarm and battery strap", "parts.battery"],
        ),
        (
            "[parts]\nfit = 0.0",
            ["alarm and battery strap", "parts.fit"],
        ),
    ] {
        let fit = build_slotted_assembly("paper", toml).check_fit();
        let message = fit.expect_err(toml).to_string();
        for phrase in phrases {
            assert!(message.contains(phrase), "{message}");
        }
    }
    for name in ROBOTS {
        assert_eq!(build_assembly(name, "").check_fit(), Ok(()), "{name}");
    }
}
