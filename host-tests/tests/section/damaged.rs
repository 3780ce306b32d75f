//! Tests with damaged sections: the core refuses them, and a damaged section with a valid checksum cannot harm a servo.
//! On the host, the core runs with overflow and bounds checking, for which the chip has no room: an overflow, or a read
//! beyond the section's end, fails the test.

use std::mem::offset_of;

use fastrand::Rng;
use lizard_core::guard::hazard::Hazard;
use lizard_core::motion::Activity;
use lizard_core::numbers::calibration::Calibration;
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::limits::Limits;
use lizard_core::numbers::robot::Robot;
use lizard_core::numbers::section::{
    FORMAT, Header, MAGIC, Numbers, REGION_BYTES, Region, SectionError, write_checksum,
};
use lizard_core::numbers::units::{CYCLES_PER_US, PulseWidth, Sine, Sweep};
use lizard_core::virtual_board::RunningRobot;
use lizard_host_tests::rng;
use lizard_robot::keep_section;

use crate::sections;

/// The byte range of the format in a header.
const FORMAT_BYTES: std::ops::Range<usize> = 4..6;

/// The byte range of the length in a header.
const LENGTH_BYTES: std::ops::Range<usize> = 6..8;

/// The lines that [`check_motion`] sends besides gaits, poses and `center`.
const OTHER_LINES: [&str; 6] = ["status", "help", "cal", "save", "rest", "stand"];

fn find_damage(section: &[u8]) -> Option<SectionError> {
    Robot::open(Region::new(section)).err()
}

/// Returns flash contents in which only these first bytes of a section have been written.
fn build_partly_written_flash(section: &[u8]) -> Vec<u8> {
    let mut flash = section.to_vec();
    flash.resize(REGION_BYTES.into(), 0xff);
    flash
}

#[test]
fn any_bytes_may_follow_a_valid_section() {
    for (named_robot, section) in sections() {
        assert_eq!(find_damage(section), None, "{}", named_robot.name);
        for filler in [0, 0x55, 0xff] {
            let mut flash = section.clone();
            flash.resize(REGION_BYTES.into(), filler);
            assert_eq!(
                find_damage(&flash),
                None,
                "{} before {filler}",
                named_robot.name
            );
        }
    }
}

#[test]
fn a_section_with_any_flipped_bit_is_refused() {
    let files = sections()
        .iter()
        .filter(|(named_robot, _)| named_robot.name.ends_with(".toml"));
    let mut file_count = 0;
    for (named_robot, section) in files {
        file_count += 1;
        let mut section = build_partly_written_flash(section);
        let length =
            u16::from_le_bytes([section[LENGTH_BYTES.start], section[LENGTH_BYTES.start + 1]]);
        for bit in 0..8 * usize::from(length) {
            section[bit / 8] ^= 1 << (bit % 8);
            let expected = match bit / 8 {
                0..4 => SectionError::Missing,
                index if FORMAT_BYTES.contains(&index) => SectionError::OtherFormat,
                _ => SectionError::Damaged,
            };
            let damage = find_damage(&section);
            assert_eq!(damage, Some(expected), "{} bit {bit}", named_robot.name);
            section[bit / 8] ^= 1 << (bit % 8);
        }
    }
    assert!(file_count >= 4, "{file_count} files");
}

#[test]
fn a_section_cut_at_any_byte_is_refused() {
    for (named_robot, section) in sections() {
        for length in 0..section.len() {
            let cut_section = &section[..length];
            let damage = find_damage(cut_section);
            assert!(damage.is_some(), "{} cut at {length}", named_robot.name);
            // The missing bytes may be the same as erased flash.
            if section[length..].iter().any(|byte| *byte != 0xff) {
                let damage = find_damage(&build_partly_written_flash(cut_section));
                assert!(damage.is_some(), "{} erased at {length}", named_robot.name);
            }
        }
    }
}

#[test]
fn a_section_of_any_other_format_is_reported_as_such() {
    let (_, section) = &sections()[0];
    let mut section = section.clone();
    let own_format =
        u16::from_le_bytes([section[FORMAT_BYTES.start], section[FORMAT_BYTES.start + 1]]);
    for format in (0..=u16::MAX).filter(|format| *format != own_format) {
        section[FORMAT_BYTES].copy_from_slice(&format.to_le_bytes());
        let damage = find_damage(&section);
        assert_eq!(damage, Some(SectionError::OtherFormat), "{format}");
    }
}

#[test]
fn flash_filled_with_any_byte_is_refused() {
    for byte in 0..=u8::MAX {
        let flash = [byte; REGION_BYTES as usize];
        assert_eq!(find_damage(&flash), Some(SectionError::Missing), "{byte}");
    }
    assert_eq!(find_damage(&[]), Some(SectionError::Missing));
}

