//! Random robots and floors, within the uncertainty of printed parts, of a floor and of a kitchen scale.

use fastrand::Rng;
use lizard_robot::{
    Body, CheckedGait, Drive, DriveKind, Feet, Ground, Robot, Stance, Strut, Travel, Walker,
};
use lizard_twin::{FRAME_S, ServoModel};

/// Number of the firmware's phase steps in a cycle.
const PHASES_PER_CYCLE: f64 = 65536.0;

/// Range of the random factor on the friction of robot.toml.
pub const FRICTION_FACTORS: (f64, f64) = (0.5, 1.5);
/// Range of the random factor on the load of each pad, and on the ratio of backward to forward friction.
const PAD_FACTORS: (f64, f64) = (0.9, 1.1);
/// Largest random shift of the mass centre in each direction.
const MAX_CENTRE_SHIFT_MM: f64 = 8.0;
/// Largest random change of the legs' mounting angle.
const MAX_MOUNT_SHIFT_DEG: f64 = 4.0;
/// Largest random shift of the hips in each direction.
const MAX_HIP_SHIFT_MM: f64 = 2.0;
/// Range of the random factor on the force and on the rate of the springs.
const SPRING_FACTORS: (f64, f64) = (0.8, 1.2);
/// Range of the factor on the stiffness of the feet's leaves. Stiffness grows with the cube of the thickness, and the
/// thickness of a print is within one fifteenth of the intended one.
const LEAF_FACTORS: (f64, f64) = (0.8, 1.25);
/// Largest random play that is added to the play of the legs, deg.
const MAX_ADDED_PLAY_DEG: f64 = 1.0;

/// Description of the ranges in which the random robots vary, for reports.
pub const SPREAD_TEXT: &str = "friction x 0.5 to 1.5, each pad's x 0.9 to 1.1, backward over forward x 0.9 to 1.1, mass centre +-8 mm,\n\
mounting +-4 deg, hips +-2 mm, springs x 0.8 to 1.2, leaves of feet x 0.8 to 1.25, a foot longer by\n\
-1 to 1 times what [feet] level says";

/// Description of the play that [`Variation::with_play`] adds, for reports.
pub const PLAY_SPREAD_TEXT: &str = "play of the legs 0 to 1 deg more";

/// A robot and a floor that differ randomly from the robot and the floor of robot.toml.
#[derive(Debug, Clone, Copy)]
pub struct Variation {
    ground: Ground,
    /// Factor on the load of each pad.
    pad_factors: [f64; 4],
    /// Factor on the ground's ratio of backward to forward friction.
    ratio_factor: f64,
}

impl Variation {
    /// Draws a random robot and floor around this ground; the seed determines them.
    pub fn random(ground: &Ground, seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let mut draw_within = |(low, high): (f64, f64)| low + (high - low) * rng.f64();
        let feet = ground.feet;
        let ground = Ground {
            feet: Feet {
                mount_angle: feet.mount_angle
                    + draw_within((-MAX_MOUNT_SHIFT_DEG, MAX_MOUNT_SHIFT_DEG)),
                hip_forward: feet.hip_forward + draw_within((-MAX_HIP_SHIFT_MM, MAX_HIP_SHIFT_MM)),
                hip_side: {
                    let shift = draw_within((-MAX_HIP_SHIFT_MM, MAX_HIP_SHIFT_MM));
                    feet.hip_side.map(|side| side + shift)
                },
                ..feet
            },
            body: Body {
                mass_centre: ground.body.mass_centre.map(|position| {
                    position + draw_within((-MAX_CENTRE_SHIFT_MM, MAX_CENTRE_SHIFT_MM))
                }),
                ..ground.body
            },
            friction_coefficient: ground.friction_coefficient * draw_within(FRICTION_FACTORS),
            drive: Drive {
                kind: match ground.drive.kind {
                    DriveKind::Rigid => DriveKind::Rigid,
                    DriveKind::Strut(strut) => DriveKind::Strut(Strut {
                        force: strut.force * draw_within(SPRING_FACTORS),
                        rate: strut.rate * draw_within(SPRING_FACTORS),
                        ..strut
                    }),
                },
                ..ground.drive
            },
            ..*ground
        };
        let (pad_factors, ratio_factor) = (
            std::array::from_fn(|_| draw_within(PAD_FACTORS)),
            draw_within(PAD_FACTORS),
        );
        let stance = Stance {
            stiffness: ground.stance.stiffness * draw_within(LEAF_FACTORS),
            twist: ground.stance.twist + ground.stance.twist_error * draw_within((-1.0, 1.0)),
            ..ground.stance
        };
        Self {
            ground: Ground { stance, ..ground },
            pad_factors,
            ratio_factor,
        }
    }

