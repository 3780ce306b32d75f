//! Tests of the figures in the documentation: they are equal to the stored figures, and the contact model agrees with
//! MuJoCo within the bounds.
//!
//! With `BLESS_PHYSICS=1`, as in `make docs`, the tables are written instead of compared.

use lizard_robot::Robot;

use lizard_physics::assumptions::{self, Assumption};
use lizard_physics::pads::{self, PadShape, SURFACES};
use lizard_physics::surface::{self, Surface, surfaces_table};
use lizard_physics::text::{check_block, format_blocks, format_lines};
use lizard_physics::{
    Case, Crossing, Displacement, Feet, Figures, Legs, ROBOT_NAMES, crate_folder,
    displacement_table, expected_table, load_robot, table, walks_of,
};

/// Compares the text between a marker and the next end marker of a page with `expected_text`.
fn check_page(page: &str, marker: &str, expected_text: &str) {
    let begin = format!("<!-- {marker} -->\n");
    check_block(page, &begin, "<!-- end -->", expected_text);
}

#[test]
fn the_pages_have_the_displacements_by_the_model_and_by_mujoco() {
    let figures = Figures::stored();
    for name in ROBOT_NAMES {
        let robot = load_robot(name);
        let fenced_table = format!("```text\n{}```\n", table(name, &robot, &figures));
        check_page(
            "docs/judges.md",
            &format!("physics of robots/{name}.toml"),
            &fenced_table,
        );
        if name == "paper" {
            let displacements = displacement_table(name, &robot, &figures);
            for page in ["README.md", "docs/gaits.md", "docs/twin.md"] {
                check_page(page, "ways of robots/paper.toml", &displacements);
            }
        }
    }
    let surfaces = surface::stored();
    for name in surface::ROBOT_NAMES {
        let table = surfaces_table(name, &figures, &surfaces);
        let marker = format!("surfaces of robots/{name}.toml");
        check_page("docs/judges.md", &marker, &table);
    }
    check_page("docs/judges.md", "pads", &pads::table(&pads::stored()));
    let changes = assumptions::table(&figures, &surfaces, &assumptions::stored());
    let fenced = format!("```text\n{changes}```\n");
    check_page("docs/limits.md", "assumptions by MuJoCo", &fenced);
    let robot = load_robot("paper");
    check_page(
        "docs/measure.md",
        "expected of robots/paper.toml",
        &expected_table(&robot),
    );
}

#[test]
fn the_stored_figures_are_written_as_they_are_read() {
    let file = crate_folder().join("figures.json");
    let text = std::fs::read_to_string(&file).expect("figures.json is readable");
    let new_text = Figures::stored().to_json();
    if std::env::var_os("BLESS_PHYSICS").is_some() {
        std::fs::write(&file, new_text).expect("figures.json is readable");
    } else {
        assert_eq!(text, new_text);
    }
}

#[test]
fn every_gait_keeps_its_distance_over_edges_and_blocks_and_its_turn_on_every_floor() {
    let (figures, stored_surfaces) = (Figures::stored(), surface::stored());
    let mut walk_count = 0;
    for name in surface::ROBOT_NAMES {
        for (gait, level) in surface::walking_gaits(&figures, name) {
            for surface in Surface::of(name) {
                let displacement = stored_surfaces[name][&gait][&surface.to_string()];
                let losses = surface::excess_losses(surface, level, displacement);
                let is_known_shortfall = surface::is_known_shortfall(name, &gait, surface);
                assert_eq!(
                    !losses.is_empty(),
                    is_known_shortfall,
                    "{name}: {gait}, {surface}: {losses:?}"
                );
                walk_count += 1;
            }
        }
    }
    let stored_counts = stored_surfaces.values().flat_map(|gaits| gaits.values());
    let stored_counts = stored_counts.map(std::collections::BTreeMap::len);
    assert_eq!(
        stored_counts.sum::<usize>(),
        walk_count,
        "and no others are stored"
    );
    assert!(walk_count > 100, "{walk_count}");
    // The check reports a robot that cannot move or turn at an edge, and a robot that turns in the wrong direction.
    let no_displacement = Displacement([0.0; 3]);
    for (gait, loss_count) in [("walk", 1), ("back", 1), ("left", 1), ("arc-right", 2)] {
        let level = surface::level_displacement(&figures, gait);
        let messages = surface::excess_losses(Surface::Edge(20), level, no_displacement);
        assert_eq!(messages.len(), loss_count, "{gait}: {messages:?}");
    }
    let [left, right] = ["left", "right"].map(|gait| surface::level_displacement(&figures, gait));
    assert_eq!(
        surface::excess_losses(Surface::Slope(8), left, right),
        ["-14.9 deg a cycle of 14.9 on a level floor; 0.75 must be kept"]
    );
}

