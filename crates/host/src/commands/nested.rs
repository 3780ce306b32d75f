//! Commands with subcommands, such as `lizard calibrate backup`.
//!
//! Related commands share one entry in the list of commands: `flash image` writes to a file what `flash` writes to
//! a board, and `sim bench` measures the firmware that `sim` runs. The commands' own modules do not depend on the
//! nesting.

use clap::{Args, Subcommand};

#[cfg(feature = "console")]
use crate::drive;
use crate::make::draw;
#[cfg(feature = "simulator")]
use crate::simulate;
use crate::{Failure, commands::completions};

#[cfg(not(all(feature = "paper", feature = "simulator")))]
use super::absent::AbsentCommand;

// The types of this file have no documentation comments: clap would show them in place of those of the arguments.
#[derive(Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct With<A: Args, B: Subcommand> {
    #[command(flatten)]
    own: A,
    #[command(subcommand)]
    below: Option<B>,
}

#[cfg(feature = "console")]
#[derive(Subcommand)]
pub enum OfFlash {
    Image(drive::image::Args),
}

/// Runs `lizard flash` or its subcommand.
#[cfg(feature = "console")]
pub fn flash(args: With<drive::flash::Args, OfFlash>) -> Result<(), Failure> {
    match args.below {
        Some(OfFlash::Image(args)) => drive::image::run(args),
        None => drive::flash::run(args.own),
    }
}

#[cfg(feature = "console")]
#[derive(Subcommand)]
pub enum OfInfo {
    Ports(drive::ports::Args),
}

/// Runs `lizard info` or its subcommand.
#[cfg(feature = "console")]
pub fn info(args: With<drive::console::info::Args, OfInfo>) -> Result<(), Failure> {
    match args.below {
        Some(OfInfo::Ports(args)) => drive::ports::run(args),
        None => drive::console::info::run(args.own),
    }
}

#[cfg(feature = "console")]
#[derive(Subcommand)]
pub enum OfConsole {
    #[cfg(feature = "simulator")]
    Replay(drive::console::replay::Args),
    /// Draw a recorded session: missing, this program was built without the simulator
    #[cfg(not(feature = "simulator"))]
    Replay(AbsentCommand),
}

/// Runs `lizard console` or its subcommand.
#[cfg(feature = "console")]
pub fn console(
    args: With<drive::console::interactive::ConsoleArgs, OfConsole>,
) -> Result<(), Failure> {
    match args.below {
        #[cfg(feature = "simulator")]
        Some(OfConsole::Replay(args)) => drive::console::replay::run(args),
        #[cfg(not(feature = "simulator"))]
        Some(OfConsole::Replay(_)) => Err(AbsentCommand::failure("console replay", &["simulator"])),
        None => drive::console::interactive::console(args.own),
    }
}

#[cfg(feature = "console")]
#[derive(Subcommand)]
pub enum OfCalibrate {
    Backup(drive::console::backup::BackupArgs),
    Restore(drive::console::backup::RestoreArgs),
}

/// Runs `lizard calibrate` or one of its subcommands.
#[cfg(feature = "console")]
pub fn calibrate(args: With<drive::console::calibrate::Args, OfCalibrate>) -> Result<(), Failure> {
    match args.below {
        Some(OfCalibrate::Backup(args)) => drive::console::backup::backup(args),
        Some(OfCalibrate::Restore(args)) => drive::console::backup::restore(args),
        None => drive::console::calibrate::run(args.own),
    }
}

#[cfg(feature = "parts")]
#[derive(Subcommand)]
pub enum OfMeasure {
    Sheet(crate::measure::SheetArgs),
    // Boxed, so that the variants have similar sizes.
    Servo(Box<crate::measure::ServoArgs>),
    Steps(crate::measure::StepsArgs),
    Slope(crate::measure::SlopeArgs),
    Keys(crate::measure::KeysArgs),
}

/// Runs `lizard measure` or one of its subcommands.
#[cfg(feature = "parts")]
pub fn measure(args: With<crate::measure::Args, OfMeasure>) -> Result<(), Failure> {
    match args.below {
        Some(OfMeasure::Sheet(args)) => crate::measure::write_sheet(args),
        Some(OfMeasure::Servo(args)) => crate::measure::measure_servo(*args),
        Some(OfMeasure::Steps(args)) => crate::measure::print_steps(args),
        Some(OfMeasure::Slope(args)) => crate::measure::measure_slope(args),
        Some(OfMeasure::Keys(args)) => crate::measure::find_keys(args),
        None => crate::measure::run(args.own),
    }
}

#[cfg(feature = "simulator")]
#[derive(Subcommand)]
pub enum OfSim {
    Bench(simulate::bench::Args),
}

/// Runs `lizard sim` or its subcommand.
#[cfg(feature = "simulator")]
pub fn sim(args: With<simulate::sim::Args, OfSim>) -> Result<(), Failure> {
    match args.below {
        Some(OfSim::Bench(args)) => simulate::bench::run(args),
        None => simulate::sim::run(args.own),
    }
}

#[derive(Subcommand)]
pub enum OfDraw {
    #[cfg(feature = "paper")]
    Charts(crate::paper::charts::Args),
    /// Draw all charts: missing, this program was built without the commands that compute
    #[cfg(not(feature = "paper"))]
    Charts(AbsentCommand),
}

/// Runs `lizard draw` or its subcommand.
pub fn draw(args: With<draw::Args, OfDraw>) -> Result<(), Failure> {
    match args.below {
        #[cfg(feature = "paper")]
        Some(OfDraw::Charts(args)) => crate::paper::charts::run(args),
        #[cfg(not(feature = "paper"))]
        Some(OfDraw::Charts(_)) => Err(AbsentCommand::failure("draw charts", &["paper"])),
        None => draw::run(args.own),
    }
}

#[derive(Subcommand)]
pub enum OfCompletions {
    Man(completions::ManArgs),
}

/// Runs `lizard completions` or its subcommand, for `program`.
pub fn completions(
    args: With<completions::CompletionsArgs, OfCompletions>,
    program: clap::Command,
) -> Result<(), Failure> {
    match args.below {
        Some(OfCompletions::Man(args)) => completions::man(args, program),
        None => completions::completions(args.own, program),
    }
}
