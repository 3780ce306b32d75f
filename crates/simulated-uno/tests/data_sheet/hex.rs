//! Tests of images as Intel HEX, against the same program as ELF and against lines written by hand.

use simulated_uno::Image;
use simulated_uno::avr_gcc::c;

use super::{LED, after_ms};

/// Formats a line of Intel HEX as avr-objcopy does: `:`, length, address, type, bytes, checksum.
fn line(address: u16, kind: u8, bytes: &[u8]) -> String {
    let [high, low] = address.to_be_bytes();
    let mut all = vec![bytes.len() as u8, high, low, kind];
    all.extend(bytes);
    let sum = all.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    all.push(sum.wrapping_neg());
    let digits: String = all.iter().map(|byte| format!("{byte:02X}")).collect();
    format!(":{digits}\r\n")
}

const END: &str = ":00000001FF\n";

#[test]
fn a_program_as_hex_does_what_it_does_as_elf() {
    let elf = c("#include <avr/io.h>
        #include <util/delay.h>
        int main(void) { DDRB = 0x20;
            for (;;) { PORTB = 0x20; _delay_us(100); PORTB = 0; _delay_us(300); } }");
    let flash = elf.flash();
    let lines = flash.chunks(16).enumerate();
    let mut text: String = lines
        .map(|(n, bytes)| line(16 * n as u16, 0, bytes))
        .collect();
    text += END;
    let hex = Image::parse_hex(&text).expect("it is Intel HEX");
    assert_eq!(hex.flash(), flash);
    assert_eq!((hex.static_ram(), hex.symbols().len()), (0, 0));
    let edges = |image| {
        let uno = after_ms(10, image);
        assert!(uno.pulses(LED).len() > 20);
        uno.edges()
    };
    assert_eq!(edges(hex), edges(elf));
}

#[test]
fn a_file_that_begins_with_a_colon_is_read_as_hex() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("loop.hex");
    let text = line(0, 0, &[0xff, 0xcf]) + END;
    std::fs::write(&file, text).expect("it is written");
    let image = Image::read(&file).expect("it is Intel HEX");
    assert_eq!(image.flash(), [0xff, 0xcf]);
}

#[test]
fn addresses_of_more_than_16_bits_and_gaps_are_understood() {
    let text = [
        line(0x0010, 0, &[1]),
        line(0, 2, &[0x01, 0x00]),
        line(0x0002, 0, &[2]),
        line(0, 4, &[0, 0]),
        line(0x7fff, 0, &[3]),
        END.to_owned(),
    ];
    let image = Image::parse_hex(&text.concat()).expect("it is Intel HEX");
    let flash = image.flash();
    assert_eq!(flash.len(), 0x8000);
    assert_eq!((flash[0x0010], flash[0x1002], flash[0x7fff]), (1, 2, 3));
    assert_eq!((flash[0], image.flash_used()), (0xff, 3));
}

#[test]
fn hex_that_is_wrong_is_refused_with_the_line() {
    let good = line(0, 0, &[0xff, 0xcf]);
    for (text, error) in [
        (
            good.replace("FFCF", "FFCE") + END,
            "line 1 is not Intel HEX: ",
        ),
        (good.clone() + "blink\n", "line 2 is not Intel HEX: "),
        (
            good,
            "the HEX file has no end record: only a part of it is there",
        ),
        (END.to_owned(), "the file holds no code"),
        (
            line(0x7fff, 0, &[1, 2]) + END,
            "2 bytes at 0x7fff do not fit an ATmega328P",
        ),
        (
            line(0, 4, &[0xff, 0xff]) + &line(0xffff, 0, &[1]) + END,
            "1 bytes at 0xffffffff do not fit an ATmega328P",
        ),
    ] {
        let refusal = Image::parse_hex(&text).expect_err("it is not an image");
        assert!(refusal.to_string().starts_with(error), "{refusal}: {text}");
    }
}
