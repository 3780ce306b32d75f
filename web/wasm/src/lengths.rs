//! Changed lengths of a robot and, if they are refused, valid alternatives.
//!
//! There are two alternatives, each checked as a complete robot: the accepted lengths nearest to the requested lengths,
//! between the lengths in the text and the requested lengths; and the requested lengths without the gait that forbids
//! them.

use lizard_robot::Robot;
use lizard_robot::edit::{KeyError, with_number, without_gait};
use serde::Serialize;
use tsify::Tsify;

use crate::description::Description;
use crate::refusal::Refusal;

/// Step of the offered lengths, mm, or deg for an angle.
const LENGTH_STEP: f64 = 0.5;

/// Lengths, mm or deg, by their keys, such as `links.l2`.
type RequestedLengths = [(String, f64)];

/// The text of a robot.toml with other lengths, its refusal, and valid alternatives.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct TriedLengths {
    /// The text with the requested lengths.
    text: String,
    /// The refusal of `text`; `None` if it is a valid robot.
    refusal: Option<Refusal>,
    /// The accepted lengths nearest to the requested lengths; `None` if not needed, not searched for, or not found.
    nearest: Option<NearestLengths>,
    /// The requested lengths without the gait that forbids them; `None` if not needed, not searched for, or if the text
    /// without the gait is refused, too.
    without: Option<WithoutGait>,
}

/// The accepted lengths that are nearest to the requested lengths.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct NearestLengths {
    /// The lengths by their keys.
    lengths: Vec<(String, f64)>,
    /// The text with these lengths.
    text: String,
}

/// A robot.toml without one of its gaits.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct WithoutGait {
    /// Name of the omitted gait.
    gait: String,
    /// The text without this gait.
    text: String,
}

impl TriedLengths {
    /// Sets lengths in the text of a robot.toml; if `searches`, also searches for valid alternatives.
    pub fn try_requested(text: &str, requested: &RequestedLengths, searches: bool) -> Self {
        let changed_text = match with_lengths(text, requested) {
            Ok(text) => text,
            Err(error) => return Self::without_alternatives(text.to_string(), Some(error.into())),
        };
        let Err(error) = Robot::parse(&changed_text) else {
            return Self::without_alternatives(changed_text, None);
        };
        let gait = error.key.strip_prefix("gait.");
        let gait = gait.and_then(|rest| rest.split('.').next());
        let gait = gait.filter(|_| searches).map(str::to_string);
        let nearest = searches.then(|| find_nearest_lengths(text, requested));
        Self {
            nearest: nearest.flatten(),
            without: gait.and_then(|gait| {
                let text = without_gait(&changed_text, &gait);
                Robot::parse(&text).ok()?;
                Some(WithoutGait { gait, text })
            }),
            ..Self::without_alternatives(changed_text, Some(error.into()))
        }
    }

    fn without_alternatives(text: String, refusal: Option<Refusal>) -> Self {
        Self {
            text,
            refusal,
            nearest: None,
            without: None,
        }
    }
}

/// Returns the smallest and the largest value, mm or deg, that the lengths of all `keys` may have together. The search
/// covers half to twice the current value; for an angle, 45 deg to either side. `None` if the text is not a valid robot
/// or has no such length.
pub fn find_accepted_range(text: &str, keys: &[String]) -> Option<(f64, f64)> {
    let lengths = Description::for_robot(&Robot::parse(text).ok()?).lengths;
    let mut candidates = lengths.iter();
    let length = candidates.find(|length| Some(&length.key) == keys.first())?;
    let (smallest, largest) = match length.unit {
        "deg" => (length.value - 45.0, length.value + 45.0),
        _ => (0.5 * length.value, 2.0 * length.value),
    };
    let find_nearest_accepted = |value: f64| {
        let value = (value / LENGTH_STEP).round() * LENGTH_STEP;
        let requested: Vec<_> = keys.iter().map(|key| (key.clone(), value)).collect();
        let result = TriedLengths::try_requested(text, &requested, true);
        match (result.refusal, result.nearest) {
            (None, _) => value,
            (Some(_), Some(nearest)) => nearest.lengths[0].1,
            (Some(_), None) => length.value,
        }
    };
    Some([smallest, largest].map(find_nearest_accepted).into())
}

/// Returns the text with the requested lengths.
fn with_lengths(text: &str, requested: &RequestedLengths) -> Result<String, KeyError> {
    let mut text = text.to_string();
    for (key, value) in requested {
        text = with_number(&text, key, *value)?;
    }
    Ok(text)
}

