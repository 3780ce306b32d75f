//! The measurements of the firmware, each on its own simulated board.

use std::iter::zip;
use std::path::Path;
use std::time::Instant;

use lizard_robot::Robot;
use simulated_uno::{Call, Fidelity, Pin};

use super::exactness::Exactness;
use super::stack::StackDepth;
use crate::Failure;
use crate::shared::firmware;
use crate::simulate::board::{BoardError, SimulatedBoard};
use crate::simulate::patrol::PATROL;
use crate::simulate::sim::frame::FRAME;
use crate::simulate::sim::tour;

/// The costs and the exactness of the firmware. A cycle is 62.5 ns. A figure that could not be measured is `None`: a
/// robot without a moving gait has no figures of a gait, and if a firmware was built from another source, the widths
/// that it commands are not known.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// The gait that was measured: the first that moves.
    pub gait: Option<String>,
    /// Bytes of flash of the code, with its tables and initial values.
    pub code: u32,
    /// Bytes of the robot's section.
    pub section: u32,
    /// True if the section has maps of certified cells; otherwise the guard measures every pose.
    pub has_maps: bool,
    /// Bytes of RAM that are static.
    pub static_ram: u16,
    /// Smallest measured number of bytes between the stack and static data.
    pub stack_spare: u16,
    /// Number of bytes between static data and the deepest stack that the code allows; computed, not measured.
    /// Negative if they collide.
    pub stack_margin: i32,
    /// Mean cycles of the control tick without interrupts, in the gait with the largest mean.
    pub tick_mean: Option<f64>,
    /// The most cycles of a control tick in any motion, without interrupts.
    pub tick_worst: u64,
    /// Mean cycles of the control tick in a routine with inputs, without interrupts.
    pub routine_mean: Option<f64>,
    /// The most cycles of a control tick in a routine with inputs, without interrupts.
    pub routine_worst: Option<u64>,
    /// The most cycles from the tick to the end of its computation while the serial line is saturated in both
    /// directions, with interrupts and answers.
    pub tick_latency: u64,
    /// The most cycles of a step of main other than the control tick, without interrupts: a line that is written, a
    /// byte that ends a line, a part of a save or load.
    pub step: u64,
    /// Mean cycles of the guard in a tick of the gait.
    pub guard: Option<f64>,
    /// Mean cycles of main in a frame of the gait, with the tick.
    pub main: Option<f64>,
    /// Mean cycles of the servo interrupts in a frame.
    pub servo_interrupts: f64,
    /// The longest time that a serial interrupt delays a servo interrupt, cycles.
    pub serial_interrupt: u64,
    /// Share of the gait's time that the CPU is asleep, percent.
    pub asleep: Option<f64>,
    /// Peak-to-peak difference of measured and commanded widths on an idle line, cycles.
    pub jitter_idle: Option<u64>,
    /// Peak-to-peak difference of measured and commanded widths on a line saturated in both directions, cycles.
    pub jitter_flooded: Option<u64>,
    /// Worst deviation of a width from its command, on the idle and the saturated line, cycles.
    pub width_error: Option<u64>,
    /// Worst deviation of a servo's period from 20 ms, on the idle and the saturated line, cycles.
    pub period_error: u64,
    /// Largest number of servo pins high at the same time, on the idle and the saturated line.
    pub pins_high: u32,
    /// The step of which all changes of a width in the gait are multiples, cycles.
    pub resolution: Option<u64>,
    /// Edges that the firmware counts as late.
    pub late: u64,
    /// Bytes that the firmware counts as lost while the sender waits for answers.
    pub lost: u64,
    /// Wall time of ten simulated minutes of the gait, s.
    pub wall: f64,
}

