//! `lizard sim` and `lizard draw` on wrong input, and the picture in docs/.

use crate::program::{read, robot, run, scratch};

fn complaint(arguments: &[&str]) -> String {
    run(arguments).refusal()
}

#[test]
fn a_firmware_that_is_not_there_is_named() {
    let message = complaint(&["sim", "--elf", "no/such.elf"]);
    assert_eq!(
        message,
        "lizard: there is no firmware at no/such.elf; without --elf, the one inside this program \
         is used"
    );
}

#[test]
fn a_file_that_is_not_firmware_is_refused() {
    let own = env!("CARGO_BIN_EXE_lizard");
    let message = complaint(&["sim", "--elf", own]);
    assert!(
        message.starts_with(&format!("lizard: {own}: not an ELF file of an AVR")),
        "{message}"
    );
}

#[test]
fn a_wrong_script_names_file_and_line() {
    let path = scratch().join("wrong-script.txt");
    std::fs::write(&path, "100 walk\nsoon stop\n").expect("the script is written");
    let path = path.display().to_string();
    let message = complaint(&["sim", "--script", &path]);
    assert_eq!(
        message,
        format!(
            "lizard: {path}: line 2: it begins with `soon`, not with a time in whole milliseconds"
        )
    );
}

#[test]
fn a_script_that_never_ends_is_refused() {
    let message = complaint(&["sim", "--script", "/dev/zero"]);
    assert_eq!(
        message,
        "lizard: cannot read /dev/zero: it is longer than 256 MiB"
    );
}

#[test]
fn an_unknown_gait_lists_those_of_the_paper_robot() {
    let message = complaint(&["sim", "--robot", &robot("paper"), "--gait", "gallop"]);
    assert!(
        message.contains("no gait `gallop`; it has stand, walk, trot"),
        "{message}"
    );
}

#[test]
fn times_out_of_range_are_refused() {
    for duration in ["0", "-3", "nan", "1e9", "soon"] {
        let argument = format!("--duration={duration}");
        let message = complaint(&["sim", &argument]);
        assert!(message.contains("--duration"), "{message}");
    }
    let message = complaint(&["sim", "--duration=2"]);
    assert!(message.contains("at least 4 s"), "{message}");
}

#[test]
fn the_picture_in_docs_is_up_to_date() {
    let drawn = run(&["draw", "--robot", &robot("paper")]).success();
    assert!(read("docs/lizard.svg") == drawn, "run `make docs`");
}
