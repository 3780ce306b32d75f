//! What is made for a body: a part as it lies on the printer's bed, and how many of it.

use lizard_kinematics::{Side, Vector};
use lizard_robot::servo::{LEGS, NAMES};

use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::mark;
use crate::layers::outline::Outline;
use crate::layers::placement::Placement;
use crate::layers::roof;
use crate::layers::shape::Shape;

/// Rings are known by their length, not by where they are.
const SPACER: &str = "spacer";

/// A printed part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name: `link A1 A3` is twice the same, for A1 and for A3.
    pub name: String,
    /// The bodies that are made so.
    pub bodies: Vec<String>,
    /// Its layers as it is printed: from z = 0 up, the larger face below.
    pub prisms: Vec<Prism>,
    /// Whether it lies on its back to be printed.
    pub turned: bool,
    /// What it may be put in instead of; `None` of a part that the robot has.
    pub instead_of: Option<String>,
    /// The numbers of its servos, which are engraved where a part comes in several kinds:
    /// `13` for A1 and A3. Empty of others.
    pub mark: String,
}

impl Part {
    /// How many are needed.
    #[must_use]
    pub fn count(&self) -> usize {
        self.bodies.len()
    }

    /// The name of its files, without an ending.
    #[must_use]
    pub fn file(&self) -> String {
        self.name.replace(' ', "-")
    }

    /// Its layers as they are printed: with its mark, and with the holes closed that would
    /// begin in the air; and how many those are.
    #[must_use]
    pub fn printed(&self) -> (Vec<Prism>, usize) {
        let marked = mark::engraved(&self.prisms, &self.mark);
        roof::closed(&marked.unwrap_or_else(|| self.prisms.clone()))
    }

    /// The middles of the holes that are to be drilled, as the part is printed, mm.
    #[must_use]
    pub fn closed_holes(&self) -> Vec<Vector> {
        roof::in_air(&self.prisms)
    }

    /// How the part as it is printed becomes one of its bodies, in that body's frame.
    #[must_use]
    pub fn lies(&self, body: &Body) -> Lies {
        let [low, high] = body.z();
        Lies {
            flipped: self.turned,
            lift: if self.turned { high } else { low },
            home: home(body),
        }
    }

    /// Its volume, mm^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        volume(&self.prisms)
    }
}

/// How a printed part is laid into its body's frame: turned over if need be, lifted, then
/// turned and shifted in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lies {
    /// Whether it is turned over first: x, y, z to x, -y, -z.
    pub flipped: bool,
    /// By how much it is lifted then, mm.
    pub lift: f64,
    /// Where the printed part's own frame is in the body's.
    pub home: Placement,
}

/// The volume of some layers, mm^3.
pub(crate) fn volume(prisms: &[Prism]) -> f64 {
    prisms
        .iter()
        .map(|prism| Outline::of(prism).area() * (prism.z[1] - prism.z[0]))
        .sum()
}

impl Assembly {
    /// Every printed part, each kind once; those that may be put in instead of others
    /// come last.
    #[must_use]
    pub fn parts(&self) -> Vec<Part> {
        let mut parts = kinds(self.bodies());
        let is_strut = |part: &&Part| {
            let first = self.body(&part.bodies[0]);
            first.is_some_and(|body| matches!(body.mount, Mount::Strut(_)))
        };
        let strut = parts.iter().find(is_strut).map(|part| part.name.clone());
        parts.extend(kinds(self.instead()).into_iter().map(|part| Part {
            instead_of: strut.clone(),
            ..part
        }));
        let several: Vec<_> = parts.iter().map(|part| what(&part.bodies[0])).collect();
        for (number, part) in parts.iter_mut().enumerate() {
            let alone = several.iter().filter(|of| **of == several[number]).count() == 1;
            if !alone {
                part.mark = numbers(&part.bodies);
            }
        }
        parts
    }
}

/// A body's name without what it is of: `link` of `link A1`.
fn what(name: &str) -> String {
    let (what, _) = name.rsplit_once(' ').unwrap_or((name, ""));
    what.to_owned()
}

/// The numbers of the servos that some bodies are of.
fn numbers(names: &[String]) -> String {
    let mut numbers: Vec<usize> = Vec::new();
    for name in names {
        let of = name.rsplit_once(' ').map_or("", |(_, of)| of);
        let servo = |list: [&str; 4]| list.iter().position(|known| *known == of);
        let side = Side::ALL.into_iter().find(|side| side.name() == of);
        numbers.extend(servo(NAMES).or(servo(LEGS)));
        numbers.extend(side.into_iter().flat_map(Side::servos));
    }
    numbers.sort_unstable();
    numbers
        .iter()
        .map(|servo| (servo + 1).to_string())
        .collect()
}

