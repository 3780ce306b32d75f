//! A number in the text of a robot.toml, changed in its place: comments, blanks and all
//! else stay as they are.

use toml::de::{DeTable, DeValue};

/// Where the hips are, ahead and aside: they follow from the legs until they are set.
pub const HIPS: [&str; 2] = ["leg.hip_forward", "leg.hip_side"];

/// What a robot.toml may leave out: it follows from other values until it is set, or is what
/// most robots have.
pub const LEFT_OUT: [&str; 12] = [
    HIPS[0],
    HIPS[1],
    "leg.drive.kind",
    "leg.drive.stiffness",
    "leg.drive.preload",
    "leg.drive.force",
    "leg.drive.rate",
    "leg.drive.play",
    "feet.stiffness",
    "feet.twist",
    "ground.friction",
    "body.mass",
];

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
/// `LEFT_OUT` that is not there is written below the last line of its table, and a table
/// that is not there below all.
///
/// # Errors
/// If the text is not TOML or has no number there.
pub fn with_number(text: &str, key: &str, value: f64) -> Result<String, NoSuchLength> {
    with_value(text, key, &format!("{value:?}"), |value| {
        matches!(value, DeValue::Float(_) | DeValue::Integer(_))
    })
}

/// The same with a word in place of a number.
///
/// # Errors
/// If the text is not TOML or has no string there.
pub fn with_word(text: &str, key: &str, word: &str) -> Result<String, NoSuchLength> {
    with_value(text, key, &format!("\"{word}\""), |value| {
        matches!(value, DeValue::String(_))
    })
}

fn with_value(
    text: &str,
    key: &str,
    value: &str,
    is_one: fn(&DeValue) -> bool,
) -> Result<String, NoSuchLength> {
    let missing = || NoSuchLength(key.to_string());
    let document = DeTable::parse(text).map_err(|_| missing())?;
    let (tables, name) = key.rsplit_once('.').ok_or_else(missing)?;
    let mut table = document.get_ref();
    for step in tables.split('.') {
        table = match table.get(step).map(|entry| entry.get_ref()) {
            Some(DeValue::Table(inner)) => inner,
            None if LEFT_OUT.contains(&key) => {
                let end = if text.ends_with('\n') { "" } else { "\n" };
                return Ok(format!("{text}{end}\n[{tables}]\n{name} = {value}\n"));
            }
            _ => return Err(missing()),
        };
    }
    let Some(place) = table.get(name) else {
        return match LEFT_OUT.contains(&key) {
            true => added(text, table, tables, name, value).ok_or_else(missing),
            false => Err(missing()),
        };
    };
    if !is_one(place.get_ref()) {
        return Err(missing());
    }
    let mut changed = text.to_string();
    changed.replace_range(place.span(), value);
    Ok(changed)
}

/// The text with a new line at the end of a table; none where that would not be in it, as
/// in a table that is written on one line.
fn added(text: &str, table: &DeTable, tables: &str, name: &str, value: &str) -> Option<String> {
    let last = table.values().map(|value| value.span().end).max()?;
    let end = line_end(text, last);
    let mut longer = text.to_string();
    longer.insert_str(end, &format!("\n{name} = {value}"));
    let there = place(&longer, tables, name)?;
    (there.start > end).then_some(longer)
}

/// The text without the line of a value that may be left out; as it is where that is not
/// there.
///
/// # Errors
/// If it is in a table that is written on one line.
pub fn without(text: &str, key: &str) -> Result<String, NoSuchLength> {
    let missing = || NoSuchLength(key.to_string());
    let (tables, name) = key.rsplit_once('.').ok_or_else(missing)?;
    let Some(there) = place(text, tables, name) else {
        return Ok(text.to_string());
    };
    let begin = text[..there.start].rfind('\n').map_or(0, |line| line + 1);
    let end = (line_end(text, there.end) + 1).min(text.len());
    if !text[begin..end].trim_start().starts_with(name) {
        return Err(missing());
    }
    Ok(text[..begin].to_string() + &text[end..])
}

/// Where the line ends that this place is in.
fn line_end(text: &str, from: usize) -> usize {
    text[from..]
        .find('\n')
        .map_or(text.len(), |line| from + line)
}

/// Where the value of a key is in the text.
fn place(text: &str, tables: &str, name: &str) -> Option<std::ops::Range<usize>> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    for step in tables.split('.') {
        table = table.get(step)?.get_ref().as_table()?;
    }
    table.get(name).map(toml::Spanned::span)
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
    fn a_table_that_was_left_out_is_written_below_all() {
        for text in ["[leg]\nground = 50.0\n", "[leg]\nground = 50.0"] {
            let changed = with_number(text, "body.mass", 250.0).expect("it may be set");
            assert_eq!(changed, "[leg]\nground = 50.0\n\n[body]\nmass = 250.0\n");
        }
    }

    #[test]
    fn a_number_is_taken_away_with_its_line() {
        const DRIVE: &str = "[leg.drive]\nkind = \"strut\"\nforce = 3.0 # N\nplay = 0.5\n";
        let rest = without(DRIVE, "leg.drive.force").expect("it may be left out");
        assert_eq!(rest, "[leg.drive]\nkind = \"strut\"\nplay = 0.5\n");
        assert_eq!(without(&rest, "leg.drive.force"), Ok(rest.clone()));
        let one = "[leg]\ndrive = { kind = \"strut\", force = 3.0 }\n";
        assert!(without(one, "leg.drive.force").is_err());
    }

    #[test]
    fn a_word_takes_the_place_of_another() {
        const DRIVE: &str = "[leg.drive] # bars\nkind = \"rigid\" # or not\n";
        let changed = with_word(DRIVE, "leg.drive.kind", "strut").expect("there");
        assert_eq!(changed, DRIVE.replace("rigid", "strut"));
        let added = with_word("[leg]\nmount = 0.0\n", "leg.drive.kind", "strut").expect("new");
        assert_eq!(
            added,
            "[leg]\nmount = 0.0\n\n[leg.drive]\nkind = \"strut\"\n"
        );
        assert!(with_word("[leg]\nmount = 0.0\n", "leg.mount", "x").is_err());
    }

    #[test]
    fn what_is_no_number_is_left_alone() {
        for key in ["links.l2", "links.name", "wings.l0", "links", "servo.A1"] {
            assert!(with_number(TEXT, key, 1.0).is_err(), "{key}");
        }
        assert!(with_number("[links", "links.l0", 1.0).is_err());
    }
}
