//! How fine the step of a mechanism's lengths may be, so that its longest bars
//! still fit into the core's 16-bit integers.

use lizard_core::{five_bar, slider, units::Scale};
use lizard_kinematics::{FiveBar, Slider};

/// The longest that robot.toml may have a bar, mm.
pub(crate) const LONGEST_BAR: f64 = 1000.0;

// So every mechanism that can be written down fits at some scale.
const _: () = assert!(3.0 * LONGEST_BAR < five_bar::LONGEST);
const _: () = assert!(4.0 * LONGEST_BAR < slider::LONGEST_ARMS);

/// Steps of a scale in a millimetre.
pub(crate) fn steps_per_mm(scale: Scale) -> f64 {
    f64::from(1u32 << scale.bits)
}

/// The scale of an end's five-bar.
pub(crate) fn of_loop(bars: &FiveBar) -> Scale {
    let all = bars.base + bars.crank_left + bars.crank_right;
    finest(&[
        (all, five_bar::LONGEST),
        (bars.coupler_left, five_bar::LONGEST),
        (bars.coupler_right, five_bar::LONGEST),
    ])
}

/// The scale of a side whose slider may travel `stroke_max` (mm) from nominal.
pub(crate) fn of_side(side: &Slider, stroke_max: f64) -> Scale {
    let arms = side.front + side.rear + side.offset.abs();
    finest(&[
        (side.base + arms, slider::LONGEST),
        (arms, slider::LONGEST_ARMS),
        (side.nominal + stroke_max.max(0.0), slider::LONGEST),
    ])
}

/// The finest scale in which every length (mm) has fewer steps than it may.
fn finest(lengths: &[(f64, f64)]) -> Scale {
    let fits = |scale: &Scale| {
        let per_mm = steps_per_mm(*scale);
        lengths.iter().all(|(mm, most)| mm * per_mm < *most)
    };
    (0..=Scale::FINEST.bits)
        .rev()
        .map(|bits| Scale { bits })
        .find(fits)
        .expect("a bar is at most a metre long")
}
