//! Comparisons of the tables in docs/gaits.md, docs/limits.md and docs/twin.md with computed tables.

use lizard_robot::{
    Assumptions, CheckedGait, Drive, DriveKind, Effort, GroundContact, HIGH_UTILISATION, Report,
    Robot, Sensitivity, ServoTable, SimulatedCycle,
};

use crate::{gait, paper};

/// The folder of the repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
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
    let robot = paper();
    let (sensitivity, servos) = (Sensitivity::compute(robot), ServoTable::compute(robot));
    for (command, output) in [
        ("lizard gaits", Report::compute(robot).to_string()),
        ("lizard gaits --sensitivity", sensitivity.to_string()),
        ("lizard gaits --servos", servos.to_string()),
    ] {
        assert_block_up_to_date("docs/gaits.md", command, &fence(output));
    }
}

#[test]
#[ignore = "make docs-check: it takes most of a minute"]
fn the_page_on_limits_lists_the_influential_assumptions() {
    let text = fence(Assumptions::compute(paper()).to_string());
    assert_block_up_to_date("docs/limits.md", "lizard gaits --assumptions", &text);
}

/// Asserts that a page contains `text` between a marker and the next end marker. With the environment variable
/// `BLESS_GAITS`, writes the page instead. Returns the page.
fn assert_block_up_to_date(name: &str, marker: &str, text: &str) -> String {
    let path = format!("{ROOT}/{name}");
    let page = std::fs::read_to_string(&path).expect(&path);
    let new_page = fill_block(&page, marker, text);
    if std::env::var_os("BLESS_GAITS").is_some() {
        std::fs::write(&path, &new_page).expect(&path);
        return new_page;
    }
    let message = format!("{name} is out of date; run with BLESS_GAITS=1");
    let mut lines = page.lines().zip(new_page.lines());
    if let Some((old_line, new_line)) = lines.find(|(old_line, new_line)| old_line != new_line) {
        panic!("{message}.\n  was {old_line}\n  is  {new_line}");
    }
    assert_eq!(page, new_page, "{message}");
    page
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
        let value = value_of(gait(paper(), name).simulate_cycle(&ground));
        format!(" {value:.1} |")
    });
    cells.concat()
}

#[test]
#[ignore = "make docs-check: it takes most of a minute"]
fn the_page_on_the_twin_shows_the_effect_of_springs() {
    let ground = paper().ground();
    let pad_friction = ground.mean_friction_force();
    let reach_mm = ground.legs.reach;
    let text = format!(
        "The parts weigh {} g. With a friction of {} that gives {pad_friction:.2} N for each pad, and {:.1} N mm at a leg of {reach_mm} mm. The servos are ideal.\n\n\
         | pull in a slotted strut, N | 0.5 | 1 | 2 | 3 | 5 | rigid |\n|---|---|---|---|---|---|---|\n\
         | lag in `walk`, deg |{}\n| `walk`, mm in a cycle |{}\n| `trot`, mm in a cycle |{}\n| `left`, deg in a cycle |{}\n",
        ground.body.mass,
        ground.friction_coefficient,
        pad_friction * reach_mm,
        format_strut_cells("walk", |cycle| cycle.max_lag),
        format_strut_cells("walk", |cycle| cycle.travel.forward),
        format_strut_cells("trot", |cycle| cycle.travel.forward),
        format_strut_cells("left", |cycle| cycle.travel.turn),
    );
    let page = assert_block_up_to_date("docs/twin.md", "springs of robots/paper.toml", &text);
    let mass = format!("| mass | {} g, the mass", ground.body.mass);
    assert!(page.contains(&mass), "docs/twin.md has no {mass:?}");
}

/// Formats a robot's row of the table of paces: the gait that loads the servos most at the `stop` voltage, and the
/// highest pace at which every gait leaves the servos enough torque at this voltage.
fn format_slow_pace_row(file: &str) -> String {
    let robot = Robot::load(format!("{ROOT}/robots/{file}.toml"));
    let robot = robot.unwrap_or_else(|error| panic!("{error}"));
    let [own_volts, _, stop_volts] = robot.reported_volts();
    let simulate = |gait| Effort::simulate(gait, robot.ground(), &robot.motors());
    let efforts: Vec<Effort> = robot.gaits().iter().map(simulate).collect();
    let utilisation_at = |effort: &Effort, pace| effort.utilisation(pace, stop_volts / own_volts);
    let named_efforts = robot.gaits().iter().map(CheckedGait::name).zip(&efforts);
    let (name, max_effort) = named_efforts
        .max_by(|(_, a), (_, b)| utilisation_at(a, 1.0).total_cmp(&utilisation_at(b, 1.0)))
        .expect("the robot has gaits");
    let is_sustainable = |percent: &u8| {
        let pace = f64::from(*percent) / 100.0;
        let mut utilisations = efforts.iter().map(|effort| utilisation_at(effort, pace));
        utilisations.all(|utilisation| utilisation <= HIGH_UTILISATION)
    };
    let percent = (10..=100).rev().find(is_sustainable);
    let percent = percent.expect("some pace is slow enough");
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
    let rows = ["paper", "own-gaits", "unequal", "large", "grain"].map(format_slow_pace_row);
    let text = format!(
        "| file | hardest gait | `stop`, V | its line at full pace | pace, % | its line then |\n|---|---|---|---|---|---|\n{}",
        rows.concat()
    );
    assert_block_up_to_date("docs/twin.md", "paces", &text);
}
