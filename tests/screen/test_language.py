"""Spanish on the screen: at once, everywhere, and never in what is not ours."""

from __future__ import annotations

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
from app.desk.modal_rows import NONE, rows_of
from app.desk.prompt_line import exactly
from app.desk.translation import tr
from app.screen import look
from app.screen.language import CONTEXT, catalogue, speak_in
from app.screen.look import Look
from app.screen.main_window import MainWindow
from app.screen.page_base import Page
from app.screen.theme import DARK
from app.shapes.shape_form import ShapeForm
from app.special.logged_events import event_row
from core.alarms import CATALOGUE, Code, Entry
from core.executor.raised_alarm import make_alarm
from core.executor.snapshot import Alarm
from core.interpreter.checkpoint import Checkpoint
from core.interpreter.modal_state import Modal
from core.shapes.shape_setting import Setting
from core.shapes.shape_table import SHAPES
from core.store.store_rows import EventRow
from resources.translations.collect import _NO_TEXT, HERE, HOLE, HOUSE, texts
from resources.translations.collect import catalogue as written
from tests.screen.hands import Hands, Key
from tests.texts import text as wording
from tests.texts import text_in_spanish

KEY_LABEL = 8  # characters
_LOGGED = re.compile(r'\.log\(\s*"(\w+)"')


every_text = cache(texts)  # of every file there is: seconds


@pytest.fixture
def spanish(hands: Hands) -> Hands:
    hands.desk.settings.choose("language", "es")
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