/// The function of the firmware that computes a frame: the control tick.
const TICK_FUNCTION: &str = "Control::frame";
/// The guard's function in the ELF.
const GUARD_FUNCTION: &str = "clearance::find_hazard";
/// The functions of the steps of main other than the control tick.
const STEP_FUNCTIONS: [&str; 3] = [
    "Console::write_line",
    "Console::receive",
    "Control::write_memory",
];
/// Lines that take long to execute: those with answers of several lines, and settings with which the limits of the
/// pulse widths restrict a servo's travel.
const LONG_LINES: [&str; 20] = [
    "status",
    "help",
    "cal",
    "save",
    "load",
    "pose 0 0 0 0",
    "trim 1 3.3",
    "trim 2 3.3",
    "trim 3 3.3",
    "trim 4 3.3",
    "scale 1 17.77",
    "scale 2 17.77",
    "scale 3 17.77",
    "scale 4 17.77",
    "dir 1 -",
    "dir 1 +",
    "limit 3 0 359",
    "boot stand",
    "center",
    "factory",
];
/// Vector numbers of TIMER1_COMPA and TIMER1_COMPB, counted from 0; the data sheet counts from 1.
const SERVO_VECTORS: [u8; 2] = [11, 12];
/// Vector numbers of USART_RX and USART_UDRE, counted from 0; the data sheet counts from 1.
const SERIAL_VECTORS: [u8; 2] = [18, 19];
/// Cycles from the end of the interrupted instruction to the first instruction of the handler: 4 for the interrupt
/// response and 3 for the jump in the vector table.
const ENTRY_CYCLES: u64 = 7;
/// Ten minutes, ms.
const LONG_RUN_MS: u64 = 600_000;

