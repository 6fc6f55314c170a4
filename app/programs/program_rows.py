"""The programs that can be chosen, with all that is known of each; how they are sorted."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk import formats
from app.desk.machine_status import Tone
from app.desk.persistence import Persistence
from app.desk.program_folder import ProgramFolders
from app.desk.sheet import Row, Sheet
from core.store.store_rows import RunRow

if TYPE_CHECKING:
    from app.programs.folder_chooser import Chooser
    from app.programs.program_list import ProgramList


@dataclass(frozen=True, slots=True)
class Program:
    """One file: bytes, seconds since 1970; ``sample`` ones are not the operator's and stay as they are."""

    name: str
    path: Path
    size: int
    changed: float
    sample: bool
    run: RunRow

    @property
    def key(self) -> tuple[str, float, int]:
        """Another text is another key: what was drawn of it stays good as long as this is the same."""
        return str(self.path), self.changed, self.size


def programs(shelf: ProgramFolders, own: Path, keep: Persistence) -> tuple[Program, ...]:
    """All programs of the shelf. Takes its time; raises StoreError when the store cannot be read."""
    runs = {row.program: row for row in keep.runs()}
    return tuple(
        Program(entry.name, entry.path, status.st_size, status.st_mtime, entry.path.parent != own, run)
        for entry in shelf.entries()
        if (status := _status(entry.path)) is not None
        for run in (runs.get(entry.name, RunRow(entry.name)),)
    )


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except OSError:
        return None  # it has gone between two looks


Rank = tuple[float, str]
Order = Callable[[Program], Rank]
# Newest and most on top; the name decides between equals.
ORDERS: Mapping[str, Order] = {
    "NAME": lambda p: (0.0, p.name.lower()),
    "DATE": lambda p: (-p.changed, p.name.lower()),
    "LAST RUN": lambda p: (_backwards(p.run.started), p.name.lower()),
    "PARTS": lambda p: (-p.run.parts, p.name.lower()),
    "SIZE": lambda p: (-p.size, p.name.lower()),
}


def _backwards(at: str | None) -> float:
    return -datetime.fromisoformat(at).timestamp() if at else 0.0


def sorted_by(order: str, found: Sequence[Program]) -> tuple[Program, ...]:
    """In the order of this name."""
    return tuple(sorted(found, key=ORDERS[order]))


def local(at: str | None) -> str:
    """A time of the store as a clock on the wall shows it; a dash where there is none."""
    return datetime.fromisoformat(at).astimezone().strftime("%Y-%m-%d %H:%M") if at else "—"


def day(seconds: float) -> str:
    """The time of a file in the same way."""
    return datetime.fromtimestamp(seconds).strftime("%Y-%m-%d %H:%M")


# --- How the list of programs, the marked one and the chooser of folders are written.


Detail = tuple[str, str]


def sheet_of(model: ProgramList) -> Sheet:
    """The list: name, date, last run, parts, best cycle."""
    rows = tuple(_row(program) for program in model.shown)
    count = f"{len(model.shown)} OF {len(model.all)} PROGRAMS" if model.find.text else f"{len(rows)} PROGRAMS"
    question, text = model.question, model.entry.text
    if not question and model.find.text:
        question, text = "FIND", model.find.text
    return Sheet(
        f"PROGRAMS  ·  {count}  ·  BY {model.order}",
        ("NAME", "CHANGED", "LAST RUN", "PARTS", "BEST"),
        (0.32, 0.25, 0.25, 0.09, 0.09),
        rows,
        model.marked if rows else -1,
        question=question,
        text=text,
        raw=frozenset({0, 1, 2}),
        figures=frozenset({3, 4}),
    )


def _row(program: Program) -> Row:
    run = program.run
    best = formats.duration(run.best) if run.best is not None else formats.NOTHING
    cells = (program.name, day(program.changed), local(run.started), str(run.parts), best)
    good = run.proof == "PROVED"
    lit = None if not run.proof else good
    return Row(cells, lit, Tone.RUN if good else Tone.ALARM)


def details_of(program: Program) -> tuple[Detail, ...]:
    """All that is known of the marked program."""
    run = program.run
    return (
        ("SIZE", _size(program.size)),
        ("WHERE", "SAMPLE" if program.sample else "OWN PROGRAM"),
        ("LAST RUN", f"{local(run.started)}  ·  {run.outcome}" if run.outcome else local(run.started)),
        ("PARTS", str(run.parts)),
        ("BEST CYCLE", _time(run.best)),
        ("LAST CYCLE", _time(run.latest)),
        ("PLANNED", _time(run.planned)),
        ("LAST PROOF", f"{run.proof}  ·  {local(run.proved)}" if run.proof else "NEVER PROVED"),
    )


def chooser_sheet(chooser: Chooser, title: str) -> Sheet:
    """Places, folders and programs."""
    rows = tuple(
        Row((spot.name, "FOLDER" if spot.folder else "PROGRAM", _size(spot.size) if spot.size else ""))
        for spot in chooser.spots
    )
    where = str(chooser.at) if chooser.at else "PLACES"
    return Sheet(
        f"{title}  ·  {where}",
        ("NAME", "", "FREE" if chooser.at is None else "SIZE"),
        (0.64, 0.18, 0.18),
        rows,
        chooser.marked if rows else -1,
        notes=(chooser.trouble,) if chooser.trouble else (),
        raw=frozenset({2} if chooser.at is None else {0, 2}),
        figures=frozenset({2}),
    )


def _time(seconds: float | None) -> str:
    return formats.duration(seconds) if seconds is not None else formats.NOTHING


def _size(size: int) -> str:
    for unit, most in (("B", 1e3), ("KB", 1e6), ("MB", 1e9)):
        if size < most:
            return f"{size / (most / 1e3):.{0 if unit == 'B' else 1}f} {unit}"
    return f"{size / 1e9:.1f} GB"
