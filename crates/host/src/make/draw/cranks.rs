//! `lizard draw --horns`: the angles at which the cranks are pressed onto the shafts, in place of horns. A crank fits
//! only on the teeth of its shaft, so the drawing also shows the remaining error and the trim that corrects it.

use lizard_kinematics::{Vector, sin_cos};
use lizard_robot::Robot;
use lizard_robot::servo::SERVO_NAMES;
use svg::node::element::{Group, Polygon, Polyline};

use crate::shared::shapes::{
    Anchor, DARK, GREY, SERVO_COLOURS, SERVO_POSITIONS, add_outline, circle, curve, line,
    rectangle, render_svg, round_hundredths, text, text_end, text_middle, text_start,
};

/// Width and height of the page, pixels.
const PAGE_SIZE: (f64, f64) = (700.0, 640.0);

/// The robot's centre on the page, pixels.
const ROBOT_CENTRE: (f64, f64) = (196.0, 320.0);
/// Width and height of the robot's area on the page, pixels.
const ROBOT_AREA_SIZE: (f64, f64) = (250.0, 476.0);

/// Number of teeth on an SG-90's spline.
const TOOTH_COUNT: usize = 25;
/// Angle between neighbouring teeth, deg.
const TOOTH_PITCH_DEG: f64 = 360.0 / TOOTH_COUNT as f64;

/// The enlarged spline's centre on the page, pixels.
const SPLINE_CENTRE: (f64, f64) = (558.0, 158.0);
/// Radii of the enlarged spline between the teeth and at their tips, pixels.
const SPLINE_RADII: (f64, f64) = (52.0, 62.0);
/// Length of the crank on the enlarged spline, pixels.
const EXAMPLE_CRANK_LENGTH: f64 = 150.0;

/// The error in the example: the crank's angle clockwise from its correct angle, deg.
const EXAMPLE_ERROR_DEG: f64 = 6.0;

/// Width and length of an SG-90 from above, mm.
const CASE_SIZE_MM: (f64, f64) = (12.2, 22.8);
/// Distance of an SG-90's shaft from the nearer end of its case, mm.
const SHAFT_TO_CASE_END_MM: f64 = 6.0;

/// Draws the cranks of a robot at their neutral angles, as SVG text.
pub fn draw_cranks(robot: &Robot) -> String {
    let cranks = (0..4).map(|servo| draw_crank(robot, servo));
    let group = cranks.fold(draw_chassis(robot), Group::add);
    let group = group.add(draw_example(robot)).add(draw_compass_rose());
    render_svg(PAGE_SIZE, group)
}

/// Returns each crank's ends in the chassis frame, mm: the shaft, and the joint with the coupler.
fn compute_crank_ends(robot: &Robot) -> [(Vector, Vector); 4] {
    let links = robot.lizard().links;
    let lengths = [links.l1, links.l4, links.l9, links.l6];
    let shafts = robot.lizard().shafts();
    let servos = robot.servos();
    std::array::from_fn(|servo| {
        let crank_vector = Vector::from_angle(servos[servo].neutral) * lengths[servo];
        (shafts[servo], shafts[servo] + crank_vector)
    })
}

/// Returns the scale at which the robot fits its area, pixels per mm.
fn compute_scale(robot: &Robot) -> f64 {
    let (mut x, mut y) = (0.0f64, 0.0f64);
    for (shaft, tip) in compute_crank_ends(robot) {
        x = x.max(shaft.x.abs()).max(tip.x.abs());
        y = y.max(shaft.y.abs()).max(tip.y.abs());
    }
    (ROBOT_AREA_SIZE.0 / (2.0 * x)).min(ROBOT_AREA_SIZE.1 / (2.0 * y))
}

/// Returns the position on the page of a point in the chassis frame.
fn to_page_point(point: Vector, scale: f64) -> (f64, f64) {
    let (x, y) = ROBOT_CENTRE;
    (x + scale * point.x, y - scale * point.y)
}

