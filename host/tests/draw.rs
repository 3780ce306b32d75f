//! What a builder follows: pins, wires and angles of the drawings are those of
//! robot.toml, for every robot.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use lizard_host::draw::{horns, wiring};
use lizard_robot::Robot;
use svg::parser::Event;

const SERVOS: [&str; 4] = ["A1", "A2", "A3", "A4"];

type Point = (f64, f64);

/// An element of a drawing: its tag, its attributes, the words in it.
#[derive(Debug)]
struct Element {
    tag: String,
    attributes: HashMap<String, String>,
    words: String,
}

impl Element {
    fn text(&self, key: &str) -> &str {
        self.attributes.get(key).map_or("", String::as_str)
    }

    fn number(&self, key: &str) -> f64 {
        let text = self.text(key);
        let number = text
            .parse()
            .unwrap_or_else(|_| panic!("{key}={text} of {self:?}"));
        assert!(f64::is_finite(number), "{self:?}");
        number
    }

    /// The places that it is drawn through.
    fn points(&self) -> Vec<Point> {
        let at = |x, y| (self.number(x), self.number(y));
        match self.tag.as_str() {
            "line" => vec![at("x1", "y1"), at("x2", "y2")],
            "circle" => vec![at("cx", "cy")],
            "text" => vec![at("x", "y")],
            "rect" => {
                let (x, y) = at("x", "y");
                let (width, height) = at("width", "height");
                vec![(x, y), (x + width, y + height)]
            }
            "polyline" | "polygon" => self
                .text("points")
                .split(' ')
                .map(|pair| {
                    let (x, y) = pair.split_once(',').expect("x,y");
                    (x.parse().expect("x"), y.parse().expect("y"))
                })
                .collect(),
            _ => vec![],
        }
    }
}

/// The elements of a drawing.
struct Drawing(Vec<Element>);

impl Drawing {
    fn of(svg: &str) -> Self {
        let mut elements: Vec<Element> = Vec::new();
        for event in svg::read(svg).expect("SVG") {
            match event {
                Event::Tag(tag, kind, attributes) if kind != svg::node::element::tag::Type::End => {
                    elements.push(Element {
                        tag: tag.into(),
                        attributes: attributes
                            .iter()
                            .map(|(key, value)| (key.clone(), value.to_string()))
                            .collect(),
                        words: String::new(),
                    });
                }
                Event::Text(words) => elements.last_mut().expect("a tag").words += words,
                Event::Error(error) => panic!("{error}"),
                _ => {}
            }
        }
        Self(elements)
    }

    fn named(&self, id: &str) -> &Element {
        let mut found = self.0.iter().filter(|element| element.text("id") == id);
        let element = found.next().unwrap_or_else(|| panic!("no {id}"));
        assert!(found.next().is_none(), "{id} twice");
        element
    }

    fn path(&self, id: &str) -> Vec<Point> {
        self.named(id).points()
    }

    /// Every wire and rail by its name.
    fn wires(&self) -> Vec<(&str, Vec<Point>)> {
        self.0
            .iter()
            .filter(|element| element.tag == "polyline" && !element.text("id").is_empty())
            .map(|element| (element.text("id"), element.points()))
            .collect()
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every file of robots/: its name and its text.
fn files() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(root().join("robots")).expect("robots/");
    let files: Vec<(String, String)> = folder
        .map(|entry| entry.expect("a file").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("a robot");
            (path.display().to_string(), text)
        })
        .collect();
    assert!(files.len() >= 4);
    files
}

/// What a file says of a servo, read by eye: the first line with this key after the
/// servo's table begins.
fn said<'a>(text: &'a str, servo: &str, key: &str) -> &'a str {
    let (_, table) = text
        .split_once(&format!("[servo.{servo}]"))
        .expect("a servo");
    let line = table
        .lines()
        .find(|line| line.starts_with(&format!("{key} =")))
        .expect(key);
    line.split_once('=')
        .expect("a value")
        .1
        .trim()
        .trim_matches('"')
}

fn paper() -> String {
    std::fs::read_to_string(root().join("robots/paper.toml")).expect("robots/paper.toml")
}

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

/// No wire meets another but where it ends at its rail, and where a brown one has to
/// pass over the red rail.
fn crossings(name: &str, drawing: &Drawing) {
    let wires = drawing.wires();
    assert_eq!(wires.len(), 2 + 1 + 3 * 4, "{name}");
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
                ("rail-plus", b) => b.starts_with("plus-") || b.starts_with("ground-"),
                ("rail-ground", b) => b.starts_with("ground-") || b == "uno-ground",
                _ => false,
            };
            assert_eq!(meet, may, "{name}: {a} and {b}");
            joints += usize::from(meet);
        }
    }
    assert_eq!(joints, 4 + 4 + 4 + 1, "{name}");
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
fn a_crank_is_drawn_and_named_at_its_neutral_angle() {
    for (name, text) in files() {
        let drawing = Drawing::of(&horns(&Robot::parse(&text).expect("a robot")));
        // All four in the same scale.
        let link = |key: &str| -> f64 {
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
                (crank[1].0 - crank[0].0).hypot(crank[1].1 - crank[0].1) / link(key)
            });
        let scales: Vec<f64> = scales.collect();
        assert!(
            scales
                .iter()
                .all(|scale| (scale / scales[0] - 1.0).abs() < 1e-3),
            "{name}"
        );
        for servo in SERVOS {
            let neutral: f64 = said(&text, servo, "neutral").parse().expect("degrees");
            let crank = drawing.path(&format!("crank-{servo}"));
            assert!(
                turned(neutral, direction(&crank)).abs() < 0.02,
                "{name} {servo}"
            );
            let label = &drawing.named(&format!("angle-{servo}")).words;
            assert_eq!(*label, format!("{neutral:.2}°"), "{name} {servo}");
        }
    }
}

