//! Tests of the details that matter to the person who builds the robot: leads, springs, screw lengths, walls, marks,
//! bridged holes.
//!
//! The layers' outlines are tested point by point, so the tests do not depend on the shapes in the proof of fit.

use std::collections::BTreeSet;

use lizard_kinematics::{End, Vector};
use lizard_parts::{Body, Kind, Loop, Mesh, Outline, Part, Prism, Solid, build_coupon};

use crate::{
    ROBOTS, build_assembly, build_assembly_with_changed_body, build_slotted_assembly, find_body,
};

fn vector(x: f64, y: f64) -> Vector {
    Vector::new(x, y)
}

/// Lists the points of a rectangle with this centre and size, at intervals of at most 0.3 mm.
fn list_rectangle_points(centre: Vector, size: Vector) -> Vec<Vector> {
    let offsets_over = |size: f64| {
        let count = (size / 0.3).ceil() as i32;
        (0..=count).map(move |i| size * (f64::from(i) / f64::from(count) - 0.5))
    };
    let rows = offsets_over(size.x).flat_map(|x| offsets_over(size.y).map(move |y| vector(x, y)));
    rows.map(|offset| centre + offset).collect()
}

/// Computes the heights and the outline of each layer.
fn compute_outlines(prisms: &[Prism]) -> Vec<([f64; 2], Outline)> {
    let layers = prisms.iter();
    let outlines = layers.map(|prism| (prism.z, Outline::from_prism(prism)));
    outlines.collect()
}

#[test]
fn the_plate_has_openings_for_the_servos_with_their_leads() {
    for name in ROBOTS {
        let assembly = build_assembly(name, "");
        let servo = assembly.robot().parts().servo;
        let plate = compute_outlines(&find_body(&assembly, "plate").prisms);
        for end in End::ALL {
            for servo_index in end.servos() {
                let case_centre = assembly.layout().plate.case_centres[servo_index];
                let edge = case_centre + vector(0.0, end.sign() * servo.length / 2.0);
                // The lead is 4 x 1.2 mm, at the shaft's end of the case.
                let lead =
                    list_rectangle_points(edge + vector(0.0, end.sign() * 0.6), vector(4.0, 1.2));
                let case = list_rectangle_points(case_centre, vector(servo.width, servo.length));
                for (z, outline) in &plate {
                    for point in lead.iter().chain(&case) {
                        let (is_filled, number) = (outline.contains(*point), servo_index + 1);
                        assert!(!is_filled, "{name} A{number}: {point:?} {z:?}");
                    }
                }
                // The shaft is at the lead's end of the case.
                let shaft = assembly.layout().shafts[servo_index];
                assert!((shaft - edge).length() < servo.shaft + 1e-9);
            }
        }
    }
}

#[test]
fn the_coupon_has_the_openings_of_the_plate() {
    let assembly = build_assembly("paper", "");
    let parts = assembly.robot().parts();
    let [coupon, _] = build_coupon(parts);
    let floor = Outline::from_prism(&coupon.prisms[0]);
    // The largest holes are the openings, one for each fit.
    let mut holes: Vec<&Loop> = floor.islands[0][1..].iter().collect();
    holes.sort_by(|a, b| a.area().total_cmp(&b.area()));
    let mut areas: Vec<f64> = holes.iter().take(5).map(|hole| -hole.area()).collect();
    areas.sort_by(f64::total_cmp);
    for (column, area) in areas.into_iter().enumerate() {
        let fit = 0.1 * column as f64;
        let case_area = (parts.servo.length + 2.0 * fit) * (parts.servo.width + 2.0 * fit);
        // The lead's notch is 5 mm wide, and extends 1.2 mm beyond the case and its clearance.
        let expected = case_area + 5.0 * 1.2;
        let is_near = (area - expected).abs() < 1e-6;
        assert!(is_near, "{column}: {area} {expected}");
    }
}

#[test]
fn a_mounted_coil_extends_between_its_hooks_and_lies_in_its_strut() {
    for name in ROBOTS {
        let assembly = build_slotted_assembly(name, "");
        let parts = assembly.robot().parts();
        for (leg_index, leg) in ["LF", "RF", "RH", "LH"].into_iter().enumerate() {
            let [spring, strut] =
                ["spring", "strut"].map(|noun| find_body(&assembly, &format!("{noun} {leg}")));
            let shape = &spring.prisms[0].filled_shapes[0];
            let x = shape.points.iter().map(|point| point.x);
            let length = x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min);
            // Each hook has the coil's inner diameter, and goes around the far side of an M3 screw.
            let inner_diameter = parts.spring.outer_diameter - 2.0 * parts.spring.wire_diameter;
            let expected_length =
                assembly.layout().legs[leg_index].strut_length + 3.0 - 2.0 * inner_diameter;
            let is_near = (length - expected_length).abs() < 1e-9;
            assert!(is_near, "{name} {leg}: {length} {expected_length}");
            if name == "paper" {
                assert!((length - 24.5).abs() < 0.01, "{length}");
            }
            let (bottom, top) = (spring.z()[0], spring.z()[1]);
            let coil_centre = shape.middle();
            // The coil also lies in its strut when the leg lags as much as the slot allows.
            for lag in [0.0, 2.5, 5.0] {
                let size = vector(length + lag, parts.spring.outer_diameter);
                for (z, outline) in compute_outlines(&strut.prisms) {
                    if z[1] <= bottom || top <= z[0] {
                        continue;
                    }
                    for point in list_rectangle_points(coil_centre + vector(lag / 2.0, 0.0), size) {
                        assert!(!outline.contains(point), "{name} {leg}: {point:?} {z:?}");
                    }
                }
            }
            let link = find_body(&assembly, &format!("link A{}", leg_index + 1));
            assert!(link.z()[0] - top > 0.2, "{name}: {top}");
        }
    }
}

