//! The interface to JavaScript: one question at a time, as JSON.
//!
//! The page asks for memory (`lizard_input`), writes a [`Question`] there, calls `lizard_ask`, and reads as many bytes of
//! JSON as that returns, at `lizard_output`: `null` if there is no answer, or the question is unknown. A page has one robot,
//! so there is one state. wasm-bindgen would need a program of its own, whose version must be the crate's. The names have a
//! prefix because on a host they would replace the C library's.
#![allow(unsafe_code)] // `no_mangle` needs it; there is no unsafe block here.

use std::cell::RefCell;

use lizard_robot::{Bars, edit};
use serde::{Deserialize, Serialize};
use serde_json::Result;

use crate::drawn::DrawnGait;
#[cfg(feature = "tune")]
use crate::faster::SearchTask;
use crate::floor::Floor;
use crate::lengths::{self, Lengths};
use crate::page::Page;
use crate::place::Place;
use crate::prediction::Movement;
use crate::trial::EditedGait;

/// A question of the page, with its arguments.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Question {
    /// [`Page::read`] of a robot.toml.
    Read(String),
    /// [`Lengths::of`], with the nearest that do where these are refused.
    Lengths(String, Vec<(String, f64)>, bool),
    /// [`lengths::range`].
    LengthRange(String, Vec<String>),
    /// [`Page::edit_floor`].
    EditFloor(String, Floor),
    /// [`Page::pulses`].
    Pulses([u32; 4]),
    /// [`Page::pose`].
    Pose([f64; 4], u32),
    /// [`Page::section`].
    Section,
    /// [`Page::restart`].
    Restart,
    /// [`Place::movement_to`].
    Way(Place, Place),
    /// [`Page::set_floor`].
    SetFloor(Floor),
    /// [`Page::set_servos`].
    SetServos(String),
    /// [`Page::predict`].
    Predict(usize),
    /// [`Page::bars`].
    Bars(usize),
    /// [`Bars::reversed`].
    Reversed(Bars),
    /// [`Page::put_gait`].
    PutGait(String, EditedGait),
    /// [`edit::routines`] of a robot.toml.
    Routines(String),
    /// [`Page::put_steps`].
    PutSteps(String, String, Vec<String>),
    /// [`Page::round`].
    Round(String),
    /// [`Page::trial`].
    Trial(EditedGait),
    /// [`Page::make_faster`].
    #[cfg(feature = "tune")]
    Faster(SearchTask),
    /// [`Faster::step`](crate::Faster::step) of the search that was started.
    #[cfg(feature = "tune")]
    FasterStep,
    /// [`Faster::found`](crate::Faster::found) of the search that was started.
    #[cfg(feature = "tune")]
    FasterFound(usize),
    /// [`Page::path`].
    Path(DrawnGait),
    /// [`Page::reach_area`].
    ReachArea(usize),
    /// [`Page::map`].
    Map(usize),
    /// [`Page::run_core`].
    RunCore,
    /// [`Page::core_frame`], with the bytes of the serial line and the supply in V.
    CoreFrame(String, f64),
}

