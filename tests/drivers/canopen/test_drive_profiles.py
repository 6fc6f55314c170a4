"""Families of drives: found by name or EDS, units, records, and the load of the bus, by hand."""

from __future__ import annotations

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from core.ports import MotionSegments
from core.table_schema import FileFinding, MachineFileError
from drivers.canopen.canopen_config import AxisConfig
from drivers.canopen.canopen_objects import build_drive_dictionary
from drivers.canopen.canopen_rules import calculate_cyclic_bus_load, get_max_frame_bits
from drivers.canopen.drive_profiles import CIA402_PROFILE, PROFILES, find_drive_profile
from drivers.canopen.drive_set import pack_copley_segment, unpack_copley_segment
from tests.drivers.canopen.bench import CanBench, can_machine, cyclic
from tests.drivers.machines import ramp


@pytest.mark.parametrize(
    ("name", "vendor", "product", "family"),
    [
        ("", 0xFB, "EPOS4 Module 50/15", "epos4"),
        ("", 0xFB, "EPOS2 50/5", "epos2"),
        ("", 0xFB, "EPOS 70/10", "cia402"),  # the first EPOS is neither
        ("", 0xAB, None, "copley"),
        ("", None, None, "cia402"),
        ("epos2", 0xFB, "EPOS4 70/15", "epos2"),  # the machine file decides
    ],
)
def test_drive_family_is_selected_by_name_or_eds(
    name: str, vendor: int | None, product: str | None, family: str
) -> None:
    assert find_drive_profile(name, vendor, product).name == family


@pytest.mark.parametrize(
    ("family", "has", "has_not"),
    [
        ("cia402", {0x6007, 0x6065, 0x60C1, 0x60E3}, {0x20C1, 0x2010}),
        ("epos2", {0x20C1, 0x2071, 0x6007, 0x6065}, {0x60F4, 0x60FD, 0x605A, 0x6066, 0x60C1}),
        ("epos4", {0x60A9, 0x30B0, 0x60C2, 0x60FD}, {0x607C, 0x60C1, 0x1006}),
        ("copley", {0x2010, 0x60C1}, {0x20C1}),
    ],
)
def test_drive_family_has_its_objects(family: str, has: set[int], has_not: set[int]) -> None:
    objects = build_drive_dictionary(PROFILES[family])
    assert has <= set(objects)
    assert not has_not & set(objects)


def axis(family: str, counts_per_rev: int) -> AxisConfig:
    return AxisConfig(
        "X", 127.0, 3048.0, 0.00127, 2.0, 0.02, profile=PROFILES[family], counts_per_rev=counts_per_rev
    )


def test_speeds_are_converted_to_drive_units() -> None:
    """25.4 mm/s are 20 000 counts/s, five turns of 4000 a second; 3048 mm/s² are 2.4 million counts/s²."""
    assert axis("cia402", 0).convert_to_drive_speed(25.4) == pytest.approx(20000.0)
    assert axis("epos4", 4000).convert_to_drive_speed(25.4) == pytest.approx(300.0)
    assert axis("cia402", 0).convert_to_drive_acceleration(3048.0) == 2_400_000
    assert axis("epos4", 4000).convert_to_drive_acceleration(3048.0) == 36_000
    assert axis("cia402", 4000).convert_to_drive_acceleration(3048.0) == 2_400_000
    assert axis("epos4", 4000).convert_to_drive_acceleration(0.0) == 1


def test_copley_segment_is_packed_into_its_bytes() -> None:
    data = pack_copley_segment(11, 20, -1234.5, -5)
    # count 11 goes round at 8; 20 ms; -5 and -12345 tenths in 24 bits, low byte first
    assert data == bytes([3, 20, 0xFB, 0xFF, 0xFF, 0xC7, 0xCF, 0xFF])
    assert unpack_copley_segment(data) == (3, 20, -1234.5, -5)
    with pytest.raises(ValueError, match="8388608"):
        pack_copley_segment(0, 20, 0.0, 2**23)
    with pytest.raises(ValueError, match="838861"):
        pack_copley_segment(0, 20, 838_861.0, 0)


