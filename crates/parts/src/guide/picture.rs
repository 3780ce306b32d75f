//! A perspective drawing of the robot, or of some of its bodies.
//!
//! Every body is a stack of flat layers, so the drawing order needs no search. Every height at which a layer begins or
//! ends cuts space into slices, which are drawn from the lowest to the highest. In each slice, the walls are drawn from
//! far to near, then the tops: a wall never rises above its own slice, so it cannot hide a top of that slice.

use lizard_kinematics::{Solution, Vector, sin_cos};

use crate::bodies::assembly::Assembly;
use crate::layers::body::{Body, Kind, Mount};
use crate::layers::outline::{Loop, Outline};

use super::drawing::{Drawing, Frame, Label, Ring};

/// A body in a picture.
#[derive(Clone, Copy, Debug)]
pub struct PictureBody<'a> {
    /// The body to draw.
    pub body: &'a Body,
    /// Lift of the body in the picture, mm.
    pub lift: f64,
    /// True to draw the body in grey, as the background of the bodies in colour.
    pub is_grey: bool,
}

impl<'a> PictureBody<'a> {
    /// Creates a body without a lift, grey or in colour.
    pub fn without_lift(body: &'a Body, is_grey: bool) -> Self {
        Self {
            body,
            lift: 0.0,
            is_grey,
        }
    }
}

/// A view of the robot.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Direction of the eye in plan view, deg, counter-clockwise from the robot's right.
    pub azimuth: f64,
    /// Elevation of the eye above the floor, deg.
    pub elevation: f64,
    /// Width of the picture, pixels.
    pub width: f64,
    /// True to show the robot from below, flipped about its long axis.
    pub is_from_below: bool,
    /// True to frame only the bodies in colour, with a margin around them.
    pub is_close_up: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            azimuth: 240.0,
            elevation: 38.0,
            width: 900.0,
            is_from_below: false,
            is_close_up: false,
        }
    }
}

/// Distance of the eye from the robot's middle, mm.
const EYE_DISTANCE: f64 = 900.0;
/// Largest angle that a chord spans, rad.
const MAX_CHORD_ANGLE: f64 = 0.55;
/// Smallest height of a slice, mm.
const MIN_SLICE_HEIGHT: f64 = 0.45;
/// Radius below which a hole is not drawn, mm, since a screw fills it. All holes of a lifted body in colour are drawn.
const HIDDEN_HOLE_RADIUS: f64 = 1.75;

/// Red, green and blue (0 to 255) of the bodies that servos A1 to A4 move: three colours from the palette of Okabe and
/// Ito, and a purple from Tol's.
const SERVO_COLOURS: [[f64; 3]; 4] = [
    [0.0, 114.0, 178.0],
    [213.0, 94.0, 0.0],
    [0.0, 158.0, 115.0],
    [170.0, 68.0, 153.0],
];

/// The eye, which looks at the robot's middle.
struct Eye {
    /// Unit vector to the right in the picture, in plan view.
    right: Vector,
    /// Unit vector from the robot's middle to the eye, in plan view.
    towards_eye: Vector,
    /// Sine of the eye's elevation.
    sin: f64,
    /// Cosine of the eye's elevation.
    cos: f64,
}

impl Eye {
    fn new(view: &View) -> Self {
        let towards_eye = Vector::from_angle(view.azimuth);
        let (sin, cos) = sin_cos(view.elevation);
        Self {
            right: towards_eye.rotated_left(),
            towards_eye,
            sin,
            cos,
        }
    }

    /// Projects a point in space onto the drawing. The result is in mm, before scaling; y points down.
    fn project(&self, point: Vector, z: f64) -> (f64, f64) {
        // Nearness is the distance from the robot's middle towards the eye, in plan view and along the line of sight.
        let (x, floor_nearness) = (point.dot(self.right), point.dot(self.towards_eye));
        let nearness = floor_nearness * self.cos + z * self.sin;
        let height = z * self.cos - floor_nearness * self.sin;
        let scale = EYE_DISTANCE / (EYE_DISTANCE - nearness);
        (x * scale, -height * scale)
    }

    /// Position of the eye in plan view.
    fn position(&self) -> Vector {
        self.towards_eye * (EYE_DISTANCE * self.cos)
    }
}

