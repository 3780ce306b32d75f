//! The reasons why a film cannot be measured, each as the sentence that the user sees.

use crate::sheet::{FLOOR_TAG_COUNT, FLOOR_TAG_EDGE};

/// A reason why a film cannot be measured.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Trouble {
    /// The film has no pictures.
    #[error("the film has no pictures")]
    NoPictures,
    /// The pictures differ in size.
    #[error("picture {picture_number} differs in size from the first one")]
    SizeDiffers {
        /// Number of the picture, from 1.
        picture_number: usize,
    },
    /// The time of a picture is not later than that of the picture before.
    #[error("picture {picture_number} is not later than the one before")]
    TimeNotLater {
        /// Number of the picture, from 1.
        picture_number: usize,
    },
    /// A tag appears twice in a picture.
    #[error(
        "picture {picture_number} shows tag {id} twice, and the program does not guess which of them counts: remove the other"
    )]
    DuplicateTag {
        /// Id of the tag.
        id: usize,
        /// Number of the picture, from 1.
        picture_number: usize,
    },
    /// No picture shows a tag of the sheet.
    #[error(
        "no picture has a tag of the sheet: film from above and near enough, without glare, in more light if the \
         pictures are dark, and not mirrored"
    )]
    NoTag,
    /// A floor tag is not completely visible in any picture.
    #[error(
        "tag {id} of the floor is not completely visible in any picture: each of the {FLOOR_TAG_COUNT} tags of the \
         two strips has to be, with its white margin"
    )]
    NoFloorTag {
        /// Id of the tag.
        id: usize,
    },
    /// The deck tag is visible too rarely.
    #[error(
        "the tag on the robot's deck, or on the horn, is in only {visible_count} of {picture_count} pictures; at least \
         nine in ten have to show it"
    )]
    DeckTagTooRare {
        /// Number of pictures that show it.
        visible_count: usize,
        /// Number of pictures.
        picture_count: usize,
    },
    /// The camera moved, and not all floor tags stayed visible.
    #[error(
        "the camera moved, and {picture_count} pictures do not show all tags of the floor: put it on a \
         tripod, or keep all tags in sight"
    )]
    CameraMoved {
        /// Number of pictures without all floor tags.
        picture_count: usize,
    },
    /// No camera could see the floor tags in this arrangement.
    #[error("no camera could see the floor's tags like this: are they flat on the floor?")]
    NoCamera,
    /// The floor tags are not arranged as on the sheet.
    #[error(
        "the floor's tags are not arranged as on the sheet (they are off by {error:.1} px): both tags of a strip have \
         to be on one piece of paper, flat on the floor"
    )]
    SheetMismatch {
        /// Root-mean-square error of a corner, px.
        error: f64,
    },
    /// The size of the floor tags does not fit their distance.
    #[error(
        "the floor's tags are {edge:.1} mm wide by their distance, not {FLOOR_TAG_EDGE} mm: were they cut apart, or \
         printed with another scale in each direction?"
    )]
    WrongTagSize {
        /// Edge of a floor tag, computed from the known distance between a strip's tags, mm.
        edge: f64,
    },
    /// The deck tag is not at its given height.
    #[error(
        "the tag on the deck, or on the horn, is {height_by_size:.0} mm above the strips by its size, not {height:.0} mm: \
         measure the height and give it with --height, and print the card and the strips at the same scale"
    )]
    WrongHeight {
        /// Height computed from the size of the tag, mm.
        height_by_size: f64,
        /// Given height, mm.
        height: f64,
    },
    /// The robot leaves the area in which the floor tags give valid places.
    #[error(
        "the robot, or the horn, is {distance:.0} mm away from the middle of the strips {seconds:.1} s after the beginning, \
         too far for the tags to locate it: move the strips, or film fewer cycles"
    )]
    TooFarFromStrips {
        /// Distance from the middle of the strips, mm.
        distance: f64,
        /// Time since the first picture, s.
        seconds: f64,
    },
    /// The robot did not move.
    #[error(
        "the robot did not move: {distance:.1} mm and {turn:.1} deg in the time of a cycle at most"
    )]
    NoMovement {
        /// Largest distance within the duration of a cycle, mm.
        distance: f64,
        /// Largest turn within the duration of a cycle, deg.
        turn: f64,
    },
    /// The film has too few cycles.
    #[error(
        "the film shows {cycles:.1} cycles of {period:.2} s; two complete ones and some time before and \
         after them are needed: film at least four"
    )]
    TooShort {
        /// Number of cycles.
        cycles: f64,
        /// Duration of a cycle, s.
        period: f64,
    },
    /// The cycles take a multiple of their predicted duration.
    #[error(
        "the cycles take {ratio} times as long as they should: give the pace with --speed (a weak supply halves it), \
         or, for a film in slow motion, the rate at which it was taken with --fps"
    )]
    WrongPace {
        /// Measured duration of a cycle divided by the predicted one.
        ratio: u32,
    },
    /// The path differs from the gait's predicted path.
    #[error(
        "the path is not that of this gait in cycles of {period:.2} s: was it another gait, another pace, several gaits \
         without a rest between them, or does the arrow of the deck's card not point to the head?"
    )]
    GaitMismatch {
        /// Duration of a cycle, s.
        period: f64,
    },
    /// The movement changes from one cycle to the next.
    #[error(
        "{seconds:.1} s after the beginning, the robot's movement changes from one cycle to the next: it has to rest \
         between two gaits"
    )]
    MovementChanges {
        /// Time since the first picture, s.
        seconds: f64,
    },
    /// No gait moves the robot, so there is none to compare with.
    #[error("no gait moves the robot, so there is nothing to compare the film with")]
    NoGait,
}
