//! Saved settings whose writes were cut off or torn, and whose bits flipped.

use std::vec::Vec;

use super::*;
use crate::memory::record::{ERASED, Progress, RECORD_BYTES};
use crate::memory::settings::Boot;
use crate::numbers::gaits::GaitId;
use crate::numbers::part::Servo;
use crate::numbers::units::Sweep;
use crate::sample::Sample;
use crate::virtual_board::Eeprom;

fn robot() -> Sample {
    Sample::odd()
}

/// The `n`-th of several settings that differ in everything.
fn settings(robot: &Sample, n: i16) -> Settings {
    let mut settings = Settings::of(robot);
    for servo in Servo::ALL {
        let mut adjustment = settings.servo(servo);
        adjustment.trim = Sweep(37 * n - 5 * servo as i16);
        adjustment.min.0 += n;
        adjustment.max.0 -= 2 * n;
        settings.set_servo(servo, adjustment);
    }
    settings.set_deadman(1000 + n as u16);
    settings.set_boot(Boot::Gait(robot.id("sway left")), robot);
    assert_eq!(settings.first_unfit_servo(robot), None);
    settings
}

/// Saves settings as the console does.
fn save_all(settings: &Settings, eeprom: &mut Eeprom) -> Settings {
    let mut saved = *settings;
    if let Some(mut writing) = save(&mut saved, eeprom) {
        loop {
            match writing.step(saved.bytes(), eeprom) {
                Progress::InProgress => {}
                Progress::Done => break,
                Progress::Failed => panic!("worn"),
            }
        }
    }
    saved
}

fn load_settings(robot: &Sample, eeprom: &Eeprom) -> (Settings, SavedState) {
    let mut settings = Settings::of(robot);
    let outcome = load(robot, eeprom, &mut settings);
    (settings, outcome)
}

/// The settings with save number 0, so that settings of different saves can be compared.
fn without_turn(settings: &Settings) -> Settings {
    let mut copy = *settings;
    copy.set_save_number(0);
    copy
}

#[test]
fn the_last_of_a_thousand_saves_is_loaded() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    assert_eq!(
        load_settings(&robot, &eeprom),
        (Settings::of(&robot), SavedState::Blank)
    );
    for n in 0..1000 {
        let new = settings(&robot, n % 70);
        let saved = save_all(&new, &mut eeprom);
        assert_eq!(without_turn(&saved), without_turn(&new));
        assert_eq!(
            load_settings(&robot, &eeprom),
            (saved, SavedState::Latest),
            "{n}"
        );
    }
}

#[test]
fn unchanged_bytes_are_not_written_again() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    save_all(&settings(&robot, 3), &mut eeprom);
    eeprom.log.clear();
    save_all(&settings(&robot, 3), &mut eeprom);
    assert!(eeprom.log.is_empty());
    // A save writes only the bytes that differ from the older copy, which it overwrites.
    save_all(&settings(&robot, 4), &mut eeprom);
    eeprom.log.clear();
    save_all(&settings(&robot, 5), &mut eeprom);
    assert!(eeprom.log.len() < usize::from(RECORD_BYTES));
    assert!(eeprom.log.iter().all(|(_, old, new)| old != new));
}

/// The values of a byte after power failed during its write: the erase has raised
/// some of its bits, or the write lowered some of the erased ones.
fn torn_values(old: u8, new: u8) -> impl Iterator<Item = u8> {
    (0..=255u8).flat_map(move |ones| [old | ones, new | ones])
}

