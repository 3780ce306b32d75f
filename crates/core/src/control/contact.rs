//! The contact that a routine's step waits for: a push button, or an obstacle switch.
//!
//! Contacts bounce for some milliseconds, and long wires pick up noise. Therefore a level counts only after three
//! consecutive frames, at most 60 ms after it began.
//!
//! A stuck button must not start the robot. Therefore a step that waits for a contact ends only if the contact was open
//! during the step and then closes. In contrast, a step that continues until there is an obstacle also ends if the
//! obstacle switch is closed from the start.

use crate::numbers::gaits::Input;

/// The bits with the levels of the last three frames, the latest in bit 0; 1 is a closed contact.
const LEVEL_BITS: u8 = 0b111;

/// The bit that is set once closing the contact may end the step: from the first frame, or after three open frames if
/// the contact must first have been open.
const READY_BIT: u8 = 0b1000;

/// A contact that may end a step, and its levels in the last frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// The contact's input.
    pub input: Input,
    /// The levels in [`LEVEL_BITS`], and [`READY_BIT`].
    history: u8,
}

impl Contact {
    /// No contact, which never ends a step, because its level is always reported as open.
    pub const NONE: Self = Self {
        input: Input::NONE,
        history: 0,
    };

    /// Creates a contact that ends its step when it closes after it was open.
    pub const fn for_wait(input: Input) -> Self {
        Self {
            input,
            // As if the contact had been closed before, so that it must first be open.
            history: LEVEL_BITS,
        }
    }

    /// Creates a contact that ends its step when it is closed, even if it is closed from the start.
    pub const fn for_motion(input: Input) -> Self {
        Self { input, history: 0 }
    }

    /// Adds a frame's level. Returns true if the contact ends the step.
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
    use std::vec::Vec;

    use super::*;

    /// Returns the frames in which a contact would end its step. In `levels`, `#` is a frame with a closed contact.
    fn find_ending_frames(mut contact: Contact, levels: &str) -> Vec<usize> {
        let level_frames = levels.bytes().enumerate();
        let ending_frames = level_frames.filter(|(_, level)| contact.add_level(*level == b'#'));
        ending_frames.map(|(frame, _)| frame).collect()
    }

    #[test]
    fn a_contact_counts_as_closed_in_its_third_consecutive_closed_frame() {
        let input = Input::button(15);
        for contact in [Contact::for_wait(input), Contact::for_motion(input)] {
            assert_eq!(find_ending_frames(contact, "....###"), [6]);
            assert_eq!(find_ending_frames(contact, "....##.##.#.#.##.###."), [19]);
            assert!(find_ending_frames(contact, "...##..##..#..##.##.#").is_empty());
        }
    }

    #[test]
    fn a_contact_closed_from_the_start_ends_a_motion_but_ends_a_wait_only_after_opening() {
        let input = Input::nose(16);
        assert_eq!(find_ending_frames(Contact::for_motion(input), "###"), [2]);
        let wait_contact = Contact::for_wait(input);
        assert!(find_ending_frames(wait_contact, &"#".repeat(1000)).is_empty());
        assert_eq!(find_ending_frames(wait_contact, "####...###"), [9]);
        // Two open frames are too few to count as open.
        assert!(find_ending_frames(wait_contact, "####..####.##").is_empty());
    }
}
