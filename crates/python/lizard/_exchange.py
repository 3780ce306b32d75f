"""Exchanges of console lines and answers with a robot."""

from __future__ import annotations

import threading
from collections.abc import Callable

from lizard._ports import Port
from lizard.status import NoAnswer, RobotError, make_answer_pattern


class Exchange:
    """The lines sent through a port and their answers, which a listener thread receives."""

    def _open_exchange(self, port: Port) -> None:
        self._port = port
        # Held while a line waits for its answer.
        self._exchange_lock = threading.RLock()
        # Guards the fields that the listener changes.
        self._condition = threading.Condition()
        self._answers: list[str] = []
        self._notes: list[str] = []
        self._port_error: OSError | None = None
        self._closing = threading.Event()

    def _send(self, line: str, timeout: float) -> list[str]:
        line = line.strip().lower()
        pattern = make_answer_pattern(line)
        with self._exchange_lock:
            self._check_open()
            with self._condition:
                self._answers, self._notes = [], []
            self._write(line)

            def find_answers() -> list[str]:
                return [text for text in self._answers if pattern.match(text)]

            if not self._wait_until(lambda: find_answers() != [], timeout):
                raise NoAnswer(f"the robot does not answer `{line}`")
            answer = find_answers()[0]
            if answer.startswith("err "):
                raise RobotError.parse(line, answer)
            return [*self._notes, answer]

    def _write(self, line: str) -> None:
        try:
            self._port.write(f"{line}\n".encode("ascii"))
        except OSError as error:
            self._port_error = error
            self._check_open()

    def _wait_until(self, is_ready: Callable[[], bool], timeout: float | None) -> bool:
        """Waits until `is_ready` is true; returns False after `timeout` seconds. Raises an error if the port closes."""
        with self._condition:
            was_ready = self._condition.wait_for(
                lambda: is_ready() or self._is_closed, timeout
            )
            self._check_open()
            return was_ready

    @property
    def _is_closed(self) -> bool:
        return self._port_error is not None or self._closing.is_set()

    def _check_open(self) -> None:
        if self._port_error is not None:
            raise ConnectionError(
                "the port is gone: the board was unplugged, or its cable is loose"
            ) from self._port_error
        if self._closing.is_set():
            raise RobotError("this robot is closed")
