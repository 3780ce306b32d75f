//! The pages are what the program makes today.

use lizard_host::errata::{SAMPLES, markdown, measure};

use crate::program::{lizard, paper, read, root};

#[test]
fn the_errata_are_what_is_measured_and_every_correction_holds() {
    let entries = measure(SAMPLES);
    assert!(entries.iter().all(|entry| entry.is_settled()));
    // One entry for each printed form: none is counted twice.
    let listed = lizard("errata --samples 1 --json", "").json();
    let mut forms: Vec<String> = listed
        .as_array()
        .unwrap()
        .iter()
        .map(|entry| entry["printed"].as_str().unwrap().to_string())
        .filter(|form| form.contains('='))
        .collect();
    let count = forms.len();
    forms.sort_unstable();
    forms.dedup();
    assert_eq!(forms.len(), count, "a condition is counted twice");
    assert!(
        read("docs/errata.md") == markdown(&entries, SAMPLES),
        "docs/errata.md is out of date: lizard errata --markdown > docs/errata.md"
    );
}

#[test]
fn every_command_in_the_walk_through_of_the_paper_prints_what_the_page_shows() {
    let page = read("docs/paper.md");
    let mut commands = 0;
    for block in page.split("```console\n").skip(1) {
        let block = block.split("```").next().expect("a closed block");
        let (command, shown) = block.split_once('\n').expect("a command and its answer");
        let args = command.strip_prefix("$ lizard ").expect("a lizard command");
        let outcome = lizard(&paper(args), "");
        assert_eq!(outcome.code, Some(0), "{args}: {}", outcome.err);
        assert!(
            outcome.out.trim_end() == shown.trim_end(),
            "docs/paper.md is out of date: lizard {args}\n{}",
            outcome.out
        );
        commands += 1;
    }
    assert!(commands >= 6, "{commands}");
}

#[test]
fn charts_come_as_svg_leave_nothing_else_and_are_those_of_the_docs() {
    let folder = std::env::temp_dir().join(format!("lizard-charts-{}", std::process::id()));
    let robot = root().join("robots/paper.toml");
    let (place, robot) = (folder.display(), robot.display());
    let outcome = lizard(&format!("charts --json {place} --robot {robot}"), "");
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let expected: Vec<String> = [
        "conditioning",
        "performance",
        "singularity",
        "stroke",
        "top-view",
        "workspace",
    ]
    .map(|name| format!("{name}.svg"))
    .into();
    assert_eq!(names, expected);
    for name in &names {
        let svg = std::fs::read_to_string(folder.join(name)).unwrap();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        assert!(
            read(&format!("docs/charts/{name}")) == svg,
            "docs/charts/{name} is out of date: lizard charts docs/charts --robot robots/paper.toml"
        );
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
