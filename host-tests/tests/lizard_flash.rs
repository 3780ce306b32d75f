//! `lizard flash`, as a person runs it: the program writes a board by its boot loader. The
//! board is simulated, its boot loader is the real one of a stock UNO or of an old Nano, and time
//! is real.
//!
//! `make flash-test` runs these tests after it has compiled program and boot loader.

mod desk;
mod shell;

use std::sync::LazyLock;

use desk::{BOOT, Desk, boot_loader, loader};
use lizard_core::section::START;
use lizard_host::firmware::named;
use lizard_host::sim::frame::servo_pins;
use lizard_host_tests::{avr_gcc, robot, root};
use lizard_robot::Robot;
use lizard_time_limit::LIMIT;
use shell::Shell;
use simulated_uno::{Fidelity, Image, Port, Uno};

/// Another program, which never stops talking at the boot loader's speed.
static TALKER: LazyLock<Image> = LazyLock::new(|| {
    avr_gcc::c(
        r#"
        #include <avr/io.h>
        #include <util/delay.h>
        int main(void) {
            UCSR0A = 1 << U2X0;
            UCSR0B = 1 << TXEN0;
            UBRR0L = 16;
            for (;;) {
                UDR0 = 0x14;
                _delay_ms(1);
            }
        }
    "#,
    )
});

/// Flash of a board that has the firmware inside the program with a robot and nothing else.
fn firmware_of(robot: &Robot) -> Vec<u8> {
    let image = lizard_host::firmware::inside(robot);
    let uno = Uno::with_image(image, Fidelity::DataSheet);
    uno.flash()[..BOOT].to_vec()
}

/// The same with the robot under test.
fn firmware() -> Vec<u8> {
    firmware_of(robot())
}

/// Another robot than the one under test, by the name under which the program has it.
fn another() -> (&'static str, Robot) {
    let name = match robot().name() {
        "large" => "unequal",
        _ => "large",
    };
    let file = root().join("robots").join(name).with_extension("toml");
    (name, Robot::load(&file).expect("it is right"))
}

/// `lizard flash` at the desk's port.
fn lizard_flash(desk: &Desk, arguments: &[&str]) -> Shell {
    let lizard = std::env::var("LIZARD").expect("`make flash-test` compiles the program");
    let name = desk.name();
    let arguments = [&["flash", name.as_str()], arguments].concat();
    Shell::start(&lizard, &arguments, &[])
}

/// The cable is pulled and put into another port.
fn unplug(desk: &mut Desk) {
    desk.port = Port::new().expect("a pseudo terminal");
}

/// Lets the board live until the program has ended. Returns the screen.
fn end(desk: &mut Desk, shell: &Shell) -> String {
    let ended = desk.until(|_| shell.has_ended());
    let screen = shell.screen();
    assert!(ended, "waited {LIMIT} for the end of the upload:\n{screen}");
    shell.last_screen()
}

/// Addresses below the boot loader where the board's flash is not that of the firmware.
fn differences(desk: &Desk) -> Vec<usize> {
    let firmware = firmware();
    (0..BOOT)
        .filter(|&at| desk.uno.flash()[at] != firmware[at])
        .collect()
}

fn assert_written(desk: &Desk) {
    let wrong = differences(desk);
    assert!(
        wrong.is_empty(),
        "flash differs from the image at {wrong:x?}"
    );
    let new = Uno::with_boot_loader(boot_loader(), Fidelity::DataSheet);
    assert!(
        desk.uno.flash()[BOOT..] == new.flash()[BOOT..],
        "the boot loader is whole"
    );
}

/// A board that has the firmware, as if it had been written.
fn with_firmware() -> Desk {
    let mut desk = Desk::with_a_new_board();
    desk.uno.set_flash(0, &firmware());
    desk
}

#[test]
fn a_blank_board_is_written_and_its_robot_says_what_it_is() {
    let mut desk = Desk::with_a_new_board();
    let shell = lizard_flash(&desk, &[]);
    let screen = end(&mut desk, &shell);
    assert!(screen.contains("the board has no program\n"), "{screen}");
    assert!(
        screen.contains("bytes written and verified, 0 were right"),
        "{screen}"
    );
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert_written(&desk);
}

