"""Serial ports: a port of this machine, and the port of a board simulated in real time."""

from __future__ import annotations

import threading
import time
from typing import Protocol

import serial

from lizard import _lizard

FRAME_PERIOD = 0.02
"""Time from one frame to the next, s."""


class Port(Protocol):
    """A serial port. `read` waits for at most one frame, and returns b"" if no byte has arrived."""

    def read(self) -> bytes: ...
    def write(self, data: bytes) -> None: ...
    def close(self) -> None: ...


class SerialPort:
    """A port of this machine; raises OSError if the port has disappeared."""

    def __init__(self, name: str, baud: int) -> None:
        self._serial = serial.Serial(name, baud, timeout=FRAME_PERIOD, exclusive=True)

    def read(self) -> bytes:
        return bytes(self._serial.read(self._serial.in_waiting or 1))

    def write(self, data: bytes) -> None:
        self._serial.write(data)

    def close(self) -> None:
        self._serial.close()


class SimulatedPort:
    """The firmware's core without a chip, which runs one frame every 20 ms."""

    def __init__(self, robot: _lizard.Robot) -> None:
        self.board = _lizard.Board(robot)
        self._unread = bytearray()
        self._lock = threading.Lock()
        self._next_frame_time = time.monotonic()

    def read(self) -> bytes:
        self._next_frame_time += FRAME_PERIOD
        time.sleep(max(0.0, self._next_frame_time - time.monotonic()))
        with self._lock:
            data = bytes(self._unread)
            self._unread.clear()
        return self.board.run_frame(data).encode()

    def write(self, data: bytes) -> None:
        with self._lock:
            self._unread += data

    def close(self) -> None:
        pass