#[test]
fn a_coil_that_is_too_high_in_its_strut_is_refused() {
    let altered_assembly = build_assembly_with_changed_body("spring LF", |spring| {
        spring.prisms[0].z = spring.prisms[0].z.map(|z| z + 0.6);
    });
    let has_spring = |a: &Body, b: &Body| a.name == "spring LF" || b.name == "spring LF";
    let proof = altered_assembly.prove_chosen(has_spring, |_, _| ());
    let clash = proof.check();
    let clash = clash.expect_err("the coil must be refused as too close to the link");
    assert!(clash.to_string().contains("link A1"), "{clash}");
}

#[test]
fn every_screw_has_a_length_that_shops_sell() {
    for name in ROBOTS {
        for kind in ["strut", "rigid"] {
            let assembly = build_assembly(name, &format!("[leg.drive]\nkind = \"{kind}\""));
            let screws = assembly.bodies().iter().filter_map(|body| match body.kind {
                Kind::Screw(length) | Kind::HexScrew(length) => Some((&body.name, length)),
                _ => None,
            });
            assert!(screws.clone().count() > 40);
            for (screw, length) in screws {
                let sold_lengths = [6.0, 8.0, 10.0, 12.0, 16.0, 20.0];
                assert!(sold_lengths.contains(&length), "{name}: {screw} {length}");
            }
        }
    }
}

#[test]
fn the_horn_screws_do_not_reach_the_servo_boss() {
    for name in ROBOTS {
        let assembly = build_assembly(name, "");
        let boss_z = assembly.stack().servo_bottom + assembly.robot().parts().servo.boss;
        let bodies = assembly.bodies().iter();
        let screws = bodies.filter(|body| matches!(body.kind, Kind::HornScrew(_)));
        let tip_heights = screws.map(|screw| screw.z()[0]);
        assert_eq!(tip_heights.clone().count(), 8);
        let min_tip_z = tip_heights.fold(f64::MAX, f64::min);
        assert!(min_tip_z > boss_z + 0.5, "{name}");
    }
}

/// Lists the points along a loop, at intervals of at most 0.2 mm.
fn list_loop_points(outline_loop: &Loop) -> Vec<Vector> {
    let mut points = Vec::new();
    for (side, end) in outline_loop.sides_with_end_points() {
        let chord = end - side.from;
        match side.arc(end) {
            None => {
                let count = (chord.length() / 0.2).ceil() as u32;
                let step = chord * (1.0 / f64::from(count));
                points.extend((0..count).map(|i| side.from + step * f64::from(i)));
            }
            Some((centre, radius)) => {
                let arc_angle = 4.0 * side.bulge.atan();
                let count = (arc_angle.abs() * radius / 0.2).ceil() as u32;
                let arm = side.from - centre;
                points.extend((0..count).map(|i| {
                    let (sin, cos) = (arc_angle * f64::from(i) / f64::from(count)).sin_cos();
                    centre + arm * cos + arm.rotated_left() * sin
                }));
            }
        }
    }
    points
}

/// Computes the thickness of the thinnest wall between two loops of a part's layer, mm.
fn compute_min_wall_thickness(part: &Part) -> f64 {
    let mut min_mm = f64::INFINITY;
    for prism in &part.prisms {
        for island in &Outline::from_prism(prism).islands {
            let point_loops: Vec<_> = island.iter().map(list_loop_points).collect();
            for (i, points) in point_loops.iter().enumerate() {
                let other_loops = point_loops[i + 1..].iter();
                let pairs = other_loops
                    .flat_map(|other_loop| points.iter().map(move |point| (other_loop, point)));
                for (other_loop, point) in pairs {
                    let distances = other_loop.iter();
                    let distances = distances.map(|other_point| (*other_point - *point).length());
                    min_mm = distances.fold(min_mm, f64::min);
                }
            }
        }
    }
    min_mm
}

