"""``prove --report FILE.pdf``: what the HTML says, on numbered pages; and what is refused."""

from __future__ import annotations

import html
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk
from tests.cli.test_prove import written
from tests.cli.test_report import PART
from tests.pdf_text import Pdf

BAD = PART.replace("G95F.004Z-.5", "G00Z-.5")
STOCK = ("--stock", "bar:1.0:2+.02")


def pdf_of(turndesk: Turndesk, tmp_path: Path, *words: object) -> Pdf:
    file = tmp_path / "report.pdf"
    told = turndesk("prove", *words, "--report", file)
    assert told.err == ""
    return Pdf(file)


def test_pdf_report_has_the_same_text_as_html(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path, page = written(tmp_path, BAD), tmp_path / "report.html"
    made = "".join(pdf_of(turndesk, tmp_path, path, "--offsets", offsets, *STOCK).pages)
    turndesk("prove", path, "--offsets", offsets, *STOCK, "--report", page)
    text = re.sub(r'<p class="made">.*?</p>|<svg.*?</svg>', "", page.read_text().split("<body>")[1])
    for words in filter(str.strip, re.split(r"<[^>]*>", text)):
        assert re.sub(r"\s", "", html.unescape(words)) in made


@pytest.mark.parametrize(("paper", "size"), [("a4", (210, 297)), ("letter", (216, 279))])
def test_pdf_pages_are_numbered_and_have_requested_paper_size(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, paper: str, size: tuple[int, int]
) -> None:
    given = (written(tmp_path, BAD), "--offsets", offsets, *STOCK, "--paper", paper)
    made = pdf_of(turndesk, tmp_path, *given)
    assert made.papers == {size}
    assert len(made.pages) > 1
    for number, words in enumerate(made.pages, 1):
        assert words.endswith(f"part.nc{number}")


def test_pdf_drawings_are_vector_graphics(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    with_part = pdf_of(turndesk, tmp_path, written(tmp_path, BAD), "--offsets", offsets, *STOCK)
    bare = pdf_of(turndesk, tmp_path, written(tmp_path, "G90G94F300\nM30\n"), "--offsets", offsets)
    assert with_part.photographs == 0
    drawn = sum(with_part.lines(page) for page in range(len(with_part.pages)))
    assert drawn > sum(bare.lines(page) for page in range(len(bare.pages))) + 40


def test_each_program_begins_a_page(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    folder = tmp_path / "parts"
    folder.mkdir()
    (folder / "a.nc").write_text("G90G94F300\nM30\n")
    (folder / "b.nc").write_bytes(b"\0")
    turndesk("prove", folder, "--offsets", offsets, "--report", tmp_path / "report.pdf")
    first, second = Pdf(tmp_path / "report.pdf").pages
    assert first.startswith("Proof")
    assert "a.nc" in first
    assert "Notproved" in second


def test_pdf_report_needs_no_display(tmp_path: Path, offsets: Path) -> None:
    around = {key: value for key, value in os.environ.items() if key not in {"DISPLAY", "QT_QPA_PLATFORM"}}
    around["TURNDESK_HOME"] = str(tmp_path / "home")
    words = ["prove", written(tmp_path, PART), "--offsets", offsets, "--report", tmp_path / "report.pdf"]
    subprocess.run([sys.executable, "-m", "app.cli.main", *map(str, words)], env=around, check=True)
    assert "Proved" in Pdf(tmp_path / "report.pdf").pages[0]


# --- what is refused


@pytest.mark.parametrize("report", [(), ("--report", "report.html")])
def test_paper_option_is_rejected_without_a_pdf_report(
    turndesk: Turndesk, tmp_path: Path, report: tuple[str, ...]
) -> None:
    told = turndesk("prove", written(tmp_path, PART), *report, "--paper", "a4")
    assert (told.status, told.out, told.err.count("\n")) == (2, "", 1)
    assert told.code == "paper-is-for-pdf"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_full_disk_leaves_the_previous_pdf_report_unchanged(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    report = written(tmp_path, "yesterday's", "report.pdf")
    (tmp_path / ".report.pdf.part").symlink_to("/dev/full")
    told = turndesk("prove", written(tmp_path, PART), "--offsets", offsets, "--report", report)
    assert told.status == 2
    assert "No space left on device" in told.err
    assert report.read_text() == "yesterday's"
    assert sorted(each.name for each in tmp_path.glob(".*.part")) == []
