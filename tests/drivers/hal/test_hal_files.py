"""The shipped HAL files: what ``turndesk machine hal`` writes, whole, and loaded by a real halrun.

A board that is not here is replaced by its pins (``board_pins``), the parallel port by LinuxCNC's
``sim_parport``; everything else of the file is loaded, set, called and wired as it stands.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

import resources
from app.compose.backends.hal_file_writer import build_hal_file
from app.compose.machine.machine_files import load_shipped_machine
from drivers.hal.boards.hal_file_builder import HalFile, render_hal_file
from tests.drivers.hal.board_pins import PINS, without_board

FILES = ("gt75-hal", "gt75-parport", "gt75-mesa-7i76e", "gt75-mesa-7i97", "gt75-ethercat")
STAND_IN = Path(__file__).parent / "board_stand_in.py"


def written(name: str) -> HalFile:
    return build_hal_file(load_shipped_machine(name))


@pytest.mark.parametrize("name", FILES)
def test_shipped_hal_file_matches_the_command_output(name: str) -> None:
    file = written(name)
    assert render_hal_file(file) == render_hal_file(written(name))
    assert resources.get_hal_path(f"{name}.hal").read_text(encoding="utf-8") == render_hal_file(file)
    for other, text in file.extra_files.items():
        assert resources.get_hal_path(other).read_text(encoding="utf-8") == text


@pytest.mark.parametrize("name", FILES)
def test_every_terminal_of_the_machine_file_is_on_a_net(name: str) -> None:
    file = written(name)
    wired = set()
    for line in render_hal_file(file).splitlines():
        words = line.split("#")[0].split()
        if words[:1] in (["net"], ["newsig"]):
            wired |= set(words[1:])
    missing = [path for path, pin in file.lathe.terminal_names.items() if pin not in wired]
    assert not missing
    told = {path for wire in file.wiring_rows for path in wire.names}
    assert set(file.lathe.terminal_names) <= told


@pytest.mark.parametrize("name", FILES)
def test_each_pin_is_on_one_signal_and_setpoints_are_added_once(name: str) -> None:
    on: dict[str, str] = {}
    text = render_hal_file(written(name))
    for line in text.splitlines():
        words = line.split("#")[0].split()
        if words[:1] == ["net"]:
            for pin in words[2:]:
                assert on.setdefault(pin, words[1]) == words[1], line
    assert text.splitlines().count("#turndesk") == 1
    assert (
        max(len(line) for line in text.splitlines() if not line.startswith("#")) < 255
    )  # of a HAL file's line


@pytest.mark.parametrize(
    ("name", "pin", "value"),
    [
        # .0001 in a step is .00254 mm; .00005 in a count is .00127 mm; .000002 in is .0000508 mm
        ("gt75-mesa-7i76e", "hm2_7i76e.0.stepgen.00.position-scale", 1 / 0.00254),
        ("gt75-parport", "stepgen.1.position-scale", 1 / 0.00254),
        ("gt75-mesa-7i97", "hm2_7i97.0.encoder.01.scale", 1 / 0.00127),
        ("gt75-ethercat", "cia402.x.pos-scale", 1 / 0.0000508),
        # 400 in/min is 169.33 mm/s; four counts a line
        ("gt75-mesa-7i97", "hm2_7i97.0.pwmgen.00.scale", 400 * 25.4 / 60),
        ("gt75-mesa-7i97", "hm2_7i97.0.encoder.02.scale", 4096),
        ("gt75-mesa-7i76e", "hm2_7i76e.0.7i76.0.0.spinout-scalemax", 3500),
    ],
)
def test_scales_are_in_millimeters_and_revolutions(name: str, pin: str, value: float) -> None:
    found = re.search(rf"^setp {re.escape(pin)} (\S+)", render_hal_file(written(name)), re.MULTILINE)
    assert found
    assert float(found[1]) == pytest.approx(value, rel=1e-8)


@pytest.mark.usefixtures("halrun")
@pytest.mark.parametrize("name", FILES)
def test_halrun_loads_the_hal_file(name: str, tmp_path: Path) -> None:
    """Every component, parameter, pin, direction and order of the file, by HAL itself; then it is started."""
    done = load(tmp_path, name, render_hal_file(written(name)))
    assert done.returncode == 0, done.stderr + done.stdout
    signals = re.findall(r"^(?:bit|float|s32|u32)\s+\S+\s+(\S+)", done.stdout, re.MULTILINE)
    assert {wire.signal for wire in written(name).wiring_rows} <= set(signals)


@pytest.mark.usefixtures("halrun")
def test_halrun_rejects_a_pin_that_the_board_does_not_have(tmp_path: Path) -> None:
    """The trial can fail: one letter of one pin."""
    text = render_hal_file(written("gt75-mesa-7i97")).replace("encoder.01.position ", "encoder.01.positron ")
    done = load(tmp_path, "gt75-mesa-7i97", text)
    assert done.returncode != 0
    assert "positron" in done.stderr + done.stdout


def load(folder: Path, name: str, text: str) -> subprocess.CompletedProcess[str]:
    """halrun with this text, its board replaced, to its start."""
    place = folder / name
    place.mkdir()
    pins = list(PINS.get(name.removeprefix("gt75-"), tuple)())
    stand_in = ""
    if pins:
        (place / "pins.json").write_text(json.dumps({"pins": pins, "on": []}), encoding="utf-8")
        shutil.copy(STAND_IN, place / STAND_IN.name)
        prefixes = dict.fromkeys(pin.name.partition(".")[0] for pin in pins)
        command = f"/usr/bin/python3 {place / STAND_IN.name} {place / 'pins.json'}"
        stand_in = "\n".join(f"loadusr -Wn stand-in-{each} {command} {each}" for each in prefixes)
    script = place / "whole.hal"
    script.write_text(without_board(text, stand_in) + "start\nshow sig\n", encoding="utf-8")
    return subprocess.run(
        ["halrun", "-f", str(script)], capture_output=True, text=True, check=False, timeout=150, cwd=place
    )
