"""The answers of a robot: its state, its pose in a frame, and the reasons for its refusals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


class RobotError(RuntimeError):
    """The robot refuses a line, stops by itself, was reset, or does not answer."""

    code: int | None = None
    """Code of a refusal, from the list in docs/console.md."""


class Frame(NamedTuple):
    """The pose that the servos are sent in a frame, and the time of the frame."""

    time: float
    """Seconds since the robot's start."""
    pose: tuple[float, ...]
    """Servo angles, deg."""


@dataclass(frozen=True)
class Status:
    """The robot's answer to `status`; a field that it does not send is NaN, 0 or empty."""

    gait: str
    """A routine or gait, with hyphens in its name; otherwise `pose`, `stop` or `rest`."""
    fault: str
    """`none`, or the reason why the robot has stopped by itself."""
    guard: str
    """`clear`, or `held` if the guard has stopped a move."""
    reset: str
    """Cause of the last reset."""
    pose: tuple[float, ...]
    """Servo angles, deg."""
    margin: float
    """Smallest margin of the pose, a sine."""
    phase: float
    """Phase of the gait, 0 to 1."""
    vcc: float
    """Supply voltage of the board, V."""
    rail: float
    """Supply voltage of the servos, V."""
    speed: int
    """Pace of gaits, percent."""
    frames: int
    """Number of frames of 20 ms since the robot's start."""
    late: int
    """Number of pulse edges that were late."""
    rx_lost: int
    """Number of received bytes that were lost."""
    resets: int
    """Number of resets since power-on."""

    @staticmethod
    def parse(answer: str) -> Status:
        """Parses `ok gait=...`; fields that this version does not know are skipped."""
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
            pose=angles(fields.get("pose", "")),
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


def angles(text: str) -> tuple[float, ...]:
    """Parses the angles of `pose=`, deg."""
    return tuple(float(angle) for angle in text.split(",") if angle)
