//! Tests of the geometry in the files: distances between holes, positions of feet, cuts; and of identical bytes on
//! every run.

use std::collections::BTreeSet;

use lizard_kinematics::Vector;
use lizard_parts::{Assembly, Body, Loop, Mount, Outline, draw_sheets, make_part_files};

use crate::find_body;

fn build_assembly(name: &str) -> Assembly {
    crate::build_slotted_assembly(name, "")
}

/// Finds the centres, seen from above, of a body's clearance holes for M3 screws.
fn find_clearance_holes(body: &Body) -> Vec<Vector> {
    let mut holes: Vec<Vector> = Vec::new();
    for prism in &body.prisms {
        for (middle, radius) in Outline::from_prism(prism).loops().filter_map(Loop::circle) {
            let is_same_hole = |hole: &Vector| (*hole - middle).length() < 1e-6;
            if (radius - 1.6).abs() < 1e-6 && !holes.iter().any(is_same_hole) {
                holes.push(middle);
            }
        }
    }
    holes
}

/// Asserts that a body has two holes that are `mm` apart.
#[track_caller]
fn assert_hole_distance(assembly: &Assembly, name: &str, mm: f64) {
    let holes = find_clearance_holes(find_body(assembly, name));
    let distance_error = |a: &Vector, b: &Vector| ((*a - *b).length() - mm).abs();
    let is_in_pair = |a| holes.iter().any(|b| distance_error(a, b) < 1e-9);
    let has_pair = holes.iter().any(is_in_pair);
    assert!(has_pair, "{name}: no two of {holes:?} are {mm} mm apart");
}

#[test]
fn the_distance_between_two_holes_is_the_length_of_the_link() {
    for name in ["paper", "large", "unequal"] {
        let assembly = build_assembly(name);
        let links = assembly.robot().lizard().links;
        let leg = assembly.robot().lizard().leg;
        for (servo, coupler, crank, arm) in [
            ("A1", links.l2, links.l1, links.l14),
            ("A2", links.l3, links.l4, links.l19),
            ("A3", links.l8, links.l9, links.l16),
            ("A4", links.l7, links.l6, links.l11),
        ] {
            assert_hole_distance(&assembly, &format!("coupler {servo}"), coupler);
            // Crank and arm form a right angle at the shaft.
            let link = format!("link {servo}");
            assert_hole_distance(&assembly, &link, crank.hypot(arm));
            let holes = find_clearance_holes(find_body(&assembly, &link));
            for length in [crank, arm] {
                let is_at_distance = |hole: &Vector| (hole.length() - length).abs() < 1e-9;
                assert!(holes.iter().any(is_at_distance), "{name} {link} {length}");
            }
        }
        for leg_name in ["LF", "RF", "RH", "LH"] {
            assert_hole_distance(&assembly, &format!("crank {leg_name}"), leg.crank);
            assert_hole_distance(&assembly, &format!("follower {leg_name}"), leg.follower);
            assert_hole_distance(&assembly, &format!("leg coupler {leg_name}"), leg.coupler);
            assert_hole_distance(&assembly, "plate", leg.ground);
        }
    }
}

#[test]
fn a_rigid_strut_has_the_length_of_a_slotted_strut_and_lies_within_it() {
    for name in ["paper", "large", "unequal"] {
        let assembly = build_assembly(name);
        for (leg, rigid) in assembly.layout().legs.iter().zip(assembly.alternatives()) {
            let expected = [Vector::default(), Vector::new(leg.strut_length, 0.0)];
            let holes = find_clearance_holes(rigid);
            assert_eq!(holes, expected, "{name}: {}", rigid.name);
            let slotted_name = rigid.name.trim_start_matches("rigid ");
            let slotted = find_body(&assembly, slotted_name);
            assert_eq!(slotted.mount, rigid.mount);
            // The rigid strut lies within the slotted strut, so bodies clear of the slotted strut are clear of both.
            let (inner_z, outer_z) = (rigid.z(), slotted.z());
            let is_within = outer_z[0] <= inner_z[0] && inner_z[1] <= outer_z[1];
            assert!(is_within, "{name}");
            let bar = &rigid.prisms[0].filled_shapes[0];
            for prism in &slotted.prisms {
                let depth = bar.depth_in(&prism.filled_shapes[0], Default::default());
                assert!(depth > -1e-9, "{name}: {depth}");
            }
        }
    }
}

