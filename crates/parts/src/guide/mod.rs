//! The guide to building the robot, step by step, with pictures of the model.
//!
//! The order of the steps lets a screwdriver reach every screw, and the electronics are tested before any part can jam.

pub(crate) mod corner;
pub(crate) mod drawing;
pub(crate) mod html;
pub(crate) mod legend;
pub(crate) mod picture;
pub(crate) mod placements;

use std::fmt::Write;

use lizard_kinematics::Solution;
use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};

use crate::bill::Bill;
use crate::bodies::assembly::Assembly;
use crate::build_error::BuildError;
use crate::files::OutputFile;
use crate::guide::drawing::Label;
use crate::guide::html::markdown_to_html;
use crate::guide::picture::{PictureBody, View, draw_picture};
use crate::guide::placements::format_placements;
use crate::layers::body::{Body, Mount};
use crate::layers::roof::PRINT_LAYER_MM;
use crate::order::reach::AccessPose;
use crate::order::steps::{ExtraView, Step, TurningPlace, build_steps};
use crate::part::Part;

/// Lift of new bodies in the exploded pictures, mm.
const EXPLODED_LIFT: f64 = 45.0;
/// Width of a step's picture, with the labels on its sides, pixels.
const PICTURE_WIDTH: f64 = 950.0;
/// Index of the servo whose corner is printed first and shown in close-ups: A1.
pub const CORNER_SERVO: usize = 0;

/// Introduction of the guide.
const INTRODUCTION: &str = "No printed robot has walked yet. Therefore print in this order, and stop if something does not fit:\n\n\
1. the **coupon** (`lizard parts DIR --coupon`): each column of holes has more clearance than the column to its left. The first column from the left into which you can push all the loose pieces by hand shows your printer's `fit`;\n\
2. one **corner** (`lizard parts DIR --corner`): a seat, a link, a leg, a strut and a foot. Printing takes three hours. Assemble it as in steps 1, 5 and 7 to 9;\n\
3. all parts.\n\n\
Print all parts in the given orientation, in layers of 0.2 mm, **without supports**. A slicer may suggest supports under the two ends \
of a sleeve's roof, but a bridge of 6.4 mm needs none.";

/// Title of the step in which the pads are pressed onto their screws.
const LEGS_TITLE: &str = "Legs, on the bench";
/// Text for pads with a strip, added to the step in which the pads are pressed on.
const STRIP_TEXT: &str = " Before you press the screws' heads in, glue a strip along each dome, from the dome's notch to its other side. The hairs or \
bristles of the strip point away from the notch; the strip's front end is folded up and glued into the notch, so that no edge of the floor catches it. \
Cut all four strips from one piece: their thickness lifts the feet and must be equal. Cut a hole of 4 mm into each, over the hole for the key.";
/// Title of the step that levels the feet, the last step that turns pads.
const LEVEL_TITLE: &str = "Level the feet";
/// Text for pads with a grain, added to the step that levels the feet.
const GRAIN_TEXT: &str = " Finally, turn each pad on its screw until its grain is right: a finger glides smoothly over it \
from head to tail. docs/gaits.md has more about pads with a grain.";
/// Text for pads with a strip, added to the step that levels the feet.
const NOTCH_TEXT: &str =
    " The notches of all four pads, LF, RF, RH and LH, then point straight to the head.";

/// Makes bill.json and the folder guide/ with pictures at `pose`, usually neutral.
///
/// # Errors
/// Returns [`BuildError::Blocked`] if a screw cannot be reached.
///
/// # Panics
/// Never: texts and numbers can always be converted to JSON.
pub fn make_documents(
    assembly: &Assembly,
    bill: &Bill,
    pose: &Solution,
) -> Result<Vec<OutputFile>, BuildError> {
    let bill_json =
        serde_json::to_string_pretty(bill).expect("texts and numbers can be converted to JSON");
    let mut files = vec![OutputFile::new("bill.json", bill_json + "\n")];
    files.extend(make_guide(assembly, bill, pose)?);
    let placements = format_placements(assembly, pose);
    files.push(OutputFile::new("guide/placements.json", placements));
    Ok(files)
}

