//! How the parts are put together, step by step, with pictures of the model.
//!
//! The order is that in which a screwdriver still reaches every screw.

use std::fmt::Write;

use lizard_kinematics::Solution;

use crate::assembly::Assembly;
use crate::bill::Bill;
use crate::body::{Body, Kind, Mount};
use crate::files::File;
use crate::picture::{Drawn, View, picture, whole};

/// How far new parts are lifted in the exploded pictures, mm.
const LIFT: f64 = 45.0;

/// One step.
struct Step {
    title: &'static str,
    words: &'static str,
    /// Whether a body is added in it.
    adds: fn(&Body) -> bool,
    /// How far a body is lifted, in parts of `LIFT`.
    lift: fn(&Body) -> f64,
}

fn named(body: &Body, starts: &[&str]) -> bool {
    starts.iter().any(|start| body.name.starts_with(start))
}

const STEPS: [Step; 8] = [
    Step {
        title: "Servos and standoffs",
        words: "Push each servo from above into its opening, its shaft towards the end of the robot, and fix it with its two \
                self-tapping screws. Screw the four standoffs on from below. Leave the horns off.",
        adds: |body| {
            body.name == "plate"
                || matches!(
                    body.kind,
                    Kind::Servo | Kind::ServoScrew | Kind::Standoff(_)
                )
                || (body.name.starts_with("screw standoff") && body.name.ends_with("below"))
        },
        lift: |body| match body.kind {
            Kind::Printed | Kind::Screw(_) => 0.0,
            Kind::ServoScrew => 1.6,
            _ => 1.0,
        },
    },
    Step {
        title: "Legs, on the bench",
        words: "For each leg: press a lock nut into the pocket under the crank's short arm. Screw the foot under the leg's coupler, heads \
                sunk into the coupler, nuts under the leaf. Put a screw from below through each end of the coupler; crank and \
                follower go over them, with nuts on top. Tighten joints until they have no play and still turn by their own weight. \
                Mind left and right: cranks LF and RH are alike, and RF and LH.",
        adds: |body| {
            (matches!(body.mount, Mount::Foot(_))
                || named(
                    body,
                    &[
                        "crank",
                        "follower",
                        "screw crank joint",
                        "screw follower joint",
                        "nut crank joint",
                        "nut follower joint",
                        "nut leg anchor",
                    ],
                ))
                && !body.name.contains("pivot")
        },
        lift: |body| match body.mount {
            Mount::Foot(_) => -0.5,
            _ if body.name.starts_with("nut") && !body.name.contains("anchor") => 0.5,
            _ => 0.0,
        },
    },
    Step {
        title: "Legs on the plate",
        words: "Set both bearings of each leg on the plate and put the long screws through from above, nuts below. The crank is on \
                the pivot next to its servo.",
        adds: |body| body.name.contains("pivot"),
        lift: |body| {
            if body.name.starts_with("nut") {
                -0.7
            } else {
                1.0
            }
        },
    },
    Step {
        title: "Struts and springs",
        words: "Lay each strut, recess up, with its slot over the crank's short arm. Hang one hook of the spring over the slot, put the \
                screw through hook, strut and crank and turn it into the sunk nut until the strut just moves freely.",
        adds: |body| {
            matches!(body.mount, Mount::Strut(_)) || body.name.starts_with("screw leg anchor")
        },
        lift: |body| {
            if body.name.starts_with("screw") {
                1.4
            } else {
                0.7
            }
        },
    },
    Step {
        title: "Links and horns",
        words: "Cut each horn to one arm and lay it into its link's pocket, fix it with two small screws from above. Put the screws of crank and arm \
                through the link from below: later there is no way to them. Run `center` on the robot so that all \
                servos stand in their middle, then press each link on at its neutral angle (`lizard draw --horns` shows it) and \
                fix it with the horn's own screw. Pull the spring's free hook under the link's third hole, lay the ring on it, and put the anchor's \
                screw from above through link, ring, hook and strut; the nut goes under the strut.",
        adds: |body| {
            matches!(body.kind, Kind::Horn)
                || named(
                    body,
                    &[
                        "link",
                        "strut spacer",
                        "screw anchor",
                        "nut anchor",
                        "screw tip",
                        "screw arm",
                    ],
                )
        },
        lift: |body| match body.kind {
            Kind::Horn => 1.3,
            Kind::Printed if body.name.starts_with("link") => 0.8,
            Kind::Screw(_) if body.name.starts_with("screw anchor") => 1.6,
            Kind::Nut => 0.0,
            Kind::Printed => 0.4,
            _ => 0.3,
        },
    },
    Step {
        title: "Sliders",
        words: "Push each rod into its sleeve. The sleeve goes on the rear arm, the rod with a ring under it on the front arm; nuts on top. The \
                rods are outside.",
        adds: |body| {
            matches!(body.mount, Mount::Sleeve(_) | Mount::Rod(_))
                || named(body, &["arm spacer", "nut arm"])
        },
        lift: |body| match body.kind {
            Kind::Nut => 1.4,
            Kind::Printed if body.name.starts_with("arm") => 0.3,
            _ => 0.8,
        },
    },
    Step {
        title: "Head and tail",
        words: "At each end the left coupler goes directly on its link, the right one on a ring. Nuts on top; a screw from below joins \
                both at the point.",
        adds: |body| {
            matches!(body.mount, Mount::Coupler(_)) || named(body, &["tip spacer", "nut tip"])
        },
        lift: |body| match body.kind {
            Kind::Nut => 1.6,
            Kind::Screw(_) => 0.4,
            Kind::Printed if body.name.starts_with("tip") => 0.3,
            _ => 0.9,
        },
    },
    Step {
        title: "Battery, deck and board",
        words: "Strap the battery to the plate through its window. The deck goes on the standoffs, screws from above; the UNO on its \
                bosses, USB to the tail, with screws that cut their own thread. Wire it as `lizard draw --wiring` shows, and \
                keep the wires clear of the links.",
        adds: |body| {
            named(body, &["battery", "deck", "board", "screw board"])
                || (body.name.starts_with("screw standoff") && body.name.ends_with("above"))
        },
        lift: |body| match body.kind {
            Kind::Battery => 0.0,
            Kind::Board => 1.3,
            Kind::Screw(_) if body.name.contains("board") => 1.8,
            Kind::Screw(_) => 1.1,
            _ => 0.8,
        },
    },
];

