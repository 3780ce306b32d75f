//! Prints the results of a run: serial text, pulses, final state and resources.

use std::io::{self, Write};

use simulated_uno::{CYCLES_PER_MS, CYCLES_PER_US, Edge, Pin, SerialByte, State, Uno, pulses};

/// The longest line that is printed in one piece, bytes.
const MAX_LINE_BYTES: usize = 200;

/// The UNO's serial text, printed line by line.
#[derive(Default)]
pub struct SerialText {
    /// The bytes of the partial line.
    unfinished_line: Vec<u8>,
    /// The cycle at which the UNO has sent the last byte.
    last_cycle: u64,
}

impl SerialText {
    /// Adds bytes and prints the lines that they complete.
    pub fn print(&mut self, bytes: &[SerialByte], out: &mut impl Write) -> io::Result<()> {
        for byte in bytes {
            self.last_cycle = byte.cycle;
            if byte.value != b'\n' {
                self.unfinished_line.push(byte.value);
            }
            if byte.value == b'\n' || self.unfinished_line.len() == MAX_LINE_BYTES {
                self.print_line(out)?;
            }
        }
        Ok(())
    }

    /// Prints the bytes after the last line end, if there are any.
    pub fn print_unfinished_line(&mut self, out: &mut impl Write) -> io::Result<()> {
        match self.unfinished_line.is_empty() {
            true => Ok(()),
            false => self.print_line(out),
        }
    }

    fn print_line(&mut self, out: &mut impl Write) -> io::Result<()> {
        let ms = self.last_cycle as f64 / CYCLES_PER_MS as f64;
        let text = String::from_utf8_lossy(&self.unfinished_line);
        let text = escape(text.trim_end_matches('\r'));
        writeln!(out, "{ms:>10.2} ms  {text}")?;
        self.unfinished_line.clear();
        Ok(())
    }
}

/// Escapes control characters, so that a text cannot control the terminal.
pub fn escape(text: &str) -> String {
    let mut escaped = String::new();
    for character in text.chars() {
        match character.is_control() {
            true => escaped.extend(character.escape_default()),
            false => escaped.push(character),
        }
    }
    escaped
}

/// Prints the pulses of all pins that have changed: one line per pulse if `shows_all`, otherwise one line per pin.
pub fn print_pulses(edges: &[Edge], shows_all: bool, out: &mut impl Write) -> io::Result<()> {
    let to_us = |cycles: u64| cycles as f64 / CYCLES_PER_US as f64;
    writeln!(out)?;
    if edges.is_empty() {
        return writeln!(out, "No pin from D2 to A5 has changed.");
    }
    match shows_all {
        true => writeln!(out, "pin      start ms      width us")?,
        false => writeln!(out, "pin    pulses  shortest us   longest us    period us")?,
    }
    for pin in (0..=19).map(Pin::arduino) {
        let pulses = pulses(edges, pin);
        let widths = pulses.iter().map(|pulse| pulse.width);
        let (Some(shortest_width), Some(longest_width)) = (widths.clone().min(), widths.max())
        else {
            if edges.iter().any(|edge| edge.pin == pin) {
                writeln!(out, "{pin:<4} no complete pulse")?;
            }
            continue;
        };
        if shows_all {
            for pulse in &pulses {
                let start = pulse.start as f64 / CYCLES_PER_MS as f64;
                writeln!(out, "{pin:<4} {start:>12.4} {:>13.4}", to_us(pulse.width))?;
            }
            continue;
        }
        let count = pulses.len();
        let total_us = to_us(pulses[count - 1].start - pulses[0].start);
        let period = match count {
            1 => "-".to_owned(),
            _ => format!("{:.4}", total_us / (count - 1) as f64),
        };
        let [shortest, longest] = [shortest_width, longest_width].map(to_us);
        let widths = format!("{shortest:>12.4} {longest:>12.4}");
        writeln!(out, "{pin:<4} {count:>8} {widths} {period:>12}")?;
    }
    Ok(())
}

/// Prints the UNO's final state and the used resources: time, flash, SRAM, CPU time.
pub fn print_summary(uno: &Uno, flash_bytes: u32, out: &mut impl Write) -> io::Result<()> {
    let state = match uno.state() {
        State::Alive => "The program is still running.".to_owned(),
        State::Halted => {
            "The program sleeps with interrupts disabled: only a reset can wake it.".to_owned()
        }
        State::Crashed { pc, message } => format!("The program crashed at {pc:#06x}: {message}."),
        State::Off => "The power is off.".to_owned(),
    };
    let awake_percent = 100.0 * uno.awake_cycles() as f64 / uno.cycle().max(1) as f64;
    // Intel HEX has no symbols, so the end of the static data and the size of the stack are unknown.
    let memory_text = match uno.image().symbols() {
        [] => String::new(),
        _ => format!(
            " data {} bytes, stack at most {} bytes,",
            uno.image().static_ram(),
            uno.stack_used()
        ),
    };
    writeln!(
        out,
        "\n{:.2} ms, flash {flash_bytes} bytes,{memory_text} awake {awake_percent:.1} % of the time. {state}",
        uno.ms(),
    )
}
