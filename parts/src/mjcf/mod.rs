//! The robot as a model for MuJoCo, so that an engine by other people can let it walk.
//!
//! Every part of the assembly becomes part of a rigid body, with the mass and the inertia
//! of its own volume, at its place in the assembly. Hinges and slides join the bodies as
//! pins and sleeves do; a constraint closes each loop. The file knows nothing of walking:
//! it has servos, pads and a floor.
//!
//! # Simplifications
//! - Only pads and floor touch each other. A separate proof shows that no two parts meet
//!   ([`crate::Proof`]).
//! - A foot's leaf lets its post move straight up and down on a spring. Links do not bend.
//! - A servo is a motor whose torque falls with its speed, whose rotor takes 20 ms to
//!   spin up, with a gain that applies the full torque at three degrees of error. It has
//!   no dead band.
//! - The friction of the pads is equal in all directions.

mod closed;
mod inertia;
mod node;
mod scene;

use std::fmt::Write as _;

use lizard_kinematics::{Solution, Vector};
use lizard_robot::servo::{LEGS, NAMES};
use lizard_robot::{FRAMES_PER_SECOND, GRAVITY, SLOT};
use xmlwriter::{Indent, Options, XmlWriter};

use crate::assembly::Assembly;
use crate::bill::{self, Bill};
use crate::body::{Body, Kind, Mount, Prism};
use crate::mesh::Mesh;
use crate::outline::Outline;
use crate::part::volume;
use crate::placement::Placement;
use crate::shape::Shape;
use crate::solid::Solid;
use crate::unfit::Unfit;
use inertia::Inertia;
use node::{Moves, Node};
pub use scene::{Course, Motor, Pull, Scene};

/// Metres in a mm, kg in a g.
const MILLI: f64 = 1e-3;
/// kg m^2 in a g mm^2.
const MILLI_CUBED: f64 = 1e-9;
/// Time of a step, s.
const STEP: f64 = 0.0002;
/// Radius of a pad, mm: that of the post above it.
const PAD: f64 = 5.0;
/// What of a foot is nearer to its middle than this is its post, mm; the rest is the leaf
/// and what holds it.
const POST: f64 = 8.0;
/// At this error a servo turns with all that it has, deg.
const FULL: f64 = 3.0;
/// What a servo's rotor takes to come to its speed without load, s. Behind its gears it is
/// far heavier to turn than a leg, and so smooths the steps of its pulses.
const SPIN_UP: f64 = 0.02;
/// Damping of a foot on its leaf over the critical one of a quarter of the robot.
const DAMPING: f64 = 0.4;
/// How hard constraints and contacts are, s and damping ratio. A floor that gives would take
/// a part of what a foot is too long.
const HARD: &str = "0.002 1";
const CONTACT: &str = "0.001 1";
const FIRM: &str = "0.95 0.99 0.0005";

/// The file.
///
/// # Errors
/// [`Unfit::Surface`] for a part whose layers do not make a body.
pub fn mjcf(assembly: &Assembly, neutral: &Solution, scene: &Scene) -> Result<String, Unfit> {
    Ok(Pieces::of(assembly, scene)?.mjcf(neutral, scene))
}

/// The shapes and masses of a robot, for more than one file: they take far longer to make
/// than the rest.
pub struct Pieces<'a> {
    assembly: &'a Assembly,
    pieces: Vec<Piece>,
}

impl<'a> Pieces<'a> {
    /// Those of a scene.
    ///
    /// # Errors
    /// As [`mjcf`].
    pub fn of(assembly: &'a Assembly, scene: &Scene) -> Result<Self, Unfit> {
        let pieces = pieces(assembly, scene)?;
        Ok(Self { assembly, pieces })
    }

    /// The file of a scene that has struts and play as the one that these were made for.
    #[must_use]
    pub fn mjcf(&self, neutral: &Solution, scene: &Scene) -> String {
        let options = Options {
            indent: Indent::Spaces(1),
            ..Options::default()
        };
        let mut writer = Writer {
            assembly: self.assembly,
            neutral,
            scene,
            pieces: &self.pieces,
            xml: XmlWriter::new(options),
        };
        writer.document();
        writer.xml.end_document()
    }
}

/// Some layers of a part, on the body of the file that they move with.
struct Piece {
    name: String,
    node: Node,
    kind: Kind,
    mesh: Mesh,
    inertia: Inertia,
}

