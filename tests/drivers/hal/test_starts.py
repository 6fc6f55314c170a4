"""A halrun that ends at its start, or whose bridge refuses: one sentence that says why, and nothing left."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import pytest

import resources
from app.compose.backends.hal_backend import create_hal_config
from app.compose.machine.machine_files import parse_machine
from core.ports import DriverError
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_session import FOLDER_PREFIX, HalSession
from tests.coded import raises_code
from tests.texts import text

ROOT = Path(__file__).resolve().parents[3]
# Says in the bridge's stead what stands in WORDS, one packet each.
SAYS = """\
#!{python}
import json, socket, sys
from pathlib import Path
sys.path.insert(0, {root!r})
from drivers.hal.bridge.packets import pack_packet
if sys.argv[1] == "-f":
    bridge = socket.socket(fileno=json.loads(Path(sys.argv[2]).with_name("bridge.json").read_text())["fd"])
    for words in {words!r}:
        bridge.send(pack_packet(words))
"""


def config() -> HalConfig:
    """Of the shipped lathe."""
    return create_hal_config(parse_machine(resources.read_machine_file("gt75-hal.toml"), "gt75-hal.toml"))


@pytest.fixture
def path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder that is all of PATH and one for sessions, with no halrun yet."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def halrun(path: Path, text: str) -> None:
    file = path / "halrun"
    file.write_text(text, encoding="utf-8")
    file.chmod(0o755)


def refused(path: Path) -> DriverError:
    """How the start of a session ends; its folder is gone behind it."""
    with pytest.raises(DriverError) as told:
        HalSession(config(), 0.0)
    assert list(path.glob(f"{FOLDER_PREFIX}*")) == []
    return told.value


def test_missing_linuxcnc_reports_what_to_install(path: Path) -> None:
    error = refused(path)
    assert error.code == "hal-setup"
    assert "linuxcnc-uspace" in str(error)


@pytest.mark.parametrize(
    ("said", "told"),
    [
        (
            "Note: rt-preempt\nRefusing to run as root",
            text("drivers.hal-root"),
        ),
        ("Realtime already running.  Use 'halrun -U'", text("drivers.hal-other-session")),
        ("one\ntwo\n\nthree\nfour", "halrun ended during startup: two / three / four"),
        ("Note: only what is worth nothing", text("drivers.hal-mute")),
    ],
)
def test_halrun_that_exits_is_reported_with_its_output(path: Path, said: str, told: str) -> None:
    halrun(path, f"#!/bin/sh\n[ $1 = -U ] || printf '%s' \"{said}\"\nexit 1\n")
    error = refused(path)
    assert told in str(error)
    assert error.code == "hal-setup"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([{"error": "python3 has no module hal"}], "HAL: python3 has no module hal"),
        (
            [{"verdicts": [["hal.axes.X.command", "x-cmd", "there is no such pin"], ["b", "c", ""]]}],
            "hal.axes.X.command = x-cmd: there is no such pin",
        ),
        (
            [{}, {"verdicts": [["a", "b", "is written by another"], ["c", "d", "is no float"]]}],
            "a = b: is written by another (and 1 more)",
        ),
    ],
)
def test_error_of_the_bridge_is_reported_in_its_words(
    path: Path, words: list[dict[str, object]], told: str
) -> None:
    halrun(path, SAYS.format(python=sys.executable, root=str(ROOT), words=words))
    assert str(refused(path)) == told


def test_invalid_packet_of_the_bridge_ends_the_startup(path: Path) -> None:
    says = SAYS.format(python=sys.executable, root=str(ROOT), words=[[1, 2]])
    halrun(path, says)
    error = refused(path)
    assert error.code == "hal-setup"
    assert "packet" in str(error)


def test_check_only_session_returns_the_verdicts_of_all_pins(path: Path) -> None:
    """Then it is no fault of the session: who asked shows them all."""
    wrong = [["a", "b", "is written by another"], ["c", "d", ""]]
    halrun(path, SAYS.format(python=sys.executable, root=str(ROOT), words=[{"verdicts": wrong}]))
    session = HalSession(config(), 0.0, check_only=True)
    assert [tuple(each) for each in session.pin_verdicts] == [tuple(each) for each in wrong]
    session.close()
    assert list(path.glob(f"{FOLDER_PREFIX}*")) == []


def test_bridge_that_ends_after_startup_is_reported_as_lost(path: Path) -> None:
    ready = [{"ready": True, "pid": 1, "warnings": ["slow"]}]
    halrun(path, SAYS.format(python=sys.executable, root=str(ROOT), words=ready))
    session = HalSession(config(), 0.0)
    assert session.warnings == ("slow",)
    assert session._halrun is not None
    session._halrun.wait()
    assert session.has_shut_down
    with raises_code(DriverError, "hal-bridge"):
        list(session.receive_packets())
    with raises_code(DriverError, "hal-bridge"):
        session.send_packet(b"")
    session.close()
    assert list(path.glob(f"{FOLDER_PREFIX}*")) == []
