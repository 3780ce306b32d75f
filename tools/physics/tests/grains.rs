//! Tests of the speeds that the contact model and MuJoCo computed for pads with a grain, as stored in grains.json.
//!
//! With `BLESS_PHYSICS=1`, as in `make docs`, the tests write the speeds into docs/gaits.md and robots/grain.toml.

use lizard_physics::grains::{self, FRICTION_RATIOS, GAITS, GrainResults};
use lizard_physics::text::{check_or_update_block, format_stored, load_stored};
use lizard_physics::{Component, crate_dir, load_robot};

/// Returns a gait's speeds at a friction ratio, mm/s or deg/s: the model's, if the model has a result, and MuJoCo's.
fn compute_speeds(stored: &GrainResults, gait: &str, ratio: f64, component: Component) -> Vec<f64> {
    let robot = load_robot(grains::ROBOT);
    let period = robot.gait(gait).expect("the robot has this gait").period();
    let index = FRICTION_RATIOS.iter().position(|known| *known == ratio);
    let results = stored[gait][index.expect("the table has the ratio")];
    let displacements = results.model.into_iter().chain([results.mujoco]);
    let speeds = displacements.map(|displacement| component.value(displacement) / period);
    speeds.collect()
}

/// True if the model's and MuJoCo's speeds both exceed a minimum.
fn are_both_above(speeds: &[f64], min_speed: f64) -> bool {
    speeds.len() == 2 && speeds.iter().all(|speed| *speed > min_speed)
}

#[test]
fn the_documentation_and_the_robot_file_have_the_stored_speeds() {
    let table = grains::format_table(&load_robot(grains::ROBOT), &load_stored("grains.json"));
    let begin = "<!-- speeds of robots/grain.toml -->\n```text\n";
    check_or_update_block("docs/gaits.md", begin, "```\n<!-- end -->", &table);
    let comment: String = table.lines().map(|line| format!("# {line}\n")).collect();
    let begin = "grain neither pair prevails: any number for run at r = 1.0 is an artefact.\n#\n";
    check_or_update_block("robots/grain.toml", begin, "#\n# Fit all", &comment);
}

#[test]
fn the_file_has_every_result_in_the_format_of_format_stored() {
    let stored: GrainResults = load_stored("grains.json");
    let text = std::fs::read_to_string(crate_dir().join("grains.json"));
    let text = text.expect("grains.json is readable");
    assert_eq!(text, format_stored(&stored, 2));
    for (gait, _) in GAITS {
        assert_eq!(stored[gait].len(), FRICTION_RATIOS.len(), "{gait}");
    }
}

#[test]
fn mujocos_results_agree_with_the_models() {
    let disagreements = grains::describe_disagreements(&load_stored("grains.json"));
    assert_eq!(disagreements, Vec::<String>::new());
}

#[test]
fn the_stored_results_of_the_model_are_up_to_date() {
    let stored: GrainResults = load_stored("grains.json");
    let robot = load_robot(grains::ROBOT);
    for (name, _) in GAITS {
        let gait = robot.gait(name).expect("the robot has this gait");
        for (ratio, results) in FRICTION_RATIOS.into_iter().zip(&stored[name]) {
            let current = grains::simulate_contact_model(&robot, gait, ratio);
            assert_eq!(current.is_some(), results.model.is_some(), "{name} {ratio}");
            let Some((stored_model, current_model)) = results.model.zip(current) else {
                continue;
            };
            let (mm, deg) = stored_model.compute_difference(current_model);
            let values = format!("stored {stored_model:?}, computed {current_model:?}");
            assert!(mm < 0.05 && deg < 0.05, "{name} {ratio}: {values}");
        }
    }
}

#[test]
fn on_pads_with_a_grain_the_robot_runs_faster_than_90_mm_per_second_and_turns() {
    let stored = load_stored("grains.json");
    let ratio = load_robot(grains::ROBOT).ground().friction_ratio;
    assert_eq!(ratio, 1.5, "the friction ratio in robots/grain.toml");
    let speeds = compute_speeds(&stored, "run", 1.5, Component::Forward);
    assert!(are_both_above(&speeds, 90.0), "run: {speeds:?} mm/s");
    for ratio in FRICTION_RATIOS {
        let speeds = compute_speeds(&stored, "arc-left", ratio, Component::Turn);
        assert!(are_both_above(&speeds, 14.0), "arc-left: {speeds:?} deg/s");
    }
    for (gait, component, min_speed) in [
        ("left", Component::Turn, 14.0),
        ("back", Component::Forward, 30.0),
    ] {
        let speeds = compute_speeds(&stored, gait, 1.5, component);
        let magnitudes: Vec<f64> = speeds.iter().map(|speed| speed.abs()).collect();
        assert!(are_both_above(&magnitudes, min_speed), "{gait}: {speeds:?}");
    }
}
