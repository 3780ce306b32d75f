//! The legs: crank, follower, coupler with the foot, and the screws that join them.
//!
//! A stiff robot on four stiff feet rocks: two diagonal feet carry nearly all of the weight. Each foot is therefore on
//! a leaf spring, and a screw sets its height. The higher the leaf is above the floor, the more the pad's friction
//! bends the leaf and turns the foot, so a column reaches down from the coupler to a low leaf.

use lizard_kinematics::Vector;
use lizard_robot::LegPlan;

use crate::bodies::builder::{Bolt, Builder, Direction};
use crate::bodies::names::servo_and_leg_names;
use crate::bodies::pads;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::{HEAD_PLAY, LEAF_THICKNESS, PAD_LIP_HEIGHT};

/// Radius of the boss around a foot's nut, mm.
const TIP_RADIUS: f64 = 5.0;
/// Distances from the follower's joint to the two screws of the foot's column, mm.
const CLAMP_DISTANCES: [f64; 2] = [21.0, 9.0];
/// Length of the screws that fix the column to the coupler and cut their thread into the column, mm.
const CLAMP_SCREW_LENGTH: f64 = 10.0;
/// Depth of these screws' holes, mm.
const CLAMP_HOLE_DEPTH: f64 = 10.0;
/// Half of the column's width, mm.
const COLUMN_HALF_WIDTH: f64 = 3.2;
/// Length of the screw that sets a foot's height, mm.
const FOOT_SCREW_LENGTH: f64 = 10.0;
/// Young's modulus of PLA, N/mm^2.
const PLA_MODULUS: f64 = 3000.0;
/// Stiffness of a leaf, N/mm. Between 0.4 and 0.6, a foot that is 1 mm too long shortens a gait by at most 5 %.
const LEAF_STIFFNESS: f64 = 0.5;

/// Computes the free length L of a leaf, mm. The stiffness of a beam clamped at one end is E b t^3 / (4 L^3), with
/// Young's modulus E, width b and thickness t.
fn compute_leaf_length(width: f64) -> f64 {
    libm::cbrt(
        PLA_MODULUS * width * (LEAF_THICKNESS * LEAF_THICKNESS * LEAF_THICKNESS)
            / (4.0 * LEAF_STIFFNESS),
    )
}

/// Adds all legs.
pub fn add(builder: &mut Builder) {
    for servo in 0..4 {
        add_crank(builder, servo);
        add_follower(builder, servo);
        add_coupler(builder, servo);
        add_foot(builder, servo);
        add_screws(builder, servo);
    }
}

fn add_crank(builder: &mut Builder, servo: usize) {
    let (_, leg) = servo_and_leg_names(servo);
    let (stack, parts) = (builder.stack, builder.parts);
    let LegPlan {
        anchor,
        crank_joint: joint,
        ..
    } = builder.layout.legs[servo];
    let (pivot, half_width) = (Vector::default(), builder.half_bar_width());
    // The half widths of bars that start at the same point differ by 0.01 mm, so that no two bar ends coincide.
    let filled = [
        Shape::disc(pivot, half_width + 1.0),
        Shape::bar(pivot, joint, half_width),
        Shape::bar(pivot, anchor, half_width - 0.01),
        Shape::disc(anchor, builder.nut_boss_radius()),
    ];
    let holes = [builder.clearance_hole(pivot), builder.clearance_hole(joint)];
    let holes_with = |hole: Shape| [&holes[..], &[hole]].concat();
    let (pocket_holes, through_holes) = (
        holes_with(builder.nut_pocket(anchor)),
        holes_with(builder.clearance_hole(anchor)),
    );
    let (nut_z, _) = stack.anchor_nut_height_and_screw_length(parts);
    let nut_z = nut_z.clamp(stack.crank[0], stack.crank[1]);
    let bearing = Shape::disc(pivot, half_width - 0.2);
    let bosses = [bearing.clone(), Shape::disc(anchor, half_width - 0.4)];
    let mut prisms = vec![
        Prism::new(filled.clone(), pocket_holes, [stack.crank[0], nut_z]),
        Prism::new(filled, through_holes.clone(), [nut_z, stack.crank[1]]),
        Prism::new(bosses, through_holes, stack.anchor),
        Prism::new([bearing], holes, [stack.anchor[1], stack.bearing[1]]),
    ];
    prisms.retain(Prism::has_height);
    builder.add_printed(format!("crank {leg}"), Mount::Crank(servo), prisms);
}

