#!/usr/bin/env python3
"""Simulates walks in MuJoCo: the files that `lizard model --drive` or `make physics` wrote.

Prints a line of JSON for each walk: the file's name without its extension, and the mean displacement per
cycle (mm forward, mm to the left, deg counter-clockwise), or `error`, a message. Two walks run at a time.
Usage: judge.py FOLDER-OR-FILE
"""

import json
import math
import multiprocessing
import sys
from pathlib import Path

from walk import Walk


def simulate(path):
    """Simulates the walk in a file, and returns the content of its line."""
    try:
        walk = Walk(path)
    except ValueError as error:
        return {"file": path.stem, "error": " ".join(str(error).split())}
    if walk.frame_count == 0:
        return {"file": path.stem, "error": "the file has no gait; write it with --drive GAIT"}
    displacement = [round(float(component), 3) for component in walk.measure_cycles()]
    warning_count = sum(warning.number for warning in walk.data.warning)
    if warning_count or not all(map(math.isfinite, displacement)):
        error = f"MuJoCo gave {warning_count} warnings; the displacement is {displacement}"
        return {"file": path.stem, "error": error}
    return {"file": path.stem, "displacement": displacement}


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    path = Path(sys.argv[1])
    paths = sorted(path.glob("*.xml")) if path.is_dir() else [path]
    has_failed = False
    with multiprocessing.Pool(2) as pool:
        for result in pool.imap_unordered(simulate, paths):
            print(json.dumps(result), flush=True)
            has_failed |= "error" in result
    sys.exit(has_failed)


if __name__ == "__main__":
    main()