/// Makes the guide as Markdown and HTML, with pictures of the robot at `pose`.
fn make_guide(
    assembly: &Assembly,
    bill: &Bill,
    pose: &Solution,
) -> Result<Vec<OutputFile>, BuildError> {
    let mut steps = build_steps(assembly.robot().drive().strut().is_some());
    let has_strip = assembly.robot().parts().strip > 0.0;
    let has_grain = has_strip || assembly.robot().ground().friction_ratio > 1.0;
    for (title, text, is_needed) in [
        (LEGS_TITLE, STRIP_TEXT, has_strip),
        (LEVEL_TITLE, GRAIN_TEXT, has_grain),
        (LEVEL_TITLE, NOTCH_TEXT, has_strip),
    ] {
        let step = steps.iter_mut().find(|step| step.title == title);
        let step = step.expect("a step has this title");
        if is_needed {
            step.instructions += text;
        }
    }
    let access_poses = assembly.find_access_poses(&steps)?;
    let parts = assembly.collect_parts();
    let bodies = assembly.bodies().iter();
    let picture_bodies = bodies.map(|body| PictureBody::without_lift(body, false));
    let picture_bodies: Vec<_> = picture_bodies.collect();
    let labels = legend::make_servo_and_end_labels(assembly, pose);
    let robot_picture = draw_picture(assembly, &picture_bodies, pose, &View::default(), &labels);
    let mut files = vec![OutputFile::new("guide/robot.svg", robot_picture)];
    let mut text = format!(
        "# Building the robot\n\n![The robot](robot.svg)\n\n{INTRODUCTION}\n\n{}\n",
        format_part_notes(&parts, assembly.robot().parts().screw.diameter)
    );
    let _ = writeln!(text, "## What is needed\n\n{bill}");
    let mut added_bodies: Vec<&Body> = Vec::new();
    for (number, step) in (1..).zip(&steps) {
        let bodies = assembly.bodies().iter();
        let new_bodies: Vec<&Body> = bodies.filter(|body| step.adds(body)).collect();
        let (title, instructions) = (step.title, &step.instructions);
        let _ = writeln!(text, "## {number}. {title}\n\n{instructions}\n");
        if new_bodies.is_empty() {
            continue;
        }
        let names = legend::list_counted_names(&new_bodies, &parts).join("; ");
        let _ = writeln!(text, "Take {names}.\n");
        let is_in_step = |access_pose: &&AccessPose| access_pose.step == number;
        let mut stages = step.stages.iter();
        let is_on_bench = stages.any(|stage| stage.turning_place == TurningPlace::Bench);
        let to_text = |access_pose| format_turns(assembly, access_pose, is_on_bench);
        let step_poses = access_poses.iter().filter(is_in_step);
        let turns: Vec<_> = step_poses.map(to_text).collect();
        if !turns.is_empty() {
            let _ = writeln!(
                text,
                "Some screws cannot be reached in the pose that the picture shows. Seen from above, turn {}.\n",
                turns.join("; ")
            );
        }
        let bodies = [&added_bodies[..], &new_bodies];
        for (picture, drawing) in draw_step(assembly, &parts, pose, step, bodies) {
            let name = format!("step-{number}-{}.svg", picture.name);
            let _ = writeln!(text, "![{title}, {}]({name})", picture.caption);
            files.push(OutputFile::new(format!("guide/{name}"), drawing));
        }
        text.push('\n');
        added_bodies.extend(new_bodies);
    }
    let page = markdown_to_html(&text);
    files.push(OutputFile::new("guide/guide.html", page));
    files.push(OutputFile::new("guide/guide.md", text));
    Ok(files)
}

/// Formats the guide's text about holes to drill for screws of this diameter, mm, and about the marks on the parts.
fn format_part_notes(parts: &[Part], screw_diameter: f64) -> String {
    let format_holes = |part: &Part| match part.build_printed_layers() {
        (_, 0) => None,
        (_, 1) => Some(format!("a hole in each {}", part.name)),
        (_, count) => Some(format!("{count} holes in each {}", part.name)),
    };
    let hole_texts: Vec<_> = parts.iter().filter_map(format_holes).collect();
    format!(
        "Some holes are closed by one printed layer of {PRINT_LAYER_MM} mm, because a pocket is below them during printing. Open them with a {screw_diameter} mm drill \
         or a screw: {}. Parts that exist in two mirrored forms have the numbers of their servos engraved, such as 13 for A1 and A3.",
        hole_texts.join(", ")
    )
}

/// A picture of a step.
struct StepPicture {
    /// A word for the file's name.
    name: &'static str,
    caption: &'static str,
    view: View,
    /// Factor of the new bodies' lift in this picture.
    lift_factor: f64,
    /// True for a new body to draw in colour.
    is_coloured: fn(&Body) -> bool,
    has_part_labels: bool,
}

