"""A robot for ROS: the joints of its URDF, and gaits for a commanded velocity. Nothing here needs ROS itself."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lizard.model import Array, Model
from lizard.robot import Robot

JOINTS = (
    *("A1", "A2", "A3", "A4"),
    *(f"coupler_{servo}_joint" for servo in ("A1", "A2", "A3", "A4")),
    *("sleeve_left_joint", "sleeve_right_joint", "rod_left_joint", "rod_right_joint"),
)
"""The joints of `lizard model robot.urdf` that do not mimic another joint, in the order of `joint_values`."""
TIMEOUT = 0.5
"""Seconds without a velocity after which the robot stops."""
TURN_LEVER_ARM = 0.1
"""Distance, m, that a turn of 1 rad counts as: that from the body's centre to a foot."""
MIN_PACE = 0.1
"""Smallest pace of a gait, as a share of its full pace."""


def joint_values(model: Model, poses: ArrayLike) -> Array:
    """Values of `JOINTS`, rad and m, at poses (..., 4), deg: (..., 12). All are 0 at neutral."""

    def angles(poses: ArrayLike) -> Array:
        servos, solved = np.asarray(poses, np.float64), model.solve(poses)
        # theta2, theta3 on A1, A2 and theta7, theta6 on A3, A4; the left sleeve on A4, the right one on A3.
        couplers = solved.couplers[..., [0, 1, 3, 2]] - servos
        sleeves = solved.directions - servos[..., [3, 2]]
        return np.concatenate([servos, couplers, sleeves], axis=-1)

    turns = np.radians(angles(poses) - angles(model.neutral))
    turns = np.remainder(turns + np.pi, 2 * np.pi) - np.pi
    rods = model.solve(poses).strokes - model.solve(model.neutral).strokes
    return np.concatenate([turns, rods / 1000], axis=-1)


@dataclass(frozen=True)
class Speed:
    """The velocity of a gait at its full pace, as the contact model predicts it."""

    gait: str
    forward: float
    """m/s"""
    turn: float
    """rad/s, counter-clockwise"""


class Driver:
    """Drives a robot by velocities, such as those of `cmd_vel`, with the gait and the pace that come nearest."""

    def __init__(self, robot: Robot, model: Model) -> None:
        """Prepares the gaits of the model for a connected robot with the same robot.toml."""
        self._robot = robot
        self._last_velocity_time = 0.0
        self._current: tuple[str, int] | None = None  # gait and pace, percent
        gaits = [model.gait(name) for name in model.gaits]
        travels = [(gait, gait.predict(with_servos=True)) for gait in gaits]
        self.speeds = [
            Speed(
                gait.name,
                travel.forward / 1000 / gait.period,
                np.radians(travel.turn) / gait.period,
            )
            for gait, travel in travels
            if np.isfinite([travel.forward, travel.turn]).all()
        ]

    def choose(self, forward: float, turn: float) -> tuple[str, int] | None:
        """Finds the gait and its pace, percent, for a velocity in m/s and rad/s; None if standing still is nearer."""
        target = np.array([forward, TURN_LEVER_ARM * turn])
        nearest, min_square = None, float(target @ target)
        for speed in self.speeds:
            full = np.array([speed.forward, TURN_LEVER_ARM * speed.turn])
            if (square := full @ full) == 0:
                continue
            pace = np.clip(target @ full / square, MIN_PACE, 1)
            error = target - pace * full
            if error @ error < min_square:
                nearest = (speed.gait, round(100 * pace))
                min_square = float(error @ error)
        return nearest

    def drive(self, forward: float, turn: float) -> None:
        """Drives at a velocity in m/s and rad/s; call `stop_if_silent` several times a second from then on.

        Raises RobotError if the robot refuses, or has stopped by itself; the next velocity starts it again.
        """
        self._last_velocity_time = time.monotonic()
        if self._current and not self._robot.is_going:
            self._current = None
            self._robot.wait(0)  # raises the reason
        target, current = self.choose(forward, turn), self._current
        if target == current:
            return
        if target is None:
            self.stop()
            return
        gait, pace = target
        self._robot.speed(pace)
        if current is None or current[0] != gait:
            self._current = None
            self._robot.go(gait)
        self._current = target

    def stop_if_silent(self) -> None:
        """Stops the robot if no velocity has arrived for `TIMEOUT`."""
        if self._current and time.monotonic() - self._last_velocity_time > TIMEOUT:
            self.stop()

    def stop(self) -> None:
        """Stops the robot, and restores the full pace of its gaits for whoever drives it next."""
        self._current = None
        self._robot.stop()
        self._robot.speed(100)
