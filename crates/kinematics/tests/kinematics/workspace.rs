//! Workspace, inscribed circle and conditioning.

use lizard_kinematics::{FiveBar, Vector, WorkingMode, Workspace};
use proptest::prelude::*;

use crate::reference::HEAD;

fn symmetrical_bars() -> impl Strategy<Value = FiveBar> {
    (5.0..100.0, 5.0..100.0, 0.0..150.0f64)
        .prop_map(|(crank, coupler, base)| FiveBar::new([base, crank, coupler, coupler, crank]))
}

#[test]
fn the_papers_head_has_the_workspace_that_was_measured() {
    let workspace = Workspace::of(&HEAD);
    assert!((workspace.area() - 14_892.6).abs() < 0.05);
    let circle = workspace.inscribed_circle().unwrap();
    assert_eq!(circle.radius, 30.0);
    assert!((circle.centre.y - 48.990).abs() < 1e-3);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64, ..ProptestConfig::default()
    })]

    #[test]
    fn the_area_is_that_of_the_points_that_can_be_reached(bars in symmetrical_bars()) {
        let workspace = Workspace::of(&bars);
        let edge = workspace.outer;
        let n = 400;
        let cell = 2.0 * edge / f64::from(n);
        let mut inside = 0;
        for i in 0..n {
            for j in 0..n {
                let at = |k: i32| -edge + (f64::from(k) + 0.5) * cell;
                let point = Vector::new(at(i), at(j));
                let reached = bars.inverse(point).is_ok();
                prop_assert_eq!(workspace.contains(point), reached);
                inside += i32::from(reached);
            }
        }
        // The count is wrong by about one cell for each cell along the edge of the workspace.
        let counted = f64::from(inside) * cell * cell;
        prop_assert!((counted - workspace.area()).abs() < 6.0 * edge * cell, "{counted} {}", workspace.area());
    }

    #[test]
    fn the_inscribed_circle_is_as_large_as_the_unreachable_points_allow(
        bars in symmetrical_bars(),
    ) {
        let workspace = Workspace::of(&bars);
        let found = workspace.inscribed_circle().map_or(0.0, |circle| circle.radius);
        let (largest, cell) = largest_by_distance_field(&bars);
        prop_assert!((found - largest).abs() <= 1.5 * cell, "{found} {largest} cell {cell}");
    }

    #[test]
    fn the_inscribed_circle_stays_inside_and_none_is_larger(
        bars in symmetrical_bars(), x in -1.0..1.0f64, y in -1.0..1.0f64,
    ) {
        let workspace = Workspace::of(&bars);
        let clearance = |point: Vector| {
            [-workspace.half_base, workspace.half_base].into_iter().map(|shaft| {
                let distance = (point - Vector::new(shaft, 0.0)).length();
                (distance - workspace.inner).min(workspace.outer - distance)
            }).fold(f64::INFINITY, f64::min)
        };
        let other = clearance(Vector::new(x, y) * workspace.outer);
        match workspace.inscribed_circle() {
            Some(circle) => {
                prop_assert!(circle.centre.y >= 0.0);
                prop_assert!((clearance(circle.centre) - circle.radius).abs() < 1e-9);
                prop_assert!(other <= circle.radius + 1e-9);
            }
            None => prop_assert!(other <= 0.0),
        }
    }

    #[test]
    fn the_conditioning_index_lies_between_0_and_1_and_does_not_depend_on_scale(
        bars in symmetrical_bars(), x in -100.0..100.0, y in 0.0..100.0f64, scale in 0.01..100.0f64,
    ) {
        let (crank, coupler) = (bars.crank_left, bars.coupler_left);
        let large = [bars.base, crank, coupler, coupler, crank].map(|length| length * scale);
        let large = FiveBar::new(large);
        if let Ok(all) = bars.inverse(Vector::new(x, y)) {
            for a in all {
                let (Ok(one), Ok(two)) = (
                    bars.forward_in(a.assembly_mode, a.theta_left, a.theta_right),
                    large.forward_in(a.assembly_mode, a.theta_left, a.theta_right),
                ) else { continue };
                prop_assert!((0.0..=1.0 + 1e-12).contains(&one.lci()));
                prop_assume!(one.gap.length() > 1e-3);
                prop_assert!((one.lci() - two.lci()).abs() < 1e-6);
            }
        }
    }
}

/// The largest distance of a reachable grid cell from the nearest unreachable point, and the width of a cell.
/// A shaft counts as unreachable, even if an arm with two equal links can be folded onto it.
fn largest_by_distance_field(bars: &FiveBar) -> (f64, f64) {
    const CELLS: usize = 120;
    let reach = bars.crank_left + bars.coupler_left;
    let cell = 2.2 * reach / CELLS as f64;
    let at = |k: usize| (k as f64 + 0.5) * cell - 1.1 * reach;
    let point = |i: usize, j: usize| Vector::new(at(i), at(j));
    let reached = |i| {
        (0..CELLS)
            .map(|j| bars.inverse(point(i, j)).is_ok())
            .collect()
    };
    let inside: Vec<Vec<bool>> = (0..CELLS).map(reached).collect();
    let mut rim = vec![bars.left_shaft(), bars.right_shaft()];
    for i in 1..CELLS - 1 {
        for j in 1..CELLS - 1 {
            let beside = [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)];
            if !inside[i][j] && beside.into_iter().any(|(i, j)| inside[i][j]) {
                rim.push(point(i, j));
            }
        }
    }
    let mut largest = 0.0_f64;
    for (i, column) in inside.iter().enumerate() {
        for j in (0..CELLS).filter(|&j| column[j]) {
            let squares = rim
                .iter()
                .map(|&outside| (point(i, j) - outside).length_squared());
            largest = largest.max(squares.fold(f64::INFINITY, f64::min));
        }
    }
    (largest.sqrt(), cell)
}

#[test]
fn a_wide_base_leaves_a_circle_between_the_shafts() {
    // r1 .2, r2 .3, r3 .4 at a base of 20 mm.
    let bars = FiveBar::new([20.0, 5.0, 7.5, 7.5, 5.0]);
    let circle = Workspace::of(&bars).inscribed_circle().unwrap();
    assert_eq!((circle.centre, circle.radius), (Vector::new(0.0, 0.0), 2.5));
}

#[test]
fn conditioning_vanishes_where_the_inscribed_circle_touches_the_rim() {
    let circle = Workspace::of(&HEAD).inscribed_circle().unwrap();
    for shaft in [HEAD.left_shaft(), HEAD.right_shaft()] {
        let away = circle.centre - shaft;
        for side in [1.0, -1.0] {
            let rim = circle.centre + away * (side * circle.radius / away.length());
            let a = HEAD.inverse(rim).unwrap()[0];
            assert_eq!(a.working_mode, WorkingMode::OUTWARD);
            let pose = HEAD.forward_in(a.assembly_mode, a.theta_left, a.theta_right);
            let index = pose.unwrap().lci();
            assert!(index < 1e-6, "{index}");
        }
    }
}
