//! A number in the text of a robot.toml, changed in its place: comments, blanks and all
//! else stay as they are.

use toml::de::{DeTable, DeValue};

/// The text has no such number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoSuchLength(
    /// The key that was looked for.
    pub String,
);

impl std::fmt::Display for NoSuchLength {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "robot.toml has no number {}", self.0)
    }
}

/// The text with another number at a key of dotted names, such as `links.l1`.
///
/// # Errors
/// If the text is not TOML or has no number there.
pub fn with_number(text: &str, key: &str, value: f64) -> Result<String, NoSuchLength> {
    let missing = || NoSuchLength(key.to_string());
    let document = DeTable::parse(text).map_err(|_| missing())?;
    let (tables, name) = key.rsplit_once('.').ok_or_else(missing)?;
    let mut table = document.get_ref();
    for step in tables.split('.') {
        table = match table.get(step).map(|entry| entry.get_ref()) {
            Some(DeValue::Table(inner)) => inner,
            _ => return Err(missing()),
        };
    }
    let place = table.get(name).ok_or_else(missing)?;
    if !matches!(place.get_ref(), DeValue::Float(_) | DeValue::Integer(_)) {
        return Err(missing());
    }
    let mut changed = text.to_string();
    changed.replace_range(place.span(), &format!("{value:?}"));
    Ok(changed)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "[links]  # lengths\nl0 = 20.0 # base\nl1 = 30\nname = \"x\"\n[servo.A1]\nneutral = 1.5\n";

    #[test]
    fn only_the_number_changes() {
        let changed = with_number(TEXT, "links.l0", 21.5).expect("there");
        assert_eq!(changed, TEXT.replace("20.0", "21.5"));
        let changed = with_number(TEXT, "servo.A1.neutral", 2.0).expect("there");
        assert_eq!(changed, TEXT.replace("1.5", "2.0"));
    }

    #[test]
    fn what_is_no_number_is_left_alone() {
        for key in ["links.l2", "links.name", "wings.l0", "links", "servo.A1"] {
            assert!(with_number(TEXT, key, 1.0).is_err(), "{key}");
        }
        assert!(with_number("[links", "links.l0", 1.0).is_err());
    }
}
