//! Comparisons of the tables in docs/gaits.md, docs/limits.md and docs/twin.md with computed tables.

use lizard_robot::{
    Assumptions, Drive, DriveKind, Effort, GroundContact, HIGH_UTILISATION, Report, Robot,
    Sensitivity, ServoTable, SimulatedCycle,
};

use crate::{gait, paper};

/// The path of the page on gaits.
const GAITS_PAGE_PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/gaits.md");
/// The path of the page on the digital twin.
const TWIN_PAGE_PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/twin.md");
/// The path of the page on the model's limits.
const LIMITS_PAGE_PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/limits.md");
/// The end of a block that a test compares or fills.
const END_MARKER: &str = "<!-- end -->";

/// Encloses a text in the lines that mark a code block.
fn fence(text: String) -> String {
    format!("```text\n{text}```\n")
}

/// Returns a page in which `text` replaces everything between a marker and the next end marker.
fn fill_block(page: &str, marker: &str, text: &str) -> String {
    let marker = format!("<!-- {marker} -->\n");
    let start = page.find(&marker).expect(&marker) + marker.len();
    let end = start + page[start..].find(END_MARKER).expect(END_MARKER);
    format!("{}{text}{}", &page[..start], &page[end..])
}

#[test]
#[ignore = "make docs-check: it takes most of a minute"]
fn the_page_on_gaits_shows_the_output_of_the_commands() {
    let page = std::fs::read_to_string(GAITS_PAGE_PATH).expect(GAITS_PAGE_PATH);
    let mut new_page = page.clone();
    for (command, output) in [
        ("lizard gaits", Report::compute(paper()).to_string()),
        (
            "lizard gaits --sensitivity",
            Sensitivity::compute(paper()).to_string(),
        ),
        (
            "lizard gaits --servos",
            ServoTable::compute(paper()).to_string(),
        ),
    ] {
        new_page = fill_block(&new_page, command, &fence(output));
    }
    assert_up_to_date(GAITS_PAGE_PATH, &page, &new_page);
}

#[test]
#[ignore = "make docs-check: it takes most of a minute"]
fn the_page_on_limits_lists_the_influential_assumptions() {
    let page = std::fs::read_to_string(LIMITS_PAGE_PATH).expect(LIMITS_PAGE_PATH);
    let text = fence(Assumptions::compute(paper()).to_string());
    let new_page = fill_block(&page, "lizard gaits --assumptions", &text);
    assert_up_to_date(LIMITS_PAGE_PATH, &page, &new_page);
}

/// Asserts that a page is up to date. With the environment variable `BLESS_GAITS`, writes the page instead.
fn assert_up_to_date(path: &str, page: &str, new_page: &str) {
    let (_, name) = path
        .split_once("/../../")
        .expect("the path leads out of the crate");
    if std::env::var_os("BLESS_GAITS").is_some() {
        std::fs::write(path, new_page).expect(path);
    } else if let Some((old_line, new_line)) = page
        .lines()
        .zip(new_page.lines())
        .find(|(old_line, new_line)| old_line != new_line)
    {
        panic!(
            "{name} is out of date; run with BLESS_GAITS=1.\n  was {old_line}\n  is  {new_line}"
        );
    } else {
        assert_eq!(
            page, new_page,
            "{name} is out of date; run with BLESS_GAITS=1"
        );
    }
}

/// Spring forces in the table of slotted struts, N; `None` stands for a rigid strut.
const SPRING_FORCES_N: [Option<f64>; 6] =
    [Some(0.5), Some(1.0), Some(2.0), Some(3.0), Some(5.0), None];

/// Formats the cells of a row of the table of slotted struts: a value of a gait for each spring force. The springs have
/// the rate of the paper's coil.
fn format_strut_cells(name: &str, value_of: fn(SimulatedCycle) -> f64) -> String {
    let rate = paper().parts().spring.rate();
    let cells = SPRING_FORCES_N.map(|force| {
        let kind = force.map_or(DriveKind::Rigid, |force| {
            DriveKind::Strut(paper().strut_with_spring(force, rate))
        });
        let ground = GroundContact {
            drive: Drive { kind, play: 0.0 },
            ..*paper().ground()
        };
        format!(
            " {:.1} |",
            value_of(gait(paper(), name).simulate_cycle(&ground))
        )
    });
    cells.concat()
}

