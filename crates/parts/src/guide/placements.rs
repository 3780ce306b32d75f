//! The placements of all bodies, as JSON for other programs.
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
    /// Step of the guide that adds the body, from 1; 0 if no step does.
    step: usize,
    /// Stage of the step that adds the body, from 1; 0 if no step does.
    stage: usize,
    /// Placement of the printed part's file; `None` if the body is bought.
    #[serde(skip_serializing_if = "Option::is_none")]
    printed: Option<PrintPlacement>,
    /// The placed screw; `None` if the body is not a screw.
    #[serde(skip_serializing_if = "Option::is_none")]
    screw: Option<PlacedScrew>,
    /// Shapes of a bought body; empty for a printed body.
    solids: Vec<PlacedPrism>,
}

/// The file of a printed part, and how it is put in place.
#[derive(Serialize)]
struct PrintPlacement {
    /// Path of the file within the output folder.
    file: String,
    /// Text engraved on the part; empty if there is none.
    mark: String,
    /// True if the part is turned over.
    #[serde(rename = "flipped")]
    is_flipped: bool,
    /// Upward shift.
    lift: f64,
    /// Rotation about the z axis, deg, counter-clockwise.
    #[serde(rename = "turn")]
    rotation: f64,
    /// Shift along x and y.
    #[serde(rename = "at")]
    shift: [f64; 2],
    /// Centres of the holes to drill, chassis frame.
    #[serde(rename = "drill")]
    holes_to_drill: Vec<[f64; 2]>,
}

/// A placed screw.
#[derive(Serialize)]
struct PlacedScrew {
    /// Position of the axis.
    #[serde(rename = "at")]
    position: [f64; 2],
    /// Height of the face under the head.
    #[serde(rename = "head")]
    seat_z: f64,
    /// Length below the head.
    length: f64,
    /// Diameter of the thread.
    diameter: f64,
    /// True if the head is above the shank.
    #[serde(rename = "head_above")]
    is_head_above: bool,
    /// Numbers, from 1, of the later steps of the guide in which the screw is turned again.
    #[serde(rename = "turned", skip_serializing_if = "Vec::is_empty")]
    turning_steps: Vec<usize>,
}

/// A vertical prism with holes between two heights.
#[derive(Serialize)]
struct PlacedPrism {
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
        let part = parts.iter().find(|part| part.prints_body(body));
        let placement = assembly.placement(body.mount, pose);
        PlacedBody {
            name: &body.name,
            kind: body.kind.word(),
            step,
            stage,
            printed: part.map(|part| compute_print_placement(&placement, body, part)),
            screw: place_screw(assembly, &steps, &placement, body),
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
    let transform = part.transform_to_body(body);
    let frame = transform.frame;
    let print_frame = Placement {
        origin: placement.map(frame.origin),
        x_axis: placement.x_axis * frame.x_axis.x
            + placement.x_axis.rotated_left() * frame.x_axis.y,
    };
    let holes_to_drill = part.find_bridged_hole_centres().into_iter().map(|hole| {
        let hole = match transform.is_flipped {
            true => hole.mirrored_in_x_axis(),
            false => hole,
        };
        to_pair(print_frame.map(hole))
    });
    PrintPlacement {
        file: format!("stl/{}.stl", part.file_stem()),
        mark: part.mark.clone(),
        is_flipped: transform.is_flipped,
        lift: transform.lift,
        rotation: print_frame.x_axis.angle(),
        shift: to_pair(print_frame.origin),
        holes_to_drill: holes_to_drill.collect(),
    }
}

fn place_screw(
    assembly: &Assembly,
    steps: &[Step],
    placement: &Placement,
    body: &Body,
) -> Option<PlacedScrew> {
    let (Kind::Screw(length) | Kind::HexScrew(length), [low, high]) = (body.kind, &body.prisms[..])
    else {
        return None;
    };
    let is_turned_in = |step: &Step| step.stages.iter().any(|stage| (stage.turns_again)(body));
    let turning_steps = (1..).zip(steps).filter(|(_, step)| is_turned_in(step));
    Some(PlacedScrew {
        position: to_pair(placement.map(low.filled_shapes[0].middle())),
        seat_z: low.z[1],
        length,
        diameter: assembly.robot().parts().screw.diameter,
        is_head_above: high.filled_shapes[0].diameter() > low.filled_shapes[0].diameter(),
        turning_steps: turning_steps.map(|(number, _)| number).collect(),
    })
}

fn place_solids(placement: &Placement, body: &Body) -> Vec<PlacedPrism> {
    let to_outline = |shape: &Shape| {
        let Shape { points, radius } = shape.placed(placement);
        let outline = points.into_iter().map(to_pair).collect();
        ConvexOutline { radius, outline }
    };
    let prisms = body.prisms.iter().flat_map(|prism| {
        prism.filled_shapes.iter().map(move |shape| PlacedPrism {
            z: prism.z,
            shape: to_outline(shape),
            holes: prism.cut_shapes.iter().map(to_outline).collect(),
        })
    });
    prisms.collect()
}