def test_the_screen_turns_spanish_at_once_and_back(hands: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "MENU" in drawn(hands, monkeypatch)
    hands.desk.settings.choose("language", "es")
    texts = drawn(hands, monkeypatch)
    assert {"MENÚ", "LISTO", "HUSILLO", "RETENCIÓN", "DE AVANCE"} <= set(texts)
    hands.desk.settings.choose("language", "en")
    assert "MENU" in drawn(hands, monkeypatch)


def test_program_text_and_comments_are_left_alone(spanish: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    spanish.machine.now = replace(spanish.machine.now, comment="READY", program="SPINDLE.nc")
    texts = drawn(spanish, monkeypatch)
    assert "READY" in texts
    assert "LISTO" in texts
    assert "SPINDLE.nc" in texts


def test_an_alarm_of_the_control_is_told_in_spanish(spanish: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    remedy = CATALOGUE["following"].remedy
    spanish.machine.fault(
        Alarm(102, "following", "FOLLOWING ERROR", "Z is 2.1 off its setpoint", remedy, line=4)
    )
    texts = " / ".join(drawn(spanish, monkeypatch))
    assert text_in_spanish("screen.alarm", number=102, what="") in texts
    assert text_in_spanish("screen.following-error") in texts
    assert text_in_spanish("screen.off-setpoint", axis="Z", distance="2.1") in texts
    assert "libere el eje" in texts
    assert text_in_spanish("screen.line", line=4) in texts
    assert "  ·  LINE" not in texts


@pytest.mark.parametrize(
    ("kind", "english", "told"),
    [
        ("estop", "701 E-STOP: an E-stop button was pressed", "701 PARO DE EMERGENCIA: se pulsó un botón"),
        ("alarm", "102 FOLLOWING ERROR: Z is 2.1 off its setpoint", "102 ERROR DE SEGUIMIENTO: Z está a 2.1"),
        ("alarm", "while stopping x: no answer", "al parar x: sin respuesta"),
        (
            "stop",
            "702 FEED HOLD: requested by the button at the operator station",
            "702 RETENCIÓN DE AVANCE: pedido por el botón de la estación",
        ),
        ("stop", "704 PROGRAM STOP: FACE", "704 PARO DE PROGRAMA: FACE"),
        ("stop", "705 OPTIONAL STOP: FACE", "705 PARO OPCIONAL: FACE"),
        (
            "accepted",
            "machine file a.toml accepted by BEN",
            "archivo de máquina a.toml aceptado por BEN",
        ),
    ],
)
def test_the_log_is_told_in_spanish(spanish: Hands, kind: str, english: str, told: str) -> None:
    row = event_row(EventRow("2026-03-02T08:00:00.000Z", kind, english))
    assert told in row.cells[2]


def test_every_kind_of_the_log_has_its_word() -> None:
    known = catalogue("es").translate
    kinds = {
        kind for file in (HOUSE / "core/executor").glob("*.py") for kind in _LOGGED.findall(file.read_text())
    }
    assert len(kinds) > 15
    assert {kind for kind in kinds if known(kind) == kind} <= {"mdi", "override"}  # the same word in Spanish


@pytest.mark.parametrize("code", ["program-stop", "optional-stop"])
def test_the_message_of_a_stop_is_the_programs(spanish: Hands, code: Code) -> None:
    told = tr(exactly(make_alarm(code, "FACE", 4, 0.0)))
    assert told.startswith("FACE; M0")
    assert "the program" not in told
    assert tr(exactly(make_alarm(code, "", 4, 0.0))).endswith(("en el programa", "está activo"))


def test_the_comment_in_force_is_the_programs(spanish: Hands) -> None:
    point = Checkpoint(Modal(comment=" FACE ", outputs=frozenset({"coolant"})))
    told = {row.key: tr(row.value) for row in rows_of(point)}
    assert told["comment"] == "FACE"
    assert told["outputs"] == "COOLANT"
    assert told["units"] == "G70 PULGADAS"
    assert {row.key: row.value for row in rows_of(Checkpoint(Modal()))}["comment"] == NONE


@pytest.mark.parametrize("entry", CATALOGUE.values(), ids=str)
def test_every_alarm_is_told_whole_wherever_it_stands(entry: Entry) -> None:
    text, known = entry.text.upper(), catalogue("es").translate
    spoken = known(text)
    assert spoken != text or text == "RESET"
    line = f"{entry.number}: {text}  ·  LINE 4"
    assert known(f"ALARM {line}  ·  AND 2 MORE") == f"ALARMA {entry.number}: {spoken}  ·  LÍNEA 4  ·  Y 2 MÁS"
    assert known(f"STOP {line}") == f"PARO {entry.number}: {spoken}  ·  LÍNEA 4"


@pytest.mark.parametrize(
    ("english", "told"),
    [
        ("SPINDLE STARTS AT 1500 RPM REVERSE", "EL HUSILLO ARRANCA A 1500 RPM EN REVERSA"),
        ("MIST TURNS ON", "SE ENCIENDE MIST"),
        ("MIST TURNED OFF AND X2 TURNED OFF", "SE APAGÓ MIST Y SE APAGÓ X2"),
        (
            "With input 7 on at line 5: G99 is not a code of this control. Write T.",
            "Con la entrada 7 encendida en la línea 5: G99 no es un código de este control. Escriba T.",
        ),
        (
            "LINE 6: Q is not a word of this control. See the list of codes: Shift+F1 in the editor.",
            "LÍNEA 6: Q no es una palabra de este control. Vea la lista de códigos: Shift+F1 en el editor.",
        ),
        (
            "LINE 50: A tool feeds only in air between two rapids.",
            "LÍNEA 50: Una herramienta avanza sólo en el aire entre dos rápidos.",
        ),
        ("FROM HOME", "DESDE REFERENCIA"),
        ("FROM LINE 1", "LÍNEA 1"),
        (
            "UNSAVED TEXT FROM LAST TIME IS IN A.NC: no room",
            "EL TEXTO SIN GUARDAR DE LA ÚLTIMA VEZ ESTÁ EN A.NC: no room",
        ),
        (
            "PRESS ONE PALM BUTTON, THEN THE OTHER (F11, F12) TO CONTINUE",
            "PULSE UN PULSADOR Y LUEGO EL OTRO (F11, F12) PARA CONTINUAR",
        ),
        ("\u2068BEN\u2069 HAS SIGNED IN: SETUP", "\u2068BEN\u2069 HA ENTRADO: PREPARADOR"),
        (
            "REJECTED: D33 does not exist; offsets are D1…32",
            "RECHAZADO: D33 no existe; los correctores son D1…32",
        ),
        (
            "NOT COUNTED AS A PART: NO COUNT is on; 4.62 s",
            "NO CONTADO COMO PIEZA: SIN CONT está puesto; 4.62 s",
        ),
        (
            "LS starts a loop, which needs further lines and LF.",
            "LS empieza un bucle, que necesita más líneas y LF.",
        ),
        (
            "CANNOT START: the program has errors: a.nc:5:1: error: G99 is not a code of this control."
            " Write T. [g-unknown] — Remove it from the program.",
            "NO PUEDE ARRANCAR: el programa tiene errores: a.nc:5:1: error: G99 no es un código de este"
            " control. Escriba T. [g-unknown] — Quítelo del programa.",
        ),
        ("REJECTED: a b.nc CANNOT BE WRITTEN: x", "RECHAZADO: NO SE PUEDE ESCRIBIR a b.nc: x"),
        ("the bar and the tools are new", "the bar and the tools are new"),  # never half of a sentence
        (
            "Alarm 61003: channel 1 block in line 5: CYCLE95: FF1 is missing, and no F is active.",
            "Alarma 61003: canal 1 bloque en la línea 5: CYCLE95: FF1 falta, y no hay ninguna F activa.",
        ),
        (
            "channel 1 block N30: CYCLE982: this lathe has no probe for measuring cycles.",
            "canal 1 bloque N30: CYCLE982: este torno no tiene palpador para ciclos de medición.",
        ),
        (
            "Syntax error: CR needs R; the line ends here.",
            "Error de sintaxis: CR necesita R; la línea termina aquí.",
        ),
    ],
)
def test_what_is_put_together_is_told_whole(english: str, told: str) -> None:
    assert catalogue("es").translate(english) == told


def test_a_refusal_with_values_is_told_in_spanish(spanish: Hands) -> None:
    why = wording("screen.spindle-limit-between", limit=9000, most=3500)
    spanish.desk.say(wording("screen.refused", why=why))
    told = catalogue("es").translate(spanish.desk.notice)
    in_spanish = text_in_spanish("screen.spindle-limit-between", limit=9000, most=3500)
    assert told == text_in_spanish("screen.refused", why=in_spanish)


@pytest.mark.parametrize(
    ("key", "told"),
    [
        ("R", "TAMAÑO falta: introdúzcalo, o elija uno con las flechas."),
        ("G", "DIÁMETRO falta: introdúzcalo."),
        ("F", "DIÁMETRO INICIAL falta: introdúzcalo."),
    ],
)
def test_a_refusal_of_a_shape_calls_its_field_as_the_form_does(spanish: Hands, key: str, told: str) -> None:
    form = ShapeForm(SHAPES[key], Setting())
    assert tr(form.trouble) == told
    assert catalogue("es").translate(SHAPES[key].name) not in {"", SHAPES[key].name}


def test_no_letter_is_missing_in_the_font() -> None:
    font = QFont(look.FAMILY)
    missing = {sign for text in written("es").values() for sign in text if not _has(font, sign)}
    assert missing <= {"\n"}


def _has(font: QFont, sign: str) -> bool:
    return QRawFont.fromFont(font).supportsCharacter(ord(sign))


def test_the_compiled_catalogue_is_that_of_the_texts() -> None:
    translator = QTranslator()
    assert translator.load(str(HERE / "turndesk_es.qm"))
    for text, told in written("es").items():
        assert (translator.translate(CONTEXT, text) or "") == told


def test_no_value_is_lost() -> None:
    holes = {text: told for text, told in written("es").items() if told and HOLE.search(text)}
    lost = [text for text, told in holes.items() if sorted(HOLE.findall(told)) != sorted(HOLE.findall(text))]
    assert lost == []


def test_another_window_speaks_its_own_language(spanish: Hands) -> None:
    spanish.desk.settings.choose("language", "en")
    other = MainWindow(Look(DARK))
    assert spanish.window.ahead is not None
    earlier = spanish.window.ahead
    other.open_desk(spanish.desk)
    assert earlier.done  # its thread has ended: one desk, one window that makes its pages
    assert tr("READY") == "READY"
    other.put_away()


def test_an_unknown_language_has_no_catalogue() -> None:
    with pytest.raises(FileNotFoundError, match="turndesk_xx"):
        speak_in("xx")


def test_key_labels_fit(spanish: Hands) -> None:
    house = Path(app.__file__).parent
    for path in (*house.glob("*/*_view.py"), *house.glob("screen/*/page.py")):
        import_module(".".join(("app", *path.relative_to(house).with_suffix("").parts)))
    labels = {label for page in _pages(Page) for label in getattr(page, "LABELS", ())}
    for key in (Key.Key_F10, Key.Key_F1, Key.Key_F6, Key.Key_F9):
        spanish.key(key)
        labels.update(spanish.frame.keys.labels)
    told = {label: catalogue("es").translate(label) for label in labels}
    assert {label: text for label, text in told.items() if max(len(label), len(text)) > KEY_LABEL} == {}
    assert told["MENU"] == "MENÚ"


def _pages(page: type[Page]) -> Iterator[type[Page]]:
    for kind in page.__subclasses__():
        yield kind
        yield from _pages(kind)


def test_every_text_has_its_spanish() -> None:
    """Run ``python -m resources.translations.collect``, then write what it has put in as unfinished."""
    known = written("es")
    assert sorted(text for text in every_text() if not known.get(text)) == []


@pytest.mark.parametrize(
    "text",
    ["SELECT %1 FROM %2", "DELETE FROM %1 WHERE %2 = ?", "FROM cycles", "QLabel { color: %1; }", "BEGIN PGM"],
)
def test_queries_and_style_sheets_are_no_texts(text: str) -> None:
    assert text not in every_text()
    assert _NO_TEXT.match(text)


def test_the_templates_are_those_of_the_texts() -> None:
    listed = set((HERE / "templates.txt").read_text(encoding="utf-8").splitlines())
    assert listed == {text for text in every_text() if HOLE.search(text)}
