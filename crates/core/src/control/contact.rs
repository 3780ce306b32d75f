//! The contact that a step of a routine waits for: a push button, or a feeler's switch.
//!
//! Contacts bounce for some milliseconds, and long wires pick up noise. So a level counts once
//! it has held for three successive frames, at most 60 ms after it began.
//!
//! A button that is stuck must not start the robot. So a wait ends only when its contact closes: the contact
//! must have been open since the wait began. A step that goes on until there is an obstacle also has to end if
//! the obstacle is there already.

use crate::numbers::gaits::Input;

/// The bits with the levels of the last three frames, the latest in bit 0; a closed contact is 1.
const LEVELS: u8 = 0b111;

/// The bit that is set once the contact has been open for three frames, or need not be: only then may it end the
/// step.
const READY_BIT: u8 = 0b1000;

/// The contact that is awaited, and its levels in the last frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// The contact's input.
    pub input: Input,
    history: u8,
}

impl Contact {
    /// No contact. While its level is given as open, it ends no step.
    pub const NONE: Self = Self {
        input: Input::NONE,
        history: 0,
    };

    /// A contact that must be open first, and then close.
    pub const fn waiting_to_close(input: Input) -> Self {
        Self {
            input,
            history: LEVELS,
        }
    }

    /// A contact that must be closed, even if it has been closed from the start.
    pub const fn waiting_while_open(input: Input) -> Self {
        Self { input, history: 0 }
    }

    /// Adds the level of a frame; returns true once the contact has closed.
    pub fn count_frame(&mut self, is_closed: bool) -> bool {
        if self.history & LEVELS == 0 {
            self.history |= READY_BIT;
        }
        let levels = self.history << 1 | u8::from(is_closed);
        self.history = self.history & READY_BIT | levels & LEVELS;
        self.history == READY_BIT | LEVELS
    }
}

#[cfg(test)]
mod tests {
    use std::string::String;
    use std::vec::Vec;

    use super::*;

    /// The frames in which a contact counts as closed; in `levels`, `#` is a frame with a closed contact.
    fn closing_frames_of(mut contact: Contact, levels: &str) -> Vec<usize> {
        let level_frames = levels.bytes().enumerate();
        let closed_frames = level_frames.filter(|(_, level)| contact.count_frame(*level == b'#'));
        closed_frames.map(|(frame, _)| frame).collect()
    }

    #[test]
    fn a_contact_closes_in_the_third_frame_in_a_row() {
        let input = Input::button(15);
        for contact in [
            Contact::waiting_to_close(input),
            Contact::waiting_while_open(input),
        ] {
            assert_eq!(closing_frames_of(contact, "....###"), [6]);
            assert_eq!(closing_frames_of(contact, "....##.##.#.#.##.###."), [19]);
            assert!(closing_frames_of(contact, "...##..##..#..##.##.#").is_empty());
        }
    }

    #[test]
    fn a_contact_closed_from_the_start_ends_a_walk_but_no_wait_until_it_was_open() {
        let input = Input::nose(16);
        assert_eq!(
            closing_frames_of(Contact::waiting_while_open(input), "###"),
            [2]
        );
        let stuck_levels: String = "#".repeat(1000);
        assert!(closing_frames_of(Contact::waiting_to_close(input), &stuck_levels).is_empty());
        assert_eq!(
            closing_frames_of(Contact::waiting_to_close(input), "####...###"),
            [9]
        );
        // Too short to have been open.
        assert!(closing_frames_of(Contact::waiting_to_close(input), "####..####.##").is_empty());
    }
}
