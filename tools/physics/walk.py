"""Simulates in MuJoCo the walk of a robot that `lizard model` wrote.

The file has a keyframe for each frame of 20 ms: its time and the servos' angles. The angles stay set
until the next frame begins, like the board's pulses. The last keyframe is `home`.
"""

import math

import mujoco
import numpy

from grain import GrainedPads


FRAME_S = 0.02
"""Time between two pulses, s."""


class BurstDrive:
    """Analogue servos. Each measures its error at a pulse, and then drives at full torque for a fraction of the
    time to the next pulse. The fraction is proportional to the error."""

    def __init__(self, model):
        # A distant target commands full torque, and the servo's own angle commands no torque.
        model.actuator_ctrllimited[:] = 0
        self.angle_indices = model.jnt_qposadr[model.actuator_trnid[:, 0]]
        self.full_torque_error = model.actuator_forcerange[:, 1] / model.actuator_gainprm[:, 0]
        self.pulse, self.error = None, None

    def set_targets(self, data, targets):
        """Sets the servos' targets for the next step."""
        pulse = int((data.time + 1e-9) / FRAME_S)
        angles = data.qpos[self.angle_indices]
        if pulse != self.pulse:
            self.pulse, self.error = pulse, targets - angles
        elapsed_fraction = (data.time - pulse * FRAME_S) / FRAME_S
        is_driven = elapsed_fraction < abs(self.error) / self.full_torque_error
        data.ctrl[:] = angles + is_driven * numpy.sign(self.error) * 2 * self.full_torque_error


class Walk:
    """A robot with its keyframes, and the cycles that can be repeated."""

    def __init__(self, path):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        ratio = float(self.model.numeric("back over forward").data[0])
        self.grained_pads = None if ratio == 1 else GrainedPads(self.model, ratio)
        names = [self.model.numeric(index).name for index in range(self.model.nnumeric)]
        self.burst_drive = BurstDrive(self.model) if "bursts" in names else None
        self.start_s, self.period_s, self.cycle_count = None, None, None
        self.frame_count = self.model.nkey - 1
        if self.frame_count > 0:
            self.start_s, self.period_s, cycle_count = self.model.numeric("cycle").data
            self.cycle_count = int(cycle_count)

    def find_frame(self, seconds):
        """Returns the index of the keyframe at a time; after the last cycle, the cycles repeat."""
        cycles_s = self.cycle_count * self.period_s
        if seconds >= self.start_s + cycles_s:
            seconds = self.start_s + (seconds - self.start_s) % cycles_s
        times = self.model.key_time
        frame = int((seconds + 1e-9) / (times[1] - times[0]))
        return min(frame, self.frame_count - 1)

    def step(self):
        """Runs one step of the engine, with the servos set to the current frame's angles."""
        if self.frame_count > 0:
            targets = self.model.key_ctrl[self.find_frame(self.data.time)]
            if self.burst_drive:
                self.burst_drive.set_targets(self.data, targets)
            else:
                self.data.ctrl[:] = targets
        if self.grained_pads:
            self.grained_pads.set_coefficients(self.data)
        mujoco.mj_step(self.model, self.data)

    def compute_pose(self):
        """Returns the chassis's pose on the floor: mm forward, mm to the left, and the heading in rad."""
        x, y, _, w, qx, qy, qz = self.data.qpos[:7]
        heading = math.atan2(2 * (w * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
        return 1000 * y, -1000 * x, heading

    def measure_cycles(self):
        """Walks to the end of the cycles that the file declares. Returns the mean displacement per cycle, in the
        frame of the cycle's start: mm forward, mm to the left, deg counter-clockwise."""
        step_s = self.model.opt.timestep
        for _ in range(round(self.start_s / step_s)):
            self.step()
        displacements = [self.walk(round(self.period_s / step_s)) for _ in range(self.cycle_count)]
        return [sum(components) / self.cycle_count for components in zip(*displacements)]

    def walk(self, step_count):
        """Runs some steps of the engine. Returns the displacement in the frame of their start, in the units of
        `measure_cycles`."""
        forward, left, heading = self.compute_pose()
        for _ in range(step_count):
            self.step()
        end_forward, end_left, end_heading = self.compute_pose()
        forward_change, left_change = end_forward - forward, end_left - left
        cos, sin = math.cos(heading), math.sin(heading)
        turn = math.remainder(end_heading - heading, math.tau)
        return (
            forward_change * cos + left_change * sin,
            left_change * cos - forward_change * sin,
            math.degrees(turn),
        )
