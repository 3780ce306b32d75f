//! Reads the gait definitions in robot.toml. Each contains a waveform, a path, or the name of a gait from which it is
//! derived.

use std::collections::HashMap;

use lizard_core::console::word::Word;
use lizard_core::memory::settings::gait_key;
use lizard_core::numbers::gaits::{MAX_GAITS, MAX_NAME_BYTES};
use lizard_kinematics::End;

use crate::config::RobotConfig;
use crate::config::servo::LEG_NAMES;
use crate::file::{Error, ReadResult, Table, read_for_each, suggest};
use crate::gaits::gait::{Gait, Stride};
use crate::gaits::path::{Harmonic, Path};
use crate::gaits::path_sweep::PathSweep;
use crate::gaits::waveform::Waveform;

/// The keys of a gait's table.
const GAIT_KEYS: [&str; 12] = [
    "period",
    "waveform",
    "duty",
    "amplitude",
    "start",
    "order",
    "gain",
    "reverse",
    "mirror",
    "like",
    "head",
    "tail",
];
/// Range of a cycle's duration, s.
const PERIOD_RANGE: (f64, f64) = (0.2, 60.0);
/// The values of the key `waveform`.
const WAVEFORM_NAMES: [&str; 3] = ["still", "wave", "held"];

/// Reads the gaits in the order of the file and resolves their references.
pub(crate) fn read_gaits(root: &Table, config: &RobotConfig) -> ReadResult<Vec<Gait>> {
    let table = root.unchecked_table("gait")?;
    let names = table.key_names();
    for name in &names {
        check_name(name, "gait").map_err(|problem| table.error(name, problem))?;
    }
    if names.len() > MAX_GAITS {
        let count = names.len();
        let message = format!("has {count} gaits; the firmware supports at most {MAX_GAITS}");
        return Err(Error::new("gait", message));
    }
    check_boot_keys(&table, &names)?;
    if names.first() != Some(&"stand") {
        let message =
            "the first gait must be stand, the neutral pose that the robot takes at power-on";
        return Err(Error::with_own_subject("gait", message));
    }
    let mut reader = GaitReader {
        table,
        names: &names,
        config,
        gaits: HashMap::new(),
    };
    let gaits = names.iter().map(|name| reader.read(name, &[]));
    let gaits = gaits.collect::<ReadResult<Vec<_>>>()?;
    let is_still = |stride: &Stride| stride.waveform == Waveform::Still;
    if gaits[0].strides.iter().all(is_still) {
        Ok(gaits)
    } else {
        let message = "must be the neutral pose that the robot takes at power-on: waveform = \"still\" and a period";
        Err(Error::new("gait.stand", message))
    }
}

/// Rejects gaits or routines that the EEPROM cannot distinguish: it stores the gait or routine of `boot` as a number
/// computed from the name.
pub(super) fn check_boot_keys(table: &Table, names: &[&str]) -> ReadResult<()> {
    let mut names_by_key = HashMap::new();
    for name in names {
        let to_console = |byte: u8| if byte == b'-' { b' ' } else { byte };
        let console_name = name.bytes().map(to_console);
        if let Some(other_name) = names_by_key.insert(gait_key(console_name), *name) {
            let message = format!(
                "cannot be used together with {other_name}: the EEPROM stores both names as the same number (for `boot`); rename one of them"
            );
            return Err(table.error(name, message));
        }
    }
    Ok(())
}

/// Rejects a name that the console cannot accept as a command or cannot print. `noun`, "gait" or "routine", is used in
/// the message.
pub(super) fn check_name(name: &str, noun: &str) -> Result<(), String> {
    let is_allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    let reject = |reason: String| Err(format!("is not a {noun} name: {reason}"));
    if !name.chars().all(is_allowed) || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
        let reason =
            "it must consist of lower-case letters, digits and hyphens, and begin with a letter";
        return reject(reason.to_string());
    }
    if name.len() > MAX_NAME_BYTES {
        let length = name.len();
        return reject(format!(
            "it has {length} characters; at most {MAX_NAME_BYTES} are allowed, so that the answer to `status` fits into a line"
        ));
    }
    if name.ends_with('-') || name.contains("--") {
        return reject("a hyphen must stand between two words".to_string());
    }
    let word = name.split('-').next().unwrap_or(name);
    if Word::find(word.as_bytes()).is_some_and(Word::is_reserved) {
        return reject(format!("\"{word}\" is a console command"));
    }
    Ok(())
}

