//! Simulation of a person who drives the robot by radio while the scenario sends lines by cable. The person's phone
//! uses the session logic of `lizard console`.

use std::time::{Duration, Instant};

use fastrand::Rng;
use lizard_host::patrol::PATROL;
use lizard_host::session::Session;
use lizard_robot::Robot;
use simulated_uno::{Radio, RadioLink, Uno, Wire};

use super::random_commands;
use super::record::{MS, Record};

/// Average number of bytes on the wire per byte that loses its stop bit.
const BYTES_PER_GARBLED_BYTE: u16 = 300;

/// Index of the radio module among the two senders on the wire to the board.
const RADIO_INDEX: usize = 0;

/// Index of the cable among the two senders on the wire to the board.
const CABLE_INDEX: usize = 1;

/// A person with a phone, the radio link, the radio module, and the wire that the module and the cable share.
pub struct Drive<'a> {
    robot: &'a Robot,
    radio: Radio,
    wire: Wire,
    session: Session,
    /// The instant of the chip's cycle 0.
    start: Instant,
    rng: Rng,
    /// The text that the phone has received after the last complete line.
    partial_line: String,
    /// The cycle at which the phone's screen is unlocked again.
    locked_until_cycle: u64,
    /// True once the phone is out of range.
    has_left: bool,
}

impl<'a> Drive<'a> {
    /// Starts a drive with a person who has just connected.
    pub fn new(link: RadioLink, robot: &'a Robot) -> Self {
        let start = Instant::now();
        Self {
            robot,
            radio: Radio::new(link),
            wire: Wire::new([link.baud; 2]),
            session: Session::new(start, true, false).with_deadman(),
            start,
            rng: Rng::with_seed(link.seed),
            partial_line: String::new(),
            locked_until_cycle: 0,
            has_left: false,
        }
    }

    /// Ends the drive at the cycle `now`: the phone moves out of range, while the module stays on the wire.
    pub fn leave(&mut self, now: u64) {
        self.has_left = true;
        self.radio.leave(now);
    }

    /// Sends bytes by the cable from the cycle `now` on.
    pub fn send_by_cable(&mut self, bytes: &[u8], now: u64) {
        self.wire.write(CABLE_INDEX, bytes, now);
    }

    /// Passes bytes on between board, cable, radio and phone. `bytes_from_uno` are the bytes that the board has sent
    /// since the last call. Call this every millisecond.
    pub fn pass_bytes(&mut self, bytes_from_uno: &[u8], uno: &mut Uno, record: &mut Record) {
        let (now, chip_baud) = (uno.cycle(), uno.chip_baud());
        let received = self.radio.received_bytes(bytes_from_uno, chip_baud);
        let [to_uno, to_phone] = self.radio.pass(&received, now);
        self.wire.write(RADIO_INDEX, &to_uno, now);
        // The wire samples the bytes at the chip's baud rate, so the board receives them at this rate.
        uno.set_baud(chip_baud);
        for wire_byte in self.wire.receive(now, chip_baud) {
            let is_garbled = !self.has_left && self.rng.u16(..BYTES_PER_GARBLED_BYTE) == 0;
            match wire_byte.filter(|_| !is_garbled) {
                Some(byte) => uno.send(&[byte]),
                None => uno.send_with_framing_error(&[0]),
            }
        }
        self.partial_line
            .push_str(&String::from_utf8_lossy(&to_phone));
        if self.has_left || self.locked_until_cycle > now {
            return;
        }
        self.use_phone(now, record);
        if self.radio.is_linked() {
            match record.radio_spans.last_mut() {
                Some(span) if span.end + 2 * MS > now => span.end = now,
                _ => record.radio_spans.push(now..now),
            }
        }
    }

    /// Lets the phone read the received lines, and the person act randomly.
    fn use_phone(&mut self, now: u64, record: &mut Record) {
        while let Some((line, rest)) = self.partial_line.split_once('\n') {
            self.session.receive(line.trim_end_matches('\r'));
            self.partial_line = rest.to_owned();
        }
        // A cycle takes 62.5 ns.
        let instant = self.start + Duration::from_nanos(now * 125 / 2);
        match self.rng.u16(..4_000) {
            0 => self.locked_until_cycle = now + self.rng.u64(..3_000) * MS,
            1 => {
                self.session.stop(instant);
                record.stop_cycles.push(now);
            }
            2..8 => {
                let line = self.random_line();
                self.session.queue(&line);
            }
            _ => {}
        }
        self.session.time_out_request(instant);
        self.session.take_events();
        while let Some(line) = self.session.take_next_line(instant) {
            self.radio.write(format!("{line}\n").as_bytes(), now);
            record.sent_lines.push((now, line));
        }
    }

    /// Returns a random line for the person to send.
    fn random_line(&mut self) -> String {
        let gait = random_commands::random_gait(&mut self.rng, self.robot);
        match self.rng.u8(..24) {
            0 | 1 => random_commands::random_pose(&mut self.rng, self.robot),
            2 | 3 => format!("speed {}", self.rng.u8(10..=100)),
            4 => random_commands::random_trim(&mut self.rng),
            5 | 6 => "stand".to_owned(),
            7 => "rest".to_owned(),
            8 | 9 => PATROL.to_owned(),
            10..14 => format!("{gait} {}", self.rng.u8(1..40)),
            14 => format!("watch {}", self.rng.u8(0..4)),
            _ => gait,
        }
    }
}
