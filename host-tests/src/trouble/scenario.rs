//! Random scenarios: an activity, a fault at a random cycle of the activity, and final commands that check the robot.

mod faults;

use std::fmt;

use fastrand::Rng;
use lizard_core::numbers::rate::BaudRate;
use lizard_host::patrol::PATROL;
use lizard_robot::Robot;
use simulated_uno::RadioLink;

use super::activity::Activity;
use super::random_commands;
use super::record::MS;
use super::step::Step;

/// A pose that is always refused, because it is beyond the travel of A1 and A4.
pub(super) const REFUSED_POSE: &str = "pose 0 0 0 0";

/// A random scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// The seed of the series to which the scenario belongs.
    pub seed: u64,
    /// The scenario's number among the scenarios of the seed.
    pub number: u64,
    /// The robot's activity when the fault is injected.
    pub activity: Activity,
    /// True if a boot loader clears MCUSR, the chip's record of a reset's cause.
    pub has_boot_loader: bool,
    /// The steps from power-on, in order.
    pub steps: Vec<Step>,
}

impl fmt::Display for Scenario {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let article = if self.has_boot_loader { "a" } else { "no" };
        writeln!(
            f,
            "scenario {} of seed {} ({}, {article} boot loader), from power-on:",
            self.number, self.seed, self.activity
        )?;
        for step in &self.steps {
            writeln!(f, "  {step}")?;
        }
        Ok(())
    }
}

impl Scenario {
    /// Generates the scenario with this number among the scenarios of a seed.
    #[must_use]
    pub fn generate(seed: u64, number: u64, robot: &Robot) -> Self {
        let mut rng = Rng::with_seed(seed.wrapping_mul(1_000_003).wrapping_add(number));
        let activity = Activity::for_scenario(number);
        let mut script = Script {
            rng: &mut rng,
            robot,
            steps: Vec::new(),
            is_driven: false,
        };
        script.start_activity(activity);
        script.add_fault(activity);
        script.end_drive();
        script.add_final_checks();
        let steps = script.steps;
        Self {
            seed,
            number,
            activity,
            has_boot_loader: rng.bool(),
            steps,
        }
    }
}

/// A scenario under construction.
struct Script<'a> {
    rng: &'a mut Rng,
    robot: &'a Robot,
    steps: Vec<Step>,
    /// True while a person drives by radio. Lines are then sent without waiting for their answers, since the next
    /// answer may belong to a line sent by radio.
    is_driven: bool,
}

