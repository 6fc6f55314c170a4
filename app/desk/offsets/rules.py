"""What a typed value does to a secondary offset, in the control's words."""

from __future__ import annotations

from enum import IntEnum

from app.desk.formats import length
from app.desk.offsets.figures import Mode, added, to_mm
from app.desk.words import tr
from core.store.rows import RADIUS_MAX, SECONDARY_REACH


class Step(IntEnum):
    """What is asked."""

    NUMBER = 0
    X = 1
    Z = 2
    R = 3


def question(step: Step) -> str:
    """The prompt of this step; attested but for R."""
    words = (tr("Offset Number?"), tr("X DIAMETER CORRECTION?"), tr("Z CORRECTION?"), tr("R?"))
    return words[step]


def value(step: Step, old: float, typed: float, mode: Mode) -> float:
    """What ``old`` (mm) becomes: X halved and added, Z added, R becomes the value."""
    if step is Step.R:
        return to_mm(typed, mode.metric)
    return added(old, typed / 2 if step is Step.X else typed, mode.metric)


def refusal(step: Step, number: int, mm: float, mode: Mode) -> str:
    """Why a value is not kept, said in the unit of the entry; empty when it is."""
    low, high = (0.0, RADIUS_MAX) if step is Step.R else (-SECONDARY_REACH, SECONDARY_REACH)
    if low <= mm <= high:
        return ""
    text = tr("{name} would become {value} {unit}; it may be {low}…{high}")
    return text.format(
        name=f"D{number} {step.name}",
        value=length(mm, mode.metric),
        unit=mode.name,
        low=f"{low / mode.unit:g}",
        high=f"{high / mode.unit:g}",
    )
