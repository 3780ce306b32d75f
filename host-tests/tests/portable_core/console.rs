//! The console as a person meets it: the banner, every command, `watch`,
//! `status`, line ends, and whatever else may come down the line.

use lizard::gait::GaitId;
use lizard::line::LONGEST;
use lizard::robot::TABLES_HASH;
use lizard_host_tests::robot;
use proptest::prelude::*;

use crate::person::{Person, is_final, is_information, pairs};

/// Every command that the robot takes while it stands, as the issue spells it.
const COMMANDS: [&str; 21] = [
    "help",
    "?",
    "stand",
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
    "speed 10",
    "speed 100",
    "pose 138.59 41.41 318.59 221.41",
    "status",
    "watch 3",
    "watch 10000",
    "watch 0",
    "rest",
];

/// What `ok` says: the line as it was understood, but for the two that tell
/// something.
fn final_line(command: &str) -> String {
    match command {
        "help" | "?" => "ok help".into(),
        "status" => "ok gait=".into(),
        other => format!("ok {other}"),
    }
}

#[test]
fn the_banner_names_version_and_tables() {
    let banner = Person::new().listen();
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(banner.len(), 1);
    let start = format!("# lizard {version} tables {TABLES_HASH:08x}");
    assert!(banner[0].starts_with(&start), "{}", banner[0]);
    assert_eq!(TABLES_HASH, robot().tables_hash());
}

#[test]
fn every_command_is_answered_by_one_line() {
    for command in COMMANDS {
        let answer = Person::standing().say(command);
        assert!(answer.starts_with(&final_line(command)), "{answer}");
    }
    // Every gait of the file is a command, a dash read as a blank.
    for gait in &robot().gaits {
        let command = gait.name.replace('-', " ");
        let mut person = Person::standing();
        assert_eq!(person.say(&command), format!("ok {command}"));
        assert_eq!(person.status("gait"), gait.name);
    }
}

#[test]
fn capitals_and_blanks_make_no_difference() {
    for command in COMMANDS {
        let plain = Person::standing().say(command);
        let capitals: String = command.to_uppercase();
        let mixed: String = command
            .chars()
            .enumerate()
            .map(|(n, c)| {
                if n % 2 == 0 {
                    c.to_ascii_uppercase()
                } else {
                    c
                }
            })
            .collect();
        for line in [
            capitals,
            mixed,
            format!("  {command} "),
            format!("\t{command}\t"),
        ] {
            assert_eq!(Person::standing().say(&line), plain, "{line:?}");
        }
        let wide = command.replace(' ', "   ");
        assert_eq!(Person::standing().say(&wide)[..3], *"ok ");
    }
}

#[test]
fn cr_lf_and_both_end_a_line_once() {
    for end in ["\r", "\n", "\r\n", "\n\r", "\r\r\n\n"] {
        let said = Person::standing().type_in(format!("stand{end}speed 50{end}").as_bytes());
        assert_eq!(said, ["ok stand", "ok speed 50"], "{end:?}");
    }
}

#[test]
fn empty_lines_are_ignored() {
    let said = Person::standing().type_in(b"\r\n\n   \r\t\r\n \t \n");
    assert!(said.is_empty(), "{said:?}");
}

#[test]
fn a_line_has_as_many_characters_as_it_says_and_no_more() {
    let line = |length: usize| format!("{:>length$}", "stand");
    assert_eq!(LONGEST, 63);
    assert_eq!(Person::standing().say(&line(63)), "ok stand");
    for length in [64, 65, 200, 5000] {
        let mut person = Person::standing();
        let answer = person.say(&line(length));
        assert_eq!(answer, "err 6 a line has at most 63 characters");
        // The line after it is a new one.
        assert_eq!(person.say("stand"), "ok stand");
    }
}

#[test]
fn what_is_typed_wrong_can_be_taken_back() {
    for back in [b"\x08", b"\x7f"] {
        let line = [b"walt", &back[..], b"k\r"].concat();
        assert_eq!(Person::standing().type_in(&line), ["ok walk"]);
        // More than there is takes nothing back.
        let line = [&back.repeat(5)[..], b"stand\r"].concat();
        assert_eq!(Person::standing().type_in(&line), ["ok stand"]);
        let line = [b"stand", &back.repeat(5)[..], b"\r"].concat();
        assert!(Person::standing().type_in(&line).is_empty());
    }
}

