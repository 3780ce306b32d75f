//! Tests of the saved settings: with power cuts during a save, at every byte and with every torn value of that
//! byte, and with bits that flip over the years.

use lizard_core::memory::copies::{self, SavedState};
use lizard_core::memory::settings::Settings;
use lizard_core::virtual_board::Eeprom;
use lizard_host_tests::{FirmwareBench, robot};
use simulated_uno::{EEPROM_SIZE, EepromOperation, Fidelity, PowerCut};

use crate::boot_standing;
use crate::kept::{power_cycle, read_calibration};

/// Loads the settings of an EEPROM as the core does.
fn load(contents: &[u8; EEPROM_SIZE]) -> (Settings, SavedState) {
    let mut settings = Settings::of(robot().firmware());
    let outcome = copies::load(robot().firmware(), &Eeprom::with(*contents), &mut settings);
    settings.set_save_number(0);
    (settings, outcome)
}

/// A board whose settings were saved twice and then changed without saving.
struct UnsavedBoard {
    bench: FirmwareBench,
    saved_eeprom: [u8; EEPROM_SIZE],
    /// The output of `cal` for the saved settings and for the changed ones.
    calibrations: [Vec<String>; 2],
}

impl UnsavedBoard {
    fn new() -> Self {
        let mut bench = boot_standing(Fidelity::DataSheet);
        for trim in ["1 0.5", "2 -0.75"] {
            bench.say(&format!("trim {trim}"));
            assert_eq!(bench.say("save"), "ok save");
        }
        let saved_calibration = read_calibration(&mut bench);
        for line in ["trim 1 1.25", "trim 3 -1", "trim 4 2", "deadman 4321"] {
            assert_eq!(bench.say(line), format!("ok {line}"));
        }
        let changed_calibration = read_calibration(&mut bench);
        Self {
            saved_eeprom: bench.uno.eeprom(),
            calibrations: [saved_calibration, changed_calibration],
            bench,
        }
    }

    /// Saves the changed settings, and returns the EEPROM operations.
    fn save(&mut self) -> Vec<EepromOperation> {
        let operations_before = self.bench.uno.eeprom_operations().len();
        assert_eq!(self.bench.say("save"), "ok save");
        self.bench.uno.eeprom_operations()[operations_before..].to_vec()
    }

    /// Powers the board on with these contents, and returns the output of `cal`.
    fn power_on_with(&mut self, contents: &[u8; EEPROM_SIZE]) -> Vec<String> {
        self.bench.uno.set_eeprom(contents);
        power_cycle(&mut self.bench);
        read_calibration(&mut self.bench)
    }
}

#[test]
fn a_power_cut_at_any_byte_of_a_save_torn_in_any_way_leaves_the_old_or_the_new() {
    let mut board = UnsavedBoard::new();
    let mut contents = board.saved_eeprom;
    let operations = board.save();
    let contents_after = board.bench.uno.eeprom();
    let [old, new] = [contents, contents_after].map(|contents| load(&contents).0);
    assert_ne!(old, new);
    assert!(operations.len() > 10);
    let (mut outcome_counts, mut image_count) = ([0, 0], 0u64);
    for operation in &operations {
        assert_eq!(contents[usize::from(operation.address)], operation.old);
        for ones in 0..=255u8 {
            for torn_byte in [operation.old | ones, operation.new | ones] {
                let mut contents = contents;
                contents[usize::from(operation.address)] = torn_byte;
                let (settings, outcome) = load(&contents);
                let is_new = settings == new;
                assert!(
                    is_new || settings == old,
                    "{operation:?} torn to {torn_byte:02x}: {outcome:?}"
                );
                outcome_counts[usize::from(is_new)] += 1;
                // One cut in 97 is also loaded by the running image.
                image_count += 1;
                if image_count % 97 == 0 {
                    let calibration = board.power_on_with(&contents);
                    assert_eq!(calibration, board.calibrations[usize::from(is_new)]);
                }
            }
        }
        contents[usize::from(operation.address)] = operation.new;
    }
    assert_eq!(contents, contents_after);
    println!("{image_count} images: {outcome_counts:?} old and new");
    assert!(outcome_counts[0] > 0 && outcome_counts[1] > 0);
}

#[test]
fn a_power_cut_in_any_operation_of_a_running_save_leaves_the_old_or_the_new() {
    let mut board = UnsavedBoard::new();
    let contents_before = board.saved_eeprom;
    let count = board.save().len() as u64;
    let contents_after = board.bench.uno.eeprom();
    let mut outcome_counts = [0, 0];
    for operation in 0..count {
        for (cut, ones) in [
            (PowerCut::InErase(operation), 0x00),
            (PowerCut::InErase(operation), 0x5a),
            (PowerCut::InWrite(operation), 0x00),
            (PowerCut::InWrite(operation), 0x81),
            (PowerCut::InWrite(operation), 0xff),
        ] {
            board.power_on_with(&contents_before);
            for line in ["trim 1 1.25", "trim 3 -1", "trim 4 2", "deadman 4321"] {
                board.bench.say(line);
            }
            board.bench.uno.cut_power(cut, ones);
            board.bench.send("save");
            board.bench.uno.run_ms(400);
            assert_eq!(*board.bench.uno.state(), simulated_uno::State::Off);
            power_cycle(&mut board.bench);
            let calibration = read_calibration(&mut board.bench);
            let index = board.calibrations.iter().position(|c| *c == calibration);
            outcome_counts
                [index.unwrap_or_else(|| panic!("{cut:?} {ones:02x}: {calibration:?}"))] += 1;
        }
    }
    assert!(
        outcome_counts[0] > 0 && outcome_counts[1] > 0,
        "{outcome_counts:?}"
    );
    assert_ne!(load(&contents_before).0, load(&contents_after).0);
}

#[test]
fn any_flipped_bit_gives_the_settings_the_other_copy_or_the_defaults() {
    let mut board = UnsavedBoard::new();
    board.save();
    let contents = board.bench.uno.eeprom();
    let [latest, older] = [contents, board.saved_eeprom].map(|contents| load(&contents).0);
    let mut defaults = Settings::of(robot().firmware());
    defaults.set_save_number(0);
    let mut outcome_counts = [0, 0, 0];
    for bit in 0..8 * EEPROM_SIZE {
        let mut flipped_contents = contents;
        flipped_contents[bit / 8] ^= 1 << (bit % 8);
        let (settings, outcome) = load(&flipped_contents);
        let index = [&latest, &older, &defaults]
            .iter()
            .position(|known| **known == settings);
        let index = index.unwrap_or_else(|| panic!("bit {bit}: {outcome:?} {settings:?}"));
        outcome_counts[index] += 1;
        if bit % 64 == 11 {
            let calibration = board.power_on_with(&flipped_contents);
            let expected = &board.calibrations[if index == 0 { 1 } else { 0 }];
            assert_eq!(&calibration, expected, "bit {bit}");
        }
    }
    println!("{outcome_counts:?} the latest, the copy before, the defaults");
    assert_eq!(outcome_counts[2], 0, "one copy is always whole");
    assert!(outcome_counts[1] >= 8 * 44, "the latest copy's own bits");
}
