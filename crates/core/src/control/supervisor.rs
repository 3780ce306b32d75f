//! The supervisor: a table of the responses to every event in every state, and a table of the first actions after every
//! reset.
//!
//! A user sends a command, the supply falls, the link breaks, the program hangs: any two of these events may occur in
//! the same frame. Therefore one table contains all responses, and all other code looks them up there. docs/faults.md
//! shows both tables.

use crate::control::fault::Fault;
use crate::control::supply::Level;
use crate::memory::restart::Cause;

/// The state of the robot on which the responses depend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The servos get no pulses.
    Resting,
    /// The robot stands, holds a pose or moves to a pose.
    Posing,
    /// The robot is in a gait other than `stand`, changes to such a gait, or runs a routine, even while the routine
    /// stands or rests.
    Walking,
}

/// An event to which the supervisor responds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The command `stand`.
    Stand,
    /// A command that starts a routine or a gait other than `stand`, or a move to a pose.
    Move,
    /// The command `stop`.
    Stop,
    /// The command `rest`.
    Rest,
    /// The command `save`.
    Save,
    /// The time of `boot` has come: the program has run for three seconds without a received byte or a fault.
    BootDue,
    /// No command has been received within the `deadman` time.
    Silence,
    /// The supply has become too low to move.
    SupplyTooLowToMove,
    /// The supply has become too low to hold a pose.
    SupplyTooLowToHold,
    /// A pulse edge was late.
    LateEdge,
    /// The stack has grown into the data.
    StackOverflow,
    /// The next pose would be unsafe.
    UnsafePose,
}

/// The supervisor's response to an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Response {
    /// Do nothing.
    Nothing,
    /// Execute the command.
    Obey,
    /// Refuse the command, because the servos rest.
    RefuseResting,
    /// Refuse the command, because the supply is too low.
    RefuseSupply,
    /// Freeze the pose if there are pulses, and show the fault until the next motion command.
    Freeze(Fault),
    /// End the pulses, and show the fault until the next motion command.
    EndPulses(Fault),
}

impl State {
    /// All states, in the order of the columns of the table of events.
    pub const ALL: [Self; 3] = [Self::Resting, Self::Posing, Self::Walking];
}

impl Event {
    /// All events, in the order of the rows of the table of events.
    pub const ALL: [Self; 12] = [
        Self::Stand,
        Self::Move,
        Self::Stop,
        Self::Rest,
        Self::Save,
        Self::BootDue,
        Self::Silence,
        Self::SupplyTooLowToMove,
        Self::SupplyTooLowToHold,
        Self::LateEdge,
        Self::StackOverflow,
        Self::UnsafePose,
    ];
}

/// The table of events: the response to an event in a state of the robot. `supply` is the level of the supply, or
/// `None` before the supply has been measured.
#[rustfmt::skip]
pub const fn response(event: Event, supply: Option<Level>, state: State) -> Response {
    use Event::{BootDue, LateEdge, Move, Rest, Save, Silence, StackOverflow, Stand, Stop, UnsafePose};
    use Event::{SupplyTooLowToHold, SupplyTooLowToMove};
    use Response::{EndPulses, Freeze, Nothing, Obey, RefuseResting, RefuseSupply};
    let can_move = matches!(supply, None | Some(Level::Good | Level::Slow));
    // Before the first measurement `save` is accepted, but the write waits for the measurement.
    let can_write = matches!(supply, None | Some(Level::Good));
    let [resting, posing, walking] = match event {
        // event                     resting                  posing                   walking
        Stand if can_move        => [Obey,                    Obey,                    Obey],
        Stand                    => [RefuseSupply,            RefuseSupply,            RefuseSupply],
        Move if can_move         => [RefuseResting,           Obey,                    Obey],
        Move                     => [RefuseResting,           RefuseSupply,            RefuseSupply],
        Stop                     => [RefuseResting,           Obey,                    Obey],
        Rest                     => [Nothing,                 Obey,                    Obey],
        Save if can_write        => [Obey,                    Obey,                    Obey],
        Save                     => [RefuseSupply,            RefuseSupply,            RefuseSupply],
        BootDue if can_move      => [Obey,                    Obey,                    Obey],
        BootDue                  => [Nothing,                 Nothing,                 Nothing],
        Silence                  => [Nothing,                 Nothing,                 Freeze(Fault::Link)],
        SupplyTooLowToMove       => [Freeze(Fault::Supply),   Freeze(Fault::Supply),   Freeze(Fault::Supply)],
        SupplyTooLowToHold       => [EndPulses(Fault::Supply), EndPulses(Fault::Supply), EndPulses(Fault::Supply)],
        LateEdge                 => [Freeze(Fault::LateEdge), Freeze(Fault::LateEdge), Freeze(Fault::LateEdge)],
        StackOverflow            => [Freeze(Fault::Stack),    Freeze(Fault::Stack),    Freeze(Fault::Stack)],
        UnsafePose               => [Nothing,                 Freeze(Fault::Guard),    Freeze(Fault::Guard)],
    };
    match state {
        State::Resting => resting,
        State::Posing => posing,
        State::Walking => walking,
    }
}

/// The number of consecutive suspected brown-outs after which the robot rests, because waking servos would pull the
/// supply down again.
pub const BROWN_OUTS_TO_REST: u8 = 3;

/// The state of the servos before a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServosBefore {
    /// The state is unknown.
    Unknown,
    /// The servos got no pulses.
    Rested,
    /// The servos were held by pulses.
    Held,
}

/// The robot's first action after a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirstAction {
    /// The servos wake one after another, in the rest pose if the EEPROM holds one, otherwise in the neutral pose; then
    /// the robot stands.
    Wake,
    /// The servos wake one after another with their pulses from before the reset; then the robot stands.
    WakeInPlace,
    /// All servos are held immediately with their pulses from before the reset.
    Hold,
    /// The servos get no pulses.
    Rest,
}

impl ServosBefore {
    /// All values, in the order of the columns of the table of resets.
    pub const ALL: [Self; 3] = [Self::Unknown, Self::Rested, Self::Held];
}

/// The table of resets: the first action after a reset, and the fault to show. `suspected_brown_outs` is the number of
/// consecutive resets that a weak supply may have caused.
#[rustfmt::skip]
pub const fn first_action(
    cause: Cause, suspected_brown_outs: u8, servos_before: ServosBefore,
) -> (FirstAction, Option<Fault>) {
    use FirstAction::{Hold, Rest, WakeInPlace, Wake};
    let must_rest = suspected_brown_outs >= BROWN_OUTS_TO_REST;
    let ([unknown, rested, held], fault) = match cause {
        // cause                                   unknown  rested  held
        Cause::Power                           => ([Wake,   Wake,   Wake],     None),
        Cause::Watchdog                        => ([Rest,   Rest,   Hold],     Some(Fault::Watchdog)),
        Cause::External | Cause::BrownOut
            if must_rest                       => ([Rest,   Rest,   Rest],     Some(Fault::BrownOut)),
        Cause::External | Cause::BrownOut      => ([Wake,   Rest,   WakeInPlace], None),
    };
    let action = match servos_before {
        ServosBefore::Unknown => unknown,
        ServosBefore::Rested => rested,
        ServosBefore::Held => held,
    };
    (action, fault)
}

#[cfg(test)]
mod tests;
