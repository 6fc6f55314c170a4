"""The Spanish guide: complete, made from the present English guide, and with the same keys and links."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

pytest.importorskip("babel")

from babel.messages.catalog import Catalog
from babel.messages.pofile import PoFileError

from resources.documentation import spanish_guide
from resources.documentation.guide_catalog import (
    collect_texts,
    list_messages,
    read_catalog,
    update_catalog,
    write_catalog,
)
from resources.documentation.page_parts import PartKind, join_parts, split_page
from resources.documentation.spanish_guide import (
    CATALOG_PATH,
    GUIDE_FOLDER,
    PENDING_NOTE,
    find_catalog_faults,
    read_guide_pages,
    translate_pages,
)
from resources.documentation.translation_check import find_faults
from resources.translations.collect import read_translations

ENGLISH = "Press `F2` FILE, then `READY` appears after 0.5 s: see [jog](jog.md#stop). **Wait** here."
SPANISH = "Pulse `F2` ARCHIVO; después de 0.5 s aparece `LISTO`: vea [manual](jog.md#stop). **Espere** aquí."
SCREEN_TEXTS = {"FILE": "ARCHIVO", "READY": "LISTO"}
PAGES = {
    "a.md": (
        "# Page\n\n- [Stop it](#stop-it)\n\nSee [below](#stop-it) and [b](b.md#one).\n\n## Stop it\n\nText.\n"
    ),
    "b.md": "# One\n\n![Jog](../pictures/jog.png) [x](../safety.md) ![Mill](../pictures/mill.png)\n",
}
TRANSLATIONS = {
    "Page": "Página",
    "See [below](#stop-it) and [b](b.md#one).": "Vea [abajo](#stop-it) y [b](b.md#one).",
    "Stop it": "Cómo parar",
    "Text.": "Texto.",
    "One": "Uno",
    "![Jog](../pictures/jog.png) [x](../safety.md) ![Mill](../pictures/mill.png)": (
        "![Manual](../pictures/jog.png) [x](../safety.md) ![Fresadora](../pictures/mill.png)"
    ),
}


def make_catalog(translations: Mapping[str, str] = TRANSLATIONS) -> Catalog:
    catalog = collect_texts(PAGES)
    for english, spanish in translations.items():
        catalog[english].string = spanish
    return catalog


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Folder of English pages, with one picture of the Spanish screen next to the folder."""
    pictures = tmp_path / "pictures" / "es"
    pictures.mkdir(parents=True)
    (pictures / "jog.png").touch()
    (tmp_path / "guide").mkdir()
    return tmp_path / "guide"


def test_catalog_contains_every_text_of_the_guide_once() -> None:
    texts = {message.id for message in list_messages(collect_texts(read_guide_pages()))}
    assert len(texts) > 1000
    assert {message.id for message in list_messages(read_catalog(CATALOG_PATH))} == texts


def test_every_text_has_a_correct_translation() -> None:
    assert find_catalog_faults(read_catalog(CATALOG_PATH), read_translations("es")) == []


def test_pages_are_those_of_the_catalog() -> None:
    made = translate_pages(read_guide_pages(), read_catalog(CATALOG_PATH))
    assert {path.name: path.read_text("utf-8") for path in (GUIDE_FOLDER / "es").glob("*.md")} == made
    assert [name for name, page in made.items() if PENDING_NOTE in page] == []


@pytest.mark.parametrize("name", read_guide_pages())
def test_parts_of_a_page_are_the_whole_page(name: str) -> None:
    page = read_guide_pages()[name]
    assert join_parts(split_page(page)).split() == page.split()


def test_page_is_split_into_its_parts() -> None:
    page = "# A\n\n1. One\n   two\n\n| `a` | b |\n|---|---|\n\n```sh\nrun x  # why\n# all\nrun\n```\n"
    parts = [part for part in split_page(page) if part.kind is not PartKind.OTHER]
    assert [(part.kind, part.lead, part.text) for part in parts] == [
        (PartKind.HEADING, "# ", "A"),
        (PartKind.TEXT, "1. ", "One two"),
        (PartKind.ROW, "| ", "`a` | b"),
        (PartKind.COMMENT, "run x  # ", "why"),
        (PartKind.COMMENT, "# ", "all"),
    ]  # fmt: skip


@pytest.mark.parametrize("mark", ["+", "-", "*", "#", "4.", "|"])
def test_wrapped_line_never_begins_with_a_mark(mark: str) -> None:
    """By hand: a line has 100 characters, so 99 of them leave no room for a blank and a mark."""
    lines = join_parts(split_page(f"{'x' * 97} y {mark} z\n")).splitlines()
    assert [line for line in lines if line.startswith(mark)] == []


