"""A robot that `lizard mjcf` has written, walked by MuJoCo.

The file has a keyframe for each frame of 20 ms: when it begins, and what the servos are
told in it. They are told so until the next one begins, as by the pulses of the board.
"""

import math

import mujoco


class Walk:
    """The robot, its keyframes, and when the cycle begins that can be repeated."""

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
        """One step of the engine, with the servos told what they are to be told."""
        if self.model.nkey > 0:
            self.data.ctrl[:] = self.model.key_ctrl[self.frame(self.data.time)]
        mujoco.mj_step(self.model, self.data)

    def place(self):
        """The chassis on the floor: forward and left, mm, and its heading, rad."""
        x, y, _, w, qx, qy, qz = self.data.qpos[:7]
        heading = math.atan2(2 * (w * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        return 1000 * y, -1000 * x, heading

    def cycle(self):
        """Walks to the end of the cycle that the file names: where that one leads, seen
        from where it began, as mm forward, mm to the left, deg counter-clockwise."""
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
