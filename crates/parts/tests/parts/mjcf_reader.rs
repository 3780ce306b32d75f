//! A reader of the MuJoCo file that places the bodies using only the file's numbers.

use std::collections::BTreeMap;

use lizard_kinematics::Solution;
use lizard_parts::{Assembly, Scene, mjcf};
use lizard_robot::Robot;
use roxmltree::{Document, Node};

/// The positions of the robot's joints at neutral.
pub fn neutral(robot: &Robot) -> Solution {
    let solution = robot.lizard().solve(&robot.neutral_pose());
    solution.expect("neutral closes")
}

/// The MuJoCo file of a robot whose scene is changed by `change`.
pub fn mjcf_with(robot: &Robot, change: impl FnOnce(&mut Scene)) -> String {
    let assembly = Assembly::new(robot);
    let mut scene = Scene::of(&assembly);
    change(&mut scene);
    mjcf(&assembly, &neutral(robot), &scene).expect("it is made")
}

/// The numbers in an attribute, which blanks separate.
pub fn numbers(node: Node, attribute: &str) -> Vec<f64> {
    let text = node.attribute(attribute).expect(attribute);
    let fields = text.split(' ');
    fields
        .map(|field| field.parse().expect("a number"))
        .collect()
}

/// The placement of a body in the world: position, m, and rotation about z.
#[derive(Clone, Copy)]
pub struct Placed {
    pub at: [f64; 3],
    pub turn: f64,
}

impl Placed {
    /// Converts a point from the body's frame to the world, m.
    pub fn point(&self, point: &[f64]) -> [f64; 3] {
        let (sin, cos) = self.turn.sin_cos();
        [
            self.at[0] + cos * point[0] - sin * point[1],
            self.at[1] + sin * point[0] + cos * point[1],
            self.at[2] + point[2],
        ]
    }
}

/// Bodies by their names.
pub type Bodies<'a> = BTreeMap<String, (Placed, Node<'a, 'a>)>;

/// Every body of a file, with its placement.
pub fn bodies<'a>(document: &'a Document) -> Bodies<'a> {
    fn walk<'a>(parent: Node<'a, 'a>, parent_placement: Placed, found_bodies: &mut Bodies<'a>) {
        for body in parent.children().filter(|node| node.has_tag_name("body")) {
            let quat = numbers(body, "quat");
            assert_eq!(quat[1..3], [0.0; 2], "it stays upright");
            let placement = Placed {
                at: parent_placement.point(&numbers(body, "pos")),
                turn: parent_placement.turn + 2.0 * quat[3].atan2(quat[0]),
            };
            let name = body.attribute("name").expect("a name").to_owned();
            assert!(
                found_bodies.insert(name, (placement, body)).is_none(),
                "one of a name"
            );
            walk(body, placement, found_bodies);
        }
    }
    let mut found_bodies = BTreeMap::new();
    let world = find(document, "worldbody");
    let origin = [0.0; 3];
    walk(
        world,
        Placed {
            at: origin,
            turn: 0.0,
        },
        &mut found_bodies,
    );
    found_bodies
}

fn find<'a>(document: &'a Document, tag: &str) -> Node<'a, 'a> {
    child(document.root_element(), tag)
}

/// The child elements of the root's child `tag`.
pub fn elements<'a>(document: &'a Document, tag: &str) -> Vec<Node<'a, 'a>> {
    let children = find(document, tag).children();
    children.filter(Node::is_element).collect()
}

/// The first child element with a tag.
pub fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Node<'a, 'a> {
    let element = node.children().find(|node| node.has_tag_name(tag));
    element.expect(tag)
}
