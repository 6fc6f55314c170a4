"""Measured parts and trends of a desk: put together and given to it."""

from __future__ import annotations

from collections.abc import Sequence

from app.desk.desk import Desk
from app.extras.quality.parts_data import FEATURE, parts_data
from app.extras.quality.quality_functions import QualityFunctions
from app.extras.quality.sample_plan import SamplePlan
from app.production.parts_watch import PartsWatch
from app.special.special_functions import SpecialFunction
from core.machine.machine_model import Machine


def attach_quality(desk: Desk, machine: Machine) -> None:
    """Give the desk what it measures and remembers of parts."""
    watch = desk.attached(PartsWatch)
    if watch is None:
        return
    watch.book.readers[FEATURE] = parts_data
    plan = SamplePlan(desk, watch)
    watch.plans.append(plan)
    desk.attach(QualityFunctions(lambda: _sections(desk, machine, watch, plan), watch.book.worker))


def _sections(desk: Desk, machine: Machine, watch: PartsWatch, plan: SamplePlan) -> Sequence[SpecialFunction]:
    """Those of the page: the start of the desk is not delayed by loading them."""
    from app.extras.quality.sections_desk import sections

    return sections(desk, machine, watch, plan)
