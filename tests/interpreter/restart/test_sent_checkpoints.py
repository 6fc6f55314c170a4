"""The state at a restart line is sent from the screen to the control."""

from __future__ import annotations

import pickle
from dataclasses import replace

import pytest

from core.interpreter.dialects import SharedProgram
from core.interpreter.restart.program_search import RestartLineSearch
from core.interpreter.restart.restart_point import RestartPoint
from core.interpreter.restart.state_rebuild import OmniturnRestartSearch
from core.interpreter.shared.checkpoint import PassStart
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.source import ProgramSource
from tests.interpreter.restart.test_program_search import lathe, mill

OMNITURN = "G90G94F300\nX1Z1\nX2\nZ2\nM30\n"


@pytest.mark.parametrize(("searched", "line"), [(mill(), 9), (lathe(), 7)], ids=["klartext", "sinumerik"])
def test_restart_point_arrives_with_its_state(
    searched: tuple[SharedProgram, InterpreterSetup], line: int
) -> None:
    """It contains neither the inputs of the screen's setup nor the start of another pass."""
    program, setup = searched
    setup = replace(setup, inputs=lambda terminal: terminal == "TB2-5")
    found = RestartLineSearch(program, setup, lambda _count: None).find_restart_point(line)
    assert isinstance(found, RestartPoint), found
    arrived = pickle.loads(pickle.dumps(PassStart(found.checkpoint, line))).checkpoint
    assert arrived == found.checkpoint
    assert arrived.kept is not None
    parts = arrived.kept.copy_parts(setup)
    assert parts.state.setup is setup
    assert not arrived.kept.copy_parts().state.setup.inputs("TB2-5")


def test_omniturn_restart_point_arrives() -> None:
    search = OmniturnRestartSearch(
        ProgramSource("part.nc", OMNITURN), InterpreterSetup(), lambda _count: None
    )
    found = search.find_restart_point(3, 0, None)
    assert isinstance(found, RestartPoint), found
    assert pickle.loads(pickle.dumps(found.checkpoint)) == found.checkpoint