#[test]
fn a_hundred_thousand_random_sections_are_refused() {
    let rng = &mut rng(150);
    for index in 0..100_000 {
        let mut section = vec![0; rng.usize(..=usize::from(REGION_BYTES))];
        rng.fill(&mut section);
        // The core checks the next field of the header only if the previous field is valid.
        if index % 4 > 0 {
            put_bytes(&mut section, 0, &MAGIC.to_le_bytes());
        }
        if index % 4 > 1 {
            put_bytes(&mut section, FORMAT_BYTES.start, &FORMAT.to_le_bytes());
        }
        if index % 4 > 2 {
            let length = section.len() as u16;
            put_bytes(&mut section, LENGTH_BYTES.start, &length.to_le_bytes());
        }
        // One section in 65 536 has a valid checksum, but the core refuses its numbers.
        assert!(find_damage(&section).is_some(), "section {index}");
    }
}

fn put_bytes(section: &mut [u8], offset: usize, bytes: &[u8]) {
    if let Some(field) = section.get_mut(offset..offset + bytes.len()) {
        field.copy_from_slice(bytes);
    }
}

#[test]
fn random_sections_with_a_valid_header_and_checksum_are_refused_or_harmless() {
    let rng = &mut rng(151);
    for _ in 0..20_000 {
        let min_length = size_of::<Header>() + size_of::<Numbers>();
        let mut section = vec![0; rng.usize(min_length..=usize::from(REGION_BYTES))];
        rng.fill(&mut section);
        let (_, valid_section) = rng.choice(sections()).expect("there are sections");
        put_bytes(&mut section, 0, &valid_section[..LENGTH_BYTES.start]);
        let length = section.len() as u16;
        put_bytes(&mut section, LENGTH_BYTES.start, &length.to_le_bytes());
        write_checksum(&mut section);
        if find_damage(&section).is_none() {
            check_motion(rng, &section);
        }
    }
}

#[test]
fn robots_with_changed_numbers_are_refused_or_harmless() {
    let rng = &mut rng(152);
    let (mut refused_count, mut accepted_count) = (0, 0);
    for index in 0..100_000 {
        let (_, section) = rng.choice(sections()).expect("there are sections");
        let mut section = section.clone();
        for _ in 0..=rng.usize(..4) {
            change_random_number(rng, &mut section);
        }
        write_checksum(&mut section);
        match find_damage(&section) {
            Some(SectionError::Harmful) => refused_count += 1,
            Some(error) => panic!("section {index} is {error:?}"),
            None => {
                accepted_count += 1;
                if accepted_count % 20 == 0 {
                    check_motion(rng, &section);
                }
            }
        }
    }
    let counts = format!("{refused_count} refused, {accepted_count} accepted");
    println!("{counts}");
    assert!(refused_count > 10_000 && accepted_count > 5_000, "{counts}");
}

/// The section's gaits exceed the travel that the section declares, and its limits accept any margin and stroke.
#[test]
fn a_gait_that_would_leave_the_travel_is_held() {
    let rng = &mut rng(154);
    let mut held_count = 0;
    for (named_robot, _) in sections() {
        let mut content = named_robot.robot.content().clone();
        content.limits = Limits {
            type2: Sine(i16::MIN),
            type1: Sine(i16::MIN),
            leg: Sine(i16::MIN),
        };
        for side in &mut content.sliders {
            (side.stroke_min, side.stroke_max) = (0, u16::MAX);
        }
        for wave in &mut content.waves {
            wave.fill_with(|| rng.i16(..));
        }
        let gaits = content.gaits[1..].iter_mut();
        for channel in gaits.flat_map(|gait| &mut gait.channels) {
            channel.gain = rng.i16(..);
        }
        let robot =
            Robot::open(keep_section(&content.section_bytes())).expect("every number is in range");
        for id in GaitId::all(robot.gait_count()).skip(1) {
            let mut running_robot = RunningRobot::power_on(robot);
            run_frames(&mut running_robot, 30);
            let name: String = robot.gait_name(id).map(char::from).collect();
            assert_eq!(running_robot.send_line(&name), format!("ok {name}"));
            run_frames(&mut running_robot, 300);
            if running_robot.motion().activity() == Activity::Stop {
                let hazard = running_robot.motion().hazard();
                assert!(matches!(hazard, Some(Hazard::Travel(_))), "{hazard:?}");
                assert_eq!(running_robot.status_value("guard"), "held");
                held_count += 1;
            }
        }
    }
    assert!(held_count > 50, "{held_count} gaits were held");
}

