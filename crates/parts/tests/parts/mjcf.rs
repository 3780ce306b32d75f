//! Tests that the MuJoCo file agrees with robot.toml.

use std::collections::BTreeMap;

use lizard_kinematics::{End, Side, Vector};
use lizard_parts::{Assembly, Block, Course, Mesh, Pads, Solid, StrutSpring};
use lizard_robot::Robot;
use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};
use roxmltree::{Document, Node};

use crate::mjcf_masses::mass_and_centre;
use crate::mjcf_reader::{
    STRUT_SPRING, bodies, child, mjcf_with, neutral_solution, numbers, section_elements,
};
use crate::{GRAIN_ROBOT, ROBOTS, robot_with};

fn robot(name: &str) -> Robot {
    robot_with(name, "")
}

#[test]
fn loops_are_closed_where_the_robots_joints_are() {
    for name in ROBOTS {
        let robot = robot(name);
        let solution = neutral_solution(&robot);
        let angles: [f64; 4] = robot.neutral_pose().into();
        let legs = [0, 1, 2, 3].map(|i| robot.legs()[i].place_at(angles[i], angles[i]));
        let shafts = robot.lizard().shafts();
        let mut joints: BTreeMap<String, Vector> = BTreeMap::new();
        for end in End::ALL {
            joints.insert(format!("end {}", end.name()), solution.point(end));
        }
        for side in Side::ALL {
            let rear_shaft = shafts[side.servos()[1]];
            let tip = rear_shaft + solution.side(side).front_tip;
            joints.insert(format!("slider {}", side.name()), tip);
        }
        for (leg, leg_points) in LEG_NAMES.iter().zip(&legs) {
            joints.insert(format!("follower joint {leg}"), leg_points.joints[1]);
            joints.insert(format!("leg anchor {leg}"), leg_points.strut_anchors[1]);
        }
        for strut_spring in [None, Some(STRUT_SPRING)] {
            let text = mjcf_with(&robot, |scene| scene.strut_spring = strut_spring);
            let document = Document::parse(&text).expect("the file is well-formed XML");
            let bodies_by_name = bodies(&document);
            let loops = section_elements(&document, "equality");
            assert_eq!(loops.len(), joints.len());
            for connect in loops {
                let attribute_of = |attribute: &str| connect.attribute(attribute).expect(attribute);
                let (first, second) = (attribute_of("body1"), attribute_of("body2"));
                assert!(bodies_by_name.contains_key(second), "{second}");
                let (placement, _) = bodies_by_name[first];
                let anchor = placement.point(&numbers(connect, "anchor"));
                let joint = joints[attribute_of("name")] * 1e-3;
                let error = (anchor[0] - joint.x).hypot(anchor[1] - joint.y);
                assert!(error < 1e-8, "{name} {connect:?} {error}");
            }
        }
    }
}

#[test]
fn each_foot_stands_where_the_contact_model_places_it_and_a_longer_foot_is_lower() {
    for name in ROBOTS {
        let robot = robot(name);
        let text = mjcf_with(&robot, |scene| scene.excess_lengths = [0.0, 0.6, 0.0, -0.3]);
        let document = Document::parse(&text).expect("the file is well-formed XML");
        let bodies_by_name = bodies(&document);
        let feet = robot.ground().feet.positions([0.0; 4]);
        for (servo, excess) in [0.0, 0.6, 0.0, -0.3].into_iter().enumerate() {
            let (placement, foot) = bodies_by_name[&format!("foot {}", LEG_NAMES[servo])];
            let mut geoms = foot.children();
            let pad = geoms.find(|geom| geom.attribute("type") == Some("sphere"));
            let pad = pad.expect("the foot has a spherical pad");
            let [x, y, z] = placement
                .point(&numbers(pad, "pos"))
                .map(|coordinate| 1000.0 * coordinate);
            let pad_bottom = z - 1000.0 * numbers(pad, "size")[0];
            let [forward, left] = feet[servo];
            assert!((y - forward).hypot(x + left) < 1e-5, "{name} {x} {y}");
            // The longest foot is on the floor.
            assert!(
                (pad_bottom - (0.6 - excess)).abs() < 1e-5,
                "{name} {pad_bottom}"
            );
            assert_eq!(child(foot, "joint").attribute("type"), Some("slide"));
        }
    }
}

