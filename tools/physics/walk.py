"""Simulates the walk of a robot that `lizard model` has written, with MuJoCo.

The file has a keyframe for each frame of 20 ms: its time and the servos' angles, which stay
set until the next frame begins, as with the pulses of the board. The last keyframe is `home`.
"""

import math

import mujoco
import numpy

from grain import Grain


FRAME = 0.02
"""Time from one pulse to the next, s."""


class Bursts:
    """Analogue servos: each measures its error at a pulse, and then drives at full torque for a share of the
    time to the next pulse that is proportional to the error."""

    def __init__(self, model):
        # A distant target commands the full torque, and the servo's own angle commands none.
        model.actuator_ctrllimited[:] = 0
        self.angle_indices = model.jnt_qposadr[model.actuator_trnid[:, 0]]
        self.full_torque_error = model.actuator_forcerange[:, 1] / model.actuator_gainprm[:, 0]
        self.pulse, self.error = None, None

    def drive(self, data, targets):
        """Sets the servos for the next step."""
        pulse = int((data.time + 1e-9) / FRAME)
        angles = data.qpos[self.angle_indices]
        if pulse != self.pulse:
            self.pulse, self.error = pulse, targets - angles
        share = (data.time - pulse * FRAME) / FRAME
        drives = share < abs(self.error) / self.full_torque_error
        data.ctrl[:] = angles + drives * numpy.sign(self.error) * 2 * self.full_torque_error


class Walk:
    """A robot with its keyframes, and the start of the cycles that can be repeated."""

    def __init__(self, path):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        ratio = float(self.model.numeric("back over forward").data[0])
        self.grain = None if ratio == 1 else Grain(self.model, ratio)
        names = [self.model.numeric(index).name for index in range(self.model.nnumeric)]
        self.bursts = Bursts(self.model) if "bursts" in names else None
        self.start, self.period, self.count = None, None, None
        self.frames = self.model.nkey - 1
        if self.frames > 0:
            self.start, self.period, count = self.model.numeric("cycle").data
            self.count = int(count)

    def frame(self, seconds):
        """Returns the index of the keyframe at a time; after the last cycle, the cycles repeat."""
        cycles = self.count * self.period
        if seconds >= self.start + cycles:
            seconds = self.start + (seconds - self.start) % cycles
        times = self.model.key_time
        frame = int((seconds + 1e-9) / (times[1] - times[0]))
        return min(frame, self.frames - 1)

    def step(self):
        """Makes one step of the engine, with the servos set to the current frame's angles."""
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
        """Returns the chassis's place on the floor: forward and left, mm, and its heading, rad."""
        x, y, _, w, qx, qy, qz = self.data.qpos[:7]
        heading = math.atan2(2 * (w * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        return 1000 * y, -1000 * x, heading

    def cycle(self):
        """Walks to the end of the cycles that the file declares. Returns the mean displacement per cycle,
        relative to its start: mm forward, mm to the left, deg counter-clockwise."""
        step = self.model.opt.timestep
        for _ in range(round(self.start / step)):
            self.step()
        displacements = [self.displacement(round(self.period / step)) for _ in range(self.count)]
        return [sum(components) / self.count for components in zip(*displacements)]

    def displacement(self, steps):
        """Returns the displacement in some steps of the engine, relative to their start."""
        forward, left, heading = self.place()
        for _ in range(steps):
            self.step()
        end_forward, end_left, end_heading = self.place()
        forward_change, left_change = end_forward - forward, end_left - left
        cos, sin = math.cos(heading), math.sin(heading)
        turn = math.remainder(end_heading - heading, math.tau)
        return (
            forward_change * cos + left_change * sin,
            left_change * cos - forward_change * sin,
            math.degrees(turn),
        )
