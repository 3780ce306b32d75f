"""A board to drive, over a serial port or simulated: the words are those of docs/console.md."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import NamedTuple, Self

from lizard._ports import FRAME, Port, SerialPort, SimulatedPort
from lizard.model import Model

BAUD = 115_200
BANNER = "# lizard "
GREETING = 3.0
"""Seconds for the banner after the port is opened, of which a UNO's boot loader takes more than one."""
ASKS = 8
"""Lines `status` to a board that sends no banner: it finds the rate by five, and a radio may lose some."""
ANSWER = 2.0
"""Seconds for an answer; `save` takes a third of one."""
STOPPING = 5.0
"""Seconds for which `stop` is sent to a robot that does not answer."""
NO_PULSES = (7, 10)
"""Codes of `stop` that is refused: the servos rest, or the flash has no robot."""
STANDING = 1.0
"""Seconds after which a robot that does not move has not reached its pose."""
ROUNDING = 0.02
"""Difference, deg, of a pose that was sent and one that `status` prints, for which the core rounds."""
DRIVEN = 901
"""`deadman` while a program drives, ms: no person sets this number, so one that is found was left behind."""


class RobotError(RuntimeError):
    """The robot refuses a line, stops by itself, was reset, or does not answer."""

    code: int | None = None
    """Code of a refusal, as docs/console.md lists them."""


class _Silent(RobotError):
    """No answer in time."""


class Frame(NamedTuple):
    """A pose that the servos are sent to, and its time."""

    time: float
    """Seconds since the robot's start."""
    pose: tuple[float, ...]
    """Servo angles, deg."""


@dataclass(frozen=True)
class Status:
    """The robot's answer to `status`; a field that it does not send is NaN, 0 or empty."""

    gait: str
    """A routine or gait, with dashes; `pose`, `stop` or `rest`."""
    fault: str
    """`none`, or the reason for which the robot has stopped by itself."""
    guard: str
    """`clear`, or `held` if the guard has stopped a move."""
    reset: str
    """Cause of the last start."""
    pose: tuple[float, ...]
    """Servo angles, deg."""
    margin: float
    """Smallest margin of the pose, a sine."""
    phase: float
    """Phase of the gait, 0 to 1."""
    vcc: float
    """Supply of the board, V."""
    rail: float
    """Supply of the servos, V."""
    speed: int
    """Percent of a gait's pace."""
    frames: int
    """Frames of 20 ms since the start."""
    late: int
    """Pulses' edges that came late."""
    rx_lost: int
    """Bytes that were lost."""
    resets: int
    """Resets since power-on."""

    @staticmethod
    def parse(answer: str) -> Status:
        """Reads `ok gait=...`; fields that this version does not know are skipped."""
        fields = dict(word.split("=", 1) for word in answer.split() if "=" in word)

        def number(name: str) -> float:
            return float(fields.get(name, "nan"))

        def count(name: str) -> int:
            return int(fields.get(name, "0"))

        return Status(
            gait=fields.get("gait", ""),
            fault=fields.get("fault", ""),
            guard=fields.get("guard", ""),
            reset=fields.get("reset", ""),
            pose=_angles(fields.get("pose", "")),
            margin=number("margin"),
            phase=number("phase"),
            vcc=number("vcc"),
            rail=number("rail"),
            speed=count("speed"),
            frames=count("frames"),
            late=count("late"),
            rx_lost=count("rx_lost"),
            resets=count("resets"),
        )


