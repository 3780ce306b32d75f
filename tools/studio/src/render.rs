//! Renders frames of the sheet and the robot as a camera would take them, with noise, blur, distortion and uneven
//! light.
//!
//! The renderer and the tested code have only the design of the sheet in common: the renderer traces rays and uses no
//! matrices.

use std::f64::consts::PI;

use fastrand::Rng;
use lizard_video::{Frame, sheet};

/// Position on the floor and heading: mm, mm, rad.
pub type Pose = [f64; 3];
type Vector = [f64; 3];

/// Grey of the black cells of a tag.
const BLACK_GREY: f64 = 35.0;
/// Grey of the paper.
const PAPER_GREY: f64 = 205.0;
/// Half width and half length of the robot, mm.
const BODY_HALF_SIZE: [f64; 2] = [75.0, 105.0];
/// Grey of the robot's top.
const BODY_GREY: f64 = 70.0;
/// Height of the robot's top above the floor, mm. The card, at `Studio::deck_tag_height`, is drawn over it.
const BODY_HEIGHT_MM: f64 = 55.0;
/// x coordinate of the edge about which the board is tilted, mm.
const TILT_EDGE_X_MM: f64 = -200.0;
/// Number of samples of a pixel in each direction.
const PIXEL_SAMPLES: usize = 3;
/// Number of samples of the exposure time.
const SHUTTER_SAMPLES: usize = 3;
/// Number of random numbers for the noise.
const NOISE_COUNT: usize = 1 << 16;
/// Number of successive pixels that use one run of random numbers.
const NOISE_RUN_LENGTH: usize = 64;

/// The studio: a board as the floor, the two strips of the sheet, and the camera. The robot carries the sheet's card
/// with the deck tag.
#[derive(Clone)]
pub struct Studio {
    /// Width and height of the frame, pixels.
    pub size: [usize; 2],
    /// Focal length as a fraction of the frame's width.
    pub focal_length: f64,
    /// Distortion of the lens: the relative displacement of an image point at a distance of one focal length from the
    /// axis.
    pub distortion: f64,
    /// Height of the camera above the floor, mm.
    pub camera_height: f64,
    /// Tilt of the camera's axis from straight down, deg.
    pub camera_tilt: f64,
    /// Direction of the camera's axis on the floor, counter-clockwise from x, deg.
    pub camera_direction: f64,
    /// Roll of the camera about its axis, deg.
    pub camera_roll: f64,
    /// The point where the camera's axis meets the floor, mm.
    pub aim: [f64; 2],
    /// Tilt of the board about its edge at x = `TILT_EDGE_X_MM`, deg. The strips and the robot are on the board.
    pub board_tilt: f64,
    /// Poses of the strips' centres.
    pub strips: [Pose; 2],
    /// Printed mm per designed mm, along a strip and across it.
    pub print_scale: [f64; 2],
    /// Ratio of the true to the designed distance between a strip's tags; 1 unless the strip was cut apart.
    pub tag_distance_factor: f64,
    /// Height of the deck tag, mm.
    pub deck_tag_height: f64,
    /// Ids of the tags that are covered.
    pub covered_tags: Vec<usize>,
    /// Round objects or reflections on the floor: x, y, radius, mm, and their grey.
    pub discs: Vec<[f64; 4]>,
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Time from the first row to the last one, s.
    pub readout_s: f64,
    /// Light, as a fraction of normal light.
    pub light: f64,
    /// Standard deviation of the noise, grey levels.
    pub noise: f64,
    /// Grey of the floor.
    pub floor_grey: f64,
    /// Loss of light from one corner of the frame to the opposite one, as a fraction.
    pub shading: f64,
}

impl Studio {
    /// Returns a studio with a random camera that sees both strips completely.
    pub fn random(rng: &mut Rng) -> Self {
        loop {
            let studio = Self::with_random_camera(rng);
            if studio.sees_strips() {
                return studio;
            }
        }
    }

