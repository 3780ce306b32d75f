//! Explains the likely mistake in a line that is not valid TOML.
//!
//! A parser's message names the expected token in terms of the grammar. The author needs to read the mistake itself: a
//! missing value, a decimal comma, or a unit after a number. This module therefore checks the line for such mistakes.
//! If there are none, the parser's message is kept.

/// Explains a mistake at byte `offset` of a text; `message` is the parser's own message.
pub fn explain_mistake(text: &str, offset: usize, message: &str) -> String {
    let line_index = text
        .get(..offset)
        .map_or(0, |text| text.matches('\n').count());
    let lines: Vec<&str> = text.lines().map(strip_comment).collect();
    let line = lines.get(line_index).copied().unwrap_or_default();
    let duplicate_message =
        (message == "duplicate key").then(|| explain_duplicate(&lines, line_index));
    duplicate_message
        .flatten()
        .or_else(|| explain_mistake_in_line(line))
        .unwrap_or_else(|| format!("invalid TOML: {message}"))
}

/// Removes a line's comment, and the whitespace at both ends.
fn strip_comment(line: &str) -> &str {
    let mut open_quote = None;
    let mut is_escaped = false;
    for (index, c) in line.char_indices() {
        match (open_quote, c) {
            _ if is_escaped => is_escaped = false,
            (Some('"'), '\\') => is_escaped = true,
            (Some(mark), c) if c == mark => open_quote = None,
            (None, '"' | '\'') => open_quote = Some(c),
            (None, '#') => return line[..index].trim(),
            _ => {}
        }
    }
    line.trim()
}

/// Returns the name of a table if this line is its header; `None` for any other line.
fn table_header_name(line: &str) -> Option<&str> {
    line.strip_prefix('[')?.strip_suffix(']').map(str::trim)
}

/// Explains a repeated table or key on line `line_index`, counted from 0; `None` if the first occurrence is not found.
fn explain_duplicate(lines: &[&str], line_index: usize) -> Option<String> {
    let lines_before = lines.get(..line_index)?;
    let line = lines.get(line_index)?;
    if let Some(table) = table_header_name(line) {
        let first_line = lines_before
            .iter()
            .position(|line| table_header_name(line) == Some(table))?
            + 1;
        return Some(format!(
            "the table [{table}] is defined twice, first on line {first_line}; put all its keys into one table"
        ));
    }
    let key = line.split_once('=')?.0.trim();
    let table_start = lines_before
        .iter()
        .rposition(|line| table_header_name(line).is_some())
        .map_or(0, |index| index + 1);
    let defines_key = |line: &&str| {
        line.split_once('=')
            .is_some_and(|(name, _)| name.trim() == key)
    };
    let first_line = table_start + lines_before[table_start..].iter().position(defines_key)? + 1;
    Some(format!(
        "`{key}` is defined twice, first on line {first_line}; keep one definition"
    ))
}

/// Explains a mistake within one line; `None` if no known mistake is found.
fn explain_mistake_in_line(line: &str) -> Option<String> {
    if line.starts_with('[') && !line.contains('=') && !line.ends_with(']') {
        return Some(format!("`{line}` is missing the ] after the table name"));
    }
    let Some((key, value)) = line.split_once('=') else {
        let key = line.split_whitespace().next()?;
        let is_key = key
            .chars()
            .all(|c| c.is_alphanumeric() || "_-.".contains(c));
        return is_key.then(|| format!("`{line}` is missing the = between `{key}` and its value"));
    };
    let (key, value) = (key.trim(), value.trim());
    if value.is_empty() {
        return Some(format!("`{key}` has no value after the ="));
    }
    explain_malformed_number(value).or_else(|| explain_unquoted_string(value))
}

