"""The closed form of `lizard solve` in numpy, for comparison.

Standard input: rows of theta1, theta4, theta8, theta5 in degrees as raw f64.
Argument 1: the 20 links as JSON. Standard output: one line of JSON with the
fastest times in s over whole columns and in blocks that fit the cache, then the
results of every row as raw f64.
"""

import json
import os
import sys
import time

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"

import numpy as np  # noqa: E402

L = json.loads(sys.argv[1])
DEG = 180.0 / np.pi


def five_bar(base, l1, l2, l3, l4, c1, s1, c4, s4):
    """Couplers' unit vectors, apex and type-2 margin."""
    ax, ay = l1 * c1 - base / 2, l1 * s1
    gx, gy = l4 * c4 + base / 2 - ax, l4 * s4 - ay
    square = gx * gx + gy * gy
    d = np.sqrt(square)
    product = (l2 + l3 + d) * (l2 + l3 - d) * (d + (l2 - l3)) * (d - (l2 - l3))
    area = np.sqrt(np.maximum(product, 0)) / 2
    along = (square + (l2 - l3) * (l2 + l3)) / (2 * square)
    rise = area / square
    fx, fy = gx * along - gy * rise, gy * along + gx * rise
    rx, ry = fx - gx, fy - gy
    return fx / l2, fy / l2, rx / l3, ry / l3, ax + fx, ay + fy, area / (l2 * l3)


def slider(offset, base, front, rear, nominal, fc, fs, rc, rs):
    """Direction in degrees and travel; the front shaft is at (offset, base)."""
    x, y = offset + front * fc - rear * rc, base + front * fs - rear * rs
    return np.arctan2(y, x) * DEG, np.sqrt(x * x + y * y) - nominal


def solve(poses):
    t1, t4, t8, t5 = poses.T / DEG
    s1, c1, s4, c4 = np.sin(t1), np.cos(t1), np.sin(t4), np.cos(t4)
    s8, c8, s5, c5 = np.sin(t8), np.cos(t8), np.sin(t5), np.cos(t5)
    hx, hy, kx, ky, px, py, head = five_bar(L[0], L[1], L[2], L[3], L[4], c1, s1, c4, s4)
    tx, ty, ux, uy, qx, qy, tail = five_bar(L[5], L[6], L[7], L[8], L[9], c5, -s5, c8, -s8)
    aside = (L[5] - L[0]) / 2
    phi_left, s_left = slider(aside, L[10], L[14], L[11], L[12] + L[13], -s1, c1, s5, -c5)
    phi_right, s_right = slider(-aside, L[15], L[19], L[16], L[17] + L[18], s4, -c4, -s8, c8)
    return np.stack(
        [
            np.arctan2(hy, hx) * DEG,
            np.arctan2(ky, kx) * DEG,
            np.arctan2(-ty, tx) * DEG,
            np.arctan2(-uy, ux) * DEG,
            px,
            py + L[10] / 2,
            qx,
            -qy - L[10] / 2,
            phi_left,
            s_left,
            phi_right,
            s_right,
            head,
            tail,
            hx * s1 - hy * c1,
            c4 * ky - s4 * kx,
            c8 * uy + s8 * ux,
            -tx * s5 - ty * c5,
            np.abs(s1),
            np.abs(s4),
            np.abs(s8),
            np.abs(s5),
        ],
        axis=1,
    )


def measure(poses, block):
    """The fastest of three passes in blocks of rows, s."""
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        for i in range(0, len(poses), block):
            solve(poses[i : i + block])
        best = min(best, time.perf_counter() - start)
    return best


def main():
    poses = np.frombuffer(sys.stdin.buffer.read()).reshape(-1, 4)
    whole, blocks = (
        min(measure(poses, block) for block in sizes)
        for sizes in ((len(poses),), (1024, 4096, 32768))
    )
    print(json.dumps({"columns": whole, "blocks": blocks, "version": np.__version__}))
    sys.stdout.flush()
    sys.stdout.buffer.write(solve(poses).tobytes())


main()
