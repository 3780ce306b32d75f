//! The guard against floating point over whole squares of crank angles, in
//! steps of a quarter of a degree: head, tail, both sides, and every angle of
//! every leg.

use lizard::clearance::Clearance;
use lizard::hazard::{Check, Kind};
use lizard::pose::Pose;
use lizard::robot::{LEFT, LIMITS, RIGHT, SERVOS};
use lizard::units::angle_from_centideg;
use lizard_host_tests::robot;

use crate::truth::{
    CROSSING_BAND, Conditions, MARGIN_BAND, NAMES, STROKE_BAND, Spread, angles, mm, sine,
};

/// Steps of a quarter of a degree in half a turn.
const STEPS: i32 = 720;

/// What a walk over many poses found, for each of the twelve conditions.
#[derive(Default)]
struct Findings {
    errors: [Spread; 12],
    /// Poses where core and truth decided differently.
    differ: [u32; 12],
    /// The farthest from its limit that any of them was.
    band: [f64; 12],
    /// The farthest from K2 = 0 that one was because of the crossing, mm.
    crossing: f64,
    /// Poses whose whole decision is safe, and unsafe.
    decided: [u32; 2],
}

impl Findings {
    /// Compares the core at a pose with the truth at the angles it was meant
    /// to have.
    fn add(&mut self, pose: &Pose, angles: [f64; 4]) {
        let core = Clearance::of(pose);
        let Some(truth) = Conditions::of(&robot().lizard, angles) else {
            assert!(core.hazard().is_some(), "no such pose: {angles:?}");
            return;
        };
        let clear_by = truth.clear_by();
        let mut safe = true;
        for (place, by) in clear_by.into_iter().enumerate() {
            let (decision, error) = decide(&core, &truth, place);
            safe &= decision;
            if let 2..6 = place
                && error.is_none()
            {
                // Folded couplers have no direction to speak of, and type-2
                // has said no already.
                assert!(core.hazard().is_some_and(|h| h.check.kind() == Kind::Type2));
                continue;
            }
            let crossed = place < 2 && truth.across[place] <= 0.0;
            if let Some(error) = error {
                self.errors[place].add(error);
            }
            if decision != (by >= 0.0 && !crossed) {
                self.differ[place] += 1;
                if place < 2 && by > MARGIN_BAND {
                    self.crossing = self.crossing.max(truth.across[place].abs());
                } else {
                    self.band[place] = self.band[place].max(by.abs());
                }
            }
        }
        assert_eq!(core.hazard().is_none(), safe, "{angles:?}");
        self.decided[usize::from(!safe)] += 1;
    }

    /// Prints all, and holds it to what the guard promises.
    fn report(&self, places: &[usize]) {
        for &place in places {
            let unit = if place < 10 { "" } else { " mm" };
            println!(
                "{:<13}{}{unit}, {} decisions differ, within {:.6}{unit}",
                NAMES[place], self.errors[place], self.differ[place], self.band[place]
            );
            let most = if place < 10 { MARGIN_BAND } else { STROKE_BAND };
            assert!(self.band[place] <= most, "{}", NAMES[place]);
            assert!(self.errors[place].max <= most, "{}", NAMES[place]);
        }
        let [safe, hazards] = self.decided;
        println!(
            "{safe} safe, {hazards} unsafe; crossing within {:.6} mm",
            self.crossing
        );
        assert!(self.crossing <= CROSSING_BAND);
        assert!(
            safe > 50_000 && hazards > 50_000,
            "a square without a limit in it"
        );
    }
}

