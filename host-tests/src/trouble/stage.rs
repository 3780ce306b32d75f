//! Plays a scenario on a simulated UNO and records all that can be seen of it.

use lizard_core::console::command::{effect, parse};
use lizard_core::console::word::Effect;
use lizard_host::sim::frame::servo_pins;
use lizard_host::sim::lines::LineReader;
use lizard_host::sim::supplies;
use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, Edge, Fidelity, Image, Pin, State, Uno};

use super::record::{Exchange, Received, Record, Span};
use super::scenario::Scenario;
use super::step::Step;

/// The longest wait for an answer, ms.
const PATIENCE_MS: u64 = 400;

/// The supply of a board in good order, and what is left of a weak one, mV.
const GOOD: f64 = 5_000.0;
const FALLEN: f64 = 2_400.0;

/// Below: the chip is held in reset, mV, with the most that its hysteresis adds.
const BROWN_OUT: f64 = 2_725.0;

/// A servo has pulses if one began in the last of these cycles.
const RECENT: u64 = 25 * CYCLES_PER_MS;

/// A board, and what has been seen of it.
struct Stage<'a> {
    robot: &'a Robot,
    uno: Uno,
    pins: [Pin; 4],
    reader: LineReader,
    record: Record,
    starts: usize,
    weak: bool,
    /// When each servo's latest pulse began.
    latest: [Option<u64>; 4],
}

/// Plays a scenario from power-on to its end.
#[must_use]
pub fn play(image: &Image, robot: &Robot, scenario: &Scenario) -> Record {
    let mut uno = Uno::with_image(image.clone(), Fidelity::DataSheet);
    supplies::connect(&mut uno, robot);
    uno.set_boot_loader(scenario.boot_loader);
    uno.set_noise_seed(scenario.number);
    let mut stage = Stage {
        robot,
        uno,
        pins: servo_pins(robot),
        reader: LineReader::default(),
        record: Record::default(),
        starts: 1,
        weak: false,
        latest: [None; 4],
    };
    stage.record.supply.push((0, GOOD));
    for step in &scenario.steps {
        stage.perform(step);
    }
    stage.finish()
}