/// Returns the point at a distance and in a direction (deg, counter-clockwise) from another point, on the page.
pub(super) fn offset_point(start: (f64, f64), angle_deg: f64, distance: f64) -> (f64, f64) {
    let (sin, cos) = sin_cos(angle_deg);
    (start.0 + distance * cos, start.1 - distance * sin)
}

/// Draws a dark arc of a circle; angles count counter-clockwise.
fn draw_arc(centre: (f64, f64), radius: f64, [start_deg, end_deg]: [f64; 2]) -> Polyline {
    const SEGMENT_COUNT: usize = 40;
    let points = (0..=SEGMENT_COUNT).map(|index| {
        let fraction = index as f64 / SEGMENT_COUNT as f64;
        offset_point(centre, start_deg + (end_deg - start_deg) * fraction, radius)
    });
    curve(&points.collect::<Vec<_>>(), DARK, 1.6)
}

/// Draws a dark, counter-clockwise arc with an arrowhead at its end.
fn draw_arrow(centre: (f64, f64), radius: f64, [start_deg, end_deg]: [f64; 2]) -> Group {
    const BARB_LENGTH: f64 = 8.0;
    let tip = offset_point(centre, end_deg, radius);
    // The backward direction of the arc at its end; the barbs lie on both sides of this direction.
    let back_deg = end_deg - 90.0;
    let barb_end = |lean_deg: f64| offset_point(tip, back_deg + lean_deg, BARB_LENGTH);
    Group::new()
        .add(draw_arc(centre, radius, [start_deg, end_deg]))
        .add(curve(&[barb_end(28.0), tip, barb_end(-28.0)], DARK, 1.6))
}

/// Draws the plate, the servos, and an arrow that points to the head.
fn draw_chassis(robot: &Robot) -> Group {
    let scale = compute_scale(robot);
    let crank_ends = compute_crank_ends(robot);
    let shaft_xs = crank_ends.iter().map(|(shaft, _)| shaft.x.abs());
    let half_width = shaft_xs.fold(0.0, f64::max) + 9.0;
    let half_height = crank_ends[0].0.y + 9.0;
    let corner = to_page_point(Vector::new(-half_width, half_height), scale);
    let size = (2.0 * half_width * scale, 2.0 * half_height * scale);
    let plate = rectangle(corner, size, "#f4f1ea").set("rx", 12);
    let mut group = Group::new().add(add_outline(plate, "#b8b0a0", 1.5));
    let (case_width, case_length) = CASE_SIZE_MM;
    for ((shaft, _), colour) in crank_ends.into_iter().zip(SERVO_COLOURS) {
        // The longer part of a servo's case lies between the shaft and the robot's centre.
        let upper_y = match shaft.y > 0.0 {
            true => shaft.y + SHAFT_TO_CASE_END_MM,
            false => shaft.y + case_length - SHAFT_TO_CASE_END_MM,
        };
        let corner = to_page_point(Vector::new(shaft.x - case_width / 2.0, upper_y), scale);
        let case = rectangle(corner, (case_width * scale, case_length * scale), colour);
        group = group.add(case.set("rx", 3).set("fill-opacity", 0.25));
    }
    let (x, y) = ROBOT_CENTRE;
    let (start, end) = ((x, y + 44.0), (x, y - 30.0));
    group
        .add(line(start, end, GREY, 3.0))
        .add(line(end, (end.0 - 8.0, end.1 + 12.0), GREY, 3.0))
        .add(line(end, (end.0 + 8.0, end.1 + 12.0), GREY, 3.0))
        .add(text_middle("head", (end.0, end.1 - 10.0), 15.0))
        .add(text_middle("tail", (start.0, start.1 + 20.0), 15.0))
}

