"""Spanish on the screen: at once, everywhere, and never in what is not ours."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from PySide6.QtCore import QTranslator
from PySide6.QtGui import QFont, QPainter, QRawFont

import app
from app.compose.optional_features import FEATURE_NAMES, extras
from app.desk.status.modal_rows import NO_CODE, make_modal_rows
from app.desk.status.prompt_line import describe_cause
from app.desk.translation import tr
from app.screen import screen_theme
from app.screen.color_palettes import DARK_PALETTE
from app.screen.page_base import Page
from app.screen.screen_theme import TRANSLATION_CONTEXT, ScreenTheme, set_language
from app.screen.window.main_window import MainWindow
from app.special.machine_records import make_event_row
from core.alarms import CATALOG, AlarmCode, AlarmEntry
from core.executor.raised_alarm import format_log_line, make_alarm
from core.executor.snapshot import Alarm
from core.interpreter.shared.checkpoint import Checkpoint
from core.interpreter.shared.modal_state import ModalState
from core.store.store_rows import EventRow
from resources.translations.collect import (
    _NO_TEXT,
    CATALOG_FOLDER,
    FILE_ENDINGS_WITHOUT_SENTENCES,
    PLACEHOLDER_PATTERN,
    PROJECT_FOLDER,
    SCREEN_FOLDERS,
    _is_apart,
    _is_read,
    collect_console_texts,
    collect_screen_texts,
)
from resources.translations.collect import read_translations as written
from resources.translations.message_list import read_list
from resources.translations.text_extraction import find_composed_texts
from tests.screen.hands import Hands, Key
from tests.texts import message, text_in_spanish

KEY_LABEL = 8  # characters
OFF = message("screen.off-setpoint", axis="Z", distance=2.1)
_LOGGED = re.compile(r'\.log(?:_text|_event)\(\s*"(\w+)"')


every_text = cache(collect_screen_texts)  # of every file there is: seconds


@pytest.fixture
def spanish(hands: Hands) -> Hands:
    hands.desk.settings_store.choose("language", "es")
    hands.window.refresh()
    return hands


def drawn(hands: Hands, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Every line that a picture of the window is made of."""
    texts: list[str] = []
    real = QPainter.drawText

    def spy(painter: QPainter, *args: object) -> object:
        texts.extend(arg for arg in args if isinstance(arg, str))
        return real(painter, *args)  # type: ignore[call-overload]

    monkeypatch.setattr(QPainter, "drawText", spy)
    hands.window.refresh()
    hands.window.grab()
    monkeypatch.undo()
    return texts


