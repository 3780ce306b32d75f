//! Tests of the choice of the keys and of their errors. A formula takes the place of the simulated robot.

use fastrand::Rng;

use super::*;
use crate::key::{PLAY, TWIST};
use crate::problem::MODEL_ERROR;

/// Number of gaits.
const GAITS: usize = 8;
/// Standard error of each measured figure.
const ERROR: f64 = 0.05;

/// A model whose movements are curved functions of the keys, with other coefficients for each gait.
fn model(values: &Values) -> Vec<Travel> {
    let mut rng = Rng::with_seed(5);
    let mut part = || {
        let mut movement = 0.0;
        for (value, key) in values.iter().zip(&KEYS) {
            let x = value / key.prior_error();
            movement += deviate(&mut rng) * (x + 0.1 * x * x);
        }
        movement
    };
    let mut travel = |_| Travel {
        forward: 30.0 + part(),
        left: part(),
        turn: 5.0 + part(),
    };
    (0..GAITS).map(&mut travel).collect()
}

/// An approximately normal deviate: the sum of twelve uniform ones.
fn deviate(rng: &mut Rng) -> f64 {
    (0..12).map(|_| rng.f64() - 0.5).sum()
}

/// The values from which each fit starts, in place of those of a robot.toml: zero, or the least possible value.
fn start() -> Values {
    std::array::from_fn(|i| KEYS[i].least.max(0.0))
}

/// The movements of a robot with random measurement errors, as a camera sees them from a tag card that may be glued
/// on slightly out of place.
fn measured(values: &Values, card: Card, rng: &mut Rng) -> Vec<MeasuredMovement> {
    let way = |travel: Travel| {
        let seen = card.card_travel(travel);
        let parts = [seen.forward, seen.left, seen.turn];
        MeasuredMovement {
            gait: "walk".to_owned(),
            pace: 1.0,
            mean: parts.map(|part| part + ERROR.hypot(MODEL_ERROR) * deviate(rng)),
            error: [ERROR; 3],
        }
    };
    model(values).into_iter().map(way).collect()
}

fn card(rng: &mut Rng) -> Card {
    Card::PRIOR_ERRORS.map(|doubt| doubt * deviate(rng)).into()
}

fn verdicts(found: &Identified) -> Vec<Verdict> {
    found.keys.iter().map(|found| found.verdict).collect()
}

#[test]
fn changed_keys_are_within_two_errors_in_95_of_100_and_right_ones_stay() {
    let (mut within, mut changed, mut moved, mut right, mut explained) = (0.0, 0.0, 0.0, 0.0, 0.0);
    const ROBOTS: u64 = 300;
    for seed in 0..ROBOTS {
        let mut rng = Rng::with_seed(seed);
        let mut truth = start();
        let is_changed: [bool; KEY_COUNT] = std::array::from_fn(|_| rng.bool());
        for i in (0..KEY_COUNT).filter(|&i| is_changed[i]) {
            truth[i] += KEYS[i].prior_error()
                * if i == PLAY {
                    rng.f64()
                } else {
                    deviate(&mut rng).max(-1.5).abs()
                };
        }
        let card = card(&mut rng);
        let ways = measured(&truth, card, &mut rng);
        let found = solve(&ways, start(), &model).expect("a fit");
        explained += f64::from(u8::from(found.goodness.is_explained));
        for i in 0..KEY_COUNT {
            let key = &found.keys[i];
            assert!(key.verdict != Verdict::Undetermined, "{seed} {key:?}");
            if is_changed[i] {
                changed += 1.0;
                within += f64::from(u8::from((key.after - truth[i]).abs() <= 2.0 * key.error));
            } else {
                right += 1.0;
                moved += f64::from(u8::from(key.verdict == Verdict::Moved));
            }
            let distance = (key.after - key.before).abs();
            assert_eq!(key.verdict == Verdict::Moved, distance > 0.0);
            assert!(distance == 0.0 || distance >= 2.0 * key.error);
        }
    }
    let share = within / changed;
    assert!((0.93..=0.985).contains(&share), "{share} of {changed}");
    assert!(moved / right < 0.05, "{} of {right}", moved / right);
    assert!(explained / ROBOTS as f64 > 0.97, "{explained}");
}

