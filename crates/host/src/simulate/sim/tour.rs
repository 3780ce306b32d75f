//! The selection of a robot's gaits for a demonstration.

use lizard_robot::Robot;

/// Names of the gaits that move a servo, in the order of robot.toml.
pub fn moving_gaits(robot: &Robot) -> Vec<&str> {
    let gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
    gaits.map(|gait| gait.name()).collect()
}

/// Names of the gaits of a demonstration: the first moving gait, then the one of the other moving gaits that is
/// predicted to turn the robot most in a cycle. With fewer than two moving gaits, the list is shorter.
pub fn demonstration_gaits(robot: &Robot) -> Vec<&str> {
    let gaits = moving_gaits(robot);
    let turn_of = |name: &str| {
        let gait = robot.gait(name);
        gait.map_or(0.0, |gait| robot.predict(gait).turn.map_or(0.0, f64::abs))
    };
    let other_gaits = gaits.iter().copied().skip(1);
    // Mirrored gaits turn equally far; the tolerance keeps the first of them.
    let turning_gait = other_gaits.fold(None, |best: Option<&str>, name| match best {
        Some(best) if turn_of(name) <= turn_of(best) + 1e-6 => Some(best),
        _ => Some(name),
    });
    gaits
        .first()
        .copied()
        .into_iter()
        .chain(turning_gait)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_demonstration_of_the_paper_robot_is_walk_and_left() {
        let robot = crate::shared::robot_file::built_in_robot("paper");
        assert_eq!(demonstration_gaits(&robot), ["walk", "left"]);
        assert!(!moving_gaits(&robot).contains(&"stand"));
    }
}
