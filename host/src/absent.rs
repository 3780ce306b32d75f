//! Commands that a program built without one of its cargo features lacks.

use std::ffi::OsString;

use crate::Failure;

const SIMULATOR: [&str; 5] = ["sim", "twin", "mjcf", "tune", "bench"];
/// `replay` needs the simulator's pictures, too.
const CONSOLE: [&str; 7] = [
    "flash",
    "console",
    "calibrate",
    "backup",
    "restore",
    "record",
    "replay",
];
const PARTS: [&str; 2] = ["parts", "fit"];
const PAPER: [&str; 10] = [
    "solve",
    "inverse",
    "velocity",
    "singularity",
    "mobility",
    "design",
    "errata",
    "charts",
    "speed",
    "prove",
];

/// Why there is no command of the first of these words.
#[must_use]
pub fn explain(words: &[OsString]) -> Failure {
    let name = words.first().map(|word| word.to_string_lossy());
    let name = name.as_deref().unwrap_or_default();
    let name = match name {
        "fk" => "solve",
        "ik" => "inverse",
        "jacobian" => "velocity",
        "monitor" => "console",
        name => name,
    };
    let draws = name == "replay" && cfg!(feature = "console");
    // It searches on all cores, as the commands that compute do.
    let searches = name == "tune" && cfg!(feature = "simulator");
    // It has the parts' shapes and masses.
    let shapes = name == "mjcf" && cfg!(feature = "simulator");
    let without = if shapes {
        "the parts to print"
    } else if searches {
        "the commands that compute"
    } else if SIMULATOR.contains(&name) || draws {
        "the simulator"
    } else if PAPER.contains(&name) {
        "the commands that compute"
    } else if CONSOLE.contains(&name) {
        "the commands for a board on USB"
    } else if PARTS.contains(&name) {
        "the parts to print"
    } else {
        return Failure::Input(format!(
            "there is no command `{name}`; lizard --help lists them"
        ));
    };
    Failure::Input(format!(
        "`lizard {name}` is missing: this program was built without {without}; make cli builds all"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_of_an_absent_feature_says_how_to_get_it() {
        let words = |word: &str| explain(&[word.into(), "--json".into()]).to_string();
        assert_eq!(
            words("sim"),
            "`lizard sim` is missing: this program was built without the simulator; make cli builds all"
        );
        assert!(words("backup").contains("without the commands for a board on USB"));
        assert!(words("solve").contains("without the commands that compute"));
        assert!(words("ik").starts_with("`lizard inverse` is missing: "));
        assert!(words("parts").contains("without the parts to print"));
        assert_eq!(
            words("fly"),
            "there is no command `fly`; lizard --help lists them"
        );
    }
}
