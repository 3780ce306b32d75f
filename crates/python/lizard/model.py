"""The model of a robot.toml: the linkage's kinematics, and the gaits."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lizard import _lizard

Array = NDArray[np.float64]

MARGINS: tuple[str, ...] = tuple(_lizard.MARGINS)
"""Names of a pose's ten margins, in the order of `Solution.margins`."""


class Movement(NamedTuple):
    """Movement of the body; a component is NaN if two feet pull against the other two, so that it is undetermined."""

    forward: float
    """mm"""
    left: float
    """mm"""
    turn: float
    """deg, counter-clockwise"""


@dataclass(frozen=True)
class Solution:
    """Joints of the linkage at poses of shape (..., 4); NaN where a loop does not close."""

    head: Array
    """Head point, mm, (..., 2)."""
    tail: Array
    """Tail point, mm, (..., 2)."""
    couplers: Array
    """Coupler angles theta2, theta3 (head), theta6, theta7 (tail), deg, (..., 4)."""
    slider_directions: Array
    """Directions of the left and the right slider, rear to front, deg, (..., 2)."""
    strokes: Array
    """Strokes of the left and the right slider from nominal, mm, (..., 2)."""
    margins: Array
    """Sines, named by `MARGINS`, (..., 10): 1 is best, 0 is singular, a negative value means another assembly mode."""
    safe: NDArray[np.bool_]
    """True where the pose is within the limits and the servos' travel, (...)."""


@dataclass(frozen=True)
class Mobility:
    """The body's degrees of freedom at poses of shape (..., 4), from the rank of the constraints.

    Both are -1 where a loop does not close.
    """

    freedoms: NDArray[np.int_]
    """Degrees of freedom while the servos turn, (...): 4 away from singularities."""
    locked_freedoms: NDArray[np.int_]
    """Degrees of freedom while the servos are locked, (...): more than 0 at a type-2 singularity."""


@dataclass(frozen=True)
class Gait:
    """A checked gait, as the firmware outputs it: a frame every 20 ms."""

    name: str
    period: float
    """Cycle time, s."""
    times: Array
    """Times of a cycle's frames, s, (n,)."""
    angles: Array
    """Servo angles in each frame, deg, (n, 4)."""
    pulses: Array
    """Pulse widths in each frame, us, (n, 4)."""
    peak_speed: float
    """Largest servo speed over a frame, deg/s."""
    min_margin: tuple[str, float]
    """Name and value of the smallest margin in a cycle."""
    _robot: _lizard.Robot

    def predict(self, *, with_servos: bool = False) -> Movement:
        """Predicts the movement per cycle in the contact model, with ideal servos or with those in robot.toml."""
        return Movement(*self._robot.predict(self.name, with_servos))


