"""A robot's answers: its state, its pose in a frame, and its refusals."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import NamedTuple

from lizard._ports import FRAME_PERIOD

POSE_TOLERANCE = 0.02
"""Largest rounding difference between a commanded angle and the angle in `status`, deg."""


class RobotError(RuntimeError):
    """The robot refused a line, stopped by itself, was reset, or did not answer."""

    code: int | None = None
    """Code of a refusal, as in the list in docs/console.md."""

    @staticmethod
    def parse(line: str, answer: str) -> RobotError:
        """Parses `err CODE REASON`, the answer to a line that the robot refuses."""
        code, reason = answer.split(" ", 2)[1:]
        refusal = RobotError(f"the robot refuses `{line}`: {reason}")
        refusal.code = int(code)
        return refusal


class NoAnswer(RobotError):
    """The robot did not answer in time."""


class Frame(NamedTuple):
    """A frame's time, and the pose that it sends to the servos."""

    time: float
    """Seconds since the robot's reset."""
    pose: tuple[float, ...]
    """Servo angles, deg."""

    @staticmethod
    def parse(line: str) -> Frame:
        """Parses `# t=... pose=...`; raises KeyError or ValueError if a radio has lost a part of the line."""
        fields = dict(word.split("=", 1) for word in line[2:].split())
        a1, a2, a3, a4 = parse_angles(fields["pose"])
        return Frame(int(fields["t"]) * FRAME_PERIOD, (a1, a2, a3, a4))


@dataclass(frozen=True)
class Status:
    """The robot's answer to `status`; a missing field is NaN, 0 or empty."""

    gait: str
    """The routine or gait, with hyphens in its name; otherwise `pose`, `stop` or `rest`."""
    fault: str
    """`none`, or the fault that stopped the robot."""
    guard: str
    """`clear`, or `held` if the guard has stopped a movement."""
    reset: str
    """Cause of the last reset."""
    pose: tuple[float, ...]
    """Servo angles, deg."""
    margin: float
    """The pose's smallest margin, a sine."""
    phase: float
    """The gait's phase, 0 to 1."""
    vcc: float
    """The board's supply voltage, V."""
    rail: float
    """The servos' supply voltage, V."""
    speed: int
    """Pace of gaits, percent."""
    frames: int
    """Number of frames of 20 ms since the robot's reset."""
    late: int
    """Number of late pulse edges."""
    rx_lost: int
    """Number of lost received bytes."""
    resets: int
    """Number of resets since power-on."""

    @staticmethod
    def parse(answer: str) -> Status:
        """Parses `ok gait=...`; ignores unknown fields."""
        fields = dict(word.split("=", 1) for word in answer.split() if "=" in word)

        def get_float(name: str) -> float:
            return float(fields.get(name, "nan"))

        def get_int(name: str) -> int:
            return int(fields.get(name, "0"))

        return Status(
            gait=fields.get("gait", ""),
            fault=fields.get("fault", ""),
            guard=fields.get("guard", ""),
            reset=fields.get("reset", ""),
            pose=parse_angles(fields.get("pose", "")),
            margin=get_float("margin"),
            phase=get_float("phase"),
            vcc=get_float("vcc"),
            rail=get_float("rail"),
            speed=get_int("speed"),
            frames=get_int("frames"),
            late=get_int("late"),
            rx_lost=get_int("rx_lost"),
            resets=get_int("resets"),
        )

    def has_pose(self, angles: tuple[float, ...]) -> bool:
        """True if the pose has these angles, deg, apart from rounding and whole turns."""
        if len(self.pose) != len(angles):
            return False
        errors = [math.remainder(a - b, 360) for a, b in zip(self.pose, angles)]
        return all(abs(error) < POSE_TOLERANCE for error in errors)


def parse_angles(text: str) -> tuple[float, ...]:
    """Parses the angles in `pose=`, deg."""
    return tuple(float(angle) for angle in text.split(",") if angle)


def make_answer_pattern(line: str) -> re.Pattern[str]:
    """Makes the pattern of the answers to a console line; raises ValueError for a line that cannot be sent."""
    if not (line.isascii() and line.isprintable() and line):
        raise ValueError(f"a console line must be printable ASCII, got {line!r}")
    word = line.split(" ")[0]
    start = "ok gait=" if word == "status" else f"ok {word}"
    # A refusal of which a radio has lost a part is no answer.
    return re.compile(rf"{re.escape(start)}|err \d+ ")


def parse_deadman(notes: list[str]) -> int:
    """Parses the robot's `deadman`, ms, in the answer to `cal`; raises NoAnswer if a radio has lost it."""
    match = re.search(r"^# deadman (\d+)$", "\n".join(notes), re.MULTILINE)
    if match is None:
        raise NoAnswer("the answer to `cal` has no `deadman`")
    return int(match[1])
