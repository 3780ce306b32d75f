//! Tests of the stored speeds on pads with a grain, as the contact model and MuJoCo compute them.
//!
//! With `BLESS_PHYSICS=1`, as in `make docs`, the speeds are written into docs/gaits.md and robots/grain.toml.

use lizard_physics::grains::{self, GAITS, GrainResults, RATIOS};
use lizard_physics::text::check_block;
use lizard_physics::{crate_folder, load_robot};

/// Returns the speeds of a gait at a friction ratio: by the model, if it has a result, and by MuJoCo. `component` is
/// the index in the displacement: 0 for mm/s ahead, 2 for deg/s of turn.
fn speeds_by_model_and_mujoco(
    stored: &GrainResults,
    gait: &str,
    ratio: f64,
    component: usize,
) -> Vec<f64> {
    let period = load_robot(grains::ROBOT)
        .gait(gait)
        .expect("the robot has this gait")
        .period();
    let index = RATIOS.iter().position(|known_ratio| *known_ratio == ratio);
    let results = stored[gait][index.expect("the ratio is one of the table's")];
    let displacements = results.model.into_iter().chain([results.mujoco]);
    displacements
        .map(|displacement| displacement.0[component] / period)
        .collect()
}

#[test]
fn the_page_and_the_robots_file_have_the_speeds_by_the_model_and_by_mujoco() {
    let table = grains::table(&load_robot(grains::ROBOT), &grains::stored());
    let begin = "<!-- speeds of robots/grain.toml -->\n```text\n";
    check_block("docs/gaits.md", begin, "```\n<!-- end -->", &table);
    let comment: String = table.lines().map(|line| format!("# {line}\n")).collect();
    let begin = "# leads nowhere.\n#\n";
    check_block("robots/grain.toml", begin, "#\n# Fit all", &comment);
}

#[test]
fn every_result_is_stored_in_the_format_that_is_written_and_close_to_the_model() {
    let stored = grains::stored();
    let text = std::fs::read_to_string(crate_folder().join("grains.json"))
        .expect("grains.json is readable");
    assert_eq!(text, grains::to_json(&stored));
    assert_eq!(grains::disagreements(&stored), Vec::<String>::new());
    for (gait, _) in GAITS {
        assert_eq!(stored[gait].len(), RATIOS.len(), "{gait}");
    }
}

#[test]
fn the_stored_results_of_the_model_are_up_to_date() {
    let (stored, robot) = (grains::stored(), load_robot(grains::ROBOT));
    for (name, _) in GAITS {
        let gait = robot.gait(name).expect("the robot has this gait");
        for (ratio, results) in RATIOS.into_iter().zip(&stored[name]) {
            let current = grains::model_displacement(&robot, gait, ratio);
            assert_eq!(current.is_some(), results.model.is_some(), "{name} {ratio}");
            let Some((stored_model, current_model)) = results.model.zip(current) else {
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
fn on_pads_with_a_grain_the_robot_runs_at_90_mm_per_second_and_still_turns() {
    let stored = grains::stored();
    assert_eq!(
        load_robot(grains::ROBOT).ground().friction_ratio,
        1.5,
        "robots/grain.toml"
    );
    let run_speeds = speeds_by_model_and_mujoco(&stored, "run", 1.5, 0);
    assert!(
        run_speeds.len() == 2 && run_speeds.iter().all(|mm| *mm > 90.0),
        "{run_speeds:?}"
    );
    for ratio in RATIOS {
        let turn_speeds = speeds_by_model_and_mujoco(&stored, "arc-left", ratio, 2);
        assert!(
            turn_speeds.len() == 2 && turn_speeds.iter().all(|deg| *deg > 14.0),
            "{turn_speeds:?}"
        );
    }
    for (gait, component, min_speed) in [("left", 2, 14.0), ("back", 0, 30.0)] {
        let gait_speeds = speeds_by_model_and_mujoco(&stored, gait, 1.5, component);
        let is_fast = |speed: &f64| speed.abs() > min_speed;
        assert!(
            gait_speeds.len() == 2 && gait_speeds.iter().all(is_fast),
            "{gait_speeds:?}"
        );
    }
}
