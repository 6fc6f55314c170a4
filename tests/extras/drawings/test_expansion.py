"""Small files that would expand to millions of entities: counted before they are made, and refused."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import pytest
import svgelements

from core.extras.drawings import dxf_reader
from core.extras.drawings.drawing import MAX_ELEMENTS, DrawingError
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.reader_tools import BlockContent, check_block_expansion

LINE = "0\nLINE\n8\n0\n10\n0\n20\n0\n11\n1\n21\n1\n"


def block(name: str, content: str) -> str:
    return f"0\nBLOCK\n8\n0\n2\n{name}\n70\n0\n10\n0\n20\n0\n{content}0\nENDBLK\n"


def insert(name: str, columns: int = 1, rows: int = 1) -> str:
    array = f"70\n{columns}\n71\n{rows}\n44\n1\n45\n1\n" if columns * rows > 1 else ""
    return f"0\nINSERT\n8\n0\n2\n{name}\n10\n0\n20\n0\n{array}"


def dxf(path: Path, blocks: str, entities: str) -> Path:
    text = f"0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"
    path.write_text(text)
    return path


def nested(depth: int, times: int, leaf: str) -> str:
    inner = [insert(f"B{n + 1}") * times for n in range(depth)]
    return "".join(block(f"B{n}", each) for n, each in enumerate([*inner, leaf]))


def svg(path: Path, body: str) -> Path:
    names = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    path.write_text(f'<svg {names} width="10mm" height="10mm">{body}</svg>')
    return path


def uses(depth: int, times: int, href: str = "xlink:href") -> str:
    groups = [f'<g id="g{n}">' + f'<use {href}="#g{n - 1}"/>' * times + "</g>" for n in range(1, depth + 1)]
    return '<g id="g0"><path d="M0 0L1 1"/></g>' + "".join(groups)


def refused(path: Path, code: str) -> str:
    with pytest.raises(DrawingError) as told:
        read_drawing(path)
    assert told.value.code == code
    text = str(told.value)
    assert path.name in text
    assert "\n" not in text
    return text


@pytest.fixture
def nothing_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    def made(*_args: Any, **_more: Any) -> Any:
        raise AssertionError("expanded before it was counted")

    monkeypatch.setattr(dxf_reader, "_expand_blocks", made)
    monkeypatch.setattr(svgelements.SVG, "parse", made)


@pytest.mark.usefixtures("nothing_is_made")
@pytest.mark.parametrize(
    ("blocks", "entities"),
    [
        (block("A", LINE), insert("A", 30_000, 30_000)),
        (block("A", ""), insert("A", 30_000, 30_000)),  # no entity, and 9e8 insertions
        ("", insert("MISSING", 30_000, 30_000)),
        (nested(13, 4, LINE), insert("B0")),
        (nested(13, 4, ""), insert("B0")),
        (nested(2, 40, LINE), insert("b0", 8, 8)),  # 40 x 40 x 64 = 102 400; names ignore case
        (nested(5000, 2, ""), insert("B0")),  # deeper than Python's calls
    ],
)
def test_dxf_blocks_are_counted_before_insertion(blocks: str, entities: str, tmp_path: Path) -> None:
    assert str(MAX_ELEMENTS) in refused(dxf(tmp_path / "x.dxf", blocks, entities), "too-many-lines")


@pytest.mark.usefixtures("nothing_is_made")
@pytest.mark.parametrize(
    "blocks", [block("A", insert("A")), block("A", insert("B")) + block("B", insert("A") + LINE)]
)
def test_self_referencing_block_is_rejected(blocks: str, tmp_path: Path) -> None:
    refused(dxf(tmp_path / "x.dxf", blocks, insert("A")), "nested-blocks")


@pytest.mark.usefixtures("nothing_is_made")
@pytest.mark.parametrize("href", ["href", "xlink:href"])
@pytest.mark.parametrize(("depth", "times"), [(12, 4), (2, 300), (20, 2)])
def test_svg_uses_are_counted_before_parsing(depth: int, times: int, href: str, tmp_path: Path) -> None:
    body = uses(depth, times, href) + f'<use {href}="#g{depth}"/>'
    assert str(MAX_ELEMENTS) in refused(svg(tmp_path / "x.svg", body), "too-many-lines")


@pytest.mark.usefixtures("nothing_is_made")
def test_self_referencing_group_is_rejected(tmp_path: Path) -> None:
    body = '<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g>'
    refused(svg(tmp_path / "x.svg", body), "nested-blocks")


def test_ordinary_blocks_and_uses_are_read(tmp_path: Path) -> None:
    path = dxf(tmp_path / "x.dxf", block("A", LINE * 2) + block("B", insert("A") * 3), insert("B", 4, 5))
    assert len(read_drawing(path).elements) == 2 * 3 * 4 * 5
    assert len(read_drawing(svg(tmp_path / "x.svg", uses(2, 3) + '<use href="#g2"/>')).elements) == 22
    # g0 draws 1 line, g1 3, g2 9, and the last use 9 again.


def test_element_limit_is_exact(tmp_path: Path) -> None:
    """1 block of 1 + 499 entities, 100 times: 50 000 are read, and one more is refused."""

    def content(entities: int) -> Any:
        return lambda key: BlockContent(0, [(100, "A")]) if not key else BlockContent(1 + entities, [])

    check_block_expansion("x.dxf", "", content(499))
    with pytest.raises(DrawingError):
        check_block_expansion("x.dxf", "", content(500))
    check_block_expansion("x.svg", "", content(500), remaining_count=100)


@pytest.mark.parametrize(
    ("name", "text", "foreign"),
    [
        ("x.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n10\nabc\n", ["Invalid", "tag", "line"]),
        ("x.dxf", "hello\n", ["Invalid", "group code", "hello"]),
        ("x.svg", "<svg><g>", ["element", "column"]),
        ("x.svg", "<svg xmlns='http://www.w3.org/2000/svg'><path d='Q'/></svg>", ["list", "index"]),
    ],
)
def test_library_messages_do_not_reach_the_user(
    name: str, text: str, foreign: list[str], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    path = tmp_path / name
    path.write_text(text)
    with caplog.at_level(logging.DEBUG), pytest.raises(DrawingError) as told:
        read_drawing(path)
    assert not [each for each in foreign if each in str(told.value)]
    assert not [each for each in caplog.records if each.name.startswith("ezdxf") and each.levelno > 30]
