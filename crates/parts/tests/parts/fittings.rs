//! Tests that each fitting (supply, strips, plugs) has a space on the robot that its example products fit into, and
//! tests of the sizes, ratings and price classes of bought parts.

use lizard_kinematics::Vector;
use lizard_parts::{
    Assembly, BATTERY_EXAMPLES, Body, Fitting, Kind, PriceClass, Shape, format_mounting_table,
};
use lizard_robot::{FUSE_RATING_A, MIN_SWITCH_RATING_A};

use crate::{ROBOTS, build_assembly, compute_bill};

/// Finds the bodies of a fitting.
fn find_bodies(assembly: &Assembly, fitting: Fitting) -> Vec<&Body> {
    let bodies = assembly.bodies().iter();
    let bodies = bodies.filter(|body| body.kind == Kind::Fitting(fitting));
    bodies.collect()
}

/// Computes the extents of points along x and y, mm.
fn compute_extents(points: &[Vector]) -> [f64; 2] {
    let extent = |coordinate: fn(&Vector) -> f64| {
        let coordinates = points.iter().map(coordinate);
        coordinates.clone().fold(f64::MIN, f64::max) - coordinates.fold(f64::MAX, f64::min)
    };
    [extent(|point| point.x), extent(|point| point.y)]
}

/// Sorts the side lengths of a box in ascending order, so that a product may be turned to fit.
fn sort_lengths(mut size: [f64; 3]) -> [f64; 3] {
    size.sort_by(f64::total_cmp);
    size
}

#[test]
fn both_example_products_fit_into_the_space_of_their_fitting() {
    for name in ROBOTS {
        let assembly = build_assembly(name, "");
        for fitting in Fitting::ALL {
            let spec = fitting.spec();
            let bodies = find_bodies(&assembly, fitting);
            let expected_count = if fitting == Fitting::Resistor { 4 } else { 1 };
            assert_eq!(bodies.len(), expected_count, "{name}: {}", spec.name);
            // A strap goes around other parts, so it has no box.
            if fitting == Fitting::Strap {
                continue;
            }
            for body in bodies {
                let shapes = body.prisms.iter().map(|prism| &prism.filled_shapes[0]);
                let points: Vec<_> = shapes.flat_map(|shape| shape.points.clone()).collect();
                let [width, length] = compute_extents(&points);
                let [low, high] = body.z();
                let space = sort_lengths([width, length, high - low]);
                for product in spec.examples {
                    let size = sort_lengths(product.size);
                    let mut lengths = size.iter().zip(space);
                    let fits = lengths.all(|(length, limit)| *length <= limit + 1e-9);
                    assert!(fits, "{product} in {space:?}");
                }
            }
        }
    }
}

#[test]
fn both_example_batteries_fit_into_every_robots_battery_space() {
    for name in ROBOTS {
        let assembly = build_assembly(name, "");
        let space = assembly.robot().parts().battery;
        for product in BATTERY_EXAMPLES {
            let mut lengths = product.size.iter().zip(space);
            let fits = lengths.all(|(length, limit)| *length <= limit);
            assert!(fits, "{name}: {product} in {space:?}");
            assert!(format_mounting_table(space).contains(product.name));
        }
        // The table lists no battery for a space into which none fits.
        assert!(!format_mounting_table([20.0, 30.0, 10.0]).contains(BATTERY_EXAMPLES[0].name));
    }
}

#[test]
fn the_default_screw_and_nut_have_the_sizes_of_their_standards() {
    let screw = lizard_robot::Parts::default().screw;
    // ISO 7380-1 for M3: head 5.70 x 1.65 mm, drawn up to 0.1 mm higher; DIN 985: 5.5 mm across flats, 4.0 mm high.
    assert_eq!([screw.diameter, screw.head], [3.0, 5.7]);
    assert!((1.65..1.75).contains(&screw.head_height));
    assert_eq!([screw.nut, screw.nut_height], [5.5, 4.0]);
}

