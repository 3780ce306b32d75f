//! Initial states of a search: every kind of EEPROM contents, each with several activities.

use lizard_core::memory::copies::COPY_ADDRESSES;
use lizard_core::memory::record::Progress;
use lizard_core::memory::restart::Cause;
use lizard_core::memory::settings::Settings;
use lizard_core::numbers::part::Servo;
use lizard_core::numbers::robot::Robot;
use lizard_core::numbers::units::Sweep;
use lizard_core::virtual_board::Eeprom;

use crate::action::Action::{self, Frames, LosePower, Reset, Say, Stall, Supply};
use crate::world::World;

/// An initial state, and the actions that lead to it.
pub struct InitialState {
    /// The EEPROM contents and the boot loader at power-on, in words.
    pub conditions: &'static str,
    /// The actions since power-on.
    pub actions: Vec<Action>,
    /// The initial state itself.
    pub world: World,
}

/// Names of EEPROM contents, each with the actions by which a standing robot writes these contents.
const MEMORIES: [(&str, &[Action]); 5] = [
    ("a blank memory", &[]),
    (
        "saved settings",
        &[
            Say("trim 1 8"),
            Frames(25),
            Say("boot walk"),
            Say("save"),
            Frames(25),
        ],
    ),
    (
        "a saved rest",
        &[
            Say("pose 155 41.41 318.59 221.41"),
            Frames(160),
            Say("rest"),
            Frames(25),
        ],
    ),
    (
        "saved settings and a saved rest",
        &[
            Say("trim 1 8"),
            Frames(25),
            Say("boot rest"),
            Say("save"),
            Frames(25),
            Say("rest"),
            Frames(25),
        ],
    ),
    (
        "a save that was cut off",
        &[
            Say("trim 1 8"),
            Frames(25),
            Say("save"),
            Frames(25),
            Say("trim 1 4"),
            Frames(25),
            Say("save"),
            Frames(2),
            LosePower(Some(0x5a)),
        ],
    ),
];

/// The name of the power-on conditions with a boot loader, which hides the cause of each reset.
const WITH_BOOT_LOADER: &str = "a boot loader and a blank memory";

/// The robot's actions between power-on and the start of the search.
const ACTIVITIES: [&[Action]; 11] = [
    &[],
    &[Frames(160)],
    &[Frames(160), Say("walk"), Frames(25)],
    &[Frames(160), Say("round"), Frames(25)],
    &[Frames(160), Say("patrol"), Frames(5)],
    // The guard holds the robot, since the gait `stray` leaves the safe poses.
    &[Frames(160), Say("stray"), Frames(160)],
    &[Frames(160), Say("rest"), Frames(25)],
    &[Frames(160), Say("trim 1 8"), Frames(25)],
    &[
        Frames(160),
        Say("pose 155 41.41 318.59 221.41"),
        Frames(160),
        Reset(Cause::External),
    ],
    &[Frames(160), Supply(4_100), Frames(5)],
    &[Frames(25), Stall(240), Frames(5)],
];

/// Returns an EEPROM with valid settings that leave servo A3 too little travel for the gaits.
fn short_travel_memory(robot: &Robot) -> Eeprom {
    let mut settings = Settings::of(robot);
    let mut servo_settings = settings.adjustment(Servo::ALL[2]);
    servo_settings.travel_max = Sweep(robot.needed_travel(Servo::ALL[2]).max.0 / 2);
    settings.set_adjustment(Servo::ALL[2], servo_settings);
    let mut memory = Eeprom::blank();
    let mut writing = COPY_ADDRESSES[0].start_write();
    while writing.advance(settings.bytes(), &mut memory) == Progress::InProgress {}
    Eeprom::with_bytes(*memory.bytes())
}

/// Returns every initial state: each EEPROM with each activity that breaks no rule.
///
/// # Panics
/// If an EEPROM's contents cannot be prepared.
pub fn all(robot: Robot<'static>) -> Vec<InitialState> {
    let mut memories: Vec<(&'static str, Eeprom)> = MEMORIES
        .iter()
        .map(|(name, actions)| {
            let mut world = World::power_on(robot, Eeprom::blank());
            // A broken rule is ignored here, since the search reports it, too.
            _ = world.apply(Frames(160));
            for action in *actions {
                _ = world.apply(*action);
            }
            (
                *name,
                Eeprom::with_bytes(*world.running.board.memory.bytes()),
            )
        })
        .collect();
    let saved_memory = |memories: &[(&'static str, Eeprom)]| memories[1].1.clone();
    let mut foreign_memory = saved_memory(&memories);
    foreign_memory.bytes_mut().rotate_left(1);
    let mut worn_memory = saved_memory(&memories);
    worn_memory.is_worn = true;
    memories.extend([
        ("foreign bytes in the memory", foreign_memory),
        ("a worn memory", worn_memory),
        (
            "saved settings that cut the gaits off",
            short_travel_memory(&robot),
        ),
    ]);
    memories.push((WITH_BOOT_LOADER, Eeprom::blank()));
    let mut states = Vec::new();
    for (conditions, memory) in memories {
        for actions in ACTIVITIES {
            let mut world = World::power_on(robot, memory.clone());
            world.running.board.has_boot_loader = conditions == WITH_BOOT_LOADER;
            if actions.iter().all(|action| world.apply(*action).is_ok()) {
                let actions = actions.to_vec();
                states.push(InitialState {
                    conditions,
                    actions,
                    world,
                });
            }
        }
    }
    states
}
