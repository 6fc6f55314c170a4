"""``prove --report``: one HTML file that opens anywhere, escaped; and what is refused."""

from __future__ import annotations

import errno
import hashlib
import os
import re
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests.cli.conftest import Turndesk
from tests.cli.test_prove import written
from tests.texts import text as wording

pytestmark = pytest.mark.usefixtures("qapp")  # one asks for a PDF, whose fonts need an application

# Faced, turned to .8 in diameter .5 in long, drilled; the M00 holds what a browser would run.
PART = (
    "G90G94F300\nM03S1500\nT1(TURN)\nX.6Z.05\nG95F.006Z0\nX-.02\nG94F300Z.05\n"
    "X.4\nG95F.004Z-.5\nX.55\nM00(<script>go</script>)\nG94F300Z1\nT2(1/4 DRILL)\nX0Z.1\n"
    "G95F.004Z-.3\nG94F300Z1\nM30\n"
)


class Page(HTMLParser):
    """What a browser makes of a page: its tags and its visible text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.words = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag != "meta":
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words += data + "\n"


def report_of(turndesk: Turndesk, tmp_path: Path, *words: object) -> tuple[Page, str]:
    file = tmp_path / "report.html"
    turndesk("prove", *words, "--report", file)
    text = file.read_text(encoding="utf-8")
    return Page(text), text


def drawings(text: str) -> dict[str, ET.Element]:
    """The inline SVG by title; the last of each."""
    found = (ET.fromstring(each) for each in re.findall(r"<svg.*?</svg>", text))
    return {each.findtext("title", ""): each for each in found}


def extent(drawing: ET.Element, look: str) -> tuple[float, float]:
    """How wide and high, in pixels, what is drawn with this look is."""
    points = [
        tuple(map(float, pair.split(",")))
        for each in drawing.iter()
        if each.get("class") == look
        for pair in each.get("points", "").split()
    ]
    wide, high = zip(*points, strict=True)
    return max(wide) - min(wide), max(high) - min(high)


def test_html_report_has_all_sections_and_drawings(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = written(tmp_path, PART)
    page, text = report_of(turndesk, tmp_path, path, "--offsets", offsets, "--stock", "bar:1.0:2+.02")
    for words in (
        "Proved", "GT-75", "bar:1.0:2+.02", hashlib.sha256(PART.encode()).hexdigest(),
        "drill, Ø 0.2500 in, point 118° (assumed)", "M00", "Message to the operator", "Offsets",
    ):  # fmt: skip
        assert words in page.words
    assert page.open == []
    assert {"Section: stock and finished part", "Tool paths", "Tool outline"} == set(drawings(text))


def test_html_report_has_no_scripts_or_external_resources(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    page, text = report_of(turndesk, tmp_path, written(tmp_path, PART), "--offsets", offsets)
    assert "<script>go</script>" in page.words
    assert not {tag for tag, _ in page.tags} & {"script", "img", "link", "iframe", "object", "a"}
    assert not [
        name for _, attrs in page.tags for name in attrs if name.startswith("on") or name in {"src", "href"}
    ]
    assert "url(" not in text


def test_html_in_file_name_or_program_line_is_escaped(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    path = written(tmp_path, "G90G94F300\nQ<img src=x>\nM30\n", "a<b>&.nc")
    page, _ = report_of(turndesk, tmp_path, path, "--offsets", offsets)
    assert "a<b>&.nc" in page.words
    assert "Q<img src=x>" in page.words
    assert "img" not in {tag for tag, _ in page.tags}


def test_report_section_has_the_proportions_of_the_part(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    given = ("--offsets", offsets, "--stock", "bar:1.0:2+.02")
    _, text = report_of(turndesk, tmp_path, written(tmp_path, PART), *given)
    section = drawings(text)["Section: stock and finished part"]
    wide, high = extent(section, "stock")
    assert wide / high == pytest.approx(2.0, rel=0.01)
    part_wide, part_high = extent(section, "part")
    assert part_wide / wide == pytest.approx(1.98 / 2.0, rel=0.01)  # .02 in are faced off
    assert part_high == high  # behind the .8 in the bar is left


def test_part_finding_is_reported_with_its_line_and_a_picture(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    path = written(tmp_path, PART.replace("G95F.004Z-.5", "G00Z-.5"))
    page, text = report_of(turndesk, tmp_path, path, "--offsets", offsets, "--stock", "bar:1.0:2+.02")
    assert wording("cli.report-errors", errors="1 error") in page.words
    assert "Line 9\n error \nrapid-into-stock" in page.words
    assert "G00Z-.5" in page.words
    place = drawings(text)["Location of the finding"]
    assert extent(place, "wrong")[1] == 0.0  # a move along Z
    assert extent(place, "wrong")[0] > 50.0
    assert extent(place, "part")[0] > 50.0


def test_times_by_tool_add_up_to_the_cycle_time(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = written(tmp_path, PART)
    page, _ = report_of(turndesk, tmp_path, path, "--offsets", offsets)
    cycle = turndesk("prove", path, "--offsets", offsets, "--json").lines[0]["cycle_time_s"]
    words = page.words[page.words.index("Tools and times") : page.words.index("Stops")]
    figures = [float(each) for each in re.findall(r"^\d+\.\d$", words, flags=re.MULTILINE)]
    assert sum(figures) == pytest.approx(cycle, abs=0.05 * len(figures))


def test_report_covers_several_programs_and_an_unreadable_file(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    folder = tmp_path / "parts"
    folder.mkdir()
    (folder / "a.nc").write_text(PART)
    (folder / "b.nc").write_bytes(b"\0")
    (folder / "c.nc").write_text("G90G94F300\nQ3\nM30\n")
    page, first = report_of(turndesk, tmp_path, folder, "--offsets", offsets)
    assert [tag for tag, _ in page.tags].count("section") == 3
    assert "Not proved" in page.words
    again = report_of(turndesk, tmp_path, folder, "--offsets", offsets)[1]  # now from what is kept
    made = re.compile(r'<p class="made">[^<]*</p>')
    assert made.sub("", again) == made.sub("", first)
    files = sorted(folder.iterdir())
    assert made.sub("", report_of(turndesk, tmp_path, *files, "--offsets", offsets)[1]) == made.sub("", first)


def test_mill_program_has_a_report_without_a_turned_section(turndesk: Turndesk, tmp_path: Path) -> None:
    page, text = report_of(turndesk, tmp_path, "resources/programs/roof.h", "--machine", "ac-table-mill")
    assert "does not turn a part" in page.words
    assert drawings(text) == {}


# --- what is refused


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("nowhere/report.html", "cannot-write"),
        ("report.doc", "report-ending"),
        ("report", "report-ending"),
        ("folder.html", "report-is-folder"),
        ("nowhere/report.pdf", "cannot-write"),
    ],
)
def test_unwritable_report_path_is_rejected_in_one_line(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, name: str, code: str
) -> None:
    (tmp_path / "folder.html").mkdir()
    told = turndesk("prove", written(tmp_path, PART), "--offsets", offsets, "--report", tmp_path / name)
    assert (told.status, told.out, told.err.count("\n")) == (2, "", 1)  # before anything is proved
    assert told.code == code


@pytest.mark.parametrize("call", ["os.fsync", "pathlib.Path.replace"])
def test_full_disk_leaves_the_previous_report_unchanged(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    report = written(tmp_path, "yesterday's", "report.html")
    monkeypatch.setattr(call, full)
    told = turndesk("prove", written(tmp_path, PART), "--offsets", offsets, "--report", report)
    assert told.status == 2
    assert "No space left on device" in told.err
    assert report.read_text() == "yesterday's"
    assert sorted(each.name for each in tmp_path.glob(".*.part")) == []


# A flat .3 in from the axis, .5 in wide, milled across the end of a bar of 1 in.
FLAT = "G90G94F300G73\nT9\nX.9Z.1\nM19\nG04F1\nM15\nZ-.25\nF8X.3\nF300X.9\nZ1\nM16\nM05\nM30\n"
MILLS = 'tool.9 = {kind = "end-mill", diameter = .5, tip = 8, length = 1.0}\n'


def test_milled_part_is_drawn_with_its_tool_path(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    tools = written(tmp_path, MILLS, "tools.toml")
    words = (written(tmp_path, FLAT), "--offsets", offsets, "--tools", tools, "--stock", "bar:1.0:2")
    page, text = report_of(turndesk, tmp_path, *words)
    assert "not known" not in page.words
    assert "end-mill, Ø 0.5000 in" in page.words
    polygons = re.findall(r'<polygon class="part" points="([^"]+)"', text)
    upper, lower = (len(set(each.split())) for each in polygons[:2])
    assert upper > lower  # the pocket is on the side of X+
    assert 'class="cut"' in text
