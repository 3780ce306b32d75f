//! What the page has to know of a robot before anything moves.

use lizard_core::console::text::Text;
use lizard_core::console::word::Word;
use lizard_core::numbers::section::START;
use lizard_kinematics::Check;
use lizard_robot::servo::{LEGS, NAMES};
use lizard_robot::{
    CheckedGait, Ground, Plate, Prediction, Robot, STILL_FRAMES, Sprung, Travel, healthy_rail_mv,
};
use lizard_twin::{ServoModel, Twin};
use serde::Serialize;

use crate::edit::HIPS;
use crate::floor::Floor;
use crate::scene::Spot;

/// A gait.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GaitEntry {
    /// Its name in robot.toml.
    pub name: String,
    /// Its command of the console.
    pub command: String,
    /// Time of a cycle at full speed, s.
    pub period: f64,
    /// Whether a servo moves in it.
    pub moves: bool,
}

/// A length of the body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkEntry {
    /// Its key in robot.toml, such as `links.l1`.
    pub key: String,
    /// What it is.
    pub label: &'static str,
    /// The key of the length that mirrors it, or must equal it; it may be its own.
    pub twin: String,
    /// mm, or deg for an angle.
    pub unit: &'static str,
    /// mm.
    pub value: f64,
}

/// A margin's limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MarginEntry {
    /// Its name.
    pub name: &'static str,
    /// The least that is safe, a sine.
    pub limit: f64,
}

/// A servo.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ServoEntry {
    /// A1 to A4.
    pub name: &'static str,
    /// Its leg, LF to LH.
    pub leg: &'static str,
    /// Arduino number of its pin; 14 to 19 are A0 to A5.
    pub pin: u8,
    /// deg, chassis frame.
    pub neutral: f64,
    /// Its travel, deg from neutral.
    pub travel: (f64, f64),
}

/// What servos may be taken for, by name; the first unless the page asks for another.
pub(crate) const SERVO_MODELS: [(&str, ServoModel); 2] =
    [("sg90", ServoModel::SG90), ("ideal", ServoModel::IDEAL)];

/// What a servo can do.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelEntry {
    /// Its name.
    pub name: &'static str,
    /// Its fastest turn, deg/s; infinite is `null` in JSON.
    pub rate: f64,
    /// Width of its dead band, us.
    pub dead_band: f64,
}

impl From<(&'static str, ServoModel)> for ModelEntry {
    fn from((name, model): (&'static str, ServoModel)) -> Self {
        Self {
            name,
            rate: model.rate,
            dead_band: model.dead_band,
        }
    }
}

/// The chassis from above, as [`Plate`]: mm, chassis frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlateEntry {
    /// Half its width and half its length, without the arms.
    pub half: Spot,
    /// Radius of its corners.
    pub corner: f64,
    /// The arms that the legs are pivoted on, from and to.
    pub arms: Vec<[Spot; 2]>,
    /// Half the width of an arm.
    pub arm: f64,
    /// The middles of the servos' cases.
    pub cases: [Spot; 4],
    /// Width and length of a case.
    pub case: Spot,
}

impl From<Plate> for PlateEntry {
    fn from(plate: Plate) -> Self {
        let arms = plate.arms.as_flattened().iter();
        Self {
            half: plate.half.into(),
            corner: plate.corner,
            arms: arms.map(|arm| arm.map(Spot::from)).collect(),
            arm: plate.arm,
            cases: plate.cases.map(Spot::from),
            case: plate.case.into(),
        }
    }
}

/// A robot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Description {
    /// By which it is told from other robots, as a banner says it.
    pub hash: String,
    /// Its name, as a banner says it.
    pub name: String,
    /// The version of the firmware that it is for.
    pub version: String,
    /// Where in flash its section begins, bytes.
    pub start: u16,
    /// Its servos, A1 to A4.
    pub servos: Vec<ServoEntry>,
    /// Its gaits in the order of the file.
    pub gaits: Vec<GaitEntry>,
    /// Every length that may be changed.
    pub lengths: Vec<LinkEntry>,
    /// Its chassis.
    pub plate: PlateEntry,
    /// Every margin's limit, in the order of [`crate::Scene::margins`].
    pub margins: Vec<MarginEntry>,
    /// Travel that the sliders have, mm from nominal.
    pub stroke: (f64, f64),
    /// Below these V the board slows down, stops and rests.
    pub supply: [f64; 3],
    /// The channel of the converter that measures the servos' rail, and the volts there.
    pub rail: Option<(u8, f64)>,
    /// Its floor, weight, feet, and what drives its legs.
    pub floor: Floor,
    /// What its servos may be taken for.
    pub models: Vec<ModelEntry>,
    /// Frames without motion after which it stands still.
    pub still: u64,
    /// The words that the page may send: they mean the same to every robot.
    pub words: Vec<&'static str>,
}

