//! A sheet as a DXF file of AutoCAD release 12, which every cutter's software can read.
//!
//! The existing DXF crate depends on an image decoder and a calendar, so this module has its own writer for the few
//! entities that a sheet needs.

use std::fmt::Write;

use crate::files::sheet::{Sheet, compute_sheet_bounds};
use crate::layers::outline::Loop;

/// Formats a sheet as DXF. `kerf` is the width of the cut, mm; the lines are the part's edge, not the cutter's path.
pub fn format_dxf(sheet: &Sheet, kerf: f64) -> String {
    let mut dxf = DxfWriter::default();
    let [low, high] = compute_sheet_bounds(sheet);
    let (name, thickness, half_kerf) = (&sheet.name, sheet.thickness, kerf / 2.0);
    dxf.add_group(999, format!(
        "{name}: mm, 1:1, {thickness:.2} mm thick; lines are the part's edge, cut {half_kerf:.2} mm away in the waste (kerf {kerf} mm)"
    ));
    dxf.add_groups(&[(0, "SECTION"), (2, "HEADER")]);
    dxf.add_groups(&[(9, "$ACADVER"), (1, "AC1009")]);
    dxf.add_groups(&[(9, "$INSUNITS"), (70, "4"), (9, "$MEASUREMENT"), (70, "1")]);
    dxf.add_group(9, "$EXTMIN");
    dxf.add_point(10, low.x, low.y);
    dxf.add_group(9, "$EXTMAX");
    dxf.add_point(10, high.x, high.y);
    dxf.add_group(0, "ENDSEC");
    dxf.add_layers(sheet);
    dxf.add_groups(&[(0, "SECTION"), (2, "ENTITIES")]);
    for layer in &sheet.layers {
        for outline_loop in &layer.loops {
            dxf.add_loop(outline_loop, &layer.name);
        }
    }
    dxf.add_groups(&[(0, "ENDSEC"), (0, "EOF")]);
    dxf.0
}

/// The text of a DXF file: pairs of a group code and a value.
#[derive(Default)]
struct DxfWriter(String);

impl DxfWriter {
    fn add_group(&mut self, code: u32, value: impl std::fmt::Display) {
        let _ = write!(self.0, "{code:>3}\r\n{value}\r\n");
    }

    fn add_groups(&mut self, pairs: &[(u32, &str)]) {
        for (code, value) in pairs {
            self.add_group(*code, value);
        }
    }

    fn add_real(&mut self, code: u32, value: f64) {
        // Adding 0 removes the sign of a negative zero.
        let value = (value * 1e9).round() / 1e9 + 0.0;
        self.add_group(code, format!("{value:.9}"));
    }

    fn add_point(&mut self, code: u32, x: f64, y: f64) {
        self.add_real(code, x);
        self.add_real(code + 10, y);
        self.add_real(code + 20, 0.0);
    }

    fn add_layers(&mut self, sheet: &Sheet) {
        self.add_groups(&[(0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "LAYER")]);
        self.add_group(70, sheet.layers.len());
        for (index, layer) in sheet.layers.iter().enumerate() {
            self.add_groups(&[(0, "LAYER"), (2, &layer.name), (70, "0")]);
            // The colour: red for lines to cut through; blue, magenta and so on for pockets.
            self.add_group(62, if index == 0 { 1 } else { 4 + index });
            self.add_group(6, "CONTINUOUS");
        }
        self.add_groups(&[(0, "ENDTAB"), (0, "ENDSEC")]);
    }

    fn add_loop(&mut self, outline_loop: &Loop, layer: &str) {
        if let Some((centre, radius)) = outline_loop.circle() {
            self.add_groups(&[(0, "CIRCLE"), (8, layer)]);
            self.add_point(10, centre.x, centre.y);
            self.add_real(40, radius);
            return;
        }
        self.add_groups(&[(0, "POLYLINE"), (8, layer), (66, "1")]);
        self.add_point(10, 0.0, 0.0);
        self.add_group(70, 1);
        for side in &outline_loop.sides {
            self.add_groups(&[(0, "VERTEX"), (8, layer)]);
            self.add_point(10, side.from.x, side.from.y);
            self.add_real(42, side.bulge);
        }
        self.add_groups(&[(0, "SEQEND"), (8, layer)]);
    }
}
