"""Session of HAL: halrun with the machine's file and TurnDesk's section, and a socket to the bridge.

The owner of a session locks its folder, so a folder without a lock belongs to a control that was killed. The
bridge of such a session detects the loss and shuts the machine down. A new session can begin only after that.
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
from drivers.hal.bridge.packets import BridgeAxis, BridgeConfig, Head, number, pack, text, unpack
from drivers.hal.hal_border import BIT, BRIDGE, Border, border_of, bridge_nets, columns, session_text
from drivers.hal.hal_config import HalConfig

# --- Session folders, and the remains of sessions whose control was killed.


PREFIX = "turndesk-hal-"
_LOCK = "session.lock"


def new_folder() -> tuple[Path, int]:
    """Create a session folder and return it with its lock; closing the lock releases the folder."""
    folder = Path(tempfile.mkdtemp(prefix=PREFIX))
    lock = os.open(folder / _LOCK, os.O_CREAT | os.O_RDWR | os.O_CLOEXEC, 0o600)
    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    return folder, lock


def clear_away(goes_on: Callable[[], bool]) -> None:
    """Remove the folders of sessions without a control, as soon as their processes have ended.

    ``goes_on`` is called between two checks and must wait briefly. When it returns False, folders with
    running processes remain.
    """
    for folder in _deserted():
        while _runs(folder) and goes_on():
            pass
        if not _runs(folder):
            shutil.rmtree(folder, ignore_errors=True)


def _deserted() -> Iterator[Path]:
    for folder in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
        with suppress(OSError):  # The folder belongs to another user or was just removed.
            found = folder.lstat()
            if stat.S_ISDIR(found.st_mode) and os.geteuid() in {0, found.st_uid} and not _locked(folder):
                yield folder


def _locked(folder: Path) -> bool:
    """Return whether a session folder is locked.

    Raises OSError for a folder without a lock file, which is just being created or does not belong to
    TurnDesk.
    """
    lock = os.open(folder / _LOCK, os.O_RDWR | os.O_NOFOLLOW | os.O_CLOEXEC)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(lock)
    return False


def _runs(folder: Path) -> bool:
    """Return whether a process that was started with this folder is still running."""
    name = os.fsencode(str(folder))
    for told in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):
            if name in told.read_bytes():
                return True
    return False


# --- The session.


PYTHON = "/usr/bin/python3"
_SCRIPT = Path(__file__).parent / "bridge" / "bridge_process.py"
_START = 30.0  # Seconds for boards that need long to be configured.
_END = 15.0
_LINGER = 0.5  # Seconds for which HAL continues after the end of its setpoints when the bridge has crashed.
_LOOK = 0.05  # Seconds between two checks for another session.
_LARGEST = 1 << 17
_ALIVE = "alive"  # File that the bridge locks while it runs.
_IN_ORDER = "ended"  # File that the bridge creates when it ends normally.
# The shared memory of streamer and bridge remains when the last of them is killed. halrun -U removes only
# HAL's other shared memory, and streamer rejects a segment that is too small.
CLEAR_STREAMS = "for key in 0x48535430 0x48535431; do ipcrm -M $key 2>/dev/null; done; true\n"

# Messages of halrun and their texts for the operator.
_PLAIN = {
    "Refusing to run as root": "LinuxCNC does not run as root; start TurnDesk as a regular user",
    "Realtime already running": (
        "another LinuxCNC or HAL session is running; close that session, or run halrun -U after a crash"
    ),
}


_ENDED, _MUTE = "HAL bridge process has ended", "no error message"


class Verdict(NamedTuple):
    """Result of the check of one pin: its key in the machine file, its name, and its error."""

    path: str
    pin: str
    trouble: str


class BridgeLink(Protocol):
    """Packet connection to a bridge, whose methods never wait."""

    warnings: tuple[str, ...]

    def send(self, data: bytes) -> None:
        """Send a packet. Raises DriverError if the bridge does not accept it."""
        ...

    def receive(self) -> Iterator[tuple[Head, Sequence[float]]]:
        """Yield the received packets. Raises DriverError if the bridge has ended."""
        ...

    @property
    def down(self) -> bool:
        """Whether HAL has ended after its bridge, so that it can be started again."""
        ...

    def hang_up(self) -> None:
        """Make the bridge brake and switch the power off, and stop communicating."""
        ...

    def close(self) -> None:
        """Close the connection, upon which the bridge ends."""
        ...


def bridge_config(config: HalConfig) -> BridgeConfig:
    """Return the configuration of the bridge."""
    pins = border_of(config).pins
    read = [pin for pin in pins if pin.way != "out" and not pin.name.startswith(("in.", "is.", "analog."))]
    written = [pin.name for pin in pins if pin.way == "out"]
    return BridgeConfig(
        axes=tuple(
            BridgeAxis(axis.name, axis.amax, axis.following_window, axis.following_time, axis.is_spindle)
            for axis in config.driven
        ),
        period=config.table.period,
        ahead=config.table.ahead,
        outputs={name: output.safe for name, output in config.outputs.items()},
        lamps=tuple(name for name, output in config.outputs.items() if output.lamp),
        inputs=tuple(config.inputs),
        analog=tuple(config.pots),
        bits=tuple(pin.name for pin in read if pin.kind == BIT),
        spindle=tuple(name.removeprefix("spindle.") for name in written if name.startswith("spindle.")),
        turns=bool(config.spindle.pins.position),
        speed=bool(config.spindle.pins.velocity),
        marks=sum(bool(axis.switch) for axis in config.driven) + (config.probe is not None),
        figures=tuple(pin.name for pin in read if pin.kind != BIT),
    )


class HalSession:
    """HAL session that its constructor starts.

    The constructor raises DriverError if halrun is missing or fails.
    """

    def __init__(self, config: HalConfig, zero: float, *, only_check: bool = False) -> None:
        _demand_halrun()
        _clear_leftovers()
        self._folder, self._lock = new_folder()
        self.warnings: tuple[str, ...] = ()
        self.verdicts: tuple[Verdict, ...] = ()
        try:
            self._start(config, zero, only_check=only_check)
        except BaseException:
            self.close()
            raise

    _halrun: subprocess.Popen[bytes] | None = None
    # Process of the bridge; HAL's processes keep its socket open, so the end of the bridge causes no end of
    # file.
    _bridge: int | None = None
    _socket: socket.socket | None = None

    def _start(self, config: HalConfig, zero: float, *, only_check: bool) -> None:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._socket = ours
        with theirs:
            self._write(config, theirs.fileno(), zero, only_check=only_check)
            log = (self._folder / "halrun.log").open("wb")
            with log:
                # A separate process session: Ctrl-C reaches only the control, which then ends HAL in order.
                self._halrun = subprocess.Popen(
                    ["halrun", "-f", str(self._folder / "session.hal")],
                    cwd=config.file.parent,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=subprocess.STDOUT,
                    pass_fds=(theirs.fileno(),),
                    start_new_session=True,
                )
        self._wait_for_bridge(only_check=only_check)
        ours.setblocking(False)

    def _write(self, config: HalConfig, fd: int, zero: float, *, only_check: bool) -> None:
        """Write the files of the session."""
        border = border_of(config)
        try:
            machine = config.file.read_text(encoding="utf-8")
        except (OSError, UnicodeError) as error:
            raise DriverError(
                "{file}: the HAL file cannot be read: {error}", file=config.file, error=error
            ) from error
        folder, session = self._folder, session_text(machine, border, config.table.thread, str(config.file))
        (folder / "bridge.json").write_text(
            json.dumps(_told(config, border, folder, fd, zero, only_check=only_check)), encoding="utf-8"
        )
        # The bridge holds a lock while it runs, because waitusr of HAL does not detect a crash. After a
        # crash, HAL continues for a while: the setpoints are played, and the limits brake.
        ramp = max((axis.vmax / axis.amax for axis in config.driven), default=0.0)
        left = _LINGER + config.table.ahead + config.table.watchdog + ramp
        linger = f'[ -e "{folder / _IN_ORDER}" ] || sleep {left:.2f}\n'
        (folder / "linger.sh").write_text(linger, encoding="utf-8")
        (folder / "clear.sh").write_text(CLEAR_STREAMS, encoding="utf-8")
        start = () if only_check else ("start",)
        lines = (
            f"loadusr -w /bin/sh {folder / 'clear.sh'}",
            session,
            f"loadusr -Wn {BRIDGE} {PYTHON} {_SCRIPT} {folder / 'bridge.json'}",
            *start,
            f"loadusr -w flock {folder / _ALIVE} /bin/sh {folder / 'linger.sh'}",
        )
        (folder / "session.hal").write_text("\n".join((*lines, "")), encoding="utf-8")

    def _wait_for_bridge(self, *, only_check: bool) -> None:
        deadline = time.monotonic() + _START
        while True:
            head = self._first_words(deadline)
            if why := text(head, "error"):
                raise DriverError("HAL: {why}", "hal-setup", why=why)
            if isinstance(said := head.get("verdicts"), list):
                self.verdicts = tuple(Verdict(*each) for each in said)
                wrong = [each for each in self.verdicts if each.trouble]
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
                        path=first.path,
                        pin=first.pin,
                        fault=first.trouble,
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

    def _first_words(self, deadline: float) -> Head:
        """Return the next packet during startup. Raises DriverError with the output of halrun."""
        assert self._socket is not None
        assert self._halrun is not None
        while time.monotonic() < deadline:
            self._socket.settimeout(0.2)
            try:
                data = self._socket.recv(_LARGEST)
            except TimeoutError:
                if self._halrun.poll() is None:
                    continue
                data = b""
            if not data:
                with suppress(subprocess.TimeoutExpired):
                    self._halrun.wait(3.0)
                words = Message("halrun ended during startup: {output}", output=self._said() or _MUTE)
                raise DriverError(words, "hal-setup")
            return unpack(data)[0]
        words = Message(
            "HAL did not start within {seconds} s: {output}",
            seconds=f"{_START:g}",
            output=self._said() or _MUTE,
        )
        raise DriverError(words, "hal-setup")

    def _said(self) -> str:
        """Return the last lines of the output of halrun that explain a failure."""
        try:
            lines = (self._folder / "halrun.log").read_text(encoding="utf-8", errors="replace").splitlines()
        except OSError:
            lines = []
        told = [line.strip() for line in lines if line.strip() and not line.startswith("Note:")]
        for words, plain in _PLAIN.items():
            if any(words in line for line in told):
                return plain
        return " / ".join(told[-3:]).replace(f"{self._folder}/", "")

    # --- the link -----------------------------------------------------------------------------------------

    def send(self, data: bytes) -> None:
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

    def receive(self) -> Iterator[tuple[Head, Sequence[float]]]:
        """Yield all received packets. Raises DriverError if the bridge has ended."""
        assert self._socket is not None
        while True:
            try:
                data = self._socket.recv(_LARGEST)
            except BlockingIOError:
                break
            except OSError:
                data = b""
            if not data:
                raise DriverError(_ENDED, "hal-bridge")
            yield unpack(data)
        if self._bridge is not None and select.select([self._bridge], [], [], 0.0)[0]:
            raise DriverError(": ".join(filter(None, (_ENDED, self._said()))), "hal-bridge")

    def hang_up(self) -> None:
        """Make the bridge brake at once and end."""
        assert self._socket is not None
        with suppress(OSError):
            self._socket.send(pack({"do": "ramp-off"}))
            self._socket.shutdown(socket.SHUT_RDWR)

    @property
    def down(self) -> bool:
        """Whether HAL has been shut down after its bridge has ended."""
        return self._halrun is None or self._halrun.poll() is not None

    def close(self) -> None:
        """End the bridge, which brakes the axes, and wait until halrun has shut HAL down."""
        if self._socket is not None:
            with suppress(OSError):
                self._socket.send(pack({"do": "end"}))
            self._socket.close()
        if self._bridge is not None:
            os.close(self._bridge)
            self._bridge = None
        if self._halrun is not None:
            try:
                failed = self._halrun.wait(_END)
            except subprocess.TimeoutExpired:
                self._halrun.kill()
                failed = self._halrun.wait()
            if failed:  # halrun or HAL's process was killed, so HAL is not shut down.
                with suppress(OSError, subprocess.TimeoutExpired):
                    subprocess.run(["halrun", "-U"], capture_output=True, timeout=_END, check=False)
        shutil.rmtree(self._folder, ignore_errors=True)
        os.close(self._lock)


def _clear_leftovers() -> None:
    """Wait until the HAL of a killed control has been shut down."""
    deadline = time.monotonic() + _END

    def goes_on() -> bool:
        time.sleep(_LOOK)
        return time.monotonic() < deadline

    clear_away(goes_on)


def _demand_halrun() -> None:
    """Raise DriverError if LinuxCNC is not installed."""
    if shutil.which("halrun") is None:
        raise DriverError(
            "halrun was not found; backend hal requires LinuxCNC (apt install linuxcnc-uspace)", "hal-setup"
        )


def _told(
    config: HalConfig, border: Border, folder: Path, fd: int, zero: float, *, only_check: bool
) -> dict[str, object]:
    """Return the contents of the configuration file for the bridge's process."""
    return {
        "fd": fd,
        "zero": zero,
        "name": BRIDGE,
        "only_check": only_check,
        "wanted": [(link.path, link.pin, link.kind, link.drives, link.ours[0]) for link in border.links],
        "pins": [(pin.name, pin.kind, pin.way) for pin in border.pins],
        "own": dict(bridge_nets(border)),
        "nets": str(folder / "nets.hal"),
        "alive": str(folder / _ALIVE),
        "ended": str(folder / _IN_ORDER),
        "columns": "f" * columns(config),
        "sampled": border.columns,
        "bridge": asdict(bridge_config(config)),
    }
