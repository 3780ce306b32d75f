//! The files of a part: a solid, a mesh, and drawings for cutting the part from a sheet.
//!
//! A printer needs triangles without gaps, a CAD program exact surfaces, a laser closed lines. All files are made from
//! the same layers, so they cannot contradict each other.

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
pub struct File {
    /// Path within the output folder, such as `stl/link-A1-A3.stl`.
    pub path: String,
    /// Content.
    pub bytes: Vec<u8>,
}

impl File {
    /// Creates a text file.
    pub fn text(path: String, text: String) -> Self {
        Self {
            path,
            bytes: text.into_bytes(),
        }
    }
}

/// Makes the files of a part: STEP and STL, and DXF and SVG if the part can be cut from a sheet.
///
/// # Errors
/// Returns [`BuildError::OpenSurface`] for a part whose layers do not form a closed surface.
pub fn make_part_files(part: &Part, kerf: f64) -> Result<Vec<File>, BuildError> {
    let solid = Solid::from_prisms(&part.prisms);
    let (printed_layers, _) = part.build_printed_layers();
    let printed_solid = Solid::from_prisms(&printed_layers);
    let mesh = match printed_solid.is_closed() {
        true => Mesh::from_solid(&printed_solid),
        false => return Err(BuildError::OpenSurface(part.name.clone())),
    };
    if !solid.is_closed() || !mesh.is_closed() {
        return Err(BuildError::OpenSurface(part.name.clone()));
    }
    let name = part.file_stem();
    let step = step::format_step(&part.name, &solid);
    let mut files = vec![
        File::text(format!("step/{name}.step"), step),
        File {
            path: format!("stl/{name}.stl"),
            bytes: stl::encode_stl(&part.name, &mesh),
        },
    ];
    for sheet in sheet::draw_sheets(part) {
        let path = format!("cut/{}", sheet.name.replace(' ', "-"));
        let (dxf, svg) = (dxf::format_dxf(&sheet, kerf), svg::format_svg(&sheet, kerf));
        files.push(File::text(format!("{path}.dxf"), dxf));
        files.push(File::text(format!("{path}.svg"), svg));
    }
    Ok(files)
}
