//! Tests of the stored speeds on pads with a grain, by the contact model and by MuJoCo.
//!
//! With `BLESS_PHYSICS=1` the speeds are written into docs/gaits.md and robots/grain.toml, as `make docs` does.

use lizard_physics::grains::{self, GAITS, Grains, RATIOS};
use lizard_physics::{crate_folder, robot};

/// Returns the speeds of a gait at a friction ratio, by the model, if known, and by MuJoCo. `part` is the index
/// in the displacement: 0 for mm/s ahead, 2 for deg/s of turn.
fn speeds(kept: &Grains, gait: &str, ratio: f64, part: usize) -> Vec<f64> {
    let period = robot(grains::ROBOT).gait(gait).expect(gait).period();
    let index = RATIOS.iter().position(|known| *known == ratio);
    let answers = kept[gait][index.expect("a ratio of the table")];
    let displacements = answers.model.into_iter().chain([answers.mujoco]);
    displacements
        .map(|displacement| displacement.0[part] / period)
        .collect()
}

/// Compares a file's text between `begin` and `end` with `wanted`; replaces it if `BLESS_PHYSICS` is set.
fn block(path: &str, begin: &str, end: &str, wanted: &str) {
    let file = crate_folder().join("../..").join(path);
    let text = std::fs::read_to_string(&file).expect(path);
    let start = text.find(begin).expect(begin) + begin.len();
    let stop = start + text[start..].find(end).expect(end);
    let now = format!("{}{wanted}{}", &text[..start], &text[stop..]);
    if std::env::var_os("BLESS_PHYSICS").is_some() {
        std::fs::write(&file, now).expect(path);
    } else {
        assert_eq!(text, now, "{path} is out of date; run with BLESS_PHYSICS=1");
    }
}

#[test]
fn the_page_and_the_robots_file_have_the_speeds_of_model_and_engine() {
    let table = grains::table(&robot(grains::ROBOT), &grains::stored());
    let start = "<!-- speeds of robots/grain.toml -->\n```text\n";
    block("docs/gaits.md", start, "```\n<!-- end -->", &table);
    let comment: String = table.lines().map(|line| format!("# {line}\n")).collect();
    let start = "# leads nowhere.\n#\n";
    block("robots/grain.toml", start, "#\n# Fit all", &comment);
}

#[test]
fn every_speed_is_stored_as_it_is_read_and_close_to_the_model() {
    let kept = grains::stored();
    let text = std::fs::read_to_string(crate_folder().join("grains.json")).expect("grains.json");
    assert_eq!(text, grains::text(&kept));
    assert_eq!(grains::disagreements(&kept), Vec::<String>::new());
    for (gait, _) in GAITS {
        assert_eq!(kept[gait].len(), RATIOS.len(), "{gait}");
    }
}

#[test]
fn the_stored_answers_of_the_model_are_its_present_ones() {
    let (kept, robot) = (grains::stored(), robot(grains::ROBOT));
    for (name, _) in GAITS {
        let gait = robot.gait(name).expect(name);
        for (ratio, answers) in RATIOS.into_iter().zip(&kept[name]) {
            let now = grains::model(&robot, gait, ratio);
            assert_eq!(now.is_some(), answers.model.is_some(), "{name} {ratio}");
            let Some((was, is)) = answers.model.zip(now) else {
                continue;
            };
            let (mm, deg) = was.distance_to(&is);
            assert!(mm < 0.05 && deg < 0.05, "{name} {ratio}: {was:?} {is:?}");
        }
    }
}

#[test]
fn with_a_grain_the_robot_runs_at_90_mm_a_second_and_still_turns() {
    let kept = grains::stored();
    assert_eq!(
        robot(grains::ROBOT).ground().ratio,
        1.5,
        "robots/grain.toml"
    );
    let run = speeds(&kept, "run", 1.5, 0);
    assert!(run.len() == 2 && run.iter().all(|mm| *mm > 90.0), "{run:?}");
    for ratio in RATIOS {
        let turn = speeds(&kept, "arc-left", ratio, 2);
        assert!(
            turn.len() == 2 && turn.iter().all(|deg| *deg > 14.0),
            "{turn:?}"
        );
    }
    for (gait, part, min) in [("left", 2, 14.0), ("back", 0, 30.0)] {
        let against = speeds(&kept, gait, 1.5, part);
        let still = |speed: &f64| speed.abs() > min;
        assert!(
            against.len() == 2 && against.iter().all(still),
            "{against:?}"
        );
    }
}
