//! The bodies that a servo turns: its horn, and the link on the horn.
//!
//! The link combines the crank of the head or the tail, a slider's arm, and the anchor of the leg's strut.

use lizard_kinematics::Vector;
use lizard_robot::Horn;
use lizard_robot::servo::SERVO_NAMES;

use crate::bodies::builder::ScrewDirection::Down;
use crate::bodies::builder::{AssemblyBuilder, Screw};
use crate::bodies::chassis::SPLINE_RADIUS;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::{HEAD_CLEARANCE, Span};

/// Distances from the shaft to the horn's small screws, as fractions of the arm's length.
const HORN_SCREW_FRACTIONS: [f64; 2] = [0.52, 0.83];
/// Radius of the hole in which a horn's small screw cuts its thread, mm.
const PILOT_RADIUS: f64 = 0.7;
/// Length of a horn's small screw, mm; a 5 mm screw would reach the servo's boss under the link.
pub const HORN_SCREW_LENGTH: f64 = 4.0;
/// Radius and height of the head of a horn's small screw, mm.
const HORN_SCREW_HEAD_SIZE: [f64; 2] = [1.5, 1.0];

/// Wall thickness of the ring between strut and link, mm; the spring's coil leaves no room for more.
const RING_WALL: f64 = 1.1;

/// Clearance on each side of a horn's arm in its pocket, in multiples of `fit`: horns vary in size.
pub const POCKET_FIT_FACTOR: f64 = 1.5;

/// Adds the horns and links of all servos, with their screws.
pub fn add(builder: &mut AssemblyBuilder) {
    for servo in 0..4 {
        add_horn(builder, servo);
        add_link(builder, servo);
        add_horn_screws(builder, servo);
        add_anchor_screw_and_ring(builder, servo);
    }
}

/// Makes the shapes of the horn's arm, which points along the crank, wider by `margin` (mm) on each side.
pub fn make_horn_arm(horn: &Horn, margin: f64) -> Vec<Shape> {
    let (hub_radius, tip_radius) = (horn.hub / 2.0 + margin, horn.tip / 2.0 + margin);
    let end = Vector::new(horn.arm - horn.tip / 2.0, 0.0);
    // The arm narrows from hub to tip.
    let half_width = 0.8 * hub_radius;
    let corners = [
        (0.0, -half_width),
        (end.x, -tip_radius),
        (end.x, tip_radius),
        (0.0, half_width),
    ];
    let taper = Shape::hull(&corners.map(|(x, y)| Vector::new(x, y)), 0.0);
    vec![
        Shape::disc(Vector::default(), hub_radius),
        taper,
        // A larger disc, so that no corner of the taper lies on its edge.
        Shape::disc(end, tip_radius + 0.05),
    ]
}

fn add_horn(builder: &mut AssemblyBuilder, servo: usize) {
    let name = SERVO_NAMES[servo];
    let horn = builder.parts.horn;
    let [low, _] = builder.stack.horn_pocket;
    let spline = Shape::disc(Vector::default(), SPLINE_RADIUS);
    let mut through_holes = vec![spline.clone()];
    through_holes
        .extend(horn_screw_positions(&horn).map(|position| Shape::disc(position, PILOT_RADIUS)));
    let hub = Shape::disc(Vector::default(), horn.hub / 2.0);
    let arm_z = [low, low + horn.thickness];
    let prisms = [
        Prism::new([hub], [spline], [low + horn.thickness - horn.height, low]),
        Prism::new(make_horn_arm(&horn, 0.0), through_holes, arm_z),
    ];
    let mount = Mount::Link(servo);
    let horn_body = builder.add_body(format!("horn {name}"), Kind::Horn, mount, prisms);
    horn_body.allowed_contacts = vec![format!("servo {name}")];
}

