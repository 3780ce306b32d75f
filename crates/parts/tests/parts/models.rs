//! Tests that the bodies in the URDF and SDF files equal those in the MuJoCo file. The tests of `scripts/models-test`
//! use parsers by other authors, and also close the loops at other poses than neutral.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;

use lizard_parts::{Assembly, Pieces, Scene};
use lizard_robot::Robot;
use lizard_robot::servo::SERVO_NAMES;
use roxmltree::{Document, Node};

use crate::mjcf_reader::{
    Placement, STRUT_SPRING, WORLD, bodies, child, mjcf_with, neutral_solution, numbers,
    parse_numbers,
};
use crate::{ROBOTS, robot_with};

/// The URDF and the SDF file of a robot whose scene is changed by `change`, and the names of their mesh files.
fn urdf_and_sdf(robot: &Robot, change: impl FnOnce(&mut Scene)) -> ([String; 2], BTreeSet<String>) {
    let assembly = Assembly::new(robot);
    let mut scene = Scene::of(&assembly);
    change(&mut scene);
    let pieces = Pieces::of(&assembly, &scene).expect("every part has a closed surface");
    let solution = neutral_solution(robot);
    let names = pieces.meshes(&scene).into_iter().map(|mesh| mesh.path);
    let texts = [
        pieces.urdf(&solution, &scene, "at/"),
        pieces.sdf(&solution, &scene, "at/"),
    ];
    (texts, names.collect())
}

/// The text in the first child element with a tag.
fn text_of(node: Node, tag: &str) -> String {
    child(node, tag).text().expect(tag).to_owned()
}

/// The child elements with a tag, by their name attributes. Fails if a name contains a space or occurs twice.
fn elements_by_name<'a>(parent: Node<'a, 'a>, tag: &str) -> BTreeMap<String, Node<'a, 'a>> {
    let mut nodes = BTreeMap::new();
    for node in parent.children().filter(|node| node.has_tag_name(tag)) {
        let name = node
            .attribute("name")
            .expect("the element has a name")
            .to_owned();
        assert!(!name.contains(' '), "{name}");
        assert!(nodes.insert(name.clone(), node).is_none(), "two of {name}");
    }
    nodes
}

/// A body: placement, mass, mass centre, and inertia as xx, yy, zz, xy, xz, yz.
type ReadBody = (Placement, f64, Vec<f64>, Vec<f64>);

/// The placement of a frame whose pose on `frame` is given by six numbers: x, y, z, roll, pitch, yaw.
fn frame_on(frame: Placement, pose: &[f64]) -> Placement {
    assert_eq!(pose[3..5], [0.0; 2], "the frame stays upright");
    Placement {
        position: frame.point(&pose[..3]),
        rotation: frame.rotation + pose[5],
    }
}

const INERTIA_KEYS: [&str; 6] = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];

/// The bodies of a URDF file by name. Each is placed by the joints from the root to its link.
fn read_urdf(document: &Document) -> BTreeMap<String, ReadBody> {
    let root = document.root_element();
    let (links, joints) = (
        elements_by_name(root, "link"),
        elements_by_name(root, "joint"),
    );
    let link_of = |joint: &Node, tag: &str| {
        let link = child(*joint, tag).attribute("link");
        link.expect("the joint names a link").to_owned()
    };
    let placement_of = |link: &str| {
        let (mut link, mut poses_to_root) = (link.to_owned(), Vec::new());
        while let Some(joint) = joints
            .values()
            .find(|joint| link_of(joint, "child") == link)
        {
            let origin = child(*joint, "origin");
            poses_to_root.push([numbers(origin, "xyz"), numbers(origin, "rpy")].concat());
            link = link_of(joint, "parent");
        }
        assert_eq!(link, "base_link", "base_link is the only root");
        poses_to_root
            .iter()
            .rev()
            .fold(WORLD, |frame, pose| frame_on(frame, pose))
    };
    let mut read_bodies = BTreeMap::new();
    for (name, link) in &links {
        let mut children = link.children();
        let Some(inertial) = children.find(|node| node.has_tag_name("inertial")) else {
            assert!(
                name == "base_link" || name.starts_with("closing_"),
                "{name}"
            );
            continue;
        };
        let inertia = INERTIA_KEYS.map(|key| numbers(child(inertial, "inertia"), key)[0]);
        let mass = numbers(child(inertial, "mass"), "value")[0];
        let centre = numbers(child(inertial, "origin"), "xyz");
        read_bodies.insert(
            name.clone(),
            (placement_of(name), mass, centre, inertia.to_vec()),
        );
    }
    read_bodies
}

