"""What a short command loads: every module that it does not use is waited for at each call."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = "G90G94F300G72\nM03S2000\nT1\nX1Z.1\nG95F.003\nX.5Z0\nX.6Z-.1\nG00X1\nZ1\nM30\n"
OF_THE_REST = (
    *("PySide6", "shtab", "app.screen", "app.report", "app.offsets.offset_book"),
    *("core.executor", "core.alarms", "core.ports", "core.records", "core.store.store"),
    *("core.interpreter.klartext", "core.interpreter.sinumerik", "core.part.milled_part"),
    *("drivers.canopen", "drivers.grblhal", "drivers.hal", "drivers.inverter"),
    *("core.machine.serial_and_backup_tables", "core.machine.setter_table"),
    *("app.extras.mtconnect.driver", "app.extras.pendant.driver", "core.extras"),
    *("drivers.simulators", "drivers.setpoint_queue"),
)
OF_PYTHON = (
    *("concurrent", "difflib", "hashlib", "importlib.resources", "logging", "random", "socket", "sqlite3"),
    *("numpy.ma", "tempfile", "traceback", "urllib.request", "xml"),
)
PROVE = """
import sys
from app.cli.main import main
status = main(["prove", sys.argv[1]])
print(status, *sys.modules, file=sys.stderr)
"""


@pytest.fixture(scope="module")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> frozenset[str]:
    """The modules of a process that has proved a short program, on the shipped lathe, without a store."""
    folder = tmp_path_factory.mktemp("cold")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TURNDESK_HOME", str(folder / "home"))
        program = folder / "part.nc"
        program.write_text(PROGRAM)
        command = [sys.executable, "-c", PROVE, str(program)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
    status, *names = done.stderr.split()
    assert status == "0", done
    return frozenset(names)


@pytest.mark.parametrize("unused", OF_THE_REST + OF_PYTHON)
def test_prove_does_not_import_unused_modules(loaded: frozenset[str], unused: str) -> None:
    assert not [name for name in loaded if f"{name}.".startswith(f"{unused}.")]


HELP = """
import sys
from app.cli.main import main
try:
    main(sys.argv[1:])
except SystemExit:
    pass
print(*sys.modules, file=sys.stderr)
"""
OF_A_HELP = ("numpy", "sqlite3", "dataclasses", "locale", "core.store", "core.machine", "core.language")
OF_A_COMPLETION = ("numpy", "sqlite3", "core.store.store", "core.store.database", "core.machine")


def modules_of(*words: str) -> list[str]:
    done = subprocess.run([sys.executable, "-c", HELP, *words], check=True, capture_output=True, text=True)
    assert done.stdout
    return done.stderr.split()


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_and_version_import_no_command_and_no_store(option: str) -> None:
    loaded = modules_of(option)
    assert not [name for name in loaded for unused in OF_A_HELP if f"{name}.".startswith(f"{unused}.")]
    assert not [name for name in loaded if name.startswith("app.cli.") and name.endswith("_command")]


def test_completion_imports_all_commands_but_not_numpy_or_store() -> None:
    loaded = modules_of("setup", "completion", "bash")
    assert {"app.cli.prove_command", "app.cli.scope_command", "app.cli.store_command"} <= set(loaded)
    assert not [name for name in loaded for unused in OF_A_COMPLETION if f"{name}.".startswith(f"{unused}.")]


def test_prove_imports_the_modules_it_uses(loaded: frozenset[str]) -> None:
    used = {"core.interpreter.omniturn", "core.motion.window_planner", "core.proving.part_proof"}
    assert used <= loaded
