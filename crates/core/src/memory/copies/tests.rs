//! Tests of saved settings after power cuts, torn bytes and flipped bits.

use super::*;
use crate::memory::record::{ERASED, Progress, RECORD_BYTES};
use crate::memory::settings::Boot;
use crate::numbers::gaits::GaitId;
use crate::numbers::part::Servo;
use crate::numbers::units::Sweep;
use crate::sample::Sample;
use crate::virtual_board::Eeprom;

fn robot_with_blank_memory() -> (Sample, Eeprom) {
    (Sample::asymmetric(), Eeprom::blank())
}

/// Makes settings whose values, except `boot`, depend on `n`.
fn make_settings(robot: &Sample, n: i16) -> Settings {
    let mut settings = Settings::for_robot(robot);
    for servo in Servo::ALL {
        let mut adjustment = settings.adjustment(servo);
        adjustment.trim = Sweep(37 * n - 5 * servo as i16);
        adjustment.travel_min.0 += n;
        adjustment.travel_max.0 -= 2 * n;
        settings.set_adjustment(servo, adjustment);
    }
    settings.set_deadman_ms(1000 + n as u16);
    settings.set_boot(Boot::Gait(robot.gait_id("sway left")), robot);
    assert!(settings.cover_gaits(robot));
    settings
}

/// Saves settings as the console does, and returns them with their save number.
fn save_settings(settings: &Settings, eeprom: &mut Eeprom) -> Settings {
    let mut saved_settings = *settings;
    if let Some(record_write) = start_save(&mut saved_settings, eeprom) {
        let progress = record_write.complete(saved_settings.bytes(), eeprom);
        assert!(progress == Progress::Done, "the EEPROM is worn");
    }
    saved_settings
}

/// Returns the settings to use, and the state of the saved ones.
fn load_settings(robot: &Sample, eeprom: &Eeprom) -> (Settings, SavedState) {
    let mut settings = Settings::for_robot(robot);
    let state = load(robot, eeprom, &mut settings);
    (settings, state)
}

#[test]
fn each_of_a_thousand_saves_is_loaded_again() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    let loaded = load_settings(&robot, &eeprom);
    assert_eq!(loaded, (Settings::for_robot(&robot), SavedState::Blank));
    for n in 0..1000 {
        let new_settings = make_settings(&robot, n % 70);
        let mut saved_settings = save_settings(&new_settings, &mut eeprom);
        let loaded = load_settings(&robot, &eeprom);
        assert_eq!(loaded, (saved_settings, SavedState::Latest), "{n}");
        saved_settings.set_save_number(0);
        assert_eq!(saved_settings, new_settings);
    }
}

#[test]
fn unchanged_bytes_are_not_written_again() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    save_settings(&make_settings(&robot, 3), &mut eeprom);
    eeprom.log.clear();
    save_settings(&make_settings(&robot, 3), &mut eeprom);
    assert!(eeprom.log.is_empty());
    // A save writes only those bytes of the older copy that change.
    save_settings(&make_settings(&robot, 4), &mut eeprom);
    eeprom.log.clear();
    save_settings(&make_settings(&robot, 5), &mut eeprom);
    assert!(eeprom.log.len() < usize::from(RECORD_BYTES));
    assert!(eeprom.log.iter().all(|(_, old, new)| old != new));
}

/// Iterates over the possible values of a byte after a power cut during its write: the erase has set some bits of the
/// old value, or the write has not cleared all bits of the new value.
fn torn_values(old: u8, new: u8) -> impl Iterator<Item = u8> {
    (0..=255u8).flat_map(move |ones| [old | ones, new | ones])
}

#[test]
fn a_power_cut_at_any_byte_leaves_the_old_or_the_new_settings() {
    let robot = Sample::asymmetric();
    for save_count in 0..4 {
        let mut eeprom = Eeprom::blank();
        let mut old_settings = Settings::for_robot(&robot);
        for n in 0..save_count {
            save_settings(&make_settings(&robot, 10 + n), &mut eeprom);
            (old_settings, _) = load_settings(&robot, &eeprom);
        }
        let mut bytes = *eeprom.bytes();
        eeprom.log.clear();
        let new_settings = save_settings(&make_settings(&robot, 60), &mut eeprom);
        assert!(eeprom.log.len() > 10);
        let mut old_count = 0;
        for (write_count, (address, old_byte, new_byte)) in eeprom.log.iter().enumerate() {
            for byte in torn_values(*old_byte, *new_byte) {
                bytes[usize::from(*address)] = byte;
                let (settings, state) = load_settings(&robot, &Eeprom::with_bytes(bytes));
                if settings == old_settings {
                    old_count += 1;
                } else {
                    let case = std::format!("power cut in write {write_count}: {state:?}");
                    assert_eq!(settings, new_settings, "{case}");
                }
            }
            bytes[usize::from(*address)] = *new_byte;
        }
        assert!(old_count > 4000);
    }
}

