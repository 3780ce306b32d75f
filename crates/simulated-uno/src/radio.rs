//! A radio module on the serial line, such as an HM-10 or an HC-05.
//!
//! The module replaces the cable between a host, such as a phone, and the chip. Bytes travel in order, in packets of up
//! to 20 bytes, each delayed by 7.5 to 100 ms. A packet may be lost. The link may end in the middle of a line and
//! resume seconds later. An HM-10 reports both events to the chip among the received bytes, as `OK+LOST` and `OK+CONN`
//! without a line end; an HC-05 reports nothing. The module passes bytes on at its own baud rate, and never resets the
//! chip.
//!
//! ```no_run
//! # use simulated_uno::{Fidelity, Radio, RadioLink, Uno};
//! let mut uno = Uno::load("firmware.elf", Fidelity::DataSheet)?;
//! let mut radio = Radio::new(RadioLink::default());
//! radio.write(b"status\n", uno.cycle());
//! for _ms in 0..500 {
//!     uno.run_ms(1);
//!     print!("{}", String::from_utf8_lossy(&radio.exchange(&mut uno)));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::collections::VecDeque;

use crate::serial::sample_byte;
use crate::{CYCLES_PER_MS, Uno};

/// The largest number of bytes in a packet.
const MAX_PACKET_BYTES: usize = 20;
/// The travel time of a packet, ms.
const DELAY_MS: std::ops::Range<f64> = 7.5..100.0;
/// The longest time for which the module collects bytes from the chip for a packet, ms.
const MAX_GATHERING_MS: u64 = 20;
/// The time between two links, ms.
const OUTAGE_MS: std::ops::Range<u64> = 200..5000;

/// The properties of a radio module and of its link to a phone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadioLink {
    /// The baud rate of the module's serial line.
    pub baud: f64,
    /// The fraction of packets that are lost, 0 to 1.
    pub packet_loss: f64,
    /// The mean duration of a link, ms; 0 if the link never ends.
    pub mean_link_ms: u64,
    /// True if the module sends `OK+CONN` and `OK+LOST` to the chip when the link begins and ends.
    pub reports_link: bool,
    /// The seed of the random numbers.
    pub seed: u64,
}

impl Default for RadioLink {
    /// A module with its factory settings, and a phone in the same room.
    fn default() -> Self {
        Self {
            baud: 9600.0,
            packet_loss: 0.01,
            mean_link_ms: 20_000,
            reports_link: true,
            seed: 0,
        }
    }
}

/// The packets on their way in one direction.
#[derive(Debug, Default)]
struct PacketQueue {
    /// The packets in order, each with the cycle at which it arrives.
    packets: VecDeque<(u64, Vec<u8>)>,
}

impl PacketQueue {
    /// Sends bytes in packets, each with a random delay; some are lost.
    fn send(&mut self, bytes: &[u8], now: u64, link: RadioLink, random: &mut fastrand::Rng) {
        for packet in bytes.chunks(MAX_PACKET_BYTES) {
            let delay_ms = DELAY_MS.start + random.f64() * (DELAY_MS.end - DELAY_MS.start);
            let delay_cycles = (delay_ms * CYCLES_PER_MS as f64) as u64;
            let last_arrival_cycle = self.packets.back().map_or(0, |(cycle, _)| *cycle);
            let arrival_cycle = last_arrival_cycle.max(now + delay_cycles);
            if random.f64() >= link.packet_loss {
                self.packets.push_back((arrival_cycle, packet.to_vec()));
            }
        }
    }

    /// Removes and returns the bytes that have arrived by the cycle `now`.
    fn take_arrived(&mut self, now: u64) -> Vec<u8> {
        let mut bytes = Vec::new();
        while let Some((_, packet)) = self.packets.pop_front_if(|(cycle, _)| *cycle <= now) {
            bytes.extend(packet);
        }
        bytes
    }

    /// Ends the transmission. Returns a random number of bytes of the next packet, which still arrive; all other bytes
    /// are lost.
    fn take_remainder(&mut self, random: &mut fastrand::Rng) -> Vec<u8> {
        let packets = std::mem::take(&mut self.packets);
        let mut next_packet = packets.into_iter().next().unwrap_or_default().1;
        next_packet.truncate(random.usize(..=next_packet.len()));
        next_packet
    }
}

/// A radio module and its link to a phone.
#[derive(Debug)]
pub struct Radio {
    link: RadioLink,
    random: fastrand::Rng,
    to_uno: PacketQueue,
    to_phone: PacketQueue,
    /// The chip's bytes that wait until a packet is full.
    gathered_bytes: Vec<u8>,
    /// The cycle since which the gathered bytes have waited.
    gathering_start: u64,
    /// The cycle at which the link ends or, while there is no link, resumes; `None` for never.
    next_link_change: Option<u64>,
    is_linked: bool,
    /// True if the phone has moved out of range for good.
    has_left: bool,
}

