//! The legs: crank, follower, coupler with the foot, and the screws that join them.
//!
//! A stiff robot on four stiff feet rocks: two feet across from each other carry nearly
//! all of its weight. So each foot is on a leaf that yields, and a screw sets its height.
//! The friction of the pad would bend a leaf high above the floor and turn the foot. So a
//! column leads down, and the leaf is low.

use lizard_kinematics::Vector;

use crate::bodies::builder::{Bolt, Builder, Points};
use crate::bodies::names::names;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::{LEAF, PLAY};

/// Radius of what is around a foot's nut, and of a pad, mm.
const TIP: f64 = 5.0;
const PAD: f64 = 4.0;
/// From the follower's joint to the two screws of the foot's column, mm.
const CLAMPS: [f64; 2] = [21.0, 9.0];
/// Length of these screws, which cut their thread into the column, mm.
const CLAMP_SCREW: f64 = 10.0;
/// How deep its holes are, mm.
const CLAMP_HOLE: f64 = 10.0;
/// Half the width of the column, mm.
const COLUMN: f64 = 3.2;
/// Length of the screw that sets a foot's height, mm.
const FOOT_SCREW: f64 = 10.0;
/// Young's modulus of PLA, N/mm^2.
const PLA: f64 = 3000.0;
/// What a leaf gives, N/mm: with 0.4 to 0.6 a foot that is 1 mm too long costs no gait
/// more than a twentieth.
const YIELD: f64 = 0.5;

/// The free length of a leaf: of a beam that is held at one end, the force at the other
/// is E b t^3 / (4 L^3) for each mm.
fn leaf_length(width: f64) -> f64 {
    libm::cbrt(PLA * width * (LEAF * LEAF * LEAF) / (4.0 * YIELD))
}

pub fn add(builder: &mut Builder) {
    for servo in 0..4 {
        crank(builder, servo);
        follower(builder, servo);
        coupler(builder, servo);
        foot(builder, servo);
        screws(builder, servo);
    }
}

/// The leg's crank from its pivot to its joint, in its own frame.
fn to_joint(builder: &Builder, servo: usize) -> Vector {
    builder.layout.legs[servo].joint
}

fn crank(builder: &mut Builder, servo: usize) {
    let (_, leg) = names(servo);
    let (stack, parts) = (builder.stack, builder.parts);
    let anchor = builder.layout.legs[servo].anchor;
    let (pivot, joint) = (Vector::default(), to_joint(builder, servo));
    let half = builder.half();
    let add = vec![
        Shape::disc(pivot, half + 1.0),
        Shape::bar(pivot, joint, half),
        Shape::bar(pivot, anchor, half - 0.01),
        Shape::disc(anchor, builder.eye()),
    ];
    let holes = [builder.hole(pivot), builder.hole(joint)];
    let layer = |add: Vec<Shape>, more: Vec<Shape>, z: [f64; 2]| Prism {
        add,
        cut: [&holes[..], &more].concat(),
        z,
    };
    let (nut, _) = stack.anchor_nut(parts);
    let nut = nut.clamp(stack.crank[0], stack.crank[1]);
    let bosses = vec![
        Shape::disc(pivot, half - 0.2),
        Shape::disc(anchor, half - 0.4),
    ];
    let bearing = vec![Shape::disc(pivot, half - 0.2)];
    let prisms = vec![
        layer(
            add.clone(),
            vec![builder.pocket(anchor)],
            [stack.crank[0], nut],
        ),
        layer(add, vec![builder.hole(anchor)], [nut, stack.crank[1]]),
        layer(bosses, vec![builder.hole(anchor)], stack.anchor),
        layer(bearing, Vec::new(), [stack.anchor[1], stack.bearing[1]]),
    ];
    let prisms = prisms
        .into_iter()
        .filter(|prism| prism.z[1] > prism.z[0] + 1e-9)
        .collect();
    builder.body(
        format!("crank {leg}"),
        Kind::Printed,
        Mount::Crank(servo),
        prisms,
    );
}

fn follower(builder: &mut Builder, servo: usize) {
    let (_, leg) = names(servo);
    let stack = builder.stack;
    let (pivot, joint) = (Vector::default(), to_joint(builder, servo));
    let half = builder.half();
    let holes = [builder.hole(pivot), builder.hole(joint)];
    let bar = Prism {
        add: vec![
            Shape::disc(pivot, half + 1.0),
            Shape::bar(pivot, joint, half),
        ],
        cut: holes.to_vec(),
        z: stack.crank,
    };
    let bearing = Prism {
        add: vec![Shape::disc(pivot, half - 0.2)],
        cut: holes[..1].to_vec(),
        z: stack.bearing,
    };
    builder.body(
        format!("follower {leg}"),
        Kind::Printed,
        Mount::Follower(servo),
        vec![bar, bearing],
    );
}

/// Where the foot's column is screwed to the coupler.
fn clamps(builder: &Builder) -> [Vector; 2] {
    let ground = builder.robot.lizard().leg.ground;
    CLAMPS.map(|before| Vector::new(ground - before, 0.0))
}

/// Where the heads of these screws bear, sunk into the coupler.
fn clamp_seat(builder: &Builder) -> f64 {
    builder.stack.leg_coupler[1] - builder.parts.screw.head_height - PLAY
}

