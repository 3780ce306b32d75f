//! The result of `lizard tune` as text.

use std::fmt::Write as _;

use lizard_tune::{Comparison, SPREAD_TEXT};

/// Formats the comparison as a part of a robot.toml: everything except the gait's table is a comment.
pub fn format(comparison: &Comparison) -> String {
    let Comparison {
        unit,
        rate,
        robot_count,
        faster_count,
        ..
    } = comparison;
    let (gait, tuned) = (&comparison.gait.name, &comparison.tuned.name);
    let name_width = gait.len().max(tuned.len()).max(8);
    let mut text = format!(
        "# {unit} at servo speeds up to {rate:.1} deg/s; the last three columns: {robot_count} random robots and floors\n\
         #\n\
         # {:name_width$}  cycle, s   deg/s  least margin          ideal   SG-90     5 %    50 %    95 %\n",
        "gait"
    );
    for row in [&comparison.gait, &comparison.tuned] {
        let [low, median, high] = row.speeds;
        let (margin_name, margin) = row.margin;
        _ = writeln!(
            text,
            "# {:name_width$}  {:8.2}  {:6.1}  {margin:.3} {margin_name:10}  {:9.1}  {:6.1}  {low:6.1}  {median:6.1}  {high:6.1}",
            row.name, row.period, row.rate, row.predicted, row.sg90
        );
    }
    text += "#\n";
    if comparison.is_better() {
        let gain = comparison.gain();
        let gain = gain.map(|gain| format!("{:.0} % ", 100.0 * gain));
        _ = writeln!(
            text,
            "# {tuned} is faster than {gait} on {faster_count} of {robot_count} robots; its 5 % quantile is {}higher.",
            gain.unwrap_or_default()
        );
    } else {
        _ = writeln!(
            text,
            "# The search found no gait with a higher 5 % quantile than {gait}. The best one is\n\
             # faster on {faster_count} of {robot_count} robots:"
        );
    }
    _ = writeln!(
        text,
        "# At random: {}.\n",
        SPREAD_TEXT.replace('\n', "\n# ")
    );
    text + &comparison.fragment
}
