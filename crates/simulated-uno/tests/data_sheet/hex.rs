//! Tests of Intel HEX images, compared with the ELF of the same program and with handwritten lines.

use super::*;

/// Formats a line of Intel HEX as avr-objcopy does: `:`, length, address, type, bytes, checksum.
fn format_line(address: u16, record_type: u8, bytes: &[u8]) -> String {
    let [high, low] = address.to_be_bytes();
    let mut all_bytes = vec![bytes.len() as u8, high, low, record_type];
    all_bytes.extend(bytes);
    let add = |sum: u8, byte: &u8| sum.wrapping_add(*byte);
    all_bytes.push(all_bytes.iter().fold(0u8, add).wrapping_neg());
    let digits: String = all_bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    format!(":{digits}\r\n")
}

const END_LINE: &str = ":00000001FF\n";

#[test]
fn hex_and_elf_images_of_a_program_give_the_same_edges() {
    let elf = compile_c(
        "#include <avr/io.h>
        #include <util/delay.h>
        int main(void) { DDRB = 0x20;
            for (;;) { PORTB = 0x20; _delay_us(100); PORTB = 0; _delay_us(300); } }",
    );
    let flash = elf.flash();
    let chunks = flash.chunks(16).enumerate();
    let lines = chunks.map(|(n, bytes)| format_line(16 * n as u16, 0, bytes));
    let text = lines.collect::<String>() + END_LINE;
    let hex = Image::parse_hex(&text).expect("the text is Intel HEX");
    assert_eq!(hex.flash(), flash);
    assert_eq!((hex.static_ram(), hex.symbols().len()), (0, 0));
    let run_for_edges = |image| {
        let uno = uno_after_ms(10, image);
        assert!(uno.pulses(LED).len() > 20);
        uno.edges()
    };
    assert_eq!(run_for_edges(hex), run_for_edges(elf));
}

#[test]
fn a_file_that_begins_with_a_colon_is_read_as_hex() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let file = folder.path().join("loop.hex");
    let text = format_line(0, 0, &[0xff, 0xcf]) + END_LINE;
    std::fs::write(&file, text).expect("the file can be written");
    let image = Image::read(&file).expect("the text is Intel HEX");
    assert_eq!(image.flash(), [0xff, 0xcf]);
}

#[test]
fn addresses_of_more_than_16_bits_and_gaps_are_supported() {
    let text = [
        format_line(0x0010, 0, &[1]),
        format_line(0, 2, &[0x01, 0x00]),
        format_line(0x0002, 0, &[2]),
        format_line(0, 4, &[0, 0]),
        format_line(0x7fff, 0, &[3]),
        END_LINE.to_owned(),
    ];
    let image = Image::parse_hex(&text.concat()).expect("the text is Intel HEX");
    let flash = image.flash();
    assert_eq!(flash.len(), 0x8000);
    assert_eq!((flash[0x0010], flash[0x1002], flash[0x7fff]), (1, 2, 3));
    assert_eq!((flash[0], image.flash_used()), (0xff, 3));
}

#[test]
fn each_error_in_a_hex_file_is_reported() {
    let good_line = format_line(0, 0, &[0xff, 0xcf]);
    for (text, expected) in [
        (
            good_line.replace("FFCF", "FFCE") + END_LINE,
            "line 1 is not Intel HEX: ",
        ),
        (good_line.clone() + "blink\n", "line 2 is not Intel HEX: "),
        (
            good_line,
            "the HEX file has no end record, so it is incomplete",
        ),
        (END_LINE.to_owned(), "the file contains no code"),
        (
            format_line(0x7fff, 0, &[1, 2]) + END_LINE,
            "2 bytes at 0x7fff do not fit an ATmega328P",
        ),
        (
            format_line(0, 4, &[0xff, 0xff]) + &format_line(0xffff, 0, &[1]) + END_LINE,
            "1 bytes at 0xffffffff do not fit an ATmega328P",
        ),
    ] {
        let error = Image::parse_hex(&text).expect_err("the text is not an image");
        assert!(error.to_string().starts_with(expected), "{error}: {text}");
    }
}
