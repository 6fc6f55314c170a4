"""The page of reliability: ``python -m tests.benchmarks.reliability_page > docs/reliability.md``.

A measurement keeps its figures with date and machine in ``tests/benchmarks/results``; nothing is written by
hand but why a mutant may live, in ``survivors.toml`` beside them, and why a fault of fuzzing is left, in
``limits.toml``.
"""

from __future__ import annotations

import json
import sys
import textwrap
import tomllib
from ast import literal_eval
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from core.alarms import CATALOG
from core.page_contents import make_anchor
from tests.benchmarks.footprint import RESULTS

Result = dict[str, Any]
_WORDS = {
    "rss_mib": "memory, MiB", "files": "open files", "threads": "software threads",
    "store_bytes": "store, kB", "log_bytes": "log, kB", "folder_bytes": "data folder, kB",
}  # fmt: skip
WANTED = 92.0  # per cent of branches
SETTLED = 20.0  # min, by which every page was open and the ring of the scope is full
DETECTED = 85.0  # per cent of mutants that are not equivalent
_SECTIONS = (
    ("night_shift", "Night shift", "{parts} parts made while faults occur"),
    ("screen_hour", "One hour of the screen", "memory and open files of the real window"),
    ("fuzz", "Fuzzing by coverage", "parsers and drivers with random input"),
    ("mutants", "Mutation", "tests that run with changed code"),
    ("branches", "Branches", "branches of the code that the tests execute"),
)
_EVENTS = {
    "collet switch": "collet switch stuck",
    "correction": "wear correction",
    "drive trips": "drive fault",
    "feed pot": "feed override changed",
    "spindle pot": "spindle override changed",
    "give up": "program canceled",
    "hold": "feed hold",
    "insert": "insert changed",
    "inverter trips": "inverter fault",
    "no count": "NO COUNT",
    "pot noise": "unstable override signal",
    "slide is pushed": "axis pushed",
    "slide jams": "axis jammed",
    "spindle bogs": "spindle overloaded",
    "spindle switch": "spindle switch OFF",
    "start": "Cycle Start",
    "station silent": "station silent",
    "bar": "new bar",
    "holds": "feed holds",
    "starts": "Cycle Starts",
    "pages": "pages opened",
    "reading": "part measured",
}
"""Events of the stored results, as the page names them; other names stay."""
_HEAD = """\
# Reliability, measured

This page lists measurements of how TurnDesk behaves in long runs and with damaged input, and of how
many code changes its tests detect. All measurements use simulated devices. TurnDesk has not yet
driven a real machine.

{contents}
`python -m tests.benchmarks.reliability_page` creates this page from stored results. No value is
entered by hand. Each measurement is started
manually; the automatic tests include only a short version of the night shift.
The line in italics at the end of a section gives the date and the computer.
"""


def page(folder: Path = RESULTS) -> str:
    """The whole page; a measurement that was never run is named."""
    parts = [_HEAD.format(contents=_contents(folder))]
    writers = {
        "night_shift": _night,
        "screen_hour": _screen,
        "fuzz": _fuzz,
        "mutants": _mutants,
        "branches": _branches,
    }
    for name, title, _ in _SECTIONS:
        write = writers[name]
        parts.append(f"## {title}\n")
        kept = sorted(folder.glob(f"{name}*.json"))
        if not kept:
            parts.append("Not measured yet.\n")
        for path in kept:
            result = json.loads(path.read_text())
            parts += [*write(result, folder), f"*{result['date']}, {result['machine']}.*\n"]
    return "\n".join(parts)


def _contents(folder: Path) -> str:
    """Return the table of contents, with the number of parts of the night shift where it was measured."""
    file = folder / "night_shift.json"
    parts = json.loads(file.read_text())["parts"] if file.exists() else "many"
    return "".join(
        f"- [{title}](#{make_anchor(title)}): {what.format(parts=parts)}\n" for _, title, what in _SECTIONS
    )


