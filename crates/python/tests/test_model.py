"""Tests that the model agrees with the geometry computed in numpy and with the command line's JSON output."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

import lizard

# Dimensions (mm) and limits of the paper's robot.
BASE, CRANK, COUPLER, BODY_LENGTH = 20.0, 30.0, 50.0, 135.0
SLIDER_ARM, NOMINAL_SLIDER_LENGTH = 30.0, 90.0
MIN_MARGIN, STROKE_RANGE = 0.3, (-15.0, 45.0)


def unit_vector(degrees: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))], -1)


def sample_poses(model: lizard.Model, count: int = 2000) -> np.ndarray:
    return model.neutral + np.random.default_rng(1).uniform(-40, 40, (count, 4))


def compute_end_point(left: np.ndarray, right: np.ndarray, sign: float) -> np.ndarray:
    """Computes the outer intersection of the coupler circles around two crank tips; sign: 1 for head, -1 for tail."""
    gap = right - left
    length = np.linalg.norm(gap, axis=-1, keepdims=True)
    normal = np.stack([-gap[..., 1], gap[..., 0]], -1) / length
    return (left + right) / 2 + sign * normal * np.sqrt(COUPLER**2 - length**2 / 4)


def compute_crank_tips(angles: np.ndarray) -> np.ndarray:
    x, y = BASE / 2, BODY_LENGTH / 2
    shafts = np.array([[-x, y], [x, y], [x, -y], [-x, -y]])
    return shafts + CRANK * unit_vector(angles)


def test_head_and_tail_are_at_the_intersections_of_the_coupler_circles(model):
    angles = sample_poses(model)
    solved = model.solve(angles)
    a1, a2, a3, a4 = np.moveaxis(compute_crank_tips(angles), -2, 0)
    np.testing.assert_allclose(solved.head, compute_end_point(a1, a2, 1), atol=1e-9)
    np.testing.assert_allclose(solved.tail, compute_end_point(a4, a3, -1), atol=1e-9)


def test_a_sliders_length_is_the_distance_between_the_tips_of_its_arms(model):
    angles = sample_poses(model)
    solved = model.solve(angles)
    for side, (front, rear, arm_angle) in enumerate([(0, 3, 90), (1, 2, -90)]):
        x = BASE / 2 * (-1 if side == 0 else 1)
        y = BODY_LENGTH / 2
        ends = [
            np.array([x, end_y]) + SLIDER_ARM * unit_vector(angles[:, servo] + offset)
            for servo, end_y, offset in [(front, y, arm_angle), (rear, -y, -arm_angle)]
        ]
        strokes = np.linalg.norm(ends[0] - ends[1], axis=-1) - NOMINAL_SLIDER_LENGTH
        np.testing.assert_allclose(solved.strokes[:, side], strokes, atol=1e-9)


def test_margins_are_sines_of_angles_between_links(model):
    angles = sample_poses(model)
    solved = model.solve(angles)
    t2, t3, t6, t7 = np.radians(solved.couplers.T)
    a1, a2, a3, a4 = np.radians(angles.T)
    expected = [np.sin(t3 - t2), np.sin(t6 - t7)]
    expected += [np.sin(a1 - t2), np.sin(t3 - a2), np.sin(a3 - t7), np.sin(t6 - a4)]
    expected += [np.sin(a1), np.sin(a2), -np.sin(a3), -np.sin(a4)]
    np.testing.assert_allclose(solved.margins.T, expected, atol=1e-9)
    assert lizard.MARGINS[0] == "type2_head" and lizard.MARGINS[9] == "leg_lh"


def test_a_pose_is_safe_if_its_margins_and_strokes_are_within_the_limits(model):
    solved = model.solve(sample_poses(model))
    low, high = STROKE_RANGE
    has_allowed_strokes = ((low <= solved.strokes) & (solved.strokes <= high)).all(-1)
    expected = (solved.margins >= MIN_MARGIN).all(-1) & has_allowed_strokes
    np.testing.assert_array_equal(solved.safe, expected)
    assert 100 < expected.sum() < 1900


def test_solve_inverse_recovers_the_angles_for_any_array_shape(model):
    angles = model.neutral + np.random.default_rng(2).uniform(-15, 15, (3, 5, 4))
    solved = model.solve(angles)
    recovered = model.solve_inverse(head=solved.head, tail=solved.tail)
    np.testing.assert_allclose((recovered - angles + 180) % 360 - 180, 0, atol=1e-8)
    tail_only = model.solve_inverse(tail=solved.tail)
    assert (tail_only[..., :2] == model.neutral[:2]).all()
    # In every working mode, the distance of each crank tip from the head point is the coupler's length.
    modes = model.working_modes("head", solved.head)
    assert modes.shape == (3, 5, 4, 2)
    assert model.solve(np.zeros((2, 0, 4))).margins.shape == (2, 0, 10)
    shafts = np.array([[-BASE / 2, BODY_LENGTH / 2], [BASE / 2, BODY_LENGTH / 2]])
    gaps = shafts + CRANK * unit_vector(modes) - solved.head[..., None, None, :]
    np.testing.assert_allclose(np.linalg.norm(gaps, axis=-1), COUPLER, atol=1e-9)


def test_a_loop_that_does_not_close_has_nan_and_a_reason(model):
    solved_angles = model.solve_inverse(head=[[5, 120], [0, 500]])
    assert np.isnan(solved_angles[1, :2]).all() and np.isfinite(solved_angles[0]).all()
    open_pose = [180.0, 0.0, *model.neutral[2:]]
    short_coupler_model = load_model_with_couplers(39.0)
    solved = short_coupler_model.solve([open_pose, short_coupler_model.neutral])
    assert np.isnan(solved.head[0]).all() and not solved.safe[0] and solved.safe[1]
    mobility = short_coupler_model.mobility([open_pose, short_coupler_model.neutral])
    assert mobility.freedoms.tolist() == [-1, 4]
    assert short_coupler_model.describe_violations(open_pose) == [
        "head: the crank tips are 80.000 mm apart, but the couplers reach only 78.000 mm"
    ]


def load_model_with_couplers(length: float) -> lizard.Model:
    """Loads the default robot, without its gaits, with another length of the head's couplers."""
    text = lizard.default_toml().split("[gait.walk]")[0]
    for link in ("l2", "l3"):
        text = text.replace(f"{link} = 50.0", f"{link} = {length}")
    return lizard.Model.from_toml(text)


