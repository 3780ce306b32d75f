//! Selects gaits of a robot: all gaits that move a servo, or the gaits of a demonstration.

use lizard_robot::Robot;

/// Lists the names of the gaits that move a servo, in the order of robot.toml.
pub fn list_moving_gaits(robot: &Robot) -> Vec<&str> {
    let gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
    gaits.map(|gait| gait.name()).collect()
}

/// Chooses the gaits of a demonstration: the first moving gait, and the other moving gait with the largest predicted
/// turn per cycle. The list is shorter if the robot has fewer than two moving gaits.
pub fn choose_demonstration_gaits(robot: &Robot) -> Vec<&str> {
    let gaits = list_moving_gaits(robot);
    let predict_turn = |name: &str| {
        let gait = robot.gait(name);
        gait.map_or(0.0, |gait| robot.predict(gait).turn.map_or(0.0, f64::abs))
    };
    let other_gaits = gaits.iter().copied().skip(1);
    // Mirrored gaits turn equally far; the tolerance selects the first of them.
    let turning_gait = other_gaits.fold(None, |best: Option<&str>, name| match best {
        Some(best) if predict_turn(name) <= predict_turn(best) + 1e-6 => Some(best),
        _ => Some(name),
    });
    let first_gait = gaits.first().copied();
    first_gait.into_iter().chain(turning_gait).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_demonstration_of_the_paper_robot_is_walk_and_left() {
        let robot = crate::shared::robot_args::built_in_robot("paper");
        assert_eq!(choose_demonstration_gaits(&robot), ["walk", "left"]);
        assert!(!list_moving_gaits(&robot).contains(&"stand"));
    }
}
