//! Comparisons of the maps with the integer guard: [`Clearance`] computes a pose's margins without the maps.

use lizard_core::guard::clearance::Clearance;
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::limits::Limits;
use lizard_core::numbers::units::Sweep;
use lizard_kinematics::{Links, Lizard};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use super::*;
use crate::config::RobotConfig;
use crate::tables::core_robot::{CoreRobot, keep_section};
use crate::tables::numbers;
use crate::tables::table::Tables;
use crate::testing::{all_robots, robot};
use crate::{Robot, Servo};

/// Random asymmetrical robots, with various links, limits and servos.
fn random_configs() -> impl Strategy<Value = RobotConfig> {
    let paper = robot("paper");
    let end_lengths = || (15.0..40.0, 22.0..45.0, 45.0..75.0, 45.0..75.0, 22.0..45.0);
    let side_lengths = || (20.0..42.0, 35.0..55.0, 35.0..55.0, 20.0..42.0);
    let limits = (0.12..0.4, 0.0..0.35, 0.0..0.35, -40.0..-5.0, 5.0..60.0);
    let servo_values = || (-15.0..15.0f64, 6.0..22.0f64, any::<bool>());
    let ends = [end_lengths(), end_lengths()];
    let sides = [side_lengths(), side_lengths()];
    let servos = [(); 4].map(|()| servo_values());
    let all_values = (ends, 90.0..200.0, sides, limits, servos);
    all_values.prop_map(move |(ends, base, sides, limits, servos)| {
        let mut links = [0.0; 20];
        for (index, (l0, l1, l2, l3, l4)) in ends.into_iter().enumerate() {
            links[5 * index..][..5].copy_from_slice(&[l0, l1, l2, l3, l4]);
        }
        for (index, (l11, l12, l13, l14)) in sides.into_iter().enumerate() {
            links[10 + 5 * index..][..5].copy_from_slice(&[base, l11, l12, l13, l14]);
        }
        let (type2, type1, leg, stroke_min, stroke_max) = limits;
        let neutral = [130.0, 50.0, 310.0, 230.0];
        RobotConfig {
            lizard: Lizard {
                links: Links::from(links),
                ..*paper.lizard()
            },
            limits: lizard_kinematics::Limits {
                type2,
                type1,
                leg,
                stroke_min,
                stroke_max,
            },
            servos: std::array::from_fn(|i| {
                let (offset, gain, is_reversed) = servos[i];
                Servo {
                    neutral: neutral[i] + offset,
                    us_per_degree: if is_reversed { -gain } else { gain },
                    ..paper.servos()[i]
                }
            }),
            ..paper.config.clone()
        }
    })
}

/// Draws a value from a strategy.
fn sample<S: Strategy>(strategy: &S, runner: &mut TestRunner) -> S::Value {
    let tree = strategy.new_tree(runner);
    tree.expect("the strategy yields a value").current()
}

/// A map, and the conditions of the guard that hold in its cells.
struct CertifiedMap<'a> {
    map: &'a Map,
    /// Index of the servo of the rows, and index of the servo of the columns.
    servos: [usize; 2],
    /// Indices in [`Clearance::margins`] of the margins that the map certifies.
    margins: &'static [usize],
    /// Index in [`Clearance::slider_lengths_sq`] of the slider that the map certifies; `None` for head and tail.
    slider: Option<usize>,
}

/// A robot in the integers of the firmware, and the maps to be checked.
struct RobotWithMaps {
    robot: CoreRobot,
    maps: CellMaps,
}

impl RobotWithMaps {
    /// Computes the maps of a robot.
    fn new(robot: &Robot) -> Self {
        Self {
            robot: *robot.firmware(),
            maps: robot.cell_maps(),
        }
    }

