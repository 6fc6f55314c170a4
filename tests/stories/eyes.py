"""The real ``turndesk`` with somebody behind its eyes: ``python -m tests.stories.eyes ARGUMENTS``.

A thread tells every change of the machine as a line of JSON. What is asked on standard input is answered by
Qt's own thread, as it shows things: ``{"ask": "screen"}``; and what a hand cannot do from outside is done
there: ``{"ask": "freeze", "seconds": 2}``, or fingers that touch: ``{"ask": "touch", "fingers": …}``.
"""

from __future__ import annotations

import ctypes
import faulthandler
import json
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QEvent, QObject, QPoint, QRectF, Qt, QTimer, Signal, Slot
from PySide6.QtGui import QFontMetricsF, QKeyEvent, QPainter, QPaintEvent, QWindow
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu, QWidget

from app.cli.main import run_console
from app.desk.desk import Desk
from app.screen.panel import Panel, TouchPanel
from app.screen.text_area.text_area import TextArea
from app.screen.window.keyboard import KeyboardFilter
from app.screen.window.main_window import MainWindow
from drivers.simulators.plant_controls import PlantControls
from tests.stories import patient_clock

LOOK = 0.01  # s
BEAT = 30  # ms between two beats of Qt's thread
Told = dict[str, Any]
_telling = threading.Lock()


def tell(line: Told) -> None:
    """A line of JSON to whoever listens."""
    with _telling:
        sys.stdout.write(json.dumps(line) + "\n")
        sys.stdout.flush()


class Painted:
    """Which text stands where, by the widget on which it was drawn last."""

    def __init__(self) -> None:
        self.texts: dict[QWidget, list[tuple[str, QRectF]]] = {}
        self._draw, self._paint = QPainter.drawText, Panel.paintEvent

    def attend(self) -> None:
        """From now on every drawn text is noted."""
        draw, paint, texts = self._draw, self._paint, self.texts

        def drawing(painter: QPainter, *what: Any) -> Any:
            device = painter.device()
            if isinstance(device, QWidget):
                texts.setdefault(device, []).append((str(what[-1]), _box(painter, what)))
            return draw(painter, *what)

        def painting(panel: Panel, event: QPaintEvent) -> None:
            texts[panel] = []
            paint(panel, event)

        setattr(QPainter, "drawText", drawing)  # noqa: B010 - Qt's own method, for this process alone
        setattr(Panel, "paintEvent", painting)  # noqa: B010


def _box(painter: QPainter, what: tuple[Any, ...]) -> QRectF:
    first, text = what[0], str(what[-1])
    if isinstance(first, int | float):
        metrics = QFontMetricsF(painter.font())
        wide = metrics.horizontalAdvance(text)
        box = QRectF(float(first), float(what[1]) - metrics.capHeight(), wide, metrics.capHeight())
    else:
        box = QRectF(first)
    return painter.worldTransform().mapRect(box)


