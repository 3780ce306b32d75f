//! robot.toml as typed values. A `Section` is one table of the file; it refuses unknown
//! keys, and every error names the whole key.

use std::collections::HashMap;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::file::error::{Checked, Hint, Problem};

/// One table of the file.
pub(crate) struct Section<'a> {
    /// The table's whole key, `servo.A1`; empty for the file itself.
    pub key: String,
    table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    /// The file's own table, of which only the keys `allowed` may appear.
    pub fn root(table: &'a DeTable<'a>, allowed: &[&str]) -> Checked<Self> {
        Self {
            key: String::new(),
            table,
        }
        .only(allowed)
    }

    /// The table under `name`; it must exist and hold no key outside `allowed`.
    pub fn section(&self, name: &str, allowed: &[&str]) -> Checked<Self> {
        self.open(name)?.only(allowed)
    }

    /// The table under `name`, whatever its keys.
    pub fn open(&self, name: &str) -> Checked<Self> {
        let key = self.path(name);
        match self.table.get(name).map(Spanned::get_ref) {
            Some(DeValue::Table(table)) => Ok(Self { key, table }),
            Some(other) => Err(wrong(other, "a table").at(key)),
            None => Err(Problem::Missing("a table").at(key)),
        }
    }

    /// Refuses keys outside `allowed`.
    pub fn only(self, allowed: &[&str]) -> Checked<Self> {
        match self
            .names()
            .into_iter()
            .find(|name| !allowed.contains(name))
        {
            Some(name) => Err(Problem::Unknown(Hint::new(name, allowed)).at(self.path(name))),
            None => Ok(self),
        }
    }

    /// Refuses keys that have moved, and says where to.
    pub fn moved(&self, names: &[&str], to: &'static str) -> Checked<()> {
        match names.iter().find(|name| self.has(name)) {
            Some(name) => Err(Problem::Moved(to).at(self.path(name))),
            None => Ok(()),
        }
    }

    /// The keys in the order of the file.
    pub fn names(&self) -> Vec<&'a str> {
        let mut keys: Vec<_> = self.table.keys().collect();
        keys.sort_by_key(|key| key.span().start);
        keys.into_iter().map(|key| key.get_ref().as_ref()).collect()
    }

    /// Whether the key is there.
    pub fn has(&self, name: &str) -> bool {
        self.table.contains_key(name)
    }

    /// The whole key of `name` in this table.
    pub fn path(&self, name: &str) -> String {
        if self.key.is_empty() {
            name.to_string()
        } else {
            format!("{}.{name}", self.key)
        }
    }

    /// A number within `min` to `max` (both allowed).
    pub fn number(&self, name: &str, min: f64, max: f64, unit: &'static str) -> Checked<f64> {
        let value = self.value(name, "a number")?;
        let value = number(value).ok_or_else(|| wrong(value, "a number").at(self.path(name)))?;
        if (min..=max).contains(&value) {
            Ok(value)
        } else {
            Err(Problem::Range {
                value,
                min,
                max,
                unit,
            }
            .at(self.path(name)))
        }
    }

    /// Like `number`, with a value for a key that is not there.
    pub fn number_or(
        &self,
        name: &str,
        default: f64,
        min: f64,
        max: f64,
        unit: &'static str,
    ) -> Checked<f64> {
        if self.has(name) {
            self.number(name, min, max, unit)
        } else {
            Ok(default)
        }
    }

    /// Refuses a number that is not less than another of this table.
    pub fn less(
        &self,
        name: &str,
        value: f64,
        other: &'static str,
        other_value: f64,
    ) -> Checked<()> {
        if value < other_value {
            return Ok(());
        }
        Err(Problem::NotLess {
            value,
            other,
            other_value,
        }
        .at(self.path(name)))
    }

    /// A string.
    pub fn text(&self, name: &str) -> Checked<&'a str> {
        let value = self.value(name, "a string")?;
        value
            .as_str()
            .ok_or_else(|| wrong(value, "a string").at(self.path(name)))
    }

    /// An array of exactly two numbers within `min` to `max`.
    pub fn pair(&self, name: &str, min: f64, max: f64, unit: &'static str) -> Checked<[f64; 2]> {
        self.numbers(name, min, max, unit)
    }

    /// An array of exactly this many numbers within `min` to `max`.
    pub fn numbers<const N: usize>(
        &self,
        name: &str,
        min: f64,
        max: f64,
        unit: &'static str,
    ) -> Checked<[f64; N]> {
        let expected = match N {
            2 => "an array of two numbers",
            _ => "an array of three numbers",
        };
        let value = self.value(name, expected)?;
        let DeValue::Array(array) = value else {
            return Err(wrong(value, expected).at(self.path(name)));
        };
        let numbers: Option<Vec<f64>> = array.iter().map(|item| number(item.get_ref())).collect();
        let Some(Ok(numbers)) = numbers.map(<[f64; N]>::try_from) else {
            return Err(Problem::Type {
                found: format!("an array of {}", array.len()),
                expected,
            }
            .at(self.path(name)));
        };
        for value in numbers {
            if !(min..=max).contains(&value) {
                return Err(Problem::Range {
                    value,
                    min,
                    max,
                    unit,
                }
                .at(self.path(name)));
            }
        }
        Ok(numbers)
    }

    /// An array of strings.
    pub fn words(&self, name: &str) -> Checked<Vec<&'a str>> {
        const EXPECTED: &str = "an array of strings";
        let value = self.value(name, EXPECTED)?;
        let words = value
            .as_array()
            .and_then(|array| array.iter().map(|item| item.get_ref().as_str()).collect());
        words.ok_or_else(|| wrong(value, EXPECTED).at(self.path(name)))
    }

    /// An array of tables, each holding no key outside `allowed`; none when
    /// the key is not there.
    pub fn list(&self, name: &str, allowed: &[&str]) -> Checked<Vec<Section<'a>>> {
        const EXPECTED: &str = "an array of tables";
        if !self.has(name) {
            return Ok(Vec::new());
        }
        let value = self.value(name, EXPECTED)?;
        let items = value
            .as_array()
            .ok_or_else(|| wrong(value, EXPECTED).at(self.path(name)))?;
        let section = |(i, item): (usize, &'a Spanned<DeValue<'a>>)| {
            let key = format!("{}[{i}]", self.path(name));
            match item.get_ref() {
                DeValue::Table(table) => Section { key, table }.only(allowed),
                other => Err(wrong(other, "a table").at(key)),
            }
        };
        items.iter().enumerate().map(section).collect()
    }

    fn value(&self, name: &str, expected: &'static str) -> Checked<&'a DeValue<'a>> {
        self.table
            .get(name)
            .map(Spanned::get_ref)
            .ok_or_else(|| Problem::Missing(expected).at(self.path(name)))
    }
}

