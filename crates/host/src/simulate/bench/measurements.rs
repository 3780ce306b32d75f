//! Measurements of the firmware, each on its own simulated board.

use std::iter::zip;
use std::path::Path;
use std::time::Instant;

use lizard_robot::{CheckedGait, Robot, to_command};
use simulated_uno::{Call, Fidelity, Pin};

use super::exactness::Exactness;
use super::stack::StackDepth;
use crate::Failure;
use crate::shared::firmware;
use crate::simulate::board::{BoardError, SimulatedBoard};
use crate::simulate::patrol::PATROL;
use crate::simulate::sim::frame::FRAME_CYCLES;
use crate::simulate::sim::gait_choice;

/// The firmware's costs and exactness. A cycle is 62.5 ns. A value that could not be measured is `None`: the values of
/// a gait if the robot has no moving gait, and the width errors if the firmware was built from another source, because
/// its commanded widths are then not known.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurements {
    /// The measured gait: the robot's first moving gait.
    pub gait: Option<String>,
    /// Flash bytes of the code, including its tables and initial values.
    pub code_bytes: u32,
    /// Flash bytes of the robot's section.
    pub section_bytes: u32,
    /// True if the section has maps of certified cells; otherwise the guard checks every pose.
    pub has_maps: bool,
    /// Bytes of static data in RAM.
    pub static_ram: u16,
    /// Smallest measured number of bytes between the stack and static data.
    pub measured_stack_margin: u16,
    /// Number of bytes between static data and the deepest possible stack, computed by [`StackDepth`]; negative if they
    /// collide.
    pub predicted_stack_margin: i32,
    /// Mean cycles of the control tick, without interrupts, in the gait with the largest mean.
    pub mean_tick_cycles: Option<f64>,
    /// Cycles of the longest control tick in any motion, without interrupts.
    pub max_tick_cycles: u64,
    /// Mean cycles of the control tick in a routine with inputs, without interrupts; `None` if there is no such
    /// routine.
    pub mean_routine_tick_cycles: Option<f64>,
    /// Cycles of the longest control tick in a routine with inputs, without interrupts; `None` if there is no such
    /// routine.
    pub max_routine_tick_cycles: Option<u64>,
    /// Most cycles from a control tick to the end of its computation while the serial line is saturated in both
    /// directions, including interrupts and answers.
    pub max_tick_latency: u64,
    /// Cycles of main's longest step except the control tick, without interrupts. A step writes a line, executes a
    /// received line, or saves or loads a part of the settings.
    pub max_step_cycles: u64,
    /// Mean cycles of the guard in a control tick of the gait.
    pub mean_guard_cycles: Option<f64>,
    /// Mean cycles of main in a frame of the gait, including the control tick.
    pub mean_main_cycles: Option<f64>,
    /// Mean cycles of the servo interrupts in a frame.
    pub mean_servo_interrupt_cycles: f64,
    /// Cycles of the longest serial interrupt, which is also the longest delay of a servo interrupt.
    pub max_serial_interrupt_cycles: u64,
    /// Time in which the CPU is asleep during the gait, percent.
    pub asleep_percent: Option<f64>,
    /// Peak-to-peak error of the widths on an idle serial line, cycles.
    pub jitter_idle: Option<u64>,
    /// Peak-to-peak error of the widths while the serial line is saturated in both directions, cycles.
    pub jitter_saturated: Option<u64>,
    /// Largest deviation of a width from its command, on the idle and the saturated line, cycles.
    pub max_width_error: Option<u64>,
    /// Largest deviation of a servo's period from 20 ms, on the idle and the saturated line, cycles.
    pub max_period_error: u64,
    /// Largest number of servo pins high at the same time, on the idle and the saturated line.
    pub max_pins_high: u32,
    /// The greatest common divisor of all width changes in the gait, cycles.
    pub width_resolution: Option<u64>,
    /// Edges that the firmware counts as late.
    pub late_edges: u64,
    /// Bytes that the firmware counts as lost while the sender waits for answers.
    pub lost_bytes: u64,
    /// Wall time of ten simulated minutes of the gait, s.
    pub wall_s: f64,
}