/// In the section, a neutral angle is outside the servo's travel, so the robot could not stand.
#[test]
fn a_robot_whose_servo_cannot_reach_its_neutral_angle_is_refused() {
    for (named_robot, _) in sections() {
        for servo in 0..4 {
            for [min, max] in [[1, 9000], [-9000, -1], [1, -1], [100, 50]] {
                let mut content = named_robot.robot.content().clone();
                let calibration = &mut content.calibration[servo];
                (calibration.travel_min, calibration.travel_max) = (Sweep(min), Sweep(max));
                let needed_travel = &mut content.needed_travel[servo];
                (needed_travel.min, needed_travel.max) = (Sweep(min), Sweep(max));
                let damage = find_damage(&content.section_bytes());
                let case = format!("{} {servo} {min} {max}", named_robot.name);
                assert_eq!(damage, Some(SectionError::Harmful), "{case}");
            }
        }
    }
}

/// Changes a random number in a section: in the servos, pins or limits, or in the parts after `Numbers` (curves, gaits,
/// waveforms, maps). Leaves the link lengths and the offsets of the parts unchanged, because the firmware trusts them
/// after the host's check.
fn change_random_number(rng: &mut Rng, section: &mut [u8]) {
    let numbers_start = size_of::<Header>();
    let offset = match rng.u8(..4) {
        0 | 1 => {
            numbers_start
                + rng.usize(offset_of!(Numbers, neutral_angles)..offset_of!(Numbers, curves))
        }
        2 => numbers_start + rng.usize(offset_of!(Numbers, rail_pin)..offset_of!(Numbers, maps)),
        _ => rng.usize(numbers_start + size_of::<Numbers>()..section.len() - 1),
    };
    let offset = offset & !1;
    let old_word = u16::from_le_bytes([section[offset], section[offset + 1]]);
    let new_word = match rng.u8(..6) {
        0 => rng.u16(..),
        1 => old_word ^ 1 << rng.u8(..16),
        2 => old_word.wrapping_add(rng.u16(..10)).wrapping_sub(5),
        3 => *rng
            .choice(&[0, 1, 0x7fff, 0x8000, 0x8001, 0xffff])
            .expect("the list is not empty"),
        4 => old_word.wrapping_neg(),
        _ => old_word.wrapping_mul(rng.u16(2..5)),
    };
    section[offset..offset + 2].copy_from_slice(&new_word.to_le_bytes());
}

/// Runs a robot with an accepted section and random commands. Checks that every frame completes and that no servo turns
/// beyond its travel.
fn check_motion(rng: &mut Rng, section: &[u8]) {
    let robot = Robot::open(keep_section(section)).expect("the section is accepted");
    let mut running_robot = RunningRobot::power_on(robot);
    run_frames(&mut running_robot, 30);
    let gaits: Vec<GaitId> = GaitId::all(robot.gait_count()).collect();
    for _ in 0..8 {
        let line = match rng.u8(..8) {
            0..4 => {
                let id = *rng.choice(&gaits).expect("every robot has `stand`");
                robot.gait_name(id).map(char::from).collect()
            }
            4 | 5 => {
                let angles = robot.neutral_angles().map(|angle| {
                    let angle = f64::from(angle.0) * 360.0 / 65536.0 + 40.0 * rng.f64() - 20.0;
                    format!("{:.2}", angle.rem_euclid(360.0))
                });
                format!("pose {}", angles.join(" "))
            }
            6 => "center".to_string(),
            _ => OTHER_LINES[rng.usize(..OTHER_LINES.len())].to_string(),
        };
        running_robot.board.send(line.as_bytes());
        running_robot.board.send(b"\r");
        run_frames(&mut running_robot, 40);
    }
}

/// Runs frames and checks that no servo turns beyond its travel.
fn run_frames(running_robot: &mut RunningRobot, count: u32) {
    for _ in 0..count {
        let pulses = running_robot.run_frame();
        running_robot.board.transmitter.text.clear();
        let calibration = running_robot.motion().calibration();
        for (pulse, servo) in pulses.0.into_iter().zip(calibration) {
            check_pulse(pulse, servo);
        }
    }
}

/// Checks that a pulse is within the servo's travel and between 500 and 2500 us. A width of 0 means no pulse.
fn check_pulse(pulse: PulseWidth, servo: &Calibration) {
    let ends = [servo.travel_min, servo.travel_max];
    let [first_end, second_end] = ends.map(|sweep| servo.clamped_width(sweep));
    let travel_range = first_end.min(second_end)..=first_end.max(second_end);
    let allowed_range = 500 * CYCLES_PER_US - 1..=2500 * CYCLES_PER_US + 1;
    assert!(
        pulse.0 == 0 || travel_range.contains(&pulse.0) && allowed_range.contains(&pulse.0),
        "{pulse:?} of {servo:?}"
    );
}
