//! The legs: crank, follower, coupler with the foot, and the screws that join them.
//!
//! A stiff robot on four stiff feet rocks: two diagonal feet carry nearly all of the weight. Each foot is therefore on
//! a leaf spring, and a screw sets its height. The higher the leaf is above the floor, the more the pad's friction
//! bends the leaf and turns the foot, so a column reaches down from the coupler to a low leaf.

use lizard_kinematics::Vector;
use lizard_robot::servo::LEG_NAMES;

use crate::bodies::builder::ScrewDirection::{Down, Up};
use crate::bodies::builder::{AssemblyBuilder, Screw};
use crate::bodies::pads;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::{HEAD_CLEARANCE, LEAF_THICKNESS, PAD_LIP_HEIGHT};

/// Radius of the boss around a foot's nut, mm.
const FOOT_BOSS_RADIUS: f64 = 5.0;
/// Distances from the follower's joint to the two clamp screws, which fix the foot's column to the coupler, mm.
const CLAMP_DISTANCES: [f64; 2] = [21.0, 9.0];
/// Length of the clamp screws, which cut their thread into the column, mm.
const CLAMP_SCREW_LENGTH: f64 = 10.0;
/// Depth of the clamp screws' holes in the column, mm.
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
    let thickness_cubed = LEAF_THICKNESS * LEAF_THICKNESS * LEAF_THICKNESS;
    let length_cubed = PLA_MODULUS * width * thickness_cubed / (4.0 * LEAF_STIFFNESS);
    libm::cbrt(length_cubed)
}

/// Adds all legs.
pub fn add(builder: &mut AssemblyBuilder) {
    for servo in 0..4 {
        add_crank(builder, servo);
        add_follower(builder, servo);
        add_coupler(builder, servo);
        add_foot(builder, servo);
        add_screws(builder, servo);
    }
}

fn add_crank(builder: &mut AssemblyBuilder, servo: usize) {
    let (stack, parts) = (builder.stack, builder.parts);
    let plan = builder.layout.legs[servo];
    let (anchor, joint) = (plan.anchor, plan.crank_joint);
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
    let pocket_holes = holes_with(builder.nut_pocket(anchor));
    let through_holes = holes_with(builder.clearance_hole(anchor));
    let pocket_top = stack.anchor_pocket_top(parts);
    let pocket_top = pocket_top.clamp(stack.crank[0], stack.crank[1]);
    let bearing = Shape::disc(pivot, half_width - 0.2);
    let bosses = [bearing.clone(), Shape::disc(anchor, half_width - 0.4)];
    let mut prisms = vec![
        Prism::new(filled.clone(), pocket_holes, [stack.crank[0], pocket_top]),
        Prism::new(filled, through_holes.clone(), [pocket_top, stack.crank[1]]),
        Prism::new(bosses, through_holes, stack.anchor),
        Prism::new([bearing], holes, [stack.anchor[1], stack.bearing[1]]),
    ];
    prisms.retain(Prism::has_height);
    builder.add_printed(Mount::Crank(servo), prisms);
}

fn add_follower(builder: &mut AssemblyBuilder, servo: usize) {
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
    builder.add_printed(Mount::Follower(servo), prisms);
}

/// Positions of the two clamp screws, coupler frame, mm.
fn clamp_positions(builder: &AssemblyBuilder) -> [Vector; 2] {
    let ground = builder.robot.lizard().leg.ground;
    CLAMP_DISTANCES.map(|distance| Vector::new(ground - distance, 0.0))
}

/// Height of the faces under the sunk heads of the clamp screws, mm.
fn clamp_seat_z(builder: &AssemblyBuilder) -> f64 {
    builder.stack.leg_coupler[1] - builder.parts.screw.head_height - HEAD_CLEARANCE
}

fn add_coupler(builder: &mut AssemblyBuilder, servo: usize) {
    let stack = builder.stack;
    let ground = builder.robot.lizard().leg.ground;
    let (from, to) = (Vector::default(), Vector::new(ground, 0.0));
    let clamps = clamp_positions(builder);
    let through_holes = clamps.map(|position| builder.clearance_hole(position));
    let counterbores = clamps.map(|position| builder.counterbore(position));
    let joints = [builder.clearance_hole(from), builder.clearance_hole(to)];
    let mut bar = vec![Shape::bar(from, to, builder.half_bar_width())];
    bar.extend(clamps.map(|position| Shape::disc(position, builder.head_boss_radius())));
    let (seat_z, [low, high]) = (clamp_seat_z(builder), stack.leg_coupler);
    let through_holes = [joints.clone(), through_holes].concat();
    let prisms = [
        Prism::new(bar.clone(), through_holes, [low, seat_z]),
        Prism::new(bar, [joints, counterbores].concat(), [seat_z, high]),
    ];
    builder.add_printed(Mount::Foot(servo), prisms);
}

