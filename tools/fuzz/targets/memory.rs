//! Any bytes in the EEPROM.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: _ = lizard_fuzz::robot(),
    |data: &[u8]| lizard_fuzz::memory(data)
);
