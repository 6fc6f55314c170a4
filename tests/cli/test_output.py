"""Where output cannot go: a full disk behind stdout, a name that is a pipe's or a device's."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

import pytest

from app.cli.main import main
from core.file_replacement import replace_atomically


@pytest.mark.skipif(not Path("/dev/full").is_char_device(), reason="no device here that is always full")
@pytest.mark.parametrize("words", [["--version"], ["--help"], ["prove", "--help"]])
def test_full_disk_on_stdout_is_reported_in_one_line(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with Path("/dev/full").open("w") as full, monkeypatch.context() as patch:
        patch.setattr(sys, "stdout", full)
        status = main(words)
    told = capsys.readouterr().err
    assert (status, told.count("\n")) == (2, 1)
    assert "stdout" in told
    assert os.strerror(errno.ENOSPC) in told


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_atomic_replace_rejects_a_pipe_or_device(tmp_path: Path) -> None:
    pipe, finished = tmp_path / "pipe", tmp_path / "finished"
    os.mkfifo(pipe)
    finished.write_bytes(b"t,x\n")
    with pytest.raises(OSError) as caught:  # noqa: PT011  the number and the name tell it
        replace_atomically(finished, pipe)
    assert (caught.value.errno, caught.value.filename) == (errno.EINVAL, str(pipe))
    assert (pipe.is_fifo(), finished.read_bytes()) == (True, b"t,x\n")
