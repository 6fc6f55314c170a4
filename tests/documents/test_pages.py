"""The pages: their links lead somewhere, their form fits the eye, and their words and commands are right."""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import pytest

from app.cli.command_parser import copy_screen_options
from app.cli.main import build_parser
from app.desk.command_errors import CommandError
from core.page_contents import make_anchor, make_table_of_contents
from tests.documents.pages import DOCS, GENERATED, ROOT, TRANSLATED_FOLDER, Command, Page, is_record, pages
from tests.glossary import AVOIDED, avoided

PICTURE_SUFFIXES = (".png", ".webp")

COLUMNS = 100
LONG = 120  # lines, from which on a page needs a table of contents
CHANGELOG = "CHANGELOG.md"  # is ordered by version and kind of change, and read from the top
SENTENCES = 5
ACCEPTED_WORDS: Mapping[str, tuple[str, ...]] = {
    "is no": ("is no longer",),  # the usual words for a state that has ended
}
"""Uses of an avoided word that are right, by the word."""
ACCEPTED_COMMANDS: Mapping[str, str] = {
    "turndesk update": "named in decision 0002 as a command that does not exist",
    "turndesk part.nc": "a program file in place of a command",
}
"""Commands in documents that the command line does not have, and why."""
PLACEHOLDERS: Mapping[str, str] = {
    "PARTS": "12",
    "COMMAND": "prove",
    "…": "FILE",
    "turndesk[shop]": "turndesk",
}
"""Words of a command that stand for a value which is not a file."""
ALL = pages()
WRITTEN = [page for page in ALL if page.name not in GENERATED]
named = pytest.mark.parametrize("page", WRITTEN, ids=lambda page: page.name)
every = pytest.mark.parametrize("page", ALL, ids=lambda page: page.name)


@cache
def _page(path: Path) -> Page:
    return Page(path)


@every
def test_links_and_their_anchors_exist(page: Page) -> None:
    missing = []
    for number, target in page.links:
        file, _, anchor = target.partition("#")
        if "://" in target or target.startswith("mailto:"):
            continue
        path = (page.path.parent / file).resolve() if file else page.path
        if not path.exists() or (anchor and anchor not in _page(path).anchors):
            missing.append(f"{page.name}:{number}: {target}")
    assert missing == []


def test_every_page_is_listed_in_the_index() -> None:
    index, records = Page(DOCS / "index.md"), Page(DOCS / "decisions" / "README.md")
    listed = {
        (page.path.parent / target.partition("#")[0]).resolve()
        for page in (index, records)
        for _, target in page.links
        if "://" not in target
    }
    listed.add(index.path)
    assert [page.name for page in ALL if DOCS in page.path.parents and page.path not in listed] == []


def test_code_names_only_documents_that_exist() -> None:
    named_in_code = {
        (path.relative_to(ROOT).as_posix(), document)
        for folder in ("app", "core", "drivers", "resources", "tests")
        for path in (ROOT / folder).rglob("*")
        if path.suffix in {".py", ".sh", ".toml", ".hal", ".csv"}
        for document in re.findall(r"\bdocs/[\w/.-]+\.md\b", path.read_text(encoding="utf-8"))
    }
    assert len(named_in_code) > 50
    assert sorted(each for each in named_in_code if not (ROOT / each[1]).is_file()) == []


def test_every_picture_is_used() -> None:
    used = {
        (page.path.parent / target).resolve()
        for page in ALL
        for _, target in page.links
        if target.endswith(PICTURE_SUFFIXES)
    }
    pictures = (path for path in (DOCS / "pictures").rglob("*") if path.suffix in PICTURE_SUFFIXES)
    assert sorted(str(path) for path in pictures if path not in used) == []


@named
def test_lines_are_wrapped(page: Page) -> None:
    too_long = [
        f"{page.name}:{line.number}"
        for line in page.lines
        if len(line.text) > COLUMNS
        and line.code is None
        and not line.text.lstrip().startswith("|")
        and "](" not in line.text
        and " " in line.text.strip()  # a single word cannot be wrapped
    ]
    assert too_long == []


@every
def test_a_long_page_has_a_table_of_contents(page: Page) -> None:
    if len(page.lines) <= LONG or is_record(page) or page.name == CHANGELOG:
        return
    chapters = [(number, title) for number, level, title in page.headings if level == 2]
    linked = {target for number, target in page.links if number < chapters[0][0]}
    assert [title for _, title in chapters if f"#{make_anchor(title)}" not in linked] == []


@named
def test_paragraphs_have_few_sentences(page: Page) -> None:
    if is_record(page):
        return
    too_long = [
        f"{page.name}:{paragraph.number}" for paragraph in page.paragraphs if paragraph.sentences > SENTENCES
    ]
    assert too_long == []


@every
def test_no_page_has_an_avoided_word(page: Page) -> None:
    if page.name.startswith(TRANSLATED_FOLDER):
        return
    text = re.sub(r"`[^`]*`", "x", page.prose.partition(AVOIDED)[0])
    text = re.sub(r"\]\([^)]*\)", "]", text)
    found = []
    for word in avoided():
        for use in ACCEPTED_WORDS.get(word, ()):
            text = re.sub(r"\s+".join(use.split()), lambda found: "\n" * found[0].count("\n"), text)
        pattern = r"\s+".join(map(re.escape, word.split()))
        found += [
            f"{page.name}:{text.count(chr(10), 0, match.start()) + 1}: {word}"
            for match in re.finditer(rf"(?<![-\w]){pattern}(?![-\w])", text, re.IGNORECASE)
        ]
    assert found == []