/// A wall: its distance from the eye, its outline and its colour.
type Wall = (f64, Ring, [f64; 3]);

/// A layer of a body in the picture.
struct Layer {
    colour: [f64; 3],
    /// True if the body is drawn in grey.
    is_grey: bool,
    /// Outer loops and holes as points, chassis frame, mm.
    loops: Vec<Vec<Vector>>,
    /// Lower and upper height, mm.
    z: [f64; 2],
}

/// Draws bodies at a pose, with labels, as SVG.
pub fn draw_picture(
    assembly: &Assembly,
    picture_bodies: &[PictureBody],
    pose: &Solution,
    view: &View,
    labels: &[Label],
) -> String {
    let eye = Eye::new(view);
    let mut layers = collect_layers(assembly, picture_bodies, pose);
    if view.is_from_below {
        for layer in &mut layers {
            layer.flip();
        }
    }
    let heights = merge_heights(&mut layers);
    let mut drawing = Drawing::default();
    for slice in heights.windows(2) {
        let [low, high] = [slice[0], slice[1]];
        let covers_slice = |layer: &&Layer| layer.z[0] < low + 1e-6 && layer.z[1] > high - 1e-6;
        let slice_layers = || layers.iter().filter(covers_slice);
        let mut walls: Vec<Wall> = Vec::new();
        for layer in slice_layers() {
            for layer_loop in &layer.loops {
                layer.add_walls(layer_loop, &eye, [low, high], &mut walls);
            }
        }
        walls.sort_by(|(a, ..), (b, ..)| b.total_cmp(a));
        for (_, ring, colour) in walls {
            drawing.draw_polygon(vec![ring], colour, false);
        }
        for layer in slice_layers() {
            if layer.z[1] < high + 1e-6 && !layer.loops.is_empty() {
                let to_ring = |layer_loop: &Vec<Vector>| -> Ring {
                    let points = layer_loop.iter();
                    points.map(|point| eye.project(*point, high)).collect()
                };
                let rings = layer.loops.iter().map(to_ring).collect();
                drawing.draw_polygon(rings, layer.colour, true);
            }
        }
    }
    // The frame encloses all bodies, or in a close-up the bodies in colour.
    let is_framed = |layer: &&Layer| !view.is_close_up || !layer.is_grey;
    let framed_layers = layers.iter().filter(is_framed);
    let points = framed_layers.flat_map(|layer| {
        let loop_points = layer.loops.iter().flatten();
        loop_points.flat_map(|point| layer.z.map(|z| eye.project(*point, z)))
    });
    let project_label = |label: &Label| match view.is_from_below {
        true => eye.project(flip_point(label.position), -label.z),
        false => eye.project(label.position, label.z),
    };
    let labels = labels.iter().map(|label| (project_label(label), label));
    let placed_labels: Vec<_> = labels.collect();
    let frame = Frame::around(points, view.is_close_up);
    drawing.into_svg(view.width, &frame, &placed_labels)
}

/// Flips a point about the robot's long axis.
fn flip_point(point: Vector) -> Vector {
    Vector::new(-point.x, point.y)
}

/// Returns the heights at which layers begin or end. Merges heights that are less than [`MIN_SLICE_HEIGHT`] apart, and
/// moves the layers to the merged height.
fn merge_heights(layers: &mut [Layer]) -> Vec<f64> {
    let mut heights: Vec<f64> = layers.iter().flat_map(|layer| layer.z).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup_by(|b, a| *b - *a < MIN_SLICE_HEIGHT);
    for layer in layers {
        for z in &mut layer.z {
            let index = heights.partition_point(|height| *height <= *z + 1e-9);
            *z = heights[index.saturating_sub(1)];
        }
    }
    heights
}

