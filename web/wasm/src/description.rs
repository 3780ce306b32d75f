//! The description of a robot, which the page reads before the robot moves.

use lizard_core::console::text::Text;
use lizard_core::console::word::Word;
use lizard_core::numbers::section::START_ADDRESS;
use lizard_kinematics::Check;
use lizard_robot::edit::HIP_KEYS;
use lizard_robot::servo::SERVO_NAMES;
use lizard_robot::{Plate, Robot, ServoType, healthy_rail_pin_mv};
use lizard_twin::ServoModel;
use serde::Serialize;
use tsify::Tsify;

use crate::floor::Floor;
use crate::scene::Point;

/// A gait of the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct GaitEntry {
    /// Name of the gait in robot.toml.
    pub name: String,
    /// Console command that starts the gait.
    pub command: String,
    /// Duration of a cycle at full pace, s.
    pub period: f64,
    /// True if a servo moves during a cycle.
    pub moves: bool,
    /// True if the gait's phase runs backward.
    pub reversed: bool,
}

/// A length of the robot that the user may change.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct LengthEntry {
    /// Key in robot.toml, such as `links.l1`.
    pub key: String,
    /// Name for the user.
    pub label: &'static str,
    /// Key of the length that must be equal, such as the same length on the other side. The length's own key if no
    /// other length must be equal.
    pub twin: String,
    /// Unit: mm, or deg for an angle.
    pub unit: &'static str,
    /// Value in `unit`.
    pub value: f64,
}

/// The limit of a margin.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct MarginEntry {
    /// Name of the margin.
    pub name: &'static str,
    /// Smallest allowed value, the sine of an angle.
    pub limit: f64,
}

/// A servo of the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct ServoEntry {
    /// Name, A1 to A4.
    pub name: &'static str,
    /// Arduino number of the servo's pin; 14 to 19 are A0 to A5.
    pub pin: u8,
    /// Neutral angle, deg, chassis frame.
    pub neutral: f64,
}

/// Name of the servo model that describes the servos in robot.toml.
const OWN_SERVOS: &str = "own";
/// Name of the servo model in which servos follow their pulses exactly.
const IDEAL_SERVOS: &str = "ideal";

/// A servo model.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct ServoModelEntry {
    /// Name of the model.
    pub name: &'static str,
    /// Stall torque, kg cm; time for 60 deg, s; the supply at which these two values are specified, V; and the supply
    /// in the robot, V. `None` for ideal servos.
    pub ratings: Option<[f64; 4]>,
}

impl ServoModelEntry {
    /// Returns the models that the page offers for a robot, the default model first.
    fn list_all(robot: &Robot) -> Vec<Self> {
        let make_entry = |name, servo: &ServoType| Self {
            name,
            ratings: Some([
                servo.stall_torque_kg_cm,
                servo.s_per_60_deg,
                servo.rated_volts,
                servo.supply_volts,
            ]),
        };
        let mut models = vec![make_entry(OWN_SERVOS, robot.servo_type())];
        let types = ServoType::ALL.iter();
        models.extend(types.map(|servo| make_entry(servo.model, servo)));
        models.push(Self {
            name: IDEAL_SERVOS,
            ratings: None,
        });
        models
    }
}

/// Finds a robot's servo model by name. A name such as `copy at 4.2` also sets the supply, V. Returns `None` for an
/// unknown name, or a supply that robot.toml does not allow.
pub(crate) fn find_servo_model(robot: &Robot, name: &str) -> Option<ServoModel> {
    let (name, supply) = match name.split_once(" at ") {
        Some((name, volts)) => (name, Some(volts.parse().ok()?)),
        None => (name, None),
    };
    let servo = match name {
        IDEAL_SERVOS => return Some(ServoModel::Ideal),
        OWN_SERVOS => robot.servo_type(),
        _ => ServoType::ALL.iter().find(|servo| servo.model == name)?,
    };
    let volts = supply.unwrap_or(servo.supply_volts);
    let (min, max) = ServoType::VOLTS_RANGE;
    let is_allowed = (min..=max).contains(&volts);
    is_allowed.then(|| ServoModel::Motors(robot.motors_with_type(servo, volts)))
}

