//! Checks of the rules about the robot's internal state and its future behaviour. A clone of the robot simulates the
//! future.

use lizard_core::console::command::effect;
use lizard_core::console::word::Effect;
use lizard_core::control::fault::Fault;
use lizard_core::guard::clearance::Clearance;
use lizard_core::memory::copies;
use lizard_core::motion::Activity;
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::part::Servo;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::robot::Robot;
use lizard_core::virtual_board::Eeprom;
use lizard_rules::{Event, Limits, Rule, Time};

use super::{FRAME, Verdict, World, violation};
use crate::fingerprint::coarse_fingerprint;

/// Tolerance for the rounding of a pulse's change from one frame to the next, cycles.
const ROUNDING_CYCLES: u16 = 2;

/// Number of frames within which any motion of this robot ends.
const MOTION_FRAMES: u32 = 160;

/// Lines that start a gait or a routine with a count. Even at half pace, the motion ends within [`MOTION_FRAMES`].
const COUNTED_MOTIONS: [&str; 3] = ["walk 1", "trot 2", "round 1"];

/// Number of frames after which a contact is certainly debounced.
const DEBOUNCE_FRAMES: u8 = 5;

/// Time in which the robot measures a new supply voltage often enough to react.
const SUPPLY_SETTLING_TIME: Time = 14 * FRAME;

/// Returns the observer's limits for a robot.
pub(super) fn observer_limits(robot: &Robot) -> Limits {
    let board = robot.supplies().board;
    Limits {
        width_ranges: Servo::ALL.map(|servo| {
            let calibration = robot.servo_calibration(servo);
            let ends = [calibration.travel_min, calibration.travel_max];
            let [first, last] = ends.map(|sweep| u32::from(calibration.width(sweep).0));
            (first.min(last), first.max(last))
        }),
        levels_mv: [board.slow_mv, board.stop_mv, board.rest_mv].map(u32::from),
        // With `true`, only the report of `boot`, which the console prints at once, permits its pulses.
        can_boot_to_rest: true,
        ..Limits::default()
    }
}

impl World {
    /// Checks an answer to a line.
    pub(super) fn check_answer(&mut self, line: &str, answer: &str) -> Verdict {
        let effect = effect(line, &self.robot());
        let is_accepted = answer.starts_with("ok ");
        let has_unnoticed_edge = self.has_unnoticed_edge();
        self.observer
            .observe_command(self.now, effect, Some(is_accepted));
        if is_accepted && effect == Effect::CalibrationChange {
            self.observe(Event::CalibrationChanged { is_saved: false });
        }
        self.observe(Event::Answer {
            line,
            effect,
            sent_at: self.now,
            answer,
        });
        if answer == "ok load" {
            self.check_loaded_limits()?;
        }
        let is_refused_for_supply = answer.starts_with("err 8");
        if is_refused_for_supply
            && !self.observer.was_supply_low(0, 70 * FRAME)
            && Time::from(self.running_robot.motion().frame_count()) * FRAME > SUPPLY_SETTLING_TIME
        {
            return violation(Rule::NoNeedlessRefusal, answer);
        }
        if is_accepted && effect == Effect::Motion {
            let is_stack_intact = self.running_robot.board.is_stack_intact;
            if has_unnoticed_edge {
                self.observe(Event::Fault);
            }
            if has_unnoticed_edge
                || self.is_supply_weak
                || self.observer.was_supply_low(0, 1)
                || self.observer.was_supply_low(1, SUPPLY_SETTLING_TIME)
            {
                self.observer.drop_pending_promises();
            } else if is_stack_intact {
                self.check_motion_begins(answer)?;
                if answer == "ok stand" {
                    self.check_robot_stands(answer)?;
                } else if COUNTED_MOTIONS.contains(&line) {
                    self.check_motion_ends(answer)?;
                }
            }
        }
        self.observer.take_verdict()
    }

    /// True if main has not noticed a late edge yet. Main notices an edge only after the pulses of its last frame, so
    /// the edge may stop the robot after a command.
    fn has_unnoticed_edge(&self) -> bool {
        let notices_in_next_frame = || {
            let mut future_robot = self.running_robot.clone();
            future_robot.run_without_reader(1);
            future_robot.main.control().fault() == Some(Fault::LateEdge)
        };
        self.running_robot.board.late_edges > 0
            && (self.observer.is_stop_unreported()
                || self.now - self.late_edge_at <= FRAME && notices_in_next_frame())
    }

    /// Checks the promises in the answers by running a clone until all promises are due.
    pub(super) fn check_promises(&mut self) -> Verdict {
        self.observer.take_verdict()?;
        if let Some(time) = self.observer.time_until_promises_due() {
            let mut future_world = self.clone();
            for _ in 0..=time / FRAME {
                future_world.run_frame()?;
            }
        }
        self.observer.drop_pending_promises();
        self.observer.take_verdict()
    }

