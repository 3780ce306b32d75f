//! Test of the running image with the digital twin, from power-on to the body's position on the floor.

use lizard_host::sim::script::{Script, Step};
use lizard_host::sim::session::play;
use lizard_host::sim::spans::list_command_spans;
use lizard_host::twin::replay::Replay;
use lizard_host::twin::report::compute_reports;
use lizard_host_tests::{FirmwareBench, robot};
use lizard_twin::ServoModel;
use simulated_uno::{Fidelity, Uno};

/// Runs every gait that moves, for three cycles and one second to reach the first pose, and replays the pulses on the
/// twin.
fn walk_all_gaits(model: ServoModel) -> Replay {
    let mut ms = 1000;
    let mut steps = Vec::new();
    for gait in robot().gaits().iter().filter(|gait| gait.has_movement()) {
        let command = gait.command();
        steps.push(Step { ms, command });
        ms += 1000 + (3000.0 * gait.period()).ceil() as u64;
    }
    let script = Script::new(steps, ms);
    let mut uno = Uno::with_image(FirmwareBench::image(), Fidelity::DataSheet);
    let recording = play(&mut uno, robot(), &script, |_| Ok(()));
    let recording = recording.expect("the event handler never fails");
    let spans = list_command_spans(&script, &recording.answers);
    Replay::simulate(robot(), recording.frames, spans, model)
}

#[test]
fn the_image_moves_the_body_as_predicted() {
    let model = ServoModel::Ideal;
    let rows = compute_reports(robot(), &walk_all_gaits(model), model, false);
    let cycles: Vec<_> = rows
        .iter()
        .filter_map(|row| Some((row, row.cycle.as_ref()?)))
        .collect();
    let gaits = robot().gaits().iter();
    let moving_gait_count = gaits.filter(|gait| gait.has_movement()).count();
    assert_eq!(
        cycles.len(),
        moving_gait_count,
        "the report does not have one cycle for each moving gait"
    );
    let mut compared_count = 0;
    for (row, cycle) in cycles {
        let (displacement, ideal) = (&cycle.displacement, &cycle.ideal_displacement);
        for (name, measured, expected, tolerance) in [
            ("forward", displacement.forward, ideal.forward, 0.5_f64),
            ("turn", displacement.turn, ideal.turn, 0.3),
        ] {
            let (Some(measured), Some(expected)) = (measured, expected) else {
                assert_eq!(measured, expected, "{} {name}", row.command);
                continue;
            };
            compared_count += 1;
            let error = (measured - expected).abs();
            assert!(
                error <= tolerance.max(0.03 * expected.abs()),
                "{} {name}: expected {expected}, got {measured}",
                row.command
            );
        }
        let max_rate = robot().speed_limits().gait_slew + 5.0;
        assert!(row.servo_rate <= max_rate, "{}", row.command);
        let (name, margin) = row.margin.expect("the loops close at every pose");
        let limits = robot().limits();
        let smallest_limit = limits.type2.min(limits.type1).min(limits.leg);
        assert!(
            margin > smallest_limit - 0.01,
            "{} {name} {margin}",
            row.command
        );
    }
    assert!(compared_count > 0, "no gait has a prediction to compare");
}