#[test]
fn every_foot_of_a_gait_that_does_not_only_turn_starts_before_the_edge_and_ends_beyond_it() {
    let figures = Figures::stored();
    let mut turning_gaits = Vec::new();
    for name in surface::ROBOT_NAMES {
        let feet = load_robot(name).ground().feet.positions([0.0; 4]);
        for (gait, level) in surface::walking_gaits(&figures, name) {
            let crossing = Crossing::of(&load_robot(name), level, 0);
            if !crossing.is_crossed {
                turning_gaits.push(gait);
                continue;
            }
            let block = crossing.block(2.0);
            // A point on the edge and the direction across it are computed from the block alone, so that a wrong block
            // is noticed.
            let (sin, cos) = block.rotation.to_radians().sin_cos();
            let half_length = block.size[1] / 2.0;
            let edge = [
                block.centre[0] + half_length * sin,
                block.centre[1] - half_length * cos,
            ];
            let distance_beyond =
                |[right, ahead]: [f64; 2]| (ahead - edge[1]) * cos - (right - edge[0]) * sin;
            let mut pose = [0.0; 3];
            for [ahead, left] in feet {
                assert!(
                    distance_beyond([-left, ahead]) < -20.0,
                    "{name}: {gait} does not start before the edge"
                );
            }
            for _ in 0..crossing.cycle_count {
                pose = move_pose(pose, level.0);
            }
            for [ahead, left] in feet {
                let [ahead, left, _] = move_pose(pose, [ahead, left, 0.0]);
                assert!(
                    distance_beyond([-left, ahead]) > 20.0,
                    "{name}: {gait} does not end beyond the edge"
                );
            }
        }
    }
    turning_gaits.sort_unstable();
    turning_gaits.dedup();
    let expected_gaits = [
        "left",
        "right",
        "turn-slowly-on-the-spot-all-the-way-to-the-left",
        "turn-slowly-to-the-right",
    ];
    assert_eq!(turning_gaits, expected_gaits);
}

/// Returns a pose (mm ahead, mm to the left, deg) after a displacement in the pose's own frame.
fn move_pose([x, y, heading]: [f64; 3], [ahead, left, turn]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = heading.to_radians().sin_cos();
    [
        x + ahead * cos - left * sin,
        y + ahead * sin + left * cos,
        heading + turn,
    ]
}

#[test]
fn every_other_assumption_and_pad_shape_is_stored_in_the_format_that_is_written() {
    let (stored_assumptions, shapes) = (assumptions::stored(), pads::stored());
    for Assumption { description, .. } in Assumption::ALL {
        assert_eq!(
            stored_assumptions[description].len(),
            assumptions::GAITS.len(),
            "{description}"
        );
    }
    assert_eq!(stored_assumptions.len(), Assumption::ALL.len());
    for shape in PadShape::ALL {
        assert_eq!(shapes[&shape.name()].len(), SURFACES.len());
    }
    assert_eq!(shapes.len(), PadShape::ALL.len());
    for (file, text) in [
        ("assumptions.json", format_lines(&stored_assumptions)),
        ("pads.json", format_lines(&shapes)),
        ("surfaces.json", format_blocks(&surface::stored())),
    ] {
        assert_eq!(
            std::fs::read_to_string(crate_folder().join(file)).expect(file),
            text
        );
    }
    // The shape `30` is that of the pads in robot.toml, so surfaces.json must have the same displacements for `walk`.
    let default_displacements = &shapes["30"];
    for surface in SURFACES {
        let name = surface.to_string();
        let (mm, _) =
            default_displacements[&name].distance_to(&surface::stored()["paper"]["walk"][&name]);
        assert!(mm < 0.05, "{name}: {mm}");
    }
}

#[test]
fn every_walk_is_stored_and_close_to_the_model() {
    let figures = Figures::stored();
    let mut count = 0;
    for name in ROBOT_NAMES {
        let robot = load_robot(name);
        for gait in robot.gaits().iter().filter(|gait| gait.has_movement()) {
            let results_for = |case| figures.get(name, gait.name(), case);
            let is_decided =
                results_for(Case::ALL[0]).is_some_and(|results| results.model.is_some());
            for case in Case::ALL {
                let Some(results) = results_for(case) else {
                    assert!(
                        !is_decided && case != Case::ALL[0],
                        "{name}: {}",
                        gait.name()
                    );
                    continue;
                };
                assert_eq!(results.disagreement(case), None, "{name}: {}", gait.name());
                assert_eq!(
                    results.model.is_some(),
                    is_decided,
                    "{name}: {}",
                    gait.name()
                );
                count += 1;
            }
        }
    }
    assert_eq!(figures.walk_count(), count, "and no others are stored");
}