#[test]
fn a_power_cut_at_any_byte_leaves_the_old_settings_or_the_new() {
    let robot = robot();
    for saved_before in 0..4 {
        let mut eeprom = Eeprom::blank();
        let mut old = (Settings::of(&robot), SavedState::Blank);
        for n in 0..saved_before {
            save_all(&settings(&robot, 10 + n), &mut eeprom);
            old = load_settings(&robot, &eeprom);
        }
        let before = *eeprom.bytes();
        eeprom.log.clear();
        let new = save_all(&settings(&robot, 60), &mut eeprom);
        assert!(eeprom.log.len() > 10);
        let mut olds = 0;
        for (count, (address, from, to)) in eeprom.log.iter().enumerate() {
            let mut bytes = before;
            for (address, _, byte) in &eeprom.log[..count] {
                bytes[usize::from(*address)] = *byte;
            }
            for byte in torn_values(*from, *to) {
                bytes[usize::from(*address)] = byte;
                let (settings, outcome) = load_settings(&robot, &Eeprom::with(bytes));
                if settings == old.0 {
                    olds += 1;
                } else {
                    assert_eq!(settings, new, "cut in write {count}: {outcome:?}");
                }
            }
        }
        assert!(olds > 4000);
    }
}

#[test]
fn a_save_after_a_power_cut_is_complete_whatever_the_cut_left() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    save_all(&settings(&robot, 1), &mut eeprom);
    save_all(&settings(&robot, 2), &mut eeprom);
    let before = *eeprom.bytes();
    eeprom.log.clear();
    save_all(&settings(&robot, 3), &mut eeprom);
    for count in 0..eeprom.log.len() {
        let mut cut = Eeprom::with(before);
        for (address, _, byte) in &eeprom.log[..count] {
            cut.bytes_mut()[usize::from(*address)] = *byte;
        }
        let new = save_all(&settings(&robot, 4), &mut cut);
        assert_eq!(load_settings(&robot, &cut).0, new);
    }
}

#[test]
fn any_flipped_bit_leaves_the_last_settings_the_previous_or_robot_tomls() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    let before = save_all(&settings(&robot, 1), &mut eeprom);
    let last = save_all(&settings(&robot, 2), &mut eeprom);
    let (mut lasts, mut befores) = (0, 0);
    for bit in 0..8 * 1024 {
        let mut bytes = *eeprom.bytes();
        bytes[bit / 8] ^= 1 << (bit % 8);
        let (settings, outcome) = load_settings(&robot, &Eeprom::with(bytes));
        if settings == last {
            lasts += 1;
        } else {
            assert_eq!(
                (settings, outcome),
                (before, SavedState::OneCopy),
                "bit {bit}"
            );
            befores += 1;
        }
    }
    // A flipped bit of the last copy leaves the previous settings, any other bit the last ones.
    assert_eq!((befores, lasts), (45 * 8, 8 * (1024 - 45)));
}

#[test]
fn any_flipped_bit_of_the_only_copy_leaves_it_or_robot_tomls() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    let only = save_all(&settings(&robot, 1), &mut eeprom);
    for bit in 0..8 * 1024 {
        let mut bytes = *eeprom.bytes();
        bytes[bit / 8] ^= 1 << (bit % 8);
        let outcome = load_settings(&robot, &Eeprom::with(bytes));
        let is_in_content = bit / 8 < 45;
        let other = (64..109).contains(&(bit / 8));
        let expected = match (is_in_content, other) {
            (true, _) => (Settings::of(&robot), SavedState::Damaged),
            (_, true) => (only, SavedState::OneCopy),
            _ => (only, SavedState::Latest),
        };
        assert_eq!(outcome, expected, "bit {bit}");
    }
}

#[test]
fn settings_for_other_servos_or_of_another_format_are_not_used() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    save_all(&settings(&robot, 1), &mut eeprom);
    let other = robot
        .clone()
        .with(|content| content.servo_hash ^= 0x0001_0000);
    let found = load_settings(&other, &eeprom);
    assert_eq!(found, (Settings::of(&other), SavedState::Foreign));
    let mut format = *settings(&robot, 1).bytes();
    format[0] = 2;
    save_all(&Settings::from_bytes(format), &mut eeprom);
    assert_eq!(load_settings(&robot, &eeprom).1, SavedState::Foreign);
    // Settings saved after that are used.
    let own = save_all(&settings(&other, 5), &mut eeprom);
    let (now, _) = load_settings(&other, &eeprom);
    assert_eq!(now, own);
}