#[test]
#[ignore = "make docs-check: it takes most of a minute"]
fn the_page_on_the_twin_shows_the_effect_of_springs() {
    let page = std::fs::read_to_string(TWIN_PAGE_PATH).expect(TWIN_PAGE_PATH);
    let ground = paper().ground();
    let (pad_friction, leg) = (ground.mean_pad_friction(), ground.feet.reach);
    let text = format!(
        "The parts weigh {} g. With a friction of {} that gives {pad_friction:.2} N for each pad, and {:.1} N mm at a leg of {leg} mm. The servos are ideal.\n\n\
         | pull in a slotted strut, N | 0.5 | 1 | 2 | 3 | 5 | rigid |\n|---|---|---|---|---|---|---|\n\
         | lag in `walk`, deg |{}\n| `walk`, mm in a cycle |{}\n| `trot`, mm in a cycle |{}\n| `left`, deg in a cycle |{}\n",
        ground.body.mass,
        ground.friction_coefficient,
        pad_friction * leg,
        format_strut_cells("walk", |cycle| cycle.max_lag),
        format_strut_cells("walk", |cycle| cycle.travel.forward),
        format_strut_cells("trot", |cycle| cycle.travel.forward),
        format_strut_cells("left", |cycle| cycle.travel.turn),
    );
    let new_page = fill_block(&page, "springs of robots/paper.toml", &text);
    assert_up_to_date(TWIN_PAGE_PATH, &page, &new_page);
    assert!(
        page.contains(&format!("| mass | {} g, the mass", ground.body.mass)),
        "{TWIN_PAGE_PATH}"
    );
}

/// Formats a robot's row of the table of paces: the gait that loads the servos most at the `stop` voltage, and the
/// highest pace at which every gait leaves the servos enough torque at this voltage.
fn format_slow_pace_row(file: &str) -> String {
    let path = format!("{}/../../robots/{file}.toml", env!("CARGO_MANIFEST_DIR"));
    let robot = Robot::load(&path).unwrap_or_else(|error| panic!("{error}"));
    let [own_volts, _, stop_volts] = robot.reported_volts();
    let efforts: Vec<_> = robot
        .gaits()
        .iter()
        .map(|gait| {
            let effort = Effort::simulate(gait, robot.ground(), &robot.motors());
            (gait.name(), effort)
        })
        .collect();
    let utilisation_at = |effort: &Effort, pace| effort.utilisation(pace, stop_volts / own_volts);
    let (name, max_effort) = efforts
        .iter()
        .max_by(|(_, a), (_, b)| utilisation_at(a, 1.0).total_cmp(&utilisation_at(b, 1.0)))
        .expect("the robot has gaits");
    let is_sustainable = |percent: &u8| {
        let pace = f64::from(*percent) / 100.0;
        efforts
            .iter()
            .all(|(_, effort)| utilisation_at(effort, pace) <= HIGH_UTILISATION)
    };
    let percent = (10..=100)
        .rev()
        .find(is_sustainable)
        .expect("some pace is slow enough");
    if robot.supplies().rail.is_some() {
        assert_eq!(robot.supplies().slow_pace_percent, percent, "{file}");
    }
    let [full_utilisation, slow_utilisation] =
        [1.0, f64::from(percent) / 100.0].map(|pace| utilisation_at(max_effort, pace));
    format!(
        "| `{file}` | `{name}` | {stop_volts:.1} | {full_utilisation:.2} | {percent} | {slow_utilisation:.2} |\n"
    )
}

#[test]
#[ignore = "make docs-check: it takes most of a minute"]
fn the_page_on_the_twin_shows_the_paces_at_a_low_supply() {
    let page = std::fs::read_to_string(TWIN_PAGE_PATH).expect(TWIN_PAGE_PATH);
    let rows = ["paper", "own-gaits", "unequal", "large", "grain"].map(format_slow_pace_row);
    let text = format!(
        "| file | hardest gait | `stop`, V | its line at full pace | pace, % | its line then |\n|---|---|---|---|---|---|\n{}",
        rows.concat()
    );
    assert_up_to_date(TWIN_PAGE_PATH, &page, &fill_block(&page, "paces", &text));
}
