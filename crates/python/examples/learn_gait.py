"""Learns a gait in about a minute: which leg swings when, for how long and how far.

The cross-entropy method tries gaits in `Lizard-v0`, keeps the best, and tries others like them. It begins without any
idea of walking: all legs start at random times. Usage: learn_gait.py [OUTPUT.toml [SEED]]
"""

import sys
from pathlib import Path

import gymnasium
import numpy as np

import lizard
from lizard.gym import REACH, LizardEnv

GENERATIONS, TRIED, KEPT = 13, 20, 5
FIRST = 80  # tried at random in the beginning
PERIOD = 1.0  # s
APPROACH = 15  # frames from standing to the first pose


def table(parameters: np.ndarray) -> str:
    """The gait as a table of robot.toml: amplitude (deg), duty, and starts (shares of a cycle)."""
    amplitude, duty, *starts = parameters
    lf, rf, rh = np.mod(np.round(starts, 3), 1)
    return f"""
[gait.learned]
period = {PERIOD}
waveform = "wave"
duty = {duty:.3f}
amplitude = {amplitude:.2f}
start = {{ LH = 0.0, LF = {lf:.3f}, RF = {rf:.3f}, RH = {rh:.3f} }}
"""


def score(env: gymnasium.Env, model: lizard.Model, parameters: np.ndarray) -> float:
    """Distance of the second cycle in MuJoCo, mm, less what it turns (deg); -inf for a gait that is refused."""
    try:
        gait = model.with_gait(table(parameters)).gait("learned")
    except lizard.RobotFileError:
        return -np.inf
    if np.isnan(gait.predict().forward):
        return -np.inf  # two feet pull against two: the smallest bump would decide
    sweeps = (gait.angles[:-1] - model.neutral + 180) % 360 - 180
    actions = (sweeps / REACH).astype(np.float32)
    begin = actions[0] * np.linspace(0, 1, APPROACH, dtype=np.float32)[:, None]
    env.reset(seed=0)
    places = []
    for action in np.concatenate([begin, actions, actions]):
        *_, info = env.step(action)
        places.append(info)
    before, after = places[-1 - len(actions)], places[-1]
    turn = after["turn"] - before["turn"]
    return float(after["forward"] - before["forward"] - abs(turn))


def main() -> None:
    output = Path(sys.argv[1] if len(sys.argv) > 1 else "learned.toml")
    random = np.random.default_rng(int(sys.argv[2]) if len(sys.argv) > 2 else 0)
    model = lizard.Model.default()
    env = LizardEnv(model, friction_spread=0)
    mean = np.array([12.0, 0.7, 0.5, 0.5, 0.5])
    spread = np.array([5.0, 0.1, 0.3, 0.3, 0.3])
    best, best_score = mean, -np.inf
    for generation in range(GENERATIONS):
        tried = random.normal(mean, spread, (TRIED if generation else FIRST, len(mean)))
        scores = np.array([score(env, model, one) for one in tried])
        kept = tried[np.argsort(scores)[-KEPT:]]
        mean, spread = kept.mean(0), kept.std(0) + spread / 10
        if scores.max() > best_score:
            best, best_score = tried[scores.argmax()], scores.max()
        print(f"{generation + 1:2}: {best_score:5.1f} mm a cycle")
    text = lizard.default_toml() + table(best)
    learned = lizard.Model.from_toml(text).gait("learned")
    output.write_text(text)
    print(
        f"{output}: contact model {learned.predict().forward:.1f} mm, MuJoCo {best_score:.1f} mm a cycle"
    )


if __name__ == "__main__":
    main()