/// Reads gaits by name, each together with the gait to which it refers.
struct GaitReader<'a> {
    /// The table `gait`.
    table: Table<'a>,
    /// The names of all gaits, in the order of the file.
    names: &'a [&'a str],
    config: &'a RobotConfig,
    /// The gaits that have been read, by name.
    gaits: HashMap<String, Gait>,
}

impl GaitReader<'_> {
    /// Reads the gait with this name, or returns it if it has been read before; `referrers` are the gaits that are
    /// being read, each of which refers to the next.
    fn read(&mut self, name: &str, referrers: &[&str]) -> ReadResult<Gait> {
        if let Some(gait) = self.gaits.get(name) {
            return Ok(gait.clone());
        }
        let gait = self.read_definition(name, referrers)?;
        self.gaits.insert(name.to_string(), gait.clone());
        Ok(gait)
    }

    /// Reads the definition of a gait that has not been read before.
    fn read_definition(&mut self, name: &str, referrers: &[&str]) -> ReadResult<Gait> {
        let table = self.table.table(name, &GAIT_KEYS)?;
        let strides = match definition_key(&table)? {
            "waveform" => read_waveform(&table)?,
            "head or tail" => read_path(name, &table, self.config)?,
            reference => return self.read_derived(name, &table, reference, referrers),
        };
        let gait = Gait {
            name: name.to_string(),
            period: table.number("period", PERIOD_RANGE, "s")?,
            is_reversed: false,
            strides,
            neutral: self.config.neutral_angles(),
        };
        Ok(gait.scaled(read_gains(&table)?))
    }

    /// Reads a gait that is derived from another gait.
    fn read_derived(
        &mut self,
        name: &str,
        table: &Table,
        reference: &'static str,
        referrers: &[&str],
    ) -> ReadResult<Gait> {
        reject_keys_outside(table, &[reference, "period", "gain"], reference)?;
        let base_name = table.text(reference)?;
        if !self.names.contains(&base_name) {
            let suggestion = suggest(base_name, self.names);
            let message =
                format!("names the gait \"{base_name}\", which does not exist; {suggestion}");
            return Err(table.error(reference, message));
        }
        let chain = [referrers, &[name]].concat();
        if chain.contains(&base_name) {
            let message = format!("circular reference: {} -> {base_name}", chain.join(" -> "));
            let key = table.full_key(reference);
            return Err(Error::with_own_subject(key, message));
        }
        let mut gait = self.read(base_name, &chain)?;
        match reference {
            "reverse" => gait.is_reversed = !gait.is_reversed,
            "mirror" => gait = gait.mirrored(),
            _ => {}
        }
        gait.name = name.to_string();
        gait.period = table.number_or("period", gait.period, PERIOD_RANGE, "s")?;
        Ok(gait.scaled(read_gains(table)?))
    }
}

/// Returns the only key that defines a gait; the keys `head` and `tail` of a path count as one.
fn definition_key(table: &Table) -> ReadResult<&'static str> {
    let is_present = |key: &&str| match *key {
        "head or tail" => table.has_key("head") || table.has_key("tail"),
        key => table.has_key(key),
    };
    let definitions = ["waveform", "head or tail", "reverse", "mirror", "like"].into_iter();
    let definitions: Vec<&'static str> = definitions.filter(is_present).collect();
    let [definition] = definitions[..] else {
        let message = "needs exactly one of waveform, a path (head, tail), reverse, mirror, like";
        return Err(Error::new(table.key.clone(), message));
    };
    Ok(definition)
}

/// Rejects keys outside `allowed`, which are meaningless together with `partner`.
fn reject_keys_outside(table: &Table, allowed: &[&str], partner: &str) -> ReadResult<()> {
    let mut names = table.key_names().into_iter();
    match names.find(|name| !allowed.contains(name)) {
        Some(name) => Err(table.error(name, format!("is not allowed with {partner}"))),
        None => Ok(()),
    }
}

