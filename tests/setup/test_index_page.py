"""The description for a package index: no link or picture that an index page cannot show."""

from __future__ import annotations

import re
from importlib.metadata import metadata
from xml.etree import ElementTree

import pytest

from resources.setup.index_page import convert_description, format_index_page
from resources.setup.lock import PROJECT_FOLDER, read_project_file

README = (PROJECT_FOLDER / "README.md").read_text(encoding="utf-8")


def targets_of(markdown_text: str) -> list[str]:
    """Return the targets of all links and pictures, as a renderer of Markdown finds them."""
    markdown = pytest.importorskip("markdown")
    html = markdown.markdown(markdown_text, extensions=["fenced_code", "tables"])
    page = ElementTree.fromstring(f"<page>{html}</page>")
    return [each.get(key, "") for each in page.iter() for key in ("href", "src") if each.get(key)]


def test_readme_for_an_index_has_no_relative_link_or_picture() -> None:
    assert [each for each in targets_of(README) if "://" not in each]  # the README has some
    assert [each for each in targets_of(format_index_page(README)) if "://" not in each] == []


def test_readme_for_an_index_has_all_its_headings_and_commands() -> None:
    page = format_index_page(README)
    for pattern in (r"^#+ .*", r"^sh \S+", r"^\.venv/\S+.*"):
        assert set(re.findall(pattern, README, re.MULTILINE)) <= set(re.findall(pattern, page, re.MULTILINE))
    assert "turndesk where" in page


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        ("See [the `a]` page](pages/a.md#b), [c](#d).", "See the `a]` page, c."),
        ("a\n\n![Alt](pages/a.png)\n\nb", "a\n\nb"),
        (
            "[web](https://a.org/x) and [mail](mailto:a@b.org)",
            "[web](https://a.org/x) and [mail](mailto:a@b.org)",
        ),
        ("```sh\n[x](y.md)\n```\n[x](y.md)", "```sh\n[x](y.md)\n```\nx"),
        ("a[1] (b) [c] (d)", "a[1] (b) [c] (d)"),
    ],
)
def test_only_relative_links_and_pictures_are_removed(written: str, expected: str) -> None:
    assert format_index_page(written).startswith(f"{expected}\n\n## Documentation\n")


def test_headers_of_the_metadata_do_not_change() -> None:
    written = b"Name: turndesk\nSummary: [x](y.md)\n\n[x](y.md)\n"
    assert convert_description(written).startswith(b"Name: turndesk\nSummary: [x](y.md)\n\nx\n")


@pytest.mark.parametrize("written", [b"Name: turndesk\n", b"Name: turndesk\n\n"])
def test_metadata_without_a_description_do_not_get_one(written: bytes) -> None:
    assert convert_description(written) == written


def test_metadata_that_an_index_shows_are_complete() -> None:
    shown = metadata("turndesk")
    assert shown["License-Expression"] == read_project_file()["project"]["license"]
    assert shown["Description-Content-Type"].partition(";")[0] == "text/markdown"
    for name in ("Author", "Keywords", "Summary", "Classifier", "Requires-Python", "License-File"):
        assert shown[name], name
