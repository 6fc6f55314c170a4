"""Rules for related values in a machine file.

A rule is checked only if all values that it needs are valid.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import combinations
from typing import NamedTuple

from core.key_declaration import FileUnit, format_value
from core.message import Message
from core.table_schema import FileFinding, FileValues


class ValueRule(NamedTuple):
    """A rule for the value at ``key_path``.

    The rule is checked only if all ``required_keys`` are present. ``find_error`` then returns the error, or
    an empty string if the value obeys the rule.
    """

    key_path: str
    required_keys: tuple[str, ...]
    find_error: Callable[[FileValues], str]


def check_rules(values: FileValues) -> Iterator[FileFinding]:
    """Yield a finding for every violated rule.

    A rule is checked only if all values that it needs are valid.
    """
    for rule in VALUE_RULES:
        if values.has_values(rule.key_path, *rule.required_keys) and (expected := rule.find_error(values)):
            yield FileFinding(rule.key_path, "", expected, "broken-rule")


def _maximum_rule(path: str, limit: str, reason: str, unit: FileUnit) -> ValueRule:
    """Return the rule that the value at ``path`` must not exceed the value at ``limit``."""

    def find_error(values: FileValues) -> str:
        value, bound = values.read_number(path), values.read_number(limit)
        if value <= bound * (1 + 1e-9):
            return ""
        inch = bool(values.is_inch)
        return Message(
            "{unit} exceeds {limit} = {bound}; {why}",
            unit=format_value(value, unit, inch),
            limit=limit,
            bound=format_value(bound, unit, inch),
            why=reason,
        )

    return ValueRule(path, (limit,), find_error)


def _home_inside(axis: str) -> ValueRule:
    path = f"axis.{axis}.travel"

    def find_error(values: FileValues) -> str:
        low, high = values.read_pair(path)
        return "" if low <= 0.0 <= high else ("travel is measured from home, so 0 must be within the travel")

    return ValueRule(path, (), find_error)


def _fixed_points(axis: str) -> ValueRule:
    path = f"axis.{axis}.fixed_points"

    def find_error(values: FileValues) -> str:
        points, (low, high) = values.read_numbers(path), values.read_pair(f"axis.{axis}.travel")
        if len(points) > 1 and values.text("machine.kind") != "lathe":
            return (
                "on a mill, each axis can have only one point, the reference of M92; only a "
                "lathe can have up to four points for G75"
            )
        outside = next((point for point in points if not low <= point <= high), None)
        if outside is None:
            return ""
        inch = bool(values.is_inch)
        point, ends = (
            format_value(outside, FileUnit.LENGTH, inch),
            (format_value(end, FileUnit.LENGTH, inch) for end in (low, high)),
        )
        return Message(
            "{point} is outside axis.{axis}.travel ({ends}); the axis cannot move there",
            point=point,
            axis=axis,
            ends=" to ".join(ends),
        )

    return ValueRule(path, (f"axis.{axis}.travel", "machine.kind"), find_error)


def _jog_overrun_rule(axis: str) -> ValueRule:
    """Return the rule that limits how far an axis travels after the connection for jogging is lost.

    The distance is lease · vmax + vmax² / 2a.
    """
    vmax, amax = f"axis.{axis}.vmax", f"axis.{axis}.amax"

    def find_error(values: FileValues) -> str:
        v = values.read_number(vmax)
        run_on = values.read_number("machine.lease_ms") * v + v * v / (2 * values.read_number(amax))
        limit = values.read_number("limits.clearance")
        if run_on <= limit * (1 + 1e-9):
            return ""
        inch = bool(values.is_inch)
        far, near = format_value(run_on, FileUnit.LENGTH, inch), format_value(limit, FileUnit.LENGTH, inch)
        return Message(
            "{axis} would travel {distance} at vmax after the signal of a jog key is lost, "
            "which exceeds limits.clearance = {nearest}; reduce machine.lease_ms",
            axis=axis,
            distance=far,
            nearest=near,
        )

    return ValueRule("machine.lease_ms", (vmax, amax, "limits.clearance"), find_error)


def _corner_tolerance_rule(axis: str) -> ValueRule:
    """Return the rule that the corner tolerance must be at least the rounding error of one count."""
    path, count = "limits.corner_tolerance", f"axis.{axis}.count"

    def find_error(values: FileValues) -> str:
        said, least = values.read_number(path), math.sqrt(2.0) * values.read_number(count)
        if said == 0.0 or said >= least * (1 - 1e-9):
            return ""
        inch = bool(values.is_inch)
        least_shown = format_value(least, FileUnit.LENGTH, inch)
        return Message(
            "rounding to {count} already causes a deviation of {least_shown}; enter at least "
            "this value, or remove the entry",
            count=count,
            least_shown=least_shown,
        )

    return ValueRule(path, (count,), find_error)


def _homing(axis: str) -> ValueRule:
    path = f"axis.{axis}.absolute"

    def find_error(values: FileValues) -> str:
        known = values.read_flag(path) or values.is_specified(f"axis.{axis}.home.order")
        known = known or (axis == "C" and values.text("machine.kind") == "lathe")  # M19 finds it
        return (
            ""
            if known
            else Message(
                "an axis without an absolute encoder needs axis.{axis}.home = {{ order, speed }}", axis=axis
            )
        )

    return ValueRule(path, ("machine.kind",), find_error)


def _home_order_rules() -> tuple[ValueRule, ...]:
    """Return the rules by which no two axes may have the same place in the homing order."""

    def make_order_rule(one: str, other: str) -> ValueRule:
        def find_error(values: FileValues) -> str:
            same = values.read_number(f"axis.{one}.home.order") == values.read_number(
                f"axis.{other}.home.order"
            )
            return (
                Message(
                    "{one} and {other} must home one after the other; set different values of home.order",
                    one=one,
                    other=other,
                )
                if same
                else ""
            )

        return ValueRule(f"axis.{other}.home.order", (f"axis.{one}.home.order",), find_error)

    return tuple(make_order_rule(one, other) for one, other in combinations("XYZABC", 2))


def _timeout(values: FileValues) -> str:
    needed = values.read_pair("spindle.rpm")[1] / values.read_number("spindle.accel_rpm_s")
    needed += values.read_number("spindle.at_speed_s")
    if values.read_number("spindle.timeout_s") > needed:
        return ""
    return Message(
        "the spindle takes {needed} s to reach its maximum speed; the timeout must be longer",
        needed=f"{needed:.3g}",
    )


def _stop_below(values: FileValues) -> str:
    low = values.read_pair("spindle.rpm")[0]
    below = values.read_number("spindle.stop_below")
    return (
        ""
        if below < low
        else Message(
            "the spindle counts as stopped below {below} rpm, but speeds down to {low} rpm can be commanded",
            below=f"{below:g}",
            low=f"{low:g}",
        )
    )


def _feedback(values: FileValues) -> str:
    wanted = values.read_flag("c_axis.feedback") and not values.read_flag("axis.C.enabled")
    return "C-axis feedback requires axis.C.enabled = true" if wanted else ""


def _slide(axis: str) -> tuple[ValueRule, ...]:
    path = f"axis.{axis}"
    return (
        _home_inside(axis),
        _fixed_points(axis),
        _jog_overrun_rule(axis),
        _corner_tolerance_rule(axis),
        _homing(axis),
        _maximum_rule(
            "limits.max_feed", f"{path}.vmax", "an axis cannot move faster than its vmax", FileUnit.FEED
        ),
        _maximum_rule(
            "limits.manual_rapid", f"{path}.vmax", "an axis cannot move faster than its vmax", FileUnit.FEED
        ),
        _maximum_rule(
            f"{path}.home.speed", f"{path}.vmax", "an axis cannot move faster than its vmax", FileUnit.FEED
        ),
        _maximum_rule(
            f"{path}.count",
            "limits.resolution",
            "one step of limits.resolution must be at least one count",
            FileUnit.LENGTH,
        ),
        *_window_rules(axis, FileUnit.LENGTH),
    )


def _window_rules(axis: str, unit: FileUnit) -> tuple[ValueRule, ...]:
    """Return the rules for the order of the tolerances of an axis.

    The count, in-position, standstill and following error windows must increase in this order.
    """
    count, arrived, still, window = (
        f"axis.{axis}.{key}" for key in ("count", "in_pos", "still_window", "fe_window")
    )
    return (
        _maximum_rule(count, arrived, "the in-position window must be at least one count", unit),
        _maximum_rule(
            arrived,
            window,
            "the in-position window must not be larger than the following error limit",
            unit,
        ),
        _maximum_rule(
            arrived,
            still,
            "the in-position window must not be larger than the standstill tolerance",
            unit,
        ),
        _maximum_rule(
            still,
            window,
            "the standstill tolerance must not be larger than the following error limit",
            unit,
        ),
    )


def _rotary(axis: str) -> tuple[ValueRule, ...]:
    return _home_inside(axis), _homing(axis), *_window_rules(axis, FileUnit.DEGREES)


_QUEUE = "the setpoint queue would run empty"


def _find_turret_error(values: FileValues) -> str:
    """Return the error for a turret, which is not allowed.

    No driver can index a turret, so the program would continue with the wrong tool after T2.
    """
    if values.text("tooling.kind") != "turret":
        return ""
    return (
        '"turret": TurnDesk does not index turrets yet. Use "gang", or "single" with one tool in the machine'
    )


VALUE_RULES = (
    *_slide("X"),
    *_slide("Y"),
    *_slide("Z"),
    *_rotary("A"),
    *_rotary("B"),
    *_rotary("C"),
    *_home_order_rules(),
    _maximum_rule(
        "machine.setpoint_ms",
        "machine.commit_ms",
        "the duration of a setpoint cannot be longer than machine.commit_ms",
        FileUnit.MILLISECONDS,
    ),
    _maximum_rule("machine.commit_ms", "machine.low_water_ms", _QUEUE, FileUnit.MILLISECONDS),
    _maximum_rule("machine.low_water_ms", "machine.lookahead_ms", _QUEUE, FileUnit.MILLISECONDS),
    _maximum_rule(
        "machine.lease_ms",
        "machine.lookahead_ms",
        "jog motion is queued at most machine.lookahead_ms ahead, so machine.lease_ms must not be longer",
        FileUnit.MILLISECONDS,
    ),
    _maximum_rule(
        "machine.commit_ms",
        "machine.lease_ms",
        "the jog watchdog would expire before the control renews it",
        FileUnit.MILLISECONDS,
    ),
    ValueRule("spindle.timeout_s", ("spindle.rpm", "spindle.accel_rpm_s", "spindle.at_speed_s"), _timeout),
    ValueRule("spindle.stop_below", ("spindle.rpm",), _stop_below),
    ValueRule("tooling.kind", (), _find_turret_error),
    ValueRule("c_axis.feedback", ("axis.C.enabled",), _feedback),
)
