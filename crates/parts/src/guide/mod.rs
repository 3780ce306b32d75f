//! How the parts are put together, step by step, with pictures of the model.
//!
//! In this order a screwdriver can reach every screw, and the electronics are tried
//! before anything could jam.

pub(crate) mod corner;
pub(crate) mod html;
pub(crate) mod ink;
pub(crate) mod legend;
pub(crate) mod papers;
pub(crate) mod picture;
pub(crate) mod placements;

use std::fmt::Write;

use lizard_kinematics::Solution;

use crate::bill::Bill;
use crate::bodies::assembly::Assembly;
use crate::bodies::names::names;
use crate::files::File;
use crate::guide::html::html;
use crate::guide::ink::Label;
use crate::guide::picture::{Drawn, View, labelled, whole};
use crate::layers::body::{Body, Mount};
use crate::layers::roof::LAYER;
use crate::order::reach::Aside;
use crate::order::steps::{Near, Step, Where, steps};
use crate::part::Part;
use crate::unfit::Unfit;

/// How far new parts are lifted in the exploded pictures, mm.
const LIFT: f64 = 45.0;
/// Width of a picture without the names next to it, pixels.
const WIDE: f64 = 950.0;
/// The corner that is printed first, and seen from nearby: that of A1.
pub const CORNER: usize = 0;

/// What the guide says first.
const BEFORE: &str = "No printed robot has walked yet. So print in this order, and stop where something is not as it should be:\n\n\
1. the **coupon** (`lizard parts DIR --coupon`): the first column into which everything goes by hand is your printer's `fit`;\n\
2. one **corner** (`lizard parts DIR --corner`): a seat, a link, a leg, a strut and a foot, three hours. Put it together as in steps 1, 5 and 7 to 9;\n\
3. everything.\n\n\
Print all parts as they lie, in layers of 0.2 mm, **without supports**. A slicer may offer some under the two ends of a sleeve's \
roof: that is a bridge of 6.4 mm, which needs none.";

/// The guide as Markdown and HTML, with its pictures at a pose, as a rule neutral.
///
/// # Errors
/// [`Unfit::Blocked`] for a screw that cannot be reached.
pub fn guide(assembly: &Assembly, bill: &Bill, pose: &Solution) -> Result<Vec<File>, Unfit> {
    let steps = steps(assembly.robot().drive().strut().is_some());
    let asides = assembly.asides(&steps)?;
    let parts = assembly.parts();
    let mut files = Vec::new();
    let robot = labelled(
        assembly,
        &whole(assembly),
        pose,
        &View::default(),
        &legend::places(assembly, pose),
    );
    files.push(File::text("guide/robot.svg".to_owned(), robot));
    let mut text = format!(
        "# Building the robot\n\n![The robot](robot.svg)\n\n{BEFORE}\n\n{}\n",
        drilled(&parts)
    );
    let _ = writeln!(text, "## What is needed\n\n{bill}");
    let mut before: Vec<&Body> = Vec::new();
    for (number, step) in (1..).zip(&steps) {
        let new: Vec<&Body> = assembly
            .bodies()
            .iter()
            .filter(|body| step.adds(body) && !before.iter().any(|old| old.name == body.name))
            .collect();
        let _ = writeln!(text, "## {number}. {}\n\n{}\n", step.title, step.words);
        if new.is_empty() {
            continue;
        }
        let _ = writeln!(text, "Take {}.\n", legend::counted(&new, &parts).join("; "));
        let here = asides.iter().filter(|aside| aside.step == number);
        let at_bench = step.stages.iter().any(|stage| stage.at == Where::Bench);
        let turns: Vec<_> = here
            .map(|aside| turned(assembly, aside, at_bench))
            .collect();
        if !turns.is_empty() {
            let _ = writeln!(
                text,
                "As drawn there is no way to some screws. Seen from above, turn {}.\n",
                turns.join("; ")
            );
        }
        let scene = Scene {
            assembly,
            parts: &parts,
            pose,
            step,
            before: &before,
            new: &new,
        };
        for (kind, words, drawing) in scene.pictures() {
            let name = format!("step-{number}-{kind}.svg");
            let _ = writeln!(text, "![{}, {words}]({name})", step.title);
            files.push(File::text(format!("guide/{name}"), drawing));
        }
        text.push('\n');
        before.extend(new);
    }
    files.push(File::text("guide/guide.html".to_owned(), html(&text)));
    files.push(File::text("guide/guide.md".to_owned(), text));
    Ok(files)
}