/// Draws a servo's crank with its angle and its name.
fn draw_crank(robot: &Robot, servo: usize) -> Group {
    let scale = compute_scale(robot);
    let (shaft, tip) = compute_crank_ends(robot)[servo];
    let (shaft_point, tip_point) = (to_page_point(shaft, scale), to_page_point(tip, scale));
    let angle_deg = robot.servos()[servo].neutral.rem_euclid(360.0);
    let (name, colour) = (SERVO_NAMES[servo], SERVO_COLOURS[servo]);
    // Three lines of text stand outside the robot.
    let first_line_y = match shaft.y > 0.0 {
        true => tip_point.1 - 56.0,
        false => tip_point.1 + 28.0,
    };
    let text_point = |offset: f64| (tip_point.0, first_line_y + offset);
    let ray_end = (shaft_point.0 + 36.0, shaft_point.1);
    let zero_ray = line(shaft_point, ray_end, DARK, 1.2);
    let crank = line(shaft_point, tip_point, colour, 11.0);
    let name_text = text(name, text_point(0.0), 18.0, colour, Anchor::Middle);
    let angle_text = text_middle(&format!("{angle_deg:.2}°"), text_point(37.0), 16.0);
    Group::new()
        .add(zero_ray.set("stroke-dasharray", "3 3"))
        .add(crank.set("id", format!("crank-{name}")))
        .add(add_outline(circle(tip_point, 6.5, "white"), DARK, 2.0))
        .add(draw_arrow(shaft_point, 22.0, [0.0, angle_deg]))
        .add(circle(shaft_point, 8.0, DARK))
        .add(circle(shaft_point, 3.0, "white"))
        .add(name_text.set("font-weight", "bold"))
        .add(text_middle(SERVO_POSITIONS[servo], text_point(18.0), 14.0))
        .add(angle_text.set("id", format!("angle-{name}")))
}

/// Draws the first servo's spline, enlarged, with a crank that is off by [`EXAMPLE_ERROR_DEG`], and explains the trim.
fn draw_example(robot: &Robot) -> Group {
    const TEXT_X: f64 = 404.0;
    let servo = 0;
    let exact_deg = robot.servos()[servo].neutral;
    let fitted_deg = exact_deg - EXAMPLE_ERROR_DEG;
    let servo_number = servo + 1;
    let max_error_deg = TOOTH_PITCH_DEG / 2.0;
    let lines = [
        format!("{TOOTH_COUNT} teeth, {TOOTH_PITCH_DEG}° apart. On the best"),
        format!("tooth, a crank is off by at most {max_error_deg}°."),
        String::new(),
        "Dashed: the crank's correct angle.".into(),
        format!("Grey: a crank {EXAMPLE_ERROR_DEG}° further clockwise."),
        format!("trim {servo_number} {EXAMPLE_ERROR_DEG}"),
        "corrects it: + counter-clockwise,".into(),
        "\u{2212} clockwise, seen from above.".into(),
    ];
    let point_at = |angle_deg: f64, radius: f64| offset_point(SPLINE_CENTRE, angle_deg, radius);
    let draw_example_crank = |angle_deg: f64, colour: &str, width: f64| {
        let end = point_at(angle_deg, EXAMPLE_CRANK_LENGTH);
        line(SPLINE_CENTRE, end, colour, width)
    };
    let fitted_crank = draw_example_crank(fitted_deg, GREY, 13.0).set("id", "fitted-crank");
    let exact_crank =
        draw_example_crank(exact_deg, SERVO_COLOURS[servo], 3.0).set("id", "exact-crank");
    let arrow_radius = EXAMPLE_CRANK_LENGTH + 12.0;
    let arrow_ends = [fitted_deg - 7.0, exact_deg];
    let trim_point = point_at(exact_deg + 4.0, EXAMPLE_CRANK_LENGTH + 16.0);
    let mut group = Group::new()
        .add(draw_spline(fitted_deg))
        .add(fitted_crank.set("stroke-opacity", 0.5))
        .add(exact_crank.set("stroke-dasharray", "9 5"))
        .add(draw_arrow(SPLINE_CENTRE, arrow_radius, arrow_ends))
        .add(circle(SPLINE_CENTRE, 6.0, DARK))
        .add(text_end("trim", trim_point, 14.0))
        // The angle between two teeth is marked where the drawing has room.
        .add(draw_tooth_mark(fitted_deg - 9.0 * TOOTH_PITCH_DEG));
    for (index, line_text) in lines.iter().enumerate() {
        let point = (TEXT_X, SPLINE_CENTRE.1 + 102.0 + 19.0 * index as f64);
        let mut element = text_start(line_text, point, 14.0);
        if line_text.starts_with("trim") {
            element = element.set("font-weight", "bold");
        }
        group = group.add(element);
    }
    group
}