fn add_foot(builder: &mut AssemblyBuilder, servo: usize) {
    let leg = LEG_NAMES[servo];
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
    let boss = Shape::disc(foot, FOOT_BOSS_RADIUS);
    let leaf = vec![
        Shape::bar(root, foot, half_width),
        boss.clone(),
        Shape::bar(clamps[0], clamps[1], half_width - 0.01),
        Shape::bar(clamps[0], root, half_width - 0.02),
    ];
    let (pocket, hole) = (builder.nut_pocket(foot), builder.clearance_hole(foot));
    let pilot_holes = clamps.map(|position| builder.pilot_hole(position));
    let [_, boss_top] = stack.foot_boss;
    let nut_z = stack.leaf[0] + builder.parts.screw.nut_height;
    let hole_bottom = stack.leg_coupler[0] - CLAMP_HOLE_DEPTH;
    let column_and_boss = [&column[..], &[boss]].concat();
    let prisms = [
        Prism::new(leaf, [pocket.clone()], stack.leaf),
        Prism::new(column_and_boss.clone(), [pocket], [stack.leaf[1], nut_z]),
        Prism::new(column_and_boss, [hole], [nut_z, boss_top]),
        Prism::solid(column.clone(), [boss_top, hole_bottom]),
        Prism::new(column, pilot_holes, [hole_bottom, stack.leg_coupler[0]]),
    ];
    let mount = Mount::Foot(servo);
    builder.add_body(format!("foot {leg}"), Kind::Printed, mount, prisms);
    for (number, position) in (1..).zip(clamps) {
        let name = format!("foot {leg} {number}");
        let screw = Screw::new(name, mount, position, clamp_seat_z(builder), Down);
        builder.add_screw(&screw, CLAMP_SCREW_LENGTH);
    }
    let seat_z = stack.pad[1] - PAD_LIP_HEIGHT;
    let screw = Screw::new(format!("height {leg}"), mount, foot, seat_z, Up);
    builder.add_screw(&screw, FOOT_SCREW_LENGTH);
    let nut = builder.make_nut(foot, [stack.leaf[0], nut_z]);
    builder.add_body(format!("height nut {leg}"), Kind::Nut, mount, [nut]);
    // The coupler never turns, so the forward direction is constant in its frame.
    let coupler_direction = builder.layout.legs[servo].coupler_direction;
    let forward = Vector::new(coupler_direction.y, coupler_direction.x);
    let pad = pads::make_pad_layers(builder.parts, foot, stack.floor, forward);
    builder.add_body(format!("pad {leg}"), Kind::Pad, mount, pad);
}

/// Adds the bolts of a leg's pivots and joints, and the bolt that joins crank and strut.
fn add_screws(builder: &mut AssemblyBuilder, servo: usize) {
    let leg = LEG_NAMES[servo];
    let (stack, parts) = (builder.stack, builder.parts);
    let plan = builder.layout.legs[servo];
    let (anchor, joint) = (plan.anchor, plan.crank_joint);
    let (coupler, strut) = (Mount::Foot(servo).name(), builder.strut_name(servo));
    let (pivot, crank) = (Vector::default(), Mount::Crank(servo));
    for (mount, part) in [(crank, "crank"), (Mount::Follower(servo), "follower")] {
        let (name, seat_z) = (format!("{part} pivot {leg}"), stack.bearing[1]);
        let screw = Screw::new(name, mount, pivot, seat_z + HEAD_CLEARANCE, Down);
        builder.add_bolt(&screw.touching("plate"), stack.plate[0] - HEAD_CLEARANCE);
        let (name, seat_z) = (format!("{part} joint {leg}"), stack.leg_coupler[0]);
        let screw = Screw::new(name, mount, joint, seat_z, Up).touching(&coupler);
        builder.add_bolt(&screw, stack.crank[1] + HEAD_CLEARANCE);
    }
    let (name, seat_z) = (format!("leg anchor {leg}"), stack.anchor_head_face);
    let screw = Screw::new(name, crank, anchor, seat_z, Down).touching(strut);
    builder.add_screw(&screw, stack.anchor_screw_length());
    builder.add_nut(&screw, stack.anchor_pocket_top(parts));
}
