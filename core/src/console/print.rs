//! How the console's lines are written.

use ufmt::uWrite;

use super::{Console, Counters, LONGEST_LINE};
use crate::answer::Answer;
use crate::digits;
use crate::fault::Fault;
use crate::gait::GaitId;
use crate::guard::Clearance;
use crate::motion::Activity;
use crate::record::Outcome;
use crate::robot::Robot;
use crate::safety::Notice;
use crate::settings::Boot;
use crate::supply::{Level, Voltage};
use crate::text::Text;
use crate::units::{Angle, Sweep, thousandths_from_phase};
use crate::word::Word;

/// Places of the lines of `cal`.
const CAL_BOOT: u8 = 4;
const CAL_DEADMAN: u8 = 5;
const CAL_END: u8 = 6;

impl<R: Robot> Console<R> {
    /// Prints a line of an answer; returns what is left of it.
    #[inline(never)]
    pub(super) fn print_answer<W>(
        &self,
        out: &mut W,
        answer: Answer,
        counters: Counters,
    ) -> Result<Option<Answer>, W::Error>
    where
        W: uWrite + ?Sized,
    {
        match answer {
            Answer::Refused(refusal) => {
                Text::Err.print(out)?;
                out.write_char(char::from(b'0' + refusal.code()))?;
                out.write_char(' ')?;
                refusal.print(&self.motion, out)?;
            }
            Answer::Gaits(first) => {
                let rest = self.print_gaits(out, first)?;
                return Ok(Some(rest.map_or(Answer::Words, Answer::Gaits)));
            }
            Answer::Words => {
                Text::HelpWords.print(out)?;
                Word::print_all(out)?;
                return Ok(Some(Answer::Hint));
            }
            Answer::Hint => {
                Text::HelpHint.print(out)?;
                return Ok(Some(Answer::Helped));
            }
            Answer::Helped => Text::OkHelp.print(out)?,
            Answer::Done => {
                Text::Ok.print(out)?;
                digits::ascii(out, self.line.text().iter().copied())?;
            }
            Answer::Status => {
                self.print_status(out, counters)?;
                return Ok(Some(Answer::Health));
            }
            Answer::Health => self.print_health(out)?,
            Answer::Settings(line) => {
                if self.print_settings(out, line)? {
                    return Ok(Some(Answer::Settings(line + 1)));
                }
            }
        }
        Ok(None)
    }

    /// `# gaits: stand|walk|...`, as many as a line takes; returns the first that
    /// it has no room for.
    fn print_gaits<W>(&self, out: &mut W, first: GaitId) -> Result<Option<GaitId>, W::Error>
    where
        W: uWrite + ?Sized,
    {
        /// Without the line end.
        const ROOM: u8 = LONGEST_LINE - 2;
        let robot = self.motion.robot();
        Text::HelpGaits.print(out)?;
        let mut length = Text::HelpGaits.length();
        let mut gait = first;
        loop {
            let name = robot.name(gait);
            if name.length() >= ROOM - length {
                return Ok(Some(gait));
            }
            length += 1 + name.length();
            out.write_char(if gait == first { ' ' } else { '|' })?;
            digits::ascii(out, name)?;
            match gait.next(robot.gaits().len()) {
                Some(next) => gait = next,
                None => return Ok(None),
            }
        }
    }

    #[inline(never)]
    fn print_status<W>(&self, out: &mut W, counters: Counters) -> Result<(), W::Error>
    where
        W: uWrite + ?Sized,
    {
        let motion = &self.motion;
        Text::OkGait.print(out)?;
        match motion.activity() {
            Activity::Gait(gait) => self.print_key(out, gait)?,
            Activity::Pose => Text::Pose.print(out)?,
            Activity::Stop => Text::Stop.print(out)?,
            Activity::Rest => Text::Rest.print(out)?,
        }
        Text::StatusPhase.print(out)?;
        digits::number(out, thousandths_from_phase(motion.phase()).into(), 3)?;
        self.print_pose(out)?;
        Text::StatusMargin.print(out)?;
        digits::sine(out, Clearance::of(motion.robot(), motion.pose()).smallest())?;
        digits::count(out, Text::StatusSpeed, motion.speed().into())?;
        digits::count(out, Text::StatusFrames, motion.frames())?;
        digits::count(out, Text::StatusLate, counters.late.into())?;
        digits::count(out, Text::StatusRxLost, counters.rx_lost.into())?;
        Text::StatusGuard.print(out)?;
        match motion.hazard() {
            None => Text::GuardClear,
            Some(_) => Text::GuardHeld,
        }
        .print(out)
    }

    /// ` fault=none reset=power resets=0 vcc=5.02 rail=5.91`, the rail where it is
    /// measured.
    #[inline(never)]
    fn print_health<W: uWrite + ?Sized>(&self, out: &mut W) -> Result<(), W::Error> {
        Text::StatusFault.print(out)?;
        self.fault()
            .map_or(Text::FaultNone, Fault::word)
            .print(out)?;
        Text::StatusReset.print(out)?;
        self.cause.word().print(out)?;
        digits::count(out, Text::StatusResets, self.restarts.into())?;
        let supplies = self.motion.robot().supplies();
        let reading = self.safety.supply().reading();
        let board = Voltage::of_board(reading, &supplies);
        digits::field(out, Text::StatusVcc, board.hundredths())?;
        if let Some(rail) = &supplies.rail {
            let rail = Voltage::of_rail(reading, rail);
            digits::field(out, Text::StatusRail, rail.hundredths())?;
        }
        Ok(())
    }

