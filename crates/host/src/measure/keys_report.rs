//! The report of the identified keys, for people and for scripts.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use lizard_identify::{
    COMPONENTS, Card, GoodnessOfFit, Identified, KeyResult, MovementResult, Verdict,
};
use serde::Serialize;

/// The identified keys, with the field names of `--json`.
#[derive(Serialize)]
pub(super) struct KeysReport {
    keys: Vec<KeyLine>,
    card: CardLine,
    /// Pairs of keys with the correlation of their errors.
    alike: Vec<(String, String, f64)>,
    fit: FitLine,
    gaits: Vec<GaitLine>,
    /// The new robot.toml; null if no key has changed.
    written: Option<PathBuf>,
}

/// A key of robot.toml: its values before and after the identification, and the standard error of the new one.
#[derive(Serialize)]
struct KeyLine {
    key: String,
    unit: &'static str,
    before: f64,
    after: f64,
    error: f64,
    /// "moved", "right", "untold" or "impossible".
    verdict: &'static str,
}

/// The pose of the tag card on the robot's deck, relative to the deck's middle: each a value and its standard error,
/// in deg for the turn and in mm for the offsets.
#[derive(Serialize)]
struct CardLine {
    turn: [f64; 2],
    ahead: [f64; 2],
    left: [f64; 2],
}

/// The quality of the fit: chi-square with the given robot.toml, with the new one, and with all keys free.
#[derive(Serialize)]
struct FitLine {
    /// The number of measured values.
    figures: usize,
    chi_square_before: f64,
    chi_square: f64,
    chi_square_all_free: f64,
    /// Degrees of freedom of `chi_square`.
    freedom: f64,
    /// True if the model explains the measured values.
    explains: bool,
    /// The factor by which the misfit of the model enlarges all standard errors.
    errors_widened: f64,
}

/// A gait: measured values, their standard errors (null if the model predicts none), and the predictions with the
/// given and the new robot.toml; ahead and left in mm, turn in deg.
#[derive(Serialize)]
struct GaitLine {
    gait: String,
    speed: f64,
    measured: [f64; 3],
    error: [Option<f64>; 3],
    before: [f64; 3],
    after: [f64; 3],
}

impl KeysReport {
    pub(super) fn new(identified: &Identified, written_path: Option<&Path>) -> Self {
        let Identified {
            card, card_error, ..
        } = identified;
        let value_and_error = |value_of: fn(&Card) -> f64| [value_of(card), value_of(card_error)];
        let GoodnessOfFit {
            chi_squares: [chi_square_before, chi_square, chi_square_all_free],
            ..
        } = identified.goodness;
        let name_pair =
            |(first, second, correlation): &(&lizard_identify::Key, &lizard_identify::Key, f64)| {
                (first.full_name(), second.full_name(), *correlation)
            };
        Self {
            keys: identified.keys.iter().map(KeyLine::new).collect(),
            card: CardLine {
                turn: value_and_error(|card| card.turn),
                ahead: value_and_error(|card| card.ahead),
                left: value_and_error(|card| card.left),
            },
            alike: identified.correlated_pairs.iter().map(name_pair).collect(),
            fit: FitLine {
                figures: identified.goodness.value_count,
                chi_square_before,
                chi_square,
                chi_square_all_free,
                freedom: identified.goodness.degrees_of_freedom,
                explains: identified.goodness.is_explained,
                errors_widened: identified.goodness.error_factor,
            },
            gaits: identified.movements.iter().map(GaitLine::new).collect(),
            written: written_path.map(Path::to_owned),
        }
    }
}

impl KeyLine {
    fn new(result: &KeyResult) -> Self {
        Self {
            key: result.key.full_name(),
            unit: result.key.unit,
            before: result.file_value,
            after: result.new_value,
            error: result.error,
            verdict: match result.verdict {
                Verdict::Changed => "moved",
                Verdict::Unchanged => "right",
                Verdict::Undetermined => "untold",
                Verdict::Impossible(_) => "impossible",
            },
        }
    }
}

impl GaitLine {
    fn new(result: &MovementResult) -> Self {
        Self {
            gait: result.measured.gait.clone(),
            speed: 100.0 * result.measured.pace,
            measured: result.measured.mean,
            error: result
                .measured
                .error
                .map(|error| Some(error).filter(|error| error.is_finite())),
            before: result.predicted_before,
            after: result.predicted_after,
        }
    }
}