/// Draws a step's pictures as SVG.
fn draw_step(
    assembly: &Assembly,
    parts: &[Part],
    pose: &Solution,
    step: &Step,
    [earlier_bodies, new_bodies]: [&[&Body]; 2],
) -> Vec<(StepPicture, String)> {
    let view = View {
        width: PICTURE_WIDTH,
        ..View::default()
    };
    let view_from_below = |azimuth: f64, view: View| View {
        is_from_below: true,
        azimuth,
        ..view
    };
    let corner_view = View {
        is_close_up: true,
        azimuth: 150.0,
        elevation: 30.0,
        ..view
    };
    let exploded = StepPicture {
        name: "exploded",
        caption: "apart",
        view,
        lift_factor: 1.0,
        is_coloured: |_| true,
        has_part_labels: true,
    };
    let extra = match step.extra_view {
        ExtraView::None => None,
        ExtraView::Corner => Some(StepPicture {
            name: "near",
            caption: "the front left corner",
            view: corner_view,
            lift_factor: 0.6,
            is_coloured: is_at_corner,
            ..exploded
        }),
        ExtraView::CornerBelow => Some(StepPicture {
            name: "below",
            caption: "the front left corner from below",
            view: view_from_below(30.0, corner_view),
            lift_factor: 0.5,
            is_coloured: is_at_corner,
            ..exploded
        }),
        ExtraView::Below => Some(StepPicture {
            name: "below",
            caption: "from below",
            view: view_from_below(300.0, view),
            lift_factor: 0.0,
            ..exploded
        }),
    };
    // The last picture shows the result of the step, without the names of its parts.
    let done = StepPicture {
        name: "done",
        caption: "done",
        lift_factor: 0.0,
        has_part_labels: false,
        ..exploded
    };
    let draw = |picture: StepPicture| {
        let earlier_bodies = earlier_bodies.iter();
        let earlier_bodies = earlier_bodies.map(|body| PictureBody::without_lift(body, true));
        let new_bodies = new_bodies.iter().map(|&body| PictureBody {
            body,
            lift: picture.lift_factor * EXPLODED_LIFT * (step.lift)(body),
            is_grey: !(picture.is_coloured)(body),
        });
        let drawn_bodies: Vec<_> = earlier_bodies.chain(new_bodies).collect();
        let mut labels: Vec<Label> = legend::make_servo_and_end_labels(assembly, pose);
        if picture.has_part_labels {
            let part_labels = legend::make_part_labels(assembly, parts, &drawn_bodies, pose);
            labels.extend(part_labels);
        }
        let drawing = draw_picture(assembly, &drawn_bodies, pose, &picture.view, &labels);
        (picture, drawing)
    };
    let pictures = [Some(exploded), extra, Some(done)];
    pictures.into_iter().flatten().map(draw).collect()
}

/// True if a body belongs to the corner that close-ups show.
fn is_at_corner(body: &Body) -> bool {
    let (name, leg) = (SERVO_NAMES[CORNER_SERVO], LEG_NAMES[CORNER_SERVO]);
    match body.mount {
        Mount::Chassis | Mount::Sleeve(_) | Mount::Rod(_) => {
            body.name.split(' ').any(|word| word == name || word == leg)
        }
        mount => mount.servos() == [CORNER_SERVO],
    }
}

/// Formats the guide's text about the links to turn so that a tool can reach some screws.
fn format_turns(assembly: &Assembly, access_pose: &AccessPose, is_on_bench: bool) -> String {
    let neutral: [f64; 4] = assembly.robot().neutral_pose().into();
    let turns = (0..4).map(|servo| (servo, access_pose.pose[servo] - neutral[servo]));
    let turns = turns.filter(|(_, angle_deg)| angle_deg.abs() > 0.5);
    let turns = turns.map(|(servo, angle_deg)| {
        let direction = match angle_deg > 0.0 {
            true => "counter-clockwise",
            false => "clockwise",
        };
        let (name, leg) = (SERVO_NAMES[servo], LEG_NAMES[servo]);
        let subject = match is_on_bench {
            true => format!("crank and follower {leg}"),
            false => format!("link {name} with its leg"),
        };
        format!("{subject} by {:.0} deg {direction}", angle_deg.abs())
    });
    let (turns, screws) = (turns.collect::<Vec<_>>(), access_pose.screws.join(", "));
    format!("{} for {screws}", turns.join(" and "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_body_is_added_in_exactly_one_step() {
        let text = include_str!("../../../../robots/paper.toml");
        for (kind, is_slotted) in [("strut", true), ("rigid", false)] {
            let text = format!("{text}\n[leg.drive]\nkind = \"{kind}\"");
            let robot = lizard_robot::Robot::parse(&text)
                .expect("paper.toml is valid with either kind of leg drive");
            let steps = build_steps(is_slotted);
            for body in Assembly::new(&robot).bodies() {
                let count = steps.iter().filter(|step| step.adds(body)).count();
                assert_eq!(count, 1, "steps that add {}", body.name);
            }
        }
    }
}