/// Bisects between the lengths in the text and the requested lengths, until the interval is at most [`LENGTH_STEP`];
/// `None` if no lengths in between are accepted.
fn find_nearest_lengths(text: &str, requested: &RequestedLengths) -> Option<NearestLengths> {
    let current_lengths = Description::for_robot(&Robot::parse(text).ok()?).lengths;
    let changes = requested.iter().map(|(key, to)| {
        let current_length = current_lengths.iter().find(|length| length.key == *key);
        (key, current_length.map_or(*to, |length| length.value), *to)
    });
    let changes: Vec<(&String, f64, f64)> = changes.collect();
    let distances = changes.iter().map(|(_, from, to)| (to - from).abs());
    let (mut accepted_fraction, mut refused_fraction) = (0.0, 1.0);
    let mut nearest = None;
    let fraction_step = LENGTH_STEP / distances.fold(0.0, f64::max);
    while refused_fraction - accepted_fraction > fraction_step {
        let fraction = f64::midpoint(accepted_fraction, refused_fraction);
        let length_at = |(key, from, to): &(&String, f64, f64)| {
            let value = ((from + (to - from) * fraction) / LENGTH_STEP).round() * LENGTH_STEP;
            ((*key).clone(), value)
        };
        let lengths: Vec<_> = changes.iter().map(length_at).collect();
        let text = with_lengths(text, &lengths).ok()?;
        if Robot::parse(&text).is_ok() {
            accepted_fraction = fraction;
            nearest = Some(NearestLengths { lengths, text });
        } else {
            refused_fraction = fraction;
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::PAPER_TOML;

    /// Returns a length for a leg's crank, and the same length for the follower, which must be equal.
    fn crank_lengths(mm: f64) -> [(String, f64); 2] {
        ["leg.crank", "leg.follower"].map(|key| (key.to_string(), mm))
    }

    #[test]
    fn accepted_lengths_have_no_alternatives_and_an_unknown_key_is_refused() {
        let result = TriedLengths::try_requested(PAPER_TOML, &crank_lengths(41.0), true);
        assert_eq!(result.refusal, None);
        assert_eq!((result.nearest, result.without), (None, None));
        assert!(result.text.contains("crank = 41.0") && result.text.contains("follower = 41.0"));
        let unknown_length = ("links.l99".to_string(), 1.0);
        let with_unknown_key = TriedLengths::try_requested(PAPER_TOML, &[unknown_length], true);
        assert_eq!(with_unknown_key.text, PAPER_TOML);
        let refusal = with_unknown_key.refusal.expect("an unknown key is refused");
        let expected =
            "robot.toml has no value links.l99 that can be changed; edit the file by hand";
        assert_eq!(refusal.reason, expected);
    }

    #[test]
    fn a_length_that_is_too_long_is_refused_with_the_longest_accepted_length() {
        let slider_lengths = |mm| ["links.l12", "links.l17"].map(|key| (key.to_string(), mm));
        let result = TriedLengths::try_requested(PAPER_TOML, &slider_lengths(80.0), true);
        let consequence = result.refusal.expect("the lengths are refused").consequence;
        assert_eq!(
            consequence.as_deref(),
            Some("in the neutral pose the left slider would hit its end stop")
        );
        assert_eq!(result.without, None, "no gait forbids these lengths");
        let nearest = result.nearest.expect("shorter lengths are accepted");
        let [(_, left_half), (_, right_half)] = nearest.lengths[..] else {
            panic!("there are two lengths")
        };
        assert_eq!(left_half, right_half);
        assert!(45.0 < left_half && left_half < 80.0, "{left_half}");
        assert!(Robot::parse(&nearest.text).is_ok());
        let longer_lengths = slider_lengths(left_half + LENGTH_STEP);
        let longer_lengths = TriedLengths::try_requested(PAPER_TOML, &longer_lengths, false);
        assert!(
            longer_lengths.refusal.is_some(),
            "{left_half} mm is not the longest accepted length"
        );
        assert_eq!(longer_lengths.nearest, None, "no search was requested");
    }

    #[test]
    fn half_a_millimetre_beyond_the_range_of_a_length_is_refused() {
        let keys = crank_lengths(0.0).map(|(key, _)| key);
        let range = find_accepted_range(PAPER_TOML, &keys);
        let (smallest, largest) = range.expect("the robot has cranks");
        assert!(smallest < 45.0 && 45.0 < largest, "{smallest} to {largest}");
        let is_refused = |mm: f64| {
            let result = TriedLengths::try_requested(PAPER_TOML, &crank_lengths(mm), false);
            result.refusal.is_some()
        };
        assert!(!is_refused(smallest) && !is_refused(largest));
        let is_smallest = smallest == 22.5 || is_refused(smallest - LENGTH_STEP);
        assert!(is_smallest, "{smallest}");
        let is_largest = largest == 90.0 || is_refused(largest + LENGTH_STEP);
        assert!(is_largest, "{largest}");
        let unknown_key = "links.l99".to_string();
        assert_eq!(find_accepted_range(PAPER_TOML, &[unknown_key]), None);
    }

    #[test]
    fn a_length_that_one_gait_forbids_is_offered_without_this_gait() {
        let coupler_lengths = ["links.l2", "links.l3"].map(|key| (key.to_string(), 60.0));
        let result = TriedLengths::try_requested(PAPER_TOML, &coupler_lengths, true);
        let consequence = result.refusal.expect("the lengths are refused").consequence;
        let expected_consequence = "in \"look\" the left front leg would lock";
        assert_eq!(consequence.as_deref(), Some(expected_consequence));
        let WithoutGait { gait, text } = result.without.expect("only `look` forbids the lengths");
        assert_eq!(gait, "look");
        let robot = Robot::parse(&text).expect("the robot without the gait is valid");
        assert_eq!(robot.gait("look"), None);
        assert_eq!(robot.lizard().links.l2, 60.0);
    }
}