#[test]
fn pads_of_other_shapes_touch_the_floor_and_light_limbs_keep_the_robots_mass() {
    let (normal_mass, _) = mass_and_centre(&mjcf_with(&robot("paper"), |_| {}));
    let (light_mass, _) = mass_and_centre(&mjcf_with(&robot("paper"), |scene| {
        scene.limb_mass_factor = 0.2
    }));
    assert!(
        (normal_mass - light_mass).abs() < 1e-3,
        "{normal_mass} {light_mass}"
    );
    let radius = robot("paper").parts().pad.radius;
    for (pads, count) in [
        (Pads::Domes(5.0), 1),
        (Pads::Flat(8.0), 1),
        // The dome is 2.08 mm high at its rim, 11 mm from its axis.
        (Pads::Terraces(0.1), 21),
    ] {
        let text = mjcf_with(&robot("paper"), |scene| {
            (scene.pads, scene.has_shapes) = (pads, false);
        });
        let document = Document::parse(&text).expect("the file is well-formed XML");
        let bodies_by_name = bodies(&document);
        let (placement, foot) = &bodies_by_name["foot LF"];
        let geoms: Vec<_> = foot
            .children()
            .filter(|node| node.has_attribute("friction"))
            .collect();
        assert_eq!(geoms.len(), count, "{pads:?}");
        for (layer, geom) in geoms.iter().enumerate() {
            let size = numbers(*geom, "size");
            let [_, _, z] = placement
                .point(&numbers(*geom, "pos"))
                .map(|coordinate| 1000.0 * coordinate);
            let half_height = 1000.0 * size[size.len() - 1];
            let expected_bottom = 0.1 * layer as f64;
            assert!(
                (z - half_height - expected_bottom).abs() < 1e-5,
                "{pads:?} {layer}: {z} {half_height}"
            );
            if let Pads::Terraces(_) = pads {
                // The rim of the disc's middle plane is on the dome's sphere.
                let centre_distance = (1000.0 * size[0]).hypot(radius - z);
                assert!(
                    (centre_distance - radius).abs() < 1e-3,
                    "{layer}: {centre_distance}"
                );
            }
        }
    }
}

#[test]
fn a_floor_has_its_blocks_its_slope_and_its_friction_on_each_pad() {
    let text = mjcf_with(&robot("paper"), |scene| {
        let (centre, size) = ([20.0, 300.0], [10.0, 40.0, 2.0]);
        let rotation_deg = 30.0;
        scene.floor.blocks.push(Block {
            centre,
            size,
            rotation: rotation_deg,
        });
        scene.floor.slope = 30.0;
        scene.floor.friction_coefficients = [0.1, 0.2, 0.3, 0.4];
    });
    let document = Document::parse(&text).expect("the file is well-formed XML");
    let mut nodes = document.descendants();
    let option = nodes
        .find(|node| node.has_tag_name("option"))
        .expect("the file has an option element");
    // The floor rises ahead, so half of the weight pulls the robot back at 30 deg.
    let [right, ahead, up] = numbers(option, "gravity")[..] else {
        panic!("gravity has three components")
    };
    assert!(right == 0.0 && (ahead + 0.5 * 9.81).abs() < 0.01, "{ahead}");
    assert!((up + 0.866 * 9.81).abs() < 0.01, "{up}");
    let geoms = || {
        document
            .descendants()
            .filter(|node| node.has_tag_name("geom"))
    };
    let block = geoms().find(|geom| geom.attribute("type") == Some("box"));
    let block = block.expect("the floor has a block");
    let [position, half_size] = ["pos", "size"].map(|attribute| numbers(block, attribute));
    assert_eq!((position[0], position[1]), (0.02, 0.3));
    let euler = numbers(block, "euler");
    assert!((euler[2] - 30f64.to_radians()).abs() < 1e-6 && euler[..2] == [0.0; 2]);
    assert_eq!(
        (half_size[0], half_size[1], position[2] + half_size[2]),
        (0.005, 0.02, 0.002)
    );
    for (leg, friction) in LEG_NAMES.into_iter().zip([0.1, 0.2, 0.3, 0.4]) {
        let name = format!("pad {leg}");
        let pad = geoms().find(|geom| geom.attribute("name") == Some(&name));
        let pad = pad.expect("each leg has a pad");
        // Without priority, MuJoCo would use the larger friction of pad and floor.
        assert_eq!(pad.attribute("priority"), Some("1"));
        assert_eq!(numbers(pad, "friction")[0], friction);
    }
}

