"""How the list of programs, the marked one and the chooser of folders are written."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.desk import formats
from app.desk.files.rows import Program, day, local
from app.desk.special.sheet import Row, Sheet
from app.desk.view import Tone

if TYPE_CHECKING:
    from app.desk.files.chooser import Chooser
    from app.desk.files.files import FilesDesk

Detail = tuple[str, str]


def sheet_of(model: FilesDesk) -> Sheet:
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
