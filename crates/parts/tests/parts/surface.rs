//! A test that every printed part of every robot has a closed surface of the right volume.

use lizard_parts::{Mesh, Solid};

use crate::{GRAIN_ROBOT, assembly};

#[test]
fn every_printed_part_is_closed_and_has_its_volume() {
    for name in ["paper", "large", "unequal", GRAIN_ROBOT] {
        let assembly = assembly(name, "");
        let mut printed_count = 0;
        for body in assembly.bodies().iter().chain(assembly.alternatives()) {
            if !body.kind.is_printed() {
                continue;
            }
            let solid = Solid::of(&body.prisms);
            assert!(solid.is_closed(), "{name}: {}", body.name);
            let mesh = Mesh::of(&solid);
            assert!(mesh.is_closed(), "{name}: the mesh of {}", body.name);
            let error = mesh.volume() / solid.volume - 1.0;
            assert!(error.abs() < 0.006, "{name}: {} {error}", body.name);
            printed_count += 1;
        }
        assert!(printed_count > 10, "{name}: {printed_count} printed parts");
    }
}
