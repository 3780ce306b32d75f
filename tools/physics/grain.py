"""Pads with a grain, which resist being dragged backward more than forward.

MuJoCo's friction is equal in all directions. Therefore every pad gets a new coefficient before each
step, for the direction in which the floor pushed the pad in the previous step. This direction is known
both while the pad slides and while it sticks.
"""

import math

import mujoco
import numpy


class Grain:
    """Four pads whose backward friction is `ratio` times their forward and sideways friction."""

    def __init__(self, model, ratio):
        self.model, self.ratio = model, ratio
        names = [model.geom(geom).name for geom in range(model.ngeom)]
        self.pads = [geom for geom, name in enumerate(names) if name.startswith("pad ")]
        # The pads' friction in the file takes precedence over the floor's.
        self.forward_friction = model.geom_friction[self.pads, 0].copy()
        # The grain turns with its pad. In the file, the robot faces along y.
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self.forward = [data.geom_xmat[pad].reshape(3, 3).T @ (0, 1, 0) for pad in self.pads]

    def set_friction(self, data):
        """Sets the friction of each pad for the next step; a pad in the air keeps its friction."""
        for index, pad in enumerate(self.pads):
            push = self.compute_push(data.contact, data.efc_force, pad)
            size = math.sqrt(push @ push)
            if size > 0:
                forward = data.geom_xmat[pad].reshape(3, 3) @ self.forward[index]
                factor = self.compute_friction_factor(push @ forward, size)
                self.model.geom_friction[pad, 0] = self.forward_friction[index] * factor

    @staticmethod
    def compute_push(contact, force, pad):
        """Returns the friction force on a pad in the last step, in the world frame, N."""
        push = numpy.zeros(3)
        # A contact's force acts on the second of its two bodies.
        for side, sign in enumerate((-1, 1)):
            for index in numpy.flatnonzero(contact.geom[:, side] == pad):
                row = contact.efc_address[index]
                if row >= 0:
                    along, across = force[row + 1 : row + 3]
                    frame = contact.frame[index]
                    push += sign * (along * frame[3:6] + across * frame[6:9])
        return push

    def compute_friction_factor(self, forward, size):
        """Returns the largest friction in a push's direction, as a multiple of the forward friction. The push has
        magnitude `size` and forward component `forward`. The factor follows an ellipse with semi-axis `ratio`
        forward and semi-axis 1 sideways."""
        if forward <= 0:
            return 1.0
        cos = forward / size
        return 1 / math.sqrt((cos / self.ratio) ** 2 + 1 - cos * cos)
