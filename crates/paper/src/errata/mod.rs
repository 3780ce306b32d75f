//! All equations of the paper, compared with the geometric solution. Only the equations are written by hand; all
//! results are computed.

mod equation;
mod equation_result;
mod forward;
mod inverse;
mod legs;
mod sample;
mod singular;
mod synthesis;
mod table;

use rayon::prelude::*;

use equation::{Equation, ErrorFn, FormErrors};
use sample::Sample;

pub use equation_result::EquationResult;
pub use table::{format_markdown, format_text};

/// Number of random poses for docs/errata.md.
pub const SAMPLE_COUNT: u32 = 20_000;

/// The paper's equations, in the order of the paper.
fn all_equations() -> Vec<&'static Equation> {
    let sections = [
        synthesis::EQUATIONS,
        inverse::EQUATIONS,
        forward::EQUATIONS,
        legs::EQUATIONS,
        singular::EQUATIONS,
    ];
    sections.into_iter().flatten().collect()
}

/// The number of equations that [`evaluate_equations`] evaluates.
pub fn equation_count() -> usize {
    all_equations().len()
}

/// Evaluates every equation at `sample_count` random poses, on all cores. The results are in the paper's order. Calls
/// `report_progress` after each equation.
pub fn evaluate_equations(
    sample_count: u32,
    report_progress: &(dyn Fn() + Sync),
) -> Vec<EquationResult> {
    let samples: Vec<Sample> = Sample::generate(sample_count as usize).collect();
    let evaluate = |error_fn: ErrorFn| FormErrors::evaluate(error_fn, &samples);
    let evaluate_equation = |equation: &Equation| {
        let printed = evaluate(equation.printed_error);
        let corrected = equation.correction.map(|(_, error_fn)| evaluate(error_fn));
        let clockwise = equation.clockwise_error.map(evaluate);
        report_progress();
        EquationResult {
            location: equation.location,
            printed_form: equation.printed_form,
            holds: printed.holds(),
            max_error: printed.max,
            no_real_value_fraction: printed.no_real_value_fraction,
            unit: equation.unit,
            special_case: equation
                .special_case
                .map(|(name, error_fn)| (evaluate(error_fn).max, name)),
            holds_clockwise: clockwise.map(|errors| errors.holds()),
            corrected_form: equation.correction.map(|(form, _)| form),
            corrected_max_error: corrected.map(|errors| errors.max),
            corrected_holds: corrected.map(|errors| errors.holds()),
        }
    };
    let equations = all_equations().into_par_iter();
    equations.map(evaluate_equation).collect()
}
