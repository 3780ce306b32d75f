//! The report of a run, as tables or as JSON.

use std::io::{self, Write};

use lizard_robot::UNDETERMINED_NOTE;
use serde::Serialize;
use simulated_uno::Uno;

use super::analysis::{CommandDisplacement, Run, Safety, ServoReport};
use super::session::DialogueLine;
use crate::shared::number::{format_or_dash, round_to_decimals};

/// All results of a run; the serialized field names are the JSON keys.
#[derive(Debug, Serialize)]
pub struct Report<'a> {
    /// The path of the firmware's file, or a description of the built-in firmware.
    #[serde(rename = "elf")]
    pub firmware_name: String,
    /// The fidelity of the simulated chip: `data-sheet` or `stock`.
    pub fidelity: &'static str,
    /// Simulated time, s.
    pub seconds: f64,
    /// Wall time, s.
    pub wall_seconds: f64,
    /// The console's dialogue.
    pub dialogue: Vec<DialogueLine>,
    /// The servos' pulses.
    pub servos: Vec<ServoReport>,
    /// The smallest margin, the stroke and the violations over all poses.
    pub safety: Safety,
    /// The predicted displacement during each command; the last entry is the complete run.
    #[serde(rename = "way")]
    pub displacements: Vec<CommandDisplacement>,
    /// Largest number of servo pins that are high at the same time.
    #[serde(rename = "most_pins_high")]
    pub max_pins_high: u32,
    /// Percentage of the cycles in which the CPU was asleep.
    pub asleep_percent: f64,
    /// Flash that the code and the robot's section occupy, bytes.
    pub flash: u32,
    /// The RAM in use; `None` for an image that is not an ELF, because such an image does not contain the end of the
    /// data.
    #[serde(flatten)]
    pub ram: Option<RamUse>,
    /// Number of received bytes lost because the firmware read them too late.
    pub overruns: u64,
    /// The number of watchdog resets.
    pub resets: u64,
    /// The firmware's final state, as a message.
    pub ended: String,
    /// Path of the picture.
    pub svg: String,
    /// The servo angles of every frame.
    pub frames: Run<'a>,
}

impl Report<'_> {
    /// Prints the report as tables and text, without the dialogue.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn print(&self, out: &mut impl Write) -> io::Result<()> {
        self.print_servos(out)?;
        self.print_displacements(out)?;
        self.print_summary(out)
    }

    fn print_servos(&self, out: &mut impl Write) -> io::Result<()> {
        for heading in [
            "servo         pulses    min us    max us   width error  period error   fastest",
            "                                              (cycles)      (cycles)   (deg/s)",
        ] {
            writeln!(out, "{heading}")?;
        }
        for row in &self.servos {
            let width_error = row
                .width_error
                .map_or("?".to_owned(), |error| error.to_string());
            writeln!(
                out,
                "{} {} {:<5} {:>9} {:>9.2} {:>9.2} {:>13} {:>13} {:>9.1}",
                row.servo,
                row.leg,
                row.pin,
                row.pulse_count,
                row.min_us,
                row.max_us,
                width_error,
                row.period_error,
                row.slew
            )?;
        }
        if self.servos.iter().any(|row| row.width_error.is_none()) {
            writeln!(
                out,
                "?: this firmware was not built from the same source as this program"
            )?;
        }
        writeln!(out)
    }

    fn print_displacements(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(
            out,
            "predicted path       from      to   forward      left      turn"
        )?;
        for row in &self.displacements {
            let format_cell = |value: Option<f64>, decimals: usize| {
                let rounded = value.map(|value| round_to_decimals(value, decimals as i32));
                format_or_dash(rounded, decimals)
            };
            writeln!(
                out,
                "{:<16} {:>6.2} s {:>5.2} s {:>6} mm {:>6} mm {:>6} deg",
                row.span.command,
                row.span.start_s,
                row.span.end_s,
                format_cell(row.displacement.forward, 1),
                format_cell(row.displacement.left, 1),
                format_cell(row.displacement.turn, 2)
            )?;
        }
        if self.frames.robot.drive().can_lag() {
            writeln!(
                out,
                "Here the legs follow their servos exactly; in `lizard twin` they lag."
            )?;
        }
        let is_undetermined =
            |row: &CommandDisplacement| row.displacement.components().contains(&None);
        if self.displacements.iter().any(is_undetermined) {
            write!(out, "{UNDETERMINED_NOTE}")?;
        }
        writeln!(out)
    }

    fn print_summary(&self, out: &mut impl Write) -> io::Result<()> {
        if let Some(min_margin) = &self.safety.min_margin {
            writeln!(
                out,
                "smallest margin {:.3} ({}) at {:.2} s; slider travel {:+.1} to {:+.1} mm",
                min_margin.value,
                min_margin.check,
                min_margin.seconds,
                round_to_decimals(self.safety.stroke[0], 1),
                round_to_decimals(self.safety.stroke[1], 1)
            )?;
        }
        if let Some(reason) = &self.safety.first_violation {
            let frame_count = self.safety.violation_count;
            writeln!(
                out,
                "{frame_count} frames violate a limit of robot.toml; first violation: {reason}"
            )?;
        }
        let ram_text = self.ram.as_ref().map_or_else(String::new, |ram| {
            let (spare, data) = (ram.stack_spare, ram.static_ram);
            format!("static RAM {data} B, {spare} B free below the stack, ")
        });
        writeln!(
            out,
            "CPU asleep {:.1} %, flash {} B, {ram_text}bytes lost {}, resets {}, pins high at once {}",
            self.asleep_percent, self.flash, self.overruns, self.resets, self.max_pins_high
        )?;
        writeln!(
            out,
            "{:.1} s simulated ({}) in {:.2} s; {}",
            self.seconds, self.fidelity, self.wall_seconds, self.ended
        )?;
        writeln!(out, "picture: {}", self.svg)
    }
}

/// A program's RAM use.
#[derive(Debug, Serialize)]
pub struct RamUse {
    /// Bytes of static data.
    pub static_ram: u16,
    /// Smallest number of bytes between the stack and static data.
    pub stack_spare: u16,
}

impl RamUse {
    /// Measures the RAM of a UNO's program; `None` if the image does not contain the end of its data.
    pub fn measure(uno: &Uno) -> Option<Self> {
        let static_ram = uno.image().static_ram();
        (static_ram > 0).then(|| Self {
            static_ram,
            stack_spare: uno.stack_spare(),
        })
    }
}
