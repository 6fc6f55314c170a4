"""Documents and texts of the product have American spelling; codespell checks them where it is installed."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from resources.translations.message_list import read_list
from tests.documents.pages import ROOT, TRANSLATED_FOLDER, pages

CODESPELL = shutil.which("codespell")
NAMES = frozenset(
    {
        # of the trade
        "collet",
        "collets",
        # words of the languages, keys and commands
        "acn",
        "diamon",
        "hel",
        "relativ",
        "sav",
        # stored in programs that exist
        "aluminium",
        "centre",
        # file and folder names
        "licences",
    }
)
"""Words that codespell takes for mistakes."""
GLOSSARY_ROW = "| centre, millimetre | center, millimeter |"


def _report(*arguments: str) -> list[str]:
    done = subprocess.run(
        [
            str(CODESPELL),
            "--builtin",
            "clear,en-GB_to_en-US",
            "--ignore-words-list",
            ",".join(sorted(NAMES)),
            *arguments,
        ],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    assert done.returncode in {0, 65} or not done.stderr, done.stderr
    return done.stdout.splitlines()


@pytest.mark.skipif(CODESPELL is None, reason="codespell is not installed: apt install codespell")
def test_documents_have_no_misspelled_words() -> None:
    files = [page.name for page in pages() if not page.name.startswith(TRANSLATED_FOLDER)]
    assert _report("--ignore-regex", f"`[^`]*`|{re.escape(GLOSSARY_ROW)}", *files) == []


@pytest.mark.skipif(CODESPELL is None, reason="codespell is not installed: apt install codespell")
def test_product_texts_have_no_misspelled_words(tmp_path: Path) -> None:
    texts = tmp_path / "texts.txt"
    texts.write_text("\n".join(read_list().values()), encoding="utf-8")
    assert _report(str(texts)) == []


@pytest.mark.skipif(CODESPELL is None, reason="codespell is not installed: apt install codespell")
def test_misspelled_word_is_detected(tmp_path: Path) -> None:
    path = tmp_path / "page.md"
    path.write_text("Recieve the colour.\n", encoding="utf-8")
    assert len(_report(str(path))) == 2


def test_glossary_row_excluded_from_spelling_exists() -> None:
    assert GLOSSARY_ROW in (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
