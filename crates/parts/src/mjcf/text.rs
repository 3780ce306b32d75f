//! Numbers and names as the file has them.

/// Metres in a mm, kg in a g.
pub(super) const MILLI: f64 = 1e-3;

/// mm as the file has them.
pub(super) fn metres(at: [f64; 3]) -> String {
    at.map(|part| round(part * MILLI).to_string()).join(" ")
}

/// To a billionth, without a minus before 0.
pub(super) fn round(value: f64) -> f64 {
    (value * 1e9).round() / 1e9 + 0.0
}

/// The writer of XML escapes quotes alone.
pub(super) fn escaped(value: &str) -> String {
    value.replace('&', "&amp;").replace('<', "&lt;")
}
