"""Tests that the unchanged examples in docs/python.md and in the README run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
EXAMPLES = [
    (page, code)
    for page in ("docs/python.md", "crates/python/README.md")
    for code in re.findall(
        r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.DOTALL | re.MULTILINE
    )
]


@pytest.mark.parametrize(("page", "code"), EXAMPLES)
def test_example_runs(page, code):
    result = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True
    )
    assert "print" not in code or result.stdout


def test_all_examples_are_found():
    assert len(EXAMPLES) == 5
