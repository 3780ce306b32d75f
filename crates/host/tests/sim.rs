//! `lizard sim` and `lizard draw` on wrong input, and the picture in docs/.

use std::path::Path;
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

/// The paper's robot: what these tests say of gaits and of the picture is its.
const PAPER: &str = concat!(
    "--robot=",
    env!("CARGO_MANIFEST_DIR"),
    "/../../robots/paper.toml"
);

fn lizard(arguments: &[&str]) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(arguments).current_dir(folder);
    LIMIT.output(&mut command, b"").expect("the program runs")
}

/// The message of a failure, and the exit code.
fn complaint(arguments: &[&str]) -> (String, Option<i32>) {
    let output = lizard(arguments);
    assert!(output.stdout.is_empty(), "nothing is half written");
    (
        String::from_utf8_lossy(&output.stderr).trim().to_owned(),
        output.status.code(),
    )
}

#[test]
fn a_firmware_that_is_not_there_is_named() {
    let (words, code) = complaint(&["sim", "--elf", "no/such.elf"]);
    assert_eq!(
        words,
        "lizard: there is no firmware at no/such.elf; without --elf, the one inside this program \
         is taken"
    );
    assert_eq!(code, Some(2));
}

#[test]
fn what_is_no_firmware_is_refused() {
    let own = env!("CARGO_BIN_EXE_lizard");
    let (words, code) = complaint(&["sim", "--elf", own]);
    assert!(
        words.starts_with(&format!("lizard: {own}: not an ELF file of an AVR")),
        "{words}"
    );
    assert_eq!(code, Some(2));
}

#[test]
fn a_wrong_script_names_file_and_line() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("wrong-script.txt");
    std::fs::write(&path, "100 walk\nsoon stop\n").expect("the script is written");
    let path = path.display().to_string();
    let (words, code) = complaint(&["sim", "--script", &path]);
    assert_eq!(
        words,
        format!(
            "lizard: {path}: line 2: it begins with `soon`, not with a time in whole milliseconds"
        )
    );
    assert_eq!(code, Some(2));
}

#[test]
fn a_script_that_never_ends_is_refused() {
    let (words, code) = complaint(&["sim", "--script", "/dev/zero"]);
    assert_eq!(
        words,
        "lizard: cannot read /dev/zero: it is longer than 256 MiB"
    );
    assert_eq!(code, Some(2));
}

#[test]
fn an_unknown_gait_lists_those_of_the_paper_robot() {
    let (words, code) = complaint(&["sim", PAPER, "--gait", "gallop"]);
    assert!(
        words.contains("no gait `gallop`; it has stand, walk, trot"),
        "{words}"
    );
    assert_eq!(code, Some(2));
}

#[test]
fn times_out_of_range_are_refused() {
    for duration in ["0", "-3", "nan", "1e9", "soon"] {
        let argument = format!("--duration={duration}");
        let (words, code) = complaint(&["sim", &argument]);
        assert!(words.contains("--duration"), "{words}");
        assert_eq!(code, Some(2), "{duration}");
    }
    let (words, _) = complaint(&["sim", "--duration=2"]);
    assert!(words.contains("at least 4 s"), "{words}");
}

#[test]
fn the_picture_in_docs_is_the_paper_robot_as_it_is_drawn_now() {
    let drawn = lizard(&["draw", PAPER]);
    assert!(drawn.status.success());
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/lizard.svg");
    let kept = std::fs::read(docs).expect("docs/lizard.svg is there");
    assert!(kept == drawn.stdout, "run `make docs`");
}
