//! Tests that the pages about parts agree with the code: values, shopping list, steps.

use lizard_parts::{build_steps, format_buying_table, format_mounting_table};
use lizard_robot::{Parts, Robot};

use crate::{build_assembly, compute_bill};

fn read_file(path: &str) -> String {
    let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Reads the TOML block of docs/build.md that lists all keys.
fn read_keys_block() -> String {
    let page = read_file("docs/build.md");
    let blocks = page.split("```toml\n").skip(1);
    let mut blocks = blocks.filter_map(|rest| rest.split("```").next());
    let block = blocks.find(|block| block.contains("[parts.servo]"));
    block.expect("a block contains [parts.servo]").to_owned()
}

#[test]
fn the_build_page_has_the_default_values() {
    let paper = read_file("robots/paper.toml");
    let robot = Robot::parse(&format!("{paper}\n{}", read_keys_block()))
        .expect("the keys in docs/build.md are valid");
    let paper = Robot::parse(&paper).expect("robots/paper.toml is valid");
    // The optional key for the foot's position has the value that follows from the hips.
    let mut parts = *robot.parts();
    assert!(parts.foot.take().is_some());
    assert_eq!(parts, Parts::default());
    assert_eq!(robot.ground(), paper.ground());
    assert_eq!(robot.legs(), paper.legs());
}

#[test]
fn the_build_page_has_every_key() {
    let block = read_keys_block();
    // The debug output contains the names of all fields. The spring's names are longer than its keys.
    let debug_text = format!("{:#?}", Parts::default());
    let mut checked_count = 0;
    for line in debug_text.lines() {
        let Some((name, value)) = line.trim().split_once(": ") else {
            continue;
        };
        let name = match name {
            "wire_diameter" => "wire",
            "outer_diameter" => "outer",
            "free_length" => "length",
            _ => name,
        };
        let is_table = value.ends_with('{');
        let is_key_line = |line: &str| match is_table {
            true => line.starts_with(&format!("[parts.{name}]")),
            false => line.starts_with(&format!("{name} = ")),
        };
        let is_present = block.lines().any(is_key_line);
        assert!(is_present, "{name} is missing in docs/build.md");
        checked_count += 1;
    }
    assert!(checked_count > 30, "{checked_count} keys of {debug_text}");
}

/// Compares a page's text between a start mark and the end mark with `expected`. If BLESS_DOCS is set, writes
/// `expected` into the page instead.
fn check_or_write_quote(path: &str, start: &str, expected: &str) {
    const END: &str = "<!-- end of the list -->";
    let page = read_file(path);
    let (text_before, rest) = page.split_once(start).expect(start);
    let (list, text_after) = rest.split_once(END).expect("the list ends");
    if std::env::var_os("BLESS_DOCS").is_some() {
        let file = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
        let text = format!("{text_before}{start}{expected}{END}{text_after}");
        std::fs::write(file, text).expect(path);
        return;
    }
    assert_eq!(list, expected, "{path}: run with BLESS_DOCS=1");
}

#[test]
fn the_pages_quote_the_lists_of_the_bill() {
    let assembly = build_assembly("paper", "[leg.drive]\nkind = \"rigid\"");
    let bill = compute_bill(&assembly);
    let (table, prices) = (format_buying_table(&bill.bought), bill.format_prices());
    let buying_list = format!("{table}\n{prices}\n");
    let radio_list = format_buying_table(&bill.radio);
    let places = format_mounting_table(assembly.robot().parts().battery);
    for (page, mark, list) in [
        ("quickstart", "the list of `lizard parts`", &buying_list),
        ("quickstart", "the list for a radio", &radio_list),
        ("build", "the places on the robot", &places),
    ] {
        let start = format!("<!-- {mark}; checked by a test -->\n");
        check_or_write_quote(&format!("docs/{page}.md"), &start, list);
        // The guide also contains the list.
        assert!(bill.to_string().contains(list), "{mark}");
    }
    for word in ["strap", "wire", "switch", "fuse", "strip", "plug"] {
        assert!(buying_list.contains(word), "{word}");
    }
    let limits = read_file("docs/limits.md");
    let mut rows = limits.lines().map(|line| line.split_whitespace());
    let row = rows.find(|row| row.clone().take(2).eq(["digital", "servos"]));
    // The first column after the range is the loss of `walk`.
    let loss = row.and_then(|mut row| row.find_map(|word| word.strip_prefix('-')));
    let sentence = format!("digital servos lose {} % of `walk`", loss.expect("a loss"));
    for text in [bill.to_string(), read_file("docs/quickstart.md")] {
        assert!(text.contains(&sentence), "{sentence}");
    }
}

#[test]
fn the_converter_is_set_after_the_wires_are_checked_and_before_the_servos_get_power() {
    let steps = build_steps(false);
    let [board_step, flash_step] = [2, 3].map(|index| &steps[index].instructions);
    let (_, text_after_check) = board_step.split_once("no contact").expect(board_step);
    assert!(text_after_check.contains("set the converter to 5.0 V"));
    assert!(flash_step.contains("switch on the servos' supply"));
}

#[test]
fn the_steps_name_no_mark_that_only_robots_with_equal_parts_have() {
    for step in build_steps(false) {
        let has_mark = step.instructions.contains("marked 1");
        assert!(!has_mark, "{}", step.title);
    }
}

#[test]
fn the_pages_have_the_mass_of_robot_toml() {
    let mass = build_assembly("paper", "").robot().ground().body.mass;
    let mass_sentence = format!("The parts weigh {mass:.0} g.");
    let page = read_file("docs/twin.md");
    let has_mass = page.contains(&mass_sentence);
    assert!(has_mass, "docs/twin.md: {mass_sentence}");
    assert!(page.contains(&format!("| mass | {mass:.0} g,")));
    let mass_line = format!("\nmass = {mass:.1} ");
    for path in ["robot.toml", "robots/paper.toml", "robots/own-gaits.toml"] {
        assert!(read_file(path).contains(&mass_line), "{path}: {mass_line}");
    }
}

#[test]
fn the_quickstart_lists_the_steps_of_the_guide_in_order() {
    let page = read_file("docs/quickstart.md");
    let lines = page.lines().filter_map(|line| line.strip_prefix("Guide: "));
    let entries = lines.flat_map(|line| line.trim_end_matches('.').split("; "));
    let entries: Vec<_> = entries.map(str::to_owned).collect();
    let numbered_steps = (1..).zip(build_steps(false));
    let expected = numbered_steps.map(|(number, step)| format!("step {number}, {}", step.title));
    assert_eq!(entries, expected.collect::<Vec<_>>());
}
