//! Tests that the masses in the MuJoCo file agree with robot.toml, the bill and the contact model.

use lizard_parts::{Assembly, Bill};
use lizard_robot::Robot;
use lizard_robot::servo::LEG_NAMES;
use roxmltree::Document;

use crate::mjcf_reader::{bodies, child, mjcf_with, neutral_solution, numbers};
use crate::{ROBOTS, robot_with};

/// The total mass of the bodies in a MuJoCo file, g, and their centre of mass, mm: forward, left, above the plate.
pub fn mass_and_centre(text: &str) -> (f64, [f64; 3]) {
    let document = Document::parse(text).expect("the file is well-formed XML");
    let (mut mass, mut moment) = (0.0, [0.0; 3]);
    let bodies_by_name = bodies(&document);
    for (placement, body) in bodies_by_name.values() {
        let inertial = child(*body, "inertial");
        let grams = 1000.0 * numbers(inertial, "mass")[0];
        assert!(grams > 0.0, "{body:?}");
        let centre = placement.point(&numbers(inertial, "pos"));
        mass += grams;
        for (sum, coordinate) in moment.iter_mut().zip(centre) {
            *sum += grams * coordinate * 1000.0;
        }
    }
    let (chassis_placement, _) = bodies_by_name["chassis"];
    let plate_height = 1000.0 * chassis_placement.position[2];
    let [right, forward, up] = moment.map(|component| component / mass);
    (mass, [forward, -right, up - plate_height])
}

/// Loads a robot file with another mass (g) and centre of mass (mm).
fn robot_with_mass(name: &str, mass: f64, [ahead, left]: [f64; 2]) -> Robot {
    let path = format!("{}/../../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect(&path);
    let (text_before, text_after) = text
        .split_once("\nmass = ")
        .expect("the file states a mass");
    let (_, text_after) = text_after
        .split_once('\n')
        .expect("another line follows the mass");
    let keys = format!("\nmass = {mass:.1}\ncentre = [{ahead:.1}, {left:.1}]\n");
    Robot::parse(&format!("{text_before}{keys}{text_after}")).expect(name)
}

#[test]
fn mass_and_mass_centre_are_those_of_robot_toml() {
    for name in ROBOTS {
        let body = robot_with(name, "").ground().body;
        for (mass, centre) in [
            (body.mass, body.mass_centre),
            (500.0, [20.0, -9.0]),
            (350.0, [-15.0, 0.0]),
        ] {
            let robot = robot_with_mass(name, mass, centre);
            let bill = Bill::of(&Assembly::new(&robot), &[], &neutral_solution(&robot));
            let (grams, [ahead, left, up]) = mass_and_centre(&mjcf_with(&robot, |_| {}));
            // The mesh replaces each arc by chords, so it loses a little volume.
            assert!((grams / mass - 1.0).abs() < 2e-3, "{name} {grams} {mass}");
            let error = (ahead - centre[0]).hypot(left - centre[1]);
            assert!(error < 0.05, "{name} {ahead} {left} {centre:?}");
            // Wires count as being at the height of the plate.
            let moment_error = (grams * up / (bill.grams * bill.centre[2]) - 1.0).abs();
            assert!(moment_error < 0.01, "{name} {up} {:?}", bill.centre);
        }
    }
}

#[test]
fn the_mass_of_a_leg_in_the_contact_model_matches_that_of_its_parts() {
    for name in ROBOTS {
        let robot = robot_with(name, "");
        let text = mjcf_with(&robot, |_| {});
        let document = Document::parse(&text).expect("the file is well-formed XML");
        let ground = robot.ground();
        for leg in LEG_NAMES {
            let mass_and_lever_arm = |part: &str| {
                let name = format!("{part} {leg}");
                let mut nodes = document.descendants();
                let body = nodes.find(|node| {
                    node.has_tag_name("body") && node.attribute("name") == Some(&*name)
                });
                let inertial = child(body.expect("the leg has this part"), "inertial");
                let centre = numbers(inertial, "pos");
                (numbers(inertial, "mass")[0], centre[0].hypot(centre[1]))
            };
            // Foot and coupler move as the pad does. Crank and follower rotate about their pivots, so their mass
            // centres move by a share of the pad's motion.
            let carried_mass = mass_and_lever_arm("foot").0 + mass_and_lever_arm("leg coupler").0;
            let turning_masses = ["crank", "follower"].map(mass_and_lever_arm);
            let equivalent_masses =
                turning_masses.map(|(mass, lever_arm)| mass * 1e3 * lever_arm / ground.feet.reach);
            let grams = 1e3 * (carried_mass + equivalent_masses[0] + equivalent_masses[1]);
            let model_grams = ground.body.leg_mass();
            assert!(
                (grams / model_grams - 1.0).abs() < 0.25,
                "{name} {leg}: {grams} and {model_grams} g"
            );
        }
    }
}
