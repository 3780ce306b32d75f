//! Measurements of the firmware, each on its own simulated board and with its budget.

use std::iter::zip;
use std::path::Path;
use std::time::Instant;

use lizard_core::numbers::section::{REGION_BYTES, START_ADDRESS};
use lizard_robot::{CheckedGait, Robot, to_command};
use simulated_uno::{Call, Fidelity, Pin};

use super::budget::{
    Bound, BudgetRow, MAX_LONG_RUN_WALL_S, MAX_OTHER_INTERRUPT_CYCLES, MIN_MAIN_FRACTION,
    TICK_BUDGET_CYCLES, TICK_BUDGET_WITHOUT_MAPS_CYCLES, TICK_DEADLINE_CYCLES,
};
use super::exactness::Exactness;
use super::stack::StackDepth;
use crate::Failure;
use crate::shared::firmware;
use crate::simulate::board::{BoardError, SimulatedBoard};
use crate::simulate::patrol::PATROL;
use crate::simulate::sim::frame::FRAME_CYCLES;
use crate::simulate::sim::gait_choice;

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

/// Measures the firmware in an ELF with `robot`, and returns each measurement with its budget. A value that could not
/// be measured is `None`: the values of a gait if the robot has no moving gait, and the width errors if the firmware
/// was built from another source, because its commanded widths are then not known. `patrol_robot` is the same robot
/// with the routine [`PATROL`]; without it, no routine is measured. `report_progress` receives each measurement's name
/// before the measurement.
///
/// A cycle is 62.5 ns. The cycles of a control tick, of the guard and of a step exclude interrupts; the cycles from a
/// tick to its frame include them. The longest serial interrupt is also the longest delay of a servo interrupt.
///
/// # Errors
/// Fails if the firmware cannot be loaded, stops or does not answer, or if its stack depth cannot be computed.
pub fn measure(
    elf: &Path,
    robot: &Robot,
    patrol_robot: Option<&Robot>,
    report_progress: impl Fn(&'static str),
) -> Result<Vec<BudgetRow>, Failure> {
    use Bound::{AtLeast, AtMost};
    let first_gait = find_gait_command(robot);
    let is_moving = first_gait.is_some();
    // A robot without a moving gait is measured while it stands.
    let gait = first_gait.as_deref().unwrap_or("stand");
    let demonstration_gaits = gait_choice::choose_demonstration_gaits(robot);
    let turn_gait = &to_command(demonstration_gaits.last().unwrap_or(&"stand"));
    let boot_board = || run_first_second(elf, robot);
    report_progress("the stack's depth");
    let image = firmware::read_image(elf)?;
    let stack =
        StackDepth::compute(&image).map_err(|error| Failure::Operation(error.to_string()))?;
    report_progress("pulses on an idle line");
    let mut idle_run = GaitRun::record(boot_board()?, gait, 20_000)?;
    let command_bytes = idle_run.board.uno.received_by_uno().len();
    let idle = Exactness::measure(&mut idle_run.board, robot.firmware(), command_bytes)?;
    report_progress("pulses on a saturated line");
    let (mut saturated_board, command_bytes) =
        run_gait_on_saturated_line(boot_board()?, turn_gait)?;
    let saturated = Exactness::measure(&mut saturated_board, robot.firmware(), command_bytes)?;
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
    let tick_latency = measure_longest_tick_latency(boot_board()?, turn_gait)?;
    report_progress("every other step");
    let step_cycles = measure_longest_step(elf, robot)?;
    report_progress("serial interrupts");
    let serial_cycles = measure_longest_serial_interrupt(boot_board, turn_gait)?;
    report_progress("ten minutes of a gait");
    let start = Instant::now();
    let long_run = GaitRun::record(boot_board()?, gait, LONG_RUN_MS)?;
    let wall_s = start.elapsed().as_secs_f64();

    let some_if_moving = |value: f64| is_moving.then_some(value);
    let measured_if_known = |value: Option<u64>| value.map(|value| value as f64);
    let always_measured = |value: u64| Some(value as f64);
    let width_errors = idle.max_width_error.zip(saturated.max_width_error);
    let width_error = width_errors.map(|(idle, saturated)| idle.max(saturated));
    let period_error = idle.max_period_error.max(saturated.max_period_error);
    let pins_high = idle.max_pins_high.max(saturated.max_pins_high);
    let [session_spare, saturated_spare] =
        [&session_board, &saturated_board].map(|board| board.uno.stack_spare());
    let late_edges = session_board.read_counter("late")? + saturated_board.read_counter("late")?;
    let lost_bytes = session_board.read_counter("rx_lost")?;
    let image = long_run.board.uno.image();
    let code_bytes = firmware::count_code_bytes(image, robot);
    let frame_count = idle_run.cycles as f64 / FRAME_CYCLES as f64;
    // The mean of the gait with the largest mean, and the longest tick in any motion.
    let mean_ticks = gait_calls.map(|calls| compute_mean_cycles(calls));
    let mean_tick = some_if_moving(mean_ticks.fold(0.0, f64::max));
    let max_tick = compute_max_cycles(&tick_calls.concat());
    let mean_routine_tick = routine_calls.as_deref().map(compute_mean_cycles);
    let max_routine_tick = routine_calls.as_deref().map(compute_max_cycles);
    let mean_guard = some_if_moving(compute_mean_cycles(&guard_calls));
    // Main's cycles include the control tick.
    let main_cycles = (idle_run.awake_cycles - idle_run.handler_cycles) as f64;
    let mean_main = some_if_moving(main_cycles / frame_count);
    let mean_servo_interrupts = idle_run.servo_handler_cycles as f64 / frame_count;
    let asleep_percent = 100.0 - 100.0 * idle_run.awake_cycles as f64 / idle_run.cycles as f64;
    let asleep_percent = some_if_moving(asleep_percent);
    let [mean_tick_budget, max_tick_budget] = if robot.has_room_for_maps() {
        TICK_BUDGET_CYCLES
    } else {
        TICK_BUDGET_WITHOUT_MAPS_CYCLES
    };
    let step_budget = MIN_MAIN_FRACTION * TICK_DEADLINE_CYCLES - max_tick_budget;
    let row = BudgetRow::new;
    let wall_row = |name, unit, measured, budget| BudgetRow {
        is_machine_dependent: true,
        ..row(name, unit, Some(measured), budget, None)
    };
    #[rustfmt::skip]
    let rows = vec![
        row("pulse jitter, idle line", "cycles", measured_if_known(idle.jitter), AtMost(0.0), Some("77-113")),
        row("pulse jitter, line saturated", "cycles", measured_if_known(saturated.jitter), AtMost(0.0), Some("121-135")),
        row("width minus command, worst", "cycles", measured_if_known(width_error), AtMost(0.0), None),
        row("width resolution", "cycles", measured_if_known(idle.width_step), AtMost(1.0), Some("16")),
        row("period minus 20 ms, worst", "cycles", always_measured(period_error), AtMost(0.0), None),
        row("servo pins high at once", "", always_measured(pins_high.into()), AtMost(1.0), None),
        row("late edges counted", "", always_measured(late_edges), AtMost(0.0), None),
        row("bytes lost, sender waits", "bytes", always_measured(lost_bytes), AtMost(0.0), None),
        row("control tick, mean in any gait", "cycles", mean_tick, AtMost(mean_tick_budget), None),
        row("  of which the guard", "cycles", mean_guard, Bound::None, Some("35 400, float solve")),
        row("control tick, worst", "cycles", always_measured(max_tick), AtMost(max_tick_budget), None),
        row("  in a routine, mean", "cycles", mean_routine_tick, AtMost(mean_tick_budget), None),
        row("  in a routine, worst", "cycles", measured_if_known(max_routine_tick), AtMost(max_tick_budget), None),
        row("tick to frame, line saturated", "cycles", always_measured(tick_latency), AtMost(TICK_DEADLINE_CYCLES), None),
        row("any other step, worst", "cycles", always_measured(step_cycles), AtMost(step_budget), None),
        row("main, mean per frame of a gait", "cycles", mean_main, Bound::None, None),
        row("servo interrupts per frame", "cycles", Some(mean_servo_interrupts), Bound::None, Some("1 513")),
        row("longest serial interrupt", "cycles", always_measured(serial_cycles), AtMost(MAX_OTHER_INTERRUPT_CYCLES), None),
        row("CPU asleep in a gait", "%", asleep_percent, AtLeast(90.0), Some("0")),
        row("flash, code", "bytes", Some(code_bytes.into()), AtMost(START_ADDRESS.into()), Some("5 994")),
        row("flash, the robot's section", "bytes", Some(robot.section().len() as f64), AtMost(REGION_BYTES.into()), None),
        row("static RAM", "bytes", Some(image.static_ram().into()), AtMost(900.0), Some("365")),
        row("between stack and static RAM", "bytes", Some(session_spare.min(saturated_spare).into()), AtLeast(400.0), None),
        row("  with the deepest stack", "bytes", Some(stack.margin().into()), AtLeast(400.0), None),
        wall_row("ten simulated minutes", "s", wall_s, AtMost(MAX_LONG_RUN_WALL_S)),
        wall_row("  times faster than a board", "", LONG_RUN_MS as f64 / 1000.0 / wall_s, Bound::None),
    ];
    Ok(rows)
}

/// Measures the cycles of main's longest step except the control tick, without interrupts.
///
/// # Errors
/// See [`measure`].
pub fn measure_longest_step(elf: &Path, robot: &Robot) -> Result<u64, BoardError> {
    let gait = find_gait_command(robot);
    let gait = gait.as_deref().unwrap_or("stand");
    let lines = list_slow_lines(robot);
    let mut max_cycles = 0;
    for function in STEP_FUNCTIONS {
        let board = run_first_second(elf, robot)?;
        max_cycles = measure_longest_call(board, function, gait, &lines)?.max(max_cycles);
    }
    Ok(max_cycles)
}

/// Returns the command of the first gait that moves a servo; `None` if the robot has no such gait.
pub(super) fn find_gait_command(robot: &Robot) -> Option<String> {
    let gaits = gait_choice::list_moving_gaits(robot);
    gaits.first().map(|name| to_command(name))
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
    let gait = find_gait_command(robot);
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
        board.send(line);
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
