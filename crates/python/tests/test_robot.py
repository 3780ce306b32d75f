"""Tests of `Robot` with the firmware's core without a chip, and with a simulated UNO on a serial port.

The environment variable `LIZARD` is the path of a program `lizard` with the UNO simulator.
"""

import os
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

import lizard
from lizard.status import NoAnswer


def start_uno(link: Path, *options: str) -> subprocess.Popen[bytes]:
    """Starts a simulated UNO behind a pseudo terminal."""
    command = [os.environ["LIZARD"], "sim", "--pty", str(link), *options]
    uno = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    while not link.exists():
        assert uno.poll() is None
        time.sleep(0.02)
    return uno


@pytest.fixture
def port(tmp_path: Path) -> Iterator[Path]:
    uno = start_uno(tmp_path / "uno")
    yield tmp_path / "uno"
    uno.kill()
    uno.wait()


def read_deadman(robot: lizard.Robot) -> int:
    return int(robot.send("cal")[-2].removeprefix("# deadman "))


def test_a_walk_of_two_cycles_takes_about_two_periods_and_ends_at_the_first_pose(
    robot, model
):
    first_frame = robot.status().frames
    robot.walk(cycles=2)
    status = robot.status()
    seconds = (status.frames - first_frame) / 50
    # The robot first moves to the gait's first pose, and slows down at the end.
    assert 2.0 <= seconds < 3.2
    assert (status.gait, status.fault) == ("stop", "none")
    difference = np.array(status.pose) - model.gait("walk").angles[0]
    assert np.abs(difference).max() < 15
    assert read_deadman(robot) == 0


def test_a_gait_continues_while_the_program_drives_with_deadman(robot):
    robot.send("deadman 700")
    robot.go("arc-left")
    assert read_deadman(robot) == 700
    time.sleep(2)
    assert robot.status().gait == "arc-left"
    robot.stop()
    assert read_deadman(robot) == 700


def test_save_stores_the_robots_own_deadman_while_the_robot_walks(robot):
    robot.walk()
    robot.stop()
    robot.send("deadman 5000")
    robot.walk()
    robot.send("save")
    assert read_deadman(robot) == 901
    robot.stop()
    robot.send("load")
    assert read_deadman(robot) == 5000


def walk_after(robot, monkeypatch, action: Callable[[], None]) -> None:
    """Starts walking; runs an action just before `walk` is sent."""
    write = robot._write

    def write_after_action(line: str) -> None:
        if line == "walk":
            action()
        write(line)

    monkeypatch.setattr(robot, "_write", write_after_action)
    robot.walk()


def test_a_late_done_line_of_the_gait_before_does_not_end_a_gait(robot, monkeypatch):
    walk_after(robot, monkeypatch, lambda: robot._handle_line("# done"))
    assert robot.is_going


def test_a_robot_that_was_reset_just_before_a_gait_walks_with_deadman(
    robot, monkeypatch
):
    walk_after(robot, monkeypatch, robot._port.board.reset)
    assert (robot.is_going, read_deadman(robot)) == (True, 901)


def test_deadman_is_set_again_after_a_reset_just_after_its_answer(robot, monkeypatch):
    robot.send("deadman 700")
    send = robot._send_until_answered

    def send_before_reset(line: str) -> list[str]:
        answer = send(line)
        if line == "deadman 700" and robot._reset_count == 0:
            robot._port.board.reset()
            while robot._reset_count == 0:
                time.sleep(0.01)
        return answer

    monkeypatch.setattr(robot, "_send_until_answered", send_before_reset)
    # Without a gait, because the lines that keep a gait alive would also set `deadman`.
    robot._set_deadman()
    # The reset has restored the saved value, 0.
    assert (robot._own_deadman, read_deadman(robot)) == (0, 901)


def test_the_robots_own_deadman_survives_a_lost_answer(robot, monkeypatch):
    robot.send("deadman 5000")
    send = robot._send_until_answered
    lost_lines: list[str] = []

    def lose_first_answer(line: str) -> list[str]:
        answer = send(line)
        if line == "deadman 901" and not lost_lines:
            lost_lines.append(line)
            raise NoAnswer("lost")
        return answer

    monkeypatch.setattr(robot, "_send_until_answered", lose_first_answer)
    with pytest.raises(NoAnswer):
        robot.go("walk")
    robot.walk()
    robot.stop()
    assert read_deadman(robot) == 5000


