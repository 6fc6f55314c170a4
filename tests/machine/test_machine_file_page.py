"""``docs/integrator/machine-file.md``: it has every key of the machine file, with its meaning."""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import app.extras
import core.extras
import core.machine
import drivers
from app.compose.machine_file_page import generate_page, iterate_table_references, main, number
from core.key_declaration import KeyField, ValueKind, declare_key, get_declared_keys
from core.machine.machine_tables import LATHE_TABLES
from core.page_contents import make_anchor
from core.table_schema import TableDescription
from tests.whole_product import WHOLE_PRODUCT

PAGE = Path(__file__).parents[2] / "docs" / "integrator" / "machine-file.md"
TABLES = tuple(iterate_table_references())
KEYS = tuple(
    (f"{table.heading}: {field.key}", field) for table in TABLES for field in get_declared_keys(table.keys)
)
_NUMERIC = (ValueKind.NUMBER, ValueKind.INTEGER)


def _declared(value: object) -> tuple[KeyField, ...]:
    return get_declared_keys(value) if isinstance(value, type) else ()


def _modules() -> Iterator[str]:
    yield from (f"core.machine.{each.name}" for each in pkgutil.iter_modules(core.machine.__path__))
    for package in (drivers, app.extras, core.extras):
        for each in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if each.name.endswith(("_table", "_tables", "_nodes", "_rules")):
                yield each.name


@WHOLE_PRODUCT
def test_the_page_is_up_to_date() -> None:
    command = "python -m app.compose.machine_file_page docs/integrator/machine-file.md"
    assert PAGE.read_text("utf-8") == generate_page(), command


def test_the_command_writes_the_page(tmp_path: Path) -> None:
    page = tmp_path / "new" / "page.md"
    assert main([str(page)]) == 0
    assert page.read_text("utf-8") == generate_page()


def test_every_declared_key_is_on_the_page() -> None:
    shown = {(field.key, field.meaning) for _, field in KEYS}
    shown |= {
        (field.key, field.meaning) for each in LATHE_TABLES.values() for field in get_declared_keys(each)
    }
    for name in _modules():
        for variable, value in vars(importlib.import_module(name)).items():
            missing = [field.key for field in _declared(value) if (field.key, field.meaning) not in shown]
            assert not missing, f"{name}.{variable}"
    assert len(KEYS) > 240


@pytest.mark.parametrize(("place", "field"), KEYS, ids=[place for place, _ in KEYS])
def test_every_key_has_a_meaning(place: str, field: KeyField) -> None:
    meaning = field.meaning
    assert re.fullmatch(r"(true|false|Not|s32|[A-Z0-9\"`]).{11,300}\.", meaning), place
    assert "|" not in meaning, "ends the cell of the table"
    assert meaning.count("`") % 2 == 0
    if field.default == 0 and field.kind in _NUMERIC and field.minimum > 0.0:
        assert not re.search(r"\b0:", meaning), "the file cannot contain this value"


def test_a_field_without_a_meaning_is_refused() -> None:
    with pytest.raises(TypeError, match="meaning"):
        declare_key(default="")  # type: ignore[call-arg]


def test_table_of_contents_links_to_unique_headings() -> None:
    text = generate_page()
    links = re.findall(r"^- \[.*\]\(#(.*)\)$", text, re.MULTILINE)
    headings = [make_anchor(title) for title in re.findall(r"^## (.*)$", text, re.MULTILINE)]
    assert headings == links
    assert len(set(headings)) == len(headings)


def test_purposes_are_sentences() -> None:
    for table in TABLES:
        assert isinstance(table, TableDescription)
        assert re.match(r"[A-Z].*\.$", table.purpose), table.heading


@pytest.mark.parametrize(
    "row",
    [
        "| `resolution` | mm or in | 0.00001 to 0.02 mm, .0000003937 to .0007874 in | *derived* |",
        "| `clearance` | mm or in | 0.1 to 100 mm, .003937 to 3.937 in | 31.75 mm, 1.25 in |",
        "| `max_feed` | mm/min or in/min | 6 to 60000 mm, .2362 to 2362 in | *derived* |",
        "| `at_speed_pct` | % | 0.5 to 25 | **required** |",
        "| `refresh_ms` | ms | 50 to 10000 | *none* |",
        '| `safe` | – | true, false, `"keep"` | **required** |',
        '| `eol` | – | `"\\r\\n"`, `"\\n"`, `"\\r"` | `"\\r\\n"` |',
        "| `seed` | – | 0 to 2147483648 | 1 |",
    ],
)
def test_units_ranges_and_defaults_match_the_file(row: str) -> None:
    assert row in generate_page()


def test_numbers_are_written_without_exponent() -> None:
    assert [number(each) for each in (1e-6, 1e7, -36000.0, 31.75)] == [
        "0.000001",
        "10000000",
        "−36000",
        "31.75",
    ]
