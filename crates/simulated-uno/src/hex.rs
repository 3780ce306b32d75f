//! Reads firmware images in Intel HEX format, which has no debug information.

use ihex::Record;

use crate::image::{FLASH_SIZE, Image, LoadError};

impl Image {
    /// Parses Intel HEX. The format has neither symbols nor the size of static data, so [`Image::static_ram`] is 0 and
    /// no function has a name.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn parse_hex(text: &str) -> Result<Self, LoadError> {
        let mut segments: Vec<(u32, Vec<u8>)> = Vec::new();
        let mut base = 0;
        for (index, record) in text.lines().map(str::trim).enumerate() {
            if record.is_empty() {
                continue;
            }
            let record = Record::from_record_string(record);
            let record = record.map_err(|reason| LoadError::HexLine {
                line: index + 1,
                reason: reason.to_string(),
            })?;
            match record {
                Record::Data { offset, value } => {
                    append(&mut segments, base + u64::from(offset), value)?;
                }
                Record::EndOfFile if segments.is_empty() => return Err(LoadError::Empty),
                Record::EndOfFile => return Ok(Self::from_segments(segments)),
                Record::ExtendedLinearAddress(upper) => base = u64::from(upper) << 16,
                Record::ExtendedSegmentAddress(segment) => base = u64::from(segment) << 4,
                // Ignored: the chip starts at address 0.
                Record::StartLinearAddress(_) | Record::StartSegmentAddress { .. } => {}
            }
        }
        Err(LoadError::HexTruncated)
    }
}

/// Appends a line's bytes to the last segment if their address is the segment's end, otherwise adds a new segment.
fn append(
    segments: &mut Vec<(u32, Vec<u8>)>,
    address: u64,
    bytes: Vec<u8>,
) -> Result<(), LoadError> {
    let size = bytes.len() as u64;
    if address + size > u64::from(FLASH_SIZE) {
        return Err(LoadError::TooLarge { address, size });
    }
    let address = address as u32;
    match segments.last_mut() {
        Some((start, last)) if *start + last.len() as u32 == address => last.extend(bytes),
        _ => segments.push((address, bytes)),
    }
    Ok(())
}
