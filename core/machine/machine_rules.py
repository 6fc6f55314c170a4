"""What must hold between the values of a machine file: rules, each checked where its values are good."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import combinations
from typing import NamedTuple

from core.table_schema import Finding, Unit, Values, shown


class Rule(NamedTuple):
    """``wrong`` answers what was expected at ``path``, or nothing; it runs when ``needs`` are all there."""

    path: str
    needs: tuple[str, ...]
    wrong: Callable[[Values], str]


def broken(values: Values) -> Iterator[Finding]:
    """A finding for every rule that the good values break."""
    for rule in RULES:
        if values.has(rule.path, *rule.needs) and (expected := rule.wrong(values)):
            yield Finding(rule.path, "", expected, "broken-rule")


def _below(path: str, limit: str, why: str, unit: Unit) -> Rule:
    """``path`` may not be over ``limit``."""

    def wrong(values: Values) -> str:
        value, bound = values.number(path), values.number(limit)
        if value <= bound * (1 + 1e-9):
            return ""
        inch = bool(values.inch)
        return f"{shown(value, unit, inch)} is over {limit} = {shown(bound, unit, inch)}; {why}"

    return Rule(path, (limit,), wrong)


def _home_inside(axis: str) -> Rule:
    path = f"axis.{axis}.travel"

    def wrong(values: Values) -> str:
        low, high = values.pair(path)
        return "" if low <= 0.0 <= high else "travel counts from home, so 0 must lie inside it"

    return Rule(path, (), wrong)


def _fixed_points(axis: str) -> Rule:
    path = f"axis.{axis}.fixed_points"

    def wrong(values: Values) -> str:
        points, (low, high) = values.numbers(path), values.pair(f"axis.{axis}.travel")
        if len(points) > 1 and values.text("machine.kind") != "lathe":
            return "a mill has one a slide, from which M92 counts; G75 with up to four is of lathes"
        outside = next((point for point in points if not low <= point <= high), None)
        if outside is None:
            return ""
        inch = bool(values.inch)
        point, ends = (
            shown(outside, Unit.LENGTH, inch),
            (shown(end, Unit.LENGTH, inch) for end in (low, high)),
        )
        return f"{point} lies outside axis.{axis}.travel, {' to '.join(ends)}; the slide cannot go there"

    return Rule(path, (f"axis.{axis}.travel", "machine.kind"), wrong)


def _jog_run_on(axis: str) -> Rule:
    """A key held by nobody: lease · vmax + vmax² / 2a is how far the slide still goes."""
    vmax, amax = f"axis.{axis}.vmax", f"axis.{axis}.amax"

    def wrong(values: Values) -> str:
        v = values.number(vmax)
        run_on = values.number("machine.lease_ms") * v + v * v / (2 * values.number(amax))
        limit = values.number("limits.clearance")
        if run_on <= limit * (1 + 1e-9):
            return ""
        inch = bool(values.inch)
        far, near = shown(run_on, Unit.LENGTH, inch), shown(limit, Unit.LENGTH, inch)
        return f"lets {axis} run on {far} at vmax, over limits.clearance = {near}; shorten the lease"

    return Rule("machine.lease_ms", (vmax, amax, "limits.clearance"), wrong)


def _corner_tolerance(axis: str) -> Rule:
    """Joints are moved by a count on each slide whatever is said: a smaller tolerance would be exceeded."""
    path, count = "limits.corner_tolerance", f"axis.{axis}.count"

    def wrong(values: Values) -> str:
        said, least = values.number(path), math.sqrt(2.0) * values.number(count)
        if said == 0.0 or said >= least * (1 - 1e-9):
            return ""
        inch = bool(values.inch)
        least_shown = shown(least, Unit.LENGTH, inch)
        return f"rounding to {count} alone takes {least_shown}; state as much or more, or leave it out"

    return Rule(path, (count,), wrong)


def _homing(axis: str) -> Rule:
    path = f"axis.{axis}.absolute"

    def wrong(values: Values) -> str:
        known = values.flag(path) or values.stated(f"axis.{axis}.home.order")
        known = known or (axis == "C" and values.text("machine.kind") == "lathe")  # M19 finds it
        return "" if known else f"an axis that is not absolute needs axis.{axis}.home = {{ order, speed }}"

    return Rule(path, ("machine.kind",), wrong)


def _home_orders() -> tuple[Rule, ...]:
    """Axes home one after the other."""

    def rule(one: str, other: str) -> Rule:
        def wrong(values: Values) -> str:
            same = values.number(f"axis.{one}.home.order") == values.number(f"axis.{other}.home.order")
            return f"{one} and {other} home one after the other; give them different orders" if same else ""

        return Rule(f"axis.{other}.home.order", (f"axis.{one}.home.order",), wrong)

    return tuple(rule(one, other) for one, other in combinations("XYZABC", 2))


def _timeout(values: Values) -> str:
    needed = values.pair("spindle.rpm")[1] / values.number("spindle.accel_rpm_s")
    needed += values.number("spindle.at_speed_s")
    if values.number("spindle.timeout_s") > needed:
        return ""
    return f"reaching the highest speed takes {needed:.3g} s; the time-out must be longer"


def _stop_below(values: Values) -> str:
    low = values.pair("spindle.rpm")[0]
    below = values.number("spindle.stop_below")
    return "" if below < low else f"{below:g} rpm counts as stopped, but the spindle may be asked for {low:g}"


def _feedback(values: Values) -> str:
    wanted = values.flag("c_axis.feedback") and not values.flag("axis.C.enabled")
    return "feedback needs axis.C.enabled = true" if wanted else ""


def _slide(axis: str) -> tuple[Rule, ...]:
    path = f"axis.{axis}"
    return (
        _home_inside(axis),
        _fixed_points(axis),
        _jog_run_on(axis),
        _corner_tolerance(axis),
        _homing(axis),
        _below("limits.max_feed", f"{path}.vmax", "no slide goes faster than its vmax", Unit.FEED),
        _below("limits.manual_rapid", f"{path}.vmax", "no slide goes faster than its vmax", Unit.FEED),
        _below(f"{path}.home.speed", f"{path}.vmax", "no slide goes faster than its vmax", Unit.FEED),
        _below(f"{path}.count", "limits.resolution", "a step must be a count at least", Unit.LENGTH),
        *_windows(axis, Unit.LENGTH),
    )


def _windows(axis: str, unit: Unit) -> tuple[Rule, ...]:
    """Each holds the next: a count, in position, what the axis may be off at rest and in motion."""
    count, arrived, still, window = (
        f"axis.{axis}.{key}" for key in ("count", "in_pos", "still_window", "fe_window")
    )
    return (
        _below(count, arrived, "in position must be a count at least", unit),
        _below(arrived, window, "in position lies inside the fault window", unit),
        _below(arrived, still, "in position lies inside what it may be off", unit),
        _below(still, window, "at rest it trails behind nothing", unit),
    )


def _rotary(axis: str) -> tuple[Rule, ...]:
    return _home_inside(axis), _homing(axis), *_windows(axis, Unit.DEGREES)


_QUEUE = "the queue would run dry"


def _indexes(values: Values) -> str:
    """A turret would have to be indexed with every T; no driver does, and T2 would cut with another tool."""
    if values.text("tooling.kind") != "turret":
        return ""
    return (
        '"turret": TurnDesk does not index turrets yet. Use "gang", or "single" with one tool in the machine'
    )


RULES = (
    *_slide("X"),
    *_slide("Y"),
    *_slide("Z"),
    *_rotary("A"),
    *_rotary("B"),
    *_rotary("C"),
    *_home_orders(),
    _below("machine.setpoint_ms", "machine.commit_ms", "a setpoint cannot last longer", Unit.MILLISECONDS),
    _below("machine.commit_ms", "machine.low_water_ms", _QUEUE, Unit.MILLISECONDS),
    _below("machine.low_water_ms", "machine.lookahead_ms", _QUEUE, Unit.MILLISECONDS),
    _below("machine.lease_ms", "machine.lookahead_ms", "a jog is never queued further", Unit.MILLISECONDS),
    _below("machine.commit_ms", "machine.lease_ms", "a renewal would come too late", Unit.MILLISECONDS),
    Rule("spindle.timeout_s", ("spindle.rpm", "spindle.accel_rpm_s", "spindle.at_speed_s"), _timeout),
    Rule("spindle.stop_below", ("spindle.rpm",), _stop_below),
    Rule("tooling.kind", (), _indexes),
    Rule("c_axis.feedback", ("axis.C.enabled",), _feedback),
)
