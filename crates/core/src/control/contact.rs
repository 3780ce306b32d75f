//! The contact that a step of a routine waits for: a push button, or a feeler's switch.
//!
//! Contacts bounce for some milliseconds, and long wires pick up noise. So a level counts once
//! it has held for three successive frames, at most 60 ms after it began.
//!
//! A button that is stuck must not start the robot. So a step that waits for a contact ends only if the contact was
//! open at some time during the step and then closes. In contrast, a step that continues until there is an obstacle
//! also ends if the obstacle is there from the start.

use crate::numbers::gaits::Input;

/// The bits that hold the levels of the last three frames, the latest in bit 0; 1 is a closed contact.
const LEVEL_BITS: u8 = 0b111;

/// The bit that is set once the contact may end the step: it has been open for three frames, or need not be.
const READY_BIT: u8 = 0b1000;

/// The contact that may end a step, and its levels in the last frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// The contact's input.
    pub input: Input,
    /// The last levels in [`LEVEL_BITS`], and [`READY_BIT`].
    history: u8,
}

impl Contact {
    /// No contact; ends no step as long as its level is reported as open.
    pub const NONE: Self = Self {
        input: Input::NONE,
        history: 0,
    };

    /// Creates a contact that ends its step by closing after it was open.
    pub const fn waiting_to_close(input: Input) -> Self {
        Self {
            input,
            history: LEVEL_BITS,
        }
    }

    /// Creates a contact that ends its step by being closed, even if it is closed from the start.
    pub const fn waiting_while_open(input: Input) -> Self {
        Self { input, history: 0 }
    }

    /// Adds the level of a frame. Returns true if the contact ends the step.
    pub fn add_level(&mut self, is_closed: bool) -> bool {
        if self.history & LEVEL_BITS == 0 {
            self.history |= READY_BIT;
        }
        let levels = self.history << 1 | u8::from(is_closed);
        self.history = self.history & READY_BIT | levels & LEVEL_BITS;
        self.history == READY_BIT | LEVEL_BITS
    }
}

#[cfg(test)]
mod tests {
    use std::string::String;
    use std::vec::Vec;

    use super::*;

    /// Returns the frames in which a contact would end its step; in `levels`, `#` is a frame with a closed contact.
    fn ending_frames(mut contact: Contact, levels: &str) -> Vec<usize> {
        let level_frames = levels.bytes().enumerate();
        let closed_frames = level_frames.filter(|(_, level)| contact.add_level(*level == b'#'));
        closed_frames.map(|(frame, _)| frame).collect()
    }

    #[test]
    fn a_contact_counts_as_closed_in_its_third_consecutive_closed_frame() {
        let input = Input::button(15);
        for contact in [
            Contact::waiting_to_close(input),
            Contact::waiting_while_open(input),
        ] {
            assert_eq!(ending_frames(contact, "....###"), [6]);
            assert_eq!(ending_frames(contact, "....##.##.#.#.##.###."), [19]);
            assert!(ending_frames(contact, "...##..##..#..##.##.#").is_empty());
        }
    }

    #[test]
    fn a_contact_closed_from_the_start_ends_a_walk_but_ends_a_wait_only_after_it_has_opened() {
        let input = Input::nose(16);
        assert_eq!(
            ending_frames(Contact::waiting_while_open(input), "###"),
            [2]
        );
        let stuck_levels: String = "#".repeat(1000);
        assert!(ending_frames(Contact::waiting_to_close(input), &stuck_levels).is_empty());
        assert_eq!(
            ending_frames(Contact::waiting_to_close(input), "####...###"),
            [9]
        );
        // Two open frames are too few to count as open.
        assert!(ending_frames(Contact::waiting_to_close(input), "####..####.##").is_empty());
    }
}
