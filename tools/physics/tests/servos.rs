//! Tests of the stored displacements with servos that lag behind their pulses, by the contact model and by MuJoCo.
//!
//! With `BLESS_PHYSICS=1`, as in `make docs`, the table is written into docs/judges.md.

use lizard_physics::crate_folder;
use lizard_physics::servos::{GAITS, Variant, servos_table, stored};
use lizard_physics::text::{check_block, format_blocks};

#[test]
fn a_gait_with_lagging_servos_loses_as_much_in_the_model_as_in_mujoco() {
    let stored = stored();
    let mut result_count = 0;
    for variant in Variant::ALL {
        for (gait, component) in GAITS {
            let results = stored[variant.name][gait];
            let name = variant.name;
            assert_eq!(variant.disagreement(gait, &results), None, "{name}, {gait}");
            let stored_displacement = results.model.expect("the model has a displacement");
            let displacement = variant.model_displacement(gait);
            let error = (stored_displacement.0[component] - displacement.0[component]).abs();
            assert!(
                error < 0.05,
                "{name}, {gait}: {stored_displacement:?} {displacement:?}"
            );
            // Half of MuJoCo's displacement must be reported as a disagreement.
            let mut halved_results = results;
            halved_results.mujoco.0[component] /= 2.0;
            assert!(
                variant.disagreement(gait, &halved_results).is_some(),
                "{name}, {gait}"
            );
            result_count += 1;
        }
    }
    let stored_count: usize = stored.values().map(std::collections::BTreeMap::len).sum();
    assert_eq!(stored_count, result_count, "and no others are stored");
    let file = std::fs::read_to_string(crate_folder().join("servos.json"))
        .expect("servos.json is readable");
    assert_eq!(file, format_blocks(&stored));
}

#[test]
fn the_page_has_the_displacements_by_the_model_and_by_mujoco() {
    let begin = "<!-- servos of robots/paper.toml -->\n";
    let table = servos_table(&stored());
    check_block("docs/judges.md", begin, "<!-- end -->", &table);
}
