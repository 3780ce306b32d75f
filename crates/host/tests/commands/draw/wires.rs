//! Tests of the nets in the wiring drawing.

use std::collections::{BTreeMap, BTreeSet};

use super::drawing::{Drawing, Point};
use super::files::{SERVOS, drawing_of, paper_toml, robot_files, servo_value};
use lizard_host::draw::draw_wiring;

/// Draws the wiring of a robot file.
fn wiring_of(robot_toml: &str) -> Drawing {
    drawing_of(draw_wiring, robot_toml)
}

/// The colour of a pin.
fn fill_of<'a>(drawing: &'a Drawing, pin: &str) -> &'a str {
    drawing.element_by_id(pin).attribute("fill")
}

/// The paper's robot file with other servo pins.
fn with_pins(pins: [&str; 4]) -> String {
    let mut text = paper_toml();
    for (servo, pin) in SERVOS.into_iter().zip(pins) {
        let entry_of = |pin: &str| format!("[servo.{servo}]\npin = \"{pin}\"");
        let old_entry = entry_of(servo_value(&text, servo, "pin"));
        assert!(text.contains(&old_entry));
        text = text.replace(&old_entry, &entry_of(pin));
    }
    text
}

/// The paper's robot file with sets of four pins, in many orders; each with the pins' names. 17 is prime, so four pins
/// at equal steps are always distinct.
fn files_with_many_pin_sets() -> impl Iterator<Item = (String, String)> {
    let pin_name = |number: usize| match number % 17 {
        index @ 0..11 => format!("D{}", index + 2),
        index => format!("A{}", index - 11),
    };
    (1..17)
        .flat_map(|step| (step % 12..17).step_by(12).map(move |start| (start, step)))
        .map(move |(start, step)| [0, 1, 2, 3].map(|servo| pin_name(start + servo * step)))
        .map(|pins| {
            (
                format!("{pins:?}"),
                with_pins(pins.each_ref().map(String::as_str)),
            )
        })
}

/// Largest distance of a wire's end from its terminal's centre, px; two wires that share a terminal end beside its
/// centre.
const MAX_TERMINAL_DISTANCE_PX: f64 = 13.0;

/// The electrical nets of a drawing, as a union-find of the names of terminals and pins.
struct Nets<'a> {
    drawing: &'a Drawing,
    parents: BTreeMap<String, String>,
}

impl<'a> Nets<'a> {
    /// Joins the two ends of each wire, link and terminal position. A component (fuse, switch, resistor) does not
    /// join its ends, and the optional wires of the radio and the inputs are left out.
    fn from_drawing(drawing: &'a Drawing) -> Self {
        let mut nets = Self {
            drawing,
            parents: BTreeMap::new(),
        };
        for (wire, path) in drawing.wires() {
            let is_option = wire.starts_with("radio-") || wire.starts_with("input-");
            if !wire.starts_with("resistor-") && !is_option {
                let ends = [path[0], path[path.len() - 1]].map(|end| nets.nearest_terminal(end));
                nets.join(&ends[0], &ends[1]);
            }
        }
        for (strip, positions, sides) in [
            ("ground", 12, ["wire", "link"]),
            ("supply", 6, ["wire", "link"]),
            ("signals", 5, ["servo", "board"]),
        ] {
            for position in 1..=positions {
                let [first_end, second_end] =
                    sides.map(|side| format!("end-{strip}-{position}-{side}"));
                nets.join(&first_end, &second_end);
            }
        }
        // The single terminal between the switch and the converter.
        nets.join("end-way-1", "end-way-2");
        nets
    }

