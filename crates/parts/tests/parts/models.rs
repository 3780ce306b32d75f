//! Tests that the bodies in the URDF and SDF files match the MuJoCo file. The tests of `scripts/models-test` use
//! parsers by other authors, and also close the loops at poses other than neutral.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;

use lizard_parts::{Assembly, Pieces, Scene};
use lizard_robot::Robot;
use lizard_robot::servo::SERVO_NAMES;
use roxmltree::{Document, Node};

use crate::mjcf_reader::{
    Placement, STRUT_SPRING, WORLD, first_child, make_mjcf, parse_numbers, parse_xml, read_bodies,
    read_numbers,
};
use crate::{ROBOTS, read_robot_with, solve_at_neutral};

/// Makes the URDF and the SDF file of a robot, with the scene that `change` alters, and the paths of their mesh files.
fn make_urdf_sdf_and_mesh_paths(
    robot: &Robot,
    change: impl FnOnce(&mut Scene),
) -> ([String; 2], BTreeSet<String>) {
    let assembly = Assembly::new(robot);
    let mut scene = Scene::for_assembly(&assembly);
    change(&mut scene);
    let pieces = Pieces::compute(&assembly, &scene).expect("every part has a closed surface");
    let solution = solve_at_neutral(robot);
    let mesh_paths = pieces.make_meshes(&scene).into_iter().map(|mesh| mesh.path);
    let texts = [
        pieces.format_urdf(&solution, &scene, "at/"),
        pieces.format_sdf(&solution, &scene, "at/"),
    ];
    (texts, mesh_paths.collect())
}

/// Reads the text of the first child element with a tag.
fn read_text(node: Node, tag: &str) -> String {
    first_child(node, tag).text().expect(tag).to_owned()
}

/// Maps the names of the child elements with a tag to the elements. Panics if a name contains a space or occurs twice.
fn elements_by_name<'a>(parent: Node<'a, 'a>, tag: &str) -> BTreeMap<String, Node<'a, 'a>> {
    let mut nodes = BTreeMap::new();
    for node in parent.children().filter(|node| node.has_tag_name(tag)) {
        let name = node.attribute("name").expect("the element has a name");
        assert!(!name.contains(' '), "{name}");
        let is_new = nodes.insert(name.to_owned(), node).is_none();
        assert!(is_new, "{name} occurs twice");
    }
    nodes
}

/// A body: placement, mass (kg), centre of mass (m), and inertia (kg m^2) in the order of [`INERTIA_KEYS`].
type ParsedBody = (Placement, f64, Vec<f64>, Vec<f64>);

/// Places a frame at a pose on another frame. The pose has six numbers: x, y, z, roll, pitch, yaw.
fn place_on(frame: Placement, pose: &[f64]) -> Placement {
    assert_eq!(pose[3..5], [0.0; 2], "the frame is tilted");
    Placement {
        position: frame.to_world(&pose[..3]),
        rotation: frame.rotation + pose[5],
    }
}

/// The elements of the inertia tensor, as URDF and SDF name them, in the order of MuJoCo's `fullinertia`.
const INERTIA_KEYS: [&str; 6] = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];

