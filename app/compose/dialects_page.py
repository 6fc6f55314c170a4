"""Generator of the lists of languages, codes and shipped machines in ``docs/dialects.md``.

The command ``python -m app.compose.dialects_page docs/dialects.md`` replaces the text between the begin and
end marks of that file.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from app.compose.machine.machine_files import load_shipped_machine
from core.interpreter.dialects import DIALECT_NAMES, get_code_book
from core.language.source import Dialect, guess_dialect
from core.machine.machine_model import Machine
from core.message import Message

BEGIN_MARK = "<!-- generated: python -m app.compose.dialects_page docs/dialects.md -->"
END_MARK = "<!-- end of what is generated -->"
_ENDINGS = (".nc", ".txt", ".h", ".mpf", ".spf")
_REFERENCE_PAGES = {
    Dialect.OMNITURN: "language",
    Dialect.KLARTEXT: "klartext-codes",
    Dialect.SINUMERIK: "sinumerik-codes",
}
_MACHINES = Path(__file__).parents[2] / "resources" / "machines"


def load_shipped_machines() -> dict[str, Machine]:
    """Return every shipped machine. The keys are the names that ``--machine`` accepts."""
    names = sorted(path.stem for path in _MACHINES.glob("*.toml"))
    return {name: load_shipped_machine(name) for name in names}


def generate_dialects_text() -> str:
    """Return the generated text including its begin and end marks."""
    found = load_shipped_machines()
    return "\n".join([BEGIN_MARK, *_languages(found), "", *_shipped(found), END_MARK])


def update_dialects_page(text: str) -> str:
    """Return the page text with its generated part updated. Raises ValueError if a mark is missing."""
    before, mark, rest = text.partition(BEGIN_MARK)
    _, last, after = rest.partition(END_MARK)
    if not (mark and last):
        raise ValueError(f"the page needs the lines {BEGIN_MARK!r} and {END_MARK!r}")
    return before + generate_dialects_text() + after


def _languages(found: dict[str, Machine]) -> Iterator[str]:
    machines = "machines that use this language in MDI and SEARCHTO"
    yield f"| language | files | codes in the reference | {machines} |"
    yield "|---|---|---|---|"
    for dialect in Dialect:
        endings = " ".join(f"`{each}`" for each in _ENDINGS if guess_dialect(f"a{each}") is dialect)
        book = get_code_book(dialect)
        count = sum(len(entries) for _, entries in book.chapters)
        speak = [name for name, machine in found.items() if machine.mdi_language == str(dialect)]
        codes = Message(
            "[{count} in {chapters_count} chapters]({pages}.md)",
            count=count,
            chapters_count=len(book.chapters),
            pages=_REFERENCE_PAGES[dialect],
        )
        yield f"| {DIALECT_NAMES[dialect]} | {endings} | {codes} | {', '.join(speak)} |"


def _shipped(found: dict[str, Machine]) -> Iterator[str]:
    yield "| `--machine` | type | backend | axes |"
    yield "|---|---|---|---|"
    for name, machine in found.items():
        axes = " ".join(f"{axis.name}{'°' if axis.is_rotary else ''}" for axis in machine.axes)
        yield f"| {name} | {machine.kind} | {machine.backend} | {axes} |"


if __name__ == "__main__":
    page_path = Path(sys.argv[1])
    page_path.write_text(update_dialects_page(page_path.read_text("utf-8")), "utf-8")
