"""Shared programs on the screen: seen and compared, taken when asked, never one that runs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.extras.sharing.sharing import ProgramSharing
from app.extras.sharing.sharing_model import NO_LOCATION_MESSAGE, SharingModel
from app.extras.sharing.sharing_setup import SharingResultHandler
from core.executor.snapshot import MachineState
from core.extras.sharing.shared_folder import SharedFolder
from core.store.store import Store
from tests.screen.day import Day, Key, begun
from tests.texts import begins, shows
from tests.texts import text as wording

PEG = "(PEG)\nG90G94F300G72\nT1\nM03S2000\nG00X.7Z.1\nX.5\nG01G94F60Z-.3\nX.7\nG00Z1\nM05\nM30\n"
BETTER = PEG.replace("F60", "F40")


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    """PEG on the desk with T1 touched off; nothing is shared yet."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    with begun(qtbot, "peg.nc", PEG) as day:
        day.store.offsets.tool_offsets.change_row(
            1, "test", {"x": -12.7, "z": -50.8, "nose_radius": 0.4, "quadrant": 3}
        ).result(60)
        day.desk.offset_book.read_store()
        yield day


@pytest.fixture
def other(tmp_path: Path) -> Iterator[ProgramSharing]:
    """Another lathe of the shop."""
    (tmp_path / "shop").mkdir()
    (tmp_path / "other" / "programs").mkdir(parents=True)
    place = SharedFolder(tmp_path / "shop")
    place.set_up()
    with Store.open(tmp_path / "other") as store:
        yield ProgramSharing(place, "LATHE 2", "2" * 32, tmp_path / "other" / "programs", lambda: store)


@pytest.fixture
def sharing(day: Day, other: ProgramSharing, tmp_path: Path) -> ProgramSharing:
    """This desk shares; the other one has taken PEG and made it better."""
    made = ProgramSharing(
        SharedFolder(tmp_path / "shop"),
        "LATHE 1",
        "1" * 32,
        tmp_path / "home" / "programs",
        day.journal.require_store,
    )
    before = day.desk.page_registry.find_model(SharingModel)
    assert before is not None
    before.close()
    day.desk.page_registry.attach_model(SharingModel(day.desk, made))
    made.synchronize()
    other.copy_version(other.synchronize().versions_by_program["peg.nc"].newest_versions[0])
    (tmp_path / "other" / "programs" / "peg.nc").write_text(BETTER)
    other.synchronize()
    made.synchronize()
    return made


def model(day: Day) -> SharingModel:
    found = day.desk.page_registry.find_model(SharingModel)
    assert found is not None
    return found


def opened(day: Day) -> None:
    day.key(Key.Key_F1, Key.Key_X)
    day.sees(lambda: day.page == "SHARED PROGRAMS")


def test_newer_program_is_compared_and_copied_on_request(
    day: Day, sharing: ProgramSharing, tmp_path: Path
) -> None:
    peg = tmp_path / "home" / "programs" / "peg.nc"
    opened(day)
    day.sees(lambda: bool(model(day).remote_versions.changes))
    assert model(day).make_table().rows[0].cells[:3] == (
        "peg.nc",
        "NEWER VERSION ON ANOTHER CONTROL",
        "LATHE 2",
    )
    signs = [(row.sign, row.text) for row in model(day).remote_versions.changes if row.sign in "+-"]
    assert signs == [("-", "G01G94F60Z-.3"), ("+", "G01G94F40Z-.3")]
    day.key(Key.Key_F2)
    assert begins(day.prompt, "screen.take-shared", name="peg.nc", desk="LATHE 2")
    day.key(Key.Key_Escape)
    assert peg.read_text() == PEG
    day.key(Key.Key_F2)
    day.run(0.7)  # long enough to have been read
    day.key(Key.Key_Y)
    day.sees(lambda: day.prompt == wording("screen.taken-shared", name="peg.nc", desk="LATHE 2"))
    assert peg.read_text() == BETTER
    day.sees(lambda: model(day).make_table().rows[0].cells[1] == "UP TO DATE")
    with sharing._store().read() as connection:
        kept = [bytes(text) for (text,) in connection.execute("SELECT text FROM program_versions")]
    assert PEG.encode() in kept


