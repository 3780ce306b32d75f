//! Items to buy that are not modelled as bodies of the robot: wires, tools, options.

use crate::price::PriceClass::{self, A, B, C, D, E};

/// A row of the bill of materials: number of pieces, name, mass of one piece (g), and price class.
pub(super) type Row = (usize, &'static str, f64, PriceClass);

/// Items to buy without a place of their own on the robot, such as wires. Their centre of mass is assumed to be at the
/// origin, in the middle of the plate.
pub(super) const UNPLACED_ITEMS: [Row; 12] = [
    (
        2,
        "wire of 0.5 mm2 (20 AWG), one red and one black, 1 m long",
        4.0,
        B,
    ),
    (
        17,
        "jumper wire (26 AWG), pin to pin, 20 cm, one of its pins cut off",
        0.4,
        B,
    ),
    (10, "cable tie, 2.5 mm wide, 140 mm long", 0.3, A),
    (1, "double-sided foam tape, 20 mm wide, 40 cm", 2.0, B),
    (1, "heat-shrink tube, 3 mm, 20 cm", 0.5, A),
    (1, "filament, PLA, 250 g", 0.0, C),
    (1, "filament, TPU (95A), 10 g, for the pads", 0.0, B),
    (1, "USB cable, A to B, that carries data", 0.0, B),
    (1, "charger for two lithium cells, with balancer", 0.0, D),
    (
        1,
        "drill of 3 mm, hex key of 2 mm and sockets for M3",
        0.0,
        C,
    ),
    (1, "multimeter, kitchen scale", 0.0, E),
    (1, "soldering iron and solder", 0.0, E),
];

/// Optional items to buy for driving without a cable; neither the mass nor the sum of the prices includes them.
pub(super) const RADIO_ITEMS: [Row; 5] = [
    (
        1,
        "radio module with a serial line: HM-10 or HC-05, at most 16 x 37 mm",
        3.0,
        C,
    ),
    (
        1,
        "diode 1N4148 (a Schottky diode such as BAT85 is better)",
        0.1,
        A,
    ),
    (1, "resistor 1 kOhm, 0.25 W", 0.2, A),
    (
        1,
        "resistor 2 kOhm, 0.25 W (or two of 1 kOhm in series)",
        0.2,
        A,
    ),
    (4, "jumper wire, socket to pin, 20 cm", 0.4, B),
];

/// Optional items for the inputs in robot.toml, each with the input's name; the mass and the price sum exclude them.
pub(super) const INPUT_ITEMS: [(&str, Row); 2] = [
    (
        "button",
        (
            1,
            "push button that closes when it is pressed, with two wires of 20 cm",
            4.0,
            A,
        ),
    ),
    (
        "nose",
        (
            1,
            "infrared obstacle switch with digital output (FC-51 or similar), with three wires of 20 cm",
            5.0,
            B,
        ),
    ),
];
