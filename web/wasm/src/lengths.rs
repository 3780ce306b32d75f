//! Changed lengths of a robot and, if they are refused, valid alternatives.
//!
//! There are two alternatives, each checked as a complete robot: the accepted lengths nearest to the
//! wanted ones, on the line from the lengths in the text; and the wanted lengths without the gait that
//! forbids them.

use lizard_robot::Robot;
use lizard_robot::edit::{NoSuchKey, with_number, without_gait};
use serde::Serialize;
use tsify::Tsify;

use crate::description::Description;
use crate::refused::Refused;

/// Step of the offered lengths, mm, or deg for an angle.
const STEP: f64 = 0.5;

/// Lengths, mm or deg, by their keys, such as `links.l2`.
type Wanted = [(String, f64)];

/// The text of a robot.toml with other lengths, its refusal, and valid alternatives.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Lengths {
    /// The text with the wanted lengths.
    text: String,
    /// The refusal of `text`; `None` if it is a valid robot.
    refusal: Option<Refused>,
    /// The nearest lengths that are accepted; `None` if none are needed, searched or found.
    nearest: Option<NearestLengths>,
    /// The wanted lengths without the gait that forbids them; `None` if not needed or not searched, or if the text
    /// without the gait is refused, too.
    without: Option<WithoutGait>,
}

/// The nearest lengths that are accepted.
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
    /// Name of the gait that is left out.
    gait: String,
    /// The text without this gait.
    text: String,
}

impl Lengths {
    /// Sets lengths in the text of a robot.toml; if `searches`, also looks for valid alternatives.
    #[must_use]
    pub fn of(text: &str, wanted: &Wanted, searches: bool) -> Self {
        let changed_text = match with_lengths(text, wanted) {
            Ok(text) => text,
            Err(missing) => return Self::of_refusal(text.to_string(), missing.into()),
        };
        let Err(error) = Robot::parse(&changed_text) else {
            return Self {
                text: changed_text,
                refusal: None,
                nearest: None,
                without: None,
            };
        };
        let gait = error.key.strip_prefix("gait.");
        let gait = gait.and_then(|rest| rest.split('.').next());
        let gait = gait.filter(|_| searches).map(str::to_string);
        Self {
            nearest: searches.then(|| find_nearest(text, wanted)).flatten(),
            without: gait.and_then(|gait| {
                let text = without_gait(&changed_text, &gait);
                Robot::parse(&text).ok()?;
                Some(WithoutGait { gait, text })
            }),
            ..Self::of_refusal(changed_text, error.into())
        }
    }

    fn of_refusal(text: String, refusal: Refused) -> Self {
        Self {
            text,
            refusal: Some(refusal),
            nearest: None,
            without: None,
        }
    }
}

/// Returns the least and the greatest value, mm or deg, with which the lengths of all `keys` are accepted.
/// The search covers half to twice the present value; for an angle, 45 deg to either side. `None`
/// if the text is no valid robot or has no such length.
#[must_use]
pub fn range(text: &str, keys: &[String]) -> Option<(f64, f64)> {
    let lengths = Description::of(&Robot::parse(text).ok()?).lengths;
    let length = lengths
        .iter()
        .find(|length| Some(&length.key) == keys.first())?;
    let (smallest, largest) = match length.unit {
        "deg" => (length.value - 45.0, length.value + 45.0),
        _ => (0.5 * length.value, 2.0 * length.value),
    };
    let accepted_near = |value: f64| {
        let value = (value / STEP).round() * STEP;
        let wanted: Vec<_> = keys.iter().map(|key| (key.clone(), value)).collect();
        let result = Lengths::of(text, &wanted, true);
        let nearest = result
            .nearest
            .and_then(|nearest| nearest.lengths.first().cloned());
        match (result.refusal, nearest) {
            (None, _) => value,
            (Some(_), Some((_, nearest))) => nearest,
            (Some(_), None) => length.value,
        }
    };
    Some((accepted_near(smallest), accepted_near(largest)))
}

fn with_lengths(text: &str, wanted: &Wanted) -> Result<String, NoSuchKey> {
    let mut text = text.to_string();
    for (key, value) in wanted {
        text = with_number(&text, key, *value)?;
    }
    Ok(text)
}