/// Explains a number in a form that TOML does not allow; `None` for anything else.
fn explain_malformed_number(value: &str) -> Option<String> {
    let is_number =
        |text: &str| text.parse::<f64>().is_ok() && !text.starts_with(char::is_alphabetic);
    let is_digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    if let Some((integer, fraction)) = value.split_once(',')
        && is_digits(integer.trim_start_matches(['-', '+']))
        && is_digits(fraction)
    {
        return Some(format!(
            "`{value}` is not a number; use a point as the decimal separator: {integer}.{fraction}"
        ));
    }
    let unsigned_value = value.trim_start_matches(['-', '+']);
    if let Some(fraction) = unsigned_value.strip_prefix('.')
        && is_digits(fraction)
    {
        let sign = if value.starts_with('-') { "-" } else { "" };
        return Some(format!(
            "`{value}` is not a number in TOML; write {sign}0.{fraction}"
        ));
    }
    if let Some(integer) = unsigned_value.strip_suffix('.')
        && is_digits(integer)
    {
        return Some(format!("`{value}` is not a number in TOML; write {value}0"));
    }
    let split_index = value.find(|c: char| c.is_alphabetic() || c.is_whitespace() || c == '%')?;
    let (amount, unit) = (value[..split_index].trim(), value[split_index..].trim());
    let is_unit = unit.starts_with(|c: char| c.is_alphabetic() || c == '%');
    (is_number(amount) && is_unit).then(|| {
        format!("`{value}`: a number takes no unit; write {amount}, and put `{unit}` in a comment")
    })
}

/// Explains a string without quotation marks; `None` for anything else.
fn explain_unquoted_string(value: &str) -> Option<String> {
    let may_be_in_word = |c: char| c.is_alphanumeric() || "_-. ".contains(c);
    let is_word = value.starts_with(char::is_alphabetic) && value.chars().all(may_be_in_word);
    let is_toml_keyword = ["true", "false", "inf", "nan"].contains(&value);
    (is_word && !is_toml_keyword)
        .then(|| format!("`{value}` is missing quotation marks; write \"{value}\""))
}

#[cfg(test)]
mod tests {
    use super::explain_mistake;
    use crate::testing::read_table;

    /// Explains the mistake in the last line of a text.
    fn explain_last_line(text: &str) -> String {
        let offset = text.trim_end().rfind('\n').map_or(0, |end| end + 1);
        explain_mistake(text, offset, "expected newline")
    }

    #[test]
    fn each_mistake_is_reported_with_its_correction() {
        let mistakes = r#"
            l1 =  | `l1` has no value after the =
            l1 = # mm | `l1` has no value after the =
            l1 = 30,0 | `30,0` is not a number; use a point as the decimal separator: 30.0
            l1 = -0,5 # mm | `-0,5` is not a number; use a point as the decimal separator: -0.5
            l1 = .5 | `.5` is not a number in TOML; write 0.5
            l1 = -.5 | `-.5` is not a number in TOML; write -0.5
            l1 = 30. | `30.` is not a number in TOML; write 30.0
            l1 = 30 mm | `30 mm`: a number takes no unit; write 30, and put `mm` in a comment
            l1 = 30mm | `30mm`: a number takes no unit; write 30, and put `mm` in a comment
            l1 30 | `l1 30` is missing the = between `l1` and its value
            pin = D9 | `D9` is missing quotation marks; write "D9"
            [links | `[links` is missing the ] after the table name
        "#;
        for [line, expected] in read_table(mistakes) {
            assert_eq!(explain_last_line(line), expected);
            let text = format!("[links]\nl0 = 20.0\n{line}\n");
            assert_eq!(explain_last_line(&text), expected);
        }
    }

    #[test]
    fn a_duplicate_is_reported_with_the_line_of_its_first_occurrence() {
        for (text, duplicate, expected) in [
            (
                "[a]\nx = 1\n[b]\nx = 2 # once\ny = 3\nx = 4\n",
                "x = 4",
                "`x` is defined twice, first on line 4; keep one definition",
            ),
            (
                "[servo.A1]\npin = \"D9\"\n[servo.A2]\n[servo.A1] # again\n",
                "[servo.A1]",
                "the table [servo.A1] is defined twice, first on line 1; put all its keys into one table",
            ),
        ] {
            let offset = text.rfind(duplicate).expect(duplicate);
            assert_eq!(explain_mistake(text, offset, "duplicate key"), expected);
        }
    }

    #[test]
    fn any_other_mistake_keeps_the_parsers_message() {
        for line in ["l1 = \"a", "l1 = [1, 2", "l1 = 1 2", "= 3", "l1 = 'it''s'"] {
            let explanation = explain_last_line(line);
            assert_eq!(explanation, "invalid TOML: expected newline", "{line}");
        }
        assert_eq!(explain_mistake("", 0, "x"), "invalid TOML: x");
        assert_eq!(explain_mistake("a = 1", 99, "x"), "invalid TOML: x");
    }
}
