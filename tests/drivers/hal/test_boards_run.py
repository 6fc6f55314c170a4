"""A program through each shipped HAL file and a real halrun: the board is replaced, the rest as it stands.

Stock components move under the names of the board (``halcmd alias``): what a velocity makes of a place, a
spindle of its command; the parallel port's steps are made as on a machine. Homing is left out.
"""

from __future__ import annotations

import json
import re
import shutil
import signal
from pathlib import Path

import pytest

import resources
from tests.drivers.hal.board_pins import PINS, without_board
from tests.drivers.hal.lathes import PATIENT, changed
from tests.drivers.hal.live import LiveLathe, live
from tests.drivers.hal.test_hal_files import STAND_IN
from tests.drivers.hal.test_programs import PIECE

PROGRAM = PIECE.replace("G90G94F100\n", "G90G94F100\nM03S500\n").replace("M30", "M05\nM30")
CARD, SERVO, FIELD = "hm2_7i76e.0", "hm2_7i97.0", "hm2_7i76e.0.7i76.0.0"
# component.pin: the board's name for it
MOVED = {
    "mesa-7i76e": {
        "st-x.in": f"{CARD}.stepgen.00.velocity-cmd",
        "st-x.out": f"{CARD}.stepgen.00.position-fb",
        "st-z.in": f"{CARD}.stepgen.01.velocity-cmd",
        "st-z.out": f"{CARD}.stepgen.01.position-fb",
        "st-ramp.in": f"{FIELD}.spinout",
        "st-rps.out": f"{CARD}.encoder.00.velocity",
        "st-turns.position-fb": f"{CARD}.encoder.00.position",
        "st-turns.index-enable": f"{CARD}.encoder.00.index-enable",
    },
    "mesa-7i97": {
        "st-x.in": f"{SERVO}.pwmgen.00.value",
        "st-x.out": f"{SERVO}.encoder.00.position",
        "st-z.in": f"{SERVO}.pwmgen.01.value",
        "st-z.out": f"{SERVO}.encoder.01.position",
        "st-ramp.in": f"{SERVO}.pwmgen.04.value",
        "st-rps.out": f"{SERVO}.encoder.02.velocity",
        "st-turns.position-fb": f"{SERVO}.encoder.02.position",
        "st-turns.index-enable": f"{SERVO}.encoder.02.index-enable",
    },
    "ethercat": {
        "st-x.in1": "cia402.x.pos-cmd",
        "st-x.sel": "cia402.x.enable",
        "st-x.out": "cia402.x.pos-fb",
        "st-z.in1": "cia402.z.pos-cmd",
        "st-z.sel": "cia402.z.enable",
        "st-z.out": "cia402.z.pos-fb",
        "st-ramp.in": "cia402.spindle.velocity-cmd",
        "st-ramp.out": "cia402.spindle.velocity-fb",
        "st-turns.out": "cia402.spindle.pos-fb",
    },
    "parport": {},  # sim_parport and the very step generators
}
ON = {
    "mesa-7i76e": [f"{FIELD}.input-{n:02d}" for n in (0, 1, 2, 8)],
    "mesa-7i97": [f"{SERVO}.inmux.00.input-{n}" for n in ("00", "01", "02", "08")],
    "ethercat": [
        *(f"lcec.0.DI.din-{n}" for n in (0, 1, 2, 4)),
        *("lcec.0.link-up", "lcec.0.all-op"),
        *(f"lcec.0.{name}.slave-oper" for name in ("x", "z", "spindle", "DI", "DO")),
    ],
}
# Base and servo thread catch up separately where they have no real-time priority: steps then trail by what a
# busy computer takes, and are all made in the end. Following errors have tests of their own.
WIDE = (
    ("fe_window = 0.02                # steps", "fe_window = 0.39               # steps"),
    ("fe_window = 0.02\n", "fe_window = 0.39\n"),
)
SLIDES = {"mesa-7i76e": "integ", "mesa-7i97": "integ", "ethercat": "mux2"}


def moving(board: str) -> list[str]:
    """Lines of HAL: slides and spindle under the board's names."""
    if board == "parport":
        return [""]
    lines = [f"loadrt {SLIDES[board]} names=st-x,st-z", "loadrt limit2 names=st-ramp"]
    if board == "ethercat":
        lines += ["loadrt integ names=st-turns"]
    else:
        lines += ["loadrt scale names=st-rps", "loadrt sim_spindle names=st-turns"]
    return [*lines, *(f"alias pin {pin} {name}" for pin, name in MOVED[board].items())]


