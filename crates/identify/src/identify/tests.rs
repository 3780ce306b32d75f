//! Tests of the choice of keys and of their errors. A formula replaces the simulated robot.

use fastrand::Rng;

use super::*;
use crate::card::CardPose;
use crate::problem::MODEL_ERROR;

/// Number of gaits.
const GAIT_COUNT: usize = 8;
/// Standard error of each measured mean, mm or deg.
const STANDARD_ERROR: f64 = 0.05;

/// Computes movements that are curved functions of the keys, with different coefficients for each gait.
fn compute_travels(values: &Values) -> Vec<Travel> {
    let mut rng = Rng::with_seed(5);
    let mut next_component = || {
        let mut component = 0.0;
        for (value, key) in values.iter().zip(&KEYS) {
            let x = value / key.prior_error();
            component += random_normal(&mut rng) * (x + 0.1 * x * x);
        }
        component
    };
    let mut next_travel = |_| Travel {
        forward: 30.0 + next_component(),
        left: next_component(),
        turn: 5.0 + next_component(),
    };
    (0..GAIT_COUNT).map(&mut next_travel).collect()
}

/// Returns an approximately normal deviate: the sum of twelve uniform deviates.
fn random_normal(rng: &mut Rng) -> f64 {
    (0..12).map(|_| rng.f64() - 0.5).sum()
}

/// Returns the values of a hypothetical robot.toml: zero, or the key's smallest possible value if it is larger.
fn default_file_values() -> Values {
    std::array::from_fn(|i| KEYS[i].min_value.max(0.0))
}

/// Simulates a camera's measurement of travels, with a mounting error of the card but without random errors.
fn measure_exactly(travels: Vec<Travel>, card: CardPose) -> Vec<MeasuredMovement> {
    let to_movement = |travel| MeasuredMovement {
        gait: "walk".to_owned(),
        pace: 1.0,
        mean: card.convert_travel(travel),
        error: [STANDARD_ERROR; 3],
    };
    travels.into_iter().map(to_movement).collect()
}

/// Simulates a camera's measurement of a robot, with a mounting error of the card and with random errors.
fn measure_robot(values: &Values, card: CardPose, rng: &mut Rng) -> Vec<MeasuredMovement> {
    let mut movements = measure_exactly(compute_travels(values), card);
    for mean in movements.iter_mut().flat_map(|movement| &mut movement.mean) {
        *mean += STANDARD_ERROR.hypot(MODEL_ERROR) * random_normal(rng);
    }
    movements
}

fn random_card(rng: &mut Rng) -> CardPose {
    let errors = CardPose::PRIOR_ERRORS.map(|prior_error| prior_error * random_normal(rng));
    errors.into()
}

/// Identifies the keys with a model, from the values of the hypothetical robot.toml.
fn identify_with(
    model: &dyn Fn(&Values) -> Vec<Travel>,
    movements: &[MeasuredMovement],
) -> Identification {
    identify_with_model(movements, default_file_values(), model).expect("the fit converges")
}

#[test]
fn about_95_percent_of_altered_keys_are_found_within_two_standard_errors_and_few_others_change() {
    let (mut altered_count, mut hit_count) = (0, 0);
    let (mut unaltered_count, mut false_change_count) = (0, 0);
    let mut explained_count = 0;
    const ROBOT_COUNT: u64 = 300;
    for seed in 0..ROBOT_COUNT {
        let mut rng = Rng::with_seed(seed);
        let mut true_values = default_file_values();
        let is_altered: [bool; KEY_COUNT] = std::array::from_fn(|_| rng.bool());
        for i in (0..KEY_COUNT).filter(|&i| is_altered[i]) {
            let deviate = match i {
                PLAY_INDEX => rng.f64(),
                _ => random_normal(&mut rng).max(-1.5).abs(),
            };
            true_values[i] += KEYS[i].prior_error() * deviate;
        }
        let card = random_card(&mut rng);
        let movements = measure_robot(&true_values, card, &mut rng);
        let result = identify_with(&compute_travels, &movements);
        explained_count += i32::from(result.goodness.is_explained);
        for i in 0..KEY_COUNT {
            let key = &result.keys[i];
            assert!(key.verdict != Verdict::Undetermined, "seed {seed}: {key:?}");
            if is_altered[i] {
                altered_count += 1;
                hit_count += i32::from((key.new_value - true_values[i]).abs() <= 2.0 * key.error);
            } else {
                unaltered_count += 1;
                false_change_count += i32::from(key.verdict == Verdict::Changed);
            }
            let distance = (key.new_value - key.file_value).abs();
            assert_eq!(key.verdict == Verdict::Changed, distance > 0.0);
            assert!(distance == 0.0 || distance >= 2.0 * key.error);
        }
    }
    let hit_fraction = f64::from(hit_count) / f64::from(altered_count);
    assert!(
        (0.93..=0.985).contains(&hit_fraction),
        "{hit_count} of {altered_count} altered keys are within two standard errors"
    );
    assert!(
        f64::from(false_change_count) < 0.05 * f64::from(unaltered_count),
        "{false_change_count} of {unaltered_count} unaltered keys got a new value"
    );
    assert!(
        f64::from(explained_count) > 0.97 * ROBOT_COUNT as f64,
        "{explained_count} of {ROBOT_COUNT} robots are explained"
    );
}

