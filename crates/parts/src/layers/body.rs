//! A rigid body of the robot: its layers, its kind, and the mount that it moves with.

use lizard_kinematics::{End, Side, Vector};
use lizard_robot::Robot;
use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};

use crate::layers::fitting::Fitting;
use crate::layers::shape::Shape;
use crate::layers::stack::Span;

/// A layer of a body: a union of shapes minus some holes, between two heights. The walls are vertical, or slope by the
/// difference of the insets.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    /// Shapes whose union is filled, mount frame, mm.
    pub filled_shapes: Vec<Shape>,
    /// Holes cut out of the union, mount frame, mm.
    pub cut_shapes: Vec<Shape>,
    /// Bottom and top, mm above the chassis plate's top.
    pub z: Span,
    /// Reductions of the filled shapes' radii at the bottom and at the top, mm; above 0 only for discs.
    pub insets: [f64; 2],
}

impl Prism {
    /// Creates a layer with holes.
    pub fn new(filled: impl Into<Vec<Shape>>, holes: impl Into<Vec<Shape>>, z: Span) -> Self {
        Self {
            filled_shapes: filled.into(),
            cut_shapes: holes.into(),
            z,
            insets: [0.0; 2],
        }
    }

    /// Creates a layer that is a truncated cone with a hole. `radii`: at the bottom and at the top, mm.
    pub(crate) fn cone(centre: Vector, radii: [f64; 2], hole: Shape, z: Span) -> Self {
        let widest = radii[0].max(radii[1]);
        Self {
            insets: radii.map(|radius| widest - radius),
            ..Self::new([Shape::disc(centre, widest)], [hole], z)
        }
    }

    /// Creates a layer without holes.
    pub fn solid(filled: impl Into<Vec<Shape>>, z: Span) -> Self {
        Self::new(filled, [], z)
    }

    /// True if the layer is thicker than a rounding error.
    pub(crate) fn has_height(&self) -> bool {
        self.z[1] > self.z[0] + 1e-9
    }

    /// Returns the layer between two other heights; the walls keep their slope.
    pub fn at_heights(&self, z: Span) -> Self {
        let [low, high] = self.insets;
        let slope = (high - low) / (self.z[1] - self.z[0]);
        Self {
            z,
            insets: z.map(|height| low + slope * (height - self.z[0])),
            ..self.clone()
        }
    }

    /// Returns a layer with vertical walls and the cross-section at a fraction of the height; 0 is the bottom.
    pub(crate) fn cross_section(&self, fraction: f64) -> Self {
        let inset = self.insets[0] + fraction * (self.insets[1] - self.insets[0]);
        let shapes = self.filled_shapes.iter();
        let filled: Vec<Shape> = shapes.map(|shape| shape.grown(-inset)).collect();
        Self::new(filled, self.cut_shapes.clone(), self.z)
    }
}

/// The kind of a body, which decides how the body is bought or made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A part to print, or to cut if all its layers have the same outline.
    Printed,
    /// A servo without its horn.
    Servo,
    /// A servo's horn.
    Horn,
    /// A screw that forms a joint or holds parts together, with its length below the head, mm.
    Screw(f64),
    /// A screw with a hexagonal head, with its length below the head, mm; a pocket in the part holds the head.
    HexScrew(f64),
    /// A self-tapping screw that comes with a servo.
    ServoScrew,
    /// A small self-tapping screw that holds a horn in its link, with its length, mm.
    HornScrew(f64),
    /// The wires of a servo within the robot.
    Lead,
    /// A bought part with a place on the robot but no role in the mechanism.
    Fitting(Fitting),
    /// A lock nut.
    Nut,
    /// A standoff, with its length, mm.
    Standoff(f64),
    /// A tension spring.
    Spring,
    /// A pad under a foot, printed from a flexible filament.
    Pad,
    /// The Arduino UNO.
    Board,
    /// The battery.
    Battery,
}

impl Kind {
    /// True for a body that is printed, pads included.
    pub fn is_printed(self) -> bool {
        matches!(self, Self::Printed | Self::Pad)
    }

