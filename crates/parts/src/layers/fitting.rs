//! The fittings, which the robot carries in addition to its mechanism: supply, terminal strips, plugs.
//!
//! Shops sell such parts in many sizes, so the robot reserves a space for each, into which common products fit. For
//! each space, two products are named with their sizes; a test checks that they fit.

use std::fmt;

use lizard_robot::{FUSE_RATING_A, MIN_SWITCH_RATING_A};

use crate::price::PriceClass;

/// Width and thickness of the battery strap, mm.
pub const STRAP_SECTION: [f64; 2] = [16.0, 1.5];
/// Pitch of a terminal strip of the 3 A size: the distance between adjacent ways, mm.
pub const STRIP_PITCH: f64 = 8.0;

/// Batteries with two lithium cells that fit into the space `battery` of `[parts]`.
pub const BATTERY_EXAMPLES: [Example; 2] = [
    Example::from_shops("GL Racing 2S 450 mAh", [21.0, 56.0, 14.0]),
    Example::from_shops("JJRC H8D 2S 500 mAh", [25.0, 55.0, 12.5]),
];

/// A product, or a kind of product without a common make, that fits into a reserved space.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Name or number of the product, or a description of the kind.
    pub name: &'static str,
    /// Size to the right, forward, up, mm; includes the tolerances of the data sheet, if any.
    pub size: [f64; 3],
    /// True if the size is from a data sheet or drawing; false if it is from shops or users.
    pub is_from_drawing: bool,
}

impl Example {
    const fn from_drawing(name: &'static str, size: [f64; 3]) -> Self {
        Self {
            name,
            size,
            is_from_drawing: true,
        }
    }

    const fn from_shops(name: &'static str, size: [f64; 3]) -> Self {
        Self {
            name,
            size,
            is_from_drawing: false,
        }
    }
}

impl fmt::Display for Example {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let prefix = if self.is_from_drawing { "" } else { "~" };
        let [x, y, z] = self.size;
        write!(f, "{}: {prefix}{x} x {y} x {z}", self.name)
    }
}

/// A kind of bought part that is mounted on the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fitting {
    /// A converter from the battery's voltage to 5 V for the servos.
    Converter,
    /// A capacitor that supports the servos' supply while they start.
    Capacitor,
    /// An alarm that beeps at a low battery voltage.
    Alarm,
    /// A terminal strip that joins all grounds.
    GroundStrip,
    /// Six ways of a terminal strip that distribute the servos' supply.
    SupplyStrip,
    /// Five ways of a terminal strip for the servos' signals, the middle one for ground.
    SignalStrip,
    /// One way of a terminal strip behind the switch, for the battery's positive line.
    PlusTerminal,
    /// A resistor from a signal to ground.
    Resistor,
    /// The switch in the battery's positive line.
    Switch,
    /// The fuse in its holder, in the battery's positive line.
    Fuse,
    /// The battery's plug and its counterpart.
    BatteryPlug,
    /// The plug in the board's barrel jack.
    BarrelPlug,
    /// A strap that holds the battery.
    Strap,
    /// The space reserved for an optional radio module.
    RadioSpace,
}

/// The specification of a fitting: name, mass, space and examples.
#[derive(Clone, Copy, Debug)]
pub struct FittingSpec {
    /// Name of the fitting's body; the bodies of several equal fittings are numbered.
    pub name: &'static str,
    /// Mass according to shops, g.
    pub grams: f64,
    /// Size of the reserved space: to the right, forward, up, mm.
    pub size: [f64; 3],
    /// Text of the article to buy; the bill adds the largest size where it matters. For switch and fuse, the text after
    /// the rating. Empty for a piece of the second terminal strip and for an option.
    pub article: &'static str,
    /// Position on the robot, in words.
    pub place: &'static str,
    /// Means of fastening.
    pub fastening: &'static str,
    /// Two products that fit into the space.
    pub examples: [Example; 2],
}

/// The two common makes of terminal strips with a pitch of 8 mm, cut to a number of ways.
const fn strip_examples(way_count: f64) -> [Example; 2] {
    let length = way_count * STRIP_PITCH;
    [
        Example::from_shops("3 A polythene strip, 2.5 mm2", [16.0, length - 2.0, 13.0]),
        Example::from_shops("Weidmueller MK 3", [17.0, length, 14.0]),
    ]
}

