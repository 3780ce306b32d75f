//! Tests of `lizard measure` on rendered films with known true values, and of the printed sheet in these films.

mod jig;
mod keys;
mod sheet;

use std::fs;
use std::path::{Path, PathBuf};

use fastrand::Rng;
use lizard_studio::encode_jpeg;
use lizard_studio::render::{Pose, Studio};
use lizard_studio::walk::{Variation, Walk, WalkSeries, paper_gait, true_displacement};
use serde_json::Value;

use crate::program::{
    Outcome, assert_contains, new_folder, read_file, robot_path, run, run_in, run_line,
    scratch_folder,
};

/// Frame rate of the films, pictures per second.
const PICTURES_PER_SECOND: f64 = 8.0;

/// A studio with a low resolution, for speed, in which the sheet fills the picture.
fn studio() -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(4));
    (studio.size, studio.focal_length) = ([640, 360], 1.0);
    (
        studio.camera_height,
        studio.camera_tilt,
        studio.camera_direction,
    ) = (800.0, 15.0, 90.0);
    (studio.camera_roll, studio.aim) = (0.0, [0.0; 2]);
    studio.deck_tag_height = 95.0;
    studio
}

/// Small differences between the cycles of a walk.
fn variation() -> Variation {
    Variation {
        cycle_deviation: [0.1, 0.1, 0.002],
        ..Variation::default()
    }
}

/// Five cycles of `walk` that differ slightly from each other.
fn varied_walk() -> Walk {
    let gait = paper_gait("walk");
    let start = [-true_displacement(&gait).forward * 2.5, 0.0, 0.0];
    Walk::new(&gait, start, 5, variation(), &mut Rng::with_seed(4))
}

/// Renders five cycles of `walk` into a new folder.
fn render_walk(folder: &str, file_name: impl Fn(usize) -> String) -> PathBuf {
    let walk = varied_walk();
    render_film(folder, file_name, walk.duration_s(), |time| {
        walk.pose_at(time)
    })
}

/// Renders a moving robot as JPEG files in a new folder; `file_name` makes a name from the picture's index.
fn render_film(
    folder: &str,
    file_name: impl Fn(usize) -> String,
    duration_s: f64,
    pose_at: impl Fn(f64) -> Pose,
) -> PathBuf {
    let folder = new_folder(folder);
    let mut rng = Rng::with_seed(4);
    let background = studio().background(&mut rng);
    for i in 0..(duration_s * PICTURES_PER_SECOND) as usize {
        let picture = background.picture(i as f64 / PICTURES_PER_SECOND, &pose_at, &mut rng);
        let path = folder.join(file_name(i));
        let jpeg = encode_jpeg(&picture, 80).expect("the picture is encodable");
        fs::write(path, jpeg).expect("the file is written");
    }
    folder
}

/// Runs `lizard measure` on a film.
fn measure(film: &Path, options: &[&str]) -> Outcome {
    let film = film.to_str().expect("the path is UTF-8");
    run(&[&["measure", film, "--height", "95"], options].concat())
}

/// The words of a table that are the same for every film: all except numbers and verdicts.
fn stable_words(table: &str) -> Vec<&str> {
    let verdict_words = ["more", "less", "errors", "agrees"];
    let component_words = ["ahead", "left", "turn", "mm", "deg"];
    table
        .lines()
        .flat_map(|line| {
            // The component with the largest error depends on the film, so its name is skipped, too.
            let skipped_words = match line.starts_with("path") {
                true => &component_words[..],
                false => &[],
            };
            let words = line
                .split_whitespace()
                .map(|word| word.trim_end_matches(','));
            words.filter(move |word| {
                word.chars().all(char::is_alphabetic) && !skipped_words.contains(word)
            })
        })
        .filter(|word| !verdict_words.contains(word))
        .collect()
}

