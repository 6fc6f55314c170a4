"""Files of inverter families: what they say, and where they are wrong."""

from __future__ import annotations

import configparser
import re
from fnmatch import fnmatch
from pathlib import Path

import pytest

from core.ports import DriverError
from drivers.inverter.family_files import load_inverter_family, read_family_file
from drivers.inverter.family_table import FrequencyKeys, StateKeys
from drivers.inverter.inverter_table import FAMILY_FOLDER, FAMILY_NAMES
from tests.coded import raises_code
from tests.drivers.inverter import benches

SETUP = Path(__file__).parents[3] / "setup.cfg"
MY_DRIVE = (benches.FOLDER / benches.OWN).read_text(encoding="utf-8")
HUANYANG = (FAMILY_FOLDER / "huanyang.toml").read_text(encoding="utf-8")


def refused(folder: Path, text: str) -> str:
    """Why a family file with this text is rejected, without the path of its folder."""
    path = folder / "my.toml"
    path.write_text(text, encoding="utf-8")
    with raises_code(DriverError, "driver") as told:
        read_family_file(path)
    assert told.value.reason == "bad-family"
    return str(told.value).replace(f"{folder}/", "")


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


def line_of(text: str, part: str) -> int:
    return text[: text.index(part)].count("\n") + 1 + part.startswith("\n")


@pytest.mark.parametrize("name", FAMILY_NAMES)
def test_every_shipped_family_can_be_read(name: str) -> None:
    table = load_inverter_family(name, Path("/nowhere"))
    assert table.name
    assert (table.register_table is None) is (name == "huanyang")


def test_documented_family_file_is_the_one_tested_here() -> None:
    page = (SETUP.parent / "docs/integrator/inverters.md").read_text(encoding="utf-8")
    shown = [block.partition("```")[0] for block in page.split("```toml\n")[1:]]
    assert [block for block in shown if block.startswith("name = ")] == [MY_DRIVE]


def test_family_files_are_installed_with_the_package() -> None:
    setup = configparser.ConfigParser()
    setup.read(SETUP, encoding="utf-8")
    patterns = setup["options.package_data"]["drivers.inverter"].split()
    for path in FAMILY_FOLDER.iterdir():
        assert any(fnmatch(f"families/{path.name}", pattern) for pattern in patterns), path.name


def test_family_file_is_parsed_into_its_table() -> None:
    table = load_inverter_family(benches.OWN, benches.FOLDER)
    assert (table.serial_line.baud, table.serial_line.write_multiple) == ((1200.0, 38400.0), True)
    assert (table.max_hz, table.setpoint_step_hz) == (400.0, 0.01)
    assert table.register_table is not None
    assert (table.register_table.fault_texts[0x0021], len(table.parameters)) == ("communication error", 4)
    assert [each.value for each in table.register_table.command_writes["reset"]] == [8, 0]


@pytest.mark.parametrize(
    ("keys", "hz", "words"),
    [
        (FrequencyKeys(register=4, counts_per_hz=100.0), 50.0, (5000,)),
        (FrequencyKeys(register=4, counts_per_hz=100.0), -50.0, (5000,)),
        (FrequencyKeys(register=4, counts_per_hz=10.0, signed=True), -50.0, (0xFE0C,)),
        (FrequencyKeys(register=4, counts_per_hz=10_000.0, words=2), 50.0, (7, 0xA120)),
        (FrequencyKeys(register=4, counts_per_hz=10_000.0, words=2, signed=True), -1.0, (0xFFFF, 0xD8F0)),
    ],
)
def test_frequency_is_encoded_and_decoded(keys: FrequencyKeys, hz: float, words: tuple[int, ...]) -> None:
    assert keys.encode_hz(hz) == words
    assert keys.decode_hz(dict(enumerate(words, 4))) == abs(hz)


@pytest.mark.parametrize(
    ("words", "signed", "highest"), [(1, False, 655.35), (1, True, 327.67), (2, False, 42949672.95)]
)
def test_register_limits_the_maximum_frequency(words: int, signed: bool, highest: float) -> None:
    keys = FrequencyKeys(register=0, counts_per_hz=100.0, words=words, signed=signed)
    assert keys.max_hz == pytest.approx(highest)


