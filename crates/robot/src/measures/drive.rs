//! The drive from a servo's link to its leg: `[leg.drive]` in robot.toml.

use lizard_contact::{Drive, DriveKind, Strut};

use crate::file::{Checked, Section, hint};
use crate::measures::legs::LegPlan;
use crate::measures::parts::Parts;
use crate::measures::strut;

const TABLE: &str = "drive";
const KEYS: [&str; 4] = ["kind", "play", "force", "rate"];
/// The kinds of drive, with the keys that each has in addition to `kind` and `play`.
const KINDS: [(&str, &[&str]); 2] = [
    (DriveKind::WORDS[0], &[]),
    (DriveKind::WORDS[1], &["force", "rate"]),
];

/// Reads `[leg.drive]`. If it is left out, the legs are rigid.
pub(crate) fn read(
    leg: &Section,
    legs: &[LegPlan; 4],
    neutral: [f64; 4],
    parts: &Parts,
) -> Checked<Drive> {
    if !leg.has(TABLE) {
        return Ok(Drive::RIGID);
    }
    let section = leg.open(TABLE)?;
    let word = match section.has("kind") {
        true => section.text("kind")?,
        false => KINDS[0].0,
    };
    if word == "spring" {
        let message = "is \"spring\", which no part is; write \"strut\" with the force and rate of its spring, or \"rigid\"";
        return Err(section.fault("kind", message));
    }
    let section = section.require_known_keys(&KEYS)?;
    let Some((_, own_keys)) = KINDS.into_iter().find(|(name, _)| *name == word) else {
        let hint = hint(word, &KINDS.map(|(name, _)| name));
        return Err(section.fault("kind", format!("is \"{word}\"; {hint}")));
    };
    let mut all_keys = KINDS.into_iter().flat_map(|(_, keys)| keys);
    if let Some(foreign_key) = all_keys.find(|key| !own_keys.contains(key) && section.has(key)) {
        return Err(section.fault(foreign_key, format!("does not go with kind = \"{word}\"")));
    }
    let kind = match word {
        "strut" => {
            let coil = strut::strut_with_coil(legs, neutral, parts, &parts.spring);
            DriveKind::Strut(Strut {
                force: section.number_or("force", coil.force, 0.01, 100.0, "N")?,
                rate: section.number_or("rate", coil.rate, 0.0, 100.0, "N/mm")?,
                ..coil
            })
        }
        _ => DriveKind::Rigid,
    };
    let play = section.number_or("play", 0.0, 0.0, 20.0, "deg")?;
    Ok(Drive { kind, play })
}