#[test]
fn a_board_whose_program_never_stops_talking_is_written_and_keeps_its_eeprom() {
    let mut desk = Desk::with_a_new_board();
    let talker = TALKER.flash();
    desk.uno.set_flash(0, &talker);
    let kept: [u8; 1024] = std::array::from_fn(|at| (at * 7 + at / 256) as u8);
    desk.uno.set_eeprom(&kept);
    let shell = lizard_flash(&desk, &[]);
    // Before the firmware may write a byte of its own.
    desk.see(&shell, "written and verified");
    assert!(
        desk.uno.eeprom() == kept,
        "the upload has changed the EEPROM"
    );
    let screen = end(&mut desk, &shell);
    let found = format!("the board has another program, of {} bytes\n", talker.len());
    assert!(screen.contains(&found), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert_written(&desk);
}

#[test]
fn a_board_that_has_the_image_is_left_as_it_is() {
    let mut desk = with_firmware();
    let shell = lizard_flash(&desk, &[]);
    let screen = end(&mut desk, &shell);
    assert!(
        screen.contains(&format!("robot {} already", named(robot().firmware()))),
        "{screen}"
    );
    assert!(screen.contains("nothing to write: all"), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert_written(&desk);
}

#[test]
fn one_page_that_differs_is_written_alone() {
    let mut desk = with_firmware();
    let old = desk.uno.flash()[0x2005];
    desk.uno.set_flash(0x2005, &[old ^ 0x10]);
    let shell = lizard_flash(&desk, &[]);
    let screen = end(&mut desk, &shell);
    assert!(
        screen.contains("the board has another build of lizard"),
        "{screen}"
    );
    // It, and the page where the chip starts.
    assert!(
        screen.contains("\n256 bytes written and verified"),
        "{screen}"
    );
    assert_written(&desk);
}

#[test]
fn a_board_unplugged_in_the_middle_does_nothing_until_it_is_written_again() {
    let mut desk = Desk::with_a_new_board();
    desk.uno.set_flash(0, &TALKER.flash());
    let shell = lizard_flash(&desk, &[]);
    // Some pages of the new code are there.
    let half = desk.until(|uno| uno.flash()[0x1000] != 0xff || shell.has_ended());
    let screen = shell.screen();
    assert!(
        half && !shell.has_ended(),
        "the upload has begun:\n{screen}"
    );
    unplug(&mut desk);
    let screen = end(&mut desk, &shell);
    assert!(screen.contains("the port is gone"), "{screen}");
    assert!(
        screen.contains("half a program now, and does nothing"),
        "{screen}"
    );
    assert!(!differences(&desk).is_empty());

    // Plugged in again: power, then nobody who calls.
    desk.uno.power_cycle();
    desk.uno.take_transmitted();
    desk.uno.take_edges();
    desk.uno.run_ms(3000);
    assert!(desk.uno.transmitted().is_empty(), "it says nothing");
    let edges = desk.uno.take_edges();
    assert!(edges.is_empty(), "no pin moves: {edges:?}");
    // These seconds were none on the wall, which a port goes by.
    unplug(&mut desk);

    let shell = lizard_flash(&desk, &[]);
    let screen = end(&mut desk, &shell);
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert_written(&desk);
}

#[test]
fn a_board_whose_button_is_pressed_in_the_middle_is_called_again_and_written() {
    let mut desk = Desk::with_a_new_board();
    let shell = lizard_flash(&desk, &[]);
    let half = desk.until(|uno| uno.flash()[0x1000] != 0xff || shell.has_ended());
    let screen = shell.screen();
    assert!(
        half && !shell.has_ended(),
        "the upload has begun:\n{screen}"
    );
    desk.uno.reset();
    let screen = end(&mut desk, &shell);
    assert!(screen.contains("all begins again"), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert_written(&desk);
}

#[test]
fn a_byte_that_changes_after_it_was_written_is_written_again() {
    let mut desk = Desk::with_a_new_board();
    let shell = lizard_flash(&desk, &[]);
    let mut changed = false;
    let ended = desk.until(|uno| {
        // Long before it is read back.
        if !changed && uno.flash()[0x280] != 0xff {
            uno.set_flash(0x211, &[uno.flash()[0x211] ^ 0x10]);
            changed = true;
        }
        shell.has_ended()
    });
    let screen = shell.last_screen();
    assert!(ended, "waited {LIMIT} for the end of the upload:\n{screen}");
    assert!(changed, "nothing was written:\n{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert_written(&desk);
}

#[test]
fn a_board_without_a_boot_loader_that_answers_is_explained() {
    let mut desk = Desk::with_a_new_board();
    // A boot loader that does nothing: `rjmp .-2`.
    desk.uno.set_flash(BOOT as u16, &[0xff, 0xcf]);
    let shell = lizard_flash(&desk, &[]);
    let screen = end(&mut desk, &shell);
    assert!(
        screen.contains("no boot loader answers. Is it a UNO or a Nano?"),
        "{screen}"
    );
    assert!(desk.uno.flash()[..BOOT].iter().all(|&byte| byte == 0xff));
}

/// What the board says in the next milliseconds, which are none on the wall.
fn says(desk: &mut Desk, line: &str, ms: u64) -> String {
    desk.uno.take_transmitted();
    desk.uno.send(line.as_bytes());
    desk.uno.run_ms(ms);
    let bytes = desk.uno.take_transmitted();
    let bytes: Vec<u8> = bytes.iter().map(|byte| byte.byte).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn a_robot_alone_is_written_behind_the_firmware_and_the_trims_are_kept() {
    let (name, other) = another();
    let mut desk = with_firmware();
    desk.uno.power_cycle();
    assert!(says(&mut desk, "", 2500).contains("# lizard "));
    assert!(says(&mut desk, "trim 1 3.5\n", 200).contains("ok"));
    assert!(says(&mut desk, "save\n", 500).contains("ok"));
    unplug(&mut desk);
    let kept = desk.uno.eeprom();

    let shell = lizard_flash(&desk, &["--only-robot", "--robot", name]);
    desk.see(&shell, "written and verified");
    assert!(
        desk.uno.eeprom() == kept,
        "the upload has changed the EEPROM"
    );
    let screen = end(&mut desk, &shell);
    let [its, now] = [robot(), &other].map(|robot| named(robot.firmware()));
    assert!(screen.contains(&format!(" robot {its}\n")), "{screen}");
    let banner = screen.lines().find(|line| line.starts_with("# lizard "));
    assert!(
        banner.is_some_and(|line| line.contains(&format!(" robot {now}"))),
        "{screen}"
    );
    let end = usize::from(START) + other.section().len();
    assert!(desk.uno.flash()[..end] == firmware_of(&other)[..end]);

    // And the first robot again: its trims are there as they were.
    let shell = lizard_flash(&desk, &["--only-robot"]);
    self::end(&mut desk, &shell);
    assert!(desk.uno.eeprom() == kept);
    let answer = says(&mut desk, "cal\n", 500);
    assert!(answer.contains("3.5"), "{answer}");
}

#[test]
fn a_board_unplugged_while_a_robot_is_written_has_no_robot_and_is_mended() {
    let (name, other) = another();
    let mut desk = with_firmware();
    let words = ["--only-robot", "--robot", name];
    let shell = lizard_flash(&desk, &words);
    let section = other.section();
    // The third page of the robot is there.
    let half = desk.until(|uno| {
        let there = uno.flash()[0x6b00..0x6b80] == section[0x100..0x180];
        there || shell.has_ended()
    });
    assert!(half && !shell.has_ended(), "{}", shell.screen());
    unplug(&mut desk);
    let screen = end(&mut desk, &shell);
    assert!(screen.contains("the port is gone"), "{screen}");
    assert!(screen.contains("half a robot now"), "{screen}");

    // Plugged in again: the firmware says so, and no servo moves.
    desk.uno.power_cycle();
    desk.uno.take_edges();
    let said = says(&mut desk, "", 2500);
    assert!(said.contains("no robot in the flash"), "{said}");
    let said = says(&mut desk, "walk\n", 300);
    assert!(said.contains("err "), "{said}");
    assert!(says(&mut desk, "status\n", 300).contains("fault=robot"));
    let edges = desk.uno.take_edges();
    let pins = servo_pins(&other);
    assert!(
        !edges.iter().any(|edge| pins.contains(&edge.pin)),
        "{edges:?}"
    );
    unplug(&mut desk);

    let shell = lizard_flash(&desk, &words);
    let screen = end(&mut desk, &shell);
    assert!(screen.contains(" without a robot\n"), "{screen}");
    assert!(
        screen.contains(&format!(" robot {}", named(other.firmware()))),
        "{screen}"
    );
    let end = usize::from(START) + section.len();
    assert!(desk.uno.flash()[..end] == firmware_of(&other)[..end]);
}

#[test]
fn a_robot_alone_is_not_written_behind_another_program() {
    let mut desk = with_firmware();
    // As avrdude leaves it: only the pages of the sketch are others.
    desk.uno.set_flash(0, &TALKER.flash());
    let before = desk.uno.flash().to_vec();
    let shell = lizard_flash(&desk, &["--only-robot"]);
    let screen = end(&mut desk, &shell);
    assert!(screen.contains("the board has another program"), "{screen}");
    assert!(screen.contains("Nothing was written"), "{screen}");
    assert!(desk.uno.flash() == before);
}

#[test]
fn avrdude_writes_the_robot_that_lizard_image_has_made() {
    let (name, other) = another();
    let mut desk = with_firmware();
    let folder = tempfile::tempdir().expect("a folder");
    let hex = folder.path().join("robot.hex").display().to_string();
    let lizard = std::env::var("LIZARD").expect("`make flash-test` compiles the program");
    let words = ["image", "--only-robot", "--robot", name, "--output", &hex];
    let shell = Shell::start(&lizard, &words, &[]);
    end(&mut desk, &shell);
    let write = format!("flash:w:{hex}:i");
    let port = desk.name();
    let options = ["-D", "-c", "arduino", "-p", "atmega328p", "-b", "115200"];
    let words = [&options[..], &["-P", &port, "-U", &write]].concat();
    let shell = Shell::start("avrdude", &words, &[]);
    let screen = end(&mut desk, &shell);
    assert!(screen.contains("bytes of flash verified"), "{screen}");
    let end = usize::from(START) + other.section().len();
    assert!(desk.uno.flash()[..end] == firmware_of(&other)[..end]);
}

/// First byte of an old Nano's boot loader.
const NANO_BOOT: usize = 0x7800;

/// A Nano as it was sold until 2018: its boot loader talks at 57 600 baud.
fn old_nano() -> Desk {
    Desk::with(loader("old-nano.hex"))
}

#[test]
fn an_old_nano_is_found_at_its_own_speed_written_and_started() {
    let mut desk = old_nano();
    let before = desk.uno.flash().to_vec();
    let shell = lizard_flash(&desk, &["--robot", "large"]);
    let screen = end(&mut desk, &shell);
    assert!(
        screen.contains("no answer at 115200 baud; calling again at 57600 baud"),
        "{screen}"
    );
    assert!(screen.contains("the board has no program\n"), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    assert!(screen.contains(" robot large "), "{screen}");
    let large = Robot::load(root().join("robots/large.toml")).expect("it is right");
    assert!(desk.uno.flash()[..NANO_BOOT] == firmware_of(&large)[..NANO_BOOT]);
    assert!(desk.uno.flash()[NANO_BOOT..] == before[NANO_BOOT..]);

    // Another robot alone: the loader resets the chip by itself at no time.
    let shell = lizard_flash(&desk, &["--only-robot", "--robot", "paper"]);
    let screen = end(&mut desk, &shell);
    assert!(screen.contains("robot large "), "{screen}");
    assert!(screen.contains("\n# lizard "), "{screen}");
    let paper = Robot::load(root().join("robots/paper.toml")).expect("it is right");
    assert!(desk.uno.flash()[..NANO_BOOT] == firmware_of(&paper)[..NANO_BOOT]);
}

#[test]
fn a_robot_that_does_not_fit_an_old_nano_is_refused_and_its_boot_loader_is_whole() {
    let mut desk = old_nano();
    let before = desk.uno.flash().to_vec();
    let shell = lizard_flash(&desk, &["--robot", "own-gaits"]);
    let screen = end(&mut desk, &shell);
    assert!(
        screen.contains("a Nano has 30720 before its boot section"),
        "{screen}"
    );
    assert!(desk.uno.flash() == before);
}

#[test]
fn after_a_hang_an_old_nano_moves_no_servo_until_its_power_is_cut() {
    let mut desk = old_nano();
    desk.uno.set_flash(0, &firmware()[..NANO_BOOT]);
    desk.uno.run_ms(2500);
    let text = |uno: &mut Uno| -> String {
        let bytes = uno.take_transmitted();
        bytes.iter().map(|byte| char::from(byte.byte)).collect()
    };
    let said = text(&mut desk.uno);
    assert!(said.contains("# lizard "), "{said}");
    desk.uno.send(b"stand\n");
    desk.uno.run_ms(500);
    text(&mut desk.uno);
    desk.uno.stall_main(1000 * simulated_uno::CYCLES_PER_MS);
    desk.uno.run_ms(400);
    desk.uno.take_edges();
    // Its loader leaves the watchdog on, which resets the chip again before the loader's end: the
    // RESET pin does not clear WDRF, and with it WDE stays set (data sheet, 11.9.2).
    desk.uno.reset();
    let resets = desk.uno.resets();
    desk.uno.run_ms(3000);
    let again = desk.uno.resets() - resets;
    assert!(
        (150..200).contains(&again),
        "{again}: one every 16 ms or so"
    );
    assert_eq!(text(&mut desk.uno), "");
    let pins = servo_pins(robot());
    let edges = desk.uno.take_edges();
    assert!(!edges.iter().any(|edge| pins.contains(&edge.pin)));
    desk.uno.power_cycle();
    desk.uno.run_ms(2500);
    let said = text(&mut desk.uno);
    assert!(said.contains("# lizard "), "{said}");
}
