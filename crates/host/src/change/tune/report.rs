//! The result of `lizard tune` as text.

use std::io::{self, Write};

use lizard_tune::{Comparison, SPREAD_TEXT};

/// Prints the comparison as a part of a robot.toml: everything except the gait's table is a comment.
///
/// # Errors
/// Fails if writing fails.
pub fn print(comparison: &Comparison, out: &mut impl Write) -> io::Result<()> {
    let Comparison {
        unit,
        robot_count,
        faster_count,
        ..
    } = comparison;
    let (gait, tuned) = (&comparison.gait.name, &comparison.tuned.name);
    writeln!(
        out,
        "# {unit} at servo speeds up to {:.1} deg/s; the last three columns: {robot_count} random robots and floors\n#",
        comparison.rate
    )?;
    let name_width = [gait, tuned]
        .map(|name| name.len())
        .into_iter()
        .fold(8, usize::max);
    writeln!(
        out,
        "# {:name_width$}  cycle, s   deg/s  least margin          ideal   SG-90     5 %    50 %    95 %",
        "gait"
    )?;
    for row in [&comparison.gait, &comparison.tuned] {
        let [low, median, high] = row.speeds;
        let (margin_name, margin) = row.margin;
        writeln!(
            out,
            "# {:name_width$}  {:8.2}  {:6.1}  {margin:.3} {margin_name:10}  {:9.1}  {:6.1}  {low:6.1}  {median:6.1}  {high:6.1}",
            row.name, row.period, row.rate, row.predicted, row.sg90
        )?;
    }
    writeln!(out, "#")?;
    if comparison.is_better() {
        writeln!(
            out,
            "# {tuned} is faster than {gait} on {faster_count} of {robot_count} robots; its 5 % quantile is {:.0} % higher.",
            100.0 * comparison.gain()
        )?;
    } else {
        writeln!(
            out,
            "# The search found no gait with a higher 5 % quantile than {gait}. The best one is\n\
             # faster on {faster_count} of {robot_count} robots:"
        )?;
    }
    writeln!(out, "# At random: {}.\n", SPREAD_TEXT.replace('\n', "\n# "))?;
    write!(out, "{}", comparison.fragment)
}
