"""A robotic lizard with four servos: kinematics, gaits, and a board to drive.

`Model` represents a robot.toml, and `Robot` a board. Angles are in degrees in the chassis frame: x to the robot's
right, y forward, counter-clockwise from +x, seen from above. Lengths are in mm. The servo order is A1 front left, A2
front right, A3 back right, A4 back left.
"""

from lizard._lizard import VERSION as __version__
from lizard._lizard import RobotFileError
from lizard.model import (
    MARGINS,
    Gait,
    Mobility,
    Model,
    Movement,
    Solution,
    default_toml,
)
from lizard.robot import Robot
from lizard.status import Frame, RobotError, Status

__all__ = [
    "MARGINS",
    "Frame",
    "Gait",
    "Mobility",
    "Model",
    "Movement",
    "Robot",
    "RobotError",
    "RobotFileError",
    "Solution",
    "Status",
    "__version__",
    "default_toml",
]
