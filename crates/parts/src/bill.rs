//! A robot's bill of materials: parts to print, items to buy, mass and centre of mass.

mod unmodelled;

use std::collections::BTreeMap;
use std::fmt;

use lizard_kinematics::{Solution, Vector};
use lizard_robot::{Coil, Parts, Robot};
use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::bodies::pads::NOTCH_DEPTH;
use crate::decimals;
use crate::layers::body::{Body, Kind, Prism};
use crate::layers::fitting::{BATTERY_EXAMPLES, Example, Fitting};
use crate::layers::outline::Outline;
use crate::part::{Part, compute_volume};
use crate::price::PriceClass;
use crate::spring_effect::SpringEffect;
use unmodelled::{INPUT_ITEMS, RADIO_ITEMS, Row, UNPLACED_ITEMS};

/// Density of a printed part, g/mm^3: PLA of 1.24 g/cm^3 with three perimeters and one third infill. The total mass is
/// within 10 % of PrusaSlicer's estimate.
const PRINTED_DENSITY: f64 = 1.0e-3;
/// Density of a pad, g/mm^3: TPU of 1.21 g/cm^3, since a pad is nearly all wall.
const PAD_DENSITY: f64 = 1.15e-3;
/// Hours of printing for each piece of any mass, in layers of 0.2 mm on an Ender 3. Together with the hours for each
/// gram, the total is within 10 % of PrusaSlicer's estimate.
const HOURS_PER_PIECE: f64 = 0.02;
/// Hours of printing for each gram of a piece.
const HOURS_PER_GRAM: f64 = 0.095;
/// Mass of a servo, g.
const SERVO_GRAMS: f64 = 9.5;
/// Mass of a horn, g.
const HORN_GRAMS: f64 = 0.8;
/// Mass of an Arduino UNO, g.
const BOARD_GRAMS: f64 = 25.0;
/// Density of a battery, g/mm^3.
const BATTERY_DENSITY: f64 = 1.1e-3;
/// Density of a spring's steel, g/mm^3.
const STEEL_DENSITY: f64 = 7.85e-3;
/// Mass of a screw's shank, g per mm of length.
const SCREW_GRAMS_PER_MM: f64 = 0.044;
/// Mass of a screw's head, g.
const SCREW_HEAD_GRAMS: f64 = 0.25;
/// Mass of a standoff, g per mm of length.
const STANDOFF_GRAMS_PER_MM: f64 = 0.06;
/// Mass of a lock nut, g.
const NUT_GRAMS: f64 = 0.4;
/// Mass of a screw between horn and link, g.
const HORN_SCREW_GRAMS: f64 = 0.1;
/// Mass of a screw that holds a servo's flange, g.
const SERVO_SCREW_GRAMS: f64 = 0.2;

/// A row of the bill of materials.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Item {
    /// Number of pieces.
    pub count: usize,
    /// Name, with the dimensions needed to buy the item.
    #[serde(rename = "what")]
    pub name: String,
    /// Mass of one piece, g.
    #[serde(serialize_with = "decimals::rounded::<10, _>")]
    pub grams: f64,
    /// Price class of the row; `None` for printed parts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub price: Option<PriceClass>,
    /// Hours to print one piece; `None` for bought items.
    #[serde(
        serialize_with = "decimals::rounded_option::<100, _>",
        skip_serializing_if = "Option::is_none"
    )]
    pub hours: Option<f64>,
}

impl Item {
    fn printed(part: &Part) -> Self {
        let density = match part.is_flexible {
            true => PAD_DENSITY,
            false => PRINTED_DENSITY,
        };
        let grams = density * part.volume();
        Self {
            hours: Some(HOURS_PER_PIECE + HOURS_PER_GRAM * grams),
            price: None,
            count: part.count(),
            name: part.name.clone(),
            grams,
        }
    }

    /// Creates the row of a bought item; `grams` is the mass of one piece.
    fn bought(count: usize, name: String, grams: f64, price: PriceClass) -> Self {
        Self {
            count,
            name,
            grams,
            price: Some(price),
            hours: None,
        }
    }

    /// Creates a row for an item that is not modelled as a body of the robot.
    fn unmodelled((count, name, grams, price): Row) -> Self {
        Self::bought(count, name.to_owned(), grams, price)
    }
}

