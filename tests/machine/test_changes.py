"""What differs between two machine files."""

from __future__ import annotations

import tomllib

import pytest

import resources
from core.machine.machine_changes import ABSENT, changes

SHIPPED = resources.machine_file("gt75.toml")


def test_the_same_file_has_no_changes_whatever_its_comments_and_order() -> None:
    assert changes(SHIPPED, SHIPPED) == ()
    assert changes("a = 1\nb = 2\n", "b = 2  # first now\na = 1.0\n") == ()


def test_a_changed_key_is_told_by_its_path_with_both_values() -> None:
    new = SHIPPED.replace("vmax = 300", "vmax = 200", 1).replace('safe = "keep"', "safe = false")
    assert [tuple(change) for change in changes(SHIPPED, new)] == [
        ("axis.X.vmax", "300", "200"),
        ("io.out.collet.safe", '"keep"', "false"),
    ]


def test_keys_that_come_and_go() -> None:
    assert [tuple(c) for c in changes("[a]\nx = 1\ny = [1, 2]\n", "[a]\nx = 1\n[b]\nz = true\n")] == [
        ("b.z", ABSENT, "true"),
        ("a.y", "[1, 2]", ABSENT),
    ]


def test_true_is_not_one() -> None:
    assert [str(change) for change in changes("a = 1\n", "a = true\n")] == ["a: 1 → true"]


def test_an_empty_table_that_gets_keys_is_told() -> None:
    assert [tuple(c) for c in changes("[sim]\n", "[sim]\nseed = 3\n")] == [
        ("sim.seed", ABSENT, "3"),
        ("sim", "{}", ABSENT),
    ]


def test_what_is_no_toml_raises() -> None:
    with pytest.raises(tomllib.TOMLDecodeError):
        changes("a = \n", "a = 1\n")
