"""MDI in the machine's own language: what a block does, what it leaves to the next, what is refused."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import atan2, cos, degrees, radians

import pytest

from app.compose.machine.machine_files import load_named_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.control_status import make_modal_state_after_cancel
from core.interpreter.dialects import interpret_mdi_line
from core.interpreter.shared.actions import ToolChange
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.source import Dialect, ProgramSource
from tests.texts import text as wording

MILL, LATHE = "ac-table-mill", "sinumerik-modulo"


class Mdi:
    """A machine at which lines are typed one after the other; each runs to its end."""

    def __init__(self, machine: str, tools: Mapping[int, ToolOffset] | None = None) -> None:
        self.machine = load_named_machine(machine)
        self.tools = dict(tools or {})
        self.point = Checkpoint(ModalState(metric=True))
        self.at: tuple[float, ...] = (0.0,) * len(self.machine.axes)

    def enters(self, text: str) -> str:
        """The block runs, or the code of what it is refused for."""
        setup = replace(
            create_power_up_setup(self.machine, tool_offsets=self.tools, secondary_offsets={}),
            start=self.at,
            begin=PassStart(self.point, is_mdi_line=True),
        )
        line = interpret_mdi_line(ProgramSource("MDI", text, Dialect(self.machine.mdi_language)), setup)
        blocks = list(line.generate_blocks(stops_at_first_error=True))
        if line.has_errors:
            return line.diagnostics[0].code
        self.at = blocks[-1].machine_end if blocks else self.at
        self.point = line.checkpoint
        return ""

    def runs(self, *lines: str) -> None:
        for text in lines:
            assert self.enters(text) == "", text

    def line(self, key: str) -> str:
        """What is told of a group of functions."""
        assert self.point.kept is not None
        return dict(self.point.kept.state_lines)[key]


@pytest.fixture
def mill() -> Mdi:
    return Mdi(MILL, {5: ToolOffset(z=80.0, nose_radius=6.0)})


@pytest.fixture
def lathe() -> Mdi:
    return Mdi(LATHE)


# --- what stands between two lines ----------------------------------------------------------------------


def test_mdi_line_starts_with_manually_switched_state(lathe: Mdi) -> None:
    lathe.runs("M8")
    assert (lathe.point.modal.coolant, lathe.line("coolant")) == (True, "M8")
    by_hand = lathe.point.modal._replace(coolant=False, outputs=frozenset({"catcher"}))
    lathe.point = lathe.point._replace(modal=by_hand)
    lathe.runs("G4 F0.1")
    assert (lathe.point.modal.coolant, lathe.point.modal.outputs) == (False, {"catcher"})
    assert (lathe.line("coolant"), lathe.line("outputs")) == ("M9", "CATCHER")


def test_mill_retains_tool_plane_and_parameters_between_lines(mill: Mdi) -> None:
    # Zero at 230, 210, -350; L 80: Z+100 is -350 + 100 + 80 = -170. A+30 about the line Y 250, Z -430 at X.
    mill.runs("TOOL CALL 5 Z S2000", "L Z+100 FMAX M3", "Q1 = 30", "PLANE AXIAL A+Q1 C+0 TURN FMAX")
    assert mill.at == pytest.approx((0.0, 0.0, -170.0, 30.0, 0.0))
    assert mill.line("plane") == "A+30.000  C+0.000"
    mill.runs("L X+10 F500")
    assert mill.at[0] == pytest.approx(240.0)
    assert (mill.line("feed"), mill.line("spindle")) == ("F500", "M3")


def test_defined_cycle_can_be_called_by_later_line(mill: Mdi) -> None:
    drilling = "CYCL DEF 200 Q200=+2 Q201=-10 Q206=+150 Q202=+5 Q210=+0 Q203=+0 Q204=+50 Q211=+0"
    mill.runs("TOOL CALL 5 Z S2000", "L X+0 Y+0 Z+50 FMAX M3", drilling, "CYCL CALL")
    assert mill.at[2] == pytest.approx(-350.0 + 50.0 + 80.0)  # Q204, the second set-up clearance


def test_tool_measured_again_is_used_by_next_line(mill: Mdi) -> None:
    mill.runs("TOOL CALL 5 Z S2000")
    mill.tools[5] = ToolOffset(z=81.5, nose_radius=6.0)
    mill.runs("L Z+100 FMAX")
    assert mill.at[2] == pytest.approx(-168.5)


def test_axes_jogged_between_lines_start_at_their_position(mill: Mdi) -> None:
    mill.runs("TOOL CALL 5 Z S2000", "L X+0 Y+0 FMAX")
    mill.at = (7.0, 8.0, -9.0, 0.0, 0.0)
    mill.runs("L IX+1 FMAX")
    assert mill.at == pytest.approx((8.0, 8.0, -9.0, 0.0, 0.0))


def test_mdi_line_starts_with_state_left_by_program(mill: Mdi) -> None:
    mill.point = Checkpoint(make_modal_state_after_cancel(ModalState(tool=5, rpm=1200.0, spindle=1)))
    mill.runs("L Z+0 FMAX")
    assert mill.at[2] == pytest.approx(-270.0)
    assert (mill.line("tool"), mill.line("spindle"), mill.line("plane")) == ("T5 Z", "M5", "")


def test_sinumerik_lathe_retains_modes_and_parameters_between_lines(lathe: Mdi) -> None:
    lathe.runs("G0 X20 Z5", "R1=4", "G1 X=R1*2 F100", "M3 S500", "G91 G95 Z-1 F0.2", "X40")
    # DIAMON: X8 is a radius of 4; G91 X40 adds 20 to it.
    assert lathe.at == pytest.approx((24.0, 4.0, 0.0))
    assert (lathe.line("distance"), lathe.line("feed")) == ("G91", "G95 F0.2")


def test_a_variable_of_def_outlives_its_line(lathe: Mdi) -> None:
    lathe.runs("DEF REAL DEPTH=3", "G0 Z=-DEPTH")
    assert lathe.at[1] == pytest.approx(-3.0)


def test_a_lathe_stays_in_transmit_from_line_to_line() -> None:
    """X20 Y15 is 25 mm from the axis; what was jogged meanwhile, X20 and C30, is X17.32 Y-10 of the face."""
    live = Mdi("sinumerik-live", {1: ToolOffset()})
    live.runs("T1 D1", "G0 DIAMOF G17 X30 Z5", "TRANSMIT", "G1 X20 Y15 F300")
    assert live.at == pytest.approx((25.0, 5.0, -degrees(atan2(15.0, 20.0))))
    live.at = (20.0, 5.0, 30.0)
    live.runs("G91 G1 Y=IC(10)")
    assert live.at == pytest.approx((20.0 * cos(radians(30.0)), 5.0, 0.0), abs=1e-9)
    live.runs("TRAFOOF", "G90 G0 X40 C90")
    assert live.at == pytest.approx((40.0, 5.0, 90.0))


def test_block_rejected_in_transmit_is_rejected_in_mdi() -> None:
    live = Mdi("sinumerik-live", {1: ToolOffset()})
    live.runs("T1 D1", "G0 DIAMOF G17 X30 Z5", "S300 M3")
    assert live.enters("TRANSMIT") == "transformation"
    live.runs("M5", "TRANSMIT")
    assert live.enters("C90") == "transformation"


def test_tool_call_is_one_action_block(mill: Mdi) -> None:
    setup = replace(
        create_power_up_setup(mill.machine, tool_offsets=mill.tools, secondary_offsets={}),
        start=mill.at,
        begin=PassStart(mill.point, is_mdi_line=True),
    )
    line = interpret_mdi_line(ProgramSource("MDI", "TOOL CALL 5 Z", Dialect.KLARTEXT), setup)
    assert [block.action for block in line.generate_blocks()] == [ToolChange(5)]


# --- refusals -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        *("BEGIN PGM A MM", "END PGM A MM", "BLK FORM 0.1 Z X+0 Y+0 Z-10", "LBL 1", "CALL LBL 1 REP2"),
        *("FN 9: IF +Q1 EQU +0 GOTO LBL 1", "CALL PGM A.H", "RND R2", "CHF 2", "L X+10 RL", "L X+10 Y+0 RR"),
        *("APPR LT X+0 Y+0 LEN10 RL", "DEP LT LEN10", "/ L X+10", "CYCL DEF 12.1 PGM A.H"),
    ],
)
def test_block_that_needs_other_blocks_is_rejected_on_mill(mill: Mdi, text: str) -> None:
    assert mill.enters(text) == "not-alone-mdi"
    assert mill.point.kept is None  # it has left nothing


@pytest.mark.parametrize(
    "text",
    ["GOTOF END1", "IF R1==1 GOTOF END1", "ENDIF", "WHILE R1<3", "RINGBORE P5", "/ X10", "G1 X9 RND=2"],
)
def test_block_that_needs_other_blocks_is_rejected_on_lathe(lathe: Mdi, text: str) -> None:
    assert lathe.enters(text) == "not-alone-mdi"


def test_failed_line_leaves_state_unchanged(mill: Mdi) -> None:
    mill.runs("TOOL CALL 5 Z S2000", "Q1 = 7")
    assert mill.enters("PLANE AXIAL A+500 TURN FMAX") != ""
    mill.runs("L X+Q1 FMAX")
    assert mill.at[0] == pytest.approx(237.0)


def test_words_of_another_language_are_rejected(mill: Mdi, lathe: Mdi) -> None:
    assert mill.enters("G1 X10 F100") != ""
    assert lathe.enters("L X+10 Y+5 FMAX") != ""


def test_a_cut_without_a_feed_is_refused_as_in_a_program(mill: Mdi, lathe: Mdi) -> None:
    mill.runs("TOOL CALL 5 Z S2000")
    assert mill.enters("L X+10") == wording("desk.feed-missing")
    assert lathe.enters("G1 X10") != ""
