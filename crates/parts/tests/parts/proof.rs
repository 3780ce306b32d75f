//! Tests of the proof that parts do not collide: its bounds never exceed the distance at any pose, it detects
//! deliberate errors, and every robot file passes it.

use std::collections::BTreeSet;

use lizard_kinematics::{Side, Solution, Vector};
use lizard_parts::{Assembly, Body, Clash, FAR_MM, MIN_GAP_MM, Mount, Shape};
use lizard_robot::Robot;

use crate::{
    GRAIN_ROBOT, ROBOTS, build_assembly, build_assembly_with_changed_body, build_slotted_assembly,
    find_body,
};

/// A generator of pseudo-random numbers between 0 and 1, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        let product = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = product.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Generates poses that the guard accepts: some anywhere in the servos' travel, the others at the edge of the accepted
/// range, where parts come closest.
fn generate_accepted_poses(robot: &Robot, count: usize) -> Vec<Solution> {
    let mut random = Random(7);
    let mut poses = Vec::new();
    let neutral = robot.servos().map(|servo| servo.neutral);
    while poses.len() < count {
        let random_angles = robot.servos().each_ref().map(|servo| {
            let (low, high) = servo.travel();
            servo.neutral + low + (high - low) * random.next()
        });
        poses.extend(robot.solve_if_allowed(random_angles));
        let solve_at = |fraction: f64| {
            let angles =
                std::array::from_fn(|i| neutral[i] + fraction * (random_angles[i] - neutral[i]));
            robot.solve_if_allowed(angles)
        };
        let (mut accepted_fraction, mut refused_fraction) = (0.0, 1.0);
        for _ in 0..30 {
            let fraction = (accepted_fraction + refused_fraction) / 2.0;
            match solve_at(fraction) {
                Some(_) => accepted_fraction = fraction,
                None => refused_fraction = fraction,
            }
        }
        poses.extend(solve_at(accepted_fraction));
    }
    poses
}

/// Proves that the parts of a robot file fit, and compares the proof's bounds with the distances at many poses.
fn assert_bounds_hold(name: &str) {
    let assembly = build_slotted_assembly(name, "");
    let proof = assembly.prove(|_, _| ());
    assert_eq!(proof.check(), Ok(()), "{name}");
    let find_mounts =
        |body_names: [&String; 2]| body_names.map(|name| find_body(&assembly, name).mount);
    let poses = generate_accepted_poses(assembly.robot(), 300);
    for pose in &poses {
        let angles: [f64; 4] = pose.pose.into();
        for (angle, [low, high]) in angles.into_iter().zip(proof.ranges) {
            let is_inside = (low..=high).contains(&angle);
            assert!(is_inside, "{name}: {angle} deg is outside {low} to {high}");
        }
    }
    for pair in assembly.find_close_pairs(poses, FAR_MM - 0.2) {
        let mounts = find_mounts([&pair.first, &pair.second]);
        let mut pairs = proof.separate_pairs.iter();
        let proved_pair =
            pairs.find(|proved| find_mounts([&proved.first, &proved.second]) == mounts);
        let proved_pair = proved_pair.unwrap_or_else(|| panic!("{name}: no bound for {pair}"));
        let holds = proved_pair.lower_bound <= pair.mm;
        assert!(holds, "{name}: {pair}, but {proved_pair}");
    }
    for pair in proof.separate_pairs.iter().chain(&proof.touching_pairs) {
        let Some(witness) = &pair.witness else {
            continue;
        };
        let accepted = assembly.robot().solve_if_allowed(witness.pose);
        assert!(accepted.is_some(), "{name}: {pair}");
        assert!(pair.lower_bound <= witness.mm, "{name}: {pair}");
        // The bound is at least about half of the smallest distance found, except near the limits of the guard.
        let is_close = witness.mm < pair.lower_bound.max(0.0) * 2.1 + 0.02;
        assert!(is_close || pair.unproved_angles.is_some(), "{name}: {pair}");
    }
}

