//! The drive from a servo's link to its leg: `[leg.drive]` in robot.toml.

use lizard_contact::{Drive, DriveKind, Strut};

use crate::file::{Checked, Section, hint};
use crate::measures::legs::LegPlan;
use crate::measures::parts::Parts;
use crate::measures::strut;

/// The key of the table in `[leg]`.
const TABLE: &str = "drive";
/// The keys of all kinds of drive.
const KEYS: [&str; 4] = ["kind", "play", "force", "rate"];
/// The kinds of drive, each with the keys that it has in addition to `kind` and `play`.
const KINDS: [(&str, &[&str]); 2] = [
    (DriveKind::NAMES[0], &[]),
    (DriveKind::NAMES[1], &["force", "rate"]),
];

/// Reads `[leg.drive]`. If this table is left out, the legs are rigid. The neutral angles of the servos are in deg,
/// chassis frame.
pub(crate) fn read(
    leg_section: &Section,
    legs: &[LegPlan; 4],
    neutral_angles: [f64; 4],
    parts: &Parts,
) -> Checked<Drive> {
    if !leg_section.has_key(TABLE) {
        return Ok(Drive::RIGID);
    }
    let section = leg_section.open(TABLE)?;
    let kind_name = match section.has_key("kind") {
        true => section.text("kind")?,
        false => KINDS[0].0,
    };
    if kind_name == "spring" {
        let message = "is \"spring\", which no part is; write \"strut\" with the force and rate of its spring, or \"rigid\"";
        return Err(section.error("kind", message));
    }
    let section = section.require_known_keys(&KEYS)?;
    let Some((_, own_keys)) = KINDS.into_iter().find(|(name, _)| *name == kind_name) else {
        let hint = hint(kind_name, &KINDS.map(|(name, _)| name));
        return Err(section.error("kind", format!("is \"{kind_name}\"; {hint}")));
    };
    let mut all_keys = KINDS.into_iter().flat_map(|(_, keys)| keys);
    if let Some(foreign_key) = all_keys.find(|key| !own_keys.contains(key) && section.has_key(key))
    {
        return Err(section.error(
            foreign_key,
            format!("does not go with kind = \"{kind_name}\""),
        ));
    }
    let kind = match kind_name {
        "strut" => {
            let coil_strut = strut::strut_with_coil(legs, neutral_angles, parts, &parts.spring);
            DriveKind::Strut(Strut {
                force: section.number_or("force", coil_strut.force, 0.01, 100.0, "N")?,
                rate: section.number_or("rate", coil_strut.rate, 0.0, 100.0, "N/mm")?,
                ..coil_strut
            })
        }
        _ => DriveKind::Rigid,
    };
    let play = section.number_or("play", 0.0, 0.0, 20.0, "deg")?;
    Ok(Drive { kind, play })
}
