//! The whole robot: every body, and where each is at a pose.

use lizard_kinematics::{Real, Solution, Vector};
use lizard_robot::Robot;

use crate::bodies::builder::Builder;
use crate::bodies::chassis;
use crate::bodies::ends;
use crate::bodies::joints::Joints;
use crate::bodies::layout::Layout;
use crate::bodies::legs;
use crate::bodies::links;
use crate::bodies::sliders;
use crate::bodies::struts;
use crate::layers::body::{Body, Mount, at_end};
use crate::layers::placement::Placement;
use crate::layers::stack::Stack;

/// Every body of a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    robot: Robot,
    stack: Stack,
    layout: Layout,
    bodies: Vec<Body>,
    instead: Vec<Body>,
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
        struts::add(&mut builder);
        Self {
            robot: robot.clone(),
            instead: struts::instead(&builder),
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

    /// Bodies that may be put in instead of some of them: the other kind of strut.
    #[must_use]
    pub fn instead(&self) -> &[Body] {
        &self.instead
    }

    /// A body by its name.
    #[must_use]
    pub fn body(&self, name: &str) -> Option<&Body> {
        self.bodies.iter().find(|body| body.name == name)
    }

    /// The same robot with bodies changed: a part of one's own, or a mistake on purpose.
    #[must_use]
    pub fn altered(mut self, change: impl FnOnce(&mut Vec<Body>)) -> Self {
        change(&mut self.bodies);
        self
    }

    /// Whether two bodies may touch: they move together, or are made to meet.
    #[must_use]
    pub fn meet(&self, a: &Body, b: &Body) -> bool {
        a.mount == b.mount || a.meets.contains(&b.name) || b.meets.contains(&a.name)
    }

    /// Where a mount's frame is at a pose, legs without lag.
    #[must_use]
    pub fn place(&self, mount: Mount, pose: &Solution) -> Placement {
        self.place_on(mount, pose)
    }

    /// The same for joints in any kind of number.
    pub(crate) fn place_on<T: Real>(&self, mount: Mount, joints: &impl Joints<T>) -> Placement<T> {
        let vector = |v: Vector| Vector::new(T::of(v.x), T::of(v.y));
        let turned = |servo: usize, at: Vector| Placement {
            at: vector(at),
            turn: joints.crank(servo),
        };
        let link = |servo: usize| turned(servo, self.layout.shafts[servo]);
        match mount {
            Mount::Chassis => Placement {
                at: vector(Placement::CHASSIS.at),
                turn: vector(Placement::CHASSIS.turn),
            },
            Mount::Link(servo) => link(servo),
            Mount::Crank(servo) => turned(servo, self.layout.legs[servo].driven),
            Mount::Follower(servo) => turned(servo, self.layout.legs[servo].idle),
            Mount::Foot(servo) => {
                let leg = &self.layout.legs[servo];
                Placement {
                    at: turned(servo, leg.driven).map(leg.joint),
                    turn: vector(leg.along),
                }
            }
            Mount::Strut(servo) => {
                let leg = &self.layout.legs[servo];
                Placement {
                    at: link(servo).map(leg.anchor),
                    turn: vector(leg.strut),
                }
            }
            Mount::Coupler(servo) => {
                let (end, hand) = at_end(servo);
                let bars = joints.end(end);
                let tip = [bars.left_tip, bars.right_tip][hand];
                let along = [bars.left_coupler, bars.right_coupler][hand];
                Placement {
                    at: self.robot.lizard().to_chassis(end, tip),
                    turn: end.mirror(along),
                }
            }
            Mount::Sleeve(side) | Mount::Rod(side) => {
                let slider = joints.side(side);
                let rear = vector(self.layout.shafts[side.servos()[1]]);
                let tip = match mount {
                    Mount::Rod(_) => slider.front_tip,
                    _ => slider.rear_tip,
                };
                Placement {
                    at: rear + tip,
                    turn: slider.span.scaled(T::of(1.0) / slider.d),
                }
            }
        }
    }
}
