//! The measurements, each on a board of its own.

use std::path::Path;
use std::time::Instant;

use lizard_robot::Robot;
use simulated_uno::Call;

use super::board::Board;
use crate::Failure;
use crate::sim::frame::FRAME;

/// What the firmware costs and how exact it is. Cycles are of 62.5 ns.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// Bytes of flash: code, tables and initial values.
    pub flash: u32,
    /// Bytes of RAM that are static.
    pub static_ram: u16,
    /// Fewest bytes ever between the stack and static data.
    pub stack_spare: u16,
    /// Mean cycles of the control tick in walk, interrupts left out.
    pub tick_mean: f64,
    /// The most cycles of a control tick in any motion, interrupts left out.
    pub tick_worst: u64,
    /// The most cycles from the tick to the end of its computation while the
    /// serial line is saturated both ways, interrupts and answers included.
    pub tick_latency: u64,
    /// Mean cycles of the guard in a tick of walk.
    pub guard: f64,
    /// Mean cycles of all that main does in a frame of walk, tick included.
    pub main: f64,
    /// Cycles that the servo interrupts take in a frame of walk.
    pub servo_interrupts: f64,
    /// The longest that a serial interrupt keeps a servo's edge waiting, cycles.
    pub serial_interrupt: u64,
    /// Share of walk that the CPU is asleep, percent.
    pub asleep: f64,
    /// Peak to peak of measured less commanded width, cycles: idle line.
    pub jitter_idle: u64,
    /// The same with the line saturated both ways.
    pub jitter_flooded: u64,
    /// Worst deviation of a width from its command, cycles, in both.
    pub width_error: u64,
    /// Worst deviation of a servo's period from 20 ms, cycles, in both.
    pub period_error: u64,
    /// The most servo pins high at once, in both.
    pub pins_high: u32,
    /// The step in which widths vary, cycles.
    pub resolution: u64,
    /// Edges that the firmware counts as late.
    pub late: u64,
    /// Bytes that it counts as lost while the sender waits for answers.
    pub lost: u64,
    /// Wall time of ten simulated minutes of walk, s.
    pub wall: f64,
}

/// Data sheet numbers of TIMER1_COMPA and TIMER1_COMPB.
const SERVO_VECTORS: [u8; 2] = [11, 12];
/// And those of USART_RX and USART_UDRE.
const SERIAL_VECTORS: [u8; 2] = [18, 19];
/// Cycles from the end of an instruction to a handler's first: 4 of the interrupt
/// and 3 of the jump in the vector table.
const ENTRY: u64 = 7;
/// Ten minutes, ms.
const LONG: u64 = 600_000;