class Eyes(QObject):
    """Looks, and tells."""

    asked = Signal(dict)

    def __init__(self, painted: Painted) -> None:
        super().__init__()
        self._painted = painted
        self._touch = QTest.createTouchDevice()
        self.asked.connect(self.answer, Qt.ConnectionType.QueuedConnection)

    # --- threads of their own --------------------------------------------------------------------------

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Counts clicks as they come to the window."""
        if event.type() is QEvent.Type.MouseButtonRelease and isinstance(watched, QWindow):
            _CLICKED[0] += 1
        return False

    def watch(self) -> None:
        """Tell what the machine does, also while the screen is frozen."""
        before: Told = {}
        while True:
            desk = _desk()
            now = _machine(desk) if desk is not None else {}
            _note_prompt()
            if now.get("line") == _SLOW_AT[0]:
                _SLOW_AT[0] = None
                patient_clock.CLOCK.run_at(1.0)
            if now and now != before:
                before = now
                tell({"machine": now, "at": time.monotonic()})
            time.sleep(LOOK)

    def listen(self) -> None:
        """Hand on what is asked."""
        for line in sys.stdin:
            asked = json.loads(line)
            if asked["ask"] == "time":  # also while Qt's thread is frozen
                tell({"answer": asked["number"], "is": patient_clock.CLOCK.now()})
            else:
                self.asked.emit(asked)

    # --- in Qt's thread --------------------------------------------------------------------------------

    @Slot(dict)
    def answer(self, asked: Told) -> None:
        """What is asked for, done or seen."""
        doing: dict[str, Callable[[Told], object]] = {
            "glance": lambda _asked: self._glance(),
            "screen": lambda _asked: self._screen(),
            "freeze": lambda told: time.sleep(told["seconds"]),
            "touch": self._finger,
            "menu": lambda _asked: self._menu(),
            "break": _break,
            "spoil": _spoil,
            "kill": _kill,
            "real time": lambda _asked: patient_clock.run_in_real_time(),
            "hurry": _hurry,
            "prompts": lambda _asked: _PROMPTS,
        }
        tell({"answer": asked["number"], "is": doing[asked["ask"]](asked)})

    def _glance(self) -> Told:
        """What is asked fifty times a second: all but the texts and their places."""
        window = _window()
        if window is None or window.frame is None:
            return {}
        frame, focus = window.frame, QApplication.focusWidget()
        return {
            "page": frame.current_page.NAME,
            "state": frame.title_line.state_text,
            "prompt": frame.prompt_line.main_text,
            "forgotten": _FORGOTTEN[0],
            "keys": _RELEASED[0],
            "clicks": _CLICKED[0],
            "theme": window.theme.palette.name,
            "active": window.isActiveWindow(),
            "minimised": window.isMinimized(),
            "field": _field(focus),
        }

    def _screen(self) -> Told:
        seen, window = self._glance(), _window()
        if not seen or window is None:
            return {}
        texts = [each for widget in window.findChildren(QWidget) for each in self._texts(widget)]
        targets = [each for panel in window.findChildren(Panel) for each in _targets(panel)]
        return seen | {"texts": texts, "targets": targets}

    def _texts(self, widget: QWidget) -> list[tuple[str, float, float, str]]:
        """Text, the middle of its place on the screen, and on what kind of widget."""
        if not widget.isVisible():
            return []
        corner, kind = widget.mapToGlobal(QPoint(0, 0)), type(widget).__name__
        texts = [(text, box.center()) for text, box in self._painted.texts.get(widget, [])]
        if _field(widget):
            texts.append((_field(widget), QRectF(widget.rect()).center()))
        return [(text, corner.x() + at.x(), corner.y() + at.y(), kind) for text, at in texts]

    def _menu(self) -> None:
        """A menu pops up over the window, as no field of ours has one."""
        window = _window()
        assert window is not None
        menu = QMenu(window)
        menu.addAction("COPY")
        menu.popup(window.mapToGlobal(window.rect().center()))

    def _finger(self, told: Told) -> None:
        """XTEST has no touch: the fingers are put into Qt where its platform would put them."""
        window = _window()
        assert window is not None
        event = QTest.touchEvent(window, self._touch, False)
        for finger, do, x, y in told["fingers"]:
            at = window.mapFromGlobal(QPoint(round(x), round(y)))
            if do == "stationary":
                event.stationary(finger)
            else:
                getattr(event, do)(finger, at, window)
        event.commit()


def _targets(panel: Panel) -> list[tuple[float, float, float, float]]:
    """Where a panel may be pressed: corner and size on the screen."""
    if not panel.isVisible():
        return []
    corner = panel.mapToGlobal(QPoint(0, 0))
    boxes = [box for box, *_ in panel._places]
    boxes += [each.box for each in panel.controls] if isinstance(panel, TouchPanel) else []
    return [(corner.x() + box.x(), corner.y() + box.y(), box.width(), box.height()) for box in boxes]


def _hurry(told: Told) -> None:
    """Speed machine time up until the control reaches a line of the program."""
    _SLOW_AT[0] = told["until_line"]
    patient_clock.CLOCK.run_at(told["rate"])


def _note_prompt() -> None:
    window = _WINDOW[0] if _WINDOW else None
    prompt = window.frame.prompt_line.main_text if window is not None and window.frame is not None else ""
    if prompt and (not _PROMPTS or _PROMPTS[-1] != prompt):
        _PROMPTS.append(prompt)


def _break(told: Told) -> list[float]:
    """Break a part of the simulated lathe, by the name of its method; return where the slides are then."""
    desk = _desk()
    assert desk is not None
    assert isinstance(desk.desk_control.station_panel, PlantControls)
    getattr(desk.desk_control.station_panel, told["name"])(*told["values"])
    slides: list[float] = _machine(desk)["slides"]
    return slides


def _executor() -> Any:
    """What ticks, by its thread."""
    thread = next(each for each in threading.enumerate() if each.name == "executor")
    return thread, getattr(thread, "_target").__self__.executor  # noqa: B009 - for this process alone


def _spoil(told: Told) -> None:
    """A driver raises what nobody has thought of, whenever this is asked of one of its ports."""

    def odd(*_what: object) -> None:
        raise RuntimeError("nobody has thought of this")

    _thread, executor = _executor()
    setattr(getattr(executor._ports, told["port"]), told["call"], odd)


def _kill(_told: Told) -> None:
    """The executor's thread ends, wherever it is."""
    patient_clock.run_in_real_time()
    thread, _ = _executor()
    ctypes.pythonapi.PyThreadState_SetAsyncExc(
        ctypes.c_ulong(thread.ident), ctypes.py_object(KeyboardInterrupt)
    )


