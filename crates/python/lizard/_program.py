"""The command `lizard` of this package."""

import signal
import sys

from lizard import _lizard


def main() -> int:
    # Python's own signal handler would run only after the program has ended.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _lizard.run_program(["lizard", *sys.argv[1:]])
