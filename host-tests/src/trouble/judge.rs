//! Judge of a scenario: converts the record to events for the observer of the rules, and checks those rules itself
//! that need the whole record.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;
use lizard_host::patrol::PATROL;
use lizard_host::sim::lines::Line;
use lizard_robot::Robot;
use lizard_rules::{BrokenRule, Event, Limits, Observer, Pulse, Rule, Time, led};
use simulated_uno::{Pin, ResetCause, State};

use super::record::{Exchange, MS, Record, Span};
use super::scenario::Scenario;
use super::setup::WIDE_SCALE;

/// The pin of the LED.
const LED: Pin = Pin::d(13);

/// Cycles of a byte that the board sends on the serial line.
const BYTE_CYCLES: u64 = 1_360;

/// Returns the limits for a scenario's robot.
fn limits_of(robot: &Robot, scenario: &Scenario) -> Limits {
    let cycles_of_us = |us: f64| (us * 16.0).round() as u32;
    let pace = robot.speed_limits();
    let max_speed = pace.slew.max(pace.gait_slew);
    let mentions = |text: &str| {
        let mut steps = scenario.steps.iter();
        steps.any(|step| step.to_string().contains(text))
    };
    // If the scenario changes a servo's scale, the limit is that of the larger scale.
    let scale_text = if mentions("scale ") { WIDE_SCALE } else { "0" };
    let wide_scale: f64 = scale_text.parse().expect("a number");
    let servos = robot.servos().each_ref();
    Limits {
        // Allows a cycle of rounding at the start and at the end of a pulse, and half an angle step.
        max_leap_cycles: servos.map(|servo| {
            cycles_of_us(max_speed / 50.0 * servo.us_per_degree.abs().max(wide_scale)) + 4
        }),
        width_ranges: servos.map(|servo| {
            (
                cycles_of_us(servo.min_us) - 1,
                cycles_of_us(servo.max_us) + 1,
            )
        }),
        levels_mv: robot.supplies().board.map(|volts| (1_000.0 * volts) as u32),
        max_frame_remainder: 25 * lizard_rules::MS,
        max_report_time: 300 * lizard_rules::MS,
        max_queue_time: 150 * lizard_rules::MS,
        // A patrol rests for a second, or longer on a low supply.
        max_routine_rest: 125_000 * lizard_rules::MS / i64::from(robot.supplies().slow_pace),
        may_boot_to_rest: mentions("boot rest"),
        brown_outs_clear_ram: true,
        is_saved_travel_narrower: mentions("say limit ") && mentions("say factory"),
        ..Limits::default()
    }
}

/// Judges a record. Returns each broken rule once.
#[must_use]
pub fn broken_rules(record: &Record, robot: &Robot, scenario: &Scenario) -> Vec<BrokenRule> {
    let mut observer = Observer::new(limits_of(robot, scenario));
    let mut all_broken: Vec<BrokenRule> = Vec::new();
    for (time, event) in events(record) {
        observer.observe(time, event);
        for mut broken in observer.take_broken_rules() {
            broken.observation += &format!(", at {:.3} ms", time as f64 / MS as f64);
            all_broken.push(broken);
        }
    }
    let checks: [(Rule, Result<(), String>); 7] = [
        (Rule::KeepsRunning, check_alive(record)),
        (Rule::StandWorks, check_stand(record)),
        (Rule::RefusalChangesNothing, check_refusals(record)),
        (Rule::LedShowsFault, check_led(record)),
        (Rule::PulsePeriod, check_pulse_times(record)),
        (Rule::OnlySentLines, check_orders_were_sent(record)),
        (Rule::StopRepeated, check_stop_is_answered(record)),
    ];
    for (rule, result) in checks {
        all_broken.extend(result.err().map(|seen| BrokenRule::new(rule, seen)));
    }
    all_broken.sort_by_key(|broken| broken.rule);
    all_broken.dedup_by_key(|broken| broken.rule);
    all_broken
}

const fn cause_of(cause: ResetCause) -> Cause {
    match cause {
        ResetCause::PowerOn => Cause::Power,
        ResetCause::External => Cause::External,
        ResetCause::BrownOut => Cause::BrownOut,
        ResetCause::Watchdog => Cause::Watchdog,
    }
}

