"""Registration of the analyses of scope records and of the drive tests."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from app.compose.extra import Extra

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.desk.page_description import PageEntry
    from app.desk.programs.program_loading import LoadingSteps
    from app.extras.analyses.analyses import Analyses
    from app.extras.analyses.drive_test_model import DriveTests
    from app.scope.scope_model import Scope
    from core.machine.machine_model import Machine

_CHART = ("app.extras.analyses.analyses_chart_view.AnalysisChart",)
_ANALYSES = "app.extras.analyses.analyses.Analyses"
_DRIVE_TESTS = "app.extras.analyses.drive_test_model.DriveTests"


class ScopeAnalyses(Extra):
    """Optional feature with the pages ANALYSES, which the scope opens, and DRIVE TEST."""

    @property
    def pages(self) -> Sequence[PageEntry]:
        from app.desk.page_description import PageEntry

        return (
            PageEntry(
                "ANALYSES",
                "app.extras.analyses.analyses_view.AnalysesPage",
                _ANALYSES,
                later=_CHART,
                after="SHARED PROGRAMS",
            ),
            PageEntry(
                "DRIVE TEST",
                "app.extras.analyses.drive_test_view.DriveTestPage",
                _DRIVE_TESTS,
                later=_CHART,
                after="ANALYSES",
            ),
        )

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        desk.pages.attach_later(_ANALYSES, partial(_analyses, desk, machine))
        desk.pages.attach_later(_DRIVE_TESTS, partial(_drive_tests, desk, machine))


def _scope_of(desk: Desk) -> Scope:
    from app.scope.scope_model import Scope

    scope = desk.pages.find(Scope)
    assert scope is not None
    return scope


def _analyses(desk: Desk, machine: Machine) -> Analyses:
    from app.extras.analyses.analyses import Analyses

    return Analyses(_scope_of(desk), {axis.name: axis for axis in machine.axes}, machine.spindle)


def _drive_tests(desk: Desk, machine: Machine) -> DriveTests:
    from app.extras.analyses.drive_test_model import DriveTests

    return DriveTests(desk, _scope_of(desk), machine)


EXTRA = ScopeAnalyses()
