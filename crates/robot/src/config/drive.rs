//! The drive from a servo's link to its leg: `[leg.drive]` in robot.toml.

use lizard_contact::{Drive, DriveKind, Strut};

use crate::config::legs::LegPlan;
use crate::config::parts::Parts;
use crate::config::strut;
use crate::file::{ReadResult, Table, suggest};

/// Every key that some kind of drive has.
const KEYS: [&str; 4] = ["kind", "play", "force", "rate"];
/// The kinds of drive, each with its keys in addition to `kind` and `play`.
const KINDS: [(&str, &[&str]); 2] = [("rigid", &[]), ("strut", &["force", "rate"])];

/// Reads `[leg.drive]`; without this table, the struts are rigid. The servos' neutral angles are in deg, chassis frame.
pub(crate) fn read(
    leg_table: &Table,
    legs: &[LegPlan; 4],
    neutral_angles: [f64; 4],
    parts: &Parts,
) -> ReadResult<Drive> {
    let table = leg_table.optional_unchecked_table("drive")?;
    let kind_name = table.text_or("kind", "rigid")?;
    if kind_name == "spring" {
        let message = "is \"spring\", which is no longer supported; write \"strut\" with the force and rate of its spring, or \"rigid\"";
        return Err(table.error("kind", message));
    }
    let table = table.require_known_keys(&KEYS)?;
    let Some((_, own_keys)) = KINDS.into_iter().find(|(name, _)| *name == kind_name) else {
        let suggestion = suggest(kind_name, &KINDS.map(|(name, _)| name));
        return Err(table.error("kind", format!("is \"{kind_name}\"; {suggestion}")));
    };
    let mut keys_of_kinds = KINDS.into_iter().flat_map(|(_, keys)| keys);
    let is_misplaced = |key: &&&str| !own_keys.contains(key) && table.has_key(key);
    if let Some(misplaced_key) = keys_of_kinds.find(is_misplaced) {
        let message = format!("is not allowed with kind = \"{kind_name}\"");
        return Err(table.error(misplaced_key, message));
    }
    let kind = match kind_name {
        "strut" => {
            let default_strut = strut::own_strut(legs, neutral_angles, parts);
            let (force, rate) = (default_strut.preload, default_strut.spring_rate);
            let read_or_derive = |name, derived: f64, (min, max): (f64, f64), unit| {
                if table.has_key(name) || (min..=max).contains(&derived) {
                    return table.number_or(name, derived, (min, max), unit);
                }
                let cause = match derived {
                    0.0 => "parts.spring is too long for its strut, which makes it",
                    _ => "parts.spring makes it",
                };
                let message = format!(
                    "is left out; {cause} {derived:.2} {unit}, but it must be between {min} and {max} {unit}"
                );
                Err(table.error(name, message))
            };
            DriveKind::Strut(Strut {
                preload: read_or_derive("force", force, (0.01, 100.0), "N")?,
                spring_rate: read_or_derive("rate", rate, (0.0, 100.0), "N/mm")?,
                ..default_strut
            })
        }
        _ => DriveKind::Rigid,
    };
    let play = table.number_or("play", 0.0, (0.0, 20.0), "deg")?;
    Ok(Drive { kind, play })
}