/// Returns every event of a record, in order of time.
#[must_use]
pub fn events(record: &Record) -> Vec<(Time, Event<'_>)> {
    let time_of = |cycle: u64| cycle as Time;
    let mut events: Vec<(Time, Event<'_>)> = Vec::new();
    let mut add = |cycle: u64, event| events.push((time_of(cycle), event));
    for (cycle, mv) in &record.supply {
        add(*cycle, Event::SupplyMv(*mv as u32));
    }
    for cut in &record.cuts {
        add(*cut, Event::ProgramCut);
    }
    for stall in &record.stalls {
        add(stall.start, Event::MainStalled(time_of(stall.end)));
    }
    for hold in &record.holds {
        add(hold.start, Event::InterruptsBlocked(time_of(hold.end)));
    }
    for start in &record.starts {
        add(start.cycle, Event::ProgramStart(cause_of(start.cause)));
    }
    for cycle in &record.bytes {
        add(*cycle, Event::ByteReceived);
    }
    for received in record
        .received
        .iter()
        .filter(|received| !received.text.is_empty())
    {
        let is_command = received.is_command;
        add(received.cycle, Event::LineReceived { is_command });
        let is_saved = received.text == "save" && record.is_saved(received.cycle);
        if is_saved || received.text == "save" || received.effect == Effect::Calibrates {
            add(received.cycle, Event::CalibrationChanged { is_saved });
        }
    }
    for (received, done) in record.orders() {
        let effect = received.effect;
        add(
            received.cycle,
            Event::Order {
                effect,
                is_accepted: done,
            },
        );
    }
    for line in &record.lines {
        let length_cycles = BYTE_CYCLES * line.text.len() as u64;
        let start = time_of(line.cycle.saturating_sub(length_cycles));
        add(line.cycle, Event::LinePrinted(start, &line.text));
    }
    for exchange in &record.exchanges {
        let (asked, line) = (time_of(exchange.asked), exchange.line.as_str());
        let effect = exchange.effect;
        events.push(match &exchange.answer {
            Some(Line { cycle, text, .. }) => (
                time_of(*cycle),
                Event::Answer {
                    line,
                    effect,
                    asked_at: asked,
                    answer: text,
                },
            ),
            None => (asked + time_of(400 * MS), Event::Unanswered(asked, line)),
        });
    }
    for (cycle, pulse) in &record.pulses {
        events.push((time_of(*cycle), Event::Pulse(*pulse)));
    }
    for write in &record.written {
        events.push((time_of(write.cycle), Event::ByteWritten));
    }
    // The time limits of some rules end at a time at which nothing else is observed.
    let pass_cycles = (0..record.end).step_by(100 * MS as usize);
    events.extend(pass_cycles.map(|cycle| (time_of(cycle), Event::TimePasses)));
    events.push((time_of(record.end), Event::TimePasses));
    events.sort_by_key(|(time, _)| *time);
    events
}

/// Checks that the firmware has neither crashed nor halted.
fn check_alive(record: &Record) -> Result<(), String> {
    match &record.state {
        Some(State::Alive) => Ok(()),
        state => Err(format!("{state:?}")),
    }
}

/// Checks that the last `stand` of the scenario, long after all trouble, is carried out and that the servos then get
/// constant pulses.
fn check_stand(record: &Record) -> Result<(), String> {
    let mut exchanges = record.exchanges.iter().rev();
    let last_status = exchanges.next().ok_or("nothing was asked")?;
    let stand_exchange = exchanges
        .find(|exchange| exchange.line == "stand")
        .ok_or("no stand")?;
    if !stand_exchange.is_done() {
        return Err(format!("stand is answered by {:?}", stand_exchange.answer));
    }
    if last_status.status("gait") != Some("stand") || last_status.status("fault") != Some("none") {
        return Err(format!("after stand: {:?}", last_status.answer));
    }
    let late_start = record.end - 110 * MS;
    for servo in 0..4 {
        let is_late = |(cycle, pulse): &&(u64, Pulse)| pulse.servo == servo && *cycle > late_start;
        let late_pulses = record.pulses.iter().filter(is_late);
        let widths: Vec<u32> = late_pulses.map(|(_, pulse)| pulse.width).collect();
        let is_steady = widths.windows(2).all(|pair| pair[0] == pair[1]);
        if widths.len() < 4 || !is_steady {
            return Err(format!("A{} gets {widths:?} at last", servo + 1));
        }
    }
    Ok(())
}

/// Checks that `status` is the same before and after a refused command, unless the robot stopped by `deadman` or at
/// the end of a counted motion, performs a routine, or was reset or disturbed between the two.
fn check_refusals(record: &Record) -> Result<(), String> {
    for exchanges in record.exchanges.windows(3) {
        let [status_before, refused_command, status_after] = exchanges else {
            continue;
        };
        let answer = refused_command.answer.as_ref();
        let is_refused = answer.is_some_and(|line| line.text.starts_with("err"));
        let (Some(answer_before), Some(answer_after)) =
            (&status_before.answer, &status_after.answer)
        else {
            continue;
        };
        let have_status =
            status_before.status("gait").is_some() && status_after.status("gait").is_some();
        let span = answer_before.cycle..answer_after.cycle;
        let has_ended_by_itself = record.lines.iter().any(|line| {
            let is_end = line.text == "# done" || line.text.contains("as long as deadman says");
            is_end && span.contains(&line.cycle)
        });
        // A routine continues by itself, for example from a motion to a rest.
        let is_routine = status_before.status("gait") == Some(PATROL)
            || status_after.status("gait") == Some(PATROL);
        let is_troubled = has_ended_by_itself
            || is_routine
            || record.is_troubled(answer_before.cycle, answer_after.cycle);
        if !is_refused || !have_status || is_troubled {
            continue;
        }
        for key in ["gait", "speed", "guard", "fault", "reset", "resets"] {
            if status_before.status(key) != status_after.status(key) {
                let line = &refused_command.line;
                return Err(format!(
                    "{line}: {} and then {}",
                    answer_before.text, answer_after.text
                ));
            }
        }
    }
    Ok(())
}

/// Checks that each servo's pulses are exactly a frame apart, unless a reset or blocked interrupts came between them.
fn check_pulse_times(record: &Record) -> Result<(), String> {
    const FRAME: u64 = 20 * MS;
    for servo in 0..4 {
        let pulses = record
            .pulses
            .iter()
            .filter(|(_, pulse)| pulse.servo == servo);
        let start_cycles: Vec<u64> = pulses.map(|(cycle, _)| *cycle).collect();
        for pair in start_cycles.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            // A longer distance is a missing frame, which another rule judges.
            let is_next = to - from < FRAME + FRAME / 2;
            let is_held = record.holds.iter().any(|hold| hold.overlaps(from, to));
            let is_new = record
                .starts
                .iter()
                .any(|start| (from..to).contains(&start.cycle));
            if is_next && to - from != FRAME && !is_held && !is_new {
                let late_cycles = to as i64 - (from + FRAME) as i64;
                let seen = format!(
                    "A{}, {late_cycles} cycles late at {} ms",
                    servo + 1,
                    to / MS
                );
                return Err(seen);
            }
        }
    }
    Ok(())
}

