//! `lizard draw --horns`: the angles at which to press the cranks onto the shafts, and the error that a trim
//! corrects, because a crank fits only on the teeth of its shaft.

use lizard_kinematics::{Vector, sin_cos};
use lizard_robot::Robot;
use lizard_robot::servo::NAMES;
use svg::node::element::{Group, Polygon, Polyline};

use crate::shared::ink::{
    Anchor, DARK, GREY, PLACES, SERVO, circle, curve, edged, fixed, line, page, rectangle, text,
    text_end, text_middle, text_start,
};

const SIZE: (f64, f64) = (700.0, 640.0);

/// The centre of the robot on the page.
const MIDDLE: (f64, f64) = (196.0, 320.0);
/// The size of the robot's area on the page.
const ROOM: (f64, f64) = (250.0, 476.0);

/// Teeth of an SG-90's spline.
const TEETH: usize = 25;
/// Angle from a tooth to the next, deg.
const TOOTH_PITCH_DEG: f64 = 360.0 / TEETH as f64;

/// The centre of the enlarged spline.
const SPLINE: (f64, f64) = (558.0, 158.0);
/// Radii of the enlarged spline between the teeth and at their tips.
const RADII: (f64, f64) = (52.0, 62.0);
/// Length of the crank on the enlarged spline.
const CRANK: f64 = 150.0;

/// The error in the example: the crank sits this many degrees clockwise of its correct angle.
const EXAMPLE_ERROR_DEG: f64 = 6.0;

/// Width and length of an SG-90 from above, mm.
const BODY: (f64, f64) = (12.2, 22.8);
/// Distance of an SG-90's shaft from the nearer end of its case, mm.
const SHAFT: f64 = 6.0;

/// The cranks of a robot at their neutral angles, as SVG text.
pub fn horns(robot: &Robot) -> String {
    let mut group = chassis(robot);
    for servo in 0..4 {
        group = group.add(crank(robot, servo));
    }
    group = group.add(example(robot)).add(rose());
    page(SIZE, group)
}

/// The ends of the cranks, mm in the chassis frame: the shaft, and the joint with the coupler.
fn cranks(robot: &Robot) -> [(Vector, Vector); 4] {
    let links = robot.lizard().links;
    let lengths = [links.l1, links.l4, links.l9, links.l6];
    let shafts = robot.lizard().shafts();
    let servos = robot.servos();
    std::array::from_fn(|servo| {
        let along = Vector::direction(servos[servo].neutral) * lengths[servo];
        (shafts[servo], shafts[servo] + along)
    })
}

/// Pixels per millimetre at which the robot fits its area.
fn scale(robot: &Robot) -> f64 {
    let (mut x, mut y) = (0.0f64, 0.0f64);
    for (shaft, tip) in cranks(robot) {
        x = x.max(shaft.x.abs()).max(tip.x.abs());
        y = y.max(shaft.y.abs()).max(tip.y.abs());
    }
    (ROOM.0 / (2.0 * x)).min(ROOM.1 / (2.0 * y))
}

/// Position on the page of a point in the chassis frame.
fn on_page(point: Vector, scale: f64) -> (f64, f64) {
    (MIDDLE.0 + scale * point.x, MIDDLE.1 - scale * point.y)
}

/// The point on the page at a distance and in a direction (degrees counter-clockwise) from another point.
fn point_toward(from: (f64, f64), degrees: f64, distance: f64) -> (f64, f64) {
    let (sin, cos) = sin_cos(degrees);
    (from.0 + distance * cos, from.1 - distance * sin)
}

/// An arc of a circle; angles count counter-clockwise.
fn arc(middle: (f64, f64), radius: f64, from: f64, to: f64, colour: &str) -> Polyline {
    const STEPS: usize = 40;
    let points: Vec<(f64, f64)> = (0..=STEPS)
        .map(|step| {
            let part = step as f64 / STEPS as f64;
            point_toward(middle, from + (to - from) * part, radius)
        })
        .collect();
    curve(&points, colour, 1.6)
}

/// An arc with an arrowhead at its end.
fn arrow(middle: (f64, f64), radius: f64, from: f64, to: f64, colour: &str) -> Group {
    const BARB: f64 = 8.0;
    let tip = point_toward(middle, to, radius);
    // The direction back along the arc at its end; the barbs lie to both sides of it.
    let along = if to > from { to - 90.0 } else { to + 90.0 };
    let barb = |lean: f64| point_toward(tip, along + lean, BARB);
    Group::new()
        .add(arc(middle, radius, from, to, colour))
        .add(curve(&[barb(28.0), tip, barb(-28.0)], colour, 1.6))
}

