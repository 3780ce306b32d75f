//! The elements of an SVG drawing.

use std::collections::HashMap;

use svg::parser::Event;

/// A point on the page, px; y points downward.
pub type Point = (f64, f64);

/// An element of a drawing: its tag, its attributes, and its text.
#[derive(Debug)]
pub struct Element {
    pub tag: String,
    attributes: HashMap<String, String>,
    pub content: String,
}

impl Element {
    /// The value of an attribute; empty without it.
    pub fn attribute(&self, key: &str) -> &str {
        self.attributes.get(key).map_or("", String::as_str)
    }

    /// The value of an attribute as a finite number.
    pub fn finite_number(&self, key: &str) -> f64 {
        let text = self.attribute(key);
        let number = text
            .parse()
            .unwrap_or_else(|_| panic!("{key}={text} of {self:?}"));
        assert!(f64::is_finite(number), "{self:?}");
        number
    }

    /// The points through which the element is drawn.
    pub fn points(&self) -> Vec<Point> {
        let point_of = |x, y| (self.finite_number(x), self.finite_number(y));
        match self.tag.as_str() {
            "line" => vec![point_of("x1", "y1"), point_of("x2", "y2")],
            "circle" => vec![point_of("cx", "cy")],
            "text" => vec![point_of("x", "y")],
            "rect" => {
                let (x, y) = point_of("x", "y");
                let (width, height) = point_of("width", "height");
                vec![(x, y), (x + width, y + height)]
            }
            "polyline" | "polygon" => {
                let number_of = |text: &str| text.parse().expect("a coordinate is a number");
                let pairs = self
                    .attribute("points")
                    .split(' ')
                    .map(|pair| pair.split_once(','));
                let pairs = pairs.map(|pair| pair.expect("a point is written as x,y"));
                pairs.map(|(x, y)| (number_of(x), number_of(y))).collect()
            }
            _ => vec![],
        }
    }
}

/// The elements of a drawing.
pub struct Drawing {
    pub elements: Vec<Element>,
}

impl Drawing {
    pub fn parse(svg: &str) -> Self {
        let mut elements: Vec<Element> = Vec::new();
        for event in svg::read(svg).expect("the drawing is SVG") {
            match event {
                Event::Tag(tag, kind, attributes) if kind != svg::node::element::tag::Type::End => {
                    let attributes = attributes.iter();
                    let attributes =
                        attributes.map(|(key, value)| (key.clone(), value.to_string()));
                    elements.push(Element {
                        tag: tag.into(),
                        attributes: attributes.collect(),
                        content: String::new(),
                    });
                }
                Event::Text(text) => elements.last_mut().expect("a tag precedes").content += text,
                Event::Error(error) => panic!("{error}"),
                _ => {}
            }
        }
        Self { elements }
    }

    pub fn element_by_id(&self, id: &str) -> &Element {
        let elements = self
            .elements
            .iter()
            .filter(|element| element.attribute("id") == id);
        match elements.collect::<Vec<_>>()[..] {
            [element] => element,
            ref elements => panic!("the drawing has {} elements {id}", elements.len()),
        }
    }

    pub fn has_element(&self, id: &str) -> bool {
        let mut elements = self.elements.iter();
        elements.any(|element| element.attribute("id") == id)
    }

    /// The texts of all elements.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.elements.iter().map(|element| element.content.as_str())
    }

    pub fn points_by_id(&self, id: &str) -> Vec<Point> {
        self.element_by_id(id).points()
    }

    /// Every wire and rail: its name and its points.
    pub fn wires(&self) -> Vec<(&str, Vec<Point>)> {
        self.elements
            .iter()
            .filter(|element| element.tag == "polyline" && !element.attribute("id").is_empty())
            .map(|element| (element.attribute("id"), element.points()))
            .collect()
    }
}
