"""``turndesk machine hal``: on stdout, in files that must not exist, as JSON."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import resources
from app.cli.main import main
from core.message import CodedError

Captured = pytest.CaptureFixture[str]


def test_hal_file_is_written_alone_to_stdout(capsys: Captured) -> None:
    assert main(["machine", "hal", "gt75-mesa-7i76e"]) == 0
    told = capsys.readouterr()
    assert told.out == resources.get_hal_path("gt75-mesa-7i76e.hal").read_text(encoding="utf-8")
    assert told.err == ""


def test_out_option_writes_new_files_and_lists_wiring(capsys: Captured, tmp_path: Path) -> None:
    out = tmp_path / "gt75-ethercat.hal"
    assert main(["machine", "hal", "gt75-ethercat", "--out", str(out)]) == 0
    told = capsys.readouterr()
    assert out.read_text(encoding="utf-8").startswith("# GT-75 EtherCAT")
    assert (tmp_path / "ethercat-conf.xml").exists()
    rows = [line.split() for line in told.out.splitlines()]
    assert ["EL1008", "channel", "2", "lcec.0.DI.din-1", "in-guard", "io.in.guard"] in rows
    assert "measure: " in told.out
    assert told.err == ""


@pytest.mark.parametrize("there", ["gt75-ethercat.hal", "ethercat-conf.xml"])
def test_existing_file_is_not_replaced(there: str, refusals: list[CodedError], tmp_path: Path) -> None:
    (tmp_path / there).write_text("mine", encoding="utf-8")
    assert main(["machine", "hal", "gt75-ethercat", "--out", str(tmp_path / "gt75-ethercat.hal")]) == 2
    (error,) = refusals
    assert error.code == "file-exists"
    assert str(tmp_path / there) in str(error)
    assert [each.name for each in tmp_path.iterdir()] == [there]
    assert (tmp_path / there).read_text(encoding="utf-8") == "mine"


def test_file_name_other_than_in_machine_file_is_reported(capsys: Captured, tmp_path: Path) -> None:
    assert main(["machine", "hal", "gt75-parport", "--out", str(tmp_path / "mine.hal")]) == 0
    assert "[hal] file is gt75-parport.hal, so TurnDesk loads that file" in capsys.readouterr().err


def test_hal_json_has_file_wiring_and_measurements(capsys: Captured) -> None:
    assert main(["machine", "hal", "gt75-mesa-7i97", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["board"] == "mesa-7i97"
    assert told["hal"] == resources.get_hal_path("gt75-mesa-7i97.hal").read_text(encoding="utf-8")
    assert {"place": "INPUT1", "pin": "hm2_7i97.0.inmux.00.input-01", "signal": "in-guard",
            "names": ["io.in.guard"]} in told["wires"]  # fmt: skip
    assert (told["beside"], told["out"]) == ({}, None)
    assert any("dial gauge" in note for note in told["measure"])


def test_all_invalid_pins_are_reported_at_once(capsys: Captured, tmp_path: Path) -> None:
    text = resources.read_machine_file("gt75-mesa-7i97.toml")
    file = tmp_path / "own.toml"
    file.write_text(text.replace("input-01", "input-91").replace("out-01", "out-06"), encoding="utf-8")
    assert main(["machine", "hal", str(file)]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert len(told.err.splitlines()) == 2
    assert 'io.in.guard = "hm2_7i97.0.inmux.00.input-91": the board does not have this pin' in told.err


@pytest.mark.parametrize("name", ["gt75", "gt75-canopen", "no-such-file.toml"])
def test_machine_without_a_hal_file_is_rejected(name: str, capsys: Captured) -> None:
    assert main(["machine", "hal", name]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_missing_output_folder_is_reported(refusals: list[CodedError], tmp_path: Path) -> None:
    assert main(["machine", "hal", "gt75-parport", "--out", str(tmp_path / "none" / "gt75-parport.hal")]) == 2
    assert [each.code for each in refusals] == ["cannot-write"]
