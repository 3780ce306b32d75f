//! The reading of a picture file as a grey picture.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use lizard_film::{Picture, luminance};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::Failure;

/// Reads a PNG or JPEG file as a grey picture.
///
/// # Errors
/// Fails if the file cannot be read or is not such a picture.
pub(super) fn read_picture(path: &Path) -> Result<Picture, Failure> {
    let name = path.display();
    let bytes =
        fs::read(path).map_err(|error| Failure::Input(format!("cannot read {name}: {error}")))?;
    let picture = match bytes.starts_with(b"\x89PNG") {
        true => decode_png(bytes),
        false => decode_jpeg(bytes),
    };
    picture.map_err(|reason| {
        Failure::Input(format!("{name} is no picture that can be read: {reason}"))
    })
}

fn decode_png(bytes: Vec<u8>) -> Result<Picture, String> {
    let error_text = |error: png::DecodingError| error.to_string();
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(error_text)?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    let info = reader.next_frame(&mut pixels).map_err(error_text)?;
    let channels = info.color_type.samples();
    let grey = pixels[..info.buffer_size()]
        .chunks_exact(channels)
        .map(|pixel| match *pixel {
            [red, green, blue, ..] => luminance(red, green, blue),
            [grey, ..] => grey,
            [] => 0,
        });
    let (width, height) = (info.width as usize, info.height as usize);
    Picture::new(width, height, grey.collect()).ok_or_else(|| "it has no pixels".to_owned())
}

fn decode_jpeg(bytes: Vec<u8>) -> Result<Picture, String> {
    let options = DecoderOptions::default().jpeg_set_out_colorspace(ColorSpace::Luma);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    let grey = decoder.decode().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions().ok_or("it has no size")?;
    Picture::new(width, height, grey).ok_or_else(|| "it has no pixels".to_owned())
}