#[test]
fn a_film_of_a_walk_agrees_with_the_prediction_and_names_its_errors() {
    let folder = render_walk("walk film", |i| format!("walk-{}ms.jpg", i * 125));
    let robot = robot_path("paper");
    let measure_walk = |robot: &str, options: &[&str]| {
        let walk_options = ["--robot", robot, "--gait", "walk"];
        measure(&folder, &[&walk_options[..], options].concat())
    };
    let object = measure_walk(&robot, &["--json"]).expect_json();
    let film = object["films"][0].clone();
    let object = object["gaits"][0].clone();
    let number_at = |path: &[&str]| {
        let value = path.iter().fold(&object, |value, key| &value[*key]);
        value
            .as_f64()
            .unwrap_or_else(|| panic!("{path:?}: {object}"))
    };
    let truth = true_displacement(&paper_gait("walk"));
    for (name, truth, max_error) in [
        ("forward", truth.forward, 0.2),
        ("left", truth.left, 0.2),
        ("turn", truth.turn, 0.5),
    ] {
        assert!(
            (number_at(&[name, "mean"]) - truth).abs() < max_error,
            "{name}: {object}"
        );
        assert!(
            (number_at(&[name, "predicted"]) - truth).abs() < 1e-2,
            "{name}: {object}"
        );
    }
    assert!(number_at(&["cycles"]) >= 3.0 && (number_at(&["period"]) - 1.0).abs() < 0.01);
    assert_eq!(
        object["each"].as_array().map(Vec::len),
        Some(number_at(&["cycles"]) as usize)
    );
    let figures = read_file("tools/physics/figures.json");
    let figures: Value = serde_json::from_str(&figures).expect("the figures are JSON");
    let mujoco = &figures["paper"]["walk"]["rigid, level"]["mujoco"];
    assert_eq!(&object["mujoco"], mujoco);
    // The stored MuJoCo figures stay valid if a comment is added to robot.toml, but not if the mass changes.
    let text = read_file("robots/paper.toml");
    let heavier_text = text.replace("mass = 435.0", "mass = 500.0");
    assert_ne!(heavier_text, text);
    for (text, mujoco) in [
        (format!("# mine\n{text}"), mujoco),
        (heavier_text, &Value::Null),
    ] {
        let changed_path = scratch_folder().join("changed.toml");
        fs::write(&changed_path, text).expect("the file is written");
        let changed_path = changed_path.to_str().expect("the path is UTF-8");
        let object = measure_walk(changed_path, &["--json"]).expect_json();
        assert_eq!(&object["gaits"][0]["mujoco"], mujoco);
    }
    let range = &object["range"];
    let predicted = number_at(&["forward", "predicted"]);
    let [min, max] =
        ["least", "most"].map(|end| range[end].as_f64().expect("the value is a number"));
    assert!(min < predicted - 5.0 && predicted + 1.0 < max, "{range}");
    assert_eq!(range["least_by"], "mounting of the legs");
    let table = measure_walk(&robot, &[]).expect_success();
    assert!(table.contains("agrees"), "{table}");
    // The example in docs/measure.md comes from such a film.
    let page = read_file("docs/measure.md");
    let (_, example) = page
        .split_once("--gait walk --height 95\n")
        .expect("the page has the example");
    let (example, _) = example.split_once("```").expect("the example ends");
    let table = table.replace(&folder.display().to_string(), "film.mp4");
    assert_eq!(stable_words(example), stable_words(&table));
    let csv = measure(&folder, &["--csv"]).expect_success();
    assert!(
        csv.starts_with("seconds,forward,left,heading\n0.0000,"),
        "{csv}"
    );
    assert_eq!(
        Some(csv.lines().count() as u64 - 1),
        film["pictures"].as_u64()
    );
    // A path that does not fit the named gait is refused; the message names the gait that fits.
    let message = measure(&folder, &["--gait", "left"]).expect_refusal();
    assert!(message.contains("was it another gait"), "{message}");
    assert!(message.ends_with("; it is like walk"), "{message}");
}

