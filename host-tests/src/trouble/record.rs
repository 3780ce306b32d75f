//! What was seen of a scenario, from the outside: pulses, lines, the LED, resets, what
//! was written; and what was done to the board.

use lizard_core::console::word::Effect;
use lizard_host::sim::lines::Line;
use simulated_uno::{
    CYCLES_PER_MS, Edge, EepromOperation, Pin, Pulse, Reset, ResetCause, State, pulses,
};

/// Cycles of a millisecond.
pub const MS: u64 = CYCLES_PER_MS;

/// From some cycle to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// Its first cycle.
    pub start: u64,
    /// The cycle after its last.
    pub end: u64,
}

impl Span {
    /// Whether it has a cycle of `start..end`.
    #[must_use]
    pub fn overlaps(&self, start: u64, end: u64) -> bool {
        self.start < end && start < self.end
    }
}

/// A line and its answer.
#[derive(Debug, Clone)]
pub struct Exchange {
    /// The cycle at which it was sent.
    pub asked: u64,
    /// The line.
    pub line: String,
    /// Its effect on the servos, if it is done.
    pub effect: Effect,
    /// The first line that came back and was no information, if one came.
    pub answer: Option<Line>,
}

impl Exchange {
    /// Whether the answer was `ok`.
    #[must_use]
    pub fn is_done(&self) -> bool {
        let answer = self.answer.as_ref();
        answer.is_some_and(|line| line.text.starts_with("ok"))
    }

    /// A value of `status`, if that was asked and answered.
    #[must_use]
    pub fn status(&self, key: &str) -> Option<&str> {
        let text = self.answer.as_ref()?.text.strip_prefix("ok ")?;
        let pairs = text.split(' ').filter_map(|pair| pair.split_once('='));
        let mut found = pairs.filter(|(name, _)| *name == key);
        (self.line == "status").then(|| found.next().map(|(_, value)| value))?
    }
}

/// A line that has come to the board.
#[derive(Debug, Clone)]
pub struct Heard {
    /// The cycle at which its end was there.
    pub cycle: u64,
    /// The line.
    pub text: String,
    /// Its effect on the servos, if it is done.
    pub effect: Effect,
}

impl Heard {
    /// True for a line that tells the robot to move, to stop or to rest.
    fn is_order(&self) -> bool {
        let ordered = matches!(self.effect, Effect::Moves | Effect::Freezes | Effect::Rests);
        ordered && self.text != super::scenario::NOWHERE
    }
}

/// A servo's pulse, and what kept it from being the one that was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seen {
    /// The pulse.
    pub pulse: Pulse,
    /// A reset or the supply cut it short.
    pub cut: bool,
    /// Interrupts were held up when it ought to have ended.
    pub held_up: bool,
}

/// A servo's first pulse after it had none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Begin {
    /// The servo, 0 to 3.
    pub servo: usize,
    /// The pulse.
    pub pulse: Pulse,
    /// Whether a reset or the supply has cut it.
    pub cut: bool,
    /// The servo's last whole pulse before it.
    pub before: Option<Pulse>,
}

/// All that was seen, and done.
#[derive(Debug)]
pub struct Record {
    /// Edges of all pins.
    pub edges: Vec<Edge>,
    /// The pulses of A1 to A4.
    pub pulses: [Vec<Seen>; 4],
    /// What the board has said.
    pub lines: Vec<Line>,
    /// What it was asked, in order.
    pub exchanges: Vec<Exchange>,
    /// What has come to it, waited for or not.
    pub heard: Vec<Heard>,
    /// When each byte has come.
    pub bytes: Vec<u64>,
    /// Every start of the program.
    pub starts: Vec<Reset>,
    /// Every write of the EEPROM.
    pub written: Vec<EepromOperation>,
    /// The supply in mV, from a cycle on.
    pub supply: Vec<(u64, f64)>,
    /// When main was stalled.
    pub stalls: Vec<Span>,
    /// When interrupts were held up.
    pub holds: Vec<Span>,
    /// When RESET was pulled, or the supply fell below the brown-out level or was taken
    /// away.
    pub cuts: Vec<u64>,
    /// The last cycle.
    pub end: u64,
    /// What became of the board.
    pub state: State,
}

impl Default for Record {
    fn default() -> Self {
        Self {
            edges: Vec::new(),
            pulses: [const { Vec::new() }; 4],
            lines: Vec::new(),
            exchanges: Vec::new(),
            heard: Vec::new(),
            bytes: Vec::new(),
            starts: Vec::new(),
            written: Vec::new(),
            supply: Vec::new(),
            stalls: Vec::new(),
            holds: Vec::new(),
            cuts: Vec::new(),
            end: 0,
            state: State::Alive,
        }
    }
}

/// A servo without a pulse for longer has none: four frames.
const GONE: u64 = 75 * MS;

impl Record {
    /// Finds the servos' pulses among the edges.
    pub(super) fn see_pulses(&mut self, pins: [Pin; 4]) {
        // Within these a reset has taken the pins back.
        const AT_ONCE: u64 = MS / 10;
        self.pulses = pins.map(|pin| {
            let pulses = pulses(&self.edges, pin).into_iter();
            let seen = pulses.map(|pulse| {
                let end = pulse.start + pulse.width;
                let cut = |at: &u64| {
                    (*at..*at + AT_ONCE).contains(&end) || (pulse.start..end).contains(at)
                };
                let held = |hold: &Span| hold.overlaps(pulse.start, end + MS);
                Seen {
                    pulse,
                    cut: self.cuts.iter().any(cut),
                    held_up: self.holds.iter().any(held),
                }
            });
            seen.collect()
        });
    }

