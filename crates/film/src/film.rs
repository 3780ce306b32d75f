//! A film: reads its pictures one after another, then finds the camera and the robot's path.

use crate::frame::Frame;
use crate::gait::Gait;
use crate::measured::Measured;
use crate::path::{PathPoint, unwind};
use crate::picture::{Picture, Pixel};
use crate::scene::{FloorCorners, Measures, Scene, View};
use crate::sheet::{CODES, DECK_TAG, FLOOR_TAGS};
use crate::tags::{self, Tag};
use crate::trouble::Trouble;
use crate::watched::{AnalysedFilm, Sight};

/// Smallest distance of a floor tag's corner from its usual place that shows a moved camera, px.
const MIN_SHIFT: f64 = 1.0;
/// Largest share of the pictures that may lack a needed tag.
const MAX_LOST_SHARE: f64 = 0.1;
/// Number of pictures in which the deck tag is used to find the camera.
const SAMPLES: usize = 8;
/// Distance beyond the floor tags, measured from their common middle, up to which places are valid, mm.
const MAX_TAG_DISTANCE: f64 = 200.0;
/// Largest difference between the deck tag's given height and the height found by its size, mm.
const MAX_HEIGHT_ERROR: f64 = 12.0;

/// Pictures from one full search to the next, so that a second copy of a tag is noticed even if it appears later.
const FULL_SEARCH_INTERVAL: usize = 16;

/// Measures of the sheet and the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// True length of a printed mm, mm: the measured length of the ruler divided by [`crate::sheet::RULER`].
    pub scale: f64,
    /// Height of the deck's tag above the floor, mm.
    pub height: f64,
}

/// A film, of which only the tags are stored.
#[derive(Debug, Clone, Default)]
pub struct Film {
    size: [usize; 2],
    frames: Vec<Frame>,
    /// The tags of the last picture.
    last: Tags,
    /// Pictures since the last full search.
    since_whole: usize,
}

/// The corners of tags by their ids.
type Tags = [Option<[Pixel; 4]>; CODES.len()];

impl Film {
    /// Finds the tags of a picture, which is not stored. If the last picture showed all tags, it searches only near
    /// their last places, which takes a fraction of the time. If a tag is missing there, and in every sixteenth
    /// picture, it searches the whole picture. If that search finds an id twice, both tags are returned.
    pub fn find_tags(&mut self, picture: &Picture) -> Vec<Tag> {
        self.since_whole = (self.since_whole + 1) % FULL_SEARCH_INTERVAL;
        let last_tags = self.last.iter().enumerate();
        let nearby_tags = last_tags.map(|(id, corners)| tags::near(picture, id, corners.as_ref()?));
        let tags = match self.since_whole {
            0 => None,
            _ => nearby_tags.collect::<Option<Vec<Tag>>>(),
        };
        let tags = tags.unwrap_or_else(|| {
            self.since_whole = 0;
            tags::read(picture)
        });
        self.last = [None; CODES.len()];
        for tag in &tags {
            self.last[tag.id] = Some(tag.corners);
        }
        tags
    }

    /// Reads the next picture, taken at this time, and returns the corners of its tags by their ids.
    ///
    /// # Errors
    /// Fails if the picture differs in size from the first one, is not later than the previous one, or shows a tag
    /// twice.
    pub fn add(&mut self, seconds: f64, picture: &Picture) -> Result<Tags, Trouble> {
        let number = self.frames.len() + 1;
        match self.frames.last() {
            None => self.size = picture.size(),
            Some(_) if self.size != picture.size() => return Err(Trouble::Size { number }),
            Some(previous) if seconds <= previous.seconds => return Err(Trouble::Times { number }),
            Some(_) => {}
        }
        let mut tags = [None; CODES.len()];
        for tag in self.find_tags(picture) {
            if tags[tag.id].replace(tag.corners).is_some() {
                return Err(Trouble::Twice { id: tag.id, number });
            }
        }
        self.frames.push(Frame { seconds, tags });
        Ok(tags)
    }

    /// Measures a gait that the robot walks during the film.
    ///
    /// # Errors
    /// Fails if the film does not show what is needed.
    pub fn measure(&self, setup: Setup, gait: &Gait) -> Result<Measured, Trouble> {
        self.watch(setup)?.measure(gait, None)
    }

    /// Finds the camera and the robot's path.
    ///
    /// # Errors
    /// Fails if the tags do not determine camera and path, contradict the setup, or show the robot too far from the
    /// floor tags.
    pub fn watch(&self, setup: Setup) -> Result<AnalysedFilm, Trouble> {
        self.check_tags()?;
        let is_moved = self.is_moved();
        let measures = Measures {
            scale: setup.scale,
            height: setup.height,
            size: self.size,
        };
        let scene = Scene::of(&self.views(is_moved)?, measures)?;
        let mut frames = Vec::with_capacity(self.frames.len());
        let mut path: Vec<PathPoint> = Vec::with_capacity(self.frames.len());
        let mut heights = Vec::with_capacity(self.frames.len());
        for frame in &self.frames {
            if let Some(place) = frame.place(&scene, is_moved) {
                frames.push(frame.clone());
                path.push(PathPoint {
                    seconds: frame.seconds,
                    place,
                });
            }
            if let (Some(camera), Some(corners)) =
                (frame.camera(&scene, is_moved), frame.tags[DECK_TAG])
            {
                heights.extend(scene.height(&camera, &corners));
            }
        }
        unwind(&mut path);
        let deck = heights.iter().sum::<f64>() / heights.len().max(1) as f64;
        if (deck - setup.height).abs() > MAX_HEIGHT_ERROR {
            return Err(Trouble::Height {
                found: deck,
                height: setup.height,
            });
        }
        self.check_place(&scene, &path)?;
        let [height, tilt] = scene.camera().stand();
        let sight = Sight {
            focal: scene.focal(),
            height,
            tilt,
            error: scene.error,
            has_camera_moved: is_moved,
            deck,
        };
        Ok(AnalysedFilm::new(path, sight, scene, frames, setup.height))
    }

