//! Long computations that are split into parts: independent processes compute the parts, and `lizard merge` prints
//! what one process alone would print. `make parallel-test` tests this with GNU parallel and commands that take
//! longer.

use crate::program::{lizard, paper};

fn complaint(arguments: &str, input: &str) -> String {
    lizard(arguments, input).expect_refusal()
}

/// Computes all parts and returns their output, the last part first.
fn parts(arguments: &str, of: usize) -> String {
    let part = |number| lizard(&format!("{arguments} --part {number}/{of}"), "").expect_success();
    (1..=of).rev().map(part).collect()
}

#[test]
fn parts_together_print_byte_for_byte_what_one_process_prints() {
    for (words, of) in [
        ("prove --one-in 30000", 3),
        ("prove --one-in 30000 --json", 2),
        ("design --search --step 0.05", 2),
        // More parts than there are items to compute.
        ("design --search --step 0.1 --top 3 --json", 5),
    ] {
        let words = paper(words);
        let whole = lizard(&words, "").expect_success();
        assert!(whole.len() > 100, "{words}: {whole}");
        let merged = lizard("merge", parts(&words, of)).expect_success();
        assert_eq!(merged, whole, "{words}");
    }
}

#[test]
fn a_merge_refuses_parts_that_are_not_one_complete_computation() {
    let words = paper("design --search --step 0.1");
    let parts = parts(&words, 2);
    let (last, first) = parts.split_once('\n').expect("two lines");
    assert_eq!(complaint("merge", last), "lizard: part 1/2 is missing");
    let other = "design --search --step 0.1 --robot robots/unequal.toml --part 1/2";
    let other = lizard(other, "").expect_success();
    assert_eq!(
        complaint("merge", &format!("{last}\n{other}")),
        "lizard: part 1/2 has a different robot from another part"
    );
    let step = lizard(&paper("design --search --step 0.2 --part 1/2"), "").expect_success();
    assert!(complaint("merge", &format!("{last}\n{step}")).contains("different options"));
    // A job that was killed leaves half a line.
    let half = &first[..first.len() / 2];
    let message = complaint("merge", &format!("{last}\n{half}"));
    assert!(
        message.starts_with("lizard: standard input: line 2 is not a part: "),
        "{message}"
    );
    assert!(complaint("merge", "").contains("there are no parts"));
    assert!(complaint("merge no-such-part", "").contains("cannot read no-such-part: "));
}

#[test]
fn a_part_needs_a_valid_number_and_a_command_that_can_be_split() {
    let message = complaint("prove --part 3/2", "");
    assert!(
        message.contains("it must be as 2/8, from 1/8 to 8/8"),
        "{message}"
    );
    let message = complaint(&paper("design --part 1/2"), "");
    assert!(message.contains("--part goes with --search"), "{message}");
}