    /// True if the corners of both strips are in the frame.
    fn sees_strips(&self) -> bool {
        let optics = self.optics();
        let [half_length, half_width] = sheet::STRIP_SIZE.map(|length| length / 2.0);
        self.strips.iter().all(|&[x, y, heading]| {
            let (sin, cos) = heading.sin_cos();
            let corners =
                [half_length, -half_length].map(|u| [half_width, -half_width].map(|v| [u, v]));
            corners.into_iter().flatten().all(|[u, v]| {
                let pixel = optics.project([x + u * cos - v * sin, y + u * sin + v * cos], 0.0);
                (0..2).all(|i| (0.0..self.size[i] as f64).contains(&pixel[i]))
            })
        })
    }

    /// Returns a studio with a random camera, which may not see the strips.
    fn with_random_camera(rng: &mut Rng) -> Self {
        let mut random_between = |min: f64, max: f64| min + (max - min) * rng.f64();
        Self {
            size: [1280, 720],
            focal_length: random_between(0.72, 0.9),
            distortion: random_between(-0.006, 0.006),
            camera_height: random_between(700.0, 900.0),
            camera_tilt: random_between(10.0, 35.0),
            camera_direction: random_between(-180.0, 180.0),
            camera_roll: random_between(-20.0, 20.0),
            aim: [random_between(-25.0, 25.0), random_between(-25.0, 25.0)],
            board_tilt: 0.0,
            strips: [(-160.0, 0.0), (160.0, PI)].map(|(y, heading)| {
                [
                    random_between(-10.0, 10.0),
                    random_between(y - 5.0, y + 5.0),
                    heading + random_between(-0.06, 0.06),
                ]
            }),
            print_scale: [1.0; 2],
            tag_distance_factor: 1.0,
            deck_tag_height: 83.0,
            covered_tags: Vec::new(),
            discs: Vec::new(),
            exposure_s: 1.0 / 80.0,
            readout_s: 0.0,
            light: 1.0,
            noise: 5.0,
            floor_grey: random_between(90.0, 160.0),
            shading: random_between(0.0, 0.4),
        }
    }

    /// Makes the camera look at the origin from this height and tilt, with the strips level in the frame.
    pub fn aim_camera(&mut self, camera_height: f64, camera_tilt: f64) {
        (self.camera_height, self.camera_tilt) = (camera_height, camera_tilt);
        (self.camera_direction, self.camera_roll) = (90.0, 0.0);
        self.aim = [0.0; 2];
    }

    /// Returns the camera's optics, in the axes of the tilted board.
    fn optics(&self) -> Optics {
        let [tilt, direction] = [self.camera_tilt, self.camera_direction].map(f64::to_radians);
        let horizontal = [tilt.sin() * direction.cos(), tilt.sin() * direction.sin()];
        let forward = [horizontal[0], horizontal[1], -tilt.cos()];
        let distance = self.camera_height / tilt.cos();
        let [eye_x, eye_y] = [0, 1].map(|i| self.aim[i] - distance * forward[i]);
        let eye_from_edge = [eye_x - TILT_EDGE_X_MM, eye_y, self.camera_height];
        // The axis to the right is level before the roll.
        let level_right = [direction.sin(), -direction.cos(), 0.0];
        let down = cross_product(forward, level_right);
        let (sin, cos) = self.camera_roll.to_radians().sin_cos();
        let right = [0, 1, 2].map(|i| cos * level_right[i] + sin * down[i]);
        let [x, y, z] = self.to_board_axes(eye_from_edge);
        let axes = [right, cross_product(forward, right), forward];
        Optics {
            eye: [x + TILT_EDGE_X_MM, y, z],
            axes: axes.map(|axis| self.to_board_axes(axis)),
            focal_length_px: self.focal_length * self.size[0] as f64,
            distortion: self.distortion,
            image_centre: self.size.map(|length| (length as f64 - 1.0) / 2.0),
        }
    }

    /// Converts a direction from the room's axes to the axes of the tilted board.
    fn to_board_axes(&self, [x, y, z]: Vector) -> Vector {
        let (sin, cos) = self.board_tilt.to_radians().sin_cos();
        [x * cos + z * sin, y, z * cos - x * sin]
    }

