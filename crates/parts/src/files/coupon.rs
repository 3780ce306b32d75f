//! A fit coupon: an hour of printing that shows which `fit` a printer needs.
//!
//! Each column has another fit, 0.0 to 0.4 mm from the left, marked by one to five dots: an M3
//! hole, a horn's pocket, a servo's opening with the notch for its lead, a piece of a sleeve. Use
//! the first column in which all of these can be assembled by hand.

use lizard_kinematics::Vector;
use lizard_robot::Parts;

use crate::bodies::leads::{LEAD, notch};
use crate::bodies::links::{POCKET, arm};
use crate::bodies::sliders::ROD;
use crate::layers::body::Prism;
use crate::layers::placement::Placement;
use crate::layers::shape::Shape;
use crate::part::Part;

/// Number of columns.
const COLUMNS: u32 = 5;
/// Difference of the fit from column to column, mm.
const STEP: f64 = 0.1;
/// Thickness of the coupon, mm.
const THICK: f64 = 4.0;
/// Thickness of the floor of the coupon's pockets, mm.
const FLOOR: f64 = 1.8;
/// Length of a piece of a sleeve, mm.
const SLEEVE: f64 = 10.0;
/// Length of the piece of rod to try in a sleeve, mm.
const GAUGE: f64 = 30.0;

/// The coupon, and a piece of rod to try in its sleeves.
pub fn coupon(parts: &Parts) -> [Part; 2] {
    let (servo, horn) = (&parts.servo, &parts.horn);
    let pitch = servo.width + 2.0 * STEP * f64::from(COLUMNS) + 4.0;
    // From the lower edge up: opening, pocket, hole with dots, sleeve.
    let max = STEP * f64::from(COLUMNS);
    let opening = 3.0 + LEAD[1] + max + servo.length / 2.0;
    let pocket = opening + servo.length / 2.0 + max + 3.0 + horn.hub / 2.0;
    let hole = pocket + horn.arm + 5.0;
    let sleeve = hole + 6.0 + SLEEVE / 2.0;
    let top = sleeve + SLEEVE / 2.0 + 2.0;
    let wide = pitch * f64::from(COLUMNS);
    let at = Vector::new;
    let plate = Shape::rectangle(at(wide / 2.0, top / 2.0), at(wide, top), 2.0);
    let (mut floor, mut below, mut walls, mut bores) = (vec![], vec![], vec![], vec![]);
    let mut roofs = Vec::new();
    for column in 0..COLUMNS {
        let fit = STEP * f64::from(column);
        let x = pitch * (f64::from(column) + 0.5);
        let case = at(servo.width + 2.0 * fit, servo.length + 2.0 * fit);
        let through = [
            Shape::disc(at(x - 3.0, hole), (parts.screw.diameter + fit) / 2.0),
            Shape::rectangle(at(x, opening), case, 0.0),
            notch(servo, at(x, opening), fit, -1.0),
        ];
        floor.extend(through.iter().cloned());
        below.extend(through);
        floor.push(Shape::disc(at(x, pocket), horn.hub / 2.0 + fit));
        let upright = Placement {
            origin: at(x, pocket),
            x_axis: at(0.0, 1.0),
        };
        let arm = arm(horn, POCKET * fit).into_iter();
        below.extend(arm.map(|shape| shape.placed(&upright)));
        for dot in 0..=column {
            let right = x + 1.6 + 1.6 * f64::from(dot % 3);
            let place = at(right, hole + 1.6 - 3.2 * f64::from(dot / 3));
            below.push(Shape::disc(place, 0.5));
        }
        let bore = ROD + 2.0 * fit;
        let outer = bore + 2.0 * parts.wall;
        walls.push(Shape::rectangle(at(x, sleeve), at(outer, SLEEVE), 0.5));
        bores.push(Shape::rectangle(at(x, sleeve), at(bore, 2.0 * SLEEVE), 0.0));
        roofs.push(THICK + parts.thickness + 2.0 * fit);
    }
    let mut prisms = vec![
        Prism::new([plate.clone()], floor, [0.0, FLOOR]),
        Prism::new([plate], below, [FLOOR, THICK]),
    ];
    // Each sleeve is two fits higher than the previous one, so its roof begins higher: each layer
    // has one bore less.
    let mut low = THICK;
    for (column, roof) in roofs.into_iter().enumerate() {
        prisms.push(Prism::new(&*walls, &bores[column..], [low, roof]));
        low = roof;
    }
    prisms.push(Prism::solid(walls, [low, low + 1.3]));
    let gauge = Shape::rectangle(at(0.0, 0.0), at(GAUGE, ROD), 1.0);
    let gauge = Prism::solid([gauge], [0.0, parts.thickness]);
    [
        Part::single("coupon", prisms),
        Part::single("coupon rod", vec![gauge]),
    ]
}
