//! Record of a scenario: the outputs that are visible from outside (pulses, lines, the LED, resets, writes to the
//! EEPROM), and the injected faults.

use std::ops::Range;

use lizard_core::console::word::Effect;
use lizard_host::sim::lines::Line;
use lizard_rules::Pulse;
use simulated_uno::{
    CYCLES_PER_MS, Edge, EepromOperation, Pin, ResetCause, ResetEvent, State, pulses,
};

/// CPU cycles in a millisecond.
pub const MS: u64 = CYCLES_PER_MS;

/// A range of cycles.
pub type CycleSpan = Range<u64>;

/// True if two spans have a cycle in common.
#[must_use]
pub fn overlap(first: &CycleSpan, second: &CycleSpan) -> bool {
    first.start < second.end && second.start < first.end
}

/// A line sent to the board, and its answer.
#[derive(Debug, Clone)]
pub struct Exchange {
    /// The cycle at which the line was sent.
    pub sent_cycle: u64,
    /// The line that was sent.
    pub line: String,
    /// The effect on the servos if the board carries out the line.
    pub effect: Effect,
    /// The first answer that the board printed after the line was sent; `None` if the board did not answer in time.
    pub answer: Option<Line>,
}

impl Exchange {
    /// True if the answer was `ok`.
    #[must_use]
    pub fn is_accepted(&self) -> bool {
        let answer = self.answer.as_ref();
        answer.is_some_and(|line| line.text.starts_with("ok"))
    }

    /// Returns the value of this key in the answer to `status`. `None` if the line is not `status`, if there is no
    /// answer, or if the answer does not have the key.
    #[must_use]
    pub fn status_value(&self, key: &str) -> Option<&str> {
        if self.line != "status" {
            return None;
        }
        let text = self.answer.as_ref()?.text.strip_prefix("ok ")?;
        let mut pairs = text.split(' ').filter_map(|pair| pair.split_once('='));
        let (_, value) = pairs.find(|(name, _)| *name == key)?;
        Some(value)
    }
}

/// A line that arrived at the board.
#[derive(Debug, Clone)]
pub struct ReceivedLine {
    /// The cycle at which the line end arrived.
    pub cycle: u64,
    /// The text that arrived.
    pub text: String,
    /// The effect on the servos if the board carries out the line.
    pub effect: Effect,
    /// True if the line is a command and arrived undamaged.
    pub is_intact_command: bool,
}

impl ReceivedLine {
    /// True if the line commands the robot to move, to stop or to rest.
    fn is_motion_command(&self) -> bool {
        let affects_motion = matches!(self.effect, Effect::Motion | Effect::Freeze | Effect::Rest);
        affects_motion && self.text != super::scenario::REFUSED_POSE
    }
}

/// The record of a scenario: everything that was observed, and everything that was done to the board.
#[derive(Debug, Default)]
pub struct Record {
    /// Edges of all pins.
    pub edges: Vec<Edge>,
    /// The pulses of A1 to A4, each with the cycle at which it begins.
    pub pulses: Vec<(u64, Pulse)>,
    /// The lines that the board printed.
    pub printed_lines: Vec<Line>,
    /// The lines for whose answers the scenario waited, in chronological order.
    pub exchanges: Vec<Exchange>,
    /// The lines that arrived at the board, whether or not the scenario waited for an answer.
    pub received_lines: Vec<ReceivedLine>,
    /// The lines that were sent by cable or radio, each with its cycle.
    pub sent_lines: Vec<(u64, String)>,
    /// The cycles at which the person at the phone sent `stop`.
    pub stop_cycles: Vec<u64>,
    /// The spans in which the person's lines could reach the board: the radio link existed, and the phone's screen was
    /// not locked.
    pub radio_spans: Vec<CycleSpan>,
    /// The cycles at which bytes arrived at the board.
    pub byte_cycles: Vec<u64>,
    /// All resets, each of which starts the program.
    pub resets: Vec<ResetEvent>,
    /// All writes to the EEPROM.
    pub eeprom_writes: Vec<EepromOperation>,
    /// The supply voltages in mV, each with the cycle from which it applied.
    pub supply_mv: Vec<(u64, f64)>,
    /// The spans in which the main loop was stalled.
    pub stalls: Vec<CycleSpan>,
    /// The spans in which interrupts were blocked.
    pub interrupt_blocks: Vec<CycleSpan>,
    /// The cycles at which RESET was pulled low, or the supply was cut or fell below the brown-out level.
    pub pulse_cut_cycles: Vec<u64>,
    /// The cycle at which the scenario ended.
    pub end_cycle: u64,
    /// The board's state at the end; `None` until the scenario has ended.
    pub state: Option<State>,
}