    /// Renders the floor and the strips without the robot.
    pub fn render_background(&self, rng: &mut Rng) -> Background {
        let [width, height] = self.size;
        let optics = self.optics();
        let grey_of_pixel = |i: usize| {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            let pixel_centre = optics.point_at_height([x, y], 0.0);
            let is_near_strip = (0..2).any(|strip| {
                let [u, v] = LocalAxes::new(self.strips[strip]).to_local(pixel_centre);
                u.abs() < sheet::STRIP_SIZE[0] && v.abs() < sheet::STRIP_SIZE[1]
            });
            if !is_near_strip {
                return self.floor_grey as f32;
            }
            average_over_pixel(|dx, dy| {
                self.floor_grey_at(optics.point_at_height([x + dx, y + dy], 0.0))
            }) as f32
        };
        let noise = (0..NOISE_COUNT).map(|_| (self.noise * random_normal(rng)) as f32);
        Background {
            studio: self.clone(),
            grey_levels: (0..width * height).map(grey_of_pixel).collect(),
            optics,
            noise: noise.collect(),
        }
    }

    /// Returns the grey of a point of the floor.
    fn floor_grey_at(&self, point: [f64; 2]) -> f64 {
        let is_in_disc =
            |[x, y, radius, _]: &&[f64; 4]| (point[0] - x).hypot(point[1] - y) < *radius;
        if let Some([.., grey]) = self.discs.iter().find(is_in_disc) {
            return *grey;
        }
        for (strip, pose) in self.strips.iter().enumerate() {
            let [u, v] = LocalAxes::new(*pose).to_local(point);
            let [u, v] = [u / self.print_scale[0], v / self.print_scale[1]];
            if u.abs() > sheet::STRIP_SIZE[0] / 2.0 || v.abs() > sheet::STRIP_SIZE[1] / 2.0 {
                continue;
            }
            for id in 2 * strip..2 * strip + 2 {
                let [x, y] = sheet::centre_on_strip(id);
                if let Some(grey) = tag_grey_at(id, [u - self.tag_distance_factor * x, v - y]) {
                    let is_covered = self.covered_tags.contains(&id);
                    return if is_covered { BLACK_GREY } else { grey };
                }
            }
            return PAPER_GREY;
        }
        self.floor_grey
    }

    /// Returns the grey of a point on the robot's card; `None` outside the card. The point's coordinates are relative
    /// to the tag's centre: to the right, and forward.
    fn card_grey_at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let [x, y] = [x / self.print_scale[0], y / self.print_scale[1]];
        let min_y = -sheet::DECK_TAG_EDGE / 2.0 - sheet::CARD_MARGIN;
        if x.abs() > sheet::CARD_SIZE[0] / 2.0 || y < min_y || y > min_y + sheet::CARD_SIZE[1] {
            return None;
        }
        let is_covered = self.covered_tags.contains(&sheet::DECK_TAG_ID);
        let tag_grey = tag_grey_at(sheet::DECK_TAG_ID, [x, y]).filter(|_| !is_covered);
        Some(tag_grey.unwrap_or(PAPER_GREY))
    }
}

/// A rendered studio without the robot.
pub struct Background {
    studio: Studio,
    optics: Optics,
    grey_levels: Vec<f32>,
    /// Random numbers for the noise; each run of successive pixels starts at a random index.
    noise: Vec<f32>,
}

/// The optics of the camera: converts between pixels and points.
struct Optics {
    /// The camera's position.
    eye: Vector,
    /// The camera's axes: right, down, forward.
    axes: [Vector; 3],
    focal_length_px: f64,
    distortion: f64,
    image_centre: [f64; 2],
}

impl Optics {
    /// Returns the point that a pixel shows at a height: the intersection of the pixel's ray with the plane at that
    /// height.
    fn point_at_height(&self, pixel: [f64; 2], height: f64) -> [f64; 2] {
        let distorted = [0, 1].map(|i| (pixel[i] - self.image_centre[i]) / self.focal_length_px);
        // Inverts the lens distortion by iteration, which converges fast because the distortion is small.
        let [mut u, mut v] = distorted;
        for _ in 0..3 {
            let factor = self.distortion_factor(u, v);
            [u, v] = [distorted[0] / factor, distorted[1] / factor];
        }
        let [right, down, forward] = &self.axes;
        let ray = [0, 1, 2].map(|i| forward[i] + u * right[i] + v * down[i]);
        let depth = (height - self.eye[2]) / ray[2];
        [0, 1].map(|i| self.eye[i] + depth * ray[i])
    }