class Model:
    """A robot whose values and gaits have been checked.

    Arrays of poses have any shape that ends with 4 (servos A1 to A4); arrays of points have any shape that ends with 2.
    """

    def __init__(self, robot: _lizard.Robot) -> None:
        self._robot = robot

    @staticmethod
    def from_toml(source: str | os.PathLike[str]) -> Model:
        """Reads a robot.toml file or its text; a str with a line break is text.

        Raises RobotFileError with the message of `lizard gaits`, and with the `file`, `line` and `key` of the error.
        """
        if isinstance(source, str) and "\n" in source:
            return Model(_lizard.Robot(source))
        return Model(_lizard.Robot.load(os.fspath(source)))

    @staticmethod
    def default() -> Model:
        """Creates the model of the project's robot.toml, which describes the paper's robot."""
        return Model(_lizard.Robot(default_toml()))

    def with_gait(self, table: str) -> Model:
        """Creates the same robot with only two gaits: `stand` and the gait with the robot.toml table `[gait.name]`.

        Raises RobotFileError, as `from_toml` does.
        """
        return Model(self._robot.with_gait(table))

    @property
    def name(self) -> str:
        """The robot's name, which the firmware prints."""
        return self._robot.name()

    @property
    def neutral(self) -> Array:
        """Neutral servo angles, at which the horns are fitted, deg, (4,)."""
        return np.array(self._robot.neutral())

    @property
    def travel(self) -> Array:
        """Smallest and largest sweep of each servo from neutral, deg, (4, 2)."""
        return np.array(self._robot.travel())

    @property
    def gait_slew(self) -> float:
        """Largest allowed servo speed of a gait, deg/s."""
        return self._robot.gait_slew()

    @property
    def gaits(self) -> list[str]:
        """Names of the gaits, in the order of the file."""
        return self._robot.gaits()

    def gait(self, name: str) -> Gait:
        """Returns a gait by its name; raises KeyError, which lists all names."""
        period, peak_speed, min_margin, times, angles = self._robot.gait(name)
        pulse_widths = self._robot.pulses(angles)
        # The words of a name may be separated by spaces, as on the console.
        name = name.replace(" ", "-")
        return Gait(
            name,
            period,
            times,
            angles,
            pulse_widths,
            peak_speed,
            min_margin,
            self._robot,
        )

    def solve(self, angles: ArrayLike) -> Solution:
        """Forward kinematics: computes all joints and margins for servo angles (..., 4), deg."""
        poses, shape = _to_rows(angles, 4)
        columns = self._robot.solve(poses).reshape(*shape, 23)
        head, tail, couplers, directions, strokes, margins, safe = np.split(
            columns, [2, 4, 8, 10, 12, 22], axis=-1
        )
        is_safe = safe[..., 0] > 0
        return Solution(head, tail, couplers, directions, strokes, margins, is_safe)

    def solve_inverse(
        self, head: ArrayLike | None = None, tail: ArrayLike | None = None
    ) -> Array:
        """Inverse kinematics: computes servo angles (..., 4), deg, for head and tail points (..., 2), mm.

        The elbows are outward, as on the built robot. The servos of an omitted end are at neutral; the servos of an end
        whose point is out of reach are NaN.
        """
        end_angles = [
            (servos, self.working_modes(name, points)[..., 0, :])
            for servos, name, points in [([0, 1], "head", head), ([3, 2], "tail", tail)]
            if points is not None
        ]
        shape = np.broadcast_shapes(*(values.shape[:-1] for _, values in end_angles))
        angles = np.broadcast_to(self.neutral, (*shape, 4)).copy()
        for servos, values in end_angles:
            angles[..., servos] = values
        return angles

    def working_modes(self, end: str, points: ArrayLike) -> Array:
        """Computes servo angles (..., 4, 2), deg, for points (..., 2), mm, of an end, "head" or "tail".

        The four working modes are outward-outward, outward-inward, inward-outward and inward-inward, the left elbow
        first; the two angles are those of the left and the right servo: A1, A2, or A4, A3. NaN where out of reach.
        """
        if end not in ("head", "tail"):
            raise ValueError(f'the end must be "head" or "tail", got {end!r}')
        rows, shape = _to_rows(points, 2)
        return self._robot.solve_inverse(end == "head", rows).reshape(*shape, 4, 2)

    def describe_violations(self, angles: ArrayLike) -> list[str]:
        """Returns messages with the reasons why a pose (4,), deg, is not safe; an empty list if it is safe."""
        poses, shape = _to_rows(angles, 4)
        if shape != ():
            raise ValueError(f"expected one pose of shape (4,), got {(*shape, 4)}")
        return self._robot.describe_violations(poses[0].tolist())

    def pulses(self, angles: ArrayLike) -> Array:
        """Computes pulse widths (..., 4), us, for servo angles (..., 4), deg, without trims."""
        poses, shape = _to_rows(angles, 4)
        return self._robot.pulses(poses).reshape(*shape, 4)

    def jacobians(self, angles: ArrayLike) -> tuple[Array, Array]:
        """Computes the derivatives K and K* of the eight loop equations, mm per radian, for servo angles (..., 4), deg.

        The columns of K (..., 8, 4) belong to theta1, theta4, theta8 and theta5; the columns of K* (..., 8, 8) belong
        to theta2, theta3, theta6 and theta7, and to the directions and strokes (mm per mm) of the left and the right
        slider. For changes da of the servo angles and dp of the other variables, K da + K* dp = 0.
        """
        poses, shape = _to_rows(angles, 4)
        rows = self._robot.jacobians(poses)
        active, passive = rows[:, :32], rows[:, 32:]
        return active.reshape(*shape, 8, 4), passive.reshape(*shape, 8, 8)

    def mobility(self, angles: ArrayLike) -> Mobility:
        """Computes the body's degrees of freedom for servo angles (..., 4), deg; -1 where a loop does not close."""
        active, passive = self.jacobians(angles)
        is_closed = np.asarray(np.isfinite(passive).all(axis=(-2, -1)))
        # Lengths are divided by 50 mm, about the length of a link, so that the elements are of the size of sines: then
        # a singular pose given to seven digits still counts as singular.
        scale = np.array([50.0, 50, 50, 50, 50, 1, 50, 1])
        passive = np.where(is_closed[..., None, None], passive, 0) / scale
        active = np.where(is_closed[..., None, None], active, 0) / 50
        combined = np.concatenate([active, passive], axis=-1)
        freedoms, locked = (
            count - np.linalg.matrix_rank(matrix, rtol=1e-7)
            for count, matrix in [(12, combined), (8, passive)]
        )
        return Mobility(
            np.where(is_closed, freedoms, -1), np.where(is_closed, locked, -1)
        )

    def section(self) -> bytes:
        """Builds the section of flash that describes the robot, including the maps of cells that are proved safe."""
        return self._robot.section()

    def image(self, *, only_robot: bool = False) -> str:
        """Builds the image for a board as Intel HEX: the firmware with this robot, or the robot alone."""
        return self._robot.image(only_robot)

    def mjcf(self, *, shapes: bool = True) -> str:
        """Builds the MuJoCo model that `lizard model` writes to an .xml file; without shapes, it is much shorter."""
        return self._robot.mjcf(shapes)


def default_toml() -> str:
    """Returns the text of the project's robot.toml, as a start for a robot file."""
    return _lizard.DEFAULT


def _to_rows(values: ArrayLike, width: int) -> tuple[Array, tuple[int, ...]]:
    """Reshapes an array (..., width) to rows (n, width); returns the rows, and the shape without the last axis."""
    array = np.asarray(values, np.float64)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ValueError(f"the last axis must have {width} numbers, got {array.shape}")
    return np.ascontiguousarray(array.reshape(-1, width)), array.shape[:-1]