    /// Checks that `limit` accepts all limits that `cal` prints.
    fn check_loaded_limits(&self) -> Verdict {
        let mut future_robot = self.running_robot.clone();
        future_robot.board.transmitter.text.clear();
        for line in future_robot.send(b"cal\r") {
            let tail = line.strip_prefix("# A");
            let Some((servo, rest)) = tail.and_then(|tail| tail.split_at_checked(1)) else {
                continue;
            };
            let (_, limits) = rest.split_once(" limit ").expect("cal prints the limits");
            let limits = limits.split_once(" dir ");
            let (limits, _) = limits.expect("the direction follows the limits");
            let answer = future_robot.send_line(&format!("limit {servo} {limits}"));
            if answer.starts_with("err ") {
                return violation(Rule::LoadedLimitsValid, answer);
            }
        }
        Ok(())
    }

    /// Closes or opens a contact. Unless a routine runs, also checks that the contact has no effect on the robot.
    pub(super) fn set_contact(&mut self, pin: u8, is_closed: bool) -> Verdict {
        let mut unchanged_robot = self.running_robot.clone();
        let other_contacts = self.running_robot.board.closed_pins & !(1 << pin);
        self.running_robot.board.closed_pins = other_contacts | u32::from(is_closed) << pin;
        let robot = self.robot();
        let activity = self.running_robot.main.control().activity();
        if matches!(activity, Activity::Gait(id) if robot.gait(id).is_routine()) {
            return Ok(());
        }
        let mut changed_robot = self.running_robot.clone();
        for robot in [&mut unchanged_robot, &mut changed_robot] {
            robot.run_without_reader(u32::from(DEBOUNCE_FRAMES));
        }
        if changed_robot.board.started_pulses() != unchanged_robot.board.started_pulses()
            || coarse_fingerprint(&changed_robot.main) != coarse_fingerprint(&unchanged_robot.main)
        {
            return violation(Rule::ContactsOnlyInRoutine, format!("{activity:?}"));
        }
        Ok(())
    }

    /// True if the robot rests and its pose is in the EEPROM.
    pub(super) fn is_rest_pose_saved(&self) -> bool {
        let motion = self.running_robot.motion();
        // Reads a copy of the bytes, because a busy EEPROM cannot be read.
        let readable_memory = Eeprom::with_bytes(*self.running_robot.board.memory.bytes());
        motion.is_resting()
            && copies::read_rest_pose(motion.robot(), &readable_memory) == Some(*motion.pose())
    }

    /// Checks that a motion that is under way continues in the next frame, unless a new fault stops it.
    fn check_motion_begins(&self, answer: &str) -> Verdict {
        let mut future_robot = self.running_robot.clone();
        future_robot.run_without_reader(1);
        let control = self.running_robot.main.control();
        let future_control = future_robot.main.control();
        if control.activity() != Activity::Stop
            && future_control.activity() == Activity::Stop
            && future_control.fault() == control.fault()
        {
            let observation = format!("{answer}, and then {}", future_robot.send_line("status"));
            return violation(Rule::MotionBegins, observation);
        }
        Ok(())
    }

    fn check_robot_stands(&self, answer: &str) -> Verdict {
        let mut future_robot = self.running_robot.clone();
        for _ in 0..MOTION_FRAMES {
            future_robot.run_frame();
        }
        let motion = future_robot.motion();
        let standing_pulses = Pose::NEUTRAL.pulses(motion.calibration());
        let activity = motion.activity();
        // The pose may have left the safe poses while the unsafe gait `stray` came to a stop.
        if motion.hazard().is_some() {
            return Ok(());
        }
        if future_robot.board.started_pulses() != standing_pulses
            || activity != Activity::Gait(GaitId::STAND)
        {
            let status = future_robot.send_line("status");
            return violation(Rule::StandWorks, format!("{answer}, and then {status}"));
        }
        Ok(())
    }

    fn check_motion_ends(&self, answer: &str) -> Verdict {
        let mut future_robot = self.running_robot.clone();
        future_robot.run_without_reader(MOTION_FRAMES);
        if future_robot.main.control().activity() != Activity::Stop {
            let observation = format!("{answer}, and then {}", future_robot.send_line("status"));
            return violation(Rule::CountedMotionEnds, observation);
        }
        Ok(())
    }

    /// Checks the pulses of a frame. `has_main_run` is false if main was stalled during the frame.
    pub(super) fn check_pulses(&mut self, has_main_run: bool) -> Verdict {
        self.observer.limits.is_memory_reliable = !self.running_robot.board.memory.is_worn;
        let pulses = self.running_robot.board.started_pulses();
        let widths = pulses.0.map(|width| width.0);
        let slew = self.robot().slew().per_frame;
        for (servo, calibration) in self.running_robot.motion().calibration().iter().enumerate() {
            let max_change_cycles = calibration.max_width_change(slew);
            let max_change_cycles = max_change_cycles.saturating_add(ROUNDING_CYCLES);
            self.observer.limits.max_change_cycles[servo] = max_change_cycles.into();
        }
        self.observer.observe_frame(self.now, widths);
        self.now += FRAME;
        self.was_main_late |= !has_main_run;
        let (robot, pose) = (self.robot(), self.running_robot.motion().pose());
        let is_pose_sent = has_main_run && widths.iter().any(|width| *width > 0);
        let find_hazard = || Clearance::measure(&robot, pose).first_hazard(&robot);
        if is_pose_sent && find_hazard().is_some() {
            return violation(Rule::PosesGuarded, format!("{pose:?}"));
        }
        self.observer.take_verdict()
    }
}
