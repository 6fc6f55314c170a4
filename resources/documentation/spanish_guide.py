"""Write the guide in Spanish from the English pages: ``python -m resources.documentation.spanish_guide``.

The command adds new and changed English texts to the catalog ``resources/translations/guide_es.po``, and
writes the pages to ``docs/guide/es``. Its exit status is the number of texts without a valid translation, up
to a maximum of 125. A page shows these texts in English with a note.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from babel.messages.catalog import Catalog

from core.page_contents import make_anchor
from resources.documentation.guide_catalog import (
    get_translation,
    is_contents_entry,
    is_translated_part,
    list_messages,
    read_catalog,
    update_catalog,
    write_catalog,
)
from resources.documentation.page_parts import PagePart, PartKind, join_parts, split_page
from resources.documentation.translation_check import find_faults
from resources.translations.collect import read_translations

PROJECT_FOLDER = Path(__file__).parents[2]
CATALOG_PATH = PROJECT_FOLDER / "resources" / "translations" / "guide_es.po"
GUIDE_FOLDER = PROJECT_FOLDER / "docs" / "guide"
PENDING_NOTE = "(En inglés: este texto ha cambiado y su traducción está pendiente.)"
_LANGUAGE = "es"
_LINK = re.compile(r"\]\(([^)\s#]*)(?:#([^)\s]+))?\)")
_MOST_FAULTS = 125
"""Largest exit status that a shell does not use for something else."""


def read_guide_pages(folder: Path | None = None) -> dict[str, str]:
    """Return the English pages of the guide by their file names."""
    return {
        path.name: path.read_text(encoding="utf-8") for path in sorted((folder or GUIDE_FOLDER).glob("*.md"))
    }


def translate_pages(
    pages: Mapping[str, str], catalog: Catalog, guide_folder: Path | None = None
) -> dict[str, str]:
    """Return the Spanish pages by their file names. ``guide_folder`` contains the English pages.

    A text without a valid translation remains in English and gets a note.
    """
    parts = {name: split_page(page) for name, page in pages.items()}
    translated = {name: [_translate_part(part, catalog) for part in each] for name, each in parts.items()}
    anchors = {name: _pair_anchors(parts[name], translated[name]) for name in pages}
    return {
        name: join_parts(
            _adapt_links(part, name, anchors, guide_folder or GUIDE_FOLDER) for part in translated[name]
        )
        for name in pages
    }


def _translate_part(part: PagePart, catalog: Catalog) -> PagePart:
    if is_contents_entry(part):
        title, _, anchor = part.text[1:].partition("](")
        return replace(part, text=f"[{get_translation(catalog, title) or title}]({anchor}")
    if not is_translated_part(part):
        return part
    translation = get_translation(catalog, part.text)
    if translation is None and part.kind in {PartKind.TEXT, PartKind.ROW}:
        translation = f"{part.text} {PENDING_NOTE}"
    return replace(part, text=translation or part.text)


def _pair_anchors(english: list[PagePart], translated: list[PagePart]) -> dict[str, str]:
    """Return the anchors of the translated headings by those of the English headings."""
    return {
        make_anchor(before.text): make_anchor(after.text)
        for before, after in zip(english, translated, strict=True)
        if before.kind is PartKind.HEADING
    }


def _adapt_links(
    part: PagePart, page: str, anchors: Mapping[str, Mapping[str, str]], guide_folder: Path
) -> PagePart:
    """Return the part with links as they must be in the folder of the translated pages."""

    def adapt(link: re.Match[str]) -> str:
        file, anchor = link[1], link[2]
        if "://" in file:
            return link[0]
        other = anchors.get(file or page, {})
        end = f"#{other.get(anchor, anchor)}" if anchor else ""
        return f"]({_find_file(file, file in anchors, guide_folder)}{end})"

    return part if part.kind is PartKind.OTHER else replace(part, text=_LINK.sub(adapt, part.text))


def _find_file(file: str, is_guide_page: bool, guide_folder: Path) -> str:
    """Return the path of a file from the folder of the translated pages."""
    if not file or is_guide_page:
        return file
    own = Path(file).parent / _LANGUAGE / Path(file).name  # the same picture of the translated screen
    return f"../{own.as_posix()}" if (guide_folder / own).is_file() else f"../{file}"


def find_catalog_faults(catalog: Catalog, screen_texts: Mapping[str, str]) -> list[str]:
    """Return the faults of a catalog, each with its English text.

    A translation that was made from an earlier English text is a fault.
    """
    faults = []
    for message in list_messages(catalog):
        english = str(message.id)
        translation = get_translation(catalog, english)
        found = ["made from an earlier English text"] if message.fuzzy else []
        found = found or find_faults(english, translation or "", screen_texts)
        faults += [f"{english}: {fault}" for fault in found]
    return faults


def main() -> int:
    """Update the catalog, write the pages, report faults and return their number."""
    pages = read_guide_pages()
    catalog = read_catalog(CATALOG_PATH)
    update_catalog(catalog, pages)
    write_catalog(catalog, CATALOG_PATH)
    folder = GUIDE_FOLDER / _LANGUAGE
    folder.mkdir(exist_ok=True)
    for former in folder.glob("*.md"):
        former.unlink()
    for name, page in translate_pages(pages, catalog).items():
        (folder / name).write_text(page, encoding="utf-8")
    faults = find_catalog_faults(catalog, read_translations(_LANGUAGE))
    sys.stderr.writelines(f"{fault}\n" for fault in faults)
    return min(len(faults), _MOST_FAULTS)


if __name__ == "__main__":
    sys.exit(main())
