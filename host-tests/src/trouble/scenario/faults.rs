//! The random faults that scenarios inject.

use super::{Activity, MS, Script, Step, random_commands};

impl Script<'_> {
    /// Adds a fault of a random kind and waits until the fault has ended. In one of four cases, a contact closes first.
    pub(super) fn add_fault(&mut self, activity: Activity) {
        if self.rng.u8(0..4) == 0 {
            self.press_random_input();
        }
        match self.rng.u8(0..100) {
            0..50 => self.add_stall(),
            50..54 => {
                self.add_stall();
                self.wait_up_to(60);
                self.add_stall();
            }
            54..64 => self.steps.push(Step::Reset),
            64..72 => {
                self.steps.push(Step::Reset);
                self.wait_up_to(5);
                self.steps.push(Step::Reset);
            }
            72..80 => self.add_dip(),
            80..84 => self.add_sag(),
            84 | 85 => self.add_low_supply(),
            86..92 => self.add_fault_during_stall(),
            92 => self.add_adjustment(),
            93 => {
                let cycles = self.rng.u64(100..20_000);
                self.steps.push(Step::BlockInterrupts(cycles));
                self.wait(40);
            }
            94 => self.steps.push(Step::PowerCycle),
            95 => self.add_two_faults(),
            _ => self.add_weak_supply(activity),
        }
    }

    /// Stalls the main loop for 1 to 300 ms and waits until the stall ends. The watchdog may end it after 250 ms.
    fn add_stall(&mut self) {
        let cycles = self.rng.u64(MS..300 * MS);
        self.steps.extend([Step::Stall(cycles), Step::Wait(cycles)]);
    }

    /// Lowers the supply for a while, sometimes below the minimum voltage of the chip or of its RAM.
    fn add_dip(&mut self) {
        let mv = match self.rng.u8(0..8) {
            0 => self.rng.u16(500..1_250),
            1..4 => self.rng.u16(1_900..2_650),
            _ => self.rng.u16(2_800..4_600),
        };
        let ms = *self.rng.choice(&[5, 60, 400]).unwrap_or(&5);
        self.steps.push(Step::Supply(mv));
        self.wait_up_to(ms);
        self.steps.push(Step::Supply(5_000));
    }

    /// Returns the minimum supply voltages for EEPROM writes, motions and pulses, mV.
    fn supply_levels_mv(&self) -> [u16; 3] {
        let board = self.robot.supplies().board_thresholds;
        board.map(|volts| (1_000.0 * volts) as u16)
    }

    /// Lowers the supply for a while, then briefly to a second, usually lower level, and restores the supply.
    fn add_sag(&mut self) {
        let [slow_mv, stop_mv, rest_mv] = self.supply_levels_mv();
        let first_mv = self.rng.u16(stop_mv - 50..slow_mv + 50);
        let second_mv = self.rng.u16(rest_mv - 400..stop_mv);
        self.steps.push(Step::Supply(first_mv));
        // The firmware usually needs one or two readings to notice the first level.
        self.wait(50);
        self.wait_up_to(100);
        self.steps.push(Step::Supply(second_mv));
        self.wait_up_to(60);
        self.steps.push(Step::Supply(5_000));
    }

    /// Lowers the supply for a long time to a level that allows motions but no EEPROM writes, and commands both.
    fn add_low_supply(&mut self) {
        let [slow_mv, stop_mv, _] = self.supply_levels_mv();
        let mv = self.rng.u16(stop_mv + 50..slow_mv - 50);
        self.steps.push(Step::Supply(mv));
        self.wait(250);
        for line in ["rest", "stand", "save"] {
            self.wait_up_to(200);
            self.say(line);
        }
        self.wait(100);
        self.steps.push(Step::Supply(5_000));
    }

    /// Stalls the main loop, and adds a reset or a drop of the supply during the stall.
    fn add_fault_during_stall(&mut self) {
        let ms = self.rng.u64(20..300);
        self.steps.push(Step::Stall(ms * MS));
        self.wait_up_to(ms);
        match self.rng.u8(0..3) {
            0 => self.steps.push(Step::Reset),
            1 => self.add_dip(),
            _ => self.add_sag(),
        }
        self.wait(ms);
    }

    /// Changes settings while the robot moves.
    fn add_adjustment(&mut self) {
        let gait = self.random_gait();
        self.send(gait);
        for _ in 0..6 {
            self.wait_up_to(700);
            let line = random_commands::random_adjustment(self.rng);
            self.send(line);
        }
        self.wait(700);
    }

    /// Adds a stall that the watchdog ends, then a long time with a low supply.
    fn add_two_faults(&mut self) {
        self.steps.push(Step::Stall(300 * MS));
        self.wait(300);
        self.wait_up_to(2_000);
        let mv = self.supply_levels_mv()[1] - 100;
        self.steps.push(Step::Supply(mv));
        self.wait(5_000);
        self.say("status");
        self.steps.push(Step::Supply(5_000));
    }

    /// Connects a supply that falls whenever three servos have pulses, for long enough to detect a robot that restarts
    /// its servos again and again. A command or a reset starts the servos.
    fn add_weak_supply(&mut self, activity: Activity) {
        self.steps.push(Step::WeakSupply(true));
        match activity {
            Activity::Resting => self.send("stand"),
            Activity::Waking | Activity::Starting => {}
            _ => self.steps.push(Step::Reset),
        }
        self.wait(6_000);
        self.say("status");
        self.steps.push(Step::WeakSupply(false));
    }
}