/// Checks that every line that the board carried out was really sent.
fn check_orders_were_sent(record: &Record) -> Result<(), String> {
    for line in &record.lines {
        // After a reset, a banner may follow the cut-off part of an answer.
        let Some(answered_line) = line
            .text
            .strip_prefix("ok ")
            .filter(|text| !text.contains('#'))
        else {
            continue;
        };
        let sent_line = if answered_line.starts_with("gait=") {
            "status"
        } else {
            answered_line
        };
        // If a reset comes while a line arrives, the program receives only the last part of the line. If the radio
        // link breaks within a line, noise may end the line early.
        let recent_cycles = line.cycle.saturating_sub(200 * MS)..line.cycle;
        let mut starts = record.starts.iter();
        let is_new = starts.any(|start| recent_cycles.contains(&start.cycle));
        let link_breaks_after = |cycle: u64| {
            record
                .radio_spans
                .iter()
                .any(|link| (cycle..cycle + 200 * MS).contains(&link.end))
        };
        let mut sent_lines = record.sent.iter();
        let is_same_line = |(cycle, text): &(u64, String)| {
            let is_part = is_new && text.ends_with(sent_line)
                || link_breaks_after(*cycle) && text.starts_with(sent_line);
            *cycle < line.cycle && (text == sent_line || is_part)
        };
        if !sent_lines.any(is_same_line) {
            return Err(format!("{}, at {} ms", line.text, line.cycle / MS));
        }
    }
    Ok(())
}

