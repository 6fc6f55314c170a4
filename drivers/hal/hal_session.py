"""HAL session: halrun with the machine's HAL file and TurnDesk's section, and a bridge socket.

The owner of a session locks its folder, so a folder without a lock belongs to a control that was killed.
The bridge of such a session detects the loss and shuts down the machine. A new session can begin only after
that.
"""

from __future__ import annotations

import fcntl
import json
import os
import select
import shutil
import socket
import stat
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import NamedTuple, Protocol

from core.message import Message
from core.ports import DriverError
from drivers.hal.bridge.packets import (
    BridgeAxis,
    BridgeConfig,
    PacketHead,
    number,
    pack_packet,
)
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_section import (
    BIT,
    BRIDGE_COMPONENT,
    HalSection,
    build_hal_section,
    count_stream_columns,
    insert_hal_section,
    list_bridge_nets,
)
from drivers.process_messages import MessageSocket, ReceivedMessage, text

# --- Session folders, and the remains of sessions whose control was killed.


FOLDER_PREFIX = "turndesk-hal-"
_LOCK_NAME = "session.lock"


def create_session_folder() -> tuple[Path, int]:
    """Create a session folder, and return it with its lock.

    Closing the lock releases the folder.
    """
    folder = Path(tempfile.mkdtemp(prefix=FOLDER_PREFIX))
    lock = os.open(folder / _LOCK_NAME, os.O_CREAT | os.O_RDWR | os.O_CLOEXEC, 0o600)
    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    return folder, lock


def remove_old_session_folders(should_continue: Callable[[], bool]) -> None:
    """Remove the folders of sessions whose control has ended, as soon as their processes have ended.

    ``should_continue`` is called between two checks, and must wait briefly. If it returns False, folders
    with running processes remain.
    """
    for folder in _deserted():
        while _is_running(folder) and should_continue():
            pass
        if not _is_running(folder):
            shutil.rmtree(folder, ignore_errors=True)


def _deserted() -> Iterator[Path]:
    for folder in Path(tempfile.gettempdir()).glob(f"{FOLDER_PREFIX}*"):
        with suppress(OSError):  # The folder belongs to another user or was just removed.
            found = folder.lstat()
            if stat.S_ISDIR(found.st_mode) and os.geteuid() in {0, found.st_uid} and not _is_locked(folder):
                yield folder


def _is_locked(folder: Path) -> bool:
    """Return whether a session folder is locked.

    Raises OSError for a folder without a lock file. Such a folder is just being created or does not belong
    to TurnDesk.
    """
    lock = os.open(folder / _LOCK_NAME, os.O_RDWR | os.O_NOFOLLOW | os.O_CLOEXEC)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(lock)
    return False


def _is_running(folder: Path) -> bool:
    """Return whether a process that was started with this folder is still running."""
    name = os.fsencode(str(folder))
    for cmdline_path in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):
            if name in cmdline_path.read_bytes():
                return True
    return False


# --- The session.


SYSTEM_PYTHON = "/usr/bin/python3"
_SCRIPT = Path(__file__).parent / "bridge" / "bridge_process.py"
_START = 30.0  # Seconds for boards that need long to be configured.
_END_TIMEOUT_S = 15.0
_CRASH_DELAY_S = (
    0.5  # Seconds for which HAL continues after the end of its setpoints when the bridge has crashed.
)
_START_POLL_S = 0.2  # Seconds between two checks whether halrun is still running.
_POLL_INTERVAL_S = 0.05  # Seconds between two checks for another session.
_ALIVE_FILE = "alive"  # File that the bridge locks while it runs.
_ENDED_FILE = "ended"  # File that the bridge creates when it ends normally.
# The shared memory of streamer and bridge remains when the last of them is killed. halrun -U removes only
# HAL's other shared memory, and streamer rejects a segment that is too small.
CLEAR_STREAMS_SCRIPT = "for key in 0x48535430 0x48535431; do ipcrm -M $key 2>/dev/null; done; true\n"

# Messages of halrun and their texts for the operator.
_HALRUN_MESSAGES = {
    "Refusing to run as root": "LinuxCNC does not run as root; start TurnDesk as a regular user",
    "Realtime already running": (
        "another LinuxCNC or HAL session is running; close that session, or run halrun -U after a crash"
    ),
}