    /// Returns the pixel that shows a point at a height.
    fn project(&self, [x, y]: [f64; 2], height: f64) -> [f64; 2] {
        let offset = [x - self.eye[0], y - self.eye[1], height - self.eye[2]];
        let component_along = |axis: Vector| (0..3).map(|i| axis[i] * offset[i]).sum::<f64>();
        let [right, down, depth] = self.axes.map(component_along);
        let [u, v] = [right / depth, down / depth];
        let scale = self.focal_length_px * self.distortion_factor(u, v);
        let [x, y] = self.image_centre;
        [x + scale * u, y + scale * v]
    }

    /// Returns the factor by which the lens changes a point's distance from the axis.
    fn distortion_factor(&self, u: f64, v: f64) -> f64 {
        1.0 + self.distortion * (u * u + v * v)
    }
}

impl Background {
    /// Renders a frame with the robot; `time_s` is the middle of the exposure. `pose_at` returns the robot's pose at a
    /// time.
    pub fn render_frame(&self, time_s: f64, pose_at: impl Fn(f64) -> Pose, rng: &mut Rng) -> Frame {
        let studio = &self.studio;
        let [width, height] = studio.size;
        let mut grey_levels = self.grey_levels.clone();
        // The axes of the robot during the exposure of a row.
        let axes_in_row = |row: usize| -> [LocalAxes; SHUTTER_SAMPLES] {
            let row_delay = (row as f64 / height as f64 - 0.5) * studio.readout_s;
            std::array::from_fn(|i| {
                let shutter_delay =
                    ((i as f64 + 0.5) / SHUTTER_SAMPLES as f64 - 0.5) * studio.exposure_s;
                LocalAxes::new(pose_at(time_s + row_delay + shutter_delay))
            })
        };
        let rows: Vec<_> = (0..height).map(axes_in_row).collect();
        let middle_axes = rows[height / 2][SHUTTER_SAMPLES / 2];
        let body_extent = BODY_HALF_SIZE.map(|length| length + 5.0);
        self.for_each_pixel(middle_axes, body_extent, BODY_HEIGHT_MM, |i, [x, y]| {
            let [u, v] = middle_axes.to_robot(self.optics.point_at_height([x, y], BODY_HEIGHT_MM));
            if u.abs() < BODY_HALF_SIZE[0] && v.abs() < BODY_HALF_SIZE[1] {
                grey_levels[i] = BODY_GREY as f32;
            }
        });
        let card_extent = [
            sheet::CARD_SIZE[0] / 2.0 + 2.0,
            sheet::CARD_SIZE[1] - sheet::DECK_TAG_EDGE / 2.0 + 2.0,
        ];
        let card_height = studio.deck_tag_height;
        self.for_each_pixel(middle_axes, card_extent, card_height, |i, [x, y]| {
            let background_grey = f64::from(grey_levels[i]);
            let card_grey = |axes: &LocalAxes| {
                average_over_pixel(|dx, dy| {
                    let point = self.optics.point_at_height([x + dx, y + dy], card_height);
                    let grey = studio.card_grey_at(axes.to_robot(point));
                    grey.unwrap_or(background_grey)
                })
            };
            let card_greys = rows[i / width].iter().map(card_grey);
            grey_levels[i] = (card_greys.sum::<f64>() / SHUTTER_SAMPLES as f64) as f32;
        });
        let mut grey = Vec::with_capacity(grey_levels.len());
        for (i, pixels) in grey_levels.chunks(NOISE_RUN_LENGTH).enumerate() {
            let (row, column) = (i * NOISE_RUN_LENGTH / width, i * NOISE_RUN_LENGTH % width);
            let diagonal_fraction =
                (row as f64 / height as f64 + column as f64 / width as f64) / 2.0;
            let brightness = (studio.light * (1.0 - studio.shading * diagonal_fraction)) as f32;
            let noise = &self.noise[rng.usize(..NOISE_COUNT - NOISE_RUN_LENGTH)..];
            let noisy_pixels = pixels.iter().zip(noise);
            grey.extend(noisy_pixels.map(|(grey, noise)| (grey * brightness + noise + 0.5) as u8));
        }
        Frame::new(width, height, grey).expect("the frame has a grey for each pixel")
    }

