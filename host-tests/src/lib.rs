//! Shared parts of the tests: the robots under test, a bench with the running firmware, random fault-injection
//! scenarios, the comparison with a second simulator, and a compiler for small AVR programs.

pub mod avr_gcc;
mod bench;
mod checks;
mod extent;
pub mod judge;
pub mod random_robot;
mod robots;
pub mod trouble;

pub use bench::FirmwareBench;
pub use checks::{assert_contains, pulse_widths, text_of};
pub use extent::{dialogue_minutes, read_number, scaled_count};
pub use lizard_host::sim::frame::{FRAME_CYCLES, Frame};
pub use lizard_host::sim::lines::Line;
pub use robots::{
    NamedRobot, gait_commands, paper_robot, patrolling_robot, rng, robot, robot_named,
    robot_with_patrol, robots, robots_of_files, root, seed,
};

/// CPU cycles in a microsecond, for pulse widths in floating point.
pub const CYCLES_PER_US: f64 = simulated_uno::CYCLES_PER_US as f64;
