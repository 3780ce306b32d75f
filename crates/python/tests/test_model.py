"""The model, compared with geometry in numpy, and with the program's JSON."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

import lizard

# The paper's robot, mm, and its limits.
BASE, CRANK, COUPLER, BODY, ARM, HALVES = 20.0, 30.0, 50.0, 135.0, 30.0, 90.0
SINES, STROKE = 0.3, (-15.0, 45.0)


def unit(degrees: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))], -1)


def random_poses(model: lizard.Model, count: int = 2000) -> np.ndarray:
    return model.neutral + np.random.default_rng(1).uniform(-40, 40, (count, 4))


def end_by_circles(left: np.ndarray, right: np.ndarray, ahead: float) -> np.ndarray:
    """The point at the couplers' length from two crank tips, on the outer side."""
    gap = right - left
    length = np.linalg.norm(gap, axis=-1, keepdims=True)
    across = np.stack([-gap[..., 1], gap[..., 0]], -1) / length
    return (left + right) / 2 + ahead * across * np.sqrt(COUPLER**2 - length**2 / 4)


def tips(angles: np.ndarray) -> np.ndarray:
    x, y = BASE / 2, BODY / 2
    shafts = np.array([[-x, y], [x, y], [x, -y], [-x, -y]])
    return shafts + CRANK * unit(angles)


def test_head_and_tail_are_where_circles_about_the_crank_tips_meet(model):
    angles = random_poses(model)
    solved = model.solve(angles)
    a1, a2, a3, a4 = np.moveaxis(tips(angles), -2, 0)
    np.testing.assert_allclose(solved.head, end_by_circles(a1, a2, 1), atol=1e-9)
    np.testing.assert_allclose(solved.tail, end_by_circles(a4, a3, -1), atol=1e-9)


def test_sliders_are_as_long_as_the_distance_of_their_arms_tips(model):
    angles = random_poses(model)
    solved = model.solve(angles)
    for side, (front, rear, turn) in enumerate([(0, 3, 90), (1, 2, -90)]):
        x = BASE / 2 * (-1 if side == 0 else 1)
        ends = [
            np.array([x, y]) + ARM * unit(angles[:, servo] + quarter)
            for servo, y, quarter in [(front, BODY / 2, turn), (rear, -BODY / 2, -turn)]
        ]
        length = np.linalg.norm(ends[0] - ends[1], axis=-1)
        np.testing.assert_allclose(solved.strokes[:, side], length - HALVES, atol=1e-9)


def test_margins_are_sines_between_links_and_decide_with_strokes_what_is_safe(model):
    angles = random_poses(model)
    solved = model.solve(angles)
    t2, t3, t6, t7 = np.radians(solved.couplers.T)
    a1, a2, a3, a4 = np.radians(angles.T)
    expected = [np.sin(t3 - t2), np.sin(t6 - t7)]
    expected += [np.sin(a1 - t2), np.sin(t3 - a2), np.sin(a3 - t7), np.sin(t6 - a4)]
    expected += [np.sin(a1), np.sin(a2), -np.sin(a3), -np.sin(a4)]
    np.testing.assert_allclose(solved.margins.T, expected, atol=1e-9)
    assert lizard.MARGINS[0] == "type2_head" and lizard.MARGINS[9] == "leg_lh"
    least, most = STROKE
    strokes = (solved.strokes >= least).all(-1) & (solved.strokes <= most).all(-1)
    safe = (solved.margins >= SINES).all(-1) & strokes
    np.testing.assert_array_equal(solved.safe, safe)
    assert 100 < safe.sum() < 1900


def test_inverse_gives_back_the_points_in_any_shape(model):
    angles = model.neutral + np.random.default_rng(2).uniform(-15, 15, (3, 5, 4))
    solved = model.solve(angles)
    found = model.inverse(head=solved.head, tail=solved.tail)
    np.testing.assert_allclose((found - angles + 180) % 360 - 180, 0, atol=1e-8)
    alone = model.inverse(tail=solved.tail)
    assert (alone[..., :2] == model.neutral[:2]).all()
    # In every mode each crank tip is a coupler's length from the point.
    modes = model.working_modes("head", solved.head)
    assert modes.shape == (3, 5, 4, 2)
    assert model.solve(np.zeros((2, 0, 4))).margins.shape == (2, 0, 10)
    shafts = np.array([[-BASE / 2, BODY / 2], [BASE / 2, BODY / 2]])
    gaps = shafts + CRANK * unit(modes) - solved.head[..., None, None, :]
    np.testing.assert_allclose(np.linalg.norm(gaps, axis=-1), COUPLER, atol=1e-9)


