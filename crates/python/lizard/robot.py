"""A board to drive, over a serial port or simulated: the words are those of docs/console.md."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator
from queue import Empty, SimpleQueue
from typing import Self

from lizard._ports import FRAME, Port, SerialPort, SimulatedPort
from lizard.model import Model
from lizard.status import Frame, RobotError, Status
from lizard.status import angles as read_angles

BAUD = 115_200
BANNER = "# lizard "
GREETING = 3.0
"""Seconds for the banner after the port is opened, of which a UNO's boot loader takes more than one."""
ASKS = 8
"""Lines `status` to a board that sends no banner: it finds the rate by five, and a radio may lose some."""
ANSWER = 2.0
"""Seconds for an answer; `save` takes a third of one."""
INSISTING = 5.0
"""Seconds for which a line that may be sent twice is sent to a robot that does not answer."""
NO_PULSES = (7, 10)
"""Codes of `stop` that is refused: the servos rest, or the flash has no robot."""
STANDING = 1.0
"""Seconds after which a robot that does not move has not reached its pose."""
ROUNDING = 0.02
"""Difference, deg, of a pose that was sent and one that `status` prints, for which the core rounds."""
DRIVEN = 901
"""`deadman` while a program drives, ms: no person sets this number, so one that is found was left behind."""


class NoAnswer(RobotError):
    """The robot has not answered in time."""


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
            except NoAnswer:
                self._ended = ""  # If it goes, `deadman` stops it.
                raise
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

    @property
    def is_going(self) -> bool:
        """True while a gait or a routine goes."""
        return self._ended is None

    def stop(self) -> None:
        """Freezes the robot in the next frame. The line is sent until the robot answers it, for five seconds.

        Nothing happens if it has no pulses.
        """
        if not self._turn.acquire(blocking=False):
            self._write("stop")  # ahead of the line that waits for its answer
            self._turn.acquire()
        try:
            self._end_gait("stop")
        except RobotError as error:
            if error.code not in NO_PULSES:
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
        return Status.parse(self._insist("status")[-1])

    def watch(self, every: int = 1) -> Iterator[Frame]:
        """Yields the pose of every so many frames of 20 ms, until the loop over it ends."""
        if every < 1:
            raise ValueError(f"every so many frames: at least 1, not {every}")
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
                self._insist("watch 0")

    def ask(self, line: str) -> list[str]:
        """Sends a line of the console; returns the `#` lines before its answer, and the answer.

        Raises RobotError if the robot refuses it. `deadman` is left as it is.
        """
        return self._ask(line, ANSWER)

    def _end_gait(self, line: str) -> None:
        with self._turn:
            self._insist(line)
            self._end(f"`{line}` has ended the gait")
            self._restore_deadman()

    def _insist(self, line: str) -> list[str]:
        """Sends a line until it is answered, because a radio may lose it."""
        end = time.monotonic() + INSISTING
        while True:
            try:
                return self._ask(line, ANSWER / 2)
            except NoAnswer:
                if time.monotonic() >= end:
                    raise

    def _ask(self, line: str, timeout: float) -> list[str]:
        line = line.strip().lower()
        if not (line.isascii() and line.isprintable() and line):
            raise ValueError(f"a line of the console is ASCII, not {line!r}")
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
                raise NoAnswer(f"the robot does not answer to `{line}`")
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
            notes = self._insist("cal")
            own = next(
                int(note.split()[-1]) for note in notes if note.startswith("# deadman ")
            )
            self._own = 0 if own == DRIVEN else own
        driven = min(self._own or DRIVEN, DRIVEN)
        self._insist(f"deadman {driven}")
        self._driven = driven

    def _restore_deadman(self) -> None:
        with self._turn:
            if self._driven is not None:
                self._insist(f"deadman {self._own}")
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
                frame = Frame(int(fields["t"]) * FRAME, read_angles(fields["pose"]))
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
