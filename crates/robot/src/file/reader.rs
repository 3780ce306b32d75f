//! Reads robot.toml as typed values. A [`Table`] is one table of the file; it rejects unknown keys unless it is opened
//! as unchecked, and every error contains the full name of its key.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::file::error::{Error, ReadResult, suggest};
use crate::file::syntax::explain_mistake;

/// Parses the text of a robot file and reads it with `read`. Skips a byte order mark at the start.
///
/// # Errors
/// Returns the first error in the text, with its line.
pub(crate) fn parse<T>(text: &str, read: impl Fn(&DeTable) -> ReadResult<T>) -> Result<T, Error> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let line_at = |offset: usize| text[..offset].matches('\n').count() + 1;
    let document = DeTable::parse(text).map_err(|error| {
        let offset = error.span().map(|span| span.start);
        let message = explain_mistake(text, offset.unwrap_or(text.len()), error.message());
        Error {
            line: offset.map(line_at),
            ..Error::new("", message)
        }
    })?;
    let table = document.get_ref();
    read(table).map_err(|error| Error {
        line: find_key_offset(table, &error.key).map(line_at),
        ..error
    })
}

/// The smallest and the largest value allowed.
pub(crate) type Range = (f64, f64);

/// Reads a value for each of four servos or legs, by name. Returns the first error.
pub(crate) fn read_for_each<T>(
    names: [&'static str; 4],
    read: impl FnMut(&'static str) -> ReadResult<T>,
) -> ReadResult<[T; 4]> {
    let [a, b, c, d] = names.map(read);
    Ok([a?, b?, c?, d?])
}

/// Finds the byte offset of a key. If the file does not have the key, finds the offset of the innermost table of its
/// path that exists; `None` if not even the outermost table exists.
fn find_key_offset(mut table: &DeTable, key: &str) -> Option<usize> {
    let mut rest = key;
    let mut innermost_start = None;
    loop {
        // A quoted key may contain a dot, so the longest matching key is the right one.
        let suffix_after = |name: &str| {
            let suffix = rest.strip_prefix(name)?;
            (suffix.is_empty() || suffix.starts_with(['.', '['])).then_some(suffix)
        };
        let entries = table.iter().filter_map(|(present, value)| {
            let name = present.get_ref().as_ref();
            Some((name.len(), present.span().start, suffix_after(name)?, value))
        });
        let Some((_, start, suffix, value)) = entries.max_by_key(|(length, ..)| *length) else {
            return innermost_start;
        };
        innermost_start = Some(start);
        match value.get_ref() {
            DeValue::Table(inner) if suffix.starts_with('.') => {
                (table, rest) = (inner, &suffix[1..])
            }
            _ => return innermost_start,
        }
    }
}

/// The use of a key by a call, recorded for the test of the page that lists all keys.
#[cfg(test)]
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum KeyUse {
    /// The table may have this key.
    Allowed,
    /// The key is a table, or an array of tables.
    Table,
    /// The key is a number or an array of numbers, with a range, a unit, and a default if it is optional.
    Number {
        range: Range,
        unit: String,
        default: Option<f64>,
    },
    /// The key is a position in polar coordinates, with the ranges of the distance (mm) and of the angle (deg).
    Polar(Range, Range),
}

#[cfg(test)]
thread_local! {
    /// The uses of keys in this thread, in order, each with the full name of its key.
    pub(crate) static KEY_USES: std::cell::RefCell<Vec<(String, KeyUse)>> = const { std::cell::RefCell::new(Vec::new()) };
}

/// One table of the file.
pub(crate) struct Table<'a> {
    /// Full name of the table, such as `servo.A1`; empty for the file itself.
    pub key: String,
    /// The contents of the table; `None` if an optional table is missing.
    contents: Option<&'a DeTable<'a>>,
}

impl<'a> Table<'a> {
    /// Opens the file's root table, which may have only the keys `allowed`.
    pub fn root(table: &'a DeTable<'a>, allowed: &[&str]) -> ReadResult<Self> {
        Self {
            key: String::new(),
            contents: Some(table),
        }
        .require_known_keys(allowed)
    }

    /// Opens the table `name`, which must exist and may have only the keys `allowed`.
    pub fn table(&self, name: &str, allowed: &[&str]) -> ReadResult<Self> {
        self.unchecked_table(name)?.require_known_keys(allowed)
    }

    /// Opens the table `name`, which may have any keys.
    pub fn unchecked_table(&self, name: &str) -> ReadResult<Self> {
        #[cfg(test)]
        self.record_use(name, KeyUse::Table);
        Ok(Self {
            key: self.full_key(name),
            contents: Some(self.read_value(name, "a table", DeValue::as_table)?),
        })
    }

    /// Opens the table `name`, which may have any keys. A missing table counts as an empty table.
    pub fn optional_unchecked_table(&self, name: &str) -> ReadResult<Self> {
        if self.has_key(name) {
            return self.unchecked_table(name);
        }
        Ok(Self {
            key: self.full_key(name),
            contents: None,
        })
    }

    /// Opens the table `name`, which may have only the keys `allowed`. A missing table counts as an empty table.
    pub fn optional_table(&self, name: &str, allowed: &[&str]) -> ReadResult<Self> {
        self.optional_unchecked_table(name)?
            .require_known_keys(allowed)
    }

    /// Returns the table if all its keys are in `allowed`, otherwise an error.
    pub fn require_known_keys(self, allowed: &[&str]) -> ReadResult<Self> {
        #[cfg(test)]
        for name in allowed {
            self.record_use(name, KeyUse::Allowed);
        }
        let is_unknown = |name: &&str| !allowed.contains(name);
        match self.key_names().into_iter().find(is_unknown) {
            Some(name) => {
                let suggestion = suggest(name, allowed);
                Err(self.error(name, format!("is not a known key; {suggestion}")))
            }
            None => Ok(self),
        }
    }

    /// Rejects the keys `names` of an earlier version of the format; `replacement` is what the user must write instead.
    pub fn reject_removed_keys(&self, names: &[&str], replacement: &str) -> ReadResult<()> {
        match names.iter().find(|name| self.has_key(name)) {
            Some(name) => {
                let message = format!("is no longer supported; write {replacement}");
                Err(self.error(name, message))
            }
            None => Ok(()),
        }
    }

    /// The table's keys in the order of the file.
    pub fn key_names(&self) -> Vec<&'a str> {
        let keys = self.contents.into_iter().flat_map(|table| table.keys());
        let mut keys: Vec<_> = keys.collect();
        keys.sort_by_key(|key| key.span().start);
        keys.into_iter().map(|key| key.get_ref().as_ref()).collect()
    }

    /// True if the table has this key.
    pub fn has_key(&self, name: &str) -> bool {
        self.contents.is_some_and(|table| table.contains_key(name))
    }

    /// The full name of a key in this table.
    pub fn full_key(&self, name: &str) -> String {
        if self.key.is_empty() {
            name.to_string()
        } else {
            format!("{}.{name}", self.key)
        }
    }

    /// Creates the error for a key in this table.
    pub fn error(&self, name: &str, problem: impl Into<String>) -> Error {
        Error::new(self.full_key(name), problem)
    }

    /// Reads a number in a range, both limits included.
    pub fn number(&self, name: &str, range: Range, unit: &str) -> ReadResult<f64> {
        #[cfg(test)]
        self.record_number_use(name, range, unit, None);
        let value = self.read_value(name, "a number", to_decimal_number)?;
        self.require_in_range(name, value, range, unit)
    }

    /// Reads a number; returns `default` if the key is missing.
    pub fn number_or(&self, name: &str, default: f64, range: Range, unit: &str) -> ReadResult<f64> {
        #[cfg(test)]
        self.record_number_use(name, range, unit, Some(default));
        match self.has_key(name) {
            true => self.number(name, range, unit),
            false => Ok(default),
        }
    }

    /// Rejects a key's `value` unless it is less than `limit`, the value of the key `limit_name` in the same table.
    pub fn require_less(
        &self,
        name: &str,
        value: f64,
        limit_name: &str,
        limit: f64,
    ) -> ReadResult<()> {
        if value < limit {
            return Ok(());
        }
        let message = format!("is {value}; it must be less than {limit_name}, which is {limit}");
        Err(self.error(name, message))
    }

    /// Reads a string.
    pub fn text(&self, name: &str) -> ReadResult<&'a str> {
        self.read_value(name, "a string", DeValue::as_str)
    }

    /// Reads a string; returns `default` if the key is missing.
    pub fn text_or(&self, name: &str, default: &'a str) -> ReadResult<&'a str> {
        match self.has_key(name) {
            true => self.text(name),
            false => Ok(default),
        }
    }

    /// Reads an array of exactly `N` numbers in a range.
    pub fn numbers<const N: usize>(
        &self,
        name: &str,
        range: Range,
        unit: &str,
    ) -> ReadResult<[f64; N]> {
        #[cfg(test)]
        self.record_number_use(name, range, unit, None);
        let numbers = self.read_array::<N>(name)?;
        for value in numbers {
            self.require_in_range(name, value, range, unit)?;
        }
        Ok(numbers)
    }

    /// Reads an array of numbers as [`Table::numbers`] does; returns `default` if the key is missing.
    pub fn numbers_or<const N: usize>(
        &self,
        name: &str,
        default: [f64; N],
        range: Range,
        unit: &str,
    ) -> ReadResult<[f64; N]> {
        match self.has_key(name) {
            true => self.numbers(name, range, unit),
            false => Ok(default),
        }
    }

    /// Reads a position in polar coordinates, an array of a distance (mm) and an angle (deg), each in its range;
    /// returns `default` if the key is missing.
    pub fn polar_or(
        &self,
        name: &str,
        default: [f64; 2],
        distance_range: Range,
        angle_range: Range,
    ) -> ReadResult<[f64; 2]> {
        #[cfg(test)]
        self.record_use(name, KeyUse::Polar(distance_range, angle_range));
        if !self.has_key(name) {
            return Ok(default);
        }
        let [distance, angle] = self.read_array(name)?;
        Ok([
            self.require_in_range(name, distance, distance_range, "mm")?,
            self.require_in_range(name, angle, angle_range, "deg")?,
        ])
    }

    /// Reads an array of strings.
    pub fn strings(&self, name: &str) -> ReadResult<Vec<&'a str>> {
        self.read_value(name, "an array of strings", |value| {
            let items = value.as_array()?.iter();
            items.map(|item| item.get_ref().as_str()).collect()
        })
    }

    /// Reads an array of tables that may have only the keys `allowed`. The array is empty if the key is missing.
    pub fn tables(&self, name: &str, allowed: &[&str]) -> ReadResult<Vec<Table<'a>>> {
        #[cfg(test)]
        self.record_use(name, KeyUse::Table);
        if !self.has_key(name) {
            return Ok(Vec::new());
        }
        let items = self.read_value(name, "an array of tables", DeValue::as_array)?;
        let read_table = |(i, item): (usize, &'a Spanned<DeValue<'a>>)| {
            let name = format!("{name}[{i}]");
            match item.get_ref() {
                DeValue::Table(table) => Table {
                    key: self.full_key(&name),
                    contents: Some(table),
                }
                .require_known_keys(allowed),
                value => Err(self.type_error(&name, value, "a table")),
            }
        };
        items.iter().enumerate().map(read_table).collect()
    }

    #[cfg(test)]
    fn record_use(&self, name: &str, key_use: KeyUse) {
        KEY_USES.with_borrow_mut(|uses| uses.push((self.full_key(name), key_use)));
    }

    #[cfg(test)]
    fn record_number_use(&self, name: &str, range: Range, unit: &str, default: Option<f64>) {
        let unit = unit.to_owned();
        let key_use = KeyUse::Number {
            range,
            unit,
            default,
        };
        self.record_use(name, key_use);
    }

    /// Reads a key's value with `convert`, which returns `None` for a value of the wrong type. A missing key is an
    /// error.
    fn read_value<T>(
        &self,
        name: &str,
        expected_type: &str,
        convert: impl FnOnce(&'a DeValue<'a>) -> Option<T>,
    ) -> ReadResult<T> {
        let Some(value) = self.contents.and_then(|table| table.get(name)) else {
            return Err(self.error(name, format!("is missing; it must be {expected_type}")));
        };
        let value = value.get_ref();
        convert(value).ok_or_else(|| self.type_error(name, value, expected_type))
    }

    /// Reads an array of exactly `N` numbers, without a check of their range.
    fn read_array<const N: usize>(&self, name: &str) -> ReadResult<[f64; N]> {
        let expected_type = match N {
            2 => "an array of two numbers",
            _ => "an array of three numbers",
        };
        let array = self.read_value(name, expected_type, DeValue::as_array)?;
        if array.len() != N {
            let message = format!("is an array of {}; it must be {expected_type}", array.len());
            return Err(self.error(name, message));
        }
        let mut numbers = [0.0; N];
        for (i, item) in array.iter().enumerate() {
            let value = item.get_ref();
            numbers[i] = to_decimal_number(value)
                .ok_or_else(|| self.type_error(&format!("{name}[{i}]"), value, "a number"))?;
        }
        Ok(numbers)
    }

    /// Returns a key's value if it is in a range, both limits included, otherwise an error.
    fn require_in_range(
        &self,
        name: &str,
        value: f64,
        range: Range,
        unit: &str,
    ) -> ReadResult<f64> {
        match (range.0..=range.1).contains(&value) {
            true => Ok(value),
            false => {
                let key = self.full_key(name);
                Err(Error::out_of_range(key, value, range, unit))
            }
        }
    }

    /// Creates the error for a value of the wrong type.
    fn type_error(&self, name: &str, value: &DeValue, expected_type: &str) -> Error {
        let found = match value {
            DeValue::String(text) => format!("the string \"{text}\""),
            DeValue::Integer(number) => number.to_string(),
            DeValue::Float(number) => number.to_string(),
            DeValue::Boolean(value) => format!("{value}"),
            DeValue::Datetime(_) => "a date".to_string(),
            DeValue::Array(_) => "an array".to_string(),
            DeValue::Table(_) => "a table".to_string(),
        };
        self.error(name, format!("is {found}; it must be {expected_type}"))
    }
}

/// Converts a decimal integer or a finite float; `None` for anything else, such as TOML's nan, inf or 0x1f.
fn to_decimal_number(value: &DeValue) -> Option<f64> {
    let text = match value {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
        DeValue::Float(float) => float.as_str(),
        _ => return None,
    };
    text.parse().ok().filter(|value: &f64| value.is_finite())
}
