"""Rules between the values of a machine file, each checked if its values are valid."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import combinations
from typing import NamedTuple

from core.key_declaration import Unit, shown
from core.message import Message
from core.table_schema import Finding, Values


class Rule(NamedTuple):
    """A rule. ``wrong`` returns the error at ``path``, or an empty string, if all ``needs`` are present."""

    path: str
    needs: tuple[str, ...]
    wrong: Callable[[Values], str]


def broken(values: Values) -> Iterator[Finding]:
    """Yield a finding for every rule that the valid values break."""
    for rule in RULES:
        if values.has(rule.path, *rule.needs) and (expected := rule.wrong(values)):
            yield Finding(rule.path, "", expected, "broken-rule")


def _below(path: str, limit: str, why: str, unit: Unit) -> Rule:
    """Return the rule that ``path`` must not exceed ``limit``."""

    def wrong(values: Values) -> str:
        value, bound = values.number(path), values.number(limit)
        if value <= bound * (1 + 1e-9):
            return ""
        inch = bool(values.inch)
        return Message(
            "{unit} exceeds {limit} = {bound}; {why}",
            unit=shown(value, unit, inch),
            limit=limit,
            bound=shown(bound, unit, inch),
            why=why,
        )

    return Rule(path, (limit,), wrong)


def _home_inside(axis: str) -> Rule:
    path = f"axis.{axis}.travel"

    def wrong(values: Values) -> str:
        low, high = values.pair(path)
        return "" if low <= 0.0 <= high else ("travel is measured from home, so 0 must be within the travel")

    return Rule(path, (), wrong)


def _fixed_points(axis: str) -> Rule:
    path = f"axis.{axis}.fixed_points"

    def wrong(values: Values) -> str:
        points, (low, high) = values.numbers(path), values.pair(f"axis.{axis}.travel")
        if len(points) > 1 and values.text("machine.kind") != "lathe":
            return (
                "on a mill, each axis can have only one point, the reference of M92; only a "
                "lathe can have up to four points for G75"
            )
        outside = next((point for point in points if not low <= point <= high), None)
        if outside is None:
            return ""
        inch = bool(values.inch)
        point, ends = (
            shown(outside, Unit.LENGTH, inch),
            (shown(end, Unit.LENGTH, inch) for end in (low, high)),
        )
        return Message(
            "{point} is outside axis.{axis}.travel ({ends}); the axis cannot move there",
            point=point,
            axis=axis,
            ends=" to ".join(ends),
        )

    return Rule(path, (f"axis.{axis}.travel", "machine.kind"), wrong)


def _jog_run_on(axis: str) -> Rule:
    """Return the rule for the distance lease · vmax + vmax² / 2a that an axis travels after a lost jog."""
    vmax, amax = f"axis.{axis}.vmax", f"axis.{axis}.amax"

    def wrong(values: Values) -> str:
        v = values.number(vmax)
        run_on = values.number("machine.lease_ms") * v + v * v / (2 * values.number(amax))
        limit = values.number("limits.clearance")
        if run_on <= limit * (1 + 1e-9):
            return ""
        inch = bool(values.inch)
        far, near = shown(run_on, Unit.LENGTH, inch), shown(limit, Unit.LENGTH, inch)
        return Message(
            "{axis} would travel {distance} at vmax after the signal of a jog key is lost, "
            "which exceeds limits.clearance = {nearest}; reduce machine.lease_ms",
            axis=axis,
            distance=far,
            nearest=near,
        )

    return Rule("machine.lease_ms", (vmax, amax, "limits.clearance"), wrong)


def _corner_tolerance(axis: str) -> Rule:
    """Return the rule that the tolerance is at least the one count by which joints always move."""
    path, count = "limits.corner_tolerance", f"axis.{axis}.count"

    def wrong(values: Values) -> str:
        said, least = values.number(path), math.sqrt(2.0) * values.number(count)
        if said == 0.0 or said >= least * (1 - 1e-9):
            return ""
        inch = bool(values.inch)
        least_shown = shown(least, Unit.LENGTH, inch)
        return Message(
            "rounding to {count} already causes a deviation of {least_shown}; enter at least "
            "this value, or remove the entry",
            count=count,
            least_shown=least_shown,
        )

    return Rule(path, (count,), wrong)


def _homing(axis: str) -> Rule:
    path = f"axis.{axis}.absolute"

    def wrong(values: Values) -> str:
        known = values.flag(path) or values.stated(f"axis.{axis}.home.order")
        known = known or (axis == "C" and values.text("machine.kind") == "lathe")  # M19 finds it
        return (
            ""
            if known
            else Message(
                "an axis without an absolute encoder needs axis.{axis}.home = {{ order, speed }}", axis=axis
            )
        )

    return Rule(path, ("machine.kind",), wrong)


def _home_orders() -> tuple[Rule, ...]:
    """Return the rules that no two axes home at the same time."""

    def rule(one: str, other: str) -> Rule:
        def wrong(values: Values) -> str:
            same = values.number(f"axis.{one}.home.order") == values.number(f"axis.{other}.home.order")
            return (
                Message(
                    "{one} and {other} must home one after the other; set different values of home.order",
                    one=one,
                    other=other,
                )
                if same
                else ""
            )

        return Rule(f"axis.{other}.home.order", (f"axis.{one}.home.order",), wrong)

    return tuple(rule(one, other) for one, other in combinations("XYZABC", 2))


def _timeout(values: Values) -> str:
    needed = values.pair("spindle.rpm")[1] / values.number("spindle.accel_rpm_s")
    needed += values.number("spindle.at_speed_s")
    if values.number("spindle.timeout_s") > needed:
        return ""
    return Message(
        "the spindle takes {needed} s to reach its maximum speed; the timeout must be longer",
        needed=f"{needed:.3g}",
    )


def _stop_below(values: Values) -> str:
    low = values.pair("spindle.rpm")[0]
    below = values.number("spindle.stop_below")
    return (
        ""
        if below < low
        else Message(
            "the spindle counts as stopped below {below} rpm, but speeds down to {low} rpm can be commanded",
            below=f"{below:g}",
            low=f"{low:g}",
        )
    )


def _feedback(values: Values) -> str:
    wanted = values.flag("c_axis.feedback") and not values.flag("axis.C.enabled")
    return "C-axis feedback requires axis.C.enabled = true" if wanted else ""


def _slide(axis: str) -> tuple[Rule, ...]:
    path = f"axis.{axis}"
    return (
        _home_inside(axis),
        _fixed_points(axis),
        _jog_run_on(axis),
        _corner_tolerance(axis),
        _homing(axis),
        _below("limits.max_feed", f"{path}.vmax", "an axis cannot move faster than its vmax", Unit.FEED),
        _below("limits.manual_rapid", f"{path}.vmax", "an axis cannot move faster than its vmax", Unit.FEED),
        _below(f"{path}.home.speed", f"{path}.vmax", "an axis cannot move faster than its vmax", Unit.FEED),
        _below(
            f"{path}.count",
            "limits.resolution",
            "one step of limits.resolution must be at least one count",
            Unit.LENGTH,
        ),
        *_windows(axis, Unit.LENGTH),
    )


def _windows(axis: str, unit: Unit) -> tuple[Rule, ...]:
    """Return the rules that count, in-position, standstill and following error windows increase in order."""
    count, arrived, still, window = (
        f"axis.{axis}.{key}" for key in ("count", "in_pos", "still_window", "fe_window")
    )
    return (
        _below(count, arrived, "the in-position window must be at least one count", unit),
        _below(
            arrived,
            window,
            "the in-position window must not be larger than the following error limit",
            unit,
        ),
        _below(
            arrived,
            still,
            "the in-position window must not be larger than the standstill tolerance",
            unit,
        ),
        _below(
            still,
            window,
            "the standstill tolerance must not be larger than the following error limit",
            unit,
        ),
    )


def _rotary(axis: str) -> tuple[Rule, ...]:
    return _home_inside(axis), _homing(axis), *_windows(axis, Unit.DEGREES)


_QUEUE = "the setpoint queue would run empty"


def _indexes(values: Values) -> str:
    """Reject a turret, because no driver indexes it and T2 would cut with another tool."""
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
    _below(
        "machine.setpoint_ms",
        "machine.commit_ms",
        "the duration of a setpoint cannot be longer than machine.commit_ms",
        Unit.MILLISECONDS,
    ),
    _below("machine.commit_ms", "machine.low_water_ms", _QUEUE, Unit.MILLISECONDS),
    _below("machine.low_water_ms", "machine.lookahead_ms", _QUEUE, Unit.MILLISECONDS),
    _below(
        "machine.lease_ms",
        "machine.lookahead_ms",
        "jog motion is queued at most machine.lookahead_ms ahead, so machine.lease_ms must not be longer",
        Unit.MILLISECONDS,
    ),
    _below(
        "machine.commit_ms",
        "machine.lease_ms",
        "the jog watchdog would expire before the control renews it",
        Unit.MILLISECONDS,
    ),
    Rule("spindle.timeout_s", ("spindle.rpm", "spindle.accel_rpm_s", "spindle.at_speed_s"), _timeout),
    Rule("spindle.stop_below", ("spindle.rpm",), _stop_below),
    Rule("tooling.kind", (), _indexes),
    Rule("c_axis.feedback", ("axis.C.enabled",), _feedback),
)
