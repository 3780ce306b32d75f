//! The summary of a recorded session, in a few lines.

use std::io::{self, Write};

use super::super::link::BANNER_START;
use super::super::recorder::Event;
use super::session::{FRAME_MS, RecordedSession};
use lizard_robot::Status;

/// Prints the session's length, commands, smallest margin, supply voltages and problems.
pub(super) fn print(session: &RecordedSession, out: &mut impl Write) -> io::Result<()> {
    let entries = &session.entries;
    let count_events = |is_counted: fn(&Event) -> bool| {
        let events = entries.iter().map(|entry| &entry.event);
        events.filter(|event| is_counted(event)).count()
    };
    if let Some(Event::Begin { port, banner, .. }) = entries.first().map(|entry| &entry.event) {
        writeln!(out, "board       {port}")?;
        let banner = banner
            .as_deref()
            .unwrap_or("unknown: the board was not reset");
        writeln!(out, "firmware    {}", banner.trim_start_matches("# "))?;
    }
    let seconds = session.end_ms() as f64 / 1000.0;
    let frame_count = session.end_ms() / FRAME_MS + 1;
    let pose_count = count_events(|event| matches!(event, Event::Pose { .. }));
    writeln!(
        out,
        "time        {seconds:.1} s, poses for {pose_count} of {frame_count} frames"
    )?;
    let refused_count =
        count_events(|event| matches!(event, Event::Answer(line) if line.starts_with("err")));
    let sent_count = count_events(|event| matches!(event, Event::Sent(_)));
    writeln!(out, "commands    {sent_count}, {refused_count} refused")?;

    let statuses: Vec<(u64, Status)> = entries
        .iter()
        .filter_map(|entry| match &entry.event {
            Event::Status(line) | Event::Answer(line) => Some((entry.ms, Status::parse(line)?)),
            _ => None,
        })
        .collect();
    let margins = statuses
        .iter()
        .filter_map(|(ms, status)| Some((ms, status.margin?)));
    if let Some((ms, margin)) = margins.min_by(|a, b| a.1.total_cmp(&b.1)) {
        let seconds = *ms as f64 / 1000.0;
        writeln!(
            out,
            "margin      smallest {margin:.3}, at {seconds:.1} s, of {} readings",
            statuses.len()
        )?;
    }
    let supply_volts = statuses.iter().filter_map(|(_, status)| status.vcc);
    print_voltage_range(out, "supply", supply_volts)?;
    let servo_volts = statuses.iter().filter_map(|(_, status)| status.rail);
    print_voltage_range(out, "servos", servo_volts)?;
    if let Some((_, last)) = statuses.last() {
        writeln!(
            out,
            "counters    late pulses {}, bytes lost {}",
            last.late_edges, last.lost_bytes
        )?;
    }
    let mut problem_count = 0;
    for entry in entries {
        let text = match &entry.event {
            Event::Note(line) if reports_problem(line) => line.trim_start_matches("# "),
            Event::Gone => "the port disappeared",
            _ => continue,
        };
        problem_count += 1;
        writeln!(
            out,
            "problem     at {:.1} s: {text}",
            entry.ms as f64 / 1000.0
        )?;
    }
    if problem_count == 0 {
        writeln!(out, "problem     none")?;
    }
    Ok(())
}

/// True if a note reports a problem. A banner during a session means that the board was reset.
fn reports_problem(note: &str) -> bool {
    ["# fault: ", "# supply: ", "# held ", BANNER_START]
        .iter()
        .any(|start| note.starts_with(start))
}

fn print_voltage_range(
    out: &mut impl Write,
    name: &str,
    volts: impl Iterator<Item = f64>,
) -> io::Result<()> {
    let range = volts.fold(None, |range: Option<(f64, f64)>, volts| {
        let (min, max) = range.unwrap_or((volts, volts));
        Some((min.min(volts), max.max(volts)))
    });
    match range {
        Some((min, max)) => writeln!(out, "{name:<12}{min:.2}..{max:.2} V"),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_shows_margin_supply_range_and_problems() {
        let status = |ms, margin| {
            format!(
                "{{\"ms\":{ms},\"status\":\"ok gait=walk pose=1,2,3,4 margin={margin} late=1 \
                 rx_lost=0 vcc=4.{ms}\"}}"
            )
        };
        let text = [
            "{\"ms\":0,\"begin\":{\"format\":\"lizard record 1\",\"port\":\"p\",\"banner\":\"# lizard 0.2.0\"}}".to_owned(),
            "{\"ms\":10,\"sent\":\"fly\"}".to_owned(),
            "{\"ms\":20,\"answer\":\"err 1 no\"}".to_owned(),
            status(500, 0.5),
            status(600, 0.25),
            status(700, 0.75),
            "{\"ms\":1500,\"note\":\"# fault: a pulse was late\"}".to_owned(),
            "{\"ms\":1600,\"note\":\"# boot: stand\"}".to_owned(),
            "{\"ms\":2000,\"gone\":null}".to_owned(),
        ]
        .join("\n");
        let session = RecordedSession::parse(&(text + "\n")).expect("the session is valid");
        let mut out = Vec::new();
        print(&session, &mut out).expect("writing to a vector succeeds");
        assert_eq!(
            String::from_utf8(out).expect("the output is UTF-8"),
            "board       p\n\
             firmware    lizard 0.2.0\n\
             time        2.0 s, poses for 0 of 101 frames\n\
             commands    1, 1 refused\n\
             margin      smallest 0.250, at 0.6 s, of 3 readings\n\
             supply      4.50..4.70 V\n\
             counters    late pulses 1, bytes lost 0\n\
             problem     at 1.5 s: fault: a pulse was late\n\
             problem     at 2.0 s: the port disappeared\n"
        );
    }
}
