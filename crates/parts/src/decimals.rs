//! Serializers that round numbers to multiples of 1/`DENOMINATOR`: 10 gives tenths, 1000 thousandths.

use serde::{Serialize, Serializer};

type SerializeResult<S> = Result<<S as Serializer>::Ok, <S as Serializer>::Error>;

/// Rounds a number, and turns -0 into 0.
fn round<const DENOMINATOR: u32>(value: f64) -> f64 {
    let denominator = f64::from(DENOMINATOR);
    (denominator * value).round() / denominator + 0.0
}

/// Serializes a rounded number.
pub(crate) fn rounded<const DENOMINATOR: u32, S: Serializer>(
    value: &f64,
    out: S,
) -> SerializeResult<S> {
    round::<DENOMINATOR>(*value).serialize(out)
}

/// Serializes an optional rounded number.
pub(crate) fn rounded_option<const DENOMINATOR: u32, S: Serializer>(
    value: &Option<f64>,
    out: S,
) -> SerializeResult<S> {
    value.map(round::<DENOMINATOR>).serialize(out)
}

/// Serializes a list of rounded numbers.
pub(crate) fn rounded_list<const DENOMINATOR: u32, S: Serializer>(
    values: &[f64],
    out: S,
) -> SerializeResult<S> {
    out.collect_seq(values.iter().map(|value| round::<DENOMINATOR>(*value)))
}
