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

/// The noun in the names of spacer rings. Their parts are named after their length, not their position.
const SPACER: &str = "spacer";

/// A printed part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name. A part named `link A1 A3` is needed twice, for A1 and for A3.
    pub name: String,
    /// Names of the bodies that are printed as this part.
    pub body_names: Vec<String>,
    /// Layers in the orientation of printing, from z = 0 up, without the mark and the bridges.
    pub prisms: Vec<Prism>,
    /// True if the part is flipped (turned over) for printing.
    pub is_flipped: bool,
    /// True if the part is printed in a flexible filament (TPU).
    pub is_flexible: bool,
    /// Name of the part that this part may replace; `None` for a part of the robot itself.
    pub replaces: Option<String>,
    /// Engraved digits: the numbers of the part's servos, such as `13` for A1 and A3. Empty for
    /// spacers, and if no other part's name begins with the same noun.
    pub mark: String,
}

impl Part {
    /// Creates a part that is needed once and printed in the orientation of its layers, without a mark.
    pub(crate) fn single(name: &str, prisms: Vec<Prism>) -> Self {
        Self {
            name: name.to_owned(),
            body_names: vec![name.to_owned()],
            prisms,
            is_flipped: false,
            is_flexible: false,
            replaces: None,
            mark: String::new(),
        }
    }

    /// Number of pieces to print.
    pub fn count(&self) -> usize {
        self.body_names.len()
    }

    /// Name of the part's files, without extension.
    pub fn file_stem(&self) -> String {
        self.name.replace(' ', "-")
    }

    /// Builds the layers as printed, with the mark, and with holes bridged where they would begin in mid-air. Also
    /// returns the number of bridged holes.
    pub fn build_printed_layers(&self) -> (Vec<Prism>, usize) {
        let marked_prisms = mark::engrave_mark(&self.prisms, &self.mark);
        roof::bridge_unsupported_holes(&marked_prisms.unwrap_or_else(|| self.prisms.clone()))
    }

    /// Finds the centres of the bridged holes in the frame of the printed part, mm; the holes are drilled after
    /// printing.
    pub fn find_bridged_hole_centres(&self) -> Vec<Vector> {
        let holes = roof::find_unsupported_holes(&self.prisms).into_iter();
        holes.map(|(hole, _)| hole.middle()).collect()
    }

    /// Computes the rigid transform from the printed part to the position of a body, in the body's frame.
    pub fn transform_to_body(&self, body: &Body) -> PrintTransform {
        let [low, high] = body.z();
        PrintTransform {
            is_flipped: self.is_flipped,
            lift: if self.is_flipped { high } else { low },
            frame: compute_print_frame(body),
        }
    }

    /// True if this part is the printed form of the body.
    pub fn prints_body(&self, body: &Body) -> bool {
        self.body_names.contains(&body.name)
    }

    /// Computes the part's volume, mm^3.
    pub fn volume(&self) -> f64 {
        compute_volume(&self.prisms)
    }
}

/// The rigid transform from a printed part's frame to its body's frame: flip, lift, then rotation and translation in
/// the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintTransform {
    /// True if the part is first flipped: (x, y, z) becomes (x, -y, -z).
    pub is_flipped: bool,
    /// Lift after the flip, mm.
    pub lift: f64,
    /// Placement of the printed part's frame in the body's frame.
    pub frame: Placement,
}

/// Computes the volume of layers, mm^3.
pub(crate) fn compute_volume(prisms: &[Prism]) -> f64 {
    prisms.iter().map(outline::compute_volume).sum()
}

impl Assembly {
    /// Collects the printed parts, each kind once, with the alternative parts at the end.
    pub fn collect_parts(&self) -> Vec<Part> {
        let mut parts = find_distinct_parts(self.bodies());
        let is_strut = |part: &&Part| {
            let first_body = self.body(&part.body_names[0]);
            first_body.is_some_and(|body| matches!(body.mount, Mount::Strut(_)))
        };
        let strut_name = parts.iter().find(is_strut).map(|part| part.name.clone());
        for mut part in find_distinct_parts(self.alternatives()) {
            part.replaces.clone_from(&strut_name);
            parts.push(part);
        }
        let part_noun = |part: &Part| split_name(&part.body_names[0]).0.to_owned();
        let nouns: Vec<_> = parts.iter().map(part_noun).collect();
        for (part, noun) in parts.iter_mut().zip(&nouns) {
            if nouns.iter().filter(|listed| *listed == noun).count() > 1 {
                part.mark = format_servo_digits(&part.body_names);
            }
        }
        parts
    }
}

/// Splits a body's name into noun and owner, such as `link` and `A1`. A name of one word has no owner.
fn split_name(name: &str) -> (&str, &str) {
    name.rsplit_once(' ').unwrap_or((name, ""))
}

/// Formats the numbers of the servos that own these bodies, in ascending order, without separators.
fn format_servo_digits(names: &[String]) -> String {
    let mut numbers: Vec<usize> = Vec::new();
    for name in names {
        let (_, owner) = split_name(name);
        let index_in = |list: [&str; 4]| list.iter().position(|name| *name == owner);
        let side = Side::ALL.into_iter().find(|side| side.name() == owner);
        numbers.extend(index_in(SERVO_NAMES).or(index_in(LEG_NAMES)));
        numbers.extend(side.into_iter().flat_map(Side::servos));
    }
    numbers.sort_unstable();
    let digits = numbers.iter().map(|servo| (servo + 1).to_string());
    digits.collect()
}

