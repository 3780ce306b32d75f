"""Pads with a grain, which resist being dragged backward more than forward.

MuJoCo's friction is equal in all directions. Therefore every pad gets a new coefficient before each
step, for the direction in which the floor pushed the pad in the previous step. This direction is known
both while the pad slides and while it sticks.
"""

import math

import mujoco
import numpy


class GrainedPads:
    """Direction-dependent friction of the four pads: backward, the coefficient is `ratio` times as large as forward
    and sideways."""

    def __init__(self, model, ratio):
        self.model, self.ratio = model, ratio
        names = [model.geom(geom).name for geom in range(model.ngeom)]
        self.pads = [geom for geom, name in enumerate(names) if name.startswith("pad ")]
        # The model file gives the pads' coefficient priority over the floor's.
        self.forward_coefficients = model.geom_friction[self.pads, 0].copy()
        # The grain turns with its pad. In the file, the robot faces along y.
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self.forward = [data.geom_xmat[pad].reshape(3, 3).T @ (0, 1, 0) for pad in self.pads]

    def set_coefficients(self, data):
        """Sets the friction coefficient of each pad for the next step; a pad in the air keeps its coefficient."""
        for index, pad in enumerate(self.pads):
            friction_force = self.compute_friction_force(data.contact, data.efc_force, pad)
            magnitude = math.sqrt(friction_force @ friction_force)
            if magnitude > 0:
                forward = data.geom_xmat[pad].reshape(3, 3) @ self.forward[index]
                factor = self.compute_coefficient_factor(friction_force @ forward, magnitude)
                self.model.geom_friction[pad, 0] = self.forward_coefficients[index] * factor

    @staticmethod
    def compute_friction_force(contact, force, pad):
        """Returns the friction force on a pad in the last step, in the world frame, N."""
        friction_force = numpy.zeros(3)
        # A contact's force acts on the second of its two geoms.
        for side, sign in enumerate((-1, 1)):
            for index in numpy.flatnonzero(contact.geom[:, side] == pad):
                row = contact.efc_address[index]
                if row >= 0:
                    along, across = force[row + 1 : row + 3]
                    frame = contact.frame[index]
                    friction_force += sign * (along * frame[3:6] + across * frame[6:9])
        return friction_force

    def compute_coefficient_factor(self, forward_component, magnitude):
        """Returns the coefficient in the direction of a friction force, relative to the forward coefficient: the
        radius of an ellipse with semi-axis `ratio` forward and semi-axis 1 sideways."""
        if forward_component <= 0:
            return 1.0
        cos = forward_component / magnitude
        return 1 / math.sqrt((cos / self.ratio) ** 2 + 1 - cos * cos)
