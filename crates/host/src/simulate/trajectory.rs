//! The servo angles that the firmware commands during a gait, for a physics engine.

use std::path::Path;

use lizard_parts::Trajectory;
use lizard_robot::Robot;
use lizard_twin::FRAME_PERIOD_S;
use simulated_uno::CYCLES_PER_US;

use crate::shared::firmware;
use crate::shared::robot_args::find_moving_gait;
use crate::simulate::sim::frame_log::FrameLog;
use crate::simulate::twin;
use crate::{Failure, RobotArgs};

/// Records the servo targets during three cycles of a gait on the simulated UNO. `elf` replaces the built-in firmware.
///
/// # Errors
/// Fails if the gait is unknown, if the firmware is missing or was built for another robot, or if the simulation
/// fails.
pub fn record(
    robot: &Robot,
    robot_args: &RobotArgs,
    gait: &str,
    elf: Option<&Path>,
) -> Result<Trajectory, Failure> {
    let gait = find_moving_gait(robot, gait)?;
    let image = firmware::select_firmware(elf, robot_args, robot)?.image;
    let script = twin::build_walk_script(robot, &[gait.name()]);
    let recording = twin::record(image, robot, &script)?;
    let log = &recording.frames;
    let stop_ms = script.steps.last().map_or(script.end_ms, |step| step.ms);
    let end_s = log.index_at(stop_ms as f64 / 1000.0) as f64 * FRAME_PERIOD_S;
    Ok(Trajectory {
        gait_name: gait.name().to_owned(),
        frames: compute_target_sweeps(robot, log),
        measure_start: end_s - gait.period(),
        period: gait.period(),
        measured_cycle_count: 1,
    })
}

/// Returns each frame's servo targets, computed from the pulses, as sweeps from neutral in degrees. A servo without a
/// pulse keeps its previous target.
fn compute_target_sweeps(robot: &Robot, log: &FrameLog) -> Vec<[f64; 4]> {
    let mut targets = [0.0; 4];
    let frames = log.widths.iter().map(|widths| {
        for (servo, width) in widths.iter().enumerate() {
            if *width > 0 {
                let width_us = f64::from(*width) / CYCLES_PER_US as f64;
                targets[servo] = robot.servos()[servo].sweep(width_us);
            }
        }
        targets
    });
    frames.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_servo_without_a_pulse_keeps_its_previous_target() {
        let robot = crate::shared::robot_args::built_in_robot("unequal");
        let widths = [
            [0; 4],
            [1470 * 16, 1535 * 16, 0, 0],
            [1562 * 16, 0, 1500 * 16, 0],
        ];
        let log = FrameLog::new(0, widths.to_vec());
        let sweeps = compute_target_sweeps(&robot, &log);
        assert_eq!(sweeps[..2], [[0.0; 4]; 2]);
        let error = (sweeps[2][0] - 10.0).abs();
        assert!(error < 1e-9, "92 us are 10 deg: {sweeps:?}");
        assert_eq!(sweeps[2][1..], [0.0; 3]);
    }
}
