"""Drives a real or simulated board with the commands in docs/console.md."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import Self

from lizard._exchange import Exchange
from lizard._ports import FRAME_PERIOD, Port, SerialPort, SimulatedPort
from lizard.model import Model
from lizard.status import Frame, NoAnswer, RobotError, Status, parse_deadman

BANNER_PREFIX = "# lizard "
BANNER_TIMEOUT = 3.0
"""Time limit for the banner after the port is opened, s; it includes more than 1 s for a UNO's boot loader."""
STATUS_ATTEMPT_COUNT = 8
"""Number of `status` lines sent to a board that sends no banner. The board needs at most five to find the baud rate;
the others replace lines that a radio loses."""
ANSWER_TIMEOUT = 2.0
"""Time limit for an answer, s; `save` takes a third of a second."""
RETRY_TIME = 5.0
"""Time for which a line is repeated until it is answered, s; only for lines that do no harm when they arrive twice."""
NO_PULSES_CODES = (7, 10)
"""Error codes of `stop` if there are no pulses to stop: the servos rest, or the flash has no robot."""
STALL_TIME = 1.0
"""Time without movement after which a robot counts as stopped, s."""
DRIVING_DEADMAN = 901
"""`deadman` while a program drives the robot, ms. No user is likely to choose this value, so a robot with this value
still has it from an earlier program."""


