//! A slider between two arms, one on each side of the robot: the RRPRR loop.
//!
//! Each arm is rigidly joined to a crank, so the arm tips are known, and the prismatic joint
//! lies on the line from the rear tip to the front one: length d = l12 + l13 + s, direction
//! phi. Its only singularity is d = 0; in practice its stroke limits it.
//!
//! The paper takes theta10 + theta11 = 0 for the two halves of the slider; with angles counted
//! counter-clockwise the halves have opposite directions, theta11 = theta10 + 180, and the
//! unknowns are phi = theta10 and s.

use crate::fault::Fault;
use crate::real::{Lanes, Real};
use crate::vector::Vector;

/// Dimensions of one side in mm. The origin is the rear shaft, the axes are the
/// chassis frame's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slider {
    /// x of the front shaft relative to the rear one, mm, either sign: 0 if head
    /// and tail have equally wide bases.
    pub offset: f64,
    /// y of the front shaft relative to the rear one, mm: l10, l15.
    pub base: f64,
    /// Front arm, mm: l14, l19.
    pub front: f64,
    /// Rear arm, mm: l11, l16.
    pub rear: f64,
    /// Distance of the arm tips at s = 0, mm: l12 + l13, l17 + l18.
    pub nominal: f64,
}

/// The solved pose of one side's loop. Points in mm from the rear shaft.
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
    /// Length of the span, mm: d.
    pub d: T,
    /// Slider travel from nominal, mm: s, positive when longer.
    pub s: T,
}

impl SliderPose {
    /// theta10 (right: theta14): direction of the slider from rear to front,
    /// degrees.
    pub fn phi(&self) -> f64 {
        self.span.angle()
    }

    /// The front arm, from its shaft to its tip.
    pub fn front_arm(&self) -> Vector {
        self.front_tip - self.front_shaft
    }
}

impl Slider {
    /// The slider between arms at two angles in degrees (theta9 and theta12 on
    /// the left, theta13 and theta16 on the right).
    ///
    /// # Errors
    /// Returns [`Fault::Collapsed`] if the arm tips coincide, or [`Fault::NotFinite`] if the input is not finite or
    /// overflows.
    pub fn forward(&self, theta_rear: f64, theta_front: f64) -> Result<SliderPose, Fault> {
        let [rear, front] = [theta_rear, theta_front].map(Vector::direction);
        self.close(rear, front)
    }

    /// The slider between arms that point along two unit vectors.
    ///
    /// # Errors
    /// Fails as [`Slider::forward`] does.
    #[inline]
    pub fn close(&self, rear: Vector, front: Vector) -> Result<SliderPose, Fault> {
        let pose = self.shape(rear, front);
        self.check(&pose)?;
        Ok(pose)
    }

    /// Checks that the slider of a pose has a direction.
    #[inline]
    pub(crate) fn check(&self, pose: &SliderPose) -> Result<(), Fault> {
        check_numbers(pose.d, pose.s)
    }

    /// True in each lane whose slider has a direction; [`Slider::close`] gives the reason why a
    /// slider has none.
    #[inline(always)]
    pub fn closes<const N: usize>(&self, pose: &SliderPose<Lanes<N>>) -> [bool; N] {
        let (Lanes(d), Lanes(s)) = (pose.d, pose.s);
        let mut is_closed = [false; N];
        for i in 0..N {
            is_closed[i] = check_numbers(d[i], s[i]).is_ok();
        }
        is_closed
    }

    /// The pose with arms along two unit vectors, without checking that the slider has a
    /// direction: see [`Slider::closes`]. The compiler leaves out the parts that the caller
    /// does not use.
    #[inline(always)]
    pub fn shape<T: Real>(&self, rear: Vector<T>, front: Vector<T>) -> SliderPose<T> {
        let rear_tip = rear * self.rear;
        let front_shaft = Vector::of(Vector::new(self.offset, self.base));
        let front_tip = front_shaft + front * self.front;
        let span = front_tip - rear_tip;
        let d = span.length();
        SliderPose {
            rear_tip,
            front_tip,
            front_shaft,
            span,
            d,
            s: d - T::of(self.nominal),
        }
    }
}

#[inline(always)]
fn check_numbers(d: f64, s: f64) -> Result<(), Fault> {
    if !d.is_finite() || !s.is_finite() {
        Err(Fault::NotFinite)
    } else if d == 0.0 {
        Err(Fault::Collapsed)
    } else {
        Ok(())
    }
}
