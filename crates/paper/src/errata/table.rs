//! The table of all equations as text and as Markdown.

use std::fmt::Write as _;

use super::equation_result::EquationResult;

/// Formats the table of all equations as lines for a terminal.
pub fn format_text(results: &[EquationResult], sample_count: u32) -> String {
    let holding_count = results.iter().filter(|result| result.holds).count();
    let mut text = format!(
        "{} printed equations at {sample_count} random poses: {holding_count} hold, {} do not.\n",
        results.len(),
        results.len() - holding_count
    );
    for result in results {
        let mark = if result.holds { "holds" } else { "FAILS" };
        let (location, printed) = (result.location, result.printed_form);
        text += &format!("\n{mark}  {location}\n       printed    {printed}\n");
        if !result.holds || result.special_case.is_some() {
            let _ = writeln!(text, "       worst      {}", result.format_error());
        }
        match result.holds_clockwise {
            Some(true) => text += "       clockwise  holds\n",
            Some(false) => text += "       clockwise  fails\n",
            None => {}
        }
        if let (Some(form), Some(holds)) = (result.corrected_form, result.corrected_holds) {
            let verdict = if holds { "holds" } else { "fails" };
            let _ = writeln!(text, "       corrected  {form}: {verdict}");
        }
    }
    text
}

/// Formats the text of docs/errata.md.
pub fn format_markdown(results: &[EquationResult], sample_count: u32) -> String {
    let holding_count = results.iter().filter(|result| result.holds).count();
    let mut text = format!(
        "# Errata of the paper, measured

This page is the output of `lizard errata --markdown`; a test fails if it is out of date.
Only the equations are written by hand; all results are computed.

Each printed equation of *Optimal Kinematic Design of a Robotic Lizard using
Four-Bar and Five-Bar Mechanisms* was evaluated at {sample_count} random poses (theta1 and
-theta5 in 90 to 180, theta4 and -theta8 in 0 to 90 degrees, the paper's lengths)
and compared with the geometric solution, whose loops close to within 1e-9 mm. Angles
are counter-clockwise from +x in the chassis frame throughout. \"Clockwise\" is a
second convention, in which the angles of the right-hand links are measured clockwise
from -x, as the drawings suggest. Under this convention several signs are right, but the
loop equations and the theta3 formula, which the paper combines with these signs, do not
hold. An error below 1e-6, in the unit of the equation, counts as rounding.

**{holding_count} of {} equations hold as printed.** Every corrected form below was measured
at the same poses and holds, unless \"(fails too)\" follows it.

| place | printed | verdict | largest error | corrected |
|---|---|---|---|---|
",
        results.len()
    );
    let escape_cell = |text: &str| text.replace('|', "\\|");
    for result in results {
        let corrected = match (result.corrected_form, result.corrected_holds) {
            (Some(form), Some(true)) => escape_cell(form),
            (Some(form), _) => format!("{} (fails too)", escape_cell(form)),
            _ => "-".to_string(),
        };
        let [location, printed] = [result.location, result.printed_form].map(escape_cell);
        let (verdict, error) = (result.verdict(), escape_cell(&result.format_error()));
        text += &format!("| {location} | {printed} | {verdict} | {error} | {corrected} |\n");
    }
    text
}