def _filled(text: str) -> str:
    """Return a paragraph wrapped at 100 columns, with an empty line after it."""
    return textwrap.fill(text, 100, break_long_words=False, break_on_hyphens=False) + "\n"


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
    return _table(["measured after", *(f"{name} {of}" for name in shown)], rows)


def _night(result: Result, _folder: Path) -> Iterator[str]:
    counts, drift = result["counts"], result["drift"]
    seen = counts["seen at the slides"]
    yield _filled(
        f"`bench_night_shift` made {result['parts']} pins from bars in {result['machine_hours']} hours of "
        f"machine time, with a simulated clock (seed {result['seed']}). It used the screen models, the "
        "executor, the simulated lathe and the store of the product. An independent observer of the axis "
        f"positions detected {seen} pins that must be counted."
    )
    yield _footprints(result["marks"], "parts")
    disagree = result["disagree"]
    agree = f"disagree: {'; '.join(disagree)}" if disagree else "all agree with the observer"
    spread = drift["turned radii with one offset, spread mm"]
    error = drift["turned radius against offset and program, mm"]
    lines = (
        f"**Counts.** The executor, screen models, store, log and cycle records {agree}.",
        f"**Not counted.** {counts['pins without count']} pins were made with NO COUNT. "
        f"Programs that were then canceled parted off {counts['pins of programs that were broken off']} "
        "pins.",
        f"**Records.** The store recorded {counts['readings']} part measurements and "
        f"{counts['inserts']} "
        f"insert changes. The setpoint queue had {result['underruns']} underruns.",
        f"**Drift.** {_places(result['at the bar stop'])} With {drift['offsets that were turned with']} "
        f"different X offsets, the turned radius varied by {spread:g} mm among pins with the same offset. It "
        f"differed by {error:g} mm from the radius that the offset and the program specify.",
        f"**Events.** The test caused these events, each the given number of times: {_list(result['done'])}.",
        f"**Alarms.** These alarms occurred, each the given number of times: {_alarms(result['alarms'])}.",
    )
    yield "".join(f"- {line}\n" for line in lines)


def _places(ticks: dict[str, int]) -> str:
    """Return how much the setpoints at the bar stop differed, as a sentence."""
    usual = literal_eval(max(ticks, key=lambda place: ticks[place]))
    if len(ticks) == 1:
        return "All setpoints at the bar stop were equal."
    apart = max(abs(a - b) for place in ticks for a, b in zip(literal_eval(place), usual, strict=True))
    elsewhere = sum(ticks.values()) - max(ticks.values())
    return (
        f"The setpoints at the bar stop differed by at most {apart:.1e} mm; "
        f"{elsewhere} of {sum(ticks.values())} ticks were not at the most frequent position."
    )


def _list(counted: dict[str, int]) -> str:
    return ", ".join(f"{_EVENTS.get(name, name)} {count}" for name, count in counted.items()) or "none"


def _alarms(counted: dict[str, int]) -> str:
    """Return how often each alarm occurred, with the number and text of the catalog."""
    entries = {str(code): entry for code, entry in CATALOG.items()}
    named = {
        f"{entries[name].number} {entries[name].text.upper()}:" if name in entries else name: count
        for name, count in counted.items()
    }
    return ", ".join(f"{name} {count}" for name, count in sorted(named.items())) or "none"


