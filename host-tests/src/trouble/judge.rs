//! A record as the events that the rules judge, and the rules that need the record.

use lizard_core::console::word::Effect;
use lizard_core::memory::restart::Cause;
use lizard_host::sim::lines::Line;
use lizard_robot::Robot;
use lizard_rules::{Broken, Event, Limits, Observer, Pulse, Rule, Time, led};
use simulated_uno::{Pin, ResetCause, State};

use super::record::{Exchange, MS, Record};
use super::scenario::Scenario;
use super::setup::WIDE;

/// The LED.
const LED: Pin = Pin::d(13);

/// Cycles of a byte on the line.
const BYTE: u64 = 1_360;

/// The limits of a scenario's robot.
fn limits(robot: &Robot, scenario: &Scenario) -> Limits {
    let cycles = |us: f64| (us * 16.0).round() as u32;
    let pace = robot.pace();
    let fastest = pace.slew.max(pace.gait_slew);
    let says = |text: &str| {
        let mut steps = scenario.steps.iter();
        steps.any(|step| step.to_string().contains(text))
    };
    // With other numbers of a servo: the largest of both.
    let wide = if says("scale ") { WIDE } else { "0" };
    let wide: f64 = wide.parse().expect("a number");
    let servos = robot.servos().each_ref();
    Limits {
        // A cycle of rounding at each end, and half a step of an angle.
        leap: servos.map(|servo| cycles(fastest / 50.0 * servo.us_per_degree.abs().max(wide)) + 4),
        widths: servos.map(|servo| (cycles(servo.min_us) - 1, cycles(servo.max_us) + 1)),
        levels: robot.supplies().board.map(|volts| (1_000.0 * volts) as u32),
        frame_left: 25 * lizard_rules::MS,
        until_told: 300 * lizard_rules::MS,
        boots_to_rest: says("boot rest"),
        brown_outs_forget: true,
        is_narrowed: says("say limit ") && says("say factory"),
        ..Limits::default()
    }
}

/// Judges a record: each rule that is broken, once.
#[must_use]
pub fn broken(record: &Record, robot: &Robot, scenario: &Scenario) -> Vec<Broken> {
    let mut observer = Observer::new(limits(robot, scenario));
    let mut all: Vec<Broken> = Vec::new();
    for (at, event) in events(record) {
        observer.observe(at, event);
        for mut broken in observer.take_broken() {
            broken.seen += &format!(", at {:.3} ms", at as f64 / MS as f64);
            all.push(broken);
        }
    }
    let checks: [(Rule, Result<(), String>); 4] = [
        (Rule::Lives, lives(record)),
        (Rule::Stands, stands(record)),
        (Rule::Refused, refused_changes_nothing(record)),
        (Rule::Led, led_shows_the_fault(record)),
    ];
    for (rule, held) in checks {
        all.extend(held.err().map(|seen| Broken::new(rule, seen)));
    }
    all.sort_by_key(|broken| broken.rule);
    all.dedup_by_key(|broken| broken.rule);
    all
}

const fn cause(cause: ResetCause) -> Cause {
    match cause {
        ResetCause::PowerOn => Cause::Power,
        ResetCause::External => Cause::External,
        ResetCause::BrownOut => Cause::BrownOut,
        ResetCause::Watchdog => Cause::Watchdog,
    }
}