fn pieces(assembly: &Assembly, scene: &Scene) -> Result<Vec<Piece>, Unfit> {
    let slotted = scene.pull.is_some();
    let is_strut = |body: &&Body| matches!(body.mount, Mount::Strut(_));
    let has = |bodies: &[Body]| bodies.iter().any(|body| body.kind == Kind::Spring);
    // The other kind of strut lies in the drawer.
    let swap = has(assembly.bodies()) != slotted;
    let own = assembly
        .bodies()
        .iter()
        .filter(|body| !(swap && is_strut(body)));
    let other = assembly
        .instead()
        .iter()
        .filter(|body| swap && is_strut(body));
    let springs = (0..4)
        .filter(|_| swap && slotted)
        .map(|servo| spring(assembly, servo));
    let mut pieces: Vec<Piece> = springs.collect();
    for body in own.chain(other) {
        let grams = bill::grams(body, assembly);
        let volume = volume(&body.prisms);
        for (node, prisms) in shares(assembly, scene, body) {
            let name = match node {
                Node::Of(_) => body.name.clone(),
                node if body.kind == Kind::Printed => format!("{} of {}", node.name(), body.name),
                _ => body.name.clone(),
            };
            let solid = Solid::of(&prisms);
            let mesh = Mesh::of(&solid);
            if !solid.is_closed() || !mesh.is_closed() {
                return Err(Unfit::Surface(name));
            }
            let inertia = Inertia::of(&mesh).scaled(grams / volume);
            let kind = body.kind;
            pieces.push(Piece {
                name,
                node,
                kind,
                mesh,
                inertia,
            });
        }
    }
    Ok(pieces)
}

/// The spring of a strut that the robot has not, but could have: it is in no drawer, so it is
/// taken for a bar of its coil's width from screw to screw.
fn spring(assembly: &Assembly, servo: usize) -> Piece {
    let coil = assembly.robot().parts().spring;
    let length = assembly.layout().legs[servo].strut_length;
    let radius = coil.outer / 2.0;
    let middle = assembly.stack().strut[1];
    let bar = Prism {
        add: vec![Shape::rectangle(
            Vector::new(length / 2.0, 0.0),
            Vector::new(length - 2.0 * coil.outer, coil.outer),
            0.0,
        )],
        cut: Vec::new(),
        z: [middle - radius, middle + radius],
    };
    let mesh = Mesh::of(&Solid::of(&[bar]));
    let shape = Inertia::of(&mesh);
    Piece {
        name: format!("spring {}", LEGS[servo]),
        node: Node::Slot(servo),
        kind: Kind::Spring,
        inertia: shape.scaled(bill::spring(&coil) / shape.mass),
        mesh,
    }
}

/// Which of its layers move with which body of the file: mostly all with one.
fn shares(assembly: &Assembly, scene: &Scene, body: &Body) -> Vec<(Node, Vec<Prism>)> {
    let of = |node: Node| vec![(node, body.prisms.clone())];
    match body.mount {
        Mount::Foot(servo) => {
            let foot = assembly.layout().legs[servo].foot;
            let post = |prism: &&Prism| (middle(prism) - foot).length() < POST;
            let (post, rest): (Vec<&Prism>, Vec<&Prism>) = body.prisms.iter().partition(post);
            [(Node::Pad(servo), post), (Node::Of(body.mount), rest)]
                .into_iter()
                .filter(|(_, prisms)| !prisms.is_empty())
                .map(|(node, prisms)| (node, prisms.into_iter().cloned().collect()))
                .collect()
        }
        Mount::Link(servo) if body.kind == Kind::Horn && scene.play > 0.0 => of(Node::Horn(servo)),
        Mount::Strut(servo) if body.kind == Kind::Spring => of(Node::Slot(servo)),
        mount => of(Node::Of(mount)),
    }
}

fn middle(prism: &Prism) -> Vector {
    let outline = Outline::of(prism);
    outline.moment() * (1.0 / outline.area())
}

struct Writer<'a> {
    assembly: &'a Assembly,
    neutral: &'a Solution,
    scene: &'a Scene,
    pieces: &'a [Piece],
    xml: XmlWriter,
}

impl<'a> Writer<'a> {
    /// An element without children.
    fn element(&mut self, name: &str, attributes: &[(&str, String)]) {
        self.open(name, attributes);
        self.xml.end_element();
    }

    fn open(&mut self, name: &str, attributes: &[(&str, String)]) {
        self.xml.start_element(name);
        for (name, value) in attributes {
            self.xml.write_attribute(name, &escaped(value));
        }
    }