impl Description {
    /// Of a robot.
    #[must_use]
    pub fn of(robot: &Robot) -> Self {
        let servos = robot
            .servos()
            .iter()
            .enumerate()
            .map(|(i, servo)| ServoEntry {
                name: NAMES[i],
                leg: LEGS[i],
                pin: servo.pin,
                neutral: servo.neutral,
                travel: servo.travel(),
            });
        let gaits = robot.gaits().iter().map(|gait| GaitEntry {
            name: gait.name().to_string(),
            command: gait.name().replace('-', " "),
            period: gait.period(),
            moves: gait.moves(),
        });
        let limits = robot.limits();
        let of = |checks: &[Check], limit: f64| {
            let entry = |check: &Check| MarginEntry {
                name: check.name(),
                limit,
            };
            checks.iter().map(entry).collect::<Vec<_>>()
        };
        let core = robot.core();
        let board = core.supplies().board;
        Self {
            hash: format!("{:08x}", core.hash()),
            name: robot.name().to_string(),
            version: version(),
            start: START,
            servos: servos.collect(),
            gaits: gaits.collect(),
            lengths: lengths(robot),
            plate: robot.plate().into(),
            margins: [
                of(&Check::TYPE2, limits.type2),
                of(&Check::TYPE1, limits.type1),
                of(&Check::LEG, limits.leg),
            ]
            .concat(),
            stroke: (limits.stroke_min, limits.stroke_max),
            rail: healthy_rail_mv(&core.supplies())
                .zip(core.rail_pin())
                .map(|(mv, pin)| (pin - 14, mv / 1000.0)),
            supply: [board.slow, board.stop, board.rest].map(|mv| f64::from(mv) / 1000.0),
            floor: Floor::of(robot),
            models: SERVO_MODELS.map(ModelEntry::from).into(),
            still: STILL_FRAMES,
            words: words(),
        }
    }
}

/// The core's own.
fn version() -> String {
    let mut version = String::new();
    Text::Version.print(&mut version);
    version
}

/// The words that are reserved. A gait can have the name of any other.
fn words() -> Vec<&'static str> {
    let reserved = Word::ALL.iter().filter(|word| word.is_reserved());
    reserved.map(|word| word.text()).collect()
}

/// What each link is, and the number of its mirror image.
const LINKS: [(&str, usize); 20] = [
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

fn lengths(robot: &Robot) -> Vec<LinkEntry> {
    let values = robot.lizard().links.to_array();
    let links = LINKS.iter().zip(values).enumerate();
    let links = links.map(|(i, ((label, twin), value))| LinkEntry {
        key: format!("links.l{i}"),
        label,
        twin: format!("links.l{twin}"),
        unit: "mm",
        value,
    });
    let (leg, feet) = (robot.lizard().leg, robot.ground().feet);
    let entry = |key: &str, label, twin: &str, value| LinkEntry {
        key: key.to_string(),
        label,
        twin: twin.to_string(),
        unit: if key == "leg.mount" { "deg" } else { "mm" },
        value,
    };
    let [ahead, aside] = HIPS;
    let [front, hind] = feet.hip_side;
    let legs = [
        entry("leg.ground", "leg ground link", "leg.coupler", leg.ground),
        entry("leg.crank", "leg crank", "leg.follower", leg.crank),
        entry("leg.coupler", "leg coupler", "leg.ground", leg.coupler),
        entry("leg.follower", "leg follower", "leg.crank", leg.follower),
        entry(ahead, "hip, fore and aft", ahead, feet.hip_forward),
    ];
    // Hips that follow may be wider in front than behind; then no one number is both.
    let aside = (front == hind).then(|| entry(aside, "hip, sideways", aside, front));
    let mount = entry(
        "leg.mount",
        "outward sweep of the legs",
        "leg.mount",
        feet.mount,
    );
    links.chain(legs).chain(aside).chain([mount]).collect()
}

/// A prediction as the page reads it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Way {
    /// mm in a cycle; none where that is undecided.
    forward: Option<f64>,
    /// mm in a cycle.
    left: Option<f64>,
    /// deg in a cycle.
    turn: Option<f64>,
}

impl From<Travel> for Way {
    fn from(way: Travel) -> Self {
        Self {
            forward: Some(way.forward),
            left: Some(way.left),
            turn: Some(way.turn),
        }
    }
}

impl From<Prediction> for Way {
    fn from(way: Prediction) -> Self {
        let Prediction {
            forward,
            left,
            turn,
        } = way;
        Self {
            forward,
            left,
            turn,
        }
    }
}

impl Way {
    /// mm ahead in a cycle, where that is decided.
    #[must_use]
    pub fn forward(&self) -> Option<f64> {
        self.forward
    }
}

/// What a cycle of a gait comes to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Outlook {
    /// Where it leads.
    #[serde(flatten)]
    pub way: Way,
    /// How far its legs lag at most, deg; none where they are rigid.
    pub lag: Option<f64>,
    /// Its way over that of rigid legs; none where they are rigid, or it gets nowhere with
    /// them.
    pub share: Option<f64>,
}

impl Outlook {
    /// Of a gait on a robot's ground of now, with its servos of now.
    #[must_use]
    pub fn of(twin: &Twin, gait: &CheckedGait) -> Self {
        let outlook = Self::ideal(gait, twin.ground());
        if twin.servos() == ServoModel::IDEAL {
            return outlook;
        }
        let way = outlook.way;
        let went = twin.cycle(gait).travel();
        Self {
            way: Way {
                forward: way.forward.and(Some(went.forward)),
                left: way.left.and(Some(went.left)),
                turn: way.turn.and(Some(went.turn)),
            },
            ..outlook
        }
    }

    /// With servos that are where their pulses say.
    fn ideal(gait: &CheckedGait, ground: &Ground) -> Self {
        match Sprung::of(gait, ground) {
            Some(Sprung { way, lag, share }) => Self {
                way: way.into(),
                lag: Some(lag),
                share,
            },
            None => Self {
                way: gait.predict(ground).into(),
                lag: None,
                share: None,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lengths_twin_has_it_as_its_own_twin() {
        let robot = Robot::parse(include_str!("../../../robots/paper.toml")).expect("right");
        let lengths = Description::of(&robot).lengths;
        for length in &lengths {
            let twin = lengths.iter().find(|other| other.key == length.twin);
            let twin = twin.expect("it is there");
            assert_eq!((&twin.twin, twin.value), (&length.key, length.value));
        }
    }
}
