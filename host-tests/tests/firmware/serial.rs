//! Tests of the serial line: no byte is lost while the sender waits for answers, and bytes lost in a flood are counted.

use fastrand::Rng;
use lizard_host_tests::FirmwareBench;
use simulated_uno::Fidelity;

use crate::baud_rate::GARBLED_ANSWER;
use crate::{
    Status, boot_to_stand, end_flood, expect_answer, first_moving_gait, pose_command,
    run_in_both_simulations, start_in_both_simulations,
};

/// Returns the number of answers since power-on.
fn count_answers(bench: &mut FirmwareBench) -> usize {
    bench.lines().iter().filter(|line| line.is_answer()).count()
}

#[test]
fn a_sender_that_waits_for_answers_loses_nothing_at_full_line_rate() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        let mut rng = Rng::with_seed(7);
        expect_answer(&mut bench, "watch 1", "ok ");
        let padded_line = format!("status{}", " ".repeat(57));
        let (gait, pose) = (first_moving_gait(), pose_command([0.0; 4]));
        let lines = [
            "status",
            "help",
            &gait,
            "stop",
            "speed 70",
            &pose,
            &padded_line,
        ];
        for _ in 0..600 {
            expect_answer(&mut bench, lines[rng.usize(..lines.len())], "ok ");
        }
        expect_answer(&mut bench, "watch 0", "ok ");
        Status::read(&mut bench).assert_has("rx_lost=0 late=0");
        assert_eq!(bench.uno.overrun_count(), 0);
    });
}

#[test]
fn the_longest_line_waits_in_the_buffer_while_an_answer_is_being_sent() {
    // Sends the longest line directly after the command with the longest answer, without waiting.
    start_in_both_simulations(boot_to_stand, |mut bench| {
        let line_count = bench.lines().len();
        bench.uno.send(b"help\n");
        let line = format!("stand{}\n", " ".repeat(57));
        bench.uno.send(line.as_bytes());
        bench.run_ms(300);
        assert_eq!(bench.last_text(), "ok stand");
        assert!(bench.lines().len() > line_count + 2);
        assert_eq!(Status::read(&mut bench).number("rx_lost"), 0.0);
    });
}

#[test]
fn a_long_answer_takes_less_than_2000_cycles_a_byte() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        expect_answer(&mut bench, "stand", "ok ");
        let bytes_before = bench.bytes().len();
        expect_answer(&mut bench, "help", "ok ");
        let bytes = &bench.bytes()[bytes_before..];
        let byte_count = bytes.len();
        assert!(byte_count > 200, "{byte_count} bytes");
        let duration_cycles = bytes[byte_count - 1].cycle - bytes[0].cycle;
        // A byte takes 1360 cycles, in stock simavr 1496. Frames and the composition of each line take additional time.
        let cycles_per_byte = duration_cycles / byte_count as u64;
        assert!(cycles_per_byte < 2_000, "{cycles_per_byte} cycles per byte");
    });
}

#[test]
fn bytes_lost_in_a_flood_are_counted() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_to_stand(fidelity);
        let (bytes_before, lines_before) = (bench.uno.received_by_uno().len(), bench.lines().len());
        bench.uno.flood(b"a\n");
        bench.run_ms(5000);
        end_flood(&mut bench);
        let received_count = (bench.uno.received_by_uno().len() - bytes_before) as f64;
        let answer_count = (bench.lines().len() - lines_before) as f64;
        let lost_count = Status::read(&mut bench).number("rx_lost");
        println!(
            "{fidelity:?}: {received_count} received, {lost_count} lost, {answer_count} answers"
        );
        assert!(answer_count > 1000.0 && lost_count > received_count / 2.0);
        // Each answer belongs to a line of at least two bytes, and lost bytes make lines only a little longer.
        let read_count = received_count - lost_count;
        let is_plausible = (2.0 * answer_count..4.0 * answer_count).contains(&read_count);
        assert!(is_plausible, "{read_count} read, {answer_count} answers");
        // After a flood, the buffer contains no bytes from the flood.
        expect_answer(&mut bench, &first_moving_gait(), "ok ");
        assert_eq!(Status::read(&mut bench).number("rx_lost"), lost_count);
    });
}