    fn document(&mut self) {
        self.open("mujoco", &[("model", self.scene.name.clone())]);
        self.element(
            "compiler",
            &[
                ("angle", "radian".to_owned()),
                ("autolimits", "true".to_owned()),
            ],
        );
        self.element(
            "option",
            &[
                ("timestep", STEP.to_string()),
                ("gravity", format!("0 0 {}", -GRAVITY)),
                ("integrator", "implicitfast".to_owned()),
                // Feet of a few g chatter on the default contacts.
                ("cone", "elliptic".to_owned()),
                ("impratio", "100".to_owned()),
                ("noslip_iterations", "20".to_owned()),
            ],
        );
        self.open("visual", &[]);
        self.element("map", &[("znear", "0.01".to_owned())]);
        self.element(
            "global",
            &[
                ("offwidth", "1280".to_owned()),
                ("offheight", "960".to_owned()),
            ],
        );
        self.xml.end_element();
        self.element(
            "statistic",
            &[
                ("extent", "0.3".to_owned()),
                ("center", "0 0 0.03".to_owned()),
            ],
        );
        self.defaults();
        if let Some(course) = &self.scene.course {
            self.open("custom", &[]);
            let data = format!("{} {}", round(course.begin), round(course.period));
            self.element("numeric", &[("name", "cycle".to_owned()), ("data", data)]);
            self.xml.end_element();
        }
        self.assets();
        self.world();
        self.loops();
        self.actuators();
        self.course();
    }

    fn defaults(&mut self) {
        self.open("default", &[]);
        self.element(
            "geom",
            &[("contype", "0".to_owned()), ("conaffinity", "0".to_owned())],
        );
        self.element("mesh", &[("scale", "0.001 0.001 0.001".to_owned())]);
        self.element(
            "equality",
            &[
                ("solref", HARD.to_owned()),
                ("solimp", "0.99 0.999 0.0001".to_owned()),
            ],
        );
        self.xml.end_element();
    }

    fn assets(&mut self) {
        self.open("asset", &[]);
        let texture = |name: &str, kind: &str, from: &str, to: &str| {
            vec![
                ("name", name.to_owned()),
                ("type", kind.to_owned()),
                (
                    "builtin",
                    if kind == "2d" { "checker" } else { "gradient" }.to_owned(),
                ),
                ("rgb1", from.to_owned()),
                ("rgb2", to.to_owned()),
                ("width", "256".to_owned()),
                ("height", "256".to_owned()),
            ]
        };
        self.element(
            "texture",
            &texture("sky", "skybox", "0.9 0.95 1", "0.6 0.7 0.8"),
        );
        self.element(
            "texture",
            &texture("floor", "2d", "0.75 0.75 0.72", "0.82 0.82 0.8"),
        );
        self.element(
            "material",
            &[
                ("name", "floor".to_owned()),
                ("texture", "floor".to_owned()),
                // A square is 5 cm wide.
                ("texrepeat", "10 10".to_owned()),
                ("texuniform", "true".to_owned()),
            ],
        );
        for piece in self.shown() {
            let mut vertex = String::new();
            for corner in &piece.mesh.corners {
                let [x, y, z] = corner.map(|part| (part * 1e5).round() / 1e5 + 0.0);
                _ = write!(vertex, "{x} {y} {z} ");
            }
            let mut face = String::new();
            for [a, b, c] in &piece.mesh.triangles {
                _ = write!(face, "{a} {b} {c} ");
            }
            self.element(
                "mesh",
                &[
                    ("name", piece.name.clone()),
                    ("vertex", vertex.trim_end().to_owned()),
                    ("face", face.trim_end().to_owned()),
                ],
            );
        }
        self.xml.end_element();
    }

    fn world(&mut self) {
        self.open("worldbody", &[]);
        self.element(
            "light",
            &[
                ("pos", "0.3 -0.3 1".to_owned()),
                ("dir", "-0.3 0.3 -1".to_owned()),
                ("type", "directional".to_owned()),
            ],
        );
        self.element(
            "geom",
            &[
                ("name", "floor".to_owned()),
                ("type", "plane".to_owned()),
                ("size", "0 0 0.05".to_owned()),
                ("material", "floor".to_owned()),
                ("conaffinity", "1".to_owned()),
                ("condim", "3".to_owned()),
                ("friction", self.friction()),
                ("solref", CONTACT.to_owned()),
                ("solimp", FIRM.to_owned()),
            ],
        );
        self.body(Node::Of(Mount::Chassis));
        self.xml.end_element();
    }

