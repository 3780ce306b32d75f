//! Tests that read sections back with the firmware's reader: each field must match the robot's file. The expected
//! values come from the robot in floating point, not from the integers from which the section was made.

use lizard_core::guard::clearance::Clearance;
use lizard_core::numbers::curve::{ENTRY_COUNT, Table, argument_at};
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::link_lengths::LinkLengths;
use lizard_core::numbers::part::{End, Servo, Side};
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::robot::Robot;
use lizard_core::numbers::section::{Header, MapHeader, Numbers, Region, SectionPart};
use lizard_core::numbers::supplies::Thresholds;
use lizard_core::numbers::units::{Scale, Sine, Sweep};
use lizard_host_tests::{CYCLES_PER_US, NamedRobot, rng};
use lizard_robot::{Robot as FileRobot, STEPS_PER_DEGREE};

use crate::sections;

/// Runs a test for every robot, with its name, the robot that the core reads, the robot from its file, and the flash.
fn for_each_robot(mut test: impl FnMut(&'static str, &Robot, &'static FileRobot, Region<'static>)) {
    for (NamedRobot { name, robot }, section) in sections() {
        let flash = Region::new(section);
        let core_robot = Robot::open(flash).expect(name);
        test(name, &core_robot, robot, flash);
    }
}

fn read_numbers(flash: Region<'_>) -> Numbers {
    flash.read(size_of::<Header>() as u16)
}

/// Converts a length to steps, rounded to the nearest step.
fn mm_to_steps(mm: f64, scale: Scale) -> f64 {
    (mm * f64::from(1u32 << scale.bits)).round()
}

/// Converts a sweep in the core's steps to degrees.
fn steps_to_degrees(sweep: i32) -> f64 {
    f64::from(sweep) / STEPS_PER_DEGREE
}

#[test]
fn the_name_the_pins_and_the_supplies_are_read_back() {
    for_each_robot(|name, robot, file_robot, _| {
        let read_name: String = robot.name().map(char::from).collect();
        assert_eq!(read_name, file_robot.name(), "{name}");
        let pins = file_robot.servos().map(|servo| servo.pin);
        assert_eq!(robot.pins(), pins, "{name}");
        let supplies = file_robot.supplies();
        let rail_pin = supplies.rail.map(|rail| rail.pin);
        assert_eq!(robot.rail_pin(), rail_pin, "{name}");
        assert_eq!(robot.slow_pace(), supplies.slow_pace_percent, "{name}");
        let stored = robot.supplies();
        let levels_mv = |stored: Thresholds| [stored.slow_mv, stored.stop_mv, stored.rest_mv];
        let mut voltages = vec![(stored.reference_mv, supplies.reference_volts)];
        let board_mv = levels_mv(stored.board).into_iter();
        voltages.extend(board_mv.zip(supplies.board_thresholds));
        if let Some(rail) = supplies.rail {
            let rail_reference = supplies.reference_volts * rail.divider_ratio;
            voltages.push((stored.rail_reference_mv, rail_reference));
            let rail_mv = levels_mv(stored.rail).into_iter();
            voltages.extend(rail_mv.zip(rail.thresholds));
        } else {
            assert_eq!(stored.rail_reference_mv, 0, "{name}");
        }
        for (mv, volts) in voltages {
            let error_mv = f64::from(mv) - 1000.0 * volts;
            assert!(error_mv.abs() <= 0.501, "{name} {stored:?}");
        }
    });
}

#[test]
fn the_servos_are_read_back() {
    for_each_robot(|name, robot, file_robot, _| {
        for (index, servo) in file_robot.servos().iter().enumerate() {
            let servo_id = Servo::ALL[index];
            let neutral_angle = robot.servo_neutral_angle(servo_id);
            let error_deg = f64::from(neutral_angle.0) / STEPS_PER_DEGREE - servo.neutral;
            assert!(error_deg.abs() <= 0.501 / STEPS_PER_DEGREE, "{name}");
            assert_eq!(robot.neutral_angles()[index], neutral_angle);
            let calibration = robot.servo_calibration(servo_id);
            assert_eq!(robot.calibration()[index], calibration);
            let pulse_us =
                |sweep: i32| servo.neutral_us + servo.us_per_degree * steps_to_degrees(sweep);
            for sweep in calibration.travel_min.0..=calibration.travel_max.0 {
                let error = f64::from(calibration.width(Sweep(sweep)).0)
                    - CYCLES_PER_US * pulse_us(sweep.into());
                // The error is half a cycle for the neutral pulse, half a cycle for the product, and the rounding of
                // the scale over the travel.
                assert!(
                    error.abs() <= 1.5,
                    "{name} {servo_id:?}: {error} cycles at {sweep}"
                );
            }
            let is_in_range =
                |sweep: i32| (servo.min_us - 1e-6..=servo.max_us + 1e-6).contains(&pulse_us(sweep));
            let min = i32::from(calibration.travel_min.0);
            let max = i32::from(calibration.travel_max.0);
            assert!(is_in_range(min) && !is_in_range(min - 1), "{name}");
            assert!(is_in_range(max) && !is_in_range(max + 1), "{name}");
        }
    });
}

#[test]
fn the_limits_the_slew_limit_and_the_gaits_travel_are_read_back() {
    for_each_robot(|name, robot, file_robot, _| {
        let (stored_limits, limits) = (robot.limits(), file_robot.limits());
        for (stored, exact) in [
            (stored_limits.type2, limits.type2),
            (stored_limits.type1, limits.type1),
            (stored_limits.leg, limits.leg),
        ] {
            let rounding_up = f64::from(stored.0) - 32768.0 * exact;
            assert!(
                (-2e-6..1.0).contains(&rounding_up),
                "{name}: {stored:?} for {exact}"
            );
        }
        let steps_per_frame = file_robot.speed_limits().slew * STEPS_PER_DEGREE / 50.0;
        let rounding_down = steps_per_frame - f64::from(robot.slew().per_frame);
        let is_rounded_down = (-2e-6..1.0).contains(&rounding_down);
        assert!(is_rounded_down, "{name}: {rounding_down}");
        // The smallest and largest sweeps of all gaits in floating point, for each servo.
        let mut sweep_ranges = [[0.0f64; 2]; 4];
        for gait in file_robot.gaits() {
            for phase in 0..4096 {
                let angles = gait.angles(f64::from(phase) / 4096.0);
                for (index, sweep_range) in sweep_ranges.iter_mut().enumerate() {
                    let sweep = angles[index] - file_robot.servos()[index].neutral;
                    let sweep = (sweep + 180.0).rem_euclid(360.0) - 180.0;
                    *sweep_range = [sweep_range[0].min(sweep), sweep_range[1].max(sweep)];
                }
            }
        }
        for servo in Servo::ALL {
            let stored = robot.needed_travel(servo);
            let [min, max] = sweep_ranges[servo.index()];
            let errors = [
                steps_to_degrees(stored.min.0.into()) - min,
                steps_to_degrees(stored.max.0.into()) - max,
            ];
            // At its extremes a table has an error of up to a tenth of a degree, and rounding adds up to a step.
            assert!(
                errors.iter().all(|error| error.abs() < 0.11),
                "{name} {servo:?}: {errors:?}"
            );
        }
    });
}

#[test]
fn the_link_lengths_and_the_sliders_are_read_back() {
    for_each_robot(|name, robot, file_robot, _| {
        let links = file_robot.lizard().links;
        let head_links = [links.l0, links.l1, links.l4, links.l2, links.l3];
        let tail_links = [links.l5, links.l6, links.l9, links.l7, links.l8];
        for (end, [base, left, right, a, b]) in [(End::Head, head_links), (End::Tail, tail_links)] {
            let lengths = robot.link_lengths(end);
            let scale = lengths.scale();
            let length = |mm: f64| mm_to_steps(mm, scale) as i16;
            let base_and_cranks = [base, left, right].map(length);
            let expected = LinkLengths::new(base_and_cranks, [a, b].map(length), scale);
            assert_eq!(lengths, expected, "{name} {end:?}");
            // The lengths must fit into the core's numbers at this scale.
            let longest_length = (base + left + right).max(a).max(b);
            let fits = |bits: u32| longest_length * f64::from(1u32 << bits) < 127.0 * 256.0;
            let bits = u32::from(scale.bits);
            assert!(fits(bits), "{name} {end:?}: {bits}");
        }
        let side_offset = (links.l5 - links.l0) / 2.0;
        let limits = file_robot.limits();
        let left_links = [side_offset, links.l10, links.l14, links.l11];
        let right_links = [-side_offset, links.l15, links.l19, links.l16];
        for (side, [offset, base, front, rear], nominal) in [
            (Side::Left, left_links, links.l12 + links.l13),
            (Side::Right, right_links, links.l17 + links.l18),
        ] {
            let slider = robot.slider(side);
            let length = |mm: f64| mm_to_steps(mm, slider.scale);
            let lengths = [
                f64::from(slider.offset),
                f64::from(slider.base),
                f64::from(slider.front_arm),
                f64::from(slider.rear_arm),
                f64::from(slider.nominal_length),
            ];
            let expected = [offset, base, front, rear, nominal].map(length);
            assert_eq!(lengths, expected, "{name} {side:?}");
            let steps_per_mm = f64::from(1u32 << slider.scale.bits);
            let inward_rounding = [
                f64::from(slider.stroke_min) - (nominal + limits.stroke_min) * steps_per_mm,
                (nominal + limits.stroke_max) * steps_per_mm - f64::from(slider.stroke_max),
            ];
            let is_rounded_inwards = inward_rounding
                .iter()
                .all(|steps_inward| (-2e-6..1.0).contains(steps_inward));
            assert!(is_rounded_inwards, "{name} {side:?}: {inward_rounding:?}");
        }
    });
}

/// The function in a coupler table of a five-bar, as `lizard_core::numbers::couplers` defines it: the rise, the
/// stretched rise, the folded rise or the skew. Each function has its own argument.
#[derive(Clone, Copy, PartialEq)]
enum CurveKind {
    Rise,
    Stretched,
    Folded,
    Skew,
}

#[test]
fn the_curves_are_read_back_at_every_point_of_their_tables() {
    for_each_robot(|name, robot, file_robot, flash| {
        let links = file_robot.lizard().links;
        let [head_addresses, tail_addresses] = read_numbers(flash).curves;
        for (end, [a, b], addresses) in [
            (End::Head, [links.l2, links.l3], head_addresses),
            (End::Tail, [links.l7, links.l8], tail_addresses),
        ] {
            let scale = robot.link_lengths(end).scale();
            let [a, b] = [a, b].map(|mm| mm_to_steps(mm, scale));
            // The squared distances between the crank tips with stretched and with folded couplers, in units of four
            // squared steps.
            let [stretched_sq, folded_sq] = [(a + b) * (a + b) / 4.0, (a - b) * (a - b) / 4.0];
            let min_rise_sq = 2.0 * stretched_sq * folded_sq / (stretched_sq + folded_sq);
            let kinds = [
                CurveKind::Rise,
                CurveKind::Stretched,
                CurveKind::Folded,
                CurveKind::Skew,
            ];
            assert!(
                addresses[0] != 0 && (addresses[3] != 0) == (a != b),
                "{name} {end:?}"
            );
            let kinds_and_addresses = kinds.into_iter().zip(addresses);
            for (kind, address) in kinds_and_addresses.filter(|(_, address)| *address != 0) {
                let table = flash.values::<Table>(address, 1).get(0);
                let table = table.expect("a curve is at the address").load();
                for (index, entry) in table.into_iter().enumerate().take(ENTRY_COUNT) {
                    let max_argument = match kind {
                        CurveKind::Rise | CurveKind::Skew => stretched_sq,
                        // Rounds down to integers, as in the core.
                        CurveKind::Stretched => (stretched_sq.floor() / 4.0).floor(),
                        CurveKind::Folded => folded_sq.floor(),
                    };
                    let argument = argument_at(max_argument as u32, index) as f64;
                    let distance_sq = match kind {
                        CurveKind::Rise => argument.max(min_rise_sq),
                        CurveKind::Skew => argument,
                        CurveKind::Stretched => stretched_sq - argument,
                        CurveKind::Folded => folded_sq + argument,
                    };
                    let beyond_folded_sq = distance_sq - folded_sq;
                    let below_stretched_sq = stretched_sq - distance_sq;
                    let exact = match kind {
                        CurveKind::Skew => (a * a - b * b).abs() / 4.0 / distance_sq,
                        _ if beyond_folded_sq <= 0.0 || below_stretched_sq <= 0.0 => 0.0,
                        _ => (below_stretched_sq * beyond_folded_sq).sqrt() / distance_sq,
                    };
                    let exact = (1024.0 * exact).min(32_767.0);
                    // The entry has a rounding error of one unit. Where the curve is steep, the rounding error of
                    // `distance_sq` matters, too.
                    let distance_to_end_sq = beyond_folded_sq.min(below_stretched_sq).max(1.0);
                    let tolerance = 1.01 + exact * 2.0 / distance_to_end_sq;
                    let error = f64::from(entry) - exact;
                    assert!(
                        error.abs() <= tolerance,
                        "{name} {end:?} entry {index}: expected {exact}, got {entry}"
                    );
                }
            }
        }
    });
}

#[test]
fn the_gaits_their_names_and_their_waveforms_are_read_back() {
    for_each_robot(|name, robot, file_robot, _| {
        assert_eq!(robot.gait_count(), file_robot.gaits().len(), "{name}");
        for (id, gait) in GaitId::all(robot.gait_count()).zip(file_robot.gaits()) {
            let gait_label = format!("{name} {}", gait.name());
            let read_name: String = robot.gait_name(id).map(char::from).collect();
            assert_eq!(read_name, gait.name().replace('-', " "), "{name}");
            let core_gait = robot.gait(id);
            let mut expected_increment = f64::from(1 << 24) / (gait.period() * 50.0);
            if gait.is_reversed() {
                expected_increment = -expected_increment;
            }
            let error = f64::from(core_gait.increment) - expected_increment;
            assert!(error.abs() <= 0.51, "{gait_label}");
            for step in 0..8192 {
                let pose = core_gait.pose(robot.waves(), step << 11);
                let exact = gait.angles(f64::from(step) / 8192.0);
                for (index, angle) in pose.angles(&robot.neutral_angles()).into_iter().enumerate() {
                    let angle = f64::from(angle.0) / STEPS_PER_DEGREE;
                    let error = (angle - exact[index] + 180.0).rem_euclid(360.0) - 180.0;
                    // The tolerance is the largest error that is allowed for a table, 0.5 deg, plus half a step of the
                    // neutral angle.
                    assert!(
                        error.abs() <= 0.504,
                        "{gait_label} A{} at {step}: {error}",
                        index + 1
                    );
                }
            }
        }
    });
}

/// The row servo and the column servo of each map.
const MAP_SERVOS: [[usize; 2]; 4] = [[0, 1], [2, 3], [0, 3], [1, 2]];

/// Reads the rows of the four maps. For each row, returns the row servo's sweeps and the column servo's certified
/// sweeps.
fn read_maps(flash: Region<'_>) -> [Vec<[std::ops::RangeInclusive<i32>; 2]>; 4] {
    let numbers = read_numbers(flash);
    let rows_part = numbers.parts[SectionPart::Rows as usize];
    let rows = flash.values::<[i8; 2]>(rows_part.address, rows_part.count);
    let mut next_row = 0;
    numbers.maps.map(|header: MapHeader| {
        let map = (0..i32::from(header.row_count)).map(|row| {
            let columns = rows.get(next_row).expect("the maps have this row").load();
            let [first_column, last_column] = columns.map(i32::from);
            next_row += 1;
            let first_sweep = 256 * (i32::from(header.first_row) + row);
            let columns = 128 * first_column..=128 * last_column + 127;
            [first_sweep..=first_sweep + 255, columns]
        });
        map.collect()
    })
}

/// True if a pose, measured without the maps, meets every condition that depends on a map's servos.
fn meets_map_conditions(robot: &Robot, map_index: usize, pose: &Pose) -> bool {
    let clearance = Clearance::measure(robot, pose);
    let limits = robot.limits();
    let meets_margins = |end_index: usize, first_servo: usize| {
        let is_within_limit = |index: usize, limit: Sine| clearance.margins[index] >= limit;
        is_within_limit(end_index, limits.type2)
            && (first_servo..first_servo + 2).all(|index| {
                is_within_limit(2 + index, limits.type1) && is_within_limit(6 + index, limits.leg)
            })
    };
    match map_index {
        0 => meets_margins(0, 0),
        1 => meets_margins(1, 2),
        2 => robot
            .slider(Side::Left)
            .allows(clearance.slider_lengths_sq[0]),
        _ => robot
            .slider(Side::Right)
            .allows(clearance.slider_lengths_sq[1]),
    }
}

#[test]
fn the_corners_and_the_middle_of_every_certified_cell_meet_the_maps_conditions() {
    let mut checked_count = 0;
    let mut robots_with_maps_count = 0;
    for_each_robot(|name, robot, _, flash| {
        let calibration = robot.calibration();
        robots_with_maps_count +=
            usize::from(read_numbers(flash).parts[SectionPart::Rows as usize].count > 0);
        for (map_index, map) in read_maps(flash).into_iter().enumerate() {
            let servos = MAP_SERVOS[map_index];
            for [row, columns] in map {
                for cell_start in (*columns.start()..*columns.end()).step_by(128) {
                    for (row_offset, column_offset) in
                        [(0, 0), (255, 0), (0, 127), (255, 127), (128, 64)]
                    {
                        let sweeps = [row.start() + row_offset, cell_start + column_offset];
                        let mut pose = Pose::NEUTRAL;
                        let mut is_within_travel = true;
                        for (servo, sweep) in servos.into_iter().zip(sweeps) {
                            let sweep = Sweep(sweep as i16);
                            is_within_travel &= calibration[servo].reaches(sweep);
                            pose.0[servo] = sweep;
                        }
                        if is_within_travel {
                            assert!(
                                meets_map_conditions(robot, map_index, &pose),
                                "{name}: map {map_index} {pose:?}"
                            );
                            checked_count += 1;
                        }
                    }
                }
            }
        }
    });
    println!("{checked_count} poses in cells, {robots_with_maps_count} robots with maps");
    assert!(
        robots_with_maps_count >= 5 && checked_count > 100_000,
        "{robots_with_maps_count} robots with maps, {checked_count} poses"
    );
}

#[test]
fn a_pose_in_all_four_maps_is_certified_and_accepted_by_the_guard() {
    let rng = &mut rng(153);
    for_each_robot(|name, robot, _, flash| {
        let maps = read_maps(flash);
        let mut certified_count = 0;
        for index in 0..20_000 {
            let mut pose = Pose::NEUTRAL;
            for (sweep, servo) in pose.0.iter_mut().zip(robot.calibration()) {
                // The sweep is any sweep, a sweep within the travel, or a sweep near neutral.
                *sweep = Sweep(match index % 3 {
                    0 => rng.i16(..),
                    1 => rng.i16(servo.travel_min.0..=servo.travel_max.0),
                    _ => rng.i16(-3000..3000),
                });
            }
            let is_in_maps = MAP_SERVOS.iter().zip(&maps).all(|(servos, map)| {
                let [row, column] = servos.map(|servo| i32::from(pose.0[servo].0));
                map.iter()
                    .any(|[rows, columns]| rows.contains(&row) && columns.contains(&column))
            });
            assert_eq!(robot.is_certified(&pose), is_in_maps, "{name} {pose:?}");
            if is_in_maps {
                certified_count += 1;
                let hazard = Clearance::measure(robot, &pose).first_hazard(robot);
                assert_eq!(hazard, None, "{name} {pose:?}");
            }
        }
        let has_maps = read_numbers(flash).parts[SectionPart::Rows as usize].count > 0;
        assert_eq!(
            certified_count > 100,
            has_maps,
            "{name}: {certified_count} certified poses"
        );
    });
}

#[test]
fn different_robots_have_different_hashes_independent_of_the_maps() {
    let mut hashes = std::collections::HashMap::new();
    for_each_robot(|name, robot, file_robot, _| {
        assert_eq!(robot.hash(), file_robot.firmware().hash(), "{name}");
        let content = file_robot.content();
        // robot.toml may be equal to a file in robots/.
        if let Some((first, first_content)) = hashes.insert(robot.hash(), (name, content)) {
            assert_eq!(first_content, content, "{first} {name}");
        }
    });
}
