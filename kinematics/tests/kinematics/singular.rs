//! The singular curves: what they name is singular, and a fine scan of the
//! plane finds no sign change of a margin that they do not name.

use lizard_kinematics::{FiveBar, Singularity, wrap};

use crate::reference::HEAD;

fn margin(bars: &FiveBar, kind: Singularity, left: f64, right: f64) -> Option<f64> {
    let pose = bars.forward(left, right).ok()?;
    Some(match kind {
        Singularity::Couplers => pose.type2,
        Singularity::LeftArm => pose.type1_left(),
        Singularity::RightArm => pose.type1_right(),
    })
}

#[test]
fn every_sign_change_of_a_type_1_margin_lies_on_a_named_curve() {
    let unequal = FiveBar {
        crank_left: 25.0,
        coupler_left: 55.0,
        ..HEAD
    };
    let mut crossings = 0;
    for bars in [HEAD, unequal] {
        for left in (-175..180).step_by(10).map(f64::from) {
            let named: Vec<_> = bars.singular_with(left).collect();
            for kind in [Singularity::LeftArm, Singularity::RightArm] {
                for step in 0..3600 {
                    let (a, b) = (f64::from(step) / 10.0 + 0.03, f64::from(step) / 10.0 + 0.13);
                    let (Some(before), Some(after)) =
                        (margin(&bars, kind, left, a), margin(&bars, kind, left, b))
                    else {
                        continue;
                    };
                    // Near d = 0 the apex swings about and signs jump.
                    let gap = bars.forward(left, a).unwrap().gap.length();
                    if before * after >= 0.0 || gap < 1.0 {
                        continue;
                    }
                    crossings += 1;
                    let near = named.iter().any(|pose| {
                        pose.kind == kind && wrap(pose.theta_right - (a + b) / 2.0).abs() < 0.2
                    });
                    assert!(near, "{kind:?} at {left} {a}: {named:?}");
                }
            }
        }
    }
    assert!(crossings > 100, "{crossings}");
}

#[test]
fn what_is_named_is_singular() {
    let short = FiveBar {
        coupler_left: 30.0,
        coupler_right: 25.0,
        ..HEAD
    };
    let mut kinds = [0; 3];
    for bars in [HEAD, short] {
        for left in -180..180 {
            for pose in bars.singular_with(f64::from(left)) {
                kinds[pose.kind as usize] += 1;
                if let Some(value) = margin(&bars, pose.kind, pose.theta_left, pose.theta_right) {
                    assert!(value.abs() < 1e-6, "{pose:?} {value}");
                }
            }
        }
    }
    assert!(kinds.iter().all(|count| *count > 100), "{kinds:?}");
    assert!(
        (0..360).all(|left| HEAD
            .singular_with(f64::from(left))
            .all(|pose| pose.kind != Singularity::Couplers)),
        "the paper's couplers never stretch: d <= 80 < 100"
    );
}

#[test]
fn the_crank_tips_coincide_where_the_paper_never_looks() {
    let poses: Vec<_> = HEAD.coinciding_tips().collect();
    assert_eq!(poses.len(), 2);
    for pose in poses {
        assert!((pose.theta_left.abs() - 70.52878).abs() < 1e-5);
        assert!((pose.theta_right.abs() - 109.47122).abs() < 1e-5);
    }
}

#[test]
fn no_path_of_good_margins_leads_to_crossed_cranks() {
    // Poses with every margin, legs too, at .3, on a half degree grid between
    // the legs' change points at 0 and 180, cut into connected regions: none
    // holds both signs of K2.
    const N: usize = 360;
    let state = |left: usize, right: usize| {
        let (left, right) = (left as f64 / 2.0 + 0.25, right as f64 / 2.0 + 0.25);
        let pose = HEAD.forward(left, right).ok()?;
        let leg = pose.left.y.abs().min(pose.right.y.abs());
        (pose.margin().min(leg) >= 0.3).then_some(pose.gap.x > 0.0)
    };
    let grid: Vec<Option<bool>> = (0..N * N).map(|i| state(i / N, i % N)).collect();
    let mut seen = vec![false; N * N];
    let (mut crossed, mut uncrossed) = (0, 0);
    for start in 0..N * N {
        if grid[start].is_none() || seen[start] {
            continue;
        }
        let mut open = vec![start];
        seen[start] = true;
        while let Some(i) = open.pop() {
            let (left, right) = (i / N, i % N);
            assert_eq!(grid[i], grid[start], "a way across at {left} {right}");
            match grid[i] {
                Some(true) => uncrossed += 1,
                _ => crossed += 1,
            }
            for (dl, dr) in [(1, 0), (N - 1, 0), (0, 1), (0, N - 1)] {
                let next = (left + dl) % N * N + (right + dr) % N;
                if grid[next].is_some() && !seen[next] {
                    seen[next] = true;
                    open.push(next);
                }
            }
        }
    }
    assert!(crossed > 100 && uncrossed > 100, "{crossed} {uncrossed}");
}
