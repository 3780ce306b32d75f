//! A slider between the front and the rear arm of a side of the robot: the RRPRR loop.
//!
//! Each arm is rigidly joined to a crank, so the arm tips are known. The prismatic joint lies on
//! the line from the rear tip to the front one, with length d = l12 + l13 + s and direction phi.
//! Its only singularity is d = 0; in practice the stroke ends long before.
//!
//! The paper's theta10 + theta11 = 0 for the two halves of the slider is wrong if both angles are counter-clockwise:
//! the halves then have opposite directions, theta11 = theta10 + 180. The unknowns are phi = theta10 and s.

use crate::fault::Fault;
use crate::real::{Lanes, Real};
use crate::vector::Vector;

/// The dimensions of one side's loop (front arm, slider, rear arm, chassis), in a frame with its origin on the rear
/// shaft and the axes of the chassis frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slider {
    /// x of the front shaft relative to the rear one, mm: 0 if l0 and l5, the widths of head and tail, are equal,
    /// otherwise of either sign.
    pub front_offset: f64,
    /// y of the front shaft relative to the rear one, mm: l10, l15.
    pub base: f64,
    /// Length of the front arm, mm: l14, l19.
    pub front_arm: f64,
    /// Length of the rear arm, mm: l11, l16.
    pub rear_arm: f64,
    /// Distance between the arm tips at s = 0, mm: l12 + l13, l17 + l18.
    pub nominal_length: f64,
}

/// A pose of a side's loop. All points are relative to the rear shaft, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderPose<T = f64> {
    /// Tip of the rear arm.
    pub rear_tip: Vector<T>,
    /// Tip of the front arm.
    pub front_tip: Vector<T>,
    /// The front shaft.
    pub front_shaft: Vector<T>,
    /// Vector from the rear tip to the front one, mm.
    pub span: Vector<T>,
    /// d: length of the span, mm.
    pub d: T,
    /// s: travel of the slider from its nominal length, mm; positive if it is longer.
    pub s: T,
}

impl SliderPose {
    /// phi: direction of the slider from rear to front, (-180, 180] degrees; theta10 on the left, theta14 on the right.
    pub fn phi(&self) -> f64 {
        self.span.angle()
    }

    /// Vector of the front arm from its shaft to its tip, mm.
    pub fn front_arm(&self) -> Vector {
        self.front_tip - self.front_shaft
    }
}

impl Slider {
    /// The pose with arms at two angles in degrees (theta9 and theta12 on the left, theta13 and theta16 on the right).
    ///
    /// # Errors
    /// Returns [`Fault::Collapsed`] if the arm tips coincide, [`Fault::NotFinite`] if the input is not finite or
    /// overflows.
    pub fn forward(&self, theta_rear: f64, theta_front: f64) -> Result<SliderPose, Fault> {
        let [rear, front] = [theta_rear, theta_front].map(Vector::from_angle);
        self.close(rear, front)
    }

    /// The pose with arms along two unit vectors; like [`Slider::forward`], but without computing sines and cosines.
    ///
    /// # Errors
    /// Fails as [`Slider::forward`] does.
    #[inline]
    pub fn close(&self, rear: Vector, front: Vector) -> Result<SliderPose, Fault> {
        let pose = self.pose_unchecked(rear, front);
        self.check_pose(&pose)?;
        Ok(pose)
    }

    /// Checks that the slider of a pose has a direction.
    #[inline]
    pub(crate) fn check_pose(&self, pose: &SliderPose) -> Result<(), Fault> {
        check_direction(pose.d, pose.s)
    }

    /// Returns, for each lane, true if the slider has a direction. For the arms of a lane without one,
    /// [`Slider::close`] returns the fault.
    #[inline(always)]
    pub fn are_loops_closed<const N: usize>(&self, pose: &SliderPose<Lanes<N>>) -> [bool; N] {
        let (Lanes(d), Lanes(s)) = (pose.d, pose.s);
        let mut is_closed = [false; N];
        for i in 0..N {
            is_closed[i] = check_direction(d[i], s[i]).is_ok();
        }
        is_closed
    }

    /// The pose with arms along two unit vectors, without a check that the slider has a direction:
    /// see [`Slider::are_loops_closed`]. The compiler leaves out the parts that the caller does not use.
    #[inline(always)]
    pub fn pose_unchecked<T: Real>(&self, rear: Vector<T>, front: Vector<T>) -> SliderPose<T> {
        let rear_tip = rear * self.rear_arm;
        let front_shaft = Vector::constant(Vector::new(self.front_offset, self.base));
        let front_tip = front_shaft + front * self.front_arm;
        let span = front_tip - rear_tip;
        let d = span.length();
        SliderPose {
            rear_tip,
            front_tip,
            front_shaft,
            span,
            d,
            s: d - T::constant(self.nominal_length),
        }
    }
}

/// Checks that a slider of length `d` and travel `s` has a direction.
#[inline(always)]
fn check_direction(d: f64, s: f64) -> Result<(), Fault> {
    if !d.is_finite() || !s.is_finite() {
        Err(Fault::NotFinite)
    } else if d == 0.0 {
        Err(Fault::Collapsed)
    } else {
        Ok(())
    }
}
