//! Checks the netlist that the wiring drawing shows.

use std::collections::BTreeMap;

use lizard_host::draw::wiring;
use lizard_robot::Robot;

use super::drawing::{Drawing, Point};
use super::files::{SERVOS, files, paper, value_of};

/// The text of the paper's robot with other pins.
fn with_pins(pins: [&str; 4]) -> String {
    let mut text = paper();
    for (servo, pin) in SERVOS.into_iter().zip(pins) {
        let before = format!(
            "[servo.{servo}]\npin = \"{}\"",
            value_of(&paper(), servo, "pin")
        );
        assert!(text.contains(&before));
        text = text.replace(&before, &format!("[servo.{servo}]\npin = \"{pin}\""));
    }
    text
}

/// Sets of four pins, in many orders. 17 is prime, so four pins at equal steps are always distinct.
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

/// Largest distance of a wire's end from its terminal's centre, px. It is not 0, since two wires may share a
/// terminal.
const MAX_TERMINAL_DISTANCE: f64 = 13.0;

/// The electrical nets of a drawing, as a union-find of the names of terminals and pins.
struct Nets<'a> {
    drawing: &'a Drawing,
    parent: BTreeMap<String, String>,
}

impl<'a> Nets<'a> {
    /// Joins the ends of wires, links and terminal positions. Components (fuse, switch, resistors) do not join
    /// their ends, and the optional wires of the radio and the inputs are left out.
    fn of(drawing: &'a Drawing) -> Self {
        let mut nets = Self {
            drawing,
            parent: BTreeMap::new(),
        };
        for (wire, path) in drawing.wires() {
            let is_option = wire.starts_with("radio-") || wire.starts_with("input-");
            if !wire.starts_with("resistor-") && !is_option {
                nets.join(
                    &nets.nearest_terminal(path[0]),
                    &nets.nearest_terminal(path[path.len() - 1]),
                );
            }
        }
        for (strip, positions, sides) in [
            ("ground", 12, ["wire", "link"]),
            ("supply", 6, ["wire", "link"]),
            ("signals", 5, ["servo", "board"]),
        ] {
            for position in 1..=positions {
                let [one, other] = sides.map(|side| format!("end-{strip}-{position}-{side}"));
                nets.join(&one, &other);
            }
        }
        // The single terminal between the switch and the converter.
        nets.join("end-way-1", "end-way-2");
        nets
    }

    /// The terminal or pin nearest to a point.
    fn nearest_terminal(&self, point: Point) -> String {
        let distance = |end: &Point| (end.0 - point.0).hypot(end.1 - point.1);
        let ends = self.drawing.0.iter().filter(|element| {
            let id = element.attribute("id");
            element.tag == "circle" && (id.starts_with("end-") || id.starts_with("pin-"))
        });
        let ends = ends.map(|element| (distance(&element.points()[0]), element.attribute("id")));
        let (nearest, name) = ends.min_by(|a, b| a.0.total_cmp(&b.0)).expect("an end");
        assert!(
            nearest <= MAX_TERMINAL_DISTANCE,
            "nothing is at {point:?}; {name} is {nearest} away"
        );
        name.to_owned()
    }

    fn root(&self, name: &str) -> String {
        match self.parent.get(name) {
            Some(parent) => self.root(parent),
            None => name.to_owned(),
        }
    }

    fn join(&mut self, a: &str, b: &str) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.parent.insert(a, b);
        }
    }

    #[track_caller]
    fn assert_joined(&self, names: &[&str]) {
        for name in names {
            // Fails if the drawing does not have the name.
            self.drawing.element_by_id(name);
            assert_eq!(
                self.root(name),
                self.root(names[0]),
                "{name} and {}",
                names[0]
            );
        }
    }
}

