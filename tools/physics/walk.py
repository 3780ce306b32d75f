"""Walks a robot that `lizard mjcf` has written, by MuJoCo.

The file has a keyframe for each frame of 20 ms: its time and the servos' angles, which stay
set until the next frame begins, as by the pulses of the board.
"""

import math

import mujoco


class Walk:
    """The robot, its keyframes, and the beginning of the cycle that can be repeated."""

    def __init__(self, path):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        self.begin, self.period = None, None
        if self.model.nkey > 0:
            self.begin, self.period = self.model.numeric("cycle").data

    def frame(self, seconds):
        """The number of the keyframe at a time; after the last cycle, that cycle's again."""
        if seconds >= self.begin + self.period:
            seconds = self.begin + (seconds - self.begin) % self.period
        times = self.model.key_time
        frame = int((seconds + 1e-9) / (times[1] - times[0]))
        return min(frame, self.model.nkey - 1)

    def step(self):
        """Makes one step of the engine, with the servos set to the present frame's angles."""
        if self.model.nkey > 0:
            self.data.ctrl[:] = self.model.key_ctrl[self.frame(self.data.time)]
        mujoco.mj_step(self.model, self.data)

    def place(self):
        """The chassis's place on the floor: forward and left, mm, and its heading, rad."""
        x, y, _, w, qx, qy, qz = self.data.qpos[:7]
        heading = math.atan2(2 * (w * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        return 1000 * y, -1000 * x, heading

    def cycle(self):
        """Walks to the end of the cycle that the file names. Returns the displacement by that
        cycle, relative to its beginning: mm forward, mm to the left, deg counter-clockwise."""
        step = self.model.opt.timestep
        for _ in range(round(self.begin / step)):
            self.step()
        forward, left, heading = self.place()
        for _ in range(round(self.period / step)):
            self.step()
        end_forward, end_left, end_heading = self.place()
        ahead, aside = end_forward - forward, end_left - left
        cos, sin = math.cos(heading), math.sin(heading)
        turn = math.remainder(end_heading - heading, math.tau)
        return ahead * cos + aside * sin, aside * cos - ahead * sin, math.degrees(turn)
