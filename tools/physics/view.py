#!/usr/bin/env python3
"""Shows in MuJoCo's window the walk of a robot that `lizard model` wrote.

Usage: target/physics/bin/python tools/physics/view.py out/walk.xml
Write the file with --drive. The measured cycles repeat until the window is closed. Space pauses and resumes.
`make physics` installs MuJoCo; so does `python3 -m pip install -r tools/physics/requirements.txt`.
"""

import sys
import time

try:
    import mujoco.viewer

    from walk import Walk
except ImportError as error:
    sys.exit(f"view.py: {error}; `make physics` installs MuJoCo into target/physics")

SPACE_KEY = 32


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    try:
        walk = Walk(sys.argv[1])
    except ValueError as error:
        sys.exit(f"view.py: {sys.argv[1]}: {' '.join(str(error).split())}")
    if walk.frame_count == 0:
        print("view.py: the file has no gait; write it with --drive GAIT")
    is_paused = False

    def on_key(code):
        nonlocal is_paused
        is_paused ^= code == SPACE_KEY

    with mujoco.viewer.launch_passive(
        walk.model, walk.data, key_callback=on_key, show_left_ui=False, show_right_ui=False
    ) as window:
        with window.lock():
            window.cam.type = mujoco.mjtCamera.mjCAMERA_TRACKING
            window.cam.trackbodyid = walk.model.body("chassis").id
            window.cam.distance = 0.45
        redraw_s = 1 / 60
        while window.is_running():
            redraw_start = time.monotonic()
            redraw_end = walk.data.time + redraw_s
            while walk.data.time < redraw_end and not is_paused:
                walk.step()
            window.sync()
            time.sleep(max(0.0, redraw_s - (time.monotonic() - redraw_start)))


if __name__ == "__main__":
    main()