#[test]
fn a_burst_that_overruns_the_buffer_is_counted_to_the_byte() {
    // While the answer to `help` is sent, the main loop reads nothing: 64 bytes fit into the buffer, and the rest is
    // lost.
    start_in_both_simulations(boot_to_stand, |mut bench| {
        bench.uno.send(b"help\n");
        bench.run_ms(3);
        bench.uno.send(&[b' '; 150]);
        bench.run_ms(300);
        bench.uno.send(b"\n");
        bench.run_ms(100);
        assert_eq!(Status::read(&mut bench).number("rx_lost"), 150.0 - 64.0);
    });
}

#[test]
fn bytes_kept_in_an_overrun_arrive_once_and_in_order() {
    // The receiver has room for two bytes and the byte being received. The answer shows which of the five digits
    // arrived.
    let byte_cycles = 1_400;
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let (mut lost_before, mut overrun_count) = (0.0, 0);
    for round in 0..40u64 {
        let overruns_before = bench.uno.overrun_count();
        bench.uno.send(b"watch ");
        bench.run_ms(2);
        bench.uno.send(b"01234");
        bench.uno.run_cycles(byte_cycles / 2 + round * 37);
        bench.uno.block_interrupts(5 * byte_cycles);
        bench.run_ms(3);
        let answer = bench.say("");
        let digits = answer.strip_prefix("ok watch ").expect(&answer);
        // The first byte may still arrive, depending on the time at which the main loop disables interrupts.
        let was_lost = bench.uno.overrun_count() > overruns_before;
        assert_eq!(digits.len() < 5, was_lost, "{round}: {answer}");
        overrun_count += usize::from(was_lost);
        let mut sent_digits = b"01234".iter();
        let was_sent_next = |digit| sent_digits.any(|sent_digit| *sent_digit == digit);
        let is_in_order = digits.bytes().all(was_sent_next);
        assert!(is_in_order, "{round}: {answer}");
        let lost_count = Status::read(&mut bench).number("rx_lost");
        let is_counted = lost_count > lost_before;
        assert_eq!(is_counted, was_lost, "{round}: {lost_count} bytes lost");
        lost_before = lost_count;
        bench.say("watch 0");
    }
    assert!(
        overrun_count > 30,
        "only {overrun_count} of 40 bursts lost a byte"
    );
}

#[test]
fn a_line_of_any_bytes_gets_one_answer_unless_it_is_blank() {
    let mut rng = Rng::with_seed(11);
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    for _ in 0..300 {
        // Excludes backspace and delete, which would remove bytes from the line.
        let bytes = (0..rng.u64(..80)).map(|_| rng.u8(..).max(32));
        let bytes: Vec<u8> = bytes.filter(|byte| *byte != 0x7f).collect();
        let answers_before = count_answers(&mut bench);
        bench.uno.send(&bytes);
        bench.uno.send(b"\n");
        bench.run_ms(20);
        let answer_count = count_answers(&mut bench) - answers_before;
        let is_blank = bytes.iter().all(|byte| *byte == b' ');
        assert_eq!(answer_count, usize::from(!is_blank), "{bytes:?}");
    }
    assert_eq!(Status::read(&mut bench).number("rx_lost"), 0.0);
}

#[test]
fn a_line_with_a_garbled_byte_is_refused_and_the_byte_counted() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        let line = b"speed 90";
        for index in 0..line.len() {
            bench.uno.send(&line[..index]);
            bench.uno.send_with_framing_error(&line[index..=index]);
            bench.uno.send(&line[index + 1..]);
            bench.uno.send(b"\n");
            bench.run_ms(20);
            assert_eq!(bench.last_text(), GARBLED_ANSWER, "byte {index}");
        }
        Status::read(&mut bench).assert_has("speed=100 rx_lost=8");
        assert_eq!(bench.say("speed 90"), "ok speed 90");
    });
}
