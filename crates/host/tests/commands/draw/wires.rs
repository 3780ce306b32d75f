//! Tests of the electrical nets in the wiring drawing.

use std::collections::{BTreeMap, BTreeSet};

use super::drawing::{Drawing, Point};
use super::robot_files::{draw_robot, paper_toml, read_robot_files, read_servo_value};
use lizard_host::draw::draw_wiring;
use lizard_robot::servo::SERVO_NAMES;

/// Draws the wiring of a robot file.
fn draw_robot_wiring(robot_toml: &str) -> Drawing {
    draw_robot(draw_wiring, robot_toml)
}

/// Returns the colour of a pin.
fn pin_fill<'a>(drawing: &'a Drawing, pin: &str) -> &'a str {
    drawing.element_by_id(pin).attribute("fill")
}

/// Returns the paper's robot file with other servo pins.
fn with_servo_pins(pins: &[String; 4]) -> String {
    let mut text = paper_toml();
    for (servo, pin) in SERVO_NAMES.into_iter().zip(pins) {
        let format_entry = |pin: &str| format!("[servo.{servo}]\npin = \"{pin}\"");
        let old_entry = format_entry(read_servo_value(&text, servo, "pin"));
        assert!(text.contains(&old_entry));
        text = text.replace(&old_entry, &format_entry(pin));
    }
    text
}

/// Returns the path and the text of each file in robots/, then the pins' names and the text of copies of the paper's
/// robot file with many sets and orders of servo pins. Since 17 is prime, four pins at equal steps are always distinct.
fn robot_files_with_many_pin_sets() -> impl Iterator<Item = (String, String)> {
    let pin_name = |number: usize| match number % 17 {
        index @ 0..11 => format!("D{}", index + 2),
        index => format!("A{}", index - 11),
    };
    let changed_files = (1..17)
        .flat_map(|step| (step % 12..17).step_by(12).map(move |start| (start, step)))
        .map(move |(start, step)| [0, 1, 2, 3].map(|servo| pin_name(start + servo * step)))
        .map(|pins| (format!("{pins:?}"), with_servo_pins(&pins)));
    read_robot_files().into_iter().chain(changed_files)
}

/// Largest distance between a wire's end and its terminal's centre, px. Two wires that share a terminal end beside the
/// centre.
const MAX_TERMINAL_DISTANCE_PX: f64 = 13.0;

/// The electrical nets of a drawing: a union-find structure of terminal and pin names.
struct Nets<'a> {
    drawing: &'a Drawing,
    parents: BTreeMap<String, String>,
}