/// Bisects from the lengths in the text to the wanted ones, down to a step; `None` if no lengths in between are
/// accepted.
fn find_nearest(text: &str, wanted: &Wanted) -> Option<NearestLengths> {
    let own_lengths = Description::of(&Robot::parse(text).ok()?).lengths;
    let changes: Vec<(&String, f64, f64)> = wanted
        .iter()
        .map(|(key, to)| {
            let own_length = own_lengths.iter().find(|length| length.key == *key);
            (key, own_length.map_or(*to, |length| length.value), *to)
        })
        .collect();
    let distances = changes.iter().map(|(_, from, to)| (to - from).abs());
    let (mut accepted_share, mut refused_share) = (0.0, 1.0);
    let mut nearest = None;
    let share_step = STEP / distances.fold(0.0, f64::max);
    while refused_share - accepted_share > share_step {
        let share = f64::midpoint(accepted_share, refused_share);
        let length_at = |(key, from, to): &(&String, f64, f64)| {
            let value = ((from + (to - from) * share) / STEP).round() * STEP;
            ((*key).clone(), value)
        };
        let lengths: Vec<_> = changes.iter().map(length_at).collect();
        let text = with_lengths(text, &lengths).ok()?;
        if Robot::parse(&text).is_ok() {
            accepted_share = share;
            nearest = Some(NearestLengths { lengths, text });
        } else {
            refused_share = share;
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: &str = include_str!("../../../robots/paper.toml");

    /// Returns a length for a leg's crank and for the follower, which must equal it.
    fn crank_lengths(mm: f64) -> [(String, f64); 2] {
        ["leg.crank", "leg.follower"].map(|key| (key.to_string(), mm))
    }

    #[test]
    fn lengths_that_are_accepted_need_nothing_else() {
        let result = Lengths::of(PAPER, &crank_lengths(41.0), true);
        assert_eq!(
            (result.refusal, result.nearest, result.without),
            (None, None, None)
        );
        assert!(result.text.contains("crank = 41.0") && result.text.contains("follower = 41.0"));
        let missing = Lengths::of(PAPER, &[("links.l99".to_string(), 1.0)], true);
        assert_eq!(missing.text, PAPER);
        let refusal = missing.refusal.expect("no such length");
        assert_eq!(refusal.refused, "robot.toml has no number links.l99");
    }

    #[test]
    fn a_length_is_refused_with_the_nearest_half_millimetre_that_is_a_robot() {
        let slider_lengths = |mm| ["links.l12", "links.l17"].map(|key| (key.to_string(), mm));
        let result = Lengths::of(PAPER, &slider_lengths(80.0), true);
        let meaning = result.refusal.expect("too long").meaning;
        assert_eq!(
            meaning.as_deref(),
            Some("in the neutral pose the left slider would run into its end")
        );
        assert_eq!(result.without, None, "no gait is in the way");
        let NearestLengths { lengths, text } = result.nearest.expect("shorter ones");
        let [(_, left_half), (_, right_half)] = lengths[..] else {
            panic!("two lengths")
        };
        assert_eq!(left_half, right_half);
        assert!(45.0 < left_half && left_half < 80.0, "{left_half}");
        assert!(Robot::parse(&text).is_ok());
        let longer = Lengths::of(PAPER, &slider_lengths(left_half + STEP), false);
        assert!(longer.refusal.is_some(), "{left_half} is not the longest");
        assert_eq!(longer.nearest, None, "not asked for");
    }

    #[test]
    fn the_range_of_a_length_ends_where_half_a_millimetre_more_is_refused() {
        let keys: Vec<_> = crank_lengths(0.0).into_iter().map(|(key, _)| key).collect();
        let (smallest, largest) = range(PAPER, &keys).expect("a crank");
        assert!(smallest < 45.0 && 45.0 < largest, "{smallest} to {largest}");
        let is_refused = |mm: f64| {
            Lengths::of(PAPER, &crank_lengths(mm), false)
                .refusal
                .is_some()
        };
        assert!(!is_refused(smallest) && !is_refused(largest));
        assert!(
            smallest == 22.5 || is_refused(smallest - STEP),
            "{smallest}"
        );
        assert!(largest == 90.0 || is_refused(largest + STEP), "{largest}");
        assert_eq!(range(PAPER, &["links.l99".to_string()]), None);
    }

    #[test]
    fn a_gait_that_alone_forbids_a_length_may_be_given_up() {
        let coupler_lengths = ["links.l2", "links.l3"].map(|key| (key.to_string(), 60.0));
        let result = Lengths::of(PAPER, &coupler_lengths, true);
        let meaning = result.refusal.expect("too long").meaning;
        let expected = "in \"look\" the left front leg would lock";
        assert_eq!(meaning.as_deref(), Some(expected));
        let WithoutGait { gait, text } = result.without.expect("look alone");
        assert_eq!(gait, "look");
        let robot = Robot::parse(&text).expect("a robot");
        assert_eq!(robot.gait("look"), None);
        assert_eq!(robot.lizard().links.l2, 60.0);
    }
}