def test_screen_switches_to_spanish_and_back(hands: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "MENU" in drawn(hands, monkeypatch)
    hands.desk.settings_store.choose("language", "es")
    texts = drawn(hands, monkeypatch)
    assert {"MENÚ", "LISTO", "HUSILLO", "RETENCIÓN", "DE AVANCE"} <= set(texts)
    hands.desk.settings_store.choose("language", "en")
    assert "MENU" in drawn(hands, monkeypatch)


def test_program_text_and_comments_are_not_translated(
    spanish: Hands, monkeypatch: pytest.MonkeyPatch
) -> None:
    spanish.machine.now = replace(spanish.machine.now, comment="READY", program="SPINDLE.nc")
    texts = drawn(spanish, monkeypatch)
    assert "READY" in texts
    assert "LISTO" in texts
    assert "SPINDLE.nc" in texts


def test_control_alarm_is_shown_in_spanish(spanish: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    remedy = CATALOG["following"].remedy
    spanish.machine.fault(
        Alarm(
            102,
            "following",
            "FOLLOWING ERROR",
            message("screen.off-setpoint", axis="Z", distance=2.1),
            remedy,
            line=4,
        )
    )
    texts = " / ".join(drawn(spanish, monkeypatch))
    assert text_in_spanish("screen.alarm", number=102, what="") in texts
    assert text_in_spanish("screen.following-error") in texts
    assert text_in_spanish("screen.off-setpoint", axis="Z", distance="2.1") in texts
    assert "libere el eje" in texts
    assert text_in_spanish("screen.line", line=4) in texts
    assert "  ·  LINE" not in texts


def logged(kind: str, text: str) -> str:
    """Return how the log shows an event."""
    return make_event_row(EventRow("2026-03-02T08:00:00.000Z", kind, text)).cells[2]


@pytest.mark.usefixtures("spanish")
def test_the_log_shows_alarms_in_spanish() -> None:
    assert logged("alarm", format_log_line(make_alarm("following", OFF, 4, 0.0))) == " ".join(
        (
            "102",
            text_in_spanish("screen.following-error") + ":",
            text_in_spanish("screen.off-setpoint", axis="Z", distance="2.1"),
        )
    )


@pytest.mark.usefixtures("spanish")
@pytest.mark.parametrize(("code", "number"), [("program-stop", 704), ("optional-stop", 705)])
def test_log_does_not_translate_text_of_program(code: AlarmCode, number: int) -> None:
    text = logged("stop", format_log_line(make_alarm(code, "FACE", 4, 0.0)))
    assert text.startswith(f"{number} PARO ")
    assert text.endswith(": FACE")


@pytest.mark.usefixtures("spanish")
def test_an_event_of_an_older_store_stays_english() -> None:
    assert logged("accepted", "machine file a.toml accepted by BEN") == "machine file a.toml accepted by BEN"


@pytest.mark.usefixtures("spanish")
def test_every_log_kind_is_translated() -> None:
    kinds = {
        kind
        for file in (PROJECT_FOLDER / "core/executor").rglob("*.py")
        for kind in _LOGGED.findall(file.read_text())
    }
    assert len(kinds) > 15
    assert {kind for kind in kinds if tr(kind) == kind} <= {"mdi", "override"}  # the same word in Spanish


@pytest.mark.parametrize("code", ["program-stop", "optional-stop"])
def test_stop_message_of_program_is_not_translated(spanish: Hands, code: AlarmCode) -> None:
    told = tr(describe_cause(make_alarm(code, "FACE", 4, 0.0)))
    assert told.startswith("FACE; M0")
    assert "the program" not in told
    assert tr(describe_cause(make_alarm(code, "", 4, 0.0))).endswith(("en el programa", "está activo"))


def test_active_program_comment_is_not_translated(spanish: Hands) -> None:
    point = Checkpoint(ModalState(comment=" FACE ", outputs=frozenset({"coolant"})))
    told = {row.key: tr(row.active_code) for row in make_modal_rows(point)}
    assert told["comment"] == "FACE"
    assert told["outputs"] == "COOLANT"
    assert told["units"] == "G70 PULGADAS"
    assert {row.key: row.active_code for row in make_modal_rows(Checkpoint(ModalState()))}[
        "comment"
    ] == NO_CODE


@pytest.mark.usefixtures("spanish")
@pytest.mark.parametrize("entry", CATALOG.values(), ids=str)
def test_every_alarm_has_spanish_translation(entry: AlarmEntry) -> None:
    texts = (entry.text.upper(), *entry.causes, entry.remedy)
    assert [text for text in texts if tr(text) == text] in ([], ["RESET"])


def test_rejection_with_values_is_shown_in_spanish(spanish: Hands) -> None:
    why = message("screen.spindle-limit-between", limit=9000, most=3500)
    spanish.desk.say(message("screen.refused", why=why))
    told = tr(spanish.desk.prompt_notice)
    in_spanish = text_in_spanish("screen.spindle-limit-between", limit=9000, most=3500)
    assert told == text_in_spanish("screen.refused", why=in_spanish)


def test_font_has_every_letter_of_translation() -> None:
    font = QFont(screen_theme.FONT_FAMILY)
    missing = {sign for text in written("es").values() for sign in text if not _has(font, sign)}
    assert missing <= {"\n"}


def _has(font: QFont, sign: str) -> bool:
    return QRawFont.fromFont(font).supportsCharacter(ord(sign))


def test_compiled_catalog_matches_source_texts() -> None:
    translator = QTranslator()
    assert translator.load(str(CATALOG_FOLDER / "turndesk_es.qm"))
    for text, told in written("es").items():
        assert (translator.translate(TRANSLATION_CONTEXT, text) or "") == told


def test_translations_contain_every_placeholder() -> None:
    holes = {text: told for text, told in written("es").items() if told and PLACEHOLDER_PATTERN.search(text)}
    lost = [
        text
        for text, told in holes.items()
        if sorted(PLACEHOLDER_PATTERN.findall(told)) != sorted(PLACEHOLDER_PATTERN.findall(text))
    ]
    assert lost == []


def test_second_window_has_its_own_language(spanish: Hands) -> None:
    spanish.desk.settings_store.choose("language", "en")
    other = MainWindow(ScreenTheme(DARK_PALETTE))
    assert spanish.window.page_preloader is not None
    earlier = spanish.window.page_preloader
    other.show_model(spanish.desk)
    assert earlier.is_done  # its thread has ended: one desk, one window that makes its pages
    assert tr("READY") == "READY"
    other.close_silently()


def test_unknown_language_has_no_catalog() -> None:
    with pytest.raises(FileNotFoundError, match="turndesk_xx"):
        set_language("xx")


def test_translated_key_labels_fit(spanish: Hands) -> None:
    house = Path(app.__file__).parent
    for path in (*house.glob("*/*_view.py"), *house.glob("screen/*/page.py")):
        import_module(".".join(("app", *path.relative_to(house).with_suffix("").parts)))
    labels = {label for page in _pages(Page) for label in getattr(page, "LABELS", ())}
    for key in (Key.Key_F10, Key.Key_F1, Key.Key_F6, Key.Key_F9):
        spanish.key(key)
        labels.update(spanish.frame.key_bar.key_labels)
    told = {label: tr(label) for label in labels}
    assert {label: text for label, text in told.items() if max(len(label), len(text)) > KEY_LABEL} == {}
    assert told["MENU"] == "MENÚ"


def _pages(page: type[Page]) -> Iterator[type[Page]]:
    for kind in page.__subclasses__():
        yield kind
        yield from _pages(kind)


def find_key_labels(tree: ast.AST) -> Iterator[str]:
    """Yield the labels of function keys that contain two letters side by side."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "FunctionKey":
            found = node.args[:1]
        elif isinstance(node, ast.Assign) and any(ast.unparse(target) == "LABELS" for target in node.targets):
            found = [node.value]
        else:
            continue
        texts = [each.value for value in found for each in ast.walk(value) if isinstance(each, ast.Constant)]
        yield from (text for text in texts if isinstance(text, str) and re.search(r"[A-Z]{2}", text))


def test_every_key_label_has_spanish_translation() -> None:
    """CSV and PIN are the same in Spanish."""
    files = Path(app.__file__).parent.rglob("*.py")
    labels = {label for path in files for label in find_key_labels(ast.parse(path.read_text("utf-8")))}
    assert len(labels) > 100
    assert sorted(labels - written("es").keys()) == ["CSV", "PIN"]


def test_every_text_has_spanish_translation() -> None:
    """Run ``python -m resources.translations.collect``, then write what it has put in as unfinished."""
    known = written("es")
    assert sorted(text for text in every_text() if not known.get(text)) == []


@pytest.mark.parametrize(
    "text",
    [
        "SELECT {a} FROM {b}",
        "DELETE FROM {a} WHERE {b} = ?",
        "FROM cycles",
        "QLabel {{ color: {a}; }}",
        "BEGIN PGM",
    ],
)
def test_queries_and_style_sheets_are_not_collected_as_texts(text: str) -> None:
    assert text not in every_text()
    assert _NO_TEXT.match(text)


def test_text_list_contains_every_text_once() -> None:
    shown = every_text()
    listed = read_list()
    known = {*shown, *collect_console_texts(shown)}
    if len(extras()) < len(FEATURE_NAMES):  # the list has the texts of all optional features
        known |= set(listed.values())
    assert sorted(listed.values()) == sorted(known)


def test_every_text_with_values_is_a_message() -> None:
    """A text that is put together otherwise cannot be translated."""
    found = [
        f"{path.relative_to(PROJECT_FOLDER)}:{line}: {text}"
        for room in SCREEN_FOLDERS
        for path in sorted((PROJECT_FOLDER / room).rglob("*.py"))
        if not _is_apart(path, room) and not path.name.endswith(FILE_ENDINGS_WITHOUT_SENTENCES)
        for line, text in find_composed_texts(ast.parse(path.read_text(encoding="utf-8")))
        if _is_read(text, False)
    ]
    assert found == []
