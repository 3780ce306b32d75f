"""Learns a gait in about a minute: the amplitude, the duty factor, and the start of each leg's stance.

The cross-entropy method tries gaits in MuJoCo (the environment `Lizard-v0`), keeps the best gaits, and tries similar
gaits. It begins without any knowledge of walking: all legs start at random times.
Usage: learn_gait.py [OUTPUT.toml [SEED]]
"""

import sys
from pathlib import Path

import gymnasium
import numpy as np

import lizard
from lizard.gym import MAX_SWEEP, LizardEnv

GENERATIONS, POPULATION, ELITES = 13, 20, 5
FIRST_POPULATION = 80  # larger, to cover the search space before it narrows
PERIOD_S = 1.0
APPROACH_FRAMES = 15  # from standing to the first pose


def format_gait_table(parameters: np.ndarray) -> str:
    """Formats a gait as a table of robot.toml; parameters: amplitude (deg), duty, and starts (fractions of a cycle)."""
    amplitude, duty, *starts = parameters
    lf, rf, rh = np.mod(np.round(starts, 3), 1)
    return f"""
[gait.learned]
period = {PERIOD_S}
waveform = "wave"
duty = {duty:.3f}
amplitude = {amplitude:.2f}
start = {{ LH = 0.0, LF = {lf:.3f}, RF = {rf:.3f}, RH = {rh:.3f} }}
"""


def compute_score(
    env: gymnasium.Env, model: lizard.Model, parameters: np.ndarray
) -> float:
    """Simulates a gait; returns the distance of its second cycle, mm, minus the turn, deg; -inf for an invalid gait."""
    try:
        gait = model.with_gait(format_gait_table(parameters)).gait("learned")
    except lizard.RobotFileError:
        return -np.inf
    if np.isnan(gait.predict().forward):
        # Two feet pull against the other two, so the direction is undetermined.
        return -np.inf
    sweeps = (gait.angles[:-1] - model.neutral + 180) % 360 - 180
    actions = (sweeps / MAX_SWEEP).astype(np.float32)
    fractions = np.linspace(0, 1, APPROACH_FRAMES, dtype=np.float32)
    approach = actions[0] * fractions[:, None]
    env.reset(seed=0)
    infos = []
    for action in np.concatenate([approach, actions, actions]):
        *_, info = env.step(action)
        infos.append(info)
    before, after = infos[-1 - len(actions)], infos[-1]
    distance_mm, turn_deg = (after[key] - before[key] for key in ("forward", "turn"))
    return float(distance_mm - abs(turn_deg))


def main() -> None:
    output_path = Path(sys.argv[1] if len(sys.argv) > 1 else "learned.toml")
    rng = np.random.default_rng(int(sys.argv[2]) if len(sys.argv) > 2 else 0)
    model = lizard.Model.default()
    env = LizardEnv(model, friction_spread=0)
    mean = np.array([12.0, 0.7, 0.5, 0.5, 0.5])
    std = np.array([5.0, 0.1, 0.3, 0.3, 0.3])
    best, best_score = mean, -np.inf
    for generation in range(GENERATIONS):
        count = POPULATION if generation else FIRST_POPULATION
        candidates = rng.normal(mean, std, (count, len(mean)))
        scores = np.array(
            [compute_score(env, model, candidate) for candidate in candidates]
        )
        elites = candidates[np.argsort(scores)[-ELITES:]]
        mean, std = elites.mean(0), elites.std(0) + std / 10
        if scores.max() > best_score:
            best, best_score = candidates[scores.argmax()], scores.max()
        print(
            f"{generation + 1:2}: best score {best_score:5.1f} (mm minus deg of turn)"
        )
    text = lizard.default_toml() + format_gait_table(best)
    learned = lizard.Model.from_toml(text).gait("learned")
    output_path.write_text(text)
    print(
        f"{output_path}: contact model {learned.predict().forward:.1f} mm, MuJoCo score {best_score:.1f}"
    )


if __name__ == "__main__":
    main()
