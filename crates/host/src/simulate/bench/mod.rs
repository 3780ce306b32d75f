//! `lizard sim bench`: measures the firmware's costs and exactness, and compares them with the budgets and the Arduino
//! Servo library.

mod budget;
mod exactness;
mod measurements;
mod stack;
mod table;

use std::io::{self, Write};
use std::path::PathBuf;

use crate::shared::firmware;
use crate::shared::progress::create_spinner;
use crate::simulate::patrol::add_patrol;
use crate::{Failure, RobotArgs};

pub use budget::{Bound, BudgetRow};
pub use measurements::{measure, measure_longest_step};
pub use stack::{StackDepth, StackError};

/// Measure the firmware on a simulated Arduino UNO against its budgets
///
/// Measures flash, RAM and stack; the cycles of the control tick, the guard and the
/// interrupts; the exactness of pulses while the serial line is saturated; and the speed of
/// the simulation relative to a real board, which alone depends on the machine. The exit
/// code is 1 if a value exceeds its budget.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The built firmware with its function names:
    /// target/avr-atmega328p/release/lizard.elf
    #[arg(long, value_name = "FILE")]
    elf: Option<PathBuf>,
    /// Print the table as one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// Measures the firmware and prints the table.
///
/// # Errors
/// Fails if there is no usable ELF, if the firmware stops or does not answer, or if a value exceeds its budget.
pub fn run(args: Args) -> Result<(), Failure> {
    let Some(elf) = args.elf else {
        return Err(Failure::Input(
            "--elf is required: the built-in firmware has no function names. Build the firmware \
             with `make firmware`, then: lizard sim bench --elf \
             target/avr-atmega328p/release/lizard.elf"
                .to_owned(),
        ));
    };
    let robot = args.robot.load()?;
    let image = firmware::read_image(&elf)?;
    let name = elf.display().to_string();
    if image.symbols().is_empty() {
        return Err(Failure::Input(format!(
            "{name} has no function names; give the ELF file that `make firmware` builds"
        )));
    }
    firmware::check_robot(&image, &name, &args.robot, &robot, "")?;
    let patrol_robot = add_patrol(args.robot.text()?, &[]).ok();
    let spinner = create_spinner("");
    let show_measurement = |measurement: &'static str| spinner.set_message(measurement);
    let rows = measure(&elf, &robot, patrol_robot.as_ref(), show_measurement)?;
    drop(spinner);

    let mut out = io::stdout().lock();
    if args.json {
        writeln!(out, "{}", serde_json::json!({ "elf": name, "rows": rows }))?;
    } else {
        let gait = measurements::find_gait_command(&robot);
        table::print(&rows, gait.as_deref(), &mut out)?;
    }
    let rows_over_budget = rows.iter().filter(|row| !row.is_within_budget);
    let names_over_budget: Vec<&str> = rows_over_budget.map(|row| row.name).collect();
    if names_over_budget.is_empty() {
        return Ok(());
    }
    let names = names_over_budget.join(", ");
    Err(Failure::Operation(format!("over budget: {names}")))
}
