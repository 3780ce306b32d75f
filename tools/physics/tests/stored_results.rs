//! Tests of the stored results: the documentation has the same values, and the contact model agrees with MuJoCo within
//! the tolerances.
//!
//! With `BLESS_PHYSICS=1`, as in `make docs`, the tests write the tables instead of comparing them.

use lizard_robot::{Robot, edit};

use lizard_physics::assumptions::{self, Assumption};
use lizard_physics::pads::{self, PadShape, SURFACES};
use lizard_physics::surface::{
    self, KNOWN_SHORTFALLS, Surface, SurfaceDisplacements, format_surfaces_table,
};
use lizard_physics::text::{check_or_update_block, format_stored, load_stored};
use lizard_physics::{
    Case, Crossing, Displacement, FootSetup, GroupedDisplacements, LegDrive, ROBOT_NAMES,
    WalkResults, crate_dir, format_comparison_table, format_displacement_table,
    format_expected_results_table, list_walks, load_robot,
};

/// Compares the text between a marker and the next end marker of a page with `expected_text`, or updates it; see
/// [`check_or_update_block`].
fn check_page(page: &str, marker: &str, expected_text: &str) {
    let begin = format!("<!-- {marker} -->\n");
    check_or_update_block(page, &begin, "<!-- end -->", expected_text);
}

#[test]
fn the_documentation_has_the_stored_displacements() {
    let walk_results = WalkResults::load_stored();
    for name in ROBOT_NAMES {
        let robot = load_robot(name);
        let table = format_comparison_table(name, &robot, &walk_results);
        let fenced_table = format!("```text\n{table}```\n");
        let marker = format!("physics of robots/{name}.toml");
        check_page("docs/judges.md", &marker, &fenced_table);
        if name == "paper" {
            let displacements = format_displacement_table(name, &robot, &walk_results);
            for page in ["README.md", "docs/gaits.md", "docs/twin.md"] {
                check_page(page, "displacements of robots/paper.toml", &displacements);
            }
        }
    }
    let surfaces = load_stored("surfaces.json");
    for name in surface::ROBOT_NAMES {
        let table = format_surfaces_table(name, &walk_results, &surfaces);
        let marker = format!("surfaces of robots/{name}.toml");
        check_page("docs/judges.md", &marker, &table);
    }
    let table = pads::format_table(&load_stored("pads.json"));
    check_page("docs/judges.md", "pads", &table);
    let by_assumption = load_stored("assumptions.json");
    let changes = assumptions::format_table(&walk_results, &surfaces, &by_assumption);
    let fenced = format!("```text\n{changes}```\n");
    check_page("docs/limits.md", "assumptions by MuJoCo", &fenced);
    let table = format_expected_results_table(&load_robot("paper"));
    check_page("docs/measure.md", "expected of robots/paper.toml", &table);
}

#[test]
fn format_stored_reproduces_the_stored_results() {
    let path = crate_dir().join("walks.json");
    let text = std::fs::read_to_string(&path).expect("walks.json is readable");
    let new_text = format_stored(&WalkResults::load_stored(), 3);
    // Other tests read the file at the same time, so it is written only if its text changes.
    if text != new_text && std::env::var_os("BLESS_PHYSICS").is_some() {
        std::fs::write(&path, new_text).expect("walks.json is writable");
    } else {
        assert_eq!(text, new_text);
    }
}

#[test]
fn every_gait_keeps_enough_of_its_displacement_on_every_surface_except_the_known_shortfalls() {
    let walk_results = WalkResults::load_stored();
    let stored_surfaces: SurfaceDisplacements = load_stored("surfaces.json");
    let mut walk_count = 0;
    for name in surface::ROBOT_NAMES {
        for (gait, level_displacement) in surface::list_walking_gaits(&walk_results, name) {
            for surface in Surface::for_robot(name) {
                let displacement = stored_surfaces[name][&gait][&surface.to_string()];
                let shortfalls =
                    surface::describe_shortfalls(surface, level_displacement, displacement);
                let is_known_shortfall = KNOWN_SHORTFALLS.contains(&(name, gait.as_str(), surface));
                let label = format!("{name}: {gait}, {surface}: {shortfalls:?}");
                assert_eq!(!shortfalls.is_empty(), is_known_shortfall, "{label}");
                walk_count += 1;
            }
        }
    }
    let stored_gaits = stored_surfaces.values().flat_map(|gaits| gaits.values());
    let stored_count: usize = stored_gaits.map(|surfaces| surfaces.len()).sum();
    assert_eq!(stored_count, walk_count, "no other walks may be stored");
    assert!(walk_count > 100, "{walk_count} walks");
    // The check also reports a robot that does not move at an edge, and one that turns in the wrong direction.
    let no_displacement = Displacement([0.0; 3]);
    for (gait, shortfall_count) in [("walk", 1), ("back", 1), ("left", 1), ("arc-right", 2)] {
        let level_displacement = surface::find_level_displacement(&walk_results, gait);
        let messages =
            surface::describe_shortfalls(Surface::Edge(20), level_displacement, no_displacement);
        assert_eq!(messages.len(), shortfall_count, "{gait}: {messages:?}");
    }
    let [left, right] =
        ["left", "right"].map(|gait| surface::find_level_displacement(&walk_results, gait));
    let messages = surface::describe_shortfalls(Surface::Slope(8), left, right);
    let expected =
        "-14.9 deg per cycle, 14.9 deg on a level floor; the fraction -1.00 must be at least 0.75";
    assert_eq!(messages, [expected]);
}

