"""``docs/checks.md`` is written from the table of checks, and every check of the table is tried."""

from __future__ import annotations

import ast
from pathlib import Path

from core.proving import part_findings
from core.proving.checks_page import main, page
from core.proving.part_checks import CHECKS

ROOT = Path(__file__).parents[2]


def test_the_page_is_that_of_the_table(tmp_path: Path) -> None:
    """python -m core.proving.checks_page docs/checks.md"""
    assert (ROOT / "docs/checks.md").read_text(encoding="utf-8") == page()
    assert main([str(tmp_path / "checks.md")]) == 0
    assert (tmp_path / "checks.md").read_text(encoding="utf-8") == page()


def test_what_is_found_has_an_entry_and_every_entry_is_found() -> None:
    tree = ast.parse(Path(part_findings.__file__).read_text(encoding="utf-8"))
    named = {
        call.args[0].value
        for call in ast.walk(tree)
        if isinstance(call, ast.Call)
        and isinstance(call.func, ast.Attribute)
        and call.func.attr in {"_add", "_tell"}
        and isinstance(call.args[0], ast.Constant)
    }
    assert named == set(CHECKS)


def test_every_check_has_a_program_that_triggers_it() -> None:
    tried = (ROOT / "tests/proving/test_part_proof.py").read_text(encoding="utf-8")
    assert [name for name in CHECKS if f'"{name}"' not in tried] == []