_ENDED, _MUTE = "HAL bridge process has ended", "no error message"
INVALID_PACKET = "the HAL bridge sent an invalid packet"


class PinCheckResult(NamedTuple):
    """The result of the check of one pin, with its key in the machine file, its name and its error."""

    machine_file_key: str
    pin_name: str
    error_text: str


class BridgeLink(Protocol):
    """A packet connection to a bridge, with methods that never block."""

    warnings: tuple[str, ...]

    def send_packet(self, data: bytes) -> None:
        """Send a packet.

        Raises DriverError if the bridge does not accept the packet.
        """
        ...

    def receive_packets(self) -> Iterator[tuple[PacketHead, Sequence[float]]]:
        """Yield the received packets.

        Raises DriverError if the bridge has ended, and ValueError for an invalid packet.
        """
        ...

    @property
    def has_shut_down(self) -> bool:
        """Return whether HAL has ended after its bridge, so that it can be started again."""
        ...

    def stop_bridge(self) -> None:
        """Make the bridge brake and switch off the power, and end the communication."""
        ...

    def close(self) -> None:
        """Close the connection, after which the bridge ends."""
        ...


def create_bridge_config(config: HalConfig) -> BridgeConfig:
    """Return the configuration of the bridge."""
    pins = build_hal_section(config).bridge_pins
    read = [
        pin for pin in pins if pin.direction != "out" and not pin.name.startswith(("in.", "is.", "analog."))
    ]
    written = [pin.name for pin in pins if pin.direction == "out"]
    return BridgeConfig(
        axes=tuple(
            BridgeAxis(
                axis.name, axis.amax, axis.following_window, axis.following_time, axis.is_spindle_c_axis
            )
            for axis in config.driven_axes
        ),
        period=config.hal_table.period,
        ahead=config.hal_table.ahead,
        outputs={name: output.safe_state for name, output in config.outputs.items()},
        lamps=tuple(name for name, output in config.outputs.items() if output.is_lamp),
        inputs=tuple(config.inputs),
        analog=tuple(config.pots),
        bits=tuple(pin.name for pin in read if pin.hal_type == BIT),
        spindle=tuple(name.removeprefix("spindle.") for name in written if name.startswith("spindle.")),
        turns=bool(config.spindle.pins.position),
        speed=bool(config.spindle.pins.velocity),
        marks=sum(bool(axis.switch_key) for axis in config.driven_axes) + (config.probe_input is not None),
        figures=tuple(pin.name for pin in read if pin.hal_type != BIT),
    )


