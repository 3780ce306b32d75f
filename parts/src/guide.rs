//! How the parts are put together, step by step, with pictures of the model.
//!
//! The order is that in which a screwdriver still reaches every screw.

use std::fmt::Write;

use lizard_kinematics::Solution;
use lizard_robot::Strut;

use crate::assembly::Assembly;
use crate::bill::Bill;
use crate::body::{Body, Kind};
use crate::files::File;
use crate::names::names;
use crate::picture::{Drawn, View, picture, whole};
use crate::reach::Aside;
use crate::steps::steps;
use crate::unfit::Unfit;

/// How far new parts are lifted in the exploded pictures, mm.
const LIFT: f64 = 45.0;

/// The guide as Markdown and HTML, with its pictures at a pose, as a rule neutral.
///
/// # Errors
/// [`Unfit::Blocked`] for a screw that cannot be reached.
pub fn guide(assembly: &Assembly, bill: &Bill, pose: &Solution) -> Result<Vec<File>, Unfit> {
    let steps = steps(assembly.robot().parts().strut == Strut::Spring);
    let asides = assembly.asides(&steps)?;
    let mut files = Vec::new();
    let view = View::default();
    let robot = picture(assembly, &whole(assembly), pose, &view);
    files.push(File::text("guide/robot.svg".to_owned(), robot));
    let mut text = String::from(
        "# Building the robot\n\n![The robot](robot.svg)\n\nNothing here was tried on a real printer yet: print the coupon first, and one leg \
         before all four.\n\n## What is needed\n\n",
    );
    let _ = writeln!(text, "{bill}");
    let mut before: Vec<&Body> = Vec::new();
    for (number, step) in steps.iter().enumerate() {
        let number = number + 1;
        let new: Vec<&Body> = assembly
            .bodies()
            .iter()
            .filter(|body| step.adds(body) && !before.iter().any(|old| old.name == body.name))
            .collect();
        for (kind, lift) in [("exploded", LIFT), ("done", 0.0)] {
            let mut drawn: Vec<Drawn> = before
                .iter()
                .map(|&body| Drawn {
                    body,
                    lift: 0.0,
                    pale: true,
                })
                .collect();
            drawn.extend(new.iter().map(|&body| Drawn {
                body,
                lift: lift * (step.lift)(body),
                pale: false,
            }));
            let name = format!("guide/step-{number}-{kind}.svg");
            let drawing = picture(
                assembly,
                &drawn,
                pose,
                &View {
                    width: 700.0,
                    ..view
                },
            );
            files.push(File::text(name, drawing));
        }
        let _ = writeln!(text, "## {number}. {}\n\n{}\n", step.title, step.words);
        let _ = writeln!(text, "Screws: {}.\n", screws(&new));
        let here = asides.iter().filter(|aside| aside.step == number);
        let turns: Vec<_> = here.map(|aside| turned(assembly, aside)).collect();
        if !turns.is_empty() {
            let _ = writeln!(
                text,
                "At neutral there is no way to some screws. Seen from above, turn {}.\n",
                turns.join("; ")
            );
        }
        let _ = writeln!(
            text,
            "![{title}, apart](step-{number}-exploded.svg)\n![{title}, done](step-{number}-done.svg)\n",
            title = step.title
        );
        before.extend(new);
    }
    files.push(File::text("guide/guide.html".to_owned(), html(&text)));
    files.push(File::text("guide/guide.md".to_owned(), text));
    Ok(files)
}

/// What has to be turned out of the way.
fn turned(assembly: &Assembly, aside: &Aside) -> String {
    let neutral: [f64; 4] = assembly.robot().neutral().into();
    let turns = (0..4).map(|servo| (servo, aside.pose[servo] - neutral[servo]));
    let turns: Vec<_> = turns
        .filter(|(_, by)| by.abs() > 0.5)
        .map(|(servo, by)| {
            let way = if by > 0.0 {
                "counter-clockwise"
            } else {
                "clockwise"
            };
            format!(
                "what {} drives by {:.0} deg {way}",
                names(servo).0,
                by.abs()
            )
        })
        .collect();
    format!("{} for {}", turns.join(" and "), aside.screws.join(", "))
}

