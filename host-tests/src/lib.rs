//! Shared parts of the tests: the robots under test, a test bench with the running firmware, random fault-injection
//! scenarios, the comparison with a second simulator, and a compiler for small AVR programs.

pub mod avr_gcc;
mod bench;
mod environment;
mod helpers;
pub mod judge;
pub mod random_robot;
mod robots;
pub mod trouble;

pub use bench::FirmwareBench;
pub use environment::{dialogue_minutes, read_number, read_positive_number, scaled_count};
pub use helpers::{assert_contains, decode_text, pulse_widths, timer1_handler_cycles};
pub use lizard_host::sim::frame::{FRAME_CYCLES, Frame};
pub use lizard_host::sim::lines::Line;
pub use robots::{
    NamedRobot, gait_commands, load_named_robot, load_robots_from_files, paper_robot,
    patrolling_robot, read_file, rng, robot, robot_with_patrol, robots, root, seed,
};

/// CPU cycles in a microsecond, for pulse widths in floating point.
pub const CYCLES_PER_US: f64 = simulated_uno::CYCLES_PER_US as f64;
