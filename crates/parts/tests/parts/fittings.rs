//! Tests of the fittings (supply, strips, plugs): each has a space on the robot, and products that fit into it.

use lizard_kinematics::Vector;
use lizard_parts::{Assembly, BATTERY_EXAMPLES, Body, Fitting, Kind, Price, Shape, places_table};
use lizard_robot::{FUSE_RATING_A, MIN_SWITCH_RATING_A};

use crate::{ROBOTS, assembly};

/// The bodies of a fitting.
fn bodies_of(assembly: &Assembly, fitting: Fitting) -> Vec<&Body> {
    let bodies = assembly.bodies().iter();
    bodies
        .filter(|body| body.kind == Kind::Fitting(fitting))
        .collect()
}

/// The extents of points along x and y, mm.
fn extents(points: &[Vector]) -> [f64; 2] {
    let extent_of = |coordinate_of: fn(&Vector) -> f64| {
        let coordinates = points.iter().map(coordinate_of);
        coordinates.clone().fold(f64::MIN, f64::max) - coordinates.fold(f64::MAX, f64::min)
    };
    [extent_of(|point| point.x), extent_of(|point| point.y)]
}

/// Sorts the side lengths of a box, the shortest first, so that a product may be turned to fit.
fn sort_lengths(mut size: [f64; 3]) -> [f64; 3] {
    size.sort_by(f64::total_cmp);
    size
}

#[test]
fn both_products_named_for_a_fitting_fit_into_the_space_of_its_body() {
    for name in ROBOTS {
        let assembly = assembly(name, "");
        for fitting in Fitting::ALL {
            let facts = fitting.facts();
            let bodies = bodies_of(&assembly, fitting);
            let expected_count = if fitting == Fitting::Resistor { 4 } else { 1 };
            assert_eq!(bodies.len(), expected_count, "{name}: {}", facts.name);
            // A strap goes around other parts, so it has no box.
            if fitting == Fitting::Strap {
                continue;
            }
            for body in bodies {
                let shapes = body.prisms.iter().map(|prism| &prism.filled_shapes[0]);
                let points: Vec<_> = shapes.flat_map(|shape| shape.points.clone()).collect();
                let [width, length] = extents(&points);
                let [low, high] = body.z();
                let space = sort_lengths([width, length, high - low]);
                for product in facts.examples {
                    let size = sort_lengths(product.size);
                    let fits = size
                        .iter()
                        .zip(space)
                        .all(|(length, limit)| *length <= limit + 1e-9);
                    assert!(fits, "{product} in {space:?}");
                }
            }
        }
    }
}

#[test]
fn both_named_batteries_fit_into_the_space_of_every_robots_battery() {
    for name in ROBOTS {
        let assembly = assembly(name, "");
        let space = assembly.robot().parts().battery;
        for product in BATTERY_EXAMPLES {
            let fits = product
                .size
                .iter()
                .zip(space)
                .all(|(length, limit)| *length <= limit);
            assert!(fits, "{name}: {product} in {space:?}");
            assert!(places_table(space).contains(product.name));
        }
        // A space into which no known battery fits lists no battery.
        assert!(!places_table([20.0, 30.0, 10.0]).contains(BATTERY_EXAMPLES[0].name));
    }
}

#[test]
fn screws_and_nuts_that_are_drawn_have_the_sizes_of_their_standards() {
    let screw = lizard_robot::Parts::default().screw;
    // ISO 7380-1 for M3: head 5.70 x 1.65 mm, drawn up to 0.1 mm higher; DIN 985: 5.5 mm across flats, 4.0 mm high.
    assert_eq!([screw.diameter, screw.head], [3.0, 5.7]);
    assert!((1.65..1.75).contains(&screw.head_height));
    assert_eq!([screw.nut, screw.nut_height], [5.5, 4.0]);
}

#[test]
fn a_product_size_without_a_drawing_is_marked_as_approximate() {
    let [by_data_sheet, approximate] = Fitting::RadioSpace.facts().examples;
    assert_eq!(
        by_data_sheet.to_string(),
        "HM-10, bare board: 13 x 27 x 2.2"
    );
    assert!(
        approximate.to_string().ends_with(": ~16 x 37 x 7"),
        "{approximate}"
    );
}

#[test]
fn a_radio_module_of_either_common_size_has_a_place() {
    let assembly = assembly("paper", "");
    let [body] = bodies_of(&assembly, Fitting::RadioSpace)[..] else {
        panic!("there is exactly one place for a radio module")
    };
    let [width, length] = extents(&body.prisms[0].filled_shapes[0].points);
    assert!(width >= 16.0 && length >= 37.0, "{width} {length}");
}

#[test]
fn no_fitting_covers_a_slot_for_a_cable_tie() {
    // Cable ties go through the deck beside the parts that they hold.
    let assembly = assembly("paper", "");
    let deck = assembly.body("deck").expect("the robot has a deck");
    let is_slot = |cut: &&Shape| {
        let [along_x, along_y] = extents(&cut.points);
        let width_mm = along_x.min(along_y) + 2.0 * cut.radius;
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
                assert!(distance > 0.05, "{}: {distance}", body.name);
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
fn the_fuse_carries_what_the_converter_draws_and_the_list_names_both_ratings() {
    // The battery's current for 3 A at 5 V: two cells at 3.2 V, and a converter that loses 15 %.
    let max_amperes = 3.0 * 5.0 / (0.85 * 2.0 * 3.2);
    assert!(max_amperes < f64::from(FUSE_RATING_A), "{max_amperes}");
    for (fitting, rating) in [
        (Fitting::Fuse, FUSE_RATING_A),
        (Fitting::Switch, MIN_SWITCH_RATING_A),
    ] {
        assert!(
            fitting
                .shopping_list_row()
                .contains(&format!(" {rating} A "))
        );
    }
}

#[test]
fn price_classes_adjoin_and_their_sum_adds_up_their_limits() {
    for pair in Price::ALL.windows(2) {
        assert_eq!(pair[0].euros()[1], pair[1].euros()[0]);
    }
    let classes = [Price::A, Price::C, Price::C, Price::E];
    assert_eq!(
        Price::sum(classes.into_iter()),
        [3 + 3 + 15, 1 + 7 + 7 + 30]
    );
    let text = Price::explanation();
    for phrase in ["A up to 1", "E 15 to 30", "2026", "vary"] {
        assert!(text.contains(phrase), "{text}");
    }
}
