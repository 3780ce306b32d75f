//! A reader of the MuJoCo file, which places the bodies by the file's numbers alone.

use std::collections::BTreeMap;

use lizard_kinematics::Solution;
use lizard_parts::{Assembly, Scene, StrutSpring, mjcf};
use lizard_robot::Robot;
use roxmltree::{Document, Node};

/// The positions of the robot's joints at neutral.
pub fn neutral_solution(robot: &Robot) -> Solution {
    let solution = robot.lizard().solve(&robot.neutral_pose());
    solution.expect("the linkages close at neutral")
}

/// The MuJoCo file of a robot whose scene is changed by `change`.
pub fn mjcf_with(robot: &Robot, change: impl FnOnce(&mut Scene)) -> String {
    let assembly = Assembly::new(robot);
    let mut scene = Scene::of(&assembly);
    change(&mut scene);
    mjcf(&assembly, &neutral_solution(robot), &scene).expect("every part has a closed surface")
}

/// The numbers in an attribute, separated by spaces.
pub fn numbers(node: Node, attribute: &str) -> Vec<f64> {
    parse_numbers(node.attribute(attribute).expect(attribute))
}

/// The numbers of a text, which are separated by spaces.
pub fn parse_numbers(text: &str) -> Vec<f64> {
    let fields = text.split(' ');
    fields
        .map(|field| field.parse().expect("the field is a number"))
        .collect()
}

/// The placement of a body in the world: position, m, and rotation about z, rad.
#[derive(Clone, Copy)]
pub struct Placement {
    pub position: [f64; 3],
    pub rotation: f64,
}

/// A spring in each strut.
pub const STRUT_SPRING: StrutSpring = StrutSpring {
    preload: 4.0,
    rate: 0.4,
};

/// The placement of the world.
pub const WORLD: Placement = Placement {
    position: [0.0; 3],
    rotation: 0.0,
};

impl Placement {
    /// Converts a point from the body's frame to the world, m.
    pub fn point(&self, point: &[f64]) -> [f64; 3] {
        let (sin, cos) = self.rotation.sin_cos();
        [
            self.position[0] + cos * point[0] - sin * point[1],
            self.position[1] + sin * point[0] + cos * point[1],
            self.position[2] + point[2],
        ]
    }
}

/// Bodies by their names.
pub type Bodies<'a> = BTreeMap<String, (Placement, Node<'a, 'a>)>;

/// Every body of a file, with its placement.
pub fn bodies<'a>(document: &'a Document) -> Bodies<'a> {
    fn add_child_bodies<'a>(
        parent: Node<'a, 'a>,
        parent_placement: Placement,
        found_bodies: &mut Bodies<'a>,
    ) {
        for body in parent.children().filter(|node| node.has_tag_name("body")) {
            let quat = numbers(body, "quat");
            assert_eq!(quat[1..3], [0.0; 2], "the body stays upright");
            let placement = Placement {
                position: parent_placement.point(&numbers(body, "pos")),
                rotation: parent_placement.rotation + 2.0 * quat[3].atan2(quat[0]),
            };
            let name = body
                .attribute("name")
                .expect("the body has a name")
                .to_owned();
            assert!(
                found_bodies.insert(name, (placement, body)).is_none(),
                "two bodies have the same name"
            );
            add_child_bodies(body, placement, found_bodies);
        }
    }
    let mut found_bodies = BTreeMap::new();
    let world = root_child(document, "worldbody");
    add_child_bodies(world, WORLD, &mut found_bodies);
    found_bodies
}

fn root_child<'a>(document: &'a Document, tag: &str) -> Node<'a, 'a> {
    child(document.root_element(), tag)
}

/// The child elements of the root's child `tag`.
pub fn section_elements<'a>(document: &'a Document, tag: &str) -> Vec<Node<'a, 'a>> {
    let children = root_child(document, tag).children();
    children.filter(Node::is_element).collect()
}

/// The first child element with a tag.
pub fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Node<'a, 'a> {
    let element = node.children().find(|node| node.has_tag_name(tag));
    element.expect(tag)
}