    /// Adds random play to the legs. A simulation with play takes longer.
    #[must_use]
    pub fn with_play(mut self, seed: u64) -> Self {
        // A separate random sequence for the play leaves all other values unchanged.
        let mut rng = Rng::with_seed(seed ^ 0x9E37_79B9_7F4A_7C15);
        self.ground.drive.play += MAX_ADDED_PLAY_DEG * rng.f64();
        self
    }

    /// Returns the given ground without any variation.
    pub fn unvaried(ground: &Ground) -> Self {
        Self {
            ground: *ground,
            pad_factors: [1.0; 4],
            ratio_factor: 1.0,
        }
    }

    /// Simulates two cycles of a gait frame by frame with these servos, and returns the movement in the second cycle.
    /// All later cycles repeat the second one.
    pub fn simulate_cycle(&self, robot: &Robot, gait: &CheckedGait, model: ServoModel) -> Travel {
        let mut sweeps = gait.sweeps(gait.phase_at(0.0));
        let targets_at = |phase: u16| gait.sweeps(f64::from(phase) / PHASES_PER_CYCLE);
        if let ServoModel::Motors(motors) = model {
            let mut walker =
                Walker::with_unevenness(self.ground, sweeps, self.pad_factors, self.ratio_factor);
            let mut run_cycle = || {
                let start_place = walker.place();
                for (_, phase) in gait.frames().skip(1) {
                    walker.drive(targets_at(phase).map(Some), FRAME_S, &motors);
                }
                walker.place().travel_from(start_place)
            };
            run_cycle();
            return run_cycle();
        }
        let mut advance = |phase: u16| {
            let targets = targets_at(phase);
            sweeps = std::array::from_fn(|i| match model {
                ServoModel::Unloaded(servo) => {
                    servo.sweep_after_frame(sweeps[i], targets[i], robot.servos()[i].us_per_degree)
                }
                _ => targets[i],
            });
            sweeps
        };
        let first_cycle: Vec<[f64; 4]> = gait.frames().map(|(_, phase)| advance(phase)).collect();
        let [start_pose, end_pose] =
            [first_cycle.first(), first_cycle.last()].map(|pose| pose.copied().unwrap_or_default());
        // The first cycle has no effect on rigid legs, so only the servos are simulated in it.
        let legs_can_lag = self.ground.drive.can_lag();
        let start_sweeps = if legs_can_lag { start_pose } else { end_pose };
        let mut walker = Walker::with_unevenness(
            self.ground,
            start_sweeps,
            self.pad_factors,
            self.ratio_factor,
        );
        if legs_can_lag {
            first_cycle.into_iter().for_each(|sweeps| {
                walker.move_to(sweeps);
            });
        }
        let start_place = walker.place();
        for (_, phase) in gait.frames() {
            walker.move_to(advance(phase));
        }
        walker.place().travel_from(start_place)
    }
}

/// Quantiles: the values below which these shares of all values lie, by nearest rank; NaN if there are no values.
pub fn quantiles<const N: usize>(mut values: Vec<f64>, shares: [f64; N]) -> [f64; N] {
    values.sort_by(f64::total_cmp);
    let last_index = values.len().saturating_sub(1);
    shares.map(|share| {
        let index = (share * last_index as f64).round() as usize;
        values.get(index).copied().unwrap_or(f64::NAN)
    })
}

