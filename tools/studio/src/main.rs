//! Renders a film of a walk whose displacement is known, for the page's tests: FOLDER/film.y4m, which a browser
//! uses as its camera; the same pictures in FOLDER/pictures; and the true displacement per cycle in
//! FOLDER/truth.json.
//!
//! `studio FOLDER WIDTH CYCLES [HIDDEN TAG]...`: the given number of cycles of the paper's `walk`, with a rest before
//! and after.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use fastrand::Rng;
use jpeg_encoder::{ColorType, Encoder};
use lizard_studio::render::Studio;
use lizard_studio::walk::{Variation, Walk, gait, truth};

/// Pictures per second. Chromium keeps a late picture in step if the delay is shorter than the time of one picture,
/// so a low rate stays in step on a busy machine.
const RATE: u32 = 10;
/// The neutral value of the two colour planes of a picture.
const COLOURLESS: u8 = 128;
/// Standard deviations of a cycle's displacement and turn: mm, mm, rad.
const CYCLE: [f64; 3] = [0.1, 0.1, 0.002];
const QUALITY: u8 = 85;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let mut next_word = || {
        arguments
            .next()
            .ok_or("FOLDER WIDTH CYCLES [HIDDEN TAG]...")
    };
    let folder = PathBuf::from(next_word()?);
    let (width, cycles): (usize, usize) = (next_word()?.parse()?, next_word()?.parse()?);
    let rng = &mut Rng::with_seed(4);
    let mut studio = Studio::random(rng);
    (studio.size, studio.focal) = ([width, width * 9 / 16], 0.95);
    (studio.height, studio.tilt, studio.direction) = (800.0, 15.0, 90.0);
    (studio.roll, studio.aim) = (0.0, [0.0; 2]);
    studio.deck = 95.0;
    studio.hidden = arguments.map(|id| id.parse()).collect::<Result<_, _>>()?;
    let gait = gait("walk");
    let truth = truth(&gait);
    let start = -truth.forward * cycles as f64 / 2.0;
    let variation = Variation {
        cycle: CYCLE,
        ..Variation::default()
    };
    let walk = Walk::new(&gait, [start, 0.0, 0.0], cycles, variation, rng);
    let background = studio.background(rng);
    let pictures = folder.join("pictures");
    fs::create_dir_all(&pictures)?;
    let [film_width, film_height] = studio.size;
    let mut film =
        format!("YUV4MPEG2 W{film_width} H{film_height} F{RATE}:1 Ip A1:1 C420jpeg\n").into_bytes();
    for i in 0..(walk.seconds() * f64::from(RATE)) as usize {
        let seconds = i as f64 / f64::from(RATE);
        let picture = background.picture(seconds, |time| walk.at(time), rng);
        let [width, height] = picture.size().map(|length| length as u16);
        let mut jpeg = Vec::new();
        Encoder::new(&mut jpeg, QUALITY).encode(picture.grey(), width, height, ColorType::Luma)?;
        fs::write(pictures.join(format!("{:.4}s.jpg", seconds)), &jpeg)?;
        film.extend(b"FRAME\n");
        film.extend(picture.grey());
        film.resize(film.len() + film_width * film_height / 2, COLOURLESS);
    }
    fs::write(folder.join("film.y4m"), film)?;
    let truth = format!(
        "{{\"forward\":{},\"left\":{},\"turn\":{}}}\n",
        truth.forward, truth.left, truth.turn
    );
    Ok(fs::write(folder.join("truth.json"), truth)?)
}
