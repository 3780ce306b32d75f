//! Where pivots and anchors are, seen from above.
//!
//! The paper's figures leave open where the legs are pivoted. All that counts for
//! walking is the circle of the foot. A parallelogram carries its coupler without
//! turning it, so the two pivots may be moved together to wherever there is room, and
//! the foot hangs at the coupler by what they were moved. The driven pivot keeps away
//! from the servo, whose link would sweep over it; the strut between them is the
//! coupler of a second parallelogram: shaft, pivot and two equal anchor arms.

use lizard_kinematics::{End, Side, Vector};
use lizard_robot::Robot;

/// A leg seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegLayout {
    /// The driven crank's pivot, mm, chassis frame.
    pub driven: Vector,
    /// The follower's pivot.
    pub idle: Vector,
    /// From the first to the second, length one.
    pub along: Vector,
    /// From the servo's angle to the direction of the leg's crank, deg.
    pub set: f64,
    /// The crank's joint with the coupler, in the crank's frame, mm.
    pub joint: Vector,
    /// The foot in the coupler's frame, mm.
    pub foot: Vector,
    /// From the shaft to the driven pivot, length one.
    pub strut: Vector,
    /// As long is the strut from anchor to anchor, mm.
    pub strut_length: f64,
    /// The anchor on the servo's link, and on the leg, in their frames, mm.
    pub anchor: Vector,
}

/// All that a pose does not move, and how it moves the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// The servos' shafts, mm, chassis frame, servo order.
    pub shafts: [Vector; 4],
    /// 1 where a link's arm stands counter-clockwise from its crank, else -1.
    pub hand: [f64; 4],
    /// Length of the cranks of head and tail, mm.
    pub crank: [f64; 4],
    /// Length of the arms of the sliders, mm.
    pub arm: [f64; 4],
    /// The legs.
    pub legs: [LegLayout; 4],
}

impl Layout {
    /// The layout of a robot.
    #[must_use]
    pub fn new(robot: &Robot) -> Self {
        let lizard = robot.lizard();
        let shafts = lizard.shafts();
        let (mut hand, mut crank, mut arm) = ([0.0; 4], [0.0; 4], [0.0; 4]);
        for side in Side::ALL {
            let [front, rear] = side.servos();
            let slider = lizard.side(side);
            (hand[front], arm[front]) = (side.sign(), slider.front);
            (hand[rear], arm[rear]) = (-side.sign(), slider.rear);
        }
        for end in End::ALL {
            let [left, right] = end.servos();
            let bars = lizard.end(end);
            (crank[left], crank[right]) = (bars.crank_left, bars.crank_right);
        }
        let legs = std::array::from_fn(|servo| leg(robot, servo, shafts[servo], hand[servo]));
        Self {
            shafts,
            hand,
            crank,
            arm,
            legs,
        }
    }
}

fn leg(robot: &Robot, servo: usize, shaft: Vector, hand: f64) -> LegLayout {
    let parts = robot.parts();
    let [outward, inward] = parts.pivot;
    let side = if shaft.x < 0.0 { -1.0 } else { 1.0 };
    let driven = shaft + Vector::new(side * outward, -End::of_servo(servo).sign() * inward);
    let neutral = robot.servos()[servo].neutral;
    let place = robot.leg(servo, neutral);
    // Of the two ends that a ground link may have, the one away from the servo.
    let link = place.half * 2.0;
    let [idle, other] = [driven + link, driven - link];
    let idle = if (idle - shaft).square() > (other - shaft).square() {
        idle
    } else {
        other
    };
    let along = (idle - driven) * (1.0 / (idle - driven).length());
    let foot = place.hip - driven;
    let set = place.reach.angle() - neutral;
    let strut = driven - shaft;
    let [radius, angle] = parts.anchor;
    LegLayout {
        driven,
        idle,
        along,
        set,
        joint: Vector::direction(set) * robot.lizard().leg.crank,
        foot: Vector::new(foot.dot(along), along.cross(foot)),
        strut: strut * (1.0 / strut.length()),
        strut_length: strut.length(),
        anchor: Vector::direction(-hand * angle) * radius,
    }
}
