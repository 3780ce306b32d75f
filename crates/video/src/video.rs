//! A video: reads the tags of its frames one by one, then finds the camera and the robot's path.

use crate::analysed_video::{AnalysedVideo, CameraEstimate};
use crate::frame::{Frame, Pixel};
use crate::frame_tags::{FrameTags, TagCorners};
use crate::gait::Gait;
use crate::measured_gait::MeasuredGait;
use crate::path::{PathPoint, unwrap_headings};
use crate::scene::{Dimensions, FloorCorners, Scene, View};
use crate::sheet::{CODES, DECK_TAG_ID, FLOOR_TAG_COUNT};
use crate::tags::{self, Tag};
use crate::video_error::VideoError;

/// Smallest distance of a floor tag's corner from its usual position at which the camera counts as moved, px.
const MIN_CAMERA_SHIFT: f64 = 1.0;
/// Largest fraction of the frames in which a required tag may be missing.
const MAX_MISSING_FRACTION: f64 = 0.1;
/// Number of frames whose deck tags are used to find the camera.
const SAMPLE_COUNT: usize = 8;
/// Largest excess of the robot's distance from the centre of the floor tags over the outermost tag's distance, mm.
const MAX_EXCESS_DISTANCE: f64 = 200.0;
/// Largest difference between the deck tag's given height and the height computed from its size, mm.
const MAX_HEIGHT_ERROR: f64 = 12.0;
/// Number of frames from one full search to the next, so that a second copy of a tag is noticed even if it appears
/// later.
const FULL_SEARCH_INTERVAL: usize = 16;

/// The dimensions of the sheet and the robot that the user measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// True length of a printed mm, mm: the measured length of the ruler divided by [`crate::sheet::RULER_LENGTH`].
    pub print_scale: f64,
    /// Height of the deck's tag above the floor, mm.
    pub deck_height: f64,
}

/// A video. Only the tags of its frames are stored.
#[derive(Debug, Clone, Default)]
pub struct Video {
    /// Width and height of the frames, px.
    frame_size: [usize; 2],
    frames: Vec<FrameTags>,
    /// The corners of the last frame's tags.
    last_corners: TagCorners,
    /// Number of frames since the last frame that was searched completely.
    frames_since_full_search: usize,
}

impl Video {
    /// Finds the tags of a frame without adding the frame to the video. If the last frame showed all tags, only the
    /// surroundings of their last positions are searched, which takes a fraction of the time. If a tag is missing
    /// there, and in every sixteenth frame, the whole frame is searched. If an id appears twice, both tags are
    /// returned.
    pub fn find_tags(&mut self, frame: &Frame) -> Vec<Tag> {
        self.frames_since_full_search = (self.frames_since_full_search + 1) % FULL_SEARCH_INTERVAL;
        let last_corners = self.last_corners.iter().enumerate();
        let nearby_tags =
            last_corners.map(|(id, corners)| tags::find_tag_near(frame, id, corners.as_ref()?));
        let tags = match self.frames_since_full_search {
            0 => None,
            _ => nearby_tags.collect::<Option<Vec<Tag>>>(),
        };
        let tags = tags.unwrap_or_else(|| {
            self.frames_since_full_search = 0;
            tags::read_tags(frame)
        });
        self.last_corners = [None; CODES.len()];
        for tag in &tags {
            self.last_corners[tag.id] = Some(tag.corners);
        }
        tags
    }

    /// Adds the next frame and its time, s. Returns the corners of the frame's tags, indexed by the tags' ids.
    ///
    /// # Errors
    /// Fails if the frame differs in size from the first frame, is not later than the previous frame, or shows a tag
    /// twice.
    pub fn add_frame(&mut self, seconds: f64, frame: &Frame) -> Result<TagCorners, VideoError> {
        let frame_number = self.frames.len() + 1;
        match self.frames.last() {
            None => self.frame_size = frame.size(),
            Some(_) if self.frame_size != frame.size() => {
                return Err(VideoError::SizeDiffers { frame_number });
            }
            Some(previous) if seconds <= previous.seconds => {
                return Err(VideoError::TimeNotLater { frame_number });
            }
            Some(_) => {}
        }
        let mut corners = [None; CODES.len()];
        for tag in self.find_tags(frame) {
            let id = tag.id;
            if corners[id].replace(tag.corners).is_some() {
                return Err(VideoError::DuplicateTag { id, frame_number });
            }
        }
        self.frames.push(FrameTags { seconds, corners });
        Ok(corners)
    }

