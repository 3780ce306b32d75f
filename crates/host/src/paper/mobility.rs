//! `lizard pose --show freedoms`: prints the degrees of freedom, counted and measured.

use lizard_kinematics::{Lizard, Solution};
use lizard_paper::mobility::{Mobility, measure};

use crate::Failure;
use crate::shared::json;

/// Prints the degrees of freedom of the body and each leg.
///
/// # Errors
/// Fails if the output cannot be written.
pub fn print(lizard: &Lizard, solution: &Solution, is_json: bool) -> Result<(), Failure> {
    let mobilities = measure(lizard, solution);
    json::print_json_or_text(is_json, &mobilities, || format_text(&mobilities))
}

fn format_text(mobilities: &[Mobility]) -> String {
    let mut page =
        "mechanism         links  joints  Gruebler   Jacobian  rank  freedoms  locked  conditioning\n"
            .to_owned();
    for mobility in mobilities {
        page += &format!(
            "{:16} {:6} {:7} {:9}   {:>5}x{:<2} {:5} {:9} {:7}  {:12.1e}\n",
            mobility.mechanism,
            mobility.links,
            mobility.joints,
            mobility.gruebler,
            mobility.constraints,
            mobility.velocities,
            mobility.rank,
            mobility.freedoms,
            mobility.locked_freedoms,
            mobility.conditioning
        );
    }
    page +=
        "locked: freedoms left with the driven cranks locked; conditioning: of the Jacobian\n\n";
    let is_singular = |mobility: &&Mobility| {
        mobility.freedoms as i64 != mobility.gruebler || mobility.locked_freedoms > 0
    };
    if !mobilities.iter().any(|mobility| is_singular(&mobility)) {
        page += "Count and rank agree: four servos hold the body, one spring each leg.\n";
    }
    for mobility in mobilities.iter().filter(is_singular) {
        page += &format!(
            "{} is singular here: the rank leaves {} freedoms",
            mobility.mechanism, mobility.freedoms
        );
        page += &match mobility.loose.as_slice() {
            [] => ".\n".to_owned(),
            loose_parts => format!(
                ", and {} with the driven cranks locked: {}.\n",
                mobility.locked_freedoms,
                loose_parts.join(", ")
            ),
        };
    }
    page
}
