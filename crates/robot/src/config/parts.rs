//! The dimensions of the parts to print and to buy: `[parts]` in robot.toml.
//!
//! The links' lengths place the joints. This table contains the width and the thickness of the parts that hold the
//! joints, and the dimensions of bought parts: servos, screws, springs and a battery. The positions of the feet
//! (`hips.rs`) and a strut's geometry and spring (`strut.rs`) follow from this table. The firmware depends on these
//! only through the threshold and the pace of a measured rail. Every key is optional.

use crate::config::coil::Coil;
use crate::file::{ReadResult, Table};

/// Dimensions of the parts, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts {
    /// Clearance on each side of a part that is pushed into another part or slides in it.
    pub fit: f64,
    /// Smallest thickness of a printed wall.
    pub wall: f64,
    /// Width of links and couplers.
    pub bar: f64,
    /// Thickness of links and couplers.
    pub thickness: f64,
    /// Thickness of the chassis plate and of the deck.
    pub plate: f64,
    /// Clearance between parts that pass over each other.
    pub gap: f64,
    /// Width of a cut by a laser or another cutter.
    pub kerf: f64,
    /// The pivot of the leg's driven crank on the chassis, from the servo's shaft: outward, and along the chassis
    /// towards its middle. The follower's pivot is farther out by the length of the ground link.
    pub pivot: [f64; 2],
    /// The foot's position on its coupler, from the crank's joint: outward and towards the middle. The hip, the centre
    /// of the foot's circle, has the same offset from the crank's pivot. `None` if the key is missing;
    /// [`crate::LegPlan`] then contains the computed position.
    pub foot: Option<[f64; 2]>,
    /// The strut's anchor on the servo's link, in polar coordinates: distance from the shaft, and angle (deg) from the
    /// crank, away from the slider's arm. The leg's anchor is parallel to it.
    pub anchor: [f64; 2],
    /// Height of the top of the chassis plate above the floor.
    pub height: f64,
    /// The servos without their horns.
    pub servo: ServoBody,
    /// The servos' horns.
    pub horn: Horn,
    /// The screws that serve as joints.
    pub screw: Screw,
    /// The pads on which the robot stands.
    pub pad: Pad,
    /// Width of a strip with a grain along each pad, from head to tail, which slides more easily in one direction, such
    /// as climbing skin; 0 omits the strip.
    pub strip: f64,
    /// The legs' springs, which are mounted in their struts.
    pub spring: Coil,
    /// Size of the battery: to the right, forward, up.
    pub battery: [f64; 3],
    /// Length of the two links behind the tail's point, which make the robot look like a lizard; 0 omits them.
    pub tail: f64,
    /// Length of the head's plate beyond the head's point; 0 omits the plate.
    pub head: f64,
}

/// Range of both components of `pivot` and `foot`, mm.
const OFFSET_RANGE: (f64, f64) = (-500.0, 500.0);
/// Range of a part's lengths, mm.
const LENGTH_RANGE: (f64, f64) = (0.1, 200.0);