/// The plate, the servos, and an arrow that points to the head.
fn chassis(robot: &Robot) -> Group {
    let (scale, cranks) = (scale(robot), cranks(robot));
    let half = cranks
        .iter()
        .map(|(shaft, _)| shaft.x.abs())
        .fold(0.0, f64::max)
        + 9.0;
    let top = cranks[0].0.y + 9.0;
    let corner = on_page(Vector::new(-half, top), scale);
    let size = (2.0 * half * scale, 2.0 * top * scale);
    let mut group = Group::new().add(edged(
        rectangle(corner, size, "#f4f1ea").set("rx", 12),
        "#b8b0a0",
        1.5,
    ));
    for (servo, (shaft, _)) in cranks.into_iter().enumerate() {
        // The longer part of a servo's case lies on the side of the shaft that faces the middle of the robot.
        let upper = if shaft.y > 0.0 {
            shaft.y + SHAFT
        } else {
            shaft.y + BODY.1 - SHAFT
        };
        let corner = on_page(Vector::new(shaft.x - BODY.0 / 2.0, upper), scale);
        group = group.add(
            rectangle(corner, (BODY.0 * scale, BODY.1 * scale), SERVO[servo])
                .set("rx", 3)
                .set("fill-opacity", 0.25),
        );
    }
    let (tail, tip) = ((MIDDLE.0, MIDDLE.1 + 44.0), (MIDDLE.0, MIDDLE.1 - 30.0));
    group
        .add(line(tail, tip, GREY, 3.0))
        .add(line(tip, (tip.0 - 8.0, tip.1 + 12.0), GREY, 3.0))
        .add(line(tip, (tip.0 + 8.0, tip.1 + 12.0), GREY, 3.0))
        .add(text_middle("head", (tip.0, tip.1 - 10.0), 15.0))
        .add(text_middle("tail", (tail.0, tail.1 + 20.0), 15.0))
}

/// A servo's crank, its angle and its name.
fn crank(robot: &Robot, servo: usize) -> Group {
    let scale = scale(robot);
    let (shaft, tip) = cranks(robot)[servo];
    let (from, to) = (on_page(shaft, scale), on_page(tip, scale));
    let angle = robot.servos()[servo].neutral.rem_euclid(360.0);
    let colour = SERVO[servo];
    // Three lines of text, outside of the robot.
    let base = if shaft.y > 0.0 {
        to.1 - 56.0
    } else {
        to.1 + 28.0
    };
    Group::new()
        .add(line(from, (from.0 + 36.0, from.1), DARK, 1.2).set("stroke-dasharray", "3 3"))
        .add(line(from, to, colour, 11.0).set("id", format!("crank-{}", NAMES[servo])))
        .add(edged(circle(to, 6.5, "white"), DARK, 2.0))
        .add(arrow(from, 22.0, 0.0, angle, DARK))
        .add(circle(from, 8.0, DARK))
        .add(circle(from, 3.0, "white"))
        .add(
            text(NAMES[servo], (to.0, base), 18.0, colour, Anchor::Middle)
                .set("font-weight", "bold"),
        )
        .add(text_middle(PLACES[servo], (to.0, base + 18.0), 14.0))
        .add(
            text_middle(&format!("{angle:.2}°"), (to.0, base + 37.0), 16.0)
                .set("id", format!("angle-{}", NAMES[servo])),
        )
}