/// Reads the bodies of a URDF file. The joints between the root and a link determine the link's placement.
fn read_urdf(document: &Document) -> BTreeMap<String, ParsedBody> {
    let root = document.root_element();
    let [links, joints] = ["link", "joint"].map(|tag| elements_by_name(root, tag));
    let read_link = |joint: &Node, tag: &str| {
        let link = first_child(*joint, tag).attribute("link");
        link.expect("the joint has a link").to_owned()
    };
    let compute_placement = |link: &str| {
        let (mut link, mut poses_to_root) = (link.to_owned(), Vec::new());
        let find_joint_above = |link: &str| {
            let mut joints = joints.values();
            joints.find(|joint| read_link(joint, "child") == link)
        };
        while let Some(joint) = find_joint_above(&link) {
            let origin = first_child(*joint, "origin");
            poses_to_root.push([read_numbers(origin, "xyz"), read_numbers(origin, "rpy")].concat());
            link = read_link(joint, "parent");
        }
        assert_eq!(link, "base_link", "there is another root than base_link");
        let poses_from_root = poses_to_root.iter().rev();
        poses_from_root.fold(WORLD, |frame, pose| place_on(frame, pose))
    };
    let mut bodies = BTreeMap::new();
    for (name, link) in &links {
        let mut children = link.children();
        let Some(inertial) = children.find(|node| node.has_tag_name("inertial")) else {
            let is_massless = name == "base_link" || name.starts_with("closing_");
            assert!(is_massless, "{name}");
            continue;
        };
        let inertia =
            INERTIA_KEYS.map(|key| read_numbers(first_child(inertial, "inertia"), key)[0]);
        let mass = read_numbers(first_child(inertial, "mass"), "value")[0];
        let centre = read_numbers(first_child(inertial, "origin"), "xyz");
        let body = (compute_placement(name), mass, centre, inertia.to_vec());
        bodies.insert(name.clone(), body);
    }
    bodies
}

/// Reads the bodies of an SDF file. A link's pose is relative to another link.
fn read_sdf(document: &Document) -> BTreeMap<String, ParsedBody> {
    let model = first_child(document.root_element(), "model");
    let links = elements_by_name(model, "link");
    fn compute_placement<'a>(links: &BTreeMap<String, Node<'a, 'a>>, name: &str) -> Placement {
        let pose = first_child(links[name], "pose");
        let frame = pose.attribute("relative_to");
        let frame = frame.map_or(WORLD, |parent| compute_placement(links, parent));
        let pose = pose.text().expect("the pose has a text");
        place_on(frame, &parse_numbers(pose))
    }
    let mut bodies = BTreeMap::new();
    for (name, link) in &links {
        let inertial = first_child(*link, "inertial");
        let inertia_node = first_child(inertial, "inertia");
        let inertia = INERTIA_KEYS.map(|key| parse_numbers(&read_text(inertia_node, key))[0]);
        let mass = parse_numbers(&read_text(inertial, "mass"))[0];
        let centre = parse_numbers(&read_text(inertial, "pose"))[..3].to_vec();
        let placement = compute_placement(&links, name);
        bodies.insert(name.clone(), (placement, mass, centre, inertia.to_vec()));
    }
    bodies
}

#[test]
fn the_bodies_of_urdf_and_sdf_match_the_mujoco_file() {
    for name in ROBOTS {
        for (strut_spring, play) in [(None, 0.0), (Some(STRUT_SPRING), 0.5)] {
            let robot = read_robot_with(name, "");
            let change =
                |scene: &mut Scene| (scene.strut_spring, scene.play) = (strut_spring, play);
            let text = make_mjcf(&robot, change);
            let document = parse_xml(&text);
            let expected = read_bodies(&document);
            let (texts, _) = make_urdf_sdf_and_mesh_paths(&robot, change);
            let [urdf, sdf] = texts.each_ref().map(|text| parse_xml(text));
            for bodies in [read_urdf(&urdf), read_sdf(&sdf)] {
                assert_eq!(bodies.len(), expected.len());
                for (name, (expected_placement, body)) in &expected {
                    let (placement, mass, centre, inertia) = &bodies[&name.replace(' ', "_")];
                    let inertial = first_child(*body, "inertial");
                    assert_eq!([*mass][..], read_numbers(inertial, "mass"), "{name}");
                    assert_eq!(*centre, read_numbers(inertial, "pos"), "{name}");
                    assert_eq!(*inertia, read_numbers(inertial, "fullinertia"), "{name}");
                    // The x axis of URDF and SDF, which points forward, is the y axis of the MuJoCo file.
                    let [x, y, z] = expected_placement.position;
                    for (actual, expected) in placement.position.into_iter().zip([y, -x, z]) {
                        let is_near = (actual - expected).abs() < 1e-8;
                        assert!(is_near, "{name}: {actual} m, not {expected} m");
                    }
                    let angle = placement.rotation - expected_placement.rotation + FRAC_PI_2;
                    let error = angle.sin().hypot(1.0 - angle.cos());
                    assert!(error < 1e-8, "{name}: off by {angle} rad");
                }
            }
        }
    }
}

