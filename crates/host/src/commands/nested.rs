//! Commands with subcommands, such as `lizard calibrate backup`.
//!
//! Related commands share one entry in the list of commands: `flash` uploads an image to a board and `flash image`
//! saves it in a file; `sim bench` measures the firmware that `sim` runs. The commands' modules do not depend on this
//! nesting.

use clap::{Args, Subcommand};

#[cfg(feature = "console")]
use crate::drive;
use crate::make::draw;
#[cfg(feature = "simulator")]
use crate::simulate;
use crate::{Failure, commands::completions};

#[cfg(not(all(feature = "paper", feature = "simulator")))]
use super::absent::{AbsentCommandArgs, absent_command_failure, is_in_build};

// The types in this file have no doc comments because clap would show them instead of the arguments' comments.

// A command that runs either with its own arguments or with a subcommand.
#[derive(Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct WithSubcommand<A: Args, S: Subcommand> {
    #[command(flatten)]
    arguments: A,
    #[command(subcommand)]
    subcommand: Option<S>,
}

#[cfg(feature = "console")]
#[derive(Subcommand)]
pub enum FlashSubcommand {
    Image(drive::image::Args),
}

/// Runs `lizard flash` or its subcommand.
#[cfg(feature = "console")]
pub fn run_flash(args: WithSubcommand<drive::flash::Args, FlashSubcommand>) -> Result<(), Failure> {
    match args.subcommand {
        Some(FlashSubcommand::Image(args)) => drive::image::run(args),
        None => drive::flash::run(args.arguments),
    }
}

#[cfg(feature = "console")]
#[derive(Subcommand)]
pub enum InfoSubcommand {
    Ports(drive::ports::Args),
}

/// Runs `lizard info` or its subcommand.
#[cfg(feature = "console")]
pub fn run_info(
    args: WithSubcommand<drive::console::info::Args, InfoSubcommand>,
) -> Result<(), Failure> {
    match args.subcommand {
        Some(InfoSubcommand::Ports(args)) => drive::ports::run(args),
        None => drive::console::info::run(args.arguments),
    }
}

#[cfg(feature = "console")]
#[derive(Subcommand)]
pub enum ConsoleSubcommand {
    #[cfg(feature = "simulator")]
    Replay(drive::console::replay::Args),
    /// Draw a recorded session (missing: this program was built without the simulator)
    #[cfg(not(feature = "simulator"))]
    Replay(AbsentCommandArgs),
}

/// Runs `lizard console` or its subcommand.
#[cfg(feature = "console")]
pub fn run_console(
    args: WithSubcommand<drive::console::interactive::ConsoleArgs, ConsoleSubcommand>,
) -> Result<(), Failure> {
    match args.subcommand {
        #[cfg(feature = "simulator")]
        Some(ConsoleSubcommand::Replay(args)) => drive::console::replay::run(args),
        #[cfg(not(feature = "simulator"))]
        Some(ConsoleSubcommand::Replay(_)) => Err(absent_command_failure(
            "console replay",
            &["simulator"],
            is_in_build,
        )),
        None => drive::console::interactive::run(args.arguments),
    }
}

#[cfg(feature = "console")]
#[derive(Subcommand)]
pub enum CalibrateSubcommand {
    Backup(drive::console::backup::BackupArgs),
    Restore(drive::console::backup::RestoreArgs),
}

/// Runs `lizard calibrate` or one of its subcommands.
#[cfg(feature = "console")]
pub fn run_calibrate(
    args: WithSubcommand<drive::console::calibrate::Args, CalibrateSubcommand>,
) -> Result<(), Failure> {
    match args.subcommand {
        Some(CalibrateSubcommand::Backup(args)) => drive::console::backup::backup(args),
        Some(CalibrateSubcommand::Restore(args)) => drive::console::backup::restore(args),
        None => drive::console::calibrate::run(args.arguments),
    }
}

#[cfg(feature = "parts")]
#[derive(Subcommand)]
pub enum MeasureSubcommand {
    Sheet(crate::measure::SheetArgs),
    // Boxed, so that the variants have similar sizes.
    Servo(Box<crate::measure::ServoArgs>),
    Steps(crate::measure::StepsArgs),
    Slope(crate::measure::SlopeArgs),
    Keys(crate::measure::KeysArgs),
}

/// Runs `lizard measure` or one of its subcommands.
#[cfg(feature = "parts")]
pub fn run_measure(
    args: WithSubcommand<crate::measure::Args, MeasureSubcommand>,
) -> Result<(), Failure> {
    match args.subcommand {
        Some(MeasureSubcommand::Sheet(args)) => crate::measure::write_sheet(args),
        Some(MeasureSubcommand::Servo(args)) => crate::measure::measure_servo(*args),
        Some(MeasureSubcommand::Steps(args)) => crate::measure::print_steps(args),
        Some(MeasureSubcommand::Slope(args)) => crate::measure::measure_slope(args),
        Some(MeasureSubcommand::Keys(args)) => crate::measure::identify_keys(args),
        None => crate::measure::run(args.arguments),
    }
}

#[cfg(feature = "simulator")]
#[derive(Subcommand)]
pub enum SimSubcommand {
    Bench(simulate::bench::Args),
}

/// Runs `lizard sim` or its subcommand.
#[cfg(feature = "simulator")]
pub fn run_sim(args: WithSubcommand<simulate::sim::Args, SimSubcommand>) -> Result<(), Failure> {
    match args.subcommand {
        Some(SimSubcommand::Bench(args)) => simulate::bench::run(args),
        None => simulate::sim::run(args.arguments),
    }
}

#[derive(Subcommand)]
pub enum DrawSubcommand {
    #[cfg(feature = "paper")]
    Charts(crate::paper::charts::Args),
    /// Draw all charts (missing: this program was built without the commands that compute)
    #[cfg(not(feature = "paper"))]
    Charts(AbsentCommandArgs),
}

/// Runs `lizard draw` or its subcommand.
pub fn run_draw(args: WithSubcommand<draw::Args, DrawSubcommand>) -> Result<(), Failure> {
    match args.subcommand {
        #[cfg(feature = "paper")]
        Some(DrawSubcommand::Charts(args)) => crate::paper::charts::run(args),
        #[cfg(not(feature = "paper"))]
        Some(DrawSubcommand::Charts(_)) => Err(absent_command_failure(
            "draw charts",
            &["paper"],
            is_in_build,
        )),
        None => draw::run(args.arguments),
    }
}

#[derive(Subcommand)]
pub enum CompletionsSubcommand {
    Man(completions::ManArgs),
}

/// Runs `lizard completions` or its subcommand, for `program`.
pub fn run_completions(
    args: WithSubcommand<completions::CompletionsArgs, CompletionsSubcommand>,
    program: clap::Command,
) -> Result<(), Failure> {
    match args.subcommand {
        Some(CompletionsSubcommand::Man(args)) => completions::write_manual_pages(args, program),
        None => completions::print_completions(args.arguments, program),
    }
}