impl Radio {
    /// Creates a module with a link to a phone.
    #[must_use]
    pub fn new(link: RadioLink) -> Self {
        let mut radio = Self {
            link,
            random: fastrand::Rng::with_seed(link.seed),
            to_uno: PacketQueue::default(),
            to_phone: PacketQueue::default(),
            gathered_bytes: Vec::new(),
            gathering_start: 0,
            next_link_change: None,
            is_linked: true,
            has_left: false,
        };
        radio.next_link_change = radio.next_link_end(0);
        radio
    }

    /// True while the link exists.
    #[must_use]
    pub fn is_linked(&self) -> bool {
        self.is_linked
    }

    /// The baud rate of the module's serial line.
    #[must_use]
    pub fn baud(&self) -> f64 {
        self.link.baud
    }

    /// Sends the phone's bytes to the chip, beginning at the cycle `now`. Without a link, the bytes are lost.
    pub fn write(&mut self, bytes: &[u8], now: u64) {
        if self.is_linked {
            self.to_uno.send(bytes, now, self.link, &mut self.random);
        }
    }

    /// Ends the link permanently at the cycle `now`: the phone moves out of range.
    pub fn leave(&mut self, now: u64) {
        self.has_left = true;
        self.next_link_change = self.is_linked.then_some(now);
    }

    /// Takes the bytes that the UNO has transmitted, sends it the bytes that have arrived from the phone, and returns
    /// the bytes that have arrived at the phone. Must be called every millisecond of the chip's time.
    pub fn exchange(&mut self, uno: &mut Uno) -> Vec<u8> {
        uno.set_baud(self.link.baud);
        let received = uno.take_bytes_at(self.link.baud);
        let [to_uno, to_phone] = self.pass(&received, uno.cycle());
        uno.send(&to_uno);
        to_phone
    }

    /// Returns the bytes that the module reads at its own baud rate if the chip sends `sent_bytes` at `chip_baud`.
    #[must_use]
    pub fn received_bytes(&self, sent_bytes: &[u8], chip_baud: f64) -> Vec<u8> {
        let read_byte = |byte: &u8| sample_byte(*byte, chip_baud, self.link.baud);
        sent_bytes.iter().map(read_byte).collect()
    }

    /// Takes the bytes that the module has received from the chip. Returns the bytes that have arrived at the chip by
    /// the cycle `now`, and those that have arrived at the phone. Must be called every millisecond of the chip's time.
    pub fn pass(&mut self, received: &[u8], now: u64) -> [Vec<u8>; 2] {
        if self.next_link_change.is_some_and(|change| change <= now) {
            return self.toggle_link(now);
        }
        let to_uno = self.to_uno.take_arrived(now);
        if !self.is_linked {
            return [to_uno, Vec::new()];
        }
        if self.gathered_bytes.is_empty() {
            self.gathering_start = now;
        }
        self.gathered_bytes.extend(received);
        if self.gathered_bytes.len() >= MAX_PACKET_BYTES
            || now >= self.gathering_start + MAX_GATHERING_MS * CYCLES_PER_MS
        {
            let bytes = std::mem::take(&mut self.gathered_bytes);
            self.to_phone.send(&bytes, now, self.link, &mut self.random);
        }
        [to_uno, self.to_phone.take_arrived(now)]
    }

    /// Ends the link or restores it. Returns the bytes that still arrive at the chip and at the phone.
    fn toggle_link(&mut self, now: u64) -> [Vec<u8>; 2] {
        self.is_linked = !self.is_linked;
        let mut to_uno = self.to_uno.take_remainder(&mut self.random);
        if self.link.reports_link {
            let report = if self.is_linked { "OK+CONN" } else { "OK+LOST" };
            to_uno.extend(report.bytes());
        }
        if self.is_linked {
            self.next_link_change = self.next_link_end(now);
            return [to_uno, Vec::new()];
        }
        self.gathered_bytes.clear();
        let return_cycle = now + self.random.u64(OUTAGE_MS) * CYCLES_PER_MS;
        self.next_link_change = (!self.has_left).then_some(return_cycle);
        [to_uno, self.to_phone.take_remainder(&mut self.random)]
    }

    /// Returns the cycle at which a link that begins now ends; `None` if links never end.
    fn next_link_end(&mut self, now: u64) -> Option<u64> {
        let max_cycles = 2 * self.link.mean_link_ms * CYCLES_PER_MS;
        (max_cycles > 0).then(|| now + self.random.u64(..max_cycles))
    }
}