    /// Word for the kind in placements.json and on the web page.
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

/// The frame of reference in which a body is fixed. Servos have numbers from 0 to 3 in servo order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mount {
    /// The chassis, which does not move.
    Chassis,
    /// The link on a servo's horn. Origin at the shaft, x along the crank of head or tail.
    Link(usize),
    /// A leg's driven crank. Origin at its pivot; it turns with its servo's link.
    Crank(usize),
    /// A leg's follower. Origin at its pivot; it turns with its servo's link.
    Follower(usize),
    /// A leg's coupler, which carries the foot and never turns. Origin at the crank's joint, x towards the follower.
    Foot(usize),
    /// A leg's strut, which does not turn unless the leg lags behind its servo. Origin at the anchor on the servo's
    /// link, x towards the leg.
    Strut(usize),
    /// The coupler of head or tail on this servo's crank. Origin at the crank's tip, x along the coupler.
    Coupler(usize),
    /// The rear half of a slider. Origin at the rear arm's tip, x along the slider from rear to front.
    Sleeve(Side),
    /// The front half of a slider. Origin at the front arm's tip, x along the slider from rear to front.
    Rod(Side),
}

impl Mount {
    /// Name of the mount and of its printed body. The body of the chassis and a rigid strut have other names.
    pub(crate) fn name(self) -> String {
        let (kind, owner) = match self {
            Self::Chassis => return "chassis".to_owned(),
            Self::Link(servo) => ("link", SERVO_NAMES[servo]),
            Self::Crank(servo) => ("crank", LEG_NAMES[servo]),
            Self::Follower(servo) => ("follower", LEG_NAMES[servo]),
            Self::Foot(servo) => ("leg coupler", LEG_NAMES[servo]),
            Self::Strut(servo) => ("strut", LEG_NAMES[servo]),
            Self::Coupler(servo) => ("coupler", SERVO_NAMES[servo]),
            Self::Sleeve(side) => ("sleeve", side.name()),
            Self::Rod(side) => ("rod", side.name()),
        };
        format!("{kind} {owner}")
    }

    /// Servos that determine the mount's placement, in servo order.
    pub fn servos(self) -> Vec<usize> {
        let mut servos = match self {
            Self::Coupler(servo) => End::from_servo(servo).servos().to_vec(),
            Self::Sleeve(side) | Self::Rod(side) => side.servos().to_vec(),
            _ => self.servo().into_iter().collect(),
        };
        servos.sort_unstable();
        servos
    }

    /// The servo after which the mount is named; `None` for the chassis and the sliders.
    pub fn servo(self) -> Option<usize> {
        match self {
            Self::Link(servo)
            | Self::Crank(servo)
            | Self::Follower(servo)
            | Self::Foot(servo)
            | Self::Strut(servo)
            | Self::Coupler(servo) => Some(servo),
            Self::Chassis | Self::Sleeve(_) | Self::Rod(_) => None,
        }
    }
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Unique name, such as `link A1` or `strut LF`.
    pub name: String,
    /// Kind of the body.
    pub kind: Kind,
    /// Mount that the body moves with.
    pub mount: Mount,
    /// Layers from bottom to top, mount frame.
    pub prisms: Vec<Prism>,
    /// Names of bodies on other mounts that this body touches or passes through by design, such as the parts that a
    /// screw holds. A separate test checks these pairs.
    pub allowed_contacts: Vec<String>,
}

impl Body {
    /// Lowest and highest z of the body, mm.
    pub fn z(&self) -> Span {
        let mut span = [f64::INFINITY, f64::NEG_INFINITY];
        for prism in &self.prisms {
            span = [span[0].min(prism.z[0]), span[1].max(prism.z[1])];
        }
        span
    }
}

/// The end that a servo drives, and the servo's index at that end: 0 for left, 1 for right.
pub(crate) fn end_and_index(servo: usize) -> (End, usize) {
    let end = End::from_servo(servo);
    (end, usize::from(end.servos()[1] == servo))
}

/// Length of the coupler on a servo's crank, mm.
pub(crate) fn coupler_length(robot: &Robot, servo: usize) -> f64 {
    let (end, index) = end_and_index(servo);
    let five_bar = robot.lizard().end(end);
    [five_bar.left_coupler_length, five_bar.right_coupler_length][index]
}