    /// Measures a gait that the robot walks during the video.
    ///
    /// # Errors
    /// Fails as [`Video::analyse`] does, or if the path does not show at least two cycles of the gait.
    pub fn measure(&self, setup: Setup, gait: &Gait) -> Result<MeasuredGait, VideoError> {
        self.analyse(setup)?.measure(gait, None)
    }

    /// Finds the camera and the robot's path.
    ///
    /// # Errors
    /// Fails if the tags do not determine the camera and the path, contradict the setup, or show that the robot is too
    /// far from the floor tags.
    pub fn analyse(&self, setup: Setup) -> Result<AnalysedVideo, VideoError> {
        self.check_tags()?;
        let has_camera_moved = self.has_camera_moved();
        let dimensions = Dimensions {
            print_scale: setup.print_scale,
            deck_height: setup.deck_height,
            frame_size: self.frame_size,
        };
        let views = self.select_views(has_camera_moved)?;
        let scene = Scene::fit(&views, dimensions, has_camera_moved)?;
        let mut frames = Vec::new();
        let mut path = Vec::new();
        let mut heights = Vec::new();
        for frame in &self.frames {
            if let Some(point) = frame.find_path_point(&scene) {
                frames.push(frame.clone());
                path.push(point);
            }
            heights.extend(frame.find_deck_height(&scene));
        }
        unwrap_headings(&mut path);
        let deck_height = heights.iter().sum::<f64>() / heights.len().max(1) as f64;
        if (deck_height - setup.deck_height).abs() > MAX_HEIGHT_ERROR {
            return Err(VideoError::WrongHeight {
                height_by_size: deck_height,
                height: setup.deck_height,
            });
        }
        self.check_distance(&scene, &path)?;
        let [height, tilt] = scene.camera().height_and_tilt();
        let camera = CameraEstimate {
            focal_length: scene.focal_length(),
            height,
            tilt,
            corner_error: scene.corner_error,
            has_camera_moved,
            deck_height,
        };
        Ok(AnalysedVideo {
            path,
            camera,
            scene,
            frames,
        })
    }

    /// Checks that every floor tag is visible at least once, and the deck tag in most frames.
    fn check_tags(&self) -> Result<(), VideoError> {
        let frame_count = self.frames.len();
        let count_frames_with = |id: usize| self.visible_tags(id).len();
        if frame_count == 0 {
            return Err(VideoError::NoFrames);
        }
        if (0..CODES.len()).all(|id| count_frames_with(id) == 0) {
            return Err(VideoError::NoTag);
        }
        if let Some(id) = (0..FLOOR_TAG_COUNT).find(|&id| count_frames_with(id) == 0) {
            return Err(VideoError::NoFloorTag { id });
        }
        let visible_count = count_frames_with(DECK_TAG_ID);
        if (visible_count as f64) < (1.0 - MAX_MISSING_FRACTION) * frame_count as f64 {
            return Err(VideoError::DeckTagTooRare {
                visible_count,
                frame_count,
            });
        }
        Ok(())
    }

    /// Returns the corners of a tag in each frame that shows it.
    fn visible_tags(&self, id: usize) -> Vec<[Pixel; 4]> {
        let frames = self.frames.iter();
        frames.filter_map(|frame| frame.corners[id]).collect()
    }

