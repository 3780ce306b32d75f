//! Pulses in, floor under: what the core sends, turned back into angles and put
//! on the ground of the contact model, must go where the gaits were meant to.

use lizard::pose::Pulses;
use lizard_host_tests::robot;
use lizard_robot::Travel;

use crate::person::Person;

/// A cycle of each gait: mm ahead, deg counter-clockwise. Found elsewhere, with
/// the waveforms in floating point.
const PREDICTED: [(&str, f64, f64); 9] = [
    ("stand", 0.0, 0.0),
    ("walk", 34.16, 0.0),
    ("trot", 26.66, 0.0),
    ("crawl", 30.78, 0.0),
    ("back", -34.16, 0.0),
    ("left", 0.0, 15.34),
    ("right", 0.0, -15.34),
    ("arc left", 17.71, 5.27),
    ("arc right", 17.71, -5.27),
];

/// Frames to full pace at the gait's first pose, more or less.
const GATHERED: u32 = 80;

/// Servo angles in the chassis frame, deg, from widths in cycles of 62.5 ns.
fn angles(pulses: Pulses) -> [f64; 4] {
    std::array::from_fn(|n| {
        let servo = &robot().servos[n];
        servo.neutral + servo.sweep(f64::from(pulses.0[n]) / 16.0)
    })
}

/// Where one cycle leads, by the pulses that the core sends for a command, at a
/// speed in percent. It begins where the gait's phase is next to 0.
fn travel(command: &str, percent: f64) -> Travel {
    let mut person = Person::standing();
    assert!(person.say(&format!("speed {percent}")).starts_with("ok"));
    assert!(person.say(command).starts_with("ok"));
    person.run(GATHERED);
    let (_, gait) = robot().gait(command).expect(command);
    let frames = gait.period * 50.0 * 100.0 / percent;
    // The frame with the phase nearest to 0, going up or down.
    let from_zero = |person: &Person| {
        let phase = i64::from(person.console.motion().phase());
        phase.min((1 << 24) - phase)
    };
    let near = ((1 << 24) as f64 / frames) as i64;
    while from_zero(&person) > near / 2 + 1 {
        person.run(1);
    }
    let mut path = vec![angles(person.console.motion().pose().pulses())];
    for _ in 0..frames.ceil() as usize {
        path.push(angles(person.frame().0));
    }
    // A cycle may end between two frames.
    let over = path.len() - 1;
    let share = frames - frames.ceil() + 1.0;
    let before = path[over - 1];
    let last = path[over];
    path[over] = std::array::from_fn(|n| before[n] + share * (last[n] - before[n]));
    robot().travel(path)
}

fn assert_goes(command: &str, percent: f64, forward: f64, turn: f64) {
    let travel = travel(command, percent);
    println!(
        "{command:<10} at {percent} %: {:+.2} mm, {:+.2} deg, aside {:+.2} mm",
        travel.forward, travel.turn, travel.left
    );
    let off = (travel.forward - forward).abs();
    assert!(
        off <= 0.3f64.max(0.01 * forward.abs()),
        "{command} {travel:?}"
    );
    assert!((travel.turn - turn).abs() <= 0.2, "{command} {travel:?}");
}

#[test]
fn the_pulses_of_every_gait_go_where_the_gait_was_meant_to() {
    for (command, forward, turn) in PREDICTED {
        assert_goes(command, 100.0, forward, turn);
    }
}

#[test]
fn a_cycle_leads_as_far_at_any_speed() {
    for percent in [20.0, 50.0, 80.0] {
        for (command, forward, turn) in PREDICTED {
            assert_goes(command, percent, forward, turn);
        }
    }
}

#[test]
fn the_head_of_look_follows_its_path() {
    let mut person = Person::standing();
    assert!(person.say("look").starts_with("ok"));
    person.run(GATHERED);
    let (_, gait) = robot().gait("look").expect("look");
    let mut farthest = 0.0f64;
    for _ in 0..200 {
        let (pulses, _) = person.frame();
        let sent = robot()
            .lizard
            .solve(&angles(pulses).into())
            .expect("closes");
        let phase = f64::from(person.console.motion().phase()) / f64::from(1 << 24);
        let meant = robot().lizard.solve(&gait.pose(phase)).expect("closes");
        let off = (sent.head_point() - meant.head_point()).length();
        farthest = farthest.max(off);
        assert!((sent.tail_point() - meant.tail_point()).length() < 0.01);
    }
    println!("the head is at most {farthest:.3} mm off its path");
    assert!(farthest < 0.1);
}

#[test]
fn pulses_stand_for_the_pose_that_status_tells() {
    let mut person = Person::standing();
    assert!(person.say("crawl").starts_with("ok"));
    for _ in 0..150 {
        let (pulses, _) = person.frame();
        let told: Vec<f64> = person
            .status("pose")
            .split(',')
            .map(|angle| angle.parse().expect("a number"))
            .collect();
        for (n, angle) in angles(pulses).into_iter().enumerate() {
            // A cycle is .006 deg, a hundredth is told.
            assert!((angle - told[n]).abs() <= 0.012, "A{}", n + 1);
        }
    }
}
