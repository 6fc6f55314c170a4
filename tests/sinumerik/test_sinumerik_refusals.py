"""Bad input: what is wrong, in which block, and that no block of it is started."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.diagnostics import Severity
from tests.sinumerik.lathe import LINEAR, MODULO, good, refused, run, setup


def without_c() -> InterpreterSetup:
    return setup(replace(MODULO, is_c_enabled=False))


def one_speed() -> InterpreterSetup:
    return setup(replace(MODULO, spindle=replace(MODULO.spindle, controlled=False)))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("N30 G0 C=DC(360)", "16830"),
        ("N30 G0 C=ACP(-1)", "16830"),
        ("N30 G0 C=ACN(400)", "16830"),
        ("N30 G0 C-15", "16830"),
        ("N30 G0 C=DC()", "12080"),
        ("N30 G0 C=DC(10", "12080"),
        ("N30 G0 C=XY(10)", "12080"),
        ("N30 G0 C=DC 10", "12080"),
        ("N30 G0 X=DC(10)", "16800"),
        ("N30 G0 X=ACP(10)", "16810"),
        ("N30 G0 Z=ACN(10)", "16820"),
        ("N30 G1 C90", "10860"),
        ("N30 G1 X5", "10860"),
        ("N30 G95 G1 X5 F0.2", "g95-spindle-stopped"),
        ("N30 G95 G1 C5 F0.2", "g95-spindle-stopped"),
        ("N30 G4 S30", "dwell-spindle-stopped"),
        ("N30 G4 S30 X10", "own-block"),
        ("N30 G4", "own-block"),
        ("N30 G4 F1 S1", "own-block"),
        ("N30 G0 G4 F1", "own-block"),
        ("N30 TRANS C30 X10 G1", "own-block"),
        ("N30 G0 G1 X10", "12060"),
        ("N30 G54 G55 G0 X10", "12060"),
        ("N30 G90 G91 X10", "12060"),
        ("N30 DIAMON DIAMOF", "12060"),
        ("N30 G0 C10 C20", "12010"),
        ("N30 G1 X1 X=IC(2) F1", "12010"),
        ("N30 G1 Z0 F0", "not-positive"),
        ("N30 G1 Z0 F-100", "not-positive"),
        ("N30 M99", "m-unknown"),
        ("N30 M98", "m-unknown"),
        ("N30 G33 Z5", "thread-lead-missing"),
        ("N30 G33 Z5 K1", "g95-spindle-stopped"),
        ("N30 G999", "12470"),
        ("N30 M3 M5 S1", "m-conflict"),
        ("N30 M0 M30", "m-conflict"),
        ("N30 D2", "17180"),
        ("N30 T1.5", "12080"),
        ("N30 T1 D10", "12080"),
        ("N30 G1 Y5 F1", "not-in-subset"),
        ("N30 CYCLE95(1,2)", "61605"),
        ("N30 CYCLE84(1,2)", "cycle-plane"),
        ("N30 GOTOF WEITER", "14080"),
        ("N30 IF R1>0", "12640"),
        ("N30 ENDFOR", "12640"),
        ("N30 IF 1 GOTOB N99", "14080"),
        ("N30 R1=1/0", "arithmetic"),
        ("N30 R1=SQRT(-1)", "arithmetic"),
        ("N30 R1=(2+3", "12080"),
        ("N30 R1=2+", "12080"),
        ("N30 DEPTH=5", "12550"),
        ("N30 DEF STRING[5] A1", "12080"),
        ('N30 MSG("HELLO"', "12080"),
        ("N30 FOR R1=1", "12080"),
        ("N30 STOPRE G1 X5", "12080"),
        ("N30 SPOS=360", "16830"),
        ("N30 SPOS=DC(-1)", "16830"),
        ("N30 SPOS=IC(20)", "spindle-position"),
        ("N30 SPOS=IC(360)", "spindle-position"),
        ("N30 M70", "spindle-position"),
        ("N30 TRANSMIT(2)", "14401"),
        ("N30 M3", "speed-missing"),
        ("N30 S-100 M3", "speed-sign"),
        ("N30 S9000 M3", "speed-range"),
        ("N30 LIMS=0", "not-positive"),
        ("N30 G0 X5 I3", "word-unused"),
        ("N30 G1 X5 F1 AR=90", "word-unused"),
        ("N30 G0 X", "12080"),
        ("N30 G0 X 5", "12080"),
        ("N30 G0 X5..3", "12080"),
        ("N30 G0 X=", "12080"),
        ("N30 G0 X5*2", "12080"),
        ("N30 G0 X=AC(5)Z=IC", "12080"),
        ("N30 G0 X5 N40", "12080"),
        ("N30 G0 CR5", "12080"),
        ("N30 G0 (X5)", "12080"),
        ("N30 G1.5 X2", "12080"),
        ("N30 G0 F=DC(2)", "12080"),
        ("N30 G1 CHF=2 C5 F1", "corner-without-move"),
        ("N30 G96 S1 G1 X5 F1 G97", "12060"),
    ],
)
def test_program_error_is_reported_with_block_and_alarm_code(text: str, code: str) -> None:
    error = refused(f"G0 X1\n{text}")
    assert error.code == code
    assert error.line == 2
    assert error.column >= 1
    assert "channel 1 block N30" in error.message
    assert error.hint
    if code.isdigit():
        assert error.message.startswith(f"Alarm {code}: ")


def test_error_message_names_the_axis() -> None:
    assert refused("N30 G0 C=DC(360)").message.startswith("Alarm 16830: channel 1 block N30 axis C: ")
    assert "axis X" in refused("N30 G0 X=DC(10)").message


@pytest.mark.parametrize(
    ("text", "name"), [("G0 C-1", "in line 1"), ("WEG: G0 C-1", "WEG"), (":7 G0 C-1", ":7")]
)
def test_error_message_names_block_by_number_label_or_line(text: str, name: str) -> None:
    assert f"block {name} axis C" in refused(text).message


@pytest.mark.parametrize("text", ["G0 C359.999", "G0 C=DC(0)", "g0 c = dc( 0 )", "G91\nG0 C=AC(10)"])
def test_valid_blocks_are_accepted(text: str) -> None:
    assert len(good(text)) == 1


def test_erroneous_block_and_later_blocks_are_not_run() -> None:
    passed = run("G0 Z1\nG0 C400\nG0 Z2")
    assert [block.line for block in passed.blocks] == [1]


def test_every_error_is_reported_in_one_pass() -> None:
    found = run("G0 C400\nG0 X=DC(1)\nM99\nC=DC()\nG0 Z3").errors
    assert [each.code for each in found] == ["16830", "16800", "m-unknown", "12080"]


def test_consequential_errors_are_not_reported() -> None:
    """Where the machine stands after the bad block nobody knows, so the arc behind it may be right."""
    assert refused("G0 X=DC(20) Z0\nG3 X60 Z-20 I0 K-20 F100").code == "16800"
    assert refused("G1 X=DC(20) F100\nZ0").code == "16800"


def test_c_words_are_rejected_without_third_axis() -> None:
    for text in ("G0 C10", "G1 X5 C=IC(3) F1", "TRANS C5"):
        error = refused(text, without_c())
        assert error.code == "unknown-axis"
        assert "no third axis" in error.message
    assert good("G0 X10 Z5", without_c())


@pytest.mark.parametrize("text", ["G4 S30", "S500 M3", "G96 S100", "LIMS=100"])
def test_speed_words_are_rejected_without_controlled_spindle(text: str) -> None:
    assert refused(f"N30 {text}", one_speed()).code == "no-controlled-spindle"


def test_single_speed_spindle_starts_without_s() -> None:
    assert run("M3\nG0 X5", one_speed()).blocks[-1].rpm == pytest.approx(MODULO.spindle.max_rpm)


def test_spindle_start_and_dwell_are_rejected_at_zero_speed() -> None:
    assert refused("S0\nN5 M3").code == "speed-missing"
    assert refused("S100 M3\nS0\nN30 G4 S2").code == "dwell-spindle-stopped"


def test_m5_in_block_with_feed_per_revolution_is_rejected() -> None:
    """M5 acts before the axes move, so the move has no speed to go by."""
    assert refused("S500 M3 G95 F0.1\nN30 G1 Z0 M5").code == "g95-spindle-stopped"


def test_arcs_outside_g18_are_rejected() -> None:
    assert refused("G17\nG2 X5 Z5 CR=50 F1").code == "arc-plane"


def test_block_of_more_than_512_characters_is_rejected() -> None:
    assert refused("G0 X1 ;" + "x" * 510).code == "12080"
    assert good("G0 X1 ;" + "x" * 500)


def test_more_than_five_m_codes_are_rejected() -> None:
    assert refused("M0 M0 M3 M3 M30 S1").code in {"m-conflict", "m-too-many"}


def test_error_for_linear_axis_states_its_range() -> None:
    error = refused("N30 G0 C400", setup(LINEAR))
    assert error.code == "10720"
    assert "-360 to +360" in error.message


@pytest.mark.parametrize(
    ("block", "named"), [("M80", "M80"), ("M9 M50", "M50"), ("M50 M80 M81", "M50 M80 M81"), ("M138", "M138")]
)
def test_unknown_m_functions_are_reported_once_each_with_remedy(block: str, named: str) -> None:
    """The control itself raises no alarm; the lines that bind the code are told letter by letter."""
    passed = run(f"N10 G0 X20 Z5\nN20 {block}\nN30 {block}\nN40 G0 X30")
    assert passed.errors == []
    assert passed.moves[-1].mx == 15.0
    told = [(each.line, each.code, each.severity) for each in passed.found]
    assert told == [(2, "m-unanswered", Severity.WARNING)] * len(named.split())
    for each, code in zip(passed.found, named.split(), strict=True):
        number = code.removeprefix("M")
        assert f"{code} is a machine-builder code" in each.message
        assert f'{number} = {{ output = "NAME", on = true }} under [m_codes]' in each.hint
        assert f"{number} = {{ ignored = true }}" in each.hint


def test_m_functions_that_the_machine_file_ignores_do_nothing() -> None:
    limits = replace(setup().limits, ignored_m_codes=frozenset({80}))
    passed = run("M80\nG0 X30\nM80", replace(setup(), limits=limits))
    assert [(each.line, each.code, each.severity) for each in passed.found] == [
        (1, "no-effect", Severity.NOTE)
    ]
    assert len(passed.blocks) == 1


def test_ineffective_switch_off_words_are_accepted_and_switch_on_rejected() -> None:
    """No transformation is ever on, and no other language."""
    assert run("G290\nTRAFOOF\nG0 X20 Z5").found == []
    assert refused("N10 G291").code == refused("N10 TRAANG").code == "not-in-subset"
    assert refused("N10 G290 G291").code == "not-in-subset"
    assert refused("N10 TRAFOOF TRAFOOF").code == "12060"
