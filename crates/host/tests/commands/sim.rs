//! `lizard sim` and `lizard draw` on wrong input, and the picture in docs/.

use crate::program::{read, robot, run, scratch};

fn complaint(arguments: &[&str]) -> String {
    run(arguments).expect_refusal()
}

#[test]
fn a_missing_firmware_is_named() {
    let message = complaint(&["sim", "--elf", "no/such.elf"]);
    assert_eq!(
        message,
        "lizard: there is no firmware at no/such.elf; without --elf, the one inside this program \
         is used"
    );
}

#[test]
fn a_file_that_is_not_firmware_is_refused() {
    let own = env!("CARGO_BIN_EXE_lizard");
    let message = complaint(&["sim", "--elf", own]);
    assert!(
        message.starts_with(&format!("lizard: {own}: not an ELF file of an AVR")),
        "{message}"
    );
}

#[test]
fn a_wrong_script_names_file_and_line() {
    let path = scratch().join("wrong-script.txt");
    std::fs::write(&path, "100 walk\nsoon stop\n").expect("the script is written");
    let path = path.display().to_string();
    let message = complaint(&["sim", "--script", &path]);
    assert_eq!(
        message,
        format!(
            "lizard: {path}: line 2: it begins with `soon`, not with a time in whole milliseconds"
        )
    );
}

#[test]
fn a_script_that_never_ends_is_refused() {
    let message = complaint(&["sim", "--script", "/dev/zero"]);
    assert_eq!(
        message,
        "lizard: cannot read /dev/zero: it is longer than 256 MiB"
    );
}

#[test]
fn an_unknown_gait_lists_those_of_the_paper_robot() {
    let message = complaint(&["sim", "--robot", &robot("paper"), "--gait", "gallop"]);
    assert!(
        message.contains("no gait `gallop`; it has stand, walk, trot"),
        "{message}"
    );
}

#[test]
fn a_routine_goes_on_at_the_presses_of_its_inputs_and_the_core_agrees() {
    let (own, script) = (scratch().join("patrol.toml"), scratch().join("patrol.txt"));
    let gaits = read("docs/gaits.md");
    let patrol = gaits
        .split("```toml\n")
        .find(|it| it.starts_with("[input.button]"));
    let patrol = patrol
        .and_then(|it| it.split("```").next())
        .expect("it is there");
    let text = format!("{}\n{patrol}", read("robots/paper.toml"));
    std::fs::write(&own, text).expect("the robot is written");
    std::fs::write(&script, "1000 patrol\n").expect("the script is written");
    let [own, script] = [own, script].map(|path| path.display().to_string());
    let words = [
        "sim",
        "--json",
        "--robot",
        &own,
        "--script",
        &script,
        "--duration=5",
    ];
    let svg = ["--svg", &scratch().join("patrol.svg").display().to_string()].map(str::to_owned);
    let played = |presses: &[&str]| {
        let mut all = words.to_vec();
        all.extend(svg.iter().map(String::as_str));
        all.extend(presses.iter().flat_map(|press| ["--press", press]));
        run(&all).json()
    };
    let waits = |played: &serde_json::Value, input: &str| -> Vec<f64> {
        let lines = played["dialogue"].as_array().expect("lines");
        let text = format!("# waiting for {input}");
        let of_input = lines.iter().filter(|line| line["text"] == text.as_str());
        of_input
            .map(|line| line["ms"].as_f64().expect("a time"))
            .collect()
    };
    let pressed = played(&["button@2", "nose@3-3.5"]);
    let begins = waits(&pressed, "nose");
    assert!(
        matches!(begins[..], [at] if (2_040.0..2_100.0).contains(&at)),
        "{begins:?}"
    );
    assert_eq!(
        pressed["servos"][0]["width_error"], 0,
        "{}",
        pressed["servos"]
    );
    let alone = played(&[]);
    assert_eq!(
        (waits(&alone, "button").len(), waits(&alone, "nose").len()),
        (1, 0)
    );
    let words = complaint(&["sim", "--robot", &robot("paper"), "--press", "nose@1"]);
    assert_eq!(words, "lizard: robot.toml has no [input.nose] for --press");
}

#[test]
fn times_out_of_range_are_refused() {
    for duration in ["0", "-3", "nan", "1e9", "soon"] {
        let argument = format!("--duration={duration}");
        let message = complaint(&["sim", &argument]);
        assert!(message.contains("--duration"), "{message}");
    }
    let message = complaint(&["sim", "--duration=2"]);
    assert!(message.contains("at least 4 s"), "{message}");
}

#[test]
fn the_picture_in_docs_is_up_to_date() {
    let drawn = run(&["draw", "--robot", &robot("paper")]).expect_success();
    assert!(read("docs/lizard.svg") == drawn, "run `make docs`");
}
