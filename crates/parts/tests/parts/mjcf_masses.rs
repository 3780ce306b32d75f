//! Tests that the masses in the MuJoCo file agree with robot.toml, the bill and the contact model.

use lizard_parts::{Assembly, Bill};
use lizard_robot::Robot;
use lizard_robot::servo::LEG_NAMES;
use roxmltree::Document;

use crate::mjcf_reader::{
    find_named, first_child, make_mjcf, read_bodies, read_numbers, solve_at_neutral,
};
use crate::{ROBOTS, read_robot_with};

/// Computes the mass (g) and the centre of mass (mm: forward, left, up from the plate) of all bodies in a MuJoCo file.
pub fn compute_mass_and_centre(text: &str) -> (f64, [f64; 3]) {
    let document = Document::parse(text).expect("the file is well-formed XML");
    let (mut mass, mut moment) = (0.0, [0.0; 3]);
    let bodies_by_name = read_bodies(&document);
    for (placement, body) in bodies_by_name.values() {
        let inertial = first_child(*body, "inertial");
        let grams = 1000.0 * read_numbers(inertial, "mass")[0];
        assert!(grams > 0.0, "{body:?}");
        let centre = placement.to_world(&read_numbers(inertial, "pos"));
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

/// Reads a robot file and replaces its mass (g) and centre of mass (mm).
fn read_robot_with_mass(name: &str, mass: f64, [forward, left]: [f64; 2]) -> Robot {
    let path = format!("{}/../../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect(&path);
    let (text_before, text_after) = text.split_once("\nmass = ").expect("the file has a mass");
    let lines = text_after.split_once('\n');
    let (_, text_after) = lines.expect("another line follows the mass");
    let keys = format!("\nmass = {mass:.1}\ncentre = [{forward:.1}, {left:.1}]\n");
    Robot::parse(&format!("{text_before}{keys}{text_after}")).expect(name)
}

#[test]
fn mass_and_centre_of_mass_match_robot_toml() {
    for name in ROBOTS {
        let body = read_robot_with(name, "").ground().body;
        for (mass, centre) in [
            (body.mass, body.centre_of_mass),
            (500.0, [20.0, -9.0]),
            (350.0, [-15.0, 0.0]),
        ] {
            let robot = read_robot_with_mass(name, mass, centre);
            let bill = Bill::compute(&Assembly::new(&robot), &[], &solve_at_neutral(&robot));
            let (grams, [forward, left, up]) = compute_mass_and_centre(&make_mjcf(&robot, |_| {}));
            // The mesh replaces each arc by chords, so it loses a little volume.
            let error = grams / mass - 1.0;
            assert!(error.abs() < 2e-3, "{name}: {grams} g, not {mass} g");
            let error = (forward - centre[0]).hypot(left - centre[1]);
            assert!(error < 0.05, "{name}: {forward}, {left}, not {centre:?}");
            // The model places the wires at the height of the plate.
            let bill_moment = bill.grams * bill.centre_of_mass[2];
            let error = grams * up / bill_moment - 1.0;
            assert!(error.abs() < 0.01, "{name}: {up} mm and {bill_moment} g mm");
        }
    }
}

#[test]
fn the_leg_mass_of_the_contact_model_matches_the_parts() {
    for name in ROBOTS {
        let robot = read_robot_with(name, "");
        let text = make_mjcf(&robot, |_| {});
        let document = Document::parse(&text).expect("the file is well-formed XML");
        let ground = robot.ground();
        for leg in LEG_NAMES {
            let read_mass_and_lever_arm = |part: &str| {
                let body = find_named(&document, "body", &format!("{part} {leg}"));
                let inertial = first_child(body, "inertial");
                let centre = read_numbers(inertial, "pos");
                let mass = read_numbers(inertial, "mass")[0];
                (mass, centre[0].hypot(centre[1]))
            };
            // Foot and coupler move as the pad does. Crank and follower rotate about their pivots, so their centres of
            // mass move by a fraction of the pad's motion.
            let carried_mass =
                read_mass_and_lever_arm("foot").0 + read_mass_and_lever_arm("leg coupler").0;
            let turning_masses = ["crank", "follower"].map(read_mass_and_lever_arm);
            let equivalent_masses =
                turning_masses.map(|(mass, lever_arm)| mass * 1e3 * lever_arm / ground.feet.reach);
            let grams = 1e3 * (carried_mass + equivalent_masses[0] + equivalent_masses[1]);
            let model_grams = ground.body.leg_mass();
            assert!(
                (grams / model_grams - 1.0).abs() < 0.25,
                "{name} {leg}: parts {grams} g, model {model_grams} g"
            );
        }
    }
}
