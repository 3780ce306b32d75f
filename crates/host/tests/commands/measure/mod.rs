//! Tests of `lizard measure` with rendered videos whose true values are known, and of the printed sheet in the videos.

mod keys;
mod servo_and_slope;
mod sheet;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use fastrand::Rng;
use lizard_studio::encode_jpeg;
use lizard_studio::render::{Pose, Studio};
use lizard_studio::walk::{Variation, Walk, WalkSeries, paper_gait, true_displacement};
use serde_json::Value;

use crate::harness::{
    Outcome, TemporaryRobot, assert_contains, expect_refusals, new_folder, read_file, robot_path,
    run_command, run_line, scratch_folder,
};

/// Frame rate of the videos.
const FRAMES_PER_SECOND: f64 = 8.0;

/// Returns a studio with a low resolution, for speed, in which the sheet fills the frame.
fn studio() -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(4));
    (studio.size, studio.focal_length) = ([640, 360], 1.0);
    (studio.camera_height, studio.camera_tilt) = (800.0, 15.0);
    (studio.camera_direction, studio.camera_roll) = (90.0, 0.0);
    studio.aim = [0.0; 2];
    studio.deck_tag_height = 95.0;
    studio
}

/// Returns small differences between the cycles of a walk.
fn variation() -> Variation {
    Variation {
        cycle_deviation: [0.1, 0.1, 0.002],
        ..Variation::default()
    }
}

/// Returns five cycles of `walk` that differ slightly from each other.
fn varied_walk() -> Walk {
    let gait = paper_gait("walk");
    let start = [-true_displacement(&gait).forward * 2.5, 0.0, 0.0];
    Walk::new(&gait, start, 5, variation(), &mut Rng::with_seed(4))
}

/// Renders a moving robot as JPEG files in a new folder; `file_name` returns a name for the frame's index.
fn render_video(
    folder: &str,
    file_name: impl Fn(usize) -> String,
    duration_s: f64,
    pose_at: impl Fn(f64) -> Pose,
) -> PathBuf {
    let folder = new_folder(folder);
    let mut rng = Rng::with_seed(4);
    let background = studio().render_background(&mut rng);
    for i in 0..(duration_s * FRAMES_PER_SECOND) as usize {
        let frame = background.render_frame(i as f64 / FRAMES_PER_SECOND, &pose_at, &mut rng);
        let path = folder.join(file_name(i));
        let jpeg = encode_jpeg(&frame, 80).expect("the frame is encodable");
        fs::write(path, jpeg).expect("the file is written");
    }
    folder
}

/// Runs `lizard measure` on a video, whose path may contain spaces.
fn measure(video: &Path, options: &str) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.arg("measure").arg(video).args(["--height", "95"]);
    command.args(options.split_whitespace());
    run_command(command.current_dir(scratch_folder()), "")
}

/// Returns the words of a table that are the same for every video: all except numbers and verdicts.
fn find_stable_words(table: &str) -> Vec<&str> {
    let verdict_words = ["more", "less", "errors", "agrees"];
    let component_words = ["ahead", "left", "turn", "mm", "deg"];
    table
        .lines()
        .flat_map(|line| {
            // The component with the largest deviation depends on the video, so its name is skipped, too.
            let is_path = line.starts_with("path");
            let words = line.split_whitespace();
            let words = words.map(|word| word.trim_end_matches(','));
            words.filter(move |word| !(is_path && component_words.contains(word)))
        })
        .filter(|word| word.chars().all(char::is_alphabetic))
        .filter(|word| !verdict_words.contains(word))
        .collect()
}

