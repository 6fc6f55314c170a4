"""The arrows of the house, as a failing test."""

import importlib
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.compose.optional_features import extras

OURS = ("app", "core", "drivers", "resources")
QT = {"PySide6", "shiboken6"}
SCREEN = "app.screen"
# They open the screen or print a PDF, and import Qt only then.
COMMANDS = {"app.cli.main", "app.cli.proofs.report_file"}


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
        f"build_parser(['{command}']); import app.compose.machine.machine_setup; "
        "sys.exit(any(name.startswith('PySide6') for name in sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


@pytest.fixture(scope="module")
def imports() -> dict[str, set[str]]:
    """What each of our modules imports by itself, also within functions and for types alone."""
    grimp = pytest.importorskip("grimp")
    graph = grimp.build_graph(
        *OURS, include_external_packages=True, exclude_type_checking_imports=False, cache_dir=None
    )
    ours = (name for name in graph.modules if name.split(".")[0] in OURS)
    return {name: set(graph.find_modules_directly_imported_by(name)) for name in ours}


def _is_view(module: str) -> bool:
    """Whether a module may know Qt: the screen's own, and the views of pages."""
    *packages, name = module.split(".")
    return f"{module}.".startswith(f"{SCREEN}.") or (
        packages[:1] == ["app"] and (name.endswith("_view") or "view" in {*packages, name})
    )


def test_only_screen_and_page_views_import_qt(imports: dict[str, set[str]]) -> None:
    assert [module for module, used in imports.items() if used & QT and not _is_view(module)] == []


def test_models_import_no_view_or_screen(imports: dict[str, set[str]]) -> None:
    models = {module for module in imports if not _is_view(module)} - COMMANDS
    assert {m: views for m in models if (views := sorted(filter(_is_view, imports[m])))} == {}


def test_only_compose_and_features_import_drivers(imports: dict[str, set[str]]) -> None:
    others = (m for m in imports if not m.startswith(("app.compose", "app.extras", "drivers")))
    known = {m: sorted(name for name in imports[m] if name.split(".")[0] == "drivers") for m in others}
    assert {module: names for module, names in known.items() if names} == {}


def test_optional_features_import_command_line_only_in_commands(imports: dict[str, set[str]]) -> None:
    extras = {m: used for m, used in imports.items() if m.startswith("app.extras.")}
    known = {m for m, used in extras.items() if any(name.startswith("app.cli") for name in used)}
    assert {m for m in known if not m.endswith("_command")} == set()


def test_feature_imports_only_features_that_it_requires(imports: dict[str, set[str]]) -> None:
    def owner(module: str) -> str:
        parts = module.split(".")
        return parts[2] if parts[1:2] == ["extras"] and len(parts) > 2 else ""

    known = {(owner(m), owner(name)) for m, used in imports.items() if owner(m) for name in used}
    needed = {(name, need) for name, extra in extras().items() for need in extra.required_features}
    assert {(a, b) for a, b in known if b and a != b} <= needed


def test_pages_of_optional_features_do_not_import_compose(imports: dict[str, set[str]]) -> None:
    extras = {m: used for m, used in imports.items() if m.startswith("app.extras.")}
    known = {m for m, used in extras.items() if any(name.startswith("app.compose") for name in used)}
    assert {
        m
        for m in known
        if not m.endswith((".extra", "_setup", "_command", "_check", "serial_gauge", "profile_trial"))
    } == set()


def test_modules_have_no_circular_imports(imports: dict[str, set[str]]) -> None:
    """Not even for types alone: who reads one of them would have to read all."""
    assert sorted(_circles(imports)) == []


def _circles(imports: dict[str, set[str]]) -> Iterator[list[str]]:
    """Modules that can all be reached from each other (Tarjan's strongly connected components)."""
    number: dict[str, int] = {}
    lowest: dict[str, int] = {}
    stack: list[str] = []

    def visit(module: str) -> Iterator[list[str]]:
        number[module] = lowest[module] = len(number)
        stack.append(module)
        for used in sorted(imports[module] & imports.keys()):
            if used not in number:
                yield from visit(used)
                lowest[module] = min(lowest[module], lowest[used])
            elif used in stack:
                lowest[module] = min(lowest[module], number[used])
        if lowest[module] == number[module]:
            circle = stack[stack.index(module) :]
            del stack[stack.index(module) :]
            if len(circle) > 1:
                yield sorted(circle)

    for module in sorted(imports):
        if module not in number:
            yield from visit(module)


def test_every_folder_of_a_driver_is_in_its_contracts() -> None:
    house = Path(__file__).parents[1]
    text = (house / "setup.cfg").read_text(encoding="utf-8")
    folders = sorted(path.parent.name for path in (house / "drivers").glob("*/__init__.py"))
    assert len(folders) > 5
    for contract, apart in (("simulators", {"simulators", "simulated"}), ("drivers-apart", {"simulators"})):
        held = text.partition(f"[importlinter:contract:{contract}]")[2].partition("\n[importlinter:")[0]
        assert [name for name in folders if f"drivers.{name}\n" not in held and name not in apart] == []


def test_pickle_is_used_only_between_turndesk_processes() -> None:
    """Unpickling runs what it is given: it is no format of a file."""
    sender_and_receiver = {
        "app/cli/proofs/proof_job.py",
        "app/cli/proofs/proof_work.py",
        "app/compose/backends/driver_host_process.py",
        "app/compose/control/control_client.py",
        "app/compose/control/control_process.py",
        "app/compose/control/control_start.py",
    }
    house = Path(__file__).parents[1]
    paths = [path for top in OURS for path in (house / top).rglob("*.py")]
    found = [
        path for path in paths if re.search(r"^\s*(import|from) pickle\b", path.read_text(), re.MULTILINE)
    ]
    assert {path.relative_to(house).as_posix() for path in found} == sender_and_receiver


MOST_FILES, MOST_LINES = 20, 500  # a newcomer sees a folder at one glance, and reads a file in one go


def test_no_folder_has_too_many_files() -> None:
    counts = Counter(path.parent for path in sources() if path.name != "__init__.py")
    assert {str(folder): count for folder, count in counts.items() if count > MOST_FILES} == {}


def test_no_file_is_too_long() -> None:
    lines = {str(path): len(path.read_text("utf-8").splitlines()) for path in sources()}
    assert {path: count for path, count in lines.items() if count > MOST_LINES} == {}


def sources() -> Iterator[Path]:
    house = Path(__file__).parents[1]
    return (path for top in OURS for path in (house / top).rglob("*.py"))