fn coupler(builder: &mut Builder, servo: usize) {
    let (_, leg) = names(servo);
    let stack = builder.stack;
    let (from, to) = (
        Vector::default(),
        Vector::new(builder.robot.lizard().leg.ground, 0.0),
    );
    let clamps = clamps(builder);
    let through = clamps.map(|at| builder.hole(at));
    let sunk = clamps.map(|at| builder.sink(at));
    let joints = [builder.hole(from), builder.hole(to)];
    let mut bar = vec![Shape::bar(from, to, builder.half())];
    bar.extend(clamps.map(|at| Shape::disc(at, builder.around_head())));
    let seat = clamp_seat(builder);
    let prisms = vec![
        Prism {
            add: bar.clone(),
            cut: [joints.clone(), through].concat(),
            z: [stack.leg_coupler[0], seat],
        },
        Prism {
            add: bar,
            cut: [joints, sunk].concat(),
            z: [seat, stack.leg_coupler[1]],
        },
    ];
    builder.body(
        format!("leg coupler {leg}"),
        Kind::Printed,
        Mount::Foot(servo),
        prisms,
    );
}

fn foot(builder: &mut Builder, servo: usize) {
    let (_, leg) = names(servo);
    let stack = builder.stack;
    let at = builder.layout.legs[servo].foot;
    let clamps = clamps(builder);
    let half = builder.half();
    // The column begins where the leaf's free length ends.
    let away = clamps[0] - at;
    let toward = away * (1.0 / away.length());
    let root = at + toward * (leaf_length(builder.parts.bar) + COLUMN);
    let column = vec![
        Shape::bar(clamps[0], clamps[1], COLUMN),
        Shape::bar(clamps[0], root, COLUMN - 0.01),
    ];
    let tip = Shape::disc(at, TIP);
    let leaf = vec![
        Shape::bar(root, at, half),
        tip.clone(),
        Shape::bar(clamps[0], clamps[1], half - 0.01),
        Shape::bar(clamps[0], root, half - 0.02),
    ];
    let (pocket, hole) = (builder.pocket(at), builder.hole(at));
    let threads = clamps.map(|at| builder.thread(at));
    let [_, boss] = stack.boss_of_foot;
    let nut = stack.leaf[0] + builder.parts.screw.nut_height;
    let holes = stack.leg_coupler[0] - CLAMP_HOLE;
    let with_tip = |cut: &Shape, z: [f64; 2]| Prism {
        add: [&column[..], std::slice::from_ref(&tip)].concat(),
        cut: vec![cut.clone()],
        z,
    };
    let prisms = vec![
        Prism {
            add: leaf,
            cut: vec![pocket.clone()],
            z: stack.leaf,
        },
        with_tip(&pocket, [stack.leaf[1], nut]),
        with_tip(&hole, [nut, boss]),
        Prism {
            add: column.clone(),
            cut: Vec::new(),
            z: [boss, holes],
        },
        Prism {
            add: column.clone(),
            cut: threads.to_vec(),
            z: [holes, stack.leg_coupler[0]],
        },
    ];
    let mount = Mount::Foot(servo);
    builder.body(format!("foot {leg}"), Kind::Printed, mount, prisms);
    for (number, at) in clamps.into_iter().enumerate() {
        let bolt = Bolt {
            name: &format!("foot {leg} {}", number + 1),
            mount,
            at,
            head: clamp_seat(builder),
            points: Points::Down,
            nut: 0.0,
            length: None,
            meets: &[],
            hex: false,
        };
        builder.screw(&bolt, CLAMP_SCREW);
    }
    let head = stack.pad[1] + builder.parts.screw.head_height;
    let bolt = Bolt {
        name: &format!("height {leg}"),
        mount,
        at,
        head,
        points: Points::Up,
        nut: 0.0,
        length: None,
        meets: &[],
        hex: false,
    };
    builder.screw(&bolt, FOOT_SCREW);
    let layer = |shape: Shape, cut: Vec<Shape>, z: [f64; 2]| Prism {
        add: vec![shape],
        cut,
        z,
    };
    let screw = builder.parts.screw;
    let thread = vec![Shape::disc(at, screw.diameter / 2.0)];
    let sunk = layer(Shape::hexagon(at, screw.nut), thread, [stack.leaf[0], nut]);
    builder.body(format!("height nut {leg}"), Kind::Nut, mount, vec![sunk]);
    let pad = layer(Shape::disc(at, PAD), Vec::new(), stack.pad);
    builder.body(format!("pad {leg}"), Kind::Pad, mount, vec![pad]);
}

fn screws(builder: &mut Builder, servo: usize) {
    let (_, leg) = names(servo);
    let (stack, parts) = (builder.stack, builder.parts);
    let (pivot, joint) = (Vector::default(), to_joint(builder, servo));
    let (plate, carries) = ("plate".to_owned(), format!("leg coupler {leg}"));
    for (mount, name) in [
        (Mount::Crank(servo), "crank"),
        (Mount::Follower(servo), "follower"),
    ] {
        builder.bolt(&Bolt {
            name: &format!("{name} pivot {leg}"),
            mount,
            at: pivot,
            head: stack.bearing[1] + PLAY,
            points: Points::Down,
            nut: stack.plate[0] - PLAY,
            length: None,
            meets: &[&plate],
            hex: false,
        });
        builder.bolt(&Bolt {
            name: &format!("{name} joint {leg}"),
            mount,
            at: joint,
            head: stack.leg_coupler[0],
            points: Points::Up,
            nut: stack.crank[1] + PLAY,
            length: None,
            meets: &[&carries],
            hex: false,
        });
    }
    let (nut, length) = stack.anchor_nut(parts);
    builder.bolt(&Bolt {
        name: &format!("leg anchor {leg}"),
        mount: Mount::Crank(servo),
        at: builder.layout.legs[servo].anchor,
        head: stack.on_hook,
        points: Points::Down,
        nut,
        length: Some(length),
        meets: &[&builder.strut(leg)],
        hex: false,
    });
}
