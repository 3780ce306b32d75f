//! The measures of the parts to print and to buy: `[parts]` in robot.toml.
//!
//! The links' lengths place the joints. This table has the width and the thickness of the
//! parts that hold the joints, and the measures of parts from a shop: servos, screws, springs, a
//! board, a battery. None of it moves a joint, so the firmware does not depend on it. The
//! places of the feet do, see `hips.rs`. All keys may be left out.

use crate::file::{Checked, Section};
use crate::measures::coil::Coil;

/// Measures of the parts, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts {
    /// Air on each side between a part and another that is pushed into it or slides in it.
    pub fit: f64,
    /// Least thickness of a printed wall.
    pub wall: f64,
    /// Width of links and couplers.
    pub bar: f64,
    /// Thickness of links and couplers.
    pub thickness: f64,
    /// Thickness of the chassis plate and of the deck.
    pub plate: f64,
    /// Air between parts that pass over each other.
    pub gap: f64,
    /// Width of the cut of a laser or a cutter.
    pub kerf: f64,
    /// The leg's driven pivot on the chassis, from its servo's shaft: outward and towards the
    /// middle. The follower's pivot is a ground link further out.
    pub pivot: [f64; 2],
    /// The foot's place on its coupler, from the crank's joint: outward and towards the middle.
    /// The hip, the centre of the foot's circle, has the same offset from the driven pivot. None
    /// if it is left out; [`crate::LegPlan`] then has the place that follows.
    pub foot: Option<[f64; 2]>,
    /// The strut's anchor on the servo's link and, in parallel, on the leg: distance from the
    /// shaft, and angle (deg) from the crank, away from the arm.
    pub anchor: [f64; 2],
    /// Height of the top of the chassis plate above the floor.
    pub height: f64,
    /// The servos without their horns.
    pub servo: ServoBody,
    /// The servos' horns.
    pub horn: Horn,
    /// Screws that are joints.
    pub screw: Screw,
    /// The legs' springs, which are mounted in their struts.
    pub spring: Coil,
    /// Size of the battery: to the right, forward, up.
    pub battery: [f64; 3],
    /// Length of the two links behind the tail's point, which make the robot look like a
    /// lizard; 0 leaves them out.
    pub tail: f64,
    /// Length of the head's plate ahead of the head's point; 0 leaves it out.
    pub head: f64,
}

/// A servo without its horn, mm. Heights are from the bottom of its case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoBody {
    /// Length of the case, along its flange.
    pub length: f64,
    /// Width of the case.
    pub width: f64,
    /// Height of the case without the gear's boss.
    pub height: f64,
    /// Length of the flange.
    pub flange: f64,
    /// Thickness of the flange.
    pub flange_thickness: f64,
    /// Height of the flange's underside.
    pub flange_height: f64,
    /// Distance from the shaft to the nearer end of the case.
    pub shaft: f64,
    /// Height of the boss around the shaft.
    pub boss: f64,
    /// Distance of the two screws in the flange.
    pub holes: f64,
}

/// A servo's horn with one arm, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Horn {
    /// Diameter of the hub.
    pub hub: f64,
    /// Height of the hub, the arm's thickness included.
    pub height: f64,
    /// Length of the arm, from the shaft to its round end.
    pub arm: f64,
    /// Width of the arm at its end.
    pub tip: f64,
    /// Thickness of the arm.
    pub thickness: f64,
}

/// A screw and its nut, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screw {
    /// Diameter of the thread.
    pub diameter: f64,
    /// Diameter of the head.
    pub head: f64,
    /// Height of the head.
    pub head_height: f64,
    /// Width of the lock nut over its flats.
    pub nut: f64,
    /// Height of the lock nut.
    pub nut_height: f64,
}

impl Default for Parts {
    fn default() -> Self {
        Self {
            fit: 0.2,
            wall: 1.6,
            bar: 9.0,
            thickness: 4.0,
            plate: 4.0,
            gap: 0.5,
            kerf: 0.2,
            pivot: [28.5, 10.0],
            foot: None,
            anchor: [22.0, 0.0],
            height: 34.0,
            servo: ServoBody {
                length: 22.8,
                width: 12.4,
                height: 22.7,
                flange: 32.4,
                flange_thickness: 2.5,
                flange_height: 15.9,
                shaft: 6.1,
                boss: 26.5,
                holes: 27.8,
            },
            horn: Horn {
                hub: 7.0,
                height: 4.5,
                arm: 14.5,
                tip: 4.0,
                thickness: 1.6,
            },
            screw: Screw {
                diameter: 3.0,
                head: 5.7,
                head_height: 1.7,
                nut: 5.5,
                nut_height: 4.0,
            },
            spring: Coil::paper(0.6),
            battery: [31.0, 56.0, 16.0],
            tail: 85.0,
            head: 42.0,
        }
    }
}

const KEYS: [&str; 18] = [
    "fit",
    "wall",
    "bar",
    "thickness",
    "plate",
    "gap",
    "kerf",
    "pivot",
    "foot",
    "anchor",
    "height",
    "servo",
    "horn",
    "screw",
    "spring",
    "battery",
    "tail",
    "head",
];

