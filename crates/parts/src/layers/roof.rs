//! Roofs that a printer can make without supports.
//!
//! A pocket on the underside of a part has a roof with a hole in the middle. A printer can span the pocket with
//! straight lines from edge to edge, but cannot draw a ring in mid-air. One layer therefore bridges the hole, and is
//! drilled through after printing.

use lizard_kinematics::Vector;

use crate::layers::body::Prism;
use crate::layers::outline::{Loop, Outline};
use crate::layers::shape::Shape;

/// Height of a printed layer, mm; one layer bridges a hole.
pub const PRINT_LAYER_MM: f64 = 0.2;
/// Distance from a hole's edge at which material is sought, in the hole's layer and in the layer below, mm.
const SUPPORT_DISTANCE_MM: f64 = 0.3;
/// Tolerance within which heights count as equal, mm.
const SAME_HEIGHT_MM: f64 = 1e-6;

/// Bridges each hole that would begin in mid-air with one printed layer. Also returns the number of these holes.
pub fn bridge_unsupported_holes(prisms: &[Prism]) -> (Vec<Prism>, usize) {
    let mut layers = prisms.to_vec();
    let unsupported_holes = find_unsupported_holes(prisms);
    for (hole, low) in &unsupported_holes {
        let high = compute_print_layer_top(*low);
        let split_layers = layers.iter().flat_map(|layer| split_at(layer, high));
        layers = split_layers.collect();
        for layer in &mut layers {
            if layer.z[0] > low - SAME_HEIGHT_MM && layer.z[1] < high + SAME_HEIGHT_MM {
                layer.cut_shapes.retain(|cut| cut != *hole);
            }
        }
    }
    (layers, unsupported_holes.len())
}

/// Computes the top of the first printed layer whose middle, where a slicer samples it, is above a height.
fn compute_print_layer_top(low: f64) -> f64 {
    let layer_index =
        ((low - PRINT_LAYER_MM / 2.0 + SAME_HEIGHT_MM) / PRINT_LAYER_MM).floor() + 1.0;
    PRINT_LAYER_MM * (layer_index + 1.0)
}

/// Splits a layer in two at a height. Returns the whole layer if the height is not inside it.
fn split_at(layer: &Prism, height: f64) -> Vec<Prism> {
    let [low, high] = layer.z;
    match height < low + SAME_HEIGHT_MM || height > high - SAME_HEIGHT_MM {
        true => vec![layer.clone()],
        false => vec![
            layer.at_heights([low, height]),
            layer.at_heights([height, high]),
        ],
    }
}

/// Finds the holes that begin in mid-air, each with the height at which it begins, mm.
pub fn find_unsupported_holes(prisms: &[Prism]) -> Vec<(&Shape, f64)> {
    let mut unsupported_holes = Vec::new();
    for pair in prisms.windows(2) {
        let [outline_below, outline] = [0, 1].map(|i| Outline::from_prism(&pair[i]));
        for hole in &pair[1].cut_shapes {
            if begins_in_mid_air(hole, &outline, &outline_below) {
                unsupported_holes.push((hole, pair[1].z[0]));
            }
        }
    }
    unsupported_holes
}

/// True if, all around a hole, its layer has material and the layer below has none.
fn begins_in_mid_air(hole: &Shape, outline: &Outline, outline_below: &Outline) -> bool {
    let widened_hole = hole.grown(SUPPORT_DISTANCE_MM);
    let surround = Outline::from_prism(&Prism::solid([widened_hole], [0.0, 1.0]));
    let mut sides = surround.loops().flat_map(Loop::sides_with_end_points);
    let is_in_mid_air = |point: Vector| outline.contains(point) && !outline_below.contains(point);
    sides.all(|(side, to)| is_in_mid_air(side.from) && is_in_mid_air(side.midpoint(to)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bridging_layer_contains_exactly_one_sampled_height() {
        for low in [2.0, 4.1, 1.33, 3.0, 0.85] {
            let high = compute_print_layer_top(low);
            // Slicers sample a part at 0.1, 0.3, 0.5 mm and so on.
            let sample_heights = (0..100).map(|i| 0.1 + PRINT_LAYER_MM * f64::from(i));
            let contained_heights = sample_heights.filter(|z| low + 1e-9 < *z && *z < high - 1e-9);
            assert_eq!(contained_heights.count(), 1, "{low} to {high} mm");
            assert!((0.09..0.31).contains(&(high - low)), "{low} to {high} mm");
        }
    }
}
