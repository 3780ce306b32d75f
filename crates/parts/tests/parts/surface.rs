//! Tests that every printed part has a closed surface that encloses the volume of its solid.

use lizard_parts::{Mesh, Solid};

use crate::{GRAIN_ROBOT, build_assembly};

#[test]
fn every_printed_part_has_a_closed_surface_that_encloses_the_volume_of_its_solid() {
    for name in ["paper", "large", "unequal", GRAIN_ROBOT] {
        let assembly = build_assembly(name, "");
        let mut printed_count = 0;
        for body in assembly.bodies().iter().chain(assembly.alternatives()) {
            if !body.kind.is_printed() {
                continue;
            }
            let solid = Solid::from_prisms(&body.prisms);
            assert!(solid.is_closed(), "{name}: the solid of {}", body.name);
            let mesh = Mesh::from_solid(&solid);
            assert!(mesh.is_closed(), "{name}: the mesh of {}", body.name);
            let error = mesh.volume() / solid.volume - 1.0;
            assert!(error.abs() < 0.006, "{name}: {}, error {error}", body.name);
            printed_count += 1;
        }
        assert!(printed_count > 10, "{name}: {printed_count} printed parts");
    }
}
