//! Simulated videos with known true values, for tests of the programs that measure videos: the robot on the sheet
//! ([`walk`]), a servo's horn ([`servo`]) and a lifted board ([`board`]). The simulated camera ([`render`]) has noise,
//! blur, distortion and uneven light.

use jpeg_encoder::{ColorType, Encoder, EncodingError};
use lizard_video::Frame;

pub mod board;
pub mod render;
pub mod servo;
pub mod walk;

/// Encodes a frame as JPEG; `quality` is 1 to 100.
///
/// # Errors
/// Fails for a frame wider or higher than JPEG allows, 65 535 pixels.
pub fn encode_jpeg(frame: &Frame, quality: u8) -> Result<Vec<u8>, EncodingError> {
    let [width, height] = frame.size().map(|length| length.try_into().unwrap_or(0));
    let mut bytes = Vec::new();
    Encoder::new(&mut bytes, quality).encode(frame.grey(), width, height, ColorType::Luma)?;
    Ok(bytes)
}
