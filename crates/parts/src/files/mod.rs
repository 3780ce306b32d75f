//! The files of a part: a solid, a mesh, and drawings for cutting the part from a sheet.
//!
//! A printer needs triangles without gaps; a CAD program needs exact surfaces; a laser cutter needs closed lines. All
//! files are made from the same layers, so they cannot contradict each other.

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
    /// Creates a text file.
    pub fn from_text(path: impl Into<String>, text: String) -> Self {
        Self {
            path: path.into(),
            bytes: text.into_bytes(),
        }
    }
}

/// Makes the files of a part: STEP and STL, and DXF and SVG if the part can be cut from a sheet. `kerf` is the width of
/// the cut, mm.
///
/// # Errors
/// Returns [`BuildError::OpenSurface`] if the layers of the part do not form a closed surface.
pub fn make_part_files(part: &Part, kerf: f64) -> Result<Vec<OutputFile>, BuildError> {
    let solid = Solid::from_prisms(&part.prisms);
    let (printed_layers, _) = part.build_printed_layers();
    let printed_solid = Solid::from_prisms(&printed_layers);
    let open_surface = || Err(BuildError::OpenSurface(part.name.clone()));
    if !solid.is_closed() || !printed_solid.is_closed() {
        return open_surface();
    }
    let mesh = Mesh::from_solid(&printed_solid);
    if !mesh.is_closed() {
        return open_surface();
    }
    let name = part.file_stem();
    let step = step::format_step(&part.name, &solid);
    let mut files = vec![
        OutputFile::from_text(format!("step/{name}.step"), step),
        OutputFile {
            path: format!("stl/{name}.stl"),
            bytes: stl::encode_stl(&part.name, &mesh),
        },
    ];
    for sheet in sheet::draw_sheets(part) {
        let path = format!("cut/{}", sheet.name.replace(' ', "-"));
        let (dxf, svg) = (dxf::format_dxf(&sheet, kerf), svg::format_svg(&sheet, kerf));
        files.push(OutputFile::from_text(format!("{path}.dxf"), dxf));
        files.push(OutputFile::from_text(format!("{path}.svg"), svg));
    }
    Ok(files)
}
