//! Tests of the stored speeds on pads with a grain, by the contact model and by MuJoCo.
//!
//! With `BLESS_PHYSICS=1` the speeds are written into docs/gaits.md and robots/grain.toml, as `make docs` does.

use lizard_physics::grains::{self, GAITS, Grains, RATIOS};
use lizard_physics::{crate_folder, robot};

/// Returns the speeds of a gait at a friction ratio, by the model, if known, and by MuJoCo. `component` is the index
/// in the displacement: 0 for mm/s ahead, 2 for deg/s of turn.
fn speeds(stored: &Grains, gait: &str, ratio: f64, component: usize) -> Vec<f64> {
    let period = robot(grains::ROBOT).gait(gait).expect(gait).period();
    let index = RATIOS.iter().position(|known| *known == ratio);
    let answers = stored[gait][index.expect("a ratio of the table")];
    let displacements = answers.model.into_iter().chain([answers.mujoco]);
    displacements
        .map(|displacement| displacement.0[component] / period)
        .collect()
}

/// Compares a file's text between `begin` and `end` with `expected`; replaces it if `BLESS_PHYSICS` is set.
fn check_block(path: &str, begin: &str, end: &str, expected: &str) {
    let file = crate_folder().join("../..").join(path);
    let text = std::fs::read_to_string(&file).expect(path);
    let start = text.find(begin).expect(begin) + begin.len();
    let stop = start + text[start..].find(end).expect(end);
    let new_text = format!("{}{expected}{}", &text[..start], &text[stop..]);
    if std::env::var_os("BLESS_PHYSICS").is_some() {
        std::fs::write(&file, new_text).expect(path);
    } else {
        assert_eq!(
            text, new_text,
            "{path} is out of date; run with BLESS_PHYSICS=1"
        );
    }
}

#[test]
fn the_page_and_the_robots_file_have_the_speeds_of_model_and_engine() {
    let table = grains::table(&robot(grains::ROBOT), &grains::stored());
    let start = "<!-- speeds of robots/grain.toml -->\n```text\n";
    check_block("docs/gaits.md", start, "```\n<!-- end -->", &table);
    let comment: String = table.lines().map(|line| format!("# {line}\n")).collect();
    let start = "# leads nowhere.\n#\n";
    check_block("robots/grain.toml", start, "#\n# Fit all", &comment);
}

#[test]
fn every_speed_is_stored_as_it_is_read_and_close_to_the_model() {
    let stored = grains::stored();
    let text = std::fs::read_to_string(crate_folder().join("grains.json")).expect("grains.json");
    assert_eq!(text, grains::text(&stored));
    assert_eq!(grains::disagreements(&stored), Vec::<String>::new());
    for (gait, _) in GAITS {
        assert_eq!(stored[gait].len(), RATIOS.len(), "{gait}");
    }
}

#[test]
fn the_stored_answers_of_the_model_are_its_present_ones() {
    let (stored, robot) = (grains::stored(), robot(grains::ROBOT));
    for (name, _) in GAITS {
        let gait = robot.gait(name).expect(name);
        for (ratio, answers) in RATIOS.into_iter().zip(&stored[name]) {
            let current = grains::model(&robot, gait, ratio);
            assert_eq!(current.is_some(), answers.model.is_some(), "{name} {ratio}");
            let Some((stored_model, current_model)) = answers.model.zip(current) else {
                continue;
            };
            let (mm, deg) = stored_model.distance_to(&current_model);
            assert!(
                mm < 0.05 && deg < 0.05,
                "{name} {ratio}: {stored_model:?} {current_model:?}"
            );
        }
    }
}

#[test]
fn with_a_grain_the_robot_runs_at_90_mm_a_second_and_still_turns() {
    let stored = grains::stored();
    assert_eq!(
        robot(grains::ROBOT).ground().friction_ratio,
        1.5,
        "robots/grain.toml"
    );
    let run_speeds = speeds(&stored, "run", 1.5, 0);
    assert!(
        run_speeds.len() == 2 && run_speeds.iter().all(|mm| *mm > 90.0),
        "{run_speeds:?}"
    );
    for ratio in RATIOS {
        let turn_speeds = speeds(&stored, "arc-left", ratio, 2);
        assert!(
            turn_speeds.len() == 2 && turn_speeds.iter().all(|deg| *deg > 14.0),
            "{turn_speeds:?}"
        );
    }
    for (gait, component, min) in [("left", 2, 14.0), ("back", 0, 30.0)] {
        let gait_speeds = speeds(&stored, gait, 1.5, component);
        let is_fast = |speed: &f64| speed.abs() > min;
        assert!(
            gait_speeds.len() == 2 && gait_speeds.iter().all(is_fast),
            "{gait_speeds:?}"
        );
    }
}
