//! Long computations in parts: processes that know nothing of each other compute them, and
//! `lizard merge` prints what one process prints. `make parallel-test` does it with GNU parallel
//! and the commands that take longer.

use std::path::Path;
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

const PAPER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/paper.toml");

fn lizard(words: &str, input: &str) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(words.split_whitespace()).current_dir(folder);
    LIMIT
        .output(&mut command, input.as_bytes())
        .expect("the program ends")
}

fn said(words: &str, input: &str) -> String {
    let output = lizard(words, input);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words}: {error}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn complaint(words: &str, input: &str) -> String {
    let output = lizard(words, input);
    assert_eq!(output.status.code(), Some(2), "{words}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The output of all parts, the last one first.
fn parts(words: &str, of: usize) -> String {
    let part = |number| said(&format!("{words} --part {number}/{of}"), "");
    (1..=of).rev().map(part).collect()
}

#[test]
fn parts_together_print_byte_for_byte_what_one_process_prints() {
    for (words, of) in [
        (format!("prove --one-in 30000 --robot {PAPER}"), 3),
        (format!("prove --one-in 30000 --robot {PAPER} --json"), 2),
        (format!("design --search --step 0.05 --robot {PAPER}"), 2),
        // More parts than there is to do.
        (
            format!("design --search --step 0.1 --top 3 --json --robot {PAPER}"),
            5,
        ),
    ] {
        let whole = said(&words, "");
        assert!(whole.len() > 100, "{words}: {whole}");
        assert_eq!(said("merge", &parts(&words, of)), whole, "{words}");
    }
}

#[test]
fn a_merge_refuses_what_is_not_all_of_one_computation() {
    let words = format!("design --search --step 0.1 --robot {PAPER}");
    let parts = parts(&words, 2);
    let (last, first) = parts.split_once('\n').expect("two lines");
    assert_eq!(complaint("merge", last), "lizard: part 1/2 is missing\n");
    let unequal = PAPER.replace("paper", "unequal");
    let other = said(
        &format!("design --search --step 0.1 --robot {unequal} --part 1/2"),
        "",
    );
    assert_eq!(
        complaint("merge", &format!("{last}\n{other}")),
        "lizard: part 1/2 has another robot than another part\n"
    );
    let step = said(
        &format!("design --search --step 0.2 --robot {PAPER} --part 1/2"),
        "",
    );
    assert!(complaint("merge", &format!("{last}\n{step}")).contains("other options"));
    // A job that was killed leaves half a line.
    let half = &first[..first.len() / 2];
    let said = complaint("merge", &format!("{last}\n{half}"));
    assert!(
        said.starts_with("lizard: standard input: line 2 is no part: "),
        "{said}"
    );
    assert!(complaint("merge", "").contains("there are no parts"));
    assert!(complaint("merge no-such-part", "").contains("cannot read no-such-part: "));
}

#[test]
fn a_part_is_of_so_many_and_of_what_takes_long() {
    let said = complaint("prove --part 3/2", "");
    assert!(
        said.contains("it must be as 2/8, from 1/8 to 8/8"),
        "{said}"
    );
    let said = complaint(&format!("design --part 1/2 --robot {PAPER}"), "");
    assert!(said.contains("--part goes with --search"), "{said}");
}
