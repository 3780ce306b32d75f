//! The complete robot: its bodies, and their placements at a pose.

use lizard_kinematics::{Real, Solution, Vector};
use lizard_robot::Robot;

use crate::bodies::builder::AssemblyBuilder;
use crate::bodies::layout::Layout;
use crate::bodies::{chassis, ends, legs, links, sliders, struts};
use crate::layers::body::{Body, Mount, end_and_index};
use crate::layers::placement::Placement;
use crate::layers::stack::Stack;

/// Every body of a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    robot: Robot,
    stack: Stack,
    layout: Layout,
    bodies: Vec<Body>,
    alternatives: Vec<Body>,
}

impl Assembly {
    /// Builds the bodies of a robot, without checking that they fit.
    pub fn new(robot: &Robot) -> Self {
        let mut builder = AssemblyBuilder::new(robot);
        chassis::add(&mut builder);
        links::add(&mut builder);
        ends::add(&mut builder);
        sliders::add(&mut builder);
        legs::add(&mut builder);
        struts::add(&mut builder);
        Self {
            robot: robot.clone(),
            alternatives: struts::make_alternatives(&builder),
            stack: builder.stack,
            layout: builder.layout,
            bodies: builder.bodies,
        }
    }

    /// Robot of this assembly.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Heights of the layers in which the bodies lie.
    pub fn stack(&self) -> &Stack {
        &self.stack
    }

    /// Positions of the pivots and anchors, seen from above.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Every body of the robot.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Bodies that may replace others: the struts of the kind that the robot does not have.
    pub fn alternatives(&self) -> &[Body] {
        &self.alternatives
    }

    /// Returns the body with this name, if any.
    pub fn body(&self, name: &str) -> Option<&Body> {
        self.bodies.iter().find(|body| body.name == name)
    }

    /// Returns the same robot with changed bodies, for tests and for custom parts.
    pub fn with_changed_bodies(mut self, change: impl FnOnce(&mut Vec<Body>)) -> Self {
        change(&mut self.bodies);
        self
    }

    /// True if two bodies may touch: they move together, or they touch by design.
    pub fn may_touch(&self, a: &Body, b: &Body) -> bool {
        a.mount == b.mount
            || a.allowed_contacts.contains(&b.name)
            || b.allowed_contacts.contains(&a.name)
    }

    /// Computes the placement of a mount's frame at a pose without lags of the legs.
    pub fn placement(&self, mount: Mount, pose: &Solution) -> Placement {
        self.placement_for_cranks(mount, pose.legs.map(|leg| leg.direction))
    }

    /// Computes the placement of a mount's frame from the directions of the cranks: unit vectors of any number type,
    /// chassis frame, servo order. Only the directions for the mount's own servos must be valid.
    pub(crate) fn placement_for_cranks<T: Real>(
        &self,
        mount: Mount,
        cranks: [Vector<T>; 4],
    ) -> Placement<T> {
        let placement_on_crank =
            |servo: usize, origin: Vector| Placement::new(Vector::constant(origin), cranks[servo]);
        let link_placement = |servo: usize| placement_on_crank(servo, self.layout.shafts[servo]);
        let (lizard, legs) = (self.robot.lizard(), &self.layout.legs);
        match mount {
            Mount::Chassis => {
                let Placement { origin, x_axis } = Placement::CHASSIS;
                Placement::new(Vector::constant(origin), Vector::constant(x_axis))
            }
            Mount::Link(servo) => link_placement(servo),
            Mount::Crank(servo) => placement_on_crank(servo, legs[servo].crank_pivot),
            Mount::Follower(servo) => placement_on_crank(servo, legs[servo].follower_pivot),
            Mount::Foot(servo) => {
                let leg = &legs[servo];
                let joint = placement_on_crank(servo, leg.crank_pivot).map(leg.crank_joint);
                Placement::new(joint, Vector::constant(leg.coupler_direction))
            }
            Mount::Strut(servo) => {
                let anchor = link_placement(servo).map(legs[servo].anchor);
                Placement::new(anchor, Vector::constant(legs[servo].strut_direction))
            }
            Mount::Coupler(servo) => {
                let (end, index) = end_and_index(servo);
                let five_bar = lizard.end_pose_unchecked(end, cranks);
                let tip = [five_bar.left_tip, five_bar.right_tip][index];
                let coupler_direction = [five_bar.left_coupler, five_bar.right_coupler][index];
                let origin = lizard.to_chassis(end, tip);
                Placement::new(origin, end.mirror(coupler_direction))
            }
            Mount::Sleeve(side) | Mount::Rod(side) => {
                let slider = lizard.side_pose_unchecked(side, cranks);
                let rear_shaft = Vector::constant(self.layout.shafts[side.servos()[1]]);
                let tip = match mount {
                    Mount::Rod(_) => slider.front_tip,
                    _ => slider.rear_tip,
                };
                let direction = slider.span.scaled(T::constant(1.0) / slider.d);
                Placement::new(rear_shaft + tip, direction)
            }
        }
    }
}
