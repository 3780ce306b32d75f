//! The report of the identified keys, as text and as JSON.

use std::fmt::Write as _;
use std::path::Path;

use lizard_identify::{
    COMPONENTS, CardPose, GoodnessOfFit, Identification, Key, KeyResult, MovementResult, Verdict,
};
use serde::Serialize;

/// The identified keys, as `--json` prints them.
#[derive(Serialize)]
pub(super) struct KeysReport {
    keys: Vec<KeyReport>,
    card: CardReport,
    /// Pairs of keys with the correlation of their errors.
    #[serde(rename = "alike")]
    correlated_pairs: Vec<(String, String, f64)>,
    fit: FitReport,
    gaits: Vec<GaitReport>,
    /// The new robot.toml; null if no key has changed.
    #[serde(rename = "written")]
    output_name: Option<String>,
}

/// A key of robot.toml: its old and new values, and the standard error of the new value.
#[derive(Serialize)]
struct KeyReport {
    key: String,
    unit: &'static str,
    #[serde(rename = "before")]
    file_value: f64,
    #[serde(rename = "after")]
    new_value: f64,
    error: f64,
    /// "moved", "right", "untold" or "impossible".
    verdict: &'static str,
}

/// The pose of the tag card on the robot's deck, relative to the deck's centre. Each field is a value and its standard
/// error, in deg for the turn and in mm for the offsets.
#[derive(Serialize)]
struct CardReport {
    turn: [f64; 2],
    #[serde(rename = "ahead")]
    forward: [f64; 2],
    left: [f64; 2],
}

/// The goodness of the fit: chi-square with the given robot.toml, with the new robot.toml, and with all keys free.
#[derive(Serialize)]
struct FitReport {
    /// The number of measured values.
    #[serde(rename = "figures")]
    value_count: usize,
    chi_square_before: f64,
    chi_square: f64,
    chi_square_all_free: f64,
    /// Degrees of freedom of `chi_square`.
    #[serde(rename = "freedom")]
    degrees_of_freedom: f64,
    /// True if the model explains the measured values.
    #[serde(rename = "explains")]
    is_explained: bool,
    /// The factor by which the model's misfit enlarges all standard errors.
    #[serde(rename = "errors_widened")]
    error_factor: f64,
}

/// A gait: measured values, their standard errors (null if the model predicts none), and the predictions with the
/// given and the new robot.toml; ahead and left in mm, turn in deg.
#[derive(Serialize)]
struct GaitReport {
    gait: String,
    #[serde(rename = "speed")]
    pace_percent: f64,
    measured: [f64; 3],
    error: [Option<f64>; 3],
    #[serde(rename = "before")]
    predicted_before: [f64; 3],
    #[serde(rename = "after")]
    predicted_after: [f64; 3],
}

impl KeysReport {
    pub(super) fn new(identified: &Identification, output_path: Option<&Path>) -> Self {
        let value_and_error = |component: fn(&CardPose) -> f64| {
            [&identified.card, &identified.card_error].map(component)
        };
        let goodness = &identified.goodness;
        let [chi_square_before, chi_square, chi_square_all_free] = goodness.chi_squares;
        let name_pair = |(first, second, correlation): &(&Key, &Key, f64)| {
            (first.full_name(), second.full_name(), *correlation)
        };
        let keys = identified.keys.iter().map(|result| KeyReport {
            key: result.key.full_name(),
            unit: result.key.unit,
            file_value: result.file_value,
            new_value: result.new_value,
            error: result.error,
            verdict: match result.verdict {
                Verdict::Changed => "moved",
                Verdict::Unchanged => "right",
                Verdict::Undetermined => "untold",
                Verdict::Impossible(_) => "impossible",
            },
        });
        let gaits = identified.movements.iter().map(|result| GaitReport {
            gait: result.measured.gait.clone(),
            pace_percent: 100.0 * result.measured.pace,
            measured: result.measured.mean,
            error: result
                .measured
                .error
                .map(|error| error.is_finite().then_some(error)),
            predicted_before: result.predicted_before,
            predicted_after: result.predicted_after,
        });
        Self {
            keys: keys.collect(),
            card: CardReport {
                turn: value_and_error(|card| card.turn),
                forward: value_and_error(|card| card.forward),
                left: value_and_error(|card| card.left),
            },
            correlated_pairs: identified.correlated_pairs.iter().map(name_pair).collect(),
            fit: FitReport {
                value_count: goodness.value_count,
                chi_square_before,
                chi_square,
                chi_square_all_free,
                degrees_of_freedom: goodness.degrees_of_freedom,
                is_explained: goodness.is_explained,
                error_factor: goodness.error_factor,
            },
            gaits: gaits.collect(),
            // A path that is not UTF-8 cannot be serialized.
            output_name: output_path.map(|path| path.display().to_string()),
        }
    }
}