/// A body is flipped for printing if its first layer has less than this fraction of its last layer's area.
const MAX_FLIPPED_AREA_RATIO: f64 = 0.7;

/// Finds the printed parts of these bodies; equal bodies share one part.
fn find_distinct_parts(bodies: &[Body]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for body in bodies.iter().filter(|body| body.kind.is_printed()) {
        let (prisms, is_flipped) = to_print_layers(body);
        let has_equal_layers = |part: &&mut Part| are_equal_layers(&part.prisms, &prisms);
        match parts.iter_mut().find(has_equal_layers) {
            Some(part) => part.body_names.push(body.name.clone()),
            None => parts.push(Part {
                is_flipped,
                is_flexible: body.kind == Kind::Pad,
                ..Part::single(&body.name, prisms)
            }),
        }
    }
    for part in &mut parts {
        part.name = match part.prisms.last() {
            Some(top) if part.body_names[0].contains(SPACER) => format!("{SPACER} {:.1}", top.z[1]),
            _ => join_names(&part.body_names),
        };
    }
    parts
}

/// Converts a body's layers to the frame in which they are printed. The second value is true if the body is flipped for
/// printing. Except on the chassis, the first shape is at the origin and the first bar along x, so equal bodies have
/// equal layers.
fn to_print_layers(body: &Body) -> (Vec<Prism>, bool) {
    let layer_area =
        |prism: Option<&Prism>| prism.map_or(0.0, |prism| Outline::from_prism(prism).area());
    let [first_area, last_area] = [body.prisms.first(), body.prisms.last()].map(layer_area);
    let is_flipped = first_area < MAX_FLIPPED_AREA_RATIO * last_area;
    let [low, high] = body.z();
    let frame = compute_print_frame(body);
    let to_print_frame = |shape: &Shape| {
        let points = shape.points.iter().map(|&point| frame.unmap(point));
        let shape = Shape {
            points: points.collect(),
            radius: shape.radius,
        };
        if is_flipped { shape.mirrored() } else { shape }
    };
    let to_print_order = |[a, b]: [f64; 2]| if is_flipped { [b, a] } else { [a, b] };
    let to_print_height = |z: f64| if is_flipped { high - z } else { z - low };
    let to_print_prism = |prism: &Prism| Prism {
        filled_shapes: prism.filled_shapes.iter().map(to_print_frame).collect(),
        cut_shapes: prism.cut_shapes.iter().map(to_print_frame).collect(),
        z: to_print_order(prism.z).map(to_print_height),
        insets: to_print_order(prism.insets),
    };
    let mut prisms: Vec<Prism> = body.prisms.iter().map(to_print_prism).collect();
    prisms.sort_by(|a, b| a.z[0].total_cmp(&b.z[0]));
    (prisms, is_flipped)
}

/// Computes the frame in which a body is printed.
fn compute_print_frame(body: &Body) -> Placement {
    if body.mount == Mount::Chassis {
        return Placement::CHASSIS;
    }
    let shapes = || body.prisms.iter().flat_map(|prism| &prism.filled_shapes);
    let first_shape = shapes().next();
    let origin = first_shape.map_or(Vector::default(), |shape| shape.points[0]);
    // A pad has no bar, so its notch gives the direction.
    let cuts = body.prisms.iter().flat_map(|prism| &prism.cut_shapes);
    let mut all_shapes = shapes().chain(cuts);
    let bar_vector = all_shapes.find_map(|shape| match shape.points[..] {
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

/// True if two parts' layers are equal except for rounding.
fn are_equal_layers(a: &[Prism], b: &[Prism]) -> bool {
    fn all_equal<T>(a: &[T], b: &[T], are_equal: impl Fn(&T, &T) -> bool) -> bool {
        a.len() == b.len() && zip(a, b).all(|(a, b)| are_equal(a, b))
    }
    let are_near = |a: &f64, b: &f64| (a - b).abs() < 1e-9;
    let are_near_points = |a: &Vector, b: &Vector| are_near(&a.x, &b.x) && are_near(&a.y, &b.y);
    let are_equal_shapes = |a: &Shape, b: &Shape| {
        are_near(&a.radius, &b.radius) && all_equal(&a.points, &b.points, are_near_points)
    };
    all_equal(a, b, |a, b| {
        all_equal(&a.z, &b.z, are_near)
            && all_equal(&a.insets, &b.insets, are_near)
            && all_equal(&a.filled_shapes, &b.filled_shapes, are_equal_shapes)
            && all_equal(&a.cut_shapes, &b.cut_shapes, are_equal_shapes)
    })
}

/// Joins the names of several bodies: `link A1 A3`; only the noun if there are four; the first name if the nouns
/// differ.
fn join_names(names: &[String]) -> String {
    let (nouns, owners): (Vec<_>, Vec<_>) = names.iter().map(|name| split_name(name)).unzip();
    match names.len() {
        2.. if nouns.iter().any(|noun| *noun != nouns[0]) => names[0].clone(),
        4 => nouns[0].to_owned(),
        2.. => format!("{} {}", nouns[0], owners.join(" ")),
        _ => names.concat(),
    }
}
