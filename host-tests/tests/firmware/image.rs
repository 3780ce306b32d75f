//! Tests of the firmware's ELF file: it contains no panics, no floating point and no `core::fmt`, and its tables stay
//! in flash.

use std::process::Command;

use lizard_host_tests::{FirmwareBench, robot, root};
use simulated_uno::{Fidelity, Image, SRAM_END, SRAM_START, vector_name};

use crate::{Status, boot_to_stand};

fn image() -> Image {
    FirmwareBench::image()
}

/// Finds the functions whose paths contain one of these parts, and returns the paths.
fn find_function_paths(parts: &[&str]) -> Vec<String> {
    let image = image();
    let functions = image.symbols().iter().filter(|symbol| symbol.is_function);
    let paths: Vec<String> = functions.map(|symbol| symbol.path()).collect();
    let is_frame_function = |path: &String| path.ends_with("Controller::compute_frame");
    let has_symbols = paths.iter().any(is_frame_function);
    assert!(has_symbols, "the ELF has no symbols");
    let is_wanted = |path: &String| parts.iter().any(|part| path.contains(part));
    paths.into_iter().filter(is_wanted).collect()
}

#[test]
fn the_image_contains_no_panic_code() {
    let functions = find_function_paths(&[
        "panic",
        "rust_begin_unwind",
        "unwrap_failed",
        "expect_failed",
        "bounds_check",
    ]);
    assert!(functions.is_empty(), "{functions:?}");
}

#[test]
fn the_image_does_not_contain_core_fmt() {
    let functions = find_function_paths(&["core::fmt", "Formatter", "Display", "Debug"]);
    assert!(functions.is_empty(), "{functions:?}");
}

#[test]
fn the_image_contains_no_floating_point_routines() {
    // Looks for routines of avr-libc, compiler-rt (such as __addsf3, __muldf3, __floatsisf, __fixunssfsi, __fp_split3)
    // and libm.
    let image = image();
    let functions = image.symbols().iter().filter(|symbol| symbol.is_function);
    let is_float = |name: &str| {
        let bare_name = name.trim_start_matches('_');
        let is_runtime_routine = name.starts_with("__");
        let suffixes = ["sf2", "sf3", "df2", "df3", "sf", "df"];
        is_runtime_routine
            && (suffixes.iter().any(|suffix| bare_name.ends_with(suffix))
                || bare_name.starts_with("fp_")
                || bare_name.starts_with("float")
                || bare_name.starts_with("fix"))
            || [
                "sinf", "cosf", "sqrtf", "sin", "cos", "sqrt", "atan2", "acos",
            ]
            .contains(&bare_name)
            || name.contains("f32")
            || name.contains("f64")
            || name.contains("libm")
    };
    let names = functions.map(|symbol| symbol.name.as_str());
    let float_names: Vec<&str> = names.filter(|name| is_float(name)).collect();
    assert!(float_names.is_empty(), "{float_names:?}");
}

#[test]
fn tables_and_messages_stay_in_flash() {
    let bench = boot_to_stand(Fidelity::DataSheet);
    let ram = (SRAM_START..SRAM_END).map(|address| bench.uno.peek(address));
    let ram: Vec<u8> = ram.collect();
    let ram_contains = |bytes: &[u8]| ram.windows(bytes.len()).any(|window| window == bytes);
    let waves = robot().firmware().waves();
    for n in 0..waves.len() {
        let wave = waves.get(n).expect("the waveform exists").load();
        for samples in wave.windows(6) {
            // A held leg gives a sequence of equal values, which RAM may contain by chance.
            if samples.iter().all(|sample| *sample == samples[0]) {
                continue;
            }
            let bytes = samples.iter().flat_map(|sample| sample.to_le_bytes());
            let bytes: Vec<u8> = bytes.collect();
            assert!(!ram_contains(&bytes), "wave {n} is in RAM");
        }
    }
    // The robot has printed none of these messages yet.
    for message in [
        "unknown command",
        "must be",
        "margin of",
        "resting",
        "percent",
        "status",
    ] {
        assert!(!ram_contains(message.as_bytes()), "{message:?} is in RAM");
    }
    assert!(
        ram_contains(b"# lizard"),
        "the banner is not in RAM, although it was just sent"
    );
}

#[test]
fn no_interrupt_has_a_higher_priority_than_the_servos() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    for line in ["walk", "help", "status", "rest", "stand"] {
        bench.say(line);
        bench.run_ms(300);
    }
    let stats = bench.uno.interrupt_stats();
    let used_vectors = stats.iter().map(|interrupt| vector_name(interrupt.vector));
    let used_vectors: Vec<&str> = used_vectors.collect();
    assert_eq!(
        used_vectors,
        ["TIMER1_COMPA", "TIMER1_COMPB", "USART_RX", "USART_UDRE"]
    );
    assert_eq!(Status::read(&mut bench).number("late"), 0.0);
}

#[test]
fn the_error_for_an_image_that_does_not_fit_names_the_excess_and_the_largest_functions() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let changed_elf = folder.path().join("changed.elf");
    let image = image();
    let symbol = |name: &str| image.symbol(name).expect("the ELF has the symbol");
    let code_end = symbol("__code_end").address;
    // The script takes the bounds of the robot's section from two symbols. Moving a symbol makes the code or the robot
    // too large.
    let check_with_symbol = |symbol: &str, address: u64| {
        let status = Command::new("avr-objcopy")
            .arg(format!("--strip-symbol={symbol}"))
            .args(["--add-symbol", &format!("{symbol}={address:#x}")])
            .args([&FirmwareBench::elf_path(), &changed_elf])
            .status();
        assert!(status.expect("avr-objcopy runs").success());
        let output = Command::new(root().join("scripts/size"))
            .arg("--check")
            .arg(&changed_elf)
            .output()
            .expect("scripts/size runs");
        assert!(output.stdout.is_empty());
        let error_text = String::from_utf8(output.stderr).expect("the messages are UTF-8");
        (output.status.success(), error_text)
    };
    assert_eq!(check_with_symbol("unused", 0), (true, String::new()));
    let (is_accepted, message) = check_with_symbol("__robot_start", code_end - 300);
    assert!(!is_accepted);
    let lines: Vec<&str> = message.lines().collect();
    let excess = format!(
        "the firmware does not fit: its code has {code_end} bytes, 300 more than the {} in front",
        code_end - 300
    );
    assert!(lines[0].starts_with(&excess), "{message}");
    assert_eq!(lines.len(), 1 + 10, "{message}");
    let sizes = lines[1..]
        .iter()
        .map(|line| line.trim().split(' ').next()?.parse::<u32>().ok());
    let are_sorted = sizes.is_sorted_by(|larger, smaller| larger.is_some() && larger >= smaller);
    assert!(are_sorted, "{message}");
    let has_frame_function = lines[1..3]
        .iter()
        .any(|line| line.ends_with("::controller::compute_frame"));
    assert!(has_frame_function, "{message}");
    let start = symbol("__robot_start").address;
    let (is_accepted, message) = check_with_symbol("__robot_end", start + 300);
    assert!(!is_accepted);
    assert!(message.starts_with("the robot does not fit: "), "{message}");
}
