"""Walks a robot that `lizard model` has written, by MuJoCo.

The file has a keyframe for each frame of 20 ms: its time and the servos' angles, which stay
set until the next frame begins, as by the pulses of the board. The last keyframe is `home`.
"""

import math

import mujoco
import numpy

from grain import Grain


FRAME = 0.02
"""The time between two pulses, s."""


class Bursts:
    """Analog servos: each looks at its angle when a pulse comes, and then drives at its full torque for
    a part of the time to the next pulse that is in proportion to the error."""

    def __init__(self, model):
        # A target that is far off asks for the full torque, and the servo's own angle for none.
        model.actuator_ctrllimited[:] = 0
        self.angles = model.jnt_qposadr[model.actuator_trnid[:, 0]]
        self.full = model.actuator_forcerange[:, 1] / model.actuator_gainprm[:, 0]
        self.pulse, self.error = None, None

    def drive(self, data, targets):
        """Sets the servos for the next step."""
        pulse = int((data.time + 1e-9) / FRAME)
        angles = data.qpos[self.angles]
        if pulse != self.pulse:
            self.pulse, self.error = pulse, targets - angles
        share = (data.time - pulse * FRAME) / FRAME
        drives = share < abs(self.error) / self.full
        data.ctrl[:] = angles + drives * numpy.sign(self.error) * 2 * self.full


class Walk:
    """The robot, its keyframes, and the beginning of the cycles that can be repeated."""

    def __init__(self, path):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        ratio = float(self.model.numeric("back over forward").data[0])
        self.grain = None if ratio == 1 else Grain(self.model, ratio)
        names = [self.model.numeric(at).name for at in range(self.model.nnumeric)]
        self.bursts = Bursts(self.model) if "bursts" in names else None
        self.begin, self.period, self.count = None, None, None
        self.frames = self.model.nkey - 1
        if self.frames > 0:
            self.begin, self.period, count = self.model.numeric("cycle").data
            self.count = int(count)

    def frame(self, seconds):
        """The number of the keyframe at a time; after the last cycle, the cycles' again."""
        cycles = self.count * self.period
        if seconds >= self.begin + cycles:
            seconds = self.begin + (seconds - self.begin) % cycles
        times = self.model.key_time
        frame = int((seconds + 1e-9) / (times[1] - times[0]))
        return min(frame, self.frames - 1)

    def step(self):
        """Makes one step of the engine, with the servos set to the present frame's angles."""
        if self.frames > 0:
            targets = self.model.key_ctrl[self.frame(self.data.time)]
            if self.bursts:
                self.bursts.drive(self.data, targets)
            else:
                self.data.ctrl[:] = targets
        if self.grain:
            self.grain.set(self.data)
        mujoco.mj_step(self.model, self.data)

    def place(self):
        """The chassis's place on the floor: forward and left, mm, and its heading, rad."""
        x, y, _, w, qx, qy, qz = self.data.qpos[:7]
        heading = math.atan2(2 * (w * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        return 1000 * y, -1000 * x, heading

    def cycle(self):
        """Walks to the end of the cycles that the file names. Returns the mean displacement by one,
        relative to its beginning: mm forward, mm to the left, deg counter-clockwise."""
        step = self.model.opt.timestep
        for _ in range(round(self.begin / step)):
            self.step()
        ways = [self.displacement(round(self.period / step)) for _ in range(self.count)]
        return [sum(parts) / self.count for parts in zip(*ways)]

    def displacement(self, steps):
        """The displacement by some steps of the engine, relative to their beginning."""
        forward, left, heading = self.place()
        for _ in range(steps):
            self.step()
        end_forward, end_left, end_heading = self.place()
        ahead, aside = end_forward - forward, end_left - left
        cos, sin = math.cos(heading), math.sin(heading)
        turn = math.remainder(end_heading - heading, math.tau)
        return ahead * cos + aside * sin, aside * cos - ahead * sin, math.degrees(turn)
