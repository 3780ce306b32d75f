//! A fit coupon: a test piece, printed within an hour, that shows which `fit` a printer needs.
//!
//! Each column has its own fit, from 0.0 mm on the left to 0.4 mm on the right, marked by one to five dots. A column
//! consists of a screw's hole, a horn's pocket, a servo's opening with the notch for its lead, and a piece of a sleeve.
//! Use the fit of the first column from the left into which all counterparts go by hand.

use lizard_robot::Parts;

use crate::bodies::leads::{LEAD_SECTION, make_lead_notch};
use crate::bodies::links::{POCKET_FIT_FACTOR, make_horn_arm};
use crate::bodies::sliders::ROD_WIDTH;
use crate::layers::body::Prism;
use crate::layers::placement::Placement;
use crate::layers::shape::{Shape, vector};
use crate::part::Part;

/// Number of columns, each with its own fit.
const COLUMN_COUNT: u32 = 5;
/// Difference between the fits of adjacent columns, mm.
const FIT_STEP: f64 = 0.1;
/// Thickness of the coupon, mm.
const THICKNESS: f64 = 4.0;
/// Thickness of the pockets' floor, mm.
const FLOOR_THICKNESS: f64 = 1.8;
/// Length of a piece of a sleeve, mm.
const SLEEVE_LENGTH: f64 = 10.0;
/// Length of the piece of rod to try in a sleeve, mm.
const ROD_LENGTH: f64 = 30.0;

/// Builds the coupon, and a piece of rod to try in its sleeves.
pub fn build_coupon(parts: &Parts) -> [Part; 2] {
    let (servo, horn) = (&parts.servo, &parts.horn);
    // More than the largest fit.
    let fit_allowance = FIT_STEP * f64::from(COLUMN_COUNT);
    let pitch = servo.width + 2.0 * fit_allowance + 4.0;
    // Order from the lower edge up: opening, pocket, hole with dots, sleeve.
    let opening_y = 3.0 + LEAD_SECTION[1] + fit_allowance + servo.length / 2.0;
    let pocket_y = opening_y + servo.length / 2.0 + fit_allowance + 3.0 + horn.hub / 2.0;
    let hole_y = pocket_y + horn.arm + 5.0;
    let sleeve_y = hole_y + 6.0 + SLEEVE_LENGTH / 2.0;
    let top_y = sleeve_y + SLEEVE_LENGTH / 2.0 + 2.0;
    let width = pitch * f64::from(COLUMN_COUNT);
    let plate = Shape::rectangle(vector(width / 2.0, top_y / 2.0), vector(width, top_y), 2.0);
    let (mut floor_cuts, mut upper_cuts, mut walls, mut bores) = (vec![], vec![], vec![], vec![]);
    let mut roof_heights = Vec::new();
    for column in 0..COLUMN_COUNT {
        let fit = FIT_STEP * f64::from(column);
        let x = pitch * (f64::from(column) + 0.5);
        let case_size = vector(servo.width + 2.0 * fit, servo.length + 2.0 * fit);
        let through_holes = [
            Shape::disc(vector(x - 3.0, hole_y), (parts.screw.diameter + fit) / 2.0),
            Shape::rectangle(vector(x, opening_y), case_size, 0.0),
            make_lead_notch(servo, vector(x, opening_y), fit, -1.0),
        ];
        floor_cuts.extend(through_holes.iter().cloned());
        upper_cuts.extend(through_holes);
        floor_cuts.push(Shape::disc(vector(x, pocket_y), horn.hub / 2.0 + fit));
        let arm_placement = Placement::new(vector(x, pocket_y), vector(0.0, 1.0));
        let arm_shapes = make_horn_arm(horn, POCKET_FIT_FACTOR * fit).into_iter();
        upper_cuts.extend(arm_shapes.map(|shape| shape.placed(&arm_placement)));
        for dot in 0..=column {
            let dot_x = x + 1.6 + 1.6 * f64::from(dot % 3);
            let dot_position = vector(dot_x, hole_y + 1.6 - 3.2 * f64::from(dot / 3));
            upper_cuts.push(Shape::disc(dot_position, 0.5));
        }
        let (middle, bore_width) = (vector(x, sleeve_y), ROD_WIDTH + 2.0 * fit);
        let wall_size = vector(bore_width + 2.0 * parts.wall, SLEEVE_LENGTH);
        let bore_size = vector(bore_width, 2.0 * SLEEVE_LENGTH);
        walls.push(Shape::rectangle(middle, wall_size, 0.5));
        bores.push(Shape::rectangle(middle, bore_size, 0.0));
        roof_heights.push(THICKNESS + parts.thickness + 2.0 * fit);
    }
    let mut prisms = vec![
        Prism::new([plate.clone()], floor_cuts, [0.0, FLOOR_THICKNESS]),
        Prism::new([plate], upper_cuts, [FLOOR_THICKNESS, THICKNESS]),
    ];
    // Since the fit grows from column to column, each sleeve's roof begins higher than the previous sleeve's. Each
    // layer therefore has one bore fewer than the layer below it.
    let mut low = THICKNESS;
    for (column, roof_height) in roof_heights.into_iter().enumerate() {
        prisms.push(Prism::new(&*walls, &bores[column..], [low, roof_height]));
        low = roof_height;
    }
    prisms.push(Prism::solid(walls, [low, low + 1.3]));
    let rod = Shape::rectangle(vector(0.0, 0.0), vector(ROD_LENGTH, ROD_WIDTH), 1.0);
    let rod = Prism::solid([rod], [0.0, parts.thickness]);
    [
        Part::single("coupon", prisms),
        Part::single("coupon rod", vec![rod]),
    ]
}
