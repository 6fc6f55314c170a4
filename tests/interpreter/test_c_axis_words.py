"""M19, M89, G89 and the words of C: where C goes, how fast, and what is refused."""

from __future__ import annotations

import pytest

from core.interpreter.shared.actions import SpindleLock, SpindleRun
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import ControlLimits
from tests.interpreter.programs import INCH, Pass, lines, passed, setup

HEAD = "G90G94F300"


def run(*each: str, limits: ControlLimits | None = None, start_c: float = 0.0) -> Pass:
    """Lines from line 2 on, between a head and M30, from C ``start_c``."""
    given = setup(limits=limits or ControlLimits(has_c_feedback=True))
    x, z, _ = given.start
    object.__setattr__(given, "start", (x, z, start_c))
    return passed(lines(HEAD, *each, "M30"), given)


def turns(result: Pass) -> list[tuple[float, float, float]]:
    """(from, to, rpm) of each turn of C alone."""
    return [(b.c0, b.c, b.rpm) for b in result.moves if b.kind is BlockKind.ROTATE]


def test_m19_at_zero_does_not_turn() -> None:
    result = run("M19")
    assert result.actions[0] == SpindleLock(orient=True)
    assert turns(result) == []
    assert result.blocks[0].modal.c_locked


@pytest.mark.parametrize(
    ("start", "word", "expected"),
    [
        (90.0, "M19", (90.0, 0.0, -200.0)),  # the short way
        (270.0, "M19", (-90.0, 0.0, 200.0)),
        (-450.0, "M19", (-90.0, 0.0, 200.0)),  # -90 short of -360, which is 0 again
        (90.0, "M19S50", (-270.0, 0.0, 50.0)),  # as M03 turns
        (270.0, "M19S-50", (270.0, 0.0, -50.0)),  # as M04 turns
    ],
)
def test_m19_turns_to_zero(start: float, word: str, expected: tuple[float, float, float]) -> None:
    result = run(word, start_c=start)
    assert turns(result) == [expected]
    (turn,) = result.moves
    assert turn.c0 + turn.modal.offset_c == start
    assert turn.mc % 360.0 == 0.0
    assert turn.feed == abs(expected[2]) * 6.0


def test_m19_at_a_full_revolution_does_not_turn() -> None:
    result = run("M19", "C10", start_c=-360.0)
    assert turns(result) == [(0.0, 10.0, 200.0)]
    assert result.moves[0].mc == -350.0


def test_m89_and_g89_lock_c_in_place() -> None:
    for word in ("M89", "G89"):
        result = run(word, "CI10", start_c=33.0)
        assert result.actions[0] == SpindleLock(orient=False)
        assert turns(result) == [(33.0, 43.0, 200.0)]


def test_c_is_absolute_incremental_or_by_the_mode() -> None:
    result = run("M19", "CA90", "CI90", "C-90", "G91", "C-90", "CA0S12", "CI720", "G90")
    assert [(a, b) for a, b, _ in turns(result)] == [
        (0.0, 90.0), (90.0, 180.0), (180.0, -90.0), (-90.0, -180.0), (-180.0, 0.0), (0.0, 720.0),
    ]  # fmt: skip
    assert [rpm for _, _, rpm in turns(result)] == [200.0, 200.0, -200.0, -200.0, 12.0, 12.0]


def test_s_magnitude_is_the_speed_and_the_path_gives_its_sign() -> None:
    assert turns(run("M19", "C90S-5", "C0S5")) == [(0.0, 90.0, 5.0), (90.0, 0.0, -5.0)]


def test_s_with_c_does_not_change_the_spindle_speed() -> None:
    result = run("S1000", "M19S20", "C90S30", "M05", "M03")
    assert result.actions[-2] == SpindleRun(1000.0)


def test_m05_releases_c_and_retains_its_position() -> None:
    result = run("M19", "C90", "M05", "X1")
    assert not result.moves[-1].modal.c_locked
    assert result.moves[-1].c == 90.0
    assert not result.blocks[-1].modal.c_locked


