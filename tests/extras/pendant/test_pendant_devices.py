"""Which device is the pendant: by name or number, told apart from its twin, and why it is not to be had."""

from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import Any

import pytest

from app.extras.pendant.driver.input_devices import (
    DeviceEntry,
    KernelDevice,
    list_input_devices,
    select_device_nodes,
)
from app.extras.pendant.driver.pendant_table import (
    ABS,
    KEY,
    REL,
    PendantControl,
    parse_button_name,
    parse_wheel_name,
)
from core.ports import DriverError
from tests.coded import raises_code

WANTED = {"hold": PendantControl(KEY, 0x131), "handwheel": PendantControl(REL, 7)}
ABLE = frozenset({(KEY, 0x130), (KEY, 0x131), (REL, 7)})


def entry(**said: Any) -> DeviceEntry:
    plain: dict[str, Any] = {
        "node": "event3",
        "name": "Shop Pendant",
        "numbers": "0b33:0030",
        "serial": "",
        "stem": "usb-1.2",
        "bluetooth": False,
        "able": ABLE,
    }
    return DeviceEntry(**(plain | said))


def in_sysfs(
    folder: Path, node: str, name: str, *, key: str = "0", rel: str = "0", bus: str = "0003"
) -> None:
    device = folder / node / "device"
    for path, text in (
        ("name", name),
        ("id/vendor", "0B33"),
        ("id/product", "0030"),
        ("id/bustype", bus),
        ("phys", f"usb-1.2/input{node[-1]}"),
        ("uniq", ""),
        ("capabilities/key", key),
        ("capabilities/rel", rel),
        ("capabilities/abs", "0"),
    ):
        (device / path).parent.mkdir(parents=True, exist_ok=True)
        (device / path).write_text(text + "\n")


def test_missing_sysfs_folder_lists_no_devices() -> None:
    assert list_input_devices(Path("/nowhere")) == []


def test_capability_words_are_64_bits_with_the_highest_first(tmp_path: Path) -> None:
    in_sysfs(tmp_path, "event3", "Shop Pendant", key="3000000000000 0 0 0 0", rel="80")
    in_sysfs(tmp_path, "event4", "Mouse", bus="0005")
    first, second = list_input_devices(tmp_path)
    assert (first.name, first.numbers, first.stem) == ("Shop Pendant", "0b33:0030", "usb-1.2")
    assert first.able == {(KEY, 0x130), (KEY, 0x131), (REL, 7)}  # 4 words of 64, then bits 48 and 49
    assert second.bluetooth


def test_device_unplugged_while_listing_is_omitted(tmp_path: Path) -> None:
    in_sysfs(tmp_path, "event3", "Shop Pendant")
    (tmp_path / "event4" / "device").mkdir(parents=True)  # without its name
    (tmp_path / "event5").mkdir()
    assert [each.node for each in list_input_devices(tmp_path)] == ["event3"]


@pytest.mark.parametrize("device", ["Shop Pendant", "shop pendant", "0B33:0030"])
def test_device_is_selected_by_name_or_number(device: str) -> None:
    other = entry(node="event4", name="Keyboard", numbers="046d:c31c", stem="usb-1.1")
    assert select_device_nodes(device, "", WANTED, [other, entry()]) == (entry(),)


def test_device_with_two_nodes_selects_both() -> None:
    dial = entry(node="event4", name="Shop Pendant Dial", able=frozenset({(REL, 7)}))
    buttons = entry(able=frozenset({(KEY, 0x131)}))
    mouse = entry(node="event5", able=frozenset({(KEY, 0x110)}))
    assert select_device_nodes("0b33:0030", "", WANTED, [buttons, dial, mouse]) == (buttons, dial)


