//! A renderer: makes the picture of the sheet and the robot that a camera would take, with noise, blur, distortion
//! and uneven light.
//!
//! It shares only the design of the sheet with the tested code: its camera follows rays and uses no matrices.

use std::f64::consts::PI;

use fastrand::Rng;
use lizard_film::{Picture, sheet};

/// Position on the floor and heading: mm, rad.
pub type Spot = [f64; 3];
type Vector = [f64; 3];

const BLACK: f64 = 35.0;
const PAPER: f64 = 205.0;
/// Half width and half length of the robot, mm.
const BODY: [f64; 2] = [75.0, 105.0];
/// Grey of the robot's top.
const BODY_GREY: f64 = 70.0;
/// Height of the robot's top, mm.
const BODY_HEIGHT: f64 = 55.0;
/// x coordinate of the edge about which the board is tilted, mm.
const TILT_EDGE: f64 = -200.0;
/// Samples of a pixel in each direction.
const PIXEL_SAMPLES: usize = 3;
/// Samples of the time for which the shutter is open.
const SHUTTER_SAMPLES: usize = 3;
/// Number of random numbers for the noise.
const NOISE_COUNT: usize = 1 << 16;
/// Number of successive pixels that use these random numbers in sequence.
const RUN_LENGTH: usize = 64;

/// The scene: the floor, the sheet and the camera.
#[derive(Clone)]
pub struct Studio {
    /// Width and height of the picture, pixels.
    pub size: [usize; 2],
    /// Focal length as a share of the picture's width.
    pub focal: f64,
    /// Distortion of the lens: the share by which it moves a point that is as far from the axis as the focal length.
    pub lens: f64,
    /// Height of the camera above the middle of the scene, mm.
    pub height: f64,
    /// Tilt of the camera's axis from straight down, deg.
    pub tilt: f64,
    /// Direction of the camera's axis on the floor, counter-clockwise from x, deg.
    pub direction: f64,
    /// Roll of the camera about its axis, deg.
    pub roll: f64,
    /// The point of the floor on the camera's axis, mm.
    pub aim: [f64; 2],
    /// Tilt of the board with strips and robot about its edge at x = `TILT_EDGE`, deg.
    pub board: f64,
    /// Places of the strips' middles.
    pub strips: [Spot; 2],
    /// Printed mm per designed mm, along a strip and across it.
    pub print: [f64; 2],
    /// Factor of the distance between a strip's tags; other than 1 if the strip was cut apart.
    pub cut: f64,
    /// Height of the deck tag, mm.
    pub deck: f64,
    /// Ids of tags that are covered.
    pub hidden: Vec<usize>,
    /// Round objects or reflections on the floor: x, y, radius, mm, and their grey.
    pub discs: Vec<[f64; 4]>,
    /// Exposure time, s.
    pub shutter: f64,
    /// Time from the first row to the last one, s.
    pub readout: f64,
    /// Light, as a share of normal light.
    pub light: f64,
    /// Standard deviation of the noise, grey levels.
    pub noise: f64,
    /// Grey of the floor.
    pub floor: f64,
    /// Loss of light from one corner of the picture to the opposite one, as a share.
    pub shade: f64,
}

impl Studio {
    /// A studio with a random camera on a tripod that sees both strips entirely.
    pub fn random(rng: &mut Rng) -> Self {
        loop {
            let studio = Self::random_camera(rng);
            if studio.sees_strips() {
                return studio;
            }
        }
    }

    /// True if the corners of both strips are in the picture.
    fn sees_strips(&self) -> bool {
        let view = self.view();
        let [length, width] = sheet::STRIP_SIZE.map(|length| length / 2.0);
        self.strips.iter().all(|&[x, y, heading]| {
            let (sin, cos) = heading.sin_cos();
            [
                [length, width],
                [length, -width],
                [-length, width],
                [-length, -width],
            ]
            .into_iter()
            .map(|[u, v]| view.image([x + u * cos - v * sin, y + u * sin + v * cos], 0.0))
            .all(|pixel| (0..2).all(|i| (0.0..self.size[i] as f64).contains(&pixel[i])))
        })
    }

