"""Every command in the shell blocks of the pages runs, in the order of its page, and ends with its status."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk, home, turndesk
from tests.documents.pages import ROOT, Page
from tests.documents.test_pages import WRITTEN, commands_of

__all__ = ["home", "turndesk"]

NOT_RUN: Mapping[str, str] = {
    "machine peer": "runs until it is stopped; tests/cli/test_machine_peer.py",
    "machine check resources/machines/gt75-bench.toml": "needs that peer",
    "run part.nc --headless --machine resources/machines/gt75-bench.toml": "needs that peer",
    "serial send": "needs a serial port; tests/cli/test_serial.py",
    "serial receive": "needs a serial port; tests/cli/test_serial.py",
    "--machine ac-table-mill": "opens the screen; tests/stories",
    "--demo": "opens the screen; tests/stories",
}
"""Commands that are not run here, by their first words, and what tests them."""
STATUS: Mapping[str, int] = {
    "prove resources/programs/bushing.nc": 1,  # the page explains the errors of this program
    "tools import": 2,  # the questions need a terminal; tests/extras/tool_tables
}
"""Exit status of the commands that do not end with 0, by their first words."""
FILES: Mapping[str, str] = {
    "part.nc": "pin.nc",
    "PIN.NC": "pin.nc",
    "parts/pin.nc": "pin.nc",
    "roof.h": "roof.h",
    "shaft.mpf": "shaft.mpf",
}
"""Files that the commands name, and the shipped programs that stand for them."""
MACHINES: Mapping[str, str] = {"hal": "gt75-mesa-7i76e.toml"}
"""Machines that stand for FILE, by the action of ``machine``; otherwise the simulated lathe."""
PAGES = [page for page in WRITTEN if any(command.complete for command, _ in commands_of(page))]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, turndesk: Turndesk) -> Path:
    """Return a folder with the files that the commands name; it is the current one."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "resources").symlink_to(ROOT / "resources")
    (tmp_path / "parts").mkdir()
    for name, program in FILES.items():
        shutil.copyfile(ROOT / "resources" / "programs" / program, tmp_path / name)
    shutil.copyfile(ROOT / "resources" / "programs" / "offsets.toml", tmp_path / "offsets.toml")
    Path("tools.toml").write_text('tool.1 = {kind = "turning", insert = "CNMG432", tip = 3}\n', "utf-8")
    Path("tool.tbl").write_text("T1 P1 X1 Z-1 D.03 Q2 ;rough\n", "utf-8")
    Path("tools.csv").write_text("Pos,Dia,Length\n1,50,-20\n", "utf-8")
    assert turndesk("offsets", "set", "T9", "kind=drill", "diameter=.25").status == 0
    return tmp_path


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_command_of_a_page_runs(page: Page, turndesk: Turndesk, folder: Path) -> None:
    ended = []
    for command, words in commands_of(page):
        text = " ".join(words)
        if not command.complete or any(text.startswith(each) for each in NOT_RUN):
            continue
        told = turndesk(*_with_files(words, turndesk, folder))
        expected = next((status for begin, status in STATUS.items() if text.startswith(begin)), 0)
        if told.status != expected:
            ended.append(f"{page.name}:{command.number}: {text}: {told.status}, {told.err.strip()}")
    assert ended == []


def _with_files(words: list[str], turndesk: Turndesk, folder: Path) -> list[str]:
    """Return the words of a command with an existing file for FILE."""
    if words[:1] == ["scope"]:
        assert turndesk("run", "part.nc", "--headless", "--offsets", "offsets.toml").status == 0
        record = folder / "home" / "records" / "run.ring"
        return [str(record) if word == "FILE" else word for word in words]
    if "T1D2" in words:
        assert turndesk("offsets", "set", "T1", "x=1", "z=1").status == 0
    if words[:1] == ["machine"]:
        machine = ROOT / "resources" / "machines" / MACHINES.get(words[1], "gt75.toml")
        shutil.copyfile(machine, folder / "FILE.toml")
        if words[1] == "mtconnect":
            with (folder / "FILE.toml").open("a", encoding="utf-8") as file:
                file.write("\n[mtconnect]\nenabled = true\n")
        return ["FILE.toml" if word == "FILE" else word for word in words]
    return words


def test_commands_excluded_from_the_run_are_still_in_a_page() -> None:
    texts = [" ".join(words) for page in PAGES for _, words in commands_of(page)]
    gone = [each for each in (*NOT_RUN, *STATUS) if not any(text.startswith(each) for text in texts)]
    assert gone == []