/// The direction of a line of at least 50 pixels, degrees counter-clockwise from the
/// right; its ends are rounded to hundredths.
fn direction(line: &[Point]) -> f64 {
    let (x, y) = (line[1].0 - line[0].0, line[0].1 - line[1].1);
    assert!(x.hypot(y) > 50.0);
    y.atan2(x).to_degrees()
}

/// By how much one turns counter-clockwise from one direction to another.
fn turned(from: f64, to: f64) -> f64 {
    (to - from + 180.0).rem_euclid(360.0) - 180.0
}

#[test]
fn the_trim_of_the_example_turns_the_crank_to_its_neutral_angle() {
    for (name, text) in files() {
        let drawing = Drawing::of(&horns(&Robot::parse(&text).expect("a robot")));
        let (sits, should) = (drawing.path("sits"), drawing.path("should"));
        let neutral: f64 = said(&text, "A1", "neutral").parse().expect("degrees");
        assert!(turned(neutral, direction(&should)).abs() < 0.02, "{name}");
        let words = drawing.0.iter().map(|element| element.words.as_str());
        let trims: Vec<&str> = words
            .filter_map(|words| words.strip_prefix("trim 1 "))
            .collect();
        let trim: f64 = trims[0].parse().expect("degrees");
        let off = turned(direction(&sits), direction(&should)) - trim;
        assert!(off.abs() < 0.02, "{name} {off}");
        assert!(trim.abs() <= 7.2, "more than the teeth leave");
    }
}

#[test]
fn the_spline_has_25_teeth_and_a_crank_is_off_by_half_a_tooth_at_most() {
    let drawing = Drawing::of(&horns(&Robot::parse(&paper()).expect("a robot")));
    let corners = drawing.path("spline");
    let count = corners.len() as f64;
    let sum = corners
        .iter()
        .fold((0.0, 0.0), |sum, at| (sum.0 + at.0, sum.1 + at.1));
    let middle = (sum.0 / count, sum.1 / count);
    let radius = |at: &Point| (at.0 - middle.0).hypot(at.1 - middle.1);
    let mean = corners.iter().map(radius).sum::<f64>() / count;
    let rises = (0..corners.len()).filter(|place| {
        let before = &corners[(place + corners.len() - 1) % corners.len()];
        radius(before) < mean && radius(&corners[*place]) > mean
    });
    assert_eq!(rises.count(), 25);
    let words: String = drawing
        .0
        .iter()
        .map(|element| element.words.as_str())
        .collect();
    assert!(
        words.contains("14.4° apart") && words.contains("7.2° at most"),
        "{words}"
    );
}

#[test]
fn everything_is_on_the_page_and_large_enough_to_be_read() {
    for (name, text) in files() {
        let robot = Robot::parse(&text).expect("a robot");
        for svg in [wiring(&robot), horns(&robot)] {
            let drawing = Drawing::of(&svg);
            let (width, height) = {
                let page = &drawing.0[0];
                (page.number("width"), page.number("height"))
            };
            assert!(width <= 700.0, "a README is that wide");
            for element in &drawing.0[1..] {
                let mut points = element.points();
                if element.tag == "text" {
                    let size = element.number("font-size");
                    assert!(size >= 12.0, "{name}: {element:?}");
                    // A wide font: 0.55 of its size for a character.
                    let long = 0.55 * size * element.words.chars().count() as f64;
                    let (x, y) = points[0];
                    if element.text("transform").is_empty() {
                        let (left, right) = match element.text("text-anchor") {
                            "start" => (0.0, long),
                            "end" => (long, 0.0),
                            _ => (long / 2.0, long / 2.0),
                        };
                        points.extend([(x - left, y - size), (x + right, y)]);
                    }
                }
                for (x, y) in points {
                    let inside = (0.0..=width).contains(&x) && (0.0..=height).contains(&y);
                    assert!(inside, "{name}: {x} {y} {element:?}");
                }
            }
        }
    }
}

#[test]
fn the_drawings_in_docs_are_of_the_paper_robot_as_it_is_drawn_now() {
    let robot = Robot::parse(&paper()).expect("a robot");
    for (name, svg) in [("wiring", wiring(&robot)), ("horns", horns(&robot))] {
        let kept = std::fs::read_to_string(root().join(format!("docs/{name}.svg")));
        assert!(
            kept.is_ok_and(|kept| kept == svg),
            "docs/{name}.svg: run `make docs`"
        );
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