impl Question {
    fn answer(self, page: &mut Page) -> Result<Vec<u8>> {
        match self {
            Self::Read(toml) => json(either(page.read(&toml))),
            Self::Lengths(toml, wanted, searches) => json(Lengths::of(&toml, &wanted, searches)),
            Self::LengthRange(toml, keys) => json(lengths::range(&toml, &keys)),
            Self::EditFloor(toml, floor) => json(either(Page::edit_floor(&toml, floor))),
            Self::Pulses(widths) => json(page.pulses(widths)),
            Self::Pose(angles, frames) => json(page.pose(angles, frames)),
            Self::Section => json(page.section()),
            Self::Restart => {
                page.restart();
                json(())
            }
            Self::Way(from, to) => json(Movement::from(from.movement_to(to))),
            Self::SetFloor(floor) => {
                page.set_floor(floor);
                json(())
            }
            Self::SetServos(name) => {
                page.set_servos(&name);
                json(())
            }
            Self::Predict(gait) => json(page.predict(gait)),
            Self::Bars(gait) => json(page.bars(gait)),
            Self::Reversed(bars) => json(bars.reversed()),
            Self::PutGait(toml, made) => json(page.put_gait(&toml, &made)),
            Self::Routines(text) => json(edit::routines(&text)),
            Self::PutSteps(text, name, steps) => json(Page::put_steps(&text, &name, &steps)),
            Self::Round(routine) => json(page.round(&routine)),
            Self::Trial(made) => json(page.trial(&made).map(either)),
            #[cfg(feature = "tune")]
            Self::Faster(wish) => json(page.make_faster(&wish).map(either)),
            #[cfg(feature = "tune")]
            Self::FasterStep => json(page.faster().map(|search| search.step())),
            #[cfg(feature = "tune")]
            Self::FasterFound(robots) => {
                json(page.faster().and_then(|search| search.found(robots)))
            }
            Self::Path(drawn) => json(page.path(&drawn)),
            Self::ReachArea(end) => json(page.reach_area(end)),
            Self::Map(end) => json(page.map(end)),
            Self::RunCore => {
                page.run_core();
                json(())
            }
            Self::CoreFrame(line, volts) => json(page.core_frame(line.as_bytes(), volts)),
        }
    }
}

/// Answers a question as JSON.
fn answer(page: &mut Page, question: &[u8]) -> Vec<u8> {
    serde_json::from_slice(question)
        .and_then(|question: Question| question.answer(page))
        .unwrap_or_else(|_| b"null".to_vec())
}

fn json(answer: impl Serialize) -> Result<Vec<u8>> {
    serde_json::to_vec(&answer)
}

/// One of two answers, whose keys tell them apart.
#[derive(Serialize)]
#[serde(untagged)]
enum Either<A, B> {
    Accepted(A),
    Refused(B),
}

fn either<A, B>(result: std::result::Result<A, B>) -> Either<A, B> {
    match result {
        Ok(accepted) => Either::Accepted(accepted),
        Err(refused) => Either::Refused(refused),
    }
}

#[derive(Default)]
struct Interface {
    page: Page,
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static INTERFACE: RefCell<Interface> = RefCell::default();
}

/// Reserves memory for a question of this length and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_input(length: usize) -> *mut u8 {
    INTERFACE.with_borrow_mut(|state| {
        state.input = vec![0; length];
        state.input.as_mut_ptr()
    })
}

/// Answers the question and returns the length of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_ask() -> usize {
    INTERFACE.with_borrow_mut(|state| {
        let input = std::mem::take(&mut state.input);
        state.output = answer(&mut state.page, &input);
        state.output.len()
    })
}

/// The address of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_output() -> *const u8 {
    INTERFACE.with_borrow(|state| state.output.as_ptr())
}

#[cfg(test)]
mod tests {
    use lizard_robot::Robot;

    use super::*;

    const PAPER: &str = include_str!("../../../robots/paper.toml");

    #[test]
    fn an_unknown_question_is_answered_by_null_and_changes_nothing() {
        let mut page = Page::default();
        let mut ask = |question: &str| {
            let answer = answer(&mut page, question.as_bytes());
            String::from_utf8(answer).expect("JSON")
        };
        let read = serde_json::json!({ "read": PAPER }).to_string();
        assert!(ask(&read).contains("\"name\":\"paper\""));
        let first = ask(r#"{"predict":1}"#);
        assert_ne!(first, "null");
        let floor = Floor::of(&Robot::parse(PAPER).expect("right"));
        let floor = serde_json::json!({ "set_floor": floor }).to_string();
        let slippery = floor.replace("\"ratio\":1.0", "\"ratio\":0.5");
        let soft = slippery.replace("rigid", "soft");
        let short = slippery.replace("\"twist\"", "\"turn\"");
        for wrong in [
            "",
            "{}",
            r#"{"eat":1}"#,
            r#"{"pulses":[1,2,3]}"#,
            &soft,
            &short,
        ] {
            assert_eq!(ask(wrong), "null", "{wrong}");
        }
        assert_eq!(ask(r#"{"predict":1}"#), first);
        ask(&slippery);
        assert_ne!(ask(r#"{"predict":1}"#), first, "{slippery}");
    }
}