/// The screws and nuts of a step, by length.
fn screws(new: &[&Body]) -> String {
    let mut counts: std::collections::BTreeMap<String, usize> = Default::default();
    for body in new {
        let what = match body.kind {
            Kind::Screw(length) => format!("M3 x {length:02}"),
            Kind::HexScrew(length) => format!("M3 x {length:02} with hexagon heads"),
            Kind::Nut => "lock nuts".to_owned(),
            Kind::ServoScrew => "servo screws".to_owned(),
            _ => continue,
        };
        *counts.entry(what).or_default() += 1;
    }
    let list: Vec<_> = counts
        .iter()
        .map(|(what, count)| format!("{count} {what}"))
        .collect();
    if list.is_empty() {
        "none".to_owned()
    } else {
        list.join(", ")
    }
}

/// The guide's Markdown as a page. It has headings, pictures, tables, code and paragraphs
/// and nothing else.
fn html(markdown: &str) -> String {
    let escape = |text: &str| {
        let text = text.replace('&', "&amp;").replace('<', "&lt;");
        // Code is between a pair of back quotes.
        let mut parts = text.split('`');
        let mut done = parts.next().unwrap_or_default().to_owned();
        while let (Some(code), Some(rest)) = (parts.next(), parts.next()) {
            let _ = write!(done, "<code>{code}</code>{rest}");
        }
        done
    };
    let mut page = String::from(
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>Building the robot</title>\n<style>body{font:16px/1.5 sans-serif;max-width:46rem;margin:2rem auto;padding:0 1rem}\
         img{max-width:100%}td,th{padding:.1rem .7rem;border-bottom:1px solid #ddd;text-align:left}\
         pre{background:#f4f4f4;padding:.6rem}</style>\n",
    );
    let (mut table, mut code) = (false, false);
    for line in markdown.lines() {
        if line.starts_with("```") {
            page.push_str(if code { "</pre>\n" } else { "<pre>" });
            code = !code;
        } else if code {
            let _ = writeln!(page, "{}", escape(line));
        } else if let Some(cells) = line.strip_prefix('|') {
            if cells.starts_with("---") {
                continue;
            }
            let cell = if table { "td" } else { "th" };
            if !table {
                page.push_str("<table>\n");
                table = true;
            }
            page.push_str("<tr>");
            for text in cells.trim_end_matches('|').split('|') {
                let _ = write!(page, "<{cell}>{}</{cell}>", escape(text.trim()));
            }
            page.push_str("</tr>\n");
        } else {
            if table {
                page.push_str("</table>\n");
                table = false;
            }
            if let Some(title) = line.strip_prefix("## ") {
                let _ = writeln!(page, "<h2>{}</h2>", escape(title));
            } else if let Some(title) = line.strip_prefix("# ") {
                let _ = writeln!(page, "<h1>{}</h1>", escape(title));
            } else if let Some((words, file)) = line
                .strip_prefix("![")
                .and_then(|rest| rest.strip_suffix(')'))
                .and_then(|rest| rest.split_once("]("))
            {
                let _ = writeln!(
                    page,
                    "<p><img src=\"{file}\" alt=\"{}\"></p>",
                    escape(words)
                );
            } else if !line.is_empty() {
                let _ = writeln!(page, "<p>{}</p>", escape(line));
            }
        }
    }
    page.push_str("</html>\n");
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_body_is_put_on_in_exactly_one_step() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/paper.toml");
        let text = std::fs::read_to_string(path).expect("paper");
        for strut in [Strut::Spring, Strut::Rigid] {
            let text = format!("{text}\n[parts]\nstrut = \"{}\"", strut.word());
            let robot = lizard_robot::Robot::parse(&text).expect("paper");
            let steps = steps(strut == Strut::Spring);
            for body in Assembly::new(&robot).bodies() {
                let count = steps.iter().filter(|step| step.adds(body)).count();
                assert_eq!(count, 1, "{}", body.name);
            }
        }
    }

    #[test]
    fn a_page_has_tables_code_and_pictures() {
        let page = html(
            "# A\n\n| a | b |\n|---|---|\n| 1 | x < y |\n\n![p](q.svg)\nrun `z`\n```toml\nk = 1\n```\n",
        );
        for part in [
            "<h1>A</h1>",
            "<tr><th>a</th><th>b</th></tr>",
            "<td>x &lt; y</td>",
            "</table>",
            "<img src=\"q.svg\" alt=\"p\">",
            "<p>run <code>z</code></p>",
            "<pre>k = 1\n</pre>",
        ] {
            assert!(page.contains(part), "{part} in {page}");
        }
    }
}
