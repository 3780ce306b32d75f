//! Runs a scenario on a simulated UNO, with a record of all outputs that are visible from outside.

use fastrand::Rng;
use lizard_core::console::command::{effect, parse};
use lizard_core::console::line::MAX_LINE_BYTES;
use lizard_core::console::word::Effect;
use lizard_host::sim::frame::servo_pins;
use lizard_host::sim::lines::LineReader;
use lizard_host::sim::supplies;
use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, Edge, Fidelity, Image, Pin, State, Uno};

use super::drive::Drive;
use super::record::{Exchange, ReceivedLine, Record};
use super::scenario::Scenario;
use super::step::Step;

/// The longest wait for an answer, ms.
const ANSWER_TIMEOUT_MS: u64 = 400;

/// Number of `status` lines after which [`ScenarioRun::ask_until_answered`] ends. A board with another baud rate needs
/// up to five lines to find the sender's rate.
const MAX_STATUS_REQUESTS: u32 = 12;

/// The voltage of a good supply, mV.
const GOOD_MV: f64 = 5_000.0;

/// The voltage of a weak supply under load, mV.
const LOADED_WEAK_MV: f64 = 2_400.0;

/// The voltage below which the chip stays in reset, mV, including the largest hysteresis.
const BROWN_OUT_MV: f64 = 2_725.0;

/// Duration of a byte sent to the board at 115 200 baud, cycles.
const RECEIVED_BYTE_CYCLES: u64 = 1_389;

/// Cycles for which a servo counts as having pulses after the start of its last pulse.
const RECENT_PULSE_CYCLES: u64 = 25 * CYCLES_PER_MS;

/// The state of a running scenario: the board, the person who drives by radio, if any, and the record so far.
struct ScenarioRun<'a> {
    robot: &'a Robot,
    uno: Uno,
    pins: [Pin; 4],
    reader: LineReader,
    drive: Option<Drive<'a>>,
    noise_rng: Rng,
    record: Record,
    /// The number of starts of the program that have been handled.
    handled_start_count: usize,
    /// True while the supply falls whenever three servos have pulses.
    is_supply_weak: bool,
    /// The cycle at which each servo's latest pulse began.
    latest_pulse_cycles: [Option<u64>; 4],
}

/// Runs a scenario from power-on to its end, and returns its record.
#[must_use]
pub fn run_scenario(image: &Image, robot: &Robot, scenario: &Scenario) -> Record {
    let mut uno = Uno::with_image(image.clone(), Fidelity::DataSheet);
    supplies::connect_healthy_robot(&mut uno, robot);
    uno.set_boot_loader(scenario.has_boot_loader);
    uno.set_noise_seed(scenario.number);
    let mut run = ScenarioRun {
        robot,
        uno,
        pins: servo_pins(robot),
        reader: LineReader::default(),
        drive: None,
        noise_rng: Rng::with_seed(scenario.number),
        record: Record::default(),
        handled_start_count: 1,
        is_supply_weak: false,
        latest_pulse_cycles: [None; 4],
    };
    run.record.supply_mv.push((0, GOOD_MV));
    for step in &scenario.steps {
        run.perform_step(step);
    }
    run.finish()
}

