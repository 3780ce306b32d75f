//! The pulse engine: its variables, and the planning of the slots. The functions that access registers are in
//! `registers`.

use crate::cells::{SharedByte, SharedCounter, SharedWord};
#[cfg(any(test, target_arch = "avr"))]
use crate::timing::MIN_WIDTH_CYCLES;
use crate::timing::{LEAD_CYCLES, max_width_cycles};

/// The pulse generator for `SERVO_COUNT` servos, with references to the variables that [`engine!`](crate::engine)
/// defines. `SIZE`, the length of the tables, is `SERVO_COUNT` rounded up to a power of two.
#[derive(Clone, Copy)]
pub struct Engine<'a, const SERVO_COUNT: usize, const SIZE: usize> {
    #[doc(hidden)]
    /// The address of the PORT register and the mask of each slot's pin; zeros, no pin, until [`Engine::connect`].
    pub pins: &'a [[SharedByte; 2]; SIZE],
    #[doc(hidden)]
    /// Two frames of pulse widths in cycles: one is played while main fills the other.
    pub frames: &'a [[SharedWord; SIZE]; 2],
    #[doc(hidden)]
    /// The index of the frame that is played. Only TIMER1_COMPB changes it, and only while `has_new_frame` is 1.
    pub played_frame: &'a SharedByte,
    #[doc(hidden)]
    /// 1 while the other frame is complete and waits to be taken over. Main sets this byte; TIMER1_COMPB clears it
    /// when taking the frame over, and main clears it to withdraw the frame.
    pub has_new_frame: &'a SharedByte,
    #[doc(hidden)]
    /// The plan: the number of the current slot or, between slots, of the next slot. The engine starts in the tick's
    /// slot, so that main can begin at once. TIMER1_COMPB writes the plan, which consists of `slot`, `port`, `mask` and
    /// `fall_count`; TIMER1_COMPA removes a pulse whose rising edge is late.
    pub slot: &'a SharedByte,
    #[doc(hidden)]
    /// The plan: the address of the pin's PORT register.
    pub port: &'a SharedByte,
    #[doc(hidden)]
    /// The plan: the pin's bit in its PORT register; 0 for no pulse.
    pub mask: &'a SharedByte,
    #[doc(hidden)]
    /// The plan: the timer count of the falling edge.
    pub fall_count: &'a SharedWord,
    #[doc(hidden)]
    /// The bits of a port that may go high: all, or none after [`Engine::suppress_pulses`].
    pub allowed_pins: &'a SharedByte,
    #[doc(hidden)]
    /// The number of ticks so far, modulo 256; written only by TIMER1_COMPA.
    pub ticks: &'a SharedByte,
    #[doc(hidden)]
    /// The number of late edges, counted in both handlers.
    pub late_edges: &'a SharedCounter,
}

