//! Tests of the firmware's ELF file: it contains no panics, no floating point and no `core::fmt`, and its tables stay
//! in flash.

use std::process::Command;

use lizard_host_tests::{FirmwareBench, robot, root};
use simulated_uno::{Fidelity, SRAM_END, SRAM_START, vector_name};

use crate::{Status, boot_to_stand};

/// Checks that no function's path contains one of these parts.
fn assert_no_function(parts: &[&str]) {
    let image = FirmwareBench::image();
    let functions = image.symbols().iter().filter(|symbol| symbol.is_function);
    let mut paths: Vec<String> = functions.map(|symbol| symbol.path()).collect();
    let is_frame_function = |path: &String| path.ends_with("Controller::compute_frame");
    let has_symbols = paths.iter().any(is_frame_function);
    assert!(has_symbols, "the ELF has no symbols");
    paths.retain(|path| parts.iter().any(|part| path.contains(part)));
    assert!(paths.is_empty(), "{paths:?}");
}

#[test]
fn the_image_contains_no_panic_code() {
    assert_no_function(&[
        "panic",
        "rust_begin_unwind",
        "unwrap_failed",
        "expect_failed",
        "bounds_check",
    ]);
}

#[test]
fn the_image_does_not_contain_core_fmt() {
    assert_no_function(&["core::fmt", "Formatter", "Display", "Debug"]);
}

#[test]
fn the_image_contains_no_floating_point_routines() {
    // Looks for routines of avr-libc, compiler-rt (such as __addsf3, __muldf3, __floatsisf, __fixunssfsi, __fp_split3)
    // and libm.
    let suffixes = ["sf2", "sf3", "df2", "df3", "sf", "df"];
    let prefixes = ["fp_", "float", "fix"];
    let parts = ["f32", "f64", "libm"];
    let libm_names = [
        "sinf", "cosf", "sqrtf", "sin", "cos", "sqrt", "atan2", "acos",
    ];
    let is_float = |name: &str| {
        let bare_name = name.trim_start_matches('_');
        let has_suffix = suffixes.iter().any(|suffix| bare_name.ends_with(suffix));
        let has_prefix = prefixes.iter().any(|prefix| bare_name.starts_with(prefix));
        name.starts_with("__") && (has_suffix || has_prefix)
            || parts.iter().any(|part| name.contains(part))
            || libm_names.contains(&bare_name)
    };
    let image = FirmwareBench::image();
    let functions = image.symbols().iter().filter(|symbol| symbol.is_function);
    let names = functions.map(|symbol| symbol.name.as_str());
    let float_names: Vec<&str> = names.filter(|name| is_float(name)).collect();
    assert!(float_names.is_empty(), "{float_names:?}");
}

#[test]
fn tables_and_messages_stay_in_flash() {
    let bench = boot_to_stand(Fidelity::DataSheet);
    let addresses = SRAM_START..SRAM_END;
    let ram: Vec<u8> = addresses.map(|address| bench.uno.peek(address)).collect();
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
    let expected = ["TIMER1_COMPA", "TIMER1_COMPB", "USART_RX", "USART_UDRE"];
    assert_eq!(used_vectors, expected);
    Status::read(&mut bench).assert_has("late=0");
}

#[test]
fn the_error_for_an_image_that_does_not_fit_names_the_excess_and_the_largest_functions() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let changed_elf = folder.path().join("changed.elf");
    let image = FirmwareBench::image();
    let symbol = |name: &str| image.symbol(name).expect("the ELF has the symbol");
    let code_end = symbol("__code_end").address;
    // `scripts/size` takes the bounds of the robot's section from two symbols. Moving a symbol makes the code or the
    // robot too large.
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
    let room = code_end - 300;
    let (is_accepted, message) = check_with_symbol("__robot_start", room);
    assert!(!is_accepted);
    let lines: Vec<&str> = message.lines().collect();
    let excess = format!("its code has {code_end} bytes, 300 more than the {room} in front");
    let first_line = format!("the firmware does not fit: {excess}");
    assert!(lines[0].starts_with(&first_line), "{message}");
    assert_eq!(lines.len(), 1 + 10, "{message}");
    let parse_size = |line: &&str| line.trim().split(' ').next()?.parse::<u32>().ok();
    let sizes = lines[1..].iter().map(parse_size);
    let are_sorted = sizes.is_sorted_by(|larger, smaller| larger.is_some() && larger >= smaller);
    assert!(are_sorted, "{message}");
    let is_frame_function = |line: &&str| line.ends_with("::controller::compute_frame");
    assert!(lines[1..3].iter().any(is_frame_function), "{message}");
    let start = symbol("__robot_start").address;
    let (is_accepted, message) = check_with_symbol("__robot_end", start + 300);
    assert!(!is_accepted);
    assert!(message.starts_with("the robot does not fit: "), "{message}");
}
