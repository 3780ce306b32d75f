//! An image for a UNO's flash: code and robot section, or a robot section alone.
//!
//! Flash is written in pages. The boot loader in the last 512 bytes of flash cannot write itself, so an image ends
//! before the boot loader.

use std::ops::Range;

use ihex::Record;
use lizard_core::numbers::section::START_ADDRESS;

/// Number of bytes in a page, which the chip writes as a whole (ATmega328P data sheet, Page Size: 64 words).
pub const PAGE_BYTES: usize = 128;
/// The address of a UNO's boot loader.
pub const BOOT_ADDRESS: usize = 0x7e00;
/// The address of a Nano's boot section, which is 2 KB long according to the fuses in Arduino's boards.txt. The chip
/// starts there, even if the boot loader is shorter.
pub const NANO_BOOT_ADDRESS: usize = 0x7800;
/// The value of an erased flash byte.
pub const BLANK: u8 = 0xff;

/// Number of data bytes in an Intel HEX line, as avr-objcopy writes it.
const LINE_BYTES: usize = 16;

/// The firmware with its robot, or a robot alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Address of the first byte, which begins a page.
    start_address: usize,
    /// The bytes from the start address on.
    bytes: Vec<u8>,
}

/// The address of a robot's section.
pub(crate) const ROBOT_ADDRESS: usize = START_ADDRESS as usize;

/// Number of bytes between the robot's address and the boot loader.
const MAX_ROBOT_BYTES: usize = BOOT_ADDRESS - ROBOT_ADDRESS;

const _: () = assert!(
    ROBOT_ADDRESS.is_multiple_of(PAGE_BYTES),
    "the robot's section starts at a page"
);

/// A flash page that an image fills completely or in part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    /// The address of the page's first byte.
    pub address: usize,
    /// The page's bytes; [`BLANK`] outside the image.
    pub bytes: [u8; PAGE_BYTES],
}

/// The reason why bytes are not a valid image.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// There is no code at address 0, where the chip starts.
    #[error("no code at address 0, where the chip starts")]
    NoStart,
    /// There is a robot's section, but no code.
    #[error(
        "the file has a robot but no code; `lizard flash --only-robot` writes a robot alone, from its robot.toml"
    )]
    NoCode,
    /// The robot's section is empty.
    #[error("the robot's section is empty")]
    NoRobot,
    /// The image reaches into the boot loader.
    #[error("the firmware has {0} bytes, but at most {BOOT_ADDRESS} fit before the boot loader")]
    TooLong(usize),
    /// The firmware's code reaches into the robot's section.
    #[error("the code has {0} bytes, but at most {ROBOT_ADDRESS} fit before the robot's section")]
    CodeTooLong(usize),
    /// The robot's section, without code, reaches into the boot loader.
    #[error(
        "the robot's section has {0} bytes, but at most {MAX_ROBOT_BYTES} fit before the boot \
         loader"
    )]
    RobotTooLong(usize),
    /// A line is not Intel HEX.
    #[error("line {line} is not Intel HEX: {reason}")]
    InvalidLine {
        /// The line's number, counted from 1.
        line: usize,
        /// The error of the Intel HEX reader.
        reason: ihex::ReaderError,
    },
    /// The end record is missing, so other lines may be missing, too.
    #[error("the HEX file is incomplete: its end record is missing")]
    NoEnd,
    /// Two lines give different values to the same address.
    #[error("line {line} gives address {address:#06x} a second, different value")]
    Conflict {
        /// The line's number, counted from 1.
        line: usize,
        /// The address in flash.
        address: usize,
    },
    /// A line has data at or beyond the boot loader, which cannot write itself.
    #[error(
        "line {line}: address {address:#06x} must be below {BOOT_ADDRESS:#06x}, where the boot \
         loader begins"
    )]
    InBootLoader {
        /// The line's number, counted from 1.
        line: usize,
        /// The address of the line's last byte.
        address: usize,
    },
}

impl Image {
    /// Creates an image of `bytes` that starts at address 0.
    ///
    /// # Errors
    /// Fails if `bytes` is empty or too long.
    pub fn new(bytes: Vec<u8>) -> Result<Self, ImageError> {
        match bytes.len() {
            0 => Err(ImageError::NoStart),
            1..=BOOT_ADDRESS => Ok(Self {
                start_address: 0,
                bytes,
            }),
            length => Err(ImageError::TooLong(length)),
        }
    }

    /// Creates the image of the firmware's code, in Intel HEX, followed by the robot's section.
    ///
    /// # Errors
    /// Fails if `code` is not an image that ends before the section, or if the section is too long.
    pub fn firmware(code: &str, section: &[u8]) -> Result<Self, ImageError> {
        let mut bytes = Self::from_hex(code)?.bytes;
        if bytes.len() > ROBOT_ADDRESS {
            return Err(ImageError::CodeTooLong(bytes.len()));
        }
        bytes.resize(ROBOT_ADDRESS, BLANK);
        bytes.extend(section);
        Self::new(bytes)
    }

