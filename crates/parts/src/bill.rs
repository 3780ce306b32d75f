//! What the robot is made of: a list to buy, its mass and its mass centre.

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
/// What is bought, g: a servo, its horn, an UNO, a battery for each mm^3, a spring's
/// steel for each mm^3, screws and standoffs for each mm and a head, a nut.
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

/// What is bought and hangs in the wires or between them: how many, what, g each. Their
/// middle is that of the rest.
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
    (
        1,
        "round plug 5.5 x 2.1 mm with two wires, from the battery's switch to the UNO's socket",
        4.0,
    ),
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

/// One kind of thing, and how many.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Item {
    /// How many.
    pub count: usize,
    /// What.
    pub what: String,
    /// Of one, g.
    #[serde(serialize_with = "decimals::one::<10, _>")]
    pub grams: f64,
    /// To print one, h; `None` for what is bought.
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

/// Everything, and what it weighs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bill {
    /// To print.
    pub printed: Vec<Item>,
    /// To print instead of some of it: the other kind of strut.
    pub instead: Vec<Item>,
    /// To buy.
    pub bought: Vec<Item>,
    /// All of it at neutral, g.
    #[serde(serialize_with = "decimals::one::<10, _>")]
    pub grams: f64,
    /// The mass centre: ahead of, left of and above the plate's middle, mm.
    #[serde(serialize_with = "decimals::each::<10, _>")]
    pub centre: [f64; 3],
    /// What the leg feels of its spring; `None` where its strut is rigid.
    pub hold: Option<Hold>,
}

/// A name for what is not printed, and its mass in g.
fn bought(body: &Body, assembly: &Assembly, hold: Option<&Hold>) -> (String, f64) {
    let parts = assembly.robot().parts();
    let diameter = parts.screw.diameter;
    match body.kind {
        Kind::Printed => (String::new(), 0.0),
        Kind::Servo => ("servo SG-90 with its horn and screws".to_owned(), SERVO),
        Kind::Horn => (String::new(), HORN),
        Kind::Screw(length) => (
            format!("screw M{diameter} x {length}, button head (ISO 7380)"),
            SCREW_HEAD + SCREW_MM * length,
        ),
        Kind::HexScrew(length) => (
            format!("screw M{diameter} x {length}, hexagon head (ISO 4017)"),
            SCREW_HEAD + SCREW_MM * length,
        ),
        Kind::ServoScrew => (String::new(), SERVO_SCREW),
        Kind::HornScrew(length) => (
            format!(
                "self-tapping screw, 1.7 to 2 mm thick, {length} mm long and no longer, for the horns"
            ),
            HORN_SCREW,
        ),
        Kind::Lead => (String::new(), 0.0),
        Kind::Fitting(fitting) => (fitting.what(), fitting.grams()),
        Kind::Pad => (
            "rubber pad, self-adhesive, 8 mm wide and 1.5 mm thick, all four of one kind"
                .to_owned(),
            PAD,
        ),
        Kind::Nut => (format!("lock nut M{diameter} (DIN 985)"), NUT),
        Kind::Standoff(length) => (
            format!("standoff M{diameter}, {length} mm, thread in both ends"),
            STANDOFF_MM * length,
        ),
        Kind::Spring => {
            let Coil {
                wire,
                outer,
                length,
            } = parts.spring;
            let volume = coil_volume(&parts.spring);
            let pull = hold.map_or(String::new(), |hold| {
                format!(", {:.1} N at {:.1} mm", hold.force, hold.installed)
            });
            (
                format!(
                    "tension spring, wire {wire} mm, coil {outer} mm, {length} mm inside its hooks{pull}"
                ),
                STEEL * volume,
            )
        }
        Kind::Board => ("Arduino UNO".to_owned(), BOARD),
        Kind::Battery => {
            let [x, y, z] = parts.battery;
            (
                format!("battery, two lithium cells, at most {x} x {y} x {z} mm"),
                BATTERY * x * y * z,
            )
        }
    }
}

/// What the spring of a strut weighs, g.
pub(crate) fn spring(coil: &Coil) -> f64 {
    STEEL * coil_volume(coil)
}

/// What a body weighs, g.
pub(crate) fn grams(body: &Body, assembly: &Assembly) -> f64 {
    match body.kind {
        Kind::Printed => PRINTED * volume(&body.prisms),
        _ => bought(body, assembly, None).1,
    }
}

/// The wire of a spring, mm^3: its coils and one more for the hooks.
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
            let (volume, middle) = middle(&body.prisms);
            let mass = match body.kind {
                Kind::Printed => PRINTED * volume,
                _ => {
                    let (what, mass) = bought(body, assembly, hold.as_ref());
                    if !what.is_empty() {
                        let known = list.entry(what).or_insert((0, mass));
                        known.0 += 1;
                    }
                    mass
                }
            };
            let at = assembly
                .place(body.mount, pose)
                .map(Vector::new(middle[0], middle[1]));
            grams += mass;
            for (sum, part) in moment.iter_mut().zip([at.y, -at.x, middle[2]]) {
                *sum += mass * part;
            }
        }
        let printed = |instead: bool| -> Vec<Item> {
            let parts = parts.iter();
            let some = parts.filter(|part| part.instead_of.is_some() == instead);
            some.map(Item::printed).collect()
        };
        let bought = list
            .into_iter()
            .map(|(what, (count, grams))| Item::bought(count, what, grams));
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

    /// To print all of it, h.
    #[must_use]
    pub fn hours(&self) -> f64 {
        let each = self.printed.iter();
        each.map(|item| item.count as f64 * item.hours.unwrap_or_default())
            .sum()
    }

    /// Screws, nuts and so on whose name begins so, in all.
    #[must_use]
    pub fn count(&self, what: &str) -> usize {
        let alike = self
            .bought
            .iter()
            .filter(|item| item.what.starts_with(what));
        alike.map(|item| item.count).sum()
    }
}

/// Volume and middle of a body in its own frame, mm^3 and mm.
fn middle(prisms: &[Prism]) -> (f64, [f64; 3]) {
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
    (volume, sum.map(|part| part / volume))
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
        for Item {
            count, what, grams, ..
        } in &self.instead
        {
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
        writeln!(
            f,
            "\nIn all about {:.0} g; the mass centre is {} the middle of the plate, \
             {:.1} mm above its top.\n",
            self.grams,
            self.beside(),
            self.centre[2]
        )?;
        if let Some(hold) = &self.hold {
            write!(f, "{hold}")?;
        } else {
            writeln!(f, "{RIGID}")?;
        }
        writeln!(f, "\nIn robot.toml:\n\n```toml")?;
        match &self.hold {
            Some(Hold { force, rate, .. }) => writeln!(
                f,
                "[leg.drive]\nkind = \"strut\"\nforce = {force:.2}\nrate = {rate:.3}\n"
            )?,
            None => writeln!(f, "[leg.drive]\nkind = \"rigid\"\n")?,
        }
        writeln!(f, "{}```", self.body_toml())
    }
}

/// What rigid struts come to.
const RIGID: &str = "The struts are rigid: a foot follows its servo but for the play of pins and gears. A foot that is caught \
                     can stall its servo, which gets hot and may burn out; a strut with a spring is no help there. Watch the robot while it \
                     walks, and switch the servos' supply off when a foot is caught.";
