//! Tests that the pages in docs/ match the program's output.

use std::collections::BTreeSet;

use lizard_paper::errata::{SAMPLE_COUNT, evaluate_equations, format_markdown};

use crate::harness::{
    assert_contains, new_folder, read_file, read_length, repo_root, robot_path, run_line,
    run_line_in, scratch_folder, with_paper,
};

#[test]
fn the_errata_page_is_up_to_date_and_every_correction_holds() {
    let results = evaluate_equations(SAMPLE_COUNT, &|| {});
    assert!(results.iter().all(|result| result.has_valid_form()));
    // Each printed form has one entry, so no erratum is counted twice.
    let json = run_line("errata --samples 1 --json", "").expect_json();
    let entries = json.as_array().unwrap().iter();
    let printed_forms = entries.map(|entry| entry["printed"].as_str().unwrap());
    let mut distinct_forms = BTreeSet::new();
    for form in printed_forms.filter(|form| form.contains('=')) {
        assert!(distinct_forms.insert(form), "{form} is counted twice");
    }
    assert!(
        read_file("docs/errata.md") == format_markdown(&results, SAMPLE_COUNT),
        "docs/errata.md is out of date; run: lizard errata --markdown > docs/errata.md"
    );
}

#[test]
fn every_command_in_docs_paper_prints_the_output_on_the_page() {
    let page = read_file("docs/paper.md");
    let mut command_count = 0;
    for block in page.split("```console\n").skip(1) {
        let block = block.split("```").next().expect("the block has contents");
        let command_and_output = block.split_once('\n');
        let (command, expected_output) = command_and_output.expect("the block has an output");
        let args = command.strip_prefix("$ lizard ").expect(command);
        let output = run_line(&with_paper(args), "").expect_success();
        assert!(
            output.trim_end() == expected_output.trim_end(),
            "docs/paper.md is out of date; lizard {args} prints:\n{output}"
        );
        command_count += 1;
    }
    assert!(command_count >= 6, "{command_count} commands");
}

