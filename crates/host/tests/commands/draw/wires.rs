//! The wiring.

use lizard_host::draw::wiring;
use lizard_robot::Robot;

use super::drawing::{Drawing, Point};
use super::files::{SERVOS, files, paper, said};

/// The paper's robot with other pins.
fn with_pins(pins: [&str; 4]) -> String {
    let mut text = paper();
    for (servo, pin) in SERVOS.into_iter().zip(pins) {
        let before = format!(
            "[servo.{servo}]\npin = \"{}\"",
            said(&paper(), servo, "pin")
        );
        assert!(text.contains(&before));
        text = text.replace(&before, &format!("[servo.{servo}]\npin = \"{pin}\""));
    }
    text
}

/// Pins in many orders: with 17 of them, steps of any size never meet a pin twice.
fn many_pins() -> Vec<[String; 4]> {
    let name = |n: usize| {
        let n = n % 17;
        if n < 11 {
            format!("D{}", n + 2)
        } else {
            format!("A{}", n - 11)
        }
    };
    (1..17)
        .flat_map(|step| (step % 12..17).step_by(12).map(move |start| (start, step)))
        .map(|(start, step)| [0, 1, 2, 3].map(|k| name(start + k * step)))
        .collect()
}

#[test]
fn a_signal_ends_at_the_pin_that_the_file_names() {
    let pins = many_pins();
    let many = pins.iter().map(|pins| {
        let text = with_pins([0, 1, 2, 3].map(|servo| pins[servo].as_str()));
        (format!("{pins:?}"), text)
    });
    for (name, text) in files().into_iter().chain(many) {
        let drawing = Drawing::of(&wiring(&Robot::parse(&text).expect("a robot")));
        for servo in SERVOS {
            let pin = said(&text, servo, "pin");
            let end = *drawing
                .path(&format!("signal-{servo}"))
                .last()
                .expect("a path");
            assert_eq!(
                end,
                drawing.path(&format!("pin-{pin}"))[0],
                "{name} {servo}"
            );
            let words = format!("to {pin}");
            assert!(
                drawing.0.iter().any(|element| element.words == words),
                "{name}"
            );
        }
        crossings(&name, &drawing);
    }
}

/// No wire meets another but where it ends at its rail, where one to ground has to pass
/// over the red rail, and where a resistor ends at its signal.
fn crossings(name: &str, drawing: &Drawing) {
    let wires = drawing.wires();
    assert_eq!(wires.len(), 2 + 1 + 4 * 4, "{name}");
    let mut joints = 0;
    for (place, (a, path)) in wires.iter().enumerate() {
        for (b, other) in &wires[place + 1..] {
            let meet = path.windows(2).any(|one| {
                other.windows(2).any(|two| {
                    let apart = |axis: fn(Point) -> f64| {
                        let ends = |part: &[Point]| {
                            let (a, b) = (axis(part[0]), axis(part[1]));
                            (a.min(b), a.max(b))
                        };
                        let (one, two) = (ends(one), ends(two));
                        one.1 < two.0 || two.1 < one.0
                    };
                    !apart(|point| point.0) && !apart(|point| point.1)
                })
            });
            let may = match (*a, *b) {
                ("rail-plus", b) => ["plus-", "ground-", "pull-down-"]
                    .iter()
                    .any(|kind| b.starts_with(kind)),
                ("rail-ground", b) => ["ground-", "pull-down-", "uno-ground"]
                    .iter()
                    .any(|kind| b.starts_with(kind)),
                (a, b) => match (a.strip_prefix("pull-down-"), b.strip_prefix("signal-")) {
                    (Some(servo), Some(signal)) => servo == signal,
                    _ => false,
                },
            };
            assert_eq!(meet, may, "{name}: {a} and {b}");
            joints += usize::from(meet);
        }
    }
    assert_eq!(joints, 3 * 4 + 1 + 3 * 4, "{name}");
}

#[test]
fn every_part_of_a_wire_is_horizontal_or_vertical() {
    // What the test of crossings takes for granted.
    for (name, text) in files() {
        let drawing = Drawing::of(&wiring(&Robot::parse(&text).expect("a robot")));
        for (wire, path) in drawing.wires() {
            let straight = |part: &[Point]| part[0].0 == part[1].0 || part[0].1 == part[1].1;
            assert!(path.windows(2).all(straight), "{name} {wire}");
        }
    }
}

#[test]
fn pins_are_where_an_uno_has_them() {
    // Thousandths of an inch from the lower left corner, from Arduino's board file.
    const PINS: [(&str, Point); 9] = [
        ("D13", (1140.0, 2000.0)),
        ("D9", (1540.0, 2000.0)),
        ("D8", (1640.0, 2000.0)),
        ("D7", (1800.0, 2000.0)),
        ("D3", (2200.0, 2000.0)),
        ("D0", (2500.0, 2000.0)),
        ("A0", (2000.0, 100.0)),
        ("A3", (2300.0, 100.0)),
        ("A5", (2500.0, 100.0)),
    ];
    let drawing = Drawing::of(&wiring(&Robot::parse(&paper()).expect("a robot")));
    let at = |name: &str| drawing.path(&format!("pin-{name}"))[0];
    let scale = (at("D0").0 - at("D13").0) / (2500.0 - 1140.0);
    let (zero, first) = (at("D13"), PINS[0].1);
    for (name, mil) in PINS {
        let (x, y) = at(name);
        let off = (
            (x - zero.0) / scale - (mil.0 - first.0),
            (zero.1 - y) / scale - (mil.1 - first.1),
        );
        assert!(off.0.abs() < 1.0 && off.1.abs() < 1.0, "{name} {off:?}");
    }
}

#[test]
fn a_rail_that_is_measured_has_its_pin_marked() {
    let text = paper().replace(
        "[limits]",
        "[supply.rail]\npin = \"A3\"\nratio = 2.5\n[limits]",
    );
    let drawing = Drawing::of(&wiring(&Robot::parse(&text).expect("a robot")));
    let words = "A3 measures the red rail, divided by 2.50.";
    assert!(drawing.0.iter().any(|element| element.words == words));
    let fill = |pin: &str| drawing.named(pin).text("fill").to_string();
    assert_eq!(fill("pin-A3"), fill("pin-D9"));
    assert_ne!(fill("pin-A3"), fill("pin-A2"));
}
