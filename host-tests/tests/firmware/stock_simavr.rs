//! Tests with Debian's own `simavr`, which runs the unchanged ELF and HEX files. Both files start, and a robot whose
//! `boot` setting is a gait walks after power-on.

use std::collections::HashMap;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use lizard_core::virtual_board::RunningRobot;
use lizard_host_tests::{CYCLES_PER_US, FirmwareBench, robot};

/// Time after which simavr is stopped. simavr runs in real time, or slower on a busy machine.
const TIMEOUT: Duration = Duration::from_secs(200);

/// Returns the command for the first gait after `stand`.
fn first_gait_command() -> String {
    robot().gaits()[1].command()
}

/// Writes the HEX file of an EEPROM whose saved settings start the first gait after power-on.
fn write_eeprom(folder: &Path) {
    let mut running_robot = RunningRobot::power_on(*robot().firmware());
    running_robot.run_frames(50);
    let boot_line = format!("boot {}", first_gait_command());
    let answer = running_robot.send_line(&boot_line);
    assert_eq!(answer, format!("ok {boot_line}"));
    running_robot.board.send(b"save\r");
    running_robot.run_frames(200);
    let output_text = running_robot.read_lines().join("\n");
    let is_saved = output_text.is_empty() || output_text.contains("ok save");
    assert!(is_saved, "{output_text}");
    let bytes = *running_robot.board.memory.bytes();
    assert_eq!(bytes[0], 0xa5, "the first copy of the settings is invalid");
    fs::write(folder.join("eeprom.bin"), bytes).expect("the folder is writable");
    let arguments = "-I binary -O ihex --change-addresses 0x810000 eeprom.bin eeprom.hex";
    objcopy(arguments, folder);
}

/// Runs `avr-objcopy` in a folder.
fn objcopy(arguments: &str, folder: &Path) {
    let status = Command::new("avr-objcopy")
        .args(arguments.split(' '))
        .current_dir(folder)
        .status();
    assert!(status.expect("avr-objcopy runs").success(), "{arguments}");
}

/// Runs simavr until its output is complete and returns the output. Ends simavr with SIGTERM, which makes simavr close
/// its files.
fn run_simavr(arguments: &str, folder: &Path, is_complete: impl Fn(&str) -> bool) -> String {
    let output_path = folder.join("output.txt");
    let file = File::create(&output_path).expect("the folder is writable");
    let mut child = Command::new("simavr")
        .args(arguments.split(' '))
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(file.try_clone().expect("the file can be shared"))
        .stderr(file)
        .spawn()
        .expect("scripts/setup has installed simavr");
    let read_output = || {
        let bytes = fs::read(&output_path).expect("the output file exists");
        String::from_utf8_lossy(&bytes).into_owned()
    };
    let deadline = Instant::now() + TIMEOUT;
    while !is_complete(&read_output()) && Instant::now() < deadline {
        sleep(Duration::from_millis(100));
    }
    let pid = rustix::process::Pid::from_child(&child);
    rustix::process::kill_process(pid, rustix::process::Signal::TERM).expect("simavr runs");
    child.wait().expect("simavr ends");
    read_output()
}

/// Tags of simavr's `avr_mcu_section.h`, each with the length of its data: the name of the trace file, and a traced
/// pin.
const VCD_FILENAME: [u8; 2] = [12, 64];
const VCD_PORTPIN: [u8; 2] = [15, 35];

/// Appends a tag and its data, which is padded with zeros, to a list of tags.
fn push_tag(tags: &mut Vec<u8>, tag: [u8; 2], data: &[u8]) {
    let end = tags.len() + tag.len() + usize::from(tag[1]);
    tags.extend(tag);
    tags.extend(data);
    tags.resize(end, 0);
}

/// Returns simavr's tags for a trace file and for each pin to be traced.
fn build_trace_tags(pins: [u8; 4]) -> Vec<u8> {
    let mut tags = Vec::new();
    push_tag(&mut tags, VCD_FILENAME, b"pins.vcd");
    for (pin, digit) in pins.into_iter().zip(b'1'..) {
        let (port, bit) = match pin {
            0..8 => (b'D', pin),
            8..14 => (b'B', pin - 8),
            _ => (b'C', pin - 14),
        };
        push_tag(&mut tags, VCD_PORTPIN, &[port, bit, 0, b'A', digit]);
    }
    tags
}