#[cfg(test)]
mod tests {
    use lizard_twin::Twin;

    use super::*;

    #[test]
    fn walk_moves_forward_on_nearly_every_robot_and_floor() {
        let robot =
            Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is valid");
        let walk = robot.gait("walk").expect("paper.toml has the gait");
        let movements: Vec<Travel> = (0..40)
            .map(|seed| {
                Variation::random(robot.ground(), seed).simulate_cycle(
                    &robot,
                    walk,
                    ServoModel::SG90,
                )
            })
            .collect();
        let quantiles_of = |component: fn(&Travel) -> f64| {
            quantiles(movements.iter().map(component).collect(), [0.05, 0.5, 0.95])
        };
        let [low, median, high] = quantiles_of(|movement| movement.forward);
        assert!(25.0 < low && low < median && median < high && high < 40.0);
        let turn = quantiles_of(|movement| movement.turn);
        assert!(turn[0] < 0.0 && turn[2] > 0.0, "{turn:?}");
    }

    #[test]
    fn uneven_feet_slow_a_walk_only_if_they_are_stiff() {
        let text = include_str!("../../../robots/paper.toml");
        let slowest_forward = |feet: &str| {
            let robot = Robot::parse(&format!("{text}\n{feet}")).expect("the robot file is valid");
            let walk = robot.gait("walk").expect("paper.toml has the gait");
            let movements = (0..60).map(|seed| {
                Variation::random(robot.ground(), seed).simulate_cycle(
                    &robot,
                    walk,
                    ServoModel::SG90,
                )
            });
            let [slowest] = quantiles(movements.map(|movement| movement.forward).collect(), [0.05]);
            slowest
        };
        let level_forward = slowest_forward("[feet]\nlevel = 0.0");
        assert!(
            slowest_forward("") > 0.97 * level_forward
                && slowest_forward("[feet]\nstiffness = 3.3") < 0.65 * level_forward
        );
    }

    #[test]
    fn added_play_leaves_all_other_values_unchanged() {
        let robot =
            Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is valid");
        for seed in 0..50 {
            let variation = Variation::random(robot.ground(), seed);
            let with_play = variation.with_play(seed);
            let play = with_play.ground.drive.play;
            assert!(
                (0.0..=MAX_ADDED_PLAY_DEG).contains(&play) && play > 0.0,
                "{play}"
            );
            let mut without_play = with_play;
            without_play.ground.drive.play = 0.0;
            assert_eq!(without_play.ground, variation.ground);
        }
    }

    #[test]
    fn a_robot_without_variation_walks_like_the_twin() {
        let text = include_str!("../../../robots/paper.toml");
        let text_with_springs = text.replace(
            "[leg]",
            "[leg]\ndrive = { kind = \"strut\", force = 0.5, rate = 0.4 }",
        );
        for text in [text, &text_with_springs] {
            let robot = Robot::parse(text).expect("the robot file is valid");
            for name in ["walk", "left"] {
                let gait = robot.gait(name).expect("paper.toml has the gait");
                for model in [ServoModel::Ideal, ServoModel::SG90] {
                    let movement =
                        Variation::unvaried(robot.ground()).simulate_cycle(&robot, gait, model);
                    let twin_movement = Twin::new(&robot, model).simulate_cycle(gait).travel();
                    let error = (movement.forward - twin_movement.forward)
                        .hypot(movement.turn - twin_movement.turn);
                    // The twin reads the firmware's tables of 64 samples; the variation computes the gait itself.
                    assert!(error < 0.4, "{name} {movement:?} {twin_movement:?}");
                }
            }
        }
    }

    #[test]
    fn the_given_share_of_the_values_is_below_each_quantile() {
        let values = (0..=100).rev().map(f64::from).collect();
        assert_eq!(quantiles(values, [0.05, 0.5, 0.95]), [5.0, 50.0, 95.0]);
    }
}