class Robot(Exchange):
    """A robot on a serial port, which belongs to a board or to a radio module.

    Opening the port of a UNO resets the board. A `with` block stops the robot at its end. While a gait runs,
    `deadman`, the time after which the robot stops if it receives nothing, is set to less than a second, and a thread
    sends lines that keep the robot moving. If this program ends or the link breaks, the robot stops by itself.
    """

    def __init__(self, port: str, *, baud: int = 115_200) -> None:
        """Opens the port, and waits for the robot's banner or status.

        Raises OSError if the port cannot be opened, RobotError if no robot answers.
        """
        self._start(SerialPort(port, baud))

    @classmethod
    def simulated(cls, model: Model | None = None) -> Robot:
        """Creates a robot on a simulated board.

        The firmware's core runs in real time on this computer, without the chip and its pulses.
        """
        robot = cls.__new__(cls)
        robot._start(SimulatedPort((model or Model.default())._robot))
        return robot

    def _start(self, port: Port) -> None:
        self._open_exchange(port)
        self._watchers: list[SimpleQueue[Frame]] = []
        # None while a gait runs; afterwards the reason for an early end, or "".
        self._end_reason: str | None = ""
        self._is_connected = False
        self._reset_count = 0
        # While `go` waits for the answer to its line: how this answer begins. Otherwise None.
        self._awaited_prefix: str | None = None
        # `deadman` before and while this program drives the robot, ms.
        self._own_deadman: int | None = None
        self._driving_deadman: int | None = None
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._keep_alive = threading.Thread(target=self._send_keep_alives, daemon=True)
        self._listener.start()
        try:
            self._wait_for_robot()
        except BaseException:
            self._shut_down()
            raise
        self._keep_alive.start()

    def _wait_for_robot(self) -> None:
        if self._wait_until(lambda: self._is_connected, BANNER_TIMEOUT):
            return
        for _ in range(STATUS_ATTEMPT_COUNT):
            with suppress(RobotError):
                self._send("status", ANSWER_TIMEOUT / 4)
                self._is_connected = True
                return
        raise RobotError(
            "no banner and no answer to `status`; is it the right port, and has the board "
            "been flashed (lizard flash)?"
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Stops the robot, restores its `deadman`, and closes the port."""
        try:
            if not self._is_closed:
                # The robot rests, or it is out of range and stops by itself.
                with suppress(RobotError, OSError):
                    self.stop()
        finally:
            self._shut_down()

    def _shut_down(self) -> None:
        self._closing.set()
        with self._condition:
            self._condition.notify_all()
        for thread in (self._listener, self._keep_alive):
            if thread.is_alive():
                thread.join()
        self._port.close()

    def go(self, name: str, cycles: int | None = None) -> None:
        """Starts a gait or a routine by its name; if `cycles` is given, waits until they are done."""
        line = name.replace("-", " ").strip().lower()
        if cycles is not None:
            line += f" {cycles}"
        with self._exchange_lock:
            self._set_deadman()
            self._awaited_prefix = f"ok {line.split(' ')[0]}"
            try:
                self.send(line)
                self._set_deadman()  # Lost if the robot was reset before the line.
            except NoAnswer as error:
                # If the gait runs, `deadman` stops it.
                self._end_reason = None
                self._mark_ended(str(error))
                raise
            except (RobotError, ValueError):
                # A refused line changes nothing: an earlier gait continues.
                if not self.is_going:
                    self._restore_deadman()
                raise
            finally:
                self._awaited_prefix = None
        if cycles is not None:
            self.wait()

    def walk(self, cycles: int | None = None) -> None:
        """Starts walking; if `cycles` is given, waits until they are done."""
        self.go("walk", cycles)

    def wait(self, timeout: float | None = None) -> None:
        """Waits for the end of counted cycles, or of a routine.

        Raises TimeoutError after `timeout` seconds, RobotError if the robot stops for another reason.
        """
        if not self._wait_until(lambda: self._end_reason is not None, timeout):
            raise TimeoutError(f"the robot still moves after {timeout} s")
        with self._exchange_lock:
            # Another thread may have started a gait, or a gait may run although its answer was lost.
            if self._end_reason == "":
                self._restore_deadman()
        if self._end_reason:
            raise RobotError(self._end_reason)

    @property
    def is_going(self) -> bool:
        """True while a gait or a routine runs."""
        return self._end_reason is None

    def stop(self) -> None:
        """Stops the robot in the next frame. Repeats the line until the robot answers, for at most five seconds.

        A robot without pulses ignores the line.
        """
        if not self._exchange_lock.acquire(blocking=False):
            self._write("stop")  # overtakes the line that waits for its answer
            self._exchange_lock.acquire()
        try:
            self._end_gait("stop")
        finally:
            self._exchange_lock.release()

    def rest(self) -> None:
        """Stops the pulses: the servos go limp. `stand` wakes them."""
        self._end_gait("rest")

    def stand(self) -> None:
        """Moves to the neutral pose, and wakes the servos after `rest`."""
        self._end_gait("stand")

    def speed(self, percent: int) -> None:
        """Sets the speed of gaits, 10 to 100 percent."""
        self._send_until_answered(f"speed {percent}")

    def pose(self, *angles: float) -> tuple[float, ...]:
        """Returns the servo angles, deg; with four angles, first moves to them and waits until they are reached.

        Raises RobotError if the pose is refused, or if the robot stops on the way.
        """
        if angles:
            self._end_gait("pose " + " ".join(f"{angle:.2f}" for angle in angles))
            self._wait_for_pose(angles)
        return self.status().pose

    def _wait_for_pose(self, angles: tuple[float, ...]) -> None:
        pose: tuple[float, ...] = ()
        last_movement_time = time.monotonic()
        while True:
            status = self.status()
            if status.has_pose(angles):
                return
            now = time.monotonic()
            if status.pose != pose:
                pose, last_movement_time = status.pose, now
            elif status.gait != "pose" or now - last_movement_time > STALL_TIME:
                reason = f"guard {status.guard}, fault {status.fault}"
                raise RobotError(f"the robot did not reach the pose: {reason}")
            time.sleep(FRAME_PERIOD)

    def status(self) -> Status:
        """Requests the robot's state."""
        answer = self._send_until_answered("status")[-1]
        try:
            return Status.parse(answer)
        except ValueError:  # a radio has lost a part of the line
            raise RobotError(f"the answer to `status` is damaged: {answer}") from None

    def watch(self, every: int = 1) -> Iterator[Frame]:
        """Yields the pose in every n-th frame of 20 ms (n is `every`), until the iteration ends."""
        if every < 1:
            raise ValueError(f"every must be at least 1, got {every}")
        frames: SimpleQueue[Frame] = SimpleQueue()
        with self._condition:
            self._watchers.append(frames)
        try:
            self._send_until_answered(f"watch {every}")
            while True:
                try:
                    frame = frames.get(timeout=every * FRAME_PERIOD + ANSWER_TIMEOUT)
                except Empty:
                    self._check_open()
                    raise RobotError("the robot no longer sends its poses") from None
                yield frame
        finally:
            with self._condition:
                self._watchers.remove(frames)
            if not self._is_closed:
                self._send_until_answered("watch 0")

    def send(self, line: str) -> list[str]:
        """Sends a console line; returns the `#` lines before its answer, and the answer.

        Raises RobotError if the robot refuses the line. Unlike `go`, does not set `deadman` for a gait that the line
        starts.
        """
        word = line.strip().lower().split(" ")[0]
        if word not in ("deadman", "factory", "load", "save"):
            return self._send(line, ANSWER_TIMEOUT)
        # These lines change or store the robot's own `deadman`.
        with self._exchange_lock:
            was_driving = self._driving_deadman is not None
            self._restore_deadman()
            try:
                return self._send(line, ANSWER_TIMEOUT)
            finally:
                self._own_deadman = None
                if was_driving:
                    self._set_deadman()

    def _end_gait(self, line: str) -> None:
        with self._exchange_lock:
            try:
                self._send_until_answered(line)
            except RobotError as error:
                if line != "stop" or error.code not in NO_PULSES_CODES:
                    raise
            self._mark_ended(f"`{line}` has ended the gait")
            self._restore_deadman()

    def _send_until_answered(self, line: str) -> list[str]:
        """Repeats a line until it is answered, since a radio may lose it."""
        deadline = time.monotonic() + RETRY_TIME
        while True:
            timeout = ANSWER_TIMEOUT / 2
            if self._driving_deadman is not None:
                # The lines that keep the gait alive wait for this line. At 9600 baud an answer takes 0.2 s.
                timeout = min(timeout, max(0.3, self._driving_deadman / 2000))
            try:
                return self._send(line, timeout)
            except NoAnswer:
                if time.monotonic() >= deadline:
                    raise

    def _set_deadman(self) -> None:
        while self._driving_deadman is None:
            reset_count = self._reset_count
            own_deadman = self._own_deadman
            if own_deadman is None:
                notes = self._send_until_answered("cal")
                own_deadman = parse_deadman(notes)
                if own_deadman == DRIVING_DEADMAN:
                    own_deadman = 0
                with self._condition:
                    # A reset restores the saved `deadman`, also after the answer.
                    if self._reset_count != reset_count:
                        continue
                    # Kept even if the next line is not answered: `cal` would then show the driving value.
                    self._own_deadman = own_deadman
            driving_deadman = min(own_deadman or DRIVING_DEADMAN, DRIVING_DEADMAN)
            self._send_until_answered(f"deadman {driving_deadman}")
            with self._condition:
                if self._reset_count == reset_count:
                    self._driving_deadman = driving_deadman

    def _restore_deadman(self) -> None:
        if self._driving_deadman is not None:
            self._send_until_answered(f"deadman {self._own_deadman}")
            self._driving_deadman = None

    def _send_keep_alives(self) -> None:
        """Sends a line at least three times per `deadman` time while this program drives the robot."""
        line_count = 0
        while not self._closing.wait(
            min(0.2, (self._driving_deadman or DRIVING_DEADMAN) / 4000)
        ):
            with self._exchange_lock:
                deadman = self._driving_deadman
                if deadman is None or self._end_reason is not None:
                    continue
                line_count += 1
                try:
                    if line_count % 5:
                        self._send(f"deadman {deadman}", ANSWER_TIMEOUT / 4)
                        continue
                    # A radio may have lost the line that reports the gait's end.
                    status = Status.parse(self._send("status", ANSWER_TIMEOUT / 4)[-1])
                except (RobotError, ValueError):
                    continue
                except OSError:
                    return
                # A routine may rest between two steps.
                may_wake = status.gait == "rest" and status.fault == "none"
                if status.gait in ("pose", "stop", "rest") and not may_wake:
                    self._mark_stopped(status.fault)

    def _mark_stopped(self, fault: str) -> None:
        self._mark_ended("" if fault == "none" else f"the robot has stopped: {fault}")

    def _mark_ended(self, reason: str) -> None:
        with self._condition:
            if self._end_reason is None:
                self._end_reason = reason
            self._condition.notify_all()

    def _listen(self) -> None:
        partial_line = b""
        while not self._closing.is_set():
            try:
                partial_line += self._port.read()
            except OSError as error:
                with self._condition:
                    self._port_error = error
                    self._condition.notify_all()
                return
            *lines, partial_line = partial_line.split(b"\n")
            partial_line = partial_line[-512:]  # noise may have no line ending
            for line in lines:
                self._handle_line(line.decode("ascii", "replace").strip())

    def _handle_line(self, line: str) -> None:
        # A reset cuts off the previous line.
        line = line[max(0, line.find(BANNER_PREFIX)) :]
        with self._condition:
            if line.startswith("# t="):
                try:
                    frame = Frame.parse(line)
                except (KeyError, ValueError):
                    return  # a radio has lost a part of the line
                for watcher in self._watchers:
                    watcher.put(frame)
            elif line.startswith(BANNER_PREFIX):
                if self._is_connected:
                    # After a reset, the robot has its saved settings.
                    self._own_deadman = self._driving_deadman = None
                    self._reset_count += 1
                    self._mark_ended("the robot was reset")
                self._is_connected = True
            elif line == "# done":
                self._mark_ended("")
            elif line.startswith("# fault: "):
                self._mark_stopped(line.removeprefix("# fault: "))
            elif line.startswith("#"):
                self._notes.append(line)
            elif line:
                self._answers.append(line)
                if line == "ok rest":  # `status` also shows `rest` in a routine
                    self._mark_ended("`rest` has ended the gait")
                # A `# done` before this answer belongs to the gait before.
                elif self._awaited_prefix and line.startswith(self._awaited_prefix):
                    self._end_reason = None
            self._condition.notify_all()
