"""Child process that reads one drawing.

``drawing_process`` starts it with the command ``python -m core.extras.drawings.drawing_child FILE MEMORY
SECONDS``. It writes the drawing, or the error, to stdout in the format of ``encode_drawing``. Text output
of the drawing libraries is discarded.
"""

from __future__ import annotations

import gc
import logging
import os
import sys
import warnings
from pathlib import Path

from core.extras.drawings.drawing import DrawingError, encode_drawing, encode_error
from core.extras.drawings.drawing_file import read_drawing


def limit_process_resources(memory: int, seconds: int) -> None:
    """Limit this process to ``memory`` bytes of address space and ``seconds`` of processor time.

    The limits apply only on Linux.
    """
    if sys.platform != "linux":
        return
    import resource  # noqa: PLC0415  Windows has none

    limits = {resource.RLIMIT_AS: memory, resource.RLIMIT_CPU: seconds, resource.RLIMIT_CORE: 0}
    for kind, most in limits.items():
        _, hard = resource.getrlimit(kind)
        soft = most if hard == resource.RLIM_INFINITY else min(most, hard)
        # beyond the hard limit the process would be killed without a signal that shows the reason
        resource.setrlimit(kind, (soft, hard))


def read_and_encode_drawing(path: Path) -> bytes:
    """Read a drawing and return it encoded as bytes, or return the encoded error if reading fails."""
    try:
        return encode_drawing(read_drawing(path))
    except DrawingError as error:
        return encode_error(error)


def run() -> None:
    """Read the drawing that the command-line arguments specify."""
    path, memory, seconds = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    out = os.fdopen(os.dup(1), "wb")
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    gc.disable()  # the process ends before there is much to collect
    limit_process_resources(memory, seconds)
    out.write(read_and_encode_drawing(path))
    out.flush()
    os._exit(0)


if __name__ == "__main__":
    run()
