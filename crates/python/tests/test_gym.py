"""Tests of the environment: Gymnasium's check, and movements as with the time step of `lizard model`."""

import importlib.util
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import lizard
from lizard.gym import MAX_SWEEP, LizardEnv

EXAMPLE = Path(__file__).parents[1] / "examples" / "learn_gait.py"
SPEC = importlib.util.spec_from_file_location("learn_gait", EXAMPLE)
assert SPEC is not None and SPEC.loader is not None
learn_gait = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(learn_gait)

# Movements per cycle with the time step of `lizard model`, 0.2 ms: forward (mm) and turn (deg).
EXPECTED_MOVEMENTS = {"walk": (34.1, 0.0), "trot": (26.4, 0.0), "left": (0.0, 14.9)}


def test_gymnasium_finds_and_accepts_the_environment():
    env = gymnasium.make("lizard.gym:Lizard-v0")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*render.*|.*infinity.*")
        check_env(env.unwrapped)
    assert env.spec is not None and env.spec.max_episode_steps == 250


def test_the_seed_determines_the_rewards():
    env = LizardEnv()

    def drive(seed: int) -> list[float]:
        env.reset(seed=seed)
        rng = np.random.default_rng(0)
        actions = rng.uniform(-1, 1, (30, 4)).astype(np.float32)
        return [float(env.step(action)[1]) for action in actions]

    assert drive(1) == drive(1) != drive(2)


@pytest.mark.parametrize("name", EXPECTED_MOVEMENTS)
def test_gaits_move_the_robot_as_far_as_with_the_time_step_of_0_2_ms(model, name):
    env = LizardEnv(friction_spread=0)
    gait = model.gait(name)
    sweeps = (gait.angles[:-1] - model.neutral + 180) % 360 - 180
    actions = (sweeps / MAX_SWEEP).astype(np.float32)
    env.reset(seed=0)
    infos = [env.step(actions[0])[4] for _ in range(20)]
    infos += [env.step(action)[4] for _ in range(2) for action in actions]
    before, after = infos[-1 - len(actions)], infos[-1]
    forward, turn = EXPECTED_MOVEMENTS[name]
    assert after["forward"] - before["forward"] == pytest.approx(forward, abs=0.7)
    assert after["turn"] - before["turn"] == pytest.approx(turn, abs=0.3)
    assert not any(info["held"] for info in infos)


def test_targets_are_safe_and_within_the_speed_limit_of_gaits(model):
    env = LizardEnv()
    env.reset(seed=3)
    rng, held_count, previous = np.random.default_rng(3), 0, np.zeros(4)
    for _ in range(200):
        action = rng.choice([-1.0, 1.0], 4).astype(np.float32)
        held_count += env.step(action)[4]["held"]
        target = np.degrees(env.data.ctrl)
        assert model.solve(model.neutral + target).safe
        assert np.abs(target - previous).max() <= model.gait_slew / 50 + 1e-9
        previous = target
    assert held_count > 0


def test_a_step_of_the_environment_takes_20_ms_with_any_time_step():
    env = LizardEnv(timestep=0.003)
    env.reset(seed=0)
    env.step(np.zeros(4, np.float32))
    assert env.data.time == pytest.approx(0.02)


def test_a_simulation_that_diverges_ends_the_episode(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)  # the engine writes a log to the working directory
    env = LizardEnv()
    env.reset(seed=0)
    env.data.qvel[6] = 1e11
    _, reward, has_diverged, *_ = env.step(np.zeros(4, np.float32))
    assert (reward, has_diverged) == (0.0, True)


def test_the_environment_rejects_pads_with_a_grain():
    grain_path = Path(__file__).parents[3] / "robots" / "grain.toml"
    with pytest.raises(ValueError, match="grain"):
        LizardEnv(lizard.Model.from_toml(grain_path))


def test_the_example_learns_a_gait_that_the_command_line_accepts(
    monkeypatch, run_lizard, tmp_path
):
    values = {"GENERATIONS": 2, "FIRST_POPULATION": 16, "POPULATION": 4}
    for name, value in values.items():
        monkeypatch.setattr(learn_gait, name, value)
    output_path = tmp_path / "learned.toml"
    monkeypatch.setattr("sys.argv", ["learn_gait.py", str(output_path)])
    learn_gait.main()
    assert lizard.Model.from_toml(output_path).gait("learned").predict().forward > 10
    result = run_lizard("gaits", "--robot", output_path)
    assert result.returncode == 0 and "learned" in result.stdout