#[test]
fn every_bit_of_the_servos_hash_tells_other_servos() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    save_all(&settings(&robot, 1), &mut eeprom);
    for bit in 0..32 {
        let other = robot.clone().with(|content| content.servo_hash ^= 1 << bit);
        assert_eq!(
            load_settings(&other, &eeprom).1,
            SavedState::Foreign,
            "bit {bit}"
        );
    }
    assert_eq!(load_settings(&robot, &eeprom).1, SavedState::Latest);
}

#[test]
fn settings_with_which_a_gait_leaves_the_travel_are_not_used() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    let mut narrow = settings(&robot, 1);
    let mut adjustment = narrow.servo(Servo::A3);
    adjustment.max = Sweep(robot.reach(Servo::A3).max.0 - 1);
    narrow.set_servo(Servo::A3, adjustment);
    save_all(&narrow, &mut eeprom);
    let found = load_settings(&robot, &eeprom);
    assert_eq!(found, (Settings::of(&robot), SavedState::Unfit));
}

#[test]
fn a_boot_gait_is_found_by_its_name_and_a_gait_that_is_gone_is_stand() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    let saved = save_all(&settings(&robot, 1), &mut eeprom);
    assert_eq!(saved.boot(&robot), Boot::Gait(robot.id("sway left")));
    let fewer = robot.clone().with(|content| _ = content.gaits.remove(1));
    assert_eq!(saved.boot(&fewer), Boot::Gait(fewer.id("sway left")));
    let fewer = fewer.with(|content| _ = content.gaits.remove(1));
    assert_eq!(saved.boot(&fewer), Boot::Gait(GaitId::STAND));
    let mut rests = saved;
    rests.set_boot(Boot::Rest, &robot);
    assert_eq!(rests.boot(&robot), Boot::Rest);
}

#[test]
fn a_rest_is_remembered_until_it_is_forgotten_and_only_by_its_own_robot() {
    let robot = robot();
    let mut eeprom = Eeprom::blank();
    assert_eq!(last_rest_pose(&robot, &eeprom), None);
    for sweeps in [[0, 1, -2, 30_000], [-100, 4000, 17, -32_768]] {
        let rest_pose = Pose(sweeps.map(Sweep));
        let saved = Settings::of_pose(&rest_pose, &robot);
        let mut writing = REST_POSE.start_write();
        while writing.step(saved.bytes(), &mut eeprom) == Progress::InProgress {}
        assert_eq!(last_rest_pose(&robot, &eeprom), Some(rest_pose));
        let other = robot.clone().with(|content| content.servo_hash = 7);
        assert_eq!(last_rest_pose(&other, &eeprom), None);
    }
    let mut writing = REST_POSE.start_invalidation();
    while writing.step(&[0; CONTENT_BYTES], &mut eeprom) == Progress::InProgress {}
    assert_eq!(last_rest_pose(&robot, &eeprom), None);
    let outside = |address: &u16| !(128..128 + RECORD_BYTES).contains(address);
    let touched: Vec<u16> = eeprom
        .log
        .iter()
        .map(|(address, ..)| *address)
        .filter(outside)
        .collect();
    assert!(touched.is_empty());
    assert_eq!(eeprom.bytes()[128], ERASED);
}

#[test]
fn random_bytes_in_the_memory_are_not_read_as_settings() {
    let robot = robot();
    let mut state = 1u32;
    for _ in 0..2000 {
        let bytes: [u8; 1024] = core::array::from_fn(|at| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // With the marks in place, so that only the CRC can reject the bytes.
            if at % 64 == 0 {
                0xa5
            } else {
                (state >> 24) as u8
            }
        });
        let found = load_settings(&robot, &Eeprom::with(bytes));
        assert_eq!(found, (Settings::of(&robot), SavedState::Damaged));
    }
}