def test_c_and_linear_axis_under_g94_end_together() -> None:
    result = run("M19", "G94F5", "X.5C90")
    move = result.moves[-1]
    assert (move.kind, move.c0, move.c, move.per_rev, move.rpm) == (BlockKind.FEED, 0.0, 90.0, False, 0.0)
    assert move.feed == pytest.approx(5 * INCH / 60)


def test_rapid_also_moves_c() -> None:
    result = run("M19", "G00", "X.5Z.5C90")
    assert result.moves[-1].kind is BlockKind.RAPID
    assert result.moves[-1].c == 90.0


def test_c_with_a_linear_axis_under_g95_feeds_the_axis() -> None:
    result = run("M19", "G95F.1", "Z-.1CI-360S20")
    move = result.moves[-1]
    assert (move.kind, move.c, move.per_rev, move.rpm) == (BlockKind.FEED, -360.0, True, -20.0)
    assert move.feed == pytest.approx(0.1 * INCH)
    assert move.css is None


def test_c_speed_applies_while_locked() -> None:
    assert run("M19S20", "G95F.1", "Z-.1CI-360").errors == []


def test_c_turns_alone_if_the_linear_axis_does_not_move() -> None:
    assert [b.kind for b in run("X.5", "M19", "X.5C90").moves] == [BlockKind.RAPID, BlockKind.ROTATE]


def test_c_word_is_a_corner_while_the_spindle_is_unlocked() -> None:
    errors = run("X1C.1").errors
    assert errors
    assert errors[0][2] != "c-unlocked"


def test_c_is_rounded_to_its_resolution() -> None:
    result = run("M19", "C27.5", "C45.115")
    assert turns(result)[1][1] == pytest.approx(45.12)
    assert result.warnings == [(4, 1, "finer-than-step")]


# --- the drive that does not tell ---------------------------------------------------------------------------

DEAF = ControlLimits()


def warned(*each: str) -> list[str]:
    result = run("M19", *each, limits=DEAF)
    assert result.errors == []
    return [d.message for d in result.interpreter.diagnostics if d.code == "dwell-too-short"]


def test_turn_before_a_move_warns_with_its_time() -> None:
    """90 degrees by 3600 degrees/s²: 2·sqrt(90/3600) = .32 s."""
    (message,) = warned("C90", "X1")
    assert "0.32 s" in message


def test_slow_turn_time_is_angle_over_speed() -> None:
    """90 degrees at 1 rpm, 6 degrees/s: 15 s and 6/3600 s, rounded up."""
    (message,) = warned("C90S1", "X1")
    assert "15.01 s" in message


def test_sufficient_dwell_gives_no_warning() -> None:
    assert warned("C90", "G04F.32", "X1") == []
    assert warned("C90", "G04F.2", "M08", "G04F.2", "X1") == []


def test_insufficient_dwell_gives_a_warning() -> None:
    assert len(warned("C90", "G04F.3", "X1")) == 1
    assert len(warned("C90", "C180", "G04F1")) == 1
    assert len(warned("C90")) == 1  # the end of the program takes the part away
    assert len(warned("C90", "X1C180F5")) == 1


def test_dwell_check_follows_loops() -> None:
    """The dwell at the loop's start comes behind the turn at its end, but for the last."""
    assert len(warned("LS3", "G04F1", "CI90", "LF", "X1")) == 1
    assert warned("LS3", "G04F1", "CI90", "LF", "G04F1", "X1") == []


def test_drive_with_feedback_needs_no_dwell() -> None:
    assert run("M19", "C90", "X1").warnings == []


# --- refusals -----------------------------------------------------------------------------------------------

