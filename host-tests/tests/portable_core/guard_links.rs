//! The guard's parts with the links of other robots: what robot.toml may ask
//! for must be measured as well as the links of the paper.

use lizard::fivebar::FiveBar;
use lizard::root::root;
use lizard::slider::Slider;
use lizard::slope::{ENTRIES, Slope, table};
use lizard::trig::Direction;
use lizard::units::angle_from_centideg;
use lizard_avr::flash;
use lizard_kinematics as float;

use crate::truth::{CROSSING_BAND, MARGIN_BAND, STROKE_BAND, Spread, mm, sine};

/// The least type-2 limit that robot.toml may set.
const LEAST_TYPE2: f64 = 0.1;

flash! {
    const SHORT: [u16; ENTRIES] = table(17 * 256);
    const SQUAT: [u16; ENTRIES] = table(33 * 256 + 77);
    const PAPER: [u16; ENTRIES] = table(50 * 256);
    const WIDE: [u16; ENTRIES] = table(64 * 256 + 1);
    const LONG: [u16; ENTRIES] = table(127 * 256);
}

/// Couplers (1/256 mm) and the function of their table.
fn slopes() -> [(i16, Slope); 5] {
    [
        (17 * 256, Slope::new(17 * 256, SHORT)),
        (33 * 256 + 77, Slope::new(33 * 256 + 77, SQUAT)),
        (50 * 256, Slope::new(50 * 256, PAPER)),
        (64 * 256 + 1, Slope::new(64 * 256 + 1, WIDE)),
        (127 * 256, Slope::new(127 * 256, LONG)),
    ]
}

/// Of the couplers' reach, as far as their slope is right to [`SLOPE_ERROR`].
const SOUND: f64 = 0.9;
/// Relative, besides the slope's own step.
const SLOPE_ERROR: f64 = 4e-4;
/// 1/1024 is the slope's step.
const SLOPE_STEP: f64 = 1.0 / 1024.0;

#[test]
fn the_slope_of_the_couplers_is_within_its_stated_error_and_low_where_they_stretch() {
    for (coupler, slope) in slopes() {
        let reach = 2.0 * mm(coupler);
        let (mut sound, mut stretched) = (Spread::default(), Spread::default());
        for n in 0..400_000 {
            // Even in the logarithm, from too near over all octaves to apart.
            let share = 2f64.powf(-5.2 + 5.3 * f64::from(n) / 400_000.0);
            let d = share * reach;
            let tips_sq = (d * d * 16384.0) as u32;
            let Some(value) = slope.at(tips_sq) else {
                assert!(!(1.0001 / 32.0..=0.9999).contains(&share), "{d} mm");
                continue;
            };
            assert!(share < 1.0001 && share > 0.9999 / 32.0, "{d} mm");
            let truth = (reach * reach / (f64::from(tips_sq) / 16384.0) - 1.0).sqrt();
            let off = f64::from(value) / 1024.0 - truth;
            if share > SOUND {
                stretched.add(off);
                assert!(off <= 1.5 * SLOPE_STEP && off > -0.07, "{d} mm: {off}");
            } else if share > 1.0 / 30.0 {
                // Nearer, the table's largest number ends it: a margin of .06.
                sound.add((off.abs() - SLOPE_STEP).max(0.0) / truth);
            }
        }
        println!(
            "couplers of {:.2} mm: {sound} relative; stretched: {stretched}",
            mm(coupler)
        );
        assert!(sound.max <= SLOPE_ERROR);
    }
}

/// The errors of a five-bar's margins over the square of crank angles.
#[derive(Default)]
struct Errors {
    /// Where the crank tips part to at most [`SOUND`] of the reach.
    sound: Spread,
    /// Type-2 beyond.
    stretched_type2: Spread,
    /// Type-1 beyond.
    stretched_type1: Spread,
}

