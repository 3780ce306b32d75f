//! A film, which reads its pictures one after another, then finds the camera and the robot's path.

use crate::analysed_film::{AnalysedFilm, CameraEstimate};
use crate::frame::Frame;
use crate::gait::Gait;
use crate::measured_gait::MeasuredGait;
use crate::path::{PathPoint, unwrap_headings};
use crate::picture::{Picture, Pixel};
use crate::scene::{Dimensions, FloorCorners, Scene, View};
use crate::sheet::{CODES, DECK_TAG_ID, FLOOR_TAG_COUNT};
use crate::tags::{self, Tag};
use crate::trouble::Trouble;

/// Smallest distance of a floor tag's corner from its usual position at which the camera counts as moved, px.
const MIN_CAMERA_SHIFT: f64 = 1.0;
/// Largest share of the pictures that may lack a needed tag.
const MAX_MISSING_SHARE: f64 = 0.1;
/// Number of pictures in which the deck tag is used to find the camera.
const SAMPLE_COUNT: usize = 8;
/// Distance beyond the outermost floor tag, measured from the middle of all floor tags, up to which places are valid,
/// mm.
const MAX_TAG_DISTANCE: f64 = 200.0;
/// Largest difference between the deck tag's given height and the height found by its size, mm.
const MAX_HEIGHT_ERROR: f64 = 12.0;

/// Number of pictures from one full search to the next, so that a second copy of a tag is noticed even if it appears
/// later.
const FULL_SEARCH_INTERVAL: usize = 16;

/// Dimensions of the sheet and the robot, as the user measured them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// True length of a printed mm, mm: the measured length of the ruler divided by [`crate::sheet::RULER_LENGTH`].
    pub print_scale: f64,
    /// Height of the deck's tag above the floor, mm.
    pub deck_height: f64,
}

/// A film, of which only the tags are stored.
#[derive(Debug, Clone, Default)]
pub struct Film {
    /// Width and height of the pictures, px.
    picture_size: [usize; 2],
    frames: Vec<Frame>,
    /// The corners of the last picture's tags.
    last_corners: TagCorners,
    /// Number of pictures since the last search of a whole picture.
    pictures_since_full_search: usize,
}

/// The corners of a picture's tags, indexed by the ids of the tags.
type TagCorners = [Option<[Pixel; 4]>; CODES.len()];

impl Film {
    /// Finds the tags of a picture without storing the picture. If the last picture showed all tags, only the
    /// surroundings of their last places are searched, which takes a fraction of the time. If a tag is missing there,
    /// and in every sixteenth picture, the whole picture is searched. If that search finds an id twice, both tags are
    /// returned.
    pub fn find_tags(&mut self, picture: &Picture) -> Vec<Tag> {
        self.pictures_since_full_search =
            (self.pictures_since_full_search + 1) % FULL_SEARCH_INTERVAL;
        let last_corners = self.last_corners.iter().enumerate();
        let nearby_tags =
            last_corners.map(|(id, corners)| tags::find_near(picture, id, corners.as_ref()?));
        let tags = match self.pictures_since_full_search {
            0 => None,
            _ => nearby_tags.collect::<Option<Vec<Tag>>>(),
        };
        let tags = tags.unwrap_or_else(|| {
            self.pictures_since_full_search = 0;
            tags::read_tags(picture)
        });
        self.last_corners = [None; CODES.len()];
        for tag in &tags {
            self.last_corners[tag.id] = Some(tag.corners);
        }
        tags
    }

