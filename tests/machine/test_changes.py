"""What differs between two machine files."""

from __future__ import annotations

import tomllib

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from core.machine.machine_file import MISSING_VALUE, compare_machine_files
from core.secret_values import SECRET_MASK
from core.table_schema import MachineFileError

SHIPPED = resources.read_machine_file("gt75.toml")


def test_comments_and_order_are_not_changes() -> None:
    assert compare_machine_files(SHIPPED, SHIPPED) == ()
    assert compare_machine_files("a = 1\nb = 2\n", "b = 2  # first now\na = 1.0\n") == ()


def test_changed_key_is_listed_with_path_and_both_values() -> None:
    new = SHIPPED.replace("vmax = 300", "vmax = 200", 1).replace('safe = "keep"', "safe = false")
    assert [tuple(change) for change in compare_machine_files(SHIPPED, new)] == [
        ("axis.X.vmax", "300", "200"),
        ("io.out.collet.safe", '"keep"', "false"),
    ]


def test_added_and_removed_keys_are_listed() -> None:
    assert [
        tuple(c) for c in compare_machine_files("[a]\nx = 1\ny = [1, 2]\n", "[a]\nx = 1\n[b]\nz = true\n")
    ] == [
        ("b.z", MISSING_VALUE, "true"),
        ("a.y", "[1, 2]", MISSING_VALUE),
    ]


def test_true_and_one_are_different_values() -> None:
    assert [str(change) for change in compare_machine_files("a = 1\n", "a = true\n")] == ["a: 1 → true"]


def test_keys_added_to_empty_table_are_listed() -> None:
    assert [tuple(c) for c in compare_machine_files("[sim]\n", "[sim]\nseed = 3\n")] == [
        ("sim.seed", MISSING_VALUE, "3"),
        ("sim", "{}", MISSING_VALUE),
    ]


def test_invalid_toml_raises_error() -> None:
    with pytest.raises(tomllib.TOMLDecodeError):
        compare_machine_files("a = \n", "a = 1\n")


@pytest.mark.parametrize(
    ("table", "key", "value"),
    [
        ("announce", "password", '"secret"'),
        ("announce", "hook", '"https://hooks/secret"'),
        ("sharing", "postgresql", '"host=h password = secret"'),
        ("sharing", "git", '"https://me:secret@h/x.git"'),
        ("status_page", "token", '"secret"'),
        ("status_page", "desks", '"http://a/?token=secret"'),
    ],
)
def test_passwords_and_tokens_are_masked_in_changes(table: str, key: str, value: str) -> None:
    (change,) = compare_machine_files("", f"[{table}]\n{key} = {value}\n")
    assert change == (f"{table}.{key}", MISSING_VALUE, SECRET_MASK)


@pytest.mark.parametrize(
    "lines",
    [
        "[announce]\npassword = 1234",
        '[announce]\nhook = "hooks/1234"',
        '[announce]\nmqtt = "me:1234@shop-pc:1883"',
        "[sharing]\npostgresql = [1234]",
        '[status_page]\ndesks = ["htp://a/?token=1234"]',
        '[status_page]\nagents = ["http://a?token=1234"]',
    ],
)
def test_passwords_and_tokens_are_not_in_findings(lines: str) -> None:
    with pytest.raises(MachineFileError) as told:
        parse_machine(f"{SHIPPED}{lines}\n", "m.toml")
    assert "1234" not in str(told.value)
    assert all("1234" not in finding.value for finding in told.value.findings)
