//! A test of the memory of simulated UNOs, in a process without other tests.
#![cfg(target_os = "linux")]

use simulated_uno::{Fidelity, Uno, avr_gcc};

#[test]
fn dropped_unos_leave_no_memory_behind() {
    let resident_kib = || {
        let status = std::fs::read_to_string("/proc/self/status").expect("Linux has this file");
        let (_, rest) = status.split_once("VmRSS:").expect("the size is listed");
        let kib = rest.split_whitespace().next().map(str::parse::<u64>);
        kib.expect("a number follows").expect("a number follows")
    };
    let image = avr_gcc::assemble("loop: rjmp loop");
    for fidelity in [Fidelity::Stock, Fidelity::DataSheet] {
        let kib_before = resident_kib();
        for _ in 0..2_000 {
            Uno::with_image(image.clone(), fidelity).run_cycles(100);
        }
        // libsimavr alone would lose 6 KiB for each UNO: 12 MB.
        let lost_kib = resident_kib().saturating_sub(kib_before);
        assert!(lost_kib < 6_000, "{fidelity:?}: {lost_kib} KiB");
    }
}
