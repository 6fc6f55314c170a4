"""``docs/json.md``: every command is run on samples, and its keys are exactly those that are declared."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import NamedTuple

import pytest

import resources
from app.cli.json_reference import json_keys, offsets_keys
from app.cli.json_reference.json_page import generate_json_page, main
from app.shopfloor import json_keys as floor_keys
from core.json_keys import declare_keys, declare_row_keys
from core.store.store import Store
from core.store.store_export import EVENTS, RUNS, TABLES_BY_FILE_NAME
from core.store.store_rows import EventRow
from core.store.table_keys import PUBLIC_TABLES as PUBLIC
from core.store.table_keys import RUN_FILE_COLUMNS
from tests.cli.conftest import Turndesk
from tests.cli.json_output import declared_alone, whole
from tests.whole_product import WHOLE_PRODUCT

PAGE = Path(__file__).parents[2] / "docs" / "json.md"
PROGRAMS = Path(resources.__file__).parent / "programs"
HEAD = "G90G94F300\nM03S600\nT1\n"


@WHOLE_PRODUCT
def test_the_page_is_up_to_date() -> None:
    assert PAGE.read_text("utf-8") == generate_json_page(), (
        "python -m app.cli.json_reference.json_page docs/json.md"
    )


def test_json_page_is_written_to_given_path(tmp_path: Path) -> None:
    assert main([str(tmp_path / "page.md")]) == 0
    assert (tmp_path / "page.md").read_text("utf-8") == generate_json_page()


def test_key_meanings_are_sentences() -> None:
    tables = [each.keys for each in json_keys.ALL_OUTPUTS] + [table.columns for table in PUBLIC]
    for key in (key for table in (*tables, floor_keys.FILE_KEYS) for key in table):
        assert key.meaning.endswith("."), key
        assert "|" not in key.meaning, key


def test_every_command_with_json_is_on_the_page() -> None:
    folder = Path(json_keys.__file__).parents[1]
    commands = {
        path.stem.removesuffix("_command")
        for path in (*folder.glob("*_command.py"), *folder.parent.glob("extras/*/*_command.py"))
        if '"--json"' in path.read_text("utf-8") or "add_program_options" in path.read_text("utf-8")
    }
    assert commands == {each.command.split()[0] for each in json_keys.ALL_OUTPUTS}


# --- The checker itself: a key too many, a key too few, another type.


NAMED = declare_keys(
    "a | integer | | A.\nb | list | | B.\nb[].c | string or null | mm | C.\nd.* | number | | D."
)


@pytest.mark.parametrize(
    ("value", "why"),
    [
        ({"a": 1, "b": [{"c": "x"}], "d": {"any": 1.5}, "e": 1}, "e is not declared"),
        ({"a": 1, "b": [{"c": "x", "f": 1}], "d": {"any": 1.5}}, r"b\[\].f is not declared"),
        ({"a": "1", "b": [{"c": "x"}], "d": {"any": 1.5}}, "a is '1', not integer"),
        ({"a": True, "b": [{"c": "x"}], "d": {"any": 1.5}}, "a is True, not integer"),
        ({"a": 1, "b": [{"c": 2}], "d": {"any": 1.5}}, "not string or null"),
        ({"a": 1, "b": [], "d": {"any": 1.5}}, "c"),
    ],
)
def test_undeclared_or_missing_json_keys_are_detected(value: object, why: str) -> None:
    declared_alone([{"a": 1, "b": [{"c": None}], "d": {"any": 2}}], NAMED)
    with pytest.raises(AssertionError, match=why):
        declared_alone([value], NAMED)


def test_row_type_with_wrong_number_of_fields_is_rejected() -> None:
    class Pair(NamedTuple):
        one: int
        other: float | None

    declared = declare_row_keys("rows[].", Pair, "one | | One.\nother | mm | Other.")
    assert [each.type for each in declared] == ["integer", "number or null"]
    assert declared[1].name == "rows[].other"
    with pytest.raises(ValueError, match="one, other"):
        declare_row_keys("", Pair, "one | | One.")
    with pytest.raises(ValueError, match="expected 4 cells"):
        declare_keys("one | integer | One.")


# --- Programs.


@pytest.mark.long
def test_prove_json_has_the_declared_keys(turndesk: Turndesk, offsets: Path, tmp_path: Path) -> None:
    lathe, mill = tmp_path / "part.nc", tmp_path / "tilted.h"
    lathe.write_text(HEAD + "X.6Z.1\nG95F.005\nG01Z-.5\nX.7\nG94F300X.7Z.1\nM30\n")
    mill.write_text((PROGRAMS / "nozzle.h").read_text())
    there = tmp_path / "there.toml"
    there.write_text("[tool.1]\nx = 0.01\nz = 9.0\n[tool.2]\nx = 0.0\nz = 0.0\n")
    words = ("--offsets", offsets, "--stock", "bar:1.2:2", "--compare", there, "--json")
    told = turndesk("prove", lathe, *words)
    back = turndesk("prove", lathe, "--offsets", there, *words[2:5], offsets, "--json")
    values = [*told.lines, *back.lines]
    for machine in ("ac-table-mill", "bc-table-mill"):
        values += turndesk("prove", mill, "--machine", machine, "--json").lines
    declared_alone(values, json_keys.PROVE_OUTPUT.keys)


@pytest.mark.long
def test_expand_json_has_the_declared_keys(turndesk: Turndesk, offsets: Path, tmp_path: Path) -> None:
    lathe = tmp_path / "part.nc"
    lathe.write_text(HEAD + "X.5Z.1\nG02X.6Z0R.1F10\nM30\n")
    for name, output in (
        (lathe, json_keys.EXPAND_OMNITURN_OUTPUT),
        (PROGRAMS / "shaft.mpf", json_keys.EXPAND_SINUMERIK_OUTPUT),
        (PROGRAMS / "nozzle.h", json_keys.EXPAND_KLARTEXT_OUTPUT),
    ):
        machine = {".mpf": ("--machine", "sinumerik-live"), ".h": ("--machine", "bc-table-mill")}
        told = turndesk("expand", name, "--json", *machine.get(name.suffix, ()))
        declared_alone(told.lines, output.keys)


def test_trace_json_has_the_declared_keys(turndesk: Turndesk, offsets: Path, tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(HEAD + "X.5Z.1\nM30\n")
    told = turndesk("trace", path, "--out", tmp_path / "out.csv", "--json")
    declared_alone(told.lines, json_keys.TRACE_OUTPUT.keys)


@pytest.mark.long
def test_run_json_has_the_declared_keys(turndesk: Turndesk, offsets: Path, tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(HEAD + "X.5Z.1\nG04F3\nM30\n")
    offsets.write_text("".join(f"[tool.{number}]\nx = 0.0\nz = 0.0\n" for number in (1, 6)))
    broken = tmp_path / "broken.toml"
    fault = 'seed = 1\nfaults = [{ at = 1.5, what = "drive_fault", axis = "X" }]'
    broken.write_text(resources.read_machine_file("gt75.toml").replace("seed = 1", fault, 1))
    nozzle = PROGRAMS / "nozzle.h"
    runs = ((path, "gt75"), (path, broken), (nozzle, "ac-table-mill"), (nozzle, "bc-table-mill"))
    words = ("--headless", "--offsets", offsets, "--json", "--machine")
    values = [turndesk("run", program, *words, machine).lines[-1] for program, machine in runs]
    assert [each["state"] for each in values] == ["complete", "alarm", "complete", "complete"]
    declared_alone(values, json_keys.RUN_OUTPUT.keys)


# --- Machine files and the alarm catalog.


def test_machine_check_json_has_the_declared_keys(turndesk: Turndesk, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    text = resources.read_machine_file("gt75.toml")
    path.write_text(text)
    assert turndesk("machine", "accept", path).status == 0
    path.write_text(text.replace("vmax = 300", "vmax = 280").replace("max_feed = 300", "max_feed = 250"))
    good = whole(turndesk("machine", "check", path, "--json"))
    path.write_text(text.replace("vmax = 300", "vmax = -1"))
    bad = whole(turndesk("machine", "check", path, "--json"), 2)
    assert set(bad) == {"file", "errors", "ports"}
    declared_alone([good, bad], json_keys.MACHINE_CHECK_OUTPUT.keys)


def test_machine_hal_json_has_the_declared_keys(turndesk: Turndesk) -> None:
    values = [
        whole(turndesk("machine", "hal", f"gt75-{board}", "--json")) for board in ("mesa-7i97", "ethercat")
    ]
    declared_alone(values, json_keys.MACHINE_HAL_OUTPUT.keys)


def test_alarms_json_has_the_declared_keys(turndesk: Turndesk) -> None:
    declared_alone([whole(turndesk("alarms", "--json"))], json_keys.ALARMS_OUTPUT.keys)


# --- The store.


def test_offsets_json_has_the_declared_keys(turndesk: Turndesk, home: Path) -> None:
    for words in (
        ("T1", "x=1.25", "z=-.5", "kind=drill", "diameter=.25"),
        ("D1", "x=.01"),
        ("G54", "z=-120"),
        ("TOOL1", "L=80.5"),
        ("PRESET1", "x=100"),
    ):
        assert turndesk("offsets", "set", *words, "--yes").status == 0
    assert turndesk("offsets", "clear", "T1").status == 0
    history = whole(turndesk("offsets", "history", "--json"))
    assert turndesk("offsets", "undo").status == 0
    history += whole(turndesk("offsets", "history", "--json"))
    declared_alone([history], offsets_keys.OFFSETS_HISTORY_OUTPUT.keys)
    assert turndesk("offsets", "set", "T1", "x=1.25", "z=-.5", "--yes").status == 0
    declared_alone([whole(turndesk("offsets", "show", "--json"))], offsets_keys.OFFSETS_SHOW_OUTPUT.keys)


def test_store_verify_json_has_the_declared_keys(turndesk: Turndesk, filled: Path) -> None:
    declared_alone([whole(turndesk("store", "verify", "--json"))], json_keys.STORE_VERIFY_OUTPUT.keys)


def test_public_tables_have_the_declared_columns(home: Path) -> None:
    with Store.open(home) as store, store.read() as connection:
        for table in PUBLIC:
            rows = connection.execute(f"PRAGMA table_info({table.name})").fetchall()
            assert [row[1] for row in rows] == [key.name for key in table.columns], table.name
            kinds = {"INTEGER": "integer", "REAL": "number", "TEXT": "string", "BLOB": "blob"}
            for row, key in zip(rows, table.columns, strict=True):
                nullable = not row[3] and not row[5]
                assert key.type == kinds[row[2]] + " or null" * nullable, f"{table.name}.{key.name}"


def test_exported_files_have_the_declared_columns(turndesk: Turndesk, filled: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert turndesk("store", "export", out).status == 0
    heads = {path.name: next(csv.reader(path.read_text("utf-8").splitlines())) for path in out.glob("*.csv")}
    files = {table.export_file: [key.name for key in table.columns] for table in PUBLIC if table.export_file}
    assert heads.pop(RUNS) == list(RUN_FILE_COLUMNS)
    assert heads.pop(EVENTS) == list(EventRow._fields)
    assert heads == files
    assert {table.export_file: table.name for table in PUBLIC if table.export_file} == TABLES_BY_FILE_NAME


# --- Scope.


def test_scope_json_has_the_declared_keys(
    turndesk: Turndesk, offsets: Path, home: Path, tmp_path: Path
) -> None:
    path = tmp_path / "part.nc"
    path.write_text(HEAD + "X.5Z.1\nM30\n")
    assert turndesk("run", path, "--headless", "--offsets", offsets).status == 0
    told = turndesk("scope", home / "records" / "run.ring", "--json")
    declared_alone(told.lines, json_keys.SCOPE_OUTPUT.keys)
