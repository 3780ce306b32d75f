//! docs/gaits.md shows what the engine says.

use std::fmt::Write;

use lizard_robot::{Robot, Travel};

use crate::paper;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/gaits.md");
const BEGIN: &str = "<!-- rigid bodies -->\n";
const END: &str = "<!-- end -->";

/// The page's table of both models; `BLESS_GAITS=1` writes it.
pub fn check(engine: &[(&str, Travel)]) {
    let page = std::fs::read_to_string(PAGE).expect(PAGE);
    let start = page.find(BEGIN).expect(BEGIN) + BEGIN.len();
    let end = start + page[start..].find(END).expect(END);
    let now = format!(
        "{}{}{}",
        &page[..start],
        table(paper(), engine),
        &page[end..]
    );
    if std::env::var_os("BLESS_GAITS").is_some() {
        std::fs::write(PAGE, now).expect(PAGE);
    } else {
        assert_eq!(
            page, now,
            "docs/gaits.md is out of date; run with BLESS_GAITS=1"
        );
    }
}

fn table(robot: &Robot, engine: &[(&str, Travel)]) -> String {
    let mut rows = "| gait | predicted | rigid bodies |\n|---|---|---|\n".to_string();
    for (name, theirs) in engine {
        let ours = robot.gait(name).expect(name).walked(robot.ground()).travel;
        writeln!(rows, "| {name} | {} | {} |", cell(&ours), cell(theirs))
            .expect("a String takes all");
    }
    rows
}

/// Ahead and turn, as far as a gait does either.
fn cell(way: &Travel) -> String {
    let ahead = (way.forward.abs() > 1.0).then(|| format!("{:+.1} mm", way.forward));
    let turn = (way.turn.abs() > 0.5).then(|| format!("{:+.1} deg", way.turn));
    let parts: Vec<String> = [ahead, turn].into_iter().flatten().collect();
    parts.join(", ")
}