/// Reads the strides of a gait that a waveform defines.
fn read_waveform(table: &Table) -> ReadResult<[Stride; 4]> {
    let waveform_name = table.text("waveform")?;
    let partner = format!("waveform = \"{waveform_name}\"");
    match waveform_name {
        "still" => {
            reject_keys_outside(table, &["waveform", "period"], &partner)?;
            Ok([Stride::STILL; 4])
        }
        "wave" => {
            let allowed = ["waveform", "period", "duty", "amplitude", "start", "gain"];
            reject_keys_outside(table, &allowed, &partner)?;
            let waveform = Waveform::Wave {
                duty: table.number("duty", (0.05, 0.95), "of the cycle")?,
            };
            let amplitude = read_amplitude(table)?;
            let starts = table.table("start", &LEG_NAMES)?;
            read_for_each(LEG_NAMES, |leg| {
                Ok(Stride {
                    waveform: waveform.clone(),
                    start: starts.number(leg, (0.0, 1.0), "of the cycle")?,
                    amplitude,
                })
            })
        }
        "held" => {
            let allowed = ["waveform", "period", "amplitude", "order", "gain"];
            reject_keys_outside(table, &allowed, &partner)?;
            let amplitude = read_amplitude(table)?;
            let to_stride = |swing_index| Stride {
                waveform: Waveform::Held { swing_index },
                start: 0.0,
                amplitude,
            };
            Ok(read_order(table)?.map(to_stride))
        }
        word => {
            let suggestion = suggest(word, &WAVEFORM_NAMES);
            Err(table.error("waveform", format!("is \"{word}\"; {suggestion}")))
        }
    }
}

/// Reads the strides of a gait that the paths of head and tail define.
fn read_path(name: &str, table: &Table, config: &RobotConfig) -> ReadResult<[Stride; 4]> {
    reject_keys_outside(table, &["period", "head", "tail", "gain"], "a path")?;
    let mut strides = [Stride::STILL; 4];
    for end in End::ALL {
        if !table.has_key(end.name()) {
            continue;
        }
        let end_table = table.table(end.name(), &["centre", "x", "y"])?;
        let path = Path {
            centre: end_table.numbers("centre", (-255.0, 255.0), "mm")?,
            x: read_harmonics(&end_table, "x")?,
            y: read_harmonics(&end_table, "y")?,
        };
        let sweeps = PathSweep::for_both_servos(config.lizard, config.neutral_angles(), end, &path)
            .map_err(|problem| {
                let consequence = format!("in \"{name}\" the {end} would not reach its path");
                Error::with_consequence(end_table.key.clone(), consequence, problem)
            })?;
        for (servo, sweep) in sweeps {
            strides[servo] = Stride {
                waveform: Waveform::Path(Box::new(sweep)),
                start: 0.0,
                amplitude: 1.0,
            };
        }
    }
    Ok(strides)
}

/// Reads the largest sweep, deg.
fn read_amplitude(table: &Table) -> ReadResult<f64> {
    table.number("amplitude", (0.0, 90.0), "deg")
}

/// Reads the legs' gains, in servo order; 1 for a leg without a gain.
fn read_gains(table: &Table) -> ReadResult<[f64; 4]> {
    let gains = table.optional_table("gain", &LEG_NAMES)?;
    read_for_each(LEG_NAMES, |leg| {
        gains.number_or(leg, 1.0, (-4.0, 4.0), "(a factor)")
    })
}

/// Reads the order of the swings. Returns each leg's position in this order, 0 to 3, in servo order.
fn read_order(table: &Table) -> ReadResult<[usize; 4]> {
    let legs = table.strings("order")?;
    let order_error = || table.error("order", "must list each of LF, RF, RH, LH exactly once");
    if legs.len() != LEG_NAMES.len() {
        return Err(order_error());
    }
    read_for_each(LEG_NAMES, |name| {
        let position = legs.iter().position(|leg| *leg == name);
        position.ok_or_else(order_error)
    })
}

/// Reads the harmonics of one coordinate of a path.
fn read_harmonics(table: &Table, name: &str) -> ReadResult<Vec<Harmonic>> {
    let harmonics = table.tables(name, &["k", "amplitude", "shift"])?;
    let read_harmonic = |harmonic: Table| {
        let order = harmonic.number("k", (1.0, 16.0), "periods in a cycle")?;
        if order.fract() != 0.0 {
            return Err(harmonic.error("k", format!("is {order}; it must be a whole number")));
        }
        Ok(Harmonic {
            order,
            amplitude: harmonic.number("amplitude", (-255.0, 255.0), "mm")?,
            phase_shift: harmonic.number_or("shift", 0.0, (-1.0, 1.0), "of its period")?,
        })
    };
    harmonics.into_iter().map(read_harmonic).collect()
}

#[cfg(test)]
mod tests;
