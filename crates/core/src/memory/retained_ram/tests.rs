//! Tests of resets between any two stores, of random RAM contents, and of every cause of a reset.

use std::cell::RefCell;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::units::{PulseWidth, Sweep};

/// RAM that survives a reset. It keeps its first bytes and its bytes after each store, because a reset may occur after
/// any number of stores.
struct Ram(RefCell<Vec<Vec<u8>>>);

impl Ram {
    fn with_bytes(bytes: Vec<u8>) -> Self {
        Self(RefCell::new(Vec::from([bytes])))
    }

    /// The current bytes.
    fn bytes(&self) -> Vec<u8> {
        let states = self.0.borrow();
        states.last().expect("the RAM has bytes").clone()
    }

    /// Returns the RAM after the first call of `begin` since power-on.
    fn after_power_on() -> Self {
        let ram = Self::with_bytes(std::vec![0; CELL_COUNT]);
        assert_eq!(begin(&ram, Some(Cause::Power)), Restart::NONE);
        ram
    }

    /// Returns the RAM as the next run of the program finds it.
    fn copy_after_reset(&self) -> Self {
        Self::with_bytes(self.bytes())
    }

    /// Returns the RAM as the next run of the program finds it after a reset before each store or after the last one.
    fn copies_after_resets(&self) -> Vec<Self> {
        let states = self.0.borrow();
        states.iter().cloned().map(Self::with_bytes).collect()
    }
}

impl Cells for Ram {
    fn get(&self, index: usize) -> u8 {
        self.bytes()[index]
    }

    fn set(&self, index: usize, byte: u8) {
        let mut bytes = self.bytes();
        bytes[index] = byte;
        self.0.borrow_mut().push(bytes);
    }
}

const REPORTED_CAUSES: [Option<Cause>; 4] = [
    None,
    Some(Cause::External),
    Some(Cause::BrownOut),
    Some(Cause::Watchdog),
];

fn make_servo_state(n: i16) -> ServoState {
    ServoState {
        is_resting: n % 3 == 0,
        frames_awake: (n % 21) as u8,
        pose: Pose([n, -n, 7 * n, -32_768 + n].map(Sweep)),
        sent_pulses: Pulses([24_000, 1 + n as u16, 65_535 - n as u16, 0].map(PulseWidth)),
    }
}

#[test]
fn a_stored_servo_state_survives_a_reset_but_not_a_loss_of_power() {
    let ram = Ram::after_power_on();
    for n in 1..100 {
        store_servo_state(&ram, &make_servo_state(n), n as u8);
        for reported_cause in REPORTED_CAUSES {
            let restarted_ram = ram.copy_after_reset();
            let restart = begin(&restarted_ram, reported_cause);
            assert_eq!(restart.servo_state_before, Some(make_servo_state(n)));
            assert_eq!(restart.suspected_brown_outs, n as u8);
            // A second reset before the program has stored a servo state.
            let second_restart = begin(&restarted_ram, reported_cause);
            assert_eq!(second_restart.servo_state_before, Some(make_servo_state(n)));
        }
        let unpowered_ram = ram.copy_after_reset();
        assert_eq!(begin(&unpowered_ram, Some(Cause::Power)), Restart::NONE);
        let servo_state = begin(&unpowered_ram, Some(Cause::External)).servo_state_before;
        let claim = "no servo state has been stored since power-on";
        assert_eq!(servo_state, None, "{claim}");
    }
}

#[test]
fn a_reset_between_any_two_stores_leaves_the_old_or_the_new_servo_state() {
    let ram = Ram::after_power_on();
    store_servo_state(&ram, &make_servo_state(1), 1);
    let (mut old_count, mut new_count) = (0, 0);
    for n in 2..9 {
        let next_ram = ram.copy_after_reset();
        store_servo_state(&next_ram, &make_servo_state(n), n as u8);
        for (kept_count, torn_ram) in next_ram.copies_after_resets().iter().enumerate() {
            let found_servo_state = begin(torn_ram, None).servo_state_before;
            if found_servo_state == Some(make_servo_state(n)) {
                new_count += 1;
            } else {
                let case = std::format!("servo state {n}, {kept_count} stores");
                let old_servo_state = Some(make_servo_state(n - 1));
                assert_eq!(found_servo_state, old_servo_state, "{case}");
                old_count += 1;
            }
        }
        store_servo_state(&ram, &make_servo_state(n), n as u8);
    }
    assert!(old_count > 100, "{old_count}");
    assert_eq!(new_count, 7);
}