#[test]
fn at_a_kink_of_the_model_the_error_follows_the_flatter_side() {
    /// Twist below which the foot carries no load and an even shorter foot has no further effect, mm.
    const KINK: f64 = -0.5;
    let kinked_model = |values: &Values| {
        let mut values = *values;
        values[TWIST_INDEX] = values[TWIST_INDEX].max(KINK);
        compute_travels(&values)
    };
    let mut true_values = default_file_values();
    true_values[TWIST_INDEX] = KINK;
    let movements = measure_exactly(compute_travels(&true_values), CardPose::default());
    let kinked_error = identify_with(&kinked_model, &movements).keys[TWIST_INDEX].error;
    let smooth_error = identify_with(&compute_travels, &movements).keys[TWIST_INDEX].error;
    assert!(
        kinked_error > 1.2 * smooth_error,
        "kinked model: {kinked_error}, smooth model: {smooth_error}"
    );
}

#[test]
fn a_key_without_effect_keeps_its_value_and_is_undetermined() {
    let model_without_key_5 = |values: &Values| {
        let mut values = *values;
        values[5] = 0.7;
        compute_travels(&values)
    };
    let mut true_values = default_file_values();
    (true_values[0], true_values[5]) = (8.0, 1.1);
    let card = random_card(&mut Rng::with_seed(1));
    let movements = measure_exactly(model_without_key_5(&true_values), card);
    let result = identify_with(&model_without_key_5, &movements);
    let mut expected = vec![Verdict::Unchanged; KEY_COUNT];
    (expected[0], expected[5]) = (Verdict::Changed, Verdict::Undetermined);
    let verdicts: Vec<Verdict> = result.keys.iter().map(|key| key.verdict).collect();
    assert_eq!(verdicts, expected);
    let key_5 = &result.keys[5];
    assert_eq!(key_5.new_value, key_5.file_value);
    assert!(key_5.error > 0.9 * KEYS[5].prior_error(), "{key_5:?}");
}

#[test]
fn two_keys_with_the_same_effect_are_reported_as_correlated() {
    let equal_effect_model = |values: &Values| {
        let mut values = *values;
        let sum = values[2] + values[3];
        values[2] = sum + 0.02 * values[3];
        values[3] = 0.0;
        compute_travels(&values)
    };
    let mut rng = Rng::with_seed(1);
    let movements = measure_robot(&default_file_values(), CardPose::default(), &mut rng);
    let result = identify_with(&equal_effect_model, &movements);
    let [(a, b, correlation)] = result.correlated_pairs[..] else {
        panic!("{:?}", result.correlated_pairs);
    };
    let expected = [&KEYS[2], &KEYS[3]];
    assert_eq!([a, b].map(Key::full_name), expected.map(Key::full_name));
    assert!(correlation < -0.9, "correlation {correlation}");
}

#[test]
fn a_movement_that_no_key_explains_is_reported_and_enlarges_the_errors() {
    let mut rng = Rng::with_seed(2);
    let mut movements = measure_robot(&default_file_values(), CardPose::default(), &mut rng);
    let good_result = identify_with(&compute_travels, &movements);
    assert!(good_result.goodness.is_explained && good_result.goodness.error_factor == 1.0);
    movements[3].mean[0] += 4.0;
    let bad_result = identify_with(&compute_travels, &movements);
    let goodness = bad_result.goodness;
    let is_detected = !goodness.is_explained && goodness.error_factor > 5.0;
    assert!(is_detected, "{goodness:?}");
    let (movement, component, _) = goodness.largest_residual;
    assert_eq!((movement, component), (3, 0));
    for (bad_key, good_key) in bad_result.keys.iter().zip(&good_result.keys) {
        assert!(
            bad_key.error > 4.0 * good_key.error,
            "bad fit: {bad_key:?}, good fit: {good_key:?}"
        );
    }
}

#[test]
fn a_negative_play_is_impossible_and_keeps_the_file_value() {
    let mut rng = Rng::with_seed(3);
    let mut movements = measure_robot(&default_file_values(), CardPose::default(), &mut rng);
    let compute_with_play = |play: f64| {
        let mut values = default_file_values();
        values[PLAY_INDEX] = play;
        compute_travels(&values)
    };
    // The movements are shifted opposite to the effect of 0.5 deg of play, so that the best fit is at -0.5 deg.
    let travel_pairs = compute_with_play(0.0)
        .into_iter()
        .zip(compute_with_play(0.5));
    for (movement, (base_travel, play_travel)) in movements.iter_mut().zip(travel_pairs) {
        movement.mean[0] -= play_travel.forward - base_travel.forward;
        movement.mean[1] -= play_travel.left - base_travel.left;
        movement.mean[2] -= play_travel.turn - base_travel.turn;
    }
    let result = identify_with(&compute_travels, &movements);
    let play_key = &result.keys[PLAY_INDEX];
    assert_eq!(play_key.new_value, 0.0);
    assert!(
        matches!(play_key.verdict, Verdict::Impossible(value) if (value + 0.5).abs() < 0.1),
        "{play_key:?}"
    );
}