def test_links_lead_to_the_translated_headings_pages_and_pictures(folder: Path) -> None:
    made = translate_pages(PAGES, make_catalog(), folder)
    assert made["a.md"] == (
        "# Página\n\n- [Cómo parar](#cómo-parar)\n\nVea [abajo](#cómo-parar) y [b](b.md#uno).\n\n"
        "## Cómo parar\n\nTexto.\n"
    )
    assert made["b.md"] == (
        "# Uno\n\n![Manual](../../pictures/es/jog.png) [x](../../safety.md) "
        "![Fresadora](../../pictures/mill.png)\n"
    )


def test_changed_text_is_marked_and_shown_in_english_with_a_note(folder: Path) -> None:
    catalog = make_catalog()
    changed = {**PAGES, "a.md": PAGES["a.md"].replace("See [below]", "Now see [below]")}
    update_catalog(catalog, changed)
    page = translate_pages(changed, catalog, folder)["a.md"]
    assert f"Now see [below](#cómo-parar) and [b](b.md#uno). {PENDING_NOTE}" in " ".join(page.split())
    assert "Vea" not in page
    faults = find_catalog_faults(catalog, {})
    assert len(faults) == 1
    assert faults[0].endswith("made from an earlier English text")


def test_new_text_is_shown_in_english_with_a_note(folder: Path) -> None:
    page = translate_pages({"a.md": "Quite new."}, make_catalog(), folder)["a.md"]
    assert page == f"Quite new. {PENDING_NOTE}\n"


def test_catalog_file_keeps_texts_marks_and_translations(tmp_path: Path) -> None:
    catalog, path = make_catalog(), tmp_path / "guide.po"
    catalog["Text."].flags.add("fuzzy")
    write_catalog(catalog, path)
    read = read_catalog(path)
    assert {message.id: message.string for message in list_messages(read)} == TRANSLATIONS
    assert [message.id for message in list_messages(read) if message.fuzzy] == ["Text."]


def test_equal_translation_has_no_fault() -> None:
    assert find_faults(ENGLISH, SPANISH, SCREEN_TEXTS) == []


@pytest.mark.parametrize(("right", "wrong", "fault"), [
    (SPANISH, " ", "not translated"),
    ("`F2` ARCHIVO", "`F3` ARCHIVO", "code spans: missing F2"),
    ("`F2` ARCHIVO", "`F2` FILE", "key labels: missing `F2` ARCHIVO"),
    ("`LISTO`", "`READY`", "code spans: missing LISTO"),
    ("`LISTO`", "LISTO", "code spans: missing LISTO"),
    ("`LISTO`", "`LISTO` `Y`", "number of code spans: unexpected `"),
    ("0.5 s", "0,5 s", "numbers: missing 0.5"),
    ("0.5 s", "5 s", "numbers: unexpected 5"),
    ("jog.md#stop", "jog.md", "links: missing jog.md#stop"),
    ("[manual](jog.md#stop)", "manual", "links: missing jog.md#stop"),
    ("**Espere**", "Espere", "bold marks: missing **"),
    ("vea", "vea | o", "cells: unexpected  | "),
])  # fmt: skip
def test_damaged_translation_is_detected(right: str, wrong: str, fault: str) -> None:
    assert right in SPANISH
    assert fault in find_faults(ENGLISH, SPANISH.replace(right, wrong), SCREEN_TEXTS)


def test_missing_translation_is_reported() -> None:
    catalog = make_catalog()
    catalog["Text."].string = ""
    assert find_catalog_faults(catalog, {}) == ["Text.: not translated"]


@pytest.mark.parametrize("damage", ["msgid unquoted\n", "stray words\n"])
def test_damaged_catalog_file_is_rejected(tmp_path: Path, damage: str) -> None:
    path = tmp_path / "guide.po"
    write_catalog(make_catalog(), path)
    path.write_text(path.read_text("utf-8") + f"\n{damage}", encoding="utf-8")
    with pytest.raises(PoFileError):
        read_catalog(path)


def test_missing_catalog_file_is_reported(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_catalog(tmp_path / "none.po")


def test_command_writes_the_pages_and_counts_the_faults(
    tmp_path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, page in PAGES.items():
        (folder / name).write_text(page, encoding="utf-8")
    (folder / "es").mkdir()
    (folder / "es" / "removed.md").touch()
    write_catalog(make_catalog({"Text.": "Texto."}), tmp_path / "guide.po")
    monkeypatch.setattr(spanish_guide, "CATALOG_PATH", tmp_path / "guide.po")
    monkeypatch.setattr(spanish_guide, "GUIDE_FOLDER", folder)
    assert spanish_guide.main() == len(TRANSLATIONS) - 1
    assert "One: not translated" in capsys.readouterr().err
    assert sorted(path.name for path in (folder / "es").iterdir()) == ["a.md", "b.md"]
