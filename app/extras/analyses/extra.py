"""Registers the analyses of scope records, and the drive tests."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from app.compose.extra import Extra
from app.desk.page_description import PageEntry

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.desk.programs.program_loading import LoadingSteps
    from app.extras.analyses.analyses import Analyses
    from app.extras.analyses.drive_test_model import DriveTests
    from app.scope.scope_model import Scope
    from core.machine.machine_model import Machine

_CHART = ("app.extras.analyses.analyses_chart_view.AnalysisChart",)
ANALYSES = PageEntry(
    "ANALYSES",
    "app.extras.analyses.analyses_view.AnalysesPage",
    "app.extras.analyses.analyses.Analyses",
    later=_CHART,
    after="SHARED PROGRAMS",
)
DRIVE_TEST = PageEntry(
    "DRIVE TEST",
    "app.extras.analyses.drive_test_view.DriveTestPage",
    "app.extras.analyses.drive_test_model.DriveTests",
    later=_CHART,
    after="ANALYSES",
)


class ScopeAnalyses(Extra):
    """The page ANALYSES, which the scope opens, and the page DRIVE TEST."""

    pages = (ANALYSES, DRIVE_TEST)

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        desk.attach_later(ANALYSES.model, partial(_analyses, desk, machine))
        desk.attach_later(DRIVE_TEST.model, partial(_drive_tests, desk, machine))


def _scope_of(desk: Desk) -> Scope:
    from app.scope.scope_model import Scope

    scope = desk.attached(Scope)
    assert scope is not None
    return scope


def _analyses(desk: Desk, machine: Machine) -> Analyses:
    from app.extras.analyses.analyses import Analyses

    return Analyses(_scope_of(desk), {axis.name: axis for axis in machine.axes}, machine.spindle)


def _drive_tests(desk: Desk, machine: Machine) -> DriveTests:
    from app.extras.analyses.drive_test_model import DriveTests

    return DriveTests(desk, _scope_of(desk), machine)


EXTRA = ScopeAnalyses()
