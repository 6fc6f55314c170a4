"""Registration of the optional feature for analyses of scope records and for drive tests."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.desk.page_description import PageDescription
    from app.desk.programs.program_loading import LoadingSteps
    from app.extras.analyses.analyses import AnalysesModel
    from app.extras.analyses.drive_test_model import DriveTestModel
    from app.scope.scope_model import ScopeModel
    from core.machine.machine_model import Machine

_CHART = ("app.extras.analyses.analyses_chart_view.AnalysisChart",)
_ANALYSES = "app.extras.analyses.analyses.AnalysesModel"
_DRIVE_TESTS = "app.extras.analyses.drive_test_model.DriveTestModel"


class AnalysesExtra(OptionalFeature):
    """Optional feature with the pages ANALYSES (opened from the scope) and DRIVE TEST."""

    @property
    def page_descriptions(self) -> Sequence[PageDescription]:
        """Return the descriptions of the pages ANALYSES and DRIVE TEST."""
        from app.desk.page_description import PageDescription

        return (
            PageDescription(
                "ANALYSES",
                "app.extras.analyses.analyses_view.AnalysesPage",
                _ANALYSES,
                deferred_modules=_CHART,
                preceding_page="SHARED PROGRAMS",
            ),
            PageDescription(
                "DRIVE TEST",
                "app.extras.analyses.drive_test_view.DriveTestPage",
                _DRIVE_TESTS,
                deferred_modules=_CHART,
                preceding_page="ANALYSES",
            ),
        )

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Register the models of the analyses and the drive test. Each model is created at its first use."""
        desk.page_registry.attach_lazy_model(_ANALYSES, partial(_analyses, desk, machine))
        desk.page_registry.attach_lazy_model(_DRIVE_TESTS, partial(_drive_tests, desk, machine))


def _scope_of(desk: Desk) -> ScopeModel:
    from app.scope.scope_model import ScopeModel

    scope = desk.page_registry.find_model(ScopeModel)
    assert scope is not None
    return scope


def _analyses(desk: Desk, machine: Machine) -> AnalysesModel:
    from app.extras.analyses.analyses import AnalysesModel

    return AnalysesModel(_scope_of(desk), {axis.name: axis for axis in machine.axes}, machine.spindle)


def _drive_tests(desk: Desk, machine: Machine) -> DriveTestModel:
    from app.extras.analyses.drive_test_model import DriveTestModel

    return DriveTestModel(desk, _scope_of(desk), machine)


EXTRA = AnalysesExtra()
