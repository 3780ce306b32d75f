//! Checks of a scenario against the safety rules. The record is converted to events for the observer; rules that need
//! the whole record are checked here.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;
use lizard_host::patrol::PATROL;
use lizard_host::sim::lines::Line;
use lizard_robot::Robot;
use lizard_rules::{Event, Limits, Observer, Pulse, Rule, Time, Violation, led};
use simulated_uno::{Pin, ResetCause, State};

use crate::{CYCLES_PER_US, FRAME_CYCLES};

use super::random_commands::LARGE_SCALE;
use super::record::{CycleSpan, Exchange, MS, Record, overlap};
use super::scenario::Scenario;

/// The LED's pin, D13.
const LED_PIN: Pin = Pin::d(13);

/// Duration of a byte that the board sends on the serial line, cycles: ten bits of 136 cycles.
const SENT_BYTE_CYCLES: u64 = 1_360;

/// Returns the observer's limits for a scenario's robot.
fn observer_limits(robot: &Robot, scenario: &Scenario) -> Limits {
    let us_to_cycles = |us: f64| (us * CYCLES_PER_US).round() as u32;
    let speed_limits = robot.speed_limits();
    let max_speed = speed_limits.slew.max(speed_limits.gait_slew);
    let mentions = |text: &str| {
        let mut steps = scenario.steps.iter();
        steps.any(|step| step.to_string().contains(text))
    };
    // If the scenario changes the scale of a servo, the limit follows from the larger scale.
    let scale_text = if mentions("scale ") { LARGE_SCALE } else { "0" };
    let scale_in_scenario: f64 = scale_text.parse().expect("the scale is a number");
    let servos = robot.servos().each_ref();
    let thresholds = robot.supplies().board_thresholds;
    Limits {
        // Allows for a cycle of rounding at both ends of a pulse, and half an angle step.
        max_change_cycles: servos.map(|servo| {
            us_to_cycles(max_speed / 50.0 * servo.us_per_degree.abs().max(scale_in_scenario)) + 4
        }),
        width_ranges: servos.map(|servo| {
            let [min, max] = [servo.min_us, servo.max_us].map(us_to_cycles);
            (min - 1, max + 1)
        }),
        levels_mv: thresholds.map(|volts| (1_000.0 * volts) as u32),
        max_frame_remainder: 25 * lizard_rules::MS,
        max_report_time: 300 * lizard_rules::MS,
        max_queue_time: 150 * lizard_rules::MS,
        // A patrol rests for a second, or longer if the supply is low.
        max_routine_rest: 125_000 * lizard_rules::MS
            / i64::from(robot.supplies().slow_pace_percent),
        can_boot_to_rest: mentions("boot rest"),
        can_brown_outs_clear_ram: true,
        can_saved_travel_be_narrower: mentions("say limit ") && mentions("say factory"),
        ..Limits::default()
    }
}

/// Checks a record against the rules. Returns at most one violation of each rule.
#[must_use]
pub fn find_violations(record: &Record, robot: &Robot, scenario: &Scenario) -> Vec<Violation> {
    let mut observer = Observer::new(observer_limits(robot, scenario));
    let mut violations: Vec<Violation> = Vec::new();
    for (time, event) in collect_events(record) {
        observer.observe(time, event);
        for mut violation in observer.take_violations() {
            violation.observation += &format!(", at {:.3} ms", time as f64 / MS as f64);
            violations.push(violation);
        }
    }
    for (rule, result) in [
        (Rule::KeepsRunning, check_alive(record)),
        (Rule::StandWorks, check_stand(record)),
        (Rule::RefusalChangesNothing, check_refusals(record)),
        (Rule::LedShowsFault, check_led(record)),
        (Rule::PulsePeriod, check_pulse_times(record)),
        (Rule::OnlySentLines, check_only_sent_lines(record)),
        (Rule::StopRepeated, check_stops_are_answered(record)),
    ] {
        if let Err(observation) = result {
            violations.push(Violation::new(rule, observation));
        }
    }
    violations.sort_by_key(|violation| violation.rule);
    violations.dedup_by_key(|violation| violation.rule);
    violations
}

