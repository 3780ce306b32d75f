//! A sheet as an SVG drawing, 1:1 in mm.

use std::fmt::Write;

use lizard_kinematics::Vector;

use crate::files::sheet::{Sheet, SheetLayer, compute_sheet_bounds};
use crate::layers::outline::Loop;

/// Margin around the sheet, mm.
const MARGIN: f64 = 5.0;
/// Colours of the layers: the first for lines to cut through, the others for pockets.
const COLOURS: [&str; 5] = ["#d00000", "#0050c0", "#a000a0", "#008040", "#806000"];

/// Formats a sheet as SVG. `kerf` is the width of the cut, mm; the lines are the part's edge, not the cutter's path.
pub fn format_svg(sheet: &Sheet, kerf: f64) -> String {
    let [low, high] = compute_sheet_bounds(sheet);
    let (width, height) = (high.x - low.x + 2.0 * MARGIN, high.y - low.y + 2.0 * MARGIN);
    let to_page = |position: Vector| (position.x - low.x + MARGIN, high.y - position.y + MARGIN);
    let (name, thickness, half_kerf) = (&sheet.name, sheet.thickness, kerf / 2.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.3}mm\" height=\"{height:.3}mm\" \
         viewBox=\"0 0 {width:.3} {height:.3}\">\n\
         <desc>{name}: 1:1 in mm, {thickness:.2} mm thick. Lines are the edge of the part; the cutter's path is \
         {half_kerf:.2} mm away from them, on the side of the waste (kerf {kerf} mm).</desc>\n"
    );
    for (SheetLayer { name, loops }, colour) in sheet.layers.iter().zip(COLOURS.iter().cycle()) {
        let style = format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"0.1\"");
        let _ = writeln!(svg, "<g id=\"{name}\" {style}>");
        for outline_loop in loops {
            let _ = match outline_loop.circle() {
                Some((centre, r)) => {
                    let (x, y) = to_page(centre);
                    writeln!(svg, "<circle cx=\"{x:.6}\" cy=\"{y:.6}\" r=\"{r:.6}\"/>")
                }
                None => {
                    let path_data = format_path(outline_loop, to_page);
                    writeln!(svg, "<path d=\"{path_data}\"/>")
                }
            };
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

/// Formats the path data of a loop.
fn format_path(outline_loop: &Loop, to_page: impl Fn(Vector) -> (f64, f64)) -> String {
    let mut path_data = String::new();
    for (index, (side, to)) in outline_loop.sides_with_end_points().enumerate() {
        let (x, y) = to_page(side.from);
        if index == 0 {
            let _ = write!(path_data, "M{x:.6} {y:.6}");
        }
        let (x, y) = to_page(to);
        let _ = match side.arc(to) {
            // The page's y axis points down, so a left turn has the sweep flag 0.
            Some((_, radius)) => write!(
                path_data,
                "A{radius:.6} {radius:.6} 0 {} {} {x:.6} {y:.6}",
                u8::from(side.bulge.abs() > 1.0),
                u8::from(side.bulge < 0.0)
            ),
            None => write!(path_data, "L{x:.6} {y:.6}"),
        };
    }
    path_data.push('Z');
    path_data
}
