"""Calculators and templates in SINUMERIK: the fields of the others, the lines of that language."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from core.extras.shapes.calculators import SPEED, THREADS
from core.extras.shapes.contour import Row
from core.extras.shapes.forms.bar_work import SINUMERIK_LOOP, no_chuck
from core.extras.shapes.forms.program_head import SINUMERIK_HEAD
from core.extras.shapes.forms.turning import LABEL
from core.extras.shapes.lines.bar_lines import Bars, write_bars
from core.extras.shapes.lines.code_lines import Along, Code
from core.extras.shapes.number_words import figure
from core.extras.shapes.shape import Filled
from core.extras.shapes.shape_fields import Refusal
from core.extras.shapes.shape_setting import Setting
from core.extras.shapes.templates import BAR_FEED, ROUGH, START, THREADING, V60_DEEP
from core.extras.shapes.threads.threading import write_cycle97
from core.message import Message

_BAR_RATE = {False: 20.0, True: 500.0}  # by metric, a minute


def _speed(filled: Filled, _setting: Setting, code: Code) -> None:
    code.write(f"G95 S{figure(filled.n('RPM'), 0)} M3 F{figure(filled.n('FEED'), 6)}")


def _speed_says(filled: Filled, setting: Setting) -> tuple[str, ...]:
    """The feed a minute as it is written here."""
    _, *others = SPEED.says(filled, setting)
    return Message("equivalent feed per minute: G94 F{number}", number=figure(filled.n("RATE"), 3)), *others


def _run_up(filled: Filled, setting: Setting) -> Filled:
    """With three turns before the thread: the slide has to reach the lead."""
    return replace(filled, values={**filled.values, "RUNUP": 3.0 * filled.n("PITCH") + setting.near})


def _passes(filled: Filled, setting: Setting, code: Code) -> None:
    write_cycle97(_run_up(filled, setting), code)


def _passes_say(filled: Filled, setting: Setting) -> tuple[str, ...]:
    """The cycle goes to its first pass by itself."""
    depth, _, passes = THREADS.says(filled, setting)
    return depth, passes


def _rough(filled: Filled, setting: Setting, code: Code) -> None:
    across, long = filled.n("FROM"), 12.5 if setting.metric else 0.5
    code.rapid(across / 2.0, setting.near)
    rows = (Row(across / 2.0, 0.0), Row(z=-long), Row(across))
    feed, rough, leave = (filled.n(word) for word in ("FEED", "ROUGH", "LEAVE"))
    code.along(Along(rows, across / 2.0, False, feed, rough, leave, feed, 0.0, filled.n("LABEL")))
    code.away()


def _thread(filled: Filled, setting: Setting, code: Code) -> None:
    crest = filled.n("FROM")
    root = crest - 2.0 * V60_DEEP * filled.n("PITCH")
    values = {**filled.values, "CREST": crest, "ROOT": root, "PASSES": 8.0, "INFEED": 29.0}
    whole = _run_up(replace(filled, values=values), setting)
    code.begin(filled.n("T"), filled.n("RPM"), crest / 2.0, whole.n("RUNUP"))
    write_cycle97(whole, code)
    code.away()


def _bar_feed(filled: Filled, setting: Setting, code: Code) -> None:
    many, long, stop, part = (filled.n(word) for word in ("COUNT", "LONG", "T", "SUB"))
    rate = _BAR_RATE[setting.metric]
    write_bars(code, Bars(int(many), long, True, stop, 0.0, rate, int(part)))


def _bar_feed_checks(_filled: Filled, setting: Setting) -> Iterator[Refusal]:
    return no_chuck(setting, "COUNT")


SINUMERIK_SPEED = replace(SPEED, cut=_speed, says=_speed_says)
SINUMERIK_THREADS = replace(THREADS, cut=_passes, says=_passes_say)
SINUMERIK_START = replace(START, fields=SINUMERIK_HEAD.fields, cut=SINUMERIK_HEAD.cut)
SINUMERIK_ROUGH = replace(ROUGH, name="CYCLE95 ROUGHING", cut=_rough, fields=(*ROUGH.fields, LABEL))
SINUMERIK_THREADING = replace(
    THREADING,
    name="THREAD CYCLE97",
    use="calls the tool, leads in, and cuts passes with a constant chip cross-section",
    cut=_thread,
)
SINUMERIK_BAR_FEED = replace(BAR_FEED, cut=_bar_feed, checks=_bar_feed_checks, ends=SINUMERIK_LOOP.ends)