def _screen(result: Result, _folder: Path) -> Iterator[str]:
    counts, minutes = result["counts"], result["minutes"]
    more = counts["seen at the slides"] - counts["store"]
    agrees = " (these numbers do not agree)" if more < 0 else ""
    if more > 0:
        agrees = f" (a program that did not reach its end parted off {more} of the pins)"
    yield _filled(
        f"`bench_screen_hour` ran the real window for {minutes:g} min in real time, on an X server. "
        f"The test performed these actions: {_list(result['done'])}. The observer detected "
        f"{counts['seen at the slides']} pins. The store contains {counts['store']} pins, the log contains "
        f"{counts['log']}, and {counts['cycles']} cycles were recorded{agrees}. "
        f"Alarms: {_alarms(result['alarms'])}."
    )
    yield _footprints(result["marks"], "min")
    if minutes < SETTLED:
        return
    names = sorted(result["marks"], key=float)
    middle, last = names[len(names) // 2], names[-1]
    grown = result["marks"][last]["rss_mib"] - result["marks"][middle]["rss_mib"]
    hours = (float(last) - float(middle)) / 60.0
    extrapolated = "" if minutes >= 60 else ", extrapolated"
    yield _filled(
        f"In the second half, after every page had been open, the memory grew by {grown:.1f} MiB, "
        f"which is {grown / hours:.0f} MiB per hour{extrapolated}."
    )


def _fuzz(result: Result, folder: Path) -> Iterator[str]:
    yield _filled(
        "`tests/fuzz` uses atheris and its own mutations, which follow the syntax of each language. It "
        "reports a fault if an exception occurs that is not permitted, if an input takes more than 2 s of "
        "CPU time, or if an error message is not clear. A test covers each corrected fault."
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
    head = [
        "input",
        "CPU time, s",
        "runs",
        "code edges covered, start to end",
        "slowest run, s",
        "open faults",
    ]
    yield _table(head, rows)
    faults = [fault for _, each in sorted(result["targets"].items()) for fault in each["faults"]]
    if faults:
        reasons = tomllib.loads((folder / "limits.toml").read_text())
        why = [reasons.get(fault["where"], {}).get("why", "not examined yet") for fault in faults]
        lines = [f"- {f['where']}, {f['text']}: {reason}" for f, reason in zip(faults, why, strict=True)]
        yield "These faults have not been corrected:\n\n" + "\n".join(lines) + "\n"


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
        rows.append([room, count, each["told"], f"{first:.0f}", len(since), len(same), f"{share:.0f}"])
        for survivor in each["survivors"]:
            name = _name(survivor)
            if name not in since:
                living.append(f"- `{name}`: {known.get(name, {}).get('why', 'no fast test detects it')}")
    yield _filled(
        "`bench_mutants` makes small random changes to functions. It then runs the tests of the source "
        "folder that execute the changed line and take less than 2 s. The goal is to detect "
        f"{DETECTED:.0f} % of the changes that affect the behavior. "
        '"Detected later" counts the changes that are detected by new tests, or by slower tests that the '
        "first run omitted. From seed 5 of core/motion on, the first run includes the slower tests. "
        '"Equivalent" counts the changes that do not affect the behavior.'
    )
    head = [
        "source folder",
        "changes",
        "detected in first run",
        "first run, %",
        "detected later",
        "equivalent",
    ]
    yield _table([*head, "detected of those not equivalent, %"], rows)
    if living:
        yield _filled(
            "No test detects the following changes. Each entry gives the file, the function, the change and "
            'the reason. "Is another" means that a constant has a different value, "with" names the new '
            'operator (GtE is ≥, LtE is ≤), and "left out" means that a statement was removed.'
        )
        yield "\n".join(living) + "\n"


def _name(survivor: Result) -> str:
    return f"{survivor['path']} {survivor['function']}: {survivor['words']}"


def _branches(result: Result, _folder: Path) -> Iterator[str]:
    rows: list[list[object]] = []
    for room, each in sorted(result["rooms"].items()):
        name = room.replace(
            "a whole run and the tests since", "a run of the whole test suite and later tests"
        )
        rows.append([name, each["branches"], each["taken"], f"{each['per cent']} %"])
        folders = each.get("folders", {})
        if len(folders) > 1:
            rows += [
                [f"— {name}", count, taken, f"{100.0 * taken / count:.1f} %"]
                for name, (count, taken) in folders.items()
                if count
            ]
    yield _filled(
        f"`bench_branches` counts the code branches that the tests of each source folder execute. The goal "
        f"is {WANTED:.0f} %."
    )
    yield _table(["source folder", "branches", "executed", "share"], rows)


if __name__ == "__main__":
    sys.stdout.write(page())