#[test]
fn help_lists_every_command_and_every_gait() {
    for question in ["help", "?", "HELP"] {
        let said = Person::standing().type_in(format!("{question}\r").as_bytes());
        let (last, lines) = said.split_last().expect("help");
        assert_eq!(last, "ok help");
        assert!(lines.iter().all(|line| is_information(line)));
        let all = lines.join("\n");
        for word in ["stop", "rest", "speed", "pose", "status", "watch"] {
            assert!(all.contains(&format!("# {word}")), "{word}");
        }
        for gait in &robot().gaits {
            assert!(all.contains(&gait.name.replace('-', " ")), "{}", gait.name);
        }
    }
}

#[test]
fn help_asked_twice_is_given_twice() {
    let mut person = Person::standing();
    let first = person.type_in(b"help\r");
    assert_eq!(person.type_in(b"?\r"), first);
}

#[test]
fn status_tells_everything_as_key_and_value() {
    let mut person = Person::standing();
    person.counters.late = 7;
    person.counters.rx_lost = 65_535;
    person.say("speed 42");
    person.say("arc left");
    person.run(200);
    let line = person.say("status");
    let status = pairs(line.strip_prefix("ok ").expect("ok"));
    let mut keys: Vec<&str> = status.keys().map(String::as_str).collect();
    keys.sort_unstable();
    let expected = [
        "frames", "gait", "guard", "late", "margin", "phase", "pose", "rx_lost", "speed",
    ];
    assert_eq!(keys, expected);
    assert!(line.starts_with("ok gait=arc-left phase=0."), "{line}");
    assert_eq!(status["speed"], "42");
    assert_eq!(status["late"], "7");
    assert_eq!(status["rx_lost"], "65535");
    assert_eq!(status["guard"], "clear");
    assert_eq!(
        status["frames"],
        person.console.motion().frames().to_string()
    );
    let phase: f64 = status["phase"].parse().expect("a number");
    let exact = f64::from(person.console.motion().phase()) / f64::from(1 << 24);
    assert!(phase <= exact && exact < phase + 0.0011, "{phase} {exact}");
    let angles: Vec<f64> = status["pose"]
        .split(',')
        .map(|angle| angle.parse().expect("a number"))
        .collect();
    for (n, angle) in angles.iter().enumerate() {
        let exact = crate::truth::degrees(person.console.motion().pose().angle(n));
        assert!((angle - exact).abs() <= 0.0051);
    }
    let margin: f64 = status["margin"].parse().expect("a number");
    let pose = <[f64; 4]>::try_from(angles).expect("four").into();
    let least = robot().lizard.margins(&pose).expect("closes").min().1;
    assert!((margin - least).abs() <= 0.0025, "{margin} {least}");
}

#[test]
fn status_names_what_the_robot_does() {
    let mut person = Person::standing();
    assert_eq!(person.status("gait"), "stand");
    for (command, gait) in [
        ("walk", "walk"),
        ("arc right", "arc-right"),
        ("pose 138.59 41.41 318.59 221.41", "pose"),
        ("stop", "stop"),
        ("rest", "rest"),
        ("stand", "stand"),
    ] {
        person.say(command);
        assert_eq!(person.status("gait"), gait);
    }
}

#[test]
fn the_longest_status_fits_the_promised_line() {
    // Person::listen holds every line to it; here, with each number at its
    // longest: ten digits of frames, as many angles as there are.
    let mut person = Person::standing();
    person.counters.late = u16::MAX;
    person.counters.rx_lost = u16::MAX;
    let longest_name = GaitId::all()
        .map(|id| id.load().name.trim_ascii_end().len())
        .max()
        .expect("gaits");
    let line = person.say("status");
    let frames = person.status("frames").len();
    let widest = line.len() - "stand".len() + longest_name - frames + 10 + 4 * "359.99".len()
        - person.status("pose").len()
        + 3
        + "-1.000".len()
        - "0.661".len()
        + "\r\n".len();
    println!("the longest status has {widest} bytes");
    assert!(widest <= usize::from(lizard::console::LONGEST_LINE));
}

