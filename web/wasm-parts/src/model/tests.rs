//! Tests of the model of a robot's parts.

use lizard_kinematics::Vector;
use lizard_twin::Shape;

use super::*;
use crate::solids::Triangles;

const PAPER: &str = include_str!("../../../../robots/paper.toml");

fn make_model(drive: &str) -> Model {
    Model::from_toml(&format!("{PAPER}\n[leg.drive]\nkind = \"{drive}\""))
        .expect("paper.toml is valid with either drive")
}

/// Converts a point from a mount's frame to the chassis frame.
fn to_chassis([x, y, cos, sin]: [f64; 4], point: Vector) -> Vector {
    let (origin, x_axis) = (Vector::new(x, y), Vector::new(cos, sin));
    origin + x_axis * point.x + x_axis.rotated_left() * point.y
}

#[test]
fn the_mounts_of_lagging_legs_match_the_shape_of_the_twin() {
    let model = make_model("strut");
    let robot = model.assembly.robot().clone();
    let neutral: [f64; 4] = robot.neutral_pose().into();
    let angles = [0, 1, 2, 3].map(|servo| neutral[servo] + [4.0, -6.0, 3.0, 5.0][servo]);
    let lags = [0.0, 2.5, -3.0, 7.0];
    let sweeps = [0, 1, 2, 3].map(|i| FORWARD_TURN_SIGN[i] * (angles[i] - neutral[i]) - lags[i]);
    let shape = Shape::from_angles(&robot, angles, sweeps).expect("every loop closes");
    let placements = model.place_mounts(angles, lags).expect("every loop closes");
    let placement_of = |mount| placements[model.mount_index(mount)];
    for servo in 0..4 {
        let (leg, plan) = (shape.legs[servo], &model.assembly.layout().legs[servo]);
        let mounts = [Mount::Crank(servo), Mount::Follower(servo)];
        for (joint, mount) in leg.joints.into_iter().zip(mounts) {
            let error = (to_chassis(placement_of(mount), plan.crank_joint) - joint).length();
            assert!(error < 1e-9, "{mount:?} is off by {error} mm");
        }
        let error = (to_chassis(placement_of(Mount::Foot(servo)), plan.foot) - leg.foot).length();
        assert!(error < 1e-9, "foot {servo} is off by {error} mm");
        let [from, to] = leg.strut_anchors;
        let strut_end = Vector::new((to - from).length(), 0.0);
        let strut = placement_of(Mount::Strut(servo));
        let error = (to_chassis(strut, Vector::default()) - from).length()
            + (to_chassis(strut, strut_end) - to).length();
        assert!(error < 1e-9, "strut {servo} is off by {error} mm");
    }
}

#[test]
fn the_mounts_of_legs_that_do_not_lag_match_the_assembly() {
    let model = make_model("rigid");
    let robot = model.assembly.robot();
    let angles = [130.0, 45.0, 322.0, 219.0];
    let pose = robot.lizard().solve(&angles.into());
    let pose = pose.expect("every loop closes");
    let placements = model.place_mounts(angles, [0.0; 4]);
    let placements = placements.expect("every loop closes");
    assert_eq!(placements.len(), model.mounts.len());
    for (mount, placement) in model.mounts.iter().zip(placements) {
        let Placement { origin, x_axis } = model.assembly.placement(*mount, &pose);
        let expected = [origin.x, origin.y, x_axis.x, x_axis.y].into_iter();
        let errors = expected.zip(placement).map(|(a, b)| (a - b).abs());
        let error = errors.fold(0.0, f64::max);
        assert!(error < 1e-9, "{mount:?} is off by {error} mm");
    }
}

/// Returns the corners of each solid.
fn list_corners(solids: &[Triangles]) -> Vec<Vec<[f32; 3]>> {
    let corners = solids.iter().map(|solid| solid.corners.as_chunks().0);
    corners.map(<[_]>::to_vec).collect()
}

#[test]
fn every_solid_has_the_height_of_its_body_and_no_corner_outside_the_body() {
    let model = make_model("strut");
    let (description, solids) = (model.describe(), model.make_solids());
    let solids = list_corners(&solids.expect("every solid is closed"));
    let largest_solid_index = description.bodies.iter().map(|body| body.solid).max();
    assert_eq!(largest_solid_index, Some(solids.len() - 1));
    for (body_entry, body) in description.bodies.iter().zip(model.assembly.bodies()) {
        let matrix = body_entry.matrix;
        let z = solids[body_entry.solid].iter().map(|corner| {
            let [x, y, z] = corner.map(f64::from);
            matrix[2] * x + matrix[6] * y + matrix[10] * z + matrix[14]
        });
        let (low, high) = z.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
            (low.min(z), high.max(z))
        });
        let [from, to] = body.z();
        let name = &body.name;
        let has_height = (low - from).abs() < 1e-4 && (high - to).abs() < 1e-4;
        assert!(has_height, "{name}: z from {low} to {high} mm");
        // Seen from above, each corner must lie on or within the body's shapes.
        for corner in &solids[body_entry.solid] {
            let [x, y, _] = corner.map(f64::from);
            let point = Vector::new(
                matrix[0] * x + matrix[4] * y + matrix[12],
                matrix[1] * x + matrix[5] * y + matrix[13],
            );
            let shapes = body.prisms.iter().flat_map(|prism| &prism.filled_shapes);
            let corner = lizard_parts::Shape::disc(point, 0.0);
            let distances = shapes.map(|shape| shape.distance(&corner));
            let error = distances.fold(f64::INFINITY, f64::min);
            assert!(
                error < 1e-3,
                "{name} has a corner {error} mm outside its shapes"
            );
        }
    }
}

#[test]
fn every_body_has_a_step_and_every_part_has_one_body_per_piece() {
    let model = make_model("strut");
    let description = model.describe();
    assert_eq!(description.steps.len(), 15);
    let mut steps = description.bodies.iter().map(|body| body.step);
    assert!(steps.all(|step| (1..=14).contains(&step)));
    let counts = description.parts.iter().enumerate().map(|(index, part)| {
        let bodies = description
            .bodies
            .iter()
            .filter(|body| body.part == Some(index));
        (part, bodies.count())
    });
    for (part, count) in counts {
        assert_eq!(part.count, count, "{}", part.name);
    }
    let sole_depth = description.sole_depth;
    assert!(sole_depth > 20.0, "{sole_depth} mm");
}

#[test]
fn the_refusal_of_impossible_parts_names_the_key_and_the_value() {
    let toml = format!("{PAPER}\n[parts]\nheight = 10.0");
    let refusal = Model::from_toml(&toml).err().expect("the robot is refused");
    let message = refusal.reason;
    assert!(message.starts_with("parts.height "), "{message}");
    assert!(message.ends_with(" 10 mm"), "{message}");
    assert!(Model::from_toml("[links]").is_err());
}
