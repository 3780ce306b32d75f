"""Fixtures of all tests: the default robot, and the program of the wheel."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import lizard

Program = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def model() -> lizard.Model:
    return lizard.Model.default()


@pytest.fixture(scope="session")
def program() -> Program:
    """Runs `lizard`, with these words and this standard input."""
    path = Path(sys.executable).parent / "lizard"

    def run(*words: object, text: str = "") -> subprocess.CompletedProcess[str]:
        words = (path, *words)
        return subprocess.run(
            [str(word) for word in words],
            check=False,
            input=text,
            capture_output=True,
            text=True,
        )

    return run
