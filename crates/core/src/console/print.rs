//! Prints the console's lines.

use crate::console::answer::{AnswerPart, Counters};
use crate::console::digits;
use crate::console::line::Line;
use crate::console::output::Output;
use crate::console::text::Text;
use crate::console::word::{RESERVED_COUNT, Word};
use crate::control::Controller;
use crate::control::fault::Fault;
use crate::control::safety::Notice;
use crate::control::supply::{Level, Voltage};
use crate::guard::clearance::Clearance;
use crate::memory::copies::SavedState;
use crate::memory::restart::Cause;
use crate::memory::settings::Boot;
use crate::motion::{Activity, Motion};
use crate::numbers::gaits::GaitId;
use crate::numbers::part::Servo;
use crate::numbers::robot::Robot;
use crate::numbers::section::SectionError;
use crate::numbers::units::{Angle, Sweep, thousandths_from_phase};

/// The greatest length of a line of gait names, excluding the line end. The limit exists because a frame may have to
/// wait until the line is written.
pub(super) const MAX_GAIT_NAMES_LINE_BYTES: u8 = 125;

/// The index of the `boot` line in the answer to `cal`; lines 0 to 3 belong to the servos.
const CAL_BOOT_LINE: u8 = 4;
/// The index of the `deadman` line in the answer to `cal`.
const CAL_DEADMAN_LINE: u8 = 5;
/// The index of the last line of the answer to `cal`, `ok cal`.
const CAL_LAST_LINE: u8 = 6;

/// Prints a part of an answer. Returns the part to print next, if any.
#[inline(never)]
pub(super) fn print_answer(
    out: &mut impl Output,
    answer: AnswerPart,
    line: &Line,
    control: &Controller,
    counters: Counters,
) -> Option<AnswerPart> {
    match answer {
        AnswerPart::Invalid(line_error) => {
            Text::Err.print(out);
            line_error.print(control.motion(), out);
        }
        AnswerPart::Refused(refusal) => {
            Text::Err.print(out);
            refusal.print(control.motion(), out);
        }
        AnswerPart::HelpGaits(first_gait) => {
            let next_gait = print_gait_names(out, first_gait, control.motion().robot());
            return Some(next_gait.map_or(AnswerPart::HelpCommands, AnswerPart::HelpGaits));
        }
        AnswerPart::HelpCommands => {
            Text::HelpCommands.print(out);
            Word::print_all::<RESERVED_COUNT>(out, control.motion().robot());
            return Some(AnswerPart::HelpUsage);
        }
        AnswerPart::HelpUsage => {
            Text::HelpUsage.print(out);
            return Some(AnswerPart::HelpDone);
        }
        AnswerPart::HelpDone => Text::OkHelp.print(out),
        AnswerPart::Done => {
            Text::Ok.print(out);
            digits::print_ascii(out, line.text().iter().copied());
        }
        AnswerPart::StatusStart => {
            print_status_start(out, control);
            return Some(AnswerPart::StatusMargin);
        }
        AnswerPart::StatusMargin => {
            print_margin(out, control.motion());
            return Some(AnswerPart::StatusHealth);
        }
        AnswerPart::StatusHealth => print_health(out, control, counters),
        AnswerPart::CalLine(line_index) => {
            if print_cal_line(out, line_index, control) {
                return Some(AnswerPart::CalLine(line_index + 1));
            }
        }
    }
    None
}

/// Prints `# gaits: stand|walk|...` with as many names as fit. Returns the first gait that does not fit, if any.
fn print_gait_names(out: &mut impl Output, first_gait: GaitId, robot: &Robot) -> Option<GaitId> {
    Text::HelpGaits.print(out);
    // If there is no robot, the flash contains no names.
    if robot.is_none() {
        return None;
    }
    let mut length = Text::HelpGaits.length();
    let mut gait = first_gait;
    loop {
        let name = robot.gait_name(gait);
        if name.remaining() >= MAX_GAIT_NAMES_LINE_BYTES - length {
            return Some(gait);
        }
        length += 1 + name.remaining();
        out.write_byte(if gait == first_gait { b' ' } else { b'|' });
        digits::print_ascii(out, name);
        match gait.next(robot.gait_count()) {
            Some(next) => gait = next,
            None => return None,
        }
    }
}

