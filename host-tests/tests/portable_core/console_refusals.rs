//! What the console refuses, with which code and words, and that nothing is
//! changed by it.

use proptest::prelude::*;

use crate::person::Person;

/// A line, and the whole of the answer to it.
const REFUSED: [(&str, &str); 64] = [
    // 1: not a command.
    ("dance", "err 1 unknown command, send help for the list"),
    ("walkk", "err 1 unknown command, send help for the list"),
    ("wal", "err 1 unknown command, send help for the list"),
    ("halt", "err 1 unknown command, send help for the list"),
    ("??", "err 1 unknown command, send help for the list"),
    ("-", "err 1 unknown command, send help for the list"),
    ("arc-left", "err 1 unknown command, send help for the list"),
    ("arcleft", "err 1 unknown command, send help for the list"),
    ("left arc", "err 2 this command takes no argument"),
    ("speed10", "err 1 unknown command, send help for the list"),
    ("watch0", "err 1 unknown command, send help for the list"),
    ("stop.", "err 1 unknown command, send help for the list"),
    ("\x00", "err 1 unknown command, send help for the list"),
    ("\u{e9}", "err 1 unknown command, send help for the list"),
    ("12", "err 1 unknown command, send help for the list"),
    // 2: an argument too many, too few or not as it should be.
    ("walk fast", "err 2 this command takes no argument"),
    ("walk 3", "err 2 this command takes no argument"),
    ("stand stand", "err 2 this command takes no argument"),
    ("stop now", "err 2 this command takes no argument"),
    ("rest 5", "err 2 this command takes no argument"),
    ("help me", "err 2 this command takes no argument"),
    ("? ?", "err 2 this command takes no argument"),
    ("status all", "err 2 this command takes no argument"),
    ("arc left now", "err 2 this command takes no argument"),
    ("arc", "err 2 this command wants one more word"),
    ("speed", "err 2 speed wants a whole number, 10..100"),
    ("speed fast", "err 2 speed wants a whole number, 10..100"),
    ("speed 5o", "err 2 speed wants a whole number, 10..100"),
    ("speed 50%", "err 2 speed wants a whole number, 10..100"),
    ("speed 50.5", "err 2 speed wants a whole number, 10..100"),
    ("speed -50", "err 2 speed wants a whole number, 10..100"),
    ("speed +50", "err 2 speed wants a whole number, 10..100"),
    ("speed 50 60", "err 2 speed wants a whole number, 10..100"),
    ("watch", "err 2 watch wants a whole number, 0..10000"),
    ("watch x", "err 2 watch wants a whole number, 0..10000"),
    ("watch 1.5", "err 2 watch wants a whole number, 0..10000"),
    ("watch -1", "err 2 watch wants a whole number, 0..10000"),
    ("watch 1 2", "err 2 watch wants a whole number, 0..10000"),
    ("pose", POSE_WANTS),
    ("pose 138.59", POSE_WANTS),
    ("pose 138.59 41.41 318.59", POSE_WANTS),
    ("pose 138.59 41.41 318.59 221.41 0", POSE_WANTS),
    ("pose 138.591 41.41 318.59 221.41", POSE_WANTS),
    ("pose 138,59 41,41 318,59 221,41", POSE_WANTS),
    ("pose a 41.41 318.59 221.41", POSE_WANTS),
    ("pose .5 41.41 318.59 221.41", POSE_WANTS),
    ("pose - 41.41 318.59 221.41", POSE_WANTS),
    ("pose --1 41.41 318.59 221.41", POSE_WANTS),
    ("pose 1e2 41.41 318.59 221.41", POSE_WANTS),
    ("pose 138.5x 41.41 318.59 221.41", POSE_WANTS),
    // 3: out of range.
    ("speed 9", "err 3 speed must be 10..100"),
    ("speed 101", "err 3 speed must be 10..100"),
    ("speed 0", "err 3 speed must be 10..100"),
    ("speed 99999999999999999999", "err 3 speed must be 10..100"),
    ("watch 10001", "err 3 watch must be 0..10000"),
    ("watch 65536", "err 3 watch must be 0..10000"),
    (
        "pose 48.58 41.41 318.59 221.41",
        "err 3 A1 reaches 48.59..228.59",
    ),
    (
        "pose 138.59 311.40 318.59 221.41",
        "err 3 A2 reaches 311.41..131.41",
    ),
    (
        "pose 138.59 41.41 48.60 221.41",
        "err 3 A3 reaches 228.59..48.59",
    ),
    (
        "pose 138.59 41.41 318.59 9999999",
        "err 3 A4 reaches 131.41..311.41",
    ),
    (
        "pose 500 41.41 318.59 221.41",
        "err 3 A1 reaches 48.59..228.59",
    ),
    (
        "pose -360.01 41.41 318.59 221.41",
        "err 3 A1 reaches 48.59..228.59",
    ),
    // 4 and 5: UNSAFE.
    // 6: too long.
    (
        "walk                                                            ",
        "err 6 a line has at most 63 characters",
    ),
    (
        "0123456789012345678901234567890123456789012345678901234567890123",
        "err 6 a line has at most 63 characters",
    ),
];

