"""Settings of a conversion, for the command and for the special function CONVERT PROGRAM."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from core.extras.convert.source_options import ConversionOptions, SourceControl

if TYPE_CHECKING:
    from core.machine.machine_model import Machine


@dataclass(frozen=True, slots=True)
class ConversionSettings:
    """Settings for facts that the source program does not contain, such as its unit.

    The value 0 of ``no_point`` and the value None of other settings mean not specified.
    """

    no_point: float = 0.0
    is_metric: bool | None = None
    is_diameter: bool | None = None
    has_front_tool_post: bool = False
    skipped_m_codes: frozenset[int] = frozenset()
    has_comments: bool = True


def make_options(control: SourceControl, settings: ConversionSettings, machine: Machine) -> ConversionOptions:
    """Return the options of a conversion for this machine."""
    return ConversionOptions(
        control,
        no_point=settings.no_point,
        metric=settings.is_metric,
        diameter=settings.is_diameter,
        front=settings.has_front_tool_post,
        skipped_m_codes=settings.skipped_m_codes,
        writes_comments=settings.has_comments,
        rapid=machine.limits.max_feed * 60,
        max_rpm=machine.spindle.max_rpm,
        max_feed_mm_min=machine.limits.max_feed * 60,
        m_codes=frozenset(machine.m_code_outputs),
    )
