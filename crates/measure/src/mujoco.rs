//! The movement of gaits according to MuJoCo, an independent physics engine, for the project's own robots.

use std::collections::BTreeMap;

use serde::Deserialize;

/// The robots of `tools/physics/walks.json` and their files.
const ROBOT_FILES: [(&str, &str); 4] = [
    ("large", include_str!("../../../robots/large.toml")),
    ("own-gaits", include_str!("../../../robots/own-gaits.toml")),
    ("paper", include_str!("../../../robots/paper.toml")),
    ("unequal", include_str!("../../../robots/unequal.toml")),
];
/// The results of the last run of `make physics`.
const RESULTS_JSON: &str = include_str!("../../../tools/physics/walks.json");
/// The key of the results without play, without lag, and with feet of equal length.
const RIGID_CASE: &str = "rigid, level";

/// The results for one gait in one case.
#[derive(Deserialize)]
struct GaitResult {
    /// Movement per cycle: mm forward, mm to the left, deg counter-clockwise.
    mujoco: [f64; 3],
}

/// Finds the movement per cycle of a gait at full pace: mm forward, mm to the left, deg counter-clockwise. `None` if
/// there is no result for the gait, or if `robot_toml` differs from the project's own robots in more than comments.
pub fn find_mujoco_movement(robot_toml: &str, gait: &str) -> Option<[f64; 3]> {
    let (robot, _) = ROBOT_FILES.into_iter().find(|(_, file_text)| {
        lines_without_comments(file_text).eq(lines_without_comments(robot_toml))
    })?;
    let results: BTreeMap<&str, BTreeMap<&str, BTreeMap<&str, GaitResult>>> =
        serde_json::from_str(RESULTS_JSON).ok()?;
    Some(results.get(robot)?.get(gait)?.get(RIGID_CASE)?.mujoco)
}

/// Returns the lines of a text that are not comments.
fn lines_without_comments(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.starts_with('#'))
}