    /// The terminal or pin nearest to a point.
    fn nearest_terminal(&self, point: Point) -> String {
        let distance_to = |end: &Point| (end.0 - point.0).hypot(end.1 - point.1);
        let ends = self.drawing.elements.iter().filter(|element| {
            let id = element.attribute("id");
            element.tag == "circle" && (id.starts_with("end-") || id.starts_with("pin-"))
        });
        let ends = ends.map(|element| (distance_to(&element.points()[0]), element.attribute("id")));
        let nearest = ends.min_by(|a, b| a.0.total_cmp(&b.0));
        let (min_distance, name) = nearest.expect("the drawing has a terminal");
        assert!(
            min_distance <= MAX_TERMINAL_DISTANCE_PX,
            "nothing is at {point:?}; {name} is {min_distance} away"
        );
        name.to_owned()
    }

    /// The name that represents the net of `name`.
    fn root(&self, name: &str) -> String {
        match self.parents.get(name) {
            Some(parent) => self.root(parent),
            None => name.to_owned(),
        }
    }

    /// Joins the nets of two names.
    fn join(&mut self, first: &str, second: &str) {
        let (first, second) = (self.root(first), self.root(second));
        if first != second {
            self.parents.insert(first, second);
        }
    }

    /// Asserts that all names are in one net.
    #[track_caller]
    fn assert_joined(&self, names: &[&str]) {
        let root = self.root(names[0]);
        for name in names {
            // Fails if the drawing does not have the name.
            self.drawing.element_by_id(name);
            assert_eq!(self.root(name), root, "{name} and {}", names[0]);
        }
    }
}

#[test]
fn every_component_is_joined_to_what_it_needs_and_to_nothing_else() {
    for (name, text) in robot_files().into_iter().chain(files_with_many_pin_sets()) {
        let drawing = wiring_of(&text);
        let nets = Nets::from_drawing(&drawing);
        let servo_grounds = SERVOS.map(|servo| format!("end-{servo}-ground"));
        let grounds = [
            "end-battery-minus",
            "end-converter-in-minus",
            "end-converter-out-minus",
            "end-capacitor-minus",
            "end-round-plug-minus",
            "end-signals-3-servo",
            "pin-GND",
        ];
        nets.assert_joined(&[&grounds[..], &servo_grounds.each_ref().map(String::as_str)].concat());
        let supplies = ["end-converter-out-plus", "end-capacitor-plus"];
        let servo_supplies = ["end-A1-plus", "end-A2-plus", "end-A3-plus", "end-A4-plus"];
        nets.assert_joined(&[&supplies[..], &servo_supplies].concat());
        nets.assert_joined(&["end-battery-plus", "end-fuse-2"]);
        nets.assert_joined(&["end-fuse-1", "end-switch-2"]);
        nets.assert_joined(&[
            "end-switch-1",
            "end-converter-in-plus",
            "end-round-plug-plus",
        ]);
        for number in 1..=3 {
            let [battery, alarm] =
                ["battery-balance", "alarm"].map(|component| format!("end-{component}-{number}"));
            nets.assert_joined(&[&battery, &alarm]);
        }
        let ends = [
            "end-battery-plus",
            "end-fuse-1",
            "end-switch-1",
            "end-converter-out-plus",
            "end-battery-minus",
        ];
        let mut net_roots = ends.map(|end| nets.root(end)).to_vec();
        for servo in SERVOS {
            let pin = servo_value(&text, servo, "pin");
            let signal = format!("end-{servo}-signal");
            nets.assert_joined(&[&signal, &format!("pin-{pin}")]);
            net_roots.push(nets.root(&signal));
            let label = format!("to {pin}");
            assert!(drawing.texts().any(|text| text == label), "{name}");
            // The servo's resistor leads from its terminal position to ground.
            let leads = drawing.points_by_id(&format!("resistor-{servo}"));
            let ends = [leads[0], leads[leads.len() - 1]]
                .map(|point| nets.root(&nets.nearest_terminal(point)));
            let nets_of_ends = [nets.root(&signal), nets.root("pin-GND")];
            assert_eq!(ends, nets_of_ends, "{name} {servo}");
        }
        let net_count = net_roots.len();
        let distinct_roots: BTreeSet<String> = net_roots.into_iter().collect();
        assert_eq!(
            distinct_roots.len(),
            net_count,
            "{name}: two nets are joined"
        );
        // Spare positions are not joined to ground.
        for position in ["end-ground-11-wire", "end-ground-12-wire"] {
            assert_ne!(nets.root(position), nets.root("pin-GND"));
        }
    }
}