/// Draws the enlarged spline with a tooth at the angle `angle_deg`.
fn draw_spline(angle_deg: f64) -> Polygon {
    let corners: Vec<String> = (0..4 * TOOTH_COUNT)
        .map(|corner| {
            // A tooth has two corners at its tip; two more lie between the teeth.
            let (root_radius, tip_radius) = SPLINE_RADII;
            let radius = match corner % 4 < 2 {
                true => tip_radius,
                false => root_radius,
            };
            let corner_deg = angle_deg + TOOTH_PITCH_DEG / 4.0 * (corner as f64 - 0.5);
            let (x, y) = offset_point(SPLINE_CENTRE, corner_deg, radius);
            format!("{},{}", round_hundredths(x), round_hundredths(y))
        })
        .collect();
    Polygon::new()
        .set("points", corners.join(" "))
        .set("id", "spline")
        .set("fill", "#ececec")
        .set("stroke", DARK)
        .set("stroke-width", 1.5)
}

/// Draws a mark for the angle from the tooth at `angle_deg` to the next tooth.
fn draw_tooth_mark(angle_deg: f64) -> Group {
    let (inner_radius, outer_radius) = (SPLINE_RADII.1 + 3.0, SPLINE_RADII.1 + 26.0);
    let point_at = |angle_deg: f64, radius: f64| offset_point(SPLINE_CENTRE, angle_deg, radius);
    let draw_ray = |angle_deg| {
        let [start, end] = [inner_radius, outer_radius].map(|radius| point_at(angle_deg, radius));
        line(start, end, DARK, 1.2)
    };
    let arc_ends = [angle_deg, angle_deg + TOOTH_PITCH_DEG];
    let (text_x, text_y) = point_at(angle_deg + TOOTH_PITCH_DEG / 2.0, outer_radius + 3.0);
    let label = format!("{TOOTH_PITCH_DEG}°");
    Group::new()
        .add(draw_ray(arc_ends[0]))
        .add(draw_ray(arc_ends[1]))
        .add(draw_arc(SPLINE_CENTRE, outer_radius - 7.0, arc_ends))
        .add(text_start(&label, (text_x, text_y + 5.0), 14.0))
}

/// Draws a compass rose that shows the zero direction and the positive sense of angles.
fn draw_compass_rose() -> Group {
    let centre = (546.0, 540.0);
    let caption = (centre.0, centre.1 - 84.0);
    let mut group = Group::new()
        .add(text_middle("angles, seen from above", caption, 14.0))
        .add(add_outline(circle(centre, 46.0, "none"), GREY, 1.2))
        .add(draw_arrow(centre, 30.0, [0.0, 70.0]));
    for (angle_deg, label, anchor, offset) in [
        (0.0, "0° right", Anchor::Start, (8.0, 5.0)),
        (90.0, "90° head", Anchor::Middle, (0.0, -8.0)),
        (180.0, "180°", Anchor::End, (-8.0, 5.0)),
        (270.0, "270°", Anchor::Middle, (0.0, 19.0)),
    ] {
        let end = offset_point(centre, angle_deg, 52.0);
        let point = (end.0 + offset.0, end.1 + offset.1);
        group = group
            .add(line(centre, end, GREY, 1.2))
            .add(text(label, point, 14.0, DARK, anchor));
    }
    group
}
