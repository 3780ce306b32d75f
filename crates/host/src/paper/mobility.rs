//! `lizard pose --show freedoms`: prints the degrees of freedom by Gruebler's count and by the constraints' rank.

use lizard_kinematics::{Lizard, Solution};
use lizard_paper::mobility::{Mobility, compute_mobilities};

use crate::Failure;
use crate::shared::json;

/// Prints the degrees of freedom of the body and each leg.
///
/// # Errors
/// Fails if the output cannot be written.
pub fn print(lizard: &Lizard, solution: &Solution, is_json: bool) -> Result<(), Failure> {
    let mobilities = compute_mobilities(lizard, solution);
    json::print_json_or_text(is_json, &mobilities, || format_text(&mobilities))
}

fn format_text(mobilities: &[Mobility]) -> String {
    let mut text =
        "mechanism         links  joints  Gruebler   Jacobian  rank  freedoms  locked  conditioning\n"
            .to_owned();
    for mobility in mobilities {
        text += &format!(
            "{:16} {:6} {:7} {:9}   {:>5}x{:<2} {:5} {:9} {:7}  {:12.1e}\n",
            mobility.mechanism,
            mobility.link_count,
            mobility.joint_count,
            mobility.gruebler,
            mobility.constraint_count,
            mobility.velocity_count,
            mobility.rank,
            mobility.freedoms,
            mobility.locked_freedoms,
            mobility.inverse_condition_number
        );
    }
    text +=
        "locked: freedoms left with the driven cranks locked; conditioning: of the Jacobian\n\n";
    let is_singular = |mobility: &&Mobility| {
        mobility.freedoms as i64 != mobility.gruebler || mobility.locked_freedoms > 0
    };
    if !mobilities.iter().any(|mobility| is_singular(&mobility)) {
        text += "Count and rank agree: four servos hold the body, one strut each leg.\n";
    }
    for mobility in mobilities.iter().filter(is_singular) {
        text += &format!(
            "{} is singular here: the rank leaves {} freedoms",
            mobility.mechanism, mobility.freedoms
        );
        text += &match mobility.loose_messages.as_slice() {
            [] => ".\n".to_owned(),
            messages => format!(
                ", and {} with the driven cranks locked: {}.\n",
                mobility.locked_freedoms,
                messages.join(", ")
            ),
        };
    }
    text
}
