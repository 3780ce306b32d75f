//! `--long-foot`: gives feet of the model a length error.

use std::str::FromStr;

use lizard_robot::servo::LEGS;

use crate::Failure;

/// Largest length error of a foot, mm; a larger one exceeds its screw or its leaf.
const MAX_FOOT_ERROR_MM: f64 = 5.0;

/// A leg whose foot has the wrong length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LongFoot {
    leg: usize,
    mm: f64,
}

/// The reason why `--long-foot` is refused.
#[derive(Debug, thiserror::Error)]
pub(super) enum LongFootError {
    #[error("write the leg and by how many mm its foot is too long, such as LF=0.6")]
    Form,
    #[error("there is no leg `{0}`; the legs are LF, RF, RH and LH")]
    Leg(String),
    #[error("`{0}` is not a number of mm")]
    Number(String),
    #[error("a foot may be off by at most {MAX_FOOT_ERROR_MM} mm either way, and {0} mm is more")]
    Far(f64),
}

impl FromStr for LongFoot {
    type Err = LongFootError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (leg, mm) = text.split_once('=').ok_or(LongFootError::Form)?;
        let index = LEGS.iter().position(|name| name.eq_ignore_ascii_case(leg));
        let leg = index.ok_or_else(|| LongFootError::Leg(leg.to_owned()))?;
        let number = mm.parse().ok().filter(|mm: &f64| mm.is_finite());
        let mm = number.ok_or_else(|| LongFootError::Number(mm.to_owned()))?;
        match mm.abs() <= MAX_FOOT_ERROR_MM {
            true => Ok(Self { leg, mm }),
            false => Err(LongFootError::Far(mm)),
        }
    }
}

/// The length error of each foot, mm, in servo order; 0 for a foot that is not given.
///
/// # Errors
/// Fails if a foot is given twice.
pub(super) fn length_errors(long_feet: &[LongFoot]) -> Result<[f64; 4], Failure> {
    let mut errors = [None; 4];
    for LongFoot { leg, mm } in long_feet {
        if errors[*leg].replace(*mm).is_some() {
            let leg = LEGS[*leg];
            return Err(Failure::Input(format!("--long-foot {leg} is given twice")));
        }
    }
    Ok(errors.map(Option::unwrap_or_default))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_foot_is_a_leg_and_its_mm() {
        let parse = |text: &str| text.parse::<LongFoot>().expect(text);
        assert_eq!(parse("LF=0.6"), LongFoot { leg: 0, mm: 0.6 });
        assert_eq!(parse("rh=-5"), LongFoot { leg: 2, mm: -5.0 });
    }

    #[test]
    fn an_invalid_long_foot_is_refused_with_a_message() {
        let refusal_of = |text: &str| text.parse::<LongFoot>().expect_err(text).to_string();
        assert_eq!(
            refusal_of("0.6"),
            "write the leg and by how many mm its foot is too long, such as LF=0.6"
        );
        assert_eq!(
            refusal_of("FL=1"),
            "there is no leg `FL`; the legs are LF, RF, RH and LH"
        );
        assert_eq!(refusal_of("LF="), "`` is not a number of mm");
        assert_eq!(refusal_of("LF=nan"), "`nan` is not a number of mm");
        assert_eq!(
            refusal_of("LF=6"),
            "a foot may be off by at most 5 mm either way, and 6 mm is more"
        );
    }

    #[test]
    fn a_foot_has_one_length() {
        let long_foot = |leg, mm| LongFoot { leg, mm };
        let errors = length_errors(&[long_foot(3, 0.5), long_foot(1, -1.0)]).expect("two feet");
        assert_eq!(errors, [0.0, -1.0, 0.0, 0.5]);
        let refusal = length_errors(&[long_foot(0, 0.0), long_foot(0, 1.0)]).expect_err("one foot");
        assert_eq!(refusal.to_string(), "--long-foot LF is given twice");
    }
}