def test_what_does_not_close_is_nan_and_says_why(model):
    point = model.inverse(head=[[5, 120], [0, 500]])
    assert np.isnan(point[1, :2]).all() and np.isfinite(point[0]).all()
    apart = [180.0, 0.0, *model.neutral[2:]]
    wide = lizard.Model.from_toml(
        lizard.default_toml()
        .replace("l2 = 50.0", "l2 = 39.0")
        .replace("l3 = 50.0", "l3 = 39.0")
        .split("[gait.walk]")[0]
    )
    solved = wide.solve([apart, wide.neutral])
    assert np.isnan(solved.head[0]).all() and not solved.safe[0] and solved.safe[1]
    assert wide.mobility([apart, wide.neutral]).freedoms.tolist() == [-1, 4]
    assert wide.reasons(apart) == [
        "head: the crank tips are 80.000 mm apart, the couplers reach 78.000 mm"
    ]


def test_jacobians_are_the_derivatives_of_the_joints(model):
    angles, step = random_poses(model, 50), 1e-5
    active, passive = model.jacobians(angles)
    slopes = np.empty((50, 8, 4))
    for servo in range(4):
        moved = angles[:, None, :] + np.array([[step], [-step]]) * np.eye(4)[servo]
        s = model.solve(moved)
        pairs = zip(np.moveaxis(s.directions, -1, 0), np.moveaxis(s.strokes, -1, 0))
        joints = [*np.moveaxis(s.couplers, -1, 0)]
        joints += [joint for pair in pairs for joint in pair]
        for row, joint in enumerate(joints):
            change = (joint[:, 0] - joint[:, 1] + 180) % 360 - 180
            rate = change / (2 * step)
            slopes[:, row, servo] = np.degrees(rate) if row in (5, 7) else rate
    np.testing.assert_allclose(active + passive @ slopes, 0, atol=1e-3)


def test_poses_are_those_of_the_program(model, program):
    angles = random_poses(model, 20)
    rows = "\n".join(",".join(map(str, row)) for row in angles)
    answer = program("pose", "--json", text=rows + "\n")
    lines = [json.loads(line) for line in answer.stdout.splitlines()]
    solved = model.solve(angles)
    assert len(lines) == 20
    for i, line in enumerate(lines):
        assert line["head"] == solved.head[i].tolist()
        assert list(line["margins"].values()) == solved.margins[i].tolist()
        assert line["safe"] == solved.safe[i]
        assert line["why"] == model.reasons(angles[i])


def test_mobility_is_that_of_the_program(model, program):
    with pytest.raises(ValueError, match="last axis"):
        model.mobility([0.0])
    for pose in [model.neutral, np.array([90, 90, 270, 270]), model.neutral - 20]:
        names = ["--theta1", "--theta4", "--theta8", "--theta5"]
        words = [word for pair in zip(names, pose) for word in pair]
        answer = program("pose", "--show", "freedoms", "--json", *words)
        body = json.loads(answer.stdout)[0]
        found = model.mobility(pose)
        assert (found.freedoms, found.loose) == (
            body["freedoms"],
            body["locked_freedoms"],
        )
    # The paper's couplers never stretch; where shorter ones do, the head is loose.
    short = lizard.default_toml()
    for link in ("l2", "l3"):
        short = short.replace(f"{link} = 50.0", f"{link} = 35.0")
    stretched = np.degrees(np.arccos((35 - BASE / 2) / CRANK))
    loose = lizard.Model.from_toml(short.split("[gait.walk]")[0])
    pose = [180 - stretched, stretched, *model.neutral[2:]]
    assert (loose.mobility(pose).freedoms, loose.mobility(pose).loose) == (4, 1)


def test_gaits_are_those_of_the_program(model, program):
    answer = program("gaits", "--json")
    lines = [json.loads(line) for line in answer.stdout.splitlines()]
    lines = [line for line in lines if "gait" in line]
    assert model.gaits == [line["gait"] for line in lines]
    for line in lines:
        gait = model.gait(line["gait"])
        assert (gait.period, gait.peak_speed) == (line["period"], line["peak_speed"])
        least = min(
            (line[kind] for kind in ("type2", "type1", "leg")),
            key=lambda one: one["margin"],
        )
        assert gait.least_margin == (least["what"], least["margin"])
        for with_servos, key in [(False, "predicted"), (True, "by_servos")]:
            expected = [np.nan if v is None else v for v in line[key].values()]
            found = gait.predict(with_servos=with_servos)
            np.testing.assert_array_equal(found, expected)