impl Figures {
    /// Measures an ELF with a robot. `patrol_robot` is the same robot with the routine [`PATROL`], if that is to be
    /// measured, too. `report_progress` receives the name of each measurement.
    ///
    /// # Errors
    /// Fails for a firmware that cannot be loaded, stops, or does not answer.
    pub fn measure(
        elf: &Path,
        robot: &Robot,
        patrol_robot: Option<&Robot>,
        report_progress: impl Fn(&'static str),
    ) -> Result<Self, Failure> {
        let gaits: Vec<String> = tour::demonstration_gaits(robot)
            .into_iter()
            .map(command_of)
            .collect();
        // A robot that only stands is measured while it stands.
        let gait = gaits.first().map_or("stand", String::as_str);
        let turn_gait = gaits.last().map_or("stand", String::as_str);
        let is_moving = !gaits.is_empty();
        let boot_board = || -> Result<SimulatedBoard, BoardError> {
            let mut board = SimulatedBoard::power_on(elf, Fidelity::DataSheet, robot)?;
            board.run_ms(1000)?;
            Ok(board)
        };
        report_progress("the stack's depth");
        let image = firmware::read(elf)?;
        let stack = StackDepth::of(&image).map_err(|e| Failure::Impossible(e.to_string()))?;
        report_progress("pulses on an idle line");
        let mut idle_run = GaitRun::of(boot_board()?, gait, 20_000)?;
        let bytes_sent = idle_run.board.uno.received_by_uno().len();
        let idle_exactness = Exactness::measure(&mut idle_run.board, robot.firmware(), bytes_sent)?;
        report_progress("pulses on a saturated line");
        let (mut flooded_board, bytes_sent) = flood(boot_board()?, turn_gait)?;
        let flooded_exactness =
            Exactness::measure(&mut flooded_board, robot.firmware(), bytes_sent)?;
        report_progress("every command");
        let mut session_board = run_all_commands(boot_board()?, robot)?;
        report_progress("the control tick in every motion");
        let tick_calls = time_calls_under(boot_board()?, TICK_FUNCTION, &motion_commands(robot))?;
        let gait_calls = tick_calls.iter().take(robot.gaits().len());
        report_progress("the control tick in a routine");
        let routine_calls = patrol_robot
            .map(|robot| time_patrol(elf, robot))
            .transpose()?;
        report_progress("the guard");
        let guard =
            mean_cycles(&time_calls_under(boot_board()?, GUARD_FUNCTION, &[gait])?.concat());
        report_progress("the control tick on a saturated line");
        let tick_latency = longest_latency(boot_board()?, turn_gait)?;
        report_progress("every other step");
        let step = longest_step(elf, robot)?;
        report_progress("serial interrupts");
        let serial_interrupt = longest_serial(boot_board, turn_gait)?;
        report_progress("ten minutes of a gait");
        let start = Instant::now();
        let long_run = GaitRun::of(boot_board()?, gait, LONG_RUN_MS)?;
        let wall_s = start.elapsed().as_secs_f64();

        let frames = idle_run.cycles as f64 / FRAME as f64;
        let figure_of_gait = |figure: f64| is_moving.then_some(figure);
        let section = robot.section().len() as u32;
        let width_error = idle_exactness
            .max_width_error()
            .zip(flooded_exactness.max_width_error());
        Ok(Self {
            code: firmware::code_bytes(long_run.board.uno.image(), robot),
            section,
            has_maps: robot.has_room_for_maps(),
            static_ram: long_run.board.uno.image().static_ram(),
            stack_spare: session_board
                .uno
                .stack_spare()
                .min(flooded_board.uno.stack_spare()),
            stack_margin: stack.margin(),
            tick_mean: figure_of_gait(
                gait_calls
                    .map(|calls| mean_cycles(calls))
                    .fold(0.0, f64::max),
            ),
            tick_worst: most_cycles(&tick_calls.concat()),
            routine_mean: routine_calls.as_deref().map(mean_cycles),
            routine_worst: routine_calls.as_deref().map(most_cycles),
            tick_latency,
            step,
            guard: figure_of_gait(guard),
            main: figure_of_gait((idle_run.awake - idle_run.in_handlers) as f64 / frames),
            servo_interrupts: idle_run.in_servos as f64 / frames,
            serial_interrupt,
            asleep: figure_of_gait(100.0 - 100.0 * idle_run.awake as f64 / idle_run.cycles as f64),
            jitter_idle: idle_exactness.jitter(),
            jitter_flooded: flooded_exactness.jitter(),
            width_error: width_error.map(|(idle, flooded)| idle.max(flooded)),
            period_error: idle_exactness
                .period_error
                .max(flooded_exactness.period_error),
            pins_high: idle_exactness.pins_high.max(flooded_exactness.pins_high),
            resolution: idle_exactness.step,
            late: session_board.read_counter("late")? + flooded_board.read_counter("late")?,
            lost: session_board.read_counter("rx_lost")?,
            wall: wall_s,
            gait: gaits.first().cloned(),
        })
    }
}

/// The most cycles of a step of main other than the control tick, without interrupts.
///
/// # Errors
/// See [`Figures::measure`].
pub fn longest_step(elf: &Path, robot: &Robot) -> Result<u64, BoardError> {
    let gait = tour::demonstration_gaits(robot)
        .first()
        .map_or("stand".into(), |gait| command_of(gait));
    let mut largest_cycles = 0;
    for function in STEP_FUNCTIONS {
        let mut board = SimulatedBoard::power_on(elf, Fidelity::DataSheet, robot)?;
        board.run_ms(1000)?;
        largest_cycles =
            longest_call(board, function, &gait, &long_lines(robot))?.max(largest_cycles);
    }
    Ok(largest_cycles)
}

/// The console command of a gait.
fn command_of(gait: &str) -> String {
    gait.replace('-', " ")
}

/// A board that has executed one command for some time on an idle line, and the cycles that it spent meanwhile.
struct GaitRun {
    board: SimulatedBoard,
    cycles: u64,
    awake: u64,
    in_handlers: u64,
    in_servos: u64,
}

impl GaitRun {
    fn of(mut board: SimulatedBoard, line: &str, ms: u64) -> Result<Self, BoardError> {
        board.say(line)?;
        board.run_ms(1000)?;
        let count_cycles = |board: &SimulatedBoard| {
            [
                board.uno.cycle(),
                board.uno.awake_cycles(),
                board.handler_cycles(|_| true),
                board.handler_cycles(|vector| SERVO_VECTORS.contains(&vector)),
            ]
        };
        let counts_before = count_cycles(&board);
        board.run_ms(ms)?;
        let counts_after = count_cycles(&board);
        let [cycles, awake, in_handlers, in_servos] =
            std::array::from_fn(|i| counts_after[i] - counts_before[i]);
        Ok(Self {
            board,
            cycles,
            awake,
            in_handlers,
            in_servos,
        })
    }
}

/// Saturates the line in both directions for twenty seconds while the robot walks. The commands that are sent move
/// nothing. Also returns the number of bytes that the board had received before them.
fn flood(mut board: SimulatedBoard, gait: &str) -> Result<(SimulatedBoard, usize), BoardError> {
    let received_before = saturate(&mut board, gait)?;
    board.run_ms(20_000)?;
    board.uno.flood(b"");
    board.run_ms(300)?;
    // This line ends the last command of the flood.
    board.uno.send(b"\n");
    board.run_ms(100)?;
    Ok((board, received_before))
}

/// Starts a gait and saturates the line in both directions. Returns the number of bytes that the board had received
/// before the line was saturated.
fn saturate(board: &mut SimulatedBoard, gait: &str) -> Result<usize, BoardError> {
    board.say("watch 1")?;
    board.say(gait)?;
    let received_before = board.uno.received_by_uno().len();
    board.uno.flood(b"status\n");
    Ok(received_before)
}

/// Commands for every kind of motion: each gait after the previous one, a far pose, neutral, a stop.
fn motion_commands(robot: &Robot) -> Vec<String> {
    let names = robot.gaits().iter().map(|gait| command_of(gait.name()));
    let mut lines: Vec<String> = names.collect();
    lines.push(pose_command(robot, [-35.0, 0.0, -35.0, 0.0]));
    lines.push(pose_command(robot, [0.0; 4]));
    lines.push("stop".into());
    lines
}

/// The command for a pose this many degrees from neutral.
fn pose_command(robot: &Robot, turns: [f64; 4]) -> String {
    let neutral = <[f64; 4]>::from(robot.neutral());
    let [a1, a2, a3, a4]: [f64; 4] = std::array::from_fn(|i| neutral[i] + turns[i]);
    format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}")
}

