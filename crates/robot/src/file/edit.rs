//! Edits of single values in a robot.toml's text. Comments, whitespace and all other lines stay unchanged.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys of the hips' forward and sideways distances. If a key is missing, its distance is computed from the legs.
pub const HIP_KEYS: [&str; 2] = ["leg.hip_forward", "leg.hip_side"];

/// Optional keys of robot.toml that an edit adds to the text if they are missing.
const OPTIONAL_KEYS: [&str; 16] = [
    HIP_KEYS[0],
    HIP_KEYS[1],
    "leg.drive.kind",
    "leg.drive.force",
    "leg.drive.rate",
    "leg.drive.play",
    "feet.stiffness",
    "feet.twist",
    "ground.friction",
    "body.mass",
    "body.centre",
    "servo.s_per_60_deg",
    "servo.stall_kg_cm",
    "servo.volts",
    "servo.dead_band_us",
    "servo.spin_up_ms",
];

/// The error for a key that is missing or cannot be changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyError(
    /// The full name of the key.
    pub String,
);

impl std::fmt::Display for KeyError {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(
            f,
            "robot.toml has no value {} that can be changed; edit the file by hand",
            self.0
        )
    }
}

/// Sets the number of a key, such as `links.l1`. A missing optional key is added after the last line of its table.
/// If the table is missing, too, it is added at the end of the text.
///
/// # Errors
/// Fails if the text is not TOML, has no number at this key, or writes the table of a missing key on one line.
pub fn with_number(text: &str, key: &str, value: f64) -> Result<String, KeyError> {
    with_value(text, key, &format!("{value:?}"), |value| {
        matches!(value, DeValue::Float(_) | DeValue::Integer(_))
    })
}

/// Sets the list of numbers of a key, as [`with_number`] sets a number.
///
/// # Errors
/// Fails if the text is not TOML, has no list at this key, or writes the table of a missing key on one line.
pub fn with_numbers(text: &str, key: &str, values: &[f64]) -> Result<String, KeyError> {
    with_value(text, key, &format!("{values:?}"), |value| {
        matches!(value, DeValue::Array(_))
    })
}

/// Adds the comment `# word rest` at the end of a key's line, or replaces a comment there that begins with `word`.
///
/// # Errors
/// Fails if the text is not TOML, or if the key is missing.
pub fn with_comment(text: &str, key: &str, word: &str, rest: &str) -> Result<String, KeyError> {
    let span = find_span(text, key)?.ok_or_else(|| KeyError(key.to_string()))?;
    let start = span.end;
    let line = &text[start..find_line_end(text, start)];
    let comment = format!(" # {word} ");
    let kept_line = line.find(&comment).map_or(line, |index| &line[..index]);
    let end = start + kept_line.trim_end().len();
    let trailing_space = &line[line.trim_end().len()..];
    let text_after = &text[start + line.len()..];
    Ok(format!(
        "{}{comment}{rest}{trailing_space}{text_after}",
        &text[..end]
    ))
}

/// Sets the string of a key, as [`with_number`] sets a number.
///
/// # Errors
/// Fails if the text is not TOML, has no string at this key, or writes the table of a missing key on one line.
pub fn with_string(text: &str, key: &str, string: &str) -> Result<String, KeyError> {
    with_value(text, key, &format!("\"{string}\""), |value| {
        matches!(value, DeValue::String(_))
    })
}

/// Sets the value of a key; `value` is TOML. Fails if `has_type` is false for the old value.
fn with_value(
    text: &str,
    key: &str,
    value: &str,
    has_type: fn(&DeValue) -> bool,
) -> Result<String, KeyError> {
    let key_error = || KeyError(key.to_string());
    let document = DeTable::parse(text).map_err(|_| key_error())?;
    let (table, name) = key.rsplit_once('.').ok_or_else(key_error)?;
    if let Some(old_value) = find_value(document.get_ref(), key) {
        if !has_type(old_value.get_ref()) {
            return Err(key_error());
        }
        let mut new_text = text.to_string();
        new_text.replace_range(old_value.span(), value);
        return Ok(new_text);
    }
    if !OPTIONAL_KEYS.contains(&key) {
        return Err(key_error());
    }
    let line = format!("{name} = {value}");
    let entries = match find_value(document.get_ref(), table) {
        Some(entries) => entries.get_ref().as_table().ok_or_else(key_error)?,
        None => &DeTable::new(),
    };
    // A subtable such as [servo.A1] has its lines elsewhere.
    let direct_values = entries.values().filter(|value| !value.get_ref().is_table());
    let Some(last_end) = direct_values.map(|value| value.span().end).max() else {
        let new_text = append_table(text, &format!("[{table}]\n{line}\n"));
        let is_toml = DeTable::parse(&new_text).is_ok();
        return is_toml.then_some(new_text).ok_or_else(key_error);
    };
    let end = find_line_end(text, last_end);
    let mut new_text = text.to_string();
    new_text.insert_str(end, &format!("\n{line}"));
    // If the table is written on one line, the new line would belong to another table.
    match find_span(&new_text, key)? {
        Some(span) if span.start > end => Ok(new_text),
        _ => Err(key_error()),
    }
}

/// Removes the line of an optional key. If the key is missing, the text stays unchanged.
///
/// # Errors
/// Fails if the text is not TOML, or if the key is in a table that is written on one line.
pub fn without_key(text: &str, key: &str) -> Result<String, KeyError> {
    let key_error = || KeyError(key.to_string());
    let (_, name) = key.rsplit_once('.').ok_or_else(key_error)?;
    let Some(span) = find_span(text, key)? else {
        return Ok(text.to_string());
    };
    let line_break = text[..span.start].rfind('\n');
    let start = line_break.map_or(0, |line_break| line_break + 1);
    let end = (find_line_end(text, span.end) + 1).min(text.len());
    if !text[start..end].trim_start().starts_with(name) {
        return Err(key_error());
    }
    Ok(text[..start].to_string() + &text[end..])
}