    /// Computes the usual corners of each floor tag: interquartile means over all frames, because a tag that is partly
    /// covered for a while seems displaced.
    fn find_usual_floor_corners(&self) -> FloorCorners {
        std::array::from_fn(|id| {
            let visible_tags = self.visible_tags(id);
            std::array::from_fn(|corner| {
                [0, 1].map(|i| {
                    interquartile_mean(visible_tags.iter().map(|tag| tag[corner][i]).collect())
                })
            })
        })
    }

    /// True if the camera moved: in more than 2 % of the frames, at least two floor tags are not at their usual
    /// positions. A single displaced tag counts as partly covered.
    fn has_camera_moved(&self) -> bool {
        let usual_corners = self.find_usual_floor_corners();
        let is_displaced = |tag: &[Pixel; 4], usual: &[Pixel; 4]| {
            let mut pairs = tag.iter().zip(usual);
            pairs.any(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]) > MIN_CAMERA_SHIFT)
        };
        let shows_camera_shift = |frame: &&FrameTags| {
            let tags = (0..FLOOR_TAG_COUNT).filter_map(|id| Some((id, frame.corners[id]?)));
            let displaced_tags = tags.filter(|(id, tag)| is_displaced(tag, &usual_corners[*id]));
            displaced_tags.count() > 1
        };
        self.frames.iter().filter(shows_camera_shift).count() > self.frames.len() / 50
    }

    /// Selects the frames to which the scene is fitted.
    fn select_views(&self, has_camera_moved: bool) -> Result<Vec<View>, VideoError> {
        if !has_camera_moved {
            return Ok(vec![View {
                floor_corners: self.find_usual_floor_corners(),
                deck_corners: select_evenly(&self.visible_tags(DECK_TAG_ID)),
            }]);
        }
        let to_complete_view = |frame: &FrameTags| {
            Some(View {
                floor_corners: frame.floor_corners()?,
                deck_corners: vec![frame.corners[DECK_TAG_ID]?],
            })
        };
        let complete_views: Vec<View> = self.frames.iter().filter_map(to_complete_view).collect();
        let is_incomplete = |frame: &&FrameTags| frame.floor_corners().is_none();
        let frame_count = self.frames.iter().filter(is_incomplete).count();
        if frame_count as f64 > MAX_MISSING_FRACTION * self.frames.len() as f64
            || complete_views.is_empty()
        {
            return Err(VideoError::CameraMoved { frame_count });
        }
        Ok(select_evenly(&complete_views))
    }

    /// Checks that the robot stays in the area in which the floor tags give valid poses.
    fn check_distance(&self, scene: &Scene, path: &[PathPoint]) -> Result<(), VideoError> {
        let tags = scene.floor_tag_centres();
        let centre =
            [0, 1].map(|i| tags.iter().map(|tag| tag[i]).sum::<f64>() / FLOOR_TAG_COUNT as f64);
        let distance_from_centre = |[x, y]: [f64; 2]| (x - centre[0]).hypot(y - centre[1]);
        let tag_distances = tags.into_iter().map(distance_from_centre);
        let max_distance = tag_distances.fold(0.0, f64::max) + MAX_EXCESS_DISTANCE;
        for point in path {
            let distance = distance_from_centre([point.pose.forward, point.pose.left]);
            if distance > max_distance {
                let seconds = point.seconds - self.frames[0].seconds;
                return Err(VideoError::TooFarFromStrips { distance, seconds });
            }
        }
        Ok(())
    }
}

/// Selects at most [`SAMPLE_COUNT`] evenly spaced values, from the first to the last; there must be at least one.
fn select_evenly<T: Clone>(values: &[T]) -> Vec<T> {
    let sample_count = SAMPLE_COUNT.min(values.len());
    let interval_count = (sample_count - 1).max(1);
    let value_at = |i: usize| values[i * (values.len() - 1) / interval_count].clone();
    (0..sample_count).map(value_at).collect()
}

/// Computes the mean of the middle half of the values; there must be at least one.
fn interquartile_mean(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let quarter = values.len() / 4;
    let half = &values[quarter..values.len() - quarter];
    half.iter().sum::<f64>() / half.len() as f64
}
