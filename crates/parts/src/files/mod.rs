//! The files of a part: solid, mesh, and what is cut from a sheet.
//!
//! A printer wants triangles without a gap, a drawing program exact surfaces, a laser closed
//! lines. All are made of the same layers, so they cannot contradict each other.

pub(crate) mod coupon;
pub(crate) mod dxf;
pub(crate) mod mesh;
pub(crate) mod sheet;
pub(crate) mod solid;
pub(crate) mod step;
pub(crate) mod stl;
pub(crate) mod svg;

use crate::files::dxf::dxf;
use crate::files::mesh::Mesh;
use crate::files::sheet::sheets;
use crate::files::solid::Solid;
use crate::files::step::step;
use crate::files::stl::stl;
use crate::files::svg::sheet_svg;
use crate::part::Part;
use crate::unfit::Unfit;

/// A file to write.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// Its path within the output folder, such as `stl/link-A1-A3.stl`.
    pub path: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

impl File {
    /// A file of text.
    #[must_use]
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
/// [`Unfit::Surface`] for a part whose layers do not make a body.
pub fn part_files(part: &Part, kerf: f64) -> Result<Vec<File>, Unfit> {
    let broken = || Unfit::Surface(part.name.clone());
    let solid = Solid::of(&part.prisms);
    if !solid.is_closed() {
        return Err(broken());
    }
    let (printed, _) = part.printed();
    let printed = Solid::of(&printed);
    if !printed.is_closed() {
        return Err(broken());
    }
    let mesh = Mesh::of(&printed);
    if !mesh.is_closed() {
        return Err(broken());
    }
    let name = part.file();
    let mut files = vec![
        File::text(format!("step/{name}.step"), step(&part.name, &solid)),
        File {
            path: format!("stl/{name}.stl"),
            bytes: stl(&part.name, &mesh),
        },
    ];
    for sheet in sheets(part) {
        let name = sheet.name.replace(' ', "-");
        files.push(File::text(format!("cut/{name}.dxf"), dxf(&sheet, kerf)));
        files.push(File::text(
            format!("cut/{name}.svg"),
            sheet_svg(&sheet, kerf),
        ));
    }
    Ok(files)
}
