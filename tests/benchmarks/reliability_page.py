"""The page of reliability: ``python -m tests.benchmarks.reliability_page > docs/reliability.md``.

A measurement keeps its figures with date and machine in ``tests/benchmarks/results``; nothing is written by
hand but why a mutant may live, in ``survivors.toml`` beside them, and why a fault of fuzzing is left, in
``limits.toml``.
"""

from __future__ import annotations

import json
import sys
import tomllib
from ast import literal_eval
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.benchmarks.footprint import RESULTS

Result = dict[str, Any]
_WORDS = {
    "rss_mib": "memory, MiB", "files": "open files", "threads": "threads", "store_bytes": "store, kB",
    "log_bytes": "log, kB", "folder_bytes": "data folder, kB",
}  # fmt: skip
WANTED = 92.0  # per cent of branches
SETTLED = 20.0  # min, by which every page was open and the ring of the scope is full
TOLD = 85.0  # per cent of mutants that are not the same program
_HEAD = """\
# What holds for years, measured

Written by `python -m tests.benchmarks.reliability_page` from the figures that the measurements keep; no
figure is typed. Every measurement is run by hand, none by the tests; CI plays a miniature of the night shift.
"""


def page(folder: Path = RESULTS) -> str:
    """The whole page; a measurement that was never run is named."""
    parts = [_HEAD]
    for name, title, write in (
        ("night_shift", "Night shift", _night),
        ("screen_hour", "The screen's hour", _screen),
        ("fuzz", "Fuzzing by coverage", _fuzz),
        ("mutants", "Mutation", _mutants),
        ("branches", "Branches", _branches),
    ):
        parts.append(f"## {title}\n")
        kept = sorted(folder.glob(f"{name}*.json"))
        if not kept:
            parts.append("Not measured yet.\n")
        for path in kept:
            result = json.loads(path.read_text())
            parts += [*write(result, folder), f"*{result['date']}, {result['machine']}.*\n"]
    return "\n".join(parts)


