//! Tests of the command line: help, aliases, suggestions, completions and manual pages.

use std::path::Path;
use std::process::Command;

use crate::harness::{
    assert_contains, expect_refusals, repo_root, run, run_command, run_line_in, scratch_folder,
};

fn run_successfully(arguments: &[&str]) -> String {
    run(arguments).expect_success()
}

/// The headings of `lizard --help`. The first five are above all commands except those for scripts and development.
const HEADINGS: [&str; 7] = [
    "Drive the robot",
    "Simulate it",
    "Build it",
    "Change its gaits and dimensions",
    "The paper, computed",
    "For scripts and development",
    "Options",
];

/// Returns the first words of the lines under a heading of `lizard --help`.
fn find_first_words(help: &str, heading: &str) -> Vec<String> {
    let (_, rest) = help.split_once(&format!("\n{heading}:\n")).expect(heading);
    let (section, _) = rest.split_once("\n\n").expect(heading);
    let first_word = |line: &str| line.split_whitespace().next().expect(heading).to_owned();
    section.lines().map(first_word).collect()
}

#[test]
fn help_groups_all_commands_by_purpose() {
    let help = run_successfully(&["--help"]);
    let positions = HEADINGS.map(|heading| help.find(&format!("\n{heading}:\n")).expect(heading));
    assert!(positions.is_sorted(), "{help}");
    assert!(help.contains("\n  merge, completions\n"), "{help}");
    let count_commands = |heading: &&str| find_first_words(&help, heading).len();
    let command_count: usize = HEADINGS[..5].iter().map(count_commands).sum();
    // Two more commands, `merge` and `completions`, are for scripts.
    assert!(command_count + 2 <= 20, "{help}");
    assert!(find_first_words(&help, "Drive the robot").contains(&"console".to_owned()));
    assert_eq!(run_successfully(&["help"]), help);
}

#[test]
fn monitor_is_an_alias_of_console() {
    let print_help = |command: &str| run_successfully(&[command, "--help"]);
    assert_eq!(print_help("monitor"), print_help("console"));
    let help = run_successfully(&["help"]);
    let line = help.lines().find(|line| line.contains(" console "));
    assert!(line.is_some_and(|line| line.contains("[also: monitor]")));
}

#[test]
fn a_deprecated_command_prints_the_output_of_its_replacement_and_a_warning() {
    for (old, new) in [
        ("fk --help", "pose --help"),
        ("inverse --head 5 120", "pose --head 5 120"),
        ("jacobian --omega1 5", "pose --show rates --omega1 5"),
        ("singularity --json", "pose --show singularities --json"),
        ("mobility --json", "pose --show freedoms --json"),
        ("record a.jsonl --help", "console --help"),
        ("replay --help", "console replay --help"),
        ("image --robot grain", "flash image --robot grain"),
        ("backup --help", "calibrate backup --help"),
        ("restore --help", "calibrate restore --help"),
        ("charts --help", "draw charts --help"),
        ("bench --help", "sim bench --help"),
        ("man --help", "completions man --help"),
    ] {
        let [old_run, new_run] = [old, new].map(|line| run_line_in(scratch_folder(), line));
        assert!(old_run.stdout == new_run.stdout, "{old_run:?}");
        let advice = "` is deprecated and will be removed in the next version; use `lizard ";
        assert_contains(&old_run.stderr, advice);
        assert_eq!(new_run.stderr, "");
    }
}

#[test]
fn a_removed_command_is_refused_with_advice() {
    run(&["spring", "--wire", "0.6"])
        .expect_refusal_with("the command `spring` was removed; a spring's force");
}

#[test]
fn a_message_about_a_very_long_word_shows_only_its_start() {
    let long_word = "x".repeat(20_000);
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let robot_text = format!("name = {long_word}\n");
    std::fs::write(folder.path().join("x.toml"), robot_text).expect("the file is written");
    for line in [
        long_word.as_str(),
        &format!("gaits --robot {long_word}"),
        "gaits --robot x.toml",
        &format!("sim --gait {long_word}"),
        &format!("draw --theta1 {long_word}"),
        &format!("calibrate restore {long_word}"),
    ] {
        let error = run_line_in(folder.path(), line).expect_refusal();
        assert!(error.contains("xxx [..."), "{error}");
        assert!(error.len() < 2500, "{} bytes: {error}", error.len());
    }
}