#[test]
fn walls_beside_pockets_and_holes_are_at_least_as_thick_as_in_robot_toml() {
    for name in ["paper", "unequal"] {
        let assembly = build_assembly(name, "");
        let wall = assembly.robot().parts().wall;
        let mut checked_count = 0;
        for part in assembly.collect_parts() {
            // These parts have thinner walls by design. In the plate, the servos' screws are close to the openings, and
            // the engraved strokes are close to each other. In a link, the horn's screws are close to the hub. The coil
            // limits the thickness of a ring. A pad's dome tapers to zero at its hole.
            let exceptions = ["plate", "link", "strut ring", "pad"];
            let mut exceptions = exceptions.into_iter();
            if exceptions.any(|prefix| part.name.starts_with(prefix)) {
                continue;
            }
            let min_mm = compute_min_wall_thickness(&part);
            let part_name = &part.name;
            assert!(min_mm > wall - 0.02, "{name}: {part_name} {min_mm:.2} mm");
            checked_count += 1;
        }
        assert!(checked_count > 10);
    }
}

#[test]
fn a_wall_surrounds_each_hexagonal_pocket_of_a_link() {
    let assembly = build_assembly("paper", "");
    let wall = assembly.robot().parts().wall;
    let link = find_body(&assembly, "link A1");
    let floor = Outline::from_prism(&link.prisms[0]);
    let outer_points = list_loop_points(&floor.islands[0][0]);
    let mut pocket_count = 0;
    for hole in &floor.islands[0][1..] {
        if hole.sides.len() != 6 {
            continue;
        }
        pocket_count += 1;
        for point in list_loop_points(hole) {
            let distances = outer_points
                .iter()
                .map(|outer_point| (*outer_point - point).length());
            let wall_mm = distances.fold(f64::INFINITY, f64::min);
            assert!(wall_mm > wall - 0.02, "{wall_mm} mm");
        }
    }
    assert_eq!(pocket_count, 2);
}

#[test]
fn parts_that_look_alike_have_different_marks() {
    for name in ["paper", "large", "unequal"] {
        let parts = build_assembly(name, "").collect_parts();
        let part_noun = |part: &Part| {
            let name = &*part.body_names[0];
            let noun = name.rsplit_once(' ').map_or(name, |(noun, _)| noun);
            noun.to_owned()
        };
        let mut marks = BTreeSet::new();
        for part in &parts {
            let has_same_noun = |listed: &&Part| part_noun(listed) == part_noun(part);
            let same_noun_parts = parts.iter().filter(has_same_noun);
            let is_spacer = part.name.starts_with("spacer");
            let is_unmarked = same_noun_parts.count() == 1 || is_spacer;
            assert_eq!(part.mark.is_empty(), is_unmarked, "{}", part.name);
            if part.mark.is_empty() {
                continue;
            }
            let is_new = marks.insert((part_noun(part), part.mark.clone()));
            assert!(
                is_new,
                "{name}: two parts that look alike have the same mark"
            );
            // The engraved mark removes some of the part's material.
            let (printed_layers, bridged_count) = part.build_printed_layers();
            let solid = Solid::from_prisms(&printed_layers);
            let bridge_volume = 0.3 * 9.0 * bridged_count as f64;
            let max_volume = part.volume() + bridge_volume - 0.5;
            assert!(solid.volume < max_volume, "{name}: {}", part.name);
            let mesh = Mesh::from_solid(&solid);
            assert!(mesh.is_closed(), "{name}: {}", part.name);
        }
        let has_mark = |noun: &str, mark: &str| marks.contains(&(noun.to_owned(), mark.to_owned()));
        for (noun, mark) in match name {
            "unequal" => [("link", "1"), ("link", "2"), ("crank", "3")],
            _ => [("link", "13"), ("link", "24"), ("crank", "24")],
        } {
            assert!(has_mark(noun, mark), "{name}: {marks:?}");
        }
    }
}

#[test]
fn no_hole_of_a_printed_part_begins_in_mid_air() {
    for name in ["paper", "large", "unequal"] {
        let mut bridged_count = 0;
        for part in build_assembly(name, "").collect_parts() {
            let (printed_layers, part_bridged_count) = part.build_printed_layers();
            bridged_count += part_bridged_count * part.count();
            for pair in compute_outlines(&printed_layers).windows(2) {
                let [([_, top_below], outline_below), (z, outline)] = pair else {
                    continue;
                };
                let part_name = &part.name;
                assert!((top_below - z[0]).abs() < 1e-9, "{name}: {part_name}");
                assert!(z[1] > z[0] + 0.01, "{name}: {part_name}");
                let is_hole = |outline_loop: &&Loop| outline_loop.area() < 0.0;
                for hole in outline.loops().filter(is_hole) {
                    // The layer below supports this layer at some point beside the hole.
                    let Some((centre, radius)) = hole.circle() else {
                        continue;
                    };
                    let is_supported = (0..24).any(|i| {
                        let direction = Vector::from_angle(15.0 * f64::from(i));
                        outline_below.contains(centre + direction * (radius + 0.2))
                    });
                    assert!(is_supported, "{name}: {part_name} at {z:?}");
                }
            }
        }
        // Each link has two bridged holes; each crank, foot and pad has one.
        assert_eq!(bridged_count, 20, "{name}");
    }
}
