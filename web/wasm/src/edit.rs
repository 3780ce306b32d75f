//! A number in the text of a robot.toml, changed in its place: comments, blanks and all
//! else stay as they are.

use toml::de::{DeTable, DeValue};

/// Numbers that a robot.toml may leave out: they follow from others until they are set.
pub const LEFT_OUT: [&str; 2] = ["leg.hip_forward", "leg.hip_side"];

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

/// The text with another number at a key of dotted names, such as `links.l1`. One of
/// [`LEFT_OUT`] that is not there is written below the last line of its table.
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
    let Some(place) = table.get(name) else {
        return match LEFT_OUT.contains(&key) {
            true => added(text, table, name, value).ok_or_else(missing),
            false => Err(missing()),
        };
    };
    if !matches!(place.get_ref(), DeValue::Float(_) | DeValue::Integer(_)) {
        return Err(missing());
    }
    let mut changed = text.to_string();
    changed.replace_range(place.span(), &format!("{value:?}"));
    Ok(changed)
}

/// The text with a new line at the end of a table; none where that would not be in it, as
/// in a table that is written on one line.
fn added(text: &str, table: &DeTable, name: &str, value: f64) -> Option<String> {
    let last = table.values().map(|value| value.span().end).max()?;
    let end = text[last..]
        .find('\n')
        .map_or(text.len(), |line| last + line);
    let mut longer = text.to_string();
    longer.insert_str(end, &format!("\n{name} = {value:?}"));
    let span = {
        let document = DeTable::parse(&longer).ok()?;
        let tables = document.get_ref().values();
        let mut tables = tables.filter_map(|value| value.get_ref().as_table());
        tables.find_map(|table| table.get(name).map(toml::Spanned::span))
    };
    (span?.start > end).then_some(longer)
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
    fn a_number_that_was_left_out_is_written_below_its_table() {
        const LEG: &str = "[leg] # legs\nground = 50.0 # lg10\n# hip_side = 35.0\n\n[servo]\n";
        let changed = with_number(LEG, "leg.hip_side", 36.0).expect("it may be set");
        let expected = LEG.replace("# lg10\n", "# lg10\nhip_side = 36.0\n");
        assert_eq!(changed, expected);
        let again = with_number(&changed, "leg.hip_side", 37.5).expect("there");
        assert_eq!(again, expected.replace("36.0", "37.5"));
        for text in [
            "leg = { ground = 50.0 }\n",
            "leg.ground = 50.0\n",
            "[leg]\n",
        ] {
            assert!(with_number(text, "leg.hip_side", 36.0).is_err(), "{text}");
        }
    }

    #[test]
    fn what_is_no_number_is_left_alone() {
        for key in ["links.l2", "links.name", "wings.l0", "links", "servo.A1"] {
            assert!(with_number(TEXT, key, 1.0).is_err(), "{key}");
        }
        assert!(with_number("[links", "links.l0", 1.0).is_err());
    }
}
