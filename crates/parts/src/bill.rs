//! The bill of a robot: parts to print, things to buy, mass and mass centre.

use std::collections::BTreeMap;
use std::fmt;

use lizard_kinematics::{Solution, Vector};
use lizard_robot::Coil;
use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::decimals;
use crate::hold::Hold;
use crate::layers::body::{Body, Kind, Prism};
use crate::layers::outline::Outline;
use crate::part::{Part, volume};

/// A printed part's mass over its volume, g/mm^3: PLA of 1.24, a third of infill within
/// three lines of wall. PrusaSlicer's parts are within a tenth of it in sum.
const PRINTED: f64 = 1.0e-3;
/// Hours of printing in layers of 0.2 mm on an Ender 3, for each piece and each g of it.
/// PrusaSlicer's are within a tenth of it in sum.
const HOURS_A_PIECE: f64 = 0.02;
const HOURS_A_GRAM: f64 = 0.095;
/// Masses of bought things, g: a servo, its horn, a UNO, a battery per mm^3, a spring's
/// steel per mm^3, screws per mm and per head, standoffs per mm, nuts and so on.
const SERVO: f64 = 9.5;
const HORN: f64 = 0.8;
const BOARD: f64 = 25.0;
const BATTERY: f64 = 1.1e-3;
const STEEL: f64 = 7.85e-3;
const SCREW_MM: f64 = 0.044;
const SCREW_HEAD: f64 = 0.25;
const STANDOFF_MM: f64 = 0.06;
const NUT: f64 = 0.4;
const HORN_SCREW: f64 = 0.1;
const SERVO_SCREW: f64 = 0.2;
const PAD: f64 = 0.2;

/// Things to buy that have no place of their own on the robot, such as wires: count, name
/// and mass of one, g. Their centre is taken to be that of the rest.
const MORE: [(usize, &str, f64); 12] = [
    (
        4,
        "resistor 10 kOhm, from each servo's signal to ground",
        0.2,
    ),
    (1, "switch for 3 A, in the battery's plus wire", 4.0),
    (
        1,
        "fuse holder for a wire, with a fuse of 5 A, beside the battery",
        5.0,
    ),
    (
        1,
        "plug for the battery's own, with two wires of 0.75 mm2, 10 cm long",
        4.0,
    ),
    (1, ROUND_PLUG, 4.0),
    (2, "wire of 0.5 mm2, one red and one black, 0.5 m long", 3.0),
    (
        12,
        "jumper wire, pin to pin, 20 cm, for the servos' plugs",
        0.4,
    ),
    (8, "cable tie, 2.5 mm wide, 100 mm long", 0.3),
    (1, "double-sided foam tape, 20 mm wide, 20 cm", 1.0),
    (1, "USB cable, A to B, that carries data", 0.0),
    (1, "charger for the battery", 0.0),
    (
        1,
        "drill of 3 mm, kitchen scale, hex key and sockets for M3",
        0.0,
    ),
];
const ROUND_PLUG: &str =
    "round plug 5.5 x 2.1 mm with two wires, from the battery's switch to the UNO's socket";

/// A line of the bill.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Item {
    /// The number of pieces.
    pub count: usize,
    /// The name, with the measures needed to buy it.
    pub what: String,
    /// Mass of one piece, g.
    #[serde(serialize_with = "decimals::one::<10, _>")]
    pub grams: f64,
    /// Hours to print one piece; `None` for bought things.
    #[serde(
        serialize_with = "decimals::optional::<100, _>",
        skip_serializing_if = "Option::is_none"
    )]
    pub hours: Option<f64>,
}

impl Item {
    fn printed(part: &Part) -> Self {
        let grams = PRINTED * part.volume();
        Self {
            count: part.count(),
            what: part.name.clone(),
            grams,
            hours: Some(HOURS_A_PIECE + HOURS_A_GRAM * grams),
        }
    }

    fn bought(count: usize, what: String, grams: f64) -> Self {
        Self {
            count,
            what,
            grams,
            hours: None,
        }
    }
}