#[test]
fn every_component_is_joined_to_what_it_needs_and_to_nothing_else() {
    let many = many_pins();
    let many = many.iter().map(|pins| {
        let text = with_pins([0, 1, 2, 3].map(|servo| pins[servo].as_str()));
        (format!("{pins:?}"), text)
    });
    for (name, text) in files().into_iter().chain(many) {
        let drawing = Drawing::of(&wiring(&Robot::parse(&text).expect("a robot")));
        let nets = Nets::of(&drawing);
        let grounds = [
            "end-A1-ground",
            "end-A2-ground",
            "end-A3-ground",
            "end-A4-ground",
        ];
        let ground = [
            "end-battery-minus",
            "end-converter-in-minus",
            "end-converter-out-minus",
            "end-capacitor-minus",
            "end-round-plug-minus",
            "end-signals-3-servo",
            "pin-GND",
        ];
        nets.assert_joined(&[&ground[..], &grounds].concat());
        let five = ["end-converter-out-plus", "end-capacitor-plus"];
        let servos = ["end-A1-plus", "end-A2-plus", "end-A3-plus", "end-A4-plus"];
        nets.assert_joined(&[&five[..], &servos].concat());
        nets.assert_joined(&["end-battery-plus", "end-fuse-2"]);
        nets.assert_joined(&["end-fuse-1", "end-switch-2"]);
        nets.assert_joined(&[
            "end-switch-1",
            "end-converter-in-plus",
            "end-round-plug-plus",
        ]);
        for number in 1..=3 {
            let [battery, alarm] =
                ["battery-balance", "alarm"].map(|of| format!("end-{of}-{number}"));
            nets.assert_joined(&[&battery, &alarm]);
        }
        let mut apart = vec![
            nets.root("end-battery-plus"),
            nets.root("end-fuse-1"),
            nets.root("end-switch-1"),
            nets.root("end-converter-out-plus"),
            nets.root("end-battery-minus"),
        ];
        for servo in SERVOS {
            let pin = value_of(&text, servo, "pin");
            let signal = format!("end-{servo}-signal");
            nets.assert_joined(&[&signal, &format!("pin-{pin}")]);
            apart.push(nets.root(&signal));
            let words = format!("to {pin}");
            assert!(
                drawing.0.iter().any(|element| element.content == words),
                "{name}"
            );
            // The servo's resistor leads from its terminal position to ground.
            let leads = drawing.path(&format!("resistor-{servo}"));
            let ends =
                [leads[0], leads[leads.len() - 1]].map(|at| nets.root(&nets.nearest_terminal(at)));
            assert_eq!(
                ends,
                [nets.root(&signal), nets.root("pin-GND")],
                "{name} {servo}"
            );
        }
        let count = apart.len();
        apart.sort();
        apart.dedup();
        assert_eq!(apart.len(), count, "{name}: two nets are one");
        // Spare positions are not joined to ground.
        for position in ["end-ground-11-wire", "end-ground-12-wire"] {
            assert_ne!(nets.root(position), nets.root("pin-GND"));
        }
    }
}

#[test]
fn removing_any_link_splits_its_strip() {
    let svg = wiring(&Robot::parse(&paper()).expect("a robot"));
    let links = (1..10).map(|link| format!("link-ground-{link}"));
    let links = links.chain((1..6).map(|link| format!("link-supply-{link}")));
    for link in links {
        let mut drawing = Drawing::of(&svg);
        assert!(
            drawing
                .0
                .iter()
                .any(|element| element.attribute("id") == link),
            "{link}"
        );
        drawing.0.retain(|element| element.attribute("id") != link);
        let nets = Nets::of(&drawing);
        let ends = match link.starts_with("link-ground") {
            true => ["end-ground-1-wire", "end-ground-10-wire"],
            false => ["end-supply-1-wire", "end-supply-6-wire"],
        };
        assert_ne!(nets.root(ends[0]), nets.root(ends[1]), "{link}");
    }
}