#[test]
fn distances_in_the_papers_robot_are_at_least_the_proved_bounds() {
    assert_bounds_hold("paper");
}

#[test]
fn distances_in_the_large_robot_are_at_least_the_proved_bounds() {
    assert_bounds_hold("large");
}

#[test]
fn distances_in_the_unequal_robot_are_at_least_the_proved_bounds() {
    assert_bounds_hold("unequal");
}

#[test]
fn rigid_struts_are_at_least_as_far_from_other_parts_as_slotted_struts() {
    let [slotted_gap, rigid_gap] = ["strut", "rigid"].map(|kind| {
        let assembly = build_assembly("paper", &format!("[leg.drive]\nkind = \"{kind}\""));
        let is_strut = |body: &Body| matches!(body.mount, Mount::Strut(_));
        let proof = assembly.prove_chosen(|a, b| is_strut(a) || is_strut(b), |_, _| ());
        assert_eq!(proof.check(), Ok(()), "{kind}");
        let nearest_pair = proof.separate_pairs.first();
        nearest_pair.expect("some pair is near").lower_bound
    });
    let is_as_far = rigid_gap >= slotted_gap;
    assert!(is_as_far, "rigid {rigid_gap} mm, slotted {slotted_gap} mm");
}

#[test]
fn own_gaits_and_grain_have_the_same_parts_as_the_papers_robot() {
    let paper = build_slotted_assembly("paper", "");
    let without_pads = |assembly: Assembly| {
        assembly.with_changed_bodies(|bodies| {
            bodies.retain(|body| body.kind != lizard_parts::Kind::Pad)
        })
    };
    // The pads of `grain` are not compared: they are no wider than plain pads, as the tests in `pads.rs` show.
    let own_gaits = build_slotted_assembly("own-gaits", "");
    let grain = without_pads(build_slotted_assembly(GRAIN_ROBOT, ""));
    for (assembly, paper) in [(own_gaits, paper.clone()), (grain, without_pads(paper))] {
        assert_eq!(assembly.bodies(), paper.bodies());
        assert_eq!(assembly.robot().limits(), paper.robot().limits());
        let [travels, paper_travels] = [&assembly, &paper].map(|assembly| {
            let servos = assembly.robot().servos().each_ref();
            servos.map(|servo| servo.travel())
        });
        assert_eq!(travels, paper_travels);
    }
}

