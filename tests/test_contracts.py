"""The arrows of the house, as a failing test."""

import importlib
import subprocess
import sys

import pytest


def test_import_contracts_hold() -> None:
    pytest.importorskip("importlinter")
    done = subprocess.run(
        [sys.executable, "-c", "from importlinter.cli import lint_imports_command as c; c()"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("command", ["prove", "expand", "trace", "run", "offsets", "store", "machine"])
def test_no_command_but_the_screen_imports_qt(command: str) -> None:
    importlib.import_module(f"app.cli.{command}_command")
    script = (
        "import sys; from app.cli.main import build_parser; "
        f"build_parser(['{command}']); import app.compose.machine_setup; "
        "sys.exit(any(name.startswith('PySide6') for name in sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0