#[test]
fn gaits_that_do_not_turn_on_the_spot_take_every_foot_across_the_edge() {
    let walk_results = WalkResults::load_stored();
    let mut gaits_on_the_spot = Vec::new();
    for name in surface::ROBOT_NAMES {
        let feet = load_robot(name).ground().legs.foot_positions([0.0; 4]);
        for (gait, level_displacement) in surface::list_walking_gaits(&walk_results, name) {
            let crossing = Crossing::find(&load_robot(name), level_displacement, 0);
            if !crossing.is_crossed {
                gaits_on_the_spot.push(gait);
                continue;
            }
            let block = crossing.make_block(2.0);
            // A point on the edge and the direction across the edge come from the block alone, so that the test detects
            // a wrong block.
            let (sin, cos) = block.rotation.to_radians().sin_cos();
            let half_length = block.size[1] / 2.0;
            let [x, y] = block.centre;
            let edge = [x + half_length * sin, y - half_length * cos];
            let compute_distance_beyond =
                |[right, forward]: [f64; 2]| (forward - edge[1]) * cos - (right - edge[0]) * sin;
            let mut pose = [0.0; 3];
            for [forward, left] in feet {
                let is_before = compute_distance_beyond([-left, forward]) < -20.0;
                assert!(is_before, "{name}: {gait} does not start before the edge");
            }
            for _ in 0..crossing.cycle_count {
                pose = move_pose(pose, level_displacement.0);
            }
            for [forward, left] in feet {
                let [forward, left, _] = move_pose(pose, [forward, left, 0.0]);
                let is_beyond = compute_distance_beyond([-left, forward]) > 20.0;
                assert!(is_beyond, "{name}: {gait} does not end beyond the edge");
            }
        }
    }
    gaits_on_the_spot.sort_unstable();
    gaits_on_the_spot.dedup();
    let expected_gaits = [
        "left",
        "right",
        "turn-slowly-on-the-spot-all-the-way-to-the-left",
        "turn-slowly-to-the-right",
    ];
    assert_eq!(gaits_on_the_spot, expected_gaits);
}

/// Returns a pose (mm forward, mm to the left, deg) after a displacement in the pose's own frame.
fn move_pose([x, y, heading]: [f64; 3], [forward, left, turn]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = heading.to_radians().sin_cos();
    [
        x + forward * cos - left * sin,
        y + forward * sin + left * cos,
        heading + turn,
    ]
}

#[test]
fn results_of_all_assumptions_and_pad_shapes_are_stored_in_the_format_of_format_stored() {
    let stored_assumptions: GroupedDisplacements = load_stored("assumptions.json");
    let shapes: GroupedDisplacements = load_stored("pads.json");
    let stored_surfaces: SurfaceDisplacements = load_stored("surfaces.json");
    for Assumption { description, .. } in Assumption::ALL {
        let gait_count = stored_assumptions[description].len();
        assert_eq!(gait_count, assumptions::GAITS.len(), "{description}");
    }
    assert_eq!(stored_assumptions.len(), Assumption::ALL.len());
    for shape in PadShape::ALL {
        assert_eq!(shapes[&shape.name()].len(), SURFACES.len());
    }
    assert_eq!(shapes.len(), PadShape::ALL.len());
    for (file, text) in [
        ("assumptions.json", format_stored(&stored_assumptions, 1)),
        ("pads.json", format_stored(&shapes, 1)),
        ("surfaces.json", format_stored(&stored_surfaces, 2)),
    ] {
        let stored_text = std::fs::read_to_string(crate_dir().join(file));
        assert_eq!(stored_text.expect(file), text);
    }
    // The pads in robot.toml have the shape `30`; therefore surfaces.json must have the same displacements for `walk`.
    for surface in SURFACES {
        let name = surface.to_string();
        let displacement = stored_surfaces["paper"]["walk"][&name];
        let (mm, _) = shapes["30"][&name].compute_difference(displacement);
        assert!(mm < 0.05, "{name}: {mm} mm");
    }
}