const fn to_cause(cause: ResetCause) -> Cause {
    match cause {
        ResetCause::PowerOn => Cause::Power,
        ResetCause::External => Cause::External,
        ResetCause::BrownOut => Cause::BrownOut,
        ResetCause::Watchdog => Cause::Watchdog,
    }
}

/// Returns all events of a record in chronological order.
#[must_use]
pub fn collect_events(record: &Record) -> Vec<(Time, Event<'_>)> {
    let to_time = |cycle: u64| cycle as Time;
    let mut events: Vec<(Time, Event<'_>)> = Vec::new();
    let mut add = |cycle: u64, event| events.push((to_time(cycle), event));
    for (cycle, mv) in &record.supply_mv {
        add(*cycle, Event::SupplyMv(*mv as u32));
    }
    for cut in &record.pulse_cut_cycles {
        add(*cut, Event::ProgramCut);
    }
    for stall in &record.stalls {
        add(stall.start, Event::MainStalled(to_time(stall.end)));
    }
    for block in &record.interrupt_blocks {
        add(block.start, Event::InterruptsBlocked(to_time(block.end)));
    }
    for reset in &record.resets {
        add(reset.cycle, Event::ProgramStart(to_cause(reset.cause)));
    }
    for cycle in &record.byte_cycles {
        add(*cycle, Event::ByteReceived);
    }
    let received_lines = record.received_lines.iter();
    for received in received_lines.filter(|received| !received.text.is_empty()) {
        let is_command = received.is_intact_command;
        add(received.cycle, Event::LineReceived { is_command });
        let is_saved = received.text == "save" && record.was_save_accepted_at(received.cycle);
        if received.text == "save" || received.effect == Effect::CalibrationChange {
            add(received.cycle, Event::CalibrationChanged { is_saved });
        }
    }
    for (received, is_accepted) in record.motion_commands() {
        let command = Event::MotionCommand {
            effect: received.effect,
            is_accepted,
        };
        add(received.cycle, command);
    }
    for line in &record.printed_lines {
        let length_cycles = SENT_BYTE_CYCLES * line.text.len() as u64;
        let start = to_time(line.cycle.saturating_sub(length_cycles));
        add(line.cycle, Event::LinePrinted(start, &line.text));
    }
    for exchange in &record.exchanges {
        let (sent_at, line) = (to_time(exchange.sent_cycle), exchange.line.as_str());
        if let Some(answer) = &exchange.answer {
            let event = Event::Answer {
                line,
                effect: exchange.effect,
                sent_at,
                answer: &answer.text,
            };
            add(answer.cycle, event);
        } else {
            let timeout = exchange.sent_cycle + 400 * MS;
            add(timeout, Event::Unanswered(sent_at, line));
        }
    }
    for (cycle, pulse) in &record.pulses {
        add(*cycle, Event::Pulse(*pulse));
    }
    for write in &record.eeprom_writes {
        add(write.cycle, Event::ByteWritten);
    }
    // Some rules have time limits, which may expire between other events.
    let check_cycles = (0..record.end_cycle).step_by(100 * MS as usize);
    for cycle in check_cycles.chain([record.end_cycle]) {
        add(cycle, Event::TimePasses);
    }
    events.sort_by_key(|(time, _)| *time);
    events
}

/// Checks that the program has neither crashed nor halted.
fn check_alive(record: &Record) -> Result<(), String> {
    match &record.state {
        Some(State::Alive) => Ok(()),
        state => Err(format!("{state:?}")),
    }
}

/// Checks that the board carries out the scenario's last `stand`, long after all faults, and that the servos then get
/// constant pulses.
fn check_stand(record: &Record) -> Result<(), String> {
    let mut exchanges = record.exchanges.iter().rev();
    let last_status = exchanges.next().ok_or("no line was sent")?;
    let stand_exchange = exchanges.find(|exchange| exchange.line == "stand");
    let stand_exchange = stand_exchange.ok_or("stand was not sent")?;
    if !stand_exchange.is_accepted() {
        return Err(format!("answer to stand: {:?}", stand_exchange.answer));
    }
    let status = ["gait", "fault"].map(|key| last_status.status_value(key));
    if status != [Some("stand"), Some("none")] {
        return Err(format!("status after stand: {:?}", last_status.answer));
    }
    let last_cycles = record.end_cycle - 110 * MS..record.end_cycle;
    for servo in 0..4 {
        let is_last =
            |(cycle, pulse): &&(u64, Pulse)| pulse.servo == servo && last_cycles.contains(cycle);
        let last_pulses = record.pulses.iter().filter(is_last);
        let widths: Vec<u32> = last_pulses.map(|(_, pulse)| pulse.width).collect();
        let is_steady = widths.windows(2).all(|pair| pair[0] == pair[1]);
        if widths.len() < 4 || !is_steady {
            return Err(format!(
                "last pulse widths of A{}: {widths:?} cycles",
                servo + 1
            ));
        }
    }
    Ok(())
}

/// Checks that `status` is the same before and after a refused command. Skips a command if, between the two answers,
/// the robot was disturbed, performed a routine, or stopped because of `deadman` or at the end of a counted motion.
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
        let gaits = [status_before, status_after].map(|status| status.status_value("gait"));
        let have_status = gaits.iter().all(Option::is_some);
        let span = answer_before.cycle..answer_after.cycle;
        let has_motion_ended = record.printed_lines.iter().any(|line| {
            let reports_end =
                line.text == "# done" || line.text.contains("within the deadman time");
            reports_end && span.contains(&line.cycle)
        });
        // A routine continues by itself, for example from a motion to a rest.
        let is_routine = gaits.contains(&Some(PATROL));
        let may_have_changed = has_motion_ended || is_routine || record.is_disturbed(&span);
        if !is_refused || !have_status || may_have_changed {
            continue;
        }
        for key in ["gait", "speed", "guard", "fault", "reset", "resets"] {
            if status_before.status_value(key) != status_after.status_value(key) {
                let line = &refused_command.line;
                return Err(format!(
                    "{line}: status was {}, then {}",
                    answer_before.text, answer_after.text
                ));
            }
        }
    }
    Ok(())
}

