//! A printed part: its layers as it lies on the printer's bed, and the bodies that are made from it.

use std::iter::zip;

use lizard_kinematics::{Side, Vector};
use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};

use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::mark;
use crate::layers::outline::{self, Outline};
use crate::layers::placement::Placement;
use crate::layers::roof;
use crate::layers::shape::Shape;

/// The noun in the names of spacer rings, whose parts are named by length, not by position.
const SPACER: &str = "spacer";

/// A printed part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The name. A part named `link A1 A3` is needed twice, for A1 and for A3.
    pub name: String,
    /// Names of the bodies for which the part is printed.
    pub body_names: Vec<String>,
    /// The layers as printed: from z = 0 up, the larger face below.
    pub prisms: Vec<Prism>,
    /// True if the part is turned over for printing.
    pub is_turned_over: bool,
    /// True if the part is printed in a flexible filament, TPU.
    pub is_flexible: bool,
    /// The part that it may replace; `None` for a standard part of the robot.
    pub instead_of: Option<String>,
    /// The digits engraved in the part: the numbers of its servos, such as `13` for A1 and A3. Empty if only one part
    /// has its noun.
    pub mark: String,
}

impl Part {
    /// A part needed once, printed in the orientation of its layers, without a mark.
    pub(crate) fn single(name: &str, prisms: Vec<Prism>) -> Self {
        Self {
            name: name.to_owned(),
            body_names: vec![name.to_owned()],
            prisms,
            is_turned_over: false,
            is_flexible: false,
            instead_of: None,
            mark: String::new(),
        }
    }

    /// The number of pieces needed.
    pub fn count(&self) -> usize {
        self.body_names.len()
    }

    /// The name of the part's files, without extension.
    pub fn file_stem(&self) -> String {
        self.name.replace(' ', "-")
    }

    /// The layers as printed, with the mark, and with each hole closed that would begin in mid-air; and the number of
    /// closed holes.
    pub fn printed_layers(&self) -> (Vec<Prism>, usize) {
        let marked = mark::engrave_mark(&self.prisms, &self.mark);
        roof::close_unsupported_holes(&marked.unwrap_or_else(|| self.prisms.clone()))
    }

    /// Centres of the closed holes, which are drilled later, in the frame of the printed part, mm.
    pub fn closed_hole_centres(&self) -> Vec<Vector> {
        roof::unsupported_hole_centres(&self.prisms)
    }

    /// The motion that takes the printed part to the position of a body, in that body's frame.
    pub fn print_to_body(&self, body: &Body) -> PrintToBody {
        let [low, high] = body.z();
        PrintToBody {
            is_flipped: self.is_turned_over,
            lift: if self.is_turned_over { high } else { low },
            frame: print_frame(body),
        }
    }

    /// The part's volume, mm^3.
    pub fn volume(&self) -> f64 {
        volume(&self.prisms)
    }
}

/// The motion from the frame of a printed part to the frame of its body: flip, lift, then turn and shift in the
/// plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintToBody {
    /// True if the part is first turned over: x, y, z become x, -y, -z.
    pub is_flipped: bool,
    /// The lift after the flip, mm.
    pub lift: f64,
    /// The placement of the printed part's frame in the body's frame.
    pub frame: Placement,
}

/// The volume of layers, mm^3.
pub(crate) fn volume(prisms: &[Prism]) -> f64 {
    prisms.iter().map(outline::volume).sum()
}

impl Assembly {
    /// Every printed part, each kind once. Alternative parts come last.
    pub fn parts(&self) -> Vec<Part> {
        let mut parts = distinct_parts(self.bodies());
        let is_strut = |part: &&Part| {
            let first_body = self.body(&part.body_names[0]);
            first_body.is_some_and(|body| matches!(body.mount, Mount::Strut(_)))
        };
        let strut_name = parts.iter().find(is_strut).map(|part| part.name.clone());
        for mut part in distinct_parts(self.alternatives()) {
            part.instead_of.clone_from(&strut_name);
            parts.push(part);
        }
        let noun_of = |part: &Part| noun_and_owner(&part.body_names[0]).0.to_owned();
        let nouns: Vec<_> = parts.iter().map(noun_of).collect();
        for (part, noun) in parts.iter_mut().zip(&nouns) {
            if nouns.iter().filter(|listed| *listed == noun).count() > 1 {
                part.mark = servo_digits(&part.body_names);
            }
        }
        parts
    }
}

/// Splits a body's name into noun and owner, such as `link` and `A1`. A name of one word has no owner.
fn noun_and_owner(name: &str) -> (&str, &str) {
    name.rsplit_once(' ').unwrap_or((name, ""))
}

/// The numbers of the servos that own these bodies, in order, as one string.
fn servo_digits(names: &[String]) -> String {
    let mut numbers: Vec<usize> = Vec::new();
    for name in names {
        let (_, owner) = noun_and_owner(name);
        let index_in = |list: [&str; 4]| list.iter().position(|name| *name == owner);
        let side = Side::ALL.into_iter().find(|side| side.name() == owner);
        numbers.extend(index_in(SERVO_NAMES).or(index_in(LEG_NAMES)));
        numbers.extend(side.into_iter().flat_map(Side::servos));
    }
    numbers.sort_unstable();
    let digits = numbers.iter().map(|servo| (servo + 1).to_string());
    digits.collect()
}