    /// Reads the next picture, which was taken at a time, s, and returns the corners of its tags by their ids.
    ///
    /// # Errors
    /// Fails if the picture differs in size from the first one, is not later than the previous one, or shows a tag
    /// twice.
    pub fn add(&mut self, seconds: f64, picture: &Picture) -> Result<TagCorners, Trouble> {
        let picture_number = self.frames.len() + 1;
        match self.frames.last() {
            None => self.picture_size = picture.size(),
            Some(_) if self.picture_size != picture.size() => {
                return Err(Trouble::SizeDiffers { picture_number });
            }
            Some(previous) if seconds <= previous.seconds => {
                return Err(Trouble::TimeNotLater { picture_number });
            }
            Some(_) => {}
        }
        let mut tags = [None; CODES.len()];
        for tag in self.find_tags(picture) {
            if tags[tag.id].replace(tag.corners).is_some() {
                return Err(Trouble::DuplicateTag {
                    id: tag.id,
                    picture_number,
                });
            }
        }
        self.frames.push(Frame { seconds, tags });
        Ok(tags)
    }

    /// Measures a gait that the robot walks during the film.
    ///
    /// # Errors
    /// Fails as [`Film::analyse`] does, or if the path does not show at least two cycles of the gait.
    pub fn measure(&self, setup: Setup, gait: &Gait) -> Result<MeasuredGait, Trouble> {
        self.analyse(setup)?.measure(gait, None)
    }

    /// Finds the camera and the robot's path.
    ///
    /// # Errors
    /// Fails if the tags do not determine the camera and the path, contradict the setup, or show that the robot is too
    /// far from the floor tags.
    pub fn analyse(&self, setup: Setup) -> Result<AnalysedFilm, Trouble> {
        self.check_tags()?;
        let has_camera_moved = self.has_camera_moved();
        let dimensions = Dimensions {
            print_scale: setup.print_scale,
            deck_height: setup.deck_height,
            picture_size: self.picture_size,
        };
        let scene = Scene::fit(&self.select_views(has_camera_moved)?, dimensions)?;
        let mut frames = Vec::with_capacity(self.frames.len());
        let mut path: Vec<PathPoint> = Vec::with_capacity(self.frames.len());
        let mut heights = Vec::with_capacity(self.frames.len());
        for frame in &self.frames {
            if let Some(place) = frame.place(&scene, has_camera_moved) {
                frames.push(frame.clone());
                path.push(PathPoint {
                    seconds: frame.seconds,
                    place,
                });
            }
            if let (Some(camera), Some(corners)) = (
                frame.camera(&scene, has_camera_moved),
                frame.tags[DECK_TAG_ID],
            ) {
                heights.extend(scene.find_deck_height(&camera, &corners));
            }
        }
        unwrap_headings(&mut path);
        let deck_height = heights.iter().sum::<f64>() / heights.len().max(1) as f64;
        if (deck_height - setup.deck_height).abs() > MAX_HEIGHT_ERROR {
            return Err(Trouble::WrongHeight {
                height_by_size: deck_height,
                height: setup.deck_height,
            });
        }
        self.check_distance(&scene, &path)?;
        let [camera_height, tilt] = scene.camera().height_and_tilt();
        let camera = CameraEstimate {
            focal_length: scene.focal_length(),
            height: camera_height,
            tilt,
            corner_error: scene.corner_error,
            has_camera_moved,
            deck_height,
        };
        Ok(AnalysedFilm {
            path,
            camera,
            scene,
            frames,
            given_deck_height: setup.deck_height,
        })
    }

    /// Checks that every floor tag is visible at least once, and the deck tag in most pictures.
    fn check_tags(&self) -> Result<(), Trouble> {
        let picture_count = self.frames.len();
        let count_of = |id: usize| {
            self.frames
                .iter()
                .filter(|frame| frame.tags[id].is_some())
                .count()
        };
        if picture_count == 0 {
            return Err(Trouble::NoPictures);
        }
        if (0..CODES.len()).all(|id| count_of(id) == 0) {
            return Err(Trouble::NoTag);
        }
        if let Some(id) = (0..FLOOR_TAG_COUNT).find(|&id| count_of(id) == 0) {
            return Err(Trouble::NoFloorTag { id });
        }
        let visible_count = count_of(DECK_TAG_ID);
        if (visible_count as f64) < (1.0 - MAX_MISSING_SHARE) * picture_count as f64 {
            return Err(Trouble::DeckTagTooRare {
                visible_count,
                picture_count,
            });
        }
        Ok(())
    }

