//! docs/gaits.md shows what the commands print.

use lizard_robot::{Report, Sensitivity};

use crate::paper;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/gaits.md");
const END: &str = "<!-- end -->";

fn fenced(text: String) -> String {
    format!("```text\n{text}```\n")
}

/// The page with what stands between a marker and the next end replaced.
fn filled(page: &str, marker: &str, text: &str) -> String {
    let marker = format!("<!-- {marker} -->\n");
    let start = page.find(&marker).expect(&marker) + marker.len();
    let end = start + page[start..].find(END).expect(END);
    format!("{}{text}{}", &page[..start], &page[end..])
}

#[test]
fn the_page_on_gaits_shows_what_the_commands_print() {
    let page = std::fs::read_to_string(PAGE).expect(PAGE);
    let mut now = filled(
        &page,
        "lizard gaits",
        &fenced(Report::of(paper()).to_string()),
    );
    now = filled(
        &now,
        "lizard gaits --sensitivity",
        &fenced(Sensitivity::of(paper()).to_string()),
    );
    if std::env::var_os("BLESS_GAITS").is_some() {
        std::fs::write(PAGE, &now).expect(PAGE);
    } else if let Some((was, is)) = page.lines().zip(now.lines()).find(|(was, is)| was != is) {
        panic!("docs/gaits.md is out of date; run with BLESS_GAITS=1.\n  was {was}\n  is  {is}");
    } else {
        assert_eq!(
            page, now,
            "docs/gaits.md is out of date; run with BLESS_GAITS=1"
        );
    }
}