/// Sends every command, with a report of every frame. Each is sent after the previous one was answered.
fn run_all_commands(
    mut board: SimulatedBoard,
    robot: &Robot,
) -> Result<SimulatedBoard, BoardError> {
    board.say("watch 1")?;
    let mut lines = motion_commands(robot);
    lines.extend(["help", "?", "status", "speed 55"].map(str::to_owned));
    let gait = tour::demonstration_gaits(robot)
        .first()
        .copied()
        .map(command_of);
    lines.extend(gait.clone());
    lines.push("rest".into());
    lines.extend(gait);
    lines.extend(["stand", "watch 0", "what", "speed", "speed 5"].map(str::to_owned));
    lines.push(pose_command(robot, [-48.59, 48.59, 0.0, 0.0]));
    lines.push(pose_command(robot, [11.41, 0.0, 0.0, -21.41]));
    lines.push("a line that is longer than the sixty-three characters it may have".into());
    for line in &lines {
        board.say(line)?;
        board.run_ms(700)?;
    }
    Ok(board)
}

/// Times a function under one command after another; returns the calls of each.
fn time_calls_under(
    mut board: SimulatedBoard,
    function: &str,
    lines: &[impl AsRef<str>],
) -> Result<Vec<Vec<Call>>, BoardError> {
    let mut calls = Vec::new();
    for line in lines {
        board.say(line.as_ref())?;
        calls.push(board.time_calls(function, 3000)?);
    }
    Ok(calls)
}

