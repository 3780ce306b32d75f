//! Reads firmware images in Intel HEX format, which has no debug information.

use ihex::Record;

use crate::image::{Image, LoadError, flash_segment};

impl Image {
    /// Parses Intel HEX. The format has neither symbols nor the size of static data, so [`Image::static_ram`] is 0 and
    /// no function has a name.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn parse_hex(text: &str) -> Result<Self, LoadError> {
        let mut segments = Vec::new();
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
                    segments.push(flash_segment(base + u64::from(offset), value)?);
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
