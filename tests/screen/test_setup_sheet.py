"""The setup sheet on F10: what stands on it, notes, its files; and what is refused."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from app.compose.program_proving import get_samples_folder
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import read_offsets_file
from app.desk.desk import Desk
from app.desk.translation import get_language
from app.programs.removable_media import UsbStick
from app.report.pdf_file import PaperSize
from app.special.setup_sheet_function import MOST_NOTES, SetupSheetFunction
from app.special.special_view import SpecialFunctionsPage
from tests.pdf_text import Pdf
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key
from tests.screen.yes import yes
from tests.texts import begins, shows, text_in_spanish
from tests.texts import text as wording

SETUP = "SETUP SHEET"


@pytest.fixture
def desk(machine: FakeMachine, journal: Journal) -> Desk:
    return desk_on(machine, keep=journal)


def opened(hands: Hands, program: str = "bushing") -> tuple[SpecialFunctionsPage, SetupSheetFunction]:
    if program:
        hands.desk.program_choice.load_by_name(program)
        hands.desk.program_loader.wait_until_loaded(60.0)
    hands.key(Key.Key_F10)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    names = [function.name for function in page.model.functions]
    page.model.open_function(names.index(SETUP))
    function = page.model.shown_function
    assert isinstance(function, SetupSheetFunction)
    if program:
        hands.sees(lambda: function.prepared_sheet is not None)
        hands.sees(lambda: len(page.table_panel.table.rows) > 3)
    return page, function


def rows(page: SpecialFunctionsPage) -> dict[str, str]:
    return {row.cells[0]: row.cells[1] for row in page.table_panel.table.rows}


def take_note(hands: Hands, text: str) -> None:
    hands.key(Key.Key_F2)
    hands.type(text)
    hands.key(Key.Key_Return)


def test_sheet_lists_tools_offsets_stock_and_stops(hands: Hands) -> None:
    page, _ = opened(hands)
    said = rows(page)
    offset = read_offsets_file(get_samples_folder() / "offsets.toml").tool_offsets[2]
    assert f"X (radius) {offset.x / 25.4:.4f} in   Z {offset.z / 25.4:.4f} in" in said["T2"]
    assert said["T2"].startswith("BORING")
    assert "(assumed)" in said["T2"]
    assert "Ø 1." in said["STOCK"]
    assert "GAUGE THE OUTSIDE AND CORRECT D1" in said["M01"]
    assert {"TIME PER PART", "STICK-OUT", "T1", "T3", "D1"} <= set(said)
    drawn = {row.cells[0] for row in page.table_panel.table.rows if row.tool_outline is not None}
    assert drawn == {"T1", "T2", "T3"}


def test_notes_follow_renamed_program(hands: Hands, journal: Journal) -> None:
    page, function = opened(hands)
    take_note(hands, "SOFT JAWS")
    take_note(hands, "BAR .02 OUT")
    hands.sees(lambda: rows(page).get("NOTE 2") == "BAR .02 OUT")
    hands.key(Key.Key_Return)  # the one that was typed last is marked
    hands.type(" MORE")
    hands.key(Key.Key_Return)
    assert function.notes == ["SOFT JAWS", "BAR .02 OUT MORE"]
    hands.sees(lambda: journal.read_setting("notes:bushing.nc") == ["SOFT JAWS", "BAR .02 OUT MORE"])
    function.on_open()  # read anew from what is kept
    assert function.notes == ["SOFT JAWS", "BAR .02 OUT MORE"]
    hands.desk.program_choice.load_by_name("pin")
    hands.desk.program_loader.wait_until_loaded(60.0)
    assert function.notes == []
    store = journal.book().store
    assert store is not None
    store.programs.rename_program("bushing.nc", "other.nc").result(60)
    assert journal.read_setting("notes:other.nc") == ["SOFT JAWS", "BAR .02 OUT MORE"]


def test_note_is_deleted_only_after_confirmation(hands: Hands) -> None:
    page, function = opened(hands)
    take_note(hands, "SOFT JAWS")
    hands.sees(lambda: "NOTE 1" in rows(page))
    hands.key(Key.Key_F3)
    assert function.notes == ["SOFT JAWS"]
    yes(hands.window)
    hands.sees(lambda: function.notes == [])
    hands.key(Key.Key_F3)
    assert hands.prompt() == wording("screen.mark-note")


def test_esc_leaves_note_unchanged(hands: Hands) -> None:
    _, function = opened(hands)
    take_note(hands, "SOFT JAWS")
    hands.key(Key.Key_Return)
    hands.type("X")
    hands.key(Key.Key_Escape)
    assert function.notes == ["SOFT JAWS"]
    assert function.note_field is None


def test_sheet_is_written_as_pdf_and_html(hands: Hands, tmp_path: Path) -> None:
    _, function = opened(hands)
    take_note(hands, "<SOFT> JAWS & MORE")
    stick = tmp_path / "stick"
    stick.mkdir()
    function.list_media = lambda: (UsbStick("BLUE", stick, 10**9),)
    before = function.paper_size
    hands.key(Key.Key_F5)
    assert function.paper_size is not before
    if before is PaperSize.A4:
        hands.key(Key.Key_F5)
    hands.key(Key.Key_F6)
    hands.sees(lambda: [place.label for place in function.save_locations] == ["BLUE", "THIS CONTROL"])
    hands.key(Key.Key_Return)
    hands.sees(lambda: shows(hands.prompt(), "screen.file-is-whole"))
    page = (stick / "bushing.nc-setup.html").read_text()
    pdf = Pdf(stick / "bushing.nc-setup.pdf")
    made = "".join(pdf.pages)
    digest = hashlib.sha256((get_samples_folder() / "bushing.nc").read_bytes()).hexdigest()
    for words in (
        wording("screen.setup-sheet", program="bushing.nc"),
        "GAUGE THE OUTSIDE AND CORRECT D1",
        digest,
        "BORING, VNMG160404",
    ):
        assert words in page
        assert words.replace(" ", "") in made
    assert "&lt;SOFT&gt; JAWS &amp; MORE" in page
    assert "<SOFT>JAWS&MORE" in made
    assert pdf.papers == {(210, 297)}
    assert sorted(each.name for each in stick.iterdir()) == ["bushing.nc-setup.html", "bushing.nc-setup.pdf"]


# --- what is refused


def test_sheet_is_not_available_without_program(hands: Hands) -> None:
    page, function = opened(hands, "")
    hands.sees(lambda: page.table_panel.table.title == SETUP)
    assert page.table_panel.table.rows == ()
    for key in (Key.Key_F2, Key.Key_F6):
        hands.key(key)
        assert begins(hands.prompt(), "screen.choose-program-for-sheet")
    assert function.note_field is None
    assert function.save_locations == ()


def test_setup_sheet_uses_selected_language(hands: Hands, tmp_path: Path) -> None:
    _, function = opened(hands)
    function.list_media = lambda: (UsbStick("BLUE", tmp_path, 10**9),)
    hands.desk.settings_store.choose("language", "es")
    hands.sees(lambda: get_language() == "es")
    hands.key(Key.Key_F6)
    hands.sees(lambda: bool(function.save_locations))
    hands.key(Key.Key_Return)
    hands.sees((tmp_path / "bushing.nc-setup.pdf").exists)
    hands.sees(lambda: not function.task_text)
    page = (tmp_path / "bushing.nc-setup.html").read_text(encoding="utf-8")
    assert '<html lang="es">' in page
    assert text_in_spanish("screen.setup-sheet", program="bushing.nc") in page


def test_number_of_notes_is_limited(hands: Hands) -> None:
    _, function = opened(hands)
    function._keep([f"NOTE {n}" for n in range(MOST_NOTES)])
    hands.key(Key.Key_F2)
    assert shows(hands.prompt(), "screen.too-many-notes")
    assert function.note_field is None


def test_unwritable_location_is_reported(hands: Hands, tmp_path: Path) -> None:
    _, function = opened(hands)
    (tmp_path / "file").write_text("no folder")
    function.list_media = lambda: (UsbStick("GONE", tmp_path / "file", 0),)
    hands.key(Key.Key_F6)
    hands.sees(lambda: bool(function.save_locations))
    hands.key(Key.Key_Return)
    hands.sees(lambda: shows(hands.prompt(), "screen.cannot-be-written"))
    assert function.task_text == ""


def test_full_disk_is_reported(hands: Hands, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _, function = opened(hands)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    function.folder = tmp_path / "sheets"
    hands.key(Key.Key_F6)
    hands.sees(lambda: bool(function.save_locations))
    hands.key(Key.Key_End)
    function.marked = len(function.save_locations) - 1
    hands.key(Key.Key_Return)
    hands.sees(lambda: "No space left on device" in hands.prompt())
    assert list((tmp_path / "sheets").iterdir()) == []
