//! The core's view of a robot on a host.
//!
//! The core reads a robot from a section of flash. On a host this section is in memory, and a simulation of the core
//! borrows the section for its whole duration. The section of a simulated robot ([`crate::Robot::firmware`]) is
//! therefore kept until the program ends. A section is at most 4 KiB, and equal sections are stored once. The section
//! of a robot that is only checked ([`crate::Robot::core`]) is not kept, so a search may try thousands of robots.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

use lizard_avr::Region;

/// The core's view of a robot.
pub type CoreRobot = lizard_core::numbers::robot::Robot<'static>;

/// The sections that are kept until the program ends.
static KEPT_SECTIONS: Mutex<Option<HashSet<&'static [u8]>>> = Mutex::new(None);

/// Keeps a section until the program ends, and returns it as a region of flash.
pub fn keep_section(section: &[u8]) -> Region<'static> {
    let mut sections = KEPT_SECTIONS.lock().unwrap_or_else(PoisonError::into_inner);
    let sections = sections.get_or_insert_default();
    if let Some(section_copy) = sections.get(section) {
        return Region::new(section_copy);
    }
    let section: &'static [u8] = Vec::leak(section.to_vec());
    sections.insert(section);
    Region::new(section)
}