/// The chassis plate seen from above, mm, chassis frame.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct PlateEntry {
    /// Half the width and half the length, without the arms.
    pub half_size: Point,
    /// Radius of the corners.
    pub corner_radius: f64,
    /// Ends of the arms that carry the legs' pivots.
    pub arms: Vec<[Point; 2]>,
    /// Half the width of an arm.
    pub arm_half_width: f64,
    /// Centres of the servos' cases.
    pub case_centres: [Point; 4],
    /// Width and length of a case.
    pub case_size: Point,
}

impl From<Plate> for PlateEntry {
    fn from(plate: Plate) -> Self {
        let arms = plate.arms.as_flattened().iter();
        Self {
            half_size: plate.half_size.into(),
            corner_radius: plate.corner_radius,
            arms: arms.map(|arm| arm.map(Point::from)).collect(),
            arm_half_width: plate.arm_half_width,
            case_centres: plate.case_centres.map(Point::from),
            case_size: plate.case_size.into(),
        }
    }
}

/// The description of a robot for the page.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Description {
    /// Hash of the robot's section in hex, as in the banner.
    pub hash: String,
    /// Name of the robot, as in the banner.
    pub name: String,
    /// Version of the firmware for which the section is made.
    pub version: String,
    /// Byte address of the robot's section in flash.
    pub start: u16,
    /// Servos A1 to A4.
    #[tsify(type = "Four<ServoEntry>")]
    pub servos: Vec<ServoEntry>,
    /// Gaits in the order of the file.
    pub gaits: Vec<GaitEntry>,
    /// Console commands that start a routine, in the order of the file.
    pub routines: Vec<String>,
    /// Lengths that the user may change.
    pub lengths: Vec<LengthEntry>,
    /// Chassis plate seen from above.
    pub plate: PlateEntry,
    /// Limits of the margins, in the order of [`crate::scene::Scene::margins`].
    pub margins: Vec<MarginEntry>,
    /// Thresholds of the board's supply below which the robot slows down, stops, and rests, V.
    pub supply: [f64; 3],
    /// Pace limit below the first threshold of `supply`, percent of a gait's nominal pace.
    pub slow_pace: u8,
    /// ADC channel that measures the servos' rail, and the voltage at its pin while the rail is healthy, V. `None` if
    /// the rail is not measured.
    pub rail: Option<(u8, f64)>,
    /// Name of each input, and the Arduino number of its pin.
    pub inputs: Vec<(&'static str, u8)>,
    /// Floor, mass, feet and leg drive.
    pub floor: Floor,
    /// Servo models that the page offers.
    pub models: Vec<ServoModelEntry>,
    /// Reserved words of the console, which may not be gait names; the same for every robot.
    pub words: Vec<&'static str>,
}

impl Description {
    /// Describes a robot.
    pub fn for_robot(robot: &Robot) -> Self {
        let servos = SERVO_NAMES.into_iter().zip(robot.servos());
        let servos = servos.map(|(name, servo)| ServoEntry {
            name,
            pin: servo.pin,
            neutral: servo.neutral,
        });
        let gaits = robot.gaits().iter().map(|gait| GaitEntry {
            name: gait.name().to_string(),
            command: gait.command(),
            period: gait.period(),
            moves: gait.has_movement(),
            reversed: gait.is_reversed(),
        });
        let routines = robot.routines().iter();
        let limits = robot.limits();
        let list_margins = |checks: &[Check], limit: f64| {
            let names = checks.iter().map(|check| check.name());
            let entries = names.map(|name| MarginEntry { name, limit });
            entries.collect::<Vec<_>>()
        };
        let margins = [
            list_margins(&Check::TYPE2, limits.type2),
            list_margins(&Check::TYPE1, limits.type1),
            list_margins(&Check::LEG, limits.leg),
        ];
        let core = robot.core();
        let board = core.supplies().board;
        let mut version = String::new();
        Text::Version.print(&mut version);
        let words = Word::ALL.iter().filter(|word| word.is_reserved());
        Self {
            hash: format!("{:08x}", core.hash()),
            name: robot.name().to_string(),
            version,
            start: START_ADDRESS,
            servos: servos.collect(),
            gaits: gaits.collect(),
            routines: routines.map(|routine| routine.command()).collect(),
            lengths: list_lengths(robot),
            plate: robot.plate().into(),
            margins: margins.concat(),
            rail: healthy_rail_pin_mv(&core.supplies())
                .zip(core.rail_pin())
                .map(|(mv, pin)| (pin - 14, mv / 1000.0)),
            inputs: robot.inputs().named_pins().collect(),
            slow_pace: core.slow_pace(),
            supply: [board.slow_mv, board.stop_mv, board.rest_mv].map(|mv| f64::from(mv) / 1000.0),
            floor: Floor::for_robot(robot),
            models: ServoModelEntry::list_all(robot),
            words: words.map(|word| word.spelling()).collect(),
        }
    }
}

