//! Limits on poses and on servo speed: `[limits]` in robot.toml.

use lizard_kinematics::Limits;

use crate::config::scale::MAX_LINK_LENGTH_MM;
use crate::config::servo::SpeedLimits;
use crate::file::{ReadResult, Table};

/// Range of a slider's stroke limits, mm.
const STROKE_RANGE_MM: (f64, f64) = (-MAX_LINK_LENGTH_MM, MAX_LINK_LENGTH_MM);
/// The lowest speed limit allowed, deg/s: a slower move would overflow the firmware's frame count.
const MIN_SPEED_DEG_S: f64 = 10.0;

/// Reads `[limits]`: the smallest margins, the range of the sliders' stroke, and the highest servo speeds.
pub(crate) fn read(root: &Table) -> ReadResult<(Limits, SpeedLimits)> {
    let table = root.table(
        "limits",
        &[
            "type2",
            "type1",
            "leg",
            "stroke_min",
            "stroke_max",
            "slew",
            "gait_slew",
        ],
    )?;
    let limits = Limits {
        // The core's coupler tables end at a margin of 0.1.
        type2: table.number("type2", (0.1, 0.95), "(a sine)")?,
        type1: table.number("type1", (0.0, 0.95), "(a sine)")?,
        leg: table.number("leg", (0.0, 0.95), "(a sine)")?,
        stroke_min: table.number("stroke_min", STROKE_RANGE_MM, "mm")?,
        stroke_max: table.number("stroke_max", STROKE_RANGE_MM, "mm")?,
    };
    let (min, max) = (limits.stroke_min, limits.stroke_max);
    table.require_less("stroke_min", min, "stroke_max", max)?;
    let read_speed = |name| table.number(name, (MIN_SPEED_DEG_S, 1000.0), "deg/s");
    let speed_limits = SpeedLimits {
        slew: read_speed("slew")?,
        gait_slew: read_speed("gait_slew")?,
    };
    Ok((limits, speed_limits))
}
