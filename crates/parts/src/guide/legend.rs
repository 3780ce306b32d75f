//! Labels in the guide's pictures: the new bodies of a step with their counts, the servos, and the robot's two ends.

use std::collections::BTreeMap;

use lizard_kinematics::{Solution, Vector};
use lizard_robot::servo::SERVO_NAMES;

use crate::bodies::assembly::Assembly;
use crate::guide::drawing::Label;
use crate::guide::picture::PictureBody;
use crate::layers::body::{Body, Kind, Mount};
use crate::part::Part;

/// Formats a body's name for the guide, such as `M3 x 12` for a screw, or noun and engraved mark for a printed part,
/// such as `link, marked 13`. Returns `None` for a lead, and for a printed body that is not in `parts`.
pub fn format_name(body: &Body, parts: &[Part]) -> Option<String> {
    // The narrowest layer of a screw is its shank.
    let shank_diameter = || {
        let layers = body.prisms.iter();
        let diameters = layers.map(|layer| layer.filled_shapes[0].diameter());
        diameters.fold(f64::INFINITY, f64::min)
    };
    Some(match body.kind {
        Kind::Screw(length) => format!("M{} x {length}", shank_diameter()),
        Kind::HexScrew(length) => format!("M{} x {length}, hexagon head", shank_diameter()),
        Kind::HornScrew(length) => format!("horn screw, {length} mm"),
        Kind::Nut => "lock nut".to_owned(),
        Kind::Standoff(length) => format!("standoff, {length} mm"),
        Kind::Pad => "pad".to_owned(),
        Kind::Board => "Arduino UNO".to_owned(),
        Kind::Lead => return None,
        Kind::ServoScrew | Kind::Servo | Kind::Horn | Kind::Spring | Kind::Battery => {
            body.kind.word().to_owned()
        }
        Kind::Fitting(fitting) => fitting.spec().name.to_owned(),
        Kind::Printed => {
            let part = parts.iter().find(|part| part.prints_body(body))?;
            // The noun ends before the names of servos or legs, as in `link A1 A3`.
            let name = part.name.split(" A").next()?;
            let noun = name.split(['L', 'R']).next()?.trim();
            match part.mark.is_empty() {
                true => noun.to_owned(),
                false => format!("{noun}, marked {}", part.mark),
            }
        }
    })
}

/// Lists the names of bodies with their counts, such as `4 x M3 x 12`, beginning with the printed parts.
pub fn list_counted_names(bodies: &[&Body], parts: &[Part]) -> Vec<String> {
    let mut counts: BTreeMap<(bool, usize, String), usize> = BTreeMap::new();
    for body in bodies {
        if let Some(name) = format_name(body, parts) {
            let is_bought = !body.kind.is_printed();
            // Shorter names come first: M3 x 8 before M3 x 12.
            *counts.entry((is_bought, name.len(), name)).or_default() += 1;
        }
    }
    let counts = counts.into_iter();
    let texts = counts.map(|((_, _, name), count)| format!("{count} x {name}"));
    texts.collect()
}

/// A point in front of the robot on its left, chassis frame, mm. Of several bodies with the same name, the one nearest
/// to this point is labelled.
const LABEL_VIEWPOINT: Vector = Vector::new(-60.0, 80.0);

/// Makes labels for the bodies in a picture that are not grey: each name once, with its count, at the body nearest to
/// [`LABEL_VIEWPOINT`].
pub fn make_part_labels(
    assembly: &Assembly,
    parts: &[Part],
    picture_bodies: &[PictureBody],
    pose: &Solution,
) -> Vec<Label> {
    // The labels of all bodies with the same name, without the count, each with its distance from LABEL_VIEWPOINT, mm.
    let mut labels_by_name: BTreeMap<String, Vec<(f64, Label)>> = BTreeMap::new();
    let coloured_bodies = picture_bodies.iter().filter(|body| !body.is_grey);
    for PictureBody { body, lift, .. } in coloured_bodies {
        let (Some(name), Some(prism)) = (format_name(body, parts), body.prisms.last()) else {
            continue;
        };
        let placement = assembly.placement(body.mount, pose);
        let position = placement.map(prism.filled_shapes[0].middle());
        let distance = (position - LABEL_VIEWPOINT).length();
        let label = Label {
            position,
            z: (body.z()[0] + body.z()[1]) / 2.0 + lift,
            text: name.clone(),
            is_beside: true,
        };
        let labels = labels_by_name.entry(name).or_default();
        labels.push((distance, label));
    }
    let labels = labels_by_name.into_values().filter_map(|labels| {
        let count_text = format!("{} x ", labels.len());
        let (_, mut label) = labels.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        label.text.insert_str(0, &count_text);
        Some(label)
    });
    labels.collect()
}

/// Makes labels for the four servos and for both ends of the robot.
pub fn make_servo_and_end_labels(assembly: &Assembly, pose: &Solution) -> Vec<Label> {
    /// Height of the labels, at the links, mm.
    const LINK_HEIGHT: f64 = 18.0;
    let label_at = |position: Vector, text: &str| Label {
        position,
        z: LINK_HEIGHT,
        text: text.to_owned(),
        is_beside: false,
    };
    // The label is on the link, because the board may hide the shaft.
    let point_on_link = |servo: usize| {
        let link_point = Vector::new(0.7 * assembly.layout().crank_lengths[servo], 0.0);
        assembly.placement(Mount::Link(servo), pose).map(link_point)
    };
    let servos = (0..4).map(|servo| label_at(point_on_link(servo), SERVO_NAMES[servo]));
    let end_y = assembly.layout().plate.half_size.y + 16.0;
    let ends = [(end_y, "HEAD"), (-end_y, "TAIL")];
    let ends = ends.map(|(y, name)| label_at(Vector::new(0.0, y), name));
    servos.chain(ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_screws_name_has_the_diameter_in_robot_toml() {
        let text = include_str!("../../../../robots/paper.toml");
        let robot = lizard_robot::Robot::parse(&format!("{text}\n[parts.screw]\ndiameter = 2.5"));
        let assembly = Assembly::new(&robot.expect("the robot is valid"));
        let screw = assembly.body("screw height LF");
        let name = format_name(screw.expect("the foot has a screw"), &[]);
        assert_eq!(name.as_deref(), Some("M2.5 x 10"));
    }
}
