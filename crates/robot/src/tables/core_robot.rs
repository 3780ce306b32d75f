//! The robot as the core reads it.
//!
//! The core reads a section of flash. On a host that section is in memory, and the core's
//! motion borrows it for as long as it runs. So the section of a robot that the core runs
//! ([`crate::Robot::firmware`]) is kept until the program ends. It has 5 KB at most, and equal
//! sections are kept once. Of a robot that is only checked and looked at
//! ([`crate::Robot::core`]) nothing is kept, so a search may try thousands.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

use lizard_avr::Region;

/// A robot as the core reads it.
pub type CoreRobot = lizard_core::numbers::robot::Robot<'static>;

static KEPT: Mutex<Option<HashSet<&'static [u8]>>> = Mutex::new(None);

/// A section as a region of flash: kept until the program ends.
pub fn flash(section: &[u8]) -> Region<'static> {
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let kept = kept.get_or_insert_default();
    if let Some(known) = kept.get(section) {
        return Region::new(known);
    }
    let section: &'static [u8] = Vec::leak(section.to_vec());
    kept.insert(section);
    Region::new(section)
}