/// Every event of a record, in order of time.
#[must_use]
pub fn events(record: &Record) -> Vec<(Time, Event<'_>)> {
    let time = |at: u64| at as Time;
    let mut events: Vec<(Time, Event<'_>)> = Vec::new();
    let mut add = |at: u64, event| events.push((time(at), event));
    for (at, mv) in &record.supply {
        add(*at, Event::Supply(*mv as u32));
    }
    for cut in &record.cuts {
        add(*cut, Event::Cut);
    }
    for stall in &record.stalls {
        add(stall.start, Event::Stalled(time(stall.end)));
    }
    for hold in &record.holds {
        add(hold.start, Event::HeldUp(time(hold.end)));
    }
    for start in &record.starts {
        add(start.cycle, Event::Start(cause(start.cause)));
    }
    for at in &record.bytes {
        add(*at, Event::Byte);
    }
    for received in record
        .received
        .iter()
        .filter(|received| !received.text.trim().is_empty())
    {
        add(received.cycle, Event::Line);
        let saved = received.text == "save" && record.is_saved(received.cycle);
        if saved || received.text == "save" || received.effect == Effect::Calibrates {
            add(received.cycle, Event::Calibrated { saved });
        }
    }
    for (received, done) in record.orders() {
        let effect = received.effect;
        add(received.cycle, Event::Order { effect, done });
    }
    for line in &record.lines {
        let length = BYTE * line.text.len() as u64;
        let begun = time(line.cycle.saturating_sub(length));
        add(line.cycle, Event::Said(begun, &line.text));
    }
    for exchange in &record.exchanges {
        let (asked, line) = (time(exchange.asked), exchange.line.as_str());
        let effect = exchange.effect;
        events.push(match &exchange.answer {
            Some(Line { cycle, text, .. }) => (
                time(*cycle),
                Event::Answer {
                    line,
                    effect,
                    asked,
                    text,
                },
            ),
            None => (asked + time(400 * MS), Event::Unanswered(asked, line)),
        });
    }
    for (at, pulse) in &record.pulses {
        events.push((time(*at), Event::Pulse(*pulse)));
    }
    for write in &record.written {
        events.push((time(write.cycle), Event::Written));
    }
    events.push((time(record.end), Event::Pass));
    events.sort_by_key(|(at, _)| *at);
    events
}

/// Neither crashed nor halted.
fn lives(record: &Record) -> Result<(), String> {
    match &record.state {
        Some(State::Alive) => Ok(()),
        other => Err(format!("{other:?}")),
    }
}

/// The last `stand` of the scenario, long after all trouble.
fn stands(record: &Record) -> Result<(), String> {
    let mut exchanges = record.exchanges.iter().rev();
    let status = exchanges.next().ok_or("nothing was asked")?;
    let stand = exchanges
        .find(|exchange| exchange.line == "stand")
        .ok_or("no stand")?;
    if !stand.is_done() {
        return Err(format!("stand is answered by {:?}", stand.answer));
    }
    if status.status("gait") != Some("stand") || status.status("fault") != Some("none") {
        return Err(format!("after stand: {:?}", status.answer));
    }
    let last = record.end - 110 * MS;
    for servo in 0..4 {
        let is_late = |(at, pulse): &&(u64, Pulse)| pulse.servo == servo && *at > last;
        let late = record.pulses.iter().filter(is_late);
        let widths: Vec<u32> = late.map(|(_, pulse)| pulse.width).collect();
        let steady = widths.windows(2).all(|pair| pair[0] == pair[1]);
        if widths.len() < 4 || !steady {
            return Err(format!("A{} gets {widths:?} at last", servo + 1));
        }
    }
    Ok(())
}

/// A command with an `err` between two questions: what they tell is the same.
fn refused_changes_nothing(record: &Record) -> Result<(), String> {
    for three in record.exchanges.windows(3) {
        let [before, refused, after] = three else {
            continue;
        };
        let answer = refused.answer.as_ref();
        let is_refused = answer.is_some_and(|line| line.text.starts_with("err"));
        let (Some(from), Some(to)) = (&before.answer, &after.answer) else {
            continue;
        };
        let are_told = before.status("gait").is_some() && after.status("gait").is_some();
        if !is_refused || !are_told || record.is_troubled(from.cycle, to.cycle) {
            continue;
        }
        for key in ["gait", "speed", "guard", "fault", "reset", "resets"] {
            if before.status(key) != after.status(key) {
                let line = &refused.line;
                return Err(format!("{line}: {} and then {}", from.text, to.text));
            }
        }
    }
    Ok(())
}

/// The LED from the report of what `status` tells, or the last order, to `status`.
fn led_shows_the_fault(record: &Record) -> Result<(), String> {
    let led = record.edges.iter().filter(|edge| edge.pin == LED);
    let led: Vec<(Time, bool)> = led.map(|edge| (edge.cycle as Time, edge.high)).collect();
    let told = |exchange: &'_ Exchange| {
        let at = exchange.answer.as_ref()?.cycle;
        Some((at, led::code(exchange.status("fault")?)))
    };
    let reports = record
        .lines
        .iter()
        .filter(|line| line.text.starts_with("# fault") || line.text.starts_with("# held"));
    let changes = reports.map(|line| line.cycle);
    let changes = changes.chain(record.orders().map(|(received, _)| received.cycle));
    let changes: Vec<u64> = changes
        .chain(record.starts.iter().map(|start| start.cycle))
        .collect();
    for (at, code) in record.exchanges.iter().filter_map(told) {
        // What is lit from before is no flash of this pattern.
        let since = changes.iter().filter(|change| **change < at).max();
        let from = since.unwrap_or(&0) + 60 * MS;
        if !record.is_disturbed(from.saturating_sub(100 * MS), at) {
            led::shows(&led, from as Time, at as Time, code?)?;
        }
    }
    Ok(())
}
