//! `lizard sim` and `lizard draw` on wrong input, and the picture in docs/.

use crate::program::{read, robot, run, scratch};

fn complaint(words: &[&str]) -> String {
    run(words).refusal()
}

#[test]
fn a_firmware_that_is_not_there_is_named() {
    let words = complaint(&["sim", "--elf", "no/such.elf"]);
    assert_eq!(
        words,
        "lizard: there is no firmware at no/such.elf; without --elf, the one inside this program \
         is used"
    );
}

#[test]
fn a_file_that_is_not_firmware_is_refused() {
    let own = env!("CARGO_BIN_EXE_lizard");
    let words = complaint(&["sim", "--elf", own]);
    assert!(
        words.starts_with(&format!("lizard: {own}: not an ELF file of an AVR")),
        "{words}"
    );
}

#[test]
fn a_wrong_script_names_file_and_line() {
    let path = scratch().join("wrong-script.txt");
    std::fs::write(&path, "100 walk\nsoon stop\n").expect("the script is written");
    let path = path.display().to_string();
    let words = complaint(&["sim", "--script", &path]);
    assert_eq!(
        words,
        format!(
            "lizard: {path}: line 2: it begins with `soon`, not with a time in whole milliseconds"
        )
    );
}

#[test]
fn a_script_that_never_ends_is_refused() {
    let words = complaint(&["sim", "--script", "/dev/zero"]);
    assert_eq!(
        words,
        "lizard: cannot read /dev/zero: it is longer than 256 MiB"
    );
}

#[test]
fn an_unknown_gait_lists_those_of_the_paper_robot() {
    let words = complaint(&["sim", "--robot", &robot("paper"), "--gait", "gallop"]);
    assert!(
        words.contains("no gait `gallop`; it has stand, walk, trot"),
        "{words}"
    );
}

#[test]
fn times_out_of_range_are_refused() {
    for duration in ["0", "-3", "nan", "1e9", "soon"] {
        let argument = format!("--duration={duration}");
        let words = complaint(&["sim", &argument]);
        assert!(words.contains("--duration"), "{words}");
    }
    let words = complaint(&["sim", "--duration=2"]);
    assert!(words.contains("at least 4 s"), "{words}");
}

#[test]
fn the_picture_in_docs_is_up_to_date() {
    let drawn = run(&["draw", "--robot", &robot("paper")]).success();
    assert!(read("docs/lizard.svg") == drawn, "run `make docs`");
}