/// Checks that successive pulses of a servo start exactly one frame apart, unless the servo rested or there was a reset
/// or a block of interrupts between them.
fn check_pulse_times(record: &Record) -> Result<(), String> {
    for servo in 0..4 {
        let is_of_servo = |(_, pulse): &&(u64, Pulse)| pulse.servo == servo;
        let pulses = record.pulses.iter().filter(is_of_servo);
        let start_cycles: Vec<u64> = pulses.map(|(cycle, _)| *cycle).collect();
        for pair in start_cycles.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let span = from..to;
            // A servo that rests wakes five frames after its last pulse at the earliest.
            let has_rested = to - from > 4 * FRAME_CYCLES;
            let mut blocks = record.interrupt_blocks.iter();
            let is_delayed = blocks.any(|block| overlap(block, &span));
            let mut resets = record.resets.iter();
            let was_reset = resets.any(|reset| span.contains(&reset.cycle));
            if !has_rested && to - from != FRAME_CYCLES && !is_delayed && !was_reset {
                let late_cycles = to as i64 - (from + FRAME_CYCLES) as i64;
                let (number, ms) = (servo + 1, to / MS);
                return Err(format!(
                    "A{number}'s pulse is {late_cycles} cycles late at {ms} ms"
                ));
            }
        }
    }
    Ok(())
}

/// Checks that the board carried out only lines that were sent.
fn check_only_sent_lines(record: &Record) -> Result<(), String> {
    for line in &record.printed_lines {
        // After a reset, the banner may follow an incomplete answer in the same line.
        let echo = line.text.strip_prefix("ok ");
        let Some(answered_line) = echo.filter(|text| !text.contains('#')) else {
            continue;
        };
        let sent_line = match answered_line.starts_with("gait=") {
            true => "status",
            false => answered_line,
        };
        // After a reset during a line, the program receives only the last part of the line. If the radio link breaks
        // during a line, noise may end the line early.
        let recent_cycles = line.cycle.saturating_sub(200 * MS)..line.cycle;
        let mut resets = record.resets.iter();
        let was_reset = resets.any(|reset| recent_cycles.contains(&reset.cycle));
        let link_breaks_after = |cycle: u64| {
            let mut spans = record.radio_spans.iter();
            spans.any(|span| (cycle..cycle + 200 * MS).contains(&span.end))
        };
        let mut sent_lines = record.sent_lines.iter();
        let is_same_line = |(cycle, text): &(u64, String)| {
            let is_part = was_reset && text.ends_with(sent_line)
                || link_breaks_after(*cycle) && text.starts_with(sent_line);
            *cycle < line.cycle && (text == sent_line || is_part)
        };
        if !sent_lines.any(is_same_line) {
            return Err(format!("{}, at {} ms", line.text, line.cycle / MS));
        }
    }
    Ok(())
}