    /// Creates the image of a robot's section without code.
    ///
    /// # Errors
    /// Fails if the section is empty or too long.
    pub fn robot_alone(section: Vec<u8>) -> Result<Self, ImageError> {
        match section.len() {
            0 => Err(ImageError::NoRobot),
            1..=MAX_ROBOT_BYTES => Ok(Self {
                start_address: ROBOT_ADDRESS,
                bytes: section,
            }),
            length => Err(ImageError::RobotTooLong(length)),
        }
    }

    /// True if the image has no code.
    pub fn is_robot_alone(&self) -> bool {
        self.start_address == ROBOT_ADDRESS
    }

    /// Parses Intel HEX.
    ///
    /// # Errors
    /// Fails if the text is not complete Intel HEX, contradicts itself, has no code at address 0, or reaches into the
    /// boot loader.
    pub fn from_hex(text: &str) -> Result<Self, ImageError> {
        let mut flash = vec![None; BOOT_ADDRESS];
        let mut base_address = 0;
        let mut has_ended = false;
        for (index, record) in text.lines().map(str::trim).enumerate() {
            let line = index + 1;
            if record.is_empty() || has_ended {
                continue;
            }
            let record = Record::from_record_string(record)
                .map_err(|reason| ImageError::InvalidLine { line, reason })?;
            match record {
                Record::Data { offset, value } => {
                    let start = base_address + usize::from(offset);
                    copy_record(&mut flash, start, &value, line)?;
                }
                Record::EndOfFile => has_ended = true,
                Record::ExtendedLinearAddress(upper) => base_address = usize::from(upper) << 16,
                Record::ExtendedSegmentAddress(segment) => base_address = usize::from(segment) << 4,
                // Ignored: the chip always starts at address 0.
                Record::StartLinearAddress(_) | Record::StartSegmentAddress { .. } => {}
            }
        }
        if !has_ended {
            return Err(ImageError::NoEnd);
        }
        match (flash[0], flash[ROBOT_ADDRESS]) {
            (Some(_), _) => {}
            (None, Some(_)) => return Err(ImageError::NoCode),
            (None, None) => return Err(ImageError::NoStart),
        }
        let end = flash.iter().rposition(Option::is_some);
        let bytes = flash[..=end.unwrap_or(0)].iter();
        Self::new(bytes.map(|byte| byte.unwrap_or(BLANK)).collect())
    }

    /// Formats the image as Intel HEX.
    ///
    /// # Panics
    /// Never: all addresses fit in 16 bits, and lines are short.
    pub fn to_hex(&self) -> String {
        let lines = self.bytes.chunks(LINE_BYTES).enumerate();
        let records = lines.map(|(index, line)| Record::Data {
            offset: (self.start_address + index * LINE_BYTES) as u16,
            value: line.to_vec(),
        });
        let records: Vec<Record> = records.chain([Record::EndOfFile]).collect();
        let text = ihex::create_object_file_representation(&records);
        text.expect("the lines are short and one end record follows them")
    }

    /// The image's bytes in the order of their addresses.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The address after the last byte.
    pub fn end_address(&self) -> usize {
        self.start_address + self.bytes.len()
    }

    /// Splits the image into pages, in the order of their addresses.
    pub fn pages(&self) -> Vec<Page> {
        let chunks = self.bytes.chunks(PAGE_BYTES).enumerate();
        let pages = chunks.map(|(index, chunk)| {
            let mut bytes = [BLANK; PAGE_BYTES];
            bytes[..chunk.len()].copy_from_slice(chunk);
            let address = self.start_address + index * PAGE_BYTES;
            Page { address, bytes }
        });
        pages.collect()
    }
}

impl Page {
    /// The page's addresses in flash.
    pub fn range(&self) -> Range<usize> {
        self.address..self.address + PAGE_BYTES
    }
}