/// Prints `ok gait=walk phase=0.250 pose=138.59,41.41,318.59,221.41`.
#[inline(never)]
fn print_status_start(out: &mut impl Output, control: &Controller) {
    let motion = control.motion();
    let robot = motion.robot();
    Text::OkGait.print(out);
    match control.activity() {
        // The name of a gait is printed without blanks: `arc-left`.
        Activity::Gait(gait) => {
            let name = robot.gait_name(gait);
            digits::print_ascii(out, name.map(|byte| if byte == b' ' { b'-' } else { byte }));
        }
        Activity::Pose => Text::Pose.print(out),
        Activity::Stop => Text::Stop.print(out),
        Activity::Rest => Text::Rest.print(out),
    }
    // If there is no robot, there is no pose and no margin.
    if robot.is_none() {
        return;
    }
    Text::StatusPhase.print(out);
    digits::print_number(out, thousandths_from_phase(motion.phase()).into(), 3);
    print_pose(out, motion)
}

/// Prints ` margin=0.661 speed=100 frames=321`.
fn print_margin(out: &mut impl Output, motion: &Motion) {
    let robot = motion.robot();
    if robot.is_none() {
        return;
    }
    Text::StatusMargin.print(out);
    digits::print_sine(out, Clearance::measure(robot, motion.pose()).min_margin());
    digits::print_count(out, Text::StatusSpeed, motion.speed_percent().into());
    digits::print_count(out, Text::StatusFrames, motion.frame_count())
}

/// Prints ` late=0 rx_lost=0 guard=clear fault=none reset=power resets=0 vcc=5.02 rail=5.91`. Omits the voltages before
/// the first reading, and `rail` if the rail is not measured.
#[inline(never)]
fn print_health(out: &mut impl Output, control: &Controller, counters: Counters) {
    digits::print_count(out, Text::StatusLate, counters.late_edges.into());
    digits::print_count(out, Text::StatusRxLost, counters.rx_lost.into());
    Text::StatusGuard.print(out);
    match control.motion().hazard() {
        None => Text::GuardClear,
        Some(_) => Text::GuardHeld,
    }
    .print(out);
    Text::StatusFault.print(out);
    control
        .fault()
        .map_or(Text::FaultNone, fault_word)
        .print(out);
    Text::StatusReset.print(out);
    cause_word(control.reset_cause()).print(out);
    digits::print_count(out, Text::StatusResets, control.reset_count().into());
    let robot = control.motion().robot();
    let reading = control.safety().supply().reading();
    // If there is no robot, no voltage can be computed, because the reference voltage is unknown.
    if robot.is_none() || reading.reference == 0 {
        return;
    }
    let supplies = robot.supplies();
    let board_voltage = Voltage::for_board(reading, &supplies);
    digits::print_hundredths(out, Text::StatusVcc, board_voltage.centivolts());
    if supplies.rail_reference_mv != 0 {
        let rail_voltage = Voltage::for_rail(reading, &supplies);
        digits::print_hundredths(out, Text::StatusRail, rail_voltage.centivolts());
    }
}

/// Prints the line of `cal` with this index. Returns false after the last line, `ok cal`.
#[inline(never)]
fn print_cal_line(out: &mut impl Output, line_index: u8, control: &Controller) -> bool {
    let settings = control.settings();
    match line_index {
        CAL_BOOT_LINE => {
            Text::CalBoot.print(out);
            print_boot(out, control);
        }
        CAL_DEADMAN_LINE => {
            digits::print_count(out, Text::CalDeadman, settings.deadman_ms().into());
        }
        CAL_LAST_LINE.. => {
            Text::Ok.print(out);
            Text::Cal.print(out);
            return false;
        }
        _ => {
            let servo = Servo::at(usize::from(line_index));
            let adjustment = settings.adjustment(servo);
            let neutral = control.motion().robot().servo_neutral_angle(servo);
            Text::InfoPrefix.print(out);
            out.write_byte(b'A');
            out.write_byte(b'1' + line_index);
            Text::CalTrim.print(out);
            print_sweep(out, adjustment.trim);
            digits::print_hundredths(
                out,
                Text::CalLimit,
                neutral.offset_by(adjustment.travel_min).centideg(),
            );
            digits::print_hundredths(
                out,
                Text::Space,
                neutral.offset_by(adjustment.travel_max).centideg(),
            );
            Text::CalDir.print(out);
            out.write_byte(if adjustment.is_direct() { b'+' } else { b'-' });
            digits::print_hundredths(out, Text::CalScale, adjustment.scale());
        }
    }
    true
}

/// Prints the value of the `boot` setting.
fn print_boot(out: &mut impl Output, control: &Controller) {
    let robot = control.motion().robot();
    match control.settings().boot(robot) {
        Boot::Rest => Text::Rest.print(out),
        Boot::Gait(id) => digits::print_ascii(out, robot.gait_name(id)),
    }
}

