"""What the desk's start does without: everybody waits for what it loads."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec

import pytest

from app.compose.optional_features import extras

DESK = """
import sys
import app.screen.screen_startup
from app.compose.desk_assembly import create_desk_and_executor
from app.compose.stored_offsets import read_stored_offsets
from drivers.wakeups import ManualClock
desk, _ = create_desk_and_executor(None, read_stored_offsets, ManualClock())
read = [name for name in sys.modules["linecache"].cache if "/app/" in name or "/core/" in name]
print(*sys.modules)
print(*read)
desk.close()
"""
OF_LATER = (
    *(
        "app.editor",
        "app.programs.program_list_model",
        "app.scope",
        "app.special.setup_sheet",
        "app.transfer",
    ),
    *("core.interpreter.klartext", "core.interpreter.sinumerik", "core.part.milled_part"),
    *("core.language.sinumerik", "core.language.code_book", "app.offsets.mill_touch"),
    *("core.geometry.rotary_axes", "core.interpreter.shared.working_plane"),
    *("core.part.insert_codes", "core.proving.program_tools", "drivers.hal", "drivers.grblhal.grblhal_table"),
    *("core.interpreter.omniturn.flow.loops_and_subroutines", "core.part.picture.solid_picture"),
    *("core.proving.part_proof", "drivers.canopen.canopen_machine", "drivers.driver_host"),
    *("drivers.hal.hal_machine", "drivers.inverter.inverter_spindle", "drivers.transfer"),
    *("ezdxf", "pyqtgraph", "svgelements"),
)
OF_FEATURES = (
    *("core.extras.quality.measured_feature", "core.extras.quality.control_charts"),
    *("app.extras.quality.shift_page", "app.extras.shapes.shapes_model", "core.extras.shapes.editor_shape"),
    *("app.extras.sharing.sharing_model", "app.extras.pendant.driver.pendant_station"),
    *("app.extras.mtconnect.adapter_setup", "app.extras.office.office_setup"),
    *("core.extras.drawings.profile_program", "app.extras.tour.tour_view", "app.extras.tour.tour_director"),
)


@pytest.fixture(scope="module")
def started(tmp_path_factory: pytest.TempPathFactory) -> tuple[frozenset[str], list[str]]:
    """Modules of a desk that stands, on the shipped lathe; source texts of ours that were read for it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TURNDESK_HOME", str(tmp_path_factory.mktemp("home")))
        command = [sys.executable, "-c", DESK]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
    modules, read, *_ = [*done.stdout.split("\n"), ""]
    return frozenset(modules.split()), read.split()


@pytest.mark.parametrize("later", [*OF_LATER, *OF_FEATURES])
def test_modules_for_pages_and_proofs_are_imported_only_when_needed(
    started: tuple[frozenset[str], list[str]], later: str
) -> None:
    if later not in OF_FEATURES or later.split(".")[2] in extras():
        assert find_spec(later) is not None
    assert not [name for name in started[0] if f"{name}.".startswith(f"{later}.")]


def test_modules_for_first_picture_are_imported_at_start(started: tuple[frozenset[str], list[str]]) -> None:
    assert {"app.automatic.automatic_view", "core.executor.executor", "PySide6.QtWidgets"} <= started[0]


def test_source_of_imported_modules_is_not_read(
    started: tuple[frozenset[str], list[str]],
) -> None:
    """PySide would read all of it, by ``inspect``, which keeps in ``linecache`` what it has read."""
    assert started[1] == []
