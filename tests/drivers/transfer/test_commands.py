"""``turndesk serial`` at one end of a line, or at both."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path
from typing import NoReturn

import pytest

from app.cli.main import main
from app.compose import stored_offsets
from app.desk.command_errors import CommandError
from tests.coded import recorded_refusals
from tests.drivers.inverter.lines import WAIT, Pair
from tests.drivers.transfer.far_end import FarEnd, answer


def test_send_and_receive_commands_transfer_a_program(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two of us on the two ends of a cable."""
    source, target = tmp_path / "PIN.nc", tmp_path / "in" / "PIN.nc"
    source.write_bytes(b"%\nG90G72\nG00X1.Z.1\nM30\n%\n")
    with Pair() as cable, ThreadPoolExecutor(1) as pool:
        receive = ["serial", "receive", "--port", cable.far, "--out", str(target)]
        future = pool.submit(main, receive)
        # DC1 is the receiver's first word: only then the sender begins.
        assert main(["serial", "send", str(source), "--port", cable.near, "--wait", "--eol", "cr"]) == 0
        status = future.result(WAIT)
    told = capsys.readouterr()
    text = target.read_bytes()
    assert text == b"G90G72\nG00X1.Z.1\nM30\n"
    assert sha256(text).hexdigest() in told.out
    assert "3 lines" in told.out
    assert status == 0, told.err


SETTINGS = (
    "--baud 110 --bits 7 --parity O --stop 2",
    "--bits 7 --parity E --dc-codes",
    "--bits 7 --parity N --flow none --dc-codes",
    "--parity E --baud 115200",
    "--stop 2 --flow none --dc-codes",
)


@pytest.mark.parametrize("settings", SETTINGS)
def test_program_is_transferred_with_every_line_setting(settings: str, tmp_path: Path) -> None:
    """Both ends set to the same; twice, because a port is left as it was set."""
    source = tmp_path / "PIN.nc"
    source.write_bytes(b"G90G72\nG00X1.Z.1\nM30\n")
    end = settings.split()
    with Pair() as cable, ThreadPoolExecutor(1) as pool:
        for name in ("ONE.nc", "TWO.nc"):
            out = tmp_path / name
            future = pool.submit(main, ["serial", "receive", "--port", cable.far, "--out", str(out), *end])
            send = ["serial", "send", str(source), "--port", cable.near, "--wait", "--leader", "8", *end]
            assert main(send) == 0
            assert future.result(WAIT) == 0
            assert out.read_bytes() == source.read_bytes()


def test_receive_rejects_an_existing_file_before_waiting(
    far: FarEnd, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is refused before anything is waited for: nobody has to send it twice."""
    target = tmp_path / "OLD.nc"
    target.write_bytes(b"M02\n")
    assert main(["serial", "receive", "--port", far.port, "--out", str(target), "--flow", "none"]) == 1
    assert str(target) in capsys.readouterr().err
    assert target.read_bytes() == b"M02\n"
    assert far.hear() == b""


def test_file_created_during_reception_is_not_replaced(
    far: FarEnd, tmp_path: Path, pool: ThreadPoolExecutor
) -> None:
    target = tmp_path / "OLD.nc"
    future = pool.submit(main, ["serial", "receive", "--port", far.port, "--out", str(target)])
    assert _asked(far)
    target.write_bytes(b"M02\n")
    answer(far, future, b"%\nG90\nM30\n%\n")
    assert future.result(WAIT) == 1
    assert target.read_bytes() == b"M02\n"


def _asked(far: FarEnd) -> bool:
    return any(b"\x11" in far.hear(0.2) for _ in range(int(WAIT / 0.2)))


def test_received_data_before_the_program_is_reported(
    far: FarEnd, tmp_path: Path, pool: ThreadPoolExecutor, capsys: pytest.CaptureFixture[str]
) -> None:
    future = pool.submit(main, ["serial", "receive", "--port", far.port, "--out", str(tmp_path / "N.nc")])
    assert _asked(far)
    told = ""
    for _ in range(int(WAIT / 0.2)):
        if "no %" in told:
            break
        far.say(b"O1234 G90\r\n")
        far.hear(0.2)
        told += capsys.readouterr().err
    assert "O1234 G90" in told
    assert "--wrap ''" in told
    answer(far, future, b"%\nG90\nM30\n%\n")
    assert future.result(WAIT) == 0


def test_program_that_cannot_be_proved_is_saved_with_the_reason(
    far: FarEnd,
    tmp_path: Path,
    pool: ThreadPoolExecutor,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The sender may be away, and the offsets can be repaired later."""

    def read_damaged_offsets() -> NoReturn:
        raise CommandError("the stored offset of tool 3 is damaged", "damaged-row")

    monkeypatch.setattr(stored_offsets, "make_offsets_reader", lambda _file: read_damaged_offsets)
    target = tmp_path / "NEW.nc"
    future = pool.submit(main, ["serial", "receive", "--port", far.port, "--out", str(target)])
    assert _asked(far)
    answer(far, future, b"%\nG90\nM30\n%\n")
    assert future.result(WAIT) == 1
    assert target.read_bytes() == b"G90\nM30\n"
    assert "the stored offset of tool 3 is damaged" in capsys.readouterr().err


def test_incomplete_program_leaves_no_file(far: FarEnd, tmp_path: Path, pool: ThreadPoolExecutor) -> None:
    target = tmp_path / "NEW.nc"
    arguments = [
        "serial",
        "receive",
        "--port",
        far.port,
        "--bits",
        "7",
        "--parity",
        "E",
        "--out",
        str(target),
    ]
    future = pool.submit(main, arguments)
    answer(far, future, b"\xa5\x0a\x31")  # a 1 without its parity bit
    assert future.result(WAIT) == 1
    assert list(tmp_path.iterdir()) == []


def test_invalid_serial_commands_are_rejected(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    refusals = recorded_refusals(monkeypatch)
    assert main(["serial", "send", str(tmp_path / "none.nc"), "--port", "/dev/ttyNONE7"]) == 2
    told = capsys.readouterr().err
    assert "none.nc" in told
    assert "No such file" in told
    program = tmp_path / "p.nc"
    program.write_text("M30\n")
    assert main(["serial", "send", str(program), "--port", "/dev/ttyNONE7"]) == 1
    assert "/dev/ttyNONE7" in capsys.readouterr().err
    assert main(["serial", "send", str(program), "--port", str(program)]) == 1
    assert str(program) in capsys.readouterr().err
    for option, said in (("--baud", "12"), ("--baud", "1000001"), ("--leader", "-1"), ("--leader", "2001")):
        assert main(["serial", "send", str(program), "--port", "/dev/ttyNONE7", option, said]) == 2
        assert refusals[-1].code == option.removeprefix("--")
        assert f"{option} {said} " in capsys.readouterr().err
    assert main(["serial", "send", str(program)]) == 2
    assert "--port" in capsys.readouterr().err


@pytest.mark.parametrize("action", ["send", "receive"])
def test_help_is_specific_to_send_or_receive(action: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["serial", action, "--help"])
    told = capsys.readouterr().out
    assert "metavar" not in told  # a bare % would show argparse's own workings
    assert ("--wait" in told) == (action == "send")
    assert "turndesk serial ports" in told


def test_ports_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["serial", "ports"]) == 0
    told = capsys.readouterr()
    assert told.out or "no serial port" in told.err
