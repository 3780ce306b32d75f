//! The files of a part: solid, mesh, and drawings for cutting it from a sheet.
//!
//! A printer needs triangles without a gap, a drawing program exact surfaces, a laser closed
//! lines. All files are made from the same layers, so they cannot contradict each other.

pub(crate) mod coupon;
pub(crate) mod dxf;
pub(crate) mod mesh;
pub(crate) mod sheet;
pub(crate) mod solid;
pub(crate) mod step;
pub(crate) mod stl;
pub(crate) mod svg;

use crate::build_problem::BuildProblem;
use crate::part::Part;
use mesh::Mesh;
use solid::Solid;

/// A file to write.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// The file's path within the output folder, such as `stl/link-A1-A3.stl`.
    pub path: String,
    /// The file's content.
    pub bytes: Vec<u8>,
}

impl File {
    /// A file of text.
    pub fn text(path: String, text: String) -> Self {
        Self {
            path,
            bytes: text.into_bytes(),
        }
    }
}

/// The files of a part: STEP and STL, and DXF and SVG if it can be cut from a sheet.
///
/// # Errors
/// Returns [`BuildProblem::OpenSurface`] for a part whose layers do not form a closed surface.
pub fn part_files(part: &Part, kerf: f64) -> Result<Vec<File>, BuildProblem> {
    let solid = Solid::of(&part.prisms);
    let (printed_layers, _) = part.printed_layers();
    let printed_solid = Solid::of(&printed_layers);
    let mesh = match printed_solid.is_closed() {
        true => Mesh::of(&printed_solid),
        false => return Err(BuildProblem::OpenSurface(part.name.clone())),
    };
    if !solid.is_closed() || !mesh.is_closed() {
        return Err(BuildProblem::OpenSurface(part.name.clone()));
    }
    let name = part.file_stem();
    let step = step::step(&part.name, &solid);
    let mut files = vec![
        File::text(format!("step/{name}.step"), step),
        File {
            path: format!("stl/{name}.stl"),
            bytes: stl::stl(&part.name, &mesh),
        },
    ];
    for sheet in sheet::sheets(part) {
        let path = format!("cut/{}", sheet.name.replace(' ', "-"));
        let (dxf, svg) = (dxf::dxf(&sheet, kerf), svg::sheet_svg(&sheet, kerf));
        files.push(File::text(format!("{path}.dxf"), dxf));
        files.push(File::text(format!("{path}.svg"), svg));
    }
    Ok(files)
}
