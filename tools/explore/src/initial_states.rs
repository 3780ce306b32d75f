//! Initial states of a search: several EEPROM contents (memories), each combined with several activities.

use lizard_core::memory::copies::COPY_ADDRESSES;
use lizard_core::memory::record::Progress;
use lizard_core::memory::restart::Cause;
use lizard_core::memory::settings::Settings;
use lizard_core::numbers::part::Servo;
use lizard_core::numbers::robot::Robot;
use lizard_core::numbers::units::Sweep;
use lizard_core::virtual_board::Eeprom;

use crate::action::Action::{self, Frames, Line, PowerLoss, Reset, Stall, SupplyMv};
use crate::small_robot::straying_robot;
use crate::world::World;

/// An initial state, and the actions that lead to it.
pub struct InitialState {
    /// A description of the memory and the boot loader at power-on.
    pub conditions: &'static str,
    /// The actions since power-on.
    pub actions: Vec<Action>,
    /// The initial state itself.
    pub world: World,
}

/// Names of memories, each with the actions that make a standing robot write this memory.
const PREPARED_MEMORIES: [(&str, &[Action]); 5] = [
    ("a blank memory", &[]),
    (
        "saved settings",
        &[
            Line("trim 1 8"),
            Frames(25),
            Line("boot walk"),
            Line("save"),
            Frames(25),
        ],
    ),
    (
        "a saved rest pose",
        &[
            Line("pose 155 41.41 318.59 221.41"),
            Frames(160),
            Line("rest"),
            Frames(25),
        ],
    ),
    (
        "saved settings and a saved rest pose",
        &[
            Line("trim 1 8"),
            Frames(25),
            Line("boot rest"),
            Line("save"),
            Frames(25),
            Line("rest"),
            Frames(25),
        ],
    ),
    (
        "a save interrupted by a power loss",
        &[
            Line("trim 1 8"),
            Frames(25),
            Line("save"),
            Frames(25),
            Line("trim 1 4"),
            Frames(25),
            Line("save"),
            Frames(2),
            PowerLoss(Some(0x5a)),
        ],
    ),
];

/// The description of power-on with a boot loader, which hides the cause of each reset.
const BOOT_LOADER_CONDITIONS: &str = "a boot loader and a blank memory";

/// The description of power-on with the [`straying_robot`], which the guard holds before any line arrives.
const STRAYING_CONDITIONS: &str = "saved settings and a `stand` that leaves the safe poses";

/// Sequences of actions between power-on and the start of the search.
const ACTIVITIES: [&[Action]; 11] = [
    &[],
    &[Frames(160)],
    &[Frames(160), Line("walk"), Frames(25)],
    &[Frames(160), Line("round"), Frames(25)],
    &[Frames(160), Line("patrol"), Frames(5)],
    // The gait `stray` leaves the safe poses, so the guard holds the robot.
    &[Frames(160), Line("stray"), Frames(160)],
    &[Frames(160), Line("rest"), Frames(25)],
    &[Frames(160), Line("trim 1 8"), Frames(25)],
    &[
        Frames(160),
        Line("pose 155 41.41 318.59 221.41"),
        Frames(160),
        Reset(Cause::External),
    ],
    &[Frames(160), SupplyMv(4_100), Frames(5)],
    &[Frames(25), Stall(240), Frames(5)],
];

/// Returns an EEPROM with valid settings in which servo A3 has too little travel for the gaits.
fn build_short_travel_memory(robot: &Robot) -> Eeprom {
    let mut settings = Settings::for_robot(robot);
    let mut adjustment = settings.adjustment(Servo::ALL[2]);
    adjustment.travel_max = Sweep(robot.needed_travel(Servo::ALL[2]).max.0 / 2);
    settings.set_adjustment(Servo::ALL[2], adjustment);
    let mut memory = Eeprom::blank();
    let mut write = COPY_ADDRESSES[0].start_write();
    while write.advance(settings.bytes(), &mut memory) == Progress::InProgress {}
    Eeprom::with_bytes(*memory.bytes())
}

/// Returns all initial states of a robot: each memory with each activity. Also includes the [`straying_robot`]
/// with each activity. Leaves out a combination that violates a rule.
pub fn prepare_all(robot: Robot<'static>) -> Vec<InitialState> {
    let mut memories: Vec<(&'static str, Eeprom)> = PREPARED_MEMORIES
        .iter()
        .map(|(name, actions)| {
            let mut world = World::power_on(robot, Eeprom::blank());
            _ = world.apply(Frames(160));
            for action in *actions {
                _ = world.apply(*action);
            }
            let memory = &world.running_robot.board.memory;
            (*name, Eeprom::with_bytes(*memory.bytes()))
        })
        .collect();
    let (_, saved_memory) = memories[1].clone();
    let mut foreign_memory = saved_memory.clone();
    foreign_memory.bytes_mut().rotate_left(1);
    let mut worn_memory = saved_memory.clone();
    worn_memory.is_worn = true;
    let short_travel_conditions = "saved settings with too little travel for the gaits";
    memories.extend([
        ("foreign bytes in the memory", foreign_memory),
        ("a worn memory", worn_memory),
        (short_travel_conditions, build_short_travel_memory(&robot)),
        (BOOT_LOADER_CONDITIONS, Eeprom::blank()),
        (STRAYING_CONDITIONS, saved_memory),
    ]);
    let mut states = Vec::new();
    for (conditions, memory) in memories {
        let is_straying = conditions == STRAYING_CONDITIONS;
        let robot = if is_straying { straying_robot() } else { robot };
        for actions in ACTIVITIES {
            let mut world = World::power_on(robot, memory.clone());
            world.running_robot.board.has_boot_loader = conditions == BOOT_LOADER_CONDITIONS;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::small_robot::small_robot;

    #[test]
    fn no_initial_state_violates_a_rule() {
        let memory_count = PREPARED_MEMORIES.len() + 5;
        let states = prepare_all(small_robot());
        assert_eq!(states.len(), memory_count * ACTIVITIES.len());
    }
}