/// The firmware's function that computes a frame: the control tick.
const TICK_FUNCTION: &str = "Controller::compute_frame";
/// The guard's function in the ELF.
const GUARD_FUNCTION: &str = "clearance::find_hazard";
/// The functions of main's steps except the control tick.
const STEP_FUNCTIONS: [&str; 3] = [
    "Console::write_line",
    "Console::receive",
    "Controller::advance_operation",
];
/// Lines that take long to execute: lines with several answer lines, and settings whose pulse width limits restrict a
/// servo's travel.
const SLOW_LINES: [&str; 20] = [
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
const INTERRUPT_ENTRY_CYCLES: u64 = 7;
/// Simulated time of the long run, ms: ten minutes.
const LONG_RUN_MS: u64 = 600_000;

impl Measurements {
    /// Measures the firmware in an ELF with `robot`. `patrol_robot` is the same robot with the routine [`PATROL`];
    /// without it, no routine is measured. `report_progress` receives each measurement's name before the measurement.
    ///
    /// # Errors
    /// Fails if the firmware cannot be loaded, stops or does not answer, or if its stack depth cannot be computed.
    pub fn measure(
        elf: &Path,
        robot: &Robot,
        patrol_robot: Option<&Robot>,
        report_progress: impl Fn(&'static str),
    ) -> Result<Self, Failure> {
        let gaits = list_demonstration_commands(robot);
        // A robot without a moving gait is measured while it stands.
        let gait = gaits.first().map_or("stand", String::as_str);
        let turn_gait = gaits.last().map_or("stand", String::as_str);
        let is_moving = !gaits.is_empty();
        let boot_board = || run_first_second(elf, robot);
        report_progress("the stack's depth");
        let image = firmware::read_image(elf)?;
        let stack =
            StackDepth::compute(&image).map_err(|error| Failure::Operation(error.to_string()))?;
        report_progress("pulses on an idle line");
        let mut idle_run = GaitRun::record(boot_board()?, gait, 20_000)?;
        let command_bytes = idle_run.board.uno.received_by_uno().len();
        let idle_exactness =
            Exactness::measure(&mut idle_run.board, robot.firmware(), command_bytes)?;
        report_progress("pulses on a saturated line");
        let (mut saturated_board, command_bytes) =
            run_gait_on_saturated_line(boot_board()?, turn_gait)?;
        let saturated_exactness =
            Exactness::measure(&mut saturated_board, robot.firmware(), command_bytes)?;
        report_progress("every command");
        let mut session_board = run_all_commands(boot_board()?, robot)?;
        report_progress("the control tick in every motion");
        let tick_calls =
            time_calls_per_command(boot_board()?, TICK_FUNCTION, &list_motion_commands(robot))?;
        let gait_calls = tick_calls.iter().take(robot.gaits().len());
        report_progress("the control tick in a routine");
        let routine_calls = patrol_robot.map(|robot| time_patrol(elf, robot));
        let routine_calls = routine_calls.transpose()?;
        report_progress("the guard");
        let guard_calls = time_calls_per_command(boot_board()?, GUARD_FUNCTION, &[gait])?.concat();
        report_progress("the control tick on a saturated line");
        let max_tick_latency = measure_longest_tick_latency(boot_board()?, turn_gait)?;
        report_progress("every other step");
        let max_step_cycles = measure_longest_step(elf, robot)?;
        report_progress("serial interrupts");
        let max_serial_interrupt_cycles = measure_longest_serial_interrupt(boot_board, turn_gait)?;
        report_progress("ten minutes of a gait");
        let start = Instant::now();
        let long_run = GaitRun::record(boot_board()?, gait, LONG_RUN_MS)?;
        let wall_s = start.elapsed().as_secs_f64();

        let frame_count = idle_run.cycles as f64 / FRAME_CYCLES as f64;
        let some_if_moving = |value: f64| is_moving.then_some(value);
        let (idle, saturated) = (&idle_exactness, &saturated_exactness);
        let max_width_errors = idle.max_width_error().zip(saturated.max_width_error());
        let [session_spare, saturated_spare] =
            [&session_board, &saturated_board].map(|board| board.uno.stack_spare());
        let image = long_run.board.uno.image();
        let mean_gait_cycles = gait_calls.map(|calls| compute_mean_cycles(calls));
        let asleep_percent = 100.0 - 100.0 * idle_run.awake_cycles as f64 / idle_run.cycles as f64;
        let main_cycles = (idle_run.awake_cycles - idle_run.handler_cycles) as f64;
        Ok(Self {
            code_bytes: firmware::count_code_bytes(image, robot),
            section_bytes: robot.section().len() as u32,
            has_maps: robot.has_room_for_maps(),
            static_ram: image.static_ram(),
            measured_stack_margin: session_spare.min(saturated_spare),
            predicted_stack_margin: stack.margin(),
            mean_tick_cycles: some_if_moving(mean_gait_cycles.fold(0.0, f64::max)),
            max_tick_cycles: compute_max_cycles(&tick_calls.concat()),
            mean_routine_tick_cycles: routine_calls.as_deref().map(compute_mean_cycles),
            max_routine_tick_cycles: routine_calls.as_deref().map(compute_max_cycles),
            max_tick_latency,
            max_step_cycles,
            mean_guard_cycles: some_if_moving(compute_mean_cycles(&guard_calls)),
            mean_main_cycles: some_if_moving(main_cycles / frame_count),
            mean_servo_interrupt_cycles: idle_run.servo_handler_cycles as f64 / frame_count,
            max_serial_interrupt_cycles,
            asleep_percent: some_if_moving(asleep_percent),
            jitter_idle: idle.jitter(),
            jitter_saturated: saturated.jitter(),
            max_width_error: max_width_errors.map(|(idle, saturated)| idle.max(saturated)),
            max_period_error: idle.max_period_error.max(saturated.max_period_error),
            max_pins_high: idle.max_pins_high.max(saturated.max_pins_high),
            width_resolution: idle.width_step,
            late_edges: session_board.read_counter("late")?
                + saturated_board.read_counter("late")?,
            lost_bytes: session_board.read_counter("rx_lost")?,
            wall_s,
            gait: gaits.first().cloned(),
        })
    }
}

/// Measures the cycles of main's longest step except the control tick, without interrupts.
///
/// # Errors
/// See [`Measurements::measure`].
pub fn measure_longest_step(elf: &Path, robot: &Robot) -> Result<u64, BoardError> {
    let gaits = list_demonstration_commands(robot);
    let gait = gaits.first().map_or("stand", String::as_str);
    let lines = list_slow_lines(robot);
    let mut max_cycles = 0;
    for function in STEP_FUNCTIONS {
        let board = run_first_second(elf, robot)?;
        max_cycles = measure_longest_call(board, function, gait, &lines)?.max(max_cycles);
    }
    Ok(max_cycles)
}

/// Lists the commands of the demonstration gaits.
fn list_demonstration_commands(robot: &Robot) -> Vec<String> {
    let gaits = gait_choice::choose_demonstration_gaits(robot);
    gaits.into_iter().map(to_command).collect()
}

/// Powers on a board and runs it for a second.
fn run_first_second(elf: &Path, robot: &Robot) -> Result<SimulatedBoard, BoardError> {
    let mut board = SimulatedBoard::power_on(elf, Fidelity::DataSheet, robot)?;
    board.run_ms(1000)?;
    Ok(board)
}

/// A board that has executed one command on an idle serial line for some time, and the cycles of this time.
struct GaitRun {
    board: SimulatedBoard,
    /// All cycles, awake or asleep.
    cycles: u64,
    awake_cycles: u64,
    handler_cycles: u64,
    servo_handler_cycles: u64,
}

impl GaitRun {
    /// Runs a command for a second, then counts the cycles of the next `ms` milliseconds.
    fn record(mut board: SimulatedBoard, command: &str, ms: u64) -> Result<Self, BoardError> {
        board.say(command)?;
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
        let [cycles, awake_cycles, handler_cycles, servo_handler_cycles] =
            std::array::from_fn(|i| counts_after[i] - counts_before[i]);
        Ok(Self {
            board,
            cycles,
            awake_cycles,
            handler_cycles,
            servo_handler_cycles,
        })
    }
}

/// Runs a gait for twenty seconds while `status` saturates the serial line in both directions. Also returns the number
/// of bytes that the board received before the saturation.
fn run_gait_on_saturated_line(
    mut board: SimulatedBoard,
    gait: &str,
) -> Result<(SimulatedBoard, usize), BoardError> {
    let command_bytes = start_gait_on_saturated_line(&mut board, gait)?;
    board.run_ms(20_000)?;
    board.uno.flood(b"");
    board.run_ms(300)?;
    // The line end completes the last `status`.
    board.uno.send(b"\n");
    board.run_ms(100)?;
    Ok((board, command_bytes))
}

/// Starts a gait and saturates the serial line in both directions. Returns the number of bytes that the board received
/// before the saturation.
fn start_gait_on_saturated_line(
    board: &mut SimulatedBoard,
    gait: &str,
) -> Result<usize, BoardError> {
    board.say("watch 1")?;
    board.say(gait)?;
    let command_bytes = board.uno.received_by_uno().len();
    board.uno.flood(b"status\n");
    Ok(command_bytes)
}

/// Lists commands for every kind of motion: each gait, a pose far from neutral, the neutral pose, and `stop`.
fn list_motion_commands(robot: &Robot) -> Vec<String> {
    let gait_commands = robot.gaits().iter().map(CheckedGait::command);
    let mut commands: Vec<String> = gait_commands.collect();
    commands.push(format_pose_command(robot, [-35.0, 0.0, -35.0, 0.0]));
    commands.push(format_pose_command(robot, [0.0; 4]));
    commands.push("stop".into());
    commands
}

/// Formats the command for the pose with `offsets` from neutral, deg.
fn format_pose_command(robot: &Robot, offsets: [f64; 4]) -> String {
    let neutral = <[f64; 4]>::from(robot.neutral_pose());
    let [a1, a2, a3, a4]: [f64; 4] = std::array::from_fn(|i| neutral[i] + offsets[i]);
    format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}")
}

/// Sends every kind of command, each after the answer to the previous one, while `watch` reports every frame.
fn run_all_commands(
    mut board: SimulatedBoard,
    robot: &Robot,
) -> Result<SimulatedBoard, BoardError> {
    board.say("watch 1")?;
    let mut commands = list_motion_commands(robot);
    commands.extend(["help", "?", "status", "speed 55"].map(str::to_owned));
    let gait = list_demonstration_commands(robot).into_iter().next();
    commands.extend(gait.clone());
    commands.push("rest".into());
    commands.extend(gait);
    commands.extend(["stand", "watch 0", "what", "speed", "speed 5"].map(str::to_owned));
    commands.push(format_pose_command(robot, [-48.59, 48.59, 0.0, 0.0]));
    commands.push(format_pose_command(robot, [11.41, 0.0, 0.0, -21.41]));
    commands.push("a line that is longer than the sixty-three characters it may have".into());
    for command in &commands {
        board.say(command)?;
        board.run_ms(700)?;
    }
    Ok(board)
}

/// Times the calls of a function during one command after another; returns the calls of each command.
fn time_calls_per_command(
    mut board: SimulatedBoard,
    function: &str,
    commands: &[impl AsRef<str>],
) -> Result<Vec<Vec<Call>>, BoardError> {
    let mut calls = Vec::new();
    for command in commands {
        board.say(command.as_ref())?;
        calls.push(board.time_calls(function, 3000)?);
    }
    Ok(calls)
}

/// Lists lines that take long to execute. Some have an unknown name that begins with the gait name that shares the most
/// leading characters with the other gait names.
fn list_slow_lines(robot: &Robot) -> Vec<String> {
    let gait_names = || robot.gaits().iter().map(CheckedGait::command);
    let total_shared_length = |line: &String| -> usize {
        let shared_length = |name: String| {
            let pairs = zip(name.bytes(), line.bytes());
            pairs.take_while(|(a, b)| a == b).count()
        };
        gait_names().map(shared_length).sum()
    };
    let most_similar_name = gait_names()
        .max_by_key(total_shared_length)
        .unwrap_or_default();
    let mut lines = SLOW_LINES.map(str::to_owned).to_vec();
    lines.push(format!("boot {most_similar_name}"));
    lines.push("cal".into());
    lines.push(format!("{most_similar_name}x"));
    lines.push(format!("boot {most_similar_name}x"));
    lines
}

/// Measures the cycles of a function's longest call while the lines are executed during a gait. Refused lines count,
/// too, because they take as long.
fn measure_longest_call(
    mut board: SimulatedBoard,
    function: &str,
    gait: &str,
    lines: &[String],
) -> Result<u64, BoardError> {
    board.say(gait)?;
    let mut max_cycles = 0;
    for line in lines {
        board.uno.send(line.as_bytes());
        board.uno.send(b"\n");
        let calls = board.time_calls(function, 400)?;
        max_cycles = max_cycles.max(compute_max_cycles(&calls));
    }
    Ok(max_cycles)
}

/// Times the control ticks of a patrol while each input closes and opens five times.
fn time_patrol(elf: &Path, robot: &Robot) -> Result<Vec<Call>, BoardError> {
    let mut board = run_first_second(elf, robot)?;
    board.say(PATROL)?;
    let mut calls = Vec::new();
    for _ in 0..5 {
        for (_, pin) in robot.inputs().named_pins() {
            for is_closed in [true, false] {
                board.uno.set_contact(Pin::arduino(pin), is_closed);
                calls.extend(board.time_calls(TICK_FUNCTION, 1500)?);
            }
        }
    }
    Ok(calls)
}

fn compute_max_cycles(calls: &[Call]) -> u64 {
    calls.iter().map(Call::own_cycles).max().unwrap_or(0)
}

fn compute_mean_cycles(calls: &[Call]) -> f64 {
    let total: u64 = calls.iter().map(Call::own_cycles).sum();
    total as f64 / calls.len().max(1) as f64
}

/// Measures the longest time from a control tick to the end of its computation on a saturated serial line, cycles.
fn measure_longest_tick_latency(mut board: SimulatedBoard, gait: &str) -> Result<u64, BoardError> {
    start_gait_on_saturated_line(&mut board, gait)?;
    let calls = board.time_calls(TICK_FUNCTION, 5000)?;
    // The tick is one slot before A1's pulse.
    let tick_cycle = board.first_pulse_cycle()? - FRAME_CYCLES / 5;
    let latencies = calls
        .iter()
        .map(|call| (call.leave_cycle - tick_cycle) % FRAME_CYCLES);
    Ok(latencies.max().unwrap_or(0))
}

/// Measures the longest serial interrupt on a saturated serial line, including the entry into its handler, cycles.
fn measure_longest_serial_interrupt(
    boot_board: impl Fn() -> Result<SimulatedBoard, BoardError>,
    gait: &str,
) -> Result<u64, BoardError> {
    let mut max_cycles = 0;
    for vector in SERIAL_VECTORS {
        let mut board = boot_board()?;
        start_gait_on_saturated_line(&mut board, gait)?;
        let calls = board.time_calls(&format!("__vector_{vector}"), 2000)?;
        max_cycles = calls.iter().map(Call::cycles).fold(max_cycles, u64::max);
    }
    Ok(max_cycles + INTERRUPT_ENTRY_CYCLES)
}