fn add_link(builder: &mut AssemblyBuilder, servo: usize) {
    let name = SERVO_NAMES[servo];
    let (parts, stack, layout) = (builder.parts, builder.stack, builder.layout);
    let shaft = Vector::default();
    let tip = Vector::new(layout.crank_lengths[servo], 0.0);
    let slider_tip = layout.arm_tips[servo];
    let anchor = layout.legs[servo].anchor;
    let half_width = builder.half_bar_width();
    let hub_radius = parts.horn.hub / 2.0 + 2.0 * parts.fit + 1.5 * parts.wall;
    // Without this brace, the link would break in the corner between crank and slider's arm.
    let brace = Shape::hull(&[shaft, tip * 0.45, slider_tip * 0.45], 0.6 * half_width);
    // The half widths of bars that start at the same point differ by 0.01 mm, so that no two bar ends coincide.
    let filled = vec![
        Shape::disc(shaft, hub_radius),
        Shape::bar(shaft, tip, half_width),
        Shape::bar(shaft, slider_tip, half_width - 0.01),
        Shape::bar(shaft, anchor, half_width - 0.02),
        brace,
        Shape::disc(tip, builder.nut_boss_radius()),
        Shape::disc(slider_tip, builder.nut_boss_radius()),
    ];
    let horn_hub = Shape::disc(shaft, parts.horn.hub / 2.0 + parts.fit);
    let holes = [tip, slider_tip].map(|position| builder.clearance_hole(position));
    let pilot_holes =
        horn_screw_positions(&parts.horn).map(|position| Shape::disc(position, PILOT_RADIUS));
    let pocket = make_horn_arm(&parts.horn, POCKET_FIT_FACTOR * parts.fit);
    let anchor_hole = builder.clearance_hole(anchor);
    let head_pockets = [tip, slider_tip].map(|position| builder.nut_pocket(position));
    let [low, high] = stack.link;
    // Holes and pockets, each with the heights between which it is cut.
    let cuts = [
        (&holes[..], [low, high]),
        (&head_pockets, [low, stack.hex_head_face]),
        (&[horn_hub], [low, stack.horn_pocket[0]]),
        (&pilot_holes, [low, stack.horn_pocket[0]]),
        (&pocket, stack.horn_pocket),
        (&[anchor_hole], [low, high]),
        (&[builder.counterbore(anchor)], stack.counterbore),
    ];
    let mut heights: Vec<f64> = cuts.iter().flat_map(|(_, z)| *z).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup_by(|a, b| *a - *b < 1e-9);
    let build_layer = |z: &[f64]| {
        let is_cut_in = |span: Span| span[0] < z[1] - 1e-9 && z[0] < span[1] - 1e-9;
        let layer_cuts = cuts.iter().filter(|(_, span)| is_cut_in(*span));
        let cut_shapes: Vec<_> = layer_cuts.flat_map(|(shapes, _)| shapes.to_vec()).collect();
        Prism::new(filled.clone(), cut_shapes, [z[0], z[1]])
    };
    let prisms: Vec<_> = heights.windows(2).map(build_layer).collect();
    let link = builder.add_printed(Mount::Link(servo), prisms);
    link.allowed_contacts = vec![format!("servo {name}")];
}

/// Positions of the small screws that hold the horn.
fn horn_screw_positions(horn: &Horn) -> [Vector; 2] {
    HORN_SCREW_FRACTIONS.map(|fraction| Vector::new(fraction * horn.arm, 0.0))
}

fn add_horn_screws(builder: &mut AssemblyBuilder, servo: usize) {
    let name = SERVO_NAMES[servo];
    let top = builder.stack.horn_pocket[0] + builder.parts.horn.thickness;
    let [radius, head_height] = HORN_SCREW_HEAD_SIZE;
    for (number, position) in (1..).zip(horn_screw_positions(&builder.parts.horn)) {
        let cylinder = |radius: f64, z: Span| Prism::solid([Shape::disc(position, radius)], z);
        let prisms = [
            cylinder(PILOT_RADIUS, [top - HORN_SCREW_LENGTH, top]),
            cylinder(radius, [top, top + head_height]),
        ];
        let name = format!("horn screw {name} {number}");
        let kind = Kind::HornScrew(HORN_SCREW_LENGTH);
        builder.add_body(name, kind, Mount::Link(servo), prisms);
    }
}

/// Adds the screw that holds the strut, and the ring between strut and link.
fn add_anchor_screw_and_ring(builder: &mut AssemblyBuilder, servo: usize) {
    let name = SERVO_NAMES[servo];
    let (stack, parts) = (builder.stack, builder.parts);
    let position = builder.layout.legs[servo].anchor;
    let strut_name = builder.strut_name(servo);
    let ring_z = [stack.anchor_head_face, stack.link[0] - HEAD_CLEARANCE];
    // The ring is thin enough to fit beside the spring's coil.
    let ring_disc = Shape::disc(position, parts.screw.diameter / 2.0 + RING_WALL);
    let prism = Prism::new([ring_disc], [builder.clearance_hole(position)], ring_z);
    let mount = Mount::Link(servo);
    let ring = builder.add_body(format!("strut ring {name}"), Kind::Printed, mount, [prism]);
    ring.allowed_contacts = vec![strut_name.clone()];
    let (name, seat_z) = (format!("anchor {name}"), stack.counterbore[0]);
    let screw = Screw::new(name, mount, position, seat_z, Down).touching(strut_name);
    builder.add_bolt(&screw, stack.strut_floor[0] - HEAD_CLEARANCE);
}