impl<const SERVO_COUNT: usize, const SIZE: usize> Engine<'_, SERVO_COUNT, SIZE> {
    /// The number of the slot without a pin.
    #[cfg(any(test, target_arch = "avr"))]
    const TICK_SLOT: u8 = SERVO_COUNT as u8;
    /// The timer count at which a slot without a pulse closes, which is as late as possible, so that the tick's slot
    /// gives main the longest time.
    const CLOSE_COUNT: u16 = max_width_cycles(SERVO_COUNT);
    /// The value of `fall_count` in a slot without a pulse.
    #[doc(hidden)]
    pub const NO_PULSE_COUNT: u16 = Self::CLOSE_COUNT + LEAD_CYCLES as u16;

    /// Submits the widths of the next frame, in CPU cycles of 62.5 ns and in the order of the pins, as `u16` or as a
    /// type that converts to it.
    ///
    /// The engine takes over all widths together, before the next frame's first slot opens. If another frame is
    /// submitted before that, it replaces the waiting frame, see [`Engine::is_taken`]. If no frame is submitted, the
    /// last widths repeat. A width of 0, or a width that does not fit into a slot, results in no pulse, see
    /// [`MIN_WIDTH_CYCLES`](crate::MIN_WIDTH_CYCLES) and [`max_width_cycles`](crate::max_width_cycles).
    #[inline(always)]
    pub fn submit<W: Into<u16>>(&self, widths: [W; SERVO_COUNT]) {
        // Withdraws a frame that has not been played. Until the end of this function TIMER1_COMPB does not
        // change `played_frame`, so the frame being filled cannot be played.
        self.has_new_frame.set(0);
        let frame = &self.frames[usize::from(self.played_frame.get() & 1 ^ 1)];
        for (stored_width, width) in frame.iter().zip(widths) {
            stored_width.set(width.into());
        }
        self.has_new_frame.set(1);
    }

    /// True if the last submitted frame, if any, has been taken over.
    ///
    /// Call this function at every tick. False means that main submitted the frame late, so the frame waits for the end
    /// of this tick's slot: a frame submitted now would replace the waiting frame, and a servo would jump. If the
    /// result is true at least at every second tick, both handlers are running, because one counts the ticks and the
    /// other takes the frames over.
    #[inline(always)]
    pub fn is_taken(&self) -> bool {
        self.has_new_frame.get() == 0
    }

    /// Prevents all further pulses; a pulse in progress ends as planned, within its slot. Call this function before a
    /// reset of the board, which would shorten the pulse and so drive the servo to its end stop. The ticks continue.
    /// The function makes a single store, so it may be called anywhere, even in an interrupt handler; only a reset
    /// undoes it.
    #[inline(always)]
    pub fn suppress_pulses(&self) {
        self.allowed_pins.set(0);
    }

    /// The number of ticks since the start, modulo 256. A tick occurs once per frame, one slot before the next frame's
    /// first pulse.
    #[inline(always)]
    pub fn ticks(&self) -> u8 {
        self.ticks.get()
    }

    /// Returns the servo and the pulse width of a slot; `None` if the slot has no pulse: the tick's slot, or a width
    /// out of range.
    #[cfg(any(test, target_arch = "avr"))]
    #[inline(always)]
    fn planned_pulse(&self, slot: u8) -> Option<(usize, u16)> {
        let servo = usize::from(slot) & (SIZE - 1);
        let width = self.frames[usize::from(self.played_frame.get() & 1)][servo].get();
        // The width is checked immediately before its use.
        let is_in_range = MIN_WIDTH_CYCLES <= width && width <= Self::CLOSE_COUNT;
        (slot != Self::TICK_SLOT && is_in_range).then_some((servo, width))
    }

    /// Plans the next slot. Called when a slot closes.
    #[cfg(any(test, target_arch = "avr"))]
    #[inline(always)]
    fn plan_next_slot(&self) {
        let slot = match self.slot.get() {
            slot if slot == Self::TICK_SLOT => {
                if self.has_new_frame.get() != 0 {
                    self.played_frame.set(self.played_frame.get() ^ 1);
                    self.has_new_frame.set(0);
                }
                0
            }
            slot => slot + 1,
        };
        self.slot.set(slot);
        match self.planned_pulse(slot) {
            None => {
                self.mask.set(0);
                self.fall_count.set(Self::NO_PULSE_COUNT);
            }
            Some((servo, width)) => {
                let [port, mask] = &self.pins[servo];
                self.port.set(port.get());
                self.mask.set(mask.get());
                self.fall_count.set(width + u16::from(LEAD_CYCLES));
            }
        }
    }
}

