//! Tests of the drawing of the cranks and the spline.

use lizard_host::draw::draw_horns;
use lizard_robot::Robot;

use super::drawing::{Drawing, Point};
use super::files::{SERVOS, files, paper, value_of};

#[test]
fn a_crank_is_drawn_and_named_at_its_neutral_angle() {
    for (name, text) in files() {
        let drawing = Drawing::of(&draw_horns(&Robot::parse(&text).expect("a robot")));
        // All four cranks have the same scale.
        let link_length = |key: &str| -> f64 {
            let line = text
                .lines()
                .find(|line| line.starts_with(&format!("{key} ")));
            let value = line
                .and_then(|line| line.split(['=', '#']).nth(1))
                .expect(key);
            value.trim().parse().expect("mm")
        };
        let scales = SERVOS
            .iter()
            .zip(["l1", "l4", "l9", "l6"])
            .map(|(servo, key)| {
                let crank = drawing.path(&format!("crank-{servo}"));
                (crank[1].0 - crank[0].0).hypot(crank[1].1 - crank[0].1) / link_length(key)
            });
        let scales: Vec<f64> = scales.collect();
        assert!(
            scales
                .iter()
                .all(|scale| (scale / scales[0] - 1.0).abs() < 1e-3),
            "{name}"
        );
        for servo in SERVOS {
            let neutral: f64 = value_of(&text, servo, "neutral").parse().expect("degrees");
            let crank = drawing.path(&format!("crank-{servo}"));
            assert!(
                turn_between(neutral, direction(&crank)).abs() < 0.02,
                "{name} {servo}"
            );
            let label = &drawing.element_by_id(&format!("angle-{servo}")).content;
            assert_eq!(*label, format!("{neutral:.2}°"), "{name} {servo}");
        }
    }
}

/// The direction of a line, degrees counter-clockwise from the right. Its end points are
/// rounded to hundredths of a pixel, so the line must be at least 50 pixels long for an
/// accurate angle.
fn direction(line: &[Point]) -> f64 {
    let (x, y) = (line[1].0 - line[0].0, line[0].1 - line[1].1);
    assert!(x.hypot(y) > 50.0);
    y.atan2(x).to_degrees()
}

/// The counter-clockwise turn from one direction to another.
fn turn_between(from: f64, to: f64) -> f64 {
    (to - from + 180.0).rem_euclid(360.0) - 180.0
}

#[test]
fn the_trim_of_the_example_turns_the_crank_to_its_neutral_angle() {
    for (name, text) in files() {
        let drawing = Drawing::of(&draw_horns(&Robot::parse(&text).expect("a robot")));
        let (placed_crank, exact_crank) = (drawing.path("sits"), drawing.path("should"));
        let neutral: f64 = value_of(&text, "A1", "neutral").parse().expect("degrees");
        assert!(
            turn_between(neutral, direction(&exact_crank)).abs() < 0.02,
            "{name}"
        );
        let texts = drawing.0.iter().map(|element| element.content.as_str());
        let trims: Vec<&str> = texts
            .filter_map(|content| content.strip_prefix("trim 1 "))
            .collect();
        let trim: f64 = trims[0].parse().expect("degrees");
        let error = turn_between(direction(&placed_crank), direction(&exact_crank)) - trim;
        assert!(error.abs() < 0.02, "{name} {error}");
        assert!(trim.abs() <= 7.2, "more than the teeth leave");
    }
}

#[test]
fn the_spline_has_25_teeth_and_a_crank_is_off_by_half_a_tooth_at_most() {
    let drawing = Drawing::of(&draw_horns(&Robot::parse(&paper()).expect("a robot")));
    let corners = drawing.path("spline");
    let count = corners.len() as f64;
    let sum = corners
        .iter()
        .fold((0.0, 0.0), |sum, point| (sum.0 + point.0, sum.1 + point.1));
    let middle = (sum.0 / count, sum.1 / count);
    let radius_of = |point: &Point| (point.0 - middle.0).hypot(point.1 - middle.1);
    let mean = corners.iter().map(radius_of).sum::<f64>() / count;
    let teeth = (0..corners.len()).filter(|index| {
        let previous = &corners[(index + corners.len() - 1) % corners.len()];
        radius_of(previous) < mean && radius_of(&corners[*index]) > mean
    });
    assert_eq!(teeth.count(), 25);
    let text: String = drawing
        .0
        .iter()
        .map(|element| element.content.as_str())
        .collect();
    assert!(
        text.contains("14.4° apart") && text.contains("7.2° at most"),
        "{text}"
    );
}