#[test]
fn a_save_after_a_power_cut_is_complete() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    save_settings(&make_settings(&robot, 1), &mut eeprom);
    save_settings(&make_settings(&robot, 2), &mut eeprom);
    let mut cut_bytes = *eeprom.bytes();
    eeprom.log.clear();
    save_settings(&make_settings(&robot, 3), &mut eeprom);
    for (address, _, byte) in &eeprom.log {
        let mut cut_eeprom = Eeprom::with_bytes(cut_bytes);
        let new_settings = save_settings(&make_settings(&robot, 4), &mut cut_eeprom);
        assert_eq!(load_settings(&robot, &cut_eeprom).0, new_settings);
        cut_bytes[usize::from(*address)] = *byte;
    }
}

#[test]
fn a_save_of_unchanged_settings_replaces_a_damaged_copy() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    let settings = make_settings(&robot, 2);
    save_settings(&make_settings(&robot, 1), &mut eeprom);
    save_settings(&settings, &mut eeprom);
    let mut damaged_eeprom = with_flipped_bit(&eeprom, 8);
    let (_, state) = load_settings(&robot, &damaged_eeprom);
    assert_eq!(state, SavedState::OneCopy);
    let saved_settings = save_settings(&settings, &mut damaged_eeprom);
    let loaded = load_settings(&robot, &damaged_eeprom);
    assert_eq!(loaded, (saved_settings, SavedState::Latest));
}

fn with_flipped_bit(eeprom: &Eeprom, bit: usize) -> Eeprom {
    let mut bytes = *eeprom.bytes();
    bytes[bit / 8] ^= 1 << (bit % 8);
    Eeprom::with_bytes(bytes)
}

#[test]
fn any_flipped_bit_leaves_the_last_or_the_previous_settings() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    let previous_settings = save_settings(&make_settings(&robot, 1), &mut eeprom);
    let last_settings = save_settings(&make_settings(&robot, 2), &mut eeprom);
    let (mut last_count, mut previous_count) = (0, 0);
    for bit in 0..8 * 1024 {
        let (settings, state) = load_settings(&robot, &with_flipped_bit(&eeprom, bit));
        if settings == last_settings {
            last_count += 1;
        } else {
            let previous = (previous_settings, SavedState::OneCopy);
            assert_eq!((settings, state), previous, "bit {bit}");
            previous_count += 1;
        }
    }
    // A flipped bit of the last copy leaves the previous settings, any other flipped bit the last settings.
    assert_eq!((previous_count, last_count), (45 * 8, 8 * (1024 - 45)));
}

#[test]
fn any_flipped_bit_leaves_the_only_copy_or_the_settings_of_robot_toml() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    let only_settings = save_settings(&make_settings(&robot, 1), &mut eeprom);
    for bit in 0..8 * 1024 {
        let loaded = load_settings(&robot, &with_flipped_bit(&eeprom, bit));
        let is_in_only_copy = bit / 8 < 45;
        let is_in_other_copy = (64..109).contains(&(bit / 8));
        let expected_loaded = match (is_in_only_copy, is_in_other_copy) {
            (true, _) => (Settings::for_robot(&robot), SavedState::Damaged),
            (_, true) => (only_settings, SavedState::OneCopy),
            _ => (only_settings, SavedState::Latest),
        };
        assert_eq!(loaded, expected_loaded, "bit {bit}");
    }
}

#[test]
fn settings_for_other_servos_or_of_another_format_are_not_used() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    save_settings(&make_settings(&robot, 1), &mut eeprom);
    let other_robot = Sample::asymmetric().with_changes(|content| content.servo_hash ^= 1 << 16);
    let expected_loaded = (Settings::for_robot(&other_robot), SavedState::Foreign);
    assert_eq!(load_settings(&other_robot, &eeprom), expected_loaded);
    let mut foreign_bytes = *make_settings(&robot, 1).bytes();
    foreign_bytes[0] = 2;
    save_settings(&Settings::from_bytes(foreign_bytes), &mut eeprom);
    assert_eq!(load_settings(&robot, &eeprom).1, SavedState::Foreign);
    // Settings saved after that are used.
    let new_settings = save_settings(&make_settings(&other_robot, 5), &mut eeprom);
    let (loaded_settings, _) = load_settings(&other_robot, &eeprom);
    assert_eq!(loaded_settings, new_settings);
}