def test_state_is_active_only_for_its_values() -> None:
    state = StateKeys(register=7, mask=0x18, values=(8.0, 24.0))
    assert [state.is_active({7: word}, {}) for word in (0x08, 0x1F, 0x10, 0x00)] == [True, True, False, False]
    assert StateKeys(coil=3).is_active({}, {3: True})
    assert not StateKeys(coil=3).is_active({}, {3: False})


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ('name = "My drive"', 'name = " "', "name"),
        ('protocol = "modbus"', 'protocol = "profibus"', "protocol"),
        ("baud = [1200, 38400]", "baud = [38400, 1200]", "line.baud"),
        ("baud = [1200, 38400]", "baud = [1200, 38400, 9600]", "line.baud"),
        ("baud = [1200, 38400]", "bauds = [1200, 38400]", "line.bauds"),
        ('parity = ["N", "E", "O"]', 'parity = ["N", "M"]', "line.parity"),
        ('parity = ["N", "E", "O"]', "parity = []", "line.parity"),
        ("write_multiple = true", "write_multiple = 16", "line.write_multiple"),
        ("register = 0x0002\n", "register = 0x10000\n", "frequency.register"),
        ("register = 0x0002\n", 'register = "0x0002"\n', "frequency.register"),
        ("counts_per_hz = 100\n\n", "counts_per_hz = 0\n\n", "frequency.counts_per_hz"),
        ("counts_per_hz = 100\n\n", "counts_per_hz = true\n\n", "frequency.counts_per_hz"),
        ("counts_per_hz = 100\n\n", "words = 3\n\n", "frequency.words"),
        ("stop = [{ register = 0x0001, value = 0x0000 }]", "stop = []", "command.stop"),
        ("stop = [{ register = 0x0001, value = 0x0000 }]", "stop = 0x0001", "command.stop"),
        ("0x0001, value = 0x0000 }]", "0x0001 }]", "command.stop[1]"),
        ("stop = [{ register = 0x0001, value", "stop = [{ register = 0x0002, value", "command.stop[1]"),
        ("stop = [{ register = 0x0001, value", "stop = [{ coil = 0x0001, value", "command.stop[1]"),
        ("count = 7", "count = 0", "read[2].count"),
        ("count = 7", "count = 7\ncoil = 0x0020", "read[2]"),
        ("register = 0x0020\ncount = 7", "register = 0xFFFE\ncount = 7", "read[2].count"),
        ("register = 0x0020\ncount", "register = 0x0000\ncount", "read[2]"),
        ("setpoint = { register = 0x0023", "setpoint = { register = 0x0027", "report.setpoint"),
        ("output = { register = 0x0024", "output = { words = 2, register = 0x0026", "report.output"),
        ("current = { register = 0x0026", "current = { register = 0x0106", "report.current"),
        ("run = { register = 0x0001, mask = 0x0003", "run = { coil = 0x0001, mask = 0x0003", "report.run"),
        ("values = [1, 2] }", "values = [1, 4] }", "report.run.values"),
        (", values = [1, 2] }", " }", "report.run.values"),
        ("fault = { register = 0x0020", "tripped = { register = 0x0020", "report.tripped"),
        ('shown = "{code:04X}H"', 'shown = "{code.real}"', "report.fault_code.shown"),
        ('shown = "{code:04X}H"', 'shown = "{0}"', "report.fault_code.shown"),
        ("0x0007 = ", "oC = ", "faults.oC"),
        ("0x0007 = ", "0x10000 = ", "faults.0x10000"),
        ("0x0008 = ", "7 = ", "faults.7"),
        ('0x0007 = "over-current"', "0x0007 = 7", "faults.0x0007"),
        ("register = 0x0181", "register = 0x0180", "parameter[2].register"),
        ("counts_per_s = 10", "counts_per_s = 10\nvalue = 15", "parameter[4]"),
        ("register = 0x0303\n", "", "highest.register"),
        ("max_hz = 400", "max_hz = 0", "limits.max_hz"),
        ("max_hz = 400", "min_hz = 10", "limits.min_hz"),
    ],
)  # fmt: skip
def test_mistake_in_a_family_file_is_reported_with_its_key(
    tmp_path: Path, old: str, new: str, key: str
) -> None:
    why = refused(tmp_path, changed(MY_DRIVE, old, new))
    assert any(re.match(rf"\d+: {re.escape(key)}[: ]", each) for each in why.split("my.toml, line ")), why


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ('name = "My drive"', "name = 1000", "name = 1000"),
        ("baud = [1200, 38400]", "baud = 9600", "baud = 9600"),
        ("baud = [1200, 38400]\n", "", "[line]"),
        ("values = [1, 2] }", "values = [1, 4] }", "run = "),
        ("count = 7", "count = 0", "count = 0"),
        ("register = 0x0020\ncount = 7", "count = 7", "[[read]]                        # status"),
        ("register = 0x0001, value = 0x0000 }]", "register = 0x0001 }]", "stop = "),
        ('0x0008 = "over', '7 = "over', '\n7 = "over'),
        ("register = 0x0181\n", "register = 0x0180 # twice\n", "register = 0x0180 # twice"),
        ('"run command from Modbus"', '""', 'why = ""'),
        ("max_hz = 400", "max_hz = nan", "max_hz = nan"),
    ],
)
def test_mistake_in_a_family_file_is_reported_with_its_line(
    tmp_path: Path, old: str, new: str, line: str
) -> None:
    text = changed(MY_DRIVE, old, new)
    assert refused(tmp_path, text).startswith(f"my.toml, line {line_of(text, line)}: ")