const POSE_WANTS: &str = "err 2 pose wants four angles in degrees, at most two decimals";

#[test]
fn every_mistake_has_its_code_and_its_sentence() {
    for (line, answer) in REFUSED {
        assert_eq!(Person::standing().say(line), answer, "{line:?}");
    }
}

/// Poses that the guard refuses, and the reason: figures from the closed forms.
const UNSAFE: [(&str, &str); 15] = [
    // d = 20 - 60 cos 78.5 = 8.04 mm, and d sqrt(10000 - d^2) / 5000 = .160.
    (
        "pose 78.5 101.5 318.59 221.41",
        "err 4 type-2 margin of the head is 0.160, at least 0.300",
    ),
    (
        "pose 138.59 41.41 258.5 281.5",
        "err 4 type-2 margin of the tail is 0.160, at least 0.300",
    ),
    // Crossed: d = 10 mm beyond the singularity.
    (
        "pose 60 120 318.59 221.41",
        "err 4 type-2 margin of the head is -0.199, at least 0.300",
    ),
    (
        "pose 138.59 41.41 240 300",
        "err 4 type-2 margin of the tail is -0.199, at least 0.300",
    ),
    // The apex 10 to the left or right of 15 + sqrt(2400) ahead: an elbow bends in.
    (
        "pose 60 60 318.59 221.41",
        "err 4 type-1 margin of A1 is -0.317, at least 0.300",
    ),
    (
        "pose 120 120 318.59 221.41",
        "err 4 type-1 margin of A2 is -0.317, at least 0.300",
    ),
    (
        "pose 138.59 41.41 240 240",
        "err 4 type-1 margin of A3 is -0.317, at least 0.300",
    ),
    (
        "pose 138.59 41.41 300 300",
        "err 4 type-1 margin of A4 is -0.317, at least 0.300",
    ),
    // sin 170, and beyond the change points.
    (
        "pose 170 41.41 318.59 221.41",
        "err 4 leg margin of A1 is 0.174, at least 0.300",
    ),
    (
        "pose 138.59 10 318.59 221.41",
        "err 4 leg margin of A2 is 0.174, at least 0.300",
    ),
    (
        "pose 138.59 41.41 350 221.41",
        "err 4 leg margin of A3 is 0.174, at least 0.300",
    ),
    (
        "pose 138.59 41.41 318.59 190",
        "err 4 leg margin of A4 is 0.174, at least 0.300",
    ),
    (
        "pose 138.59 350 318.59 221.41",
        "err 4 leg margin of A2 is -0.174, at least 0.300",
    ),
    // 135 + 60 cos 80 = 145.42 mm, 90 of them nominal.
    (
        "pose 80 41.41 318.59 280",
        "err 5 left slider is at 55.42 mm, stroke -15.00..45.00",
    ),
    (
        "pose 138.59 100 260 221.41",
        "err 5 right slider is at 55.42 mm, stroke -15.00..45.00",
    ),
];