@pytest.mark.parametrize(
    "call",
    [
        lambda robot: robot.status(),
        lambda robot: robot.speed(50),
        lambda robot: next(robot.watch()),
    ],
)
def test_a_lost_line_does_not_stop_a_walking_robot(robot, monkeypatch, call):
    robot.walk()
    write, lost_lines = robot._write, []

    def lose_first_line(line: str) -> None:
        if threading.current_thread() is threading.main_thread() and not lost_lines:
            lost_lines.append(line)
        else:
            write(line)

    monkeypatch.setattr(robot, "_write", lose_first_line)
    call(robot)
    status = robot.status()
    assert (status.gait, status.fault) == ("walk", "none")


def test_stop_restores_deadman_even_if_the_robot_rests_already(robot):
    robot.walk()
    robot.send("rest")
    assert not robot.is_going
    robot.stop()
    assert read_deadman(robot) == 0


def test_the_robot_stops_if_the_program_sends_no_lines(robot):
    robot.go("walk")
    robot._closing.set()  # the threads end, as in a killed program
    robot._keep_alive.join()
    robot._listener.join()
    board = robot._port.board
    for _ in range(60):
        board.run_frame(b"")
    answer = board.run_frame(b"status\n")
    assert "gait=walk" not in answer and "gait=" in answer


def test_watch_yields_the_poses_until_the_commanded_pose(robot, model):
    target_pose = tuple(np.round(model.neutral + [8, -8, 5, 5], 2))
    frames: list[lizard.Frame] = []

    def watch_until_final_pose() -> None:
        for frame in robot.watch(2):
            frames.append(frame)
            if frame.pose == final_pose:
                return

    final_pose = tuple(float(angle) for angle in target_pose)
    watcher = threading.Thread(target=watch_until_final_pose)
    watcher.start()
    final_pose = robot.pose(*target_pose)
    np.testing.assert_allclose(final_pose, target_pose, atol=0.011)
    watcher.join(5)
    times = [frame.time for frame in frames]
    np.testing.assert_allclose(np.diff(times), 0.04, atol=1e-9)
    assert frames[0].pose != final_pose and frames[-1].pose == final_pose


def test_a_refusal_has_the_robots_message_and_code(robot):
    with pytest.raises(lizard.RobotError, match="A1 must be") as error:
        robot.pose(0, 0, 0, 0)
    assert error.value.code == 3
    with pytest.raises(lizard.RobotError, match="the robot refuses `wlak`: unknown"):
        robot.go("wlak")
    assert read_deadman(robot) == 0
    robot.walk()
    with pytest.raises(lizard.RobotError, match="unknown"):
        robot.go("wlak")
    assert (robot.is_going, read_deadman(robot)) == (True, 901)
    robot.rest()
    robot.stop()
    for line in ("walk\nstop", "", "st\u00e4nd"):
        with pytest.raises(ValueError, match="ASCII"):
            robot.send(line)
    with pytest.raises(lizard.RobotError, match="resting") as error:
        robot.walk()
    assert error.value.code == 7
    robot.stand()
    assert robot.status().gait == "stand"


def test_damaged_lines_do_not_end_the_listener(robot):
    for line in ("# t=12pose=1,2,3,4", "# t=12 pose=1,2", "# t=12 pose"):
        robot._handle_line(line)
    robot.walk(cycles=1)


def test_a_damaged_refusal_is_no_answer(robot, monkeypatch):
    monkeypatch.setattr(robot, "_write", lambda line: robot._handle_line("err 3"))
    with pytest.raises(lizard.RobotError, match="does not answer"):
        robot._send("walk", 0.1)


def test_after_a_reset_wait_raises_an_error_and_the_robot_can_walk_again(robot):
    robot.walk()
    robot._port.board.reset()
    with pytest.raises(lizard.RobotError, match="the robot was reset"):
        robot.wait()
    status = robot.status()
    assert (status.reset, status.resets) == ("external", 1)
    robot.walk(cycles=1)


