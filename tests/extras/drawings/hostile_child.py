"""A process in the place of the one that reads a drawing: its file's text says what it does."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

from core.extras.drawings.drawing_child import limit_process_resources


def main() -> None:
    """Do it, within the limits of the arguments."""
    what = Path(sys.argv[1]).read_text(encoding="utf-8")
    limit_process_resources(int(sys.argv[2]), int(sys.argv[3]))
    if what == "hang":
        signal.pause()
    elif what == "spin":
        while True:
            pass
    elif what == "grow":
        bytearray(8 * 1024**3)
    elif what == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    elif what == "half":
        sys.stdout.write("\x40\0\0\0{")
    else:
        sys.stderr.write("words of a library\n")
        sys.stdout.write("words of a library\n")


if __name__ == "__main__":
    main()
