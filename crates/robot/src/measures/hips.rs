//! The hips: the centres of the circles on which the feet move.
//!
//! A foot is fixed to its coupler, which moves without turning. So the foot's circle is
//! the circle of the crank's joint, shifted: the offset from the driven pivot to the hip
//! equals the offset from that joint to the foot. In each direction, two of pivot, foot and
//! hip determine the third. robot.toml may state the third only if it agrees.

use lizard_contact::Feet;
use lizard_kinematics::{End, Lizard, Vector};

use crate::file::{Checked, Fault, Section};
use crate::measures::legs::outward;
use crate::measures::parts::Parts;

/// The default position of the foot on its coupler, mm, as in [`Parts::foot`]: with the pivots of
/// the paper's robot, the hips are 55 mm ahead and 35 mm to the side.
const FOOT: [f64; 2] = [-3.5, 2.5];
/// Range of the hips' distance ahead, mm.
const HIP_FORWARD_RANGE: (f64, f64) = (1.0, 500.0);
/// Range of the hips' distance to the side, mm.
const HIP_SIDE_RANGE: (f64, f64) = (0.0, 500.0);
/// Largest difference of two lengths that count as equal, mm.
const SAME_LENGTH_MM: f64 = 0.005;

const AHEAD_KEY: &str = "hip_forward";
const SIDE_KEY: &str = "hip_side";

/// The distances of the hips as `[leg]` gives them, mm; `None` if a distance follows from pivot and foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hips {
    ahead: Option<f64>,
    side: Option<f64>,
}

impl Hips {
    /// Reads the hips from `[leg]`.
    pub fn read(leg: &Section) -> Checked<Self> {
        let read_mm = |name, (min, max)| match leg.has(name) {
            true => leg.number(name, min, max, "mm").map(Some),
            false => Ok(None),
        };
        Ok(Self {
            ahead: read_mm(AHEAD_KEY, HIP_FORWARD_RANGE)?,
            side: read_mm(SIDE_KEY, HIP_SIDE_RANGE)?,
        })
    }

    /// Places the feet. Refuses hips that contradict pivot and foot, or that are out of range.
    pub fn place_feet(&self, lizard: &Lizard, parts: &Parts, mount: f64) -> Checked<Feet> {
        // Left and right are mirror images; head and tail may have different widths.
        let shafts = lizard.shafts();
        let [head, tail] = End::ALL.map(|end| {
            let [_, right] = end.servos();
            let foot = parts.foot.unwrap_or(FOOT);
            let hip = shafts[right] + outward(right, parts.pivot) + outward(right, foot);
            end.mirror(hip)
        });
        let check_distance = |value: Option<f64>, computed_mm: f64, key: &str, (min, max)| {
            let problem = match value {
                Some(value)
                    if parts.foot.is_none() || (value - computed_mm).abs() < SAME_LENGTH_MM =>
                {
                    return Ok(value);
                }
                Some(value) => format!(
                    "is {value} mm, but parts.pivot and parts.foot put it at {computed_mm:.2} mm; leave one of them out"
                ),
                None if (min..=max).contains(&computed_mm) => return Ok(computed_mm),
                None => format!(
                    "is left out and follows from links, parts.pivot and parts.foot, which put it at {computed_mm:.2} mm; it must be within {min} to {max} mm"
                ),
            };
            Err(Fault::new(format!("leg.{key}"), problem))
        };
        let side_of = |end: Vector| check_distance(self.side, end.x, SIDE_KEY, HIP_SIDE_RANGE);
        Ok(Feet {
            hip_forward: check_distance(self.ahead, head.y, AHEAD_KEY, HIP_FORWARD_RANGE)?,
            hip_side: [side_of(head)?, side_of(tail)?],
            mount,
            reach: lizard.leg.crank,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Robot;
    use crate::testing::with;

    const LEG: &str = "[leg] ";

    /// The paper's robot with these lines in `[leg]` and in `[parts]`.
    fn robot(hip_lines: &str, part_lines: &str) -> Result<Robot, String> {
        let leg = format!("[parts]\n{part_lines}\n[leg]\n{hip_lines}\n#");
        with("paper", &[(LEG, &leg)]).map_err(|error| error.to_string())
    }

    /// The distances of the paper's hips with these lines: ahead, and to the side at head and tail.
    fn hips_of(hip_lines: &str, part_lines: &str) -> (f64, [f64; 2]) {
        let feet = robot(hip_lines, part_lines).expect("a robot").ground().feet;
        (feet.hip_forward, feet.hip_side)
    }

    #[test]
    fn hips_follow_from_the_pivots_and_the_foot() {
        // Compared exactly: no result of the paper's robot may depend on the last digit.
        assert_eq!(hips_of("", ""), (55.0, [35.0; 2]));
        assert_eq!(hips_of("", "pivot = [30.0, 8.0]"), (57.0, [36.5; 2]));
        assert_eq!(hips_of("", "foot = [1.5, -0.5]"), (58.0, [40.0; 2]));
        let hip_lines = "hip_forward = 55.0\nhip_side = 35.0";
        assert_eq!(hips_of(hip_lines, "foot = [-3.5, 2.5]"), (55.0, [35.0; 2]));
        let wide_robot = with("paper", &[("l0 = 20.0", "l0 = 24.0")]).expect("a robot");
        assert_eq!(wide_robot.ground().feet.hip_side, [37.0, 35.0]);
        assert_eq!(wide_robot.ground().feet.hips()[3], [-55.0, 35.0]);
    }

    #[test]
    fn the_foot_follows_from_hips_that_are_given() {
        assert_eq!(hips_of("hip_side = 36.0", ""), (55.0, [36.0; 2]));
        let foot_offset = |robot: &Robot| {
            let leg = robot.legs()[1];
            leg.coupler_direction * leg.foot.x + leg.coupler_direction.rotated_left() * leg.foot.y
        };
        let moved_robot = robot("hip_forward = 57.0\nhip_side = 36.0", "").expect("a robot");
        let error = foot_offset(&moved_robot) - Vector::new(36.0 - 38.5, 57.0 - 57.5);
        assert!(error.length() < 1e-9, "{error:?}");
        let same_robot = robot("hip_forward = 55.0\nhip_side = 35.0", "").expect("a robot");
        assert_eq!(
            foot_offset(&same_robot),
            foot_offset(&robot("", "").expect("a robot"))
        );
    }
}
