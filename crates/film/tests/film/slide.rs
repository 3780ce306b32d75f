//! How well films of a robot that slides down a tilted board are measured.

use std::f64::consts::PI;

use fastrand::Rng;
use lizard_film::{Figure, Film, Setup, Slide, SlideTrouble, Watched};

use crate::render::Studio;

const SETUP: Setup = Setup {
    scale: 1.0,
    height: 83.0,
};
/// Acceleration of free fall, mm/s^2, and step of the simulation, s.
const GRAVITY: f64 = 9806.65;
const STEP: f64 = 0.0005;
/// Place at which a hand stops the robot, mm down from where it stood.
const STOPPED: f64 = 110.0;

/// A board that is lifted, and the robot on it.
#[derive(Clone, Copy)]
struct Board {
    resting: f64,
    sliding: f64,
    /// deg/s, from a time on, s.
    lift: f64,
    from: f64,
    /// Tilt at the beginning and at the end, deg.
    begin: f64,
    end: f64,
    /// Direction of the head from the way down, deg.
    head: f64,
    /// Direction of the slide from the way down, deg.
    aside: f64,
}

const BOARD: Board = Board {
    resting: 0.75,
    sliding: 0.68,
    lift: 6.0,
    from: 1.2,
    begin: 0.0,
    end: 50.0,
    head: 0.0,
    aside: 0.0,
};

impl Board {
    /// The board's tilt at a time, deg.
    fn tilt(&self, seconds: f64) -> f64 {
        (self.begin + self.lift * (seconds - self.from).max(0.0)).min(self.end)
    }

    /// The robot's way down, mm, each [`STEP`] seconds for a time in seconds.
    fn ways(&self, seconds: f64) -> Vec<f64> {
        let (mut way, mut speed) = (0.0, 0.0);
        let step = |i: usize| {
            let (sin, cos) = self.tilt(i as f64 * STEP).to_radians().sin_cos();
            let friction = if speed > 0.0 {
                self.sliding
            } else {
                self.resting
            };
            speed = f64::max(0.0, speed + GRAVITY * (sin - friction * cos) * STEP);
            way = f64::min(STOPPED, way + speed * STEP);
            way
        };
        (0..(seconds / STEP) as usize).map(step).collect()
    }

    /// Films the board: many pictures only around the slide.
    fn film(&self, studio: &Studio, rate: f64) -> Film {
        let mut rng = Rng::with_seed(11);
        let length = self.from + (self.end.min(45.0) - self.begin) / self.lift + 0.5;
        let ways = self.ways(length);
        let way = |seconds: f64| ways[((seconds.max(0.0) / STEP) as usize).min(ways.len() - 1)];
        let mut film = Film::default();
        let mut seconds = 0.0;
        while seconds < length && way(seconds - 0.1) < STOPPED {
            let mut here = studio.clone();
            here.board = self.tilt(seconds);
            // The way down is to the left in the scene.
            let heading = PI + self.head.to_radians();
            let (sin, cos) = (PI + self.aside.to_radians()).sin_cos();
            let robot = |time: f64| [55.0 + way(time) * cos, 5.0 + way(time) * sin, heading];
            let picture = here.background(&mut rng).picture(seconds, robot, &mut rng);
            film.add(seconds, &picture).expect("a picture");
            seconds += if way(seconds + 0.25) > 0.5 {
                1.0 / rate
            } else {
                0.2
            };
        }
        film
    }

    fn slide(&self) -> Result<Slide, SlideTrouble> {
        Slide::of(&watched(&self.film(&studio(), 30.0)))
    }
}

fn watched(film: &Film) -> Watched {
    film.watch(SETUP).expect("it is watched")
}

/// A studio with few pixels, which the sheet fills.
fn studio() -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(5));
    (studio.size, studio.focal) = ([640, 480], 0.85);
    (studio.height, studio.tilt, studio.direction) = (850.0, 12.0, 90.0);
    (studio.roll, studio.aim) = (0.0, [0.0; 2]);
    // A robot that lies askew needs more room.
    studio.strips = [[5.0, -180.0, 0.03], [-5.0, 180.0, PI - 0.02]];
    studio.shutter = 1.0 / 250.0;
    studio
}

/// Checks a figure against its truth, and its error against the largest useful one.
fn check(figure: Figure, truth: f64, largest: f64) {
    println!("{figure:?}, truth {truth:.3}");
    assert!(
        (figure.value - truth).abs() < 2.0 * figure.error,
        "{figure:?} {truth}"
    );
    assert!(figure.error < largest, "{figure:?}");
}

#[test]
fn a_slide_shows_resting_and_sliding_friction_with_head_or_tail_first() {
    for (head, resting, sliding) in [(8.0, 0.75, 0.68), (-175.0, 0.5, 0.5)] {
        let board = Board {
            resting,
            sliding,
            head,
            ..BOARD
        };
        let slide = board.slide().expect("it slides");
        assert_eq!(slide.is_ahead, head == 8.0);
        check(slide.tilt, resting.atan().to_degrees(), 0.6);
        check(slide.resting, resting, 0.02);
        check(slide.sliding, sliding, 0.02);
    }
}

/// A board with little friction: its film is short.
const SLIPPERY: Board = Board {
    resting: 0.35,
    sliding: 0.3,
    lift: 8.0,
    end: 30.0,
    ..BOARD
};

#[test]
fn what_is_no_slide_down_a_board_is_named() {
    let reason = |board: Board| board.slide().expect_err("it is not measured");
    let not_slid = reason(Board {
        end: 12.0,
        ..SLIPPERY
    });
    assert!(
        matches!(not_slid, SlideTrouble::NotSlid { tilt, .. } if (tilt - 12.0).abs() < 1.0),
        "{not_slid}"
    );
    let moving = reason(Board {
        from: 0.3,
        ..SLIPPERY
    });
    assert!(matches!(moving, SlideTrouble::NotAtRest { .. }), "{moving}");
    let across = reason(Board {
        head: 36.0,
        ..SLIPPERY
    });
    assert!(
        matches!(across, SlideTrouble::Across { aside } if (aside - 36.0).abs() < 3.0),
        "{across}"
    );
    let pushed = reason(Board {
        aside: 180.0,
        ..SLIPPERY
    });
    assert!(
        matches!(pushed, SlideTrouble::NotDown { aside } if aside > 170.0),
        "{pushed}"
    );
    let fast = reason(Board {
        lift: 40.0,
        ..SLIPPERY
    });
    assert!(
        matches!(fast, SlideTrouble::Fast { rate } if rate > 20.0),
        "{fast}"
    );
    let film = SLIPPERY.film(&studio(), 5.0);
    let few = Slide::of(&watched(&film));
    assert!(
        matches!(few, Err(SlideTrouble::FewPictures { .. })),
        "{few:?}"
    );
}