/// The bill of a robot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bill {
    /// Parts to print.
    pub printed: Vec<Item>,
    /// Parts to print instead of some of these: struts of the other kind.
    pub instead: Vec<Item>,
    /// Things to buy.
    pub bought: Vec<Item>,
    /// The robot's mass, g.
    #[serde(serialize_with = "decimals::one::<10, _>")]
    pub grams: f64,
    /// The mass centre at neutral: ahead of, left of and above the plate's middle, mm.
    #[serde(serialize_with = "decimals::each::<10, _>")]
    pub centre: [f64; 3],
    /// The effect of the springs on the legs; `None` for rigid struts.
    pub hold: Option<Hold>,
}

/// The line of the bill for a bought body, empty if it is printed or comes with another
/// one, and the body's mass, g.
fn bought(body: &Body, assembly: &Assembly, hold: Option<&Hold>) -> (String, f64) {
    let parts = assembly.robot().parts();
    let diameter = parts.screw.diameter;
    match body.kind {
        Kind::Printed => (String::new(), PRINTED * volume(&body.prisms)),
        Kind::Servo => ("servo SG-90 with its horn and screws".to_owned(), SERVO),
        Kind::Horn => (String::new(), HORN),
        Kind::Screw(length) | Kind::HexScrew(length) => {
            let head = match body.kind {
                Kind::Screw(_) => "button head (ISO 7380)",
                _ => "hexagon head (ISO 4017)",
            };
            let what = format!("screw M{diameter} x {length}, {head}");
            (what, SCREW_HEAD + SCREW_MM * length)
        }
        Kind::ServoScrew => (String::new(), SERVO_SCREW),
        Kind::HornScrew(length) => {
            let size = format!("1.7 to 2 mm thick, {length} mm long and no longer");
            (
                format!("self-tapping screw, {size}, for the horns"),
                HORN_SCREW,
            )
        }
        Kind::Lead => (String::new(), 0.0),
        Kind::Fitting(fitting) => (fitting.what(), fitting.grams()),
        Kind::Pad => {
            let size = "8 mm wide and 1.5 mm thick";
            (
                format!("rubber pad, self-adhesive, {size}, all four of one kind"),
                PAD,
            )
        }
        Kind::Nut => (format!("lock nut M{diameter} (DIN 985)"), NUT),
        Kind::Standoff(length) => {
            let what = format!("standoff M{diameter}, {length} mm, thread in both ends");
            (what, STANDOFF_MM * length)
        }
        Kind::Spring => {
            let Coil {
                wire,
                outer,
                length,
            } = parts.spring;
            let coil = format!("wire {wire} mm, coil {outer} mm, {length} mm inside its hooks");
            let pull = hold.map_or(String::new(), |hold| {
                format!(", {:.1} N at {:.1} mm", hold.force, hold.installed)
            });
            (
                format!("tension spring, {coil}{pull}"),
                spring(&parts.spring),
            )
        }
        Kind::Board => ("Arduino UNO".to_owned(), BOARD),
        Kind::Battery => {
            let [x, y, z] = parts.battery;
            let what = format!("battery, two lithium cells, at most {x} x {y} x {z} mm");
            (what, BATTERY * x * y * z)
        }
    }
}

/// Mass of the spring of a strut, g.
pub(crate) fn spring(coil: &Coil) -> f64 {
    STEEL * coil_volume(coil)
}

/// Mass of a body, g.
pub(crate) fn grams(body: &Body, assembly: &Assembly) -> f64 {
    bought(body, assembly, None).1
}

/// Volume of a spring's wire, mm^3: its coils and three more for the hooks.
fn coil_volume(coil: &Coil) -> f64 {
    use std::f64::consts::PI;
    (coil.coils() + 3.0) * PI * coil.mean() * PI * coil.wire * coil.wire / 4.0
}

impl Bill {
    /// The bill of a robot, whose mass centre is taken at a pose.
    #[must_use]
    pub fn of(assembly: &Assembly, parts: &[Part], pose: &Solution) -> Self {
        let hold = Hold::of(assembly);
        let mut list: BTreeMap<String, (usize, f64)> = BTreeMap::new();
        let (mut grams, mut moment) = (0.0, [0.0; 3]);
        for body in assembly.bodies() {
            let (what, mass) = bought(body, assembly, hold.as_ref());
            if !what.is_empty() {
                list.entry(what).or_insert((0, mass)).0 += 1;
            }
            let [x, y, z] = middle(&body.prisms);
            let at = assembly.place(body.mount, pose).map(Vector::new(x, y));
            grams += mass;
            for (sum, part) in moment.iter_mut().zip([at.y, -at.x, z]) {
                *sum += mass * part;
            }
        }
        let printed = |instead: bool| -> Vec<Item> {
            let parts = parts.iter();
            let some = parts.filter(|part| part.instead_of.is_some() == instead);
            some.map(Item::printed).collect()
        };
        let bought = list.into_iter();
        let bought = bought.map(|(what, (count, grams))| Item::bought(count, what, grams));
        let more = MORE.map(|(count, what, each)| {
            grams += count as f64 * each;
            Item::bought(count, what.to_owned(), each)
        });
        Self {
            printed: printed(false),
            instead: printed(true),
            bought: bought.chain(more).collect(),
            grams,
            centre: moment.map(|sum| sum / grams),
            hold,
        }
    }

