//! The pulse engine: the interrupt handlers that open and close the slots.

use crate::cells::{Byte, Counter, Word};
#[cfg(any(test, target_arch = "avr"))]
use crate::timing::MIN_WIDTH;
use crate::timing::{LEAD, max_width};

/// The pulse generator for `SERVOS` servos. It refers to the variables that [`engine!`](crate::engine) defines.
/// `SIZE` is `SERVOS` rounded up to a power of two.
#[derive(Clone, Copy)]
pub struct Engine<'a, const SERVOS: usize, const SIZE: usize> {
    #[doc(hidden)]
    /// Ports and masks of the pins, by slot. They are zero, which is no pin, until [`Engine::connect`].
    pub pins: &'a [[Byte; 2]; SIZE],
    #[doc(hidden)]
    /// Two frames of pulse widths: one is played while main fills the other.
    pub frames: &'a [[Word; SIZE]; 2],
    #[doc(hidden)]
    /// The index of the frame that is played. Only the handler changes it, and only while `fresh` is set.
    pub playing: &'a Byte,
    #[doc(hidden)]
    /// 1 while the other frame is complete and waits to be taken over. Main sets it. The handler clears it when it
    /// takes the frame over, and main clears it to withdraw the frame.
    pub fresh: &'a Byte,
    #[doc(hidden)]
    /// The plan: the number of the current slot or, between slots, of the next one. It starts with the tick's slot,
    /// so that main starts at once. TIMER1_COMPB writes the plan; TIMER1_COMPA removes a pulse from it whose rising
    /// edge is late.
    pub slot: &'a Byte,
    #[doc(hidden)]
    /// The plan: the port of the pin.
    pub port: &'a Byte,
    #[doc(hidden)]
    /// The plan: the bit of the pin, 0 for no pulse.
    pub mask: &'a Byte,
    #[doc(hidden)]
    /// The plan: the timer count at which the falling edge is due.
    pub fall: &'a Word,
    #[doc(hidden)]
    /// The pins that may go high: all, or none after [`Engine::hush`].
    pub allowed: &'a Byte,
    #[doc(hidden)]
    /// The ticks so far, modulo 256; written only by TIMER1_COMPA.
    pub ticks: &'a Byte,
    #[doc(hidden)]
    /// The number of late edges, counted in both handlers.
    pub late: &'a Counter,
}