fn add_follower(builder: &mut Builder, servo: usize) {
    let (_, leg) = servo_and_leg_names(servo);
    let (pivot, joint) = (Vector::default(), builder.layout.legs[servo].crank_joint);
    let (stack, half_width) = (builder.stack, builder.half_bar_width());
    let holes = [builder.clearance_hole(pivot), builder.clearance_hole(joint)];
    let bearing = Shape::disc(pivot, half_width - 0.2);
    let bearing = Prism::new([bearing], [holes[0].clone()], stack.bearing);
    let bar = [
        Shape::disc(pivot, half_width + 1.0),
        Shape::bar(pivot, joint, half_width),
    ];
    let prisms = [Prism::new(bar, holes, stack.crank), bearing];
    builder.add_printed(format!("follower {leg}"), Mount::Follower(servo), prisms);
}

/// Positions of the two screws between coupler and foot, coupler frame, mm.
fn clamp_positions(builder: &Builder) -> [Vector; 2] {
    let ground = builder.robot.lizard().leg.ground;
    CLAMP_DISTANCES.map(|distance| Vector::new(ground - distance, 0.0))
}

/// Height of the faces under the sunk heads of the screws between coupler and foot, mm.
fn clamp_seat(builder: &Builder) -> f64 {
    builder.stack.leg_coupler[1] - builder.parts.screw.head_height - HEAD_PLAY
}

fn add_coupler(builder: &mut Builder, servo: usize) {
    let (_, leg) = servo_and_leg_names(servo);
    let stack = builder.stack;
    let ground = builder.robot.lizard().leg.ground;
    let (from, to) = (Vector::default(), Vector::new(ground, 0.0));
    let clamps = clamp_positions(builder);
    let through_holes = clamps.map(|position| builder.clearance_hole(position));
    let head_recesses = clamps.map(|position| builder.head_recess(position));
    let joints = [builder.clearance_hole(from), builder.clearance_hole(to)];
    let mut bar = vec![Shape::bar(from, to, builder.half_bar_width())];
    bar.extend(clamps.map(|position| Shape::disc(position, builder.head_boss_radius())));
    let (seat_z, [low, high]) = (clamp_seat(builder), stack.leg_coupler);
    let through_holes = [joints.clone(), through_holes].concat();
    let prisms = [
        Prism::new(bar.clone(), through_holes, [low, seat_z]),
        Prism::new(bar, [joints, head_recesses].concat(), [seat_z, high]),
    ];
    builder.add_printed(format!("leg coupler {leg}"), Mount::Foot(servo), prisms);
}