#[test]
fn the_two_halves_of_each_cut_urdf_joint_coincide() {
    for name in ROBOTS {
        let ([urdf, _], _) = make_urdf_sdf_and_mesh_paths(&read_robot_with(name, ""), |_| {});
        let urdf = parse_xml(&urdf);
        let links = read_urdf(&urdf);
        let joints = elements_by_name(urdf.root_element(), "joint");
        let locate_half = |name: &str| {
            let joint = joints[&format!("{name}_joint")];
            assert_eq!(joint.attribute("type"), Some("fixed"));
            let parent = first_child(joint, "parent").attribute("link");
            let (placement, ..) = &links[parent.expect("the joint has a link")];
            placement.to_world(&read_numbers(first_child(joint, "origin"), "xyz"))
        };
        let mut joint_count = 0;
        let names = joints.keys();
        for joint_name in names.filter_map(|name| name.strip_suffix("_1_joint")) {
            let [first_point, second_point] =
                ["1", "2"].map(|number| locate_half(&format!("{joint_name}_{number}")));
            let error = (first_point[0] - second_point[0]).hypot(first_point[1] - second_point[1]);
            assert!(error < 1e-8, "{name}: {joint_name} is off by {error} m");
            joint_count += 1;
        }
        assert_eq!(
            joint_count, 12,
            "two ends, two sliders, two joints of each leg"
        );
    }
}

#[test]
fn urdf_and_sdf_have_the_names_and_limits_of_the_servos() {
    let robot = read_robot_with("unequal", "");
    let (texts, _) = make_urdf_sdf_and_mesh_paths(&robot, |_| {});
    let [urdf, sdf] = texts.each_ref().map(|text| parse_xml(text));
    let model = first_child(sdf.root_element(), "model");
    let urdf_joints = elements_by_name(urdf.root_element(), "joint");
    let sdf_joints = elements_by_name(model, "joint");
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
        let limit = first_child(urdf_joints[name], "limit");
        let attributes = ["lower", "upper", "effort", "velocity"];
        let urdf_limits = attributes.map(|attribute| read_numbers(limit, attribute)[0]);
        let limit = first_child(first_child(sdf_joints[name], "axis"), "limit");
        let sdf_limits = attributes.map(|attribute| parse_numbers(&read_text(limit, attribute))[0]);
        for limits in [urdf_limits, sdf_limits] {
            for (actual, expected) in limits.into_iter().zip(expected) {
                let is_near = (actual - expected).abs() < 1e-8;
                assert!(is_near, "{name}: {actual}, not {expected}");
            }
        }
    }
}

#[test]
fn the_meshes_match_the_references_in_urdf_and_sdf() {
    let robot = read_robot_with("paper", "");
    let (texts, mesh_paths) = make_urdf_sdf_and_mesh_paths(&robot, |_| {});
    for text in &texts {
        let document = parse_xml(text);
        let nodes = document.descendants();
        let urdf_references = nodes.clone().filter_map(|node| node.attribute("filename"));
        let uri_nodes = nodes.filter(|node| node.has_tag_name("uri"));
        let references = urdf_references.chain(uri_nodes.filter_map(|node| node.text()));
        let paths = references.map(|path| path.strip_prefix("at/").expect("the folder is at/"));
        let referenced_paths: BTreeSet<_> = paths.map(str::to_owned).collect();
        assert_eq!(referenced_paths, mesh_paths);
    }
    let (texts, _) = make_urdf_sdf_and_mesh_paths(&robot, |scene| scene.has_shapes = false);
    assert!(texts.iter().all(|text| !text.contains("mesh")));
}
