"""Values of words from formulas: they have the same limits as numbers, and no motion starts outside them."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from core.language.sinumerik.sinumerik_words import VALUE_RANGES
from core.language.sinumerik.word_table import INEFFECTIVE_WORDS
from tests.sinumerik.lathe import MODULO, good, refused, run, setup

LIVE = load_shipped_machine("sinumerik-live")
TURNING = "S500 M3 G95 F0.1\nG0 X20 Z2\n"
BLOCKS = {
    **dict.fromkeys(("X", "Z"), "G1 {word}"),
    **dict.fromkeys(("F", "FB"), "G94 F100\nG1 Z=IC(-1) {word}"),
    "Y": "SPOS=0\nTRANSMIT\nG17 G94 G1 {word} F100",
    "J": "SPOS=0\nTRANSMIT\nG17 G94 G3 X=IC(5) {word} F100",
    "C": "TRANS {word}",
    **dict.fromkeys(("X1", "Z1"), "G74 {word}"),
    "FP": "G75 X0 {word}",
    "RP": "G1 AP=10 {word}",
    "AP": "G1 RP=10 {word}",
    "ANG": "G1 X40 {word}",
    "RPL": "ROT {word}",
    "I": "G3 X20 Z-10 K-6 {word}",
    "K": "G3 X20 Z-10 I0 {word}",
    **dict.fromkeys(("CR", "AR"), "G3 X30 Z-10 {word}"),
    "I1": "CIP X20 Z-10 K1=-4 {word}",
    "K1": "CIP X20 Z-10 I1=15 {word}",
    **dict.fromkeys(("CHF", "CHR", "RND"), "G1 Z-10 {word}\nX40"),
    **dict.fromkeys(("RNDM", "FRCM", "OVR"), "{word}\nG1 Z-10\nX40"),
    "FRC": "G1 Z-10 RND=1 {word}\nX40",
    **dict.fromkeys(("SPOS", "SPOSA", "S", "LIMS", "T"), "{word}"),
    "D": "T1 {word}",
    "SF": "G33 Z-10 K1 {word}",
    "OFFN": "SPOS=0\nTRANSMIT\n{word}",
}
"""A block for each word with limits that has an effect."""


OWN_ALARMS = {
    "T": ("17190", "T=R1 results in {value:g}, which is not a tool number"),
    "D": ("17180", "D=R1: cutting edges are D1 to D9; D0 deselects"),
}
"""Alarms of SINUMERIK for tools and edges, which name the valid numbers."""


def _program(name: str, value: str, formula: str) -> str:
    return f"R1={value}\n{TURNING}{BLOCKS[name].format(word=f'{name}={formula}')}"


def test_each_word_with_limits_has_a_block() -> None:
    """The letters and names that follow an equals sign, without R and the words that have no effect."""
    assert BLOCKS.keys() == VALUE_RANGES.keys() - INEFFECTIVE_WORDS.keys() - {"R"}


@pytest.mark.parametrize("side", [0, 1], ids=["below", "above"])
@pytest.mark.parametrize("name", BLOCKS)
def test_formula_outside_the_limits_is_rejected_like_a_number(name: str, side: int) -> None:
    """1 below the lowest value and 1 above the highest value of the table."""
    value = f"{VALUE_RANGES[name][side] + (-1, 1)[side]:.0f}"
    around = setup(LIVE if "TRANSMIT" in BLOCKS[name] else MODULO)
    assert refused(_program(name, value, value), around).code == "12080"
    found = refused(_program(name, value, "R1"), around)
    code, told = OWN_ALARMS.get(name, ("out-of-range", "{name}=R1 results in {value:g},"))
    assert (found.code, found.line) == (code, 4 + BLOCKS[name].split("{")[0].count("\n"))
    assert told.format(name=name, value=float(value)) in found.message


def test_negative_rounding_from_a_formula_moves_nothing_past_the_end() -> None:
    """With RNDM=-2, G1 Z-10 once ended at Z-12."""
    passed = run(f"{TURNING}R1=-2\nRNDM=R1\nG1 Z-10\nX40")
    assert [each.code for each in passed.errors] == ["out-of-range"]
    assert min(block.z for block in passed.moves) == 2.0


@pytest.mark.parametrize(("radius", "ends"), [("2", [-8.0, -10.0, -10.0]), ("0", [-10.0, -10.0])])
def test_rounding_from_a_formula_within_the_limits(radius: str, ends: list[float]) -> None:
    """The rounding of 2 mm begins at Z-10 + 2; RNDM=0 cancels it."""
    blocks = good(f"{TURNING}R1={radius}\nRNDM=R1\nG1 Z-10\nX40")
    assert [block.z for block in blocks[1:]] == pytest.approx(ends)


@pytest.mark.parametrize(("name", "value"), [("OVR", "200"), ("OVR", "1"), ("AP", "360"), ("S", "0")])
def test_value_at_the_limit_is_accepted(name: str, value: str) -> None:
    block = {"AP": "G1 RP=10 AP=R1"}.get(name, f"{name}=R1")
    assert run(f"R1={value}\n{TURNING}{block}").errors == []


def test_variables_have_no_limits_for_results() -> None:
    """1e9 is the highest number in a program, but an intermediate result can be larger: 2e9 / 1e9 = 2."""
    (block,) = good("R1=1000000000\nR2=R1*2\nG0 Z=R2/R1")
    assert block.z == 2.0
