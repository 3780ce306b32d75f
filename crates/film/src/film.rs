//! A film: its pictures one after another, then the robot's way per cycle.

use lizard_contact::{Place, Travel};

use crate::camera::Camera;
use crate::cycles::{self, Cycles};
use crate::gait::Gait;
use crate::mean::{self, Mean};
use crate::path::{Seen, unwind};
use crate::picture::{Picture, Pixel};
use crate::scene::{FloorCorners, Measures, Scene, View};
use crate::sheet::{CODES, DECK_TAG, FLOOR_TAGS};
use crate::tags;
use crate::trouble::Trouble;

/// Distance of a floor tag's corner from its usual place that shows a moved camera, px.
const MOVED: f64 = 1.0;
/// Share of the pictures that need not show what is asked for.
const LOST: f64 = 0.1;
/// Number of pictures whose deck's tag helps to find the camera.
const SAMPLES: usize = 8;
/// Distance beyond the floor tags' middles in which places are still told, mm.
const BEYOND: f64 = 200.0;
/// Standard deviations of what a user measures: the deck tag's height, mm, and the ruler, as a share.
const HEIGHT_SIGMA: f64 = 1.0;
const RULER_SIGMA: f64 = 0.001;
/// Largest difference of the deck tag's height from that by its size, mm.
const HEIGHT: f64 = 12.0;

/// Measures of the sheet and the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// Length of a printed mm, mm: the ruler's over [`crate::sheet::RULER`].
    pub scale: f64,
    /// Height of the deck's tag above the floor, mm.
    pub height: f64,
}

/// The camera as it was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Focal length, px.
    pub focal: f64,
    /// Height above the floor, mm, in the first picture.
    pub height: f64,
    /// Tilt from straight down, deg, in the first picture.
    pub tilt: f64,
    /// Mean error of a corner on the floor, px.
    pub error: f64,
    /// True if the camera moved.
    pub moved: bool,
    /// Height of the deck's tag by its size, mm.
    pub deck: f64,
}

/// A measured film.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Way ahead of a cycle, seen from its start, mm.
    pub forward: Mean,
    /// Drift to the left, mm.
    pub left: Mean,
    /// Turn, deg, counter-clockwise positive.
    pub turn: Mean,
    /// Time of a cycle, s, and its standard error.
    pub period: [f64; 2],
    /// The movement of each cycle.
    pub cycles: Vec<Travel>,
    /// The times between the cycles, s.
    pub ends: Vec<f64>,
    /// The path.
    pub path: Vec<Seen>,
    /// The camera.
    pub sight: Sight,
}

/// The tags of a picture.
#[derive(Debug, Clone)]
struct Frame {
    seconds: f64,
    tags: [Option<[Pixel; 4]>; CODES.len()],
}

impl Frame {
    /// The floor's tags, if all are seen.
    fn floor(&self) -> Option<FloorCorners> {
        let [a, b, c, d, _] = self.tags;
        Some([a?, b?, c?, d?])
    }
}

/// A film, of which the tags are kept.
#[derive(Debug, Clone, Default)]
pub struct Film {
    size: [usize; 2],
    frames: Vec<Frame>,
}

impl Film {
    /// Reads the next picture, taken at this time, and returns the corners of its tags by their ids.
    ///
    /// # Errors
    /// Fails if it has another size than the first one, is not later than the one before, or shows a
    /// tag twice.
    pub fn add(
        &mut self,
        seconds: f64,
        picture: &Picture,
    ) -> Result<[Option<[Pixel; 4]>; CODES.len()], Trouble> {
        let number = self.frames.len() + 1;
        match self.frames.last() {
            None => self.size = picture.size(),
            Some(_) if self.size != picture.size() => return Err(Trouble::Size { number }),
            Some(before) if seconds <= before.seconds => return Err(Trouble::Times { number }),
            Some(_) => {}
        }
        let mut tags = [None; CODES.len()];
        for tag in tags::read(picture) {
            if tags[tag.id].replace(tag.corners).is_some() {
                return Err(Trouble::Twice { id: tag.id, number });
            }
        }
        self.frames.push(Frame { seconds, tags });
        Ok(tags)
    }