/// The first servo's spline, enlarged, with a crank on the nearest tooth.
fn example(robot: &Robot) -> Group {
    const LEFT: f64 = 404.0;
    let servo = 0;
    let exact = robot.servos()[servo].neutral;
    let placed = exact - EXAMPLE_ERROR_DEG;
    let number = servo + 1;
    let lines = [
        format!("{TEETH} teeth, {TOOTH_PITCH_DEG}° apart. On the best"),
        format!("one a crank is off by {}° at most.", TOOTH_PITCH_DEG / 2.0),
        String::new(),
        "Dashed: the angle where it should be.".into(),
        format!("Grey: it sits {EXAMPLE_ERROR_DEG}° clockwise of that."),
        format!("trim {number} {EXAMPLE_ERROR_DEG}"),
        "turns it there: + counter-clockwise,".into(),
        "\u{2212} clockwise, seen from above.".into(),
    ];
    let mut group = Group::new()
        .add(spline(placed))
        .add(
            line(SPLINE, point_toward(SPLINE, placed, CRANK), GREY, 13.0)
                .set("stroke-opacity", 0.5)
                .set("id", "sits"),
        )
        .add(
            line(
                SPLINE,
                point_toward(SPLINE, exact, CRANK),
                SERVO[servo],
                3.0,
            )
            .set("stroke-dasharray", "9 5")
            .set("id", "should"),
        )
        .add(arrow(SPLINE, CRANK + 12.0, placed - 7.0, exact, DARK))
        .add(circle(SPLINE, 6.0, DARK))
        .add(text_end(
            "trim",
            point_toward(SPLINE, exact + 4.0, CRANK + 16.0),
            14.0,
        ))
        // The width of a tooth, marked on the side that is free.
        .add(tooth(placed - 9.0 * TOOTH_PITCH_DEG));
    for (index, words) in lines.iter().enumerate() {
        let point = (LEFT, SPLINE.1 + 102.0 + 19.0 * index as f64);
        let mut line = text_start(words, point, 14.0);
        if words.starts_with("trim") {
            line = line.set("font-weight", "bold");
        }
        group = group.add(line);
    }
    group
}

/// The enlarged spline with a tooth at the angle `degrees`.
fn spline(degrees: f64) -> Polygon {
    let corners: Vec<String> = (0..4 * TEETH)
        .map(|corner| {
            // Two corners at a tooth's tip, two between teeth.
            let radius = if corner % 4 < 2 { RADII.1 } else { RADII.0 };
            let degrees_of_corner = degrees + TOOTH_PITCH_DEG / 4.0 * (corner as f64 - 0.5);
            let (x, y) = point_toward(SPLINE, degrees_of_corner, radius);
            format!("{},{}", fixed(x), fixed(y))
        })
        .collect();
    Polygon::new()
        .set("points", corners.join(" "))
        .set("id", "spline")
        .set("fill", "#ececec")
        .set("stroke", DARK)
        .set("stroke-width", 1.5)
}

/// A mark for the angle from the tooth at `degrees` to the next tooth.
fn tooth(degrees: f64) -> Group {
    let (near, far) = (RADII.1 + 3.0, RADII.1 + 26.0);
    let ray = |degrees| {
        line(
            point_toward(SPLINE, degrees, near),
            point_toward(SPLINE, degrees, far),
            DARK,
            1.2,
        )
    };
    let words = point_toward(SPLINE, degrees + TOOTH_PITCH_DEG / 2.0, far + 3.0);
    Group::new()
        .add(ray(degrees))
        .add(ray(degrees + TOOTH_PITCH_DEG))
        .add(arc(
            SPLINE,
            far - 7.0,
            degrees,
            degrees + TOOTH_PITCH_DEG,
            DARK,
        ))
        .add(text_start(
            &format!("{TOOTH_PITCH_DEG}°"),
            (words.0, words.1 + 5.0),
            14.0,
        ))
}

/// A compass rose that shows the zero direction and the positive sense of angles.
fn rose() -> Group {
    let middle = (546.0, 540.0);
    let caption = (middle.0, middle.1 - 84.0);
    let mut group = Group::new()
        .add(text_middle("angles, seen from above", caption, 14.0))
        .add(edged(circle(middle, 46.0, "none"), GREY, 1.2))
        .add(arrow(middle, 30.0, 0.0, 70.0, DARK));
    for (degrees, words, anchor, offset) in [
        (0.0, "0° right", Anchor::Start, (8.0, 5.0)),
        (90.0, "90° head", Anchor::Middle, (0.0, -8.0)),
        (180.0, "180°", Anchor::End, (-8.0, 5.0)),
        (270.0, "270°", Anchor::Middle, (0.0, 19.0)),
    ] {
        let end = point_toward(middle, degrees, 52.0);
        let point = (end.0 + offset.0, end.1 + offset.1);
        group = group
            .add(line(middle, end, GREY, 1.2))
            .add(text(words, point, 14.0, DARK, anchor));
    }
    group
}
