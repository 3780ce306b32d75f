//! The workspace of a five-bar, its inscribed circle, and the conditioning index.

use lizard_kinematics::{FiveBar, Vector, WorkingMode, Workspace};
use proptest::prelude::*;

use crate::reference::PAPER_HEAD;

/// Random five-bars with equal arms.
fn any_symmetrical_five_bar() -> impl Strategy<Value = FiveBar> {
    (5.0..100.0, 5.0..100.0, 0.0..150.0f64)
        .prop_map(|(crank, coupler, base)| FiveBar::new([base, crank, coupler, coupler, crank]))
}

#[test]
fn the_papers_head_has_the_expected_workspace_and_inscribed_circle() {
    let workspace = Workspace::for_five_bar(&PAPER_HEAD);
    assert!((workspace.area() - 14_892.6).abs() < 0.05);
    let circle = workspace.inscribed_circle().unwrap();
    assert_eq!(circle.radius, 30.0);
    assert!((circle.centre.y - 48.990).abs() < 1e-3);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_workspace_consists_of_the_reachable_points(five_bar in any_symmetrical_five_bar()) {
        let workspace = Workspace::for_five_bar(&five_bar);
        let outer_radius = workspace.outer_radius;
        let cells_per_side = 400;
        let cell_width = 2.0 * outer_radius / f64::from(cells_per_side);
        let mut reachable_count = 0;
        for i in 0..cells_per_side {
            for j in 0..cells_per_side {
                let coordinate = |k: i32| -outer_radius + (f64::from(k) + 0.5) * cell_width;
                let point = Vector::new(coordinate(i), coordinate(j));
                let is_reachable = five_bar.inverse(point).is_ok();
                prop_assert_eq!(workspace.contains(point), is_reachable);
                reachable_count += i32::from(is_reachable);
            }
        }
        // Only cells on the rim of the workspace can be counted wrongly, and their errors partly cancel.
        let counted_area = f64::from(reachable_count) * cell_width * cell_width;
        prop_assert!((counted_area - workspace.area()).abs() < 6.0 * outer_radius * cell_width, "counted area {counted_area}, computed area {}", workspace.area());
    }

    #[test]
    fn the_inscribed_circle_is_as_large_as_the_unreachable_points_allow(
        five_bar in any_symmetrical_five_bar(),
    ) {
        let workspace = Workspace::for_five_bar(&five_bar);
        let radius = workspace.inscribed_circle().map_or(0.0, |circle| circle.radius);
        let (clearance, cell_width) = max_clearance_on_grid(&five_bar);
        prop_assert!((radius - clearance).abs() <= 1.5 * cell_width, "radius {radius}, clearance {clearance}, cell width {cell_width}");
    }

    #[test]
    fn the_inscribed_circle_touches_the_rim_and_none_is_larger(
        five_bar in any_symmetrical_five_bar(), x in -1.0..1.0f64, y in -1.0..1.0f64,
    ) {
        let workspace = Workspace::for_five_bar(&five_bar);
        let clearance_at = |point: Vector| {
            [-workspace.half_base, workspace.half_base].into_iter().map(|shaft_x| {
                let distance = (point - Vector::new(shaft_x, 0.0)).length();
                (distance - workspace.inner_radius).min(workspace.outer_radius - distance)
            }).fold(f64::INFINITY, f64::min)
        };
        let other_clearance = clearance_at(Vector::new(x, y) * workspace.outer_radius);
        match workspace.inscribed_circle() {
            Some(circle) => {
                prop_assert!(circle.centre.y >= 0.0);
                prop_assert!((clearance_at(circle.centre) - circle.radius).abs() < 1e-9);
                prop_assert!(other_clearance <= circle.radius + 1e-9);
            }
            None => prop_assert!(other_clearance <= 0.0),
        }
    }

    #[test]
    fn the_conditioning_index_lies_between_0_and_1_and_does_not_depend_on_scale(
        five_bar in any_symmetrical_five_bar(), x in -100.0..100.0, y in 0.0..100.0f64, scale in 0.01..100.0f64,
    ) {
        let (crank, coupler) = (five_bar.left_crank_length, five_bar.left_coupler_length);
        let scaled_lengths = [five_bar.base, crank, coupler, coupler, crank].map(|length| length * scale);
        let scaled_five_bar = FiveBar::new(scaled_lengths);
        if let Ok(solutions) = five_bar.inverse(Vector::new(x, y)) {
            for solution in solutions {
                let (Ok(pose), Ok(scaled_pose)) = (
                    five_bar.forward_in_mode(solution.assembly_mode, solution.theta_left, solution.theta_right),
                    scaled_five_bar.forward_in_mode(solution.assembly_mode, solution.theta_left, solution.theta_right),
                ) else { continue };
                prop_assert!((0.0..=1.0 + 1e-12).contains(&pose.conditioning_index()));
                // If the crank tips coincide, rounding decides the couplers' directions.
                prop_assume!(pose.gap.length() > 1e-3);
                prop_assert!((pose.conditioning_index() - scaled_pose.conditioning_index()).abs() < 1e-6);
            }
        }
    }
}