    /// Creates a robot without gaits from its configuration.
    fn from_config(config: &RobotConfig) -> Self {
        let tables = Tables::new(&[]).expect("tables without gaits can be built");
        let content = numbers::build_content("random", config, &tables, &[]);
        Self {
            maps: CellMaps::new(&config.lizard, &content),
            robot: CoreRobot::unchecked(keep_section(&content.section_bytes()))
                .expect("the section is complete"),
        }
    }

    /// The maps, each with the conditions that it certifies.
    fn certified_maps(&self) -> [CertifiedMap<'_>; 4] {
        let certified_map = |map, servos, margins, slider| CertifiedMap {
            map,
            servos,
            margins,
            slider,
        };
        let maps = &self.maps;
        [
            certified_map(&maps.head, [0, 1], &[0, 2, 3, 6, 7], None),
            certified_map(&maps.tail, [2, 3], &[1, 4, 5, 8, 9], None),
            certified_map(&maps.left, [0, 3], &[], Some(0)),
            certified_map(&maps.right, [1, 2], &[], Some(1)),
        ]
    }

    /// Checks that the guard accepts seven pairs of angles in every cell: the four corners, the centre and two random
    /// pairs. Compares only the margins and sliders that the map certifies. Returns the number of cells, or a message
    /// about the first pose that the guard rejects.
    fn check(&self, runner: &mut TestRunner) -> Result<usize, String> {
        let Limits { type2, type1, leg } = self.robot.limits();
        let min_margins = [type2, type2, type1, type1, type1, type1, leg, leg, leg, leg];
        let sides = lizard_core::numbers::part::Side::ALL.map(|side| self.robot.slider(side));
        let mut cell_count = 0;
        for certified_map in self.certified_maps() {
            let (map, [row_servo, column_servo]) = (certified_map.map, certified_map.servos);
            let (margins, slider) = (certified_map.margins, certified_map.slider);
            assert!(map.rows.len() <= MAX_ROWS);
            for (row, [first, last]) in (i32::from(map.first_row)..).zip(&map.rows) {
                for column in i32::from(*first)..=i32::from(*last) {
                    cell_count += 1;
                    let offsets = (0..256i32, 0..128i32);
                    let [first_pair, second_pair] = [(); 2].map(|()| sample(&offsets, runner));
                    let corners = [(0, 0), (0, 127), (255, 0), (255, 127)];
                    let inner_pairs = [(128, 64), first_pair, second_pair];
                    for (row_offset, column_offset) in corners.into_iter().chain(inner_pairs) {
                        let row_sweep = Sweep((row * 256 + row_offset) as i16);
                        let column_sweep = Sweep((column * 128 + column_offset) as i16);
                        let mut pose = Pose::NEUTRAL;
                        pose.0[row_servo] = row_sweep;
                        pose.0[column_servo] = column_sweep;
                        assert!(map.cells().contains(row_sweep, column_sweep));
                        let clearance = Clearance::measure(&self.robot, &pose);
                        let is_accepted = margins
                            .iter()
                            .all(|margin| clearance.margins[*margin] >= min_margins[*margin])
                            && slider.is_none_or(|side| {
                                sides[side].allows(clearance.slider_lengths_sq[side])
                            });
                        if !is_accepted {
                            return Err(format!("{pose:?}: {clearance:?}"));
                        }
                    }
                }
            }
        }
        Ok(cell_count)
    }
}

#[test]
fn the_guard_accepts_the_corners_the_centre_and_random_poses_of_every_cell() {
    let mut runner = TestRunner::deterministic();
    for (name, robot) in all_robots() {
        let result = RobotWithMaps::new(&robot).check(&mut runner);
        let cell_count = result.unwrap_or_else(|message| panic!("{name} at {message}"));
        assert!(cell_count > 2000, "{name}: {cell_count}");
    }
}

