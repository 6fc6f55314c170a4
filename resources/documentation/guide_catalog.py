"""Gettext catalog of the guide: each text of the English pages with its translation."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from pathlib import Path

from babel.messages.catalog import Catalog, Message
from babel.messages.pofile import read_po, write_po

from core.page_contents import make_anchor
from resources.documentation.page_parts import PagePart, PartKind, split_page

LINE_LENGTH = 110
"""Length of the lines of a catalog file, in characters."""
_CONTENTS_ENTRY = re.compile(r"\[([^\]]*)\]\(#([^)]*)\)")


def is_contents_entry(part: PagePart) -> bool:
    """Return whether a part only links to the heading with the same text, as in a table of contents."""
    found = _CONTENTS_ENTRY.fullmatch(part.text)
    return part.kind is PartKind.TEXT and found is not None and make_anchor(found[1]) == found[2]


def is_translated_part(part: PagePart) -> bool:
    """Return whether the catalog contains the text of a part.

    Entries of a table of contents are written from the translated headings.
    """
    return part.kind is not PartKind.OTHER and not is_contents_entry(part)


def collect_texts(pages: Mapping[str, str]) -> Catalog:
    """Return a catalog without translations that contains the texts of these pages, given by their names."""
    catalog = Catalog()
    for name, page in pages.items():
        for part in split_page(page):
            if is_translated_part(part):
                catalog.add(part.text, locations=[(name, 0)])
    return catalog


def read_catalog(path: Path) -> Catalog:
    """Return the catalog that a file contains.

    Raises OSError if the file cannot be read, and PoFileError if it is damaged.
    """
    return read_po(io.BytesIO(path.read_bytes()), locale="es", abort_invalid=True)


def write_catalog(catalog: Catalog, path: Path) -> None:
    """Write the catalog to a file, without the texts that no page contains any longer."""
    for message in catalog:
        message.flags.discard("python-format")  # Babel sees a format in a text with a percent sign
    written = io.BytesIO()
    write_po(written, catalog, width=LINE_LENGTH, ignore_obsolete=True, include_lineno=False)
    path.write_bytes(written.getvalue())


def update_catalog(catalog: Catalog, pages: Mapping[str, str]) -> None:
    """Adapt the catalog to the texts of the pages.

    A new text that resembles a former one gets the translation of the former text, marked as fuzzy.
    """
    catalog.update(collect_texts(pages), update_creation_date=False)


def list_messages(catalog: Catalog) -> list[Message]:
    """Return the messages of a catalog without its header."""
    return [message for message in catalog if message.id]


def get_translation(catalog: Catalog, text: str) -> str | None:
    """Return the translation of a text, or None if it is missing or made from an earlier English text."""
    message = catalog.get(text)
    if message is None or message.fuzzy or not isinstance(message.string, str) or not message.string:
        return None
    return message.string