/// The bill of materials of a robot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bill {
    /// Parts to print.
    pub printed: Vec<Item>,
    /// Parts that may replace others: the struts of the kind that the robot does not have.
    #[serde(rename = "instead")]
    pub alternatives: Vec<Item>,
    /// Items to buy.
    pub bought: Vec<Item>,
    /// Items to buy for driving without a cable.
    pub radio: Vec<Item>,
    /// Items to buy for the inputs and the pads' strips in robot.toml; optional.
    pub inputs: Vec<Item>,
    /// Sum of the price classes of all items to buy except options: lower and upper bound, euros.
    pub euros: [u32; 2],
    /// Mass of the robot, g.
    #[serde(serialize_with = "decimals::rounded::<1, _>")]
    pub grams: f64,
    /// Centre of mass at the pose given to [`Bill::compute`]: forward, left and up from the plate's middle, mm.
    #[serde(rename = "centre", serialize_with = "decimals::rounded_list::<10, _>")]
    pub centre_of_mass: [f64; 3],
    /// Effect of the springs on the legs; `None` if the struts are rigid.
    #[serde(rename = "hold")]
    pub spring_effect: Option<SpringEffect>,
    /// Size of the space for the battery: to the right, forward, up, mm.
    #[serde(skip)]
    battery_space: [f64; 3],
}

/// Formats the name of the bill's row for a bought body; empty for a body that is printed or sold as a part of another
/// body.
fn format_item_name(body: &Body, parts: &Parts, spring_effect: Option<&SpringEffect>) -> String {
    let diameter = parts.screw.diameter;
    match body.kind {
        Kind::Servo => "servo SG-90 with its horn and screws".to_owned(),
        Kind::Screw(length) => format!("screw M{diameter} x {length}, button head (ISO 7380)"),
        Kind::HexScrew(length) => format!("screw M{diameter} x {length}, hexagon head (ISO 4017)"),
        Kind::HornScrew(length) => {
            let size = format!("1.7 to 2 mm thick, exactly {length} mm long");
            format!("self-tapping screw, {size}, for the horns")
        }
        Kind::Fitting(fitting) => fitting.format_item_name(),
        Kind::Nut => format!("lock nut M{diameter} (DIN 985)"),
        Kind::Standoff(length) => {
            format!("standoff M{diameter}, {length} mm, thread in both ends")
        }
        Kind::Spring => {
            let spring = &parts.spring;
            let (wire, outer) = (spring.wire_diameter, spring.outer_diameter);
            let length = spring.free_length;
            let pull_text = spring_effect.map_or(String::new(), |effect| {
                let (force, length) = (effect.preload_force, effect.installed_length);
                format!(", {force:.1} N at {length:.1} mm")
            });
            format!(
                "tension spring, wire {wire} mm, coil {outer} mm, {length} mm inside its hooks{pull_text}"
            )
        }
        Kind::Board => "Arduino UNO".to_owned(),
        Kind::Battery => {
            let [x, y, z] = parts.battery;
            format!("battery, two lithium cells, at most {x} x {y} x {z} mm")
        }
        Kind::Printed | Kind::Pad | Kind::Horn | Kind::ServoScrew | Kind::Lead => String::new(),
    }
}

/// Price class of a bought body's row.
fn price_class(kind: Kind) -> PriceClass {
    match kind {
        Kind::Fitting(fitting) => fitting.price_class(),
        Kind::Servo | Kind::Board | Kind::Battery => PriceClass::D,
        Kind::Spring => PriceClass::C,
        _ => PriceClass::B,
    }
}

/// Mass of a strut's spring, g.
pub(crate) fn spring_grams(coil: &Coil) -> f64 {
    use std::f64::consts::PI;
    // The active coils, and three more for the hooks.
    let (coil_count, wire) = (coil.active_coil_count() + 3.0, coil.wire_diameter);
    STEEL_DENSITY * (coil_count * PI * coil.mean_diameter() * PI * wire * wire / 4.0)
}

