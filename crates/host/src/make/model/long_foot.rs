//! The option `--long-foot`, which sets length errors of the model's feet.

use std::str::FromStr;

use lizard_robot::servo::LEG_NAMES;

use crate::Failure;

/// Largest length error of a foot, mm. The foot's screw and leaf spring do not allow more.
const MAX_FOOT_ERROR_MM: f64 = 5.0;

/// The length error of a leg's foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FootOffset {
    /// The leg's index in servo order.
    leg: usize,
    /// Length error of the foot, mm; positive if the foot is too long.
    offset_mm: f64,
}

impl FromStr for FootOffset {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (leg_name, length_text) = text.split_once('=').ok_or(
            "expected LEG=MM, for example LF=0.6 for a left front foot that is 0.6 mm too long",
        )?;
        let leg = LEG_NAMES
            .iter()
            .position(|name| name.eq_ignore_ascii_case(leg_name))
            .ok_or_else(|| format!("unknown leg `{leg_name}`; allowed values: LF, RF, RH, LH"))?;
        let number = length_text.parse().ok().filter(|mm: &f64| mm.is_finite());
        let offset_mm = number.ok_or_else(|| format!("`{length_text}` is not a length in mm"))?;
        match offset_mm.abs() <= MAX_FOOT_ERROR_MM {
            true => Ok(Self { leg, offset_mm }),
            false => Err(format!(
                "the length error must be between -{MAX_FOOT_ERROR_MM} and {MAX_FOOT_ERROR_MM} mm, but is {offset_mm} mm"
            )),
        }
    }
}

/// Returns each foot's length error, mm, in servo order; 0 for a foot that is not given.
///
/// # Errors
/// Fails if a foot is given twice.
pub(super) fn list_in_servo_order(foot_offsets: &[FootOffset]) -> Result<[f64; 4], Failure> {
    let mut offsets_mm = [None; 4];
    for FootOffset { leg, offset_mm } in foot_offsets {
        if offsets_mm[*leg].replace(*offset_mm).is_some() {
            let leg = LEG_NAMES[*leg];
            return Err(Failure::Input(format!("--long-foot {leg} is given twice")));
        }
    }
    Ok(offsets_mm.map(Option::unwrap_or_default))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foot_offset_is_parsed_from_leg_and_mm() {
        for (text, leg, offset_mm) in [("LF=0.6", 0, 0.6), ("rh=-5", 2, -5.0)] {
            let foot_offset = text.parse::<FootOffset>().expect(text);
            assert_eq!(foot_offset, FootOffset { leg, offset_mm });
        }
    }

    #[test]
    fn an_invalid_foot_offset_is_refused_with_the_reason() {
        for (text, reason) in [
            (
                "0.6",
                "expected LEG=MM, for example LF=0.6 for a left front foot that is 0.6 mm too long",
            ),
            ("FL=1", "unknown leg `FL`; allowed values: LF, RF, RH, LH"),
            ("LF=", "`` is not a length in mm"),
            ("LF=nan", "`nan` is not a length in mm"),
            (
                "LF=6",
                "the length error must be between -5 and 5 mm, but is 6 mm",
            ),
        ] {
            assert_eq!(text.parse::<FootOffset>(), Err(reason.to_owned()));
        }
    }

    #[test]
    fn foot_offsets_are_in_servo_order_and_unique() {
        let foot_offset = |leg, offset_mm| FootOffset { leg, offset_mm };
        let offsets_mm = list_in_servo_order(&[foot_offset(3, 0.5), foot_offset(1, -1.0)])
            .expect("each foot is given once");
        assert_eq!(offsets_mm, [0.0, -1.0, 0.0, 0.5]);
        let refusal = list_in_servo_order(&[foot_offset(0, 0.0), foot_offset(0, 1.0)])
            .expect_err("a foot that is given twice must be refused");
        assert_eq!(refusal.to_string(), "--long-foot LF is given twice");
    }
}
