"""Pads with a grain: it takes more to drag them backward than forward.

MuJoCo's friction is equal in all directions. So before each step every pad gets the coefficient for
the direction in which the floor pushed it in the step before. That direction is known while a pad
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
        # In the file the pads' friction counts, not the floor's.
        self.even = model.geom_friction[self.pads, 0].copy()
        # The grain turns with its pad. As the file has the robot, it looks along y.
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self.ahead = [data.geom_xmat[pad].reshape(3, 3).T @ (0, 1, 0) for pad in self.pads]

    def set(self, data):
        """Sets the friction of each pad for the next step; one that is in the air keeps its own."""
        for at, pad in enumerate(self.pads):
            push = self.push(data.contact, data.efc_force, pad)
            size = math.sqrt(push @ push)
            if size > 0:
                ahead = data.geom_xmat[pad].reshape(3, 3) @ self.ahead[at]
                limit = self.limit(push @ ahead, size)
                self.model.geom_friction[pad, 0] = self.even[at] * limit

    @staticmethod
    def push(contact, force, pad):
        """The friction on a pad in the last step, in the frame of the world, N."""
        push = numpy.zeros(3)
        # A contact's force is on the second of its two bodies.
        for side, sign in enumerate((-1, 1)):
            for of in numpy.flatnonzero(contact.geom[:, side] == pad):
                row = contact.efc_address[of]
                if row >= 0:
                    along, across = force[row + 1 : row + 3]
                    frame = contact.frame[of]
                    push += sign * (along * frame[3:6] + across * frame[6:9])
        return push

    def limit(self, forward, size):
        """The largest force in the direction of a push of this size with this part forward, over
        the friction of a pad that slides forward: on an ellipse that is `ratio` long."""
        if forward <= 0:
            return 1.0
        cos = forward / size
        return 1 / math.sqrt((cos / self.ratio) ** 2 + 1 - cos * cos)