#[test]
fn a_product_size_without_a_drawing_is_marked_as_approximate() {
    let [exact, approximate] = Fitting::RadioSpace.spec().examples;
    assert_eq!(exact.to_string(), "HM-10, bare board: 13 x 27 x 2.2");
    let is_marked = approximate.to_string().ends_with(": ~16 x 37 x 7");
    assert!(is_marked, "{approximate}");
}

#[test]
fn a_cable_tie_reaches_around_the_alarm_and_the_deck() {
    /// Length of a 140 mm tie that cannot be part of its loop, according to makers, mm: the head, and a tip without
    /// teeth.
    const UNUSABLE_MM: f64 = 42.0;
    let assembly = build_assembly("paper", "");
    let bill = compute_bill(&assembly);
    let mut item_names = bill.bought.iter().map(|item| &item.name);
    let item_name = item_names.find(|name| name.starts_with("cable tie"));
    let item_name = item_name.expect("the bill lists cable ties");
    let number = item_name.trim_end_matches(" mm long").rsplit(' ').next();
    let tie_length: f64 = number.expect(item_name).parse().expect(item_name);
    let deck = &assembly.body("deck").expect("the robot has a deck").prisms[0];
    let middle_shape = &deck.filled_shapes[0];
    let [width, _] = compute_extents(&middle_shape.points);
    let [_, _, alarm_height] = Fitting::Alarm.spec().size;
    let height = alarm_height + deck.z[1] - deck.z[0];
    let loop_length = 2.0 * (width + 2.0 * middle_shape.radius + height);
    assert!(loop_length < tie_length - UNUSABLE_MM, "{loop_length} mm");
}

#[test]
fn no_fitting_covers_a_slot_for_a_cable_tie() {
    // Cable ties go through the deck beside their fittings.
    let assembly = build_assembly("paper", "");
    let deck = assembly.body("deck").expect("the robot has a deck");
    let is_slot = |cut: &&Shape| {
        let [x_extent, y_extent] = compute_extents(&cut.points);
        let width_mm = x_extent.min(y_extent) + 2.0 * cut.radius;
        cut.points.len() > 1 && (1.9..2.1).contains(&width_mm)
    };
    let slots = deck.prisms[0].cut_shapes.iter().filter(is_slot);
    let mut slot_count = 0;
    for slot in slots {
        for body in assembly.bodies() {
            if !matches!(body.kind, Kind::Fitting(_)) || body.z()[0] < deck.z()[0] {
                continue;
            }
            for prism in &body.prisms {
                let distance = prism.filled_shapes[0].distance(slot);
                assert!(distance > 0.05, "{}: {distance} mm", body.name);
            }
        }
        slot_count += 1;
    }
    assert_eq!(
        slot_count, 5,
        "two for signals, two for the fuse, one for the switch"
    );
}

#[test]
fn the_fuse_carries_the_converters_current_and_the_item_names_state_both_ratings() {
    // The battery's current for 3 A at 5 V, with two cells at 3.2 V and a converter that loses 15 %.
    let max_amperes = 3.0 * 5.0 / (0.85 * 2.0 * 3.2);
    assert!(max_amperes < f64::from(FUSE_RATING_A), "{max_amperes} A");
    for (fitting, rating) in [
        (Fitting::Fuse, FUSE_RATING_A),
        (Fitting::Switch, MIN_SWITCH_RATING_A),
    ] {
        let item_name = fitting.format_item_name();
        assert!(item_name.contains(&format!(" {rating} A ")), "{item_name}");
    }
}

#[test]
fn price_classes_are_contiguous_and_a_sum_adds_their_bounds() {
    for pair in PriceClass::ALL.windows(2) {
        assert_eq!(pair[0].euro_range()[1], pair[1].euro_range()[0]);
    }
    let classes = [PriceClass::A, PriceClass::C, PriceClass::C, PriceClass::E];
    let sum = PriceClass::sum(classes.into_iter());
    assert_eq!(sum, [3 + 3 + 15, 1 + 7 + 7 + 30]);
    let text = PriceClass::explanation();
    for phrase in ["A up to 1", "E 15 to 30", "2026", "vary"] {
        assert!(text.contains(phrase), "{text}");
    }
}