#[test]
fn watch_reports_the_pose_of_every_nth_frame_until_it_is_ended() {
    for every in [1u32, 2, 7, 50] {
        let mut person = Person::standing();
        person.say("walk");
        assert_eq!(
            person.say(&format!("watch {every}")),
            format!("ok watch {every}")
        );
        let begin = person.console.motion().frames();
        let mut times = Vec::new();
        for _ in 0..200 {
            for line in person.frame().1 {
                let watched = pairs(line.strip_prefix("# ").expect("information"));
                assert_eq!(watched.len(), 2, "{line}");
                let time: u32 = watched["t"].parse().expect("a number");
                assert_eq!(time, person.console.motion().frames());
                assert_eq!(watched["pose"], person.status("pose"));
                times.push(time - begin);
            }
        }
        let expected: Vec<u32> = (1..=200).filter(|t| t % every == 0).collect();
        assert_eq!(times, expected);
        assert_eq!(person.say("watch 0"), "ok watch 0");
        assert!(person.run(200).is_empty());
    }
}

#[test]
fn watch_goes_on_while_the_robot_rests() {
    let mut person = Person::standing();
    person.say("watch 5");
    person.say("rest");
    assert_eq!(person.run(50).len(), 10);
}

#[test]
fn speed_holds_for_every_gait_from_then_on() {
    let mut person = Person::standing();
    person.say("speed 35");
    for command in ["walk", "stop", "trot", "rest", "stand", "look"] {
        person.say(command);
        person.run(30);
        assert_eq!(person.status("speed"), "35");
    }
}

/// What is expected of bytes: how each line of them ends, told by another
/// reader of lines than the core's.
fn lines_typed(bytes: &[u8]) -> Vec<Option<String>> {
    let mut lines = Vec::new();
    for line in bytes.split(|byte| matches!(byte, b'\r' | b'\n')) {
        let mut kept: Vec<u8> = Vec::new();
        let mut too_long = false;
        for byte in line {
            match byte {
                0x08 | 0x7f => drop(kept.pop()),
                _ if kept.len() == 63 => too_long = true,
                _ => kept.push(*byte),
            }
        }
        let text: String = kept.iter().map(|byte| char::from(*byte)).collect();
        let text = text.trim_matches(|c: char| " \t\x0c\r\n".contains(c));
        lines.push((!too_long).then(|| text.to_ascii_lowercase()));
    }
    lines.pop(); // not ended yet
    lines.retain(|line| line.as_deref() != Some(""));
    lines
}

/// Bytes of a person, of a program gone mad, and of a broken cable.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let command = prop::sample::select(COMMANDS.to_vec())
        .prop_map(|command| format!("{command}\r").into_bytes());
    let piece = prop_oneof![
        4 => command,
        2 => prop::collection::vec(any::<u8>(), 0..40),
        2 => "[ -~\x08\x7f\t]{0,80}[\r\n]{0,2}".prop_map(String::into_bytes),
        2 => "(pose|speed|watch|arc|walk|POSE)( [+-]?[0-9]{0,6}\\.?[0-9]{0,3}){0,5}\r\n"
            .prop_map(String::into_bytes),
    ];
    prop::collection::vec(piece, 0..12).prop_map(|pieces| pieces.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn every_line_of_any_bytes_gets_exactly_one_final_line(bytes in bytes()) {
        let mut person = Person::standing();
        let said = person.type_in(&bytes);
        let finals: Vec<&String> = said.iter().filter(|line| is_final(line)).collect();
        let typed = lines_typed(&bytes);
        prop_assert_eq!(finals.len(), typed.len(), "{:?} {:?}", said, typed);
        for (answer, line) in finals.into_iter().zip(typed) {
            match line {
                None => prop_assert!(answer.starts_with("err 6 ")),
                Some(line) => prop_assert!(!answer.starts_with("err 6 "), "{line}"),
            }
        }
    }

    #[test]
    fn frames_between_any_bytes_never_fail(bytes in bytes(), frames in 0usize..4) {
        // Person::listen checks the form of every line; overflow or a bad index
        // would panic.
        let mut person = Person::new();
        for byte in bytes {
            person.type_in(&[byte]);
            for _ in 0..frames {
                person.frame();
            }
        }
    }

    #[test]
    fn it_is_all_the_same_whether_bytes_come_at_once_or_frames_apart(bytes in bytes()) {
        let (mut once, mut apart) = (Person::standing(), Person::standing());
        let words = |said: Vec<String>| -> Vec<String> {
            said.into_iter().filter(|line| is_final(line) && !line.contains('=')).collect()
        };
        let at_once = words(once.type_in(&bytes));
        let mut one_by_one = Vec::new();
        for byte in &bytes {
            one_by_one.extend(apart.type_in(&[*byte]));
            one_by_one.extend(apart.run(1));
        }
        prop_assert_eq!(words(one_by_one), at_once);
    }
}
