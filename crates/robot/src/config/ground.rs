//! The parameters of the contact model: `[ground]`, `[body]` and `[feet]` in robot.toml.

use lizard_contact::{Body, DEFAULT_FRICTION, Drive, GroundContact, LegGeometry, Stance};

use crate::config::servo::LEG_NAMES;
use crate::file::{ReadResult, Table};

/// Reads `[ground]`, `[body]` and `[feet]`. `legs` and `drive` come from other tables.
pub(crate) fn read(root: &Table, legs: LegGeometry, drive: Drive) -> ReadResult<GroundContact> {
    const RATIO_KEY: &str = "friction_back_over_forward";
    let table = root.table("ground", &[RATIO_KEY, "friction"])?;
    let unit = "(a coefficient)";
    Ok(GroundContact {
        legs,
        body: read_body(root, &legs)?,
        stance: read_stance(root)?,
        friction_coefficient: table.number_or("friction", DEFAULT_FRICTION, (0.05, 5.0), unit)?,
        friction_ratio: table.number(RATIO_KEY, (0.1, 10.0), "(a ratio)")?,
        drive,
    })
}

/// Reads `[body]`; every key is optional. Rejects a centre of mass with which a foot would leave the floor in the
/// neutral pose.
fn read_body(root: &Table, legs: &LegGeometry) -> ReadResult<Body> {
    let Body {
        mass,
        centre_of_mass,
    } = Body::DEFAULT;
    let table = root.optional_table("body", &["mass", "centre"])?;
    let body = Body {
        mass: table.number_or("mass", mass, (10.0, 10_000.0), "g")?,
        centre_of_mass: table.numbers_or("centre", centre_of_mass, (-500.0, 500.0), "mm")?,
    };
    let loads = Stance::LEVEL.relative_loads(&body, legs.foot_positions([0.0; 4]));
    match loads.iter().position(|load| *load <= 0.0) {
        Some(leg) => {
            let foot = LEG_NAMES[leg];
            let message = format!(
                "is so far from the middle that foot {foot} is off the floor in the neutral pose; all four feet must carry load"
            );
            Err(table.error("centre", message))
        }
        None => Ok(body),
    }
}

/// Reads `[feet]`; every key is optional.
fn read_stance(root: &Table) -> ReadResult<Stance> {
    let default = Stance::DEFAULT;
    let table = root.optional_table("feet", &["stiffness", "twist", "level"])?;
    Ok(Stance {
        stiffness: table.number_or("stiffness", default.stiffness, (0.01, 1000.0), "N/mm")?,
        twist: table.number_or("twist", default.twist, (-20.0, 20.0), "mm")?,
        twist_error: table.number_or("level", default.twist_error, (0.0, 20.0), "mm")?,
    })
}