/// Formats the report for people.
pub(super) fn report_text(identified: &Identified, written_path: Option<&Path>) -> String {
    let mut text = format!(
        "{:<35}{:>10}{:>10}{:>9}\n",
        "key", "before", "after", "error"
    );
    for result in &identified.keys {
        text += &key_line(result);
    }
    let Identified {
        card, card_error, ..
    } = identified;
    let _ = writeln!(
        text,
        "\nThe card on the deck lies {:+.1} +- {:.1} mm ahead of the middle, {:+.1} +- {:.1} mm to the left, and is turned by \
         {:+.2} +- {:.2} deg.",
        card.ahead, card_error.ahead, card.left, card_error.left, card.turn, card_error.turn
    );
    for (first, second, correlation) in &identified.correlated_pairs {
        let _ = writeln!(
            text,
            "{} and {} look alike in these gaits: their errors are correlated by {correlation:+.2}.",
            first.full_name(),
            second.full_name()
        );
    }
    text += "\n";
    text += &goodness_text(identified);
    let _ = writeln!(
        text,
        "\n{:<28}{:>9}{:>7}{:>9}{:>9}",
        "a cycle", "measured", "error", "before", "after"
    );
    for result in &identified.movements {
        text += &movement_lines(result);
    }
    text += "\n";
    match written_path {
        Some(path) => {
            let path = path.display();
            let _ = writeln!(
                text,
                "{path}: the robot with the values above; lizard gaits --robot {path}"
            );
        }
        None => text += "No key is changed, so nothing is written.\n",
    }
    text
}

fn key_line(result: &KeyResult) -> String {
    let digits = result.decimal_count();
    let key = result.key;
    let name = match key.unit {
        "" => key.full_name(),
        unit => format!("{}, {unit}", key.full_name()),
    };
    let verdict = match result.verdict {
        Verdict::Changed => "changed".to_owned(),
        Verdict::Unchanged => "right".to_owned(),
        Verdict::Undetermined => format!("these gaits do not tell it: {}", key.other_method),
        Verdict::Impossible(value) => {
            format!("would have to be {value:.digits$}, which it cannot; left")
        }
    };
    format!(
        "{name:<35}{:>10}{:>10}{:>9.digits$}  {verdict}\n",
        format!("{:?}", result.file_value),
        if result.verdict == Verdict::Changed {
            format!("{:.digits$}", result.new_value)
        } else {
            "-".to_owned()
        },
        result.error,
    )
}

/// Formats the paragraph on the goodness of the fit.
fn goodness_text(identified: &Identified) -> String {
    let GoodnessOfFit {
        value_count,
        chi_squares: [chi_before, chi_after, chi_free],
        degrees_of_freedom: freedom,
        chi_square_limit: limit,
        is_explained,
        error_factor,
        largest_residual: (movement_index, component_index, difference),
    } = identified.goodness;
    let mut text = format!(
        "{value_count} figures: chi-square {chi_before:.1} by robot.toml, {chi_after:.1} with the values above, for {freedom:.0} degrees of freedom.\n"
    );
    let (name, _) = COMPONENTS[component_index];
    let gait = &identified.movements[movement_index].measured.gait;
    let comparison = if difference > 0.0 { "more" } else { "less" };
    let worst_text = format!(
        "`{gait}`, {name}: {:.1} errors {comparison} than the model",
        difference.abs()
    );
    if !is_explained {
        let _ = writeln!(
            text,
            "The model does not explain these movements, whatever its keys: chi-square {chi_free:.1} at best, and 1 % of true models exceed \
             {limit:.1}. Worst is {worst_text}. All errors above are therefore {error_factor:.1} times as large. Look for a servo that is not \
             as robot.toml has it, a foot that catches, another floor."
        );
    } else if freedom >= 1.0 && chi_after > limit {
        let _ = writeln!(
            text,
            "The unchanged keys would explain more, but only together ({chi_free:.1}), and these gaits do not tell which of them. \
             Film further gaits. Worst is {worst_text}."
        );
    } else if freedom < 1.0 {
        text += "That is too few figures to tell whether the model is right: film further gaits.\n";
    } else {
        let _ = writeln!(
            text,
            "The model explains these movements. Worst is {worst_text}."
        );
        if error_factor >= 1.05 {
            let _ = writeln!(
                text,
                "All errors above are {error_factor:.1} times as large, because of the remaining misfit."
            );
        }
    }
    text
}

fn movement_lines(result: &MovementResult) -> String {
    let movement = &result.measured;
    let gait = match movement.pace {
        1.0 => movement.gait.clone(),
        pace => format!("{} at {:.0} %", movement.gait, 100.0 * pace),
    };
    let mut lines = String::new();
    for (i, (component_name, unit)) in COMPONENTS.iter().enumerate() {
        let name = if i == 0 { gait.as_str() } else { "" };
        let error = match movement.error[i].is_finite() {
            true => format!("{:.2}", movement.error[i]),
            false => "tie".to_owned(),
        };
        let _ = writeln!(
            lines,
            "{name:<17}{:<11}{:>+9.2}{error:>7}{:>+9.2}{:>+9.2}",
            format!("{component_name}, {unit}"),
            movement.mean[i],
            result.predicted_before[i],
            result.predicted_after[i]
        );
    }
    lines
}