#[test]
fn draw_charts_writes_the_svg_files_in_docs() {
    let folder = new_folder("charts");
    let line = format!("draw charts --json charts --robot {}", robot_path("paper"));
    run_line_in(scratch_folder(), &line).expect_success();
    let entries = std::fs::read_dir(&folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    assert_eq!(
        names.join(" "),
        "conditioning.svg performance.svg singularity.svg stroke.svg top-view.svg workspace.svg \
         workspaces.svg"
    );
    for name in &names {
        let svg = std::fs::read_to_string(folder.join(name)).unwrap();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        assert!(
            read_file(&format!("docs/charts/{name}")) == svg,
            "docs/charts/{name} is out of date; run: lizard draw charts docs/charts --robot robots/paper.toml"
        );
    }
}

/// Table 1 of the paper as printed: link names and lengths, mm.
const TABLE_1: [(&str, f64); 7] = [
    ("l0 l5", 20.0),
    ("l1 l4 l6 l9 l14 l11 l16 l19", 30.0),
    ("l2 l3 l7 l8", 50.0),
    ("l12 l13 l16 l18", 45.0),
    ("l10 l15", 135.0),
    ("ground coupler", 50.0),
    ("follower crank", 45.0),
];

#[test]
fn table_1_matches_the_papers_robot_except_for_the_link_listed_twice() {
    let robot = read_file("robots/paper.toml");
    let split_row = |(names, mm): (&'static str, f64)| names.split(' ').map(move |name| (name, mm));
    let rows = TABLE_1.into_iter().flat_map(split_row);
    let differs = |(name, mm): &(&str, f64)| read_length(&robot, name) != *mm;
    let differing_rows: Vec<_> = rows.clone().filter(differs).collect();
    assert_eq!(differing_rows, [("l16", 45.0)]);
    let names = rows.map(|(name, _)| name);
    let links: BTreeSet<&str> = names.filter(|name| name.starts_with('l')).collect();
    assert_eq!(links.len(), 19);
    assert!(!links.contains("l17") && read_length(&robot, "l17") == 45.0);
    let page = read_file("docs/paper.md");
    let remark = "19 of 20 links; l17 is missing and l16 is listed twice";
    assert_contains(&page, remark);
}

#[test]
fn docs_paper_lists_every_figure_of_the_paper_with_its_command_and_files() {
    let page = read_file("docs/paper.md");
    let heading_split = page.split_once("| in the paper |");
    let (_, table) = heading_split.expect("the page has the table");
    let lines = table.lines().skip(2);
    let lines = lines.map_while(|line| line.strip_prefix("| ")?.strip_suffix(" |"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(" | ").collect()).collect();
    let figures = (1..=10).map(|number| format!("Figure {number}"));
    let other_names = ["Table 1", "Algorithm 1", "section 3.1.2"].map(str::to_owned);
    let expected_names: Vec<String> = figures.chain(other_names).collect();
    let row_names: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(row_names, expected_names);
    let charts_help = run_line("draw charts --help", "").expect_success();
    for row in &rows {
        let [name, _, command, files, agreement] = row[..] else {
            panic!("{row:?}")
        };
        assert!(!agreement.is_empty(), "{name}");
        for file in files.split(", ") {
            let path = repo_root().join("docs").join(file);
            assert!(path.is_file(), "{name}: {file}");
        }
        let Some(command) = command.strip_prefix("`lizard ") else {
            assert_eq!(command, "none", "{name}");
            continue;
        };
        let command = command.trim_end_matches('`');
        // Commands that take a DIR run for seconds; other tests run them.
        if let Some(base_command) = command.strip_suffix(" DIR") {
            run_line(&format!("{base_command} --help"), "").expect_success();
            let chart_names = files
                .split(", ")
                .filter_map(|file| file.strip_prefix("charts/")?.strip_suffix(".svg"));
            for chart_name in chart_names {
                assert!(charts_help.contains(chart_name), "{name}: {chart_name}");
            }
        } else {
            run_line(&with_paper(command), "").expect_success();
        }
    }
}

#[test]
fn docs_paper_states_the_computed_movements_of_the_papers_gaits() {
    let page = read_file("docs/paper.md").replace('\n', " ");
    let rows = run_line(&with_paper("gaits --json"), "").expect_json_lines();
    let find_prediction = |gait: &str, key: &str| -> f64 {
        let row = rows.iter().find(|row| row["gait"] == gait).expect(gait);
        row["predicted"][key].as_f64().expect(key)
    };
    let [walk_mm, trot_mm] = ["walk", "trot"].map(|gait| find_prediction(gait, "forward"));
    let left_deg = find_prediction("left", "turn");
    let foot_travel_mm = 80.0_f64.hypot(55.0) * left_deg.to_radians();
    let table = run_line(&with_paper("gaits --sensitivity"), "").expect_success();
    let find_numbers = |heading: &str, name: &str| -> Vec<f64> {
        let (_, rows) = table.split_once(heading).expect(heading);
        let prefix = format!("{name} ");
        let row = rows.lines().find_map(|line| line.strip_prefix(&prefix));
        let words = row.expect(name).split_whitespace();
        words.filter_map(|word| word.parse().ok()).collect()
    };
    // The third mount column is for 41.4 deg, and the fourth column of friction ratios for 1.25. The row of a turn has
    // two numbers in each column.
    let mounted_walk_mm = find_numbers("mount, deg", "walk")[2];
    let mounted_turn_deg = find_numbers("mount, deg", "left")[5];
    assert!(table.contains("41.4") && table.contains("1.25"));
    let uneven_walk_mm = find_numbers("back/forward", "walk")[3];
    for phrase in [
        format!("25 cycles of `walk` are {:.0} mm", 25.0 * walk_mm),
        format!("`left` turns {left_deg:.1} deg per cycle"),
        format!("`trot`, {trot_mm:.1} mm per cycle"),
        format!("`walk` moves {walk_mm:.1} mm per cycle"),
        format!("the feet, 97 mm from the middle, move by {foot_travel_mm:.1} mm"),
        format!("`walk` moves {mounted_walk_mm:.1} mm per cycle instead of {walk_mm:.1}"),
        format!("`left` turns {mounted_turn_deg:.1} deg instead of {left_deg:.1}"),
        format!("1.25 times as strong backward as forward, `walk` moves {uneven_walk_mm:.1} mm"),
    ] {
        assert_contains(&page, &phrase);
    }
}