    /// The parts that can be seen.
    fn shown(&self) -> &'a [Piece] {
        match self.scene.shapes {
            true => self.pieces,
            false => &[],
        }
    }

    /// A pad's: it slides, and neither turns nor rolls against a friction of its own.
    fn friction(&self) -> String {
        format!("{} 0 0", self.assembly.robot().ground().friction)
    }

    fn plays(&self) -> bool {
        self.scene.play > 0.0
    }

    fn place(&self, node: Node) -> Placement {
        self.assembly.place(node.frame(), self.neutral)
    }

    fn body(&mut self, node: Node) {
        let stack = *self.assembly.stack();
        let carrier = node.carrier(self.plays());
        let place = match carrier {
            Some(carrier) => self.place(node).seen_from(&self.place(carrier)),
            None => Placement::CHASSIS,
        };
        // The pads' undersides are on the floor, the longest foot's too.
        let longest = self.scene.long.into_iter().fold(0.0, f64::max);
        let up = match carrier {
            Some(_) => 0.0,
            None => longest - stack.floor,
        };
        let half = place.turn.angle().to_radians() / 2.0;
        self.open(
            "body",
            &[
                ("name", node.name()),
                ("pos", metres([place.at.x, place.at.y, up])),
                (
                    "quat",
                    format!("{} 0 0 {}", round(half.cos()), round(half.sin())),
                ),
            ],
        );
        self.joint(node);
        let mass = self
            .pieces
            .iter()
            .filter(|piece| piece.node == node)
            .fold(self.loose(node), |sum, piece| sum.and(&piece.inertia));
        let tensor = mass
            .tensor()
            .map(|part| format!("{:.6e}", part * MILLI_CUBED));
        self.element(
            "inertial",
            &[
                ("pos", metres(mass.centre())),
                ("mass", round(mass.mass * MILLI).to_string()),
                ("fullinertia", tensor.join(" ")),
            ],
        );
        for piece in self.shown().iter().filter(|piece| piece.node == node) {
            self.element(
                "geom",
                &[
                    ("type", "mesh".to_owned()),
                    ("mesh", piece.name.clone()),
                    ("rgba", colour(piece.kind).to_owned()),
                ],
            );
        }
        if let Node::Pad(servo) = node {
            let foot = self.assembly.layout().legs[servo].foot;
            let z = stack.floor - self.scene.long[servo] + PAD;
            self.element(
                "geom",
                &[
                    ("name", format!("pad {}", LEGS[servo])),
                    ("type", "sphere".to_owned()),
                    ("size", round(PAD * MILLI).to_string()),
                    ("pos", metres([foot.x, foot.y, z])),
                    ("rgba", "0.15 0.15 0.15 1".to_owned()),
                    ("contype", "1".to_owned()),
                    ("condim", "3".to_owned()),
                    ("friction", self.friction()),
                    ("solref", CONTACT.to_owned()),
                    ("solimp", FIRM.to_owned()),
                ],
            );
        }
        if carrier.is_none() {
            self.element(
                "camera",
                &[
                    ("name", "beside".to_owned()),
                    ("mode", "trackcom".to_owned()),
                    ("pos", "0.24 -0.21 0.2".to_owned()),
                    ("xyaxes", "0.66 0.75 0 -0.39 0.34 0.86".to_owned()),
                ],
            );
        }
        for child in Node::all(self.scene.pull.is_some(), self.plays()) {
            if child.carrier(self.plays()) == Some(node) {
                self.body(child);
            }
        }
        self.xml.end_element();
    }

    /// What the bill weighs and no body is drawn of, such as wires: it is taken to be in the
    /// plate's middle.
    fn loose(&self, node: Node) -> Inertia {
        if node != Node::Of(Mount::Chassis) {
            return Inertia::default();
        }
        let all = Bill::of(self.assembly, &[], self.neutral).grams;
        let bodies = self.assembly.bodies().iter();
        let drawn: f64 = bodies.map(|body| bill::grams(body, self.assembly)).sum();
        Inertia::point((all - drawn).max(0.0))
    }

    /// The joint of a body with what carries it, which has its name.
    fn joint(&mut self, node: Node) {
        let mut of = vec![("name", node.name())];
        let kind = |kind: &str| ("type", kind.to_owned());
        let axis = |axis: &str| ("axis", axis.to_owned());
        match node.moves() {
            Moves::Free => {
                self.element("freejoint", &of);
                return;
            }
            Moves::Turns => of.extend([kind("hinge"), axis("0 0 1")]),
            Moves::Along => of.extend([kind("slide"), axis("1 0 0")]),
            Moves::Upright => of.extend([kind("slide"), axis("0 0 1")]),
        }
        if self.motor_on(node).is_some() {
            // What the motor's own voltage takes from its torque as it turns faster.
            let Motor { rate, stall } = self.scene.motor;
            let damping = stall * MILLI / rate.to_radians();
            of.push(("damping", round(damping).to_string()));
            of.push(("armature", round(damping * SPIN_UP).to_string()));
        }
        match (node, self.scene.pull) {
            (Node::Of(Mount::Link(_)), _) if self.plays() => {
                let play = round(self.scene.play.to_radians());
                of.push(("range", format!("{} {play}", -play)));
                of.extend(limits());
                // Grease: a link that is free in its play does not ring.
                of.push(("damping", "0.00001".to_owned()));
            }
            (Node::Pad(_), _) => {
                let stiffness = self.scene.stiffness / MILLI;
                let quarter = self.assembly.robot().ground().body.mass * MILLI / 4.0;
                let damping = DAMPING * 2.0 * (stiffness * quarter).sqrt();
                of.push(("stiffness", round(stiffness).to_string()));
                of.push(("damping", round(damping).to_string()));
            }
            (Node::Slot(_), Some(Pull { force, rate })) => {
                of.push(("range", format!("0 {}", round(SLOT * MILLI))));
                of.extend(limits());
                of.push(("stiffness", round(rate / MILLI).to_string()));
                of.push(("springref", round(-force / rate * MILLI).to_string()));
                of.push(("damping", "0.1".to_owned()));
            }
            _ => {}
        }
        self.element("joint", &of);
    }

    /// The servo whose motor turns a body.
    fn motor_on(&self, node: Node) -> Option<usize> {
        match node {
            Node::Horn(servo) => Some(servo),
            Node::Of(Mount::Link(servo)) if !self.plays() => Some(servo),
            _ => None,
        }
    }

    fn loops(&mut self) {
        self.open("equality", &[]);
        for closed in closed::all(self.assembly, self.scene.pull.is_some()) {
            let [first, second] = closed.bodies.map(Node::name);
            self.element(
                "connect",
                &[
                    ("name", closed.name),
                    ("body1", first),
                    ("body2", second),
                    ("anchor", metres([closed.at.x, closed.at.y, 0.0])),
                ],
            );
        }
        self.xml.end_element();
    }

    fn actuators(&mut self) {
        self.open("actuator", &[]);
        let stall = self.scene.motor.stall * MILLI;
        for (servo, name) in NAMES.iter().enumerate() {
            let joint = match self.plays() {
                true => Node::Horn(servo),
                false => Node::Of(Mount::Link(servo)),
            };
            let (least, most) = self.assembly.robot().servos()[servo].travel();
            let [least, most] = [least, most].map(|angle| round(angle.to_radians()));
            self.element(
                "position",
                &[
                    ("name", (*name).to_owned()),
                    ("joint", joint.name()),
                    ("kp", round(stall / FULL.to_radians()).to_string()),
                    ("forcerange", format!("{} {}", round(-stall), round(stall))),
                    ("ctrlrange", format!("{least} {most}")),
                ],
            );
        }
        self.xml.end_element();
    }

    /// A keyframe for each frame of 20 ms: its time, and the angles for the servos.
    fn course(&mut self) {
        let Some(course) = &self.scene.course else {
            return;
        };
        self.open("keyframe", &[]);
        for (frame, targets) in course.frames.iter().enumerate() {
            let time = round(frame as f64 / FRAMES_PER_SECOND);
            let targets = targets.map(|angle| round(angle.to_radians()).to_string());
            self.element(
                "key",
                &[
                    ("name", format!("{} {time:.2}", course.gait)),
                    ("time", time.to_string()),
                    ("ctrl", targets.join(" ")),
                ],
            );
        }
        self.xml.end_element();
    }
}

fn limits() -> [(&'static str, String); 2] {
    [
        ("solreflimit", HARD.to_owned()),
        ("solimplimit", "0.99 0.999 0.0001".to_owned()),
    ]
}

/// mm as the file has them.
fn metres(at: [f64; 3]) -> String {
    at.map(|part| round(part * MILLI).to_string()).join(" ")
}

/// To a billionth, without a minus before 0.
fn round(value: f64) -> f64 {
    (value * 1e9).round() / 1e9 + 0.0
}

/// The writer of XML escapes quotes alone.
fn escaped(value: &str) -> String {
    value.replace('&', "&amp;").replace('<', "&lt;")
}

fn colour(kind: Kind) -> &'static str {
    match kind {
        Kind::Printed => "0.36 0.62 0.36 1",
        Kind::Servo => "0.15 0.3 0.65 1",
        Kind::Horn => "0.95 0.95 0.95 1",
        Kind::Board => "0.0 0.5 0.55 1",
        Kind::Battery => "0.25 0.25 0.28 1",
        _ => "0.6 0.6 0.62 1",
    }
}
