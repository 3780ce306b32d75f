//! A parser for SVG drawings.

use std::collections::HashMap;

use svg::parser::Event;

/// A point on the page, px; y points downward.
pub type Point = (f64, f64);

/// An element of a drawing, with its tag, attributes and text.
#[derive(Debug)]
pub struct Element {
    pub tag: String,
    attributes: HashMap<String, String>,
    pub content: String,
}

impl Element {
    /// Returns the value of an attribute; empty if the attribute is missing.
    pub fn attribute(&self, key: &str) -> &str {
        self.attributes.get(key).map_or("", String::as_str)
    }

    /// Parses the value of an attribute as a finite number.
    pub fn parse_number(&self, key: &str) -> f64 {
        let number = self.attribute(key).parse();
        let number = number.unwrap_or_else(|_| panic!("{key} is not a number: {self:?}"));
        assert!(f64::is_finite(number), "{key} is not finite: {self:?}");
        number
    }

    /// Parses the points through which the element is drawn.
    pub fn points(&self) -> Vec<Point> {
        let parse_point = |x, y| (self.parse_number(x), self.parse_number(y));
        match self.tag.as_str() {
            "line" => vec![parse_point("x1", "y1"), parse_point("x2", "y2")],
            "circle" => vec![parse_point("cx", "cy")],
            "text" => vec![parse_point("x", "y")],
            "rect" => {
                let (x, y) = parse_point("x", "y");
                let (width, height) = parse_point("width", "height");
                vec![(x, y), (x + width, y + height)]
            }
            "polyline" | "polygon" => {
                let parse = |text: &str| text.parse().expect("a coordinate is a number");
                let parse_pair = |pair: &str| {
                    let (x, y) = pair.split_once(',').expect("a point is written as x,y");
                    (parse(x), parse(y))
                };
                let pairs = self.attribute("points").split(' ');
                pairs.map(parse_pair).collect()
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
                    elements.push(Element {
                        tag: tag.into(),
                        attributes: attributes
                            .map(|(key, value)| (key.clone(), value.to_string()))
                            .collect(),
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
        let elements = self.elements.iter();
        let elements = elements.filter(|element| element.attribute("id") == id);
        match elements.collect::<Vec<_>>()[..] {
            [element] => element,
            ref elements => panic!("the drawing has {} elements {id}", elements.len()),
        }
    }

    pub fn has_element(&self, id: &str) -> bool {
        let mut elements = self.elements.iter();
        elements.any(|element| element.attribute("id") == id)
    }

    /// Returns the texts of all elements.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.elements.iter().map(|element| element.content.as_str())
    }

    pub fn points_by_id(&self, id: &str) -> Vec<Point> {
        self.element_by_id(id).points()
    }

    /// Returns the names and points of all wires.
    pub fn wires(&self) -> Vec<(&str, Vec<Point>)> {
        self.elements
            .iter()
            .filter(|element| element.tag == "polyline" && !element.attribute("id").is_empty())
            .map(|element| (element.attribute("id"), element.points()))
            .collect()
    }
}
