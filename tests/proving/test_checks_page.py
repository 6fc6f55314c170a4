"""``docs/checks.md`` is written from the table of checks, and every check of the table is tried."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from core.proving.checks import cut_checks, edge_checks, part_findings, thread_checks
from core.proving.checks.part_checks import PART_CHECKS, PROGRAM_CHECKS
from core.proving.checks_page import main, render_checks_page

MODULES = (part_findings, cut_checks, cut_checks, edge_checks, thread_checks)
ROOT = Path(__file__).parents[2]


def test_checks_page_matches_table(tmp_path: Path) -> None:
    """python -m core.proving.checks_page docs/checks.md"""
    assert (ROOT / "docs/checks.md").read_text(encoding="utf-8") == render_checks_page()
    assert main([str(tmp_path / "checks.md")]) == 0
    assert (tmp_path / "checks.md").read_text(encoding="utf-8") == render_checks_page()


def test_checks_table_lists_exactly_the_reported_checks() -> None:
    assert {name for module in MODULES for name in _named(module)} == set(PART_CHECKS)


def _named(module: ModuleType) -> Iterator[str]:
    tree = ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8"))
    for call in ast.walk(tree):
        if not (isinstance(call, ast.Call) and call.args and isinstance(call.args[0], ast.Constant)):
            continue
        name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
        if name in {"_add", "_store_finding", "Found"}:
            yield str(call.args[0].value)


PROMISED = (
    "rapid-into-stock feed-into-holder holder-into-stock into-chuck neighbour-tool larger-than-stock "
    "cuts-air wrong-spindle-direction no-tool collet-open live-tool-off spindle-off drill-too-deep "
    "part-off-unsupported thread-run-up chip-load through-part unreached-branch"
)


def test_every_check_that_is_promised_is_on_the_page() -> None:
    assert [name for name in PROMISED.split() if f"**{name}** (" not in render_checks_page()] == []


def test_every_check_has_a_program_that_triggers_it() -> None:
    tried = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests/proving").glob("test_*.py"))
    assert [name for name in (*PART_CHECKS, *PROGRAM_CHECKS) if tried.count(f'"{name}') < 1] == []
