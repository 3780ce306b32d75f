"""The program `lizard` of this package, as a command."""

import signal
import sys

from lizard import _lizard


def main() -> int:
    # Python's own handler would wait until the program has ended.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _lizard.program(["lizard", *sys.argv[1:]])