/// Prints a notice: an unsolicited line.
pub(super) fn print_notice(out: &mut impl Output, notice: Notice, control: &Controller) {
    match notice {
        Notice::SavedSettings => match control.saved_settings_state() {
            SavedState::Latest | SavedState::Blank => Text::CalibrationBlank,
            SavedState::OneCopy => Text::CalibrationOneCopy,
            SavedState::Damaged => Text::CalibrationDamaged,
            SavedState::Foreign => Text::CalibrationForeign,
            SavedState::Unfit => Text::CalibrationUnfit,
        }
        .print(out),
        Notice::RestPoseNotSaved => Text::RestPoseNotSaved.print(out),
        Notice::Fault => {
            Text::NoticeFault.print(out);
            let fault = control.safety().fault();
            match control.section_error() {
                Some(SectionError::OtherFormat) => Text::FaultNoticeRobotFormat,
                Some(SectionError::Damaged | SectionError::Harmful) => {
                    Text::FaultNoticeRobotDamaged
                }
                _ => fault.map_or(Text::FaultNone, fault_message),
            }
            .print(out)
        }
        Notice::Supply => {
            let centivolts = control.limiting_voltage().centivolts();
            digits::print_hundredths(out, Text::NoticeSupply, centivolts);
            out.write_byte(b' ');
            out.write_byte(b'V');
            match control.safety().supply().level() {
                Level::Good => Text::LevelGood.print(out),
                Level::Slow => {
                    let pace = control.motion().robot().slow_pace();
                    digits::print_count(out, Text::LevelSlow, pace.into())
                }
                Level::Stop => Text::LevelStop.print(out),
                Level::Rest => Text::LevelRest.print(out),
            }
        }
        Notice::Boot => {
            Text::NoticeBoot.print(out);
            print_boot(out, control)
        }
        Notice::Done => Text::NoticeDone.print(out),
        Notice::Waiting => {
            Text::NoticeWaiting.print(out);
            match control.awaited_input().is_nose() {
                true => Text::Nose,
                false => Text::Button,
            }
            .print(out)
        }
    }
}

/// Prints ` pose=`, followed by the chassis angles of the four servos.
pub(super) fn print_pose(out: &mut impl Output, motion: &Motion) {
    Text::PoseField.print(out);
    digits::print_angles(out, motion.pose(), motion.robot())
}

/// Prints a sweep in degrees with two decimals.
fn print_sweep(out: &mut impl Output, sweep: Sweep) {
    let magnitude = Angle(sweep.0.unsigned_abs()).centideg();
    let centideg = i32::from(magnitude);
    digits::print_signed(out, if sweep.0 < 0 { -centideg } else { centideg }, 2)
}

/// Prints `# lizard 0.2.0 robot paper 1a2b3c4d, send help for the commands`.
pub(super) fn print_banner(out: &mut impl Output, robot: &Robot) {
    Text::Banner.print(out);
    Text::Version.print(out);
    if robot.is_none() {
        Text::BannerNoRobot.print(out);
        return Text::BannerEnd.print(out);
    }
    Text::BannerRobot.print(out);
    digits::print_ascii(out, robot.name());
    out.write_byte(b' ');
    let hash = robot.hash();
    for digit in 0..8 {
        let nibble = (hash >> (28 - 4 * digit)) as u8 & 0xf;
        let character = if nibble < 10 {
            b'0' + nibble
        } else {
            b'a' - 10 + nibble
        };
        out.write_byte(character);
    }
    Text::BannerEnd.print(out)
}

/// Returns the word by which `status` names a fault.
const fn fault_word(fault: Fault) -> Text {
    match fault {
        Fault::Guard => Text::FaultGuard,
        Fault::Supply => Text::FaultSupply,
        Fault::Link => Text::FaultLink,
        Fault::Watchdog => Text::FaultWatchdog,
        Fault::LateEdge => Text::FaultLate,
        Fault::Stack => Text::FaultStack,
        Fault::BrownOut => Text::FaultBrownOut,
        Fault::Robot => Text::FaultRobot,
    }
}

/// Returns the message that announces a fault.
const fn fault_message(fault: Fault) -> Text {
    match fault {
        Fault::Guard => Text::FaultNoticeGuard,
        Fault::Supply => Text::FaultNoticeSupply,
        Fault::Link => Text::FaultNoticeLink,
        Fault::Watchdog => Text::FaultNoticeWatchdog,
        Fault::LateEdge => Text::FaultNoticeLate,
        Fault::Stack => Text::FaultNoticeStack,
        Fault::BrownOut => Text::FaultNoticeBrownOut,
        Fault::Robot => Text::FaultNoticeRobot,
    }
}

/// Returns the word by which `status` names the cause of a reset.
const fn cause_word(cause: Cause) -> Text {
    match cause {
        Cause::Power => Text::CausePower,
        Cause::External => Text::CauseExternal,
        Cause::BrownOut => Text::CauseBrownOut,
        Cause::Watchdog => Text::CauseWatchdog,
    }
}
