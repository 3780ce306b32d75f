"""Pads with a grain: dragging them backward takes more force than dragging them forward.

MuJoCo's friction is equal in all directions. So before each step every pad gets the coefficient for
the direction in which the floor pushed it in the previous step. That direction is known while a pad
slides and while it holds.
"""

import math

import mujoco
import numpy


class Grain:
    """Four pads whose friction backward is `ratio` times their friction forward and sideways."""

    def __init__(self, model, ratio):
        self.model, self.ratio = model, ratio
        names = [model.geom(geom).name for geom in range(model.ngeom)]
        self.pads = [geom for geom, name in enumerate(names) if name.startswith("pad ")]
        # In the file the friction of the pads is in effect, not that of the floor.
        self.forward_friction = model.geom_friction[self.pads, 0].copy()
        # The grain turns with its pad. In the file the robot faces along y.
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self.ahead = [data.geom_xmat[pad].reshape(3, 3).T @ (0, 1, 0) for pad in self.pads]

    def set(self, data):
        """Sets the friction of each pad for the next step; a pad in the air keeps its friction."""
        for index, pad in enumerate(self.pads):
            push = self.push(data.contact, data.efc_force, pad)
            size = math.sqrt(push @ push)
            if size > 0:
                ahead = data.geom_xmat[pad].reshape(3, 3) @ self.ahead[index]
                limit = self.limit(push @ ahead, size)
                self.model.geom_friction[pad, 0] = self.forward_friction[index] * limit

    @staticmethod
    def push(contact, force, pad):
        """Returns the friction on a pad in the last step, in the world frame, N."""
        push = numpy.zeros(3)
        # A contact's force is on the second of its two bodies.
        for side, sign in enumerate((-1, 1)):
            for index in numpy.flatnonzero(contact.geom[:, side] == pad):
                row = contact.efc_address[index]
                if row >= 0:
                    along, across = force[row + 1 : row + 3]
                    frame = contact.frame[index]
                    push += sign * (along * frame[3:6] + across * frame[6:9])
        return push

    def limit(self, forward, size):
        """Returns the largest friction in the direction of a push of magnitude `size` whose forward component is
        `forward`, as a multiple of the friction of a pad that slides forward. The limit is an ellipse with the
        semi-axes `ratio` forward and 1 sideways."""
        if forward <= 0:
            return 1.0
        cos = forward / size
        return 1 / math.sqrt((cos / self.ratio) ** 2 + 1 - cos * cos)
