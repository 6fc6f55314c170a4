"""Subprograms by name, their ends, skipped blocks, R parameters, and files beside the program."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from core.interpreter.shared.actions import ProgramEnd
from core.language.called_files import load_called_files
from core.language.diagnostics import PROGRAM_STOP_ASSUMPTION
from core.language.source import Dialect, ProgramSource, load_source
from tests.sinumerik.lathe import good, refused, run, setup, source

NUT = ProgramSource("NUT.spf", "N10 G0 Z=IC(1)\nN20 C=IC(90)\nN30 M17\nN40 G0 Z99\n", Dialect.SINUMERIK)


def test_subprogram_runs_as_often_as_called() -> None:
    blocks = good(source("G0 Z0\nNUT P3\nG0 Z50", NUT))
    assert [block.z for block in blocks] == pytest.approx([0, 1, 1, 2, 2, 3, 3, 50])
    assert [block.line for block in blocks] == [1, 2, 2, 2, 2, 2, 2, 3]  # the line of the call is shown


def test_values_set_in_subprogram_remain_in_force() -> None:
    rough = ProgramSource("rough.spf", "G91 G1 F600 R1=5\nM17", Dialect.SINUMERIK)
    (block,) = good(source("ROUGH\nZ=IC(R1)", rough))
    assert (block.feed, block.z - block.z0) == pytest.approx((10, 5))


def test_programs_in_one_file_call_each_other() -> None:
    text = "%_N_PART_MPF\nG0 Z0\nCUT\nM30\n%_N_CUT_SPF\nG0 Z7\nM17\n"
    blocks = run(source(text)).blocks
    assert [block.line for block in blocks] == [2, 6, 4]  # lines of the file itself
    assert isinstance(blocks[-1].action, ProgramEnd)


def test_m17_also_ends_a_main_program() -> None:
    assert [type(b.action) for b in run("M17\nG0 Z5").blocks] == [ProgramEnd]


@pytest.mark.parametrize("code", ["M2", "M30"])
def test_nothing_runs_after_program_end(code: str) -> None:
    blocks = run(f"G0 Z1\nG0 Z2 {code}\nG0 Z400 C999").blocks
    assert [block.line for block in blocks] == [1, 2, 2]


@pytest.mark.parametrize("code", ["M2", "M17", "M30"])
def test_called_program_returns_at_its_end(code: str) -> None:
    inner = ProgramSource("inner.mpf", f"G0 Z1\nN5 {code}\nZ400", Dialect.SINUMERIK)
    assert [block.z for block in good(source("G0 Z0\nINNER\nZ7\nM30", inner))] == [0.0, 1.0, 7.0]


def test_missing_subprogram_is_reported_by_name() -> None:
    error = refused("G0 Z0\nN20 THREAD")
    assert (error.code, error.line) == ("subprogram-missing", 2)
    assert "THREAD" in error.message
    assert "THREAD.spf" in error.hint


def test_subprogram_error_is_reported_with_file_and_line() -> None:
    bad = ProgramSource("BAD.spf", "G0 Z1\nN7 G0 C400", Dialect.SINUMERIK)
    error = refused(source("G0 Z0\n\nBAD", bad))
    assert (error.code, error.line) == ("16830", 3)
    assert "BAD.spf line 2" in error.message
    assert "block N7 axis C" in error.message


def test_subprogram_error_after_program_stop_states_its_assumption() -> None:
    sub = ProgramSource("PROBE.spf", "R1=1/($AA_IW[X]-20)\nM17\n", Dialect.SINUMERIK)
    error = refused(source("G0 X20\nM0\nPROBE\nM30", sub))
    assert (error.line, error.code, error.assumptions) == (3, "arithmetic", (PROGRAM_STOP_ASSUMPTION,))


def test_recursive_subprogram_is_rejected() -> None:
    loop = ProgramSource("RING.spf", "G0 Z=IC(1)\nRING", Dialect.SINUMERIK)
    passed = run(source("RING", loop))
    assert [each.code for each in passed.errors] == ["recursion"]
    assert len(passed.blocks) < 20


def test_skip_blocks_are_skipped_under_block_delete() -> None:
    text = "G0 Z0\n/G0 Z1\n/7 N5 G0 Z2\nG0 Z3"
    assert len(good(text)) == 4
    assert [b.z for b in good(text, replace(setup(), block_delete=True))] == [0, 3]


def test_r_parameters_are_used_as_targets() -> None:
    blocks = good("R1=20 R2=-5 R3=R2\nG0 X=R1 Z=IC(R2)\nZ=AC(R3) C=DC(R1)")
    assert [value for b in blocks for value in (b.x, b.z)] == pytest.approx([10, 45, 10, -5])
    assert blocks[-1].c == pytest.approx(20)


def test_files_in_program_folder_are_found_in_any_case(tmp_path: Path) -> None:
    (tmp_path / "Nut.SPF").write_text("LOCH\nM17\n")
    (tmp_path / "loch.spf").write_text("G0 Z3\nM17\n")
    (tmp_path / "other.spf").write_text("G0 Z99\nM17\n")
    (tmp_path / "part.mpf").write_text("N5 NUT P2 ; twice\nM30\n")
    found = load_called_files(load_source(tmp_path / "part.mpf"), [tmp_path])
    assert [each.name.lower() for each in found.subprograms] == ["loch.spf", "nut.spf"]
    assert len(good(found)) == 2


def test_main_program_is_found_if_no_subprogram_has_its_name(tmp_path: Path) -> None:
    (tmp_path / "NUT.MPF").write_text("G0 Z3\nM30\n")
    (tmp_path / "loch.spf").write_text("G0 Z4\nM17\n")
    (tmp_path / "LOCH.MPF").write_text("G0 Z99\nM30\n")
    found = load_called_files(source("NUT\nLOCH\nNONE\nM30"), [tmp_path])
    assert [each.name for each in found.subprograms] == ["loch.spf", "NUT.MPF"]
    assert refused(found).code == "subprogram-missing"


def test_file_that_is_not_text_counts_as_missing(tmp_path: Path) -> None:
    (tmp_path / "nut.spf").write_bytes(b"\0\0")
    found = load_called_files(source("NUT"), [tmp_path])
    assert refused(found).code == "subprogram-missing"
