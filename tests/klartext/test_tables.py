"""Datum tables and point tables beside a program, and programs that are selected."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from core.language.called_files import load_called_files
from core.language.klartext import parse_line
from core.language.klartext.named_files import find_called_programs, read_table_rows
from core.language.source import ProgramSource, load_source
from tests.klartext.running import TOOL, Ran, run_source, whole

DATUMS = """BEGIN VICE .D MM
NR   X         Y         Z         C         DOC
0    +0        +0        +0        +0        PLATE
2    +10.5     -5        +3        +0        LEFT VICE
7              +8                            ONLY Y
9    +1        +1        +1        +30       TURNED
[END]
"""
HOLES = """BEGIN HOLES .PNT MM
NR   X      Y      Z      FADE
0    +10    +20    +0     N
1    +30    +20    -2     N
2    +50    +20    +0     Y
[END]
"""
SLOT = "BEGIN PGM SLOT MM\nL IX+5 R0 F300\nEND PGM SLOT MM\n"
DRILL = "CYCL DEF 200 DRILLING ~\n Q200=2 ~\n Q201=-5 ~\n Q206=150 ~\n Q202=5 ~\n Q203=+0 ~\n Q204=30\n"


def beside(text: str) -> Ran:
    files = tuple(
        ProgramSource(name, each)
        for name, each in (("VICE.D", DATUMS), ("HOLES.PNT", HOLES), ("SLOT.H", SLOT))
    )
    return run_source(ProgramSource("T.H", whole(TOOL + text), subprograms=files))


def test_rows_are_read_by_their_columns() -> None:
    rows = read_table_rows(ProgramSource("VICE.D", DATUMS))
    assert rows[2] == {"X": 10.5, "Y": -5.0, "Z": 3.0, "C": 0.0}
    assert rows[7] == {"Y": 8.0}
    assert read_table_rows(ProgramSource("V.D", DATUMS.replace("MM", "INCH")))[2]["X"] == pytest.approx(266.7)
    assert [*read_table_rows(ProgramSource("HOLES.PNT", HOLES))] == [0, 1]
    assert [*read_table_rows(ProgramSource("V.D", DATUMS.replace("7  ", "²  ")))] == [0, 2, 9]
    assert read_table_rows(ProgramSource("EMPTY.D", "BEGIN EMPTY .D MM\n[END]\n")) == {}


@pytest.mark.parametrize("block", ["CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 #2", "TRANS DATUM TABLE TABLINE2",
                                   "Q5 = 2\nCYCL DEF 7.0 DATUM\nCYCL DEF 7.1 #Q5"])  # fmt: skip
def test_table_row_sets_datum(block: str) -> None:
    ran = beside(f'SEL TABLE "TNC:\\TAB\\vice.d"\n{block}')
    assert ran.codes == []
    assert ran.state.datum == (10.5, -5.0, 3.0)


def test_empty_cell_leaves_its_axis_unchanged() -> None:
    ran = beside('SEL TABLE "VICE.D"\nCYCL DEF 7.0 D\nCYCL DEF 7.1 #2\nCYCL DEF 7.0 D\nCYCL DEF 7.1 #7')
    assert ran.state.datum == (10.5, 8.0, 3.0)


def test_point_table_gives_pattern_points() -> None:
    ran = beside(f'L Z+40 R0 FMAX M3\n{DRILL}SEL PATTERN "HOLES.PNT"\nCYCL CALL PAT FMAX')
    assert ran.codes == []
    ends = [block.swivel.end for block in ran.blocks if block.kind is BlockKind.FEED and block.swivel]
    assert ends == [pytest.approx((10, 20, -5)), pytest.approx((30, 20, -7))]


def test_a_selected_program_is_called() -> None:
    ran = beside('SEL PGM "SLOT.H"\nL X+1 FMAX\nCALL SELECTED PGM')
    assert ran.codes == []
    assert sum(block.kind is BlockKind.FEED for block in ran.blocks) == 1


def test_tables_are_found_in_folder_of_program(tmp_path: Path) -> None:
    (tmp_path / "vice.d").write_text(DATUMS)
    (tmp_path / "t.h").write_text(whole('SEL TABLE "TNC:\\VICE.D"\nCYCL DEF 7.0 D\nCYCL DEF 7.1 #2'))
    source = load_called_files(load_source(tmp_path / "t.h"), [tmp_path])
    assert [each.name.upper() for each in source.subprograms] == ["VICE.D"]
    assert run_source(source).state.datum == (10.5, -5.0, 3.0)


@pytest.mark.parametrize(
    ("text", "code", "names"),
    [
        ("CYCL DEF 7.0 D\nCYCL DEF 7.1 #2", "Datum table missing", "selected"),
        ('SEL TABLE "VICE.D"\nCYCL DEF 7.0 D\nCYCL DEF 7.1 #3', "Datum table missing", "row 3"),
        ('SEL TABLE "VICE.D"\nCYCL DEF 7.0 D\nCYCL DEF 7.1 #9', "Wrong axis programmed", "C"),
        ('SEL TABLE "OTHER.D"', "Program not found", "OTHER.D"),
        ('SEL PATTERN "OTHER.PNT"', "Program not found", "OTHER.PNT"),
        ("CALL SELECTED PGM", "Program not found", "selected"),
        ('SEL PGM "OTHER.H"\nCALL SELECTED PGM', "Program not found", "OTHER.H"),
        ("SEL TABLE", "Syntax error", "name"),
        ("CALL SELECTED PGM 5", "Syntax error", "PGM"),
        ("CYCL DEF 7.0 D\nCYCL DEF 7.1 #2 X+5", "Syntax error", "cycle 7"),
    ],
)
def test_invalid_table_access_is_rejected(text: str, code: str, names: str) -> None:
    ran = beside(text)
    assert code in ran.codes
    assert any(names in each.message for each in ran.errors)


def test_files_are_named_without_their_folder() -> None:
    text = 'CALL PGM TNC:\\PARTS\\SLOT.H\nTRANS DATUM TABLE "VICE.D" TABLINE1\nCYCL DEF 12.1 %50'
    assert list(find_called_programs(ProgramSource("T.H", whole(text)))) == ["SLOT.H", "VICE.D", "50.H"]


def test_words_of_older_and_german_controls_are_accepted() -> None:
    """R, F and M without a value leave all as it is; ABST is DIST."""
    line = parse_line(1, "L X+10 Y+5 R F M")
    assert line.error is None
    assert parse_line(1, "PLANE SPATIAL SPA+10 SPB+0 SPC+0 MOVE ABST50 F500").error is None
    assert parse_line(1, "L X+10 R5").error is not None