/// The table that replaces `[parts] strut`.
const STRUT: &str = "[leg.drive] with kind = \"strut\" or \"rigid\"";

impl Parts {
    /// Reads `[parts]`; every key may be left out.
    pub(crate) fn read(root: &Section) -> Checked<Self> {
        let all = Self::default();
        if !root.has("parts") {
            return Ok(all);
        }
        let section = root.open("parts")?;
        section.moved(&["strut"], STRUT)?;
        let section = section.only(&KEYS)?;
        let mm = |name, default, min, max| section.number_or(name, default, min, max, "mm");
        let list = |name, default: [f64; 2], min, max| match section.has(name) {
            true => section.numbers(name, min, max, "(mm; an angle in deg)"),
            false => Ok(default),
        };
        let foot = match section.has("foot") {
            true => Some(list("foot", [0.0; 2], -500.0, 500.0)?),
            false => None,
        };
        let battery = match section.has("battery") {
            true => section.numbers("battery", 1.0, 500.0, "mm")?,
            false => all.battery,
        };
        Ok(Self {
            fit: mm("fit", all.fit, 0.0, 1.0)?,
            wall: mm("wall", all.wall, 0.4, 10.0)?,
            bar: mm("bar", all.bar, 4.0, 50.0)?,
            thickness: mm("thickness", all.thickness, 2.0, 20.0)?,
            plate: mm("plate", all.plate, 2.0, 20.0)?,
            gap: mm("gap", all.gap, 0.1, 5.0)?,
            kerf: mm("kerf", all.kerf, 0.0, 2.0)?,
            pivot: list("pivot", all.pivot, -500.0, 500.0)?,
            foot,
            anchor: list("anchor", all.anchor, -90.0, 500.0)?,
            height: mm("height", all.height, 5.0, 500.0)?,
            servo: ServoBody::read(&section, all.servo)?,
            horn: Horn::read(&section, all.horn)?,
            screw: Screw::read(&section, all.screw)?,
            spring: Coil::read(&section, all.spring)?,
            battery,
            tail: mm("tail", all.tail, 0.0, 300.0)?,
            head: mm("head", all.head, 0.0, 300.0)?,
        })
    }
}

/// Implements the reader of a table of lengths above 0. A table or a key that is left out has its
/// default.
macro_rules! lengths {
    ($type:ident, $table:literal, [$($key:ident),*]) => {
        impl $type {
            fn read(parts: &Section, default: Self) -> Checked<Self> {
                if !parts.has($table) {
                    return Ok(default);
                }
                let section = parts.section($table, &[$(stringify!($key)),*])?;
                Ok(Self {
                    $($key: section.number_or(stringify!($key), default.$key, 0.1, 200.0, "mm")?,)*
                })
            }
        }
    };
}

lengths!(
    ServoBody,
    "servo",
    [
        length,
        width,
        height,
        flange,
        flange_thickness,
        flange_height,
        shaft,
        boss,
        holes
    ]
);
lengths!(Horn, "horn", [hub, height, arm, tip, thickness]);
lengths!(
    Screw,
    "screw",
    [diameter, head, head_height, nut, nut_height]
);
lengths!(Coil, "spring", [wire, outer, length]);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::with;

    fn built(table: &str) -> Result<Parts, String> {
        const BEFORE: &str = "[ground]";
        with("paper", &[(BEFORE, &format!("{table}\n{BEFORE}"))])
            .map(|robot| *robot.parts())
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_key_that_is_left_out_has_the_value_of_the_papers_robot() {
        assert_eq!(built(""), Ok(Parts::default()));
        let parts = built("[parts]\nbar = 10.0\npivot = [30, 11]\n[parts.servo]\nshaft = 5.9");
        let expected = Parts {
            bar: 10.0,
            pivot: [30.0, 11.0],
            servo: ServoBody {
                shaft: 5.9,
                ..Parts::default().servo
            },
            ..Parts::default()
        };
        assert_eq!(parts, Ok(expected));
    }

    #[test]
    fn a_part_that_cannot_be_built_is_refused_with_its_key() {
        for (table, sentence) in [
            (
                "[parts]\nbars = 3.0",
                "parts.bars is not a known key; did you mean \"bar\"?",
            ),
            (
                "[parts]\nbar = 1.0",
                "parts.bar is 1; it must be within 4 to 50 mm",
            ),
            (
                "[parts]\nbattery = [30.0, 50.0]",
                "parts.battery is an array of 2; it must be an array of three numbers",
            ),
            (
                "[parts.horn]\nhub = \"big\"",
                "parts.horn.hub is the string \"big\"; it must be a number",
            ),
            (
                "[parts.spring]\nwire = 0.0",
                "parts.spring.wire is 0; it must be within",
            ),
            ("[parts]\nservo = 3", "parts.servo is"),
            (
                "[parts]\nstrut = \"spring\"",
                "parts.strut is not read any more; write [leg.drive] with kind = \"strut\" or \"rigid\"",
            ),
        ] {
            let refused = built(table).expect_err(table);
            assert!(refused.contains(sentence), "{refused}");
        }
    }
}
