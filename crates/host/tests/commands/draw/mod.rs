//! Tests of the drawings that a builder follows: pins, wires and angles are those of robot.toml, for every robot.

mod cranks;
mod drawing;
mod files;
mod wires;

use lizard_host::draw::{draw_horns, draw_top_view, draw_wiring};
use lizard_robot::Robot;

use crate::program::read;
use drawing::Drawing;
use files::{files, paper};

#[test]
fn everything_is_on_the_page_and_large_enough_to_be_read() {
    for (name, text) in files() {
        let robot = Robot::parse(&text).expect("a robot");
        for svg in [draw_wiring(&robot), draw_horns(&robot)] {
            let drawing = Drawing::of(&svg);
            let (width, height) = {
                let page = &drawing.0[0];
                (page.number("width"), page.number("height"))
            };
            assert!(width <= 700.0, "a README is that wide");
            for element in &drawing.0[1..] {
                let mut points = element.points();
                if element.tag == "text" {
                    let size = element.number("font-size");
                    assert!(size >= 12.0, "{name}: {element:?}");
                    // A character of a wide font is about 0.55 of the font size wide.
                    let text_width = 0.55 * size * element.content.chars().count() as f64;
                    let (x, y) = points[0];
                    if element.attribute("transform").is_empty() {
                        let (left, right) = match element.attribute("text-anchor") {
                            "start" => (0.0, text_width),
                            "end" => (text_width, 0.0),
                            _ => (text_width / 2.0, text_width / 2.0),
                        };
                        points.extend([(x - left, y - size), (x + right, y)]);
                    }
                }
                for (x, y) in points {
                    let is_inside = (0.0..=width).contains(&x) && (0.0..=height).contains(&y);
                    assert!(is_inside, "{name}: {x} {y} {element:?}");
                }
            }
        }
    }
}

#[test]
fn the_drawings_in_docs_are_up_to_date() {
    let robot = Robot::parse(&paper()).expect("a robot");
    let neutral = robot
        .lizard()
        .solve(&robot.neutral_pose())
        .expect("it closes");
    let view = draw_top_view(&robot, &neutral, true);
    for (name, svg) in [
        ("wiring", draw_wiring(&robot)),
        ("horns", draw_horns(&robot)),
        ("lizard", view.clone()),
        ("charts/top-view", view),
    ] {
        let stored_svg = read(&format!("docs/{name}.svg"));
        assert!(stored_svg == svg, "docs/{name}.svg: run `make docs`");
    }
}
