//! Tests of the stored displacements with servos that lag behind their pulses, in the contact model and in MuJoCo.
//!
//! With `BLESS_PHYSICS=1`, as in `make docs`, the tests write the table into docs/judges.md.

use lizard_physics::servos::{GAITS, ServoResults, Variant, format_servos_table};
use lizard_physics::text::{check_or_update_block, format_stored, load_stored};
use lizard_physics::{Displacement, crate_dir};

#[test]
fn the_model_matches_mujoco_for_lagging_servos() {
    let stored: ServoResults = load_stored("servos.json");
    let mut result_count = 0;
    for variant in Variant::ALL {
        for (gait, component) in GAITS {
            let name = variant.name;
            let results = stored[name][gait];
            let disagreement = variant.describe_disagreement(gait, &results);
            assert_eq!(disagreement, None, "{name}, {gait}");
            let stored_displacement = results.model.expect("the model has a displacement");
            let displacement = variant.simulate_contact_model(gait);
            let error =
                (component.value(stored_displacement) - component.value(displacement)).abs();
            let values = format!("stored {stored_displacement:?}, computed {displacement:?}");
            assert!(error < 0.05, "{name}, {gait}: {values}");
            // A halved displacement of MuJoCo must count as a disagreement.
            let mut halved_results = results;
            halved_results.mujoco = Displacement(results.mujoco.0.map(|value| value / 2.0));
            let disagreement = variant.describe_disagreement(gait, &halved_results);
            assert!(disagreement.is_some(), "{name}, {gait}");
            result_count += 1;
        }
    }
    let stored_count: usize = stored.values().map(std::collections::BTreeMap::len).sum();
    assert_eq!(stored_count, result_count, "no other results may be stored");
    let text =
        std::fs::read_to_string(crate_dir().join("servos.json")).expect("servos.json is readable");
    assert_eq!(text, format_stored(&stored, 2));
}

#[test]
fn the_documentation_has_the_stored_displacements() {
    let begin = "<!-- servos of robots/paper.toml -->\n";
    let table = format_servos_table(&load_stored("servos.json"));
    check_or_update_block("docs/judges.md", begin, "<!-- end -->", &table);
}
