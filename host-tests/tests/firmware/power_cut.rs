//! Tests of the saved settings after power cuts during a save, at every byte and with every torn value of the byte, and
//! after bit flips in the EEPROM.

use lizard_core::memory::copies::{self, SavedState};
use lizard_core::memory::settings::Settings;
use lizard_core::virtual_board::Eeprom;
use lizard_host_tests::{FirmwareBench, robot};
use simulated_uno::{EEPROM_SIZE, EepromOperation, Fidelity, PowerCut};

use crate::boot_to_stand;
use crate::measurements::{power_cycle, read_calibration};

/// Lines that change the settings without saving them.
const CHANGES: [&str; 4] = ["trim 1 1.25", "trim 3 -1", "trim 4 2", "deadman 4321"];

/// Loads the settings from an EEPROM with the core's code.
fn load_settings(contents: &[u8; EEPROM_SIZE]) -> (Settings, SavedState) {
    let mut settings = Settings::for_robot(robot().firmware());
    let eeprom = Eeprom::with_bytes(*contents);
    let saved_state = copies::load(robot().firmware(), &eeprom, &mut settings);
    settings.set_save_number(0);
    (settings, saved_state)
}

/// A board whose settings were saved twice and then changed without saving.
struct UnsavedBoard {
    bench: FirmwareBench,
    saved_eeprom: [u8; EEPROM_SIZE],
    /// The output of `cal` for the saved settings and for the changed settings.
    calibrations: [Vec<String>; 2],
}

impl UnsavedBoard {
    fn new() -> Self {
        let mut bench = boot_to_stand(Fidelity::DataSheet);
        for trim in ["1 0.5", "2 -0.75"] {
            bench.say(&format!("trim {trim}"));
            assert_eq!(bench.say("save"), "ok save");
        }
        let saved_calibration = read_calibration(&mut bench);
        for line in CHANGES {
            bench.expect_ok(line);
        }
        let changed_calibration = read_calibration(&mut bench);
        Self {
            saved_eeprom: bench.uno.eeprom(),
            calibrations: [saved_calibration, changed_calibration],
            bench,
        }
    }

    /// Saves the changed settings and returns the EEPROM operations.
    fn save(&mut self) -> Vec<EepromOperation> {
        let operations_before = self.bench.uno.eeprom_operations().len();
        assert_eq!(self.bench.say("save"), "ok save");
        self.bench.uno.eeprom_operations()[operations_before..].to_vec()
    }

    /// Powers on the board with these EEPROM contents and returns the output of `cal`.
    fn power_on_with(&mut self, contents: &[u8; EEPROM_SIZE]) -> Vec<String> {
        self.bench.uno.set_eeprom(contents);
        power_cycle(&mut self.bench);
        read_calibration(&mut self.bench)
    }
}

#[test]
fn a_power_cut_at_any_byte_of_a_save_leaves_the_old_or_the_new_settings() {
    let mut board = UnsavedBoard::new();
    let mut contents = board.saved_eeprom;
    let operations = board.save();
    let contents_after = board.bench.uno.eeprom();
    let [old, new] = [contents, contents_after].map(|contents| load_settings(&contents).0);
    assert_ne!(old, new);
    assert!(operations.len() > 10);
    let (mut outcome_counts, mut torn_count) = ([0, 0], 0u64);
    for operation in &operations {
        let address = usize::from(operation.address);
        assert_eq!(contents[address], operation.old_value);
        // In a torn byte, some bits are 1 that are 0 in the old or in the new value.
        for ones in 0..=255u8 {
            for whole_byte in [operation.old_value, operation.new_value] {
                let torn_byte = whole_byte | ones;
                let mut contents = contents;
                contents[address] = torn_byte;
                let (settings, saved_state) = load_settings(&contents);
                let is_new = settings == new;
                assert!(
                    is_new || settings == old,
                    "{operation:?} torn to {torn_byte:02x}: {saved_state:?}"
                );
                outcome_counts[usize::from(is_new)] += 1;
                // The running image also loads one torn EEPROM in 97.
                torn_count += 1;
                if torn_count % 97 == 0 {
                    let calibration = board.power_on_with(&contents);
                    assert_eq!(calibration, board.calibrations[usize::from(is_new)]);
                }
            }
        }
        contents[address] = operation.new_value;
    }
    assert_eq!(contents, contents_after);
    println!("{torn_count} torn EEPROMs; old and new settings: {outcome_counts:?}");
    assert!(outcome_counts[0] > 0 && outcome_counts[1] > 0);
}

#[test]
fn a_power_cut_in_any_eeprom_operation_of_a_save_leaves_the_old_or_the_new_settings() {
    let mut board = UnsavedBoard::new();
    let contents_before = board.saved_eeprom;
    let operation_count = board.save().len() as u64;
    let contents_after = board.bench.uno.eeprom();
    let mut outcome_counts = [0, 0];
    for operation in 0..operation_count {
        for (cut, ones) in [
            (PowerCut::InErase(operation), 0x00),
            (PowerCut::InErase(operation), 0x5a),
            (PowerCut::InWrite(operation), 0x00),
            (PowerCut::InWrite(operation), 0x81),
            (PowerCut::InWrite(operation), 0xff),
        ] {
            board.power_on_with(&contents_before);
            for line in CHANGES {
                board.bench.say(line);
            }
            board.bench.uno.cut_power(cut, ones);
            board.bench.send("save");
            board.bench.uno.run_ms(400);
            assert_eq!(*board.bench.uno.state(), simulated_uno::State::Off);
            power_cycle(&mut board.bench);
            let calibration = read_calibration(&mut board.bench);
            let is_new = calibration == board.calibrations[1];
            let is_whole = is_new || calibration == board.calibrations[0];
            assert!(is_whole, "{cut:?} {ones:02x}: {calibration:?}");
            outcome_counts[usize::from(is_new)] += 1;
        }
    }
    let [old_count, new_count] = outcome_counts;
    assert!(old_count > 0 && new_count > 0, "{outcome_counts:?}");
    let [old, new] = [contents_before, contents_after].map(|contents| load_settings(&contents).0);
    assert_ne!(old, new);
}

#[test]
fn after_any_bit_flip_the_latest_or_the_previous_settings_are_loaded() {
    let mut board = UnsavedBoard::new();
    board.save();
    let contents = board.bench.uno.eeprom();
    let [latest, previous] =
        [contents, board.saved_eeprom].map(|contents| load_settings(&contents).0);
    let mut defaults = Settings::for_robot(robot().firmware());
    defaults.set_save_number(0);
    let mut outcome_counts = [0, 0, 0];
    for bit in 0..8 * EEPROM_SIZE {
        let mut flipped_contents = contents;
        flipped_contents[bit / 8] ^= 1 << (bit % 8);
        let (settings, saved_state) = load_settings(&flipped_contents);
        let mut known_settings = [&latest, &previous, &defaults].into_iter();
        let index = known_settings.position(|known| *known == settings);
        let index = index.unwrap_or_else(|| panic!("bit {bit}: {saved_state:?} {settings:?}"));
        outcome_counts[index] += 1;
        if bit % 64 == 11 {
            let calibration = board.power_on_with(&flipped_contents);
            let expected = &board.calibrations[usize::from(index == 0)];
            assert_eq!(&calibration, expected, "bit {bit}");
        }
    }
    println!("latest settings, previous settings, defaults: {outcome_counts:?}");
    assert_eq!(outcome_counts[2], 0, "a bit flip invalidates both copies");
    let are_enough = outcome_counts[1] >= 8 * 44;
    assert!(are_enough, "too few bit flips damage the latest copy");
}
