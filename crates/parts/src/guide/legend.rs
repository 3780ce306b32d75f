//! The names in the pictures of the guide: what is new in a step, how often, and which
//! end of the robot is which.

use std::collections::BTreeMap;

use lizard_kinematics::{Solution, Vector};
use lizard_robot::servo::NAMES;

use crate::bodies::assembly::Assembly;
use crate::guide::ink::Label;
use crate::guide::picture::Drawn;
use crate::layers::body::{Body, Kind, Mount};
use crate::part::Part;

/// What a body is called in the guide: screws by their length, printed parts by the name
/// of their file and their mark.
pub fn called(body: &Body, parts: &[Part]) -> Option<String> {
    Some(match body.kind {
        Kind::Screw(length) => format!("M3 x {length}"),
        Kind::HexScrew(length) => format!("M3 x {length}, hexagon head"),
        Kind::HornScrew(length) => format!("horn screw, {length} mm"),
        Kind::ServoScrew => "servo screw".to_owned(),
        Kind::Nut => "lock nut".to_owned(),
        Kind::Standoff(length) => format!("standoff, {length} mm"),
        Kind::Servo => "servo".to_owned(),
        Kind::Horn => "horn".to_owned(),
        Kind::Spring => "spring".to_owned(),
        Kind::Pad => "rubber pad".to_owned(),
        Kind::Board => "Arduino UNO".to_owned(),
        Kind::Battery => "battery".to_owned(),
        Kind::Lead => return None,
        Kind::Fitting(fitting) => fitting.name().to_owned(),
        Kind::Printed => {
            let part = parts.iter().find(|part| part.bodies.contains(&body.name))?;
            let what = part
                .name
                .split_once(" A")
                .map_or(&*part.name, |(what, _)| what);
            let what = what
                .split_once(['L', 'R'])
                .map_or(what, |(what, _)| what.trim());
            match part.mark.is_empty() {
                true => what.to_owned(),
                false => format!("{what}, marked {}", part.mark),
            }
        }
    })
}

/// How many of each are among some bodies: `4 x M3 x 12`, the printed parts first.
pub fn counted(bodies: &[&Body], parts: &[Part]) -> Vec<String> {
    let mut counts: BTreeMap<(bool, usize, String), usize> = BTreeMap::new();
    for body in bodies {
        if let Some(name) = called(body, parts) {
            let screw = !matches!(body.kind, Kind::Printed);
            // M3 x 8 comes before M3 x 12.
            *counts.entry((screw, name.len(), name)).or_default() += 1;
        }
    }
    let words = counts.into_iter();
    words
        .map(|((_, _, name), count)| format!("{count} x {name}"))
        .collect()
}

/// Names of what is new in a picture: each once, at the one that is nearest to the front
/// left corner.
pub fn names(assembly: &Assembly, parts: &[Part], drawn: &[Drawn], pose: &Solution) -> Vec<Label> {
    let mut found: BTreeMap<String, (f64, usize, Label)> = BTreeMap::new();
    for Drawn { body, lift, pale } in drawn {
        let Some(name) = called(body, parts).filter(|_| !pale) else {
            continue;
        };
        let Some(prism) = body.prisms.last() else {
            continue;
        };
        let at = assembly.place(body.mount, pose).map(prism.add[0].middle());
        let away = (at - Vector::new(-60.0, 80.0)).length();
        let label = Label {
            at,
            z: (body.z()[0] + body.z()[1]) / 2.0 + lift,
            text: name.clone(),
            beside: true,
        };
        let entry = found.entry(name).or_insert((away, 0, label.clone()));
        entry.1 += 1;
        if away < entry.0 {
            (entry.0, entry.2) = (away, label);
        }
    }
    let labels = found.into_values().map(|(_, count, label)| Label {
        text: format!("{count} x {}", label.text),
        ..label
    });
    labels.collect()
}

/// The servos' names at their places, and which end is which.
pub fn places(assembly: &Assembly, pose: &Solution) -> Vec<Label> {
    /// As high as the links, mm.
    const HIGH: f64 = 18.0;
    let label = |at: Vector, text: &str| Label {
        at,
        z: HIGH,
        text: text.to_owned(),
        beside: false,
    };
    // On its link, beside the shaft, which the board may hide.
    let on_link = |servo: usize| {
        let out = 0.7 * assembly.layout().crank[servo];
        assembly
            .place(Mount::Link(servo), pose)
            .map(Vector::new(out, 0.0))
    };
    let mut labels: Vec<_> = (0..4)
        .map(|servo| label(on_link(servo), NAMES[servo]))
        .collect();
    let ends = assembly.layout().plate.half.y + 16.0;
    labels.push(label(Vector::new(0.0, ends), "HEAD"));
    labels.push(label(Vector::new(0.0, -ends), "TAIL"));
    labels
}
