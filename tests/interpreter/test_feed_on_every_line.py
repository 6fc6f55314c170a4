"""A line with another F needs no statement: every block and finding is that which its statement gives."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from unittest.mock import patch

import pytest

from core.interpreter.omniturn.motion import straight_moves
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import read_program
from core.interpreter.shared.job_setup import ControlLimits, InterpreterSetup, ToolOffset
from core.language.diagnostics import Diagnostic
from core.language.source import ProgramSource

SETUP = InterpreterSetup(tools={1: ToolOffset(0.0, 0.0)}, limits=ControlLimits(max_feed_mm_s=300 * 25.4 / 60))
HEAD = ["G90G94F300G72", "M03S2000", "T1", "X1Z.1", "G95F.003"]
# What stands between the moves, and changes what the next F means; what is refused, or needs more beside it.
MEANT = ["G94F5", "G95F.004", "G00", "G01", "G00 (TITLE)", "G04F1", "(noted)", "M03S900", "X.5Z-.1"]
ODD = [
    "M05",
    "G91",
    "G90",
    "G35",
    "G36",
    "G96S300",
    "G97",
    "G41X.4Z.2",
    "G40X.6Z.3",
    "D2",
    "G71",
    "G73",
    "X.5,C.02",
]
STRANGE = [f"F{each}" for each in (".06", ".3", "0", ".00001", "5", "6.5", "300", "301", "9999")]


def gone_through(text: str, setup: InterpreterSetup = SETUP) -> tuple[list[str], list[Diagnostic]]:
    """All fields of all blocks, and what was found."""
    interpreter = Interpreter(read_program(ProgramSource("PART", text)), setup)
    return [repr(block) for block in interpreter.generate_blocks()], list(interpreter.diagnostics)


def by_statements(text: str) -> tuple[list[str], list[Diagnostic]]:
    """The same, each line with another F by its statement."""
    with patch.object(straight_moves, "set_plain_move_feed", lambda _state, _f: False):
        return gone_through(text)


def program(chance: random.Random, between: Sequence[str], feeds: Sequence[str]) -> str:
    """Moves with an F each, and now and then what changes the meaning of the next."""
    lines = list(HEAD)
    for _ in range(60):
        if chance.random() < 0.15:
            lines.append(chance.choice(between))
        x, z = f"X{chance.uniform(0.1, 1):.{chance.choice((3, 4, 5))}f}", f"Z{chance.uniform(-1, 0):.4f}"
        code, words = chance.choice(["", "", "", "G01"]), chance.choice([x + z, x, z])
        lines.append(f"{code}{words}{chance.choice(feeds)}")
    return "\n".join([*lines, "M30"])


@pytest.mark.parametrize("seed", range(20))
def test_findings_with_feed_on_every_line_match_statement_findings(seed: int) -> None:
    text = program(random.Random(seed), [*MEANT, *ODD], ["", "F.003", "F.0031", "F.004", *STRANGE])
    assert gone_through(text) == by_statements(text)


@pytest.mark.parametrize("seed", range(20))
def test_blocks_with_feed_on_every_line_match_statement_blocks(seed: int) -> None:
    text = program(random.Random(seed), MEANT, ["", "F.003", "F.0031", "F.004", "F.05"])
    blocks, found = gone_through(text)
    assert len(blocks) > 60
    assert (blocks, found) == by_statements(text)


def test_feed_on_line_sets_modal_feed_without_statement() -> None:
    moves = [f"X.{5 + k % 2}Z-.{k + 1}F.00{k + 3}" for k in range(4)]
    with patch("core.interpreter.omniturn.omniturn_interpreter.make_statement") as made:
        interpreter = Interpreter(
            read_program(ProgramSource("PART", "\n".join([*HEAD, "X.5Z0", *moves, "M30"]))), SETUP
        )
        cuts = [
            block
            for block in interpreter.generate_blocks()
            if block.line > len(HEAD) + 1 and block.action is None
        ]
    # F of G95 in inches a turn: .003 in are .0762 mm; the first is in force already.
    assert [round(block.feed, 6) for block in cuts] == [0.0762, 0.1016, 0.127, 0.1524]
    assert [block.modal.last_cutting_feed for block in cuts] == [block.feed for block in cuts]
    made.assert_not_called()


@pytest.mark.parametrize(
    ("feed", "code"),
    [("F.3", "feed-range"), ("F.06", "feed-high"), ("F301", "feed-range"), ("F.00001", "feed-range")],
)
def test_invalid_or_unusual_feed_is_reported_on_its_line(feed: str, code: str) -> None:
    text = "\n".join([*HEAD, "X.5Z0", "Z-.1F.004", f"Z-.2{feed}", "M30"])
    found = [(each.line, each.code) for each in gone_through(text)[1]]
    assert (len(HEAD) + 3, code) in found


def test_feed_above_axis_limit_at_spindle_speed_is_rejected() -> None:
    """.05 in a turn at 2000 rpm are 100 in/min, where the slides reach 90."""
    slow = replace(SETUP, limits=ControlLimits(max_feed_mm_s=90 * 25.4 / 60))
    text = "\n".join(["G90G94F80G72", *HEAD[1:], "X.5Z0", "Z-.1F.004", "Z-.2F.045", "Z-.3F.05", "M30"])
    found = [(each.line, each.code) for each in gone_through(text, slow)[1]]
    assert (len(HEAD) + 4, "feed-over-speed") in found
    assert (len(HEAD) + 3, "feed-over-speed") not in found