fn add_foot(builder: &mut Builder, servo: usize) {
    let (_, leg) = servo_and_leg_names(servo);
    let stack = builder.stack;
    let foot = builder.layout.legs[servo].foot;
    let clamps = clamp_positions(builder);
    let half_width = builder.half_bar_width();
    // The column begins at the end of the leaf's free length.
    let column_offset = clamps[0] - foot;
    let column_direction = column_offset * (1.0 / column_offset.length());
    let root =
        foot + column_direction * (compute_leaf_length(builder.parts.bar) + COLUMN_HALF_WIDTH);
    // As in the crank, the half widths of bars that start at the same point differ by 0.01 mm.
    let column = vec![
        Shape::bar(clamps[0], clamps[1], COLUMN_HALF_WIDTH),
        Shape::bar(clamps[0], root, COLUMN_HALF_WIDTH - 0.01),
    ];
    let tip = Shape::disc(foot, TIP_RADIUS);
    let leaf = vec![
        Shape::bar(root, foot, half_width),
        tip.clone(),
        Shape::bar(clamps[0], clamps[1], half_width - 0.01),
        Shape::bar(clamps[0], root, half_width - 0.02),
    ];
    let (pocket, hole) = (builder.nut_pocket(foot), builder.clearance_hole(foot));
    let threads = clamps.map(|position| builder.thread_hole(position));
    let [_, boss_top] = stack.foot_boss;
    let nut_z = stack.leaf[0] + builder.parts.screw.nut_height;
    let hole_bottom = stack.leg_coupler[0] - CLAMP_HOLE_DEPTH;
    let column_and_tip = [&column[..], &[tip]].concat();
    let prisms = [
        Prism::new(leaf, [pocket.clone()], stack.leaf),
        Prism::new(column_and_tip.clone(), [pocket], [stack.leaf[1], nut_z]),
        Prism::new(column_and_tip, [hole], [nut_z, boss_top]),
        Prism::solid(column.clone(), [boss_top, hole_bottom]),
        Prism::new(column, threads, [hole_bottom, stack.leg_coupler[0]]),
    ];
    let mount = Mount::Foot(servo);
    builder.add_printed(format!("foot {leg}"), mount, prisms);
    for (number, position) in (1..).zip(clamps) {
        let name = format!("foot {leg} {number}");
        let bolt = Bolt::new(&name, mount, position, clamp_seat(builder), Direction::Down);
        builder.add_screw(&bolt, CLAMP_SCREW_LENGTH);
    }
    let head_z = stack.pad[1] - PAD_LIP_HEIGHT;
    let name = format!("height {leg}");
    builder.add_screw(
        &Bolt::new(&name, mount, foot, head_z, Direction::Up),
        FOOT_SCREW_LENGTH,
    );
    let screw = builder.parts.screw;
    let (flats, thread) = (
        Shape::hexagon(foot, screw.nut),
        Shape::disc(foot, screw.diameter / 2.0),
    );
    let nut_prism = Prism::new([flats], [thread], [stack.leaf[0], nut_z]);
    builder.add_body(format!("height nut {leg}"), Kind::Nut, mount, [nut_prism]);
    // The coupler never turns, so a direction is constant in its frame.
    let coupler_direction = builder.layout.legs[servo].coupler_direction;
    let head_direction = Vector::new(coupler_direction.y, coupler_direction.x);
    let pad = pads::make_pad_layers(builder.parts, foot, stack.floor, head_direction);
    builder.add_body(format!("pad {leg}"), Kind::Pad, mount, pad);
}

/// Adds the bolts of a leg's pivots and joints, and the bolt that joins crank and strut.
fn add_screws(builder: &mut Builder, servo: usize) {
    let (_, leg) = servo_and_leg_names(servo);
    let (stack, parts) = (builder.stack, builder.parts);
    let LegPlan {
        anchor,
        crank_joint: joint,
        ..
    } = builder.layout.legs[servo];
    let (pivot, coupler) = (Vector::default(), format!("leg coupler {leg}"));
    let crank = Mount::Crank(servo);
    for (mount, name) in [(crank, "crank"), (Mount::Follower(servo), "follower")] {
        let (head_z, screw) = (stack.bearing[1] + HEAD_PLAY, format!("{name} pivot {leg}"));
        builder.add_bolt(&Bolt {
            nut_z: stack.plate[0] - HEAD_PLAY,
            contacts: &["plate"],
            ..Bolt::new(&screw, mount, pivot, head_z, Direction::Down)
        });
        let (head_z, screw) = (stack.leg_coupler[0], format!("{name} joint {leg}"));
        builder.add_bolt(&Bolt {
            nut_z: stack.crank[1] + HEAD_PLAY,
            contacts: &[&coupler],
            ..Bolt::new(&screw, mount, joint, head_z, Direction::Up)
        });
    }
    let (nut_z, length) = stack.anchor_nut_height_and_screw_length(parts);
    let name = format!("leg anchor {leg}");
    builder.add_bolt(&Bolt {
        nut_z,
        length: Some(length),
        contacts: &[&builder.strut_name(leg)],
        ..Bolt::new(
            &name,
            crank,
            anchor,
            stack.anchor_head_face,
            Direction::Down,
        )
    });
}