    /// Calls `visit` for every pixel of the rectangle around the robot's body or card, with the pixel's index, column
    /// and row. `extent` is the largest distance from the origin of the axes, to a side and along the heading, mm.
    fn for_each_pixel(
        &self,
        LocalAxes { x, y, cos, sin }: LocalAxes,
        extent: [f64; 2],
        height: f64,
        mut visit: impl FnMut(usize, [f64; 2]),
    ) {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]| {
            let (right, forward) = (a * extent[0], b * extent[1]);
            let floor_x = x + forward * cos + right * sin;
            let floor_y = y + forward * sin - right * cos;
            self.optics.project([floor_x, floor_y], height)
        });
        let pixel_range = |i: usize| {
            let positions = corners.iter().map(|corner| corner[i]);
            let min = positions.clone().fold(f64::INFINITY, f64::min);
            let max = positions.fold(0.0, f64::max);
            (min.max(0.0) as usize)..((max + 1.0) as usize).min(self.studio.size[i])
        };
        for row in pixel_range(1) {
            for column in pixel_range(0) {
                let index = row * self.studio.size[0] + column;
                visit(index, [column as f64, row as f64]);
            }
        }
    }
}

/// Returns the mean of `sample` over a pixel.
fn average_over_pixel(sample: impl Fn(f64, f64) -> f64) -> f64 {
    let offset = |i: usize| (i as f64 + 0.5) / PIXEL_SAMPLES as f64 - 0.5;
    let values = (0..PIXEL_SAMPLES * PIXEL_SAMPLES)
        .map(|i| sample(offset(i % PIXEL_SAMPLES), offset(i / PIXEL_SAMPLES)));
    values.sum::<f64>() / (PIXEL_SAMPLES * PIXEL_SAMPLES) as f64
}

/// Returns the grey of a tag at a point relative to the tag's centre; `None` outside the tag.
fn tag_grey_at(id: usize, [x, y]: [f64; 2]) -> Option<f64> {
    let cell_edge = sheet::tag_edge(id) / sheet::CELLS_PER_SIDE as f64;
    let half_cells = sheet::CELLS_PER_SIDE as f64 / 2.0;
    let [column, row] = [x / cell_edge + half_cells, half_cells - y / cell_edge].map(f64::floor);
    let tag_range = 0.0..sheet::CELLS_PER_SIDE as f64;
    let is_inside = tag_range.contains(&column) && tag_range.contains(&row);
    is_inside.then(|| {
        let is_white = sheet::is_white(id, row as usize, column as usize);
        if is_white { PAPER_GREY } else { BLACK_GREY }
    })
}

/// The axes of a pose: the origin, and the cosine and sine of the heading.
#[derive(Clone, Copy)]
struct LocalAxes {
    x: f64,
    y: f64,
    cos: f64,
    sin: f64,
}

impl LocalAxes {
    fn new([x, y, heading]: Pose) -> Self {
        let (sin, cos) = heading.sin_cos();
        Self { x, y, cos, sin }
    }

    /// Converts a point on the floor to these axes: along the heading, and to the left.
    fn to_local(self, point: [f64; 2]) -> [f64; 2] {
        let Self { x, y, cos, sin } = self;
        let (dx, dy) = (point[0] - x, point[1] - y);
        [dx * cos + dy * sin, dy * cos - dx * sin]
    }

    /// Converts a point on the floor to the robot's axes: right, forward.
    fn to_robot(self, point: [f64; 2]) -> [f64; 2] {
        let [forward, left] = self.to_local(point);
        [-left, forward]
    }
}

fn cross_product(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Returns a random number with approximately a standard normal distribution.
pub fn random_normal(rng: &mut Rng) -> f64 {
    (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0
}
