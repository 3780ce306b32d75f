//! Paths of wires from a row of servos to a row of pins, without crossings.
//!
//! A wire goes down, sideways at its own height, and down again. The servos have the
//! order of their pins, so only the heights have to be chosen: of the wires that go to
//! the same side, the one farthest to that side turns first.

/// A path on the page, with only horizontal and vertical parts.
pub type Path = Vec<(f64, f64)>;

/// Pixels between parallel wires.
pub const GAP: f64 = 13.0;

/// Paths from places in a row to places in a row below, both from left to right. The
/// highest sideways part is at `height`.
pub fn between_rows(from: &[(f64, f64)], to: &[(f64, f64)], height: f64) -> Vec<Path> {
    let goes_right = |wire: usize| to[wire].0 > from[wire].0;
    (0..from.len())
        .map(|wire| {
            let wires_ahead = if goes_right(wire) {
                (wire + 1..from.len())
                    .filter(|other| goes_right(*other))
                    .count()
            } else {
                (0..wire).filter(|other| !goes_right(*other)).count()
            };
            let level = height + GAP * wires_ahead as f64;
            vec![
                from[wire],
                (from[wire].0, level),
                (to[wire].0, level),
                to[wire],
            ]
        })
        .collect()
}

/// The last part of a path that runs down the right side of a board and then to a pin in the
/// board's lower row; `index` counts such wires from the board outwards.
pub fn route_end(corner: (f64, f64), index: usize, pin: (f64, f64)) -> Path {
    let (x, y) = turn_point(corner, index);
    vec![(x, y), (pin.0, y), pin]
}

/// The point near a board's lower right corner (`corner`) where a wire to the lower row of pins
/// turns; `index` counts such wires from the board outwards.
pub fn turn_point(corner: (f64, f64), index: usize) -> (f64, f64) {
    let offset = GAP * (index as f64 + 1.0);
    (corner.0 + offset, corner.1 + offset)
}