@pytest.mark.parametrize("table", ["line", "frequency", "command", "report"])
def test_missing_table_is_reported(tmp_path: Path, table: str) -> None:
    text = changed(MY_DRIVE, f"[{table}]", f"[not_{table}]")
    assert f": {table}: " in refused(tmp_path, text)


@pytest.mark.parametrize(
    "name", ["output", "setpoint", "current", "run", "reverse", "asked_reverse", "fault_code"]
)
def test_missing_report_value_is_reported(tmp_path: Path, name: str) -> None:
    head, report, rest = MY_DRIVE.partition("[report]")
    text = head + report + changed(rest, f"\n{name} = ", f"\nno_{name} = ")
    assert f": report.{name}: " in refused(tmp_path, text)


@pytest.mark.parametrize("text", ["command = 1", "report = 1", "read = 1", "faults = 1", "parameter = [1]"])
def test_value_in_place_of_a_table_is_reported(tmp_path: Path, text: str) -> None:
    head, _, _ = MY_DRIVE.partition("[line]")
    key = text.split(" ", maxsplit=1)[0]
    assert f"line {head.count(chr(10)) + 1}: {key}" in refused(tmp_path, f"{head}{text}\n")


def test_all_mistakes_in_a_family_file_are_reported_at_once(tmp_path: Path) -> None:
    text = changed(changed(MY_DRIVE, "count = 7", "count = 700"), "max_hz = 400", "max_hz = 4e9")
    assert refused(tmp_path, text).count("my.toml, line ") == 2


def test_a_fault_code_outside_the_reads_needs_a_fault_state(tmp_path: Path) -> None:
    text = changed(MY_DRIVE, "fault = { register = 0x0020, mask = 0x0008, values = [8] }\n", "")
    assert refused(tmp_path, text).startswith(
        f"my.toml, line {line_of(text, 'fault_code')}: report.fault_code:"
    )
    text = changed(text, "fault_code = { register = 0x0080", "fault_code = { register = 0x0021")
    (tmp_path / "my.toml").write_text(text)
    assert read_family_file(tmp_path / "my.toml").register_table is not None


def test_registers_are_rejected_for_a_family_with_coded_frames(tmp_path: Path) -> None:
    text = f"{HUANYANG}\n[frequency]\nregister = 1\ncounts_per_hz = 100\n"
    assert refused(tmp_path, text).startswith(f"my.toml, line {line_of(text, '[frequency]')}: frequency:")


def test_invalid_toml_is_reported_with_its_line(tmp_path: Path) -> None:
    assert "line 2" in refused(tmp_path, 'name = "A"\nmanual = \n')


def test_unreadable_family_file_is_reported(tmp_path: Path) -> None:
    (tmp_path / "latin.toml").write_bytes(b'name = "\xd8"\n')
    (tmp_path / "huge.toml").write_bytes(b"#" * (1024 * 1024 + 1))
    (tmp_path / "folder.toml").mkdir()
    for name in ("none.toml", "latin.toml", "huge.toml", "folder.toml"):
        with raises_code(DriverError, "driver", name) as told:
            load_inverter_family(name, tmp_path)
        assert told.value.reason == "bad-family"