#[test]
fn every_walk_is_stored_and_agrees_with_the_model() {
    let walk_results = WalkResults::load_stored();
    let mut count = 0;
    for name in ROBOT_NAMES {
        let robot = load_robot(name);
        for gait in robot.gaits().iter().filter(|gait| gait.has_movement()) {
            let gait = gait.name();
            let find_results = |case| walk_results.get(name, gait, case);
            let has_model_result =
                find_results(Case::ALL[0]).is_some_and(|results| results.model.is_some());
            for case in Case::ALL {
                let Some(results) = find_results(case) else {
                    let may_be_missing = !has_model_result && case != Case::ALL[0];
                    assert!(may_be_missing, "{name}: {gait}");
                    continue;
                };
                let disagreement = results.describe_disagreement(case);
                assert_eq!(disagreement, None, "{name}: {gait}");
                assert_eq!(results.model.is_some(), has_model_result, "{name}: {gait}");
                count += 1;
            }
        }
    }
    let walk_count = walk_results.walk_count();
    assert_eq!(walk_count, count, "no other walks may be stored");
}

#[test]
fn the_stored_results_of_the_model_are_up_to_date() {
    let (walk_results, robot) = (WalkResults::load_stored(), load_robot("paper"));
    let mut count = 0;
    for walk in list_walks(&robot) {
        let results = walk_results.get("paper", &walk.gait, walk.case);
        let results = results.expect("the walk is stored");
        assert_eq!(results.model.is_some(), walk.is_determined, "{}", walk.gait);
        let (Some(stored), Some(computed)) = (results.model, walk.simulate_contact_model(&robot))
        else {
            continue;
        };
        let (mm, deg) = stored.compute_difference(computed);
        let values = format!("stored {stored:?}, computed {computed:?}");
        assert!(mm < 0.05 && deg < 0.05, "{}: {values}", walk.gait);
        count += 1;
    }
    assert!(count >= 40, "{count} walks");
}

#[test]
fn a_foot_1_mm_too_long_costs_less_than_a_tenth_of_the_distance_or_of_the_turn() {
    let walk_results = WalkResults::load_stored();
    let legs = LegDrive::Rigid;
    let distance_and_turn = |Displacement([forward, left, turn])| (forward.hypot(left), turn.abs());
    let mut count = 0;
    for name in ROBOT_NAMES {
        let robot = load_robot(name);
        for gait in robot.gaits().iter().filter(|gait| gait.has_movement()) {
            let find_results = |feet| walk_results.get(name, gait.name(), Case { legs, feet });
            let results = [FootSetup::Level, FootSetup::Long].map(find_results);
            let [Some(level), Some(long)] = results else {
                continue;
            };
            let model = level.model.zip(long.model).into_iter();
            let pairs = model.chain([(level.mujoco, long.mujoco)]);
            for (level_displacement, long_displacement) in pairs {
                let [(level_distance, level_turn), (long_distance, long_turn)] =
                    [level_displacement, long_displacement].map(distance_and_turn);
                // The test checks a gait's distance, or the turn of a gait without distance; it skips other gaits.
                let (level_value, long_value) = match (level_distance > 4.0, level_turn > 1.0) {
                    (true, _) => (level_distance, long_distance),
                    (false, true) => (level_turn, long_turn),
                    (false, false) => continue,
                };
                assert!(
                    long_value > 0.9 * level_value,
                    "{name}: {}: level feet {level_displacement:?}, long foot {long_displacement:?}",
                    gait.name()
                );
                count += 1;
            }
        }
    }
    assert!(count >= 60, "{count} displacements");
}

#[test]
fn robot_toml_accepts_every_key_in_the_table_of_expected_results() {
    let text = std::fs::read_to_string(crate_dir().join("../../robots/paper.toml"));
    let text = text.expect("robots/paper.toml is readable");
    let table = format_expected_results_table(&load_robot("paper"));
    let keys = table.lines().skip(2).map(|line| {
        let cell = line.rsplit(" | ").next().expect("a row has cells");
        cell.trim_end_matches(" |").trim_matches('`')
    });
    let mut count = 0;
    for key in keys {
        let (section, name) = key.split_once("] ").expect(key);
        let header = format!("\n{section}]");
        let path = format!("{}.{name}", section.trim_start_matches('['));
        let text = edit::without_key(&text, &path).expect(key);
        // No key takes an array. Therefore a known key is rejected because of its type, and an unknown key because it
        // is unknown.
        let invalid_text = match text.split_once(&header) {
            Some((start, rest)) => {
                let (comment, rest) = rest.split_once('\n').expect("the header's line ends");
                format!("{start}{header}{comment}\n{name} = []\n{rest}")
            }
            None if name == "force" => {
                format!("{text}\n{section}]\nkind = \"strut\"\nrate = 0.4\n{name} = []\n")
            }
            None => format!("{text}\n{section}]\n{name} = []\n"),
        };
        let message = Robot::parse(&invalid_text).expect_err(key).to_string();
        let is_type_error = message.contains(&path) && !message.contains("not a known key");
        assert!(is_type_error, "{message}");
        count += 1;
    }
    assert!(count >= 10, "{count} keys");
}