#[test]
fn a_reset_between_any_two_stores_of_begin_keeps_the_servo_state() {
    let ram = Ram::after_power_on();
    store_servo_state(&ram, &make_servo_state(5), 5);
    mark_hung(&ram);
    let next_ram = ram.copy_after_reset();
    begin(&next_ram, None);
    let torn_rams = next_ram.copies_after_resets();
    assert!(torn_rams.len() > 3);
    for (kept_count, torn_ram) in torn_rams.iter().enumerate() {
        let restart = begin(torn_ram, None);
        let expected = Some(make_servo_state(5));
        assert_eq!(restart.servo_state_before, expected, "{kept_count} stores");
        assert!((1..=2).contains(&restart.reset_count));
        assert!(matches!(restart.cause, Cause::Watchdog | Cause::External));
    }
}

#[test]
fn every_cause_is_determined_from_its_flag_or_from_ram() {
    for (reported_cause, has_hung, expected_cause, is_supply_suspected) in [
        (Some(Cause::External), false, Cause::External, false),
        (Some(Cause::BrownOut), false, Cause::BrownOut, true),
        (Some(Cause::Watchdog), false, Cause::Watchdog, false),
        (Some(Cause::Power), false, Cause::Power, false),
        (None, false, Cause::External, true),
        (None, true, Cause::Watchdog, false),
        (Some(Cause::External), true, Cause::External, false),
    ] {
        let ram = Ram::after_power_on();
        if has_hung {
            mark_hung(&ram);
        }
        let restart = begin(&ram, reported_cause);
        assert_eq!(restart.cause, expected_cause);
        assert_eq!(restart.is_supply_suspected, is_supply_suspected);
    }
}

#[test]
fn resets_are_counted_up_to_255() {
    let ram = Ram::after_power_on();
    for n in 1..=600u32 {
        let restart = begin(&ram, Some(Cause::External));
        assert_eq!(u32::from(restart.reset_count), n.min(255));
    }
    assert_eq!(begin(&ram, Some(Cause::Power)).reset_count, 0);
}

proptest! {
    #[test]
    fn the_contents_of_ram_at_power_on_are_not_trusted(
        bytes in prop::collection::vec(any::<u8>(), CELL_COUNT),
        reported_cause in prop::sample::select(&REPORTED_CAUSES[..]),
    ) {
        let mut bytes = bytes;
        // By chance, one in 256 random contents has the mark.
        prop_assume!(bytes[MARK_CELL] != POWERED_MARK);
        let ram = Ram::with_bytes(bytes.clone());
        let restart = begin(&ram, reported_cause);
        prop_assert_eq!((restart.reset_count, restart.servo_state_before), (0, None));
        prop_assert_eq!(begin(&ram, Some(Cause::External)).servo_state_before, None);
        bytes[MARK_CELL] = POWERED_MARK;
        // Neither RUNNING nor HUNG.
        bytes[PROGRAM_STATE_CELL] = 0x5b;
        prop_assert_eq!(begin(&Ram::with_bytes(bytes), reported_cause).servo_state_before, None);
    }

    #[test]
    fn a_flipped_bit_in_a_stored_servo_state_is_detected(bit in 0..8 * CELLS_PER_COPY, n in 1i16..100) {
        let ram = Ram::after_power_on();
        store_servo_state(&ram, &make_servo_state(n), n as u8);
        let copy_cell = FIRST_COPY_CELL + CELLS_PER_COPY * usize::from(ram.get(VALID_COPY_CELL) & 1);
        ram.set(copy_cell + bit / 8, ram.get(copy_cell + bit / 8) ^ (1 << (bit % 8)));
        prop_assert_eq!(begin(&ram, None).servo_state_before, None);
    }
}