#[test]
fn the_tests_use_every_robot_file() {
    let folder = format!("{}/../../robots", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(folder).expect("the folder robots/ is readable");
    let names = files.map(|file| file.expect("the folder's entry is readable").file_name());
    let expected = ROBOTS.into_iter().chain([GRAIN_ROBOT]);
    let expected = expected.map(|name| format!("{name}.toml").into());
    assert_eq!(BTreeSet::from_iter(names), BTreeSet::from_iter(expected));
}

/// Finds the worst clash among the pairs that include a body for which `is_chosen` is true.
fn find_clash(assembly: &Assembly, is_chosen: impl Fn(&Body) -> bool) -> Clash {
    let proof = assembly.prove_chosen(|a, b| is_chosen(a) || is_chosen(b), |_, _| ());
    proof.check().expect_err("the proof must find a clash")
}

/// Asserts that a clash is an overlap of two bodies whose names begin with `first` and `second`, in either order.
#[track_caller]
fn assert_overlap(clash: Clash, first: &str, second: &str) {
    let Clash::Overlap(clearance) = clash else {
        panic!("{clash}");
    };
    assert!(clearance.mm < 0.0, "{clearance}");
    let (a, b) = (&clearance.first, &clearance.second);
    let is_pair = |a: &str, b: &str| a.starts_with(first) && b.starts_with(second);
    assert!(is_pair(a, b) || is_pair(b, a), "{clearance}");
}

#[test]
fn an_overlap_due_to_a_wrong_dimension_is_detected() {
    for (parts_line, prefix, first, second) in [
        ("bar = 20.0", "link", "link A", ""),
        ("pivot = [22.0, 6.0]", "crank", "crank", "plate"),
    ] {
        let altered_assembly = build_slotted_assembly("paper", &format!("[parts]\n{parts_line}"));
        let clash = find_clash(&altered_assembly, |body| body.name.starts_with(prefix));
        assert_overlap(clash, first, second);
    }
}

#[test]
fn a_large_overlap_is_detected_early() {
    let proof = build_slotted_assembly("paper", "[parts]\nbar = 24.0").prove(|_, _| ());
    let Err(Clash::Overlap(clearance)) = proof.check() else {
        panic!("no overlap");
    };
    assert!(clearance.mm < -5.0, "{clearance}");
    let region_count = proof.region_count;
    assert!(region_count < 10_000, "{region_count} regions");
}

#[test]
fn a_screw_that_is_too_long_is_detected() {
    for (name, [extra_below_mm, extra_above_mm], obstacle) in [
        ("screw tip A1", [8.0, 0.0], "strut LF"),
        ("screw foot LF 2", [0.0, 3.0], "follower LF"),
        ("screw crank pivot LF", [0.0, 6.5], "screw arm A1"),
        ("screw height LF", [0.0, 26.0], "crank LF"),
        ("screw leg anchor LF", [0.0, 5.0], "link A1"),
    ] {
        let altered_assembly = build_assembly_with_changed_body(name, |screw| {
            let diameter = |i: usize| screw.prisms[i].filled_shapes[0].diameter();
            let shank = usize::from(diameter(1) < diameter(0));
            let [low, high] = screw.prisms[shank].z;
            screw.prisms[shank].z = [low - extra_below_mm, high + extra_above_mm];
        });
        let clash = find_clash(&altered_assembly, |body| body.name == name);
        assert_overlap(clash, name, obstacle);
    }
}

#[test]
fn swapped_layers_are_detected() {
    // The upper and the lower coupler of the head swap their heights.
    let altered_assembly = build_slotted_assembly("paper", "").with_changed_bodies(|bodies| {
        let find_index = |name: &str| {
            let index = bodies.iter().position(|body| body.name == name);
            index.expect(name)
        };
        let [lower_index, upper_index] = ["coupler A1", "coupler A2"].map(find_index);
        let z = bodies[lower_index].prisms[0].z;
        bodies[lower_index].prisms[0].z = bodies[upper_index].prisms[0].z;
        bodies[upper_index].prisms[0].z = z;
    });
    let clash = find_clash(&altered_assembly, |body| body.name.starts_with("coupler"));
    assert_overlap(clash, "coupler A", "");
}

#[test]
fn a_hole_that_is_displaced_from_its_pin_is_detected() {
    let altered_assembly = build_assembly_with_changed_body("coupler A4", |coupler| {
        for cut in &mut coupler.prisms[0].cut_shapes {
            for point in &mut cut.points {
                *point = *point + Vector::new(0.0, 0.3);
            }
        }
    });
    let clash = find_clash(&altered_assembly, |body| body.name == "coupler A4");
    let Clash::Overlap(clearance) = clash else {
        panic!("no overlap");
    };
    assert!((clearance.mm + 0.2).abs() < 0.02, "{clearance}");
    assert!(clearance.second.starts_with("screw"), "{clearance}");
}

#[test]
fn the_message_about_parts_that_come_too_close_contains_their_pose() {
    // At the limits of the guard, the strut comes close to the servo's screws.
    let altered_assembly = build_slotted_assembly("paper", "[parts]\nanchor = [22.0, 5.0]");
    let clash = find_clash(&altered_assembly, |body| body.name.starts_with("strut"));
    let message = clash.to_string();
    assert!(message.contains("strut"), "{message}");
    assert!(message.contains(" pose "), "{message}");
}

/// Computes the smallest and the largest x of a shape that is shifted by `shift_mm` along x, mm.
fn compute_x_range(shape: &Shape, shift_mm: f64) -> [f64; 2] {
    let xs = shape.points.iter().map(|point| point.x + shift_mm);
    let low = xs.clone().fold(f64::INFINITY, f64::min) - shape.radius;
    [low, xs.fold(f64::NEG_INFINITY, f64::max) + shape.radius]
}

#[test]
fn a_rod_stays_in_its_sleeve_throughout_the_stroke() {
    for name in ["paper", "large", "unequal"] {
        let assembly = build_slotted_assembly(name, "");
        let (lizard, limits) = (assembly.robot().lizard(), assembly.robot().limits());
        for side in Side::ALL {
            let slider = lizard.side(side);
            let [sleeve, rod] = ["sleeve", "rod"].map(|part| {
                let body = find_body(&assembly, &format!("{part} {side}"));
                let mut shapes = body.prisms.iter().flat_map(|prism| &prism.filled_shapes);
                shapes.find(|shape| shape.points.len() > 2).expect(part)
            });
            let [start, end] = compute_x_range(sleeve, 0.0);
            let mut min_overlap = f64::INFINITY;
            for step in 0..=100 {
                let fraction = f64::from(step) / 100.0;
                let stroke = limits.stroke_min + fraction * (limits.stroke_max - limits.stroke_min);
                let [rear, front] = compute_x_range(rod, slider.nominal_length + stroke);
                min_overlap = min_overlap.min(front.min(end) - rear.max(start));
            }
            // At the longest stroke, the rod overlaps the sleeve by exactly the required length.
            let error = min_overlap - 20.0;
            assert!(error.abs() < 1e-9, "{name} {side}: {min_overlap} mm");
        }
        let is_sleeve_and_rod =
            |a: &Body, b: &Body| a.name.starts_with("sleeve") && b.name.starts_with("rod");
        let proof = assembly.prove_chosen(is_sleeve_and_rod, |_, _| ());
        // Each side of the rod has a clearance of 0.2 mm in the bore.
        assert_eq!(proof.touching_pairs.len(), 2);
        for pair in &proof.touching_pairs {
            let witness = pair.witness.as_ref();
            let gap = witness.expect("the rod is near its sleeve").mm;
            assert!((gap - assembly.robot().parts().fit).abs() < 1e-9, "{pair}");
        }
    }
}

#[test]
fn the_screw_of_a_strut_has_clearance_along_its_whole_slot() {
    let assembly = build_slotted_assembly("paper", "");
    let strut = find_body(&assembly, "strut LF");
    let leg = assembly.layout().legs[0];
    let screw_radius = assembly.robot().parts().screw.diameter / 2.0;
    let is_at_screw = |cut: &&Shape| (cut.points[0].x - leg.strut_length).abs() < 1e-9;
    let cuts = strut.prisms[0].cut_shapes.iter();
    let mut slots = cuts.filter(|cut| cut.points.len() == 2);
    let slot = slots.find(is_at_screw).expect("the strut has a slot");
    for step in 0..=10 {
        let travel = 5.0 * f64::from(step) / 10.0;
        let shank = Shape::disc(Vector::new(leg.strut_length + travel, 0.0), screw_radius);
        let gap = shank.depth_in(slot, Vector::default());
        assert!((gap - 0.1).abs() < 1e-9, "{gap} mm after {travel} mm");
    }
    let shank_beyond_slot = Shape::disc(Vector::new(leg.strut_length + 5.2, 0.0), screw_radius);
    assert!(shank_beyond_slot.depth_in(slot, Vector::default()) < 0.0);
}

#[test]
fn the_smallest_allowed_distance_is_at_least_the_clearance_of_a_fit() {
    assert!(MIN_GAP_MM >= build_slotted_assembly("paper", "").robot().parts().fit);
}
