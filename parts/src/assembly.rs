//! The whole robot: every body, and where each is at a pose.

use lizard_kinematics::{End, Side, Solution, Vector};
use lizard_robot::Robot;

use crate::body::{Body, Mount, at_end};
use crate::builder::Builder;
use crate::layout::Layout;
use crate::place::Place;
use crate::stack::Stack;
use crate::{chassis, ends, legs, links, sliders};

/// Every body of a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    robot: Robot,
    stack: Stack,
    layout: Layout,
    bodies: Vec<Body>,
}

impl Assembly {
    /// The bodies of a robot. Whether they fit is not asked here.
    #[must_use]
    pub fn new(robot: &Robot) -> Self {
        let mut builder = Builder::new(robot);
        chassis::add(&mut builder);
        links::add(&mut builder);
        ends::add(&mut builder);
        sliders::add(&mut builder);
        legs::add(&mut builder);
        Self {
            robot: robot.clone(),
            stack: builder.stack,
            layout: builder.layout,
            bodies: builder.bodies,
        }
    }

    /// The robot that it is of.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The heights of its layers.
    #[must_use]
    pub fn stack(&self) -> &Stack {
        &self.stack
    }

    /// Where pivots and anchors are.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Every body.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// A body by its name.
    #[must_use]
    pub fn body(&self, name: &str) -> Option<&Body> {
        self.bodies.iter().find(|body| body.name == name)
    }

    /// Whether two bodies may touch: they move together, or are made to meet.
    #[must_use]
    pub fn meet(&self, a: &Body, b: &Body) -> bool {
        a.mount == b.mount || a.meets.contains(&b.name) || b.meets.contains(&a.name)
    }

    /// Where a mount's frame is at a pose, legs without lag.
    #[must_use]
    pub fn place(&self, mount: Mount, pose: &Solution) -> Place {
        let angles: [f64; 4] = pose.pose.into();
        let link = |servo: usize| Place {
            at: self.layout.shafts[servo],
            turn: Vector::direction(angles[servo]),
        };
        let crank = |servo: usize, at: Vector| Place { at, ..link(servo) };
        match mount {
            Mount::Chassis => Place::CHASSIS,
            Mount::Link(servo) => link(servo),
            Mount::Crank(servo) => crank(servo, self.layout.legs[servo].driven),
            Mount::Follower(servo) => crank(servo, self.layout.legs[servo].idle),
            Mount::Foot(servo) => {
                let leg = &self.layout.legs[servo];
                Place {
                    at: leg.driven + self.robot.leg(servo, angles[servo]).reach,
                    turn: leg.along,
                }
            }
            Mount::Strut(servo) => {
                let leg = &self.layout.legs[servo];
                Place {
                    at: link(servo).map(leg.anchor),
                    turn: leg.strut,
                }
            }
            Mount::Coupler(servo) => {
                let (end, hand) = at_end(servo);
                Place {
                    at: pose.crank_tips()[servo],
                    turn: pose.couplers(end)[hand],
                }
            }
            Mount::Sleeve(side) | Mount::Rod(side) => {
                let slider = pose.side(side);
                let rear = self.layout.shafts[side.servos()[1]];
                let tip = match mount {
                    Mount::Rod(_) => slider.front_tip,
                    _ => slider.rear_tip,
                };
                Place {
                    at: rear + tip,
                    turn: slider.span * (1.0 / slider.d),
                }
            }
        }
    }
}

/// What the servos, their links and their legs are called.
pub(crate) fn names(servo: usize) -> (&'static str, &'static str) {
    (
        lizard_robot::servo::NAMES[servo],
        lizard_robot::servo::LEGS[servo],
    )
}

/// The name of the coupler on a servo's crank.
pub(crate) fn coupler(servo: usize) -> String {
    format!("coupler {}", names(servo).0)
}

/// The shortest and the longest that a slider may be from pin to pin, mm.
pub(crate) fn slider_range(robot: &Robot, side: Side) -> [f64; 2] {
    let (slider, limits) = (robot.lizard().side(side), robot.limits());
    [
        slider.nominal + limits.stroke_min,
        slider.nominal + limits.stroke_max,
    ]
}

/// Length of the coupler on a servo's crank, mm.
pub(crate) fn coupler_length(robot: &Robot, servo: usize) -> f64 {
    let (end, hand): (End, usize) = at_end(servo);
    let bars = robot.lizard().end(end);
    [bars.coupler_left, bars.coupler_right][hand]
}