#[cfg(any(doc, target_arch = "avr"))]
mod registers;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::timing::slot_cycles;

    /// The engine's variables, as `engine!` defines them.
    struct Variables<const SIZE: usize> {
        pins: [[SharedByte; 2]; SIZE],
        frames: [[SharedWord; SIZE]; 2],
        bytes: [SharedByte; 7],
        fall_count: SharedWord,
        late_edges: SharedCounter,
    }

    impl<const SIZE: usize> Variables<SIZE> {
        fn with_servos<const SERVO_COUNT: usize>() -> Self {
            let bytes = [const { SharedByte::new(0) }; 7];
            bytes[0].set(SERVO_COUNT as u8); // the tick's slot
            let mut pins = [const { [const { SharedByte::new(0) }; 2] }; SIZE];
            for (servo, pin) in pins.iter_mut().enumerate().take(SERVO_COUNT) {
                *pin = [SharedByte::new(0x25), SharedByte::new(servo as u8 + 1)];
            }
            Self {
                pins,
                frames: [const { [const { SharedWord::new(0) }; SIZE] }; 2],
                bytes,
                fall_count: SharedWord::new(0),
                late_edges: SharedCounter::new(),
            }
        }

        fn engine<const SERVO_COUNT: usize>(&self) -> Engine<'_, SERVO_COUNT, SIZE> {
            let [
                slot,
                played_frame,
                has_new_frame,
                port,
                mask,
                allowed_pins,
                ticks,
            ] = &self.bytes;
            Engine {
                pins: &self.pins,
                frames: &self.frames,
                played_frame,
                has_new_frame,
                slot,
                port,
                mask,
                fall_count: &self.fall_count,
                allowed_pins,
                ticks,
                late_edges: &self.late_edges,
            }
        }
    }

    /// Plans each slot of a frame. Returns the plans: slot, mask, and count of the falling edge.
    fn plan_frame<const SERVO_COUNT: usize, const SIZE: usize>(
        engine: &Engine<'_, SERVO_COUNT, SIZE>,
    ) -> [(u8, u8, u16); 9] {
        let mut plans = [(0, 0, 0); 9];
        for plan in &mut plans[..=SERVO_COUNT] {
            engine.plan_next_slot();
            let fall_count = engine.fall_count.get();
            *plan = (engine.slot.get(), engine.mask.get(), fall_count);
        }
        plans
    }

    fn assert_each_servo_has_its_slot<const SERVO_COUNT: usize, const SIZE: usize>() {
        let variables = Variables::<SIZE>::with_servos::<SERVO_COUNT>();
        let engine = variables.engine::<SERVO_COUNT>();
        let mut widths = [0; SERVO_COUNT];
        for (servo, width) in widths.iter_mut().enumerate() {
            *width = 24_000 + servo as u16;
        }
        assert!(engine.is_taken(), "a frame waits before any was submitted");
        engine.submit(widths);
        assert!(!engine.is_taken(), "the first frame does not wait");
        for frame in 0..3 {
            let plans = plan_frame(&engine);
            for (servo, plan) in plans.into_iter().enumerate().take(SERVO_COUNT) {
                let fall_count = 24_000 + servo as u16 + u16::from(LEAD_CYCLES);
                let expected_plan = (servo as u8, servo as u8 + 1, fall_count);
                assert_eq!(plan, expected_plan, "{SERVO_COUNT} servos, frame {frame}");
            }
            let close_count = slot_cycles(SERVO_COUNT) - 1_000 + u16::from(LEAD_CYCLES);
            let plan_without_pulse = (SERVO_COUNT as u8, 0, close_count);
            assert_eq!(plans[SERVO_COUNT], plan_without_pulse, "the tick's slot");
        }
        assert!(engine.is_taken());
    }

    #[test]
    fn each_of_one_to_eight_servos_has_its_slot_before_the_ticks_slot() {
        assert_each_servo_has_its_slot::<1, 1>();
        assert_each_servo_has_its_slot::<2, 2>();
        assert_each_servo_has_its_slot::<3, 4>();
        assert_each_servo_has_its_slot::<4, 4>();
        assert_each_servo_has_its_slot::<5, 8>();
        assert_each_servo_has_its_slot::<6, 8>();
        assert_each_servo_has_its_slot::<7, 8>();
        assert_each_servo_has_its_slot::<8, 8>();
    }

    #[test]
    fn a_width_too_short_or_too_long_for_a_slot_results_in_no_pulse() {
        let variables = Variables::<8>::with_servos::<6>();
        let engine = variables.engine::<6>();
        let max_cycles = max_width_cycles(6);
        engine.submit([0, 999, 1_000, max_cycles, max_cycles + 1, u16::MAX]);
        let masks = plan_frame(&engine).map(|(_, mask, _)| mask);
        assert_eq!(masks[..7], [0, 0, 3, 4, 0, 0, 0]);
    }

    #[test]
    fn a_submitted_frame_is_played_from_its_first_slot_on() {
        let variables = Variables::<4>::with_servos::<4>();
        let engine = variables.engine::<4>();
        engine.submit([20_000u16; 4]);
        engine.plan_next_slot();
        engine.plan_next_slot();
        engine.submit([30_000u16; 4]);
        engine.plan_next_slot();
        let fall_count = engine.fall_count.get();
        assert_eq!(fall_count, 20_220, "the played frame has changed");
        engine.plan_next_slot();
        engine.plan_next_slot();
        assert_eq!(engine.mask.get(), 0, "the tick's slot");
        engine.plan_next_slot();
        assert_eq!(engine.fall_count.get(), 30_220, "new frame's first slot");
    }
}