#[test]
fn wires_only_cross_they_never_run_into_or_along_each_other() {
    let many = many_pins();
    let many = many
        .iter()
        .map(|pins| with_pins([0, 1, 2, 3].map(|servo| pins[servo].as_str())));
    for text in files().into_iter().map(|file| file.1).chain(many) {
        let drawing = Drawing::of(&wiring(&Robot::parse(&text).expect("a robot")));
        // The wires in the radio's panel may touch each other, so they are left out.
        let mut wires = drawing.wires();
        wires.retain(|(name, _)| !name.starts_with("radio-"));
        let upright = |part: &[Point]| part[0].0 == part[1].0;
        for (wire, path) in &wires {
            let is_straight = |part: &[Point]| part[0].0 == part[1].0 || part[0].1 == part[1].1;
            assert!(path.windows(2).all(is_straight), "{wire}");
        }
        for (place, (a, path)) in wires.iter().enumerate() {
            for (b, other) in &wires[place + 1..] {
                for (one, two) in path
                    .windows(2)
                    .flat_map(|one| other.windows(2).map(move |two| (one, two)))
                {
                    let apart = |axis: fn(&Point) -> f64| {
                        let range = |part: &[Point]| {
                            let (a, b) = (axis(&part[0]), axis(&part[1]));
                            (a.min(b), a.max(b))
                        };
                        let (one, two) = (range(one), range(two));
                        (one.0 - two.1).max(two.0 - one.1)
                    };
                    let (x, y) = (apart(|at| at.0), apart(|at| at.1));
                    if upright(one) == upright(two) {
                        // Parallel wires keep their distance, unless they share an end or are both links.
                        let shared = a.starts_with("link-") && b.starts_with("link-");
                        let near = x < 3.0 && y < 3.0;
                        assert!(
                            !near || shared || one.contains(&two[0]) || one.contains(&two[1]),
                            "{a} along {b}: {one:?} {two:?}"
                        );
                    } else if x <= 0.0 && y <= 0.0 {
                        // Wires that cross do so well away from the ends of both, unless they share an end.
                        let depth = (-x).min(-y);
                        let touch = one.iter().any(|end| two.contains(end));
                        assert!(depth > 2.0 || touch, "{a} runs into {b}: {one:?} {two:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_radio_is_an_option_with_a_diode_to_d0_and_a_divider_from_d1() {
    let drawing = Drawing::of(&wiring(&Robot::parse(&paper()).expect("a robot")));
    let at = |name: &str| drawing.path(name)[0];
    let path = |name: &str| drawing.path(name);
    let [anode, cathode] = ["end-diode-anode", "end-diode-cathode"].map(at);
    // The module pulls D0 low: current flows from D0 into TXD.
    assert_eq!(path("radio-d0"), [at("end-radio-D0 (RX)"), anode]);
    assert_eq!(path("radio-txd"), [cathode, at("end-radio-module-TXD")]);
    assert_eq!(path("radio-d1")[0], at("end-radio-D1 (TX)"));
    assert_eq!(path("radio-rxd")[1], at("end-radio-module-RXD"));
    let [rxd, ground] = ["radio-rxd", "radio-ground"].map(|name| path(name)[0].1);
    let lower = path("radio-2k");
    assert_eq!([lower[0].1, lower[1].1], [rxd, ground]);
    let printed = |words: &str| {
        drawing
            .0
            .iter()
            .any(|element| element.content.contains(words))
    };
    assert!(printed("Option: a radio module") && printed("1 k\u{3a9}") && printed("2 k\u{3a9}"));
}

#[test]
fn inputs_are_an_option_of_a_robot_that_has_them_between_their_pins_and_ground() {
    let draw = |tables: &str| {
        let text = paper().replace("[limits]", &format!("{tables}\n[limits]"));
        Drawing::of(&wiring(&Robot::parse(&text).expect("a robot")))
    };
    let has_entry = |drawing: &Drawing, name: &str| {
        let mut ids = drawing.0.iter().map(|element| element.attribute("id"));
        ids.any(|id| id == name)
    };
    let (button, nose) = ("[input.button]\npin = \"A1\"", "[input.nose]\npin = \"D7\"");
    let (none, one) = (draw(""), draw(button));
    let both = draw(&format!("{button}\n{nose}"));
    for name in ["input-button-A1", "input-button-GND"] {
        assert_eq!(
            [
                has_entry(&none, name),
                has_entry(&one, name),
                has_entry(&both, name)
            ],
            [false, true, true]
        );
    }
    for name in ["input-nose-D7", "input-nose-GND", "input-nose-5V"] {
        assert_eq!(
            [
                has_entry(&none, name),
                has_entry(&one, name),
                has_entry(&both, name)
            ],
            [false, false, true]
        );
        let path = both.path(name);
        let from = name.strip_prefix("input-").expect("it begins so");
        assert_eq!(path[0], both.path(&format!("end-{from}"))[0]);
    }
    let fill =
        |drawing: &Drawing, pin: &str| drawing.element_by_id(pin).attribute("fill").to_string();
    assert_eq!(fill(&both, "pin-A1"), fill(&both, "pin-D9"));
    assert_ne!(fill(&none, "pin-A1"), fill(&none, "pin-D9"));
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
        let error = (
            (x - zero.0) / scale - (mil.0 - first.0),
            (zero.1 - y) / scale - (mil.1 - first.1),
        );
        assert!(
            error.0.abs() < 1.0 && error.1.abs() < 1.0,
            "{name} {error:?}"
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
    let words = "A3 measures the +5 V strip, divided by 2.50.";
    assert!(drawing.0.iter().any(|element| element.content == words));
    let fill = |pin: &str| drawing.element_by_id(pin).attribute("fill").to_string();
    assert_eq!(fill("pin-A3"), fill("pin-D9"));
    assert_ne!(fill("pin-A3"), fill("pin-A2"));
}
