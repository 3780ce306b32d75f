//! What the robot does when something happens: one table.
//!
//! A person sends a command, the supply falls, the line breaks, the program hangs, and
//! any two of these may happen in the same frame. So one table has the consequence of
//! every event in every state, and the code that acts looks it up here. docs/faults.md
//! prints the same tables.

use crate::control::fault::Fault;
use crate::control::supply::Level;
use crate::memory::restart::Cause;

/// What the robot is doing, as far as this matters here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// There are no pulses.
    Resting,
    /// It stands, holds a pose or moves to one.
    Still,
    /// A gait other than `stand` is under way, or is what the robot goes over to.
    Walking,
}

/// What happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Somebody sends `stand`.
    Stand,
    /// Somebody sends another motion.
    Move,
    /// `stop`.
    Stop,
    /// `rest`.
    Rest,
    /// `save`.
    Save,
    /// Three seconds have passed since the start, no byte has come and nothing is wrong.
    Boot,
    /// No line has come for as long as `deadman` says.
    Silence,
    /// The supply has become too low to move.
    TooLow,
    /// The supply has become too low to hold a pose.
    Empty,
    /// An edge of a pulse came late.
    LateEdge,
    /// The stack has reached the data.
    Stack,
    /// The next pose would not be safe.
    Unsafe,
}

/// What follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Response {
    /// Nothing.
    Nothing,
    /// What was asked for.
    Obey,
    /// It is refused, because the servos rest.
    RefuseResting,
    /// It is refused, because the supply is too low.
    RefuseSupply,
    /// The pose is frozen, if there is one, and the fault shown until a command orders
    /// a motion.
    Freeze(Fault),
    /// The pulses end, and the fault is shown until a command moves the robot.
    EndPulses(Fault),
}

impl State {
    /// All of them, as the columns of the table.
    pub const ALL: [Self; 3] = [Self::Resting, Self::Still, Self::Walking];
}

impl Event {
    /// All of them, as the rows of the table.
    pub const ALL: [Self; 12] = [
        Self::Stand,
        Self::Move,
        Self::Stop,
        Self::Rest,
        Self::Save,
        Self::Boot,
        Self::Silence,
        Self::TooLow,
        Self::Empty,
        Self::LateEdge,
        Self::Stack,
        Self::Unsafe,
    ];
}

/// The table: what follows an event, by the level of the supply, if it has been
/// measured yet, and by the state.
#[rustfmt::skip]
pub const fn response(event: Event, supply: Option<Level>, state: State) -> Response {
    use Event::{Boot, Empty, LateEdge, Move, Rest, Save, Silence, Stack, Stand, Stop, TooLow, Unsafe};
    use Response::{EndPulses, Freeze, Nothing, Obey, RefuseResting, RefuseSupply};
    let enough_to_move = matches!(supply, None | Some(Level::Good | Level::Slow));
    // Before it has been measured, writing waits for that.
    let enough_to_write = matches!(supply, None | Some(Level::Good));
    let [resting, still, walking] = match event {
        // what happens              resting                  still                    walking
        Stand if enough_to_move  => [Obey,                    Obey,                    Obey],
        Stand                    => [RefuseSupply,            RefuseSupply,            RefuseSupply],
        Move if enough_to_move   => [RefuseResting,           Obey,                    Obey],
        Move                     => [RefuseResting,           RefuseSupply,            RefuseSupply],
        Stop                     => [RefuseResting,           Obey,                    Obey],
        Rest                     => [Nothing,                 Obey,                    Obey],
        Save if enough_to_write  => [Obey,                    Obey,                    Obey],
        Save                     => [RefuseSupply,            RefuseSupply,            RefuseSupply],
        Boot if enough_to_move   => [Obey,                    Obey,                    Obey],
        Boot                     => [Nothing,                 Nothing,                 Nothing],
        Silence                  => [Nothing,                 Nothing,                 Freeze(Fault::Link)],
        TooLow                   => [Freeze(Fault::Supply),   Freeze(Fault::Supply),   Freeze(Fault::Supply)],
        Empty                    => [EndPulses(Fault::Supply), EndPulses(Fault::Supply), EndPulses(Fault::Supply)],
        LateEdge                 => [Freeze(Fault::Late),     Freeze(Fault::Late),     Freeze(Fault::Late)],
        Stack                    => [Freeze(Fault::Stack),    Freeze(Fault::Stack),    Freeze(Fault::Stack)],
        Unsafe                   => [Nothing,                 Freeze(Fault::Guard),    Freeze(Fault::Guard)],
    };
    match state {
        State::Resting => resting,
        State::Still => still,
        State::Walking => walking,
    }
}

/// So many restarts in a row that a weak supply may have made, and the robot rests:
/// servos that wake would pull the supply down again.
pub const BROWN_OUTS: u8 = 3;

/// What the program before this one did with the servos.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Before {
    /// Nothing, or nothing is known of it.
    Nothing,
    /// It sent no pulses.
    Rested,
    /// It held them.
    Held,
}

/// How the robot begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beginning {
    /// The servos wake one after the other in the pose of the last `rest`, if the
    /// memory holds one, or else in the neutral one; then the robot stands.
    Wake,
    /// They wake one after the other with the pulses that they had; then it stands.
    TakeOver,
    /// They are held with the pulses that they had, all at once.
    Hold,
    /// There are no pulses.
    Rest,
}

impl Before {
    /// All of them, as the columns of the table.
    pub const ALL: [Self; 3] = [Self::Nothing, Self::Rested, Self::Held];
}

/// The table of restarts: how the robot begins, and the fault that is shown, by the
/// cause, by the restarts in a row that a weak supply may have made, and by what the
/// program before did.
#[rustfmt::skip]
pub const fn beginning(cause: Cause, brown_outs: u8, before: Before) -> (Beginning, Option<Fault>) {
    use Beginning::{Hold, Rest, TakeOver, Wake};
    let too_many = brown_outs >= BROWN_OUTS;
    let ([nothing, rested, held], fault) = match cause {
        // cause                                   nothing  rested  held
        Cause::Power                           => ([Wake,   Wake,   Wake],     None),
        Cause::Watchdog                        => ([Rest,   Rest,   Hold],     Some(Fault::Watchdog)),
        Cause::External | Cause::BrownOut
            if too_many                        => ([Rest,   Rest,   Rest],     Some(Fault::BrownOut)),
        Cause::External | Cause::BrownOut      => ([Wake,   Rest,   TakeOver], None),
    };
    let beginning = match before {
        Before::Nothing => nothing,
        Before::Rested => rested,
        Before::Held => held,
    };
    (beginning, fault)
}

#[cfg(test)]
mod tests;