#[test]
fn removing_any_link_splits_its_strip() {
    let links = (1..10).map(|link| format!("link-ground-{link}"));
    let links = links.chain((1..6).map(|link| format!("link-supply-{link}")));
    for link in links {
        let mut drawing = wiring_of(&paper_toml());
        assert!(drawing.has_element(&link), "{link}");
        drawing
            .elements
            .retain(|element| element.attribute("id") != link);
        let nets = Nets::from_drawing(&drawing);
        let ends = match link.starts_with("link-ground") {
            true => ["end-ground-1-wire", "end-ground-10-wire"],
            false => ["end-supply-1-wire", "end-supply-6-wire"],
        };
        assert_ne!(nets.root(ends[0]), nets.root(ends[1]), "{link}");
    }
}

#[test]
fn wires_cross_but_never_run_into_or_along_each_other() {
    for (_, text) in robot_files().into_iter().chain(files_with_many_pin_sets()) {
        let drawing = wiring_of(&text);
        // The wires in the radio's panel may touch each other, so they are left out.
        let mut wires = drawing.wires();
        wires.retain(|(name, _)| !name.starts_with("radio-"));
        let is_vertical = |segment: &[Point]| segment[0].0 == segment[1].0;
        for (wire, path) in &wires {
            let is_straight =
                |segment: &[Point]| segment[0].0 == segment[1].0 || segment[0].1 == segment[1].1;
            assert!(path.windows(2).all(is_straight), "{wire}");
        }
        for (index, (wire, path)) in wires.iter().enumerate() {
            for (other_wire, other_path) in &wires[index + 1..] {
                let pairs = path.windows(2).flat_map(|segment| {
                    other_path
                        .windows(2)
                        .map(move |other_segment| (segment, other_segment))
                });
                for (segment, other_segment) in pairs {
                    let gap_along = |axis: fn(&Point) -> f64| {
                        let range_of = |segment: &[Point]| {
                            let (start, end) = (axis(&segment[0]), axis(&segment[1]));
                            (start.min(end), start.max(end))
                        };
                        let (segment, other_segment) = (range_of(segment), range_of(other_segment));
                        (segment.0 - other_segment.1).max(other_segment.0 - segment.1)
                    };
                    let (x_gap, y_gap) = (gap_along(|point| point.0), gap_along(|point| point.1));
                    let share_an_end = segment.iter().any(|end| other_segment.contains(end));
                    if is_vertical(segment) == is_vertical(other_segment) {
                        // Parallel wires keep their distance, unless they share an end or are both links.
                        let are_links =
                            wire.starts_with("link-") && other_wire.starts_with("link-");
                        let are_near = x_gap < 3.0 && y_gap < 3.0;
                        assert!(
                            !are_near || are_links || share_an_end,
                            "{wire} along {other_wire}: {segment:?} {other_segment:?}"
                        );
                    } else if x_gap <= 0.0 && y_gap <= 0.0 {
                        // Wires cross away from the ends of both, unless they share an end.
                        let depth = (-x_gap).min(-y_gap);
                        assert!(
                            depth > 2.0 || share_an_end,
                            "{wire} runs into {other_wire}: {segment:?} {other_segment:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn the_radio_is_an_option_with_a_diode_to_d0_and_a_divider_from_d1() {
    let drawing = wiring_of(&paper_toml());
    let points_of = |name: &str| drawing.points_by_id(name);
    let terminal = |name: &str| points_of(&format!("end-{name}"))[0];
    let [anode, cathode] = ["diode-anode", "diode-cathode"].map(terminal);
    // The module pulls D0 low: current flows from D0 into TXD.
    assert_eq!(points_of("radio-d0"), [terminal("radio-D0 (RX)"), anode]);
    let module_txd = terminal("radio-module-TXD");
    assert_eq!(points_of("radio-txd"), [cathode, module_txd]);
    assert_eq!(points_of("radio-d1")[0], terminal("radio-D1 (TX)"));
    assert_eq!(points_of("radio-rxd")[1], terminal("radio-module-RXD"));
    let [rxd_y, ground_y] = ["radio-rxd", "radio-ground"].map(|name| points_of(name)[0].1);
    let resistor_ends = points_of("radio-2k");
    assert_eq!([0, 1].map(|end| resistor_ends[end].1), [rxd_y, ground_y]);
    for label in ["Option: a radio module", "1 k\u{3a9}", "2 k\u{3a9}"] {
        assert!(drawing.texts().any(|text| text.contains(label)), "{label}");
    }
}

#[test]
fn inputs_are_drawn_as_options_between_their_pins_and_ground() {
    let drawing_with = |tables: &str| {
        let text = paper_toml().replace("[limits]", &format!("{tables}\n[limits]"));
        wiring_of(&text)
    };
    let (button, nose) = ("[input.button]\npin = \"A1\"", "[input.nose]\npin = \"D7\"");
    let (no_inputs, button_only) = (drawing_with(""), drawing_with(button));
    let both_inputs = drawing_with(&format!("{button}\n{nose}"));
    let drawings_with_element =
        |id: &str| [&no_inputs, &button_only, &both_inputs].map(|drawing| drawing.has_element(id));
    for name in ["input-button-A1", "input-button-GND"] {
        assert_eq!(drawings_with_element(name), [false, true, true]);
    }
    for name in ["input-nose-D7", "input-nose-GND", "input-nose-5V"] {
        assert_eq!(drawings_with_element(name), [false, false, true]);
        let terminal = name.replace("input-", "end-");
        let [wire, terminal] = [name, &terminal].map(|id| both_inputs.points_by_id(id));
        assert_eq!(wire[0], terminal[0]);
    }
    assert_eq!(
        fill_of(&both_inputs, "pin-A1"),
        fill_of(&both_inputs, "pin-D9")
    );
    assert_ne!(fill_of(&no_inputs, "pin-A1"), fill_of(&no_inputs, "pin-D9"));
}

#[test]
fn pins_are_where_a_uno_has_them() {
    // Mils (thousandths of an inch) from the lower left corner, from Arduino's board file.
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
    let drawing = wiring_of(&paper_toml());
    let pin_point = |name: &str| drawing.points_by_id(&format!("pin-{name}"))[0];
    let scale = (pin_point("D0").0 - pin_point("D13").0) / (2500.0 - 1140.0);
    let (origin, origin_mil) = (pin_point("D13"), PINS[0].1);
    for (name, mil) in PINS {
        let (x, y) = pin_point(name);
        let error = (
            (x - origin.0) / scale - (mil.0 - origin_mil.0),
            (origin.1 - y) / scale - (mil.1 - origin_mil.1),
        );
        let is_small = error.0.abs() < 1.0 && error.1.abs() < 1.0;
        assert!(is_small, "{name} {error:?}");
    }
}

#[test]
fn the_pin_that_measures_the_rail_is_marked() {
    let text = paper_toml().replace(
        "[limits]",
        "[supply.rail]\npin = \"A3\"\nratio = 2.5\n[limits]",
    );
    let drawing = wiring_of(&text);
    let note = "A3 measures the +5 V strip, divided by 2.50.";
    assert!(drawing.texts().any(|text| text == note));
    assert_eq!(fill_of(&drawing, "pin-A3"), fill_of(&drawing, "pin-D9"));
    assert_ne!(fill_of(&drawing, "pin-A3"), fill_of(&drawing, "pin-A2"));
}