    /// Every beginning of a servo's pulses, in order of time.
    #[must_use]
    pub fn begins(&self) -> Vec<Begin> {
        let mut begins = Vec::new();
        for (servo, seen) in self.pulses.iter().enumerate() {
            let mut last: Option<Pulse> = None;
            let mut whole = None;
            for Seen { pulse, cut, .. } in seen {
                if last.is_none_or(|last| pulse.start - last.start > GONE) {
                    begins.push(Begin {
                        servo,
                        pulse: *pulse,
                        cut: *cut,
                        before: whole,
                    });
                }
                last = Some(*pulse);
                if !cut {
                    whole = last;
                }
            }
        }
        begins.sort_by_key(|begin| begin.pulse.start);
        begins
    }

    /// The times in which no servo had a pulse for longer than `least`, each from the
    /// end of the last pulse to the start of the next, or to the end of it all.
    #[must_use]
    pub fn silences(&self, least: u64) -> Vec<Span> {
        let mut all: Vec<Pulse> = self
            .pulses
            .iter()
            .flatten()
            .map(|seen| seen.pulse)
            .collect();
        all.sort_by_key(|pulse| pulse.start);
        let ends = all.iter().map(|pulse| pulse.start + pulse.width);
        let starts = all
            .iter()
            .skip(1)
            .map(|pulse| pulse.start)
            .chain([self.end]);
        let spans = ends.zip(starts).map(|(start, end)| Span { start, end });
        spans.filter(|span| span.end > span.start + least).collect()
    }

    /// Whether a servo's pulse begins in `start..end`.
    #[must_use]
    pub fn has_pulses(&self, start: u64, end: u64) -> bool {
        (0..4).any(|servo| self.servo_has_pulses(servo, start, end))
    }

    /// The same of one servo.
    #[must_use]
    pub fn servo_has_pulses(&self, servo: usize, start: u64, end: u64) -> bool {
        let pulses = &self.pulses[servo];
        let first = pulses.partition_point(|seen| seen.pulse.start < start);
        pulses.get(first).is_some_and(|seen| seen.pulse.start < end)
    }

    /// The starts of the program in `start..end`.
    pub fn starts_in(&self, start: u64, end: u64) -> impl Iterator<Item = &Reset> {
        let inside = move |reset: &&Reset| (start..end).contains(&reset.cycle);
        self.starts.iter().filter(inside)
    }

    /// The latest start of the program before a cycle.
    #[must_use]
    pub fn start_before(&self, cycle: u64) -> Option<&Reset> {
        self.starts.iter().rev().find(|start| start.cycle <= cycle)
    }

    /// Whether main was stalled, or interrupts held up, in `start..end`.
    #[must_use]
    pub fn is_disturbed(&self, start: u64, end: u64) -> bool {
        let mut all = self.stalls.iter().chain(&self.holds);
        all.any(|span| span.overlaps(start, end))
    }

    /// For how long the supply was below `mv` in `start..end`, cycles.
    #[must_use]
    pub fn low_for(&self, mv: f64, start: u64, end: u64) -> u64 {
        let ends = self
            .supply
            .iter()
            .skip(1)
            .map(|(at, _)| *at)
            .chain([u64::MAX]);
        let pieces = self.supply.iter().zip(ends);
        let low = pieces.filter(|((_, volts), _)| *volts < mv);
        low.map(|((at, _), until)| until.min(end).saturating_sub((*at).max(start)))
            .sum()
    }

    /// The lines to the board that tell it to move or to rest, with what became of
    /// each: `Some(true)` it was done, `Some(false)` refused, `None` unknown.
    pub fn orders(&self) -> impl Iterator<Item = (&Heard, Option<bool>)> {
        self.heard
            .iter()
            .filter(|heard| heard.is_order())
            .map(|heard| {
                let asked = |exchange: &&Exchange| {
                    exchange.line == heard.text && exchange.asked <= heard.cycle
                };
                let exchange = self.exchanges.iter().rev().find(asked);
                // Within a line's length.
                let exchange = exchange.filter(|one| heard.cycle - one.asked < 10 * MS);
                let answer = exchange.and_then(|exchange| exchange.answer.as_ref());
                let done = answer.and_then(|answer| match answer.text.get(..3)? {
                    "ok " => Some(true),
                    "err" => Some(false),
                    _ => None,
                });
                (heard, done.or_else(|| self.is_confirmed(heard)))
            })
    }

    /// `Some(true)` if the `ok` to a line that nobody waited for came soon.
    fn is_confirmed(&self, heard: &Heard) -> Option<bool> {
        let soon = heard.cycle..heard.cycle + 300 * MS;
        let ok = format!("ok {}", heard.text);
        let mut lines = self.lines.iter();
        let said = lines.any(|line| soon.contains(&line.cycle) && line.text == ok);
        said.then_some(true)
    }

    /// Whether an order that may have been done came in `start..end`.
    #[must_use]
    pub fn was_ordered(&self, start: u64, end: u64) -> bool {
        let mut orders = self.orders();
        orders.any(|(heard, done)| done != Some(false) && (start..end).contains(&heard.cycle))
    }

    /// Whether the last start lost what RAM held.
    #[must_use]
    pub fn lost_power(&self, start: u64, end: u64) -> bool {
        let lost = |reset: &Reset| reset.cause == ResetCause::PowerOn;
        self.starts_in(start, end).any(lost)
    }
}