/// The guide as Markdown and HTML, with its pictures, and the bill as JSON.
#[must_use]
pub fn guide(assembly: &Assembly, bill: &Bill, pose: &Solution) -> Vec<File> {
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
    for (number, step) in STEPS.iter().enumerate() {
        let number = number + 1;
        let new: Vec<&Body> = assembly
            .bodies()
            .iter()
            .filter(|body| (step.adds)(body) && !before.iter().any(|old| old.name == body.name))
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
        let _ = writeln!(
            text,
            "![{title}, apart](step-{number}-exploded.svg)\n![{title}, done](step-{number}-done.svg)\n",
            title = step.title
        );
        before.extend(new);
    }
    files.push(File::text("guide/guide.html".to_owned(), html(&text)));
    files.push(File::text("guide/guide.md".to_owned(), text));
    files
}

/// The screws and nuts of a step, by length.
fn screws(new: &[&Body]) -> String {
    let mut counts: std::collections::BTreeMap<String, usize> = Default::default();
    for body in new {
        let what = match body.kind {
            Kind::Screw(length) => format!("M3 x {length:02}"),
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
        let robot = lizard_robot::Robot::load(path).expect("paper");
        let assembly = Assembly::new(&robot);
        for body in assembly.bodies() {
            let steps = STEPS.iter().filter(|step| (step.adds)(body)).count();
            assert_eq!(steps, 1, "{}", body.name);
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
