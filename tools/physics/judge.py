#!/usr/bin/env python3
"""Walks robots that `lizard model --drive` or `make physics` has written, by MuJoCo.

Prints a line of JSON for each: the file's name, and the mean displacement by a cycle (mm forward, mm to
the left, deg counter-clockwise). Two walks run at a time. Usage: judge.py FOLDER-OR-FILE
"""

import json
import math
import multiprocessing
import sys
from pathlib import Path

from walk import Walk


def judge(path):
    try:
        walk = Walk(path)
    except ValueError as wrong:
        return {"file": path.stem, "trouble": " ".join(str(wrong).split())}
    if walk.frames == 0:
        return {"file": path.stem, "trouble": "it holds no gait; write it with --drive GAIT"}
    way = [round(float(part), 3) for part in walk.cycle()]
    trouble = sum(warning.number for warning in walk.data.warning)
    if trouble or not all(map(math.isfinite, way)):
        return {"file": path.stem, "trouble": f"MuJoCo warns of it {trouble} times"}
    return {"file": path.stem, "way": way}


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    given = Path(sys.argv[1])
    paths = sorted(given.glob("*.xml")) if given.is_dir() else [given]
    trouble = False
    with multiprocessing.Pool(2) as pool:
        for line in pool.imap_unordered(judge, paths):
            print(json.dumps(line), flush=True)
            trouble |= "trouble" in line
    sys.exit(trouble)


if __name__ == "__main__":
    main()