/// The gaits of a result, each with the number of its walks.
fn walk_counts(object: &Value) -> Vec<(&str, usize)> {
    let gaits = object["gaits"].as_array().expect("the value is an array");
    let counts = gaits.iter().map(|result| {
        let name = result["gait"].as_str().expect("the gait has a name");
        (name, result["walks"].as_array().map_or(0, Vec::len))
    });
    counts.collect()
}

#[test]
fn gaits_in_a_film_are_identified_by_given_names_or_by_their_paths() {
    let [walk, left] = ["walk", "left"].map(paper_gait);
    let order = [(&walk, 3), (&left, 4), (&walk, 3)];
    let (start, mut rng) = ([-90.0, -20.0, 0.0], Rng::with_seed(4));
    let series = WalkSeries::new(start, &order, 2.2, variation(), &mut rng);
    let name_of = |i| format!("{i}.jpg");
    let folder = render_film("gaits", name_of, series.duration_s(), |time| {
        series.pose_at(time)
    });
    let robot = robot_path("paper");
    let measure_gaits = |options: &[&str]| {
        let film_options = ["--robot", &robot, "--fps", "8"];
        measure(&folder, &[&film_options[..], options].concat())
    };
    let svg_path = scratch_folder().join("measured.svg");
    let svg_name = svg_path.display().to_string();
    let picture_options = ["--json", "--picture", &svg_name];
    let unnamed_result = measure_gaits(&picture_options).expect_json();
    assert_eq!(
        walk_counts(&unnamed_result),
        [("walk", 2), ("left", 1)],
        "{unnamed_result}"
    );
    let named_result = measure_gaits(&["--json", "--gait", "walk,left,walk"]).expect_json();
    assert_eq!(walk_counts(&named_result), walk_counts(&unnamed_result));
    for (index, gait) in [walk, left].iter().enumerate() {
        let result = &unnamed_result["gaits"][index];
        let truth = true_displacement(gait);
        for (component, truth, max_error) in
            [("forward", truth.forward, 0.3), ("turn", truth.turn, 0.5)]
        {
            let mean = result[component]["mean"].as_f64().expect(component);
            assert!((mean - truth).abs() < max_error, "{component}: {result}");
        }
        assert_eq!(result["farthest"]["agrees"], true, "{result}");
        assert!(
            result["within"].as_array().map_or(0, Vec::len) >= 6,
            "{result}"
        );
    }
    let svg = fs::read_to_string(svg_path).expect("the file is readable");
    for label in ["walk, ", "left, ", "measured", "predicted", "turn, deg"] {
        assert!(svg.contains(label), "{label}: {svg}");
    }
    // A gait that is not in the film and gaits in the wrong order are refused.
    let refusal = measure_gaits(&["--gait", "walk,left,walk,back"]).expect_refusal();
    assert!(
        refusal.starts_with("lizard: 3 walks between rests of")
            && refusal.contains("names 4: walk, left, walk, back\n")
            && refusal.contains(" s long: like left\n")
            && refusal.ends_with("no walk is like back"),
        "{refusal}"
    );
    let refusal = measure_gaits(&["--gait", "left,walk,walk"]).expect_refusal();
    assert!(
        refusal.contains(" s, left: the path is not that of this gait")
            && refusal.ends_with("; it is like walk"),
        "{refusal}"
    );
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
    for (line, message) in [
        ("measure none --gait walk", "lizard: there is no film none"),
        (
            "measure empty --gait walk",
            "lizard: empty has no pictures: .png, .jpg or .jpeg",
        ),
        (
            "measure untimed --gait walk",
            "lizard: the times of the pictures are unknown: --fps 30 gives the film's frames per second",
        ),
        (
            "measure text --gait walk --fps 30",
            "lizard: text/a.png is no picture that can be read: ",
        ),
        (
            "measure text --gait wlak --fps 30",
            "lizard: robot.toml has no gait `wlak`; those that move are",
        ),
        (
            "measure text --gait stand --fps 30",
            "lizard: the gait `stand` moves no servo",
        ),
        (
            "measure text --gait walk --ruler 20",
            "error: invalid value '20' for '--ruler <MM>': it is the line of 100 mm",
        ),
        (
            "measure --gait walk",
            "error: the following required arguments were not provided",
        ),
        (
            "measure text --csv --gait walk",
            "error: the argument '--csv' cannot be used with '--gait <NAMES>'",
        ),
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let refusal = run_in(&folder, &arguments, "").expect_refusal();
        assert!(refusal.starts_with(message), "{line}: {refusal}");
    }
}

