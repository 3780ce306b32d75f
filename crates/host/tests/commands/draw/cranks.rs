//! Tests of the crank and spline drawing.

use lizard_host::draw::draw_cranks;
use lizard_robot::servo::SERVO_NAMES;

use super::drawing::Point;
use super::robot_files::{draw_robot, paper_toml, read_neutral_angle, read_robot_files};
use crate::harness::read_length;

#[test]
fn each_crank_is_drawn_and_labelled_at_its_neutral_angle() {
    for (name, text) in read_robot_files() {
        let drawing = draw_robot(draw_cranks, &text);
        // All four cranks are drawn to the same scale.
        let crank_points = |servo: &str| drawing.points_by_id(&format!("crank-{servo}"));
        let cranks = SERVO_NAMES.iter().zip(["l1", "l4", "l9", "l6"]);
        let scales = cranks.map(|(servo, key)| {
            let crank = crank_points(servo);
            (crank[1].0 - crank[0].0).hypot(crank[1].1 - crank[0].1) / read_length(&text, key)
        });
        let scales: Vec<f64> = scales.collect();
        for scale in &scales {
            assert!((scale / scales[0] - 1.0).abs() < 1e-3, "{name}: {scales:?}");
        }
        for servo in SERVO_NAMES {
            let neutral = read_neutral_angle(&text, servo);
            let error = angle_difference(neutral, compute_direction(&crank_points(servo)));
            assert!(error.abs() < 0.02, "{name} {servo}: {error} deg");
            let label = &drawing.element_by_id(&format!("angle-{servo}")).content;
            assert_eq!(*label, format!("{neutral:.2}°"), "{name} {servo}");
        }
    }
}

/// Computes the direction of a line, degrees, counter-clockwise from the +x axis. The drawing rounds points to
/// hundredths of a pixel, so the direction is accurate only for lines longer than 50 pixels.
fn compute_direction(line: &[Point]) -> f64 {
    let (x, y) = (line[1].0 - line[0].0, line[0].1 - line[1].1);
    assert!(x.hypot(y) > 50.0);
    y.atan2(x).to_degrees()
}

/// Returns the counter-clockwise angle from one direction to another, degrees from -180 to 180.
fn angle_difference(from: f64, to: f64) -> f64 {
    (to - from + 180.0).rem_euclid(360.0) - 180.0
}

#[test]
fn the_example_trim_turns_the_mounted_crank_to_its_neutral_angle() {
    for (name, text) in read_robot_files() {
        let drawing = draw_robot(draw_cranks, &text);
        let [mounted_crank, exact_crank] =
            ["fitted-crank", "exact-crank"].map(|id| drawing.points_by_id(id));
        let exact_direction = compute_direction(&exact_crank);
        let error = angle_difference(read_neutral_angle(&text, "A1"), exact_direction);
        assert!(error.abs() < 0.02, "{name}: {error} deg");
        let mut texts = drawing.texts();
        let trim = texts.find_map(|text| text.strip_prefix("trim 1 "));
        let trim = trim.expect("the drawing has a trim");
        let trim: f64 = trim.parse().expect("the value is a number");
        let error = angle_difference(compute_direction(&mounted_crank), exact_direction) - trim;
        assert!(error.abs() < 0.02, "{name}: {error} deg");
        assert!(trim.abs() <= 7.2, "{trim} deg is more than half a tooth");
    }
}

#[test]
fn the_spline_has_25_teeth_and_a_crank_is_at_most_half_a_tooth_off() {
    let drawing = draw_robot(draw_cranks, &paper_toml());
    let corners = drawing.points_by_id("spline");
    let corner_count = corners.len() as f64;
    let mean = |axis: fn(&Point) -> f64| corners.iter().map(axis).sum::<f64>() / corner_count;
    let middle = (mean(|point| point.0), mean(|point| point.1));
    let radius = |point: &Point| (point.0 - middle.0).hypot(point.1 - middle.1);
    let mean_radius = corners.iter().map(radius).sum::<f64>() / corner_count;
    let teeth = (0..corners.len()).filter(|index| {
        let previous = &corners[(index + corners.len() - 1) % corners.len()];
        radius(previous) < mean_radius && radius(&corners[*index]) > mean_radius
    });
    assert_eq!(teeth.count(), 25);
    let text: String = drawing.texts().collect();
    assert!(
        text.contains("14.4° apart") && text.contains("at most 7.2°"),
        "{text}"
    );
}
