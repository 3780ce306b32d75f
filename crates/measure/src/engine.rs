//! The movement of gaits according to MuJoCo, an independent physics engine, for the robots of the project's
//! own files.

use std::collections::BTreeMap;

use serde::Deserialize;

/// The robots of `tools/physics/figures.json` and their files.
const FILES: [(&str, &str); 4] = [
    ("large", include_str!("../../../robots/large.toml")),
    ("own-gaits", include_str!("../../../robots/own-gaits.toml")),
    ("paper", include_str!("../../../robots/paper.toml")),
    ("unequal", include_str!("../../../robots/unequal.toml")),
];
/// Results of the last run of `make physics`.
const FIGURES: &str = include_str!("../../../tools/physics/figures.json");
/// Key of the results without play, lag or a foot that is too long.
const CASE: &str = "rigid, level";

#[derive(Deserialize)]
struct Answers {
    mujoco: [f64; 3],
}

/// Movement per cycle at full pace: mm ahead, mm to the left, deg. `None` if the text differs in more than
/// comments from each of the project's own robots, or if there is no result for the gait.
pub fn mujoco(text: &str, gait: &str) -> Option<[f64; 3]> {
    let (robot, _) = FILES.into_iter().find(|(_, file_text)| {
        lines_without_comments(file_text).eq(lines_without_comments(text))
    })?;
    let figures: BTreeMap<&str, BTreeMap<&str, BTreeMap<&str, Answers>>> =
        serde_json::from_str(FIGURES).ok()?;
    Some(figures.get(robot)?.get(gait)?.get(CASE)?.mujoco)
}

/// The lines of a text that are not comments.
fn lines_without_comments(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.starts_with('#'))
}