impl Script<'_> {
    fn say(&mut self, line: impl Into<String>) {
        let step = match self.is_driven {
            true => Step::Send,
            false => Step::Say,
        };
        self.steps.push(step(line.into()));
    }

    fn send(&mut self, line: impl Into<String>) {
        self.steps.push(Step::Send(line.into()));
    }

    fn wait(&mut self, ms: u64) {
        self.steps.push(Step::Wait(ms * MS));
    }

    /// Waits for a random number of cycles, less than `ms` milliseconds.
    fn wait_up_to(&mut self, ms: u64) {
        self.steps.push(Step::Wait(self.rng.u64(1..ms * MS)));
    }

    fn random_pose(&mut self) -> String {
        random_commands::random_pose(self.rng, self.robot)
    }

    fn say_random_gait(&mut self) {
        let gait = self.random_gait();
        self.say(gait);
    }

    fn random_gait(&mut self) -> String {
        random_commands::random_gait(self.rng, self.robot)
    }

    /// Starts an activity and waits until a random cycle during the activity.
    fn start_activity(&mut self, activity: Activity) {
        let is_at_power_on = activity == Activity::Starting && self.rng.u8(0..3) == 0;
        if !is_at_power_on {
            self.wait(600);
            self.steps
                .extend(random_commands::random_settings(self.rng, self.robot));
            if self.rng.bool() {
                let pose = self.random_pose();
                self.say(pose);
                self.wait(500);
            }
        }
        match activity {
            Activity::Resting => {
                self.say("rest");
                if self.rng.u8(0..4) == 0 {
                    self.wait(300);
                    self.say("rest");
                    self.wait(200);
                }
                self.wait_up_to(800);
            }
            Activity::Waking => {
                self.say("rest");
                self.wait(200);
                self.send("stand");
                self.wait_up_to(450);
            }
            Activity::Holding => {
                if self.rng.bool() {
                    self.say_random_gait();
                    self.wait_up_to(900);
                    self.say("stop");
                }
                self.wait_up_to(40);
            }
            Activity::Moving => {
                let pose = self.random_pose();
                self.send(pose);
                self.wait_up_to(250);
            }
            Activity::Cycling => {
                self.say_random_gait();
                self.wait_up_to(2_000);
            }
            Activity::Saving => self.start_saving(),
            Activity::Starting => self.restart_program(is_at_power_on),
            Activity::Answering => self.send_requests(),
            Activity::Patrolling => self.start_patrol(),
            Activity::Driven => self.start_drive(),
        }
    }

    /// Starts an EEPROM write with `rest` or `save`, in some cases while a gait runs.
    fn start_saving(&mut self) {
        match self.rng.u8(0..3) {
            0 => {
                self.send("rest");
                self.wait_up_to(120);
                return;
            }
            1 => {
                self.say_random_gait();
                self.wait_up_to(400);
            }
            _ => {}
        }
        let line = random_commands::random_trim(self.rng);
        self.say(line);
        self.wait(100);
        self.send("save");
        self.wait_up_to(250);
    }

    /// Restarts the program, unless the scenario is still at power-on, and waits for part of the start.
    fn restart_program(&mut self, is_at_power_on: bool) {
        if !is_at_power_on {
            match self.rng.u8(0..4) {
                0 => self.say("rest"),
                1 => self.say_random_gait(),
                _ => {}
            }
            self.wait_up_to(700);
            self.steps.push(match self.rng.u8(0..3) {
                0 => Step::PowerCycle,
                _ => Step::Reset,
            });
        }
        let ms = *self.rng.choice(&[5, 100, 500]).unwrap_or(&5);
        self.wait_up_to(ms);
    }

    /// Sends up to four lines without waiting for their answers, in some cases at rest or while a gait runs.
    fn send_requests(&mut self) {
        match self.rng.u8(0..3) {
            0 => self.say("rest"),
            1 => self.say_random_gait(),
            _ => {}
        }
        for _ in 0..self.rng.u8(1..5) {
            let lines = [
                "status",
                "help",
                "cal",
                "speed 50",
                "nonsense",
                "watch 1",
                REFUSED_POSE,
            ];
            let line = *self.rng.choice(&lines).unwrap_or(&"status");
            self.send(line);
        }
        self.wait_up_to(120);
    }

    /// Starts the patrol routine. In three cases of four, presses the button that the routine waits for. Then presses
    /// random inputs.
    fn start_patrol(&mut self) {
        self.say(PATROL);
        if self.rng.u8(0..4) > 0 {
            self.wait(150);
            for is_closed in [true, false] {
                let button = self.robot.inputs().button;
                self.steps
                    .extend(button.map(|pin| Step::Contact(pin, is_closed)));
                self.wait(100);
            }
        }
        for _ in 0..self.rng.u8(0..5) {
            self.wait_up_to(1_500);
            self.press_random_input();
        }
        self.wait_up_to(2_000);
    }

    /// Presses a random input for a random time, which may be too short to count, or until the end of the scenario.
    fn press_random_input(&mut self) {
        let inputs: Vec<(&str, u8)> = self.robot.inputs().named_pins().collect();
        let Some((_, pin)) = self.rng.choice(&inputs).copied() else {
            return;
        };
        self.steps.push(Step::Contact(pin, true));
        self.wait_up_to(200);
        if self.rng.u8(0..8) > 0 {
            self.steps.push(Step::Contact(pin, false));
        }
    }

    /// Lets a person start to drive by radio. In a quarter of these scenarios, noise comes first, as from a radio
    /// module without a phone.
    fn start_drive(&mut self) {
        if self.rng.u8(0..4) == 0 {
            self.add_noise();
        }
        let rate = self.rng.choice(&BaudRate::ALL);
        let rate = rate.unwrap_or(&BaudRate::Fastest);
        let link = RadioLink {
            baud: f64::from(rate.baud()),
            packet_loss: *self.rng.choice(&[0.0, 0.01, 0.1]).unwrap_or(&0.0),
            mean_link_ms: *self.rng.choice(&[0, 1_000, 4_000]).unwrap_or(&0),
            reports_link: self.rng.bool(),
            seed: self.rng.u64(..),
        };
        self.steps.push(Step::Drive(link));
        self.is_driven = true;
        self.continue_drive();
    }

    /// Lets the person continue to drive while the scenario sends lines by cable.
    fn continue_drive(&mut self) {
        for _ in 0..self.rng.u8(1..4) {
            self.wait_up_to(3_000);
            let gait = self.random_gait();
            let lines = [
                "status", "help", "cal", "speed 70", "nonsense", "stop", "watch 1", &gait, PATROL,
            ];
            let line = *self.rng.choice(&lines).unwrap_or(&"status");
            self.send(line);
            if self.rng.u8(0..3) == 0 {
                self.wait_up_to(300);
                self.press_random_input();
            }
        }
    }

    fn end_drive(&mut self) {
        if !self.is_driven {
            return;
        }
        self.continue_drive();
        self.wait_up_to(2_000);
        self.steps.push(Step::Leave);
        self.is_driven = false;
        self.wait(300);
        if self.rng.u8(0..4) == 0 {
            self.add_noise();
        }
    }

    /// Adds noise on the serial line for a random time, then a reset, as when a computer opens the port.
    fn add_noise(&mut self) {
        let cycles = self.rng.u64(MS..3_000 * MS);
        let noise = [Step::Noise(cycles), Step::Wait(cycles), Step::Reset];
        self.steps.extend(noise);
        self.wait(600);
    }

    /// Waits and asks for the status. Then sends four lines: one that the board must refuse, `walk`, `rest` and
    /// `stand`. Asks for the status after each.
    fn add_final_checks(&mut self) {
        // In one of four cases, waits long enough for the LED's fault pattern and for the gait after power-on.
        let wait_ms = match self.rng.u8(0..4) {
            0 => 5_500,
            _ => self.rng.u64(350..800),
        };
        self.wait(wait_ms);
        // Ends an incomplete line, left by a reset or by the end of a link, and makes it invalid.
        self.send("!");
        self.wait(150);
        self.steps.push(Step::AskUntilAnswered);
        self.say("status");
        let refused_lines = [
            REFUSED_POSE,
            "trim 1 90",
            "speed 5",
            "nonsense",
            "limit 2 1 2",
        ];
        let refused_line = *self.rng.choice(&refused_lines).unwrap_or(&"nonsense");
        self.say(refused_line);
        self.say("status");
        // A supply counts as good only one second after it has recovered.
        let changes_supply = |step: &Step| matches!(step, Step::Supply(_) | Step::WeakSupply(_));
        if self.steps.iter().any(changes_supply) {
            self.wait(1_300);
        }
        self.steps.push(Step::SayOrStand("walk".into()));
        self.wait(700);
        self.say("status");
        for (line, ms) in [("rest", 150), ("stand", 1_300)] {
            self.say(line);
            self.wait(ms);
            self.say("status");
        }
    }
}
