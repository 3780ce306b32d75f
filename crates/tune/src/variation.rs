//! Random robots and floors within the uncertainty of printed parts, of a floor and of a kitchen scale.

use fastrand::Rng;
use lizard_robot::{CheckedGait, DriveKind, GroundContact, Robot, Travel, Walker};
use lizard_twin::{FRAME_PERIOD_S, ServoModel};

/// Steps of the firmware's 16-bit phase per gait cycle.
const PHASE_STEPS_PER_CYCLE: f64 = 65536.0;

/// Range of the random factor on the friction in robot.toml.
pub const FRICTION_FACTORS: (f64, f64) = (0.5, 1.5);
/// Range of the random factor on the load of each pad, and on the ratio of backward to forward friction.
const PAD_FACTORS: (f64, f64) = (0.9, 1.1);
/// Largest random shift of the centre of mass in each direction.
const MAX_MASS_SHIFT_MM: f64 = 8.0;
/// Largest random change of the legs' mounting angle.
const MAX_MOUNT_SHIFT_DEG: f64 = 4.0;
/// Largest random shift of the hips in each direction.
const MAX_HIP_SHIFT_MM: f64 = 2.0;
/// Range of the random factors on the springs' force and rate.
const SPRING_FACTORS: (f64, f64) = (0.8, 1.2);
/// Range of the random factor on the stiffness of the feet's leaves. Stiffness grows with the cube of the thickness,
/// so these factors belong to prints that are 7 % too thin or 8 % too thick.
const LEAF_FACTORS: (f64, f64) = (0.8, 1.25);
/// Largest random play that is added to the legs' play.
const MAX_ADDED_PLAY_DEG: f64 = 1.0;

/// The ranges of the random values, in words, for reports.
pub const SPREAD_TEXT: &str = "friction x 0.5 to 1.5, each pad's load x 0.9 to 1.1, backward over forward x 0.9 to 1.1,\n\
centre of mass +-8 mm, mounting +-4 deg, hips +-2 mm, springs x 0.8 to 1.2, foot leaves x 0.8 to 1.25,\n\
a foot longer by -1 to 1 times [feet] level";

/// The range of the play that [`Variation::with_play`] adds, in words, for reports.
pub const PLAY_SPREAD_TEXT: &str = "play of the legs 0 to 1 deg more";

/// A robot and a floor that differ randomly from those in robot.toml.
#[derive(Debug, Clone, Copy)]
pub struct Variation {
    ground: GroundContact,
    /// Factor on each pad's load.
    pad_factors: [f64; 4],
    /// Factor on the ground's ratio of backward to forward friction.
    ratio_factor: f64,
}

impl Variation {
    /// Creates a random robot and floor around `ground`, determined by the seed.
    pub fn sample(ground: &GroundContact, seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let mut sample_in = |(low, high): (f64, f64)| low + (high - low) * rng.f64();
        let mut ground = *ground;
        ground.legs.mount_angle += sample_in((-MAX_MOUNT_SHIFT_DEG, MAX_MOUNT_SHIFT_DEG));
        ground.legs.hip_forward += sample_in((-MAX_HIP_SHIFT_MM, MAX_HIP_SHIFT_MM));
        let hip_side_shift = sample_in((-MAX_HIP_SHIFT_MM, MAX_HIP_SHIFT_MM));
        for side in &mut ground.legs.hip_side {
            *side += hip_side_shift;
        }
        for position in &mut ground.body.centre_of_mass {
            *position += sample_in((-MAX_MASS_SHIFT_MM, MAX_MASS_SHIFT_MM));
        }
        ground.friction_coefficient *= sample_in(FRICTION_FACTORS);
        if let DriveKind::Strut(strut) = &mut ground.drive.kind {
            strut.preload *= sample_in(SPRING_FACTORS);
            strut.spring_rate *= sample_in(SPRING_FACTORS);
        }
        let pad_factors = std::array::from_fn(|_| sample_in(PAD_FACTORS));
        let ratio_factor = sample_in(PAD_FACTORS);
        ground.stance.stiffness *= sample_in(LEAF_FACTORS);
        ground.stance.twist += ground.stance.twist_error * sample_in((-1.0, 1.0));
        Self {
            ground,
            pad_factors,
            ratio_factor,
        }
    }