/// Collects the layers of the bodies at a pose, without the loops that are not drawn.
fn collect_layers(
    assembly: &Assembly,
    picture_bodies: &[PictureBody],
    pose: &Solution,
) -> Vec<Layer> {
    let mut layers = Vec::new();
    for picture_body in picture_bodies {
        let (body, lift, is_grey) = (picture_body.body, picture_body.lift, picture_body.is_grey);
        let placement = assembly.placement(body.mount, pose);
        let colour = select_colour(body, is_grey);
        for prism in &body.prisms {
            let outline = Outline::from_prism(prism);
            let hides_small_holes = is_grey || lift == 0.0;
            let is_drawn = |outline_loop: &&Loop| {
                let circle = outline_loop.circle();
                let is_small = circle.is_some_and(|(_, radius)| radius < HIDDEN_HOLE_RADIUS);
                let is_hole = outline_loop.area() < 0.0;
                !(hides_small_holes && is_hole && is_small)
            };
            let to_placed_points = |outline_loop: &Loop| {
                let points = divide_loop(outline_loop).into_iter();
                points.map(|point| placement.map(point)).collect()
            };
            let loops = outline.loops().filter(is_drawn);
            layers.push(Layer {
                colour,
                is_grey,
                loops: loops.map(to_placed_points).collect(),
                z: prism.z.map(|z| z + lift),
            });
        }
    }
    layers
}

/// Returns the points of a loop, with arcs divided into chords.
fn divide_loop(outline_loop: &Loop) -> Vec<Vector> {
    let mut points = Vec::new();
    for (side, to) in outline_loop.sides_with_end_points() {
        points.push(side.from);
        points.extend(side.division_points(to, |_, angle| (angle / MAX_CHORD_ANGLE).ceil() as u32));
    }
    points
}

impl Layer {
    /// Flips the layer about the robot's long axis; the loops keep the material on their left.
    fn flip(&mut self) {
        for layer_loop in &mut self.loops {
            for point in layer_loop.iter_mut() {
                *point = flip_point(*point);
            }
            layer_loop.reverse();
        }
        let [low, high] = self.z;
        self.z = [-high, -low];
    }

    /// Adds the visible walls of a loop; adjacent walls of equal shade become one wall.
    fn add_walls(
        &self,
        layer_loop: &[Vector],
        eye: &Eye,
        [low, high]: [f64; 2],
        walls: &mut Vec<Wall>,
    ) {
        let n = layer_loop.len();
        let compute_shade = |i: usize| {
            let (a, b) = (layer_loop[i], layer_loop[(i + 1) % n]);
            let normal = (b - a).rotated_right();
            let is_visible = normal.dot(eye.position() - a) > 0.0;
            let length = normal.length();
            // The light comes from the eye's left.
            let light = (eye.towards_eye + eye.right * -0.8).dot(normal) / (1.3 * length.max(1e-9));
            is_visible.then(|| (4.0 * light.clamp(0.0, 1.0)).round() as i32)
        };
        let mut i = 0;
        while i < n {
            let Some(shade) = compute_shade(i) else {
                i += 1;
                continue;
            };
            let mut chain = vec![layer_loop[i]];
            while i < n && compute_shade(i) == Some(shade) {
                chain.push(layer_loop[(i + 1) % n]);
                i += 1;
            }
            let distances = chain.iter().map(|point| (eye.position() - *point).length());
            let distance = distances.sum::<f64>() / chain.len() as f64;
            let mut ring: Ring = chain.iter().map(|point| eye.project(*point, low)).collect();
            ring.extend(chain.iter().rev().map(|point| eye.project(*point, high)));
            let brightness = 0.5 + 0.09 * f64::from(shade);
            let colour = self.colour.map(|channel| channel * brightness);
            walls.push((distance, ring, colour));
        }
    }
}

/// Selects the colour of a body.
fn select_colour(body: &Body, is_grey: bool) -> [f64; 3] {
    if is_grey {
        return [222.0, 222.0, 218.0];
    }
    match (body.kind, body.mount.servo()) {
        (Kind::Printed, Some(servo)) => SERVO_COLOURS[servo].map(|channel| 0.72 * channel + 70.0),
        (Kind::Printed, None) if body.mount == Mount::Chassis => [236.0, 224.0, 190.0],
        (Kind::Printed, None) => [240.0, 228.0, 66.0],
        (Kind::Servo, _) => [70.0, 110.0, 200.0],
        (Kind::Horn, _) => [250.0, 250.0, 250.0],
        (Kind::Board, _) => [20.0, 130.0, 135.0],
        (Kind::Battery, _) => [120.0, 120.0, 130.0],
        (Kind::Pad, _) => [90.0, 90.0, 94.0],
        _ => [170.0, 170.0, 176.0],
    }
}
