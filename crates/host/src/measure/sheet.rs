//! `lizard measure sheet`: writes the sheet of tags, which is printed at actual size.

use std::io::{self, Write};
use std::path::PathBuf;

use lizard_measure::PaperSize;

use crate::Failure;
use crate::shared::files;

/// The printer's paper size, as named on the command line.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default)]
enum PaperName {
    /// 297 x 210 mm
    #[default]
    A4,
    /// 11 x 8.5 inches
    Letter,
}

/// Write the sheet of tags to print for `lizard measure`, as PDF
///
/// One page, at actual size: two strips for the floor, a card for the robot's deck, instructions for laying and
/// gluing them, and a line of 100 mm that shows the scale of the printout.
#[derive(clap::Args, Debug)]
#[command(after_help = "Example:
  lizard measure sheet --paper letter")]
pub struct SheetArgs {
    /// The paper in the printer
    #[arg(long, value_enum, default_value_t)]
    paper: PaperName,
    /// Output file for the sheet
    #[arg(long, short, value_name = "FILE", default_value = "out/sheet.pdf")]
    output: PathBuf,
}

/// Writes the sheet.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn write_sheet(args: SheetArgs) -> Result<(), Failure> {
    let paper = match args.paper {
        PaperName::A4 => PaperSize::A4,
        PaperName::Letter => PaperSize::Letter,
    };
    files::write(&args.output, &paper.draw_tag_sheet())?;
    if files::is_standard_output(&args.output) {
        return Ok(());
    }
    let file = args.output.display();
    writeln!(
        io::stdout(),
        "{file}: print it at 100 % (\"actual size\"), then measure the line of 100 mm on it"
    )?;
    Ok(())
}