def test_after_a_start_without_a_banner_wait_notices_a_reset(monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr("lizard.robot.BANNER_PREFIX", "# lost")
        patch.setattr("lizard.robot.BANNER_TIMEOUT", 0.1)
        robot = lizard.Robot.simulated()
    with robot:
        robot.walk()
        robot._port.board.reset()
        with pytest.raises(lizard.RobotError, match="the robot was reset"):
            robot.wait(timeout=5)


def lose_all_bytes(robot, monkeypatch):
    monkeypatch.setattr(robot._port, "write", lambda data: None)
    monkeypatch.setattr(robot._port, "read", lambda: time.sleep(0.02) or b"")


def test_close_ends_a_wait_even_if_the_robot_is_out_of_range(robot, monkeypatch):
    monkeypatch.setattr("lizard.robot.RETRY_TIME", 0.0)
    robot.walk()
    lose_all_bytes(robot, monkeypatch)
    threading.Timer(0.1, robot.close).start()
    with pytest.raises(lizard.RobotError, match="this robot is closed"):
        robot.wait(timeout=10)


def test_an_unanswered_gait_ends_the_wait_for_the_gait_before(robot, monkeypatch):
    def trot() -> None:
        with suppress(lizard.RobotError):
            robot.go("trot")

    robot.walk()
    monkeypatch.setattr("lizard.robot.ANSWER_TIMEOUT", 0.1)
    lose_all_bytes(robot, monkeypatch)
    threading.Timer(0.1, trot).start()
    with pytest.raises(lizard.RobotError, match="does not answer `trot`"):
        robot.wait(timeout=10)


def test_wait_raises_an_error_after_a_stop_or_a_timeout(robot):
    threading.Timer(0.5, robot.stop).start()
    start_time = time.monotonic()
    with pytest.raises(lizard.RobotError, match="`stop` has ended the gait"):
        robot.walk(cycles=20)
    assert time.monotonic() - start_time < 3
    with pytest.raises(TimeoutError, match="still moves"):
        robot.walk()
        robot.wait(timeout=0.2)


def test_a_with_block_that_raises_stops_the_robot():
    with pytest.raises(ZeroDivisionError), lizard.Robot.simulated() as robot:
        robot.walk()
        board = robot._port.board
        _ = 1 / 0
    answer = board.run_frame(b"status\n")
    assert "gait=stop" in answer
    with pytest.raises(lizard.RobotError, match="this robot is closed"):
        robot.walk()


def test_a_routine_of_the_model_continues_after_a_rest():
    routine = '[routine.round]\nsteps = ["walk 1", "rest 2 s", "stand 0.5 s"]\n'
    model = lizard.Model.from_toml(lizard.default_toml() + routine)
    with lizard.Robot.simulated(model) as robot:
        robot.go("round")
        robot.wait(timeout=10)
        assert robot.status().gait in ("stand", "stop")


def test_a_board_on_a_serial_port_walks(port):
    with lizard.Robot(str(port)) as robot:
        robot.walk(cycles=1)
        assert robot.status().gait == "stop"
        # Another program that opens the port resets the board.
        robot.walk()
        subprocess.run(["stty", "-F", str(port), "hupcl"], check=True)
        assert robot.status().late == 0


def test_unplugging_the_board_raises_a_connection_error(tmp_path):
    uno = start_uno(tmp_path / "uno")
    with lizard.Robot(str(tmp_path / "uno")) as robot:
        robot.walk()
        uno.kill()
        uno.wait()
        with pytest.raises(ConnectionError, match="the board was unplugged"):
            robot.wait()
        with pytest.raises(ConnectionError):
            robot.status()


def test_a_robot_walks_over_a_radio_at_another_baud_rate(tmp_path):
    uno = start_uno(tmp_path / "uno", "--radio", "9600")
    try:
        with lizard.Robot(str(tmp_path / "uno")) as robot:
            robot.walk()
            time.sleep(2)
            assert robot.status().gait == "walk"
    finally:
        uno.kill()
        uno.wait()


def test_the_error_for_a_port_without_a_robot_states_the_reason(tmp_path):
    with pytest.raises(OSError, match="no-port"):
        lizard.Robot(str(tmp_path / "no-port"))
    controller, terminal = os.openpty()
    with pytest.raises(lizard.RobotError, match="no banner and no answer"):
        lizard.Robot(os.ttyname(terminal))
    os.close(controller)
    os.close(terminal)
