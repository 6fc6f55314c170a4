"""PDF output by a separate process.

Text layout takes time, and the caller must not wait.
"""

from __future__ import annotations

import subprocess
import sys
from enum import StrEnum
from pathlib import Path
from tempfile import TemporaryDirectory

from core.message import Message
from core.process_environment import make_module_environment

_TIMEOUT_S = 120.0  # seconds


class PaperSize(StrEnum):
    """The supported paper sizes."""

    A4 = "a4"
    LETTER = "letter"


def make_pdf(html: str, title: str, paper: PaperSize) -> bytes:
    """Convert the HTML body of a page to PDF, and return the bytes.

    The footer shows ``title``. This runs on a worker. Raise OSError on failure.
    """
    with TemporaryDirectory(prefix="turndesk-") as folder:
        path = Path(folder) / "sheet.pdf"
        command = [sys.executable, "-m", "app.screen.pdf_pages", str(path), title, paper.value]
        around = make_module_environment(QT_QPA_PLATFORM="offscreen")
        try:
            done = subprocess.run(
                command, input=html.encode(), capture_output=True, timeout=_TIMEOUT_S, check=False, env=around
            )
        except subprocess.TimeoutExpired as error:
            raise OSError(
                0, Message("no PDF was created within {longest} s", longest=f"{_TIMEOUT_S:.0f}")
            ) from error
        if done.returncode:
            lines = done.stderr.decode(errors="replace").strip().splitlines()
            raise OSError(
                0,
                lines[-1]
                if lines
                else Message(
                    "the PDF was not created (return code {returncode})", returncode=done.returncode
                ),
            )
        return path.read_bytes()