/// Adds the table of a gait: in place of an existing gait with this name, otherwise at the end of the text.
pub fn with_gait(text: &str, name: &str, table: &str) -> String {
    match replace_gait(text, name, table) {
        (new_text, true) => new_text,
        (text, false) => append_table(&text, table),
    }
}

/// Removes the tables of a gait. If the gait is missing, the text stays unchanged.
pub fn without_gait(text: &str, name: &str) -> String {
    replace_gait(text, name, "").0
}

/// Replaces the tables of a gait with `table`. Returns the new text, and true if the gait existed.
fn replace_gait(text: &str, name: &str, table: &str) -> (String, bool) {
    let key = to_key(name);
    let (header, subtable_start) = (format!("[gait.{key}]"), format!("[gait.{key}."));
    let (mut new_text, mut is_in_gait, mut is_replaced) = (String::new(), false, false);
    for line in text.split_inclusive('\n') {
        let trimmed_line = line.trim_start();
        if trimmed_line.starts_with('[') {
            is_in_gait =
                trimmed_line.starts_with(&header) || trimmed_line.starts_with(&subtable_start);
            if is_in_gait && !is_replaced {
                is_replaced = true;
                new_text += table;
            }
        }
        // A comment after the last key may belong to the next table.
        if !is_in_gait || trimmed_line.starts_with('#') {
            new_text += line;
        }
    }
    (new_text, is_replaced)
}

/// A routine as written in the file, valid or not.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct WrittenRoutine {
    /// Name of the routine.
    pub name: String,
    /// The texts of its steps.
    pub steps: Vec<String>,
}

/// Reads a text's routines in their order, without a check, so that a routine with a mistake can be shown and
/// corrected. Skips routines whose steps are not strings.
pub fn read_routines(text: &str) -> Vec<WrittenRoutine> {
    let Ok(document) = DeTable::parse(text) else {
        return Vec::new();
    };
    let table = document.get_ref().get("routine");
    let Some(table) = table.and_then(|table| table.get_ref().as_table()) else {
        return Vec::new();
    };
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(name, _)| name.span().start);
    let read_routine = |(name, routine): (&Spanned<_>, &Spanned<DeValue>)| {
        let steps = routine.get_ref().get("steps")?.get_ref().as_array()?;
        let steps = steps.iter().map(|step| step.get_ref().as_str());
        Some(WrittenRoutine {
            name: AsRef::<str>::as_ref(name.get_ref()).to_string(),
            steps: steps
                .map(|step| step.map(str::to_string))
                .collect::<Option<_>>()?,
        })
    };
    entries.into_iter().filter_map(read_routine).collect()
}

/// Sets the steps of a routine, which are added below its header if they are missing. A missing routine is added at the
/// end of the text. The routine's other lines, such as `repeat`, stay unchanged.
pub fn with_steps(text: &str, name: &str, steps: &[String]) -> String {
    let steps: Vec<_> = steps.iter().map(|step| format!("{step:?}")).collect();
    let steps = format!("[{}]", steps.join(", "));
    let mut new_text = text.to_string();
    if let Ok(Some(span)) = find_span(text, &format!("routine.{name}.steps")) {
        new_text.replace_range(span, &steps);
        return new_text;
    }
    let document = DeTable::parse(text);
    let root = document.as_ref().ok().map(Spanned::get_ref);
    // A table that is not inline begins with its header.
    if let Some(table) = root.and_then(|root| find_value(root, &format!("routine.{name}")))
        && table.get_ref().is_table()
        && text[table.span().start..].starts_with('[')
    {
        let end = find_line_end(text, table.span().start);
        new_text.insert_str(end, &format!("\nsteps = {steps}"));
        return new_text;
    }
    let key = to_key(name);
    append_table(text, &format!("[routine.{key}]\nsteps = {steps}\n"))
}

/// Formats a name as part of a key in TOML, with quotation marks if it needs them.
pub fn to_key(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '-';
    match name.is_empty() || !name.chars().all(is_bare) {
        true => format!("{name:?}"),
        false => name.to_string(),
    }
}

/// Adds a table at the end of a text, after an empty line.
fn append_table(text: &str, table: &str) -> String {
    let line_break = if text.ends_with('\n') { "" } else { "\n" };
    format!("{text}{line_break}\n{table}")
}

/// Finds the byte range of a key's value in a text; `None` if the key is missing. Fails if the text is not TOML.
fn find_span(text: &str, key: &str) -> Result<Option<Range<usize>>, KeyError> {
    let document = DeTable::parse(text).map_err(|_| KeyError(key.to_string()))?;
    Ok(find_value(document.get_ref(), key).map(Spanned::span))
}

/// Finds the value of a dotted key.
fn find_value<'a>(table: &'a DeTable<'a>, key: &str) -> Option<&'a Spanned<DeValue<'a>>> {
    match key.split_once('.') {
        Some((first, rest)) => find_value(table.get(first)?.get_ref().as_table()?, rest),
        None => table.get(key),
    }
}

/// Finds the byte offset at the end of the line that contains the offset `start`.
fn find_line_end(text: &str, start: usize) -> usize {
    text[start..]
        .find('\n')
        .map_or(text.len(), |length| start + length)
}

#[cfg(test)]
mod tests;
