//! Tests that the reference for all keys, docs/robot-toml.md, agrees with the reader, the code that reads robot.toml.
//!
//! keys.txt contains the meaning of each key. Each key's range, unit and default are recorded while the reader reads a
//! robot with every table. With the environment variable `BLESS_KEYS`, a test writes the page instead of comparing it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use crate::config::RobotConfig;
use crate::file::{self, Error, KEY_USES, KeyUse, Range, Table, format_number};
use crate::gaits::{define, routine};
use crate::robot::TOP_LEVEL_KEYS;

/// Path of the reference page.
const PAGE_PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/robot-toml.md");
/// The line of the page after which the reference starts.
const REFERENCE_MARKER: &str = "<!-- keys of robot.toml -->\n";

/// Returns the text of a robot with every table, and with each key whose default the reader does not record.
fn robot_text_with_every_table() -> String {
    let extra_tables = "
        [leg.drive]\nkind = \"strut\"
        [joints]
        [supply]
        [supply.rail]\npin = \"A3\"\nratio = 2.0
        [feet]
        [parts]\npivot = [28.5, 10.0]\nfoot = [-3.5, 2.5]\nanchor = [22.0, 0.0]
        battery = [31.0, 56.0, 16.0]
        [parts.servo]
        [parts.horn]
        [parts.screw]
        [parts.pad]
        [parts.spring]
        [input.button]\npin = \"A1\"
        [input.nose]\npin = \"A2\"
        [routine.patrol]\nsteps = [\"walk 1\"]
        ";
    let text = crate::testing::robot_text("paper")
        .replace("mass = 435.0", "mass = 435.0\ncentre = [0.0, 0.0]")
        .replace("mount = ", "hip_forward = 55.0\nhip_side = 35.0\nmount = ")
        .replace("[servo.A1]", "[servo]\nmodel = \"SG-90\"\n[servo.A1]");
    text + &extra_tables
        .lines()
        .map(|line| format!("{}\n", line.trim()))
        .collect::<String>()
}

/// Converts a key to its name in keys.txt, in which the names that an author chooses, the four servos, the four legs,
/// both ends, and the harmonics of both coordinates share one entry each.
fn to_generic_name(key: &str) -> String {
    let names: Vec<&str> = key.split('.').collect();
    let parts = names.iter().enumerate().map(|(index, name)| {
        let name = name.split('[').next().unwrap_or(name);
        match (index, name) {
            (1, _) if ["gait", "routine"].contains(&names[0]) => "NAME",
            (_, "A2" | "A3" | "A4") => "A1",
            (3, "LF" | "RF" | "RH" | "LH") => "LF RF RH LH",
            (2, "tail") => "head",
            (3, "y") if names.len() > 4 => "x",
            (_, name) => name,
        }
    });
    parts.collect::<Vec<_>>().join(".")
}

/// The cells of the reference that the reader records for a key: values and default.
#[derive(Default)]
struct RecordedCells {
    values: Option<String>,
    default: Option<String>,
}

/// Formats the allowed values of a number.
fn format_range((min, max): Range, unit: &str) -> String {
    format!("{} to {}, {unit}", format_number(min), format_number(max))
}

/// Records all keys that the reader accepts, except keys whose values are tables.
fn record_keys() -> BTreeMap<String, RecordedCells> {
    KEY_USES.with_borrow_mut(Vec::clear);
    read_definitions(&robot_text_with_every_table()).expect("the robot with every table is valid");
    let key_uses = KEY_USES.with_borrow_mut(std::mem::take);
    let mut keys = BTreeMap::<String, RecordedCells>::new();
    for (key, key_use) in &key_uses {
        let recorded_cells = keys.entry(to_generic_name(key)).or_default();
        match key_use {
            KeyUse::Number {
                range,
                unit,
                default,
            } => {
                let unit = unit.trim_start_matches('(').trim_end_matches(')');
                recorded_cells.values = Some(format_range(*range, unit));
                let default = default.map(format_number);
                recorded_cells.default = default.or(recorded_cells.default.take());
            }
            KeyUse::Polar(distance_range, angle_range) => {
                let distance_values = format_range(*distance_range, "mm");
                let angle_values = format_range(*angle_range, "deg");
                recorded_cells.values = Some(format!("{distance_values}; {angle_values}"));
            }
            KeyUse::Allowed | KeyUse::Table => {}
        }
    }
    let is_table = |key_use: &&(String, KeyUse)| matches!(key_use.1, KeyUse::Table);
    for (table, _) in key_uses.iter().filter(is_table) {
        // A list of harmonics is recorded as a table, but is also a key of the reference.
        if !table.ends_with(".x") && !table.ends_with(".y") {
            keys.remove(&to_generic_name(table));
        }
    }
    keys
}

/// A line of keys.txt: the key's full name, and the cells for name, values, default and meaning.
struct KeyLine {
    key: String,
    cells: [&'static str; 4],
}

/// Reads the tables of keys.txt, each with its name, its meaning and its keys.
fn read_reference_tables() -> Vec<(&'static str, &'static str, Vec<KeyLine>)> {
    let mut tables: Vec<(_, _, Vec<KeyLine>)> = Vec::new();
    let lines = include_str!("keys.txt").lines();
    for line in lines.filter(|line| !line.is_empty() && !line.starts_with("# ")) {
        let header = line.strip_prefix('[');
        if let Some((name, meaning)) = header.and_then(|header| header.split_once("] ")) {
            tables.push((name, meaning, Vec::new()));
            continue;
        }
        let cells: Vec<&str> = line.split(" | ").collect();
        let cells: [&str; 4] = cells.try_into().expect(line);
        let (table, _, lines) = tables.last_mut().expect("a table comes first");
        let key = match table.is_empty() {
            true => cells[0].to_owned(),
            false => format!("{table}.{}", cells[0]),
        };
        lines.push(KeyLine { key, cells });
    }
    tables
}

#[test]
fn the_reference_lists_exactly_the_keys_that_are_read() {
    let read_keys: BTreeSet<String> = record_keys().into_keys().collect();
    let tables = read_reference_tables().into_iter();
    let listed_lines = tables.flat_map(|(.., lines)| lines);
    let listed_keys: BTreeSet<String> = listed_lines.map(|line| line.key).collect();
    let differences: Vec<&String> = read_keys.symmetric_difference(&listed_keys).collect();
    let message = "src/keys.txt must list exactly the keys that are read";
    assert!(differences.is_empty(), "{message}: {differences:?}");
    assert!(read_keys.len() > 120, "only {} keys", read_keys.len());
}

#[test]
fn the_reference_page_is_up_to_date() {
    let keys = record_keys();
    let mut text = String::new();
    for (table, meaning, lines) in read_reference_tables() {
        match table {
            "" => _ = write!(text, "## Top\n\n{meaning}\n\n"),
            _ => _ = write!(text, "## [{table}]\n\n{meaning}\n\n"),
        }
        text += "| key | values | default | meaning |\n|---|---|---|---|\n";
        for KeyLine { key, cells } in lines {
            let recorded_cells = &keys[&key];
            let [name, values, default, meaning] = cells;
            let cell_text = |cell: &str, recorded: &Option<String>| match (cell, recorded) {
                (".", Some(recorded)) => recorded.clone(),
                (".", None) => panic!("the reader does not record this cell: {key}"),
                (cell, _) => cell.to_owned(),
            };
            let values = cell_text(values, &recorded_cells.values);
            let default = cell_text(default, &recorded_cells.default);
            _ = writeln!(text, "| `{name}` | {values} | {default} | {meaning} |");
        }
        text.push('\n');
    }
    let page = std::fs::read_to_string(PAGE_PATH).expect(PAGE_PATH);
    let (text_before, _) = page.split_once(REFERENCE_MARKER).expect(REFERENCE_MARKER);
    let expected = format!("{text_before}{REFERENCE_MARKER}\n{}\n", text.trim_end());
    if std::env::var_os("BLESS_KEYS").is_some() {
        std::fs::write(PAGE_PATH, expected).expect(PAGE_PATH);
    } else {
        assert!(
            page == expected,
            "docs/robot-toml.md is out of date; run with BLESS_KEYS=1"
        );
    }
}

/// Reads configuration, gaits and routines, but does not compute their tables, which takes long.
fn read_definitions(text: &str) -> Result<(), Error> {
    file::parse(text, |table| {
        let root = Table::root(table, &TOP_LEVEL_KEYS)?;
        let config = RobotConfig::read(&root)?;
        let gaits = define::read_gaits(&root, &config)?;
        let names: Vec<&str> = gaits.iter().map(|gait| gait.name.as_str()).collect();
        routine::read_routines(&root, &names, &config.inputs).map(|_| ())
    })
}

#[test]
fn exactly_the_required_keys_of_the_reference_cannot_be_left_out() {
    let text = robot_text_with_every_table();
    let mut checked_key_count = 0;
    for (table, _, lines) in read_reference_tables() {
        let start = match table {
            "" => 0,
            _ => match text.find(&format!("\n[{}]", table.replace("NAME", "walk"))) {
                Some(start) => start + 1,
                // The table is written inline, as the value of a key.
                None => continue,
            },
        };
        for KeyLine { cells, .. } in lines {
            let table_text = text[start..].split("\n[").next().unwrap_or_default();
            let is_key = |line: &&str| line.split('=').next().unwrap_or("").trim() == cells[0];
            let Some(line) = table_text.lines().find(is_key) else {
                assert_ne!(cells[2], "required", "{table}.{}", cells[0]);
                continue;
            };
            let text_without_key =
                format!("{}{}", &text[..start], text[start..].replacen(line, "", 1));
            let error = read_definitions(&text_without_key).err();
            let is_required = error.is_some_and(|error| error.problem.contains("is missing"));
            let is_listed_as_required = cells[2].starts_with("required");
            assert_eq!(is_required, is_listed_as_required, "{table}.{}", cells[0]);
            checked_key_count += 1;
        }
    }
    assert!(checked_key_count > 50, "only {checked_key_count} keys");
}
