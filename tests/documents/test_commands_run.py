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
    "machine peer": "runs until it is stopped; tests/killed/test_controller.py",
    "machine check resources/machines/gt75-bench.toml": "needs that peer; tests/cli/test_machine_bus.py",
    "run part.nc --headless --machine resources/machines/gt75-bench.toml": (
        "needs that peer; tests/cli/test_machine_bus.py"
    ),
    "serial send": "needs a serial port; tests/drivers/transfer/test_commands.py",
    "serial receive": "needs a serial port; tests/drivers/transfer/test_commands.py",
    "--machine ac-table-mill": "opens the screen; tests/stories",
    "--demo": "opens the screen; tests/stories",
}
"""Commands that are not run here, by their first words, with the reason and with what tests them."""
OTHER_PROGRAMS: Mapping[str, str] = {
    "sh app/start.sh": "installs packages and opens the screen; tests/setup/test_environment.py",
    "sh tests/run.sh": "would run this test; .ci/run",
    "ip link set can0 up": "needs a CAN interface and the rights of root; tests/drivers/canopen",
    "sudo TURNDESK_OPERATOR=anna apt install": "changes the system; resources/setup/release_check.py",
    "sudo apt install xserver-xorg": "changes the system; the control file is checked by tests/setup",
    "sudo systemctl enable turndesk-kiosk@": "changes the system; tests/setup/test_release.py",
    "sudo sh turndesk-….run": "changes the system; resources/setup/release_check.py",
    ".venv/bin/python -m resources.setup.bundle": "needs a network; resources/setup/release.py",
    "groupadd -f machine; usermod": "changes the accounts of the system; resources/setup/debian/postinst",
}
"""Commands of other programs, which are not run here, with the reason and with what runs or tests them."""
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
    others = [command.text for page in WRITTEN for command in page.commands]
    gone += [each for each in OTHER_PROGRAMS if not any(text.startswith(each) for text in others)]
    assert gone == []


def find_unexplained_commands(page: Page) -> list[str]:
    """Return the commands in the shell blocks of a page that are neither run nor excluded with a reason."""
    own = {command for command, _ in commands_of(page)}
    return [
        f"{page.name}:{command.number}: {command.text}"
        for command in page.commands
        if command.complete and command not in own and not command.text.startswith(tuple(OTHER_PROGRAMS))
    ]


def test_each_command_is_run_or_excluded_with_a_reason() -> None:
    assert [each for page in WRITTEN for each in find_unexplained_commands(page)] == []


def test_command_without_a_reason_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.documents.pages.ROOT", tmp_path)
    (tmp_path / "a.md").write_text("```sh\nrm -r x\nturndesk where\nsh app/start.sh --kiosk\n```\n")
    assert find_unexplained_commands(Page(tmp_path / "a.md")) == ["a.md:2: rm -r x"]


def test_reasons_name_existing_tests_and_scripts() -> None:
    named = {word for reason in (*NOT_RUN.values(), *OTHER_PROGRAMS.values()) for word in reason.split()}
    paths = [word for word in named if "/" in word]
    assert len(paths) >= 8
    assert [path for path in paths if not (ROOT / path).exists()] == []
    assert [each for each in (*NOT_RUN.values(), *OTHER_PROGRAMS.values()) if "; " not in each] == []