/// What has to be drilled.
fn drilled(parts: &[Part]) -> String {
    let some = parts.iter().filter(|part| part.printed().1 > 0);
    let list: Vec<_> = some
        .map(|part| {
            let (_, count) = part.printed();
            let holes = if count == 1 { "a hole" } else { "holes" };
            match count {
                1 => format!("{holes} in each {}", part.name),
                _ => format!("{count} {holes} in each {}", part.name),
            }
        })
        .collect();
    format!(
        "Where a sunk pocket lies below in printing, the hole in its roof is closed by one layer of {LAYER} mm; open it with a drill of 3 mm, \
         or a screw: {}. Parts that are alike but for left and right have the numbers of their servos engraved: 13 is for A1 and A3.",
        list.join(", ")
    )
}

/// A step and what was there before.
struct Scene<'a> {
    assembly: &'a Assembly,
    parts: &'a [Part],
    pose: &'a Solution,
    step: &'a Step,
    before: &'a [&'a Body],
    new: &'a [&'a Body],
}

impl Scene<'_> {
    /// Its pictures: what they are, in a word and in words.
    fn pictures(&self) -> Vec<(&'static str, &'static str, String)> {
        let view = View {
            width: WIDE,
            ..View::default()
        };
        let below = View {
            below: true,
            azimuth: 300.0,
            ..view
        };
        let corner = View {
            near: true,
            azimuth: 150.0,
            elevation: 30.0,
            ..view
        };
        let corner_below = View {
            below: true,
            azimuth: 30.0,
            ..corner
        };
        let all = |_: &Body| true;
        let mut pictures = vec![("exploded", "apart", self.picture(&view, LIFT, true, all))];
        match self.step.near {
            Near::None => {}
            Near::Corner => {
                let drawing = self.picture(&corner, 0.6 * LIFT, true, at_corner);
                pictures.push(("near", "the front left corner", drawing));
            }
            Near::CornerBelow => {
                let drawing = self.picture(&corner_below, 0.5 * LIFT, true, at_corner);
                pictures.push(("below", "the front left corner from below", drawing));
            }
            Near::Below => {
                let drawing = self.picture(&below, 0.0, true, all);
                pictures.push(("below", "from below", drawing));
            }
        }
        pictures.push(("done", "done", self.picture(&view, 0.0, false, all)));
        pictures
    }

    fn picture(&self, view: &View, lift: f64, named: bool, which: fn(&Body) -> bool) -> String {
        let old = self.before.iter().map(|&body| Drawn {
            body,
            lift: 0.0,
            pale: true,
        });
        let new = self.new.iter().map(|&body| Drawn {
            body,
            lift: lift * (self.step.lift)(body),
            pale: !which(body),
        });
        let drawn: Vec<_> = old.chain(new).collect();
        let mut labels: Vec<Label> = legend::places(self.assembly, self.pose);
        if named {
            labels.extend(legend::names(self.assembly, self.parts, &drawn, self.pose));
        }
        labelled(self.assembly, &drawn, self.pose, view, &labels)
    }
}

/// Whether a body belongs to the corner that is seen from nearby.
fn at_corner(body: &Body) -> bool {
    let (name, leg) = names(CORNER);
    match body.mount {
        Mount::Chassis | Mount::Sleeve(_) | Mount::Rod(_) => {
            body.name.split(' ').any(|word| word == name || word == leg)
        }
        mount => mount.servos() == [CORNER],
    }
}

/// What has to be turned out of the way.
fn turned(assembly: &Assembly, aside: &Aside, at_bench: bool) -> String {
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
            let (name, leg) = names(servo);
            let what = match at_bench {
                true => format!("crank and follower {leg}"),
                false => format!("link {name} with its leg"),
            };
            format!("{what} by {:.0} deg {way}", by.abs())
        })
        .collect();
    format!("{} for {}", turns.join(" and "), aside.screws.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_body_is_put_on_in_exactly_one_step() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/paper.toml");
        let text = std::fs::read_to_string(path).expect("paper");
        for (word, slotted) in [("strut", true), ("rigid", false)] {
            let text = format!("{text}\n[leg.drive]\nkind = \"{word}\"");
            let robot = lizard_robot::Robot::parse(&text).expect("paper");
            let steps = steps(slotted);
            for body in Assembly::new(&robot).bodies() {
                let count = steps.iter().filter(|step| step.adds(body)).count();
                assert_eq!(count, 1, "{}", body.name);
            }
        }
    }
}