/// Returns the widths of each servo's pulses in us, from a trace file with steps of 10 ns.
fn parse_widths(vcd: &str) -> HashMap<String, Vec<f64>> {
    let (mut names, mut rises_us, mut now_us) = (HashMap::new(), HashMap::new(), 0.0);
    let mut widths: HashMap<String, Vec<f64>> = HashMap::new();
    for line in vcd.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let ["$var", _, _, code, name, ..] = words[..] {
            names.insert(code.to_owned(), name.to_owned());
        } else if let Some(time) = line.strip_prefix('#') {
            now_us = time.trim().parse::<f64>().expect("a time is a number") / 100.0;
        } else if let Some(code) = line.strip_prefix('1') {
            rises_us.insert(code.trim().to_owned(), now_us);
        } else if let Some(code) = line.strip_prefix('0')
            && let Some(rise_us) = rises_us.remove(code.trim())
        {
            let name = names.get(code.trim()).expect("the signal has a name");
            let widths = widths.entry(name.clone()).or_default();
            widths.push(now_us - rise_us);
        }
    }
    widths
}

#[test]
fn the_elf_file_walks_in_debians_simavr() {
    let folder = tempfile::tempdir().expect("the folder is writable");
    let folder = folder.path();
    write_eeprom(folder);
    fs::copy(FirmwareBench::elf_path(), folder.join("lizard.elf"))
        .expect("`make firmware` has built the firmware");
    // `traced.elf` is the same file with trace tags for four pins added to its own tags.
    let arguments = "-O binary -j .mmcu --set-section-flags .mmcu=alloc lizard.elf mmcu.bin";
    objcopy(arguments, folder);
    let mut mmcu = fs::read(folder.join("mmcu.bin")).expect("avr-objcopy has written the section");
    let end = mmcu.len() - 2;
    mmcu.splice(end..end, build_trace_tags(robot().firmware().pins()));
    fs::write(folder.join("mmcu.bin"), mmcu).expect("the folder is writable");
    let arguments = "--update-section .mmcu=mmcu.bin lizard.elf traced.elf";
    objcopy(arguments, folder);
    let vcd_path = folder.join("pins.vcd");
    let arguments = "-m atmega328p -f 16000000 traced.elf -ee eeprom.hex";
    let output_text = run_simavr(arguments, folder, |_| {
        // 30 000 bytes, about 20 for each edge, cover the three seconds before the gait and two of its cycles.
        fs::metadata(&vcd_path).is_ok_and(|file| file.len() > 30_000)
    });
    let boot_note = format!("# boot: {}", first_gait_command());
    assert!(output_text.contains(&boot_note), "{output_text}");
    assert!(!output_text.contains("fault"), "{output_text}");
    assert!(!output_text.contains("supply"), "{output_text}");
    let vcd = fs::read_to_string(vcd_path).expect("simavr has written the trace");
    assert!(vcd.contains("$timescale 10ns $end"), "{}", &vcd[..80]);
    let widths_us = parse_widths(&vcd);
    for (number, calibration) in (1..).zip(robot().firmware().calibration()) {
        let servo_widths_us = &widths_us[&format!("A{number}")];
        let [min_us, max_us] = [f64::min, f64::max].map(|pick| {
            let extreme = servo_widths_us.iter().copied().reduce(pick);
            extreme.expect("the servo has pulses")
        });
        let pulse_count = servo_widths_us.len();
        assert!(pulse_count > 150, "{pulse_count} pulses");
        let case = format!("A{number}: pulses between {min_us} and {max_us} us");
        assert!(max_us - min_us > 50.0, "does not turn, {case}");
        let limits = [calibration.travel_min, calibration.travel_max]
            .map(|limit| f64::from(calibration.clamped_width(limit)) / CYCLES_PER_US);
        let (low_us, high_us) = (limits[0].min(limits[1]), limits[0].max(limits[1]));
        assert!(low_us - 0.1 <= min_us && max_us <= high_us + 0.1, "{case}");
    }
}

/// A HEX file does not contain the supply voltage, so simavr assumes 3.3 V. This is too low for servos, and the
/// firmware must report it.
#[test]
fn the_hex_files_start_in_debians_simavr_and_report_its_low_voltage() {
    let folder = tempfile::tempdir().expect("the folder is writable");
    let folder = folder.path();
    let elf = FirmwareBench::elf_path();
    fs::copy(elf.with_extension("hex"), folder.join("firmware.hex"))
        .expect("`make firmware` has built the firmware");
    let image = lizard_upload::Image::new(FirmwareBench::image().flash())
        .expect("the flash makes an image");
    fs::write(folder.join("image.hex"), image.to_hex()).expect("the folder is writable");
    for file in ["firmware.hex", "image.hex"] {
        let arguments = format!("-m atmega328p -f 16000000 {file}");
        let output_text = run_simavr(&arguments, folder, |text| text.contains("3.30 V"));
        let name = lizard_host::firmware::format_robot_label(robot().firmware());
        for part in [format!("robot {name},").as_str(), "3.30 V"] {
            assert!(
                output_text.contains(part),
                "{file}, no {part:?}: {output_text}"
            );
        }
    }
}
