"""Chapters of a day at the lathe, each by keys alone. Figures are worked out by hand, in inches from home."""

from __future__ import annotations

import pytest

from app.editor.editor_model import EditorStage
from app.editor.editor_view import EditorPage
from app.screen import page_table
from core.executor.snapshot import MachineState
from tests.screen.day import NEAR, Day, Key
from tests.texts import begins, text

NAME = "pin9"
PROGRAM = """\
G90G94F300G72(PIN OF .9 DIAMETER)
T1
M03S1500
X1.1Z.1
D1X.9
G95F.01Z-.3
X1.1
G94F300Z.5
M01(GAUGE THE .9 AND CORRECT D1)
T2
X1.2Z.1
Z-.4
G95F.004X.8
G94F300X1.2
Z.5
M05
M30"""
# T1 touches a bar of .998 at X .3 of the slide and its face at Z -.5; T2 touches a diameter of .75 at X -.4,
# and at Z -.8 a shoulder .05 in front of the zero of the part.
T1 = (0.3 - 0.499, -0.5)
T2 = (-0.4 - 0.375, -0.8 - 0.05)
# D1: .002 smaller in diameter, .001 away from the chuck.
D1 = (-0.001, 0.001)
# Where the slides stand when the line has been run: half the diameter, tool, correction.
ENDS = {
    4: (0.55 + T1[0], 0.1 + T1[1]),
    5: (0.45 + T1[0] + D1[0], 0.1 + T1[1] + D1[1]),
    6: (0.45 + T1[0] + D1[0], -0.3 + T1[1] + D1[1]),
    7: (0.55 + T1[0] + D1[0], -0.3 + T1[1] + D1[1]),
    8: (0.55 + T1[0] + D1[0], 0.5 + T1[1] + D1[1]),
    11: (0.6 + T2[0], 0.1 + T2[1]),
    12: (0.6 + T2[0], -0.4 + T2[1]),
    13: (0.4 + T2[0], -0.4 + T2[1]),
    14: (0.6 + T2[0], -0.4 + T2[1]),
    15: (0.6 + T2[0], 0.5 + T2[1]),
}


def editor(day: Day) -> EditorPage:
    """The editor, which must be in front, with what is typed proved."""
    page = day.frame.current_page
    assert isinstance(page, EditorPage)
    day.sees(
        lambda: (
            not page.editor.live_proof.is_outdated
            and page.finding_list.findings is page.editor.live_proof.current_findings
        )
    )
    return page


def open_editor(day: Day) -> EditorPage:
    """F3, and the text is there."""
    day.key(Key.Key_F3)
    day.sees(lambda: day.page == page_table.EDITOR)
    page = day.frame.current_page
    assert isinstance(page, EditorPage)
    day.sees(lambda: page.editor.stage is EditorStage.OPEN and bool(page.text_field.toPlainText()))
    return editor(day)


def drives_on(day: Day) -> None:
    """The first key of the day."""
    day.reaches(MachineState.DISABLED)
    day.key(Key.Key_D)
    day.reaches(MachineState.IDLE)


def write_program(day: Day) -> None:
    """F2, a name nobody knows, F3, F1; one line is wrong, and is mended where the margin shows it."""
    day.key(Key.Key_F2)
    day.type(NAME)
    day.key(Key.Key_Return, Key.Key_X, Key.Key_F3)
    assert day.prompt == text("screen.new-file")
    day.key(Key.Key_F1)
    day.sees(lambda: day.page == page_table.EDITOR)
    for number, line in enumerate(PROGRAM.replace("\nX1.1\n", "\nX1.1.5\n").splitlines()):
        if number:
            day.key(Key.Key_Return)
        day.type(line)
    found = editor(day).finding_list.findings.diagnostics
    wrong = next(diagnostic for diagnostic in found if diagnostic.line == 7)
    day.key(Key.Key_F6)
    day.sees(lambda: wrong.message in day.prompt)
    day.key(Key.Key_End, Key.Key_Backspace, Key.Key_Backspace)
    assert editor(day).text_field.toPlainText() == PROGRAM
    assert [d.message for d in editor(day).finding_list.findings.diagnostics if d.line == 7] == []
    day.key(Key.Key_F3)
    day.sees(lambda: day.page == page_table.AUTOMATIC)


def set_tools(day: Day) -> None:
    """F1, F5: to the bar by steps of .1, measured diameter and face typed; the same for T2."""
    day.key(Key.Key_F1, Key.Key_F5, Key.Key_F2)
    for number, downs, lefts, diameter, face in (
        ("1", 3, 5, "1-.002", "0"),
        ("2", -7, 3, ".75", ".1/2"),
    ):
        _step(day, Key.Key_Down if downs > 0 else Key.Key_Up, abs(downs))
        _step(day, Key.Key_Left, lefts)
        day.type("t")
        day.enter(number)
        day.type("x")
        day.enter(diameter)
        day.type("z")
        day.enter(face)
        day.saved()
        assert day.prompt == f"T{number} SAVED"
    tools = day.store.offsets.tool_offsets.read_rows()
    for row, (x, z) in ((tools[1], T1), (tools[2], T2)):
        assert (row.x / 25.4, row.z / 25.4) == (pytest.approx(x, abs=NEAR), pytest.approx(z, abs=NEAR))
    back_to_automatic(day)


def _step(day: Day, key: Key, presses: int) -> None:
    for _ in range(presses):
        day.key(key)
        day.run(0.05)
        day.reaches(MachineState.IDLE)


def back_to_automatic(day: Day) -> None:
    """F1 and F2, from any page; the program is proved anew by then."""
    day.key(Key.Key_F1, Key.Key_F2)
    assert day.page == page_table.AUTOMATIC
    asks = f"LINE {day.shot.interrupted_line} WAS INTERRUPTED" if day.shot.interrupted_line else "TO START"
    day.sees(lambda: asks in day.prompt)  # a warning of the first move may come before it


def correct(day: Day, x: str, z: str = "") -> None:
    """F9, D1, X and Z, R as it is; back by Esc."""
    day.key(Key.Key_F9)
    day.enter("1", x, z, "")
    day.sees(lambda: not day.desk.offset_book.is_saving)
    # What the correction makes of the next part may be known, and shown, by then.
    assert begins(day.prompt, "screen.saved", names="D1") or begins(day.prompt, "screen.no-next-part")
    day.key(Key.Key_Escape)
    assert day.page == page_table.AUTOMATIC


def stand_at(day: Day, place: tuple[float, float]) -> None:
    """The slides really are there."""
    assert day.slides == (pytest.approx(place[0], abs=NEAR), pytest.approx(place[1], abs=NEAR))
