//! How well films of a robot whose path is known are measured.

use fastrand::Rng;
use lizard_film::{Film, Gait, Measured, Setup, Trouble};

use crate::render::Studio;
use crate::walk::{Varies, Walk, gait, truth};

/// Setup of a sheet in true size.
pub const TRUE_SIZE: Setup = Setup {
    scale: 1.0,
    height: 83.0,
};

/// Films a walk.
pub fn film(studio: &Studio, walk: &Walk, rate: f64, rng: &mut Rng) -> Film {
    let now = std::time::Instant::now();
    let background = studio.background(rng);
    println!("background {:?}", now.elapsed());
    let (mut r, mut a) = (0.0, 0.0);
    let mut film = Film::default();
    for i in 0..(walk.seconds() * rate) as usize {
        let seconds = i as f64 / rate;
        let now = std::time::Instant::now();
        let picture = background.picture(seconds, |time| walk.at(time), rng);
        r += now.elapsed().as_secs_f64();
        let now = std::time::Instant::now();
        film.add(seconds, &picture).expect("a picture");
        a += now.elapsed().as_secs_f64();
    }
    println!("render {r} add {a}");
    film
}

/// Films some cycles with a random camera, and measures them.
fn measured(
    gait: &Gait,
    cycles: usize,
    varies: Varies,
    rng: &mut Rng,
) -> Result<Measured, Trouble> {
    let studio = Studio::random(rng);
    let way = truth(gait).forward * cycles as f64;
    let heading = rng.f64() * 0.4 - 0.2;
    let start = [-way / 2.0, 0.0, heading];
    let walk = Walk::new(gait, start, cycles, varies, rng);
    film(&studio, &walk, 30.0, rng).measure(TRUE_SIZE, gait)
}

#[test]
fn a_cycle_is_measured_to_a_fifth_of_a_millimetre_and_half_a_degree() {
    let mut rng = Rng::with_seed(1);
    let gait = gait("walk");
    let now = std::time::Instant::now();
    let measured = measured(&gait, 5, Varies::default(), &mut rng).expect("it is measured");
    println!("{:?}", now.elapsed());
    println!(
        "{:?}\n{:?}\n{:?}\n{:?}",
        truth(&gait),
        measured.forward,
        measured.left,
        measured.turn
    );
    println!("{:?} {:?}", measured.sight, measured.period);
    println!("{:?}", measured.cycles);
}