/// Checks that each `stop` of the person at the phone is answered in time, if the radio link holds for that long and
/// no trouble comes.
fn check_stop_is_answered(record: &Record) -> Result<(), String> {
    const ANSWER_TIME: u64 = 2_000 * MS;
    // The time for an answer while the robot still searches for the line's baud rate: it leaves a rate that has
    // carried a command after 32 wrong bytes, some eight lines, and then needs up to five more. One in ten is lost.
    const RATE_SEARCH_TIME: u64 = 6_000 * MS;
    // An answer to an earlier `stop` may come up to this time before the `stop`.
    const EARLIER_ANSWER_TIME: u64 = 300 * MS;
    for stop in &record.stops {
        let is_stop_answer = |line: &&Line| {
            let is_end = line.text.ends_with("ok stop") || line.text.starts_with("err 7");
            line.cycle + EARLIER_ANSWER_TIME > *stop && is_end
        };
        let answer_cycle = record
            .lines
            .iter()
            .find(is_stop_answer)
            .map(|line| line.cycle);
        let due_cycle_in = |link: &Span| {
            let start = link.start.max(*stop);
            let due_cycle = start
                + if record.has_found_rate(start) {
                    ANSWER_TIME
                } else {
                    RATE_SEARCH_TIME
                };
            let is_calm = !record.is_troubled(start.saturating_sub(300 * MS), due_cycle);
            (link.end >= due_cycle && is_calm).then_some(due_cycle)
        };
        let due_cycle = record.radio_spans.iter().find_map(due_cycle_in);
        if due_cycle.is_some_and(|due_cycle| answer_cycle.is_none_or(|cycle| cycle > due_cycle)) {
            return Err(format!("stop, sent first at {} ms", stop / MS));
        }
    }
    Ok(())
}

/// Checks that the LED blinks the code of the fault that each `status` reports, from the last change (the report of a
/// fault, an order or a start) on.
fn check_led(record: &Record) -> Result<(), String> {
    let led_edges = record.edges.iter().filter(|edge| edge.pin == LED);
    let led_edges: Vec<(Time, bool)> = led_edges
        .map(|edge| (edge.cycle as Time, edge.is_rising))
        .collect();
    let shown_code_of = |exchange: &'_ Exchange| {
        let cycle = exchange.answer.as_ref()?.cycle;
        Some((cycle, led::fault_code(exchange.status("fault")?)))
    };
    // An order waits while older answers are printed, so the change is at the time of its own answer.
    let reports_change = |text: &str| {
        let is_done = text.starts_with("ok ") && !text.starts_with("ok gait=");
        is_done || text.starts_with("# fault") || text.starts_with("# held")
    };
    let change_lines = record
        .lines
        .iter()
        .filter(|line| reports_change(&line.text));
    let changes = change_lines.map(|line| line.cycle);
    let changes = changes.chain(record.orders().map(|(received, _)| received.cycle));
    let changes: Vec<u64> = changes
        .chain(record.starts.iter().map(|start| start.cycle))
        .collect();
    for (cycle, code) in record.exchanges.iter().filter_map(shown_code_of) {
        // A flash of the LED that began before the last change does not belong to the present pattern.
        let last_change = changes.iter().filter(|change| **change < cycle).max();
        let start = last_change.unwrap_or(&0) + 60 * MS;
        if !record.is_disturbed(start.saturating_sub(100 * MS), cycle) {
            led::check_pattern(&led_edges, start as Time, cycle as Time, code?)?;
        }
    }
    Ok(())
}