fn errors([base, left, right, coupler]: [f64; 4], slope: Slope) -> Errors {
    let steps = |mm: f64| (256.0 * mm) as i16;
    let core = FiveBar::new(steps(base), steps(left), steps(right), slope);
    let truth = float::FiveBar {
        base,
        crank_left: left,
        coupler_left: coupler,
        coupler_right: coupler,
        crank_right: right,
    };
    let least = ((LEAST_TYPE2 + band(coupler)) * 32768.0) as i16;
    let mut errors = Errors::default();
    for i in 0..=360 {
        for j in 0..=360 {
            let [a, b] = [i, j].map(|step| Direction::of(angle_from_centideg(50 * step)));
            let margins = core.margins(a, b);
            let [a, b] = [i, j].map(|step| 0.5 * f64::from(step));
            let Ok(pose) = truth.forward(a, b) else {
                assert!(margins[0] < least, "does not close at {a} {b}");
                continue;
            };
            if pose.gap.x.abs() < CROSSING_BAND {
                continue;
            }
            if pose.type2 < LEAST_TYPE2 {
                assert!(margins[0] < least, "folds at {a} {b}");
                continue;
            }
            let type2 = pose.type2.copysign(pose.gap.x);
            let meant = [type2, pose.type1_left(), pose.type1_right()];
            let [type2, left, right] = std::array::from_fn(|n| sine(margins[n]) - meant[n]);
            if pose.gap.length() <= SOUND * 2.0 * coupler {
                for off in [type2, left, right] {
                    errors.sound.add(off);
                }
            } else {
                assert!(
                    pose.gap.x < 0.0 || type2 <= band(coupler),
                    "{type2} too high at {a} {b}"
                );
                errors.stretched_type2.add(type2);
                errors.stretched_type1.add(left);
                errors.stretched_type1.add(right);
            }
        }
    }
    errors
}

/// The margins' error for couplers of a length in mm: steps of lengths and
/// angles weigh more in a small robot.
fn band(coupler: f64) -> f64 {
    MARGIN_BAND.max(0.11 / coupler)
}

#[test]
fn five_bars_of_other_robots_are_measured_as_well() {
    for (coupler, slope) in slopes() {
        let l = mm(coupler);
        // Like the paper's, lopsided, slight, and one that can stretch.
        let shapes = [
            [0.4, 0.6, 0.6],
            [0.5, 0.8, 0.4],
            [0.15, 0.3, 0.3],
            [0.9, 0.65, 0.7],
        ];
        for shape in shapes {
            let [base, left, right] = shape.map(|share: f64| (256.0 * share * l).round() / 256.0);
            if base + left + right > 127.0 {
                continue; // robot.toml may not ask for it
            }
            let errors = errors([base, left, right, l], slope);
            println!(
                "{base:.1} {left:.1} {right:.1} mm, couplers {l:.1} mm: {}; stretched type-2 {}, type-1 {}",
                errors.sound, errors.stretched_type2, errors.stretched_type1
            );
            assert!(errors.sound.max <= band(l));
            assert!(errors.stretched_type1.max <= 0.05);
        }
    }
}

#[test]
fn sliders_of_other_robots_are_measured_as_well() {
    for (offset, base, front, rear) in [
        (0.0, 135.0, 30.0, 30.0),
        (-12.0, 90.0, 20.0, 35.0),
        (25.0, 130.0, 50.0, 50.0),
        (3.0, 40.0, 8.0, 12.0),
    ] {
        let steps = |mm: f64| (256.0 * mm) as i16;
        let left = Slider {
            offset: steps(offset),
            base: (256.0 * base) as u16,
            front: steps(front),
            rear: steps(rear),
            nominal: (256.0 * base) as u16,
            min: 0,
            max: u16::MAX,
        };
        let truth = float::Slider {
            offset,
            base,
            front,
            rear,
            nominal: base,
        };
        let mut spread = Spread::default();
        for i in 0..360 {
            for j in 0..360 {
                let [a, b] = [i, j].map(|step| Direction::of(angle_from_centideg(100 * step)));
                let [front, rear] = [i, j].map(f64::from);
                // Tail-local angles: the rear crank's is the negative.
                let meant = truth
                    .forward(-rear - 90.0, front + 90.0)
                    .expect("tips apart");
                spread.add(mm(left.travel(left.length_sq(a, b))) - meant.s);
                // The right side is the left one in a mirror.
                let right = left.mirrored();
                let seen = right.length_sq(a.mirrored(), b.mirrored());
                let meant = truth
                    .forward(-rear + 90.0, front - 90.0)
                    .expect("tips apart");
                spread.add(mm(right.travel(seen)) - meant.s);
            }
        }
        println!("offset {offset}, base {base}, arms {front} and {rear} mm: {spread} mm");
        assert!(spread.max <= STROKE_BAND);
    }
}

#[test]
fn a_root_is_the_largest_whole_number_whose_square_fits() {
    for k in 0..=u16::MAX {
        let square = u32::from(k) * u32::from(k);
        assert_eq!(root(square), k);
        // The last number before the next square, and one within.
        let last = square + 2 * u32::from(k);
        assert_eq!(root(last), k);
        assert_eq!(root(square + u32::from(k)), k);
    }
}