@pytest.mark.parametrize("word", ACCEPTED_WORDS)
def test_accepted_words_are_avoided_words_and_still_in_use(word: str) -> None:
    assert word in avoided()
    uses = ACCEPTED_WORDS[word]
    assert [use for use in uses if not any(use in page.prose for page in ALL)] == []


def arguments_of(command: str) -> list[str] | None:
    """Return the words after ``turndesk``, with values for placeholders; None for another command."""
    text = re.sub(r"\[(--[^\]]*)\]", r"\1", command)  # an option that may be left out
    lexer = shlex.shlex(text, posix=True, punctuation_chars="&>|;()<")
    lexer.whitespace_split = True
    words = list(lexer)
    if not words or words[0].rpartition("/")[2] != "turndesk":
        return None
    ends = [words.index(sign) for sign in ("&", ">", "|", ";", ")") if sign in words]
    return [PLACEHOLDERS.get(word, word) for word in words[1 : min(ends, default=len(words))]]


def commands_of(page: Page) -> Iterator[tuple[Command, list[str]]]:
    for command in page.commands:
        text = command.text.removeprefix("source <(")
        if re.match(r"(?:\S*/)?turndesk\s", text):
            arguments = arguments_of(text)
            if arguments is not None:
                yield command, arguments


@cache
def _parser() -> argparse.ArgumentParser:
    return build_parser()


def _named_parser(words: list[str]) -> tuple[argparse.ArgumentParser, list[str]]:
    """Return the parser of the command and action that begin these words, and the words after them."""
    parser, rest = _parser(), list(words)
    while True:
        below = next((each for each in parser._actions if isinstance(each, argparse._SubParsersAction)), None)
        if below is None or not rest or rest[0].startswith("-"):
            return parser, rest
        if rest[0] not in below.choices:
            raise CommandError(f"{rest[0]} is not a command", "")
        parser = below.choices[rest.pop(0)]


def _is_right(command: Command, arguments: list[str]) -> bool:
    """Return whether a command parses; of one that is only named, commands and options must exist."""
    try:
        if command.complete:
            copy_screen_options(_parser().parse_args(arguments))
            return True
        parser, rest = _named_parser(arguments)
        if parser is _parser() or any(not word.startswith("-") for word in rest):
            copy_screen_options(_parser().parse_args(arguments))
        return all(
            word.partition("=")[0] in parser._option_string_actions for word in rest if word[:2] == "--"
        )
    except (CommandError, SystemExit):
        return False


@every
def test_every_documented_command_is_valid(
    page: Page, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    wrong = [
        f"{page.name}:{command.number}: {command.text}: {capsys.readouterr().err.strip()}"
        for command, arguments in commands_of(page)
        if command.text not in ACCEPTED_COMMANDS and not _is_right(command, arguments)
    ]
    assert wrong == []


def test_accepted_commands_are_still_in_a_page() -> None:
    texts = {command.text for page in ALL for command in page.commands}
    assert [command for command in ACCEPTED_COMMANDS if command not in texts] == []


@every
def test_every_python_module_of_a_command_exists(page: Page) -> None:
    names = {
        name
        for command in page.commands
        for name in re.findall(r"python3? -m ([a-z_.]+)", command.text)
        if name.partition(".")[0] in {"app", "core", "drivers", "resources", "tests"}
    }
    assert sorted(name for name in names if find_spec(name) is None) == []


def test_links_and_commands_of_pages_are_found() -> None:
    """A page reader that finds nothing would let every test pass."""
    found = {arguments[0] for _, arguments in commands_of(Page(DOCS / "index.md"))}
    assert {"prove", "run", "offsets", "store", "machine", "setup", "scope"} <= found
    assert len([link for page in ALL for link in page.links]) > 300


def test_markdown_page_is_parsed(tmp_path: Path) -> None:
    path = tmp_path / "page.md"
    path.write_text(
        "# One `two` page\n\n- [A\n  link](other.md#x). Second.\n- Item\n\n```sh\nturndesk prove A\n```\n\n"
        "**Lead.** One. Two (e.g. here). Three!\n| `a` | b. |\n\n## One, two\n## One, two\n",
        encoding="utf-8",
    )
    page = Page(path)
    assert page.anchors == {"one-two-page", "one-two", "one-two-1"}
    assert list(page.links) == [(3, "other.md#x")]
    assert [(each.number, each.sentences) for each in page.paragraphs] == [(3, 2), (5, 0), (11, 3)]
    assert [(each.number, each.text) for each in page.commands if each.complete] == [(8, "turndesk prove A")]


def test_contents_link_to_the_headings() -> None:
    assert (
        make_table_of_contents(["Tools, offsets", "G02/G03"])
        == "- [Tools, offsets](#tools-offsets)\n- [G02/G03](#g02g03)\n"
    )


@pytest.mark.parametrize(
    "text",
    ["turndesk prve FILE", "turndesk prove FILE --nosuch", "turndesk run", "turndesk store backp FILE"],
)
def test_wrong_command_is_detected(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = arguments_of(text)
    assert arguments is not None
    assert not _is_right(Command(1, text, True), arguments)
    capsys.readouterr()
