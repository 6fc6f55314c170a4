"""Collect every text that a person can read: ``python -m resources.translations.collect``.

A text with values is the template of a ``Message``, such as ``LINE {line}``. New texts are added to the
catalogs (Qt's ``.ts`` files), which ``pyside6-lrelease`` compiles. ``messages.csv`` lists every text by its
id.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Container, Mapping
from pathlib import Path

from app.compose.optional_features import extras
from core.access.access_table import AccessLevel, ProtectedChange
from core.alarms import CATALOG
from core.interpreter.dialects import get_code_book
from core.interpreter.omniturn.codes.code_table import CODE_CHAPTERS
from core.language.klartext import klartext_faults
from core.language.sinumerik.cycle_names import UNSUPPORTED_CYCLES
from core.language.sinumerik.unsupported_words import UNSUPPORTED_WORDS
from core.language.sinumerik.word_table import GROUP_BY_FUNCTION, INEFFECTIVE_WORDS
from core.language.source import Dialect
from resources.translations.message_list import write_list
from resources.translations.text_extraction import find_marked_texts, find_texts

CATALOG_FOLDER = Path(__file__).parent
PROJECT_FOLDER = CATALOG_FOLDER.parents[1]
CATALOG_CONTEXT = "turndesk"
LANGUAGES = ("es",)
# Of composing, what is said while the screen is open; the rest goes to the console before there is one.
COMPOSE_FOLDER = "app/compose"
COMPOSE_FILES = (
    "accepted_machine.py",
    "part_prover.py",
    "journal.py",
    "desk_assembly.py",
    "desk_services.py",
    "screen_desk.py",
    *("control_client.py", "control_slot.py", "live_control.py"),
    "simulated_backend.py",
    "stored_offsets.py",
    "program_proving.py",
)
SCREEN_FOLDERS = (
    *(
        "app/automatic",
        "app/desk",
        "app/editor",
        "app/jog",
        "app/mdi",
        "app/offsets",
        "app/part",
        "app/path",
        "app/programs",
        "app/production",
    ),
    *("app/scope", "app/screen", "app/searchto", "app/extras"),
    *("app/special", "app/transfer"),
    "app/working_plane",
    *("core/alarms", "core/executor", "core/store", "core/interpreter"),
    *("core/language", "core/proving", "core/geometry", "core/motion", "core/part", COMPOSE_FOLDER),
    *("core/production", "core/records", "core/extras", "core/access"),
    "app/shopfloor",
)
# Where much is told to programs or to the console: what is marked alone.
MARKED_ONLY_PATHS = ("app/shopfloor/", "app/extras/office/", "core/extras/sharing/shared_database.py")
# Scripts and tables that no screen shows, and what the console is told where there is no screen.
EXCLUDED_FILES = frozenset(
    {
        *(
            "access_page.py",
            "json_keys.py",
            "offsets_keys.py",
            "table_keys.py",
            "checks_page.py",
            "code_book_page.py",
            "access_table.py",
            "code_entry.py",
            "code_table.py",
            *("move_codes.py", "cycle_codes.py", "flow_codes.py"),
            "language_page.py",
            "key_table.py",
            "headless_run.py",
        ),
        "pages/guide_text.py",
        *("desk/command_errors.py", "desk/toml_file.py", "offsets/offsets_file.py", "screen/display.py"),
        *(
            "proof_scheduler.py",
            "sharing/version_record.py",
            "share_command.py",
            "location_wait.py",
        ),
        *("sharing_table.py", "sharing_check.py"),
        *("mtconnect/adapter_setup.py", "mtconnect_command.py", "pendant_setup.py"),
        *("office_setup.py", "office_check.py", "page_server.py", "shop_network_tables.py"),
        "profile_command.py",
        *("shapes_command.py", "shape_steps.py"),
        *("screen/pdf_pages.py", "lines/sinumerik_lines.py"),
        "lines/live_lines.py",
        *(
            "sinumerik/cycle_names.py",
            "word_table.py",
            "unsupported_words.py",
        ),  # see _of_books
    }
)
# Of optional features: what their commands print.
EXCLUDED_EXTRAS_ENDINGS = ("_command.py", "_check.py", "_json_keys.py")
# Read by somebody, and not to be told from names by their looks.
ADDITIONAL_TEXTS = (
    "the server does not support TLS; use an address that begins with http://",
    "the server closed the connection without a response",
    "the server accepts TLS only; use an address that begins with https://",
    "the server's response is not HTTP",
    "the address contains characters that are not allowed in an address",
    "the server rejects the user name or the password of [announce] (Not authorized)",
    "the server rejects the user name or the password of [announce]",
    (
        "the server closed the connection without an MQTT response; check whether the server "
        "uses this port without TLS"
    ),
    "a drill",
    "a reamer",
    "a tap",
    # Labels of function keys, heads of tables and names of functions that look like codes.
    *("POINT +", "POINT -", "CHAPTER +", "CHAPTER -", "COUNT +1", "COUNT -1", "SAV+LOAD", "SAV+MENU"),
    *("TOUCH L", "TOUCH X", "TOUCH Z", "USE", "BY", "X IS", "R PARAMETERS"),
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
    "TOOL LIFE USED UP, OR PART MEASUREMENT DUE",
    "STOP: FEED HOLD, M00, SINGLE BLOCK",
    "PART FINISHED, NO CYCLE RUNNING",
    "CYCLE RUNNING",
    # What the screen puts together of parts that are texts of their own.
    "1 WARNING",
    # A finding in one line, as an answer names it.
    "NO COUNT is on",
    "wait until the axes are at rest",
    "starts",
    "ends",
    "passes",
    "pecks",
    "Type -.",
    "Type +.",
    "Type (.",
    "Type ).",
    # The same with nothing in a hole, which a template does not know.
    "the arc ends at its start point.",
    # What a fault of SINUMERIK begins with.
    # What Klartext ends with where a line cannot be read on.
    "The formula needs a number or a parameter.",
    "syntax error: The closing parenthesis of the parameter list is missing.",
    # Too short, too like a code, or put together where nobody sees a sentence.
    "Comments start with a semicolon (;).",
    "Remove the character; comments start with ;",
    "A vector has zero length.",
    "A projection angle of 90 degrees is not possible.",
    "The first and the second point are the same.",
    "The first and the third point are the same.",
    "No position of the rotary axes within their ranges produces this plane.",
    "BEGIN PGM and END PGM specify different units.",
    "BEGIN PGM appears twice.",
    # Last, for what has no words of its own around it: a code and why, and a sentence by its full stop.
    # What stands in a hole, and is a single word or looks like a code.
    "approach",
    "departure",
    "the C axis turns",
    "PgUp",
    "PgDn",
    # Of the event log: its kinds; what has changed in the file are its own words.
    *(
        "access",
        "alarm",
        "change",
        "cleared",
        "confirmed",
        "disturbed",
        "end",
        "estop",
        "force",
    ),
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
    *("late", "rights", "starved", "state", "stop", "switch", "test", "thread", "uncounted", "warning"),
    # What a finding rests on; tools are names.
    "stock",
)
CAPITALS_FOLDERS = (
    "app",
    "core/alarms",
    "core/executor",
)  # where a single word in capitals is read by somebody
PLACEHOLDER_PATTERN = re.compile(r"\{\w*\}")
_NO_TEXT = re.compile(
    r"^\s*(?!SELECT [A-Z][A-Z0-9 ,.:]*$)(SELECT|INSERT|UPDATE|DELETE|CREATE|PRAGMA|BEGIN|COMMIT) .*"
    r"|^\s*(WHERE|FROM|JOIN|LEFT|GROUP|ORDER|ON|AND) [^{]*[a-z].*"  # of ours those are in capitals
    r"|^F\d+$|^:memory:$|^[A-Z]{1,3}$|^XYZABC$|^Callable|^finger|^\(?\?|.*[{;]\s*$|^%[YHd]|.*QLineEdit"
    r"|(?!.*\{\w*\}$).*\}\s*$"  # a bracket that ends no hole
    r"|^(Page|Zoom|Pan|Shift) \w+$|^QWERTY|.*\\|^[A-Z]{2}\d"
    r"|^[\w ,.-]* --json$|^One object\b|^[\w.*\[\]]+ \| "  # commands and keys in the reference of outputs
    r"|^<\w+ |^[^ ]*=\{[^ ]*; |^\s*WHERE .*= \?.*$|^KeptPass|^'?mill tool'?$|^CYCLE (DEF|CALL)$"
)
_WORDS = re.compile(
    r"[^\W\d_]{2,}.*\s+.*[^\W\d_]{2,}|[^\W\d_]{2,}\s*[:.?…]$"
    r"|^[^\W\d_]{3,} [A-Z]\.$"  # a verb and the letter of a word, such as a remedy
)
_LETTERS = re.compile(r"[^\W\d_]{2}")
_SENTENCE = 3  # words from which on a text of the command line is a sentence and no name
# Program lines, scripts of other programs and tables of words, which nobody reads as sentences.
FILE_ENDINGS_WITHOUT_SENTENCES = (
    "_book.py",
    "_lines.py",
    "cycle_names.py",
    "word_table.py",
    "unsupported_words.py",
    "hal_section.py",
    "hal_file_builder.py",
    "_keys.py",
    "alarms_page.py",
)
_CAPITALS = re.compile(r"(?:\d+ )?[A-ZÁÉÍÓÚÑ][A-ZÁÉÍÓÚÑ'’-]+$")
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


def collect_screen_texts() -> dict[str, str]:
    """Return every text that the screen shows, with the first file that contains the text.

    These texts are translated.
    """
    found: dict[str, str] = {}
    for room in SCREEN_FOLDERS:
        loud = room.startswith(CAPITALS_FOLDERS)
        for path in sorted((PROJECT_FOLDER / room).rglob("*.py")):
            if not _is_apart(path, room):
                place = path.relative_to(PROJECT_FOLDER).as_posix()
                marked_alone = place.startswith(MARKED_ONLY_PATHS) and path.name != "extra.py"
                for text in _texts_of_file(path, loud, marked_alone):
                    found.setdefault(text, str(path.relative_to(PROJECT_FOLDER)))
    tables = [*ADDITIONAL_TEXTS, *_of_levels(), *_loud_alarms(), *_of_codes(), *_of_books(), *_of_extras()]
    return {**dict.fromkeys(tables, ""), **found}


def collect_console_texts(screen_texts: Container[str]) -> dict[str, str]:
    """Return the texts of the command line and of the drivers, with their files.

    Texts in ``screen_texts`` are left out.
    """
    found: dict[str, str] = {}
    for top in ("app", "core", "drivers"):
        for path in sorted((PROJECT_FOLDER / top).rglob("*.py")):
            if not path.name.endswith(FILE_ENDINGS_WITHOUT_SENTENCES):
                for text in _texts_of_file(path, False, False):
                    if text not in screen_texts and len(text.split()) >= _SENTENCE:
                        found.setdefault(text, str(path.relative_to(PROJECT_FOLDER)))
    return found


def _is_apart(path: Path, room: str) -> bool:
    named = {path.name, f"{path.parent.name}/{path.name}"}
    driver = path.parent.name == "driver"  # of an optional feature
    if driver or (room == "app/extras" and path.name.endswith(EXCLUDED_EXTRAS_ENDINGS)):
        return True
    return bool(named & EXCLUDED_FILES) or (room == COMPOSE_FOLDER and path.name not in COMPOSE_FILES)


def _texts_of_file(path: Path, loud: bool, marked_alone: bool) -> list[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    read = () if marked_alone else (text for text in find_texts(tree) if _is_read(text, loud))
    return sorted(
        {
            *read,
            *(text for text in find_marked_texts(tree) if _LETTERS.search(PLACEHOLDER_PATTERN.sub("", text))),
        }
    )


def _of_levels() -> list[str]:
    """Return the names of the access levels and of the changes that they protect."""
    return [*(level.name for level in AccessLevel), *(act.value for act in ProtectedChange)]


def _of_codes() -> list[str]:
    """Return the texts of the code table that an operator can see.

    All other texts in the table are documentation.
    """
    codes = [code for _, chapter in CODE_CHAPTERS for code in chapter]
    said = {code.mdi_error_text for code in codes if code.mdi_error_text} | {
        code.mode_group for code in codes
    }
    for refusal in (each for code in codes for each in code.entry_errors):
        said |= {refusal.text, refusal.hint}
    rules = [rule for code in codes for rule in code.word_rules.values()]
    said |= {rule.description for rule in rules if any("{what}" in each.text for each in rule.errors)}
    return sorted(text for text in said if _is_read(text, False))


def _of_books() -> list[str]:
    """Return the chapters and meanings in the code books, which the editor shows."""
    books = [get_code_book(dialect) for dialect in Dialect]
    chapters = {title for book in books for title, _ in book.chapters}
    shown = chapters | {entry.what for book in books for entry in book.entries}
    shown |= {what for book in books for entry in book.entries for _, what in book.list_word_meanings(entry)}
    refused = {*UNSUPPORTED_WORDS.values(), *UNSUPPORTED_CYCLES.values()}
    refused |= {
        name for key, name in vars(klartext_faults).items() if key.isupper() and isinstance(name, str)
    }
    return sorted(shown | refused | {*GROUP_BY_FUNCTION.values(), *INEFFECTIVE_WORDS.values()})


def _of_extras() -> list[str]:
    """Return the texts in the tables of the optional features."""
    return [text for extra in extras().values() for text in extra.words()]


def _loud_alarms() -> list[str]:
    """Return all alarm texts that contain capital letters, in upper case as the screen shows them."""
    texts = [entry.text for entry in CATALOG.values()]
    return [text.upper() for text in texts if text != text.lower()]


def _is_read(text: str, loud: bool) -> bool:
    if text in _SHORT or "\n" in text:
        return loud and text in _SHORT
    bare = PLACEHOLDER_PATTERN.sub("", text)
    if _NO_TEXT.match(text) or not re.search(r"[^\W\d_]{2}", bare):
        return False
    if bare != text and " " in bare and re.search(r"[^\W\d_]{3}", bare):
        return True
    return bool(_WORDS.search(text)) or (loud and bool(_CAPITALS.match(text)))


def read_translations(language: str) -> dict[str, str]:
    """Return the finished translations in a ``.ts`` file, with the English texts as keys."""
    return {text: told for text, (told, finished) in _entries(language).items() if finished}


def _entries(language: str) -> dict[str, tuple[str, bool]]:
    """Return each translation and whether it is marked as finished, with the English texts as keys.

    The result is empty if the file does not exist.
    """
    path = CATALOG_FOLDER / f"turndesk_{language}.ts"
    if not path.exists():
        return {}
    found = {}
    for message in ET.parse(path).getroot().iter("message"):
        translation = message.find("translation")
        told = translation.text if translation is not None and translation.text else ""
        finished = bool(told) and translation is not None and translation.get("type") is None
        found[message.findtext("source", "")] = told, finished
    return found


def write_catalog(language: str, texts: dict[str, str], former_texts: Mapping[str, str]) -> None:
    """Write the ``.ts`` file with these texts and their translations, and compile the ``.qm`` file.

    ``former_texts`` maps the current English text of each reworded text to its former text. A reworded text
    retains its former translation, marked as unfinished.
    """
    known = _entries(language)
    root = ET.Element("TS", version="2.1", language=language, sourcelanguage="en")
    context = ET.SubElement(root, "context")
    ET.SubElement(context, "name").text = CATALOG_CONTEXT
    for text, file in sorted(texts.items(), key=lambda entry: (entry[1], entry[0])):
        message = ET.SubElement(context, "message")
        ET.SubElement(message, "location", filename=file)
        ET.SubElement(message, "source").text = text
        translation = ET.SubElement(message, "translation")
        former = known.get(former_texts.get(text, ""), ("", False))[0]
        translation.text, finished = known.get(text, (former, False))
        if not finished:
            translation.set("type", "unfinished")
    ET.indent(root)
    path = CATALOG_FOLDER / f"turndesk_{language}.ts"
    body = ET.tostring(root, encoding="unicode")
    path.write_text(f'<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n{body}\n', encoding="utf-8")
    release = Path(sys.executable).with_name("pyside6-lrelease")
    subprocess.run([release, "-silent", path, "-qm", path.with_suffix(".qm")], check=True)


def main() -> int:
    """Update the message list and the catalogs, and return the number of texts without a translation."""
    shown = collect_screen_texts()
    successors = write_list({**shown, **collect_console_texts(shown)})
    missing = 0
    for language in LANGUAGES:
        write_catalog(language, shown, successors)
        missing += len(shown) - len(read_translations(language))
    return missing


if __name__ == "__main__":
    sys.exit(min(main(), 125))
