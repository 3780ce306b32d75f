//! The reasons why a video cannot be measured, each with its message to the user.

use crate::sheet::{FLOOR_TAG_COUNT, FLOOR_TAG_EDGE};

/// A reason why a video cannot be measured.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum VideoError {
    /// The video has no frames.
    #[error("the video has no frames: check that it plays")]
    NoFrames,
    /// The frames differ in size.
    #[error(
        "frame {frame_number} differs in size from the first frame: use the frames of one video"
    )]
    SizeDiffers {
        /// Number of the frame, from 1.
        frame_number: usize,
    },
    /// The time of a frame is not later than the time of the previous frame.
    #[error("the time of frame {frame_number} must be later than the time of the previous frame")]
    TimeNotLater {
        /// Number of the frame, from 1.
        frame_number: usize,
    },
    /// A tag appears twice in a frame.
    #[error("frame {frame_number} shows tag {id} twice: remove one of the two tags")]
    DuplicateTag {
        /// Id of the tag.
        id: usize,
        /// Number of the frame, from 1.
        frame_number: usize,
    },
    /// No frame shows a tag of the sheet.
    #[error(
        "no frame shows a tag of the sheet: record from above and from a short distance, without glare and not \
         mirrored, and in more light if the frames are dark"
    )]
    NoTag,
    /// A floor tag is not completely visible in any frame.
    #[error(
        "floor tag {id} is not completely visible in any frame: each of the {FLOOR_TAG_COUNT} tags of the two strips \
         must be visible with its white margin"
    )]
    NoFloorTag {
        /// Id of the tag.
        id: usize,
    },
    /// The deck tag is visible in too few frames.
    #[error(
        "the tag on the deck or horn is visible in only {visible_count} of {frame_count} frames: at least nine in ten \
         must show it"
    )]
    DeckTagTooRare {
        /// Number of frames that show the tag.
        visible_count: usize,
        /// Number of frames.
        frame_count: usize,
    },
    /// The camera moved, and not all floor tags stayed visible.
    #[error(
        "the camera moved, and {frame_count} frames do not show all floor tags: put the camera on a tripod, or keep \
         all tags in view"
    )]
    CameraMoved {
        /// Number of frames without all floor tags.
        frame_count: usize,
    },
    /// No camera could see the floor tags in this arrangement.
    #[error(
        "no camera position explains how the floor tags appear: do they lie flat on the floor?"
    )]
    NoCamera,
    /// The floor tags are not arranged as on the sheet.
    #[error(
        "the floor tags are not arranged as on the sheet (error {error:.1} px): both tags of a strip must be on one \
         piece of paper, flat on the floor"
    )]
    SheetMismatch {
        /// Root-mean-square error of a corner, px.
        error: f64,
    },
    /// The size of the floor tags contradicts the distance between them.
    #[error(
        "the floor tags are {edge:.1} mm wide relative to their distance, not {FLOOR_TAG_EDGE} mm: was a strip cut \
         apart, or printed with different scales in length and width?"
    )]
    WrongTagSize {
        /// Edge of a floor tag, computed from the known distance between a strip's tags, mm.
        edge: f64,
    },
    /// The deck tag is not at its given height.
    #[error(
        "according to its size, the tag on the deck or horn is {height_by_size:.0} mm above the strips, not \
         {height:.0} mm: measure the height and give it with --height, and print the card and the strips at the same \
         scale"
    )]
    WrongHeight {
        /// Height computed from the size of the tag, mm.
        height_by_size: f64,
        /// Given height, mm.
        height: f64,
    },
    /// The robot leaves the area in which the floor tags give valid poses.
    #[error(
        "{seconds:.1} s after the start, the robot or horn is {distance:.0} mm from the centre of the strips, too far \
         for the tags to locate it: move the strips, or record fewer cycles"
    )]
    TooFarFromStrips {
        /// Distance from the centre of the strips, mm.
        distance: f64,
        /// Time since the first frame, s.
        seconds: f64,
    },
    /// The robot did not move.
    #[error(
        "the robot did not move: at most {distance:.1} mm and {turn:.1} deg within the duration of a cycle; record the \
         robot while it walks"
    )]
    NoMovement {
        /// Largest distance within the duration of a cycle, mm.
        distance: f64,
        /// Largest turn within the duration of a cycle, deg.
        turn: f64,
    },
    /// The video has too few cycles.
    #[error(
        "the video shows {cycles:.1} cycles of {period:.2} s, but two complete cycles and some time before and after \
         them are required: record at least four"
    )]
    TooShort {
        /// Number of cycles.
        cycles: f64,
        /// Duration of a cycle, s.
        period: f64,
    },
    /// The cycles take a multiple of their predicted duration.
    #[error(
        "the cycles take {ratio} times as long as expected: give the pace with --speed (a weak supply halves it), or, \
         for a video in slow motion, the recording's frame rate with --fps"
    )]
    WrongPace {
        /// Measured duration of a cycle divided by the predicted one.
        ratio: u32,
    },
    /// The path differs from the gait's predicted path.
    #[error(
        "the path does not match this gait in cycles of {period:.2} s: was it another gait, another pace, several \
         gaits without a rest between them, or does the arrow on the deck's card not point to the head?"
    )]
    GaitMismatch {
        /// Duration of a cycle, s.
        period: f64,
    },
    /// The movement changes from one cycle to the next.
    #[error(
        "{seconds:.1} s after the start, the robot's movement changes from one cycle to the next: the robot must rest \
         between two gaits"
    )]
    MovementChanges {
        /// Time since the first frame, s.
        seconds: f64,
    },
    /// No gait moves the robot, so the video cannot be compared with a prediction.
    #[error(
        "no gait moves the robot, so the video cannot be compared with a prediction: add such a gait to robot.toml"
    )]
    NoGait,
}
