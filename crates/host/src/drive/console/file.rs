//! A calibration as a file: TOML, so that a person can read and change it.

use std::path::Path;

use super::calibration::{Calibration, is_name};
use crate::Failure;
use crate::shared::files;

/// The value of the key `format`. The number rises when a key changes its meaning.
const FORMAT: &str = "lizard calibration 1";

const HEAD: &str = "\
# A lizard's calibration. `lizard calibrate restore` gives it back to the robot.
# Angles in degrees; trim and limit as the console has them, scale in us per degree.

";

/// The text of the file.
pub fn text(calibration: &Calibration) -> String {
    let keys = toml::to_string(calibration).expect("numbers and words are always TOML");
    format!("{HEAD}format = \"{FORMAT}\"\n{keys}")
}

/// Reads the text of a calibration file.
///
/// # Errors
/// Returns a message that names the key or the line.
pub fn parse(text: &str) -> Result<Calibration, String> {
    let line = |error: &toml::de::Error| {
        let offset = error.span().map_or(0, |span| span.start);
        text.get(..offset)
            .map_or(1, |text_before| text_before.lines().count().max(1))
    };
    let mut table: toml::Table = text.parse().map_err(|error: toml::de::Error| {
        let offset = error.span().map_or(0, |span| span.start);
        let reason = lizard_robot::explain_mistake(text, offset, error.message());
        format!("line {}: {reason}", line(&error))
    })?;
    match table.remove("format") {
        Some(format) if format.as_str() == Some(FORMAT) => {}
        Some(other) => return Err(format!("format is {other}, not \"{FORMAT}\"")),
        None => return Err(format!("the key format = \"{FORMAT}\" is missing")),
    }
    let calibration: Calibration = serde_path_to_error::deserialize(table).map_err(|error| {
        let key = error.path().to_string();
        let problem = error.inner().message().to_owned();
        match key.as_str() {
            "." => problem,
            _ => format!("{key}: {problem}"),
        }
    })?;
    if !is_name(&calibration.boot) {
        return Err(format!(
            "boot: `{}` is not the name of a gait",
            calibration.boot
        ));
    }
    for (name, servo) in ["A1", "A2", "A3", "A4"]
        .into_iter()
        .zip(calibration.servo.all())
    {
        let [min, max] = servo.limit;
        let values = [
            ("trim", servo.trim),
            ("limit", min),
            ("limit", max),
            ("scale", servo.scale),
        ];
        for (key, value) in values {
            // The console takes hundredths, and no larger numbers than a turn has.
            let hundredths = value * 100.0;
            if !(value.abs() <= 360.0 && (hundredths - hundredths.round()).abs() < 1e-6) {
                return Err(format!(
                    "servo.{name}.{key}: {value} is not a number of at most two decimals, \
                     -360..360"
                ));
            }
        }
    }
    Ok(calibration)
}

/// Reads a file.
///
/// # Errors
/// Fails if it cannot be read, or is not a calibration.
pub fn read(path: &Path) -> Result<Calibration, Failure> {
    let name = path.display();
    let text = files::read_text(path)?;
    parse(&text).map_err(|problem| Failure::Input(format!("{name}: {problem}")))
}

#[cfg(test)]
mod tests {
    use super::super::calibration::{Direction, Servo, Servos};
    use super::*;

    fn set() -> Calibration {
        let servo = |trim| Servo {
            trim,
            limit: [48.59, 228.59],
            dir: Direction::Minus,
            scale: 10.0,
        };
        Calibration {
            boot: "arc left".to_owned(),
            deadman: 1500,
            servo: Servos {
                a1: servo(-3.25),
                a2: servo(0.0),
                a3: servo(0.1),
                a4: servo(20.0),
            },
        }
    }

    #[test]
    fn a_calibration_is_the_same_after_the_way_through_a_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.toml");
        files::write(&path, text(&set()).as_bytes()).expect("it is written");
        assert_eq!(read(&path).expect("it is read"), set());
    }

    #[test]
    fn the_file_reads_as_a_person_would_write_it() {
        let text = text(&set());
        assert!(
            text.contains("boot = \"arc left\"\ndeadman = 1500\n"),
            "{text}"
        );
        assert!(
            text.contains(
                "[servo.A1]\ntrim = -3.25\nlimit = [48.59, 228.59]\ndir = \"-\"\nscale = 10.0\n"
            ),
            "{text}"
        );
    }

    #[test]
    fn a_mistake_in_a_file_is_reported_with_its_key() {
        let good = text(&set());
        let complaint = |from: &str, to: &str| {
            assert!(good.contains(from), "{from}");
            parse(&good.replacen(from, to, 1)).expect_err("it is wrong")
        };
        assert_eq!(
            complaint("calibration 1", "calibration 2"),
            "format is \"lizard calibration 2\", not \"lizard calibration 1\""
        );
        assert_eq!(
            parse("[links]\nl0 = 20.0\n").expect_err("it is another file"),
            "the key format = \"lizard calibration 1\" is missing"
        );
        let words = parse("format = \"x\n").expect_err("it is not TOML");
        assert!(words.starts_with("line 1: this is not TOML: "), "{words}");
        for (from, to, start) in [
            ("trim = -3.25\n", "", "servo.A1: missing field `trim`"),
            (
                "trim = -3.25",
                "trim = \"much\"",
                "servo.A1.trim: invalid type: string",
            ),
            (
                "trim = -3.25",
                "trim = 1.234",
                "servo.A1.trim: 1.234 is not a number of at most two",
            ),
            (
                "trim = -3.25",
                "trim = nan",
                "servo.A1.trim: NaN is not a number",
            ),
            (
                "trim = -3.25",
                "trim = 1e9",
                "servo.A1.trim: 1000000000 is not a number",
            ),
            (
                "dir = \"-\"",
                "dir = \"left\"",
                "servo.A1.dir: unknown variant `left`",
            ),
            (
                "limit = [48.59, 228.59]",
                "limit = [1]",
                "servo.A1.limit: invalid length 1",
            ),
            ("scale = 10.0", "scale = 10.0\nscal = 9", "servo.A1"),
            ("deadman = 1500", "deadman = -1", "deadman: invalid value"),
            (
                "arc left",
                "walk\\nsave",
                "boot: `walk\nsave` is not the name",
            ),
        ] {
            let words = complaint(from, to);
            assert!(words.starts_with(start), "{words} / {start}");
        }
    }
}