def test_copley_drives_follow_the_same_path() -> None:
    bench = CanBench(can_machine(('drive = "epos2"', 'drive = "copley"'), (", counts_per_rev = 4000", "")))
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, (0.0, 0.0, 0.0), 60.0, 0.4))
    bench.run(1.2)
    sample = axes.sample()
    assert sample.fault == ""
    assert sample.actual[0] == pytest.approx(60.0 * 0.42, abs=0.0013)
    segments: MotionSegments = ramp(bench.clock.now() + 0.14, (60.0 * 0.42, 0.0, 0.0), -60.0, 0.4)
    bench.run(1.0)
    axes.splice(segments._replace(start_times_s=segments.start_times_s + 1.0))
    bench.run(1.5)
    assert axes.sample().fault == ""
    assert axes.sample().actual[0] == pytest.approx(0.0, abs=0.0013)
    bench.close()


def test_bus_load_matches_hand_calculation() -> None:
    # 47 + 8n + floor((34 + 8n - 1)/4): 55, 125 and 135 bits
    assert [get_max_frame_bits(n) for n in (0, 7, 8)] == [55, 125, 135]
    load = calculate_cyclic_bus_load(2, 2, 1_000_000, 0.001, 10)
    assert load.bits_per_sync == 55 + 2 * 250
    assert load.slow_bits_per_sync == (2 * 135 + 4 * 135) / 10
    assert load.used_fraction == pytest.approx(0.636)
    assert load.has_reserve
    assert not calculate_cyclic_bus_load(3, 0, 1_000_000, 0.001, 10).has_reserve  # 80 % and the seldom ones
    assert calculate_cyclic_bus_load(3, 0, 1_000_000, 0.002, 5).has_reserve


def refused(*changes: tuple[str, str]) -> FileFinding:
    text = resources.read_machine_file("gt75-canopen.toml")
    for old, new in (('mode = "pvt"', 'mode = "csp"'), ('drive = "epos2"', 'drive = "epos4"'), *changes):
        assert old in text
        text = text.replace(old, new)
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text, "m.toml")
    (finding,) = caught.value.findings
    return finding


def test_overloaded_bus_is_rejected_with_the_sync_interval_that_fits() -> None:
    slow = refused(("sync_ms = 10 ", "sync_ms = 1 "), ("bitrate = 1000000\n", "bitrate = 500000\n"))
    assert (slow.path, slow.value) == ("canopen.sync_ms", "1")
    for value in ("2 axis drives", "127%", "500000 bit/s", "sync_ms to at least 2"):
        assert value in slow.expected_value


def test_sync_must_be_whole_milliseconds_and_commit_time_long_enough() -> None:
    broken = refused(("sync_ms = 10 ", "sync_ms = 2.5 "))
    assert (broken.path, broken.value) == ("canopen.sync_ms", "2.5")
    assert "60C2" in broken.expected_value
    late = refused(
        ("sync_ms = 10 ", "sync_ms = 2 "),
        ("commit_ms = 140", "commit_ms = 19"),
        ("lease_ms = 200", "lease_ms = 90"),
    )
    assert (late.path, late.value) == ("machine.commit_ms", "19")
    assert "20" in late.expected_value


def test_drive_family_of_a_node_overrides_the_common_family() -> None:
    bench = CanBench(
        cyclic("csp", ("Z = { id = 2 }", 'Z = { id = 2, drive = "epos4", counts_per_rev = 4000 }'))
    )
    drives = bench.machine.axes.drives.axes
    assert [axis.drive.profile.name for axis in drives] == ["cia402", "epos4"]
    assert bench.peers.plant.axis_drives["Z"].values[0x60A9, 0] == 0x00B44700
    assert CIA402_PROFILE.unit_objects == ()
    bench.close()
