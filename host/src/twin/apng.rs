//! A moving picture: two cycles of a gait from above, over a floor that stays.

#[cfg(feature = "paper")]
pub use drawn::draw;

/// Nothing: this build cannot turn drawings into pixels.
///
/// # Errors
/// Always.
#[cfg(not(feature = "paper"))]
pub fn draw(_: &super::replay::Replay) -> Result<Vec<u8>, crate::Failure> {
    Err(crate::Failure::Input(
        "--apng needs a program built with the commands that compute; make cli builds all"
            .to_owned(),
    ))
}

#[cfg(feature = "paper")]
mod drawn {
    use std::collections::HashMap;

    use lizard_kinematics::Vector;
    use lizard_robot::{Place, Plate};
    use lizard_twin::{FRAME, Shape};
    use resvg::{tiny_skia, usvg};
    use svg::Document;
    use svg::node::element::Group;

    use super::super::replay::Replay;
    use crate::Failure;
    use crate::draw::body::Sheet;
    use crate::draw::ink::{DARK, GRID, SERVO, circle, curve, line, rectangle};

    /// Pixels for a mm.
    const SCALE: f64 = 1.25;
    /// mm around the robot's way.
    const ROOM: f64 = 22.0;
    /// Every second frame is enough for the eye.
    const EVERY: usize = 2;
    const HOLDS: &str = "#009e73";
    /// Below half a mm in a frame, as in a stance.
    const CREEPS: &str = "#e6a817";
    const SLIDES: &str = "#d55e00";
    const STEEL: &str = "#666666";

    /// The picture of two cycles of the first gait that moves, as APNG.
    ///
    /// # Errors
    /// A run without a whole cycle of a gait.
    pub fn draw(replay: &Replay) -> Result<Vec<u8>, Failure> {
        let found = replay
            .stages
            .iter()
            .find_map(|stage| replay.last_cycle(stage));
        let Some((_, cycle)) = found else {
            return Err(Failure::Input(
                "--apng draws two cycles of a gait, and the script walks none so long".to_owned(),
            ));
        };
        let begin = cycle.start - cycle.len();
        let frames: Vec<usize> = (begin..cycle.end).step_by(EVERY).collect();
        let view = View::of(replay, &frames);
        let pictures: Vec<Vec<u8>> = frames
            .iter()
            .map(|&frame| view.pixels(&view.svg(replay, begin, frame)))
            .collect::<Result<_, _>>()
            .map_err(Failure::Impossible)?;
        encode(view.size(), &pictures).map_err(|fault| Failure::Impossible(fault.to_string()))
    }

    /// What part of the floor is shown: forward and left, mm, from and to.
    struct View {
        from: [f64; 2],
        to: [f64; 2],
    }

    impl View {
        fn of(replay: &Replay, frames: &[usize]) -> Self {
            let mut view = Self {
                from: [f64::INFINITY; 2],
                to: [f64::NEG_INFINITY; 2],
            };
            for &frame in frames {
                let Some(shape) = &replay.shapes[frame] else {
                    continue;
                };
                let feet = shape.legs.iter().flat_map(|leg| leg.joints);
                for point in shape.ends.into_iter().chain(feet) {
                    let at = on_floor(replay.states[frame].place, point);
                    for (i, at) in at.into_iter().enumerate() {
                        view.from[i] = view.from[i].min(at - ROOM);
                        view.to[i] = view.to[i].max(at + ROOM);
                    }
                }
            }
            view
        }

        fn size(&self) -> (u32, u32) {
            let pixels = |i: usize| (SCALE * (self.to[i] - self.from[i])).ceil() as u32;
            (pixels(1), pixels(0))
        }

        fn page(&self, [forward, left]: [f64; 2]) -> (f64, f64) {
            (SCALE * (self.to[1] - left), SCALE * (self.to[0] - forward))
        }

        /// A frame, the body's track since frame `begin` among it.
        fn svg(&self, replay: &Replay, begin: usize, frame: usize) -> String {
            let (width, height) = self.size();
            let (width, height) = (f64::from(width), f64::from(height));
            let mut group = Group::new().add(rectangle((0.0, 0.0), (width, height), "white"));
            let lines = |i: usize| {
                let first = (self.from[i] / 50.0).ceil() as i32;
                (first..)
                    .map(|n| f64::from(n) * 50.0)
                    .take_while(move |at| *at < self.to[i])
            };
            for at in lines(0) {
                let y = self.page([at, 0.0]).1;
                group = group.add(line((0.0, y), (width, y), GRID, 1.0));
            }
            for at in lines(1) {
                let x = self.page([0.0, at]).0;
                group = group.add(line((x, 0.0), (x, height), GRID, 1.0));
            }
            let track: Vec<(f64, f64)> = replay.states[begin..=frame]
                .iter()
                .map(|state| self.page([state.place.forward, state.place.left]))
                .collect();
            group = group.add(curve(&track, "#8a6fb0", 2.0));
            if let Some(shape) = &replay.shapes[frame] {
                let state = &replay.states[frame];
                let holds = state.holds();
                let pads = std::array::from_fn(|i| match state.slip[i] {
                    _ if holds[i] => HOLDS,
                    slip if slip < 0.5 => CREEPS,
                    _ => SLIDES,
                });
                let plate = replay.robot.plate();
                group = self.robot(group, &plate, shape, state.place, pads);
            }
            Document::new()
                .set("viewBox", (0, 0, width, height))
                .set("width", width)
                .set("height", height)
                .add(group)
                .to_string()
        }

