//! The option `--long-foot`, which gives feet of the model a length error.

use std::str::FromStr;

use lizard_robot::servo::LEG_NAMES;

use crate::Failure;

/// Largest length error of a foot, mm. The foot's screw and its leaf spring allow no larger one.
const MAX_FOOT_ERROR_MM: f64 = 5.0;

/// A leg whose foot has the wrong length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LongFoot {
    /// Index of the leg, in servo order.
    leg: usize,
    /// The excess of the foot's length, mm; negative for a short foot.
    error_mm: f64,
}

/// The reason why `--long-foot` is refused.
#[derive(Debug, thiserror::Error)]
pub(super) enum LongFootError {
    #[error("write the leg and by how many mm its foot is too long, such as LF=0.6")]
    InvalidForm,
    #[error("there is no leg `{0}`; the legs are LF, RF, RH and LH")]
    UnknownLeg(String),
    #[error("`{0}` is not a number of mm")]
    NotANumber(String),
    #[error("a foot may be off by at most {MAX_FOOT_ERROR_MM} mm either way, and {0} mm is more")]
    TooLarge(f64),
}

impl FromStr for LongFoot {
    type Err = LongFootError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (leg, mm) = text.split_once('=').ok_or(LongFootError::InvalidForm)?;
        let index = LEG_NAMES
            .iter()
            .position(|name| name.eq_ignore_ascii_case(leg));
        let leg = index.ok_or_else(|| LongFootError::UnknownLeg(leg.to_owned()))?;
        let number = mm.parse().ok().filter(|mm: &f64| mm.is_finite());
        let mm = number.ok_or_else(|| LongFootError::NotANumber(mm.to_owned()))?;
        match mm.abs() <= MAX_FOOT_ERROR_MM {
            true => Ok(Self { leg, error_mm: mm }),
            false => Err(LongFootError::TooLarge(mm)),
        }
    }
}

/// The length error of each foot, mm, in servo order; 0 for a foot that is not given.
///
/// # Errors
/// Fails if a foot is given twice.
pub(super) fn length_errors(long_feet: &[LongFoot]) -> Result<[f64; 4], Failure> {
    let mut errors = [None; 4];
    for LongFoot { leg, error_mm } in long_feet {
        if errors[*leg].replace(*error_mm).is_some() {
            let leg = LEG_NAMES[*leg];
            return Err(Failure::Input(format!("--long-foot {leg} is given twice")));
        }
    }
    Ok(errors.map(Option::unwrap_or_default))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_foot_is_parsed_from_its_leg_and_its_error_in_mm() {
        let parse = |text: &str| text.parse::<LongFoot>().expect(text);
        assert_eq!(
            parse("LF=0.6"),
            LongFoot {
                leg: 0,
                error_mm: 0.6
            }
        );
        assert_eq!(
            parse("rh=-5"),
            LongFoot {
                leg: 2,
                error_mm: -5.0
            }
        );
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
    fn length_errors_are_in_servo_order_and_a_foot_given_twice_is_refused() {
        let long_foot = |leg, mm| LongFoot { leg, error_mm: mm };
        let errors = length_errors(&[long_foot(3, 0.5), long_foot(1, -1.0)])
            .expect("each foot is given once");
        assert_eq!(errors, [0.0, -1.0, 0.0, 0.5]);
        let refusal = length_errors(&[long_foot(0, 0.0), long_foot(0, 1.0)])
            .expect_err("a foot that is given twice must be refused");
        assert_eq!(refusal.to_string(), "--long-foot LF is given twice");
    }
}