@pytest.mark.parametrize(
    ("found", "serial", "reason", "values"),
    [
        ([], "", "missing", []),
        ([entry()], "7", "missing", ["7"]),
        ([entry(), entry(node="event9", stem="usb-1.3")], "", "several", ["2 "]),
        (
            [entry(serial="A1"), entry(node="event9", stem="usb-1.3", serial="B2")],
            "",
            "several",
            ["2 ", "A1, B2"],
        ),
        ([entry(able=frozenset({(KEY, 0x131)}))], "", "lacks-control", ["handwheel"]),
        ([entry(bluetooth=True)], "", "bluetooth", []),
    ],
)
def test_ambiguous_or_missing_device_is_rejected(
    found: list[DeviceEntry], serial: str, reason: str, values: list[str]
) -> None:
    with raises_code(DriverError, "driver", *values) as told:
        select_device_nodes("Shop Pendant", serial, WANTED, found)
    assert told.value.reason == reason


def test_identical_devices_are_distinguished_by_serial_number() -> None:
    twin = entry(node="event9", stem="usb-1.3", serial="B2")
    assert select_device_nodes("Shop Pendant", "B2", WANTED, [entry(serial="A1"), twin]) == (twin,)


def test_permission_error_shows_the_udev_rule(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> int:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("app.extras.pendant.driver.input_devices.os.open", refused)
    with pytest.raises(DriverError) as caught:
        KernelDevice(entry(), tmp_path)
    assert 'ATTRS{idVendor}=="0b33", ATTRS{idProduct}=="0030", TAG+="uaccess"' in str(caught.value)
    assert "/etc/udev/rules.d/70-turndesk-pendant.rules" in str(caught.value)


def test_missing_node_is_reported_with_the_cause(tmp_path: Path) -> None:
    with raises_code(DriverError, "driver", "Shop Pendant") as told:
        KernelDevice(entry(), tmp_path)
    assert told.value.reason == "not-opened"


def test_ioctl_numbers_match_the_kernel_header(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """EVIOCSCLOCKID, EVIOCGRAB, EVIOCGKEY of 96 bytes, EVIOCGABS of axis 16, as linux/input.h makes them."""
    asked: list[int] = []

    def ioctl(_device: int, request: int, value: bytearray) -> None:
        asked.append(request)
        if request == 0x80604518:
            value[0x131 // 8] |= 1 << 0x131 % 8
        if request == 0x80184550:
            struct.pack_into("@iiiiii", value, 0, 7, -1, 255, 0, 0, 0)

    monkeypatch.setattr("app.extras.pendant.driver.input_devices._ioctl", ioctl)
    os.mkfifo(tmp_path / "event3")
    device = KernelDevice(entry(able=ABLE | {(ABS, 0x10)}), tmp_path)
    try:
        assert device.read_pressed_keys() == {0x131}
        assert device.read_axis_ranges() == {0x10: (-1, 255, 7)}
        assert asked == [0x400445A0, 0x40044590, 0x80604518, 0x80184550]
        assert device.read() == b""
    finally:
        device.close()
    device.close()  # a second time is nothing


def test_file_that_is_not_a_device_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "event3").write_bytes(b"")
    with raises_code(DriverError, "driver", "Shop Pendant") as told:
        KernelDevice(entry(), tmp_path)
    assert told.value.reason == "taken"


def test_event_names_match_the_kernel_header() -> None:
    """Against the kernel's own header, where it is installed."""
    header = Path("/usr/include/linux/input-event-codes.h")
    if not header.exists():
        pytest.skip("the kernel's headers are not installed")
    known: dict[str, str] = {}
    for line in header.read_text().splitlines():
        words = line.split()
        if len(words) > 2 and words[0] == "#define":
            known[words[1]] = words[2]

    def number(name: str) -> int:
        text = known[name]
        return number(text) if text in known else int(text, 0)

    asked = 0
    for name in known:
        found = parse_button_name(name) or (
            parse_wheel_name(name) if name.startswith(("REL_", "ABS_")) else None
        )
        if found is not None:
            assert found.event_code == number(name), name
            asked += 1
    assert asked > 200


@pytest.mark.parametrize("name", ["", "BTN_NONE", "KEY_0xfff", "ABS_HAT0X", "REL_DIAL", "+", "ABS_+"])
def test_invalid_button_name_is_not_parsed(name: str) -> None:
    assert parse_button_name(name) is None


def test_key_is_named_by_its_number() -> None:
    assert parse_button_name("KEY_0x1d3") == PendantControl(KEY, 0x1D3)
