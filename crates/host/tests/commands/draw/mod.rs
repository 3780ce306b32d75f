//! Tests of the drawings for a builder: pins, wires and angles of every robot match its robot.toml.

mod cranks;
mod drawing;
mod robot_files;
mod wires;

use lizard_host::draw::{draw_cranks, draw_wiring};
use lizard_robot::Robot;

use crate::harness::read_file;
use drawing::Drawing;
use robot_files::{paper_toml, read_robot_files};

#[test]
fn every_element_is_on_the_page_and_every_text_is_large_enough_to_read() {
    for (name, text) in read_robot_files() {
        let robot = Robot::parse(&text).expect("the robot file is valid");
        for svg in [draw_wiring(&robot), draw_cranks(&robot)] {
            let drawing = Drawing::parse(&svg);
            let page = &drawing.elements[0];
            let [width, height] = ["width", "height"].map(|key| page.parse_number(key));
            assert!(width <= 700.0, "{name}: wider than a README on GitHub");
            for element in &drawing.elements[1..] {
                let mut points = element.points();
                if element.tag == "text" {
                    let size = element.parse_number("font-size");
                    assert!(size >= 12.0, "{name}: {element:?}");
                    // The width of a character in a wide font is about 0.55 of the font size.
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
                    assert!(is_inside, "{name}: ({x}, {y}) is off the page: {element:?}");
                }
            }
        }
    }
}

#[test]
fn the_drawings_in_docs_are_up_to_date() {
    let robot = Robot::parse(&paper_toml()).expect("the robot file is valid");
    for (name, svg) in [
        ("wiring", draw_wiring(&robot)),
        ("horns", draw_cranks(&robot)),
    ] {
        let stored_svg = read_file(&format!("docs/{name}.svg"));
        assert!(stored_svg == svg, "docs/{name}.svg: run `make docs`");
    }
}