    /// A studio with a random camera, whether or not it sees the strips.
    fn random_camera(rng: &mut Rng) -> Self {
        let mut random_between = |low: f64, high: f64| low + (high - low) * rng.f64();
        Self {
            size: [1280, 720],
            focal: random_between(0.72, 0.9),
            lens: random_between(-0.006, 0.006),
            height: random_between(700.0, 900.0),
            tilt: random_between(10.0, 35.0),
            direction: random_between(-180.0, 180.0),
            roll: random_between(-20.0, 20.0),
            aim: [random_between(-25.0, 25.0), random_between(-25.0, 25.0)],
            board: 0.0,
            strips: [
                [
                    random_between(-10.0, 10.0),
                    random_between(-165.0, -155.0),
                    random_between(-0.06, 0.06),
                ],
                [
                    random_between(-10.0, 10.0),
                    random_between(155.0, 165.0),
                    PI + random_between(-0.06, 0.06),
                ],
            ],
            print: [1.0; 2],
            cut: 1.0,
            deck: 83.0,
            hidden: Vec::new(),
            discs: Vec::new(),
            shutter: 1.0 / 80.0,
            readout: 0.0,
            light: 1.0,
            noise: 5.0,
            floor: random_between(90.0, 160.0),
            shade: random_between(0.0, 0.4),
        }
    }

    /// The camera's position and its axes (right, down, ahead), in the frame of the tilted board.
    fn camera(&self) -> (Vector, [Vector; 3]) {
        let (tilt, direction) = (self.tilt.to_radians(), self.direction.to_radians());
        let lean = [tilt.sin() * direction.cos(), tilt.sin() * direction.sin()];
        let ahead = [lean[0], lean[1], -tilt.cos()];
        let distance = self.height / tilt.cos();
        let eye = [
            self.aim[0] - distance * ahead[0],
            self.aim[1] - distance * ahead[1],
            self.height,
        ];
        // Level, then rolled about the axis.
        let level = [direction.sin(), -direction.cos(), 0.0];
        let down = cross(ahead, level);
        let (sin, cos) = self.roll.to_radians().sin_cos();
        let right = [0, 1, 2].map(|i| cos * level[i] + sin * down[i]);
        // The camera in the frame of the board.
        let [x, y, z] = self.on_board([eye[0] - TILT_EDGE, eye[1], eye[2]]);
        let axes = [right, cross(ahead, right), ahead].map(|axis| self.on_board(axis));
        ([x + TILT_EDGE, y, z], axes)
    }

    /// Converts a direction from the frame of the room to the frame of the tilted board.
    fn on_board(&self, [x, y, z]: Vector) -> Vector {
        let (sin, cos) = self.board.to_radians().sin_cos();
        [x * cos + z * sin, y, z * cos - x * sin]
    }

    fn view(&self) -> View {
        let (eye, axes) = self.camera();
        let [width, height] = self.size.map(|length| length as f64);
        View {
            eye,
            axes,
            focal: self.focal * width,
            lens: self.lens,
            middle: [(width - 1.0) / 2.0, (height - 1.0) / 2.0],
        }
    }

    /// The floor and the strips without the robot.
    pub fn background(&self, rng: &mut Rng) -> Background {
        let [width, height] = self.size;
        let view = self.view();
        let mut light = vec![0f32; width * height];
        for (i, light) in light.iter_mut().enumerate() {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            let middle = view.meet([x, y], 0.0);
            let is_near = (0..2).any(|strip| {
                let [u, v] = Turned::new(self.strips[strip]).local_point(middle);
                u.abs() < sheet::STRIP_SIZE[0] && v.abs() < sheet::STRIP_SIZE[1]
            });
            *light = match is_near {
                true => {
                    mean_of_samples(|dx, dy| self.floor_at(view.meet([x + dx, y + dy], 0.0))) as f32
                }
                false => self.floor as f32,
            };
        }
        Background {
            studio: self.clone(),
            view,
            light,
            noise: (0..NOISE_COUNT)
                .map(|_| (self.noise * normal(rng)) as f32)
                .collect(),
        }
    }

    /// The grey of a point of the floor.
    fn floor_at(&self, point: [f64; 2]) -> f64 {
        let is_in_disc =
            |[x, y, radius, _]: &&[f64; 4]| (point[0] - x).hypot(point[1] - y) < *radius;
        if let Some([.., grey]) = self.discs.iter().find(is_in_disc) {
            return *grey;
        }
        for (strip, spot) in self.strips.iter().enumerate() {
            let [u, v] = Turned::new(*spot).local_point(point);
            let [u, v] = [u / self.print[0], v / self.print[1]];
            if u.abs() > sheet::STRIP_SIZE[0] / 2.0 || v.abs() > sheet::STRIP_SIZE[1] / 2.0 {
                continue;
            }
            for id in 2 * strip..2 * strip + 2 {
                let [x, y] = sheet::middle_on_strip(id);
                if let Some(grey) = tag_grey(id, [u - self.cut * x, v - y]) {
                    return if self.hidden.contains(&id) {
                        BLACK
                    } else {
                        grey
                    };
                }
            }
            return PAPER;
        }
        self.floor
    }

