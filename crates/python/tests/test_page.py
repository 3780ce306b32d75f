"""The examples of docs/python.md and of the README run as they are."""

import re
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
def test_an_example_runs(page, code, capsys):
    exec(compile(code, page, "exec"), {})
    assert "print" not in code or capsys.readouterr().out


def test_there_are_examples_of_everything():
    assert len(EXAMPLES) == 5
