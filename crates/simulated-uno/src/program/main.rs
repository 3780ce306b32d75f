//! `simulated-uno program.hex`: runs a program without a board.
//!
//! Prints the lines from the serial port as they arrive, each with its time, then the pulses that an oscilloscope
//! would show on each pin, and a summary.

mod report;

use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use simulated_uno::{CYCLES_PER_MS, Fidelity, Image, LoadError, State, Uno};

/// Run a program on a simulated Arduino UNO, and print its serial text and its pulses.
#[derive(Parser)]
#[command(
    version,
    after_help = "The exit status is 1 if the program cannot be loaded or crashes, or if the output \
                  cannot be written."
)]
struct Arguments {
    /// The program, as Intel HEX (.hex) or ELF (.elf).
    program: PathBuf,
    /// Duration of the run, in milliseconds of the chip's time.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..=3_600_000))]
    ms: u64,
    /// Send a line after this many milliseconds: --say 500:walk. May be given repeatedly.
    #[arg(long, value_name = "MS:LINE", value_parser = parse_line)]
    say: Vec<ScheduledLine>,
    /// The baud rate at which lines are sent; the program determines the rate of its answers.
    #[arg(long, default_value_t = 115_200, value_parser = clap::value_parser!(u32).range(1..=2_000_000))]
    baud: u32,
    /// Print every pulse instead of a summary for each pin.
    #[arg(long)]
    pulses: bool,
    /// Use stock simavr, without the corrections according to the data sheet.
    #[arg(long)]
    stock: bool,
}

/// A line for the serial port, and the time at which it is sent.
#[derive(Clone)]
struct ScheduledLine {
    ms: u64,
    text: String,
}

/// Parses a value of --say, such as `500:walk`.
fn parse_line(argument: &str) -> Result<ScheduledLine, String> {
    let message = "expected a time in ms and a line, such as 500:walk";
    let (ms, text) = argument.split_once(':').ok_or(message)?;
    let ms = ms.parse().map_err(|_| message)?;
    let text = text.to_owned();
    Ok(ScheduledLine { ms, text })
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let image = match Image::read(&arguments.program) {
        Ok(image) => image,
        Err(error) => {
            match error {
                // This message already names the file.
                LoadError::Read { .. } => eprintln!("simulated-uno: {error}"),
                _ => eprintln!("simulated-uno: {}: {error}", arguments.program.display()),
            }
            return ExitCode::FAILURE;
        }
    };
    match run(&arguments, image, &mut io::stdout().lock()) {
        Ok(code) => code,
        // The reader has closed the pipe, as in `simulated-uno blink.hex | head`.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("simulated-uno: cannot print: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the program, and prints its lines, its pulses and a summary.
fn run(arguments: &Arguments, image: Image, out: &mut impl Write) -> io::Result<ExitCode> {
    let fidelity = match arguments.stock {
        true => Fidelity::Stock,
        false => Fidelity::DataSheet,
    };
    let flash_bytes = image.flash_used();
    let mut uno = Uno::with_image(image, fidelity);
    uno.set_baud(f64::from(arguments.baud));
    let mut lines = arguments.say.clone();
    lines.sort_by_key(|line| line.ms);
    lines.retain(|line| line.ms < arguments.ms);
    if lines.len() < arguments.say.len() {
        let ms = arguments.ms;
        eprintln!("simulated-uno: lines at or after --ms {ms} are not sent");
    }
    let mut edges = Vec::new();
    let mut serial_text = report::SerialText::default();
    let mut lines = lines.into_iter().peekable();
    let end_cycle = arguments.ms * CYCLES_PER_MS;
    while *uno.state() == State::Alive && uno.cycle() < end_cycle {
        while let Some(line) = lines.next_if(|line| line.ms * CYCLES_PER_MS <= uno.cycle()) {
            let (ms, text) = (uno.ms(), report::escape(&line.text));
            writeln!(out, "{ms:>10.2} ms  > {text}")?;
            uno.send(line.text.as_bytes());
            uno.send(b"\n");
        }
        uno.run_until_cycle(end_cycle.min(uno.cycle() + CYCLES_PER_MS));
        edges.append(&mut uno.take_edges());
        serial_text.print(&uno.take_transmitted(), out)?;
    }
    serial_text.print_unfinished_line(out)?;
    report::print_pulses(&edges, arguments.pulses, out)?;
    report::print_summary(&uno, flash_bytes, out)?;
    out.flush()?;
    Ok(match uno.state() {
        State::Crashed { .. } => ExitCode::FAILURE,
        _ => ExitCode::SUCCESS,
    })
}