/// Returns the largest distance of a reachable grid cell from the nearest unreachable point, and the cell width, mm.
/// The shafts count as unreachable, even if an arm with equal links can be folded onto its shaft.
fn max_clearance_on_grid(five_bar: &FiveBar) -> (f64, f64) {
    const CELLS_PER_SIDE: usize = 120;
    let reach = five_bar.left_crank_length + five_bar.left_coupler_length;
    let cell_width = 2.2 * reach / CELLS_PER_SIDE as f64;
    let coordinate = |k: usize| (k as f64 + 0.5) * cell_width - 1.1 * reach;
    let point_at = |i: usize, j: usize| Vector::new(coordinate(i), coordinate(j));
    let reachable_column = |i| {
        (0..CELLS_PER_SIDE)
            .map(|j| five_bar.inverse(point_at(i, j)).is_ok())
            .collect()
    };
    let is_reachable: Vec<Vec<bool>> = (0..CELLS_PER_SIDE).map(reachable_column).collect();
    let mut rim_points = vec![five_bar.left_shaft(), five_bar.right_shaft()];
    for i in 1..CELLS_PER_SIDE - 1 {
        for j in 1..CELLS_PER_SIDE - 1 {
            let neighbours = [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)];
            if !is_reachable[i][j] && neighbours.into_iter().any(|(i, j)| is_reachable[i][j]) {
                rim_points.push(point_at(i, j));
            }
        }
    }
    let mut max_clearance_squared = 0.0_f64;
    for (i, column) in is_reachable.iter().enumerate() {
        for j in (0..CELLS_PER_SIDE).filter(|&j| column[j]) {
            let squares = rim_points
                .iter()
                .map(|&rim_point| (point_at(i, j) - rim_point).length_squared());
            max_clearance_squared =
                max_clearance_squared.max(squares.fold(f64::INFINITY, f64::min));
        }
    }
    (max_clearance_squared.sqrt(), cell_width)
}

#[test]
fn with_a_wide_base_the_inscribed_circle_is_centred_between_the_shafts() {
    // Crank and coupler are 0.5 and 0.75 times half the base.
    let workspace = Workspace::for_five_bar(&FiveBar::new([20.0, 5.0, 7.5, 7.5, 5.0]));
    let circle = workspace.inscribed_circle().unwrap();
    assert_eq!((circle.centre, circle.radius), (Vector::new(0.0, 0.0), 2.5));
}

#[test]
fn the_conditioning_index_vanishes_where_the_inscribed_circle_touches_the_rim() {
    let workspace = Workspace::for_five_bar(&PAPER_HEAD);
    let circle = workspace.inscribed_circle().unwrap();
    for shaft in [PAPER_HEAD.left_shaft(), PAPER_HEAD.right_shaft()] {
        let shaft_to_centre = circle.centre - shaft;
        for side in [1.0, -1.0] {
            let rim_point =
                circle.centre + shaft_to_centre * (side * circle.radius / shaft_to_centre.length());
            let solution = PAPER_HEAD.inverse(rim_point).unwrap()[0];
            assert_eq!(solution.working_mode, WorkingMode::OUTWARD);
            let (left, right) = (solution.theta_left, solution.theta_right);
            let pose = PAPER_HEAD.forward_in_mode(solution.assembly_mode, left, right);
            let index = pose.unwrap().conditioning_index();
            assert!(index < 1e-6, "the index is {index}");
        }
    }
}