#[test]
fn every_bit_of_the_servos_hash_distinguishes_other_servos() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    save_settings(&make_settings(&robot, 1), &mut eeprom);
    for bit in 0..32 {
        let other_robot =
            Sample::asymmetric().with_changes(|content| content.servo_hash ^= 1 << bit);
        let (_, state) = load_settings(&other_robot, &eeprom);
        assert_eq!(state, SavedState::Foreign, "bit {bit}");
    }
    assert_eq!(load_settings(&robot, &eeprom).1, SavedState::Latest);
}

#[test]
fn settings_whose_travel_does_not_cover_a_gait_are_not_used() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    let mut narrow_settings = make_settings(&robot, 1);
    let mut adjustment = narrow_settings.adjustment(Servo::A3);
    adjustment.travel_max = Sweep(robot.needed_travel(Servo::A3).max.0 - 1);
    narrow_settings.set_adjustment(Servo::A3, adjustment);
    save_settings(&narrow_settings, &mut eeprom);
    let loaded = load_settings(&robot, &eeprom);
    assert_eq!(loaded, (Settings::for_robot(&robot), SavedState::Unfit));
}

#[test]
fn a_boot_gait_is_found_by_its_name_and_replaced_by_stand_if_it_no_longer_exists() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    let saved_settings = save_settings(&make_settings(&robot, 1), &mut eeprom);
    let boot_left = |robot: &Sample| Boot::Gait(robot.gait_id("sway left"));
    assert_eq!(saved_settings.boot(&robot), boot_left(&robot));
    let robot_with_fewer_gaits =
        Sample::asymmetric().with_changes(|content| _ = content.gaits.remove(1));
    let boot = saved_settings.boot(&robot_with_fewer_gaits);
    assert_eq!(boot, boot_left(&robot_with_fewer_gaits));
    let robot_with_fewest_gaits =
        robot_with_fewer_gaits.with_changes(|content| _ = content.gaits.remove(1));
    let boot = saved_settings.boot(&robot_with_fewest_gaits);
    assert_eq!(boot, Boot::Gait(GaitId::STAND));
    let mut rest_settings = saved_settings;
    rest_settings.set_boot(Boot::Rest, &robot);
    assert_eq!(rest_settings.boot(&robot), Boot::Rest);
}

#[test]
fn a_rest_pose_is_read_until_it_is_invalidated_and_only_for_the_same_servos() {
    let (robot, mut eeprom) = robot_with_blank_memory();
    assert_eq!(read_rest_pose(&robot, &eeprom), None);
    for sweeps in [[0, 1, -2, 30_000], [-100, 4000, 17, -32_768]] {
        let rest_pose = Pose(sweeps.map(Sweep));
        let saved_settings = Settings::for_pose(&rest_pose, &robot);
        let record_write = REST_POSE_ADDRESS.start_write();
        record_write.complete(saved_settings.bytes(), &mut eeprom);
        assert_eq!(read_rest_pose(&robot, &eeprom), Some(rest_pose));
        let other_robot = robot.clone().with_changes(|content| content.servo_hash = 7);
        assert_eq!(read_rest_pose(&other_robot, &eeprom), None);
    }
    let record_write = REST_POSE_ADDRESS.start_invalidation();
    record_write.complete(&[0; CONTENT_BYTES], &mut eeprom);
    assert_eq!(read_rest_pose(&robot, &eeprom), None);
    let is_outside = |address: &u16| !(128..128 + RECORD_BYTES).contains(address);
    let mut addresses = eeprom.log.iter().map(|(address, ..)| address);
    assert!(!addresses.any(is_outside));
    assert_eq!(eeprom.bytes()[128], ERASED);
}

#[test]
fn random_bytes_are_not_accepted_as_settings() {
    let robot = Sample::asymmetric();
    let mut state = 1u32;
    for _ in 0..2000 {
        let bytes: [u8; 1024] = core::array::from_fn(|index| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // The marks are correct, so only the CRC can reject the bytes.
            match index % 64 {
                0 => 0xa5,
                _ => (state >> 24) as u8,
            }
        });
        let loaded = load_settings(&robot, &Eeprom::with_bytes(bytes));
        assert_eq!(loaded, (Settings::for_robot(&robot), SavedState::Damaged));
    }
}