def test_jacobians_are_the_derivatives_of_the_joint_coordinates(model):
    angles, step = sample_poses(model, 50), 1e-5
    active, passive = model.jacobians(angles)
    slopes = np.empty((50, 8, 4))
    for servo in range(4):
        shifted = angles[:, None, :] + np.array([[step], [-step]]) * np.eye(4)[servo]
        solved = model.solve(shifted)
        directions = np.moveaxis(solved.slider_directions, -1, 0)
        pairs = zip(directions, np.moveaxis(solved.strokes, -1, 0))
        joints = [*np.moveaxis(solved.couplers, -1, 0)]
        joints += [joint for pair in pairs for joint in pair]
        for row, joint in enumerate(joints):
            change = (joint[:, 0] - joint[:, 1] + 180) % 360 - 180
            rate = change / (2 * step)
            slopes[:, row, servo] = np.degrees(rate) if row in (5, 7) else rate
    np.testing.assert_allclose(active + passive @ slopes, 0, atol=1e-3)


def test_solutions_match_the_command_line(model, run_lizard):
    angles = sample_poses(model, 20)
    rows = "\n".join(",".join(map(str, row)) for row in angles)
    result = run_lizard("pose", "--json", stdin=rows + "\n")
    solutions = [json.loads(line) for line in result.stdout.splitlines()]
    solved = model.solve(angles)
    assert len(solutions) == 20
    for i, solution in enumerate(solutions):
        assert solution["head"] == solved.head[i].tolist()
        assert list(solution["margins"].values()) == solved.margins[i].tolist()
        assert solution["safe"] == solved.safe[i]
        assert solution["why"] == model.describe_violations(angles[i])


def test_mobility_matches_the_command_line(model, run_lizard):
    with pytest.raises(ValueError, match="last axis"):
        model.mobility([0.0])
    for pose in [model.neutral, np.array([90, 90, 270, 270]), model.neutral - 20]:
        names = ["--theta1", "--theta4", "--theta8", "--theta5"]
        arguments = [word for pair in zip(names, pose) for word in pair]
        result = run_lizard("pose", "--show", "freedoms", "--json", *arguments)
        body = json.loads(result.stdout)[0]
        mobility = model.mobility(pose)
        assert mobility.freedoms == body["freedoms"]
        assert mobility.locked_freedoms == body["locked_freedoms"]


def test_the_head_is_loose_if_its_couplers_are_collinear(model):
    # The paper's couplers cannot become collinear, but shorter couplers can.
    collinear_angle = np.degrees(np.arccos((35 - BASE / 2) / CRANK))
    pose = [180 - collinear_angle, collinear_angle, *model.neutral[2:]]
    mobility = load_model_with_couplers(35.0).mobility(pose)
    assert (mobility.freedoms, mobility.locked_freedoms) == (4, 1)