def called(board: str) -> list[str]:
    """What is called behind everything, and what is wired between these."""
    if board == "parport":  # the relay is reset, the collet closed
        return ["setp parport.0.pin-10-in-fake 1", "setp parport.0.pin-11-in-fake 1", ""]
    lines = [f"addf {name} servo-thread" for name in ("st-x", "st-z", "st-ramp")]
    lines += ["setp st-ramp.maxv 1500"]
    if board == "ethercat":
        lines += ["net x-pos-fb st-x.in0", "net z-pos-fb st-z.in0"]
    else:
        lines += [
            "addf st-rps servo-thread",
            "setp st-rps.gain 0.0166666667",
            "net st-rpm st-ramp.out st-rps.in",
        ]
    speed = "in" if board == "ethercat" else "velocity-cmd"
    return [*lines, "addf st-turns servo-thread", f"net spindle-rps st-turns.{speed}", ""]


@pytest.mark.long
@pytest.mark.real_time
@pytest.mark.usefixtures("halrun")
@pytest.mark.parametrize("board", list(MOVED))
def test_program_completes_with_the_shipped_hal_file(board: str, tmp_path: Path) -> None:
    program = PIECE.replace("F100", "F40") if board == "parport" else PROGRAM
    with live(lathe_without_board(board, tmp_path, ON.get(board, []))) as lathe:
        lathe.ready()
        lathe.run(program)
        assert lathe.shot.actual[:2] == pytest.approx([0.6 * 25.4, 0.3 * 25.4], abs=0.003)  # one step


@pytest.mark.long
@pytest.mark.real_time
@pytest.mark.usefixtures("halrun")
def test_board_watchdog_and_drive_not_ready_are_faults(tmp_path: Path) -> None:
    faults = {f"{SERVO}.watchdog.has_bit": "hal-board", f"{SERVO}.inmux.00.input-10-not": "axis"}
    with live(lathe_without_board("mesa-7i97", tmp_path, ON["mesa-7i97"])) as lathe:
        for pin, code in faults.items():
            lathe.ready()
            switch(lathe, tmp_path, [*ON["mesa-7i97"], pin])
            lathe.until(lambda shot: bool(shot.alarms))
            assert code in lathe.codes
            switch(lathe, tmp_path, ON["mesa-7i97"])


@pytest.mark.long
@pytest.mark.real_time
@pytest.mark.usefixtures("halrun")
def test_disconnected_board_removes_power_at_rest_despite_frozen_estop(
    tmp_path: Path,
) -> None:
    """As hm2_eth does it: inputs stay as they were, only packet-error-exceeded rises; has_bit is not read."""
    with live(lathe_without_board("mesa-7i97", tmp_path, ON["mesa-7i97"])) as lathe:
        lathe.ready()
        switch(lathe, tmp_path, [*ON["mesa-7i97"], f"{SERVO}.packet-error-exceeded"])
        lathe.until(lambda shot: bool(shot.alarms))
        assert "hal-board" in lathe.codes
        assert lathe.pin("turndesk.in.estop") == 1.0  # frozen: released
        assert lathe.pin("turndesk.chain-ok") == 0.0
        assert not lathe.is_on("machine-on")
        assert lathe.shot.unknown


def switch(lathe: LiveLathe, folder: Path, on: list[str]) -> None:
    """What is on at the card."""
    file = folder / "pins.json"
    file.write_text(json.dumps({**json.loads(file.read_text(encoding="utf-8")), "on": on}), encoding="utf-8")
    lathe.kill("hm2_7i97", signal.SIGUSR1)


def lathe_without_board(board: str, folder: Path, on: list[str]) -> Path:
    """The machine file beside its HAL file, both as shipped but for homing and the board."""
    name = f"gt75-{board}"
    machine = resources.read_machine_file(f"{name}.toml")
    machine = re.sub(r"absolute = false\nhome = .*", "absolute = true", machine)
    machine = machine.replace("two_hand_start = true", "two_hand_start = false")  # tests post the start
    machine = changed(machine, (*PATIENT, *(WIDE if board == "parport" else ())))
    (folder / f"{name}.toml").write_text(machine, encoding="utf-8")
    moved = set(MOVED[board].values())
    pins = [pin for pin in PINS.get(board, tuple)() if pin.name not in moved]
    (folder / "pins.json").write_text(json.dumps({"pins": pins, "on": on}), encoding="utf-8")
    shutil.copy(STAND_IN, folder / STAND_IN.name)
    prefixes = dict.fromkeys(pin.name.partition(".")[0] for pin in pins)
    command = f"/usr/bin/python3 {folder / STAND_IN.name} {folder / 'pins.json'}"
    loads = [f"loadusr -Wn stand-in-{each} {command} {each}" for each in prefixes]
    text = resources.get_hal_path(f"{name}.hal").read_text(encoding="utf-8")
    whole = without_board(text, "\n".join((*loads, *moving(board)))) + "\n".join(called(board))
    (folder / f"{name}.hal").write_text(whole, encoding="utf-8")
    return folder / f"{name}.toml"