    /// Measures a gait.
    ///
    /// # Errors
    /// Fails if the film does not show what is needed.
    pub fn measure(&self, setup: Setup, gait: &Gait) -> Result<Measured, Trouble> {
        self.check_tags()?;
        let moved = self.is_moved();
        let measures = Measures {
            scale: setup.scale,
            height: setup.height,
            size: self.size,
        };
        let scene = Scene::of(&self.views(moved)?, measures)?;
        let place = |scene: &Scene, frame: &Frame| {
            let camera = camera(scene, frame, moved)?;
            scene.place(&camera, frame.tags[DECK_TAG].as_ref()?)
        };
        let mut path: Vec<Seen> = Vec::with_capacity(self.frames.len());
        let mut heights = Vec::with_capacity(self.frames.len());
        for frame in &self.frames {
            if let Some(place) = place(&scene, frame) {
                path.push(Seen {
                    seconds: frame.seconds,
                    place,
                });
            }
            if let (Some(camera), Some(corners)) =
                (camera(&scene, frame, moved), frame.tags[DECK_TAG])
            {
                heights.extend(scene.height(&camera, &corners));
            }
        }
        unwind(&mut path);
        let deck = heights.iter().sum::<f64>() / heights.len().max(1) as f64;
        if (deck - setup.height).abs() > HEIGHT {
            return Err(Trouble::Height {
                found: deck,
                height: setup.height,
            });
        }
        self.check_place(&scene, &path)?;
        let cycles = cycles::find(&path, gait)?;
        let parts = parts(&cycles.travels);
        let doubts = self.doubts(&scene, &cycles, if moved { 5 } else { 11 }, place);
        let [height, tilt] = scene.camera().stand();
        // A tag that is higher looks as if it went farther.
        let scale = (HEIGHT_SIGMA / (height - setup.height)).hypot(RULER_SIGMA);
        let mean = |i: usize| {
            let mut mean = mean::of(&parts[i]);
            let scale = if i < 2 { mean.mean * scale } else { 0.0 };
            let clock = cycles.pace[i] * cycles.period[1] / cycles.period[0];
            mean.error = (mean.error.powi(2) + clock.powi(2) + scale.powi(2) + doubts[i]).sqrt();
            mean
        };
        Ok(Measured {
            forward: mean(0),
            left: mean(1),
            turn: mean(2),
            period: cycles.period,
            cycles: cycles.travels,
            ends: cycles.ends,
            path,
            sight: Sight {
                focal: scene.focal(),
                height,
                tilt,
                error: scene.error,
                moved,
                deck,
            },
        })
    }

    /// Checks that every tag is seen often enough.
    fn check_tags(&self) -> Result<(), Trouble> {
        let pictures = self.frames.len();
        let seen = |id: usize| {
            self.frames
                .iter()
                .filter(|frame| frame.tags[id].is_some())
                .count()
        };
        if pictures == 0 {
            return Err(Trouble::NoPictures);
        }
        if (0..CODES.len()).all(|id| seen(id) == 0) {
            return Err(Trouble::NoTag);
        }
        if let Some(id) = (0..FLOOR_TAGS).find(|&id| seen(id) == 0) {
            return Err(Trouble::FloorTag { id });
        }
        let seen = seen(DECK_TAG);
        if (seen as f64) < (1.0 - LOST) * pictures as f64 {
            return Err(Trouble::DeckTag { seen, pictures });
        }
        Ok(())
    }

    /// The corners of each floor tag where they are most often: a tag that is partly covered for a while has
    /// others.
    fn usual(&self) -> FloorCorners {
        std::array::from_fn(|id| {
            let seen: Vec<_> = self
                .frames
                .iter()
                .filter_map(|frame| frame.tags[id])
                .collect();
            std::array::from_fn(|corner| {
                [0, 1].map(|i| middle(seen.iter().map(|tag| tag[corner][i]).collect()))
            })
        })
    }