def test_gaits_match_the_command_line(model, run_lizard):
    result = run_lizard("gaits", "--json")
    rows = [json.loads(line) for line in result.stdout.splitlines()]
    rows = [row for row in rows if "gait" in row]
    assert model.gaits == [row["gait"] for row in rows]
    for row in rows:
        gait = model.gait(row["gait"])
        assert (gait.period, gait.peak_speed) == (row["period"], row["peak_speed"])
        min_margin = min(
            (row[kind] for kind in ("type2", "type1", "leg")),
            key=lambda margin: margin["margin"],
        )
        assert gait.min_margin == (min_margin["what"], min_margin["margin"])
        for with_servos, key in [(False, "predicted"), (True, "by_servos")]:
            expected = [
                np.nan if value is None else value for value in row[key].values()
            ]
            predicted = gait.predict(with_servos=with_servos)
            np.testing.assert_array_equal(predicted, expected)


def test_frames_match_the_trace_and_pulses_match_the_servo_gain(model, run_lizard):
    gait = model.gait("arc left")
    assert gait.name == "arc-left"
    rows = run_lizard("gaits", "--trace", "arc-left").stdout.splitlines()[1:]
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


def test_the_error_for_an_invalid_file_matches_the_command_line(run_lizard, tmp_path):
    robot_path = tmp_path / "my.toml"
    text = lizard.default_toml()
    for entry, key in [
        ("amplitude = 20.0", "gait.walk"),
        ("min_us = 600.0", "servo.A1.min_us"),
    ]:
        assert entry in text
        robot_path.write_text(text.replace(entry, entry.split("=")[0] + "= 300.0", 1))
        with pytest.raises(lizard.RobotFileError) as error:
            lizard.Model.from_toml(robot_path)
        result = run_lizard("gaits", "--robot", robot_path)
        assert result.stderr == f"lizard: {error.value}\n" and result.returncode == 2
        assert error.value.key.startswith(key) and error.value.file == str(robot_path)
        line = robot_path.read_text().splitlines()[error.value.line - 1]
        assert line.startswith(entry.split(" ")[0])
    with pytest.raises(lizard.RobotFileError, match="none.toml"):
        lizard.Model.from_toml("none.toml")


def test_with_gait_validates_the_added_gait(model):
    table = '[gait.sway]\nperiod = 2.0\nwaveform = "wave"\nduty = 0.6\n'
    starts = "start = { LF = 0, RF = 0, RH = 0, LH = 0 }\n"
    swaying = model.with_gait(f"{table}amplitude = 10.0\n{starts}")
    assert swaying.gaits == ["stand", "sway"]
    with pytest.raises(lizard.RobotFileError, match=r"gait\.sway"):
        model.with_gait(f"{table}amplitude = 80.0\n{starts}")
    with pytest.raises(lizard.RobotFileError) as error:
        model.with_gait(table.replace("0.6", "6.0") + f"amplitude = 10.0\n{starts}")
    assert error.value.line == 4 and error.value.key == "gait.sway.duty"


def test_images_match_the_command_line(model, run_lizard, tmp_path):
    for options, only_robot in [([], False), (["--only-robot"], True)]:
        image_path = tmp_path / "image.hex"
        run_lizard("flash", "image", *options, "--output", image_path)
        assert image_path.read_text() == model.image(only_robot=only_robot)
    # The robot-only image holds exactly the robot's flash section.
    lines = [bytes.fromhex(line[1:]) for line in model.image(only_robot=True).split()]
    data = b"".join(line[4:-1] for line in lines if line[3] == 0)
    assert data == model.section() and sum(lines[0]) % 256 == 0


def test_the_wheel_contains_its_licences_and_no_simulator(run_lizard):
    result = run_lizard("sim")
    assert result.returncode != 0 and "simulator" in result.stderr
    site_packages = Path(lizard.__file__).parent.parent
    dist_info = next(site_packages.glob("lizard_robot-*.dist-info"))
    metadata = (dist_info / "METADATA").read_text()
    assert "License-Expression: MIT OR Apache-2.0" in metadata
    for name in ("LICENSE-MIT", "LICENSE-APACHE"):
        text = (Path(__file__).parents[3] / name).read_text()
        assert (dist_info / "licenses" / name).read_text() == text
    module = next((site_packages / "lizard").glob("_lizard*")).read_bytes()
    simulator = b"avr_make_mcu"
    assert simulator not in module
    assert simulator in Path(os.environ["LIZARD"]).read_bytes()