    /// Hours to print all parts.
    #[must_use]
    pub fn hours(&self) -> f64 {
        let each = self.printed.iter();
        each.map(|item| item.count as f64 * item.hours.unwrap_or_default())
            .sum()
    }

    /// The number of bought things whose name begins with some words.
    #[must_use]
    pub fn count(&self, what: &str) -> usize {
        let bought = self.bought.iter();
        let alike = bought.filter(|item| item.what.starts_with(what));
        alike.map(|item| item.count).sum()
    }
}

/// The centroid of a body in its own frame, mm.
fn middle(prisms: &[Prism]) -> [f64; 3] {
    let (mut volume, mut sum) = (0.0, [0.0; 3]);
    for prism in prisms {
        let outline = Outline::of(prism);
        let high = prism.z[1] - prism.z[0];
        let (area, moment) = (outline.area(), outline.moment());
        volume += area * high;
        sum[0] += moment.x * high;
        sum[1] += moment.y * high;
        sum[2] += area * high * (prism.z[0] + prism.z[1]) / 2.0;
    }
    sum.map(|part| part / volume)
}

impl fmt::Display for Bill {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "To print:\n")?;
        writeln!(f, "| pieces | part | g each | h each |\n|---|---|---|---|")?;
        for item in &self.printed {
            let (count, what, grams) = (item.count, &item.what, item.grams);
            let hours = item.hours.unwrap_or_default();
            writeln!(f, "| {count} | {what} | {grams:.1} | {hours:.2} |")?;
        }
        writeln!(
            f,
            "\nAbout {:.0} hours on a printer like an Ender 3, in layers of 0.2 mm with 30 % infill.",
            self.hours()
        )?;
        let (other, kind) = match self.hold {
            Some(_) => ("without springs", "rigid"),
            None => ("with springs", "strut"),
        };
        for item in &self.instead {
            let (count, what, grams) = (item.count, &item.what, item.grams);
            writeln!(
                f,
                "\nInstead of the struts, {count} x {what}, {grams:.1} g each, which make legs {other}; with \
                 `kind = \"{kind}\"` under `[leg.drive]` in robot.toml this guide is about them."
            )?;
        }
        writeln!(f, "\nTo buy:\n")?;
        writeln!(f, "| pieces | what |\n|---|---|")?;
        for Item { count, what, .. } in &self.bought {
            writeln!(f, "| {count} | {what} |")?;
        }
        let (grams, beside, up) = (self.grams, self.beside(), self.centre[2]);
        writeln!(
            f,
            "\nIn all about {grams:.0} g; the mass centre is {beside} the middle of the plate, {up:.1} mm above its top.\n"
        )?;
        let drive = match &self.hold {
            Some(hold) => {
                write!(f, "{hold}")?;
                let (force, rate) = (hold.force, hold.rate);
                format!("kind = \"strut\"\nforce = {force:.2}\nrate = {rate:.3}")
            }
            None => {
                writeln!(f, "{RIGID}")?;
                "kind = \"rigid\"".to_owned()
            }
        };
        let body = self.body_toml();
        writeln!(
            f,
            "\nIn robot.toml:\n\n```toml\n[leg.drive]\n{drive}\n\n{body}```"
        )
    }
}

/// The guide's words about rigid struts.
const RIGID: &str = "The struts are rigid: a foot follows its servo but for the play of pins and gears. A foot that is caught \
                     can stall its servo, which gets hot and may burn out; a strut with a spring is no help there. Watch the robot while it \
                     walks, and switch the servos' supply off when a foot is caught.";
