//! docs/errata.md is what `lizard errata` measures, and every correction holds.

use lizard_host::paper::errata::{SAMPLES, markdown, measure};

#[test]
fn the_page_is_what_is_measured_and_every_correction_holds() {
    let entries = measure(SAMPLES);
    assert!(entries.iter().all(|entry| entry.is_settled()));
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/errata.md"))
        .expect("docs/errata.md");
    assert!(
        page == markdown(&entries, SAMPLES),
        "docs/errata.md is out of date: lizard errata --markdown > docs/errata.md"
    );
}