#[test]
fn an_unsafe_pose_is_refused_with_what_is_wrong_its_value_and_its_limit() {
    for (line, answer) in UNSAFE {
        assert_eq!(Person::standing().say(line), answer, "{line}");
    }
}

#[test]
fn a_resting_robot_refuses_to_move_until_it_is_told_to_stand() {
    let moving = [
        "walk",
        "trot",
        "crawl",
        "back",
        "left",
        "right",
        "arc left",
        "arc right",
        "look",
        "stop",
        "pose 138.59 41.41 318.59 221.41",
        "pose 78.5 101.5 318.59 221.41",
    ];
    for line in moving {
        let mut person = Person::standing();
        assert_eq!(person.say("rest"), "ok rest");
        person.run(5);
        assert_eq!(
            person.say(line),
            "err 7 servos are resting, send stand first"
        );
        for _ in 0..100 {
            assert_eq!(person.frame().0.0, [0; 4], "{line}");
        }
        assert_eq!(person.status("gait"), "rest");
        // What moves nothing is answered, and a mistake is still a mistake.
        assert_eq!(person.say("speed 50"), "ok speed 50");
        assert_eq!(person.say("watch 0"), "ok watch 0");
        assert_eq!(person.say("rest"), "ok rest");
        assert_eq!(person.say("help"), "ok help");
        assert!(person.say("dance").starts_with("err 1 "));
        assert_eq!(person.say("stand"), "ok stand");
        person.run(25);
        assert!(person.frame().0.0.iter().all(|width| *width > 0));
    }
}

/// Lines that are refused in some state or other.
fn refused() -> impl Strategy<Value = String> {
    let all: Vec<&str> = REFUSED
        .iter()
        .chain(&UNSAFE)
        .map(|(line, _)| *line)
        .collect();
    let angle = || (0u32..36_000).prop_map(|angle| f64::from(angle) / 100.0);
    prop_oneof![
        prop::sample::select(all).prop_map(str::to_owned),
        (angle(), angle(), angle(), angle())
            .prop_map(|(a, b, c, d)| format!("pose {a} {b} {c} {d}")),
        "[a-z]{1,8}( [a-z0-9.]{1,6}){0,3}",
    ]
}

/// Commands that a robot obeys, and frames to do so.
fn obeyed() -> impl Strategy<Value = (String, u32)> {
    let commands = [
        "stand",
        "walk",
        "trot",
        "left",
        "arc right",
        "look",
        "stop",
        "rest",
        "speed 33",
        "speed 100",
        "watch 9",
        "watch 0",
        "pose 120 50 310 230",
        "pose 150 30 330 210",
    ];
    (prop::sample::select(commands.to_vec()), 0u32..90)
        .prop_map(|(command, frames)| (command.to_owned(), frames))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_refused_line_changes_nothing(
        history in prop::collection::vec(obeyed(), 0..6),
        lines in prop::collection::vec(refused(), 1..4),
    ) {
        let (mut asked, mut spared) = (Person::standing(), Person::standing());
        for (command, frames) in history {
            for person in [&mut asked, &mut spared] {
                person.say(&command);
                person.run(frames);
            }
        }
        for line in lines {
            if line.trim().is_empty() {
                continue;
            }
            let answer = asked.say(&line);
            if !answer.starts_with("err ") {
                return Ok(()); // a pose that is safe, or a word that is one
            }
        }
        prop_assert_eq!(asked.say("status"), spared.say("status"));
        for _ in 0..80 {
            prop_assert_eq!(asked.frame(), spared.frame());
        }
        prop_assert_eq!(asked.say("status"), spared.say("status"));
    }
}
