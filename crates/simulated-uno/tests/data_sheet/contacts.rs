//! Tests that a pin with a contact to ground behaves as in the data sheet, sections 14.2.1 and 14.2.4.

use super::*;

/// A program that enables the pull-ups of D4, D8 and A1 by writes to PIND, PINB and PINC (data sheet, 14.2.2), and then
/// repeatedly writes the levels of the three pins to GPIOR0 as bits 0, 1 and 2.
const LEVELS_PROGRAM: &str = "
#include <avr/io.h>
int main(void) {
    PIND = 1 << 4; PINB = 1 << 0; PINC = 1 << 1;
    for (;;) {
        unsigned char levels = 0;
        if (PIND & 1 << 4) levels |= 1;
        if (PINB & 1 << 0) levels |= 2;
        if (PINC & 1 << 1) levels |= 4;
        GPIOR0 = levels;
    }
}";

#[test]
fn a_pin_is_low_while_its_contact_is_closed_and_high_otherwise() {
    let image = compile_c(LEVELS_PROGRAM);
    let pins = [Pin::d(4), Pin::d(8), Pin::a(1)];
    for fidelity in FIDELITIES {
        let mut uno = Uno::with_image(image.clone(), fidelity);
        let read_levels = |uno: &mut Uno, closed_contacts: u8| {
            for (bit, pin) in pins.into_iter().enumerate() {
                uno.set_contact(pin, closed_contacts & 1 << bit != 0);
            }
            uno.run_cycles(1_000);
            mark_values(uno).last().copied()
        };
        for _ in 0..2 {
            for closed_contacts in [0, 1, 2, 4, 7, 3, 0, 5] {
                let levels = read_levels(&mut uno, closed_contacts);
                assert_eq!(levels, Some(7 & !closed_contacts), "{fidelity:?}");
            }
            uno.reset();
        }
    }
}