/// Mass of a body, g.
pub(crate) fn body_grams(body: &Body, assembly: &Assembly) -> f64 {
    let parts = assembly.robot().parts();
    match body.kind {
        Kind::Printed => PRINTED_DENSITY * compute_volume(&body.prisms),
        Kind::Pad => PAD_DENSITY * compute_volume(&body.prisms),
        Kind::Servo => SERVO_GRAMS,
        Kind::Horn => HORN_GRAMS,
        Kind::Screw(length) | Kind::HexScrew(length) => {
            SCREW_HEAD_GRAMS + SCREW_GRAMS_PER_MM * length
        }
        Kind::ServoScrew => SERVO_SCREW_GRAMS,
        Kind::HornScrew(_) => HORN_SCREW_GRAMS,
        Kind::Lead => 0.0,
        Kind::Fitting(fitting) => fitting.spec().grams,
        Kind::Nut => NUT_GRAMS,
        Kind::Standoff(length) => STANDOFF_GRAMS_PER_MM * length,
        Kind::Spring => spring_grams(&parts.spring),
        Kind::Board => BOARD_GRAMS,
        Kind::Battery => {
            let [x, y, z] = parts.battery;
            BATTERY_DENSITY * x * y * z
        }
    }
}

/// Makes the row for the pads' strips with a grain; `None` if the pads are plain.
fn make_strip_item(parts: &Parts) -> Option<Item> {
    /// Mass of a 30 mm long strip per mm of width, g: climbing skin of 1.2 kg/m^2.
    const STRIP_GRAMS_PER_MM: f64 = 0.036;
    let name = format!(
        "strip with a grain, {} x 30 mm, at most {NOTCH_DEPTH} mm thick: climbing skin of a ski (Pomoca Climb, Colltex; ~1.5 mm \
         without hairs), or a strip of a brush with short, slanted bristles",
        parts.strip
    );
    (parts.strip > 0.0)
        .then(|| Item::bought(4, name, STRIP_GRAMS_PER_MM * parts.strip, PriceClass::C))
}

/// Lists the rows for a robot's inputs and for the strips on its pads.
fn list_input_items(robot: &Robot) -> Vec<Item> {
    let has_input = |name: &str| robot.inputs().named_pins().any(|(input, _)| input == name);
    let rows = INPUT_ITEMS.into_iter().filter(|(name, _)| has_input(name));
    let items = rows.map(|(_, row)| Item::unmodelled(row));
    items.chain(make_strip_item(robot.parts())).collect()
}

impl Bill {
    /// Computes the bill of materials of a robot, with its centre of mass at `pose`.
    pub fn compute(assembly: &Assembly, parts: &[Part], pose: &Solution) -> Self {
        let (robot, spring_effect) = (assembly.robot(), SpringEffect::compute(assembly));
        let mut items_by_name: BTreeMap<String, Item> = BTreeMap::new();
        let (mut grams, mut moment) = (0.0, [0.0; 3]);
        for body in assembly.bodies() {
            let name = format_item_name(body, robot.parts(), spring_effect.as_ref());
            let body_mass = body_grams(body, assembly);
            if !name.is_empty() {
                let price = price_class(body.kind);
                let new_item = Item::bought(0, name.clone(), body_mass, price);
                items_by_name.entry(name).or_insert(new_item).count += 1;
            }
            let [x, y, z] = compute_centroid(&body.prisms);
            let position = assembly.placement(body.mount, pose).map(Vector::new(x, y));
            grams += body_mass;
            for (sum, coordinate) in moment.iter_mut().zip([position.y, -position.x, z]) {
                *sum += body_mass * coordinate;
            }
        }
        let list_items = |is_alternative: bool| -> Vec<Item> {
            let parts = parts.iter();
            let listed_parts = parts.filter(|part| part.replaces.is_some() == is_alternative);
            listed_parts.map(Item::printed).collect()
        };
        let unplaced_items = UNPLACED_ITEMS.map(Item::unmodelled);
        let row_grams = |item: &Item| item.count as f64 * item.grams;
        grams += unplaced_items.iter().map(row_grams).sum::<f64>();
        let bought: Vec<_> = items_by_name.into_values().chain(unplaced_items).collect();
        Self {
            printed: list_items(false),
            alternatives: list_items(true),
            euros: PriceClass::sum(bought.iter().filter_map(|item| item.price)),
            bought,
            radio: RADIO_ITEMS.map(Item::unmodelled).into(),
            inputs: list_input_items(robot),
            grams,
            centre_of_mass: moment.map(|sum| sum / grams),
            spring_effect,
            battery_space: robot.parts().battery,
        }
    }