/// The printed parts of these bodies; equal bodies share a part.
fn distinct_parts(bodies: &[Body]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for body in bodies.iter().filter(|body| body.kind.is_printed()) {
        let (prisms, is_turned_over) = layers_in_print_frame(body);
        match parts
            .iter_mut()
            .find(|part| are_equal(&part.prisms, &prisms))
        {
            Some(part) => part.body_names.push(body.name.clone()),
            None => parts.push(Part {
                is_turned_over,
                is_flexible: body.kind == Kind::Pad,
                ..Part::single(&body.name, prisms)
            }),
        }
    }
    for part in &mut parts {
        let top_layer = part
            .prisms
            .last()
            .filter(|_| part.body_names[0].contains(SPACER));
        part.name = match top_layer {
            Some(top) => format!("{SPACER} {:.1}", top.z[1]),
            None => shared_name(&part.body_names),
        };
    }
    parts
}

/// A body's layers as printed, and true if the body is turned over for printing. The first shape is at the origin
/// and the first bar along x, so equal parts have equal layers wherever they are used.
fn layers_in_print_frame(body: &Body) -> (Vec<Prism>, bool) {
    let area_of = |prism: Option<&Prism>| prism.map_or(0.0, |prism| Outline::of(prism).area());
    let is_turned_over = area_of(body.prisms.first()) < 0.7 * area_of(body.prisms.last());
    let [low, high] = body.z();
    let frame = print_frame(body);
    let to_print_frame = |shape: &Shape| {
        let points = shape.points.iter().map(|&point| frame.unmap(point));
        let shape = Shape {
            points: points.collect(),
            radius: shape.radius,
        };
        if is_turned_over {
            shape.mirrored()
        } else {
            shape
        }
    };
    let to_printed_prism = |prism: &Prism| Prism {
        filled_shapes: prism.filled_shapes.iter().map(to_print_frame).collect(),
        cut_shapes: prism.cut_shapes.iter().map(to_print_frame).collect(),
        z: match is_turned_over {
            true => [high - prism.z[1], high - prism.z[0]],
            false => prism.z.map(|z| z - low),
        },
        inset: match is_turned_over {
            true => [prism.inset[1], prism.inset[0]],
            false => prism.inset,
        },
    };
    let mut prisms: Vec<Prism> = body.prisms.iter().map(to_printed_prism).collect();
    prisms.sort_by(|a, b| a.z[0].total_cmp(&b.z[0]));
    (prisms, is_turned_over)
}

/// The frame in which a body's part is printed.
fn print_frame(body: &Body) -> Placement {
    if body.mount == Mount::Chassis {
        return Placement::CHASSIS;
    }
    let shapes = || body.prisms.iter().flat_map(|prism| &prism.filled_shapes);
    let first_shape = shapes().next();
    let origin = first_shape.map_or(Vector::default(), |shape| shape.points[0]);
    // A pad has no bar; only its notch gives it a direction.
    let cuts = body.prisms.iter().flat_map(|prism| &prism.cut_shapes);
    let bar_vector = shapes()
        .chain(cuts)
        .find_map(|shape| match shape.points[..] {
            [from, to, ..] => Some(to - from),
            _ => None,
        });
    Placement {
        origin,
        x_axis: bar_vector.map_or(Placement::CHASSIS.x_axis, |vector| {
            vector * (1.0 / vector.length())
        }),
    }
}

/// True if two parts are equal except for rounding.
fn are_equal(a: &[Prism], b: &[Prism]) -> bool {
    let are_near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    let have_equal_points = |a: &Shape, b: &Shape| {
        a.points.len() == b.points.len()
            && zip(&a.points, &b.points).all(|(a, b)| are_near(a.x, b.x) && are_near(a.y, b.y))
    };
    let are_equal_shapes = |a: &[Shape], b: &[Shape]| {
        a.len() == b.len()
            && zip(a, b).all(|(a, b)| are_near(a.radius, b.radius) && have_equal_points(a, b))
    };
    a.len() == b.len()
        && zip(a, b).all(|(a, b)| {
            let have_equal_heights = are_near(a.z[0], b.z[0]) && are_near(a.z[1], b.z[1]);
            let have_equal_insets =
                are_near(a.inset[0], b.inset[0]) && are_near(a.inset[1], b.inset[1]);
            have_equal_heights
                && have_equal_insets
                && are_equal_shapes(&a.filled_shapes, &b.filled_shapes)
                && are_equal_shapes(&a.cut_shapes, &b.cut_shapes)
        })
}

/// One name for several bodies: their common noun, then their owners.
fn shared_name(names: &[String]) -> String {
    let (nouns, owners): (Vec<_>, Vec<_>) = names.iter().map(|name| noun_and_owner(name)).unzip();
    match names.len() {
        2.. if nouns.iter().any(|noun| *noun != nouns[0]) => names[0].clone(),
        4 => nouns[0].to_owned(),
        2.. => format!("{} {}", nouns[0], owners.join(" ")),
        _ => names.concat(),
    }
}
