//! Tests that the MuJoCo file agrees with robot.toml.

use std::collections::BTreeMap;

use lizard_kinematics::{End, Side, Vector};
use lizard_parts::{Assembly, Block, Mesh, Pads, Solid, StrutSpring, Trajectory};
use lizard_robot::Robot;
use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};
use roxmltree::Node;

use crate::mjcf_masses::compute_mass_and_centre;
use crate::mjcf_reader::{
    STRUT_SPRING, find_named, first_child, make_mjcf, parse_xml, read_bodies, read_numbers,
    section_elements,
};
use crate::{GRAIN_ROBOT, ROBOTS, read_robot_with, solve_at_neutral};

fn read_robot(name: &str) -> Robot {
    read_robot_with(name, "")
}

#[test]
fn cut_joints_match_the_joints_of_the_robot() {
    for name in ROBOTS {
        let robot = read_robot(name);
        let solution = solve_at_neutral(&robot);
        let angles: [f64; 4] = robot.neutral_pose().into();
        let legs = [0, 1, 2, 3].map(|i| robot.legs()[i].points_at(angles[i], angles[i]));
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
            let text = make_mjcf(&robot, |scene| scene.strut_spring = strut_spring);
            let document = parse_xml(&text);
            let bodies_by_name = read_bodies(&document);
            let loops = section_elements(&document, "equality");
            assert_eq!(loops.len(), joints.len());
            for connect in loops {
                let read_attribute = |name: &str| connect.attribute(name).expect(name);
                let second_body = read_attribute("body2");
                assert!(bodies_by_name.contains_key(second_body), "{second_body}");
                let (placement, _) = bodies_by_name[read_attribute("body1")];
                let anchor = placement.to_world(&read_numbers(connect, "anchor"));
                let joint = joints[read_attribute("name")] * 1e-3;
                let error = (anchor[0] - joint.x).hypot(anchor[1] - joint.y);
                assert!(error < 1e-8, "{name}: {connect:?} is off by {error} m");
            }
        }
    }
}

#[test]
fn pads_match_the_contact_model_and_the_longest_foot_is_on_the_floor() {
    for name in ROBOTS {
        let robot = read_robot(name);
        let text = make_mjcf(&robot, |scene| scene.excess_lengths = [0.0, 0.6, 0.0, -0.3]);
        let document = parse_xml(&text);
        let bodies_by_name = read_bodies(&document);
        let feet = robot.ground().legs.foot_positions([0.0; 4]);
        for (servo, excess) in [0.0, 0.6, 0.0, -0.3].into_iter().enumerate() {
            let (placement, foot) = bodies_by_name[&format!("foot {}", LEG_NAMES[servo])];
            let mut geoms = foot.children();
            let pad = geoms.find(|geom| geom.attribute("type") == Some("sphere"));
            let pad = pad.expect("the foot has a spherical pad");
            let [x, y, z] = placement
                .to_world(&read_numbers(pad, "pos"))
                .map(|coordinate| 1000.0 * coordinate);
            let pad_bottom = z - 1000.0 * read_numbers(pad, "size")[0];
            let [forward, left] = feet[servo];
            let error = (y - forward).hypot(x + left);
            assert!(error < 1e-5, "{name}: pad at {x}, {y}");
            let error = pad_bottom - (0.6 - excess);
            assert!(error.abs() < 1e-5, "{name}: bottom at {pad_bottom} mm");
            assert_eq!(first_child(foot, "joint").attribute("type"), Some("slide"));
        }
    }
}

#[test]
fn light_limbs_keep_the_mass_of_the_robot() {
    let robot = read_robot("paper");
    let [normal_mass, light_mass] = [1.0, 0.2].map(|factor| {
        let text = make_mjcf(&robot, |scene| scene.limb_mass_factor = factor);
        let document = parse_xml(&text);
        compute_mass_and_centre(&document).0
    });
    let is_equal = (normal_mass - light_mass).abs() < 1e-3;
    assert!(is_equal, "{normal_mass} g and {light_mass} g");
}