impl Stage<'_> {
    fn perform(&mut self, step: &Step) {
        let now = self.uno.cycle();
        match step {
            Step::Say(line) => _ = self.say(line),
            Step::Send(line) => self.send(line),
            Step::Order(line) => {
                if self
                    .say(line)
                    .is_some_and(|answer| answer.starts_with("err 7"))
                {
                    self.say("stand");
                }
            }
            Step::Wait(cycles) => self.run_to(now + cycles),
            Step::Stall(cycles) => {
                self.uno.stall_main(*cycles);
                self.record.stalls.push(Span {
                    start: now,
                    end: now + cycles,
                });
            }
            Step::Hold(cycles) => {
                self.uno.hold(*cycles);
                // It waits until interrupts are on.
                let end = now + cycles + CYCLES_PER_MS;
                self.record.holds.push(Span { start: now, end });
            }
            Step::Reset => {
                self.record.cuts.push(now);
                self.uno.reset();
                self.look();
            }
            Step::PowerCycle => {
                self.record.cuts.push(now);
                self.uno.power_cycle();
                self.look();
            }
            Step::Supply(mv) => self.set_supply(f64::from(*mv)),
            Step::Weak(on) => {
                self.weak = *on;
                if !on {
                    self.set_supply(GOOD);
                }
            }
        }
    }

    fn send(&mut self, line: &str) {
        self.uno.send(line.as_bytes());
        self.uno.send(b"\n");
    }

    fn say(&mut self, line: &str) -> Option<String> {
        let asked = self.uno.cycle();
        self.look();
        let from = self.record.lines.len();
        self.send(line);
        let mut answer = None;
        let end = asked + PATIENCE_MS * CYCLES_PER_MS;
        while answer.is_none() && self.uno.cycle() < end && self.is_alive() {
            self.run_to(self.uno.cycle() + CYCLES_PER_MS);
            let new = &self.record.lines[from..];
            answer = new.iter().find(|line| line.is_answer()).cloned();
        }
        let text = answer.as_ref().map(|line| line.text.clone());
        self.record.exchanges.push(Exchange {
            asked,
            line: line.to_owned(),
            effect: effect(line, self.robot.firmware()),
            answer,
        });
        text
    }

    fn is_alive(&self) -> bool {
        *self.uno.state() == State::Alive
    }

    fn set_supply(&mut self, mv: f64) {
        let now = self.uno.cycle();
        if self
            .record
            .supply
            .last()
            .is_some_and(|(_, before)| *before == mv)
        {
            return;
        }
        self.uno.set_supply_mv(mv);
        self.record.supply.push((now, mv));
        if mv < BROWN_OUT {
            self.record.cuts.push(now);
        }
    }

    /// A stall ends with a reset, and a weak supply answers to the pulses: so time
    /// passes in small pieces while there is one of them.
    fn run_to(&mut self, until: u64) {
        while self.uno.cycle() < until && self.is_alive() {
            let now = self.uno.cycle();
            let stalled = self
                .record
                .stalls
                .last()
                .is_some_and(|stall| stall.end > now);
            let piece = if stalled || self.weak {
                CYCLES_PER_MS
            } else {
                until - now
            };
            self.uno.run_until_cycle(until.min(now + piece));
            self.look();
        }
    }

    /// Takes over what the board has done since the last look.
    fn look(&mut self) {
        let bytes = self.uno.take_transmitted();
        self.record.lines.extend(self.reader.read(&bytes));
        let edges = self.uno.take_edges();
        for (latest, pin) in self.latest.iter_mut().zip(self.pins) {
            let rises = |edge: &&Edge| edge.high && edge.pin == pin;
            *latest = edges
                .iter()
                .rev()
                .find(rises)
                .map(|edge| edge.cycle)
                .or(*latest);
        }
        self.record.edges.extend(edges);
        let starts = self.uno.reset_events();
        if starts.len() > self.starts {
            self.starts = starts.len();
            self.uno.stall_main(0);
            let now = self.uno.cycle();
            if let Some(stall) = self.record.stalls.last_mut() {
                stall.end = stall.end.min(now);
            }
        }
        if self.weak {
            let since = self.uno.cycle().saturating_sub(RECENT);
            let awake = self
                .latest
                .iter()
                .flatten()
                .filter(|at| **at >= since)
                .count();
            self.set_supply(if awake >= 3 { FALLEN } else { GOOD });
        }
    }

    fn finish(mut self) -> Record {
        self.look();
        let mut record = self.record;
        record.end = self.uno.cycle();
        record.starts = self.uno.reset_events();
        record.written = self.uno.eeprom_operations();
        record.state = Some(self.uno.state().clone());
        let mut text = Vec::new();
        for byte in self.uno.received_by_uno() {
            record.bytes.push(byte.cycle);
            if byte.byte != b'\n' {
                text.push(byte.byte);
                continue;
            }
            let line = String::from_utf8_lossy(&text).into_owned();
            record.received.push(Received {
                cycle: byte.cycle,
                effect: effect_of_an_end(&line, self.robot),
                text: line,
            });
            text.clear();
        }
        record.find_pulses(self.pins);
        record
    }
}

/// The effect of a line, or of its longest end that has one: a reset may have cut off what
/// came before.
fn effect_of_an_end(line: &str, robot: &Robot) -> Effect {
    let robot = robot.firmware();
    if parse(line.as_bytes(), robot).is_ok() {
        return effect(line, robot);
    }
    let ends = line
        .char_indices()
        .map(|(at, _)| effect(&line[at..], robot));
    let mut some = ends.filter(|effect| *effect != Effect::None);
    some.next().unwrap_or(Effect::None)
}