    /// Adds random play to the legs. A simulation with play takes longer.
    #[must_use]
    pub fn with_play(mut self, seed: u64) -> Self {
        // The play has its own random sequence, so that all other values stay unchanged.
        let mut rng = Rng::with_seed(seed ^ 0x9E37_79B9_7F4A_7C15);
        self.ground.drive.play += MAX_ADDED_PLAY_DEG * rng.f64();
        self
    }

    /// Creates a robot and a floor without variation.
    pub fn nominal(ground: &GroundContact) -> Self {
        Self {
            ground: *ground,
            pad_factors: [1.0; 4],
            ratio_factor: 1.0,
        }
    }

    /// Simulates two cycles of a gait frame by frame, and returns the movement in the second cycle. All later cycles
    /// are equal to the second cycle.
    pub fn simulate_cycle(&self, robot: &Robot, gait: &CheckedGait, model: ServoModel) -> Travel {
        let mut sweeps = gait.sweeps(gait.phase_at(0.0));
        let compute_targets = |phase: u16| gait.sweeps(f64::from(phase) / PHASE_STEPS_PER_CYCLE);
        let place_walker = |sweeps: [f64; 4]| {
            Walker::with_unevenness(self.ground, sweeps, self.pad_factors, self.ratio_factor)
        };
        if let ServoModel::Motors(motors) = model {
            let mut walker = place_walker(sweeps);
            let mut run_cycle = || {
                let start_pose = walker.body_pose();
                for (_, phase) in gait.frames().skip(1) {
                    walker.run_motors(compute_targets(phase).map(Some), FRAME_PERIOD_S, &motors);
                }
                walker.body_pose().travel_from(start_pose)
            };
            run_cycle();
            return run_cycle();
        }
        let mut move_servos = |phase: u16| {
            let targets = compute_targets(phase);
            sweeps = std::array::from_fn(|i| {
                model.compute_end_sweep(sweeps[i], targets[i], robot.servos()[i].us_per_degree)
            });
            sweeps
        };
        let first_cycle: Vec<[f64; 4]> =
            gait.frames().map(|(_, phase)| move_servos(phase)).collect();
        // If the legs are rigid, only the servos' state carries over from the first cycle, so the walker starts at
        // the end of that cycle.
        let can_legs_lag = self.ground.drive.can_lag();
        let start_sweeps = match can_legs_lag {
            true => first_cycle.first(),
            false => first_cycle.last(),
        };
        let mut walker = place_walker(start_sweeps.copied().unwrap_or_default());
        if can_legs_lag {
            for sweeps in first_cycle {
                walker.move_to(sweeps);
            }
        }
        let start_pose = walker.body_pose();
        for (_, phase) in gait.frames() {
            walker.move_to(move_servos(phase));
        }
        walker.body_pose().travel_from(start_pose)
    }
}

/// Computes quantiles without interpolation: for each fraction, the sorted value whose index is nearest to the fraction
/// times the last index. Returns NaN if there are no values.
pub fn compute_quantiles<const N: usize>(mut values: Vec<f64>, fractions: [f64; N]) -> [f64; N] {
    values.sort_by(f64::total_cmp);
    let last_index = values.len().saturating_sub(1);
    fractions.map(|fraction| {
        let index = (fraction * last_index as f64).round() as usize;
        values.get(index).copied().unwrap_or(f64::NAN)
    })
}

#[cfg(test)]
mod tests {
    use lizard_twin::Twin;

    use super::*;

    const PAPER: &str = include_str!("../../../robots/paper.toml");

