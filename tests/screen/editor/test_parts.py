"""The parts of the page: colours by the lexer's words, places without overlap, the real store."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import pytest
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import NO_OFFSETS
from app.desk.status.formats import format_local_time
from app.editor.editor_model import EditorModel, EditorStage, open_editor
from app.editor.editor_parts_view import FindingList, make_editor_layout
from app.editor.live_proof import ProofFindings
from app.editor.text_view import ProgramTextField
from app.screen.color_palettes import DARK_PALETTE, LIGHT_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window_layout import FINGERTIP_PX
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect
from drivers.wakeups import ManualClock
from tests.editor.shop import GOOD

KEYS = 2  # places before those of the rows, where not all of them fit: the keys that leaf


@pytest.fixture
def field(qtbot: QtBot) -> Iterator[ProgramTextField]:
    window = QWidget()
    qtbot.addWidget(window)
    yield ProgramTextField(ScreenTheme(DARK_PALETTE), window)
    window.close()


def inks(field: ProgramTextField, line: int) -> list[tuple[str, str]]:
    """What is written in which colour."""
    text = field.buffer.read_line(line - 1)
    return [
        (text[start : start + length], QColor(ink.foreground().color()).name())
        for start, length, ink in field.find_line_colors(line - 1, text)
    ]


def test_words_are_colored_as_lexer_reads_them(field: ProgramTextField) -> None:
    field.replace_text("g0 1X.5F.1(G05)T1", as_new=True)
    field.apply_theme()
    assert inks(field, 1) == [
        ("g0 1", DARK_PALETTE.accent),
        ("X.5", DARK_PALETTE.text),
        ("F.1", DARK_PALETTE.run),
        ("(G05)", DARK_PALETTE.soft),
        ("T1", DARK_PALETTE.pause),
    ]


def test_plane_statements_are_not_colored_as_comments(field: ProgramTextField) -> None:
    field.replace_text("M19\n(~PLXC)\n(G02X.5 Y.2I.1J0F8)\n(X?)\n(END)\n(DONE)\nX1", as_new=True)
    field.apply_theme()
    assert inks(field, 2) == [("(~PLXC)", DARK_PALETTE.accent)]
    assert inks(field, 3)[1:4] == [
        ("X.5", DARK_PALETTE.text),
        ("Y.2I.1J0", DARK_PALETTE.text),
        ("F8", DARK_PALETTE.run),
    ]
    assert ("?", DARK_PALETTE.alarm) in inks(field, 4) or ("X", DARK_PALETTE.alarm) in inks(field, 4)
    assert inks(field, 5) == [("(END)", DARK_PALETTE.accent)]
    assert inks(field, 6) == [("(DONE)", DARK_PALETTE.soft)]


def test_lines_of_removed_plane_are_colored_as_comments(field: ProgramTextField) -> None:
    field.replace_text("(~PLXC)\n(X.5)", as_new=True)
    field.apply_theme()
    assert inks(field, 2) == [("X.5", DARK_PALETTE.text)]
    field.replace_text_ranges((1,), 1, "")  # the mark of the entry
    assert inks(field, 2) == [("(X.5)", DARK_PALETTE.soft)]


def test_unreadable_word_is_marked_until_it_is_fixed(field: ProgramTextField) -> None:
    field.replace_text("X1?", as_new=True)
    field.apply_theme()
    assert ("?", DARK_PALETTE.alarm) in inks(field, 1)
    field.replace_text("X1", as_new=True)
    assert DARK_PALETTE.alarm not in {ink for _text, ink in inks(field, 1)}


def test_new_theme_colors_are_applied_to_text(field: ProgramTextField) -> None:
    field.replace_text("G01", as_new=True)
    field.apply_theme()
    field.theme.set_palette(LIGHT_PALETTE)
    field.apply_theme()
    assert inks(field, 1) == [("G01", LIGHT_PALETTE.accent)]


@pytest.mark.parametrize("asking", [True, False])
@pytest.mark.parametrize(("width", "height", "u"), [(860, 390, 6.4), (1600, 700, 12.0), (3200, 1400, 24.0)])
def test_editor_layout_parts_do_not_overlap(width: int, height: int, u: float, asking: bool) -> None:
    at = make_editor_layout(width, height, u, has_question=asking)
    parts = [
        at.head_line,
        at.text,
        at.path_area,
        at.finding_list,
        at.code_strip,
        *([at.question_line] if asking else []),
    ]
    for one, other in combinations(parts, 2):
        apart = one.right <= other.x or other.right <= one.x or one.bottom <= other.y or other.bottom <= one.y
        assert apart, (one, other)
    assert all(p.x >= 0 and p.y >= 0 and p.right <= width and p.bottom <= height for p in parts)
    assert all(p.w > 20 * u and p.h > 3 * u for p in parts)


def test_program_versions_are_saved_in_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    journal = Journal.open_default()
    desk, executor = create_desk_and_executor(None, lambda: NO_OFFSETS, ManualClock(), journal)
    executor.run_tick()
    editor = desk.page_registry.find_model(EditorModel)
    assert editor is not None
    editor.pending_name = "new"
    assert open_editor(desk, editor)
    editor.create_document()
    for text in (GOOD, GOOD, GOOD + "(2)\n"):
        editor.save_document(text)
        editor.worker.wait_for_results(60.0)
    editor.save_and_leave(GOOD + "(2)\n", should_load=True)
    assert editor.stage is EditorStage.CLOSED
    assert desk.program_loader.wait_until_loaded(20).name == "new.nc"
    rows = journal.versions("new.nc")
    assert [row.number for row in rows] == [2, 1]
    assert journal.read_version_text("new.nc", 1) == GOOD.encode()
    assert (tmp_path / "programs" / "new.nc").read_text() == GOOD + "(2)\n"
    desk.close()
    journal.close()


def test_times_are_shown_in_local_time() -> None:
    assert format_local_time("2026-03-01T10:00:00.000Z").endswith(":00:00")


def test_sinumerik_words_are_colored_by_sinumerik_rules(field: ProgramTextField) -> None:
    field.set_dialect(Dialect.SINUMERIK)
    field.replace_text("N10 G1 X=IC(5) F100 ; (in)\nNUT P2\nG0 T1\nG0 H1", as_new=True)
    field.apply_theme()
    assert inks(field, 1) == [
        ("N10", DARK_PALETTE.soft),
        ("G1", DARK_PALETTE.accent),
        ("X=IC(5)", DARK_PALETTE.text),
        ("F100", DARK_PALETTE.run),
        ("; (in)", DARK_PALETTE.soft),
    ]
    assert inks(field, 2)[0] == ("NUT", DARK_PALETTE.pause)
    assert inks(field, 3)[-1] == ("T1", DARK_PALETTE.pause)
    assert ("H", DARK_PALETTE.alarm) in inks(field, 4)


def test_change_of_language_recolors_text(field: ProgramTextField) -> None:
    field.replace_text("G0X1(a)", as_new=True)
    before = inks(field, 1)
    field.set_dialect(Dialect.SINUMERIK)
    assert inks(field, 1) != before
    field.set_dialect(Dialect.OMNITURN)
    assert inks(field, 1) == before


def test_findings_are_touch_sized_on_smallest_screen(qtbot: QtBot) -> None:
    above = QWidget()
    qtbot.addWidget(above)
    panel = FindingList(ScreenTheme(DARK_PALETTE, 6.4), lambda _found: None, above)
    panel.resize(374, 106)  # as at 1024x600
    found = [Diagnostic(line, 1, Severity.ERROR, "unknown", "not known") for line in range(1, 5)]
    panel.show_findings(ProofFindings(diagnostics=tuple(found)), 4)
    panel.grab()
    assert len(panel._places) == KEYS + 2
    for box, *_ in panel._places:
        assert box.height() >= FINGERTIP_PX
        assert panel.find_full_area().contains(box)
