"""To rest without losing the position.

0x18 and 0x19 do not brake: both end the steps where they are, and only 0x18 tells by ALARM:3 that the
position is lost by that. Behind 0x19 the line that is being planned goes on into the emptied planner, and
moves. So a feed hold comes first, or a jog cancel, and 0x18 when all is at rest.
"""

from __future__ import annotations

from collections.abc import Generator

from drivers.grblhal import codes
from drivers.grblhal.asking import MISSED
from drivers.grblhal.controller import Controller
from drivers.grblhal.scripting import Script, Step

_LATE = 0.4  # s, beyond its ramp, for a stop to be seen
_BANNER = 3.0  # s that a reset takes
_NO_RESET = "the controller does not come back from its reset; is E-stop pressed?"
_STALE = 0.5  # s in which reports from before a reset may still come
_MUTE = 0.4  # s without a report behind a thread: it waits for its index and hears nothing but a stop
_INDEX = 7.0  # s until that wait is over, whatever comes


def stop(c: Controller, *, waits: bool = False) -> Script:
    """Brake, then reset, which voids its queue; the position is kept unless it did not come to rest.

    ``waits``: a thread pass is under way, which may be waiting for its index with nothing moving; there 0x18
    would be a lost position, and 0x19 is a reset. An alarm is left alone.
    """
    if c.state != "Home":  # which nothing but a reset ends
        yield from _brake(c)
    if c.state == "Alarm":
        return
    if not (waits and c.clock.now() - c.heard_at > _MUTE):
        yield from reset(c)
        return
    before, reports = c.banners, c.reports
    c.expect_reset()
    c.realtime(codes.STOP)
    yield lambda: c.banners > before or c.reports > reports, _INDEX, MISSED
    if c.state != "Alarm" and c.banners == before:
        yield from reset(c)


def reset(c: Controller) -> Script:
    """Soft reset, and its banner, before which no question is answered: a report says that none comes."""
    before, reports, began = c.banners, c.reports, c.clock.now()

    def answers() -> bool:
        return c.reports > reports and c.heard_at > began + _STALE

    c.expect_reset()
    c.realtime(codes.RESET)
    yield lambda: c.banners > before or answers(), _BANNER, _NO_RESET
    yield lambda: c.banners > before, 0.0, _NO_RESET


def _brake(c: Controller) -> Generator[Step, None, None]:
    """Until it rests, is mute, or its time is over."""
    after, began = c.reports + 1, c.clock.now()  # one report may still be on its way from before
    by = began + _stopping(c)
    c.realtime(codes.JOG_CANCEL, codes.HOLD)

    def rests() -> bool:
        return c.reports > after and c.report is not None and not c.report.moves

    yield lambda: rests() or c.clock.now() >= by, _stopping(c) + 1.0, MISSED


def _stopping(c: Controller) -> float:
    """Seconds that the slowest slide takes to brake, by the controller's own figures where it tells them."""
    ramps = [axis.vmax / axis.amax for axis in c.wired]
    for axis in c.wired:
        speed, accel = c.speed_of(axis.name), c.figure(120, axis.name)
        if speed and accel:
            ramps.append(speed / accel)
    return _LATE + max(ramps)