class Robot:
    """A robot at a serial port: a board's, or a radio module's.

    Opening the port of a UNO resets it. A `with` block stops the robot at its end. While a gait goes, `deadman` is
    set, and a thread keeps the robot going: if this program ends or the link breaks, the robot stops by itself
    within a second.
    """

    def __init__(self, port: str, *, baud: int = BAUD) -> None:
        """Opens the port, and waits for the robot's banner or its status.

        Raises OSError if the port cannot be opened, RobotError if no lizard answers.
        """
        self._start(SerialPort(port, baud))

    @classmethod
    def simulated(cls, model: Model | None = None) -> Robot:
        """A robot on a simulated board, in real time: the firmware's own code, without a chip and its pulses."""
        robot = cls.__new__(cls)
        robot._start(SimulatedPort((model or Model.default())._robot))
        return robot

    def _start(self, port: Port) -> None:
        self._port = port
        self._turn = threading.RLock()  # for a line and its answer
        self._news = threading.Condition()  # guards what the listening thread changes
        self._answers: list[str] = []
        self._notes: list[str] = []
        self._watchers: list[SimpleQueue[Frame]] = []
        self._ended: str | None = (
            ""  # None while a gait goes, then the reason of an early end
        )
        self._gone: OSError | None = None
        self._is_up = False
        self._own: int | None = None  # the robot's own deadman, ms
        self._driven: int | None = None  # the deadman while this program drives, ms
        self._closing = threading.Event()
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._keeper = threading.Thread(target=self._keep_going, daemon=True)
        self._listener.start()
        try:
            self._greet()
        except BaseException:
            self._shut()
            raise
        self._keeper.start()

    def _greet(self) -> None:
        if self._wait(lambda: self._is_up, GREETING):
            return
        for _ in range(ASKS):
            try:
                self._ask("status", ANSWER / 4)
                return
            except RobotError:
                continue
        raise RobotError(
            "nothing answers: no banner and no answer to `status`; is it the right port, and has the board "
            "been flashed (lizard flash)?"
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Stops the robot, gives it its own `deadman` back, and closes the port."""
        try:
            if not self._closing.is_set() and self._gone is None:
                self.stop()
        except (RobotError, OSError):
            pass  # It rests, or is out of reach and stops by itself.
        finally:
            self._shut()

    def _shut(self) -> None:
        self._closing.set()
        for thread in (self._listener, self._keeper):
            if thread.is_alive():
                thread.join()
        self._port.close()

    def go(self, name: str, cycles: int | None = None) -> None:
        """Starts a gait or a routine by its name; with a number of cycles, waits until they are done."""
        line = name.replace("-", " ")
        if cycles is not None:
            line += f" {cycles}"
        with self._turn:
            self._set_deadman()
            self._ended = None
            try:
                self.ask(line)
            except RobotError:
                self._ended = ""
                self._restore_deadman()
                raise
        if cycles is not None:
            self.wait()

    def walk(self, cycles: int | None = None) -> None:
        """Starts to walk; with a number of cycles, waits until they are done."""
        self.go("walk", cycles)

    def wait(self, timeout: float | None = None) -> None:
        """Waits for the end of counted cycles, or of a routine.

        Raises TimeoutError after so many seconds, RobotError if the robot stops for another reason.
        """
        if not self._wait(lambda: self._ended is not None, timeout):
            raise TimeoutError(f"the robot still goes after {timeout} s")
        self._restore_deadman()
        if self._ended:
            raise RobotError(self._ended)

    def stop(self) -> None:
        """Freezes the robot in the next frame. The line is sent until the robot answers it, for five seconds.

        Nothing happens if it has no pulses.
        """
        if not self._turn.acquire(blocking=False):
            self._write("stop")  # ahead of the line that waits for its answer
            self._turn.acquire()
        try:
            end = time.monotonic() + STOPPING
            while True:
                try:
                    return self._end_gait("stop", ANSWER / 4)
                except RobotError as error:
                    if error.code in NO_PULSES:
                        return None
                    if not isinstance(error, _Silent) or time.monotonic() >= end:
                        raise
        finally:
            self._turn.release()

    def rest(self) -> None:
        """Ends the pulses: the servos go limp. `stand` wakes them."""
        self._end_gait("rest")

    def stand(self) -> None:
        """Goes to the neutral pose, and wakes the servos after `rest`."""
        self._end_gait("stand")

    def speed(self, percent: int) -> None:
        """Sets the pace of gaits, 10 to 100 percent."""
        self.ask(f"speed {percent}")

    def pose(self, *angles: float) -> tuple[float, ...]:
        """Returns the servo angles, deg; with four angles, goes there first and waits until they are reached.

        Raises RobotError if the pose is refused, or the robot stops on the way.
        """
        if angles:
            self._end_gait("pose " + " ".join(f"{angle:.2f}" for angle in angles))
            self._reach(angles)
        return self.status().pose

    def _reach(self, angles: tuple[float, ...]) -> None:
        pose: tuple[float, ...] = ()
        moved = time.monotonic()
        while True:
            status = self.status()
            off = (math.remainder(a - b, 360) for a, b in zip(status.pose, angles))
            if all(abs(angle) < ROUNDING for angle in off):
                return
            now = time.monotonic()
            if status.pose != pose:
                pose, moved = status.pose, now
            elif status.gait != "pose" or now - moved > STANDING:
                why = f"guard {status.guard}, fault {status.fault}"
                raise RobotError(f"the robot has stopped before the pose: {why}")
            time.sleep(FRAME)

    def status(self) -> Status:
        """Asks for the robot's state."""
        return Status.parse(self.ask("status")[-1])

    def watch(self, every: int = 1) -> Iterator[Frame]:
        """Yields the pose of every so many frames of 20 ms, until the loop over it ends."""
        frames: SimpleQueue[Frame] = SimpleQueue()
        self._watchers.append(frames)
        try:
            self.ask(f"watch {every}")
            while True:
                try:
                    frame = frames.get(timeout=every * FRAME + ANSWER)
                except Empty:
                    self._check()
                    raise RobotError("the robot no longer sends its poses") from None
                yield frame
        finally:
            self._watchers.remove(frames)
            if self._gone is None and not self._closing.is_set():
                self.ask("watch 0")

    def ask(self, line: str) -> list[str]:
        """Sends a line of the console; returns the `#` lines before its answer, and the answer.

        Raises RobotError if the robot refuses it. `deadman` is left as it is.
        """
        return self._ask(line, ANSWER)

    def _end_gait(self, line: str, timeout: float = ANSWER) -> None:
        with self._turn:
            self._ask(line, timeout)
            self._end(f"`{line}` has ended the gait")
            self._restore_deadman()

    def _ask(self, line: str, timeout: float) -> list[str]:
        line = line.strip().lower()
        word = line.split(" ")[0]
        ok = "ok gait=" if word == "status" else f"ok {word}"
        with self._turn:
            self._check()
            with self._news:
                self._answers, self._notes = [], []
            self._write(line)
            answer = ""

            def has_answer() -> bool:
                nonlocal answer
                fits = (text for text in self._answers if text.startswith((ok, "err ")))
                answer = next(fits, "")
                return answer != ""

            if not self._wait(has_answer, timeout):
                raise _Silent(f"the robot does not answer to `{line}`")
            if answer.startswith("err "):
                code, reason = answer.split(" ", 2)[1:]
                refusal = RobotError(f"the robot refuses `{line}`: {reason}")
                refusal.code = int(code)
                raise refusal
            return [*self._notes, answer]

    def _write(self, line: str) -> None:
        try:
            self._port.write(f"{line}\n".encode("ascii"))
        except OSError as error:
            self._gone = error
            self._check()

    def _wait(self, ready: Callable[[], bool], timeout: float | None) -> bool:
        with self._news:
            found = self._news.wait_for(
                lambda: ready() or self._gone is not None, timeout
            )
            self._check()
            return found

    def _check(self) -> None:
        if self._gone is not None:
            raise ConnectionError(
                "the port is gone: the board was unplugged, or its cable is loose"
            ) from self._gone
        if self._closing.is_set():
            raise RobotError("this robot is closed")

    def _set_deadman(self) -> None:
        if self._driven is not None:
            return
        if self._own is None:
            notes = self.ask("cal")
            own = next(
                int(note.split()[-1]) for note in notes if note.startswith("# deadman ")
            )
            self._own = 0 if own == DRIVEN else own
        driven = min(self._own or DRIVEN, DRIVEN)
        self.ask(f"deadman {driven}")
        self._driven = driven

    def _restore_deadman(self) -> None:
        with self._turn:
            if self._driven is not None:
                self.ask(f"deadman {self._own}")
                self._driven = None

    def _keep_going(self) -> None:
        """Sends a line at least every third of `deadman`, as long as this program drives."""
        turn = 0
        while not self._closing.wait(min(0.2, (self._driven or DRIVEN) / 4000)):
            with self._turn:
                if self._driven is None or self._ended is not None:
                    continue
                turn += 1
                try:
                    if turn % 5:
                        self._ask(f"deadman {self._driven}", ANSWER / 4)
                        continue
                    # A radio may have lost the line that says the end.
                    status = Status.parse(self._ask("status", ANSWER / 4)[-1])
                except RobotError:
                    continue
                except OSError:
                    return
                if status.gait in ("pose", "stop", "rest"):
                    self._end(
                        ""
                        if status.fault == "none"
                        else f"the robot has stopped: {status.fault}"
                    )

    def _end(self, why: str) -> None:
        with self._news:
            if self._ended is None:
                self._ended = why
            self._news.notify_all()

    def _listen(self) -> None:
        rest = b""
        while not self._closing.is_set():
            try:
                rest += self._port.read()
            except OSError as error:
                with self._news:
                    self._gone = error
                    self._news.notify_all()
                return
            *lines, rest = rest.split(b"\n")
            rest = rest[-512:]  # noise may have no end
            for line in lines:
                self._hear(line.decode("ascii", "replace").strip())

    def _hear(self, line: str) -> None:
        line = line[max(0, line.find(BANNER)) :]  # a reset cuts off the line before
        with self._news:
            if line.startswith("# t="):
                fields = dict(word.split("=", 1) for word in line[2:].split())
                frame = Frame(int(fields["t"]) * FRAME, _angles(fields["pose"]))
                for watcher in self._watchers:
                    watcher.put(frame)
            elif line.startswith(BANNER):
                if self._is_up:
                    self._driven = None  # Its settings are the saved ones again.
                    self._end("the robot was reset")
                self._is_up = True
            elif line == "# done":
                self._end("")
            elif line.startswith("# fault: "):
                self._end(f"the robot has stopped: {line.removeprefix('# fault: ')}")
            elif line.startswith("#"):
                self._notes.append(line)
            elif line:
                self._answers.append(line)
            self._news.notify_all()


def _angles(text: str) -> tuple[float, ...]:
    return tuple(float(angle) for angle in text.split(",") if angle)
