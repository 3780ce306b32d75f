//! Paths of wires between a row of servos and a row of pins, without crossings.
//!
//! A wire leads down, sideways at its own height, and down again. The servos stand in the order of their pins, so only
//! the heights must be chosen: among the wires that lead to the same side, the outermost wire turns first.

/// A path on the page, with only horizontal and vertical segments.
pub type Path = Vec<(f64, f64)>;

/// Distance between parallel wires, pixels.
pub const WIRE_SPACING: f64 = 13.0;

/// Returns the paths of wires from `starts`, a row of points, to `ends`, a row below; both rows are ordered from left
/// to right. The highest horizontal segment is at y = `first_turn_y`.
pub fn route_between_rows(
    starts: &[(f64, f64)],
    ends: &[(f64, f64)],
    first_turn_y: f64,
) -> Vec<Path> {
    let leads_right = |wire: usize| ends[wire].0 > starts[wire].0;
    let route_wire = |wire: usize| {
        // The wires farther out on the side to which this wire leads. Those of them that lead to the same side turn
        // before this wire.
        let outer_wires = match leads_right(wire) {
            true => wire + 1..starts.len(),
            false => 0..wire,
        };
        let leads_to_same_side = |outer_wire: &usize| leads_right(*outer_wire) == leads_right(wire);
        let outer_count = outer_wires.filter(leads_to_same_side).count();
        let turn_y = first_turn_y + WIRE_SPACING * outer_count as f64;
        let (start, end) = (starts[wire], ends[wire]);
        vec![start, (start.0, turn_y), (end.0, turn_y), end]
    };
    (0..starts.len()).map(route_wire).collect()
}

/// Returns the point near a board's lower right corner (`corner`) where wire `index` to the lower row of pins turns.
/// The wires are counted from the board outwards.
pub fn turn_point(corner: (f64, f64), index: usize) -> (f64, f64) {
    let offset = WIRE_SPACING * (index as f64 + 1.0);
    (corner.0 + offset, corner.1 + offset)
}