/// The bodies of an SDF file by name. Each is placed by the poses of the links to which it is relative.
fn read_sdf(document: &Document) -> BTreeMap<String, ReadBody> {
    let model = child(document.root_element(), "model");
    let links = elements_by_name(model, "link");
    fn placement_of<'a>(links: &BTreeMap<String, Node<'a, 'a>>, name: &str) -> Placement {
        let pose = child(links[name], "pose");
        let frame = pose.attribute("relative_to");
        let frame = frame.map_or(WORLD, |parent| placement_of(links, parent));
        frame_on(
            frame,
            &parse_numbers(pose.text().expect("the pose has a text")),
        )
    }
    let mut read_bodies = BTreeMap::new();
    for (name, link) in &links {
        let inertial = child(*link, "inertial");
        let inertia_node = child(inertial, "inertia");
        let inertia = INERTIA_KEYS.map(|name| parse_numbers(&text_of(inertia_node, name))[0]);
        let mass = parse_numbers(&text_of(inertial, "mass"))[0];
        let centre = parse_numbers(&text_of(inertial, "pose"))[..3].to_vec();
        read_bodies.insert(
            name.clone(),
            (placement_of(&links, name), mass, centre, inertia.to_vec()),
        );
    }
    read_bodies
}

#[test]
fn urdf_and_sdf_have_the_bodies_of_the_mujoco_file_with_x_forward() {
    for name in ROBOTS {
        for (strut_spring, play) in [(None, 0.0), (Some(STRUT_SPRING), 0.5)] {
            let robot = robot_with(name, "");
            let change =
                |scene: &mut Scene| (scene.strut_spring, scene.play) = (strut_spring, play);
            let text = mjcf_with(&robot, change);
            let document = Document::parse(&text).expect("the file is well-formed XML");
            let expected = bodies(&document);
            let ([urdf, sdf], _) = urdf_and_sdf(&robot, change);
            let [urdf, sdf] = [&urdf, &sdf]
                .map(|text| Document::parse(text).expect("the file is well-formed XML"));
            for read_bodies in [read_urdf(&urdf), read_sdf(&sdf)] {
                assert_eq!(read_bodies.len(), expected.len());
                for (name, (expected_placement, body)) in &expected {
                    let (read_placement, mass, centre, inertia) =
                        &read_bodies[&name.replace(' ', "_")];
                    let inertial = child(*body, "inertial");
                    assert_eq!([*mass][..], numbers(inertial, "mass"), "{name}");
                    assert_eq!(*centre, numbers(inertial, "pos"), "{name}");
                    assert_eq!(*inertia, numbers(inertial, "fullinertia"), "{name}");
                    // The x axis in URDF and SDF is the y axis in MuJoCo's file.
                    let [x, y, z] = expected_placement.position;
                    for (actual, expected) in read_placement.position.into_iter().zip([y, -x, z]) {
                        assert!(
                            (actual - expected).abs() < 1e-8,
                            "{name} {actual} {expected}"
                        );
                    }
                    let angle = read_placement.rotation - expected_placement.rotation + FRAC_PI_2;
                    let error = angle.sin().hypot(1.0 - angle.cos());
                    assert!(error < 1e-8, "{name} {angle}");
                }
            }
        }
    }
}