impl<'a> Nets<'a> {
    /// Joins the two ends of each wire, link and terminal position. Components (fuse, switch, resistor) do not join
    /// their ends. The optional wires of the radio and the inputs are ignored.
    fn from_drawing(drawing: &'a Drawing) -> Self {
        let mut nets = Self {
            drawing,
            parents: BTreeMap::new(),
        };
        for (wire, path) in drawing.wires() {
            let is_optional = wire.starts_with("radio-") || wire.starts_with("input-");
            if !wire.starts_with("resistor-") && !is_optional {
                let ends = [path[0], path[path.len() - 1]].map(|end| nets.find_terminal(end));
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
        // The switch and the converter share a single terminal.
        nets.join("end-way-1", "end-way-2");
        nets
    }

    /// Finds the terminal or pin nearest to a point.
    fn find_terminal(&self, point: Point) -> String {
        let distance = |end: &Point| (end.0 - point.0).hypot(end.1 - point.1);
        let ends = self.drawing.elements.iter().filter(|element| {
            let id = element.attribute("id");
            element.tag == "circle" && (id.starts_with("end-") || id.starts_with("pin-"))
        });
        let ends = ends.map(|element| (distance(&element.points()[0]), element.attribute("id")));
        let nearest = ends.min_by(|a, b| a.0.total_cmp(&b.0));
        let (min_distance, name) = nearest.expect("the drawing has a terminal");
        assert!(
            min_distance <= MAX_TERMINAL_DISTANCE_PX,
            "no terminal at {point:?}: {name} is {min_distance} px away"
        );
        name.to_owned()
    }

    /// Finds the name that represents the net of `name`.
    fn find_root(&self, name: &str) -> String {
        match self.parents.get(name) {
            Some(parent) => self.find_root(parent),
            None => name.to_owned(),
        }
    }

    /// Joins the nets of two names.
    fn join(&mut self, first: &str, second: &str) {
        let (first, second) = (self.find_root(first), self.find_root(second));
        if first != second {
            self.parents.insert(first, second);
        }
    }

    /// Checks that all names in a list, which are separated by spaces, are in one net.
    #[track_caller]
    fn assert_joined(&self, names: &str) {
        let names: Vec<&str> = names.split(' ').collect();
        let root = self.find_root(names[0]);
        for name in &names {
            // Panics if the drawing does not have the name.
            self.drawing.element_by_id(name);
            let actual = self.find_root(name);
            assert_eq!(actual, root, "{name} and {} are not joined", names[0]);
        }
    }
}

#[test]
fn every_component_is_joined_to_the_nets_that_it_needs() {
    for (name, text) in robot_files_with_many_pin_sets() {
        let drawing = draw_robot_wiring(&text);
        let nets = Nets::from_drawing(&drawing);
        for names in [
            "end-battery-minus end-converter-in-minus end-converter-out-minus end-capacitor-minus",
            "end-battery-minus end-round-plug-minus end-signals-3-servo pin-GND",
            "pin-GND end-A1-ground end-A2-ground end-A3-ground end-A4-ground",
            "end-converter-out-plus end-capacitor-plus end-A1-plus end-A2-plus end-A3-plus end-A4-plus",
            "end-battery-plus end-fuse-2",
            "end-fuse-1 end-switch-2",
            "end-switch-1 end-converter-in-plus end-round-plug-plus",
            "end-battery-balance-1 end-alarm-1",
            "end-battery-balance-2 end-alarm-2",
            "end-battery-balance-3 end-alarm-3",
        ] {
            nets.assert_joined(names);
        }
        let ends = [
            "end-battery-plus",
            "end-fuse-1",
            "end-switch-1",
            "end-converter-out-plus",
            "end-battery-minus",
        ];
        let mut net_roots = ends.map(|end| nets.find_root(end)).to_vec();
        for servo in SERVO_NAMES {
            let pin = read_servo_value(&text, servo, "pin");
            let signal = format!("end-{servo}-signal");
            nets.assert_joined(&format!("{signal} pin-{pin}"));
            net_roots.push(nets.find_root(&signal));
            let label = format!("to {pin}");
            assert!(drawing.texts().any(|text| text == label), "{name}");
            // The servo's resistor leads from its terminal position to ground.
            let leads = drawing.points_by_id(&format!("resistor-{servo}"));
            let ends = [leads[0], leads[leads.len() - 1]]
                .map(|point| nets.find_root(&nets.find_terminal(point)));
            let expected_nets = [nets.find_root(&signal), nets.find_root("pin-GND")];
            assert_eq!(ends, expected_nets, "{name} {servo}");
        }
        let distinct_count = BTreeSet::from_iter(&net_roots).len();
        let net_count = net_roots.len();
        assert_eq!(distinct_count, net_count, "{name}: two nets are joined");
        // Spare positions are not joined to ground.
        for position in ["end-ground-11-wire", "end-ground-12-wire"] {
            assert_ne!(nets.find_root(position), nets.find_root("pin-GND"));
        }
    }
}

#[test]
fn the_removal_of_any_link_splits_its_strip() {
    for (strip, position_count) in [("ground", 10), ("supply", 6)] {
        for number in 1..position_count {
            let link = format!("link-{strip}-{number}");
            let mut drawing = draw_robot_wiring(&paper_toml());
            assert!(drawing.has_element(&link), "{link}");
            let elements = &mut drawing.elements;
            elements.retain(|element| element.attribute("id") != link);
            let nets = Nets::from_drawing(&drawing);
            let [first_root, last_root] = [1, position_count]
                .map(|position| nets.find_root(&format!("end-{strip}-{position}-wire")));
            assert_ne!(first_root, last_root, "{link}");
        }
    }
}

#[test]
fn wires_may_cross_but_never_touch_or_overlap() {
    for (_, text) in robot_files_with_many_pin_sets() {
        let drawing = draw_robot_wiring(&text);
        // The wires in the radio's panel may touch each other, so they are ignored.
        let mut wires = drawing.wires();
        wires.retain(|(name, _)| !name.starts_with("radio-"));
        for (wire, path) in &wires {
            let is_straight =
                |segment: &[Point]| is_vertical(segment) || segment[0].1 == segment[1].1;
            assert!(path.windows(2).all(is_straight), "{wire}");
        }
        for (index, (wire, path)) in wires.iter().enumerate() {
            for (other_wire, other_path) in &wires[index + 1..] {
                for segment in path.windows(2) {
                    for other_segment in other_path.windows(2) {
                        check_distance(wire, segment, other_wire, other_segment);
                    }
                }
            }
        }
    }
}

fn is_vertical(segment: &[Point]) -> bool {
    segment[0].0 == segment[1].0
}

/// Checks that the segments of two wires neither overlap nor touch, except at a shared end.
fn check_distance(wire: &str, segment: &[Point], other_wire: &str, other_segment: &[Point]) {
    let x_gap = compute_gap(segment, other_segment, |point| point.0);
    let y_gap = compute_gap(segment, other_segment, |point| point.1);
    let has_shared_end = segment.iter().any(|end| other_segment.contains(end));
    if is_vertical(segment) == is_vertical(other_segment) {
        // Parallel wires keep their distance, unless they share an end or are both links.
        let are_links = wire.starts_with("link-") && other_wire.starts_with("link-");
        let are_near = x_gap < 3.0 && y_gap < 3.0;
        assert!(
            !are_near || are_links || has_shared_end,
            "{wire} is too near to {other_wire}: {segment:?}, {other_segment:?}"
        );
    } else if x_gap <= 0.0 && y_gap <= 0.0 {
        // Crossing wires cross away from their ends, unless they share an end.
        let depth = (-x_gap).min(-y_gap);
        assert!(
            depth > 2.0 || has_shared_end,
            "{wire} touches {other_wire}: {segment:?}, {other_segment:?}"
        );
    }
}

/// Returns the distance between two segments along an axis, negative if they overlap.
fn compute_gap(first: &[Point], second: &[Point], axis: fn(&Point) -> f64) -> f64 {
    let [(min, max), (other_min, other_max)] = [first, second].map(|segment| {
        let (start, end) = (axis(&segment[0]), axis(&segment[1]));
        (start.min(end), start.max(end))
    });
    (min - other_max).max(other_min - max)
}

#[test]
fn the_optional_radio_has_a_diode_to_d0_and_a_voltage_divider_from_d1() {
    let drawing = draw_robot_wiring(&paper_toml());
    let points = |name: &str| drawing.points_by_id(name);
    let terminal = |name: &str| points(&format!("end-{name}"))[0];
    let [anode, cathode] = ["diode-anode", "diode-cathode"].map(terminal);
    // The module pulls D0 low: current flows from D0 into TXD.
    assert_eq!(points("radio-d0"), [terminal("radio-D0 (RX)"), anode]);
    let module_txd = terminal("radio-module-TXD");
    assert_eq!(points("radio-txd"), [cathode, module_txd]);
    assert_eq!(points("radio-d1")[0], terminal("radio-D1 (TX)"));
    assert_eq!(points("radio-rxd")[1], terminal("radio-module-RXD"));
    let [rxd_y, ground_y] = ["radio-rxd", "radio-ground"].map(|name| points(name)[0].1);
    let resistor_ends = points("radio-2k");
    assert_eq!([0, 1].map(|end| resistor_ends[end].1), [rxd_y, ground_y]);
    for label in ["Option: a radio module", "1 k\u{3a9}", "2 k\u{3a9}"] {
        assert!(drawing.texts().any(|text| text.contains(label)), "{label}");
    }
}

#[test]
fn inputs_are_drawn_as_options_between_their_pins_and_ground() {
    let draw_with_tables = |tables: &str| {
        let text = paper_toml().replace("[limits]", &format!("{tables}\n[limits]"));
        draw_robot_wiring(&text)
    };
    let (button, nose) = ("[input.button]\npin = \"A1\"", "[input.nose]\npin = \"D7\"");
    let (no_inputs, button_only) = (draw_with_tables(""), draw_with_tables(button));
    let both_inputs = draw_with_tables(&format!("{button}\n{nose}"));
    let are_drawn =
        |id: &str| [&no_inputs, &button_only, &both_inputs].map(|drawing| drawing.has_element(id));
    for name in ["input-button-A1", "input-button-GND"] {
        assert_eq!(are_drawn(name), [false, true, true]);
    }
    for name in ["input-nose-D7", "input-nose-GND", "input-nose-5V"] {
        assert_eq!(are_drawn(name), [false, false, true]);
        let terminal = name.replace("input-", "end-");
        let [wire, terminal] = [name, &terminal].map(|id| both_inputs.points_by_id(id));
        assert_eq!(wire[0], terminal[0]);
    }
    for (drawing, is_used) in [(&both_inputs, true), (&no_inputs, false)] {
        let [a1, d9] = ["pin-A1", "pin-D9"].map(|pin| pin_fill(drawing, pin));
        assert_eq!(a1 == d9, is_used, "{a1} {d9}");
    }
}

#[test]
fn the_pins_have_the_positions_of_a_unos_pins() {
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
    let drawing = draw_robot_wiring(&paper_toml());
    let pin_point = |name: &str| drawing.points_by_id(&format!("pin-{name}"))[0];
    let scale = (pin_point("D0").0 - pin_point("D13").0) / (2500.0 - 1140.0);
    let (origin, origin_mil) = (pin_point("D13"), PINS[0].1);
    for (name, position_mil) in PINS {
        let (x, y) = pin_point(name);
        let error_mil = (
            (x - origin.0) / scale - (position_mil.0 - origin_mil.0),
            (origin.1 - y) / scale - (position_mil.1 - origin_mil.1),
        );
        let is_small = error_mil.0.abs() < 1.0 && error_mil.1.abs() < 1.0;
        assert!(is_small, "{name}: error {error_mil:?} mil");
    }
}

#[test]
fn the_pin_that_measures_the_servo_supply_is_marked() {
    let text = paper_toml().replace(
        "[limits]",
        "[supply.rail]\npin = \"A3\"\nratio = 2.5\n[limits]",
    );
    let drawing = draw_robot_wiring(&text);
    for note in [
        "Pin A3 measures the +5 V strip, divided by 2.50.",
        "Its divider: for example 15.0 k\u{3a9} from the strip to the pin, 10 k\u{3a9} to ground.",
    ] {
        assert!(drawing.texts().any(|text| text == note), "{note}");
    }
    assert_eq!(pin_fill(&drawing, "pin-A3"), pin_fill(&drawing, "pin-D9"));
    assert_ne!(pin_fill(&drawing, "pin-A3"), pin_fill(&drawing, "pin-A2"));
}

#[test]
fn servos_at_another_voltage_than_the_drawn_supply_are_mentioned() {
    let text = format!("{}\n[servo]\nvolts = 6.0\n", paper_toml());
    let note =
        "The drawing is for servos at 5 V, but this robot's servos are at 6 V: the converter,";
    assert!(draw_robot_wiring(&text).texts().any(|text| text == note));
    assert!(
        draw_robot_wiring(&paper_toml())
            .texts()
            .all(|text| text != note)
    );
}
