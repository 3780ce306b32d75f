//! PNG from SVG.

use resvg::{tiny_skia, usvg};

/// Renders a picture at twice its size, for dense screens.
///
/// # Errors
/// A sentence, if the picture cannot be read or is too large.
pub fn png(svg: &str, options: &usvg::Options) -> Result<Vec<u8>, String> {
    const ZOOM: f32 = 2.0;
    let tree = usvg::Tree::from_str(svg, options).map_err(|fault| fault.to_string())?;
    let size = tree.size();
    let (width, height) = ((size.width() * ZOOM) as u32, (size.height() * ZOOM) as u32);
    let mut pixels =
        tiny_skia::Pixmap::new(width, height).ok_or_else(|| "the picture is empty".to_string())?;
    resvg::render(
        &tree,
        tiny_skia::Transform::from_scale(ZOOM, ZOOM),
        &mut pixels.as_mut(),
    );
    pixels.encode_png().map_err(|fault| fault.to_string())
}

/// Fonts of this machine. Without any, PNG files have no text.
pub fn options() -> usvg::Options<'static> {
    let mut options = usvg::Options::default();
    let fonts = options.fontdb_mut();
    fonts.load_system_fonts();
    let sans = ["Helvetica", "Arial", "Liberation Sans", "DejaVu Sans"]
        .into_iter()
        .find(|family| {
            let families = [usvg::fontdb::Family::Name(family)];
            fonts
                .query(&usvg::fontdb::Query {
                    families: &families,
                    ..Default::default()
                })
                .is_some()
        });
    if let Some(sans) = sans {
        fonts.set_sans_serif_family(sans);
    }
    options
}