/// The label of each link, l0 to l19, and the number of its twin, its mirror image; a base is its own twin.
const LINK_LABELS_AND_TWINS: [(&str, usize); 20] = [
    ("head base", 0),
    ("head crank, left", 4),
    ("head coupler, left", 3),
    ("head coupler, right", 2),
    ("head crank, right", 1),
    ("tail base", 5),
    ("tail crank, left", 9),
    ("tail coupler, left", 8),
    ("tail coupler, right", 7),
    ("tail crank, right", 6),
    ("chassis, left", 15),
    ("rear arm, left", 16),
    ("slider rear half, left", 17),
    ("slider front half, left", 18),
    ("front arm, left", 19),
    ("chassis, right", 10),
    ("rear arm, right", 11),
    ("slider rear half, right", 12),
    ("slider front half, right", 13),
    ("front arm, right", 14),
];

/// Returns the lengths of a robot that the user may change, with their current values.
fn list_lengths(robot: &Robot) -> Vec<LengthEntry> {
    let (leg, geometry) = (robot.lizard().leg, robot.ground().legs);
    let make_entry = |key: &str, label, twin: &str, value| LengthEntry {
        key: key.to_string(),
        label,
        twin: twin.to_string(),
        unit: if key == "leg.mount" { "deg" } else { "mm" },
        value,
    };
    let values = robot.lizard().links.to_array();
    let links = LINK_LABELS_AND_TWINS.iter().zip(values).enumerate();
    let links = links.map(|(i, ((label, twin), value))| {
        let (key, twin) = (format!("links.l{i}"), format!("links.l{twin}"));
        make_entry(&key, label, &twin, value)
    });
    let [forward_key, side_key] = HIP_KEYS;
    let [front_side, hind_side] = geometry.hip_side;
    let (forward, mount) = (geometry.hip_forward, geometry.mount_angle);
    let legs = [
        make_entry("leg.ground", "leg ground link", "leg.coupler", leg.ground),
        make_entry("leg.crank", "leg crank", "leg.follower", leg.crank),
        make_entry("leg.coupler", "leg coupler", "leg.ground", leg.coupler),
        make_entry("leg.follower", "leg follower", "leg.crank", leg.follower),
        make_entry(forward_key, "hip, fore and aft", forward_key, forward),
    ];
    // Hips that are computed from the legs may differ between front and hind. One number cannot describe both;
    // therefore the page does not offer this length.
    let side_entry = (front_side == hind_side)
        .then(|| make_entry(side_key, "hip, sideways", side_key, front_side));
    let mount_entry = make_entry("leg.mount", "outward sweep of the legs", "leg.mount", mount);
    let lengths = links.chain(legs).chain(side_entry);
    lengths.chain([mount_entry]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_is_the_twin_of_its_twin() {
        let robot = crate::paper::load_paper_robot();
        let lengths = Description::for_robot(&robot).lengths;
        for length in &lengths {
            let mut candidates = lengths.iter();
            let twin = candidates.find(|candidate| candidate.key == length.twin);
            let twin = twin.expect("every twin is in the list");
            assert_eq!((&twin.twin, twin.value), (&length.key, length.value));
        }
    }
}