    /// True if the camera moved: then two tags are elsewhere, and not one that is partly covered.
    fn is_moved(&self) -> bool {
        let usual = self.usual();
        let is_elsewhere = |tag: &[Pixel; 4], usual: &[Pixel; 4]| {
            let pairs = tag.iter().zip(usual);
            pairs
                .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]))
                .any(|far| far > MOVED)
        };
        let moved = |frame: &&Frame| {
            let tags = (0..FLOOR_TAGS).filter_map(|id| Some((id, frame.tags[id]?)));
            tags.filter(|(id, tag)| is_elsewhere(tag, &usual[*id]))
                .count()
                > 1
        };
        self.frames.iter().filter(moved).count() > self.frames.len() / 50
    }

    /// Pictures by which to find the scene.
    fn views(&self, moved: bool) -> Result<Vec<View>, Trouble> {
        let whole: Vec<(FloorCorners, [Pixel; 4])> = self
            .frames
            .iter()
            .filter_map(|frame| Some((frame.floor()?, frame.tags[DECK_TAG]?)))
            .collect();
        let spread = |count: usize| {
            let last = SAMPLES.min(count).max(1);
            (0..last).map(move |i| i * count.saturating_sub(1) / last.saturating_sub(1).max(1))
        };
        if !moved {
            let decks: Vec<_> = self
                .frames
                .iter()
                .filter_map(|frame| frame.tags[DECK_TAG])
                .collect();
            return Ok(vec![View {
                floor: self.usual(),
                decks: spread(decks.len()).map(|i| decks[i]).collect(),
            }]);
        }
        let pictures = self
            .frames
            .iter()
            .filter(|frame| frame.floor().is_none())
            .count();
        if pictures as f64 > LOST * self.frames.len() as f64 || whole.is_empty() {
            return Err(Trouble::CameraMoved { pictures });
        }
        let view = |i: usize| View {
            floor: whole[i].0,
            decks: vec![whole[i].1],
        };
        Ok(spread(whole.len()).map(view).collect())
    }

    /// Checks that the robot is where the floor's tags tell places.
    fn check_place(&self, scene: &Scene, path: &[Seen]) -> Result<(), Trouble> {
        let tags = scene.floor_tags();
        let middle = [0, 1].map(|i| tags.iter().map(|tag| tag[i]).sum::<f64>() / FLOOR_TAGS as f64);
        let from = |[x, y]: [f64; 2]| (x - middle[0]).hypot(y - middle[1]);
        let reach = tags.into_iter().map(from).fold(0.0, f64::max) + BEYOND;
        for seen in path {
            let distance = from([seen.place.forward, seen.place.left]);
            if distance > reach {
                let seconds = seen.seconds - self.frames[0].seconds;
                return Err(Trouble::OutOfSheet { distance, seconds });
            }
        }
        Ok(())
    }

    /// The variances of a mean cycle that follow from those of the first `count` parameters of
    /// the scene: forward, left, turn.
    fn doubts(
        &self,
        scene: &Scene,
        cycles: &Cycles,
        count: usize,
        place: impl Fn(&Scene, &Frame) -> Option<Place>,
    ) -> [f64; 3] {
        let nearest = |time: &f64| {
            let seen = self
                .frames
                .iter()
                .filter(|frame| place(scene, frame).is_some());
            seen.min_by(|a, b| {
                (a.seconds - time)
                    .abs()
                    .total_cmp(&(b.seconds - time).abs())
            })
        };
        let frames: Vec<&Frame> = cycles.ends.iter().filter_map(nearest).collect();
        let mean = |scene: &Scene| -> [f64; 3] {
            let mut seen: Vec<Seen> = frames
                .iter()
                .filter_map(|frame| {
                    Some(Seen {
                        seconds: 0.0,
                        place: place(scene, frame)?,
                    })
                })
                .collect();
            unwind(&mut seen);
            let travels: Vec<Travel> = seen
                .windows(2)
                .map(|pair| pair[1].place.seen_from(pair[0].place))
                .collect();
            parts(&travels).map(|part| part.iter().sum::<f64>() / part.len().max(1) as f64)
        };
        let here = mean(scene);
        let slopes: Vec<[f64; 3]> = (0..count)
            .map(|i| {
                let step = scene.covariance[(i, i)].sqrt().max(1e-12);
                let there = mean(&scene.moved(i, step));
                [0, 1, 2].map(|part| (there[part] - here[part]) / step)
            })
            .collect();
        [0, 1, 2].map(|part| {
            let pairs = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
            let term = |(i, j): (usize, usize)| {
                slopes[i][part] * scene.covariance[(i, j)] * slopes[j][part]
            };
            pairs.map(term).sum::<f64>().max(0.0)
        })
    }
}

/// The mean of the middle half of values, which is not empty.
fn middle(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let quarter = values.len() / 4;
    let half = &values[quarter..values.len() - quarter];
    half.iter().sum::<f64>() / half.len() as f64
}

/// The camera of a picture.
fn camera(scene: &Scene, frame: &Frame, moved: bool) -> Option<Camera> {
    match moved {
        false => Some(scene.camera()),
        true => Some(scene.camera_at(&scene.pose(&frame.floor()?)?)),
    }
}

/// Forward, left and turn of each cycle.
fn parts(travels: &[Travel]) -> [Vec<f64>; 3] {
    let part = |part: fn(&Travel) -> f64| travels.iter().map(part).collect();
    [
        part(|travel| travel.forward),
        part(|travel| travel.left),
        part(|travel| travel.turn),
    ]
}