def _field(widget: QWidget | None) -> str:
    if isinstance(widget, QLineEdit):
        return widget.text()
    return widget.toPlainText() if isinstance(widget, TextArea) else ""


def _window() -> MainWindow | None:
    found = [each for each in QApplication.topLevelWidgets() if isinstance(each, MainWindow)]
    return found[0] if found else None


def _desk() -> Desk | None:
    window = _WINDOW[0] if _WINDOW else None
    return window.frame.desk if window is not None and window.frame is not None else None


_WINDOW: list[MainWindow] = []
_PROMPTS: list[str] = []  # what the prompt line has shown, in its order
_SLOW_AT: list[int | None] = [None]  # line of the program at which machine time slows down again
_RELEASED = [0]  # keys that have come up
_CLICKED = [0]  # buttons of the mouse that have come up
_FORGOTTEN = [0]  # presses that the screen has said to have dropped


def _machine(desk: Desk) -> Told:
    """The machine of now: as the control has it, and where the simulated slides really stand (mm)."""
    shot = desk.read_snapshot()
    hands = (
        desk.desk_control.station_panel
        if isinstance(desk.desk_control.station_panel, PlantControls)
        else None
    )
    true = hands.get_true_positions() if hands is not None else shot.actual
    outputs = hands.outputs() if hands is not None else dict.fromkeys(shot.outputs, True)
    return {
        "turning": round(hands.get_spindle_rpm() if hands is not None else shot.rpm_actual),
        "lit": sorted(name for name, on in outputs.items() if on),
        "state": shot.state.value,
        "line": shot.line,
        "parts": shot.parts,
        "actual": [round(each, 4) for each in shot.actual],
        "slides": [round(each, 4) for each in true],
        "rpm": round(shot.rpm_actual),
        "outputs": sorted(shot.outputs),
        "feed_override": round(shot.feed_override, 3),
        "single_block": shot.single_block,
        "spindle_auto": shot.spindle_auto,
        "switches": [shot.optional_stop, shot.block_delete, shot.cycle_repeat, shot.no_count],
        "alarms": [[alarm.number, alarm.text] for alarm in shot.alarms],
        "refused": shot.start_refusal_reason,
        "start_code": getattr(shot, "start_code", ""),
        "homed": list(shot.homed),
    }


def main() -> int:
    faulthandler.enable()  # a process that dies of a signal says where
    if "STORY_IN_REAL_TIME" not in os.environ:
        patient_clock.install()
    app = QApplication(["turndesk"])
    beats = QTimer()
    beats.timeout.connect(patient_clock.CLOCK.beat_of_screen)
    beats.start(BEAT)
    painted = Painted()
    painted.attend()
    eyes = Eyes(painted)
    app.installEventFilter(eyes)
    made = MainWindow.__init__

    def making(window: MainWindow, *what: Any) -> None:
        made(window, *what)
        _WINDOW.append(window)

    dropped, releasing = MainWindow._show_dropped, KeyboardFilter._released

    def released(keyboard: KeyboardFilter, event: QKeyEvent, code: int) -> bool:
        _RELEASED[0] += 1
        return releasing(keyboard, event, code)

    setattr(KeyboardFilter, "_released", released)  # noqa: B010

    def dropping(window: MainWindow, names: tuple[str, ...]) -> None:
        _FORGOTTEN[0] += 1
        dropped(window, names)

    setattr(MainWindow, "__init__", making)  # noqa: B010
    setattr(MainWindow, "_show_dropped", dropping)  # noqa: B010
    for each in (eyes.watch, eyes.listen):
        threading.Thread(target=each, daemon=True).start()
    status = run_console()
    del beats, app
    return status


if __name__ == "__main__":
    sys.exit(main())
