"""Proof of a written program: its reader's steps are compared with the elementary blocks of the source."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import zip_longest
from math import inf

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.omniturn_writer import WrittenLine
from core.extras.convert.path_steps import MOVE_KINDS, PathStep, StepKind
from core.extras.convert.proof.compared_steps import drop_idle, drop_repeated_speeds
from core.extras.convert.proof.conversion_proof import (
    SPEED_RESOLUTION,
    PathComparison,
    Proof,
    make_target_error,
)
from core.extras.convert.source_options import ConversionOptions, SourceControl
from core.extras.convert.source_reader import read_source
from core.extras.convert.targets.omniturn_steps import InterpretedProgram
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import Diagnostic, Severity

_HARMLESS = frozenset({"nose-offset"})
"""Warnings of the reader about a written program that do not change its meaning."""


def prove_by_reading(
    lines: Sequence[WrittenLine],
    control: SourceControl,
    program: InterpretedProgram,
    *,
    resolution_mm: float,
    feed_resolution_mm: float = 0.0,
    speed_resolution: float = SPEED_RESOLUTION,
) -> Proof:
    """Read a written program and compare its steps with the blocks of the source program.

    ``resolution_mm`` and ``feed_resolution_mm`` are the resolutions of the written coordinates in mm and of
    F in mm. ``speed_resolution`` is the resolution of S in rpm and in the unit of the surface speed. The
    maximum speeds, the nose compensation of each move, and all moves and actions must be equal.
    """
    options = ConversionOptions(control, max_rpm=inf, max_feed_mm_min=inf)
    state, findings = read_source([each.text for each in lines], options)
    errors = [each for each in findings if _is_difference(each, lines)]
    if errors:
        text = "".join(f"{each.text}\n" for each in lines)
        numbers = [each.source_line_number for each in lines]
        return Proof(tuple(make_target_error(each, text, numbers) for each in errors))
    steps = [replace(each, line=lines[each.line - 1].source_line_number) for each in state.steps]
    different = _find_nose_difference(program.blocks, steps) or _find_speed_difference(
        program.steps, steps, speed_resolution / 2 + 1e-6
    )
    if different is not None:
        return Proof((different,))
    blocks = drop_repeated_speeds(program.blocks, resolution=speed_resolution, is_metric=program.is_metric)
    comparison = PathComparison(
        blocks, steps, metric=program.is_metric,
        resolution_mm=resolution_mm, feed_resolution_mm=feed_resolution_mm,
        speed_resolution=speed_resolution,
        has_source_blocks=True, has_thread_cycles=False,
    )  # fmt: skip
    return comparison.compare_steps()


def _is_difference(found: Diagnostic, lines: Sequence[WrittenLine]) -> bool:
    """Return whether a finding of the reader means that the written program is not as intended."""
    if found.severity is Severity.NOTE or found.code in _HARMLESS:
        return False
    text = lines[found.line - 1].text if found.line else ""
    is_path_tolerance = found.code == "left-out" and text.startswith("G64 ")
    is_stored_point = found.code == "home-position" and "G30" in text
    return not is_path_tolerance and not is_stored_point


def _find_nose_difference(blocks: Sequence[Block], steps: Sequence[PathStep]) -> Diagnostic | None:
    """Return the first difference between the nose compensation of the moves, and at the end."""
    made = []
    code = 40
    for step in steps:
        if step.kind is StepKind.NOSE:
            code = round(step.number)
        elif step.kind in MOVE_KINDS:
            made.append((step.line, code))
    made.append((steps[-1].line, code))
    kept = drop_idle(blocks, has_home_moves=True)
    moves = [each for each in kept if each.moves and each.modal.tool]
    wanted = [each.modal.compensation_code for each in [*moves, blocks[-1]]]
    for (line, code), want in zip(made, wanted, strict=False):
        if code != want:
            error = make_error(
                line, 0, "proof-differs", what="the nose compensation", made=f"G{code}", wanted=f"G{want}"
            )
            return error.diagnostic
    return None


def _find_speed_difference(
    source: Sequence[PathStep], steps: Sequence[PathStep], near: float
) -> Diagnostic | None:
    """Return the first difference of more than ``near`` rpm between the maximum spindle speeds."""
    wanted, made = _list_maximum_speeds(source), _list_maximum_speeds(steps)
    for (line, want), (_, speed) in zip_longest(wanted, made, fillvalue=(0, 0.0)):
        if abs(speed - want) > near:
            error = make_error(
                line,
                0,
                "proof-differs",
                what="the maximum spindle speed",
                made=f"{speed:g}",
                wanted=f"{want:g}",
            )
            return error.diagnostic
    return None


def _list_maximum_speeds(steps: Sequence[PathStep]) -> list[tuple[int, float]]:
    """Return each new maximum speed under G96 in rpm, with its line."""
    found: list[tuple[int, float]] = []
    for step in steps:
        spindle = step.spindle
        is_limited = step.kind is StepKind.SPINDLE and spindle.is_css and spindle.direction
        if is_limited and (not found or found[-1][1] != spindle.max_rpm):
            found.append((step.line, spindle.max_rpm))
    return found