/// The core's decision on one condition, and its error against the truth, None
/// where the crank tips are so near to each other that the core calls it quits:
/// any limit that robot.toml may set on type-2 lies beyond that.
fn decide(core: &Clearance, truth: &Conditions, place: usize) -> (bool, Option<f64>) {
    let check = Check::at(place as u8);
    if check.kind() == Kind::Stroke {
        let side = place - 10;
        let slider = [LEFT, RIGHT][side];
        let [min_sq, max_sq] = slider.stroke_sq();
        let length_sq = core.sliders_sq[side];
        let travel = mm(slider.travel(length_sq));
        return (
            (min_sq..=max_sq).contains(&length_sq),
            Some(travel - truth.travels[side]),
        );
    }
    let value = core.margins[place];
    // The truth has no sign for crossed cranks, the core does.
    let meant = match place {
        0..2 if truth.across[place].abs() <= CROSSING_BAND => {
            truth.margins[place].copysign(f64::from(value))
        }
        0..2 => truth.margins[place].copysign(truth.across[place]),
        _ => truth.margins[place],
    };
    let tips = match place {
        0 | 2 | 3 => truth.tips[0],
        1 | 4 | 5 => truth.tips[1],
        _ => f64::INFINITY,
    };
    let error = (tips > 5.0).then_some(sine(value) - meant);
    (value >= LIMITS.least(check.kind()), error)
}

/// Walks the square of two servos, 0..180 deg each, those of the tail in
/// tail-local angles; the others stand.
fn square(first: usize, second: usize) -> Findings {
    let mut findings = Findings::default();
    let neutral = robot().servos.map(|servo| servo.neutral);
    for i in 0..=STEPS {
        for j in 0..=STEPS {
            let (mut pose, mut angles) = (Pose::NEUTRAL, neutral);
            for (servo, step) in [(first, i), (second, j)] {
                let centideg = if servo < 2 {
                    25 * step
                } else {
                    36_000 - 25 * step
                };
                pose.0[servo] = SERVOS[servo].sweep_to(angle_from_centideg(centideg));
                angles[servo] = f64::from(centideg) / 100.0;
            }
            findings.add(&pose, angles);
        }
    }
    findings
}

#[test]
fn the_guard_agrees_with_floating_point_over_the_square_of_the_head() {
    square(0, 1).report(&[0, 2, 3, 6, 7]);
}

#[test]
fn the_guard_agrees_with_floating_point_over_the_square_of_the_tail() {
    square(3, 2).report(&[1, 4, 5, 8, 9]);
}

#[test]
fn the_guard_agrees_with_floating_point_over_the_square_of_the_left_side() {
    square(0, 3).report(&[10]);
}

#[test]
fn the_guard_agrees_with_floating_point_over_the_square_of_the_right_side() {
    square(1, 2).report(&[11]);
}

#[test]
fn a_leg_is_measured_right_at_every_angle_and_negative_beyond_a_change_point() {
    for servo in 0..4 {
        let mut spread = Spread::default();
        for sweep in i16::MIN..=i16::MAX {
            let mut pose = Pose::NEUTRAL;
            pose.0[servo] = sweep;
            let outward = [1.0, 1.0, -1.0, -1.0][servo];
            let truth = outward * angles(&pose)[servo].to_radians().sin();
            spread.add(sine(Clearance::of(&pose).margins[6 + servo]) - truth);
        }
        println!("{:<13}{spread}", NAMES[6 + servo]);
        assert!(spread.max <= MARGIN_BAND);
    }
}

#[test]
fn the_head_and_the_tail_are_judged_alike() {
    for i in 0..=STEPS / 4 {
        for j in 0..=STEPS / 4 {
            let [a1, a2] = [i, j].map(|step| angle_from_centideg(100 * step));
            let at = |servo: usize, angle: u16| SERVOS[servo].sweep_to(angle);
            let tail = |angle: u16| angle.wrapping_neg();
            let core = Clearance::of(&Pose([
                at(0, a1),
                at(1, a2),
                at(2, tail(a2)),
                at(3, tail(a1)),
            ]));
            let m = core.margins;
            assert_eq!([m[0], m[2], m[3]], [m[1], m[5], m[4]], "{i} {j}");
        }
    }
}