#[test]
fn a_video_of_a_walk_agrees_with_the_prediction_and_is_refused_as_another_gait() {
    let walk = varied_walk();
    let file_name = |i: usize| format!("walk-{}ms.jpg", i * 125);
    let folder = render_video("walk video", file_name, walk.duration_s(), |time| {
        walk.pose_at(time)
    });
    let measure_walk = |options: &str| measure(&folder, &format!("--gait walk {options}"));
    let paper = robot_path("paper");
    let measurement = measure_walk(&format!("--json --robot {paper}")).expect_json();
    // Every number is finite: serde_json writes NaN and infinity as null.
    assert!(!measurement.to_string().contains("null"), "{measurement}");
    let video = &measurement["videos"][0];
    let result = &measurement["gaits"][0];
    let find_number = |path: &[&str]| {
        let value = path.iter().fold(result, |value, key| &value[*key]);
        let number = value.as_f64();
        number.unwrap_or_else(|| panic!("{path:?}: {result}"))
    };
    let truth = true_displacement(&paper_gait("walk"));
    for (name, truth, max_error) in [
        ("forward", truth.forward, 0.2),
        ("left", truth.left, 0.2),
        ("turn", truth.turn, 0.5),
    ] {
        for (key, max_error) in [("mean", max_error), ("predicted", 1e-2)] {
            let error = find_number(&[name, key]) - truth;
            assert!(error.abs() < max_error, "{name} {key}: {result}");
        }
    }
    let (cycles, period) = (find_number(&["cycles"]), find_number(&["period"]));
    assert!(cycles >= 3.0 && (period - 1.0).abs() < 0.01);
    let each_cycle = result["each"].as_array().expect("the value is an array");
    assert_eq!(each_cycle.len(), cycles as usize);
    let engine_results = read_file("tools/physics/walks.json");
    let engine_results: Value = serde_json::from_str(&engine_results).expect("the file is JSON");
    let mujoco = &engine_results["paper"]["walk"]["rigid, level"]["mujoco"];
    assert_eq!(&result["mujoco"], mujoco);
    // The stored MuJoCo results stay valid if a comment is added to robot.toml, but not if the mass changes.
    for (change, mujoco) in [
        (("[limits]", "# mine\n[limits]"), mujoco),
        (("mass = 435.0", "mass = 500.0"), &Value::Null),
    ] {
        let robot = TemporaryRobot::from_paper(&[change]);
        let measurement = measure_walk(&robot.add_option("--json")).expect_json();
        assert_eq!(&measurement["gaits"][0]["mujoco"], mujoco);
    }
    let range = &result["range"];
    let predicted = find_number(&["forward", "predicted"]);
    let [min, max] =
        ["least", "most"].map(|end| range[end].as_f64().expect("the value is a number"));
    assert!(min < predicted - 5.0 && predicted + 1.0 < max, "{range}");
    assert_eq!(range["least_by"], "mounting of the legs");
    let table = measure_walk(&format!("--robot {paper}")).expect_success();
    assert!(table.contains("agrees"), "{table}");
    // The example in docs/measure.md is the output for such a video.
    let page = read_file("docs/measure.md");
    let example = page.split_once("--gait walk --height 95\n");
    let (_, example) = example.expect("the page has the example");
    let (example, _) = example.split_once("```").expect("the example ends");
    let table = table.replace(&folder.display().to_string(), "video.mp4");
    assert_eq!(find_stable_words(example), find_stable_words(&table));
    let csv = measure(&folder, "--csv").expect_success();
    let csv_start = "seconds,forward,left,heading\n0.0000,";
    assert!(csv.starts_with(csv_start), "{csv}");
    assert_eq!(video["frames"], csv.lines().count() - 1);
    // A path that does not match the named gait is refused; the message names the gait that matches.
    let message = measure(&folder, "--gait left").expect_refusal();
    assert!(message.contains("was it another gait"), "{message}");
    assert!(message.ends_with("; it resembles walk"), "{message}");
}

/// Returns the gaits in the output of `lizard measure --json`, each with the number of its walks.
fn count_walks(output: &Value) -> Vec<(&str, usize)> {
    let gaits = output["gaits"].as_array().expect("the value is an array");
    let counts = gaits.iter().map(|result| {
        let name = result["gait"].as_str().expect("the gait has a name");
        (name, result["walks"].as_array().map_or(0, Vec::len))
    });
    counts.collect()
}

#[test]
fn measure_identifies_gaits_by_given_names_or_by_their_paths() {
    let [walk, left] = ["walk", "left"].map(paper_gait);
    let order = [(&walk, 3), (&left, 4), (&walk, 3)];
    let start = [-90.0, -20.0, 0.0];
    let mut rng = Rng::with_seed(4);
    let series = WalkSeries::new(start, &order, 2.2, variation(), &mut rng);
    let file_name = |i| format!("{i}.jpg");
    let folder = render_video("gaits", file_name, series.duration_s(), |time| {
        series.pose_at(time)
    });
    let paper = robot_path("paper");
    let measure_gaits =
        |options: &str| measure(&folder, &format!("--robot {paper} --fps 8 {options}"));
    let unnamed_measurement = measure_gaits("--json --picture measured.svg").expect_json();
    let walks = count_walks(&unnamed_measurement);
    assert_eq!(walks, [("walk", 2), ("left", 1)], "{unnamed_measurement}");
    let named_measurement = measure_gaits("--json --gait walk,left,walk").expect_json();
    assert_eq!(count_walks(&named_measurement), walks);
    for (index, gait) in [walk, left].iter().enumerate() {
        let result = &unnamed_measurement["gaits"][index];
        let truth = true_displacement(gait);
        for (component, truth, max_error) in
            [("forward", truth.forward, 0.3), ("turn", truth.turn, 0.5)]
        {
            let mean = result[component]["mean"].as_f64().expect(component);
            assert!((mean - truth).abs() < max_error, "{component}: {result}");
        }
        assert_eq!(result["farthest"]["agrees"], true, "{result}");
        let within = result["within"].as_array();
        assert!(within.map_or(0, Vec::len) >= 6, "{result}");
    }
    let svg = fs::read_to_string(scratch_folder().join("measured.svg"));
    let svg = svg.expect("the file is readable");
    for label in ["walk, ", "left, ", "measured", "predicted", "turn, deg"] {
        assert!(svg.contains(label), "{label}: {svg}");
    }
    // A gait that is not in the video and gaits in the wrong order are refused.
    let refusal = measure_gaits("--gait walk,left,walk,back").expect_refusal();
    assert!(
        refusal.starts_with("lizard: found 3 walks between rests of")
            && refusal.contains("names 4: walk, left, walk, back\n")
            && refusal.contains(" s long: resembles left\n")
            && refusal.ends_with("no walk resembles back"),
        "{refusal}"
    );
    let refusal = measure_gaits("--gait left,walk,walk").expect_refusal();
    assert_contains(&refusal, " s, left: the path does not match this gait");
    assert!(refusal.ends_with("; it resembles walk"), "{refusal}");
    let refusal = measure_gaits("--picture gaits/0.jpg").expect_refusal();
    assert_contains(&refusal, "gaits/0.jpg: this command reads it");
}