#[test]
fn pads_of_every_shape_touch_the_floor() {
    let radius = read_robot("paper").parts().pad.radius;
    for (pads, count) in [
        (Pads::Domes(5.0), 1),
        (Pads::Flat(8.0), 1),
        // The dome is 2.08 mm high at its rim, 11 mm from its axis.
        (Pads::Terraces(0.1), 21),
    ] {
        let text = make_mjcf(&read_robot("paper"), |scene| {
            (scene.pads, scene.has_shapes) = (pads, false);
        });
        let document = parse_xml(&text);
        let bodies_by_name = read_bodies(&document);
        let (placement, foot) = &bodies_by_name["foot LF"];
        let has_friction = |node: &Node| node.has_attribute("friction");
        let geoms: Vec<_> = foot.children().filter(has_friction).collect();
        assert_eq!(geoms.len(), count, "{pads:?}");
        for (layer, geom) in geoms.iter().enumerate() {
            let size = read_numbers(*geom, "size");
            let [_, _, z] = placement
                .to_world(&read_numbers(*geom, "pos"))
                .map(|coordinate| 1000.0 * coordinate);
            let half_height = 1000.0 * size[size.len() - 1];
            let error = z - half_height - 0.1 * layer as f64;
            let heights = format!("centre at {z}, half height {half_height}");
            assert!(error.abs() < 1e-5, "{pads:?}, layer {layer}: {heights}");
            if let Pads::Terraces(_) = pads {
                // The rim of the disc's middle plane is on the dome's sphere.
                let centre_distance = (1000.0 * size[0]).hypot(radius - z);
                assert!(
                    (centre_distance - radius).abs() < 1e-3,
                    "layer {layer}: {centre_distance} mm from the sphere's centre"
                );
            }
        }
    }
}

#[test]
fn the_file_has_the_blocks_slope_and_friction_of_the_floor() {
    let text = make_mjcf(&read_robot("paper"), |scene| {
        scene.floor.blocks.push(Block {
            centre: [20.0, 300.0],
            size: [10.0, 40.0, 2.0],
            rotation: 30.0,
        });
        scene.floor.slope = 30.0;
        scene.floor.friction_coefficients = [0.1, 0.2, 0.3, 0.4];
    });
    let document = parse_xml(&text);
    let option = first_child(document.root_element(), "option");
    // The floor rises by 30 deg, so half of the weight pulls the robot backward.
    let [right, forward, up] = read_numbers(option, "gravity")[..] else {
        panic!("gravity has three components")
    };
    let is_expected = right == 0.0 && (forward + 0.5 * 9.81).abs() < 0.01;
    assert!(is_expected, "forward: {forward}");
    assert!((up + 0.866 * 9.81).abs() < 0.01, "up: {up}");
    let is_block = |node: &Node| node.has_tag_name("geom") && node.attribute("type") == Some("box");
    let block = document.descendants().find(is_block);
    let block = block.expect("the floor has a block");
    let [position, half_size] = ["pos", "size"].map(|attribute| read_numbers(block, attribute));
    assert_eq!((position[0], position[1]), (0.02, 0.3));
    let euler = read_numbers(block, "euler");
    assert!((euler[2] - 30f64.to_radians()).abs() < 1e-6 && euler[..2] == [0.0; 2]);
    assert_eq!((half_size[0], half_size[1]), (0.005, 0.02));
    assert_eq!(position[2] + half_size[2], 0.002);
    for (leg, friction) in LEG_NAMES.into_iter().zip([0.1, 0.2, 0.3, 0.4]) {
        let pad = find_named(&document, "geom", &format!("pad {leg}"));
        // Without a priority, MuJoCo would use the larger friction coefficient of pad and floor.
        assert_eq!(pad.attribute("priority"), Some("1"));
        assert_eq!(read_numbers(pad, "friction")[0], friction);
    }
}

