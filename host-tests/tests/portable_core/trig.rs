//! The quarter wave in flash against the sine, at every angle there is.

use lizard::trig::Direction;

use crate::truth::{Spread, degrees, sine};

#[test]
fn sine_and_cosine_are_within_their_stated_error_at_every_angle() {
    let (mut sines, mut cosines, mut lengths) =
        (Spread::default(), Spread::default(), Spread::default());
    for angle in 0..=u16::MAX {
        let direction = Direction::of(angle);
        let (sin, cos) = degrees(angle).to_radians().sin_cos();
        sines.add(sine(direction.sin) - sin);
        cosines.add(sine(direction.cos) - cos);
        lengths.add(sine(direction.sin).hypot(sine(direction.cos)) - 1.0);
    }
    println!("sin {sines}; cos {cosines}; length {lengths}");
    assert!(sines.max <= 4.5e-5 && cosines.max <= 4.5e-5);
    assert!(lengths.max <= 6e-5);
}

#[test]
fn the_four_right_angles_are_exact() {
    let one = i16::MAX;
    for (angle, sin, cos) in [
        (0, 0, one),
        (0x4000, one, 0),
        (0x8000, 0, -one),
        (0xc000, -one, 0),
    ] {
        assert_eq!(Direction::of(angle), Direction { sin, cos });
    }
}

#[test]
fn the_quadrants_are_images_of_each_other_to_the_bit() {
    for angle in 0..=u16::MAX {
        let here = Direction::of(angle);
        let quarter_on = Direction::of(angle.wrapping_add(0x4000));
        assert_eq!((quarter_on.cos, quarter_on.sin), (-here.sin, here.cos));
        let mirrored = Direction::of(0x8000u16.wrapping_sub(angle));
        assert_eq!(here.mirrored(), mirrored);
        assert_eq!(here.tail_local(), Direction::of(angle.wrapping_neg()));
    }
}