/// The printed parts that some bodies are made as.
fn kinds(bodies: &[Body]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for body in bodies.iter().filter(|body| body.kind == Kind::Printed) {
        let (prisms, turned) = lying(body);
        match parts.iter_mut().find(|part| alike(&part.prisms, &prisms)) {
            Some(part) => part.bodies.push(body.name.clone()),
            None => parts.push(Part {
                name: String::new(),
                bodies: vec![body.name.clone()],
                prisms,
                turned,
                instead_of: None,
                mark: String::new(),
            }),
        }
    }
    for part in &mut parts {
        part.name = match part.prisms.last() {
            Some(top) if part.bodies[0].contains(SPACER) => {
                format!("{SPACER} {:.1}", top.z[1])
            }
            _ => together(&part.bodies),
        };
    }
    parts
}

/// A body's layers as they are printed, and whether they lie on their back. Its first
/// shape is at the origin and its first bar along x, so that what is made alike is known
/// to be alike wherever it is used.
fn lying(body: &Body) -> (Vec<Prism>, bool) {
    let area = |prism: Option<&Prism>| prism.map_or(0.0, |prism| Outline::of(prism).area());
    let turned = area(body.prisms.first()) < 0.7 * area(body.prisms.last());
    let [low, high] = body.z();
    let home = home(body);
    let lay = |shape: &Shape| {
        let points = shape
            .points
            .iter()
            .map(|&point| home.unmap(point))
            .collect();
        let radius = shape.radius;
        let shape = Shape { points, radius };
        if turned { shape.mirrored() } else { shape }
    };
    let mut prisms: Vec<Prism> = body
        .prisms
        .iter()
        .map(|prism| Prism {
            add: prism.add.iter().map(lay).collect(),
            cut: prism.cut.iter().map(lay).collect(),
            z: if turned {
                [high - prism.z[1], high - prism.z[0]]
            } else {
                prism.z.map(|z| z - low)
            },
        })
        .collect();
    prisms.sort_by(|a, b| a.z[0].total_cmp(&b.z[0]));
    (prisms, turned)
}

/// The frame in which a part is drawn.
fn home(body: &Body) -> Placement {
    if body.mount == Mount::Chassis {
        return Placement::CHASSIS;
    }
    let shapes = || body.prisms.iter().flat_map(|prism| &prism.add);
    let at = shapes()
        .next()
        .map_or(Vector::default(), |shape| shape.points[0]);
    let bar = shapes().find_map(|shape| match shape.points[..] {
        [from, to, ..] => Some(to - from),
        _ => None,
    });
    Placement {
        at,
        turn: bar.map_or(Placement::CHASSIS.turn, |bar| bar * (1.0 / bar.length())),
    }
}

/// Whether two parts are one, but for rounding.
fn alike(a: &[Prism], b: &[Prism]) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| {
            let shapes = |a: &[Shape], b: &[Shape]| {
                a.len() == b.len()
                    && a.iter().zip(b).all(|(a, b)| {
                        near(a.radius, b.radius)
                            && a.points.len() == b.points.len()
                            && a.points
                                .iter()
                                .zip(&b.points)
                                .all(|(a, b)| near(a.x, b.x) && near(a.y, b.y))
                    })
            };
            near(a.z[0], b.z[0])
                && near(a.z[1], b.z[1])
                && shapes(&a.add, &b.add)
                && shapes(&a.cut, &b.cut)
        })
}

/// One name for several bodies: what they share, then what they are of.
fn together(names: &[String]) -> String {
    let Some(first) = names.first() else {
        return String::new();
    };
    let what = first.rsplit_once(' ').map_or("", |(what, _)| what);
    let same = |name: &&String| {
        name.rsplit_once(' ')
            .is_some_and(|(other, _)| other == what)
    };
    if names.len() > 1 && names.iter().filter(same).count() == names.len() {
        let owners = names.iter().filter_map(|name| name.rsplit_once(' '));
        let owners: Vec<_> = owners.map(|(_, owner)| owner).collect();
        if owners.len() == 4 {
            return what.to_owned();
        }
        return format!("{what} {}", owners.join(" "));
    }
    first.clone()
}