#[test]
fn the_guard_accepts_every_cell_of_random_robots() {
    let mut runner = TestRunner::deterministic();
    let strategy = random_configs();
    let mut cell_count = 0;
    for number in 0..100 {
        let config = sample(&strategy, &mut runner);
        let result = RobotWithMaps::from_config(&config).check(&mut runner);
        cell_count += result.unwrap_or_else(|message| panic!("robot {number} at {message}"));
    }
    assert!(cell_count > 100 * 1000, "{cell_count} cells of 100 robots");
}

#[test]
fn the_guard_accepts_every_pose_that_all_four_maps_contain() {
    let mut runner = TestRunner::deterministic();
    for (name, robot) in all_robots() {
        let RobotWithMaps { robot, maps } = RobotWithMaps::new(&robot);
        let travels = robot
            .calibration()
            .map(|servo| (servo.travel_min.0..=servo.travel_max.0).prop_map(Sweep));
        let mut certified_count = 0;
        for _ in 0..200_000 {
            let pose = Pose(sample(&travels, &mut runner));
            if maps.contains(&pose) {
                certified_count += 1;
                let hazard = Clearance::measure(&robot, &pose).first_hazard(&robot);
                assert_eq!(hazard, None, "{name}: {pose:?}");
            }
        }
        let has_enough = certified_count > 200;
        assert!(has_enough, "{name}: {certified_count} of 200 000 poses");
    }
}

/// Makes each limit in turn a little stricter than in the maps. Some cell then violates the limit, so the comparison
/// would notice a wrong map.
#[test]
fn cells_of_the_old_maps_violate_a_stricter_limit() {
    let robot = robot("unequal");
    let changes: [fn(&mut lizard_kinematics::Limits); 5] = [
        |limits| limits.type2 += 0.3,
        |limits| limits.type1 += 0.05,
        |limits| limits.leg += 0.03,
        |limits| limits.stroke_min += 1.0,
        |limits| limits.stroke_max -= 1.0,
    ];
    for (index, change) in changes.into_iter().enumerate() {
        let mut stricter_config = robot.config.clone();
        change(&mut stricter_config.limits);
        let stricter_robot = RobotWithMaps::from_config(&stricter_config);
        let maps = robot.cell_maps();
        assert_ne!(stricter_robot.maps, maps, "limit {index}");
        let robot_with_old_maps = RobotWithMaps {
            maps,
            ..stricter_robot
        };
        let outcome = robot_with_old_maps.check(&mut TestRunner::deterministic());
        assert!(outcome.is_err(), "limit {index}");
    }
}

#[test]
fn maps_begin_and_end_with_a_cell_and_have_at_most_max_rows() {
    for (name, robot) in all_robots() {
        for CertifiedMap { map, .. } in RobotWithMaps::new(&robot).certified_maps() {
            assert!(map.rows.len() <= MAX_ROWS, "{name}");
            let [first, .., last] = map.rows.as_slice() else {
                panic!("{name}: a map of {} rows", map.rows.len());
            };
            assert!(first[0] <= first[1] && last[0] <= last[1], "{name}");
            // Every map contains the neutral pose.
            assert!(map.cells().contains(Sweep(0), Sweep(0)), "{name}");
        }
    }
}

/// Computes the fraction of a gait's phases at which all four maps contain the pose.
fn compute_certified_fraction(robot: &CoreRobot, maps: &CellMaps, gait: GaitId) -> f64 {
    let gait = robot.gait(gait);
    let certified_count = (0..1u32 << 16)
        .filter(|phase| maps.contains(&gait.pose(robot.waves(), phase << 8)))
        .count();
    certified_count as f64 / 65536.0
}

#[test]
fn every_gait_stays_within_certified_cells() {
    for (name, robot) in all_robots() {
        let maps = robot.cell_maps();
        for (gait, id) in robot.gaits().iter().zip(GaitId::all(robot.gaits().len())) {
            let fraction = compute_certified_fraction(robot.firmware(), &maps, id);
            assert_eq!(fraction, 1.0, "{name} {}", gait.name());
        }
    }
}