    /// The usual corners of each floor tag: interquartile means over all pictures, since a tag that is partly covered
    /// for a while seems displaced.
    fn usual_floor_corners(&self) -> FloorCorners {
        std::array::from_fn(|id| {
            let visible_tags: Vec<_> = self
                .frames
                .iter()
                .filter_map(|frame| frame.tags[id])
                .collect();
            std::array::from_fn(|corner| {
                [0, 1].map(|i| {
                    interquartile_mean(visible_tags.iter().map(|tag| tag[corner][i]).collect())
                })
            })
        })
    }

    /// True if the camera moved: in more than 2 % of the pictures, two or more floor tags are not at their usual
    /// positions. If only one tag is displaced, it is partly covered.
    fn has_camera_moved(&self) -> bool {
        let usual_corners = self.usual_floor_corners();
        let is_displaced = |tag: &[Pixel; 4], usual: &[Pixel; 4]| {
            let pairs = tag.iter().zip(usual);
            pairs
                .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]))
                .any(|distance| distance > MIN_CAMERA_SHIFT)
        };
        let shows_camera_shift = |frame: &&Frame| {
            let tags = (0..FLOOR_TAG_COUNT).filter_map(|id| Some((id, frame.tags[id]?)));
            tags.filter(|(id, tag)| is_displaced(tag, &usual_corners[*id]))
                .count()
                > 1
        };
        self.frames.iter().filter(shows_camera_shift).count() > self.frames.len() / 50
    }

    /// Selects the pictures to which the scene is fitted.
    fn select_views(&self, has_camera_moved: bool) -> Result<Vec<View>, Trouble> {
        let complete_views: Vec<(FloorCorners, [Pixel; 4])> = self
            .frames
            .iter()
            .filter_map(|frame| Some((frame.floor_corners()?, frame.tags[DECK_TAG_ID]?)))
            .collect();
        let evenly_spaced_indices = |count: usize| {
            let sample_count = SAMPLE_COUNT.min(count).max(1);
            (0..sample_count)
                .map(move |i| i * count.saturating_sub(1) / sample_count.saturating_sub(1).max(1))
        };
        if !has_camera_moved {
            let decks: Vec<_> = self
                .frames
                .iter()
                .filter_map(|frame| frame.tags[DECK_TAG_ID])
                .collect();
            return Ok(vec![View {
                floor_corners: self.usual_floor_corners(),
                deck_corners: evenly_spaced_indices(decks.len())
                    .map(|i| decks[i])
                    .collect(),
            }]);
        }
        let picture_count = self
            .frames
            .iter()
            .filter(|frame| frame.floor_corners().is_none())
            .count();
        if picture_count as f64 > MAX_MISSING_SHARE * self.frames.len() as f64
            || complete_views.is_empty()
        {
            return Err(Trouble::CameraMoved { picture_count });
        }
        let view_of = |i: usize| {
            let (floor_corners, deck_corners) = complete_views[i];
            View {
                floor_corners,
                deck_corners: vec![deck_corners],
            }
        };
        Ok(evenly_spaced_indices(complete_views.len())
            .map(view_of)
            .collect())
    }

    /// Checks that the robot stays where the floor tags give valid places.
    fn check_distance(&self, scene: &Scene, path: &[PathPoint]) -> Result<(), Trouble> {
        let tags = scene.floor_tags();
        let middle =
            [0, 1].map(|i| tags.iter().map(|tag| tag[i]).sum::<f64>() / FLOOR_TAG_COUNT as f64);
        let distance_from_middle = |[x, y]: [f64; 2]| (x - middle[0]).hypot(y - middle[1]);
        let max_distance = tags
            .into_iter()
            .map(distance_from_middle)
            .fold(0.0, f64::max)
            + MAX_TAG_DISTANCE;
        for point in path {
            let distance = distance_from_middle([point.place.forward, point.place.left]);
            if distance > max_distance {
                let seconds = point.seconds - self.frames[0].seconds;
                return Err(Trouble::TooFarFromStrips { distance, seconds });
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
