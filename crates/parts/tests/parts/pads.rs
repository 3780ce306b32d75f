//! Tests of pads for a strip with a grain: the notch for the strip's end, and the notch's direction.

use lizard_kinematics::Vector;
use lizard_parts::{Outline, Part, Prism, Shape, make_documents};
use lizard_robot::servo::LEG_NAMES;

use crate::{GRAIN_ROBOT, build_assembly, compute_bill, find_body, solve_at_neutral};

/// Finds the notch of a pad, its only hole with corners; `None` for a plain pad.
fn find_notch(prisms: &[Prism]) -> Option<&Shape> {
    let mut cuts = prisms.iter().flat_map(|prism| &prism.cut_shapes);
    cuts.find(|cut| cut.points.len() > 1)
}

#[test]
fn the_notches_of_all_four_printed_pads_point_to_the_head_when_mounted() {
    let assembly = build_assembly(GRAIN_ROBOT, "");
    let half_width = assembly.robot().parts().pad.width / 2.0;
    let parts = assembly.collect_parts();
    let is_pad = |part: &&Part| part.is_flexible;
    let [pad] = parts.iter().filter(is_pad).collect::<Vec<_>>()[..] else {
        panic!("there is exactly one kind of pad");
    };
    assert_eq!(pad.count(), 4);
    let (layers, bridged_count) = pad.build_printed_layers();
    // The hole for the key is bridged, as in a plain pad.
    assert_eq!(bridged_count, 1, "bridged holes");
    let notch = find_notch(&layers).expect("the printed pad has a notch");
    // A foot never turns, so the second pose must give the same result.
    let poses = [[0.0; 4], [9.0, -8.0, 7.0, -6.0]].map(|turns| {
        let angles: [f64; 4] = assembly.robot().neutral_pose().into();
        let angles = std::array::from_fn(|servo| angles[servo] + turns[servo]);
        let pose = assembly.robot().solve_if_allowed(angles);
        pose.expect("the guard accepts the pose")
    });
    let with_legs = |pose| LEG_NAMES.map(|leg| (pose, leg));
    for (pose, leg) in poses.iter().flat_map(with_legs) {
        let [pad_body, screw] =
            ["pad", "screw height"].map(|noun| find_body(&assembly, &format!("{noun} {leg}")));
        let transform = pad.transform_to_body(pad_body);
        let (is_flipped, frame) = (transform.is_flipped, transform.frame);
        let placement = assembly.placement(pad_body.mount, pose);
        let to_robot = |point: &Vector| {
            let y = if is_flipped { -point.y } else { point.y };
            placement.map(frame.map(Vector::new(point.x, y)))
        };
        let axis = placement.map(screw.prisms[0].filled_shapes[0].middle());
        for corner in &notch.points {
            let from_axis = to_robot(corner) - axis;
            // The head lies in the +y direction. The strip is 8 mm wide, with a fit of 0.2 mm on each side.
            let x_error = from_axis.x.abs() - 4.2;
            assert!(x_error.abs() < 1e-9, "{leg}: {from_axis:?}");
            assert!(from_axis.y > half_width - 1.51, "{leg}: {from_axis:?}");
        }
    }
}

#[test]
fn a_pad_with_a_notch_is_as_high_as_a_plain_pad_and_no_wider() {
    let assemblies = ["paper", GRAIN_ROBOT].map(|name| build_assembly(name, ""));
    for leg in LEG_NAMES {
        let find_pad = |assembly| find_body(assembly, &format!("pad {leg}"));
        let [plain_body, notched_body] = assemblies.each_ref().map(find_pad);
        assert_eq!(plain_body.z(), notched_body.z());
        assert!(find_notch(&plain_body.prisms).is_none());
        assert_eq!(plain_body.prisms.len(), notched_body.prisms.len());
        let mut notched_count = 0;
        for (plain, notched) in plain_body.prisms.iter().zip(&notched_body.prisms) {
            assert_eq!(plain.z, notched.z);
            let end_radii = |prism: &Prism| {
                let radius = prism.filled_shapes[0].radius;
                prism.insets.map(|inset| radius - inset)
            };
            let [plain_radii, notched_radii] = [plain, notched].map(end_radii);
            for (notched_radius, plain_radius) in notched_radii.into_iter().zip(plain_radii) {
                let excess = notched_radius - plain_radius;
                assert!((-0.3..1e-9).contains(&excess), "{leg}: {excess} mm wider");
            }
            if notched.cut_shapes.len() > plain.cut_shapes.len() {
                let [notched_area, plain_area] =
                    [notched, plain].map(|prism| Outline::from_prism(prism).area());
                assert!(
                    notched_area < plain_area - 1.0,
                    "{leg}: notched {notched_area} mm^2, plain {plain_area} mm^2"
                );
                notched_count += 1;
            }
        }
        // The notch exists only in the layers where the dome is wide enough for it.
        assert!(notched_count > 5, "{leg}: {notched_count} layers");
    }
}

#[test]
fn a_strip_that_does_not_fit_its_pad_is_rejected() {
    for (width, fits) in [(4.0, false), (5.0, true), (14.5, true), (15.5, false)] {
        let assembly = build_assembly("paper", &format!("[parts]\nstrip = {width:.1}"));
        let error = assembly.check_dimensions().err();
        let message = error.map(|error| error.to_string());
        assert_eq!(message.is_none(), fits, "a strip of {width} mm");
        assert!(message.is_none_or(|message| message.starts_with("parts.strip must be")));
    }
}

#[test]
fn bill_and_guide_mention_strips_only_for_a_robot_with_strips() {
    for (name, has_strip) in [("paper", false), (GRAIN_ROBOT, true)] {
        let assembly = build_assembly(name, "");
        let pose = solve_at_neutral(assembly.robot());
        let (bill, strip_name) = (compute_bill(&assembly), "strip with a grain, 8 x 30 mm");
        let inputs = bill.inputs.iter();
        let strips = inputs.filter(|item| item.name.starts_with(strip_name));
        let strip_count = strips.map(|item| item.count).sum::<usize>();
        assert_eq!(strip_count, 4 * usize::from(has_strip), "{name}");
        let files = make_documents(&assembly, &bill, &pose).expect("every screw can be reached");
        let text = files.iter().find(|file| file.path.ends_with("guide.md"));
        let text = String::from_utf8_lossy(&text.expect("the documents contain the guide").bytes);
        let notch_phrase = "folded up and glued into the notch";
        for phrase in [notch_phrase, "point straight to the head"] {
            assert_eq!(text.contains(phrase), has_strip, "{name}: {phrase}");
        }
    }
}