    /// Checks that every floor tag is visible at least once, and the deck tag in most pictures.
    fn check_tags(&self) -> Result<(), Trouble> {
        let pictures = self.frames.len();
        let count_of = |id: usize| {
            self.frames
                .iter()
                .filter(|frame| frame.tags[id].is_some())
                .count()
        };
        if pictures == 0 {
            return Err(Trouble::NoPictures);
        }
        if (0..CODES.len()).all(|id| count_of(id) == 0) {
            return Err(Trouble::NoTag);
        }
        if let Some(id) = (0..FLOOR_TAGS).find(|&id| count_of(id) == 0) {
            return Err(Trouble::FloorTag { id });
        }
        let seen = count_of(DECK_TAG);
        if (seen as f64) < (1.0 - MAX_LOST_SHARE) * pictures as f64 {
            return Err(Trouble::DeckTag { seen, pictures });
        }
        Ok(())
    }

    /// The usual corners of each floor tag: means of the middle half of all pictures, since a tag that is partly
    /// covered for a while seems to be elsewhere.
    fn usual_floor_corners(&self) -> FloorCorners {
        std::array::from_fn(|id| {
            let tags_seen: Vec<_> = self
                .frames
                .iter()
                .filter_map(|frame| frame.tags[id])
                .collect();
            std::array::from_fn(|corner| {
                [0, 1].map(|i| {
                    interquartile_mean(tags_seen.iter().map(|tag| tag[corner][i]).collect())
                })
            })
        })
    }

    /// True if the camera moved: in more than 2 % of the pictures, two or more floor tags are not at their usual
    /// places. A single displaced tag is one that is partly covered.
    fn is_moved(&self) -> bool {
        let usual = self.usual_floor_corners();
        let is_elsewhere = |tag: &[Pixel; 4], usual: &[Pixel; 4]| {
            let pairs = tag.iter().zip(usual);
            pairs
                .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]))
                .any(|distance| distance > MIN_SHIFT)
        };
        let is_frame_moved = |frame: &&Frame| {
            let tags = (0..FLOOR_TAGS).filter_map(|id| Some((id, frame.tags[id]?)));
            tags.filter(|(id, tag)| is_elsewhere(tag, &usual[*id]))
                .count()
                > 1
        };
        self.frames.iter().filter(is_frame_moved).count() > self.frames.len() / 50
    }

    /// Selects the pictures that are used to find the scene.
    fn views(&self, is_moved: bool) -> Result<Vec<View>, Trouble> {
        let complete_frames: Vec<(FloorCorners, [Pixel; 4])> = self
            .frames
            .iter()
            .filter_map(|frame| Some((frame.floor()?, frame.tags[DECK_TAG]?)))
            .collect();
        let spread_indices = |count: usize| {
            let sample_count = SAMPLES.min(count).max(1);
            (0..sample_count)
                .map(move |i| i * count.saturating_sub(1) / sample_count.saturating_sub(1).max(1))
        };
        if !is_moved {
            let decks: Vec<_> = self
                .frames
                .iter()
                .filter_map(|frame| frame.tags[DECK_TAG])
                .collect();
            return Ok(vec![View {
                floor: self.usual_floor_corners(),
                decks: spread_indices(decks.len()).map(|i| decks[i]).collect(),
            }]);
        }
        let pictures = self
            .frames
            .iter()
            .filter(|frame| frame.floor().is_none())
            .count();
        if pictures as f64 > MAX_LOST_SHARE * self.frames.len() as f64 || complete_frames.is_empty()
        {
            return Err(Trouble::CameraMoved { pictures });
        }
        let view_of = |i: usize| View {
            floor: complete_frames[i].0,
            decks: vec![complete_frames[i].1],
        };
        Ok(spread_indices(complete_frames.len()).map(view_of).collect())
    }

    /// Checks that the robot stays where the floor tags give valid places.
    fn check_place(&self, scene: &Scene, path: &[PathPoint]) -> Result<(), Trouble> {
        let tags = scene.floor_tags();
        let middle = [0, 1].map(|i| tags.iter().map(|tag| tag[i]).sum::<f64>() / FLOOR_TAGS as f64);
        let distance_from_middle = |[x, y]: [f64; 2]| (x - middle[0]).hypot(y - middle[1]);
        let reach = tags
            .into_iter()
            .map(distance_from_middle)
            .fold(0.0, f64::max)
            + MAX_TAG_DISTANCE;
        for point in path {
            let distance = distance_from_middle([point.place.forward, point.place.left]);
            if distance > reach {
                let seconds = point.seconds - self.frames[0].seconds;
                return Err(Trouble::OutOfSheet { distance, seconds });
            }
        }
        Ok(())
    }
}

/// The mean of the middle half of the values; there must be at least one.
fn interquartile_mean(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let quarter = values.len() / 4;
    let half = &values[quarter..values.len() - quarter];
    half.iter().sum::<f64>() / half.len() as f64
}
