//! The placements of all bodies as JSON, for programs.
//!
//! Lengths in mm; the chassis frame, z up from the top of the plate; servos at neutral. A
//! printed part's file lies as it is printed: it is turned over if `flipped` is true
//! (x, y, z to x, -y, -z), lifted by `lift`, turned about the upright axis by `turn` (deg,
//! counter-clockwise) and shifted by `at`. Bought bodies have `solids`: upright prisms over
//! convex outlines, already in place. `drill` are the holes to be drilled in a printed part.

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
struct Placed<'a> {
    name: &'a str,
    kind: &'static str,
    /// The step of the guide in which the body is added, from 1.
    step: usize,
    /// The stage of that step in which the body is added, from 1.
    stage: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    printed: Option<Print>,
    #[serde(skip_serializing_if = "Option::is_none")]
    screw: Option<Screw>,
    solids: Vec<Prism>,
}

/// The placement of a printed part's file.
#[derive(Serialize)]
struct Print {
    file: String,
    mark: String,
    flipped: bool,
    lift: f64,
    turn: f64,
    at: [f64; 2],
    /// Middles of the holes to be drilled, chassis frame.
    drill: Vec<[f64; 2]>,
}

/// A screw: the position of its axis, the height of the face under its head, its length and
/// diameter, and the side of its head.
#[derive(Serialize)]
struct Screw {
    at: [f64; 2],
    head: f64,
    length: f64,
    diameter: f64,
    head_above: bool,
    /// The steps in which the screw is turned again, on the robot.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    turned: Vec<usize>,
}

/// A convex prism, and the holes in its layer.
#[derive(Serialize)]
struct Prism {
    z: [f64; 2],
    #[serde(flatten)]
    shape: Flat,
    holes: Vec<Flat>,
}

#[derive(Serialize)]
struct Flat {
    radius: f64,
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
        let part = parts.iter().find(|part| part.bodies.contains(&body.name));
        let placement = assembly.place(body.mount, pose);
        Placed {
            name: &body.name,
            kind: body.kind.word(),
            step,
            stage,
            printed: part.map(|part| print_of(&placement, body, part)),
            screw: screw_of(assembly, &steps, &placement, body),
            solids: match part {
                Some(_) => Vec::new(),
                None => solids_of(&placement, body),
            },
        }
    };
    let list: Vec<Placed> = assembly.bodies().iter().map(placed_body_of).collect();
    serde_json::to_string_pretty(&list).expect("texts and numbers") + "\n"
}

fn pair_of(point: Vector) -> [f64; 2] {
    [point.x, point.y]
}

fn print_of(placement: &Placement, body: &Body, part: &Part) -> Print {
    let motion = part.print_to_body(body);
    let frame = motion.frame;
    let origin = placement.map(frame.origin);
    let turn = placement.x_axis * frame.x_axis.x + placement.x_axis.rotated_left() * frame.x_axis.y;
    let drill = part.closed_holes().into_iter().map(|hole| {
        let hole = if part.is_turned_over {
            hole.mirrored()
        } else {
            hole
        };
        pair_of(origin + turn * hole.x + turn.rotated_left() * hole.y)
    });
    Print {
        file: format!("stl/{}.stl", part.file()),
        mark: part.mark.clone(),
        flipped: motion.flipped,
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
    let is_turned_in = |step: &Step| step.stages.iter().any(|stage| (stage.turns)(body));
    let turning_steps = (1..).zip(steps).filter(|(_, step)| is_turned_in(step));
    Some(Screw {
        at: pair_of(placement.map(low.filled_shapes[0].middle())),
        head: low.z[1],
        length,
        diameter: assembly.robot().parts().screw.diameter,
        head_above: high.filled_shapes[0].width() > low.filled_shapes[0].width(),
        turned: turning_steps.map(|(number, _)| number).collect(),
    })
}

fn solids_of(placement: &Placement, body: &Body) -> Vec<Prism> {
    let flat_of = |shape: &Shape| Flat {
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
            shape: flat_of(shape),
            holes: prism.cut_shapes.iter().map(flat_of).collect(),
        })
    });
    layers.collect()
}