#[test]
fn the_contact_sphere_of_a_pad_matches_its_dome() {
    let assembly = Assembly::new(&read_robot("paper"));
    let pad = assembly.body("pad LF").expect("the leg has a pad");
    let text = make_mjcf(&read_robot("paper"), |_| ());
    let document = parse_xml(&text);
    let sphere = find_named(&document, "geom", "pad LF");
    let radius = 1000.0 * read_numbers(sphere, "size")[0];
    let parts = assembly.collect_parts();
    let part = parts.iter().find(|part| part.body_names[0] == pad.name);
    let (layers, _) = part.expect("the pad is printed").build_printed_layers();
    let mesh = Mesh::from_solid(&Solid::from_prisms(&layers));
    // The printed pad lies on its back, centred on the origin. The hole for the screw is in the middle.
    let top = mesh.corners.iter().fold(0.0, |top, [.., z]| z.max(top));
    let (mut lowest_z, mut triangle_count) = (top, 0);
    for triangle in &mesh.triangles {
        let corners = triangle.map(|corner| mesh.corners[corner]);
        let axis_distances = corners.map(|[x, y, _]| x.hypot(y));
        let corners_on_dome = axis_distances.map(|distance| (3.05..10.95).contains(&distance));
        if corners_on_dome == [false; 3] {
            continue;
        }
        triangle_count += 1;
        for ([.., z], axis_distance) in corners.into_iter().zip(axis_distances) {
            let sphere_z = top - radius + (radius.powi(2) - axis_distance.powi(2)).sqrt();
            let is_near = (z - sphere_z).abs() < 0.002;
            assert!(is_near, "dome at {z} mm, sphere at {sphere_z} mm");
            lowest_z = lowest_z.min(z);
        }
        let [a, b, c] = corners;
        let [[ux, uy, _], [vx, vy, _]] = [b, c].map(|end| [0, 1, 2].map(|i| end[i] - a[i]));
        assert!(ux * vy - uy * vx > 1e-6, "a vertical triangle: {corners:?}");
    }
    let height = top - lowest_z;
    let is_dome = triangle_count > 1000 && height > 1.9;
    assert!(is_dome, "{triangle_count} triangles, {height} mm high");
}

#[test]
fn a_slotted_strut_pulls_with_the_tension_of_its_spring_and_yields_in_one_direction() {
    let constant_force = StrutSpring {
        rate: 0.0,
        ..STRUT_SPRING
    };
    for (spring, max_error) in [(STRUT_SPRING, 1e-6), (constant_force, 0.01)] {
        let StrutSpring { preload, rate } = spring;
        let text = make_mjcf(&read_robot("paper"), |scene| {
            scene.strut_spring = Some(spring);
        });
        let document = parse_xml(&text);
        let bodies_by_name = read_bodies(&document);
        for leg in LEG_NAMES {
            let (_, slot) = bodies_by_name[&format!("slot {leg}")];
            // A steel wire of 0.6 mm, about 0.7 m long, weighs about 1.6 g.
            let grams = 1000.0 * read_numbers(first_child(slot, "inertial"), "mass")[0];
            assert!((0.5..2.5).contains(&grams), "{grams} g");
            let joint = first_child(slot, "joint");
            let range = read_numbers(joint, "range");
            assert_eq!(range, [0.0, 0.005]);
            let [stiffness, rest] =
                ["stiffness", "springref"].map(|attribute| read_numbers(joint, attribute)[0]);
            for (metres, tension) in [(0.0, preload), (0.003, preload + 3.0 * rate)] {
                let error = stiffness * (metres - rest) - tension;
                assert!(
                    error.abs() < max_error,
                    "{error} N, {metres} m from the slot's inner end"
                );
            }
        }
    }
    let rigid_text = make_mjcf(&read_robot("paper"), |scene| scene.strut_spring = None);
    assert!(!rigid_text.contains("slot"));
}

#[test]
fn servos_have_the_stall_torque_no_load_rate_and_travel_of_robot_toml() {
    for play in [0.0, 1.0] {
        let robot = read_robot("unequal");
        let text = make_mjcf(&robot, |scene| scene.play = play);
        let document = parse_xml(&text);
        let motors = section_elements(&document, "actuator");
        assert_eq!(motors.len(), 4);
        for (servo, motor) in motors.iter().enumerate() {
            assert_eq!(motor.attribute("name"), Some(SERVO_NAMES[servo]));
            let joint_name = motor.attribute("joint").expect("the motor has a joint");
            let joint = find_named(&document, "joint", joint_name);
            let [min_torque, max_torque] = read_numbers(*motor, "forcerange")[..] else {
                panic!("forcerange has two values")
            };
            // The stall torque of the SG-90, 1.8 kg cm.
            let error = max_torque - 0.018 * 9.80665;
            let is_expected = error.abs() < 1e-6 && min_torque == -max_torque;
            assert!(is_expected, "torques {min_torque} and {max_torque} N m");
            let rate = max_torque / read_numbers(joint, "damping")[0];
            assert!((rate.to_degrees() - 500.0).abs() < 1e-3, "{rate} rad/s");
            let (low, high) = robot.servos()[servo].travel();
            let range = read_numbers(*motor, "ctrlrange");
            assert!((range[0].to_degrees() - low).abs() < 1e-6);
            assert!((range[1].to_degrees() - high).abs() < 1e-6);
        }
        assert_eq!(text.contains("<joint name=\"horn A1\""), play > 0.0);
    }
}