    /// Simulates `walk` on random variations of a robot.
    fn simulate_walks(robot_toml: &str, robot_count: u64) -> Vec<Travel> {
        let robot = Robot::parse(robot_toml).expect("the robot file is valid");
        let walk = robot.gait("walk").expect("the robot has the gait");
        let variations = (0..robot_count).map(|seed| Variation::sample(robot.ground(), seed));
        variations
            .map(|variation| variation.simulate_cycle(&robot, walk, ServoModel::SG90))
            .collect()
    }

    #[test]
    fn walk_moves_forward_on_nearly_every_robot_and_floor() {
        let movements = simulate_walks(PAPER, 40);
        let find_quantiles = |component: fn(&Travel) -> f64| {
            compute_quantiles(movements.iter().map(component).collect(), [0.05, 0.5, 0.95])
        };
        let [low, median, high] = find_quantiles(|movement| movement.forward);
        assert!(25.0 < low && low < median && median < high && high < 40.0);
        let turn_deg = find_quantiles(|movement| movement.turn);
        assert!(
            turn_deg[0] < 0.0 && turn_deg[2] > 0.0,
            "turn {turn_deg:?} deg"
        );
    }

    #[test]
    fn uneven_feet_slow_a_walk_only_if_they_are_stiff() {
        let compute_low_forward = |feet: &str| {
            let movements = simulate_walks(&format!("{PAPER}\n{feet}"), 60).into_iter();
            let forward_distances = movements.map(|movement| movement.forward).collect();
            compute_quantiles(forward_distances, [0.05])[0]
        };
        let level_forward = compute_low_forward("[feet]\nlevel = 0.0");
        assert!(compute_low_forward("") > 0.97 * level_forward);
        assert!(compute_low_forward("[feet]\nstiffness = 3.3") < 0.65 * level_forward);
    }

    #[test]
    fn added_play_leaves_all_other_values_unchanged() {
        let robot = Robot::parse(PAPER).expect("paper.toml is valid");
        for seed in 0..50 {
            let variation = Variation::sample(robot.ground(), seed);
            let with_play = variation.with_play(seed);
            let play = with_play.ground.drive.play;
            assert!(
                (0.0..=MAX_ADDED_PLAY_DEG).contains(&play) && play > 0.0,
                "play {play} deg"
            );
            let mut without_play = with_play;
            without_play.ground.drive.play = 0.0;
            assert_eq!(without_play.ground, variation.ground);
        }
    }

    #[test]
    fn a_nominal_robot_walks_like_the_twin() {
        let paper_with_springs = PAPER.replace(
            "[leg]",
            "[leg]\ndrive = { kind = \"strut\", force = 0.5, rate = 0.4 }",
        );
        for robot_toml in [PAPER, &paper_with_springs] {
            let robot = Robot::parse(robot_toml).expect("the robot file is valid");
            for name in ["walk", "left"] {
                let gait = robot.gait(name).expect("paper.toml has the gait");
                for model in [ServoModel::Ideal, ServoModel::SG90] {
                    let movement =
                        Variation::nominal(robot.ground()).simulate_cycle(&robot, gait, model);
                    let twin_movement = Twin::new(&robot, model).simulate_cycle(gait).travel();
                    let error = (movement.forward - twin_movement.forward)
                        .hypot(movement.turn - twin_movement.turn);
                    // The twin reads the firmware's tables of 64 samples; the variation computes the gait itself.
                    assert!(error < 0.4, "{name}: {movement:?}, twin {twin_movement:?}");
                }
            }
        }
    }

    #[test]
    fn the_quantiles_of_the_integers_up_to_100_are_the_percentages() {
        let values = (0..=100).rev().map(f64::from).collect();
        assert_eq!(
            compute_quantiles(values, [0.05, 0.5, 0.95]),
            [5.0, 50.0, 95.0]
        );
    }
}
