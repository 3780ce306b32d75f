//! Decodes PNG and JPEG files, the formats in which frames are stored.

use std::io::Cursor;

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::Frame;
use crate::frame::luma;

impl Frame {
    /// Decodes the bytes of a PNG or JPEG file.
    ///
    /// # Errors
    /// Returns the reason if the bytes are not a valid PNG or JPEG file.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        if bytes.starts_with(b"\x89PNG") {
            decode_png(bytes)
        } else {
            decode_jpeg(bytes)
        }
    }
}

fn decode_png(bytes: &[u8]) -> Result<Frame, String> {
    let error_text = |error: png::DecodingError| error.to_string();
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(error_text)?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    let output = reader.next_frame(&mut pixels).map_err(error_text)?;
    let channels = output.color_type.samples();
    let pixels = pixels[..output.buffer_size()].chunks_exact(channels);
    let grey = pixels.map(|pixel| match *pixel {
        [red, green, blue, ..] => luma(red, green, blue),
        [grey, ..] => grey,
        [] => 0,
    });
    let (width, height) = (output.width as usize, output.height as usize);
    Frame::new(width, height, grey.collect()).ok_or_else(|| "it has no pixels".to_owned())
}

fn decode_jpeg(bytes: &[u8]) -> Result<Frame, String> {
    let options = DecoderOptions::default().jpeg_set_out_colorspace(ColorSpace::Luma);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    let grey = decoder.decode().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions().ok_or("it has no size")?;
    Frame::new(width, height, grey).ok_or_else(|| "it has no pixels".to_owned())
}