impl Figures {
    /// Measures an ELF. `progress` is told what is being measured.
    ///
    /// # Errors
    /// A firmware that cannot be loaded, dies, or does not answer.
    pub fn measure(
        elf: &Path,
        robot: &Robot,
        progress: impl Fn(&'static str),
    ) -> Result<Self, Failure> {
        let awake = || Board::awake(elf, robot);
        progress("pulses on an idle line");
        let idle = Walk::of(awake()?, 20_000)?;
        let heard = idle.board.uno.received_by_uno().len();
        let idle_exact = idle.board.exactness(heard)?;
        progress("pulses on a saturated line");
        let (mut flooded, heard) = flood(awake()?)?;
        let flooded_exact = flooded.exactness(heard)?;
        progress("every command");
        let mut session = session(awake()?, robot)?;
        progress("the control tick in walk");
        let tick = times(awake()?, "Console::frame", &["walk"])?;
        progress("the control tick in every motion");
        let every = times(awake()?, "Console::frame", &motions(robot))?;
        progress("the guard");
        let of = times(awake()?, "Clearance::of", &["walk"])?;
        let hazard = times(awake()?, "Clearance::hazard", &["walk"])?;
        progress("the control tick on a saturated line");
        let tick_latency = latency(awake()?)?;
        progress("serial interrupts");
        let serial_interrupt = longest_serial(awake)?;
        progress("ten minutes of walk");
        let begin = Instant::now();
        let long = Walk::of(awake()?, LONG)?;
        let wall = begin.elapsed().as_secs_f64();

        let frames = idle.walked as f64 / FRAME as f64;
        Ok(Self {
            flash: long.board.uno.image().flash_used(),
            static_ram: long.board.uno.image().static_ram(),
            stack_spare: session.uno.stack_spare().min(flooded.uno.stack_spare()),
            tick_mean: mean(&tick),
            tick_worst: every.iter().map(Call::own_cycles).max().unwrap_or(0),
            tick_latency,
            guard: mean(&of) + mean(&hazard),
            main: (idle.awake - idle.in_handlers) as f64 / frames,
            servo_interrupts: idle.in_servos as f64 / frames,
            serial_interrupt,
            asleep: 100.0 - 100.0 * idle.awake as f64 / idle.walked as f64,
            jitter_idle: idle_exact.jitter(),
            jitter_flooded: flooded_exact.jitter(),
            width_error: idle_exact.worst().max(flooded_exact.worst()),
            period_error: idle_exact.period.max(flooded_exact.period),
            pins_high: idle_exact.pins_high.max(flooded_exact.pins_high),
            resolution: idle_exact.step,
            late: session.count("late")? + flooded.count("late")?,
            lost: session.count("rx_lost")?,
            wall,
        })
    }
}

/// A board that has walked on an idle line, and the cycles that took.
struct Walk {
    board: Board,
    walked: u64,
    awake: u64,
    in_handlers: u64,
    in_servos: u64,
}

impl Walk {
    fn of(mut board: Board, ms: u64) -> Result<Self, Failure> {
        board.say("walk")?;
        board.run_ms(1000)?;
        let counts = |board: &Board| {
            [
                board.uno.cycle(),
                board.uno.awake_cycles(),
                board.in_handlers(|_| true),
                board.in_handlers(|vector| SERVO_VECTORS.contains(&vector)),
            ]
        };
        let before = counts(&board);
        board.run_ms(ms)?;
        let after = counts(&board);
        let [walked, awake, in_handlers, in_servos] = std::array::from_fn(|i| after[i] - before[i]);
        Ok(Self {
            board,
            walked,
            awake,
            in_handlers,
            in_servos,
        })
    }
}

/// Twenty seconds of commands that move nothing, as fast as they go through the
/// line, while the robot turns, and as many bytes back. Also returns how many
/// bytes came before.
fn flood(mut board: Board) -> Result<(Board, usize), Failure> {
    let heard = saturate(&mut board)?;
    board.run_ms(20_000)?;
    board.uno.flood(b"");
    board.run_ms(300)?;
    // What is left of the flood ends with this line.
    board.uno.send(b"\n");
    board.run_ms(100)?;
    Ok((board, heard))
}

fn saturate(board: &mut Board) -> Result<usize, Failure> {
    board.say("watch 1")?;
    board.say("left")?;
    let heard = board.uno.received_by_uno().len();
    board.uno.flood(b"status\n");
    Ok(heard)
}

/// Everything one can ask for that moves: each gait from the one before, a far
/// pose, home, a stop.
fn motions(robot: &Robot) -> Vec<String> {
    let names = robot.gaits.iter().map(|gait| gait.name.replace('-', " "));
    let mut lines: Vec<String> = names.collect();
    let [a1, a2, a3, a4] = <[f64; 4]>::from(robot.neutral());
    let far = [a1 - 35.0, a2, a3 - 35.0, a4];
    for [a1, a2, a3, a4] in [far, [a1, a2, a3, a4]] {
        lines.push(format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}"));
    }
    lines.push("stop".into());
    lines
}

/// Every command with a report of every frame, each sent when the one before has
/// been answered.
fn session(mut board: Board, robot: &Robot) -> Result<Board, Failure> {
    board.say("watch 1")?;
    let others = [
        "help",
        "?",
        "status",
        "speed 55",
        "walk",
        "rest",
        "walk",
        "stand",
        "watch 0",
        "what",
        "speed",
        "speed 5",
        "pose 90 90 318.59 221.41",
        "pose 150 41.41 318.59 200",
        "a line that is longer than the sixty-three characters it may have",
    ];
    let lines = motions(robot);
    for line in lines.iter().map(String::as_str).chain(others) {
        board.say(line)?;
        board.run_ms(700)?;
    }
    Ok(board)
}

/// Times a function while the robot does one thing after the other.
fn times(
    mut board: Board,
    function: &str,
    lines: &[impl AsRef<str>],
) -> Result<Vec<Call>, Failure> {
    let mut calls = Vec::new();
    for line in lines {
        board.say(line.as_ref())?;
        calls.extend(board.time(function, 3000)?);
    }
    Ok(calls)
}

fn mean(calls: &[Call]) -> f64 {
    let all: u64 = calls.iter().map(Call::own_cycles).sum();
    all as f64 / calls.len().max(1) as f64
}

/// The longest time from a tick to the return of the function that computes its
/// frame, on a saturated line.
fn latency(mut board: Board) -> Result<u64, Failure> {
    saturate(&mut board)?;
    let calls = board.time("Console::frame", 5000)?;
    // The tick comes a slot before A1's pulse.
    let tick = board.first_pulse()? - FRAME / 5;
    let late = calls.iter().map(|call| (call.leave - tick) % FRAME);
    Ok(late.max().unwrap_or(0))
}

/// The longest of the serial interrupts on a saturated line, with their entry.
fn longest_serial(awake: impl Fn() -> Result<Board, Failure>) -> Result<u64, Failure> {
    let mut longest = 0;
    for vector in SERIAL_VECTORS {
        let mut board = awake()?;
        saturate(&mut board)?;
        let calls = board.time(&format!("__vector_{vector}"), 2000)?;
        longest = calls.iter().map(Call::cycles).fold(longest, u64::max);
    }
    Ok(longest + ENTRY)
}
