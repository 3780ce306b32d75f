//! Tests of the robot's section in flash: the core reads the numbers that were written, and no servo moves with an
//! invalid section.

use std::sync::LazyLock;

use lizard_host_tests::{NamedRobot, robots};

mod damaged;
mod read_back;

/// Returns all robots with their sections, the robots from files first.
fn sections() -> &'static [(&'static NamedRobot, Vec<u8>)] {
    static SECTIONS: LazyLock<Vec<(&'static NamedRobot, Vec<u8>)>> = LazyLock::new(|| {
        let sections = robots()
            .iter()
            .map(|named_robot| (named_robot, named_robot.robot.section()));
        sections.collect()
    });
    &SECTIONS
}