/// Copies the bytes of a line's record into `flash`, from address `start` on.
fn copy_record(
    flash: &mut [Option<u8>],
    start: usize,
    bytes: &[u8],
    line: usize,
) -> Result<(), ImageError> {
    let end = start + bytes.len();
    let Some(destination) = flash.get_mut(start..end) else {
        let address = end - 1;
        return Err(ImageError::InBootLoader { line, address });
    };
    for (index, (cell, byte)) in destination.iter_mut().zip(bytes).enumerate() {
        if cell.is_some_and(|earlier_byte| earlier_byte != *byte) {
            let address = start + index;
            return Err(ImageError::Conflict { line, address });
        }
        *cell = Some(*byte);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two data lines and the end record, as avr-objcopy writes them.
    const HEX: &str = "\
:100000000C9434000C943E000C943E000C943E0082\n\
:0400100001020304E2\n\
:00000001FF\n";

    fn parse_error(text: &str) -> String {
        let error = Image::from_hex(text).expect_err("the text is not an image");
        error.to_string()
    }

    #[test]
    fn an_image_from_hex_starts_at_address_0_and_is_blank_in_gaps() {
        let image = Image::from_hex(HEX).expect("the text is an image");
        assert_eq!(image.bytes().len(), 20);
        assert_eq!(image.bytes()[..3], [0x0c, 0x94, 0x34]);
        assert_eq!(image.bytes()[16..], [1, 2, 3, 4]);
        let hex_with_gap = HEX.replace(":0400100001020304E2", ":026E0000AABB2B");
        let image = Image::from_hex(&hex_with_gap).expect("the text is an image");
        assert_eq!(image.bytes().len(), 0x6e02);
        assert!(image.bytes()[16..0x6e00].iter().all(|&byte| byte == 0xff));
        assert_eq!(image.bytes()[0x6e00..], [0xaa, 0xbb]);
    }

    #[test]
    fn from_hex_reverses_to_hex() {
        let bytes: Vec<u8> = (0..1000).map(|index| (index * 7) as u8).collect();
        let image = Image::new(bytes).expect("the image fits");
        let text = image.to_hex();
        assert_eq!(Image::from_hex(&text), Ok(image));
        let image = Image::from_hex(HEX).expect("the text is an image");
        assert_eq!(image.to_hex(), HEX);
    }

    #[test]
    fn a_partly_filled_page_is_blank_after_the_image() {
        let image = Image::new(vec![5; 130]).expect("the image fits");
        let pages = image.pages();
        assert_eq!([pages[0].address, pages[1].address], [0, 128]);
        assert_eq!(pages.len(), 2);
        assert_eq!(pages[1].bytes[..3], [5, 5, 0xff]);
        assert_eq!(pages[1].range(), 128..256);
    }

    #[test]
    fn a_robot_alone_starts_at_its_address_and_ends_before_the_boot_loader() {
        let robot = Image::robot_alone(vec![5; 130]).expect("the image fits");
        let addresses: Vec<usize> = robot.pages().iter().map(|page| page.address).collect();
        assert_eq!(addresses, [0x6e00, 0x6e80]);
        assert_eq!(robot.end_address(), 0x6e82);
        assert!(robot.is_robot_alone());
        assert!(robot.to_hex().starts_with(":106E0000"));
        assert_eq!(Image::robot_alone(Vec::new()), Err(ImageError::NoRobot));
        assert!(Image::robot_alone(vec![0; 0x1000]).is_ok());
        let error = Image::robot_alone(vec![0; 0x1001]).expect_err("the section is too long");
        assert_eq!(
            error.to_string(),
            "the robot's section has 4097 bytes, but at most 4096 fit before the boot loader"
        );
    }

    #[test]
    fn the_error_for_an_image_that_does_not_fit_has_its_size() {
        let error = Image::new(vec![0; 32_257]).expect_err("the image is too long");
        assert_eq!(
            error.to_string(),
            "the firmware has 32257 bytes, but at most 32256 fit before the boot loader"
        );
        assert!(Image::new(vec![0; 32_256]).is_ok());
        assert_eq!(Image::new(Vec::new()), Err(ImageError::NoStart));
    }

    #[test]
    fn the_error_for_code_that_reaches_into_the_robots_section_has_its_size() {
        let code = |byte_count: usize| {
            let image = Image::new(vec![5; byte_count]).expect("the code fits without a robot");
            image.to_hex()
        };
        let error = Image::firmware(&code(28_161), &[7]).expect_err("the code is too long");
        assert_eq!(
            error.to_string(),
            "the code has 28161 bytes, but at most 28160 fit before the robot's section"
        );
        let image = Image::firmware(&code(28_160), &[7]).expect("the code fits");
        assert_eq!(image.bytes()[28_159..], [5, 7]);
    }

    #[test]
    fn the_error_for_an_invalid_hex_line_has_its_number() {
        let error_with_second_line =
            |line: &str| parse_error(&HEX.replacen(":0400100001020304E2", line, 1));
        for (line, reason) in [
            (":0400100001020304E3", "invalid check"),
            ("<html>", "missing start"),
        ] {
            let expected_start = format!("line 2 is not Intel HEX: {reason}");
            let error = error_with_second_line(line);
            assert!(error.starts_with(&expected_start), "{line}: {error}");
        }
        assert_eq!(
            error_with_second_line(":010004009566\n"),
            "line 2 gives address 0x0004 a second, different value"
        );
        assert_eq!(
            error_with_second_line(":027DFF0001027F"),
            "line 2: address 0x7e00 must be below 0x7e00, where the boot loader begins"
        );
        // A file for a larger chip may have data beyond the first 64 KiB.
        assert_eq!(
            error_with_second_line(":020000040001F9\n:0100000005FA"),
            "line 3: address 0x10000 must be below 0x7e00, where the boot loader begins"
        );
    }

    #[test]
    fn a_hex_file_needs_an_end_record_and_code_at_address_0() {
        let hex_without_end = HEX.lines().take(2).collect::<Vec<_>>().join("\n");
        assert_eq!(
            parse_error(&hex_without_end),
            "the HEX file is incomplete: its end record is missing"
        );
        assert_eq!(
            parse_error(":0100100005EA\n:00000001FF"),
            "no code at address 0, where the chip starts"
        );
        let robot = Image::robot_alone(vec![5; 130]).expect("the image fits");
        let message = parse_error(&robot.to_hex());
        assert!(message.contains("`lizard flash --only-robot`"), "{message}");
    }
}
