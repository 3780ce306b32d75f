//! Nothing meets what it is not made to meet, at poses on a grid; and where a measure
//! of the parts is wrong, something does.

use lizard_parts::{Assembly, Clearance};

use crate::{ROBOTS, STRUT, with};

/// The nearest pair of the paper's robot with other parts.
fn nearest(parts: &str) -> Option<Clearance> {
    let robot = with("paper", &format!("{STRUT}\n{parts}"));
    let assembly = Assembly::new(&robot);
    assembly.nearest(assembly.poses(9), 1.0).into_iter().next()
}

#[test]
fn every_robot_has_air_between_its_parts() {
    for name in ROBOTS {
        let assembly = Assembly::new(&with(name, STRUT));
        assert!(assembly.poses(10).count() > 100, "{name}");
        let near = assembly.nearest(assembly.poses(10), 0.2);
        assert!(near.is_empty(), "{name}: {}", near[0]);
    }
}

#[test]
fn a_wrong_measure_makes_parts_overlap() {
    for (parts, first, second) in [
        ("[parts]\nbar = 24.0", "", ""),
        ("[parts]\npivot = [6.25, -4.0]", "", ""),
        ("[parts.servo]\nboss = 20.0", "servo", "strut"),
        ("[parts]\nbattery = [90.0, 90.0, 30.0]", "", "battery"),
        ("[parts]\nanchor = [12.0, 5.0]", "", ""),
        ("[parts.screw]\nhead = 14.0\nhead_height = 3.0", "screw", ""),
    ] {
        let near = nearest(parts).unwrap_or_else(|| panic!("{parts}: nothing is near"));
        assert!(near.mm < 0.0, "{parts}: {near}");
        assert!(
            near.first.contains(first) || near.second.contains(second),
            "{parts}: {near}"
        );
    }
}

#[test]
fn a_body_is_found_by_its_name_and_has_layers_from_below_to_above() {
    let assembly = Assembly::new(&with("unequal", ""));
    let mut names: Vec<_> = assembly.bodies().iter().map(|body| &body.name).collect();
    names.sort();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count, "two bodies have one name");
    for body in assembly.bodies() {
        for pair in body.prisms.windows(2) {
            assert_eq!(pair[0].z[1], pair[1].z[0], "{}", body.name);
        }
        for prism in &body.prisms {
            assert!(prism.z[0] < prism.z[1], "{}", body.name);
        }
        for other in &body.meets {
            assert!(
                assembly.body(other).is_some(),
                "{} meets {other}",
                body.name
            );
        }
    }
}

#[test]
fn pins_meet_the_holes_of_what_they_hold() {
    for name in ROBOTS {
        let robot = with(name, "");
        let assembly = Assembly::new(&robot);
        let mut met = 0;
        for pose in assembly.poses(5) {
            for screw in assembly.bodies() {
                if !screw.name.starts_with("screw ") {
                    continue;
                }
                let shank = &screw
                    .prisms
                    .iter()
                    .min_by(|a, b| a.add[0].width().total_cmp(&b.add[0].width()));
                let shank = &shank.expect("a shank").add[0];
                let place = assembly.place(screw.mount, &pose);
                let at = place.map(shank.points[0]);
                for held in &screw.meets {
                    let held = assembly.body(held).expect(held);
                    let frame = assembly.place(held.mount, &pose);
                    let near = held
                        .prisms
                        .iter()
                        .flat_map(|prism| &prism.cut)
                        .filter(|cut| cut.radius >= shank.radius - 0.3)
                        .map(|cut| (frame.map(cut.points[0]) - at).length())
                        .fold(f64::INFINITY, f64::min);
                    assert!(
                        near < 1e-9,
                        "{name}: {} in {} {near}",
                        screw.name,
                        held.name
                    );
                    met += 1;
                }
            }
        }
        assert!(met > 50, "{name}: {met} holes");
    }
}

#[test]
fn a_robot_that_does_not_fit_is_refused_in_one_sentence() {
    let refused = |parts: &str| {
        let robot = with("paper", &format!("{STRUT}\n{parts}"));
        let unfit = Assembly::new(&robot).fits().expect_err(parts);
        unfit.to_string()
    };
    // The pivot that the paper's figures suggest is under the servo's link.
    let naive = refused("[parts]\npivot = [6.25, -4.0]\n[parts.spring]\nlength = 8.0");
    assert!(
        naive.contains(" and ") && naive.contains("overlap by"),
        "{naive}"
    );
    let near = refused("[parts]\npivot = [22.0, 6.0]\n[parts.spring]\nlength = 20.0");
    assert!(
        near.contains("overlap by") && near.contains("at pose"),
        "{near}"
    );
    for (parts, sentence) in [
        (
            "[parts]\nbar = 6.0",
            "parts.bar is 6 mm, but the head of a screw and a wall on each side need 7.3 mm",
        ),
        ("[parts]\nheight = 15.0", "the feet need 21.3 mm"),
        (
            "[parts.spring]\nlength = 40.0",
            "leg strut LF is 30.2 mm from screw to screw, but its spring is 40.0 mm long",
        ),
        ("[parts]\nthickness = 15.0", "do not make one body"),
    ] {
        let refused = refused(parts);
        assert!(refused.contains(sentence), "{refused}");
    }
    for name in ROBOTS {
        let robot = with(name, "");
        assert_eq!(Assembly::new(&robot).fits(), Ok(()), "{name}");
    }
}
