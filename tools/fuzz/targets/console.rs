//! Fuzz target: any bytes at the console.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: _ = lizard_fuzz::robot(),
    |data: &[u8]| lizard_fuzz::check_console(data)
);
