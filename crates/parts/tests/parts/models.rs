//! Tests with an XML parser that the bodies in the URDF and SDF files equal those in the MuJoCo file. The tests of
//! `scripts/models-test` use parsers by other authors, and close the loops at other poses than neutral.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;

use lizard_parts::{Assembly, Pieces, Pull, Scene};
use lizard_robot::Robot;
use lizard_robot::servo::NAMES;
use roxmltree::{Document, Node};

use crate::mjcf_reader::{Placed, bodies, child, mjcf_with, neutral, numbers};
use crate::{ROBOTS, robot_with};

/// The URDF and the SDF file of a robot whose scene is changed by `change`, and the names of their mesh files.
fn urdf_and_sdf(robot: &Robot, change: impl FnOnce(&mut Scene)) -> ([String; 2], BTreeSet<String>) {
    let assembly = Assembly::new(robot);
    let mut scene = Scene::of(&assembly);
    change(&mut scene);
    let pieces = Pieces::of(&assembly, &scene).expect("it is made");
    let neutral = neutral(robot);
    let names = pieces.meshes(&scene).into_iter().map(|mesh| mesh.path);
    let text = [
        pieces.urdf(&neutral, &scene, "at/"),
        pieces.sdf(&neutral, &scene, "at/"),
    ];
    (text, names.collect())
}

/// The text in the first child element with a tag.
fn text_of(node: Node, tag: &str) -> String {
    child(node, tag).text().expect(tag).to_owned()
}

fn floats(text: &str) -> Vec<f64> {
    let parts = text.split(' ');
    parts.map(|part| part.parse().expect("a number")).collect()
}

/// The child elements with a tag, by their name attributes. Fails if a name contains a blank or occurs twice.
fn named<'a>(parent: Node<'a, 'a>, tag: &str) -> BTreeMap<String, Node<'a, 'a>> {
    let mut all = BTreeMap::new();
    for node in parent.children().filter(|node| node.has_tag_name(tag)) {
        let name = node.attribute("name").expect("a name").to_owned();
        assert!(!name.contains(' '), "{name}");
        assert!(all.insert(name.clone(), node).is_none(), "two of {name}");
    }
    all
}

/// A body: placement, mass, mass centre, and inertia as xx, yy, zz, xy, xz, yz.
type ReadBody = (Placed, f64, Vec<f64>, Vec<f64>);

/// The placement of a frame that is given relative to another one by six numbers: x, y, z, roll, pitch, yaw.
fn frame_on(frame: Placed, six: &[f64]) -> Placed {
    assert_eq!(six[3..5], [0.0; 2], "it stays upright");
    Placed {
        at: frame.point(&six[..3]),
        turn: frame.turn + six[5],
    }
}

const WORLD: Placed = Placed {
    at: [0.0; 3],
    turn: 0.0,
};
const INERTIA: [&str; 6] = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];

/// The bodies of a URDF file by name. Each is placed by the joints from the root to its link.
fn read_urdf(document: &Document) -> BTreeMap<String, ReadBody> {
    let root = document.root_element();
    let (links, joints) = (named(root, "link"), named(root, "joint"));
    let end = |joint: &Node, tag: &str| {
        let link = child(*joint, tag).attribute("link");
        link.expect("a link").to_owned()
    };
    let place = |link: &str| {
        let (mut link, mut up) = (link.to_owned(), Vec::new());
        while let Some(joint) = joints.values().find(|joint| end(joint, "child") == link) {
            let origin = child(*joint, "origin");
            up.push([numbers(origin, "xyz"), numbers(origin, "rpy")].concat());
            link = end(joint, "parent");
        }
        assert_eq!(link, "base_link", "one root");
        up.iter()
            .rev()
            .fold(WORLD, |frame, six| frame_on(frame, six))
    };
    let mut read = BTreeMap::new();
    for (name, link) in &links {
        let mut children = link.children();
        let Some(inertial) = children.find(|node| node.has_tag_name("inertial")) else {
            assert!(
                name == "base_link" || name.starts_with("closing_"),
                "{name}"
            );
            continue;
        };
        let inertia = INERTIA.map(|of| numbers(child(inertial, "inertia"), of)[0]);
        let mass = numbers(child(inertial, "mass"), "value")[0];
        let centre = numbers(child(inertial, "origin"), "xyz");
        read.insert(name.clone(), (place(name), mass, centre, inertia.to_vec()));
    }
    read
}

/// The bodies of an SDF file by name. Each is placed by the poses of the links to which it is relative.
fn read_sdf(document: &Document) -> BTreeMap<String, ReadBody> {
    let model = child(document.root_element(), "model");
    let links = named(model, "link");
    fn place<'a>(links: &BTreeMap<String, Node<'a, 'a>>, name: &str) -> Placed {
        let pose = child(links[name], "pose");
        let frame = pose.attribute("relative_to");
        let frame = frame.map_or(WORLD, |parent| place(links, parent));
        frame_on(frame, &floats(pose.text().expect("six numbers")))
    }
    let mut read = BTreeMap::new();
    for (name, link) in &links {
        let inertial = child(*link, "inertial");
        let of = child(inertial, "inertia");
        let inertia = INERTIA.map(|name| floats(&text_of(of, name))[0]);
        let mass = floats(&text_of(inertial, "mass"))[0];
        let centre = floats(&text_of(inertial, "pose"))[..3].to_vec();
        read.insert(
            name.clone(),
            (place(&links, name), mass, centre, inertia.to_vec()),
        );
    }
    read
}