    /// Explains the price classes and states their sum.
    pub fn format_prices(&self) -> String {
        let [min, max] = self.euros;
        let explanation = PriceClass::explanation();
        format!("{explanation} The sum of all rows, tools included, is {min} to {max} euros.")
    }

    /// Hours to print all parts.
    pub fn printing_hours(&self) -> f64 {
        let item_hours = |item: &Item| item.count as f64 * item.hours.unwrap_or_default();
        self.printed.iter().map(item_hours).sum()
    }

    /// Counts the bought pieces whose name begins with `prefix`.
    pub fn count_bought(&self, prefix: &str) -> usize {
        let bought = self.bought.iter();
        let matching_items = bought.filter(|item| item.name.starts_with(prefix));
        matching_items.map(|item| item.count).sum()
    }
}

/// Computes the centroid of a body in its own frame, mm.
fn compute_centroid(prisms: &[Prism]) -> [f64; 3] {
    let (mut volume, mut sum) = (0.0, [0.0; 3]);
    for prism in prisms {
        let outline = Outline::from_prism(prism);
        let height = prism.z[1] - prism.z[0];
        let (area, moment) = (outline.area(), outline.first_moment());
        volume += area * height;
        sum[0] += moment.x * height;
        sum[1] += moment.y * height;
        sum[2] += area * height * (prism.z[0] + prism.z[1]) / 2.0;
    }
    sum.map(|moment| moment / volume)
}

impl fmt::Display for Bill {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "To print:\n")?;
        writeln!(f, "| pieces | part | g each | h each |\n|---|---|---|---|")?;
        for item in &self.printed {
            let (count, name, grams) = (item.count, &item.name, item.grams);
            let hours = item.hours.unwrap_or_default();
            writeln!(f, "| {count} | {name} | {grams:.1} | {hours:.2} |")?;
        }
        let hours = self.printing_hours();
        writeln!(
            f,
            "\nAbout {hours:.0} hours on a printer like an Ender 3, in layers of 0.2 mm with 30 % infill.\n\n\
             {PADS_TEXT}"
        )?;
        let (leg_text, kind) = match self.spring_effect {
            Some(_) => ("without springs", "rigid"),
            None => ("with springs", "strut"),
        };
        for item in &self.alternatives {
            let (count, name, grams) = (item.count, &item.name, item.grams);
            writeln!(
                f,
                "\nFor legs {leg_text}, print {count} x {name}, {grams:.1} g each, instead of the struts. With \
                 `kind = \"{kind}\"` under `[leg.drive]` in robot.toml, this guide describes such legs."
            )?;
        }
        let bought = format_buying_table(&self.bought);
        let radio = format_buying_table(&self.radio);
        let prices = self.format_prices();
        writeln!(f, "\nTo buy:\n\n{bought}\n{prices}\n\n{SERVOS_TEXT}")?;
        writeln!(f, "\nOptional, to drive the robot by radio:\n\n{radio}")?;
        if !self.inputs.is_empty() {
            let rows = format_buying_table(&self.inputs);
            writeln!(
                f,
                "Optional, for the inputs and strips in robot.toml:\n\n{rows}"
            )?;
        }
        let places = format_mounting_table(self.battery_space);
        let centre = self.describe_centre();
        let (grams, [_, _, height]) = (self.grams, self.centre_of_mass);
        let (height, side) = (height.abs(), if height < 0.0 { "below" } else { "above" });
        writeln!(
            f,
            "Places on the robot, and products that fit there:\n\n{places}\n\nThe robot weighs about {grams:.0} g; its \
             centre of mass is {centre}, {height:.1} mm {side} the plate's top.\n"
        )?;
        let (drive_text, drive_toml) = match &self.spring_effect {
            Some(effect) => {
                let (force, rate) = (effect.preload_force, effect.spring_rate);
                let toml = format!("kind = \"strut\"\nforce = {force:.2}\nrate = {rate:.3}");
                (effect.to_string(), toml)
            }
            None => (format!("{RIGID_TEXT}\n"), "kind = \"rigid\"".to_owned()),
        };
        let body_toml = self.format_body_toml();
        writeln!(
            f,
            "{drive_text}\nIn robot.toml:\n\n```toml\n[leg.drive]\n{drive_toml}\n\n{body_toml}```"
        )
    }
}

