//! Tests of pads for a strip with a grain: the notch for the strip's end, and the direction that the notch marks.

use lizard_kinematics::Vector;
use lizard_parts::{Bill, Outline, Part, Shape, documents};
use lizard_robot::servo::LEG_NAMES;

use crate::{GRAIN_ROBOT, assembly, body, neutral_solution};

/// The notch of a pad, its only hole with corners; `None` for a plain pad.
fn notch_of(prisms: &[lizard_parts::Prism]) -> Option<&Shape> {
    let mut cuts = prisms.iter().flat_map(|prism| &prism.cut_shapes);
    cuts.find(|cut| cut.points.len() > 1)
}

#[test]
fn the_notches_of_all_four_printed_pads_point_to_the_head_when_mounted() {
    let assembly = assembly(GRAIN_ROBOT, "");
    let half_width = assembly.robot().parts().pad.width / 2.0;
    let parts = assembly.parts();
    let is_pad = |part: &&Part| part.is_flexible;
    let [pad] = parts.iter().filter(is_pad).collect::<Vec<_>>()[..] else {
        panic!("there is exactly one kind of pad");
    };
    assert_eq!(pad.count(), 4);
    let (layers, closed_count) = pad.printed_layers();
    assert_eq!(closed_count, 1, "the hole for the key, as in a plain pad");
    let notch = notch_of(&layers).expect("the printed pad has a notch");
    // A second pose is also checked, because a foot never turns.
    let poses = [[0.0; 4], [9.0, -8.0, 7.0, -6.0]].map(|turns| {
        let angles: [f64; 4] = assembly.robot().neutral_pose().into();
        let angles = std::array::from_fn(|servo| angles[servo] + turns[servo]);
        assembly
            .robot()
            .solve_if_allowed(angles)
            .expect("the guard accepts the pose")
    });
    for (pose, leg) in poses
        .iter()
        .flat_map(|pose| LEG_NAMES.map(|leg| (pose, leg)))
    {
        let (pad_body, screw) = (
            body(&assembly, &format!("pad {leg}")),
            body(&assembly, &format!("screw height {leg}")),
        );
        let motion = pad.print_to_body(pad_body);
        let placement = assembly.place(pad_body.mount, pose);
        let to_robot = |point: &Vector| {
            let y = if motion.is_flipped { -point.y } else { point.y };
            placement.map(motion.frame.map(Vector::new(point.x, y)))
        };
        let axis = placement.map(screw.prisms[0].filled_shapes[0].middle());
        for corner in &notch.points {
            let from_axis = to_robot(corner) - axis;
            // Robots of this project face along y.
            assert!(
                (from_axis.x.abs() - 4.2).abs() < 1e-9,
                "{leg}: {from_axis:?}"
            );
            assert!(from_axis.y > half_width - 1.51, "{leg}: {from_axis:?}");
        }
    }
}

#[test]
fn a_pad_for_a_strip_lies_within_a_plain_pad_and_is_as_high() {
    let [plain, notched] = ["paper", GRAIN_ROBOT].map(|name| assembly(name, ""));
    for leg in LEG_NAMES {
        let [plain, notched] =
            [&plain, &notched].map(|assembly| body(assembly, &format!("pad {leg}")));
        assert_eq!(plain.z(), notched.z());
        assert!(notch_of(&plain.prisms).is_none());
        assert_eq!(plain.prisms.len(), notched.prisms.len());
        let mut notched_count = 0;
        for (plain, notched) in plain.prisms.iter().zip(&notched.prisms) {
            assert_eq!(plain.z, notched.z);
            let radius_of = |prism: &lizard_parts::Prism, end: usize| {
                prism.filled_shapes[0].radius - prism.inset[end]
            };
            for end in [0, 1] {
                let excess = radius_of(notched, end) - radius_of(plain, end);
                assert!((-0.3..1e-9).contains(&excess), "{leg}: {excess}");
            }
            if notched.cut_shapes.len() > plain.cut_shapes.len() {
                let [notched_area, plain_area] =
                    [notched, plain].map(|prism| Outline::of(prism).area());
                assert!(
                    notched_area < plain_area - 1.0,
                    "{leg}: {notched_area} {plain_area}"
                );
                notched_count += 1;
            }
        }
        // The notch exists only in the layers where the dome is wide enough for it.
        assert!(notched_count > 5, "{leg}: {notched_count} layers");
    }
}

#[test]
fn a_strip_that_its_pad_cannot_carry_is_refused() {
    for (width, fits) in [(4.0, false), (5.0, true), (14.5, true), (15.5, false)] {
        let assembly = assembly("paper", &format!("[parts]\nstrip = {width:.1}"));
        let refusal = assembly
            .check_dimensions()
            .err()
            .map(|problem| problem.to_string());
        assert_eq!(refusal.is_none(), fits, "{width}");
        assert!(refusal.is_none_or(|message| message.starts_with("parts.strip is")));
    }
}

#[test]
fn only_the_guide_of_a_robot_with_strips_says_how_to_glue_and_turn_them() {
    for (name, has_strip) in [("paper", false), (GRAIN_ROBOT, true)] {
        let assembly = assembly(name, "");
        let pose = neutral_solution(&assembly);
        let bill = Bill::of(&assembly, &assembly.parts(), &pose);
        let strips = bill
            .inputs
            .iter()
            .filter(|item| item.what.starts_with("strip with a grain, 8 x 30 mm"));
        assert_eq!(
            strips.map(|item| item.count).sum::<usize>(),
            4 * usize::from(has_strip)
        );
        let files = documents(&assembly, &bill, &pose).expect("every screw can be reached");
        let text = files.iter().find(|file| file.path.ends_with("guide.md"));
        let text = String::from_utf8_lossy(&text.expect("the documents contain the guide").bytes)
            .into_owned();
        for phrase in [
            "folded up and glued into the notch",
            "point straight to the head",
        ] {
            assert_eq!(text.contains(phrase), has_strip, "{name}: {phrase}");
        }
    }
}
