"""Collects every text that an operator can read: ``python -m resources.translations.collect``.

Whole sentences are taken as they are; what is put together gets holes (``LINE %1``). The catalogues (Qt's
``.ts``) get what is new, ``pyside6-lrelease`` compiles them, ``templates.txt`` names the texts with holes.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from itertools import count
from pathlib import Path

from app.shapes.drawing_form import PROFILE
from core.access.access_table import Act, Level
from core.alarms import CATALOGUE
from core.interpreter.dialects import code_book
from core.interpreter.omniturn.code_table import CHAPTERS
from core.language.klartext import klartext_faults
from core.language.sinumerik.cycle_names import CYCLES, CYCLES_OUTSIDE
from core.language.sinumerik.outside_words import OUTSIDE
from core.language.sinumerik.word_table import FUNCTIONS, M_FUNCTIONS, WORDS
from core.language.source import Dialect
from core.shapes.shape_fields import Field, choice_text
from core.shapes.shape_table import HELPERS, SHAPES, SINUMERIK_HELPERS, SINUMERIK_SHAPES
from core.shapes.thread_series import Series
from resources.translations.reading import marked, texts_of

HERE = Path(__file__).parent
HOUSE = HERE.parents[1]
CONTEXT = "turndesk"
LANGUAGES = ("es",)
# Of composing, what is said while the screen is open; the rest goes to the console before there is one.
COMPOSING = "app/compose"
COMPOSED = (
    "desk_part.py",
    "gauge_wire.py",
    "journal.py",
    "screen_desk.py",
    "sharing_desk.py",
    "simulated_backend.py",
    "desk_functions.py",
    "stored_offsets.py",
    "workshop.py",
)
ROOMS = (
    *(
        "app/automatic",
        "app/desk",
        "app/editor",
        "app/jobs",
        "app/jog",
        "app/mdi",
        "app/offsets",
        "app/part",
        "app/path",
        "app/programs",
        "app/quality",
    ),
    *("app/scope", "app/screen", "app/searchto", "app/shapes", "app/sharing"),
    *("app/special", "app/transfer"),
    "app/working_plane",
    *("core/alarms", "core/executor", "core/store", "core/interpreter"),
    *("core/language", "core/proving", "core/geometry", "core/motion", "core/part", COMPOSING),
    *("core/drawings", "core/quality", "core/records", "core/shapes", "core/sharing", "core/access"),
    "app/shopfloor",
)
# Where much is told to programs: what is marked alone.
MARKED_ALONE = frozenset({"app/shopfloor"})
# Scripts and tables that no screen shows, and what the console is told where there is no screen.
APART = frozenset(
    {
        *(
            "access_page.py",
            "access_page.py",
            "access_table.py",
            "code_entry.py",
            "code_table.py",
            "language_page.py",
            "keys.py",
            "run_without_screen.py",
        ),
        *("desk/command_errors.py", "desk/toml_file.py", "offsets/offsets_file.py", "screen/display.py"),
        *("sharing/git_command.py", "shared_git.py", "shared_database.py", "sharing/version_record.py"),
        *("screen/pdf_pages.py", "shapes/sinumerik_lines.py", "shapes/bar_lines.py"),
        *("shapes/live_lines.py", "shapes/sinumerik_live_lines.py"),
        *(
            "klartext_book.py",
            "klartext_cycle_book.py",
            "sinumerik_book.py",
            "calls_book.py",
            "cycles_book.py",
            "sinumerik/cycle_names.py",
            "word_table.py",
            "outside_words.py",
        ),  # see _of_books
    }
)
# Read by somebody, and not to be told from names by their looks.
ALSO = (
    "its certificate cannot be verified: %1",
    "it does not support TLS; use an address that begins with http://",
    "it closed the connection without a response",
    "it accepts TLS only; use an address that begins with https://",
    "its response is not HTTP",
    "its address contains characters that are not allowed in an address",
    "it rejects the user or the password of [announce] (Not authorized)",
    "it rejects the user or the password of [announce]",
    "it closed the connection without an MQTT response; check whether this is its port without TLS",
    "a drill",
    "a reamer",
    "a tap",
    "POINT +",
    "POINT -",
    "M03 FWD",
    "M04 REV",
    "M05 OFF",
    "done",
    "rapid",
    "none",
    "on",
    "off",
    "in/min",
    "in/rev",
    "IN/OUT",
    # Of the page for the office, and what the system says there.
    *("NO ANSWER", "no answer", "UNAVAILABLE", "STOPPED", "INTERRUPTED"),
    *("Connection refused", "No route to host", "Network is unreachable", "Name or service not known"),
    "JOB",
    "TRY",
    # Of what a backup differs in.
    "programs",
    "settings",
    "presets",
    "jobs",
    "users",
    "tools",
    "RED",
    # Of the signal tower.
    "TOOL LIFE USED UP, OR PARTS TO MEASURE",
    "STOP: FEED HOLD, M00, SINGLE BLOCK",
    "PART FINISHED, NO CYCLE RUNNING",
    "CYCLE RUNNING",
    "%1 · SIMULATED",
    # What the screen puts together of parts that are texts of their own.
    "LINE %1",
    "%1 WARNINGS",
    "1 WARNING",
    # A finding in one line, as an answer names it.
    "%1: error: %2 [%3]",
    "%1: error: %2 [%3] — %4",
    "%1: warning: %2 [%3]",
    "%1: warning: %2 [%3] — %4",
    "NOT COUNTED AS A PART: %1; %2 s",
    "NO COUNT is on",
    "wait until the axes are at rest",
    "%1 is %2, but must be between %3 and %4",
    "%1 would move to %2 from home, %3 beyond the travel limit of %4",
    "%1: character %2, %3, is not a valid %4; valid: %5",
    "Unexpected word in an %1 block",
    "Unexpected word in a %1 block",
    "starts",
    "ends",
    "passes",
    "pecks",
    "Type -.",
    "Type +.",
    "Type (.",
    "Type ).",
    "AND %1 MORE",
    "STOP %1: %2",
    "%1 TURNS ON",
    "%1 TURNS OFF",
    "%1 TURNED ON AND %2",
    "%1 TURNED OFF AND %2",
    "Line %1 begins inside the part, and no safe path leads there.",
    "With input %1 %2 at line %3: %4",
    "With input %1 %2 at line %3 and input %4 %5 at line %6: %7",
    # The same with nothing in a hole, which a template does not know.
    "the arc ends at its start point.",
    "the arc by %1 ends at its start point.",
    "%1 accepts no parameters, but the call passes %2.",
    "%1 accepts 1 parameter, but the call passes %2.",
    # What a fault of SINUMERIK begins with.
    "channel %1 block %2: %3",
    "channel %1 block in line %2: %3",
    "channel %1 block %2 axis %3: %4",
    "channel %1 block in line %2 axis %3: %4",
    "Alarm %1: channel %2 block %3: %4",
    "Alarm %1: channel %2 block in line %3: %4",
    "Alarm %1: channel %2 block %3 axis %4: %5",
    "Alarm %1: channel %2 block in line %3 axis %4: %5",
    "syntax error: %1",
    # What Klartext ends with where a line cannot be read on.
    "%1; found '%2'.",
    "%1; the line ends here.",
    "%1 needs CCA and R",
    "%1 are missing",
    "The formula needs a number or a parameter.",
    "The formula needs a number or a parameter for %1",
    "Not supported: %1 is not supported here.",
    "%1: this lathe has no axis %2.",
    "CYCLE%1: %2.",
    "Cycle not defined: Cycle %1 is a machine-builder cycle, and this machine has no such cycles.",
    "%1: The argument list %2.",
    "syntax error: The closing parenthesis of the parameter list is missing.",
    "%1: an R parameter must follow = or be assigned with =, such as R1=10.",
    "%1: R parameters are R0 to R%2.",
    "%1: the feed must be greater than 0.",
    "%1: the speed limit must be greater than 0.",
    # Too short, too like a code, or put together where nobody sees a sentence.
    "Lower %1.",
    "Raise %1.",
    "Comments start with a semicolon (;).",
    "Remove the character; comments start with ;",
    "M%1 is not a code of this machine.",
    "A vector has zero length.",
    "A projection angle of 90 degrees is not possible.",
    "The first and the second point are the same.",
    "The first and the third point are the same.",
    "No position of the rotary axes within their ranges produces this plane.",
    "BEGIN PGM and END PGM specify different units.",
    "BEGIN PGM appears twice.",
    "The stock sticks out so far that it whips at %1 rpm; it turns at %2.",
    # Last, for what has no words of its own around it: a code and why, and a sentence by its full stop.
    "%1: %2.",
    "%1.",
    # What stands in a hole, and is a single word or looks like a code.
    "approach",
    "departure",
    "C turns",
    # A choice that the drawing itself brings.
    "DRAWING UNIT: INCH",
    "DRAWING UNIT: AS DRAWN",
    "LAYER: ALL",
    "PgUp",
    "PgDn",
    # Of the event log: its kinds; what has changed in the file are its own words.
    *("access", "alarm", "change", "cleared", "confirmed", "disturbed", "end", "estop", "force"),
    *(
        "interrupted",
        "load",
        "machine",
        "offsets",
        "override",
        "part",
        "refused",
        "repeat",
        "restart",
        "start",
    ),
    *("starved", "state", "stop", "switch", "test", "thread", "uncounted", "warning"),
    "%1: the control stopped during its last run",
    "machine file %1 accepted",
    "machine file %1 accepted: %2",
    "machine file %1 accepted by %2",
    "machine file %1 accepted by %2: %3",
    # What a finding rests on; tools are names.
    "stock",
    "stock, %1",
)
LOUD = ("app", "core/alarms", "core/executor")  # where a single word in capitals is read by somebody
HOLE = re.compile(r"%\d|\{\w*(?:[:.][^{}]*)?\}")
_NO_TEXT = re.compile(
    r"^\s*(?!SELECT [A-Z][A-Z0-9 ,.:]*$)(SELECT|INSERT|UPDATE|DELETE|CREATE|PRAGMA|BEGIN|COMMIT) .*"
    r"|^\s*(WHERE|FROM|JOIN|LEFT|GROUP|ORDER|ON|AND) [^{]*[a-z].*"  # of ours those are in capitals
    r"|^F\d+$|^:memory:$|^[A-Z]{1,3}$|^XYZABC$|^Callable|^finger|^\(?\?|.*[{;]\s*$|^%[YHd]|.*QLineEdit"
    r"|(?!.*\{\w*\}$).*\}\s*$"  # a bracket that ends no hole
    r"|^(Page|Zoom|Pan|Shift) \w+$|^QWERTY|.*\\|^[A-Z]{2}\d"
    r"|^<(rect|svg|text) |^KeptPass|^'?mill tool'?$|^CYCLE (DEF|CALL)$"
)
_WORDS = re.compile(
    r"[^\W\d_]{2,}.*\s+.*[^\W\d_]{2,}|[^\W\d_]{2,}\s*[:.?…]$|[^\W\d_]{3,}[:;,]?\s+%|%\d\s+[^\W\d_]{2,}"
)
_CAPITALS = re.compile(r"[A-ZÁÉÍÓÚÑ][A-ZÁÉÍÓÚÑ'’-]+$")
_SHORT = frozenset(
    {
        "ON",
        "OFF",
        "MM",
        "ALL",
        "TIP",
        "PAD",
        "GO",
        "UP",
        "FIT",
        "ADD",
        "DEL",
        "OUT",
        "END",
        "SFM",
        "JOG",
        "MDI",
    }
)


def texts() -> dict[str, str]:
    """Every text, and the first file that has it."""
    found: dict[str, str] = {}
    for room in ROOMS:
        loud = room.startswith(LOUD)
        for path in sorted((HOUSE / room).rglob("*.py")):
            if not {path.name, f"{path.parent.name}/{path.name}"} & APART and (
                room != COMPOSING or path.name in COMPOSED
            ):
                tree = ast.parse(path.read_text(encoding="utf-8"))
                texts = texts_of(tree) if room not in MARKED_ALONE else ()
                read = {text for text in texts if _is_read(text, loud)}
                for text in sorted(read | set(marked(tree))):
                    found.setdefault(text, str(path.relative_to(HOUSE)))
    return {
        **dict.fromkeys(
            [*ALSO, *_of_levels(), *_loud_alarms(), *_of_codes(), *_of_books(), *_of_shapes()], ""
        ),
        **found,
    }


def _of_levels() -> list[str]:
    """The levels, and what each may change."""
    return [*(level.name for level in Level), *(act.value for act in Act)]


def _of_codes() -> list[str]:
    """What the code table says of codes to an operator; the rest of it is documentation."""
    codes = [code for _, chapter in CHAPTERS for code in chapter]
    said = {f"%1 {code.not_in_mdi}." for code in codes if code.not_in_mdi} | {code.group for code in codes}
    for refusal in (each for code in codes for each in code.plain_refusals):
        said |= {_with_numbered_holes(refusal.text), _with_numbered_holes(refusal.hint)}
    rules = [rule for code in codes for rule in code.rules.values()]
    said |= {rule.what for rule in rules if any("{what}" in each.text for each in rule.refusals)}
    return sorted(text for text in said if _is_read(text, False))


def _of_books() -> list[str]:
    """Chapters and meanings of the code books, which the editor shows."""
    books = [code_book(dialect) for dialect in Dialect]
    chapters = {title for book in books for title, _ in book.chapters}
    shown = chapters | {entry.what for book in books for entry in book.entries}
    shown |= {what for book in books for entry in book.entries for _, what in book.words_of(entry)}
    reasons = {entry.idle for entry in (*FUNCTIONS.values(), *WORDS.values(), *M_FUNCTIONS.values())}
    refused = {*OUTSIDE.values(), *CYCLES_OUTSIDE.values()} | {f"{name}: %1 %2." for name in CYCLES}
    refused |= {f"%1: {why}." for why in OUTSIDE.values()}
    refused |= {f"{name}: %1" for key, name in vars(klartext_faults).items() if key.isupper()}
    return sorted(shown | refused | {entry.group for entry in FUNCTIONS.values()} | reasons - {""})


def _of_shapes() -> list[str]:
    """Names of shapes and of their fields: many are single words."""
    tables = (SHAPES, SINUMERIK_SHAPES, HELPERS, SINUMERIK_HELPERS)
    shapes = (*(shape for table in tables for shape in table.values()), PROFILE)
    fields = [field for shape in shapes for field in shape.fields]
    labels = {field.label for field in fields if len(field.label) > 1}
    choices = {choice_text(field, choice) for field in fields for choice in _in_words(field)}
    return sorted({shape.name for shape in shapes} | labels | choices)


def _in_words(field: Field) -> tuple[str, ...]:
    """The choices that are words: series and classes of threads have names that all languages use."""
    if field.word == "SERIES":
        return (Series.OWN.value,)
    return () if field.word in {"CLASS", "SIZE"} else field.choices


def _with_numbered_holes(text: str) -> str:
    numbers = count(1)
    return re.sub(r"\{\w+\}", lambda _: f"%{next(numbers)}", text)


def _loud_alarms() -> list[str]:
    """Alarms that are shown in capitals and are not found by their small letters: M30, E-stop, C."""
    texts = [entry.text for entry in CATALOGUE.values()]
    return [text.upper() for text in texts if text != text.lower()]


def _is_read(text: str, loud: bool) -> bool:
    if text in _SHORT or "\n" in text:
        return loud and text in _SHORT
    bare = HOLE.sub("", text)
    if _NO_TEXT.match(text) or not re.search(r"[^\W\d_]{2}", bare):
        return False
    if bare != text and " " in bare and re.search(r"[^\W\d_]{3}", bare):
        return True
    return bool(_WORDS.search(text)) or (loud and bool(_CAPITALS.match(text)))


def catalogue(language: str) -> dict[str, str]:
    """What a ``.ts`` file holds: translations by text; unfinished ones are empty."""
    path = HERE / f"turndesk_{language}.ts"
    if not path.exists():
        return {}
    messages = ET.parse(path).getroot().iter("message")
    return {m.findtext("source", ""): m.findtext("translation", "") for m in messages}


def write(language: str, wanted: dict[str, str]) -> None:
    """The ``.ts`` file with exactly the wanted texts, keeping what is translated; and its ``.qm``."""
    known = catalogue(language)
    root = ET.Element("TS", version="2.1", language=language, sourcelanguage="en")
    context = ET.SubElement(root, "context")
    ET.SubElement(context, "name").text = CONTEXT
    for text, file in sorted(wanted.items(), key=lambda entry: (entry[1], entry[0])):
        message = ET.SubElement(context, "message")
        ET.SubElement(message, "location", filename=file)
        ET.SubElement(message, "source").text = text
        translation = ET.SubElement(message, "translation")
        translation.text = known.get(text, "")
        if not translation.text:
            translation.set("type", "unfinished")
    ET.indent(root)
    path = HERE / f"turndesk_{language}.ts"
    body = ET.tostring(root, encoding="unicode")
    path.write_text(f'<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n{body}\n', encoding="utf-8")
    release = Path(sys.executable).with_name("pyside6-lrelease")
    subprocess.run([release, "-silent", path, "-qm", path.with_suffix(".qm")], check=True)


def main() -> int:
    """Bring templates and catalogues up to date; the number of texts without a translation."""
    wanted = texts()
    holed = sorted(text for text in wanted if HOLE.search(text) and "\n" not in text)
    (HERE / "templates.txt").write_text("\n".join(holed) + "\n", encoding="utf-8")
    missing = 0
    for language in LANGUAGES:
        write(language, wanted)
        missing += sum(not text for text in catalogue(language).values())
    return missing


if __name__ == "__main__":
    sys.exit(min(main(), 125))
