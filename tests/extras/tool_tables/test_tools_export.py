"""``turndesk tools export``: values by hand, what the import reads back, and what LinuxCNC reads."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from core.extras.tool_tables.table_file import find_table_format, read_tool_table
from core.extras.tool_tables.tool_entry import TableReadingOptions, ToolTable
from core.store.store import Store
from tests.cli.conftest import Turndesk

RS274 = shutil.which("rs274")
ROUGHING: dict[str, str | float] = {
    "kind": "turning",
    "insert": "CNMG432",
    "holder": "MCLNR-124B",
    "entry": 95.0,
}
DRILL: dict[str, str | float] = {
    "kind": "drill",
    "diameter": 6.35,
    "point": 118.0,
    "flutes": 2,
    "length": 50.8,
}
BAR: dict[str, str | float] = {
    "kind": "boring",
    "insert": "CCMT060204",
    "holder": "S16-SCLCR06",
    "diameter": 16.0,
}
GROOVE: dict[str, str | float] = {"kind": "parting", "width": 3.0, "hand": "left", "length": 12.0}


@pytest.fixture
def tools(turndesk: Turndesk, home: Path) -> None:
    """Store five tools: turning, drill, boring, parting and one without a shape."""
    offsets: dict[int, dict[str, str | float]] = {
        1: {"x": 38.1, "z": -50.8, "nose_radius": 0.79375, "quadrant": 3, "remark": "=rough", "wear_x": 0.1},
        2: {"x": 12.7, "z": -25.4, "remark": "hole"},
        3: {"x": 10.0, "z": -20.0, "nose_radius": 0.4, "quadrant": 2},
        4: {"x": 11.0, "z": -21.0, "nose_radius": 0.2},
        5: {"x": 1.0, "z": 2.0},
    }
    with Store.open(home) as store:
        for number, row in offsets.items():
            store.offsets.tool_offsets.change_row(number, "touched off", row).result(60)
        for number, shape in {1: ROUGHING, 2: DRILL, 3: BAR, 4: GROOVE}.items():
            store.offsets.tool_shapes.change_row(number, "measured", shape).result(60)


def read(path: Path, unit: str = "", **options: object) -> ToolTable:
    return read_tool_table(path, find_table_format(path.name), TableReadingOptions(unit=unit, **options))  # type: ignore[arg-type]


@pytest.mark.usefixtures("tools")
def test_linuxcnc_table_in_inches(turndesk: Turndesk, tmp_path: Path) -> None:
    """38.1 mm = 1.5 in; 0.79375 mm = 1/32 in, so D = 1/16 in; quadrant 3 is orientation 2."""
    path = tmp_path / "tool.tbl"
    said = turndesk("tools", "export", path)
    assert said.status == 0
    first, second, *_ = path.read_text().splitlines()
    assert first == "T1 P1 X+1.500000 Z-2.000000 D0.062500 Q2 ;=rough CNMG432 MCLNR-124B"
    assert second == "T2 P2 X+0.500000 Z-1.000000 D0.250000 ;hole drill"
    assert re.search(r"T1: .*entering angle.*wear", said.out)
    assert re.search(r"T4: .*width", said.out)


@pytest.mark.usefixtures("tools")
@pytest.mark.parametrize("name", ["a.tbl", "a.csv", "a.json"])
@pytest.mark.parametrize("unit", ["in", "mm"])
def test_import_reads_back_what_was_exported(
    turndesk: Turndesk, tmp_path: Path, name: str, unit: str
) -> None:
    path = tmp_path / name
    assert turndesk("tools", "export", path, "--unit", unit, "--only", "1-4").status == 0
    found = read(path, unit if name == "a.tbl" else "").tools
    has_positions = name != "a.json"
    for number, shape in {1: ROUGHING, 2: DRILL, 3: BAR, 4: GROOVE}.items():
        values = {**found[number].offset_values, **found[number].shape_values}
        names = {"kind", "insert", "holder", "diameter"} & shape.keys()
        if name == "a.tbl" and number == 3:
            names.discard("diameter")  # D is the nose diameter of a boring tool
        names |= {"width", "point", "flutes", "length", "hand"} & shape.keys() if name != "a.tbl" else set()
        for each in names:
            wanted = shape[each]
            assert values[each] == (wanted if isinstance(wanted, str) else pytest.approx(wanted, abs=1e-4))
        assert ("x" in values) is has_positions
    assert found[1].offset_values["nose_radius"] == pytest.approx(0.79375, abs=3e-5)
    assert found[3].offset_values["nose_radius"] == pytest.approx(0.4, abs=3e-5)


@pytest.mark.usefixtures("tools")
def test_mapped_columns_of_a_csv_file(turndesk: Turndesk, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    columns = "number=Pos,x_diameter=Dia,z=Length,remark=Text"
    assert turndesk("tools", "export", path, "--map", columns, "--unit", "mm", "--only", "1-2").status == 0
    assert path.read_text() == (
        "Pos,Dia,Length,Text\n1,76.200000,-50.800000, =rough\n2,25.400000,-25.400000,hole\n"
    )
    mapped = {"number": "Pos", "x_diameter": "Dia", "z": "Length", "remark": "Text"}
    assert read(path, "mm", columns=mapped).tools[1].offset_values["x"] == 38.1


@pytest.mark.usefixtures("tools")
def test_fusion_library_has_no_tool_without_a_kind(turndesk: Turndesk, tmp_path: Path) -> None:
    path = tmp_path / "lathe.txt"
    said = turndesk("tools", "export", path, "--to", "fusion", "--unit", "mm")
    assert "T5" in said.out.splitlines()[-1]
    turning, drill, *_ = json.loads(path.read_text())["data"]
    assert (turning["type"], turning["unit"], turning["post-process"]["number"]) == (
        *("turning general", "millimeters", 1),
    )
    geometry = turning["geometry"]
    assert {key: geometry[key] for key in ("SC", "TC", "SCTY", "RA", "INSD", "S", "RE")} == {
        **{"SC": "C", "TC": "M", "SCTY": "G", "RA": 0.0, "INSD": 12.7, "S": 4.7625, "RE": 0.79375}
    }
    assert (turning["holder"]["THSC"], turning["holder"]["W"]) == ("L", 19.05)  # 12/16 in
    assert drill["geometry"] == {
        **{"DC": 6.35, "LCF": 50.8, "NOF": 2, "SIG": 118.0, "HAND": True, "CSP": False}
    }


@pytest.mark.usefixtures("tools")
@pytest.mark.skipif(RS274 is None, reason="LinuxCNC is not installed")
def test_linuxcnc_reads_the_table(turndesk: Turndesk, tmp_path: Path) -> None:
    table = tmp_path / "tool.tbl"
    assert turndesk("tools", "export", table).status == 0
    shown = "G43\n(debug,#5400 #5401 #5403 #5410 #5413)\n"
    program = tmp_path / "part.ngc"
    program.write_text(f"G20 G18\nT1 M6\n{shown}T2 M6\n{shown}M2\n")
    settings = tmp_path / "lathe.ini"
    settings.write_text(
        f"[RS274NGC]\nPARAMETER_FILE = {tmp_path / 'rs.var'}\nLATHE = 1\n[EMCIO]\nTOOL_TABLE = {table}\n"
        "[TRAJ]\nAXES = 3\nCOORDINATES = X Z\nLINEAR_UNITS = inch\n"
    )
    (tmp_path / "rs.var").touch()
    words = [str(RS274), "-g", "-i", str(settings), "-t", str(table), str(program)]
    out = subprocess.run(words, capture_output=True, text=True, check=False, timeout=60).stdout
    found = [[float(word) for word in each.split()] for each in re.findall(r'MESSAGE\("([^"]*)"\)', out)]
    assert found == [[1, 1.5, -2, 0.0625, 2], [2, 0.5, -1, 0.25, 0]]


@pytest.mark.usefixtures("tools")
@pytest.mark.parametrize(
    ("name", "words", "code"),
    [
        ("a.fctb", (), "unknown-format"),
        ("a.dat", (), "unknown-format"),
        ("a.xyz", (), "unknown-format"),
        ("a.tbl", ("--map", "number=T"), "unknown-option"),
        ("a.csv", ("--map", "x=X"), "no-number-column"),
        ("a.csv", ("--map", "number=T,wear=W"), "unknown-key"),
        ("a.csv", ("--map", "number=T,d=D"), "unknown-key"),
        ("a.csv", ("--map", "number="), "no-value"),
        ("a.csv", ("--only", "33"), "unknown-number"),
        ("a.csv", ("--only", "9"), "no-tools"),
        ("a.json", ("--only", "5"), "no-tools"),
        ("missing/a.csv", (), "no-folder"),
    ],
)
def test_invalid_exports_are_rejected(
    turndesk: Turndesk, tmp_path: Path, name: str, words: tuple[str, ...], code: str
) -> None:
    path = tmp_path / name
    assert turndesk("tools", "export", path, *words).code == code
    assert not path.exists()


@pytest.mark.usefixtures("tools")
def test_existing_file_is_not_overwritten(turndesk: Turndesk, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("mine")
    assert turndesk("tools", "export", path).code == "file-exists"
    assert path.read_text() == "mine"


def test_empty_store_is_rejected(turndesk: Turndesk, tmp_path: Path) -> None:
    with Store.open(Path(tmp_path / "home")):
        pass
    assert turndesk("tools", "export", tmp_path / "a.csv").code == "no-tools"
