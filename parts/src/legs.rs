//! The legs: crank, follower, coupler with the foot, and the screws that join them.

use lizard_kinematics::Vector;

use crate::body::{Kind, Mount, Prism};
use crate::builder::{Bolt, Builder, Points};
use crate::names::names;
use crate::shape::Shape;
use crate::stack::PLAY;

/// Radius of a foot's post, mm.
const POST: f64 = 5.0;
/// From the follower's joint to the two screws of the foot's leaf, mm.
const CLAMPS: [f64; 2] = [21.0, 9.0];

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

/// Where the leaf is screwed to the coupler.
fn clamps(builder: &Builder) -> [Vector; 2] {
    let ground = builder.robot.lizard().leg.ground;
    CLAMPS.map(|before| Vector::new(ground - before, 0.0))
}

fn coupler(builder: &mut Builder, servo: usize) {
    let (_, leg) = names(servo);
    let stack = builder.stack;
    let (from, to) = (
        Vector::default(),
        Vector::new(builder.robot.lizard().leg.ground, 0.0),
    );
    let half = builder.half();
    let clamps = clamps(builder);
    let through = clamps.map(|at| builder.hole(at));
    let sunk = clamps.map(|at| builder.sink(at));
    let joints = [builder.hole(from), builder.hole(to)];
    let bar = vec![Shape::bar(from, to, half)];
    let seat = stack.leg_coupler[1] - builder.parts.screw.head_height - PLAY;
    let prisms = vec![
        Prism {
            add: vec![Shape::bar(clamps[0], clamps[1], half - 0.1)],
            cut: through.to_vec(),
            z: [stack.leaf[1], stack.leg_coupler[0]],
        },
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
    let post = Prism {
        add: vec![Shape::disc(at, POST)],
        cut: Vec::new(),
        z: [stack.floor, stack.leaf[0]],
    };
    let leaf = Prism {
        add: vec![
            Shape::bar(clamps[0], clamps[1], half),
            Shape::bar(clamps[0], at, half - 0.01),
            Shape::disc(at, POST + 1.0),
        ],
        cut: clamps.map(|at| builder.hole(at)).to_vec(),
        z: stack.leaf,
    };
    builder.body(
        format!("foot {leg}"),
        Kind::Printed,
        Mount::Foot(servo),
        vec![post, leaf],
    );
    for (number, at) in clamps.into_iter().enumerate() {
        builder.bolt(&Bolt {
            name: &format!("foot {leg} {}", number + 1),
            mount: Mount::Foot(servo),
            at,
            head: stack.leg_coupler[1] - builder.parts.screw.head_height - PLAY,
            points: Points::Down,
            nut: stack.leaf[0],
            length: None,
            meets: &[],
            hex: false,
        });
    }
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
        head: stack.on_hook(parts),
        points: Points::Down,
        nut: nut - 0.0,
        length: Some(length),
        meets: &[&builder.strut(leg)],
        hex: false,
    });
}
