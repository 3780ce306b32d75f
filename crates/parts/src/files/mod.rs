//! The files of a part: a solid, a mesh, and drawings for cutting the part from a sheet.
//!
//! A printer needs triangles without gaps; a CAD program needs exact surfaces; a laser cutter needs closed lines. All
//! files are derived from the same layers, so they cannot contradict each other; only the mesh has the engraved marks
//! and the closed holes of the printed part.

pub(crate) mod coupon;
pub(crate) mod dxf;
pub(crate) mod mesh;
pub(crate) mod sheet;
pub(crate) mod solid;
pub(crate) mod step;
pub(crate) mod stl;
pub(crate) mod svg;

use crate::build_error::BuildError;
use crate::part::Part;
use mesh::Mesh;
use solid::Solid;

/// A file to write.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputFile {
    /// Path within the output folder, such as `stl/link-A1-A3.stl`.
    pub path: String,
    /// Bytes of the file.
    pub bytes: Vec<u8>,
}

impl OutputFile {
    /// Creates a file from a text or from bytes.
    pub fn new(path: impl Into<String>, content: impl Into<Vec<u8>>) -> Self {
        let (path, bytes) = (path.into(), content.into());
        Self { path, bytes }
    }
}

/// Makes the files of a part: STEP and STL, and DXF and SVG if the part can be cut from a sheet. `kerf` is the width of
/// the cut, mm.
///
/// # Errors
/// Returns [`BuildError::OpenSurface`] if the layers of the part do not form a closed surface.
pub fn make_part_files(part: &Part, kerf: f64) -> Result<Vec<OutputFile>, BuildError> {
    let solid = Solid::from_prisms(&part.prisms);
    if !solid.is_closed() {
        return Err(BuildError::OpenSurface(part.name.clone()));
    }
    let mesh = Mesh::from_prisms(&part.name, &part.build_printed_layers().0)?;
    let name = part.file_stem();
    let step = step::format_step(&part.name, &solid);
    let stl = stl::encode_stl(&part.name, &mesh);
    let mut files = vec![
        OutputFile::new(format!("step/{name}.step"), step),
        OutputFile::new(format!("stl/{name}.stl"), stl),
    ];
    for sheet in sheet::draw_sheets(part) {
        let path = format!("cut/{}", sheet.name.replace(' ', "-"));
        let (dxf, svg) = (dxf::format_dxf(&sheet, kerf), svg::format_svg(&sheet, kerf));
        files.push(OutputFile::new(format!("{path}.dxf"), dxf));
        files.push(OutputFile::new(format!("{path}.svg"), svg));
    }
    Ok(files)
}
