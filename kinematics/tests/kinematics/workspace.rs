//! Workspace, inscribed circle and conditioning.

use lizard_kinematics::{Elbow, FiveBar, Vector, Workspace};
use proptest::prelude::*;

use crate::reference::HEAD;

fn symmetrical() -> impl Strategy<Value = FiveBar> {
    (5.0..100.0, 5.0..100.0, 0.0..150.0f64).prop_map(|(crank, coupler, base)| FiveBar {
        base,
        crank_left: crank,
        coupler_left: coupler,
        coupler_right: coupler,
        crank_right: crank,
    })
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
        cases: 64, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn the_area_is_that_of_the_points_that_can_be_reached(bars in symmetrical()) {
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
        // A grid misses by about a cell for each cell along the rim.
        let counted = f64::from(inside) * cell * cell;
        prop_assert!((counted - workspace.area()).abs() < 6.0 * edge * cell, "{counted} {}", workspace.area());
    }

    #[test]
    fn the_inscribed_circle_touches_all_four_circles_and_none_is_larger(
        bars in symmetrical(), x in -1.0..1.0f64, y in 0.0..1.0f64,
    ) {
        let workspace = Workspace::of(&bars);
        let clearance = |point: Vector| {
            [-workspace.half_base, workspace.half_base].into_iter().map(|shaft| {
                let distance = (point - Vector::new(shaft, 0.0)).length();
                (distance - workspace.inner).min(workspace.outer - distance)
            }).fold(f64::INFINITY, f64::min)
        };
        if let Some(circle) = workspace.inscribed_circle() {
            prop_assert!((clearance(circle.centre) - circle.radius).abs() < 1e-9);
            let other = Vector::new(x, y) * workspace.outer;
            prop_assert!(clearance(other) <= circle.radius + 1e-9);
        }
    }

    #[test]
    fn the_conditioning_index_lies_between_0_and_1_and_knows_no_scale(
        bars in symmetrical(), x in -100.0..100.0, y in 0.0..100.0f64, scale in 0.01..100.0f64,
    ) {
        let large = FiveBar {
            base: bars.base * scale,
            crank_left: bars.crank_left * scale,
            coupler_left: bars.coupler_left * scale,
            coupler_right: bars.coupler_right * scale,
            crank_right: bars.crank_right * scale,
        };
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

#[test]
fn conditioning_vanishes_where_the_inscribed_circle_touches_the_rim() {
    let circle = Workspace::of(&HEAD).inscribed_circle().unwrap();
    for shaft in [HEAD.left_shaft(), HEAD.right_shaft()] {
        let away = circle.centre - shaft;
        for side in [1.0, -1.0] {
            let rim = circle.centre + away * (side * circle.radius / away.length());
            let a = HEAD.inverse(rim).unwrap()[0];
            assert_eq!(
                (a.working_mode.left, a.working_mode.right),
                (Elbow::Outward, Elbow::Outward)
            );
            let pose = HEAD
                .forward_in(a.assembly_mode, a.theta_left, a.theta_right)
                .unwrap();
            assert!(pose.lci() < 1e-6, "{}", pose.lci());
        }
    }
}
