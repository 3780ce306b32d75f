//! Helpers that make and read a MuJoCo file, and compute each body's placement from the file alone.

use std::collections::BTreeMap;

use lizard_parts::{Assembly, Pieces, Scene, StrutSpring};
use lizard_robot::Robot;
use roxmltree::{Document, Node};

use crate::solve_at_neutral;

/// Makes the MuJoCo file of a robot, with the scene that `change` alters.
pub fn make_mjcf(robot: &Robot, change: impl FnOnce(&mut Scene)) -> String {
    let assembly = Assembly::new(robot);
    let mut scene = Scene::for_assembly(&assembly);
    change(&mut scene);
    let pieces = Pieces::compute(&assembly, &scene).expect("every part has a closed surface");
    pieces.format_mjcf(&solve_at_neutral(robot), &scene)
}

/// Parses the text of a model file.
pub fn parse_xml(text: &str) -> Document<'_> {
    Document::parse(text).expect("the file is well-formed XML")
}

/// Reads the numbers in an attribute, separated by spaces.
pub fn read_numbers(node: Node, attribute: &str) -> Vec<f64> {
    parse_numbers(node.attribute(attribute).expect(attribute))
}

/// Parses numbers that are separated by spaces.
pub fn parse_numbers(text: &str) -> Vec<f64> {
    let fields = text.split(' ');
    let numbers = fields.map(|field| field.parse().expect("the field is a number"));
    numbers.collect()
}

/// Placement of a body in the world frame: position, m, and rotation about z, rad.
#[derive(Clone, Copy)]
pub struct Placement {
    pub position: [f64; 3],
    pub rotation: f64,
}

/// The spring of each strut in tests of slotted struts.
pub const STRUT_SPRING: StrutSpring = StrutSpring {
    preload: 4.0,
    rate: 0.4,
};

/// Placement of the world frame itself.
pub const WORLD: Placement = Placement {
    position: [0.0; 3],
    rotation: 0.0,
};

impl Placement {
    /// Converts a point, m, from the body's frame to the world frame.
    pub fn to_world(self, point: &[f64]) -> [f64; 3] {
        let (sin, cos) = self.rotation.sin_cos();
        [
            self.position[0] + cos * point[0] - sin * point[1],
            self.position[1] + sin * point[0] + cos * point[1],
            self.position[2] + point[2],
        ]
    }
}

/// Placements and elements of the bodies, by name.
pub type Bodies<'a> = BTreeMap<String, (Placement, Node<'a, 'a>)>;

/// Reads every body of a file and computes its placement.
pub fn read_bodies<'a>(document: &'a Document) -> Bodies<'a> {
    fn add_child_bodies<'a>(
        parent: Node<'a, 'a>,
        parent_placement: Placement,
        found_bodies: &mut Bodies<'a>,
    ) {
        for body in parent.children().filter(|node| node.has_tag_name("body")) {
            let quat = read_numbers(body, "quat");
            assert_eq!(quat[1..3], [0.0; 2], "the body is tilted");
            let placement = Placement {
                position: parent_placement.to_world(&read_numbers(body, "pos")),
                rotation: parent_placement.rotation + 2.0 * quat[3].atan2(quat[0]),
            };
            let name = body.attribute("name").expect("the body has a name");
            let previous = found_bodies.insert(name.to_owned(), (placement, body));
            assert!(previous.is_none(), "two bodies have the same name");
            add_child_bodies(body, placement, found_bodies);
        }
    }
    let mut found_bodies = BTreeMap::new();
    let world = section(document, "worldbody");
    add_child_bodies(world, WORLD, &mut found_bodies);
    found_bodies
}

fn section<'a>(document: &'a Document, tag: &str) -> Node<'a, 'a> {
    first_child(document.root_element(), tag)
}

/// Returns the child elements of the root's child `tag`.
pub fn section_elements<'a>(document: &'a Document, tag: &str) -> Vec<Node<'a, 'a>> {
    let children = section(document, tag).children();
    children.filter(Node::is_element).collect()
}

/// Returns the element with a tag and a name.
pub fn find_named<'a>(document: &'a Document, tag: &str, name: &str) -> Node<'a, 'a> {
    let mut nodes = document.descendants();
    let is_named = |node: &Node| node.has_tag_name(tag) && node.attribute("name") == Some(name);
    nodes.find(is_named).expect(name)
}

/// Returns the first child element with a tag.
pub fn first_child<'a>(node: Node<'a, 'a>, tag: &str) -> Node<'a, 'a> {
    let element = node.children().find(|node| node.has_tag_name(tag));
    element.expect(tag)
}
