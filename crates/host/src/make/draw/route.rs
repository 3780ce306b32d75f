//! Paths of wires from a row of servos to a row of pins, without crossings.
//!
//! A wire leads down, sideways at its own height, and down again. The servos stand in the order of their pins, so only
//! the heights have to be chosen: of the wires that lead to the same side, the one farthest to that side turns first.

/// A path on the page, with only horizontal and vertical parts.
pub type Path = Vec<(f64, f64)>;

/// Distance between parallel wires, pixels.
pub const WIRE_SPACING: f64 = 13.0;

/// The paths of wires from the points of a row to those of a row below; both rows are ordered from left to right. The
/// highest sideways part is at y = `first_turn_y`.
pub fn paths_between_rows(from: &[(f64, f64)], to: &[(f64, f64)], first_turn_y: f64) -> Vec<Path> {
    let leads_right = |wire: usize| to[wire].0 > from[wire].0;
    (0..from.len())
        .map(|wire| {
            let ahead_count = if leads_right(wire) {
                (wire + 1..from.len())
                    .filter(|ahead| leads_right(*ahead))
                    .count()
            } else {
                (0..wire).filter(|ahead| !leads_right(*ahead)).count()
            };
            let turn_y = first_turn_y + WIRE_SPACING * ahead_count as f64;
            vec![
                from[wire],
                (from[wire].0, turn_y),
                (to[wire].0, turn_y),
                to[wire],
            ]
        })
        .collect()
}

/// The last part of a path that leads down the right side of a board and then to a pin in the board's lower row, from
/// the [`turn_point`] on.
pub fn path_end(corner: (f64, f64), index: usize, pin: (f64, f64)) -> Path {
    let (x, y) = turn_point(corner, index);
    vec![(x, y), (pin.0, y), pin]
}

/// The point near a board's lower right corner (`corner`) at which a wire to the lower row of pins
/// turns; `index` counts such wires from the board outwards.
pub fn turn_point(corner: (f64, f64), index: usize) -> (f64, f64) {
    let offset = WIRE_SPACING * (index as f64 + 1.0);
    (corner.0 + offset, corner.1 + offset)
}