def test_frames_are_those_of_the_trace_and_pulses_follow_the_servos_gain(
    model, program
):
    gait = model.gait("arc left")
    assert gait.name == "arc-left"
    rows = program("gaits", "--trace", "arc-left").stdout.splitlines()[1:]
    trace = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    np.testing.assert_allclose(gait.times, trace[:, 0], atol=1e-9)
    np.testing.assert_allclose(gait.angles, trace[:, 1:], atol=5.1e-4)
    pulses = 1500 + 10 * ((gait.angles - model.neutral + 180) % 360 - 180)
    np.testing.assert_allclose(gait.pulses, pulses, atol=1e-9)
    np.testing.assert_array_equal(model.pulses(gait.angles), gait.pulses)
    with pytest.raises(
        KeyError, match="there is no gait wlak; the gaits are stand, walk"
    ):
        model.gait("wlak")


def test_a_wrong_file_is_refused_in_the_programs_words(program, tmp_path):
    file = tmp_path / "my.toml"
    text = lizard.default_toml()
    for wrong, key in [
        ("amplitude = 20.0", "gait.walk"),
        ("min_us = 600.0", "servo.A1.min_us"),
    ]:
        assert wrong in text
        file.write_text(text.replace(wrong, wrong.split("=")[0] + "= 300.0", 1))
        with pytest.raises(lizard.RobotFileError) as error:
            lizard.Model.from_toml(file)
        answer = program("gaits", "--robot", file)
        assert answer.stderr == f"lizard: {error.value}\n" and answer.returncode == 2
        assert error.value.key.startswith(key) and error.value.file == str(file)
        line = file.read_text().splitlines()[error.value.line - 1]
        assert line.startswith(wrong.split(" ")[0])
    with pytest.raises(lizard.RobotFileError, match="none.toml"):
        lizard.Model.from_toml("none.toml")


def test_a_gait_is_checked_alone(model):
    table = '[gait.sway]\nperiod = 2.0\nwaveform = "wave"\nduty = 0.6\n'
    starts = "start = { LF = 0, RF = 0, RH = 0, LH = 0 }\n"
    swaying = model.with_gait(f"{table}amplitude = 10.0\n{starts}")
    assert swaying.gaits == ["stand", "sway"]
    with pytest.raises(lizard.RobotFileError, match=r"gait\.sway"):
        model.with_gait(f"{table}amplitude = 80.0\n{starts}")
    with pytest.raises(lizard.RobotFileError) as error:
        model.with_gait(table.replace("0.6", "6.0") + f"amplitude = 10.0\n{starts}")
    assert error.value.line == 4 and error.value.key == "gait.sway.duty"


def test_images_are_those_of_the_program(model, program, tmp_path):
    for words, only_robot in [([], False), (["--only-robot"], True)]:
        file = tmp_path / "image.hex"
        program("image", *words, "--output", file)
        assert file.read_text() == model.image(only_robot=only_robot)
    # The robot alone is the section, line by line.
    lines = [bytes.fromhex(line[1:]) for line in model.image(only_robot=True).split()]
    data = b"".join(line[4:-1] for line in lines if line[3] == 0)
    assert data == model.section() and sum(lines[0]) % 256 == 0


def test_the_wheel_has_its_licences_and_no_simulator(program):
    answer = program("sim")
    assert answer.returncode != 0 and "simulator" in answer.stderr
    site = Path(lizard.__file__).parent.parent
    installed = next(site.glob("lizard_robot-*.dist-info"))
    metadata = (installed / "METADATA").read_text()
    assert "License-Expression: MIT OR Apache-2.0" in metadata
    for name in ("LICENSE-MIT", "LICENSE-APACHE"):
        text = (Path(__file__).parents[3] / name).read_text()
        assert (installed / "licenses" / name).read_text() == text
    module = next((site / "lizard").glob("_lizard*")).read_bytes()
    simulator = b"avr_make_mcu"
    assert simulator not in module
    assert simulator in Path(os.environ["LIZARD"]).read_bytes()