impl Fitting {
    /// All kinds of fittings, roughly in the order of the current's path from the battery.
    pub const ALL: [Self; 14] = [
        Self::Strap,
        Self::BatteryPlug,
        Self::Fuse,
        Self::Switch,
        Self::PlusTerminal,
        Self::Converter,
        Self::Capacitor,
        Self::GroundStrip,
        Self::SupplyStrip,
        Self::SignalStrip,
        Self::Resistor,
        Self::Alarm,
        Self::BarrelPlug,
        Self::RadioSpace,
    ];

    /// Returns the specification of this kind of fitting.
    pub fn spec(self) -> FittingSpec {
        match self {
            Self::Converter => FittingSpec {
                name: "converter",
                grams: 6.0,
                size: [22.0, 28.0, 10.0],
                article: "converter from 7.4 V to 5 V, 3 A",
                place: "under the deck, towards the head",
                fastening: "foam tape, and a cable tie through the deck's window",
                examples: [
                    Example::from_shops("Pololu D36V28F5", [17.8, 17.8, 8.9]),
                    Example::from_shops("MP1584EN board", [17.0, 22.0, 4.0]),
                ],
            },
            Self::Capacitor => FittingSpec {
                name: "capacitor",
                grams: 2.0,
                size: [10.5, 20.5, 10.5],
                article: "capacitor 1000 uF, 10 V or more",
                place: "under the plate, behind the strip for +5 V",
                fastening: "the same cable tie as the strip",
                examples: [
                    Example::from_drawing("Panasonic EEU-FR1A102, 10 V", [10.5, 18.0, 10.5]),
                    Example::from_drawing("Rubycon 16ZLH1000MEFC10X16, 16 V", [10.5, 18.0, 10.5]),
                ],
            },
            Self::Alarm => FittingSpec {
                name: "alarm",
                grams: 9.0,
                size: [26.0, 42.0, 13.0],
                article: "low-voltage alarm for two lithium cells",
                place: "under the deck, towards the tail",
                fastening: "foam tape, and a cable tie around the deck",
                examples: [
                    Example::from_shops("BX100 for 1 to 8 cells", [25.0, 40.0, 11.0]),
                    Example::from_shops("HobbyKing alarm for 2 to 4 cells", [23.0, 37.0, 11.0]),
                ],
            },
            Self::GroundStrip => FittingSpec {
                name: "ground strip",
                grams: 18.0,
                size: [17.5, 97.0, 14.5],
                article: "terminal strip, 12 ways, pitch 8 mm (3 A size)",
                place: "under the plate, left",
                fastening: "two cable ties through the plate's slots",
                examples: strip_examples(12.0),
            },
            Self::SupplyStrip => FittingSpec {
                name: "supply strip",
                grams: 9.0,
                size: [17.5, 49.0, 14.5],
                article: "",
                place: "under the plate, right",
                fastening: "two cable ties through the plate's slots",
                examples: strip_examples(6.0),
            },
            Self::SignalStrip => FittingSpec {
                name: "signal strip",
                grams: 7.5,
                size: [17.5, 41.0, 14.5],
                article: "",
                place: "on the deck's left wing, rear half",
                fastening: "foam tape, and a cable tie through the wing's slots",
                examples: strip_examples(5.0),
            },
            Self::PlusTerminal => FittingSpec {
                name: "plus way",
                grams: 1.5,
                size: [17.5, 8.5, 14.5],
                article: "",
                place: "on the deck's right wing, between switch and fuse",
                fastening: "foam tape",
                examples: strip_examples(1.0),
            },
            Self::Resistor => FittingSpec {
                name: "resistor",
                grams: 0.2,
                size: [2.6, 6.8, 2.6],
                article: "resistor 10 kOhm, 0.25 W, from a servo's signal to ground",
                place: "beside the signal strip, outside",
                fastening: "its own wires, screwed into the strip",
                examples: [
                    Example::from_drawing("Yageo CFR-25JB-52-10K, carbon film", [2.6, 6.8, 2.6]),
                    Example::from_drawing("Yageo MFR-25FBF52-10K, metal film", [2.6, 6.8, 2.6]),
                ],
            },
            Self::Switch => FittingSpec {
                name: "switch",
                grams: 5.0,
                size: [27.0, 21.5, 15.5],
                article: "or more, two contacts, for the battery's plus wire",
                place: "on the deck's right wing, rear end, lying on its side with the rocker outward",
                fastening: "foam tape, and a cable tie around the wing's end and through its slot",
                examples: [
                    Example::from_shops("KCD1-101, 6 A at 250 V AC", [25.0, 21.0, 15.0]),
                    Example::from_shops("Marquardt 1801.1146", [26.0, 21.0, 15.0]),
                ],
            },
            Self::Fuse => FittingSpec {
                name: "fuse",
                grams: 6.0,
                size: [14.0, 46.0, 14.0],
                article: "(a glass one: 3.15 A), and a holder for it that sits in a wire",
                place: "on the deck's right wing, front half",
                fastening: "foam tape, and a cable tie through the wing's slots",
                examples: [
                    Example::from_shops("holder for mini blade fuses (ATM)", [10.0, 40.0, 13.5]),
                    Example::from_shops("holder for glass fuses 5 x 20 mm", [13.0, 44.0, 13.0]),
                ],
            },
            Self::BatteryPlug => FittingSpec {
                name: "battery plug",
                grams: 5.0,
                size: [32.0, 6.6, 12.0],
                article: "plug that fits the battery's, with two wires of 0.5 mm2, 10 cm long",
                place: "on the plate, before the battery, on edge",
                fastening: "foam tape on the battery's end",
                examples: [
                    Example::from_shops("Amass XT30U pair", [26.0, 5.2, 10.2]),
                    Example::from_shops("JST RCY (BEC) pair", [26.0, 6.0, 8.0]),
                ],
            },
            Self::BarrelPlug => FittingSpec {
                name: "barrel plug",
                grams: 4.0,
                size: [15.0, 42.0, 15.0],
                article: "barrel plug 5.5 x 2.1 mm, plus inside, with two wires of 0.25 mm2 or more, 20 cm long",
                place: "in the UNO's barrel jack",
                fastening: "the socket; its wires in a cable tie at the deck",
                examples: [
                    Example::from_shops("moulded, with cable", [10.0, 36.0, 10.0]),
                    Example::from_shops("with screw terminals", [14.0, 38.0, 12.5]),
                ],
            },
            Self::Strap => FittingSpec {
                name: "battery strap",
                grams: 3.0,
                size: [STRAP_SECTION[0], 150.0, STRAP_SECTION[1]],
                article: "hook-and-loop strap, 16 mm wide, 150 mm long",
                place: "around battery and plate, through the slots beside the battery",
                fastening: "itself",
                examples: [
                    Example::from_shops("hook-and-loop cable strap", [16.0, 150.0, 1.5]),
                    Example::from_shops(
                        "non-slip battery strap, cut to length",
                        [16.0, 150.0, 1.5],
                    ),
                ],
            },
            Self::RadioSpace => FittingSpec {
                name: "place for a radio module",
                grams: 0.0,
                size: [16.5, 37.5, 8.0],
                article: "",
                place: "on the deck's left wing, front half",
                fastening: "foam tape",
                examples: [
                    Example::from_drawing("HM-10, bare board", [13.0, 27.0, 2.2]),
                    Example::from_shops("HC-05 or HM-10 on a carrier", [16.0, 37.0, 7.0]),
                ],
            },
        }
    }

    /// Formats the name of the row in the bill of materials; empty for a part that is listed otherwise or not at all.
    pub fn format_item_name(self) -> String {
        let FittingSpec { article, size, .. } = self.spec();
        let [x, y, z] = size;
        let max_size = format!("at most {x} x {y} x {z} mm");
        match self {
            // A second strip is cut into the supply, signal and plus pieces.
            Self::SupplyStrip => Self::GroundStrip.format_item_name(),
            _ if article.is_empty() => String::new(),
            Self::Resistor | Self::Strap | Self::BatteryPlug | Self::BarrelPlug => {
                article.to_owned()
            }
            Self::Capacitor => format!("{article}, at most {x} mm thick and {y} mm long"),
            Self::Switch => format!("switch for {MIN_SWITCH_RATING_A} A {article}, {max_size}"),
            Self::Fuse => format!("fuse of {FUSE_RATING_A} A {article}, {max_size}"),
            _ => format!("{article}, {max_size}"),
        }
    }

    /// Price class of the row in the bill of materials.
    pub fn price_class(self) -> PriceClass {
        match self {
            Self::Resistor => PriceClass::A,
            Self::Converter | Self::Alarm => PriceClass::C,
            _ => PriceClass::B,
        }
    }
}
