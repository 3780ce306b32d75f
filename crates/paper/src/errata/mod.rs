//! Every equation of the paper compared with the geometric solution. Only the equations are typed in; all else is
//! computed.

mod entry;
mod equation;
mod forward;
mod inverse;
mod legs;
mod sample;
mod singular;
mod synthesis;
mod table;

use rayon::prelude::*;

use equation::{Equation, Misses};
use sample::Sample;

pub use entry::Entry;
pub use table::{markdown, text};

/// Number of random poses behind docs/errata.md.
pub const SAMPLES: u32 = 20_000;

/// The paper's equations, in its order.
fn equations() -> Vec<&'static Equation> {
    [
        synthesis::EQUATIONS,
        inverse::EQUATIONS,
        forward::EQUATIONS,
        legs::EQUATIONS,
        singular::EQUATIONS,
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The number of equations that [`measure`] evaluates.
pub fn equation_count() -> usize {
    equations().len()
}

/// Measures every equation, in the paper's order, at `samples` random poses, on all cores. `progress` is called once
/// for each.
pub fn measure(samples: u32, progress: &(dyn Fn() + Sync)) -> Vec<Entry> {
    let samples: Vec<Sample> = Sample::many(samples as usize).collect();
    let measure_one = |equation: &Equation| {
        let printed = Misses::of(equation.miss, &samples);
        let corrected = equation
            .corrected
            .map(|(_, miss)| Misses::of(miss, &samples));
        progress();
        Entry {
            place: equation.place,
            printed: equation.printed,
            holds: printed.holds(),
            worst: printed.worst,
            unreal: printed.unreal,
            unit: equation.unit,
            aside: equation
                .special_case
                .map(|(place, miss)| (Misses::of(miss, &samples).worst, place)),
            holds_clockwise: equation
                .clockwise
                .map(|miss| Misses::of(miss, &samples).holds()),
            corrected: equation.corrected.map(|(form, _)| form),
            corrected_worst: corrected.map(|misses| misses.worst),
            corrected_holds: corrected.map(|misses| misses.holds()),
        }
    };
    equations().into_par_iter().map(measure_one).collect()
}