/// Lines that take long to execute. Among them is an unknown name that has the most leading characters in common
/// with the names of the gaits.
fn long_lines(robot: &Robot) -> Vec<String> {
    let gait_names = || robot.gaits().iter().map(|gait| command_of(gait.name()));
    let shared_count = |line: &String| -> usize {
        let shared_length = |name: String| {
            zip(name.bytes(), line.bytes())
                .take_while(|(a, b)| a == b)
                .count()
        };
        gait_names().map(shared_length).sum()
    };
    let nearest_name = gait_names().max_by_key(shared_count).unwrap_or_default();
    let mut lines = LONG_LINES.map(str::to_owned).to_vec();
    lines.push(format!("boot {nearest_name}"));
    lines.push("cal".into());
    lines.push(format!("{nearest_name}x"));
    lines.push(format!("boot {nearest_name}x"));
    lines
}

/// The most cycles of a function while each line is executed during a gait. Lines that are refused count, too, since
/// they take as long.
fn longest_call(
    mut board: SimulatedBoard,
    function: &str,
    gait: &str,
    lines: &[String],
) -> Result<u64, BoardError> {
    board.say(gait)?;
    let mut largest_cycles = 0;
    for line in lines {
        board.uno.send(line.as_bytes());
        board.uno.send(b"\n");
        let calls = board.time_calls(function, 400)?;
        largest_cycles = largest_cycles.max(most_cycles(&calls));
    }
    Ok(largest_cycles)
}

/// The control ticks of a patrol in which each input is closed and opened five times.
fn time_patrol(elf: &Path, robot: &Robot) -> Result<Vec<Call>, BoardError> {
    let mut board = SimulatedBoard::power_on(elf, Fidelity::DataSheet, robot)?;
    board.run_ms(1000)?;
    board.say(PATROL)?;
    let mut calls = Vec::new();
    for _ in 0..5 {
        for (_, pin) in robot.inputs().each() {
            for is_closed in [true, false] {
                board.uno.set_contact(Pin::arduino(pin), is_closed);
                calls.extend(board.time_calls(TICK_FUNCTION, 1500)?);
            }
        }
    }
    Ok(calls)
}

fn most_cycles(calls: &[Call]) -> u64 {
    calls.iter().map(Call::own_cycles).max().unwrap_or(0)
}

fn mean_cycles(calls: &[Call]) -> f64 {
    let total: u64 = calls.iter().map(Call::own_cycles).sum();
    total as f64 / calls.len().max(1) as f64
}

/// The longest time from a tick to the return of the function that computes its frame, on a saturated line, cycles.
fn longest_latency(mut board: SimulatedBoard, gait: &str) -> Result<u64, BoardError> {
    saturate(&mut board, gait)?;
    let calls = board.time_calls(TICK_FUNCTION, 5000)?;
    // The tick is one slot before A1's pulse.
    let tick_cycle = board.first_pulse()? - FRAME / 5;
    let latencies = calls.iter().map(|call| (call.leave - tick_cycle) % FRAME);
    Ok(latencies.max().unwrap_or(0))
}

/// The longest serial interrupt on a saturated line, including the entry into its handler, cycles.
fn longest_serial(
    boot_board: impl Fn() -> Result<SimulatedBoard, BoardError>,
    gait: &str,
) -> Result<u64, BoardError> {
    let mut longest_cycles = 0;
    for vector in SERIAL_VECTORS {
        let mut board = boot_board()?;
        saturate(&mut board, gait)?;
        let calls = board.time_calls(&format!("__vector_{vector}"), 2000)?;
        longest_cycles = calls
            .iter()
            .map(Call::cycles)
            .fold(longest_cycles, u64::max);
    }
    Ok(longest_cycles + ENTRY_CYCLES)
}
