"""List of all texts, ``messages.csv``, with the id and the English template of each text.

The id of a text does not change when the text is reworded: a new text receives the id of the most similar
text of the same folder that no longer exists.
"""

from __future__ import annotations

import csv
import difflib
import re
from collections.abc import Iterable, Mapping
from itertools import count
from pathlib import Path

LIST_PATH = Path(__file__).with_name("messages.csv")
_HOLE = re.compile(r"\{\w*\}")
_WORDS = 5  # of a text in its id
_SIMILAR = 0.6  # from this ratio on, a text is a reworded one; see difflib


def read_list() -> dict[str, str]:
    """Return the listed texts by id, or an empty dictionary if the list does not exist yet."""
    if not LIST_PATH.exists():
        return {}
    with LIST_PATH.open(newline="", encoding="utf-8") as file:
        return {row["id"]: row["english"] for row in csv.DictReader(file)}


def write_list(texts: Mapping[str, str]) -> dict[str, str]:
    """Write the list of texts, and return the former text of each reworded text.

    ``texts`` maps each text to the file that contains it.
    """
    former = read_list()
    known = {english: name for name, english in former.items()}
    gone = {name: english for name, english in former.items() if english not in texts}
    ids, successors = {text: known[text] for text in texts if text in known}, {}
    for text, path in texts.items():
        if text in known:
            continue
        old = _most_similar(text, _folder(path), gone)
        if old:
            successors[text] = gone.pop(old)
        ids[text] = old or _new_id(text, path, ids.values())
    with LIST_PATH.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("id", "english"))
        rows.writerows(sorted((name, text) for text, name in ids.items()))
    return successors


def _folder(file: str) -> str:
    """Return the first part of the ids for texts in ``file``: the package name, such as ``jog``."""
    return Path(file).parts[1].removesuffix(".py") if file else "tables"


def _most_similar(text: str, folder: str, gone: Mapping[str, str]) -> str:
    """Return the id of the deleted text that ``text`` replaces.

    Returns an empty string if there is no similar text.
    """
    found, best = "", _SIMILAR
    for name, english in gone.items():
        if (
            name.startswith(f"{folder}.")
            and (ratio := difflib.SequenceMatcher(None, english, text).ratio()) > best
        ):
            found, best = name, ratio
    return found


def _new_id(text: str, file: str, used: Iterable[str]) -> str:
    """Return a new unique id that consists of the first words of a text."""
    words = re.findall(r"[a-z0-9]+", _HOLE.sub("", text).lower())[:_WORDS]
    base = f"{_folder(file)}.{'-'.join(words)}"
    taken = frozenset(used)
    return next(name for n in count(1) if (name := base if n == 1 else f"{base}-{n}") not in taken)
