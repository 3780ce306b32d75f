#!/usr/bin/env python3
"""Shows in MuJoCo's window how a robot walks that `lizard model` has written.

Usage: target/physics/bin/python tools/physics/view.py out/walk.xml
The file is to be written with --drive; the last cycle is repeated until the window is
closed. Space pauses and resumes. `make physics` installs MuJoCo; so does
`python3 -m pip install -r tools/physics/requirements.txt`.
"""

import sys
import time

try:
    import mujoco.viewer

    from walk import Walk
except ImportError as missing:
    sys.exit(f"view.py: {missing}; `make physics` installs MuJoCo into target/physics")

SPACE = 32


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    try:
        walk = Walk(sys.argv[1])
    except ValueError as wrong:
        sys.exit(f"view.py: {sys.argv[1]}: {' '.join(str(wrong).split())}")
    if walk.frames == 0:
        print("view.py: the servos do not move; write the file with --drive GAIT")
    stopped = False

    def key(code):
        nonlocal stopped
        stopped ^= code == SPACE

    with mujoco.viewer.launch_passive(
        walk.model, walk.data, key_callback=key, show_left_ui=False, show_right_ui=False
    ) as window:
        with window.lock():
            window.cam.type = mujoco.mjtCamera.mjCAMERA_TRACKING
            window.cam.trackbodyid = walk.model.body("chassis").id
            window.cam.distance = 0.45
        frame = 1 / 60
        while window.is_running():
            began = time.monotonic()
            until = walk.data.time + frame
            while walk.data.time < until and not stopped:
                walk.step()
            window.sync()
            time.sleep(max(0.0, frame - (time.monotonic() - began)))


if __name__ == "__main__":
    main()
