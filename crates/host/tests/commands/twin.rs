//! `lizard twin` on wrong input.

use crate::program::{lizard, paper};

#[test]
fn a_gait_that_there_is_not_is_refused_with_those_there_are() {
    for (gait, words) in [
        (
            "jump",
            "lizard: robot.toml has no gait `jump`; those that move are walk, trot, crawl, back, \
             left, right, arc-left, arc-right, look",
        ),
        ("stand", "lizard: the gait `stand` moves no servo"),
    ] {
        let line = paper(&format!("twin --gait {gait}"));
        assert_eq!(lizard(&line, "").refusal(), words);
    }
}