        fn robot(
            &self,
            mut group: Group,
            plate: &Plate,
            shape: &Shape,
            place: Place,
            pads: [&str; 4],
        ) -> Group {
            let sheet = Sheet {
                at: |point: Vector| self.page(on_floor(place, point)),
                scale: SCALE,
                turn: place.heading.to_degrees(),
            };
            group = sheet.feet(group, &shape.legs, pads);
            group = sheet.plate(group, plate);
            group = sheet.cranks(group, shape.shafts, &shape.legs);
            for (front, rear) in [(0, 3), (1, 2)] {
                group = group.add(sheet.bar(shape.arms[front], shape.arms[rear], STEEL, 3.0));
                for servo in [front, rear] {
                    let (shaft, arm) = (shape.shafts[servo], shape.arms[servo]);
                    group = group.add(sheet.bar(shaft, arm, SERVO[servo], 3.0));
                }
            }
            for (i, colour) in SERVO.into_iter().enumerate() {
                group = group
                    .add(sheet.bar(shape.tips[i], shape.ends[i / 2], STEEL, 3.4))
                    .add(sheet.bar(shape.shafts[i], shape.tips[i], colour, 4.6))
                    .add(circle((sheet.at)(shape.shafts[i]), 3.2 * SCALE, DARK))
                    .add(sheet.joint(shape.tips[i], 2.2));
            }
            group = sheet.anchors(group, &shape.legs);
            for (end, mm) in shape.ends.into_iter().zip([5.0, 3.0]) {
                group = group.add(sheet.disc(end, mm, "#f0e442"));
            }
            group
        }

        /// Its pixels, red, green, blue and opacity.
        fn pixels(&self, svg: &str) -> Result<Vec<u8>, String> {
            let (width, height) = self.size();
            let tree = usvg::Tree::from_str(svg, &usvg::Options::default())
                .map_err(|fault| fault.to_string())?;
            let mut pixels = tiny_skia::Pixmap::new(width, height).ok_or("the picture is empty")?;
            resvg::render(
                &tree,
                tiny_skia::Transform::identity(),
                &mut pixels.as_mut(),
            );
            Ok(pixels.take())
        }
    }

    fn on_floor(place: Place, point: Vector) -> [f64; 2] {
        place.on_floor([point.y, -point.x])
    }

    /// A colour as finely as the picture needs it: five bits of each part.
    fn rough(pixel: &[u8]) -> [u8; 3] {
        std::array::from_fn(|i| pixel[i] & 0xf8 | pixel[i] >> 5)
    }

    /// The pictures one after another with at most 256 colours, endlessly.
    fn encode(
        (width, height): (u32, u32),
        pictures: &[Vec<u8>],
    ) -> Result<Vec<u8>, png::EncodingError> {
        let mut counts: HashMap<[u8; 3], usize> = HashMap::new();
        for pixel in pictures.iter().flat_map(|picture| picture.chunks_exact(4)) {
            *counts.entry(rough(pixel)).or_default() += 1;
        }
        let mut colours: Vec<_> = counts.into_iter().collect();
        // The commonest first, and of equals always the same one.
        colours.sort_by_key(|(colour, count)| (std::cmp::Reverse(*count), *colour));
        let palette: Vec<[u8; 3]> = colours
            .iter()
            .take(256)
            .map(|(colour, _)| *colour)
            .collect();
        let nearest = |colour: [u8; 3]| {
            let away = |other: &[u8; 3]| -> i32 {
                (0..3)
                    .map(|i| (i32::from(colour[i]) - i32::from(other[i])).pow(2))
                    .sum()
            };
            (0..palette.len())
                .min_by_key(|&i| away(&palette[i]))
                .unwrap_or(0) as u8
        };
        let index: HashMap<[u8; 3], u8> = colours
            .iter()
            .map(|(colour, _)| (*colour, nearest(*colour)))
            .collect();
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(palette.concat());
        encoder.set_compression(png::Compression::High);
        // Colour numbers are not shades, so neighbouring pixels predict nothing.
        encoder.set_filter(png::Filter::NoFilter);
        encoder.set_animated(pictures.len() as u32, 0)?;
        encoder.set_frame_delay((1000.0 * FRAME) as u16 * EVERY as u16, 1000)?;
        let mut writer = encoder.write_header()?;
        for picture in pictures {
            let pixels = picture.chunks_exact(4).map(|pixel| index[&rough(pixel)]);
            writer.write_image_data(&pixels.collect::<Vec<u8>>())?;
        }
        writer.finish()?;
        Ok(bytes)
    }
}