#[test]
fn at_a_fold_the_error_is_that_of_the_flatter_side() {
    /// Twist below which the foot carries no load, so a shorter foot changes nothing more, mm.
    const FOLD: f64 = -0.5;
    let folded = |values: &Values| {
        let mut values = *values;
        values[TWIST] = values[TWIST].max(FOLD);
        model(&values)
    };
    let mut truth = start();
    truth[TWIST] = FOLD;
    let mut ways = measured(&truth, Card::default(), &mut Rng::with_seed(1));
    for (way, travel) in ways.iter_mut().zip(model(&truth)) {
        way.mean = [travel.forward, travel.left, travel.turn];
    }
    let error = |model: &dyn Fn(&Values) -> Vec<Travel>| {
        solve(&ways, start(), model).expect("a fit").keys[TWIST].error
    };
    let [folded, smooth] = [error(&folded), error(&model)];
    assert!(folded > 1.2 * smooth, "{folded} {smooth}");
}

#[test]
fn a_key_without_influence_stays_and_is_said_to_be_untold() {
    let blind = |values: &Values| {
        let mut values = *values;
        values[5] = 0.7;
        model(&values)
    };
    let mut truth = start();
    (truth[0], truth[5]) = (8.0, 1.1);
    let mut rng = Rng::with_seed(1);
    let card = card(&mut rng);
    let mut ways = measured(&truth, card, &mut rng);
    for (way, travel) in ways.iter_mut().zip(blind(&truth)) {
        let seen = card.card_travel(travel);
        way.mean = [seen.forward, seen.left, seen.turn];
    }
    let found = solve(&ways, start(), &blind).expect("a fit");
    let mut wanted = vec![Verdict::Unchanged; KEY_COUNT];
    (wanted[0], wanted[5]) = (Verdict::Moved, Verdict::Undetermined);
    assert_eq!(verdicts(&found), wanted);
    assert_eq!(found.keys[5].after, found.keys[5].before);
    assert!(
        found.keys[5].error > 0.9 * KEYS[5].prior_error(),
        "{:?}",
        found.keys[5]
    );
}

#[test]
fn two_keys_that_look_alike_are_named() {
    let alike = |values: &Values| {
        let mut values = *values;
        let sum = values[2] + values[3];
        values[2] = sum + 0.02 * values[3];
        values[3] = 0.0;
        model(&values)
    };
    let mut rng = Rng::with_seed(1);
    let ways = measured(&start(), Card::default(), &mut rng);
    let found = solve(&ways, start(), &alike).expect("a fit");
    let [(a, b, correlation)] = found.correlated[..] else {
        panic!("{:?}", found.correlated);
    };
    assert_eq!(
        (a.full_name(), b.full_name()),
        (KEYS[2].full_name(), KEYS[3].full_name())
    );
    assert!(correlation < -0.9, "{correlation}");
}

#[test]
fn a_way_that_no_key_explains_is_named_and_widens_the_errors() {
    let mut rng = Rng::with_seed(2);
    let mut ways = measured(&start(), Card::default(), &mut rng);
    let good = solve(&ways, start(), &model).expect("a fit");
    assert!(good.goodness.is_explained && good.goodness.error_factor == 1.0);
    ways[3].mean[0] += 4.0;
    let bad = solve(&ways, start(), &model).expect("a fit");
    let Goodness {
        is_explained: explains,
        error_factor: widened,
        worst,
        ..
    } = bad.goodness;
    assert!(!explains && widened > 5.0, "{:?}", bad.goodness);
    assert_eq!((worst.0, worst.1), (3, 0));
    for (bad, good) in bad.keys.iter().zip(&good.keys) {
        assert!(bad.error > 4.0 * good.error, "{bad:?} {good:?}");
    }
}

#[test]
fn a_play_below_zero_is_not_written() {
    let mut rng = Rng::with_seed(3);
    let mut ways = measured(&start(), Card::default(), &mut rng);
    let with_play = |play: f64| {
        let mut values = start();
        values[PLAY] = play;
        model(&values)
    };
    // Shifts the movements by the opposite of what a play of 0.5 deg would do, so that the fit asks for -0.5 deg.
    for ((way, at), play) in ways.iter_mut().zip(with_play(0.0)).zip(with_play(0.5)) {
        way.mean[0] -= play.forward - at.forward;
        way.mean[1] -= play.left - at.left;
        way.mean[2] -= play.turn - at.turn;
    }
    let found = solve(&ways, start(), &model).expect("a fit");
    let play = &found.keys[PLAY];
    assert_eq!(play.after, 0.0);
    assert!(
        matches!(play.verdict, Verdict::Impossible(value) if (value + 0.5).abs() < 0.1),
        "{play:?}"
    );
}
