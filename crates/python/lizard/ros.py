"""A robot for ROS: the joints of its URDF, and gaits for a wanted velocity. Nothing here needs ROS itself."""

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
"""The joints of `lizard model robot.urdf` that follow no other, in the order of `joint_values`."""
TIMEOUT = 0.5
"""Seconds without a velocity after which the robot stops."""
REACH = 0.1
"""Distance, m, as which a radian of turning counts: that from the body's middle to a foot."""
SLOWEST = 0.1
"""Least pace of a gait."""


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
    """Drives a robot by velocities, as `cmd_vel` has them: with the gait, and its pace, that come nearest."""

    def __init__(self, robot: Robot, model: Model) -> None:
        """Takes the gaits of a robot that is driven already, and of its robot.toml."""
        self._robot = robot
        self._heard = 0.0
        self._going: tuple[str, int] | None = None
        gaits = [model.gait(name) for name in model.gaits]
        ways = [(gait, gait.predict(with_servos=True)) for gait in gaits]
        self.speeds = [
            Speed(
                gait.name,
                way.forward / 1000 / gait.period,
                np.radians(way.turn) / gait.period,
            )
            for gait, way in ways
            if np.isfinite([way.forward, way.turn]).all()
        ]

    def choose(self, forward: float, turn: float) -> tuple[str, int] | None:
        """Finds the gait and its pace, percent, for a velocity in m/s and rad/s; None if standing comes nearer."""
        wanted = np.array([forward, REACH * turn])
        chosen, least = None, float(wanted @ wanted)
        for speed in self.speeds:
            full = np.array([speed.forward, REACH * speed.turn])
            if (square := full @ full) == 0:
                continue
            pace = np.clip(wanted @ full / square, SLOWEST, 1)
            off = wanted - pace * full
            if off @ off < least:
                chosen, least = (speed.gait, round(100 * pace)), float(off @ off)
        return chosen

    def drive(self, forward: float, turn: float) -> None:
        """Takes a velocity in m/s and rad/s; `stop_if_silent` has to follow several times a second.

        Raises RobotError if the robot refuses, or has stopped by itself; the next velocity starts it again.
        """
        self._heard = time.monotonic()
        if self._going and not self._robot.is_going:
            self._going = None
            self._robot.wait(0)  # raises the reason
        wanted, going = self.choose(forward, turn), self._going
        if wanted == going:
            return
        if wanted is None:
            self.stop()
            return
        gait, pace = wanted
        self._robot.speed(pace)
        if going is None or going[0] != gait:
            self._going = None
            self._robot.go(gait)
        self._going = wanted

    def stop_if_silent(self) -> None:
        """Stops the robot if no velocity has come for `TIMEOUT`."""
        if self._going and time.monotonic() - self._heard > TIMEOUT:
            self.stop()

    def stop(self) -> None:
        """Stops the robot, and gives its gaits their full pace back for whoever drives it next."""
        self._going = None
        self._robot.stop()
        self._robot.speed(100)
