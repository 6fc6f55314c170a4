"""A process of its own reads a drawing: as it is, within its limits, until it is canceled, and in silence."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from core.extras.drawings import drawing_child, drawing_process
from core.extras.drawings.drawing import (
    Drawing,
    DrawingError,
    DrawnElement,
    decode_drawing,
    encode_drawing,
    encode_error,
)
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_process import ReadingLimits, read_drawing_in_process
from core.geometry.lines_and_arcs import Arc, Line
from tests.coded import raises_code
from tests.extras.drawings.hand import chain, dxf

linux = pytest.mark.skipif(sys.platform != "linux", reason="the limits of a process are Linux's")
BULGED = ((0, 0), (0, 4), (-8, 4, 0.3), (-8, 6), (-12, 6), (-12, 0))


@pytest.fixture
def hostile(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drawing_process, "_CHILD", "tests.extras.drawings.hostile_child")


def drawing(folder: Path, what: str) -> Path:
    path = folder / "part.dxf"
    path.write_text(what)
    return path


# --- what comes back


def test_drawing_read_in_a_process_is_identical(tmp_path: Path) -> None:
    path = dxf(tmp_path / "part.dxf", chain(*BULGED))
    here = read_drawing(path)
    assert any(isinstance(each.element, Arc) for each in here.elements)
    assert read_drawing_in_process(path) == here


def test_every_element_kind_survives_encoding() -> None:
    drawn = (
        DrawnElement(Line((0.1, -1e7), (1.0 / 3.0, 2.0)), "PART"),
        DrawnElement(
            Arc((0.0, 1.0), (1.0, 0.0), (0.0, 0.0), clockwise=True), "Ø — \u4e2d", is_center_line=True
        ),
        DrawnElement(Arc((0.0, 1.0), (1.0, 0.0), (0.0, 0.0), clockwise=False), ""),
    )
    one = Drawing("part.dxf", drawn, 25.4, {"TEXT": 3})
    assert decode_drawing(encode_drawing(one)) == one


def test_error_is_passed_on_with_its_code(tmp_path: Path) -> None:
    with raises_code(DrawingError, "damaged", "part.dxf"):
        read_drawing_in_process(drawing(tmp_path, "no drawing"))
    with raises_code(DrawingError, "unreadable", "none.svg"):
        read_drawing_in_process(tmp_path / "none.svg")
    with raises_code(DrawingError, "some-code", "why"):
        decode_drawing(encode_error(DrawingError("why", "some-code")))


def test_current_folder_is_not_on_the_import_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder of drawings may hold a file that is named as a module of Python's."""
    path = dxf(tmp_path / "part.dxf", chain(*BULGED))
    (tmp_path / "struct.py").write_text("raise SystemExit(0)\n")
    monkeypatch.chdir(tmp_path)
    assert read_drawing_in_process(Path(path.name)) == read_drawing(path)


# --- its limits


@pytest.mark.usefixtures("hostile")
def test_slow_drawing_process_times_out(tmp_path: Path) -> None:
    with raises_code(DrawingError, "too-slow", "part.dxf"):
        read_drawing_in_process(drawing(tmp_path, "hang"), limits=ReadingLimits(timeout_s=0.0))


@linux
@pytest.mark.usefixtures("hostile")
@pytest.mark.parametrize(
    ("what", "code"),
    [("spin", "too-slow"), ("grow", "out-of-memory"), ("die", "out-of-memory"), ("half", "out-of-memory")],
)
def test_excessive_resource_use_raises_one_error(what: str, code: str, tmp_path: Path) -> None:
    with raises_code(DrawingError, code, "part.dxf"):
        read_drawing_in_process(drawing(tmp_path, what), limits=ReadingLimits(processor_time_s=1))


@linux
def test_memory_limit_covers_imported_libraries(tmp_path: Path) -> None:
    path = dxf(tmp_path / "part.dxf", chain(*BULGED))
    with raises_code(DrawingError, "out-of-memory", "part.dxf"):
        read_drawing_in_process(path, limits=ReadingLimits(memory_bytes=24 * 1024**2))


def test_memory_error_in_a_library_raises_out_of_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def hungry(*_words: object) -> Drawing:
        raise MemoryError

    monkeypatch.setattr("core.extras.drawings.dxf_reader.read_dxf", hungry)
    with raises_code(DrawingError, "out-of-memory", "part.dxf"):
        decode_drawing(drawing_child.read_and_encode_drawing(drawing(tmp_path, "0\n")))


def test_process_start_failure_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_words: object, **_more: object) -> None:
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(subprocess, "Popen", refused)
    with raises_code(DrawingError, "unreadable", "part.dxf"):
        read_drawing_in_process(drawing(tmp_path, "x"))


# --- canceled


class CanceledError(Exception):
    """Of whoever waits."""


@linux
@pytest.mark.usefixtures("hostile")
def test_caller_can_cancel_and_the_process_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    started, asked, real = list[subprocess.Popen[bytes]](), list[float](), subprocess.Popen

    def start(*words: object, **more: object) -> subprocess.Popen[bytes]:
        started.append(real(*words, **more))  # type: ignore[call-overload]
        return started[-1]

    def cancel(seconds: float) -> None:
        asked.append(seconds)
        if len(asked) == 3:
            raise CanceledError

    monkeypatch.setattr(subprocess, "Popen", start)
    with pytest.raises(CanceledError):
        read_drawing_in_process(drawing(tmp_path, "hang"), cancel)
    assert asked == sorted(asked)
    assert started[0].returncode == -9


# --- in silence


@pytest.mark.usefixtures("hostile")
def test_library_output_is_suppressed(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with raises_code(DrawingError, "out-of-memory"):
        read_drawing_in_process(drawing(tmp_path, "print"))
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.dxf", "999\nx\n0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC9999\n0\nENDSEC\n0\nEOF\n"),
        ("b.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nP\n10\nx\n0\nENDSEC\n0\nEOF\n"),
        ("c.svg", '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0 L x 5 Q Q"/></svg>'),
        ("d.svg", "<svg"),
    ],
)
def test_command_error_is_one_line_without_library_text(name: str, text: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    start = "import sys; from app.cli.main import run_console; sys.exit(run_console())"
    told = subprocess.run(
        [sys.executable, "-c", start, "profile", str(tmp_path / name), "--list"],
        capture_output=True, check=False, text=True,
        env={**os.environ, "TURNDESK_HOME": str(tmp_path / "home")},
    )  # fmt: skip
    assert told.stderr.count("\n") == 1
    assert told.stderr.startswith("turndesk: ")
    assert not {"ezdxf", "svgelements", "Traceback", "xml", "token"} & set(told.stderr.lower().split())
