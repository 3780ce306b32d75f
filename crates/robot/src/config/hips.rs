//! The hips: the centres of the circles on which the feet move.
//!
//! A foot is fixed to its coupler, which moves without turning. The foot's circle is therefore the crank joint's
//! circle, shifted: the offset from the driven pivot to the hip equals the offset from the crank joint to the foot. In
//! each direction, any two of pivot, foot and hip determine the third. robot.toml may state the third only if it agrees
//! with the other two.

use lizard_contact::LegGeometry;
use lizard_kinematics::{End, Lizard, Vector};

use crate::config::legs::chassis_offset;
use crate::config::parts::Parts;
use crate::file::{Error, ReadResult, Table};

/// The default position of the foot on its coupler, mm, as in [`Parts::foot`]. With the pivots of the paper's robot,
/// the hips are 55 mm forward and 35 mm to the side.
const DEFAULT_FOOT: [f64; 2] = [-3.5, 2.5];
/// Range of the hips' forward distance from the chassis centre, mm.
const HIP_FORWARD_RANGE: (f64, f64) = (1.0, 500.0);
/// Range of the hips' sideways distance from the chassis centre, mm.
const HIP_SIDE_RANGE: (f64, f64) = (0.0, 500.0);
/// Largest difference between two lengths that count as equal, mm.
const LENGTH_TOLERANCE_MM: f64 = 0.005;

/// The key of the hips' forward distance from the chassis centre.
const FORWARD_KEY: &str = "hip_forward";
/// The key of the hips' sideways distance from the chassis centre.
const SIDE_KEY: &str = "hip_side";

/// The hips' distances from the chassis centre in `[leg]`, mm. A distance is `None` if it follows from pivot and foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hips {
    forward: Option<f64>,
    side: Option<f64>,
}

impl Hips {
    /// Reads the hips from `[leg]`.
    pub fn read(leg: &Table) -> ReadResult<Self> {
        let read_mm = |name, range| match leg.has_key(name) {
            true => leg.number(name, range, "mm").map(Some),
            false => Ok(None),
        };
        Ok(Self {
            forward: read_mm(FORWARD_KEY, HIP_FORWARD_RANGE)?,
            side: read_mm(SIDE_KEY, HIP_SIDE_RANGE)?,
        })
    }

    /// Computes the geometry of the legs; `mount_angle` is the legs' sweep at neutral, deg. Rejects hips that
    /// contradict pivot and foot, or that are out of range.
    pub fn compute_leg_geometry(
        &self,
        lizard: &Lizard,
        parts: &Parts,
        mount_angle: f64,
    ) -> ReadResult<LegGeometry> {
        // Left and right are mirror images; head and tail may have different widths.
        let shafts = lizard.shafts();
        let [head_hip, tail_hip] = End::ALL.map(|end| {
            let [_, right_servo] = end.servos();
            let foot = parts.foot.unwrap_or(DEFAULT_FOOT);
            let hip = shafts[right_servo]
                + chassis_offset(right_servo, parts.pivot)
                + chassis_offset(right_servo, foot);
            end.mirror(hip)
        });
        let resolve_distance = |stated_mm: Option<f64>, computed_mm: f64, key: &str, (min, max)| {
            let problem = match stated_mm {
                Some(mm)
                    if parts.foot.is_none() || (mm - computed_mm).abs() < LENGTH_TOLERANCE_MM =>
                {
                    return Ok(mm);
                }
                Some(mm) => format!(
                    "is {mm} mm, but parts.pivot and parts.foot put it at {computed_mm:.2} mm; leave out this key or parts.foot"
                ),
                None if (min..=max).contains(&computed_mm) => return Ok(computed_mm),
                None => format!(
                    "is left out; links, parts.pivot and parts.foot put it at {computed_mm:.2} mm, but it must be between {min} and {max} mm"
                ),
            };
            Err(Error::new(format!("leg.{key}"), problem))
        };
        let resolve_side =
            |hip: Vector| resolve_distance(self.side, hip.x, SIDE_KEY, HIP_SIDE_RANGE);
        Ok(LegGeometry {
            hip_forward: resolve_distance(
                self.forward,
                head_hip.y,
                FORWARD_KEY,
                HIP_FORWARD_RANGE,
            )?,
            hip_side: [resolve_side(head_hip)?, resolve_side(tail_hip)?],
            mount_angle,
            reach: lizard.leg.crank,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Robot;
    use crate::testing::valid_robot_with;

    /// The header of the table `[leg]`.
    const LEG_HEADER: &str = "[leg] ";

    /// Reads the paper's robot with these lines in `[leg]` and in `[parts]`.
    fn robot(hip_lines: &str, part_lines: &str) -> Robot {
        let leg = format!("[parts]\n{part_lines}\n[leg]\n{hip_lines}\n#");
        valid_robot_with("paper", &[(LEG_HEADER, &leg)])
    }

    /// Returns the hips' distances in the paper's robot with these lines, mm: forward, and sideways at head and tail.
    fn read_hips(hip_lines: &str, part_lines: &str) -> (f64, [f64; 2]) {
        let legs = robot(hip_lines, part_lines).ground().legs;
        (legs.hip_forward, legs.hip_side)
    }

    #[test]
    fn the_hips_follow_from_the_pivots_and_the_foot() {
        // Compared exactly: no result of the paper's robot may depend on the last digit.
        assert_eq!(read_hips("", ""), (55.0, [35.0; 2]));
        assert_eq!(read_hips("", "pivot = [30.0, 8.0]"), (57.0, [36.5; 2]));
        assert_eq!(read_hips("", "foot = [1.5, -0.5]"), (58.0, [40.0; 2]));
        let hip_lines = "hip_forward = 55.0\nhip_side = 35.0";
        let hips = read_hips(hip_lines, "foot = [-3.5, 2.5]");
        assert_eq!(hips, (55.0, [35.0; 2]));
        let wide_robot = valid_robot_with("paper", &[("l0 = 20.0", "l0 = 24.0")]);
        assert_eq!(wide_robot.ground().legs.hip_side, [37.0, 35.0]);
        assert_eq!(wide_robot.ground().legs.hips()[3], [-55.0, 35.0]);
    }

    #[test]
    fn the_foot_follows_from_hips_that_are_given() {
        assert_eq!(read_hips("hip_side = 36.0", ""), (55.0, [36.0; 2]));
        let foot_offset = |hip_lines: &str| {
            let robot = robot(hip_lines, "");
            let leg = robot.legs()[1];
            leg.coupler_direction * leg.foot.x + leg.coupler_direction.rotated_left() * leg.foot.y
        };
        let shifted_foot = foot_offset("hip_forward = 57.0\nhip_side = 36.0");
        let error = shifted_foot - Vector::new(36.0 - 38.5, 57.0 - 57.5);
        assert!(error.length() < 1e-9, "{error:?}");
        let same_foot = foot_offset("hip_forward = 55.0\nhip_side = 35.0");
        assert_eq!(same_foot, foot_offset(""));
    }
}