    /// A line of `cal`; false after the last one, which is `ok cal`.
    #[inline(never)]
    fn print_settings<W>(&self, out: &mut W, line: u8) -> Result<bool, W::Error>
    where
        W: uWrite + ?Sized,
    {
        let settings = &self.settings;
        match line {
            CAL_BOOT => {
                Text::CalBoot.print(out)?;
                self.print_boot(out)?;
            }
            CAL_DEADMAN => {
                digits::count(out, Text::CalDeadman, settings.deadman().into())?;
            }
            CAL_END.. => {
                Text::Ok.print(out)?;
                Text::Cal.print(out)?;
                return Ok(false);
            }
            _ => {
                let place = usize::from(line & 3);
                let set = settings.servo(place);
                let neutral = self.motion.robot().neutral_of(place);
                Text::Information.print(out)?;
                out.write_char('A')?;
                out.write_char(char::from(b'1' + line))?;
                Text::CalTrim.print(out)?;
                print_sweep(out, set.trim)?;
                digits::field(out, Text::CalLimit, neutral.swept(set.min).centideg())?;
                digits::field(out, Text::Blank, neutral.swept(set.max).centideg())?;
                Text::CalDir.print(out)?;
                out.write_char(if set.is_direct() { '+' } else { '-' })?;
                digits::field(out, Text::CalScale, set.scale())?;
            }
        }
        Ok(true)
    }

    fn print_boot<W: uWrite + ?Sized>(&self, out: &mut W) -> Result<(), W::Error> {
        match self.settings.boot(self.motion.robot()) {
            Boot::Rest => Text::Rest.print(out),
            Boot::Gait(id) => digits::ascii(out, self.motion.robot().name(id)),
        }
    }

    /// What is said without being asked for.
    pub(super) fn print_notice<W>(&self, out: &mut W, notice: Notice) -> Result<(), W::Error>
    where
        W: uWrite + ?Sized,
    {
        match notice {
            Notice::Memory => match self.found {
                Outcome::Latest | Outcome::Blank => Text::MemoryBlank,
                Outcome::Other => Text::MemoryOther,
                Outcome::Damaged => Text::MemoryDamaged,
                Outcome::Foreign => Text::MemoryForeign,
                Outcome::Unfit => Text::MemoryUnfit,
            }
            .print(out),
            Notice::Fault => {
                Text::NoticeFault.print(out)?;
                match self.safety.fault() {
                    None => Text::FaultNone,
                    Some(Fault::Guard) => Text::WhyGuard,
                    Some(Fault::Supply) => Text::WhySupply,
                    Some(Fault::Link) => Text::WhyLink,
                    Some(Fault::Watchdog) => Text::WhyWatchdog,
                    Some(Fault::Late) => Text::WhyLate,
                    Some(Fault::Stack) => Text::WhyStack,
                }
                .print(out)
            }
            Notice::Supply => {
                digits::field(out, Text::NoticeSupply, self.voltage().hundredths())?;
                out.write_char(' ')?;
                out.write_char('V')?;
                match self.safety.supply().level() {
                    Level::Good => Text::LevelGood,
                    Level::Slow => Text::LevelSlow,
                    Level::Stop => Text::LevelStop,
                    Level::Rest => Text::LevelRest,
                }
                .print(out)
            }
            Notice::Boot => {
                Text::NoticeBoot.print(out)?;
                self.print_boot(out)
            }
        }
    }

    /// The guard's fault, or another one.
    fn fault(&self) -> Option<Fault> {
        match self.motion.hazard() {
            Some(_) => Some(Fault::Guard),
            None => self.safety.fault(),
        }
    }

    pub(super) fn print_pose<W: uWrite + ?Sized>(&self, out: &mut W) -> Result<(), W::Error> {
        Text::WatchPose.print(out)?;
        let motion = &self.motion;
        digits::angles(out, motion.pose(), motion.robot())
    }

    /// A gait's name as a value without a blank: `arc-left`.
    fn print_key<W: uWrite + ?Sized>(&self, out: &mut W, gait: GaitId) -> Result<(), W::Error> {
        let name = self.motion.robot().name(gait);
        digits::ascii(out, name.map(|byte| if byte == b' ' { b'-' } else { byte }))
    }
}

/// A sweep in degrees with two decimals.
fn print_sweep<W: uWrite + ?Sized>(out: &mut W, sweep: Sweep) -> Result<(), W::Error> {
    let size = Angle(sweep.0.unsigned_abs()).centideg();
    let centideg = i32::from(size);
    digits::signed(out, if sweep.0 < 0 { -centideg } else { centideg }, 2)
}

/// `# lizard 0.1.0 tables 1a2b3c4d, send help for the commands`.
pub(super) fn print_banner<W: uWrite + ?Sized>(out: &mut W, hash: u32) -> Result<(), W::Error> {
    Text::Banner.print(out)?;
    Text::Version.print(out)?;
    Text::BannerTables.print(out)?;
    for digit in 0..8 {
        let nibble = (hash >> (28 - 4 * digit)) as u8 & 0xf;
        let digit = if nibble < 10 {
            b'0' + nibble
        } else {
            b'a' - 10 + nibble
        };
        out.write_char(char::from(digit))?;
    }
    Text::BannerEnd.print(out)
}
