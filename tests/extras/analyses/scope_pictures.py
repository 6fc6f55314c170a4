"""Pictures of worn machines in the scope: ``python -m tests.extras.analyses.scope_pictures OUT``.

A loose gib, a slipping belt and a bad encoder are put into the simulated lathe; what is pictured is what the
pages make of it.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from PySide6.QtWidgets import QApplication

from app.compose.runs.journal import Journal
from app.extras.analyses.analyses import AnalysesModel
from app.scope.scope_model import ScopeModel
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts, style_application
from app.screen.window.main_window import MainWindow
from core.executor.scope_recorder import ScopeRecorder
from core.executor.snapshot import MachineState
from tests.screen.pictures import Stage, _grab, _settle, press

CIRCLE = "G90G94F12G72\nT1(TURNING TOOL)\nX1.4Z.5\nG02X1.4Z.5I0K.3\nX1.5\nM30\n"
FEED = "G90G94F37G72\nT1(TURNING TOOL)\nX1.4Z1.\nZ.5\nX1.5\nM30\n"
THREAD = (
    "G90G94F300G72\nT1(TURNING TOOL)\nM03S600\nX.24Z.2\nG04F1\n"
    "G33X.21Z-.5I.01K.05C\nG94F100X.5Z.2\nM05\nM30\n"
)

_PATIENCE = 100  # tenths of a second for the worker
Wear = Callable[[Any], None]  # of the plant's hands
# Name, program, what is worn, curves of the scope (none: those that are there), keys from the Automatic page.
PICTURES: tuple[tuple[str, str, Wear, tuple[str, ...], str], ...] = (
    ("scope-gib", CIRCLE, lambda hands: hands.loose_gib("X", 0.006), (), "Scope F8 F4 Zoom_in"),
    (
        "scope-belt",
        THREAD,
        lambda hands: hands.belt_slip(0.04),
        ("Z velocity", "spindle command", "spindle speed"),
        "Scope F2 F6 Zoom_in Zoom_in Zoom_in",
    ),
    (
        "scope-encoder",
        FEED,
        lambda hands: hands.encoder_ripple("Z", 0.03),
        ("Z following error", "Z velocity", "Z acceleration"),
        "Scope F2 F6",
    ),
    ("scope-thread", THREAD, lambda hands: hands.belt_slip(0.04), (), "Scope F8 F3"),
)


def main(argv: list[str] | None = None) -> int:
    """Write the pictures; the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.extras.analyses.scope_pictures", description=__doc__
    )
    parser.add_argument("out", metavar="OUT", type=Path, help="folder for the PNG files")
    parser.add_argument("--language", default="en", choices=("en", "es"), help="of the screen; default en")
    args = parser.parse_args(argv)
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    args.out.mkdir(parents=True, exist_ok=True)
    _app = QApplication.instance() or QApplication(sys.argv[:1])
    load_fonts()
    style_application(DARK_PALETTE)
    for name, program, wear, curves, keys in PICTURES:
        with TemporaryDirectory() as folder:
            os.environ["TURNDESK_HOME"] = folder
            _picture(args.out / f"{name}.png", Path(folder), program, wear, curves, keys, args.language)
        sys.stdout.write(f"{args.out / name}.png\n")
    return 0


def _picture(
    path: Path, home: Path, program: str, wear: Wear, curves: tuple[str, ...], keys: str, language: str
) -> None:
    """One machine, worn, that runs one program to its end."""
    file = home / "worn.nc"
    file.write_text(program)
    journal = Journal.open_default()
    stage = Stage(journal)
    desk = stage.desk
    recorder, scope = desk.desk_control.recordings, desk.page_registry.find_model(ScopeModel)
    assert recorder is not None
    assert scope is not None
    stage.make_ready(str(file))
    wear(desk.desk_control.station_panel)
    stage.press_start()

    assert isinstance(recorder, ScopeRecorder)

    def over() -> bool:
        recorder.store_queued_ticks()
        snapshot = desk.read_snapshot()
        if snapshot.alarms:
            raise RuntimeError(f"{path.stem}: {snapshot.alarms[0].text}: {snapshot.alarms[0].cause}")
        return desk.read_snapshot().state is MachineState.IDLE

    stage.tick(over, 200.0)
    scope.selected_signal_keys = curves or scope.selected_signal_keys
    desk.settings_store.choose("language", language)
    window = MainWindow(ScreenTheme(DARK_PALETTE))
    window.resize(1024, 600)
    window.show_model(desk)
    for key in keys.split():
        press(window, key)
        for _ in range(_PATIENCE):
            if key != "F2" or scope.frozen_curves is not None:
                break
            _settle(window, 0.1)
    analyses = desk.page_registry.find_model(AnalysesModel)
    assert analyses is not None
    for _ in range(_PATIENCE):
        if "F8" not in keys or analyses.result is not None:
            break
        _settle(window, 0.1)
    _grab(window, path)
    window.close_silently()
    stage.close()
    journal.close()


if __name__ == "__main__":
    sys.exit(main())