#[test]
fn the_two_halves_of_each_cut_joint_of_the_urdf_coincide() {
    for name in ROBOTS {
        let ([urdf, _], _) = urdf_and_sdf(&robot_with(name, ""), |_| {});
        let document = Document::parse(&urdf).expect("the file is well-formed XML");
        let (links, joints) = (
            read_urdf(&document),
            elements_by_name(document.root_element(), "joint"),
        );
        let point_of = |name: &str| {
            let joint = joints[&format!("{name}_joint")];
            assert_eq!(joint.attribute("type"), Some("fixed"));
            let parent = child(joint, "parent")
                .attribute("link")
                .expect("the joint names a link");
            links[parent]
                .0
                .point(&numbers(child(joint, "origin"), "xyz"))
        };
        let mut joint_count = 0;
        for joint_name in joints
            .keys()
            .filter_map(|name| name.strip_suffix("_1_joint"))
        {
            let [first_point, second_point] =
                ["1", "2"].map(|number| point_of(&format!("{joint_name}_{number}")));
            let error = (first_point[0] - second_point[0]).hypot(first_point[1] - second_point[1]);
            assert!(error < 1e-8, "{name} {joint_name} {error}");
            joint_count += 1;
        }
        assert_eq!(joint_count, 12, "two ends, two sliders, two for each leg");
    }
}

#[test]
fn servos_have_their_names_ranges_torques_and_rates_in_urdf_and_sdf() {
    let robot = robot_with("unequal", "");
    let ([urdf, sdf], _) = urdf_and_sdf(&robot, |_| {});
    let [urdf, sdf] =
        [&urdf, &sdf].map(|text| Document::parse(text).expect("the file is well-formed XML"));
    let model = child(sdf.root_element(), "model");
    let (urdf_joints, sdf_joints) = (
        elements_by_name(urdf.root_element(), "joint"),
        elements_by_name(model, "joint"),
    );
    let links = elements_by_name(model, "link");
    assert!(sdf_joints.keys().all(|joint| !links.contains_key(joint)));
    for (servo, name) in SERVO_NAMES.into_iter().enumerate() {
        let (min_deg, max_deg) = robot.servos()[servo].travel();
        // The SG-90: 1.8 kg cm and 500 deg/s.
        let expected = [
            min_deg.to_radians(),
            max_deg.to_radians(),
            0.018 * 9.80665,
            500f64.to_radians(),
        ];
        let limit = child(urdf_joints[name], "limit");
        let attributes = ["lower", "upper", "effort", "velocity"];
        let urdf_limits = attributes.map(|attribute| numbers(limit, attribute)[0]);
        let limit = child(child(sdf_joints[name], "axis"), "limit");
        let sdf_limits = attributes.map(|attribute| parse_numbers(&text_of(limit, attribute))[0]);
        for limits in [urdf_limits, sdf_limits] {
            for (actual, expected) in limits.into_iter().zip(expected) {
                assert!(
                    (actual - expected).abs() < 1e-8,
                    "{name} {actual} {expected}"
                );
            }
        }
    }
}

#[test]
fn exactly_the_meshes_named_in_urdf_and_sdf_are_made() {
    let (texts, meshes) = urdf_and_sdf(&robot_with("paper", ""), |_| {});
    for text in &texts {
        let document = Document::parse(text).expect("the file is well-formed XML");
        let urdf_names = document
            .descendants()
            .filter_map(|node| node.attribute("filename"));
        let uri_nodes = document
            .descendants()
            .filter(|node| node.has_tag_name("uri"));
        let mesh_names: BTreeSet<String> = urdf_names
            .chain(uri_nodes.filter_map(|node| node.text()))
            .map(|name| {
                name.strip_prefix("at/")
                    .expect("the mesh is in the folder at/")
                    .to_owned()
            })
            .collect();
        assert_eq!(mesh_names, meshes);
    }
    let (texts, _) = urdf_and_sdf(&robot_with("paper", ""), |scene| scene.has_shapes = false);
    assert!(texts.iter().all(|text| !text.contains("mesh")));
}