#[test]
fn the_stored_results_of_the_model_are_up_to_date() {
    let (figures, robot) = (Figures::stored(), load_robot("paper"));
    let mut count = 0;
    for walk in walks_of(&robot) {
        let results = figures
            .get("paper", &walk.gait, walk.case)
            .expect("the walk is stored");
        assert_eq!(results.model.is_some(), walk.is_decided, "{}", walk.gait);
        let (Some(stored), Some(computed)) = (results.model, walk.model_displacement(&robot))
        else {
            continue;
        };
        let (mm, deg) = stored.distance_to(&computed);
        assert!(
            mm < 0.05 && deg < 0.05,
            "{}: {stored:?} {computed:?}",
            walk.gait
        );
        count += 1;
    }
    assert!(count >= 40, "{count}");
}

#[test]
fn a_foot_a_millimetre_too_long_costs_less_than_a_tenth_of_the_distance() {
    let figures = Figures::stored();
    let case_with = |feet| Case {
        legs: Legs::Rigid,
        feet,
    };
    let mut count = 0;
    for name in ROBOT_NAMES {
        for gait in load_robot(name)
            .gaits()
            .iter()
            .filter(|gait| gait.has_movement())
        {
            let results_for = |feet| figures.get(name, gait.name(), case_with(feet));
            let (Some(level), Some(long)) = (results_for(Feet::Level), results_for(Feet::Soft))
            else {
                continue;
            };
            let model = level.model.zip(long.model);
            for (level_displacement, long_displacement) in
                model.into_iter().chain([(level.mujoco, long.mujoco)])
            {
                let distance_of =
                    |displacement: Displacement| displacement.0[0].hypot(displacement.0[1]);
                let turn_of = |displacement: Displacement| displacement.0[2].abs();
                // A gait is judged by its distance if it has one, else by its turn; a gait without either is skipped.
                let (level_value, long_value) = match (
                    distance_of(level_displacement) > 4.0,
                    turn_of(level_displacement) > 1.0,
                ) {
                    (true, _) => (
                        distance_of(level_displacement),
                        distance_of(long_displacement),
                    ),
                    (false, true) => (turn_of(level_displacement), turn_of(long_displacement)),
                    (false, false) => continue,
                };
                assert!(
                    long_value > 0.9 * level_value,
                    "{name}: {} {level_displacement:?} {long_displacement:?}",
                    gait.name()
                );
                count += 1;
            }
        }
    }
    assert!(count >= 60, "{count}");
}

#[test]
fn every_key_that_a_trial_sets_is_valid_in_robot_toml() {
    let text = std::fs::read_to_string(crate_folder().join("../../robots/paper.toml"))
        .expect("robots/paper.toml is readable");
    let table = expected_table(&load_robot("paper"));
    let keys = table.lines().skip(2).flat_map(|line| {
        let cell = line
            .rsplit(" | ")
            .next()
            .expect("each row ends with its keys");
        cell.trim_end_matches(" |")
            .split(", ")
            .map(|key| key.trim_matches('`'))
    });
    let mut count = 0;
    for key in keys {
        let (section, name) = key.split_once("] ").expect(key);
        let header = format!("\n{section}]");
        // No key takes an array, so a known key is refused because of its type, and an unknown key because it is
        // unknown.
        let wrong_text = match text.contains(&header) {
            true => {
                let header_start = text.find(&header).expect("the text contains the header") + 1;
                let body_start = header_start
                    + text[header_start..]
                        .find('\n')
                        .expect("the header's line ends")
                    + 1;
                let end = text[body_start..]
                    .find("\n[")
                    .map_or(text.len(), |end| body_start + end);
                let other_lines = text[body_start..end]
                    .lines()
                    .filter(|line| !line.starts_with(&format!("{name} ")));
                let other_lines: Vec<&str> = other_lines.collect();
                format!(
                    "{}{name} = []\n{}{}",
                    &text[..body_start],
                    other_lines.join("\n"),
                    &text[end..]
                )
            }
            false if name == "force" => {
                format!("{text}\n{section}]\nkind = \"strut\"\nrate = 0.4\n{name} = []\n")
            }
            false => format!("{text}\n{section}]\n{name} = []\n"),
        };
        let message = Robot::parse(&wrong_text).expect_err(key).to_string();
        let path = format!("{}.{name}", section.trim_start_matches('['));
        assert!(
            message.contains(&path) && !message.contains("not a known key"),
            "{message}"
        );
        count += 1;
    }
    assert!(count >= 10, "{count}");
}