#[test]
fn their_bodies_are_those_of_mujocos_file_turned_ahead() {
    let (force, rate) = (4.0, 0.4);
    for name in ROBOTS {
        for (pull, play) in [(None, 0.0), (Some(Pull { force, rate }), 0.5)] {
            let robot = robot_with(name, "");
            let change = |scene: &mut Scene| (scene.pull, scene.play) = (pull, play);
            let text = mjcf_with(&robot, change);
            let document = Document::parse(&text).expect("well formed");
            let wanted = bodies(&document);
            let ([urdf, sdf], _) = urdf_and_sdf(&robot, change);
            let [urdf, sdf] = [&urdf, &sdf].map(|text| Document::parse(text).expect("well formed"));
            for read in [read_urdf(&urdf), read_sdf(&sdf)] {
                assert_eq!(read.len(), wanted.len());
                for (name, (placed, body)) in &wanted {
                    let (found, mass, centre, inertia) = &read[&name.replace(' ', "_")];
                    let inertial = child(*body, "inertial");
                    assert_eq!([*mass][..], numbers(inertial, "mass"), "{name}");
                    assert_eq!(*centre, numbers(inertial, "pos"), "{name}");
                    assert_eq!(*inertia, numbers(inertial, "fullinertia"), "{name}");
                    // The x axis in URDF and SDF is the y axis in MuJoCo's file.
                    let [x, y, z] = placed.at;
                    for (found, wanted) in found.at.into_iter().zip([y, -x, z]) {
                        assert!((found - wanted).abs() < 1e-8, "{name} {found} {wanted}");
                    }
                    let turned = found.turn - placed.turn + FRAC_PI_2;
                    let error = turned.sin().hypot(1.0 - turned.cos());
                    assert!(error < 1e-8, "{name} {turned}");
                }
            }
        }
    }
}

#[test]
fn the_two_halves_of_each_cut_joint_of_the_urdf_coincide() {
    for name in ROBOTS {
        let ([urdf, _], _) = urdf_and_sdf(&robot_with(name, ""), |_| {});
        let document = Document::parse(&urdf).expect("well formed");
        let (links, joints) = (
            read_urdf(&document),
            named(document.root_element(), "joint"),
        );
        let frame = |name: &str| {
            let joint = joints[&format!("{name}_joint")];
            assert_eq!(joint.attribute("type"), Some("fixed"));
            let parent = child(joint, "parent").attribute("link").expect("a link");
            links[parent]
                .0
                .point(&numbers(child(joint, "origin"), "xyz"))
        };
        let mut count = 0;
        for first in joints
            .keys()
            .filter_map(|name| name.strip_suffix("_1_joint"))
        {
            let [one, two] = ["1", "2"].map(|number| frame(&format!("{first}_{number}")));
            let error = (one[0] - two[0]).hypot(one[1] - two[1]);
            assert!(error < 1e-8, "{name} {first} {error}");
            count += 1;
        }
        assert_eq!(count, 12, "two ends, two sliders, two for each leg");
    }
}

#[test]
fn servos_have_their_names_ranges_and_powers_in_both() {
    let robot = robot_with("unequal", "");
    let ([urdf, sdf], _) = urdf_and_sdf(&robot, |_| {});
    let [urdf, sdf] = [&urdf, &sdf].map(|text| Document::parse(text).expect("well formed"));
    let model = child(sdf.root_element(), "model");
    let (in_urdf, in_sdf) = (named(urdf.root_element(), "joint"), named(model, "joint"));
    let links = named(model, "link");
    assert!(in_sdf.keys().all(|joint| !links.contains_key(joint)));
    for (servo, name) in NAMES.into_iter().enumerate() {
        let (smallest, largest) = robot.servos()[servo].travel();
        // The SG-90: 1.8 kg cm and 500 deg/s.
        let wanted = [
            smallest.to_radians(),
            largest.to_radians(),
            0.018 * 9.80665,
            500f64.to_radians(),
        ];
        let limit = child(in_urdf[name], "limit");
        let found = ["lower", "upper", "effort", "velocity"];
        let of_urdf = found.map(|of| numbers(limit, of)[0]);
        let limit = child(child(in_sdf[name], "axis"), "limit");
        let of_sdf = found.map(|of| floats(&text_of(limit, of))[0]);
        for found in [of_urdf, of_sdf] {
            for (found, wanted) in found.into_iter().zip(wanted) {
                assert!((found - wanted).abs() < 1e-8, "{name} {found} {wanted}");
            }
        }
    }
}

#[test]
fn every_mesh_that_they_name_is_made_and_none_is_left_over() {
    let (texts, meshes) = urdf_and_sdf(&robot_with("paper", ""), |_| {});
    for text in &texts {
        let document = Document::parse(text).expect("well formed");
        let of_urdf = document
            .descendants()
            .filter_map(|node| node.attribute("filename"));
        let of_sdf = document
            .descendants()
            .filter(|node| node.has_tag_name("uri"));
        let named: BTreeSet<String> = of_urdf
            .chain(of_sdf.filter_map(|node| node.text()))
            .map(|name| name.strip_prefix("at/").expect("the folder").to_owned())
            .collect();
        assert_eq!(named, meshes);
    }
    let (texts, _) = urdf_and_sdf(&robot_with("paper", ""), |scene| scene.has_shapes = false);
    assert!(texts.iter().all(|text| !text.contains("mesh")));
}