#[test]
fn a_film_without_ffmpeg_says_what_to_install() {
    let film = scratch_folder().join("film.mp4");
    fs::write(&film, "a film").expect("the file is written");
    let program = env!("CARGO_BIN_EXE_lizard");
    let mut command = std::process::Command::new(program);
    command
        .args(["measure", "--gait", "walk"])
        .arg(&film)
        .env("PATH", "");
    let output = lizard_time_limit::LIMIT
        .output(&mut command, b"")
        .expect("the program exits");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_contains(&message, "install ffmpeg, or give a folder of pictures");
    assert_eq!(output.status.code(), Some(1));
}

/// Replaces ffmpeg and ffprobe by scripts: ffmpeg prints decoded pictures, ffprobe the uneven times of a phone's film.
#[test]
#[cfg(unix)]
fn a_film_is_read_through_ffmpeg_at_the_times_from_ffprobe() {
    use std::fmt::Write as _;
    use std::os::unix::fs::PermissionsExt;
    let folder = scratch_folder().join("ffmpeg");
    fs::create_dir_all(&folder).expect("the folder is created");
    let mut film = b"YUV4MPEG2 W640 H360 F8:1 Ip A1:1 Cmono\n".to_vec();
    let mut times = String::new();
    let (background, walk) = (studio(), varied_walk());
    let mut rng = Rng::with_seed(9);
    let background = background.background(&mut rng);
    for i in 0..(walk.duration_s() * PICTURES_PER_SECOND) as usize {
        let seconds = i as f64 / PICTURES_PER_SECOND + 0.01 * f64::from(i as u32 % 3);
        let picture = background.picture(seconds, |time| walk.pose_at(time), &mut rng);
        film.extend(b"FRAME\n");
        film.extend(picture.grey());
        let _ = write!(times, "{seconds:.6},\n\n");
    }
    fs::write(folder.join("film"), film).expect("the file is written");
    fs::write(folder.join("times"), times).expect("the file is written");
    for (program, file) in [("ffmpeg", "film"), ("ffprobe", "times")] {
        let path = folder.join(program);
        let script = format!("#!/bin/sh\nexec cat '{}'\n", folder.join(file).display());
        fs::write(&path, script).expect("the file is written");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755))
            .expect("the script is made executable");
    }
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_lizard"));
    let path = format!("{}:/usr/bin:/bin", folder.display());
    command.args(["measure", "--gait", "walk", "--height", "95", "--json"]);
    command.args(["--robot", &robot_path("paper")]);
    command.arg(folder.join("film")).env("PATH", path);
    let output = lizard_time_limit::LIMIT
        .output(&mut command, b"")
        .expect("the program exits");
    let object: Value = serde_json::from_slice(&output.stdout).expect("the output is JSON");
    let forward_mm = object["gaits"][0]["forward"]["mean"].as_f64();
    let forward_mm = forward_mm.expect("the value is a number");
    assert!(
        (forward_mm - true_displacement(&paper_gait("walk")).forward).abs() < 0.2,
        "{object}"
    );
}

#[test]
fn every_number_in_the_json_of_a_film_is_finite() {
    // serde_json writes NaN and infinity as null.
    let folder = render_walk("numbers", |i| format!("{i}.jpg"));
    let options = ["--fps", "8", "--gait", "walk", "--json"];
    let text = measure(&folder, &options).expect_json().to_string();
    assert!(!text.contains("null"), "{text}");
    let help = run_line("measure --help", "").expect_success();
    assert_contains(&help, "standard error of the mean");
}
