"""The wait of ``turndesk share``: a silent place is told, Ctrl+C ends the wait, refusals come through."""

from __future__ import annotations

import os
import subprocess
import threading
from pathlib import Path
from typing import cast

import pytest

from app.extras.sharing import location_wait
from app.extras.sharing.location_wait import run_location_work
from core.extras.sharing.shared_folder import MARKER_FILE_NAME, SharedFolder
from core.extras.sharing.shared_location import SharedLocation, SharingError, SharingErrorCause
from tests.coded import raises_code
from tests.texts import text as wording


class Place:
    """A place with a name only: the tests do its work."""

    name = "the database shop"


def test_silent_location_is_reported_once_and_its_response_still_used(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    told = threading.Event()
    tell = location_wait._tell

    def tell_and_answer(place: SharedLocation, seconds: float) -> None:
        tell(place, seconds)
        told.set()

    monkeypatch.setattr(location_wait, "_tell", tell_and_answer)
    assert run_location_work(cast("SharedLocation", Place()), lambda: told.wait(60.0), 0.0) is True
    said = wording("cli.no-response", place="the database shop", seconds=0, until="")
    assert capsys.readouterr() == ("", f"turndesk: {said}\n")


def test_timely_response_prints_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_location_work(cast("SharedLocation", Place()), lambda: 7) == 7
    assert capsys.readouterr() == ("", "")


def test_location_error_is_raised_in_the_caller() -> None:
    def refuse() -> None:
        raise SharingErrorCause.FULL.make_error("the folder x")

    with raises_code(SharingError, "disk-full", "folder x"):
        run_location_work(cast("SharedLocation", Place()), refuse)


def test_ctrl_c_ends_the_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    never = threading.Event()

    def press(*_args: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(location_wait, "wait", press)
    with pytest.raises(KeyboardInterrupt):
        run_location_work(cast("SharedLocation", Place()), lambda: never.wait(60.0))
    never.set()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_hanging_folder_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    os.mkfifo(tmp_path / MARKER_FILE_NAME)  # opening it waits for a writer, as a dead drive does
    waits, real = list[object](), subprocess.Popen.wait

    def in_no_time(process: subprocess.Popen[bytes], timeout: float | None = None) -> int:
        waits.append(timeout)
        if len(waits) == 2:
            process.kill()
            real(process)
        raise subprocess.TimeoutExpired("open", timeout or 0.0)

    touched = threading.Event()
    monkeypatch.setattr(subprocess.Popen, "wait", in_no_time)
    with raises_code(SharingError, "away", "300 s"):
        run_location_work(SharedFolder(tmp_path), touched.set)
    assert (waits, touched.is_set()) == ([30.0, 270.0], False)
    until = wording("cli.stops-waiting", seconds=300)
    said = wording("cli.no-response", place=f"the folder {tmp_path}", seconds=30, until=until)
    assert capsys.readouterr().err == f"turndesk: {said}\n"