/// The guide's text about the pads.
const PADS_TEXT: &str = "Print all four pads in TPU (95A) from one roll: the flat side on the bed, 100 % infill, layers of 0.1 mm. Floor \
                    edges catch on sharp terraces, so smooth each dome with a thin film of flexible glue or silicone, and leave its hole open.";

/// The guide's text about the servos.
const SERVOS_TEXT: &str = "Use plain analogue servos, all four of one make. According to the model, digital servos lose \
                     13 % of `walk`'s distance, and servos with a light rotor more than half.";

/// Formats items to buy as a Markdown table.
pub fn format_buying_table(items: &[Item]) -> String {
    let mut text = "| pieces | item | price |\n|---|---|---|\n".to_owned();
    for item in items {
        let price = item.price.map(|price| price.to_string());
        let (count, name, price) = (item.count, &item.name, price.unwrap_or_default());
        text += &format!("| {count} | {name} | {price} |\n");
    }
    text
}

/// Formats a Markdown table of the battery and the fittings: place, space, fastening, and examples that fit.
pub fn format_mounting_table(battery: [f64; 3]) -> String {
    let format_size = |[x, y, z]: [f64; 3]| format!("{x} x {y} x {z}");
    let join_examples = |examples: &[Example]| {
        let examples: Vec<_> = examples.iter().map(Example::to_string).collect();
        examples.join("; ")
    };
    let mut text =
        "| part | place | space, mm | fastening | examples, mm |\n|---|---|---|---|---|\n"
            .to_owned();
    let fits = |example: &Example| (0..3).all(|axis| example.size[axis] <= battery[axis]);
    let batteries: Vec<_> = BATTERY_EXAMPLES.into_iter().filter(fits).collect();
    let (space, examples) = (format_size(battery), join_examples(&batteries));
    text += &format!(
        "| battery | on the plate, in the middle | {space} | the battery strap | {examples} |\n"
    );
    for fitting in Fitting::ALL {
        let spec = fitting.spec();
        let (name, place, fastening) = (spec.name, spec.place, spec.fastening);
        let (space, examples) = (format_size(spec.size), join_examples(&spec.examples));
        text += &format!("| {name} | {place} | {space} | {fastening} | {examples} |\n");
    }
    text + SIZES_TEXT
}

/// The text below the table of places: the sources of the sizes, and the sizes of the other parts.
const SIZES_TEXT: &str = "
`~` marks a usual size in shops without a known drawing. The other sizes are from data sheets or standards, with tolerances.

| other parts | size, mm, according to standards or common products |
|---|---|
| screws | ISO 7380-1: head 5.7 x 1.65, 2 mm key; ISO 4017: head 5.5 x 2 (M3) |
| lock nuts | DIN 985: 5.5 over flats, 4 high (M3) |
| standoffs | 5.5 over flats at most, thread in both ends: Harwin R30-100; Wuerth WA-SSTII (~5) |
| fuse | IEC 60127: 5 x 20 of glass; ISO 8820-3: mini blade |
| cable ties | HellermannTyton T18I: 2.5 x 140; Panduit PLT1.5M: ~2.5 x 142 |
| servos | TowerPro SG90: 22.2 x 11.8 x 31, copies ~22.8 x 12.6; MG90S: ~22.8 x 12.2 x 28.5; measure yours for `[parts.servo]` |
| board | Arduino UNO R3: 68.6 x 53.4; Elegoo UNO R3: the same outline, holes and sockets |
";

/// The guide's text about rigid struts.
const RIGID_TEXT: &str = "The struts are rigid: a foot follows its servo except for the play of pins and gears. A foot that is caught \
                     can stall its servo, which gets hot and may burn out; a strut with a spring does not prevent this. Watch the robot \
                     while it walks, and switch the servos' supply off when a foot is caught.";