#[test]
fn the_sphere_that_touches_the_floor_is_that_of_the_pads_dome() {
    let assembly = Assembly::new(&robot("paper"));
    let pad = assembly.body("pad LF").expect("the leg has a pad");
    let text = mjcf_with(&robot("paper"), |_| ());
    let document = Document::parse(&text).expect("the file is well-formed XML");
    let mut nodes = document
        .descendants()
        .filter(|node| node.has_tag_name("geom"));
    let sphere = nodes.find(|node| node.attribute("name") == Some("pad LF"));
    let radius = 1000.0 * numbers(sphere.expect("the file has the pad's sphere"), "size")[0];
    let parts = assembly.parts();
    let part = parts.iter().find(|part| part.body_names[0] == pad.name);
    let (layers, _) = part.expect("the pad is printed").printed_layers();
    let mesh = Mesh::of(&Solid::of(&layers));
    // The printed pad lies on its back, centred on the origin; in the middle is the hole for the screw.
    let top = mesh.corners.iter().fold(0.0, |top, [.., z]| z.max(top));
    let (mut lowest, mut triangle_count) = (top, 0);
    for triangle in &mesh.triangles {
        let corners = triangle.map(|corner| mesh.corners[corner]);
        let axis_distances = corners.map(|[x, y, _]| x.hypot(y));
        let are_on_dome = axis_distances.map(|distance| (3.05..10.95).contains(&distance));
        if are_on_dome == [false; 3] {
            continue;
        }
        triangle_count += 1;
        for ([.., z], axis_distance) in corners.into_iter().zip(axis_distances) {
            let sphere_z = top - radius + (radius.powi(2) - axis_distance.powi(2)).sqrt();
            assert!(
                (z - sphere_z).abs() < 0.002,
                "{z} where the sphere has {sphere_z}"
            );
            lowest = lowest.min(z);
        }
        let [a, b, c] = corners;
        let ([ux, uy, _], [vx, vy, _]) = (
            [0, 1, 2].map(|i| b[i] - a[i]),
            [0, 1, 2].map(|i| c[i] - a[i]),
        );
        assert!(ux * vy - uy * vx > 1e-6, "a vertical triangle: {corners:?}");
    }
    assert!(
        triangle_count > 1000 && top - lowest > 1.9,
        "a dome of {} mm",
        top - lowest
    );
}

#[test]
fn a_slotted_strut_pulls_with_its_springs_force_and_yields_in_one_direction() {
    let StrutSpring {
        preload: force,
        rate,
    } = STRUT_SPRING;
    let text = mjcf_with(&robot("paper"), |scene| {
        scene.strut_spring = Some(STRUT_SPRING);
    });
    let document = Document::parse(&text).expect("the file is well-formed XML");
    let bodies_by_name = bodies(&document);
    for leg in LEG_NAMES {
        let (_, slot) = bodies_by_name[&format!("slot {leg}")];
        // A steel wire of 0.6 mm, about 0.7 m long, weighs about 1.6 g.
        let grams = 1000.0 * numbers(child(slot, "inertial"), "mass")[0];
        assert!((0.5..2.5).contains(&grams), "{grams}");
        let joint = child(slot, "joint");
        let range = numbers(joint, "range");
        assert_eq!(range, [0.0, 0.005]);
        let [stiffness, rest] =
            ["stiffness", "springref"].map(|attribute| numbers(joint, attribute)[0]);
        for (metres, newtons) in [(0.0, force), (0.003, force + 3.0 * rate)] {
            let error = stiffness * (metres - rest) - newtons;
            assert!(
                error.abs() < 1e-6,
                "{metres} m from the slot's end: {error}"
            );
        }
    }
    let rigid_text = mjcf_with(&robot("paper"), |scene| scene.strut_spring = None);
    assert!(!rigid_text.contains("slot"));
}

#[test]
fn a_servo_has_its_stall_torque_its_largest_rate_and_its_travel() {
    for play in [0.0, 1.0] {
        let robot = robot("unequal");
        let text = mjcf_with(&robot, |scene| scene.play = play);
        let document = Document::parse(&text).expect("the file is well-formed XML");
        let motors = section_elements(&document, "actuator");
        assert_eq!(motors.len(), 4);
        for (servo, motor) in motors.iter().enumerate() {
            assert_eq!(motor.attribute("name"), Some(SERVO_NAMES[servo]));
            let joint_name = motor.attribute("joint").expect("a motor names its joint");
            let mut nodes = document.descendants();
            let is_joint = |node: &Node| {
                node.has_tag_name("joint") && node.attribute("name") == Some(joint_name)
            };
            let joint = nodes.find(is_joint).expect(joint_name);
            let [min_torque, max_torque] = numbers(*motor, "forcerange")[..] else {
                panic!("a force range has two torques")
            };
            // The stall torque of the SG-90, 1.8 kg cm.
            assert!(
                (max_torque - 0.018 * 9.80665).abs() < 1e-6 && min_torque == -max_torque,
                "{max_torque}"
            );
            let rate = max_torque / numbers(joint, "damping")[0];
            assert!((rate.to_degrees() - 500.0).abs() < 1e-3, "{rate}");
            let (low, high) = robot.servos()[servo].travel();
            let range = numbers(*motor, "ctrlrange");
            assert!((range[0].to_degrees() - low).abs() < 1e-6);
            assert!((range[1].to_degrees() - high).abs() < 1e-6);
        }
        assert_eq!(text.contains("<joint name=\"horn A1\""), play > 0.0);
    }
}

