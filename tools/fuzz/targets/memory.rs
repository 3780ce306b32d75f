//! Fuzz target: any bytes in the EEPROM.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: _ = lizard_fuzz::robot(),
    |data: &[u8]| lizard_fuzz::check_memory(data)
);
