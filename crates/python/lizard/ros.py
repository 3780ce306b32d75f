"""Support for ROS: the joints of the robot's URDF, and gaits for a commanded velocity. The module does not need ROS."""

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
"""Time without a velocity after which the robot stops, s."""
TURN_LEVER_ARM = 0.1
"""Distance that weighs as much as a turn of 1 rad, m: about the distance from the body's centre to a foot."""
MIN_PACE = 0.1
"""Smallest pace of a gait, as a fraction of its nominal rate."""


def joint_values(model: Model, poses: ArrayLike) -> Array:
    """Computes the values of `JOINTS` (..., 12), rad and m, at poses (..., 4), deg; all are 0 at neutral."""

    def joint_angles(poses: ArrayLike) -> Array:
        servos, solved = np.asarray(poses, np.float64), model.solve(poses)
        # theta2 and theta3 belong to A1 and A2, theta7 and theta6 to A3 and A4; the left sleeve to A4, the right to A3.
        couplers = solved.couplers[..., [0, 1, 3, 2]] - servos
        sleeves = solved.slider_directions - servos[..., [3, 2]]
        return np.concatenate([servos, couplers, sleeves], axis=-1)

    turns = np.radians(joint_angles(poses) - joint_angles(model.neutral))
    turns = np.remainder(turns + np.pi, 2 * np.pi) - np.pi
    rods = model.solve(poses).strokes - model.solve(model.neutral).strokes
    return np.concatenate([turns, rods / 1000], axis=-1)


@dataclass(frozen=True)
class GaitVelocity:
    """A gait's velocity at its nominal rate, predicted by the contact model."""

    gait: str
    forward: float
    """m/s"""
    turn: float
    """rad/s, counter-clockwise"""


class Driver:
    """Drives a robot at given velocities, such as those of `cmd_vel`, with the gait and the pace nearest to them."""

    def __init__(self, robot: Robot, model: Model) -> None:
        """Prepares the model's gaits for a connected robot with the same robot.toml."""
        self._robot = robot
        self._last_velocity_time = 0.0
        self._current: tuple[str, int] | None = None  # gait and pace, percent
        gaits = [model.gait(name) for name in model.gaits]
        movements = [(gait, gait.predict(with_servos=True)) for gait in gaits]
        self.velocities = [
            GaitVelocity(
                gait.name,
                movement.forward / 1000 / gait.period,
                np.radians(movement.turn) / gait.period,
            )
            for gait, movement in movements
            if np.isfinite([movement.forward, movement.turn]).all()
        ]

    def choose_gait(self, forward: float, turn: float) -> tuple[str, int] | None:
        """Finds the gait and the pace, percent, nearest to a velocity in m/s and rad/s; None if standing is nearer."""
        target = np.array([forward, TURN_LEVER_ARM * turn])
        nearest, min_square_error = None, float(target @ target)
        for velocity in self.velocities:
            nominal = np.array([velocity.forward, TURN_LEVER_ARM * velocity.turn])
            if (nominal_square := nominal @ nominal) == 0:
                continue
            pace = np.clip(target @ nominal / nominal_square, MIN_PACE, 1)
            error = target - pace * nominal
            if error @ error < min_square_error:
                nearest = (velocity.gait, round(100 * pace))
                min_square_error = float(error @ error)
        return nearest

    def drive(self, forward: float, turn: float) -> None:
        """Drives at a velocity in m/s and rad/s; afterwards, call `stop_if_silent` several times per second.

        Raises RobotError if the robot refuses or has stopped by itself; the next velocity starts it again.
        """
        self._last_velocity_time = time.monotonic()
        if self._current and not self._robot.is_going:
            self._current = None
            self._robot.wait(0)  # raises the reason
        target, current = self.choose_gait(forward, turn), self._current
        if target is None:
            if current or self._robot.is_going:
                self.stop()
            return
        if target == current:
            return
        gait, pace = target
        self._robot.speed(pace)
        if current is None or current[0] != gait:
            self._current = None
            self._robot.go(gait)
        self._current = target

    def stop_if_silent(self) -> None:
        """Stops the robot if no velocity has arrived for `TIMEOUT`."""
        is_moving = self._current or self._robot.is_going
        if is_moving and time.monotonic() - self._last_velocity_time > TIMEOUT:
            self.stop()

    def stop(self) -> None:
        """Stops the robot, and restores the nominal rate of its gaits."""
        self._current = None
        self._robot.stop()
        self._robot.speed(100)