#[test]
fn the_motors_and_the_friction_of_joints_are_those_of_the_robot_file() {
    let text = include_str!("../../../../robots/paper.toml").replace(
        "[servo.A1]",
        "[joints]\ndrag = 17.0\nslider = 0.5\n[servo]\nmodel = \"copy\"\nvolts = 4.2\nspin_up_ms = 10.0\n[servo.A1]",
    );
    let robot = Robot::parse(&text).expect("the robot is valid");
    let text = mjcf_with(&robot, |_| {});
    let document = Document::parse(&text).expect("the file is well-formed XML");
    let joints: Vec<Node> = document
        .descendants()
        .filter(|node| node.has_tag_name("joint"))
        .collect();
    let friction_of = |name_prefix: &str| -> Vec<f64> {
        let matching_joints = joints.iter().filter(|node| {
            let node_name = node.attribute("name").unwrap_or_default();
            node_name.starts_with(name_prefix)
        });
        matching_joints
            .map(|node| numbers(*node, "frictionloss")[0])
            .collect()
    };
    assert_eq!(friction_of("link"), [0.017; 4]);
    assert_eq!(friction_of("rod"), [0.5; 2]);
    // The servo "copy" has 1.2 kg cm and 400 deg/s at 4.8 V. At 4.2 V, both are less in proportion, so the damping
    // stays the same, and so does the rotor's inertia.
    let link = joints
        .iter()
        .find(|node| node.attribute("name") == Some("link A1"))
        .expect("the link of A1 has a joint");
    let damping = 0.012 * 9.80665 / 400f64.to_radians();
    assert!((numbers(*link, "damping")[0] - damping).abs() < 1e-8);
    assert!((numbers(*link, "armature")[0] - 0.01 * damping).abs() < 1e-8);
    let motor = section_elements(&document, "actuator")[0];
    let max_torque = numbers(motor, "forcerange")[1];
    assert!(
        (max_torque - 0.012 * 9.80665 * 4.2 / 4.8).abs() < 1e-6,
        "{max_torque}"
    );
}

#[test]
fn a_course_has_the_angles_of_its_gait_and_the_times_of_its_last_cycle() {
    let robot = robot("own-gaits");
    let gait = robot.gait("stride").expect("the robot has the gait stride");
    let course = Course::of(&robot, gait, 2, 1);
    let (start, period) = (course.measure_start, course.period);
    let text = mjcf_with(&robot, |scene| scene.course = Some(course));
    let document = Document::parse(&text).expect("the file is well-formed XML");
    let mut nodes = document.descendants();
    let numeric = nodes.find(|node| node.attribute("name") == Some("cycle"));
    let numeric = numeric.expect("the file states the measured cycles");
    let [cycle_start, cycle_length, cycle_count] = numbers(numeric, "data")[..] else {
        panic!("two times and a number describe the measured cycles")
    };
    assert!((cycle_start - start).abs() < 1e-9 && cycle_length == period && period == 0.91);
    assert_eq!(cycle_count, 1.0);
    let mut keys = section_elements(&document, "keyframe");
    let home = keys.pop().and_then(|key| key.attribute("name"));
    assert_eq!(home, Some("home"));
    let last_time = numbers(*keys.last().expect("the course has frames"), "time")[0];
    assert!(last_time >= start + period && last_time < start + period + 0.02 + 1e-9);
    for key in keys {
        let time = numbers(key, "time")[0];
        if time < start {
            continue;
        }
        let expected = gait.angles(gait.phase_at(time - start));
        for (servo, target) in numbers(key, "ctrl").into_iter().enumerate() {
            let error = expected[servo] - robot.servos()[servo].neutral - target.to_degrees();
            assert!(
                lizard_kinematics::wrap(error).abs() < 0.11,
                "{time} {error}"
            );
        }
    }
}

#[test]
fn the_file_has_the_ratio_of_backward_to_forward_friction() {
    for (name, ratio) in [("paper", 1.0), ("unequal", 1.15), (GRAIN_ROBOT, 1.5)] {
        let text = mjcf_with(&robot(name), |_| {});
        let document = Document::parse(&text).expect("the file is well-formed XML");
        let mut nodes = document.descendants();
        let numeric = nodes.find(|node| node.attribute("name") == Some("back over forward"));
        let numeric = numeric.expect("the file states the friction ratio");
        assert_eq!(numbers(numeric, "data"), [ratio], "{name}");
    }
}

#[test]
fn a_model_name_may_contain_any_character() {
    let name = "a <b> & \"c\".toml";
    let text = mjcf_with(&robot("paper"), |scene| scene.name = name.to_owned());
    let document = Document::parse(&text).expect("the file is well-formed XML");
    assert_eq!(document.root_element().attribute("model"), Some(name));
}
