//! The files of a part.

use crate::dxf::dxf;
use crate::mesh::Mesh;
use crate::part::Part;
use crate::sheet::sheets;
use crate::solid::Solid;
use crate::step::step;
use crate::stl::stl;
use crate::svg::sheet_svg;
use crate::unfit::Unfit;

/// A file to be written.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// Its path in the folder of all: `stl/link-A1-A3.stl`.
    pub path: String,
    /// What it holds.
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

/// The files of a part: STEP, STL, and where it can be cut DXF and SVG.
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