class HalSession:
    """A HAL session that the constructor starts.

    The constructor raises DriverError if halrun is missing or fails.
    """

    def __init__(self, config: HalConfig, clock_zero: float, *, check_only: bool = False) -> None:
        _require_halrun()
        _remove_leftovers()
        self._folder, self._lock = create_session_folder()
        self.warnings: tuple[str, ...] = ()
        self.pin_verdicts: tuple[PinCheckResult, ...] = ()
        try:
            self._start(config, clock_zero, only_check=check_only)
        except BaseException:
            self.close()
            raise

    _halrun: subprocess.Popen[bytes] | None = None
    # Process of the bridge; HAL's processes keep its socket open, so the end of the bridge causes no end of
    # file.
    _bridge: int | None = None
    _socket: MessageSocket | None = None

    def _start(self, config: HalConfig, zero: float, *, only_check: bool) -> None:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._socket = MessageSocket(ours)
        with theirs:
            self._write(config, theirs.fileno(), zero, check_only=only_check)
            log = (self._folder / "halrun.log").open("wb")
            with log:
                # A separate process session: Ctrl-C reaches only the control, which then ends HAL in order.
                self._halrun = subprocess.Popen(
                    ["halrun", "-f", str(self._folder / "session.hal")],
                    cwd=config.hal_file.parent,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=subprocess.STDOUT,
                    pass_fds=(theirs.fileno(),),
                    start_new_session=True,
                )
        self._wait_for_bridge(only_check=only_check)

    def _write(self, config: HalConfig, fd: int, zero: float, *, check_only: bool) -> None:
        """Write the session's files, including the HAL file and the bridge configuration."""
        border = build_hal_section(config)
        try:
            machine = config.hal_file.read_text(encoding="utf-8")
        except (OSError, UnicodeError) as error:
            raise DriverError(
                "{file}: the HAL file cannot be read: {error}", file=config.hal_file, error=error
            ) from error
        folder, session = (
            self._folder,
            insert_hal_section(machine, border, config.hal_table.thread, str(config.hal_file)),
        )
        (folder / "bridge.json").write_text(
            json.dumps(_bridge_settings(config, border, folder, fd, zero, only_check=check_only)),
            encoding="utf-8",
        )
        # The bridge holds a lock while it runs, because waitusr of HAL does not detect a crash. After a
        # crash, HAL continues for a while: the setpoints are played, and the limits brake.
        ramp = max((axis.vmax / axis.amax for axis in config.driven_axes), default=0.0)
        left = _CRASH_DELAY_S + config.hal_table.ahead + config.hal_table.watchdog + ramp
        linger = f'[ -e "{folder / _ENDED_FILE}" ] || sleep {left:.2f}\n'
        (folder / "linger.sh").write_text(linger, encoding="utf-8")
        (folder / "clear.sh").write_text(CLEAR_STREAMS_SCRIPT, encoding="utf-8")
        start = () if check_only else ("start",)
        lines = (
            f"loadusr -w /bin/sh {folder / 'clear.sh'}",
            session,
            f"loadusr -Wn {BRIDGE_COMPONENT} {SYSTEM_PYTHON} {_SCRIPT} {folder / 'bridge.json'}",
            *start,
            f"loadusr -w flock {folder / _ALIVE_FILE} /bin/sh {folder / 'linger.sh'}",
        )
        (folder / "session.hal").write_text("\n".join((*lines, "")), encoding="utf-8")

    def _wait_for_bridge(self, *, only_check: bool) -> None:
        deadline = time.monotonic() + _START
        while True:
            head = self._read_first_packet(deadline)
            if why := text(head, "error"):
                raise DriverError("HAL: {why}", "hal-setup", why=why)
            if isinstance(said := head.get("verdicts"), list):
                self.pin_verdicts = tuple(PinCheckResult(*each) for each in said)
                wrong = [each for each in self.pin_verdicts if each.error_text]
                if only_check:
                    return
                if wrong:
                    template = (
                        "{path} = {pin}: {fault} (and {count} more)"
                        if len(wrong) > 1
                        else "{path} = {pin}: {fault}"
                    )
                    first = wrong[0]
                    words = Message(
                        template,
                        path=first.machine_file_key,
                        pin=first.pin_name,
                        fault=first.error_text,
                        count=len(wrong) - 1,
                    )
                    raise DriverError(words, "hal-setup")
            elif head.get("ready") is True:
                # On an old kernel, the end is detected later by silence.
                with suppress(OSError, AttributeError):
                    self._bridge = os.pidfd_open(int(number(head, "pid")))
                warnings = head.get("warnings")
                self.warnings = tuple(map(str, warnings)) if isinstance(warnings, list) else ()
                return

    def _read_first_packet(self, deadline: float) -> PacketHead:
        """Return the next packet during startup.

        Raises DriverError with the output of halrun if no packet is received, and if the packet is invalid.
        """
        assert self._socket is not None
        assert self._halrun is not None
        while time.monotonic() < deadline:
            has_ended = self._halrun.poll() is not None
            has_data = self._socket.wait(0.0 if has_ended else _START_POLL_S)
            try:
                for head, _ in self._socket.receive():
                    return head
            except (OSError, EOFError):
                has_ended, has_data = True, False
            except ValueError as error:
                raise DriverError(INVALID_PACKET, "hal-setup") from error
            if has_ended and not has_data:
                with suppress(subprocess.TimeoutExpired):
                    self._halrun.wait(3.0)
                words = Message("halrun ended during startup: {output}", output=self._read_output() or _MUTE)
                raise DriverError(words, "hal-setup")
        words = Message(
            "HAL did not start within {seconds} s: {output}",
            seconds=f"{_START:g}",
            output=self._read_output() or _MUTE,
        )
        raise DriverError(words, "hal-setup")

    def _read_output(self) -> str:
        """Return the last lines of halrun's output, which explain why HAL failed."""
        try:
            lines = (self._folder / "halrun.log").read_text(encoding="utf-8", errors="replace").splitlines()
        except OSError:
            lines = []
        output_lines = [line.strip() for line in lines if line.strip() and not line.startswith("Note:")]
        for words, plain in _HALRUN_MESSAGES.items():
            if any(words in line for line in output_lines):
                return plain
        return " / ".join(output_lines[-3:]).replace(f"{self._folder}/", "")

    # --- the link -----------------------------------------------------------------------------------------

    def send_packet(self, data: bytes) -> None:
        """Send one packet. Raises DriverError if the bridge has ended or accepts no data."""
        assert self._socket is not None
        try:
            self._socket.send(data)
        except BlockingIOError as error:
            raise DriverError("the HAL bridge no longer accepts data", "hal-silent") from error
        except OSError as error:
            raise DriverError(
                "the HAL bridge has ended ({cause})", "hal-bridge", cause=error.strerror
            ) from error

    def receive_packets(self) -> Iterator[ReceivedMessage]:
        """Yield all received packets.

        Raises DriverError if the bridge has ended, and ValueError for an invalid packet.
        """
        assert self._socket is not None
        try:
            yield from self._socket.receive()
        except (OSError, EOFError):
            raise DriverError(_ENDED, "hal-bridge") from None
        if self._bridge is not None and select.select([self._bridge], [], [], 0.0)[0]:
            raise DriverError(": ".join(filter(None, (_ENDED, self._read_output()))), "hal-bridge")

    def stop_bridge(self) -> None:
        """Make the bridge brake immediately and end."""
        assert self._socket is not None
        with suppress(OSError):
            self._socket.send(pack_packet({"do": "ramp-off"}))
            self._socket.disconnect()

    @property
    def has_shut_down(self) -> bool:
        """Return whether HAL has been shut down after the end of its bridge."""
        return self._halrun is None or self._halrun.poll() is not None

    def close(self) -> None:
        """End the bridge, which brakes the axes, and wait until halrun has shut down HAL."""
        if self._socket is not None:
            with suppress(OSError):
                self._socket.send(pack_packet({"do": "end"}))
            self._socket.close()
        if self._bridge is not None:
            os.close(self._bridge)
            self._bridge = None
        if self._halrun is not None:
            try:
                failed = self._halrun.wait(_END_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                self._halrun.kill()
                failed = self._halrun.wait()
            if failed:  # halrun or HAL's process was killed, so HAL is not shut down.
                with suppress(OSError, subprocess.TimeoutExpired):
                    subprocess.run(["halrun", "-U"], capture_output=True, timeout=_END_TIMEOUT_S, check=False)
        shutil.rmtree(self._folder, ignore_errors=True)
        os.close(self._lock)


def _remove_leftovers() -> None:
    """Wait until the HAL session of a killed control has been shut down, and remove its folder."""
    deadline = time.monotonic() + _END_TIMEOUT_S

    def can_keep_waiting() -> bool:
        time.sleep(_POLL_INTERVAL_S)
        return time.monotonic() < deadline

    remove_old_session_folders(can_keep_waiting)


def _require_halrun() -> None:
    """Raise DriverError if LinuxCNC is not installed."""
    if shutil.which("halrun") is None:
        raise DriverError(
            "halrun was not found; backend hal requires LinuxCNC (apt install linuxcnc-uspace)", "hal-setup"
        )


def _bridge_settings(
    config: HalConfig, section: HalSection, folder: Path, fd: int, zero: float, *, only_check: bool
) -> dict[str, object]:
    """Return the contents of the configuration file for the process of the bridge."""
    return {
        "fd": fd,
        "zero": zero,
        "name": BRIDGE_COMPONENT,
        "only_check": only_check,
        "wanted": [
            (
                link.machine_file_key,
                link.pin_name,
                link.hal_type,
                link.is_driven_by_turndesk,
                link.turndesk_signals[0],
            )
            for link in section.machine_links
        ],
        "pins": [(pin.name, pin.hal_type, pin.direction) for pin in section.bridge_pins],
        "own": dict(list_bridge_nets(section)),
        "nets": str(folder / "nets.hal"),
        "alive": str(folder / _ALIVE_FILE),
        "ended": str(folder / _ENDED_FILE),
        "columns": "f" * count_stream_columns(config),
        "sampled": section.sample_column_types,
        "bridge": asdict(create_bridge_config(config)),
    }