#[test]
fn the_motors_and_the_joint_friction_match_robot_toml() {
    let text = include_str!("../../../../robots/paper.toml").replace(
        "[servo.A1]",
        "[joints]\ndrag = 17.0\nslider = 0.5\n[servo]\nmodel = \"copy\"\nvolts = 4.2\nspin_up_ms = 10.0\n[servo.A1]",
    );
    let robot = Robot::parse(&text).expect("the robot is valid");
    let text = make_mjcf(&robot, |_| {});
    let document = parse_xml(&text);
    let joint_friction = |name_prefix: &str| -> Vec<f64> {
        let is_matching = |node: &Node| {
            let name = node.attribute("name").unwrap_or_default();
            node.has_tag_name("joint") && name.starts_with(name_prefix)
        };
        let joints = document.descendants().filter(is_matching);
        let friction = joints.map(|node| read_numbers(node, "frictionloss")[0]);
        friction.collect()
    };
    assert_eq!(joint_friction("link"), [0.017; 4]);
    assert_eq!(joint_friction("rod"), [0.5; 2]);
    // The servo "copy" has 1.2 kg cm and 400 deg/s at 4.8 V. Both are proportional to the supply voltage, so the
    // damping and the reflected inertia are the same at 4.2 V.
    let link = find_named(&document, "joint", "link A1");
    let damping = 0.012 * 9.80665 / 400f64.to_radians();
    assert!((read_numbers(link, "damping")[0] - damping).abs() < 1e-8);
    assert!((read_numbers(link, "armature")[0] - 0.01 * damping).abs() < 1e-8);
    let motor = section_elements(&document, "actuator")[0];
    let max_torque = read_numbers(motor, "forcerange")[1];
    let error = max_torque - 0.012 * 9.80665 * 4.2 / 4.8;
    assert!(error.abs() < 1e-6, "{max_torque} N m");
}

#[test]
fn the_file_has_the_servo_targets_and_the_measured_cycles_of_a_trajectory() {
    let robot = read_robot("own-gaits");
    let gait = robot.gait("stride").expect("the robot has the gait stride");
    let trajectory = Trajectory::for_gait(&robot, gait, 2, 1);
    let (start, period) = (trajectory.measure_start, trajectory.period);
    let text = make_mjcf(&robot, |scene| scene.trajectory = Some(trajectory));
    let document = parse_xml(&text);
    let numeric = find_named(&document, "numeric", "cycle");
    let [measure_start, cycle_period, cycle_count] = read_numbers(numeric, "data")[..] else {
        panic!("cycle has three values")
    };
    assert!((measure_start - start).abs() < 1e-9 && cycle_period == period && period == 0.91);
    assert_eq!(cycle_count, 1.0);
    let mut keys = section_elements(&document, "keyframe");
    let home = keys.pop().and_then(|key| key.attribute("name"));
    assert_eq!(home, Some("home"));
    let last_time = read_numbers(*keys.last().expect("the trajectory has frames"), "time")[0];
    assert!(last_time >= start + period && last_time < start + period + 0.02 + 1e-9);
    for key in keys {
        let time = read_numbers(key, "time")[0];
        if time < start {
            continue;
        }
        let expected = gait.angles(gait.phase_at(time - start));
        for (servo, target) in read_numbers(key, "ctrl").into_iter().enumerate() {
            let error = expected[servo] - robot.servos()[servo].neutral - target.to_degrees();
            let is_near = lizard_kinematics::wrap(error).abs() < 0.11;
            assert!(is_near, "{time} s: off by {error} deg");
        }
    }
}

#[test]
fn the_file_has_the_friction_ratio() {
    for (name, ratio) in [("paper", 1.0), ("unequal", 1.15), (GRAIN_ROBOT, 1.5)] {
        let text = make_mjcf(&read_robot(name), |_| {});
        let document = parse_xml(&text);
        let numeric = find_named(&document, "numeric", "back over forward");
        assert_eq!(read_numbers(numeric, "data"), [ratio], "{name}");
    }
}

#[test]
fn a_model_name_may_contain_any_character() {
    let name = "a <b> & \"c\"\nd.toml";
    let text = make_mjcf(&read_robot("paper"), |scene| scene.name = name.to_owned());
    let document = parse_xml(&text);
    assert_eq!(document.root_element().attribute("model"), Some(name));
}
