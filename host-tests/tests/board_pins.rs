//! The firmware's table of pins, compiled here, against the pins of the chip.

#[path = "../../src/board/pulses/pin.rs"]
mod pin;

/// What the data sheet calls the pins of the UNO's sockets D2 to D12 and A0 to A5,
/// from the UNO's circuit diagram.
const SOCKETS: [(u8, char, u8); 17] = [
    (2, 'D', 2),
    (3, 'D', 3),
    (4, 'D', 4),
    (5, 'D', 5),
    (6, 'D', 6),
    (7, 'D', 7),
    (8, 'B', 0),
    (9, 'B', 1),
    (10, 'B', 2),
    (11, 'B', 3),
    (12, 'B', 4),
    (14, 'C', 0),
    (15, 'C', 1),
    (16, 'C', 2),
    (17, 'C', 3),
    (18, 'C', 4),
    (19, 'C', 5),
];

#[test]
fn every_pin_has_the_port_and_the_bit_of_the_circuit_diagram() {
    for (number, port, bit) in SOCKETS {
        let pin = pin::Pin::arduino(number);
        // Data sheet, 30 Register Summary: PORTB 0x25, PORTC 0x28, PORTD 0x2B.
        let address = match port {
            'B' => 0x25,
            'C' => 0x28,
            _ => 0x2b,
        };
        assert_eq!((pin.port, pin.mask), (address, 1 << bit), "pin {number}");
    }
}

#[test]
fn the_serial_line_and_the_led_are_no_servo_pins() {
    for number in [0, 1, 13, 20, 255] {
        assert!(std::panic::catch_unwind(|| pin::Pin::arduino(number)).is_err());
    }
}
