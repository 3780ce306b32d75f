//! Tests that the masses in the MuJoCo file agree with robot.toml, the bill and the contact model.

use lizard_parts::{Assembly, Bill};
use lizard_robot::servo::LEG_NAMES;
use lizard_robot::{Robot, edit};
use roxmltree::Document;

use crate::mjcf_reader::{
    find_named, first_child, make_mjcf, parse_xml, read_bodies, read_numbers,
};
use crate::{ROBOTS, read_robot_with, solve_at_neutral};

/// Computes the mass (g) and the centre of mass (mm: forward, left, up from the plate) of all bodies in a MuJoCo file.
pub fn compute_mass_and_centre(document: &Document) -> (f64, [f64; 3]) {
    let (mut mass, mut moment) = (0.0, [0.0; 3]);
    let bodies_by_name = read_bodies(document);
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

/// Reads a robot file and replaces its mass (g) and centre of mass (mm: forward, left).
fn read_robot_with_mass(name: &str, mass: f64, centre: [f64; 2]) -> Robot {
    let path = format!("{}/../../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect(&path);
    let text = edit::with_number(&text, "body.mass", mass).expect("the file has a mass");
    let text = edit::with_numbers(&text, "body.centre", &centre).expect("a centre can be added");
    Robot::parse(&text).expect(name)
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
            let text = make_mjcf(&robot, |_| {});
            let document = parse_xml(&text);
            let (grams, [forward, left, up]) = compute_mass_and_centre(&document);
            // The mesh replaces each arc by chords, so it loses a little volume.
            let error = grams / mass - 1.0;
            assert!(error.abs() < 2e-3, "{name}: {grams} g, not {mass} g");
            let error = (forward - centre[0]).hypot(left - centre[1]);
            assert!(error < 0.05, "{name}: {forward}, {left}, not {centre:?}");
            // The model places the wires at the height of the plate.
            let (moment, bill_moment) = (grams * up, bill.grams * bill.centre_of_mass[2]);
            let error = moment / bill_moment - 1.0;
            assert!(
                error.abs() < 0.01,
                "{name}: {moment} g mm, not {bill_moment} g mm"
            );
        }
    }
}

#[test]
fn the_leg_mass_of_the_parts_differs_by_less_than_a_quarter_from_the_contact_models() {
    for name in ROBOTS {
        let robot = read_robot_with(name, "");
        let text = make_mjcf(&robot, |_| {});
        let document = parse_xml(&text);
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
                turning_masses.map(|(mass, lever_arm)| mass * 1e3 * lever_arm / ground.legs.reach);
            let grams = 1e3 * (carried_mass + equivalent_masses[0] + equivalent_masses[1]);
            let model_grams = ground.body.leg_mass();
            let error = grams / model_grams - 1.0;
            let message = format!("parts {grams} g, model {model_grams} g");
            assert!(error.abs() < 0.25, "{name} {leg}: {message}");
        }
    }
}
