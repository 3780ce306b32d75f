"""The robot as an environment of Gymnasium, on the physics engine MuJoCo: `gymnasium.make("lizard.gym:Lizard-v0")`.

An import of this module registers `Lizard-v0`, of 250 frames.
"""

from __future__ import annotations

import math
from typing import Any

import gymnasium
import mujoco
import numpy as np
from numpy.typing import NDArray

from lizard._ports import FRAME
from lizard.model import Array, Model

REACH = 30.0
"""Sweep of a servo from neutral that the actions -1 and 1 ask for, deg."""
STEP = 0.001
"""Step of the engine, s: the coarsest with which a cycle of each gait is as long as with 0.2 ms, within 2 %."""
SETTLING = 0.5
"""Seconds in which the robot comes to rest on the floor before the first frame."""


class LizardEnv(gymnasium.Env[NDArray[np.float32], NDArray[np.float32]]):
    """The robot on a level floor; a step is a frame of 20 ms.

    Action, (4,), -1 to 1: the targets of A1 to A4 as sweeps from neutral, counter-clockwise positive, in units of
    30 deg. As on the board, a target is approached at most as fast as `[limits] gait_slew`, and a pose that breaks a
    limit is not taken: the last safe one is held.

    Observation, (15,): the servos' sweeps (rad) and rates (rad/s), the body's velocity forward and to the left (m/s)
    and its turn (rad/s), and the targets (rad).

    Reward: mm forward, as seen from the start. `info` has the place: `forward` and `left` (mm), `turn` (deg), and
    `held`, true if the action was not taken.

    A seed decides the friction of the floor, which differs from robot.toml's by up to `friction_spread`.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012

    def __init__(
        self,
        model: Model | None = None,
        friction_spread: float = 0.1,
        step: float = STEP,
    ) -> None:
        self.robot = model or Model.default()
        self.engine = mujoco.MjModel.from_xml_string(self.robot.mjcf(shapes=False))
        if self.engine.numeric("back over forward").data[0] != 1:
            raise ValueError("[ground] ratio is not 1: MuJoCo has no pads with a grain")
        _coarsen(self.engine, step)
        self.data = mujoco.MjData(self.engine)
        self.friction_spread = friction_spread
        self._substeps = round(FRAME / step)
        self._friction = self.engine.geom_friction.copy()
        joints = [
            self.engine.actuator(name).trnid[0] for name in ("A1", "A2", "A3", "A4")
        ]
        self._angles = self.engine.jnt_qposadr[joints]
        self._rates = self.engine.jnt_dofadr[joints]
        self._most = math.radians(self.robot.gait_slew) * FRAME
        self._target: Array = np.zeros(4)
        self._place = (0.0, 0.0, 0.0)
        mujoco.mj_step(self.engine, self.data, round(SETTLING / step))
        self._rest = self.data.qpos.copy()
        self.action_space = gymnasium.spaces.Box(-1, 1, (4,), np.float32)
        self.observation_space = gymnasium.spaces.Box(
            -np.inf, np.inf, (15,), np.float32
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        super().reset(seed=seed)
        mujoco.mj_resetData(self.engine, self.data)
        self.data.qpos[:] = self._rest
        spread = self.friction_spread
        self.engine.geom_friction[:, 0] = self._friction[:, 0] * self.np_random.uniform(
            1 - spread, 1 + spread
        )
        mujoco.mj_forward(self.engine, self.data)
        self._target = np.zeros(4)
        self._place = self._now()
        return self._observation(), self._info(False)

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        wanted = np.clip(action, -1, 1) * math.radians(REACH)
        target = self._target + np.clip(wanted - self._target, -self._most, self._most)
        held = not self.robot.solve(self.robot.neutral + np.degrees(target)).safe
        if not held:
            self._target = target
        self.data.ctrl[:] = self._target
        before = self._forward()
        mujoco.mj_step(self.engine, self.data, self._substeps)
        broken = not np.isfinite(self.data.qpos).all()
        reward = 0.0 if broken else self._forward() - before
        return self._observation(), reward, broken, False, self._info(held)

    def _now(self) -> tuple[float, float, float]:
        """Place of the chassis: to the right and forward, mm, and heading, rad."""
        x, y, _, w, qx, qy, qz = self.data.qpos[:7]
        heading = math.atan2(2 * (w * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        return 1000 * x, 1000 * y, heading

    def _forward(self) -> float:
        return 1000 * float(self.data.qpos[1])

    def _observation(self) -> NDArray[np.float32]:
        heading = self._now()[2]
        vx, vy = self.data.qvel[:2]
        cos, sin = math.cos(heading), math.sin(heading)
        body = [vy * cos - vx * sin, -vx * cos - vy * sin, self.data.qvel[5]]
        servos = [self.data.qpos[self._angles], self.data.qvel[self._rates]]
        return np.concatenate(
            [*servos, body, self._target], dtype=np.float32, casting="same_kind"
        )

    def _info(self, held: bool) -> dict[str, Any]:
        x, y, heading = self._now()
        turn = math.remainder(heading - self._place[2], math.tau)
        forward, left = y - self._place[1], self._place[0] - x
        return {
            "forward": forward,
            "left": left,
            "turn": math.degrees(turn),
            "held": held,
        }


def _coarsen(engine: mujoco.MjModel, step: float) -> None:
    """Sets the engine's step, for which constraints must be softer, and the faster of two equal solvers."""
    engine.opt.timestep = step
    engine.opt.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE
    engine.opt.tolerance, engine.opt.noslip_iterations = 1e-6, 0
    for stiff in (engine.eq_solref, engine.geom_solref, engine.jnt_solref):
        stiff[:, 0] = np.maximum(stiff[:, 0], 2 * step)


gymnasium.register(
    "Lizard-v0", entry_point="lizard.gym:LizardEnv", max_episode_steps=250
)