impl<const SERVOS: usize, const SIZE: usize> Engine<'_, SERVOS, SIZE> {
    /// The number of the slot without a pin.
    #[cfg(any(test, target_arch = "avr"))]
    const TICK_SLOT: u8 = SERVOS as u8;
    /// The count at which a slot without a pulse closes. It is as late as possible, so that main has the longest
    /// time in the tick's slot.
    const CLOSE: u16 = max_width(SERVOS);
    /// The count of the falling edge in a slot without a pulse.
    #[doc(hidden)]
    pub const NO_PULSE: u16 = Self::CLOSE + LEAD as u16;

    /// Submits the widths of the next frame, in CPU cycles of 62.5 ns, in the order of the pins; as `u16` or as a
    /// type that converts into it.
    ///
    /// The engine takes them over together before the first slot opens. A second call before that replaces the
    /// first, which is then never played: see [`Engine::is_taken`]. Without a new frame, the last widths repeat. A
    /// width of 0, or one that does not fit into a slot, gives no pulse: see [`MIN_WIDTH`](crate::MIN_WIDTH) and
    /// [`max_width`](crate::max_width).
    #[inline(always)]
    pub fn submit<W: Into<u16>>(&self, widths: [W; SERVOS]) {
        // Withdraws a frame that has not been played. Until the end of this function the handler does not change
        // `playing`, so the frame that is being filled cannot start to play.
        self.fresh.set(0);
        let frame = &self.frames[usize::from(self.playing.get() & 1 ^ 1)];
        for (slot, width) in frame.iter().zip(widths) {
            slot.set(width.into());
        }
        self.fresh.set(1);
    }

    /// True if the last submitted frame, if any, has been taken over.
    ///
    /// Check it at every tick. False means that main submitted the frame so late that it waits for the end of this
    /// tick's slot: then submit no new frame for this tick, if a servo must not jump. If it is true at least at
    /// every second tick, both handlers run, since one gives the tick and the other takes the frame over.
    #[inline(always)]
    pub fn is_taken(&self) -> bool {
        self.fresh.get() == 0
    }

    /// Prevents all further pulses; one in progress ends as planned, within its slot. Call it before you reset the
    /// board, which would cut the pulse short and so drive the servo to its end stop. The tick continues. It is a
    /// single store, so it may be called anywhere, even in an interrupt handler; only a reset undoes it.
    #[inline(always)]
    pub fn hush(&self) {
        self.allowed.set(0);
    }

    /// Frames since the start, modulo 256. It is incremented once per frame, one slot before the next frame's first
    /// pulse.
    #[inline(always)]
    pub fn ticks(&self) -> u8 {
        self.ticks.get()
    }

    /// The servo and the pulse width of a slot; `None` if the slot has no pulse: the tick's slot, or a width out of
    /// range.
    #[cfg(any(test, target_arch = "avr"))]
    #[inline(always)]
    fn planned_pulse(&self, slot: u8) -> Option<(usize, u16)> {
        let servo = usize::from(slot) & (SIZE - 1);
        let width = self.frames[usize::from(self.playing.get() & 1)][servo].get();
        // Checked here, immediately before use.
        let is_in_range = MIN_WIDTH <= width && width <= Self::CLOSE;
        (slot != Self::TICK_SLOT && is_in_range).then_some((servo, width))
    }

    /// Plans the next slot. Called when a slot closes.
    #[cfg(any(test, target_arch = "avr"))]
    #[inline(always)]
    fn plan(&self) {
        let slot = match self.slot.get() {
            slot if slot == Self::TICK_SLOT => {
                if self.fresh.get() != 0 {
                    self.playing.set(self.playing.get() ^ 1);
                    self.fresh.set(0);
                }
                0
            }
            slot => slot + 1,
        };
        self.slot.set(slot);
        match self.planned_pulse(slot) {
            None => {
                self.mask.set(0);
                self.fall.set(Self::NO_PULSE);
            }
            Some((servo, width)) => {
                let [port, mask] = &self.pins[servo];
                self.port.set(port.get());
                self.mask.set(mask.get());
                self.fall.set(width + u16::from(LEAD));
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
        pins: [[Byte; 2]; SIZE],
        frames: [[Word; SIZE]; 2],
        bytes: [Byte; 7],
        fall: Word,
        late: Counter,
    }

    impl<const SIZE: usize> Variables<SIZE> {
        fn of<const SERVOS: usize>() -> Self {
            let bytes = [const { Byte::new(0) }; 7];
            bytes[0].set(SERVOS as u8); // the slot of the tick
            let mut pins = [const { [const { Byte::new(0) }; 2] }; SIZE];
            for (servo, pin) in pins.iter_mut().enumerate().take(SERVOS) {
                *pin = [Byte::new(0x25), Byte::new(servo as u8 + 1)];
            }
            Self {
                pins,
                frames: [const { [const { Word::new(0) }; SIZE] }; 2],
                bytes,
                fall: Word::new(0),
                late: Counter::new(),
            }
        }

        fn engine<const SERVOS: usize>(&self) -> Engine<'_, SERVOS, SIZE> {
            let [slot, playing, fresh, port, mask, allowed, ticks] = &self.bytes;
            Engine {
                pins: &self.pins,
                frames: &self.frames,
                playing,
                fresh,
                slot,
                port,
                mask,
                fall: &self.fall,
                allowed,
                ticks,
                late: &self.late,
            }
        }
    }

    /// The plan of each slot of a frame: slot, mask and falling edge.
    fn plan_frame<const SERVOS: usize, const SIZE: usize>(
        engine: &Engine<'_, SERVOS, SIZE>,
    ) -> [(u8, u8, u16); 9] {
        let mut slots = [(0, 0, 0); 9];
        for slot in &mut slots[..=SERVOS] {
            engine.plan();
            *slot = (engine.slot.get(), engine.mask.get(), engine.fall.get());
        }
        slots
    }

    fn every_servo_has_its_slot<const SERVOS: usize, const SIZE: usize>() {
        let variables = Variables::<SIZE>::of::<SERVOS>();
        let engine = variables.engine::<SERVOS>();
        let mut widths = [0; SERVOS];
        for (servo, width) in widths.iter_mut().enumerate() {
            *width = 24_000 + servo as u16;
        }
        assert!(engine.is_taken(), "nothing waits before the first");
        engine.submit(widths);
        assert!(!engine.is_taken(), "and the first has not been taken");
        for frames in 0..3 {
            let slots = plan_frame(&engine);
            for (servo, slot) in slots.into_iter().enumerate().take(SERVOS) {
                let fall = 24_000 + servo as u16 + u16::from(LEAD);
                let expected = (servo as u8, servo as u8 + 1, fall);
                assert_eq!(slot, expected, "{SERVOS} servos, frame {frames}");
            }
            let close_count = slot_cycles(SERVOS) - 1_000 + u16::from(LEAD);
            assert_eq!(
                slots[SERVOS],
                (SERVOS as u8, 0, close_count),
                "the tick has no pin"
            );
        }
        assert!(engine.is_taken());
    }

    #[test]
    fn one_to_eight_servos_have_their_slots_and_then_the_tick() {
        every_servo_has_its_slot::<1, 1>();
        every_servo_has_its_slot::<2, 2>();
        every_servo_has_its_slot::<3, 4>();
        every_servo_has_its_slot::<4, 4>();
        every_servo_has_its_slot::<5, 8>();
        every_servo_has_its_slot::<6, 8>();
        every_servo_has_its_slot::<7, 8>();
        every_servo_has_its_slot::<8, 8>();
    }

    #[test]
    fn a_width_too_long_for_a_slot_makes_no_pulse() {
        let variables = Variables::<8>::of::<6>();
        let engine = variables.engine::<6>();
        let max_cycles = max_width(6);
        engine.submit([0, 999, 1_000, max_cycles, max_cycles + 1, u16::MAX]);
        let masks = plan_frame(&engine).map(|(_, mask, _)| mask);
        assert_eq!(masks[..7], [0, 0, 3, 4, 0, 0, 0]);
    }

    #[test]
    fn a_frame_is_taken_over_whole_and_only_at_its_beginning() {
        let variables = Variables::<4>::of::<4>();
        let engine = variables.engine::<4>();
        engine.submit([20_000u16; 4]);
        engine.plan();
        engine.plan();
        engine.submit([30_000u16; 4]);
        engine.plan();
        assert_eq!(engine.fall.get(), 20_220, "the frame that plays stays");
        engine.plan();
        engine.plan();
        assert_eq!(engine.mask.get(), 0, "the tick");
        engine.plan();
        assert_eq!(
            engine.fall.get(),
            30_220,
            "the new one, from its first slot on"
        );
    }
}
