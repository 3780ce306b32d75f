//! `lizard sim bench`: measures the costs and the exactness of the firmware, and compares them with its budgets and
//! with the Arduino Servo library.

mod budget;
mod exactness;
mod figures;
mod stack;
mod table;

use std::io::{self, Write};
use std::path::PathBuf;

use crate::shared::firmware;
use crate::shared::progress::progress_bar;
use crate::simulate::patrol::with_patrol;
use crate::{Failure, RobotFile};

pub use budget::{Bound, Row, rows};
pub use figures::{Figures, longest_step};
pub use stack::{StackDepth, StackError};

/// Measure the firmware on a simulated Arduino UNO against its budgets
///
/// Flash, RAM and stack; cycles of the control tick, the guard and the
/// interrupts; exactness of pulses while the serial line is saturated; and how
/// much faster than a real board the simulation is. All but the last are the same on
/// any machine. Exit code 1 if a budget is broken.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The firmware that was built, with the names of its functions:
    /// target/avr-atmega328p/release/lizard.elf
    #[arg(long, value_name = "FILE")]
    elf: Option<PathBuf>,
    /// Print the table as one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// A row and its verdict, for `--json`.
#[derive(serde::Serialize)]
struct JudgedRow<'a> {
    #[serde(flatten)]
    row: &'a Row,
    /// True if the figure is within its budget.
    met: bool,
}

impl<'a> JudgedRow<'a> {
    fn new(row: &'a Row) -> Self {
        let met = row.is_within_budget();
        Self { row, met }
    }
}

/// Measures the firmware and prints the table.
///
/// # Errors
/// Fails if no usable ELF is given, if the firmware stops or does not answer, or if a figure is over its budget.
pub fn run(args: Args) -> Result<(), Failure> {
    let Some(elf) = args.elf else {
        return Err(Failure::Input(
            "functions are measured by their names, which the firmware inside this program does \
             not have. Build it from the source with `make firmware`, then: lizard sim bench --elf \
             target/avr-atmega328p/release/lizard.elf"
                .to_owned(),
        ));
    };
    let robot = args.robot.load()?;
    firmware::select_firmware(Some(&elf), &args.robot, &robot)?;
    let patrol_robot = with_patrol(&args.robot.text()?, &[]).ok();
    let progress = progress_bar(0, "{spinner} {msg}, {elapsed}");
    progress.enable_steady_tick(std::time::Duration::from_millis(100));
    let figures = Figures::measure(&elf, &robot, patrol_robot.as_ref(), |measurement| {
        progress.set_message(measurement);
    })?;
    progress.finish_and_clear();

    let rows = rows(&figures);
    let mut out = io::stdout().lock();
    if args.json {
        let rows: Vec<_> = rows.iter().map(JudgedRow::new).collect();
        let elf = elf.display().to_string();
        writeln!(out, "{}", serde_json::json!({ "elf": elf, "rows": rows }))?;
    } else {
        table::print(&rows, figures.gait.as_deref(), &mut out)?;
    }
    let figures_over_budget: Vec<&str> = rows
        .iter()
        .filter(|row| !row.is_within_budget())
        .map(|row| row.what)
        .collect();
    if figures_over_budget.is_empty() {
        Ok(())
    } else {
        let names = figures_over_budget.join(", ");
        Err(Failure::Impossible(format!("over budget: {names}")))
    }
}
