//! The door to JavaScript: a plain C interface.
//!
//! Texts come and go as UTF-8 in this module's own memory. The page asks for room
//! (`lizard_input`), writes there, calls, and reads the answer at `lizard_output`,
//! `lizard_output_length` bytes of JSON; `null` where there is nothing to say. A robot's section is bytes as they are.
//! One page has one robot, so there is one state. wasm-bindgen would do the same with a program of its own, whose
//! version must be the crate's. The names have a prefix because on a host they would
//! replace the C library's `read` and its kin.
#![allow(unsafe_code)] // `no_mangle` needs it; there is no unsafe block here.

use std::cell::RefCell;

use serde::Serialize;

use crate::description::Way;
use crate::floor::Floor;
use crate::page::Page;
use crate::place::Place;

#[derive(Default)]
struct Door {
    page: Page,
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static DOOR: RefCell<Door> = RefCell::default();
}

/// Calls the page with the input as text and writes down its answer.
fn answer<T: Serialize>(call: impl FnOnce(&mut Page, &str) -> T) {
    DOOR.with_borrow_mut(|door| {
        let input = std::mem::take(&mut door.input);
        let said = call(&mut door.page, &String::from_utf8_lossy(&input));
        door.output = serde_json::to_vec(&said).unwrap_or_else(|_| b"null".to_vec());
    });
}

/// Either of two answers, without a word for which it is.
#[derive(Serialize)]
#[serde(untagged)]
enum Either<A, B> {
    Well(A),
    Refused(B),
}

fn either<A, B>(result: Result<A, B>) -> Either<A, B> {
    match result {
        Ok(well) => Either::Well(well),
        Err(refused) => Either::Refused(refused),
    }
}

/// Room for an input of so many bytes.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_input(length: usize) -> *mut u8 {
    DOOR.with_borrow_mut(|door| {
        door.input = vec![0; length];
        door.input.as_mut_ptr()
    })
}

/// Where the last answer is.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_output() -> *const u8 {
    DOOR.with_borrow(|door| door.output.as_ptr())
}

/// How many bytes it has.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_output_length() -> usize {
    DOOR.with_borrow(|door| door.output.len())
}

/// [`Page::read`] of the input.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_read() {
    answer(|page, text| either(page.read(text)));
}

/// [`Page::edit`]: the input is the key, a line feed, and the text of the robot.toml.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_edit(value: f64) {
    answer(|_, input| {
        let (key, text) = input.split_once('\n').unwrap_or((input, ""));
        either(Page::edit(text, key, value))
    });
}

/// [`Page::edit_floor`]: the input is a line as [`Floor::read`] takes it, and then a text.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_edit_floor() {
    answer(|_, input| {
        let (line, text) = input.split_once('\n')?;
        Some(either(Page::edit_floor(text, Floor::read(line)?)))
    });
}

/// [`Page::pulses`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_pulses(a1: u32, a2: u32, a3: u32, a4: u32) {
    answer(|page, _| page.pulses([a1, a2, a3, a4]));
}

/// [`Page::pose`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_pose(a1: f64, a2: f64, a3: f64, a4: f64, frames: u32) {
    answer(|page, _| page.pose([a1, a2, a3, a4], frames));
}

/// [`Page::section`]: the answer is its bytes; none without a robot.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_section() {
    DOOR.with_borrow_mut(|door| door.output = door.page.section().unwrap_or_default());
}

/// [`Page::restart`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_restart() {
    answer(|page, _| page.restart());
}

/// [`Place::way_to`](crate::Place::way_to): x, y and heading of two places.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_way(x0: f64, y0: f64, h0: f64, x1: f64, y1: f64, h1: f64) {
    let place = |x, y, heading| Place { x, y, heading };
    answer(|_, _| Way::from(place(x0, y0, h0).way_to(place(x1, y1, h1))));
}

/// [`Page::set_floor`]: the input is a line as [`Floor::read`] takes it.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_set_floor() {
    answer(|page, line| Floor::read(line).map(|floor| page.set_floor(floor)));
}

/// [`Page::set_servos`]: the input is a name.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_set_servos() {
    answer(|page, name| page.set_servos(name));
}

/// [`Page::predict`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_predict(gait: usize) {
    answer(|page, _| page.predict(gait));
}

/// [`Page::bars`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_bars(gait: usize) {
    answer(|page, _| page.bars(gait));
}

/// [`Bars::turned_round`](crate::Bars::turned_round): the input is the bars as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_turned_round() {
    answer(|_, bars| {
        let bars: crate::Bars = serde_json::from_str(bars).ok()?;
        Some(bars.turned_round())
    });
}

/// [`Bars::put_into`](crate::Bars::put_into): the input is as that of [`Page::trial`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_put_gait() {
    answer(|_, input| {
        let (bars, text) = input.split_once('\n')?;
        let bars: crate::Bars = serde_json::from_str(bars).ok()?;
        Some(bars.put_into(text))
    });
}

/// [`Page::trial`]: the input is the bars as JSON on one line, and then the text of the robot.toml.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_trial() {
    answer(|page, input| {
        let (bars, text) = input.split_once('\n')?;
        page.trial(text, &serde_json::from_str(bars).ok()?)
            .map(either)
    });
}

/// [`Page::trial_drawn`]: the input is the line as JSON on one line, and then the text of the robot.toml.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_trial_drawn() {
    answer(|page, input| {
        let (drawn, text) = input.split_once('\n')?;
        page.trial_drawn(text, &serde_json::from_str(drawn).ok()?)
            .map(either)
    });
}

/// [`Page::put_drawn`]: the input is as that of [`Page::trial_drawn`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_put_drawn() {
    answer(|page, input| {
        let (drawn, text) = input.split_once('\n')?;
        page.put_drawn(text, &serde_json::from_str(drawn).ok()?)
    });
}

/// [`Page::make_faster`]: the input is the wish as JSON on one line, and then the text of the robot.toml.
#[cfg(feature = "tune")]
#[unsafe(no_mangle)]
pub extern "C" fn lizard_faster() {
    answer(|page, input| {
        let (wish, text) = input.split_once('\n')?;
        page.make_faster(text, &serde_json::from_str(wish).ok()?)
            .map(either)
    });
}

/// [`Faster::step`](crate::Faster::step) of the search that was begun.
#[cfg(feature = "tune")]
#[unsafe(no_mangle)]
pub extern "C" fn lizard_faster_step() {
    answer(|page, _| Some(page.faster()?.step()));
}

/// [`Faster::found`](crate::Faster::found) of the search that was begun.
#[cfg(feature = "tune")]
#[unsafe(no_mangle)]
pub extern "C" fn lizard_faster_found(robots: u32) {
    answer(|page, _| page.faster()?.found(robots as usize));
}

/// [`Page::path`]: the input is the line as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_path() {
    answer(|page, drawn| page.path(&serde_json::from_str(drawn).ok()?));
}

/// [`Page::room`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_room(end: usize) {
    answer(|page, _| page.room(end));
}

/// [`Page::map`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_map(end: usize) {
    answer(|page, _| page.map(end));
}

/// [`Page::run_core`].
#[unsafe(no_mangle)]
pub extern "C" fn lizard_run_core() {
    answer(|page, _| page.run_core());
}

/// [`Page::core_frame`]: the input is what came over the serial line.
#[unsafe(no_mangle)]
pub extern "C" fn lizard_core_frame(volts: f64) {
    answer(|page, line| page.core_frame(line.as_bytes(), volts));
}
