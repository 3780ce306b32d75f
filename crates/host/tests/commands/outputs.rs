//! Tests that commands overwrite no input, and that a killed command leaves no file.

use std::fs;
use std::process::Command;

use crate::harness::{Outcome, assert_contains, read_cases, read_file, run_command, run_line_in};

#[test]
fn no_command_overwrites_its_input_or_a_robot_file() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let folder_path = folder.path();
    let robot = &read_file("robots/paper.toml");
    let session =
        "{\"ms\":0,\"begin\":{\"format\":\"lizard record 1\",\"port\":\"p\",\"banner\":null}}\n";
    let files = [
        ("my.toml", robot.as_str()),
        ("robot.toml", robot),
        ("broken", "[links]\nl0 = wrong\n"),
        ("a.jsonl", session),
        ("a.txt", "500 walk\n"),
    ];
    for (name, text) in files {
        fs::write(folder_path.join(name), text).expect("the file is written");
    }
    fs::create_dir(folder_path.join("charts")).expect("the folder is created");
    for link in ["charts/top-view.svg", "my.urdf"] {
        fs::hard_link(folder_path.join("my.toml"), folder_path.join(link))
            .expect("a hard link is created");
    }
    let lines_and_protected_files = "
        flash image --robot my.toml --output my.toml => my.toml
        flash image --robot my.toml --output ./x/../my.toml => my.toml
        flash image --robot large --output robot.toml => robot.toml
        flash image --robot large --output broken => broken
        draw --robot my.toml --output my.toml => my.toml
        draw --robot my.toml --output robot.toml => robot.toml
        model my.urdf --robot my.toml => my.urdf
        console replay a.jsonl --svg a.jsonl => a.jsonl
        sim --duration 4 --svg robot.toml => robot.toml
        sim --script a.txt --svg a.txt => a.txt
        draw charts charts --robot my.toml => top-view.svg
    ";
    for (line, protected_file) in read_cases(lines_and_protected_files) {
        fs::create_dir_all(folder_path.join("x")).expect("the folder is created");
        let outcome = run_line_in(folder_path, line);
        let error = outcome.stderr;
        assert_eq!(outcome.code, Some(2), "{line}: {error}");
        assert!(
            error.contains(protected_file) && error.contains("; choose another output file"),
            "{line}: {error}"
        );
    }
    for (name, text) in files {
        let current_text = fs::read_to_string(folder_path.join(name));
        let is_unchanged = current_text.expect("the file is readable") == text;
        assert!(is_unchanged, "{name} has changed");
    }
    assert!(!folder_path.join("my-urdf-meshes").exists());
}

#[test]
fn new_writes_a_valid_robot_file_and_replaces_no_file() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let folder_path = folder.path();
    let output = run_line_in(folder_path, "new my.toml").expect_success();
    assert!(output.contains("lizard gaits --robot my.toml"), "{output}");
    let file = folder_path.join("my.toml");
    let text = fs::read_to_string(&file).expect("the file is readable");
    for part in ["\n[gait.walk]\n", "# "] {
        assert_contains(&text, part);
    }
    run_line_in(folder_path, "gaits --robot my.toml").expect_success();
    fs::write(&file, "mine").expect("the file is written");
    run_line_in(folder_path, "new my.toml")
        .expect_refusal_with("lizard: my.toml already exists; choose another name");
    let current_text = fs::read_to_string(&file).expect("the file is readable");
    assert_eq!(current_text, "mine");
    let outcome = run_line_in(folder_path, "new no/folder/my.toml");
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
}

#[test]
fn a_folder_does_not_hide_the_built_in_robot_of_its_name() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let line = "gaits --robot large";
    let output = run_line_in(folder.path(), line).expect_success();
    fs::create_dir(folder.path().join("large")).expect("the folder is created");
    let output_with_folder = run_line_in(folder.path(), line).expect_success();
    assert_eq!(output_with_folder, output);
    fs::create_dir(folder.path().join("mine")).expect("the folder is created");
    let failure = "lizard: mine: cannot be read: Is a directory (os error 21)";
    run_line_in(folder.path(), "gaits --robot mine").expect_refusal_with(failure);
}

#[test]
fn a_hyphen_as_output_is_refused_and_leaves_no_file() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for line in [
        "draw --output -",
        "flash image --output -",
        "model -",
        "new -",
        "console --sim --record -",
    ] {
        run_line_in(folder.path(), line).expect_refusal_with("- is not an output file");
    }
    assert!(!folder.path().join("-").exists());
}

#[test]
#[cfg(target_os = "linux")]
fn an_output_to_standard_output_is_appended_to_the_text_before_it() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    for (line, piped_line) in [
        ("flash image --output /dev/stdout", "flash image"),
        ("model /dev/stdout", "model /dev/stdout"),
    ] {
        let script = format!("echo before > a; exec \"$0\" {line} --robot paper >> a");
        let mut bash = Command::new("bash");
        bash.args(["-c", &script, env!("CARGO_BIN_EXE_lizard")]);
        run_command(bash.current_dir(folder.path()), "").expect_success();
        let text = fs::read_to_string(folder.path().join("a")).expect("the file is readable");
        let piped_line = format!("{piped_line} --robot paper");
        let piped_text = run_line_in(folder.path(), &piped_line).expect_success();
        assert!(text == format!("before\n{piped_text}"), "{line}: {text}");
    }
}

#[test]
#[cfg(unix)]
fn a_broken_link_called_robot_toml_is_an_error() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let link = folder.path().join("robot.toml");
    std::os::unix::fs::symlink("nothing", link).expect("a link is created");
    run_line_in(folder.path(), "gaits").expect_refusal_with("/robot.toml: cannot be read");
}

#[test]
#[cfg(target_os = "linux")]
fn a_command_killed_while_writing_leaves_no_file() {
    // The system kills a program that writes more than 8 KiB into a file.
    let limit = "ulimit -c 0 -f 8";
    let outcome = run_with_limit(limit, "flash image --robot large --output x.hex");
    assert_eq!(outcome.code, None, "no signal: {outcome:?}");
}

#[test]
#[cfg(target_os = "linux")]
fn new_leaves_no_file_if_it_cannot_write_all_bytes() {
    // A program that ignores the signal gets an error instead.
    let outcome = run_with_limit("trap '' XFSZ; ulimit -f 4", "new x.toml");
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    assert_contains(&outcome.stderr, "cannot write x.toml: ");
}

/// Runs a command line in an empty folder after a shell command that limits the size of files, and checks that no file
/// remains.
#[cfg(target_os = "linux")]
fn run_with_limit(limit: &str, line: &str) -> Outcome {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let script = format!("{limit}; exec \"$0\" {line}");
    let mut bash = Command::new("bash");
    bash.args(["-c", &script, env!("CARGO_BIN_EXE_lizard")]);
    let outcome = run_command(bash.current_dir(folder.path()), "");
    let remaining_files = fs::read_dir(folder.path()).expect("the folder is readable");
    assert_eq!(remaining_files.count(), 0, "{outcome:?}");
    outcome
}