#[test]
fn the_refusal_of_a_mistyped_word_suggests_the_correct_word() {
    let cases = "
        claibrate => 'calibrate'
        sim --durration 5 => '--duration'
        draw --wirring => '--wiring'
        sim --fidelity stok => 'stock'
        sim --gait wlak --robot robots/paper.toml => ; did you mean `walk`?
        twin --gait trott --robot robots/paper.toml => ; did you mean `trot`?
        tune --gait wakl --robot robots/paper.toml => ; did you mean `walk`?
        gaits --trace arc-lfet --robot robots/paper.toml => ; did you mean `arc-left`?
    ";
    expect_refusals(&repo_root(), cases);
}

/// Runs the completion script in bash without bash's own completions; returns the completions of the word at `index`.
#[cfg(unix)]
fn complete_in_bash(script: &Path, typed_line: &str, index: usize) -> Vec<String> {
    let line = format!(
        ". {}; COMP_WORDS=({typed_line}); COMP_CWORD={index}; COMP_LINE='{typed_line}'; \
         _lizard lizard \"${{COMP_WORDS[{index}]}}\" \"${{COMP_WORDS[{}]}}\"; \
         printf '%s\\n' \"${{COMPREPLY[@]}}\"",
        script.display(),
        index - 1
    );
    let mut bash = Command::new("bash");
    let text = run_command(bash.args(["--norc", "-c", &line]), "").expect_success();
    text.lines().map(str::to_owned).collect()
}

#[test]
#[cfg(unix)]
fn bash_completes_commands_and_options() {
    let script = scratch_folder().join("lizard.bash");
    let script_text = run_successfully(&["completions", "bash"]);
    std::fs::write(&script, script_text).expect("the file is written");
    let root = repo_root().display().to_string();
    let files = [format!("{root}/robot.toml"), format!("{root}/robots/")];
    for (line, index, expected) in [
        ("lizard calib", 1, &["calibrate"][..]),
        ("lizard twin --ro", 2, &["--robust", "--robot"]),
        ("lizard sim --fidelity sto", 3, &["stock"]),
        ("lizard gaits --robot la", 3, &["large"]),
        (
            &format!("lizard gaits --robot {root}/rob"),
            3,
            &files.each_ref().map(String::as_str),
        ),
        // A gait has no file completions.
        ("lizard sim --gait ", 3, &[""]),
    ] {
        assert_eq!(complete_in_bash(&script, line, index), expected, "{line}");
    }
}

#[test]
fn zsh_and_fish_complete_robot_files() {
    for (shell, expected) in [
        ("zsh", ":_files -g \"*.toml\"' "),
        ("fish", " -r -k -xa \"(__fish_complete_suffix .toml) grain "),
    ] {
        assert_contains(&run_successfully(&["completions", shell]), expected);
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let pages = folder.path().join("man1");
    run_successfully(&["completions", "man", &pages.display().to_string()]);
    let help = run_successfully(&["--help"]);
    let mut page_count = 0;
    let headings = HEADINGS[..5].iter();
    for name in headings.flat_map(|heading| find_first_words(&help, heading)) {
        let page = std::fs::read_to_string(pages.join(format!("lizard-{name}.1")));
        let page = page.expect("the manual page is readable");
        assert_contains(&page, &format!(".TH lizard-{name} 1"));
        // In a manual page, a literal hyphen is written `\-`.
        assert_contains(&page, r"\-\-help");
        page_count += 1;
    }
    assert!(page_count > 17, "{page_count} pages");
    for subcommand in ["calibrate-backup", "flash-image", "sim-bench"] {
        let page = pages.join(format!("lizard-{subcommand}.1"));
        assert!(page.is_file(), "{subcommand}");
    }
    let main_page = std::fs::read_to_string(pages.join("lizard.1")).expect("the file is readable");
    assert_contains(&main_page, "lizard\\-console(1)");
}

#[test]
fn info_ports_prints_a_list_as_json_and_as_text() {
    let ports = run(&["info", "ports", "--json"]).expect_json();
    let ports = ports.as_array().expect("the value is an array");
    let text = run_successfully(&["info", "ports"]);
    let has_no_port = text.contains("no USB serial port");
    assert_eq!(has_no_port, ports.is_empty(), "{text}");
    assert!(text.lines().count() >= ports.len().max(1), "{text}");
}

#[test]
fn the_refusal_of_bench_without_a_build_suggests_how_to_build() {
    let message = run(&["sim", "bench"]).expect_refusal();
    assert_contains(&message, "`make firmware`");
    assert_contains(&message, "lizard sim bench --elf ");
}