    /// The grey of a point of the robot's card, given to the right and ahead of the middle of its tag.
    fn card_at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let [x, y] = [x / self.print[0], y / self.print[1]];
        let low = -sheet::DECK_TAG_EDGE / 2.0 - sheet::CARD_MARGIN;
        if x.abs() > sheet::CARD_SIZE[0] / 2.0 || y < low || y > low + sheet::CARD_SIZE[1] {
            return None;
        }
        Some(match tag_grey(sheet::DECK_TAG_ID, [x, y]) {
            Some(_) if self.hidden.contains(&sheet::DECK_TAG_ID) => PAPER,
            Some(grey) => grey,
            None => PAPER,
        })
    }
}

/// The picture of a studio without the robot.
pub struct Background {
    studio: Studio,
    view: View,
    light: Vec<f32>,
    /// Random numbers for the noise; each run of successive pixels begins at another index.
    noise: Vec<f32>,
}

struct View {
    eye: Vector,
    axes: [Vector; 3],
    focal: f64,
    lens: f64,
    middle: [f64; 2],
}

impl View {
    /// The point at a height that a pixel shows: the intersection of the pixel's ray with the plane at that height.
    fn meet(&self, [x, y]: [f64; 2], height: f64) -> [f64; 2] {
        let distorted = [
            (x - self.middle[0]) / self.focal,
            (y - self.middle[1]) / self.focal,
        ];
        // Inverts the distortion of the lens by iteration, which converges fast since the distortion is small.
        let [mut u, mut v] = distorted;
        for _ in 0..3 {
            let factor = self.bend(u, v);
            [u, v] = [distorted[0] / factor, distorted[1] / factor];
        }
        let [right, down, ahead] = &self.axes;
        let ray = [0, 1, 2].map(|i| ahead[i] + u * right[i] + v * down[i]);
        let distance = (height - self.eye[2]) / ray[2];
        [
            self.eye[0] + distance * ray[0],
            self.eye[1] + distance * ray[1],
        ]
    }

    /// The pixel that shows a point at a height.
    fn image(&self, [x, y]: [f64; 2], height: f64) -> [f64; 2] {
        let offset = [x - self.eye[0], y - self.eye[1], height - self.eye[2]];
        let component_along = |axis: &Vector| (0..3).map(|i| axis[i] * offset[i]).sum::<f64>();
        let [right, down, ahead] = &self.axes;
        let [u, v] = [
            component_along(right) / component_along(ahead),
            component_along(down) / component_along(ahead),
        ];
        let distance = self.focal * self.bend(u, v);
        [self.middle[0] + distance * u, self.middle[1] + distance * v]
    }

    /// The factor by which the lens moves a point away from the axis.
    fn bend(&self, u: f64, v: f64) -> f64 {
        1.0 + self.lens * (u * u + v * v)
    }
}

impl Background {
    /// The picture with the robot, with the exposure centred on this time.
    pub fn picture(&self, seconds: f64, robot: impl Fn(f64) -> Spot, rng: &mut Rng) -> Picture {
        let studio = &self.studio;
        let [width, height] = studio.size;
        let mut light = self.light.clone();
        // The places of the robot while the shutter is open for a row.
        let spots_in_row = |row: usize| -> [Turned; SHUTTER_SAMPLES] {
            let row_delay = (row as f64 / height as f64 - 0.5) * studio.readout;
            std::array::from_fn(|i| {
                let shutter_delay =
                    ((i as f64 + 0.5) / SHUTTER_SAMPLES as f64 - 0.5) * studio.shutter;
                Turned::new(robot(seconds + row_delay + shutter_delay))
            })
        };
        let rows: Vec<_> = (0..height).map(spots_in_row).collect();
        let middle_spot = rows[height / 2][SHUTTER_SAMPLES / 2];
        let body = [(BODY[0] + 5.0), (BODY[1] + 5.0)];
        self.for_each_pixel(middle_spot, body, BODY_HEIGHT, |i, [x, y]| {
            let [u, v] = middle_spot.robot_point(self.view.meet([x, y], BODY_HEIGHT));
            if u.abs() < BODY[0] && v.abs() < BODY[1] {
                light[i] = BODY_GREY as f32;
            }
        });
        let card = [
            sheet::CARD_SIZE[0] / 2.0 + 2.0,
            sheet::CARD_SIZE[1] - sheet::DECK_TAG_EDGE / 2.0 + 2.0,
        ];
        self.for_each_pixel(middle_spot, card, studio.deck, |i, [x, y]| {
            let spots = &rows[i / width];
            let background_grey = f64::from(light[i]);
            let grey_of = |spot: &Turned| {
                mean_of_samples(|dx, dy| {
                    let point = spot.robot_point(self.view.meet([x + dx, y + dy], studio.deck));
                    studio.card_at(point).unwrap_or(background_grey)
                })
            };
            light[i] = (spots.iter().map(grey_of).sum::<f64>() / SHUTTER_SAMPLES as f64) as f32;
        });
        let mut grey = Vec::with_capacity(light.len());
        for (i, pixels) in light.chunks(RUN_LENGTH).enumerate() {
            let (row, column) = (i * RUN_LENGTH / width, i * RUN_LENGTH % width);
            let share = (row as f64 / height as f64 + column as f64 / width as f64) / 2.0;
            let shade = (studio.light * (1.0 - studio.shade * share)) as f32;
            let noise = &self.noise[rng.usize(..NOISE_COUNT - RUN_LENGTH)..];
            grey.extend(
                pixels
                    .iter()
                    .zip(noise)
                    .map(|(light, noise)| (light * shade + noise + 0.5) as u8),
            );
        }
        Picture::new(width, height, grey).expect("all rows")
    }