def test_a_program_that_runs_is_not_replaced(day: Day, sharing: ProgramSharing, tmp_path: Path) -> None:
    day.key(Key.Key_D)
    assert day.desk.program_choice.load_by_name("peg")
    day.sees(lambda: day.prompt.startswith(wording("screen.to-start")))
    day.palms()
    day.reaches(MachineState.RUN)
    opened(day)
    day.sees(lambda: model(day).selected_version is not None)
    day.key(Key.Key_F2)
    assert day.prompt == wording("screen.program-being-cut", name="peg.nc")
    day.key(Key.Key_Return)
    assert (tmp_path / "home" / "programs" / "peg.nc").read_text() == PEG


def test_f3_resolves_a_conflict_with_the_local_version(
    day: Day, sharing: ProgramSharing, other: ProgramSharing, tmp_path: Path
) -> None:
    mine = PEG.replace("S2000", "S1500")
    (tmp_path / "home" / "programs" / "peg.nc").write_text(mine)
    opened(day)
    day.key(Key.Key_F3)
    assert begins(day.prompt, "screen.nothing-to-settle")
    sharing.synchronize()
    day.sees(lambda: model(day).make_table().rows[0].cells[1] == wording("screen.changed-on-both"))
    day.key(Key.Key_F3)
    assert begins(day.prompt, "screen.keep-own", name="peg.nc")
    day.sees(lambda: not model(day).worker.is_busy)  # the versions of the others are read
    day.run(0.7)
    day.key(Key.Key_Y)
    day.sees(lambda: day.prompt == wording("screen.kept-own", name="peg.nc"))
    sharing.synchronize()
    assert other.synchronize().states_by_program == {"peg.nc": "newer"}


def test_unreachable_location_is_shown_and_logged_once(
    day: Day, sharing: ProgramSharing, tmp_path: Path
) -> None:
    (tmp_path / "shop").rename(tmp_path / "unmounted")
    heard = SharingResultHandler(day.desk, day.journal)
    for _ in range(3):
        heard.handle_result(sharing.synchronize())
    day.saved()
    told = [each.text for each in day.journal.events("was not found", (), 10)]
    assert len(told) == 1
    opened(day)
    assert shows(" ".join(model(day).make_table().notes), "screen.share-not-there")
    day.sees(lambda: model(day).selected_version is not None)
    day.key(Key.Key_F2)
    day.run(0.7)
    day.key(Key.Key_Y)
    day.sees(lambda: day.prompt.startswith(wording("screen.refused", why="the folder")))


def test_change_to_the_loaded_program_is_reported_once(day: Day, sharing: ProgramSharing) -> None:
    assert day.desk.program_choice.load_by_name("peg")
    day.sees(lambda: not day.desk.program_loader.loaded_program.is_busy)
    heard = SharingResultHandler(day.desk, day.journal)
    day.desk.ask_operator("PRESS Y TO DELETE IT", lambda: None)
    heard.handle_result(
        sharing.last_result
    )  # on the sharing thread: a question is not spoilt in the middle of being asked
    assert day.desk.prompt_notice == "PRESS Y TO DELETE IT"
    day.desk.update()
    assert (day.desk.prompt_line.message, day.desk.prompt_line.question_text) == (
        wording("screen.changed-elsewhere", name="peg.nc", desk="LATHE 2"),
        "PRESS Y TO DELETE IT",
    )
    day.desk.clear_prompt_line()
    heard.handle_result(sharing.last_result)
    day.desk.update()
    assert day.desk.prompt_notice == ""


def test_page_without_a_location_explains_how_to_set_one(day: Day) -> None:
    opened(day)
    assert model(day).make_table().notes == (NO_LOCATION_MESSAGE,)
    day.key(Key.Key_F2)
    assert day.prompt == wording("screen.mark-program")
    day.key(Key.Key_F5)
    assert day.prompt == NO_LOCATION_MESSAGE


def test_location_that_never_responds_is_reported_and_queues_nothing(
    day: Day, sharing: ProgramSharing
) -> None:
    """A dead network drive: the look waits for ever. The page says so behind 30 s, and queues nothing."""
    model(day).get_waiting_time_s = lambda: 29.0
    assert not any(shows(note, "screen.share-silent") for note in model(day).make_table().notes)
    opened(day)
    day.sees(lambda: model(day).selected_version is not None and not model(day).worker.is_busy)
    model(day).get_waiting_time_s = lambda: 95.0
    said = wording("screen.share-silent", name=sharing.location.name, seconds=95)
    assert shows(" ".join(model(day).make_table().notes), "screen.share-silent", seconds=95)
    for key in (Key.Key_F5, Key.Key_F2):
        day.desk.clear_prompt_line()
        day.key(key)
        assert day.desk.prompt_notice.startswith(said)
    assert not model(day).worker.is_busy