/// Defines the dimensions of a part: a struct of lengths with their defaults, and the reader of its table. Each length
/// must be in [`LENGTH_RANGE`], and the first of a pair after `where` must be less than the second; every key is
/// optional.
macro_rules! dimensions {
    ($($(#[$type_doc:meta])* $type:ident in $table:literal $(where [$($less:ident < $limit:ident),+])? {
        $($(#[$key_doc:meta])* $key:ident: $default:literal,)*
    })*) => {$(
        $(#[$type_doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $type {
            $($(#[$key_doc])* pub $key: f64,)*
        }

        impl $type {
            const DEFAULT: Self = Self { $($key: $default,)* };

            fn read(parts: &Table) -> ReadResult<Self> {
                let default = Self::DEFAULT;
                let table = parts.optional_table($table, &[$(stringify!($key)),*])?;
                let dimensions = Self {
                    $($key: table.number_or(stringify!($key), default.$key, LENGTH_RANGE, "mm")?,)*
                };
                $($(table.require_less(
                    stringify!($less), dimensions.$less, stringify!($limit), dimensions.$limit
                )?;)+)?
                Ok(dimensions)
            }
        }
    )*};
}

dimensions! {
    /// A servo without its horn, mm. Heights are from the bottom of its case.
    ServoBody in "servo" where [shaft < length, length < holes, holes < flange] {
        /// Length of the case, along its flange.
        length: 22.8,
        /// Width of the case.
        width: 12.4,
        /// Height of the case without the gear's boss.
        height: 22.7,
        /// Length of the flange.
        flange: 32.4,
        /// Thickness of the flange.
        flange_thickness: 2.5,
        /// Height of the flange's underside.
        flange_height: 15.9,
        /// Distance from the shaft to the nearer end of the case.
        shaft: 6.1,
        /// Height of the boss around the shaft.
        boss: 26.5,
        /// Distance between the two screws in the flange.
        holes: 27.8,
    }

    /// A servo's horn with one arm, mm.
    Horn in "horn" where [tip < hub] {
        /// Diameter of the hub.
        hub: 7.0,
        /// Height of the hub, the arm's thickness included.
        height: 4.5,
        /// Length of the arm, from the shaft to its round end.
        arm: 14.5,
        /// Width of the arm at its end.
        tip: 4.0,
        /// Thickness of the arm.
        thickness: 1.6,
    }

    /// A screw and its nut, mm.
    Screw in "screw" where [diameter < head, diameter < nut] {
        /// Diameter of the thread.
        diameter: 3.0,
        /// Diameter of the head.
        head: 5.7,
        /// Height of the head.
        head_height: 1.7,
        /// Width of the lock nut over its flats.
        nut: 5.5,
        /// Height of the lock nut.
        nut_height: 4.0,
    }

    /// A round pad under a foot, with a dome below, mm. A dome slides up an edge that would stop a flat pad.
    Pad in "pad" {
        /// Radius of the sphere of which the dome is a part.
        radius: 30.0,
        /// Diameter of the pad. With `radius` it determines the height of the dome.
        width: 22.0,
        /// Total height.
        height: 4.0,
    }
}

impl Pad {
    /// Height of the dome, mm, which is also the height of the highest edge that the pad can slide up. `None` if the
    /// pad is wider than the sphere.
    pub fn dome_height(&self) -> Option<f64> {
        let half_width = self.width / 2.0;
        (half_width <= self.radius)
            .then(|| self.radius - (self.radius * self.radius - half_width * half_width).sqrt())
    }
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
            servo: ServoBody::DEFAULT,
            horn: Horn::DEFAULT,
            screw: Screw::DEFAULT,
            pad: Pad::DEFAULT,
            strip: 0.0,
            spring: Coil {
                wire_diameter: 0.6,
                outer_diameter: 5.55,
                free_length: 25.4,
            },
            battery: [31.0, 56.0, 16.0],
            tail: 85.0,
            head: 42.0,
        }
    }
}

/// The keys of `[parts]`.
const KEYS: [&str; 20] = [
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
    "pad",
    "strip",
    "spring",
    "battery",
    "tail",
    "head",
];

/// Reads the spring of the struts. Its lengths have the same range as the other parts' lengths.
fn read_spring(parts: &Table, default: Coil) -> ReadResult<Coil> {
    let table = parts.optional_table("spring", &["wire", "outer", "length"])?;
    let read_mm = |name, default| table.number_or(name, default, LENGTH_RANGE, "mm");
    Ok(Coil {
        wire_diameter: read_mm("wire", default.wire_diameter)?,
        outer_diameter: read_mm("outer", default.outer_diameter)?,
        free_length: read_mm("length", default.free_length)?,
    })
}

/// The replacement for the removed key `strut` of `[parts]`, for the message about this key.
const STRUT_REPLACEMENT: &str = "[leg.drive] with kind = \"strut\" or \"rigid\"";

impl Parts {
    /// Reads `[parts]`; every key is optional.
    pub(crate) fn read(root: &Table) -> ReadResult<Self> {
        let defaults = Self::default();
        let table = root.optional_unchecked_table("parts")?;
        table.reject_removed_keys(&["strut"], STRUT_REPLACEMENT)?;
        let table = table.require_known_keys(&KEYS)?;
        let read_mm = |name, default, min, max| table.number_or(name, default, (min, max), "mm");
        let foot = match table.has_key("foot") {
            true => Some(table.numbers("foot", OFFSET_RANGE, "mm")?),
            false => None,
        };
        let pivot = table.numbers_or("pivot", defaults.pivot, OFFSET_RANGE, "mm")?;
        if pivot == [0.0; 2] {
            // The strut joins two parallel arms, one at the shaft and one at the pivot.
            let message = "is on the servo's shaft, so the strut would have no length";
            return Err(table.error("pivot", message));
        }
        let battery = table.numbers_or("battery", defaults.battery, (1.0, 500.0), "mm")?;
        Ok(Self {
            fit: read_mm("fit", defaults.fit, 0.0, 1.0)?,
            wall: read_mm("wall", defaults.wall, 0.4, 10.0)?,
            bar: read_mm("bar", defaults.bar, 4.0, 50.0)?,
            thickness: read_mm("thickness", defaults.thickness, 2.0, 20.0)?,
            plate: read_mm("plate", defaults.plate, 2.0, 20.0)?,
            gap: read_mm("gap", defaults.gap, 0.1, 5.0)?,
            kerf: read_mm("kerf", defaults.kerf, 0.0, 2.0)?,
            pivot,
            foot,
            anchor: table.polar_or("anchor", defaults.anchor, (1.0, 500.0), (-180.0, 180.0))?,
            height: read_mm("height", defaults.height, 5.0, 500.0)?,
            servo: ServoBody::read(&table)?,
            horn: Horn::read(&table)?,
            screw: Screw::read(&table)?,
            pad: Pad::read(&table)?,
            strip: read_mm("strip", defaults.strip, 0.0, 100.0)?,
            spring: read_spring(&table, defaults.spring)?,
            battery,
            tail: read_mm("tail", defaults.tail, 0.0, 300.0)?,
            head: read_mm("head", defaults.head, 0.0, 300.0)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::paper_with_tables;

    /// Reads the parts of the paper's robot with these tables.
    fn parts_with(tables: &str) -> Parts {
        *paper_with_tables(tables).expect(tables).parts()
    }

    #[test]
    fn omitted_keys_have_the_values_of_the_papers_robot() {
        assert_eq!(parts_with(""), Parts::default());
        let parts = parts_with("[parts]\nbar = 10.0\npivot = [30, 11]\n[parts.servo]\nshaft = 5.9");
        let expected = Parts {
            bar: 10.0,
            pivot: [30.0, 11.0],
            servo: ServoBody {
                shaft: 5.9,
                ..Parts::default().servo
            },
            ..Parts::default()
        };
        assert_eq!(parts, expected);
    }
}