/// Formats the report as text.
pub(super) fn format_report(identified: &Identification, output_path: Option<&Path>) -> String {
    let mut text = format!(
        "{:<35}{:>10}{:>10}{:>9}\n",
        "key", "before", "after", "error"
    );
    for result in &identified.keys {
        text += &format_key(result);
    }
    let (card, card_error) = (&identified.card, &identified.card_error);
    let _ = writeln!(
        text,
        "\nThe card on the deck lies {:+.1} +- {:.1} mm ahead of the centre and {:+.1} +- {:.1} mm to the left, and is \
         turned by {:+.2} +- {:.2} deg.",
        card.forward, card_error.forward, card.left, card_error.left, card.turn, card_error.turn
    );
    for (first, second, correlation) in &identified.correlated_pairs {
        let _ = writeln!(
            text,
            "{} and {} have similar effects in these gaits: the correlation of their errors is {correlation:+.2}.",
            first.full_name(),
            second.full_name()
        );
    }
    text += "\n";
    text += &format_goodness(identified);
    let _ = writeln!(
        text,
        "\n{:<28}{:>9}{:>7}{:>9}{:>9}",
        "per cycle", "measured", "error", "before", "after"
    );
    for result in &identified.movements {
        text += &format_movement(result);
    }
    text += "\n";
    match output_path {
        Some(path) => {
            let path = path.display();
            text += &format!("{path} has the values above; next: lizard gaits --robot {path}\n");
        }
        None => text += "No key was changed, so no file was written.\n",
    }
    text
}

fn format_key(result: &KeyResult) -> String {
    let decimals = result.decimal_count();
    let key = result.key;
    let name = match key.unit {
        "" => key.full_name(),
        unit => format!("{}, {unit}", key.full_name()),
    };
    let verdict = match result.verdict {
        Verdict::Changed => "changed".to_owned(),
        Verdict::Unchanged => "right".to_owned(),
        Verdict::Undetermined => {
            format!("not determined by these gaits: {}", key.other_method)
        }
        Verdict::Impossible(value) => {
            format!("would be {value:.decimals$}, which is not allowed; unchanged")
        }
    };
    let file_value = format!("{:?}", result.file_value);
    let new_value = match result.verdict {
        Verdict::Changed => format!("{:.decimals$}", result.new_value),
        _ => "-".to_owned(),
    };
    let error = result.error;
    format!("{name:<35}{file_value:>10}{new_value:>10}{error:>9.decimals$}  {verdict}\n")
}

/// Formats the paragraph about the goodness of the fit.
fn format_goodness(identified: &Identification) -> String {
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
        "{value_count} values: chi-square {chi_before:.1} with robot.toml, {chi_after:.1} with the values \
         above, for {freedom:.0} degrees of freedom.\n"
    );
    let (name, _) = COMPONENTS[component_index];
    let gait = &identified.movements[movement_index].measured.gait;
    let comparison = if difference > 0.0 { "more" } else { "less" };
    let deviation = format!(
        "`{gait}`, {name}: {:.1} standard errors {comparison} than the model",
        difference.abs()
    );
    if !is_explained {
        let _ = writeln!(
            text,
            "The model does not explain these movements with any values of its keys: chi-square is at least \
             {chi_free:.1}, but only 1 % of true models exceed {limit:.1}. The largest deviation is {deviation}. All \
             errors above are therefore {error_factor:.1} times as large. Look for a servo that \
             differs from robot.toml, a foot that catches, or another floor."
        );
    } else if freedom >= 1.0 && chi_after > limit {
        let _ = writeln!(
            text,
            "Changes of further keys would explain more (chi-square {chi_free:.1}), but these gaits do not determine \
             which keys: record more gaits. The largest deviation is {deviation}."
        );
    } else if freedom < 1.0 {
        text += "These values are too few to judge the model: record more gaits.\n";
    } else {
        text +=
            &format!("The model explains these movements. The largest deviation is {deviation}.\n");
        if error_factor >= 1.05 {
            let _ = writeln!(
                text,
                "Because of the remaining misfit, all errors above are {error_factor:.1} times as large."
            );
        }
    }
    text
}

fn format_movement(result: &MovementResult) -> String {
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
