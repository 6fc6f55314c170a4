"""Keys and words of a machine's own language: no OmniTurn code on a mill or a SINUMERIK lathe."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.desk.status.readouts import make_spindle_readout
from app.screen.page_table import map_menu_keys
from app.special.inputs_outputs import SignalsFunction
from core.executor.snapshot import Snapshot
from tests.screen.hands import Hands


@pytest.mark.parametrize(
    ("language", "tools", "offsets"),
    [
        ("omniturn", "TOOL OFFSETS", "SECONDARY OFFSETS"),
        ("sinumerik", "TOOL OFFSETS", "ZERO OFFSETS"),
        ("klartext", "TOOL TABLE", "PRESETS"),
    ],
)
def test_f8_and_f9_in_main_menu_open_same_pages_as_elsewhere(language: str, tools: str, offsets: str) -> None:
    keys = map_menu_keys(language)
    assert (keys["F8"].name, keys["F9"].name) == (tools, offsets)


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("omniturn", ("M05 OFF", "M03 FWD", "M04 REV")),
        ("sinumerik", ("M5 OFF", "M3 FWD", "M4 REV")),
        ("klartext", ("M5 OFF", "M3 FWD", "M4 REV")),
    ],
)
def test_spindle_readout_uses_words_of_program_language(language: str, words: tuple[str, ...]) -> None:
    told = (make_spindle_readout(Snapshot(rpm_command=rpm), True, language) for rpm in (0.0, 900.0, -900.0))
    assert tuple(each.direction for each in told) == words


@pytest.mark.parametrize(
    ("name", "switched", "asked"),
    [
        ("gt75", {"coolant": "M08 M09", "collet": "M12 M13"}, {"TB2-5": "M91 M92", "guard": "GUARD"}),
        ("sinumerik-live", {"coolant": "M8 M9", "collet": ""}, {"guard": "GUARD"}),
        ("ac-table-mill", {"coolant": "M8 M9"}, {}),
    ],
)
def test_outputs_and_inputs_are_listed_with_codes_of_machine(
    hands: Hands, name: str, switched: dict[str, str], asked: dict[str, str]
) -> None:
    section = SignalsFunction(hands.desk, load_shipped_machine(name))
    outputs = {row.cells[0]: row.cells[3] for row in section.make_table(Snapshot()).rows}
    assert {name: outputs[name] for name in switched} == switched
    section.make_function_keys()["F4"].action()
    inputs = {row.cells[0]: row.cells[3] for row in section.make_table(Snapshot()).rows}
    assert {name: inputs[name] for name in asked} == asked
    assert name == "gt75" or not any(code.startswith("M9") for code in inputs.values())


@pytest.mark.parametrize(("stops", "asked"), [(True, "GUARD"), (False, "")])
def test_guard_code_is_listed_only_if_guard_stops_cycle(hands: Hands, stops: bool, asked: str) -> None:
    machine = load_shipped_machine("gt75")
    interlocks = replace(machine.interlocks, guard_stops=stops)
    section = SignalsFunction(hands.desk, replace(machine, interlocks=interlocks))
    section.make_function_keys()["F4"].action()
    inputs = {row.cells[0]: row.cells[3] for row in section.make_table(Snapshot()).rows}
    assert inputs["guard"] == asked
