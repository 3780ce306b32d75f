//! Tests of the drawing of the cranks and the spline.

use lizard_host::draw::draw_horns;

use super::drawing::Point;
use super::files::{SERVOS, drawing_of, neutral_angle, paper_toml, robot_files};

#[test]
fn a_crank_is_drawn_at_and_labelled_with_its_neutral_angle() {
    for (name, text) in robot_files() {
        let drawing = drawing_of(draw_horns, &text);
        // All four cranks are drawn to the same scale.
        let link_length = |key: &str| -> f64 {
            let mut values = text
                .lines()
                .filter_map(|line| line.strip_prefix(key)?.trim().strip_prefix('='));
            let value = values.next().and_then(|value| value.split('#').next());
            value
                .expect(key)
                .trim()
                .parse()
                .expect("the value is a number")
        };
        let crank_of = |servo: &str| drawing.points_by_id(&format!("crank-{servo}"));
        let scales = SERVOS
            .iter()
            .zip(["l1", "l4", "l9", "l6"])
            .map(|(servo, key)| {
                let crank = crank_of(servo);
                (crank[1].0 - crank[0].0).hypot(crank[1].1 - crank[0].1) / link_length(key)
            });
        let scales: Vec<f64> = scales.collect();
        for scale in &scales {
            assert!((scale / scales[0] - 1.0).abs() < 1e-3, "{name}: {scales:?}");
        }
        for servo in SERVOS {
            let neutral = neutral_angle(&text, servo);
            let error = turn_between(neutral, direction(&crank_of(servo)));
            assert!(error.abs() < 0.02, "{name} {servo}: {error}");
            let label = &drawing.element_by_id(&format!("angle-{servo}")).content;
            assert_eq!(*label, format!("{neutral:.2}°"), "{name} {servo}");
        }
    }
}

/// The direction of a line, degrees counter-clockwise from the right. The drawing rounds points to hundredths of a
/// pixel, so only a line of more than 50 pixels has an accurate angle.
fn direction(line: &[Point]) -> f64 {
    let (x, y) = (line[1].0 - line[0].0, line[0].1 - line[1].1);
    assert!(x.hypot(y) > 50.0);
    y.atan2(x).to_degrees()
}

/// The counter-clockwise turn from one direction to another, degrees from -180 to 180.
fn turn_between(from: f64, to: f64) -> f64 {
    (to - from + 180.0).rem_euclid(360.0) - 180.0
}

#[test]
fn the_trim_of_the_example_turns_the_crank_to_its_neutral_angle() {
    for (name, text) in robot_files() {
        let drawing = drawing_of(draw_horns, &text);
        let [placed_crank, exact_crank] = ["sits", "should"].map(|id| drawing.points_by_id(id));
        let error = turn_between(neutral_angle(&text, "A1"), direction(&exact_crank));
        assert!(error.abs() < 0.02, "{name} {error}");
        let mut texts = drawing.texts();
        let trim = texts.find_map(|text| text.strip_prefix("trim 1 "));
        let trim = trim.expect("the drawing has a trim");
        let trim: f64 = trim.parse().expect("the value is a number");
        let error = turn_between(direction(&placed_crank), direction(&exact_crank)) - trim;
        assert!(error.abs() < 0.02, "{name} {error}");
        assert!(trim.abs() <= 7.2, "{trim} is more than half a tooth");
    }
}

#[test]
fn the_spline_has_25_teeth_and_a_crank_is_off_by_half_a_tooth_at_most() {
    let drawing = drawing_of(draw_horns, &paper_toml());
    let corners = drawing.points_by_id("spline");
    let count = corners.len() as f64;
    let mean_of = |axis: fn(&Point) -> f64| corners.iter().map(axis).sum::<f64>() / count;
    let middle = (mean_of(|point| point.0), mean_of(|point| point.1));
    let radius_of = |point: &Point| (point.0 - middle.0).hypot(point.1 - middle.1);
    let mean_radius = corners.iter().map(radius_of).sum::<f64>() / count;
    let teeth = (0..corners.len()).filter(|index| {
        let previous = &corners[(index + corners.len() - 1) % corners.len()];
        radius_of(previous) < mean_radius && radius_of(&corners[*index]) > mean_radius
    });
    assert_eq!(teeth.count(), 25);
    let text: String = drawing.texts().collect();
    assert!(
        text.contains("14.4° apart") && text.contains("7.2° at most"),
        "{text}"
    );
}