/// The line, from 1, of a key or of the nearest table that holds it.
pub(crate) fn line(text: &str, table: &DeTable, key: &str) -> Option<usize> {
    let within = |whole: &String| {
        key == *whole
            || key.starts_with(&format!("{whole}."))
            || key.starts_with(&format!("{whole}["))
    };
    lines(text, table)
        .into_iter()
        .filter(|(whole, _)| within(whole))
        .max_by_key(|(whole, _)| whole.len())
        .map(|(_, line)| line)
}

/// Where each key of the file stands, by its whole key.
fn lines(text: &str, table: &DeTable) -> HashMap<String, usize> {
    fn walk(text: &str, prefix: &str, table: &DeTable, lines: &mut HashMap<String, usize>) {
        for (key, value) in table {
            let whole = if prefix.is_empty() {
                key.get_ref().to_string()
            } else {
                format!("{prefix}.{}", key.get_ref())
            };
            let line = text[..key.span().start].matches('\n').count() + 1;
            lines.insert(whole.clone(), line);
            if let DeValue::Table(inner) = value.get_ref() {
                walk(text, &whole, inner, lines);
            }
        }
    }
    let mut lines = HashMap::new();
    walk(text, "", table, &mut lines);
    lines
}

/// Integers count as numbers; TOML's nan and inf do not.
fn number(value: &DeValue) -> Option<f64> {
    let text = match value {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
        DeValue::Float(float) => float.as_str(),
        _ => return None,
    };
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

fn wrong(value: &DeValue, expected: &'static str) -> Problem {
    let found = match value {
        DeValue::String(text) => format!("the string \"{text}\""),
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::Boolean(value) => format!("{value}"),
        DeValue::Datetime(_) => "a date".to_string(),
        DeValue::Array(_) => "an array".to_string(),
        DeValue::Table(_) => "a table".to_string(),
    };
    Problem::Type { found, expected }
}
