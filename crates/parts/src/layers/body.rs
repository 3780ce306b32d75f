//! A rigid body of the robot: its layers, what it is, and what it moves with.

use lizard_kinematics::{End, Side};

use lizard_robot::Robot;

use crate::layers::fitting::Fitting;
use crate::layers::shape::Shape;
use crate::layers::stack::Span;

/// A layer of a body: what some shapes cover and no hole takes away, between two
/// heights.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    /// The layer is the union of these, in the body's frame, mm.
    pub add: Vec<Shape>,
    /// Less these.
    pub cut: Vec<Shape>,
    /// From and to, mm above the chassis plate's top.
    pub z: Span,
}

/// What a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// To be printed, or cut where all its layers have one outline.
    Printed,
    /// A servo without its horn.
    Servo,
    /// A servo's horn.
    Horn,
    /// A screw that is a joint or holds parts together, by its length below the head, mm.
    Screw(f64),
    /// A screw with a hexagonal head, which the part that it is put into holds.
    HexScrew(f64),
    /// A self-tapping screw from a servo's bag.
    ServoScrew,
    /// A small self-tapping screw that holds a horn in its link, by its length, mm.
    HornScrew(f64),
    /// The wires of a servo, as far as they lie in the robot.
    Lead,
    /// What is bought and has a place, but is not a part of the mechanism.
    Fitting(Fitting),
    /// A lock nut.
    Nut,
    /// A standoff by its length, mm.
    Standoff(f64),
    /// A tension spring.
    Spring,
    /// A rubber pad under a foot.
    Pad,
    /// The Arduino UNO.
    Board,
    /// The battery.
    Battery,
}

impl Kind {
    /// The word for it, as placements.json and the page have it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Printed => "printed",
            Self::Servo => "servo",
            Self::Horn => "horn",
            Self::Screw(_) => "screw",
            Self::HexScrew(_) => "hexagon screw",
            Self::ServoScrew => "servo screw",
            Self::HornScrew(_) => "horn screw",
            Self::Nut => "nut",
            Self::Standoff(_) => "standoff",
            Self::Spring => "spring",
            Self::Pad => "pad",
            Self::Lead => "lead",
            Self::Fitting(_) => "fitting",
            Self::Board => "board",
            Self::Battery => "battery",
        }
    }
}

/// What a body moves with. Servos are numbered in servo order, 0 to 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mount {
    /// The chassis: does not move.
    Chassis,
    /// A servo's horn. Origin at the shaft, x along the crank of head or tail.
    Link(usize),
    /// A leg's driven crank. Origin at its pivot; turned as its servo's link is.
    Crank(usize),
    /// A leg's follower. Origin at its pivot; turned as its servo's link is.
    Follower(usize),
    /// A leg's coupler, which carries the foot and never turns. Origin at its joint
    /// with the crank, x towards the follower.
    Foot(usize),
    /// A leg's strut, which never turns while the leg does not lag. Origin at the
    /// anchor on the servo's link, x towards the leg.
    Strut(usize),
    /// The coupler of head or tail on the crank of this servo. Origin at the crank's
    /// tip, x along the coupler.
    Coupler(usize),
    /// The rear half of a slider. Origin at the rear arm's tip, x along the slider.
    Sleeve(Side),
    /// Its front half. Origin at the front arm's tip, x as the rear half's.
    Rod(Side),
}

impl Mount {
    /// The servos that decide where it is, in servo order.
    #[must_use]
    pub fn servos(self) -> Vec<usize> {
        match self {
            Self::Chassis => Vec::new(),
            Self::Link(servo)
            | Self::Crank(servo)
            | Self::Follower(servo)
            | Self::Foot(servo)
            | Self::Strut(servo) => vec![servo],
            Self::Coupler(servo) => sorted(End::of_servo(servo).servos()),
            Self::Sleeve(side) | Self::Rod(side) => sorted(side.servos()),
        }
    }
}

fn sorted([a, b]: [usize; 2]) -> Vec<usize> {
    vec![a.min(b), a.max(b)]
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its unique name: `link A1`, `strut LF`.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// What it moves with.
    pub mount: Mount,
    /// Its layers from below to above, in its own frame.
    pub prisms: Vec<Prism>,
    /// Names of bodies of other mounts that it touches or passes through by design: a
    /// screw, and what it holds. A test of its own looks at each such pair.
    pub meets: Vec<String>,
}

impl Body {
    /// The lowest and the highest point, mm.
    #[must_use]
    pub fn z(&self) -> Span {
        let mut span = [f64::INFINITY, f64::NEG_INFINITY];
        for prism in &self.prisms {
            span = [span[0].min(prism.z[0]), span[1].max(prism.z[1])];
        }
        span
    }
}

/// The end at which a servo stands and whether it is its left or right one, 0 or 1.
pub(crate) fn at_end(servo: usize) -> (End, usize) {
    let end = End::of_servo(servo);
    (end, usize::from(end.servos()[1] == servo))
}

/// Length of the coupler on a servo's crank, mm.
pub(crate) fn coupler_length(robot: &Robot, servo: usize) -> f64 {
    let (end, hand) = at_end(servo);
    let bars = robot.lizard().end(end);
    [bars.coupler_left, bars.coupler_right][hand]
}
