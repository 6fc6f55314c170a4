"""``turndesk prove``: keys and units of the public JSON, figures by hand, refusals in one line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk

HEAD = "G90G94F300\nM03S2000\nT1\n"
KEYS = {
    "file", "dialect", "units", "blocks", "elementary", "diagnostics", "cycle_time_s", "cutting_time_s",
    "rapid_time_s", "dwell_time_s", "cutting_length", "rapid_length", "tools", "limits", "stock", "final",
}  # fmt: skip


def written(tmp_path: Path, text: str | bytes, name: str = "part.nc") -> Path:
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_prove_json_values_match_hand_calculation(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    # .5 in of cutting at .004 in/rev and 2000 rpm is 8 in/min: 3.75 s, ramps well under a hundredth.
    path = written(tmp_path, HEAD + "X.5Z.1\nG95F.004Z-.4\nG04F2\nG00X1\nM30\n")
    told = turndesk("prove", path, "--offsets", offsets, "--json")
    assert told.status == 0
    assert told.err == ""
    (proof,) = told.lines
    assert set(proof) >= KEYS
    assert (proof["dialect"], proof["units"], proof["tools"]) == ("omniturn", "inch", [1])
    assert proof["cutting_length"] == pytest.approx(0.5)
    assert proof["rapid_length"] == pytest.approx((0.5**2 + 0.1**2) ** 0.5 + 0.5)
    assert proof["cutting_time_s"] == pytest.approx(3.75, abs=0.01)
    assert proof["dwell_time_s"] == 2.0
    assert proof["limits"]["x"] == [0.5, 1.0]
    assert proof["limits"]["z"] == [-0.4, 0.1]
    assert proof["limits"]["rpm"] == [2000.0, 2000.0]
    assert proof["limits"]["feed_ipm"] == [8.0, 300.0]
    assert proof["final"] == {"x": 1.0, "z": -0.4, "c": 0.0}
    parts = ("cutting_time_s", "rapid_time_s", "dwell_time_s", "wait_time_s")
    assert proof["cycle_time_s"] == pytest.approx(sum(proof[key] for key in parts), abs=1e-5)


def test_arc_limits_include_its_crown(turndesk: Turndesk, example: Callable[[str], Path]) -> None:
    told = turndesk("prove", example("arc-r-diameter-barrel"), "--json")
    # Centre r .2 - sqrt(.635² - .15²), crown .635 further out; the rapid to .3 reaches further still.
    assert told.lines[0]["limits"]["x"] == [0.0, 0.3]
    assert told.lines[0]["cutting_length"] == pytest.approx(0.1 + 0.2 + 0.2 + 0.2 + 0.302856, abs=1e-5)


def test_several_files_give_a_line_each_and_the_worst_status(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    good = written(tmp_path, HEAD + "X.5Z.1\nM30\n")
    bad = written(tmp_path, HEAD + "X.5Z.1Q3\nM30\n", "bad.nc")
    told = turndesk("prove", good, bad, "--offsets", offsets, "--json")
    assert told.status == 1
    assert [line["file"] for line in told.lines] == [str(good), str(bad)]
    (finding,) = told.lines[1]["diagnostics"]
    assert (finding["line"], finding["column"], finding["severity"]) == (4, 7, "error")
    assert finding["hint"]
    assert finding["args"]
    assert all(str(value) in finding["message"] for value in finding["args"].values())


def test_unreadable_file_does_not_prevent_other_proofs(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    good = written(tmp_path, HEAD + "X.5Z.1\nM30\n")
    told = turndesk("prove", tmp_path / "none.nc", good, "--offsets", offsets, "--json")
    assert told.status == 2
    assert [each["file"] for each in told.lines] == [str(good)]
    assert told.err == f"turndesk: {tmp_path / 'none.nc'} cannot be read: No such file or directory.\n"


def test_soft_limit_error_names_line_axis_and_overrun(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    # Home to Z -6 is the travel; -6.25 is a quarter of an inch too far.
    told = turndesk(
        "prove",
        written(tmp_path, HEAD + "X.5Z.1\nZ-6.25\nM30\n"),
        "--offsets",
        offsets,
        "--json",
    )
    assert told.status == 1
    # That the tool is never fed is another matter.
    (finding,) = (each for each in told.lines[0]["diagnostics"] if each.get("check") != "unmade-cut")
    assert (finding["line"], finding["code"]) == (5, "soft-limit")
    assert "Z" in finding["message"]
    assert "0.2500 in" in finding["message"]


def test_arc_that_bulges_beyond_soft_limit_is_rejected(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    # Both ends stand at X 3.9, the half circle between them reaches 4.4; travel ends at 4.
    text = HEAD + "X3.9Z.5\nG94F20Z0\nG02X3.9Z-1R.5\nM30\n"
    told = turndesk("prove", written(tmp_path, text), "--offsets", offsets, "--json")
    assert [(d["line"], d["code"]) for d in told.lines[0]["diagnostics"]] == [(6, "soft-limit")]


def test_missing_tool_offset_is_a_warning_in_prove(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("prove", written(tmp_path, HEAD + "X.5Z.1\nM30\n"), "--json")
    assert told.status == 0
    (finding,) = told.lines[0]["diagnostics"]
    assert (finding["code"], finding["severity"], finding["line"]) == ("tool-offset-missing", "warning", 3)


UNREADABLE = {
    "empty": b"",
    "binary": bytes(range(256)) * 8,
    "utf-16": "G90\nM30\n".encode("utf-16"),
    "one line of a megabyte": b"G90X" + b"1" * 1_000_000,
}


@pytest.mark.parametrize("content", UNREADABLE.values(), ids=UNREADABLE)
def test_file_that_is_not_a_program_gives_one_clear_error(
    turndesk: Turndesk, tmp_path: Path, content: bytes
) -> None:
    told = turndesk("prove", written(tmp_path, content))
    assert told.status == 2
    assert told.out == ""
    assert told.err.count("\n") == 1
    assert "part.nc" in told.err


MISTAKES = {
    "parenthesis left open": ("G90(TEXT\nM30\n", 1, 4),
    "a number beyond all bounds": ("G90G94F300\nX1e999\nM30\n", 2, 3),
}


@pytest.mark.parametrize(("text", "line", "column"), MISTAKES.values(), ids=MISTAKES)
def test_error_has_line_and_column(
    turndesk: Turndesk, tmp_path: Path, text: str, line: int, column: int
) -> None:
    told = turndesk("prove", written(tmp_path, text), "--json")
    assert told.status == 1
    errors = [d for d in told.lines[0]["diagnostics"] if d["severity"] == "error"]
    assert [(d["line"], d["column"]) for d in errors] == [(line, column)]


@pytest.mark.parametrize(
    ("argv", "what"),
    [
        (("prove",), "FILE"),
        (("prove", "absent.nc"), "absent.nc"),
        (("prove", "absent.h"), "absent.h"),
        (("prove", "part.nc", "--machine", "absent.toml"), "absent.toml"),
        (("prove", "part.nc", "--offsets", "absent.toml"), "absent.toml"),
        (("prove", "part.nc", "--inputs", "absent.toml"), "absent.toml"),
        (("prove", "part.nc", "--dialect", "fanuc"), "fanuc"),
        (("forge",), "forge"),
    ],
)
def test_wrong_usage_and_unreadable_files_exit_with_status_2(
    turndesk: Turndesk, argv: tuple[str, ...], what: str
) -> None:
    told = turndesk(*argv)
    assert told.status == 2
    assert told.out == ""
    assert told.err.count("\n") == 1
    assert what in told.err


def test_prove_summary_has_blocks_and_tools(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    told = turndesk("prove", written(tmp_path, HEAD + "X.5Z.1\nM30\n"), "--offsets", offsets)
    assert "proved; 5 blocks, 4 elementary, T1" in told.out