NO_C = ControlLimits(is_c_enabled=False)
REFUSED: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    (("CA90",), (2, 1, "c-unlocked")),
    (("CI90",), (2, 1, "c-unlocked")),
    (("C90",), (2, 1, "c-unlocked")),
    (("X1CA90",), (2, 3, "c-unlocked")),
    (("M19", "M05", "C90"), (4, 1, "c-unlocked")),
    (("M19", "CA90CI90"), (3, 5, "word-twice")),
    (("M19", "C90CI5"), (3, 4, "word-twice")),
    (("M19", "C"), (3, 1, "number-missing")),
    (("M19", "M03S500"), (3, 1, "spindle-locked")),
    (("M89", "S500M04"), (3, 5, "spindle-locked")),
    (("M19", "C90S201"), (3, 4, "speed-range")),
    (("M19", "C90S-201"), (3, 4, "speed-range")),
    (("M19", "C90S0"), (3, 4, "speed-range")),
    (("M19S300",), (2, 4, "speed-range")),
    (("G89S300",), (2, 4, "speed-range")),
    (("G89M08",), (2, 1, "not-alone")),
    (("G89X1",), (2, 4, "word-unused")),
    (("M19", "G92C5X1"), (3, 4, "word-unused")),
    (("M19", "G95", "Z-.1C360S5"), (4, 0, "feed-missing")),
    (("M19", "G95F.1", "Z-.1C360"), (4, 5, "speed-missing")),
    (("M19", "G95F.1", "Z-.1C359S5"), (4, 5, "c-too-little")),
    (("M19", "G95F.1", "Z-.1C0S5"), (4, 5, "c-too-little")),
    (("M19S5", "G95F.1", "Z-.1"), (4, 0, "spindle-stopped")),
    (("M19", "G96S200", "F5X1C5"), (4, 0, "spindle-stopped")),
    (("M19", "T1", "X1C90"), (4, 0, "tool-first-move")),
    (("M19", "G91", "G02X.1C90R1"), (4, 7, "word-unused")),
]


@pytest.mark.parametrize(("program", "error"), REFUSED, ids=[" ".join(program) for program, _ in REFUSED])
def test_invalid_c_words_are_rejected(program: tuple[str, ...], error: tuple[int, int, str]) -> None:
    assert error in run(*program).errors


@pytest.mark.parametrize("word", ["M19", "M89", "G89"])
def test_machine_without_c_rejects_c_words(word: str) -> None:
    assert run(word, limits=NO_C).errors == [(2, 1, "c-disabled")]


def test_feed_too_fast_for_the_axis_is_rejected() -> None:
    """2 in/rev at 200 rpm is 400 in/min."""
    result = run("G35F2", "G92X0Z0", "M19", "G95F2", "Z-1C180S200", "G94F5Z0", "G36", "G92X0Z0")
    assert (6, 0, "feed-over-speed") in result.errors


def test_feed_up_to_the_axis_maximum_is_accepted() -> None:
    """1.5 in/rev at 200 rpm is 300 in/min, which is its most, and .001 in more is refused."""
    head = ("G35F2", "G92X0Z0", "M19")
    assert "feed-over-speed" not in [code for *_, code in run(*head, "G95F1.5", "Z-1C240S200").errors]
    assert (6, 0, "feed-over-speed") in run(*head, "G95F1.501", "Z-1C240S200").errors


def test_error_states_the_required_degrees() -> None:
    """.3 in at .2 in/rev is one and a half turns."""
    result = run("M19", "G95F.2", "Z-.3C360S5")
    (found,) = [d for d in result.interpreter.diagnostics if d.code == "c-too-little"]
    assert "needs 540" in found.message


def test_turn_after_a_rejected_one_is_checked_from_its_end() -> None:
    """From Z-.3 C360 on, .1 in at .2 in/rev is half a turn."""
    assert [error[0] for error in run("M19", "G95F.2", "Z-.3C360S5", "Z-.4C540").errors] == [4]
    assert [error[0] for error in run("M19", "G95F.2", "Z-.3C360S5", "Z-.4C530").errors] == [4, 5]