/// Checks that the board answers each `stop` of the person at the phone in time, if the radio link lasts long enough
/// without a disturbance.
fn check_stops_are_answered(record: &Record) -> Result<(), String> {
    const ANSWER_CYCLES: u64 = 2_000 * MS;
    // The limit while the board still searches for the sender's baud rate. After a command at one rate, the board
    // leaves this rate only after 32 wrong bytes, in about eight lines, and then needs up to five more lines. One line
    // in ten is lost.
    const RATE_SEARCH_CYCLES: u64 = 6_000 * MS;
    // An answer to an earlier `stop` also counts if it comes at most this long before the `stop`.
    const EARLIER_ANSWER_CYCLES: u64 = 300 * MS;
    for stop in &record.stop_cycles {
        let is_stop_answer = |line: &&Line| {
            let is_answer = line.text.ends_with("ok stop") || line.text.starts_with("err 7");
            line.cycle + EARLIER_ANSWER_CYCLES > *stop && is_answer
        };
        let answer = record.printed_lines.iter().find(is_stop_answer);
        let answer_cycle = answer.map(|line| line.cycle);
        let find_deadline = |span: &CycleSpan| {
            let start = span.start.max(*stop);
            let deadline = match record.has_found_baud_rate(start) {
                true => start + ANSWER_CYCLES,
                false => start + RATE_SEARCH_CYCLES,
            };
            let is_undisturbed = !record.is_disturbed(&(start.saturating_sub(300 * MS)..deadline));
            (span.end >= deadline && is_undisturbed).then_some(deadline)
        };
        let deadline = record.radio_spans.iter().find_map(find_deadline);
        if deadline.is_some_and(|deadline| answer_cycle.is_none_or(|cycle| cycle > deadline)) {
            let ms = stop / MS;
            return Err(format!("no answer to the stop first sent at {ms} ms"));
        }
    }
    Ok(())
}

/// Checks that the LED flashes the code of the fault that a `status` reports, from the last change before this `status`
/// on. A change is a reported fault, a motion command or a start of the program.
fn check_led(record: &Record) -> Result<(), String> {
    let led_edges = record.edges.iter().filter(|edge| edge.pin == LED_PIN);
    let led_edges = led_edges.map(|edge| (edge.cycle as Time, edge.is_rising));
    let led_edges: Vec<(Time, bool)> = led_edges.collect();
    let reported_code = |exchange: &'_ Exchange| {
        let cycle = exchange.answer.as_ref()?.cycle;
        Some((cycle, led::fault_code(exchange.status_value("fault")?)))
    };
    // A motion command waits while older answers are printed, so it takes effect at the time of its own answer.
    let reports_change = |text: &str| {
        let is_accepted_command = text.starts_with("ok ") && !text.starts_with("ok gait=");
        is_accepted_command || text.starts_with("# fault") || text.starts_with("# held")
    };
    let lines = record.printed_lines.iter();
    let change_lines = lines.filter(|line| reports_change(&line.text));
    let changes = change_lines.map(|line| line.cycle);
    let changes = changes.chain(record.motion_commands().map(|(received, _)| received.cycle));
    let resets = record.resets.iter().map(|reset| reset.cycle);
    let changes: Vec<u64> = changes.chain(resets).collect();
    for (cycle, code) in record.exchanges.iter().filter_map(reported_code) {
        // A flash of the LED that began before the last change belongs to the previous pattern.
        let last_change = changes.iter().filter(|change| **change < cycle).max();
        let start = last_change.unwrap_or(&0) + 60 * MS;
        if !record.is_stalled_or_blocked(&(start.saturating_sub(100 * MS)..cycle)) {
            led::check_pattern(&led_edges, start as Time, cycle as Time, code?)?;
        }
    }
    Ok(())
}
