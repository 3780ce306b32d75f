//! Tests of the stored displacements with servos that cannot follow, by the contact model and by MuJoCo.
//!
//! With `BLESS_PHYSICS=1` the table is written into docs/judges.md, as `make docs` does.

use lizard_physics::crate_folder;
use lizard_physics::servos::{GAITS, Variant, servos_table, stored, text};

#[test]
fn a_servo_that_cannot_follow_loses_in_the_model_what_it_loses_in_mujoco() {
    let stored = stored();
    let mut count = 0;
    for variant in Variant::ALL {
        for (gait, component) in GAITS {
            let answers = stored[variant.name][gait];
            let name = variant.name;
            assert_eq!(variant.disagreement(gait, &answers), None, "{name}, {gait}");
            let (stored_displacement, displacement) =
                (answers.model.expect("a way"), variant.model(gait));
            let error = (stored_displacement.0[component] - displacement.0[component]).abs();
            assert!(
                error < 0.05,
                "{name}, {gait}: {stored_displacement:?} {displacement:?}"
            );
            // Half of MuJoCo's displacement must be reported as a disagreement.
            let mut halved = answers;
            halved.mujoco.0[component] /= 2.0;
            assert!(
                variant.disagreement(gait, &halved).is_some(),
                "{name}, {gait}"
            );
            count += 1;
        }
    }
    let stored_count: usize = stored.values().map(std::collections::BTreeMap::len).sum();
    assert_eq!(stored_count, count, "and no others are stored");
    let file = std::fs::read_to_string(crate_folder().join("servos.json")).expect("servos.json");
    assert_eq!(file, text(&stored));
}

#[test]
fn the_page_has_the_ways_of_model_and_mujoco() {
    let file = crate_folder().join("../../docs/judges.md");
    let page = std::fs::read_to_string(&file).expect("judges.md");
    let begin = "<!-- servos of robots/paper.toml -->\n";
    let start = page.find(begin).expect(begin) + begin.len();
    let end = start + page[start..].find("<!-- end -->").expect("an end");
    let new_page = format!(
        "{}{}{}",
        &page[..start],
        servos_table(&stored()),
        &page[end..]
    );
    if std::env::var_os("BLESS_PHYSICS").is_some() {
        std::fs::write(&file, new_page).expect("judges.md");
    } else {
        assert_eq!(page, new_page, "run with BLESS_PHYSICS=1");
    }
}