impl ScenarioRun<'_> {
    fn perform_step(&mut self, step: &Step) {
        let now = self.uno.cycle();
        match step {
            Step::Say(line) => _ = self.say(line),
            Step::Send(line) => self.send(line),
            Step::SayOrStand(line) => {
                let answer = self.say(line);
                if answer.is_some_and(|answer| answer.starts_with("err 7")) {
                    self.say("stand");
                }
            }
            Step::Wait(cycles) => self.run_to(now + cycles),
            Step::Stall(cycles) => {
                self.uno.stall_main(*cycles);
                self.record.stalls.push(now..now + cycles);
            }
            Step::BlockInterrupts(cycles) => {
                self.uno.block_interrupts(*cycles);
                // The block begins only when interrupts are enabled, so the recorded span is a millisecond longer.
                let end = now + cycles + CYCLES_PER_MS;
                self.record.interrupt_blocks.push(now..end);
            }
            Step::Reset => {
                self.record.pulse_cut_cycles.push(now);
                self.uno.reset();
                self.record_events();
            }
            Step::PowerCycle => {
                self.record.pulse_cut_cycles.push(now);
                self.uno.power_cycle();
                self.record_events();
            }
            Step::Supply(mv) => self.set_supply(f64::from(*mv)),
            Step::Drive(link) => self.drive = Some(Drive::new(*link, self.robot)),
            Step::Leave => {
                if let Some(drive) = &mut self.drive {
                    drive.leave(now);
                }
            }
            Step::Contact(pin, is_closed) => self.uno.set_contact(Pin::arduino(*pin), *is_closed),
            Step::AskUntilAnswered => self.ask_until_answered(),
            Step::Noise(cycles) => self.add_noise(*cycles),
            Step::WeakSupply(is_weak) => {
                self.is_supply_weak = *is_weak;
                if !is_weak {
                    self.set_supply(GOOD_MV);
                }
            }
        }
    }

    fn send(&mut self, line: &str) {
        let now = self.uno.cycle();
        let bytes = [line.as_bytes(), b"\n"].concat();
        match &mut self.drive {
            Some(drive) => drive.send_by_cable(&bytes, now),
            None => self.uno.send(&bytes),
        }
        self.record.sent_lines.push((now, line.to_owned()));
    }

    /// Sends `status` until the robot answers, at most [`MAX_STATUS_REQUESTS`] times.
    fn ask_until_answered(&mut self) {
        for _ in 0..MAX_STATUS_REQUESTS {
            let old_line_count = self.record.printed_lines.len();
            self.send("status");
            self.run_to(self.uno.cycle() + ANSWER_TIMEOUT_MS * CYCLES_PER_MS);
            let mut new_lines = self.record.printed_lines[old_line_count..].iter();
            if new_lines.any(|line| line.text.starts_with("ok gait=")) {
                return;
            }
        }
    }

    /// Sends random bytes to the board: in half of the cases as many as the line can carry in `cycles`, otherwise at
    /// most a twentieth of this number.
    fn add_noise(&mut self, cycles: u64) {
        let max_count = cycles / RECEIVED_BYTE_CYCLES;
        let count = match self.noise_rng.bool() {
            true => max_count,
            false => self.noise_rng.u64(..=max_count / 20),
        };
        for _ in 0..count {
            let byte = match self.noise_rng.u8(..4) {
                0 => b'\n',
                1 => self.noise_rng.u8(b' '..0x7f),
                _ => self.noise_rng.u8(..),
            };
            // A line that contains only `?` would print the help.
            let byte = if byte == b'?' { b'!' } else { byte };
            match self.noise_rng.u8(..8) {
                0 => self.uno.send_with_framing_error(&[byte]),
                _ => self.uno.send(&[byte]),
            }
        }
    }

    /// Sends a line, waits up to [`ANSWER_TIMEOUT_MS`] for its answer and records both. Returns the answer.
    fn say(&mut self, line: &str) -> Option<String> {
        let sent_cycle = self.uno.cycle();
        self.record_events();
        let old_line_count = self.record.printed_lines.len();
        self.send(line);
        let mut answer = None;
        let end_cycle = sent_cycle + ANSWER_TIMEOUT_MS * CYCLES_PER_MS;
        while answer.is_none() && self.uno.cycle() < end_cycle && self.is_alive() {
            self.run_to(self.uno.cycle() + CYCLES_PER_MS);
            let new_lines = &self.record.printed_lines[old_line_count..];
            answer = new_lines.iter().find(|line| line.is_answer()).cloned();
        }
        let text = answer.as_ref().map(|line| line.text.clone());
        self.record.exchanges.push(Exchange {
            sent_cycle,
            line: line.to_owned(),
            effect: effect(line, self.robot.firmware()),
            answer,
        });
        text
    }

    fn is_alive(&self) -> bool {
        *self.uno.state() == State::Alive
    }

    /// Sets the supply voltage in mV, and records a change.
    fn set_supply(&mut self, mv: f64) {
        let now = self.uno.cycle();
        let previous = self.record.supply_mv.last();
        if previous.is_some_and(|(_, previous_mv)| *previous_mv == mv) {
            return;
        }
        self.uno.set_supply_mv(mv);
        self.record.supply_mv.push((now, mv));
        if mv < BROWN_OUT_MV {
            self.record.pulse_cut_cycles.push(now);
        }
    }

    /// Runs until `end_cycle`, in steps of a millisecond during a stall, a weak supply or a drive: a reset ends a
    /// stall, a weak supply reacts to the pulses, and a drive passes bytes on.
    fn run_to(&mut self, end_cycle: u64) {
        while self.uno.cycle() < end_cycle && self.is_alive() {
            let now = self.uno.cycle();
            let last_stall = self.record.stalls.last();
            let is_stalled = last_stall.is_some_and(|stall| stall.end > now);
            let step_cycles = match is_stalled || self.is_supply_weak || self.drive.is_some() {
                true => CYCLES_PER_MS,
                false => end_cycle - now,
            };
            self.uno.run_until_cycle(end_cycle.min(now + step_cycles));
            self.record_events();
        }
    }

    /// Records the board's outputs since the last call, lets the drive react to them, ends a stall after a reset and
    /// updates a weak supply.
    fn record_events(&mut self) {
        let bytes = self.uno.take_transmitted();
        self.record.printed_lines.extend(self.reader.read(&bytes));
        if let Some(drive) = &mut self.drive {
            let bytes: Vec<u8> = bytes.iter().map(|sent| sent.value).collect();
            drive.pass_bytes(&bytes, &mut self.uno, &mut self.record);
        }
        let edges = self.uno.take_edges();
        for (pulse_cycle, pin) in self.latest_pulse_cycles.iter_mut().zip(self.pins) {
            let is_rise = |edge: &&Edge| edge.is_rising && edge.pin == pin;
            let last_rise = edges.iter().rev().find(is_rise);
            *pulse_cycle = last_rise.map(|edge| edge.cycle).or(*pulse_cycle);
        }
        self.record.edges.extend(edges);
        let start_count = self.uno.reset_events().len();
        if start_count > self.handled_start_count {
            self.handled_start_count = start_count;
            self.uno.stall_main(0);
            if let Some(stall) = self.record.stalls.last_mut() {
                stall.end = stall.end.min(self.uno.cycle());
            }
        }
        if self.is_supply_weak {
            let recent_start = self.uno.cycle().saturating_sub(RECENT_PULSE_CYCLES);
            let pulses = self.latest_pulse_cycles.iter().flatten();
            let recent_count = pulses.filter(|cycle| **cycle >= recent_start).count();
            self.set_supply(match recent_count {
                3.. => LOADED_WEAK_MV,
                _ => GOOD_MV,
            });
        }
    }

    /// Ends the scenario and completes its record.
    fn finish(mut self) -> Record {
        self.record_events();
        let mut record = self.record;
        record.end_cycle = self.uno.cycle();
        record.resets = self.uno.reset_events();
        record.eeprom_writes = self.uno.eeprom_operations();
        record.state = Some(self.uno.state().clone());
        let mut line_bytes = Vec::new();
        for byte in self.uno.received_by_uno() {
            record.byte_cycles.push(byte.cycle);
            match byte.value {
                b'\r' | b'\n' => {
                    let line = parse_received_line(&line_bytes, byte.cycle, self.robot);
                    record.received_lines.push(line);
                    line_bytes.clear();
                }
                0x08 | 0x7f => _ = line_bytes.pop_if(|last| last.is_ascii()),
                value => line_bytes.push(value),
            }
        }
        record.collect_pulses(self.pins);
        record
    }
}

/// Parses a received line from its bytes and the cycle at which its line end arrived.
fn parse_received_line(bytes: &[u8], cycle: u64, robot: &Robot) -> ReceivedLine {
    let is_undamaged = bytes.len() <= MAX_LINE_BYTES && bytes.is_ascii();
    let text = String::from_utf8_lossy(bytes.trim_ascii()).to_ascii_lowercase();
    ReceivedLine {
        cycle,
        effect: find_suffix_effect(&text, robot),
        is_intact_command: is_undamaged && parse(text.as_bytes(), robot.firmware()).is_ok(),
        text,
    }
}

/// Returns the effect of a line or, if the line is not a command, of its longest suffix that has an effect. Other text
/// may precede a command, such as an incomplete line left by a reset.
fn find_suffix_effect(line: &str, robot: &Robot) -> Effect {
    let robot = robot.firmware();
    if parse(line.as_bytes(), robot).is_ok() {
        return effect(line, robot);
    }
    let effect_from = |(index, _): (usize, char)| effect(&line[index..], robot);
    let suffix_effects = line.char_indices().map(effect_from);
    let mut effects = suffix_effects.filter(|effect| *effect != Effect::None);
    effects.next().unwrap_or(Effect::None)
}
