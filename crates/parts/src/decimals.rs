//! Serializers that round numbers to their significant decimals: `UNIT` is 10 for tenths, 1000 for thousandths.

use serde::{Serialize, Serializer};

type SerializeResult<S> = Result<<S as Serializer>::Ok, <S as Serializer>::Error>;

/// Rounds a number, and turns -0 into 0.
fn round_to_unit<const UNIT: u32>(value: f64) -> f64 {
    let unit = f64::from(UNIT);
    (unit * value).round() / unit + 0.0
}

/// Serializes a rounded number.
pub(crate) fn one<const UNIT: u32, S: Serializer>(value: &f64, out: S) -> SerializeResult<S> {
    round_to_unit::<UNIT>(*value).serialize(out)
}

/// Serializes an optional rounded number.
pub(crate) fn optional<const UNIT: u32, S: Serializer>(
    value: &Option<f64>,
    out: S,
) -> SerializeResult<S> {
    value.map(round_to_unit::<UNIT>).serialize(out)
}

/// Serializes a list of rounded numbers.
pub(crate) fn each<const UNIT: u32, S: Serializer>(values: &[f64], out: S) -> SerializeResult<S> {
    out.collect_seq(values.iter().map(|value| round_to_unit::<UNIT>(*value)))
}