impl Record {
    /// Collects the servos' pulses from the edges and adds them to the record.
    pub(super) fn collect_pulses(&mut self, pins: [Pin; 4]) {
        // Cycles after a reset within which the chip releases its pins.
        const RELEASE_CYCLES: u64 = MS / 10;
        for (servo, pin) in pins.into_iter().enumerate() {
            for pulse in pulses(&self.edges, pin) {
                let (start, end) = (pulse.start, pulse.start + pulse.width);
                let is_cut_at = |cycle: &u64| {
                    (*cycle..*cycle + RELEASE_CYCLES).contains(&end) || (start..end).contains(cycle)
                };
                let is_delayed_by = |block: &CycleSpan| overlap(block, &(start..end + MS));
                let pulse = Pulse {
                    servo,
                    width: pulse.width as u32,
                    is_cut: self.pulse_cut_cycles.iter().any(is_cut_at),
                    is_end_late: self.interrupt_blocks.iter().any(is_delayed_by),
                };
                self.pulses.push((start, pulse));
            }
        }
    }

    /// True if the main loop was stalled or interrupts were blocked in this span.
    #[must_use]
    pub fn is_stalled_or_blocked(&self, span: &CycleSpan) -> bool {
        let mut disturbances = self.stalls.iter().chain(&self.interrupt_blocks);
        disturbances.any(|disturbance| overlap(disturbance, span))
    }

    /// Returns the lines that command the robot to move, to stop or to rest, each with its outcome: `Some(true)` if the
    /// board carried out the line, `Some(false)` if it refused the line, `None` if the outcome is unknown.
    pub fn motion_commands(&self) -> impl Iterator<Item = (&ReceivedLine, Option<bool>)> {
        self.received_lines
            .iter()
            .filter(|received| received.is_motion_command())
            .map(|received| {
                let matches_line = |exchange: &&Exchange| {
                    exchange.line == received.text && exchange.sent_cycle <= received.cycle
                };
                let exchange = self.exchanges.iter().rev().find(matches_line);
                // The exchange belongs to this line only if the line arrived within the time that sending takes.
                let exchange =
                    exchange.filter(|exchange| received.cycle - exchange.sent_cycle < 10 * MS);
                let answer = exchange.and_then(|exchange| exchange.answer.as_ref());
                let outcome = answer.and_then(|answer| match answer.text.get(..3)? {
                    "ok " => Some(true),
                    "err" => Some(false),
                    _ => None,
                });
                (received, outcome.or_else(|| self.derive_outcome(received)))
            })
    }

    /// Derives the outcome of a line for whose answer the scenario did not wait, from the lines that the board prints
    /// in the next 300 ms. Returns `Some(true)` if the board carried out the line, `Some(false)` if it refused the
    /// line, `None` if the outcome is unknown.
    fn derive_outcome(&self, received: &ReceivedLine) -> Option<bool> {
        let span = received.cycle..received.cycle + 300 * MS;
        // A reset may have cut off the beginning of the line.
        let is_ok = |text: &str| {
            let echo = text.strip_prefix("ok ");
            echo.is_some_and(|echo| received.text.ends_with(echo))
        };
        let lines = self.printed_lines.iter();
        let mut next_lines = lines.filter(|line| span.contains(&line.cycle));
        if next_lines.clone().any(|line| is_ok(&line.text)) {
            return Some(true);
        }
        // While the servos rest (7) or the supply is too low (8), a motion command without an `ok` is refused.
        let is_refusal = |text: &str| text.starts_with("err 7 ") || text.starts_with("err 8 ");
        let is_refused = next_lines.any(|line| is_refusal(&line.text));
        (is_refused && !self.is_disturbed(&span)).then_some(false)
    }

    /// True if the answer to a `save` that arrived at this cycle was `ok`.
    #[must_use]
    pub fn was_save_accepted_at(&self, cycle: u64) -> bool {
        let is_accepted_save = |exchange: &Exchange| {
            let sent_span = exchange.sent_cycle..exchange.sent_cycle + 10 * MS;
            exchange.line == "save" && exchange.is_accepted() && sent_span.contains(&cycle)
        };
        self.exchanges.iter().any(is_accepted_save)
    }

    /// True if the board has found the sender's baud rate by this cycle. The board has then answered a line since the
    /// person began to drive by radio, and since the last reset that made the board forget the rate.
    #[must_use]
    pub fn has_found_baud_rate(&self, cycle: u64) -> bool {
        let radio_start = self.radio_spans.first().map_or(cycle, |span| span.start);
        let forgets_baud_rate = |reset: &&ResetEvent| {
            let is_cause = matches!(reset.cause, ResetCause::PowerOn | ResetCause::External);
            is_cause && reset.cycle < cycle
        };
        let reset = self.resets.iter().rev().find(forgets_baud_rate);
        let search_start = reset.map_or(radio_start, |reset| reset.cycle.max(radio_start));
        let mut lines = self.printed_lines.iter();
        lines.any(|line| line.is_answer() && (search_start..cycle).contains(&line.cycle))
    }

    /// True if there was a reset, a power cut, a stall or a block of interrupts in this span.
    #[must_use]
    pub fn is_disturbed(&self, span: &CycleSpan) -> bool {
        self.resets.iter().any(|reset| span.contains(&reset.cycle))
            || self.pulse_cut_cycles.iter().any(|cut| span.contains(cut))
            || self.is_stalled_or_blocked(span)
    }
}