def _table(head: list[str], rows: list[list[object]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join([*lines, *("| " + " | ".join(map(str, row)) + " |" for row in rows)]) + "\n"


def _footprints(marks: dict[str, dict[str, float]], of: str) -> str:
    """First, middle and last mark."""
    names = sorted(marks, key=float)
    shown = [names[0], names[len(names) // 2], names[-1]]
    rows: list[list[object]] = []
    for key, words in _WORDS.items():
        share = 1000.0 if words.endswith("kB") else 1.0
        rows.append([words, *(f"{marks[name][key] / share:,.0f}" for name in shown)])
    return _table(["", *(f"{name} {of}" for name in shown)], rows)


def _night(result: Result, _folder: Path) -> Iterator[str]:
    counts, drift = result["counts"], result["drift"]
    same = not result["disagree"]
    yield (
        f"`bench_night_shift`, seed {result['seed']}: {result['parts']} pins from bars in "
        f"{result['machine_hours']} hours of the machine on the step clock; desk, executor, simulated lathe "
        "and store are the product's. A witness looks at the slides alone and has seen "
        f"{counts['seen at the slides']} pins that count.\n"
    )
    yield _footprints(result["marks"], "parts")
    said = "all the same as what was seen" if same else "; ".join(result["disagree"])
    yield (
        f"Counts of executor, desk, store, log and cycles: {said}. Made without count: "
        f"{counts['pins without count']}; parted off by programs that were then broken off: "
        f"{counts['pins of programs that were broken off']}; readings {counts['readings']}, inserts "
        f"{counts['inserts']}; underruns {result['underruns']}.\n"
    )
    yield (
        f"Drift: {_places(result['at the bar stop'])}; with "
        f"{drift['offsets that were turned with']} offsets X of the pin spread by "
        f"{drift['turned radii with one offset, spread mm']:g} mm and was off what offset and program say by "
        f"{drift['turned radius against offset and program, mm']:g} mm.\n"
    )
    yield f"What was done and what broke: {_list(result['done'])}. Alarms: {_list(result['alarms'])}.\n"


def _places(ticks: dict[str, int]) -> str:
    """How far the setpoints at the bar stop lay apart, and in how many ticks they lay elsewhere."""
    usual = literal_eval(max(ticks, key=lambda place: ticks[place]))
    if len(ticks) == 1:
        return "the setpoints at the bar stop were one place"
    apart = max(abs(a - b) for place in ticks for a, b in zip(literal_eval(place), usual, strict=True))
    elsewhere = sum(ticks.values()) - max(ticks.values())
    return (
        f"the setpoints at the bar stop lay within {apart:.1e} mm, "
        f"{elsewhere} of {sum(ticks.values())} ticks not at the usual place"
    )


def _list(counted: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in counted.items()) or "none"


def _screen(result: Result, _folder: Path) -> Iterator[str]:
    counts, minutes = result["counts"], result["minutes"]
    more = counts["seen at the slides"] - counts["store"]
    agrees = " (what was seen does not agree)" if more < 0 else ""
    if more > 0:
        agrees = f" ({more} parted off in a program that did not come to its end)"
    yield (
        f"`bench_screen_hour`: the real window for {minutes:g} minutes by the real clock under an X server, "
        f"{_list(result['done'])}; {counts['seen at the slides']} pins seen at the slides, {counts['store']} "
        f"in the store, {counts['log']} in the log, {counts['cycles']} cycles{agrees}. "
        f"Alarms: {_list(result['alarms'])}.\n"
    )
    yield _footprints(result["marks"], "min")
    if minutes < SETTLED:
        return
    names = sorted(result["marks"], key=float)
    middle, last = names[len(names) // 2], names[-1]
    grown = result["marks"][last]["rss_mib"] - result["marks"][middle]["rss_mib"]
    hours = (float(last) - float(middle)) / 60.0
    yield (
        f"In the second half, when every page has been open, it grows by {grown:.1f} MiB: "
        f"{grown / hours:.0f} MiB an hour{'' if minutes >= 60 else ', extrapolated'}.\n"
    )


def _fuzz(result: Result, folder: Path) -> Iterator[str]:
    yield (
        "`tests/fuzz`: atheris beside changes that know each language. A fault is what raises what it should "
        "not, takes over 2 s of processor time or tells no clear sentence. What was mended has a test.\n"
    )
    rows = [
        [
            name,
            f"{each['seconds']:g}",
            f"{each.get('runs', 0):,}",
            f"{each['edges at first']} to {each['edges']}",
            f"{each.get('slowest_s', 0.0):.2f}",
            len(each["faults"]),
        ]
        for name, each in sorted(result["targets"].items())
    ]
    yield _table(["of", "s of processor time", "runs", "edges", "slowest, s", "faults left"], rows)
    faults = [fault for _, each in sorted(result["targets"].items()) for fault in each["faults"]]
    if faults:
        reasons = tomllib.loads((folder / "limits.toml").read_text())
        why = [reasons.get(fault["where"], {}).get("why", "not looked at yet") for fault in faults]
        lines = [f"- {f['where']}, {f['text']}: {reason}" for f, reason in zip(faults, why, strict=True)]
        yield "Those that are left:\n\n" + "\n".join(lines) + "\n"


def _mutants(result: Result, folder: Path) -> Iterator[str]:
    known = tomllib.loads((folder / "survivors.toml").read_text())
    rows, living = [], []
    for room, each in sorted(result["rooms"].items()):
        same = [name for name in map(_name, each["survivors"]) if known.get(name, {}).get("same")]
        told_since = {_name(survivor) for survivor in each["survivors"] if survivor.get("told by")}
        since = [
            name
            for name in map(_name, each["survivors"])
            if name in told_since or known.get(name, {}).get("test")
        ]
        count = each["mutants"] - each["not put in"]
        told = each["told"] + len(since)
        share = 100.0 * told / max(1, count - len(same))
        first = 100.0 * each["told"] / max(1, count - len(same))
        rows.append([room, count, each["told"], f"{first:.0f} %", len(since), len(same), f"{share:.0f} %"])
        for survivor in each["survivors"]:
            name = _name(survivor)
            if name not in since:
                living.append(f"- `{name}`: {known.get(name, {}).get('why', 'no fast test tells')}")
    yield (
        "`bench_mutants`: small changes of functions by a seed, each against the tests of its room below 2 s "
        f"that come by its line; wanted are {TOLD:.0f} % of those that change what the program does. Told "
        "since is what new tests tell, or such as the quick part leaves out for their time; from motion's "
        "seed 5 on those are played at first too.\n"
    )
    yield _table(
        ["room", "mutants", "told", "at first", "told since", "the same", "told of the others"], rows
    )
    if living:
        yield "Those that live:\n\n" + "\n".join(living) + "\n"


def _name(survivor: Result) -> str:
    return f"{survivor['path']} {survivor['function']}: {survivor['words']}"


def _branches(result: Result, _folder: Path) -> Iterator[str]:
    rows: list[list[object]] = []
    for room, each in sorted(result["rooms"].items()):
        rows.append([room, each["branches"], each["taken"], f"{each['per cent']} %"])
        folders = each.get("folders", {})
        if len(folders) > 1:
            rows += [
                [f"— {name}", count, taken, f"{100.0 * taken / count:.1f} %"]
                for name, (count, taken) in folders.items()
                if count
            ]
    yield f"`bench_branches`: taken by the tests of the room alone; wanted are {WANTED:.0f} %.\n"
    yield _table(["room", "branches", "taken", "share"], rows)


if __name__ == "__main__":
    sys.stdout.write(page())
