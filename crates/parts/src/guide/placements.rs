//! The placements of all bodies as JSON, for programs.
//!
//! Lengths are in mm, in the chassis frame, with z up from the top of the plate. The file of a printed part contains
//! the part as printed. To put the part in place, turn it over if `flipped` is true (x, y, z to x, -y, -z), lift it by
//! `lift`, turn it about the z axis by `turn` (deg, counter-clockwise) and shift it by `at`. Bought bodies have
//! `solids`: vertical prisms over convex outlines, already in place. `drill` lists a printed part's holes to drill.

use lizard_kinematics::{Solution, Vector};
use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Kind};
use crate::layers::placement::Placement;
use crate::layers::shape::Shape;
use crate::order::steps::{Step, build_steps, find_step_and_stage};
use crate::part::Part;

/// The placement of a body.
#[derive(Serialize)]
struct PlacedBody<'a> {
    /// Name of the body.
    name: &'a str,
    /// Kind of the body as a word, such as "screw".
    kind: &'static str,
    /// Step of the guide that adds the body, from 1.
    step: usize,
    /// Stage of the step that adds the body, from 1.
    stage: usize,
    /// Placement of the printed part's file; `None` for a bought body.
    #[serde(skip_serializing_if = "Option::is_none")]
    printed: Option<PrintPlacement>,
    /// The placed screw; `None` for other bodies.
    #[serde(skip_serializing_if = "Option::is_none")]
    screw: Option<Screw>,
    /// Shapes of a bought body; empty for a printed body.
    solids: Vec<Prism>,
}

/// The placement of a printed part's file.
#[derive(Serialize)]
struct PrintPlacement {
    /// Path of the file within the output folder.
    file: String,
    /// Text engraved on the part; empty if there is none.
    mark: String,
    /// True if the part is turned over.
    flipped: bool,
    /// Upward shift.
    lift: f64,
    /// Turn about the z axis, deg, counter-clockwise.
    turn: f64,
    /// Shift along x and y.
    at: [f64; 2],
    /// Middles of the holes to drill, chassis frame.
    drill: Vec<[f64; 2]>,
}

/// A placed screw.
#[derive(Serialize)]
struct Screw {
    /// Position of the axis.
    at: [f64; 2],
    /// Height of the face under the head.
    head: f64,
    /// Length below the head.
    length: f64,
    /// Diameter of the thread.
    diameter: f64,
    /// True if the head is above the shank.
    head_above: bool,
    /// Later steps of the guide that turn the screw again, from 1.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    turned: Vec<usize>,
}

/// A vertical prism with holes between two heights.
#[derive(Serialize)]
struct Prism {
    z: [f64; 2],
    #[serde(flatten)]
    shape: ConvexOutline,
    holes: Vec<ConvexOutline>,
}

/// The convex hull of equal discs.
#[derive(Serialize)]
struct ConvexOutline {
    /// Radius of the discs; 0 for a polygon.
    radius: f64,
    /// Centres of the discs.
    outline: Vec<[f64; 2]>,
}

/// Formats the placements of all bodies at a pose as JSON.
///
/// # Panics
/// Never: texts and numbers can always be converted to JSON.
pub fn format_placements(assembly: &Assembly, pose: &Solution) -> String {
    let parts = assembly.collect_parts();
    let steps = build_steps(assembly.robot().drive().strut().is_some());
    let to_placed_body = |body| {
        let (step, stage) = find_step_and_stage(&steps, body);
        let part = parts
            .iter()
            .find(|part| part.body_names.contains(&body.name));
        let placement = assembly.placement(body.mount, pose);
        PlacedBody {
            name: &body.name,
            kind: body.kind.word(),
            step,
            stage,
            printed: part.map(|part| compute_print_placement(&placement, body, part)),
            screw: find_screw(assembly, &steps, &placement, body),
            solids: match part {
                Some(_) => Vec::new(),
                None => place_solids(&placement, body),
            },
        }
    };
    let placed_bodies: Vec<PlacedBody> = assembly.bodies().iter().map(to_placed_body).collect();
    serde_json::to_string_pretty(&placed_bodies)
        .expect("texts and numbers can be converted to JSON")
        + "\n"
}

fn to_pair(point: Vector) -> [f64; 2] {
    [point.x, point.y]
}

fn compute_print_placement(placement: &Placement, body: &Body, part: &Part) -> PrintPlacement {
    let motion = part.print_to_body(body);
    let frame = motion.frame;
    let origin = placement.map(frame.origin);
    let turn = placement.x_axis * frame.x_axis.x + placement.x_axis.rotated_left() * frame.x_axis.y;
    let drill = part.find_closed_holes().into_iter().map(|hole| {
        let hole = if part.is_turned_over {
            hole.mirrored()
        } else {
            hole
        };
        to_pair(origin + turn * hole.x + turn.rotated_left() * hole.y)
    });
    PrintPlacement {
        file: format!("stl/{}.stl", part.file_stem()),
        mark: part.mark.clone(),
        flipped: motion.is_flipped,
        lift: motion.lift,
        turn: turn.angle(),
        at: to_pair(origin),
        drill: drill.collect(),
    }
}

fn find_screw(
    assembly: &Assembly,
    steps: &[Step],
    placement: &Placement,
    body: &Body,
) -> Option<Screw> {
    let (Kind::Screw(length) | Kind::HexScrew(length)) = body.kind else {
        return None;
    };
    let [low, high] = &body.prisms[..] else {
        return None;
    };
    let is_turned_in = |step: &Step| step.stages.iter().any(|stage| (stage.turns_again)(body));
    let turning_steps = (1..).zip(steps).filter(|(_, step)| is_turned_in(step));
    Some(Screw {
        at: to_pair(placement.map(low.filled_shapes[0].middle())),
        head: low.z[1],
        length,
        diameter: assembly.robot().parts().screw.diameter,
        head_above: high.filled_shapes[0].diameter() > low.filled_shapes[0].diameter(),
        turned: turning_steps.map(|(number, _)| number).collect(),
    })
}

fn place_solids(placement: &Placement, body: &Body) -> Vec<Prism> {
    let to_outline = |shape: &Shape| ConvexOutline {
        radius: shape.radius,
        outline: shape
            .points
            .iter()
            .map(|point| to_pair(placement.map(*point)))
            .collect(),
    };
    let layers = body.prisms.iter().flat_map(|prism| {
        prism.filled_shapes.iter().map(move |shape| Prism {
            z: prism.z,
            shape: to_outline(shape),
            holes: prism.cut_shapes.iter().map(to_outline).collect(),
        })
    });
    layers.collect()
}
