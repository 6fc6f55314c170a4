"""A machine file that has changed: shown key by key, and no drive goes on before somebody accepts it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

import resources
from app.compose.desk_assembly import create_desk_and_executor
from app.compose.machine.accepted_machine import (
    create_acceptance_record,
    get_settings_key,
    list_file_differences,
)
from app.compose.machine.machine_files import load_machine
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import NO_OFFSETS
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.status.state_prompt import make_page_prompt
from app.special.machine_records import MachineFileFunction
from app.special.special_functions import SpecialFunctionsModel
from core.executor.executor import Executor
from core.executor.snapshot import MachineState
from core.machine.machine_model import Machine
from drivers.wakeups import ManualClock
from tests.attached import attached
from tests.texts import begins, shows
from tests.texts import text as wording

SHIPPED = resources.read_machine_file("gt75.toml")


@dataclass
class Room:
    desk: Desk
    executor: Executor
    clock: ManualClock

    def run(self, ticks: int = 20) -> None:
        for _ in range(ticks):
            self.clock.advance(0.01)
            self.executor.run_tick()
        self.desk.update()

    @property
    def state(self) -> MachineState:
        return self.desk.read_snapshot().state

    @property
    def prompt(self) -> str:
        return make_page_prompt(self.desk, self.desk.read_snapshot(), self.desk.program_loader.loaded_program)

    @property
    def section(self) -> MachineFileFunction:
        functions = attached(self.desk, SpecialFunctionsModel).functions
        (found,) = [each for each in functions if isinstance(each, MachineFileFunction)]
        return found

    def cells(self) -> list[tuple[str, ...]]:
        return [row.cells for row in self.section.make_table(self.desk.read_snapshot()).rows]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "own.toml"
    path.write_text(SHIPPED)
    return path


@contextmanager
def room(file: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Room]:
    """The control from its start to its end, on one store."""
    monkeypatch.setenv("TURNDESK_HOME", str(file.parent / "home"))
    clock, journal = ManualClock(), Journal.open_default()
    desk, executor = create_desk_and_executor(str(file), lambda: NO_OFFSETS, clock, journal)
    made = Room(desk, executor, clock)
    made.run(2)
    try:
        yield made
    finally:
        desk.close()
        journal.close()


def test_new_machine_file_is_accepted_without_a_question(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for _ in range(2):
        with room(file, monkeypatch) as made:
            assert made.desk.changes.barred == ""
            assert made.cells() == []
            assert made.section.make_function_keys() == {}
            made.desk.enable_drives()
            made.run()
            assert made.state is MachineState.IDLE


def test_changed_machine_file_bars_drives_until_it_is_accepted(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with room(file, monkeypatch):
        pass
    file.write_text(
        SHIPPED.replace("vmax = 300", "vmax = 280", 1).replace("max_feed = 300", "max_feed = 250")
    )
    with room(file, monkeypatch) as made:
        assert shows(made.desk.prompt_notice, "desk.machine-file-changed", count=2)
        assert made.cells() == [("limits.max_feed", "300", "250"), ("axis.X.vmax", "300", "280")]
        made.desk.enable_drives()
        made.run()
        assert made.state is MachineState.DISABLED
        assert shows(made.desk.prompt_notice, "desk.machine-file-changed", count=2)
        assert shows(made.prompt, "desk.machine-file-changed", count=2)
        accept = made.section.make_function_keys()["F2"].action
        accept()
        accept()
        assert begins(made.desk.prompt_notice, "desk.accept-machine-file")
        assert made.desk.changes.barred
        made.desk.prompt_line._since = float("-inf")
        made.desk.confirm_question_if_unchanged()
        assert made.cells() == []
        assert not shows(made.prompt, "desk.machine-file-changed", count=2)
        made.desk.enable_drives()
        made.run()
        assert made.state is MachineState.IDLE
    with room(file, monkeypatch) as made:
        assert made.desk.changes.barred == ""


def test_unaccepted_change_is_asked_again_at_the_next_start(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with room(file, monkeypatch):
        pass
    file.write_text(SHIPPED.replace("lease_ms = 200", "lease_ms = 100"))
    for _ in range(2):
        with room(file, monkeypatch) as made:
            assert made.cells() == [("machine.lease_ms", "200", "100")]
    file.write_text(SHIPPED)
    with room(file, monkeypatch) as made:
        assert made.desk.changes.barred == ""


def test_machine_file_changes_and_acceptance_are_logged(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with room(file, monkeypatch):
        pass
    file.write_text(SHIPPED.replace("seed = 1", "seed = 2"))
    with room(file, monkeypatch) as made:
        made.desk.changes.accept_changes()
    journal = Journal.open_default()
    told = [event.text for event in journal.events("", (), 50)]
    journal.close()
    assert any(text == wording("desk.machine-file", what="sim.seed: 1 → 2") for text in told)
    assert any(
        shows(text, "desk.machine-file-accepted") and text.endswith(": sim.seed: 1 → 2") for text in told
    )


def bus_machine(tmp_path: Path) -> Machine:
    path = tmp_path / "bus.toml"
    path.write_text(resources.read_machine_file("gt75-canopen.toml"))
    return load_machine(path)


def test_changed_drive_settings_count_as_a_machine_file_change(tmp_path: Path) -> None:
    machine, kept = bus_machine(tmp_path), Persistence()
    record = create_acceptance_record(machine)
    drives = record["drives"]
    assert isinstance(drives, dict)
    assert sorted(drives) == ["X", "Z", "io", "spindle"]
    kept.save_setting(get_settings_key(machine), record)
    assert list_file_differences(machine, kept) == ()
    kept.save_setting(get_settings_key(machine), {**record, "drives": {**drives, "Z": "0123456789ab"}})
    (change,) = list_file_differences(machine, kept) or ()
    assert change.path.startswith("canopen.nodes.Z")
    assert change.old == "0123456789ab"


@pytest.mark.parametrize("damaged", [None, 3, {}, {"text": 5}])
def test_damaged_machine_file_record_is_treated_as_a_first_start(tmp_path: Path, damaged: object) -> None:
    machine, kept = bus_machine(tmp_path), Persistence()
    kept.save_setting(get_settings_key(machine), damaged)
    assert list_file_differences(machine, kept) is None
