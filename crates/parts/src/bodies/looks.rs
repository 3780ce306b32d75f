//! What makes the robot look like a lizard: two long links behind the tail's point, as
//! the paper's robot has them, and a head ahead of the head's point.
//!
//! They drive nothing. The screw of the point and one more hold each of them on the
//! coupler on which it lies, so it turns with that coupler: the left tail link under the
//! lower coupler, the right one and the head on the upper one. At neutral they point
//! straight back and ahead.

use lizard_kinematics::{End, Solution, Vector};

use crate::bodies::builder::{Bolt, Builder, Points};
use crate::bodies::names::names;
use crate::layers::body::{Kind, Mount, Prism, at_end, coupler_length};
use crate::layers::shape::Shape;
use crate::layers::stack::PLAY;

/// Their thickness, mm.
const THICK: f64 = 3.0;
/// From the point to the second screw, mm.
const BACK: f64 = 14.0;
/// Length of that screw, which cuts its thread, mm.
const SCREW: f64 = 6.0;
/// How far the two links of the tail point apart, deg to each side.
const APART: f64 = 3.5;

/// What an end has of it.
#[derive(Default)]
pub struct Looks {
    /// What lies under the lower coupler at the point, mm.
    pub below: f64,
    /// What lies on the upper one, mm.
    pub above: f64,
    /// Names of what lies on the upper one.
    pub on_right: Vec<String>,
}

/// How far an end's own part reaches beyond its point, mm; 0 where it has none.
fn length(builder: &Builder, end: End) -> f64 {
    match end {
        End::Head => builder.parts.head,
        End::Tail => builder.parts.tail,
    }
}

/// The hole for the second screw in a coupler that carries something: its lower part,
/// and where the screw's head is sunk if it comes from above.
pub fn fixed(builder: &Builder, servo: usize, point: Vector) -> Option<[Shape; 2]> {
    let (end, hand) = at_end(servo);
    let at = point - Vector::new(BACK, 0.0);
    match (length(builder, end) > 0.0, end, hand) {
        (true, End::Tail, 0) => Some([builder.hole(at), builder.sink(at)]),
        (true, _, 1) => Some([builder.thread(at), builder.thread(at)]),
        _ => None,
    }
}

pub fn add(builder: &mut Builder, end: End) -> Looks {
    let length = length(builder, end);
    let neutral = builder.robot.lizard().solve(&builder.robot.neutral());
    let (true, Ok(neutral)) = (length > 0.0, neutral) else {
        return Looks::default();
    };
    let [left, right] = end.servos();
    match end {
        End::Head => {
            let shape = head(builder, right, &neutral, length);
            on_upper(builder, right, "head plate".to_owned(), shape);
            Looks {
                below: 0.0,
                above: THICK,
                on_right: vec!["head plate".to_owned()],
            }
        }
        End::Tail => {
            let shape = tail(builder, left, &neutral, length);
            under_lower(builder, left, shape);
            let shape = tail(builder, right, &neutral, length);
            let name = format!("tail {}", names(right).0);
            on_upper(builder, right, name.clone(), shape);
            Looks {
                below: THICK,
                above: THICK,
                on_right: vec![name],
            }
        }
    }
}

/// What is added and what is cut away.
type Flat = (Vec<Shape>, Vec<Shape>);

/// The point of an end, and the way out from there at neutral, in a coupler's frame.
fn out(builder: &Builder, servo: usize, neutral: &Solution) -> [Vector; 2] {
    let (end, hand) = at_end(servo);
    let bars = neutral.end(end);
    let along = end.mirror([bars.left_coupler, bars.right_coupler][hand]);
    let ahead = Vector::new(0.0, end.sign());
    let point = Vector::new(coupler_length(builder.robot, servo), 0.0);
    [point, Vector::new(ahead.dot(along), along.cross(ahead))]
}

fn turned(way: Vector, by: f64) -> Vector {
    let by = Vector::direction(by);
    way * by.x + way.left() * by.y
}

fn tail(builder: &Builder, servo: usize, neutral: &Solution, length: f64) -> Flat {
    let [point, straight] = out(builder, servo, neutral);
    // Seen from behind the robot, left is to the left.
    let (_, hand) = at_end(servo);
    let way = turned(straight, if hand == 0 { -APART } else { APART });
    let half = builder.half();
    let wide = way.left() * (half - 1.5);
    let second = point - Vector::new(BACK, 0.0);
    let add = vec![
        Shape::bar(second, point, half),
        Shape::hull(
            &[point + wide, point - wide, point + way * (length - 1.5)],
            1.5,
        ),
    ];
    (add, vec![builder.hole(point)])
}

fn head(builder: &Builder, servo: usize, neutral: &Solution, length: f64) -> Flat {
    /// Radius of the corners, and of an eye, mm.
    const ROUND: f64 = 7.0;
    const EYE: f64 = 2.5;
    let [point, way] = out(builder, servo, neutral);
    let at = |ahead: f64, left: f64| point + way * ahead + way.left() * left;
    let second = point - Vector::new(BACK, 0.0);
    let wide = 0.24 * length;
    let face = Shape::hull(
        &[
            at(length - ROUND, 0.0),
            at(0.34 * length, wide),
            at(0.34 * length, -wide),
            at(-0.1 * length, 0.4 * wide),
            at(-0.1 * length, -0.4 * wide),
        ],
        ROUND,
    );
    let eyes = [wide, -wide].map(|left| Shape::disc(at(0.42 * length, left), EYE));
    let mut cut = vec![builder.hole(point)];
    cut.extend(eyes);
    let add = vec![Shape::bar(second, point, builder.half()), face];
    (add, cut)
}

/// The place of the second screw in a coupler's frame.
fn second(builder: &Builder, servo: usize) -> Vector {
    Vector::new(coupler_length(builder.robot, servo) - BACK, 0.0)
}

fn on_upper(builder: &mut Builder, servo: usize, name: String, (add, mut cut): Flat) {
    let low = builder.stack.upper[1];
    let at = second(builder, servo);
    cut.push(builder.hole(at));
    let z = [low, low + THICK];
    let mount = Mount::Coupler(servo);
    builder.body(
        name.clone(),
        Kind::Printed,
        mount,
        vec![Prism { add, cut, z }],
    );
    screw(builder, &name, servo, z[1]);
}

fn under_lower(builder: &mut Builder, servo: usize, (add, mut cut): Flat) {
    let high = builder.stack.lower[0];
    let at = second(builder, servo);
    cut.push(builder.thread(at));
    let z = [high - THICK, high];
    let name = format!("tail {}", names(servo).0);
    let mount = Mount::Coupler(servo);
    builder.body(
        name.clone(),
        Kind::Printed,
        mount,
        vec![Prism { add, cut, z }],
    );
    // The upper coupler turns over this head.
    let seat = builder.stack.lower[1] - builder.parts.screw.head_height - PLAY;
    screw(builder, &name, servo, seat);
}

fn screw(builder: &mut Builder, of: &str, servo: usize, head: f64) {
    let at = second(builder, servo);
    let bolt = Bolt {
        name: of,
        mount: Mount::Coupler(servo),
        at,
        head,
        points: Points::Down,
        nut: 0.0,
        length: None,
        meets: &[],
        hex: false,
    };
    builder.screw(&bolt, SCREW);
}
