"""The robot as a Gymnasium environment, simulated with MuJoCo: `gymnasium.make("lizard.gym:Lizard-v0")`.

Importing this module registers `Lizard-v0`, whose episodes last 250 frames.
"""

from __future__ import annotations

import math
from typing import Any

import gymnasium
import mujoco
import numpy as np
from numpy.typing import NDArray

from lizard._ports import FRAME_PERIOD
from lizard.model import Array, Model

MAX_SWEEP = 30.0
"""Sweep from neutral that corresponds to the action 1, deg."""
TIMESTEP = 0.001
"""Engine time step, s: the largest for which the movement in a cycle differs by at most 2 % from that at 0.2 ms."""
SETTLING_TIME = 0.5
"""Time before the first frame in which the robot settles on the floor, s."""
DIVERGENCES = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)
"""The engine's warnings about a simulation that diverges."""


class LizardEnv(gymnasium.Env[NDArray[np.float32], NDArray[np.float32]]):
    """The robot on a level floor; each call of `step` simulates one frame of 20 ms.

    Action, (4,), -1 to 1: the targets of A1 to A4 as sweeps from neutral, counter-clockwise positive, in units of
    30 deg. As on the board, `[limits] gait_slew` limits the speed, and a pose that violates a limit is refused: the
    last safe pose is held.

    Observation, (15,): the servos' sweeps (rad) and rates (rad/s), the body's velocity forward and to the left (m/s)
    and turn rate (rad/s), and the targets (rad).

    Reward: the distance moved in this frame along the initial forward axis, mm. `info` has the displacement from the
    start, `forward` and `left` (mm) and `turn` (deg), and `held`, true if the action was refused.

    A seed determines the floor's friction, which differs from the value in robot.toml by a fraction of at most
    `friction_spread`.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012

    def __init__(
        self,
        model: Model | None = None,
        friction_spread: float = 0.1,
        timestep: float = TIMESTEP,
    ) -> None:
        self.model = model or Model.default()
        self.engine = mujoco.MjModel.from_xml_string(self.model.mjcf(shapes=False))
        if self.engine.numeric("back over forward").data[0] != 1:
            raise ValueError(
                "[ground] friction_back_over_forward must be 1: MuJoCo cannot simulate pads with a grain"
            )
        # A frame has a whole number of steps.
        self._substeps = max(1, round(FRAME_PERIOD / timestep))
        timestep = FRAME_PERIOD / self._substeps
        _set_timestep(self.engine, timestep)
        self.data = mujoco.MjData(self.engine)
        self.friction_spread = friction_spread
        self._nominal_friction = self.engine.geom_friction.copy()
        joints = [
            self.engine.actuator(name).trnid[0] for name in ("A1", "A2", "A3", "A4")
        ]
        self._qpos_indices = self.engine.jnt_qposadr[joints]
        self._qvel_indices = self.engine.jnt_dofadr[joints]
        self._max_change = math.radians(self.model.gait_slew) * FRAME_PERIOD
        self._target: Array = np.zeros(4)
        self._start_pose = (0.0, 0.0, 0.0)
        mujoco.mj_step(self.engine, self.data, round(SETTLING_TIME / timestep))
        self._settled_qpos = self.data.qpos.copy()
        self.action_space = gymnasium.spaces.Box(-1, 1, (4,), np.float32)
        self.observation_space = gymnasium.spaces.Box(
            -np.inf, np.inf, (15,), np.float32
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        super().reset(seed=seed)
        mujoco.mj_resetData(self.engine, self.data)
        self.data.qpos[:] = self._settled_qpos
        spread = self.friction_spread
        scale = self.np_random.uniform(1 - spread, 1 + spread)
        self.engine.geom_friction[:, 0] = scale * self._nominal_friction[:, 0]
        mujoco.mj_forward(self.engine, self.data)
        self._target = np.zeros(4)
        self._start_pose = self._chassis_pose()
        return self._observation(), self._info(False)

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        target_sweeps = np.clip(action, -1, 1) * math.radians(MAX_SWEEP)
        target = self._target + np.clip(
            target_sweeps - self._target, -self._max_change, self._max_change
        )
        is_held = not self.model.solve(self.model.neutral + np.degrees(target)).safe
        if not is_held:
            self._target = target
        self.data.ctrl[:] = self._target
        previous_forward = self._forward_mm()
        mujoco.mj_step(self.engine, self.data, self._substeps)
        # If the simulation diverges, the engine moves the robot back to its start, and counts a warning.
        has_diverged = any(self.data.warning[kind].number for kind in DIVERGENCES)
        reward = 0.0 if has_diverged else self._forward_mm() - previous_forward
        return self._observation(), reward, has_diverged, False, self._info(is_held)

    def _chassis_pose(self) -> tuple[float, float, float]:
        """Returns the position of the chassis, to the right and forward (mm), and the heading (rad)."""
        x, y, _, w, qx, qy, qz = self.data.qpos[:7]
        heading = math.atan2(2 * (w * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        return 1000 * x, 1000 * y, heading

    def _forward_mm(self) -> float:
        return 1000 * float(self.data.qpos[1])

    def _observation(self) -> NDArray[np.float32]:
        heading = self._chassis_pose()[2]
        vx, vy = self.data.qvel[:2]
        cos, sin = math.cos(heading), math.sin(heading)
        body = [vy * cos - vx * sin, -vx * cos - vy * sin, self.data.qvel[5]]
        servos = [
            self.data.qpos[self._qpos_indices],
            self.data.qvel[self._qvel_indices],
        ]
        return np.concatenate(
            [*servos, body, self._target], dtype=np.float32, casting="same_kind"
        )

    def _info(self, is_held: bool) -> dict[str, Any]:
        x, y, heading = self._chassis_pose()
        turn = math.remainder(heading - self._start_pose[2], math.tau)
        forward, left = y - self._start_pose[1], self._start_pose[0] - x
        return {
            "forward": forward,
            "left": left,
            "turn": math.degrees(turn),
            "held": is_held,
        }


def _set_timestep(engine: mujoco.MjModel, timestep: float) -> None:
    """Sets the engine's time step, softens the constraints accordingly, and selects faster solver settings."""
    engine.opt.timestep = timestep
    engine.opt.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE
    engine.opt.tolerance, engine.opt.noslip_iterations = 1e-6, 0
    for solref in (engine.eq_solref, engine.geom_solref, engine.jnt_solref):
        solref[:, 0] = np.maximum(solref[:, 0], 2 * timestep)


gymnasium.register(
    "Lizard-v0", entry_point="lizard.gym:LizardEnv", max_episode_steps=250
)