#[test]
fn impossible_measurements_are_refused_with_a_message() {
    let folder = new_folder("measure refusals");
    for name in ["empty", "text", "untimed"] {
        fs::create_dir(folder.join(name)).expect("the folder is created");
    }
    for (name, text) in [("text/a.png", "no picture"), ("untimed/frame-001.png", "")] {
        fs::write(folder.join(name), text).expect("the file is written");
    }
    let cases = "
        measure none --gait walk => lizard: none is neither a video file nor a folder...
        measure empty --gait walk => lizard: empty has no frames: .png, .jpg or .jpeg files...
        measure untimed --gait walk => lizard: the time of untimed/frame-001.png is unknown: give the frames per second...
        measure text --gait wlak --fps 30 => lizard: the robot has no gait `wlak`; allowed values:...
        measure text --gait stand --fps 30 => lizard: the gait `stand` moves no servo
        measure text --gait walk --fps 30 => lizard: text/a.png is not a complete PNG or JPEG file
        measure text --gait walk --ruler 20 => error: invalid value '20' for '--ruler <MM>': must be between 85 and 115 mm...
        measure text --fps 30 --picture - => lizard: - is not an output file...
        measure text empty --csv => lizard: --csv requires a single video
        measure --gait walk => error: the following required arguments were not provided...
        measure text --csv --gait walk => error: the argument '--csv' cannot be used with '--gait <NAMES>'...
    ";
    expect_refusals(&folder, cases);
}

#[test]
fn the_error_for_a_video_without_ffmpeg_names_the_program_to_install() {
    let video = scratch_folder().join("video.mp4");
    fs::write(&video, "a video").expect("the file is written");
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(["measure", "--gait", "walk"]).arg(&video);
    let outcome = run_command(command.env("PATH", ""), "");
    assert_contains(
        &outcome.stderr,
        "install ffmpeg, or give a folder of frames",
    );
    assert_eq!(outcome.code, Some(1));
}

/// Replaces ffmpeg and ffprobe by scripts: ffmpeg prints decoded frames, ffprobe the uneven times of a phone's video.
#[test]
#[cfg(unix)]
fn measure_reads_frames_from_ffmpeg_and_times_from_ffprobe() {
    use std::fmt::Write as _;
    use std::os::unix::fs::PermissionsExt;
    let folder = scratch_folder().join("ffmpeg");
    fs::create_dir_all(&folder).expect("the folder is created");
    let mut video = b"YUV4MPEG2 W640 H360 F8:1 Ip A1:1 Cmono\n".to_vec();
    let mut times = String::new();
    let walk = varied_walk();
    let mut rng = Rng::with_seed(9);
    let background = studio().render_background(&mut rng);
    for i in 0..(walk.duration_s() * FRAMES_PER_SECOND) as usize {
        let seconds = i as f64 / FRAMES_PER_SECOND + 0.01 * f64::from(i as u32 % 3);
        let frame = background.render_frame(seconds, |time| walk.pose_at(time), &mut rng);
        video.extend(b"FRAME\n");
        video.extend(frame.grey());
        let _ = write!(times, "{seconds:.6},\n\n");
    }
    fs::write(folder.join("video"), video).expect("the file is written");
    fs::write(folder.join("times"), times).expect("the file is written");
    for (program, file) in [("ffmpeg", "video"), ("ffprobe", "times")] {
        let path = folder.join(program);
        let file = folder.join(file).display().to_string();
        let script = format!("#!/bin/sh\ncase \"$*\" in *file:/*) exec cat '{file}';; esac\n");
        fs::write(&path, script).expect("the file is written");
        let permissions = fs::Permissions::from_mode(0o755);
        fs::set_permissions(&path, permissions).expect("the script is made executable");
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    let path = format!("{}:/usr/bin:/bin", folder.display());
    command.args(["measure", "--gait", "walk", "--height", "95", "--json"]);
    command.args(["--robot", &robot_path("paper")]);
    command.arg(folder.join("video")).env("PATH", path);
    let object = run_command(&mut command, "").expect_json();
    let forward_mm = object["gaits"][0]["forward"]["mean"].as_f64();
    let forward_mm = forward_mm.expect("the value is a number");
    let error_mm = forward_mm - true_displacement(&paper_gait("walk")).forward;
    assert!(error_mm.abs() < 0.2, "{object}");
}

#[test]
fn the_help_of_measure_explains_the_errors_that_it_prints() {
    let help = run_line("measure --help", "").expect_success();
    assert_contains(&help, "standard error of the mean");
}
