//! Tests of the program `simulated-uno`, run from the command line.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use lizard_time_limit::TIME_LIMIT;
use simulated_uno::avr_gcc;

/// Program that sends `ready` at its start and answers every line with `got` and the line's first letter.
const ANSWER_PROGRAM: &str = r#"
    #include <avr/io.h>
    static void put(const char *text) {
        for (; *text; text++) { while (!(UCSR0A & 1 << UDRE0)) {} UDR0 = *text; }
    }
    static char get(void) { while (!(UCSR0A & 1 << RXC0)) {} return UDR0; }
    int main(void) {
        UCSR0A = 1 << U2X0; UBRR0 = 16; UCSR0B = 1 << RXEN0 | 1 << TXEN0;
        put("ready\r\n");
        for (;;) {
            char first[] = "?\n", next = get();
            first[0] = next;
            while (next != '\n') next = get();
            put("got "); put(first);
        }
    }"#;

/// Program that sets D9 high for exactly 16 000 cycles, 1 ms, then low for at least 47 999.
const PULSES_PROGRAM: &str = "
    #include <avr/io.h>
    int main(void) {
        DDRB = 2;
        for (;;) {
            PORTB = 2; __builtin_avr_delay_cycles(15999); PORTB = 0;
            __builtin_avr_delay_cycles(48000);
        }
    }";

fn run_program(file: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_simulated-uno"));
    command.arg(file).args(arguments);
    let output = TIME_LIMIT.run_command(&mut command, b"");
    output.expect("simulated-uno runs")
}

/// Compiles a source and returns the paths of its ELF and Intel HEX files.
fn compile(folder: &Path, source: &str) -> [std::path::PathBuf; 2] {
    let [c, elf, hex] = ["program.c", "program.elf", "program.hex"].map(|name| folder.join(name));
    fs::write(&c, source).expect("the file can be written");
    avr_gcc::run(&["-O2", "-std=gnu11"], &[c.as_ref()], &elf).expect("the source compiles");
    let mut objcopy = Command::new("avr-objcopy");
    objcopy.args(["-O", "ihex", "-R", ".eeprom"]);
    objcopy.args([&elf, &hex]);
    let output = TIME_LIMIT.run_command(&mut objcopy, b"");
    let output = output.expect("avr-objcopy runs");
    assert!(output.status.success(), "{output:?}");
    [elf, hex]
}

/// Compiles a source and runs `simulated-uno` with its Intel HEX file.
fn run_source(source: &str, arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let [_, hex] = compile(folder.path(), source);
    run_program(&hex, arguments)
}

fn to_text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("the output is UTF-8")
}

#[test]
fn hex_and_elf_files_of_a_program_give_the_same_pulses() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let [elf, hex] = compile(folder.path(), PULSES_PROGRAM);
    // Intel HEX does not contain the size of the static data, so the report omits the memory.
    for (file, reports_memory) in [(elf, true), (hex, false)] {
        let output = run_program(&file, &["--ms", "100"]);
        assert!(output.status.success(), "{output:?}");
        let output_text = to_text(&output.stdout);
        let row = output_text.lines().find(|line| line.starts_with("D9"));
        let row = row.unwrap_or_else(|| panic!("no D9 in {output_text}"));
        let row: Vec<&str> = row.split_whitespace().collect();
        let expected_cells = ["D9", "25", "1000.0000", "1000.0000"];
        assert_eq!(row[..4], expected_cells, "{output_text}");
        let has_memory = output_text.contains("data 0 bytes, stack ");
        assert_eq!(has_memory, reports_memory, "{output_text}");
        let period: f64 = row[4].parse().expect("the period is a number");
        assert!((4000.0..4001.0).contains(&period), "{output_text}");
        for text in ["awake 100.0 %", "The program is still running."] {
            assert!(output_text.contains(text), "no {text} in {output_text}");
        }
    }
}

#[test]
fn the_option_pulses_lists_every_pulse() {
    let output = run_source(PULSES_PROGRAM, &["--ms", "10", "--pulses"]);
    let output_text = to_text(&output.stdout);
    let rows = output_text.lines().filter(|line| line.starts_with("D9"));
    let widths = rows.filter_map(|row| row.split_whitespace().nth(2));
    let widths: Vec<&str> = widths.collect();
    assert_eq!(widths, ["1000.0000"; 3], "{output_text}");
}

#[test]
fn sent_lines_and_answers_are_printed_with_their_times() {
    for extra_arguments in [&["--stock"][..], &[]] {
        let mut arguments = vec!["--ms", "60", "--say", "40:stop", "--say", "20:walk"];
        arguments.extend(extra_arguments);
        let output = run_source(ANSWER_PROGRAM, &arguments);
        let output_text = to_text(&output.stdout);
        let lines: Vec<(f64, &str)> = output_text
            .lines()
            .filter_map(|line| line.split_once(" ms  "))
            .map(|(ms, text)| (ms.trim().parse().expect("the time is a number"), text))
            .collect();
        let texts: Vec<&str> = lines.iter().map(|line| line.1).collect();
        let expected_texts = ["ready", "> walk", "got w", "> stop", "got s"];
        assert_eq!(texts, expected_texts, "{output_text}");
        for (line, ms) in lines.iter().zip([0.0, 20.0, 20.0, 40.0, 40.0]) {
            assert!((ms..ms + 2.0).contains(&line.0), "{output_text}");
        }
        let pin_text = "No pin from D2 to A5 has changed.";
        assert!(output_text.contains(pin_text), "{output_text}");
    }
}

#[test]
fn invalid_files_end_with_exit_code_1_and_invalid_arguments_with_2() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let file = folder.path().join("incomplete.hex");
    fs::write(&file, ":02000000FFCF30\n").expect("the file can be written");
    let incomplete_output = run_program(&file, &[]);
    assert_eq!(incomplete_output.status.code(), Some(1));
    let error = to_text(&incomplete_output.stderr);
    let expected_end = "no end record, so it is incomplete\n";
    assert!(error.ends_with(expected_end), "{error}");
    let missing_output = run_program(&folder.path().join("missing.hex"), &[]);
    assert_eq!(missing_output.status.code(), Some(1));
    assert!(to_text(&missing_output.stderr).contains("missing.hex"));
    let usage_output = run_program(&file, &["--say", "walk"]);
    assert_eq!(usage_output.status.code(), Some(2));
    assert!(to_text(&usage_output.stderr).contains("such as 500:walk"));
}

#[test]
fn a_crash_is_reported_and_ends_with_exit_code_1() {
    let output = run_source("int main(void) { *(volatile char *)0x0fff = 1; }", &[]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let output_text = to_text(&output.stdout);
    let is_reported = output_text.contains("The program crashed at 0x");
    assert!(is_reported, "{output_text}");
}

#[test]
fn control_characters_in_serial_text_are_escaped() {
    let source = ANSWER_PROGRAM.replace("ready\\r\\n", "\\033[2Jblank\\n");
    let output_text = to_text(&run_source(&source, &["--ms", "5"]).stdout);
    assert!(output_text.contains("\\u{1b}[2Jblank"), "{output_text}");
    assert!(!output_text.contains('\u{1b}'), "{output_text}");
}