    /// Calls a function for every pixel around a part of the robot, with the pixel's index and its column and row.
    fn for_each_pixel(
        &self,
        Turned([x, y], [cos, sin]): Turned,
        half: [f64; 2],
        height: f64,
        mut visit: impl FnMut(usize, [f64; 2]),
    ) {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]| {
            let (right, ahead) = (a * half[0], b * half[1]);
            let floor = [x + ahead * cos + right * sin, y + ahead * sin - right * cos];
            self.view.image(floor, height)
        });
        let size = self.studio.size;
        let range_of = |i: usize| {
            let low = corners
                .iter()
                .map(|corner| corner[i])
                .fold(f64::INFINITY, f64::min);
            let high = corners.iter().map(|corner| corner[i]).fold(0.0, f64::max);
            (low.max(0.0) as usize)..((high + 1.0).max(0.0) as usize).min(size[i])
        };
        for row in range_of(1) {
            for column in range_of(0) {
                visit(row * size[0] + column, [column as f64, row as f64]);
            }
        }
    }
}

/// The mean over the samples of a pixel.
fn mean_of_samples(sample: impl Fn(f64, f64) -> f64) -> f64 {
    let offset = |i: usize| (i as f64 + 0.5) / PIXEL_SAMPLES as f64 - 0.5;
    let values = (0..PIXEL_SAMPLES * PIXEL_SAMPLES)
        .map(|i| sample(offset(i % PIXEL_SAMPLES), offset(i / PIXEL_SAMPLES)));
    values.sum::<f64>() / (PIXEL_SAMPLES * PIXEL_SAMPLES) as f64
}

/// The grey of a tag at a point relative to its middle; `None` outside of the tag.
fn tag_grey(id: usize, [x, y]: [f64; 2]) -> Option<f64> {
    let square = sheet::tag_edge(id) / sheet::SQUARES_PER_SIDE as f64;
    let half = sheet::SQUARES_PER_SIDE as f64 / 2.0;
    let (column, row) = ((x / square + half).floor(), (half - y / square).floor());
    let tag_range = 0.0..sheet::SQUARES_PER_SIDE as f64;
    let is_inside = tag_range.contains(&column) && tag_range.contains(&row);
    is_inside.then(
        || match sheet::is_white(id, row as usize, column as usize) {
            true => PAPER,
            false => BLACK,
        },
    )
}

/// A place: a point, and the cosine and sine of its heading.
#[derive(Clone, Copy)]
struct Turned([f64; 2], [f64; 2]);

impl Turned {
    fn new([x, y, heading]: Spot) -> Self {
        Self([x, y], [heading.cos(), heading.sin()])
    }

    /// Converts a point of the floor to this place's frame: along the heading, and to the left.
    fn local_point(&self, point: [f64; 2]) -> [f64; 2] {
        let Self([x, y], [cos, sin]) = self;
        let (dx, dy) = (point[0] - x, point[1] - y);
        [dx * cos + dy * sin, dy * cos - dx * sin]
    }

    /// Converts a point of the floor to the robot's frame: right, ahead.
    fn robot_point(&self, point: [f64; 2]) -> [f64; 2] {
        let [ahead, left] = self.local_point(point);
        [-left, ahead]
    }
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A random number with a standard normal distribution.
pub fn normal(rng: &mut Rng) -> f64 {
    (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0
}
