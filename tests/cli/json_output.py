"""Compares the JSON that commands print with the declared keys."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable
from typing import Any

from core.json_keys import JsonKey, find_keys, find_parent_paths, has_declared_type
from tests.cli.conftest import Told


def declared_alone(
    values: Iterable[object], declared: Collection[JsonKey], never: Collection[str] = ()
) -> None:
    """The values together have exactly the declared keys but ``never``, with values of the declared types."""
    named, seen = {key.name: key for key in declared}, set[str]()
    above = find_parent_paths(declared)
    for value in values:
        for path, each in find_keys(value, declared):
            assert path in named or path in above, f"{path} is not declared"
            if path in named:
                assert has_declared_type(each, named[path]), f"{path} is {each!r}, not {named[path].type}"
                seen.add(path)
    unseen = set(named) - seen
    assert unseen == set(never), f"never printed: {sorted(unseen)}"


def whole(told: Told, status: int = 0) -> Any:
    assert told.status == status, told.err
    return json.loads(told.out)
