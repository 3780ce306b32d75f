"""Fixtures shared by all tests: the default robot, and the program `lizard` installed from the wheel."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import lizard

RunLizard = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def model() -> lizard.Model:
    return lizard.Model.default()


@pytest.fixture(scope="session")
def run_lizard() -> RunLizard:
    """Returns a function that runs `lizard` with arguments and with a text as standard input."""
    path = Path(sys.executable).parent / "lizard"

    def run(*arguments: object, text: str = "") -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(argument) for argument in (path, *arguments)],
            check=False,
            input=text,
            capture_output=True,
            text=True,
        )

    return run
