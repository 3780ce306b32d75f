//! The placements of all bodies as JSON, for programs.
//!
//! Lengths are in mm, in the chassis frame, with z up from the top of the plate. The file of a printed part has the
//! part as it is printed. To put it in place, turn it over if `flipped` is true (x, y, z to x, -y, -z), lift it by
//! `lift`, turn it about the z axis by `turn` (deg, counter-clockwise) and shift it by `at`. Bought bodies have
//! `solids`: vertical prisms over convex outlines, already in place. `drill` lists the holes to be drilled in a printed
//! part.

use lizard_kinematics::{Solution, Vector};
use serde::Serialize;

use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Kind};
use crate::layers::placement::Placement;
use crate::layers::shape::Shape;
use crate::order::steps::{Step, step_and_stage, steps};
use crate::part::Part;

/// The placement of a body.
#[derive(Serialize)]
struct PlacedBody<'a> {
    /// The body's name.
    name: &'a str,
    /// The body's kind as a word, such as "screw".
    kind: &'static str,
    /// The step of the guide in which the body is added, from 1.
    step: usize,
    /// The stage of that step in which the body is added, from 1.
    stage: usize,
    /// The placement of the printed part's file; `None` for a bought body.
    #[serde(skip_serializing_if = "Option::is_none")]
    printed: Option<PrintPlacement>,
    /// The screw in its place; `None` for another body.
    #[serde(skip_serializing_if = "Option::is_none")]
    screw: Option<Screw>,
    /// The shapes of a bought body; empty for a printed one.
    solids: Vec<Prism>,
}

/// The placement of a printed part's file.
#[derive(Serialize)]
struct PrintPlacement {
    /// Path of the file within the output folder.
    file: String,
    /// The text engraved on the part; empty if there is none.
    mark: String,
    /// True if the part is turned over.
    flipped: bool,
    /// Shift upward.
    lift: f64,
    /// Turn about the z axis, deg counter-clockwise.
    turn: f64,
    /// Shift along x and y.
    at: [f64; 2],
    /// Middles of the holes to be drilled, chassis frame.
    drill: Vec<[f64; 2]>,
}

/// A screw in its place.
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
    /// The later steps of the guide in which the screw is turned again, from 1.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    turned: Vec<usize>,
}

/// A vertical prism between two heights, and the holes in it.
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

/// The placements of all bodies at a pose, as JSON.
///
/// # Panics
/// Never: texts and numbers can always be written as JSON.
pub fn placements(assembly: &Assembly, pose: &Solution) -> String {
    let parts = assembly.parts();
    let steps = steps(assembly.robot().drive().strut().is_some());
    let placed_body_of = |body| {
        let (step, stage) = step_and_stage(&steps, body);
        let part = parts
            .iter()
            .find(|part| part.body_names.contains(&body.name));
        let placement = assembly.place(body.mount, pose);
        PlacedBody {
            name: &body.name,
            kind: body.kind.word(),
            step,
            stage,
            printed: part.map(|part| print_placement_of(&placement, body, part)),
            screw: screw_of(assembly, &steps, &placement, body),
            solids: match part {
                Some(_) => Vec::new(),
                None => solids_of(&placement, body),
            },
        }
    };
    let placed_bodies: Vec<PlacedBody> = assembly.bodies().iter().map(placed_body_of).collect();
    serde_json::to_string_pretty(&placed_bodies).expect("texts and numbers can be written as JSON")
        + "\n"
}

fn pair_of(point: Vector) -> [f64; 2] {
    [point.x, point.y]
}

fn print_placement_of(placement: &Placement, body: &Body, part: &Part) -> PrintPlacement {
    let motion = part.print_to_body(body);
    let frame = motion.frame;
    let origin = placement.map(frame.origin);
    let turn = placement.x_axis * frame.x_axis.x + placement.x_axis.rotated_left() * frame.x_axis.y;
    let drill = part.closed_hole_centres().into_iter().map(|hole| {
        let hole = if part.is_turned_over {
            hole.mirrored()
        } else {
            hole
        };
        pair_of(origin + turn * hole.x + turn.rotated_left() * hole.y)
    });
    PrintPlacement {
        file: format!("stl/{}.stl", part.file_stem()),
        mark: part.mark.clone(),
        flipped: motion.is_flipped,
        lift: motion.lift,
        turn: turn.angle(),
        at: pair_of(origin),
        drill: drill.collect(),
    }
}

fn screw_of(
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
        at: pair_of(placement.map(low.filled_shapes[0].middle())),
        head: low.z[1],
        length,
        diameter: assembly.robot().parts().screw.diameter,
        head_above: high.filled_shapes[0].diameter() > low.filled_shapes[0].diameter(),
        turned: turning_steps.map(|(number, _)| number).collect(),
    })
}

fn solids_of(placement: &Placement, body: &Body) -> Vec<Prism> {
    let outline_of = |shape: &Shape| ConvexOutline {
        radius: shape.radius,
        outline: shape
            .points
            .iter()
            .map(|point| pair_of(placement.map(*point)))
            .collect(),
    };
    let layers = body.prisms.iter().flat_map(|prism| {
        prism.filled_shapes.iter().map(move |shape| Prism {
            z: prism.z,
            shape: outline_of(shape),
            holes: prism.cut_shapes.iter().map(outline_of).collect(),
        })
    });
    layers.collect()
}
