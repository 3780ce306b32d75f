"""Fixtures shared by all tests: the default robot's model, a simulated robot, and the program `lizard` of the wheel."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import lizard


@pytest.fixture(scope="session")
def model() -> lizard.Model:
    return lizard.Model.default()


@pytest.fixture
def robot() -> Iterator[lizard.Robot]:
    with lizard.Robot.simulated() as robot:
        yield robot


@pytest.fixture(scope="session")
def run_lizard() -> Callable[..., subprocess.CompletedProcess[str]]:
    """Returns a function that runs `lizard` with the given arguments and standard input."""
    program = Path(sys.executable).parent / "lizard"

    def run(*arguments: object, stdin: str = "") -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(argument) for argument in (program, *arguments)],
            check=False,
            input=stdin,
            capture_output=True,
            text=True,
        )

    return run
