"""The documentation site: built without a warning, complete, and readable without a network or a server."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from app.desk.pages.alarm_help import find_alarm_address
from app.desk.pages.guide_text import find_page_address
from resources.documentation import build_site
from resources.documentation.build_site import SiteError
from resources.documentation.site_pages import Navigation, convert_lists, list_site_files, make_navigation
from tests.documents.pages import ROOT, pages
from tests.documents.test_help_addresses import NUMBERS, TOPICS


def paths_of(navigation: Navigation) -> Iterator[str]:
    for entry in navigation:
        for below in entry.values():
            yield from [below] if isinstance(below, str) else paths_of(below)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("material")
    folder = tmp_path_factory.mktemp("documentation") / "site"
    build_site.build_site(folder)
    return folder


@pytest.mark.long
def test_site_is_built_without_a_warning_and_has_every_page(site: Path) -> None:
    names = {page.path.relative_to(ROOT).as_posix() for page in pages()}
    made = {path.relative_to(site).as_posix() for path in site.rglob("*.html")}
    expected = {re.sub(r"README\.md$", "index.md", name).removesuffix("md") + "html" for name in names}
    assert sorted(expected - made - {".github/PULL_REQUEST_TEMPLATE.html"}) == []


@pytest.mark.long
def test_site_has_a_target_for_every_address_that_the_help_shows(site: Path) -> None:
    addresses = [find_page_address(topic, language) for topic in TOPICS for language in ("en", "es")]
    addresses += map(find_alarm_address, NUMBERS)
    missing = []
    for address in addresses:
        file, _, anchor = address.partition("#")
        if f'id="{anchor}"' not in (site / file).read_text("utf-8"):
            missing.append(address)
    assert missing == []


def test_pages_load_nothing_from_a_network(site: Path) -> None:
    loaded = re.compile(r'<(?:script|link|img|iframe)\b[^>]*\b(?:src|href)="?(?:https?:)?//')
    assert [path.name for path in site.rglob("*.html") if loaded.search(path.read_text("utf-8"))] == []
    styles = [path for path in site.rglob("*.css") if "url(http" in path.read_text("utf-8")]
    assert styles == []


@pytest.mark.long
def test_page_fits_a_telephone_and_has_search_without_a_server(site: Path) -> None:
    page = (site / "docs" / "integrator" / "wiring.html").read_text("utf-8")
    assert 'name="viewport" content="width=device-width,initial-scale=1"' in page
    assert 'src="../../iframe-worker.js"' in page
    assert "zero-speed relay" in (site / "search" / "search_index.js").read_text("utf-8")


def test_navigation_has_each_page_once() -> None:
    listed = list(paths_of(make_navigation(ROOT)))
    assert len(listed) == len(set(listed))
    found = {str(name) for name in list_site_files(ROOT) if name.suffix == ".md"}
    assert found ^ set(listed) == set()


def test_navigation_begins_with_readers() -> None:
    titles = [next(iter(entry)) for entry in make_navigation(ROOT)]
    assert titles[:5] == ["TurnDesk", "Operators", "Setters", "Programmers of parts", "Integrators"]


@pytest.mark.parametrize(("written", "expected"), [
    ("1. a\n\n   b\n2. c", "1. a\n\n    b\n\n2. c"),
    ("- a\n  - b\n    c\n- d", "- a\n    - b\n        c\n- d"),
    ("text\n- a\n- b", "text\n\n- a\n- b"),
    ("10. a\n\n    ```sh\n    - x\n      y\n    ```", "10. a\n\n    ```sh\n    - x\n      y\n    ```"),
    ("- a\n\ntext\n  b", "- a\n\ntext\n  b"),
])  # fmt: skip
def test_lists_of_github_are_indented_for_mkdocs(written: str, expected: str) -> None:
    """By hand: four spaces for each level, and a blank line before an item after a paragraph."""
    assert convert_lists(written) == f"{expected}\n"


@pytest.mark.parametrize("text", ["Do as in step\n4. Then stop.", "- as in step\n  4. Then stop."])
def test_number_at_the_start_of_a_wrapped_line_is_no_list_item(text: str) -> None:
    assert "4\\. Then" in convert_lists(text)


def project(folder: Path, link: str) -> Path:
    (folder / "docs" / "decisions").mkdir(parents=True)
    (folder / "README.md").write_text(f"# Start\n\nSee [it]({link}).\n")
    (folder / "docs" / "decisions" / "README.md").write_text("# Decisions\n")
    (folder / "docs" / "index.md").write_text(
        "# All\n\n## Readers\n\n| page |\n|---|\n| [D](decisions/README.md) |\n"
    )
    return folder


@pytest.mark.long
@pytest.mark.parametrize("link", ["missing.md", "docs/index.md#missing"])
def test_wrong_link_prevents_the_site(tmp_path: Path, link: str) -> None:
    pytest.importorskip("material")
    with pytest.raises(SiteError, match="missing"):
        build_site.build_site(tmp_path / "site", project(tmp_path / "project", link))
    assert not (tmp_path / "site").exists()


@pytest.mark.long
def test_site_contains_the_license_of_its_theme(site: Path) -> None:
    assert "Martin Donath" in (site / "assets" / "LICENSE").read_text("utf-8")


@pytest.mark.parametrize("fails", [False, True])
def test_site_for_packages_replaces_an_old_one_and_is_deleted_afterwards(
    fails: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "documents"
    monkeypatch.setattr(build_site, "PACKAGE_FOLDER", folder)
    monkeypatch.setattr(build_site, "build_site", Path.mkdir)
    folder.mkdir()
    (folder / "old.html").touch()
    with suppress(ZeroDivisionError), build_site.build_site_for_packages() as site:
        assert list(site.iterdir()) == []
        1 // int(not fails)
    assert not folder.exists()


def test_an_existing_folder_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert build_site.main([str(tmp_path)]) == 1
    assert "already exists" in capsys.readouterr().err


def test_missing_mkdocs_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build_site, "find_spec", lambda _: None)
    with pytest.raises(SiteError, match="not installed"):
        build_site.build_site(tmp_path / "site")