#[test]
fn the_pivots_of_the_plate_match_the_kinematics() {
    let assembly = build_assembly("unequal");
    let holes = find_clearance_holes(find_body(&assembly, "plate"));
    for leg in &assembly.layout().legs {
        for pivot in [leg.crank_pivot, leg.follower_pivot] {
            let is_at_pivot = |hole: &Vector| (*hole - pivot).length() < 1e-9;
            assert!(holes.iter().any(is_at_pivot), "{pivot:?}");
        }
    }
}

#[test]
fn the_position_of_each_foot_matches_the_contact_model() {
    for name in ["paper", "large", "unequal"] {
        let assembly = build_assembly(name);
        let robot = assembly.robot();
        for pose in assembly.grid_poses(7) {
            let sweeps = robot.sweeps(pose.pose.into());
            let feet = robot.ground().legs.foot_positions(sweeps);
            for (servo, [forward, left]) in feet.into_iter().enumerate() {
                let foot = Vector::new(-left, forward);
                let leg = &assembly.layout().legs[servo];
                // The points in the drawings.
                let angle = pose.legs[servo].direction.angle();
                let drawn_leg = leg.points_at(angle, angle);
                let point_on = |mount, point| assembly.placement(mount, &pose).map(point);
                let (crank, follower) = (Mount::Crank(servo), Mount::Follower(servo));
                let ([joint, follower_joint], anchors) =
                    (drawn_leg.joints, drawn_leg.strut_anchors);
                for (drawn, built) in [
                    (foot, point_on(Mount::Foot(servo), leg.foot)),
                    (drawn_leg.foot, foot),
                    (joint, point_on(crank, leg.crank_joint)),
                    (follower_joint, point_on(follower, leg.crank_joint)),
                    (anchors[0], point_on(Mount::Link(servo), leg.anchor)),
                    (anchors[1], point_on(crank, leg.anchor)),
                ] {
                    assert!((drawn - built).length() < 1e-9, "{name} {servo}");
                }
            }
        }
    }
}

#[test]
fn all_files_are_identical_in_every_run() {
    let make_files = || -> Vec<_> {
        let parts = build_assembly("unequal").collect_parts().into_iter();
        let files = parts.map(|part| make_part_files(&part, 0.2));
        let files = files.map(|files| files.expect("the part has a closed surface"));
        files.flatten().collect()
    };
    let (first, second) = (make_files(), make_files());
    assert!(first.len() > 50);
    assert!(first == second);
    let paths: BTreeSet<_> = first.iter().map(|file| &file.path).collect();
    assert_eq!(paths.len(), first.len(), "two files have the same path");
}

#[test]
fn a_link_is_cut_through_at_its_holes_and_milled_at_its_pockets() {
    let assembly = build_assembly("paper");
    let parts = assembly.collect_parts();
    let link = parts.iter().find(|part| part.name == "link A1 A3");
    let sheets = draw_sheets(link.expect("A1 and A3 have equal links"));
    assert_eq!(sheets.len(), 1);
    let layers = sheets[0].layers.iter();
    let layers = layers.map(|layer| (&*layer.name, layer.loops.len()));
    // Cut through: the outline, the holes of crank, arm, anchor and hub, and the holes of two small screws.
    // Pockets: for two hexagonal heads, for the horn, and for the head of the anchor's screw.
    let expected = [
        ("CUT", 7),
        ("POCKET_2.00_BOTTOM", 2),
        ("POCKET_2.20_TOP", 1),
        ("POCKET_1.90_TOP", 1),
    ];
    assert_eq!(layers.collect::<Vec<_>>(), expected);
}
