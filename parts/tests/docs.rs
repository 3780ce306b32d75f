//! What docs/build.md says of `[parts]` is what is so where it is left out.

use lizard_robot::{Parts, Robot};

fn read(path: &str) -> String {
    let path = format!("{}/../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|fault| panic!("{path}: {fault}"))
}

/// The block of the page that has all keys.
fn block() -> String {
    let page = read("docs/build.md");
    let blocks = page.split("```toml\n").skip(1);
    let mut blocks = blocks.filter_map(|rest| rest.split("```").next());
    let all = blocks.find(|block| block.contains("[parts.servo]"));
    all.expect("a block with [parts.servo]").to_owned()
}

#[test]
fn the_page_has_the_values_of_what_is_left_out() {
    let paper = read("robots/paper.toml");
    let robot = Robot::parse(&format!("{paper}\n{}", block())).expect("docs/build.md");
    let paper = Robot::parse(&paper).expect("robots/paper.toml");
    // The foot's place that is left out is the one that hips would give.
    let mut parts = *robot.parts();
    assert!(parts.foot.take().is_some());
    assert_eq!(parts, Parts::default());
    assert_eq!(robot.ground(), paper.ground());
    assert_eq!(robot.legs(), paper.legs());
}

#[test]
fn the_page_has_every_key() {
    let block = block();
    // The names of all fields, as they are printed for a programmer.
    let printed = format!("{:#?}", Parts::default());
    let mut asked = 0;
    for line in printed.lines() {
        let Some((name, value)) = line.trim().split_once(": ") else {
            continue;
        };
        let table = value.ends_with('{');
        let key = |line: &str| match table {
            true => line.starts_with(&format!("[parts.{name}]")),
            false => line.starts_with(&format!("{name} = ")),
        };
        assert!(block.lines().any(key), "docs/build.md has no {name}");
        asked += 1;
    }
    assert!(asked > 30, "{asked} keys of {printed}");
}
