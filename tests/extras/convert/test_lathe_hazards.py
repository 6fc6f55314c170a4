"""Differences between lathes that the proof of a converted program cannot detect, calculated by hand."""

from __future__ import annotations

import pytest

from tests.extras.convert.test_from_omniturn import complete, convert, lines_of
from tests.extras.convert.test_to_sinumerik import convert as convert_to_sinumerik


def texts_of(text: str, target: str) -> list[str]:
    """Return the lines of the conversion of a complete OmniTurn program."""
    done = convert_to_sinumerik(text, "omniturn") if target == "sinumerik" else convert(text, target)
    assert not done.errors, [each.message for each in done.errors]
    return [each.text for each in done.lines]


@pytest.mark.parametrize(
    ("body", "made"),
    [
        # the lines from (PART OFF) to M30 are not executed before M00
        (
            "M98P1(GROOVE)\n(PART OFF)\nZ0(FACE)\nM30\n}1(SUB)\nM00(TURN IT)\nM99",
            ["(GROOVE)", "(SUB)", "(MSG, TURN IT)", "M0", "(PART OFF)", "(FACE)", "G1 G95 Z0 F.01"],
        ),
        # subroutine 1 is never executed
        (
            "P2\nM30\n}1(NEVER)\n(NEVER)\nM99\n}2\nM00(LOOK)\nM99",
            ["(MSG, LOOK)", "M0"],
        ),
        # the text of a stop is shown at each stop
        ("LS2\nM00(LOOK)\nLF", ["(MSG, LOOK)", "M0", "(MSG, LOOK)", "M0"]),
    ],
)
def test_text_of_a_stop_contains_no_comment_of_other_lines(body: str, made: list[str]) -> None:
    assert lines_of(body, "linuxcnc")[: len(made)] == made


LONG = "TURN THE PART AND TIGHTEN THE CHUCK TO 40 NM; DO NOT CONTINUE WHILE THE DOOR IS OPEN"
"""Text of 84 characters; the first 60 end within CONTINUE."""


def test_long_text_for_the_operator_is_not_cut() -> None:
    first, second = "TURN THE PART AND TIGHTEN THE CHUCK TO 40 NM; DO NOT", "CONTINUE WHILE THE DOOR IS OPEN"
    assert lines_of(f"M00({LONG})", "linuxcnc")[:3] == [f"(MSG, {first})", f"(MSG, {second})", "M0"]
    fanuc = lines_of(f"M00({LONG})", "fanuc")
    assert fanuc[:3] == [f"({first.replace(';', ' ')})", f"({second})", "M00"]
    made = texts_of(complete(f"M00({LONG})"), "sinumerik")
    assert f'MSG("{LONG}")' in made
    assert f'MSG("{LONG} {LONG[:29]}...")' in texts_of(complete(f"M00({LONG} {LONG})"), "sinumerik")


def test_accents_become_plain_letters() -> None:
    assert lines_of("(OPERACIÓN Ü)\nZ0", "fanuc")[0] == "(OPERACION U)"
