"""Every key of the samples spoilt, one at a time: refused under its own path, and never by a traceback."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import parse_machine
from core.table_schema import MachineFileError
from tests.machine.spoil import Place, leaves, path_of, sample, with_value

pytestmark = pytest.mark.long

# Each key is spoilt in the first sample that has it; "spec" is last, as it may be absent.
SAMPLES = (
    "gt75",
    "gt75-canopen",
    "gt75-grblhal",
    "gt75-hal",
    "gt75-parport",
    "gt75-mesa-7i76e",
    "gt75-mesa-7i97",
    "gt75-ethercat",
    "gt75-vfd",
    "ac-table-mill",
    "bc-table-mill",
    "fork-head-mill",
    "head-table-mill",
    "sinumerik-modulo",
    "spec",
)
# What may be any text or any number is spoilt by its kind alone.
NUMBERS: tuple[object, ...] = ("x", True, float("nan"), float("inf"), 10**400, [], {})
FREE_NUMBERS = ("canopen.sdo", "grblhal.settings", "sim.seed")


def wrong_values(path: str, value: object) -> list[object]:
    if isinstance(value, bool):
        return ["perhaps", [], {}] if path.endswith(".safe") else ["keep", 1, 0.0, [], {}]
    if isinstance(value, int | float):
        if path.startswith("grblhal.settings"):
            return [True, [], {}]
        return [*NUMBERS, *(() if path.startswith(FREE_NUMBERS) else (1e12, -1e12))]
    if path.endswith(".fixed_points"):  # of any number up to four, in any order
        return ["x", 3, [], [1, 2, 3, 4, 5], ["a"], [1e9], {}]
    if isinstance(value, list):
        return ["x", 3, [1.0], [1, 2, 3, 4], [2.0, 1.0] if len(value) == 2 else ["a", 1, 2], {}]
    texts = [5, [], {}] if path.endswith(".safe") else [5, True, [], {}]
    return texts if path in {"spindle.driver", "dnc.wrap"} else [*texts, ""]


def new_places(name: str) -> list[tuple[Place, object]]:
    """Return the keys of a sample, with their values, that no sample before it has."""
    before = {path_of(place) for each in SAMPLES[: SAMPLES.index(name)] for place, _ in leaves(sample(each))}
    return [(place, value) for place, value in leaves(sample(name)) if path_of(place) not in before]


def spoilt(name: str) -> list[tuple[Place, object]]:
    return [
        (place, wrong)
        for place, value in new_places(name)
        if value != []
        for wrong in wrong_values(path_of(place), value)
    ]


def paths_of(text: str, name: str) -> list[str]:
    """Paths of all findings; none for a file that is accepted."""
    try:
        parse_machine(text, name)
    except MachineFileError as error:
        return [finding.path for finding in error.findings]
    return []


@pytest.mark.parametrize("name", SAMPLES)
def test_sample_file_loads_unchanged(name: str) -> None:
    data = sample(name)
    place = next(place for place, _ in leaves(data))
    assert parse_machine(with_value(data, place, data["machine"]["name"]), name).axes  # type: ignore[index]


@pytest.mark.parametrize("name", SAMPLES)
def test_every_wrong_value_is_one_error_at_its_path(name: str) -> None:
    """Only machine.kind, which decides what tables there are, draws further ones."""
    data, trouble = sample(name), []
    for place, wrong in spoilt(name):
        path = path_of(place)
        found = paths_of(with_value(data, place, wrong), name)
        here = [each for each in found if each == path or each.startswith(f"{path}.")]
        if not here or (len(here) < len(found) and path != "machine.kind"):
            trouble.append((path, wrong, found))
    assert not trouble


@pytest.mark.parametrize("name", SAMPLES)
def test_every_unknown_key_is_reported(name: str) -> None:
    data = sample(name)
    free = ("m_codes", "io.in", "io.out", "canopen.nodes", "canopen.sdo.all", "grblhal.settings")
    for place, _ in new_places(name):
        beside = (*place[:-1], "nobody_reads_this")
        if len(place) == 1 or path_of(place[:-1]) in free:
            continue
        assert paths_of(with_value(data, beside, 1), name) == [path_of(beside)]
