"""Spindle encoder on the bus, which is a CiA 406 node or the second encoder input of a drive."""

from __future__ import annotations

from collections import deque

import canopen
from canopen.emcy import EmcyError

from core.message import Message
from core.ports import DriverError, Fault
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_config import EncoderConfig
from drivers.canopen.canopen_setup import NodeSetup, build_monitoring_objects
from drivers.canopen.cia402_drives import MAX_MISSING_REPLIES, Cia402Drive

_SPEED_WINDOW_S = (
    0.1  # Seconds over which the speed is measured, so that a late reading changes it by about 1 %.
)
_MAX_SPEED_FACTOR = 2.0  # Factor of the maximum speed that indicates a broken wire.
_SCALING_ENABLED = 0x04  # Bit 2 of 0x6000: the counts per revolution are 0x6001 instead of the resolution.
_COUNTER_RANGE = 2**32


class CanEncoder:
    """Spindle encoder that measures speed and angle from its counts at each SYNC.

    A fault remains active until ``clear_fault`` is called.
    """

    def __init__(self, config: EncoderConfig, bus: CanBus, drive: Cia402Drive | None) -> None:
        self._config = config
        self._bus = bus
        self._drive = drive
        self._setup = drive.setup if drive is not None else _setup_of(config, bus)
        self.node = self._setup.node
        self.failure: Fault | str = ""
        self.missing_reply_count = 0
        self._range = _COUNTER_RANGE  # Counts after which the position wraps around.
        self._raw: int | None = None
        self._counts = 0
        self._asked = self._heard = bus.clock.now()
        self._reads: deque[tuple[float, float]] = deque()  # Time of the SYNC, and revolutions.

    def connect(self) -> None:
        """Check the encoder and map its PDO.

        Raises DriverError if the encoder does not respond or does not match the machine file.
        """
        setup, config = self._setup, self._config
        if config.node is not None:
            setup.enter_pre_operational()
            setup.require_profile(406)
            setup.configure_objects(
                build_monitoring_objects(self._bus.config), config.node.sdo, (od.HEARTBEAT,)
            )
            self._check_counts()
            self.node.nmt.add_heartbeat_callback(self._heartbeat)
            self.node.emcy.add_callback(self._emergency)
        entry = config.index | config.object_subindex << 16
        every = self._bus.config.slow_reply_divisor
        setup.map_sent_objects(1 if self._drive is None else 3, self._told, (entry, 32), every=every)
        self._raw, self.missing_reply_count, self.failure = None, 0, ""
        self._heard = self._bus.clock.now()
        self._reads.clear()

    def start_node(self) -> None:
        """Start the node by NMT, unless the encoder is connected to a drive.

        The owner of such a drive starts its node.
        """
        if self._drive is None:
            self.node.nmt.state = "OPERATIONAL"

    def record_sync(self, now_s: float, *, reply_expected: bool = True) -> None:
        """Record that a SYNC was sent at time ``now_s``.

        With ``reply_expected``, the encoder must reply to this SYNC.
        """
        self.missing_reply_count, self._asked = self.missing_reply_count + reply_expected, now_s

    def supervise_encoder(self) -> None:
        """Set a fault if heartbeats or replies are missing."""
        silent = self._bus.clock.now() - self._heard
        if self._drive is None and silent > 3.0 * self._bus.config.heartbeat:
            self._wrong(
                "no heartbeat from the encoder for {silent} s; check cable and power", silent=f"{silent:.2f}"
            )
        elif self.missing_reply_count > MAX_MISSING_REPLIES:
            self._wrong("the encoder does not respond to SYNC; check cable and power")

    def clear_fault(self) -> None:
        """Configure the encoder again after a fault.

        If this fails, the encoder sets a fault again. The fault affects only the spindle, not the axes.
        """
        if not self.failure:
            return
        try:
            self.connect()
            self.start_node()
        except DriverError as error:
            self.failure = Fault("spindle encoder {error}", "spindle-encoder", error=error)

    def measure_rpm(self) -> float:
        """Return the mean speed of the last 0.1 s in rpm, signed."""
        if len(self._reads) < 2:
            return 0.0
        (t0, turns0), (t1, turns1) = self._reads[0], self._reads[-1]
        return 60.0 * (turns1 - turns0) / (t1 - t0)

    def read_angle(self) -> tuple[float, float] | None:
        """Return the time of the last encoder reply in seconds, and the revolutions at that time.

        Returns None before the first reply.
        """
        return self._reads[-1] if self._reads else None

    def read_fault(self) -> str:
        """Return the reason why the measurement is invalid, or an empty string if it is valid."""
        return self._bus.failure or self.failure

    def _check_counts(self) -> None:
        """Compare the counts per revolution and the counting range of the encoder with the machine file.

        Raises DriverError if the counts differ, or if the counter may wrap around between two replies.
        """
        setup, config = self._setup, self._config
        scaled = setup.read(od.ENCODER_MODE) & _SCALING_ENABLED
        counts = setup.read(od.ENCODER_STEPS if scaled else od.ENCODER_RESOLUTION)
        if counts != abs(config.counts_per_rev):
            where = "6001:0" if scaled else "6501:0"
            raise DriverError(
                "{name}: the encoder reports {counts} counts per revolution (object {place}), but "
                "spindle.encoder.counts_per_rev is {counts_per_rev}",
                name=config.name,
                counts=counts,
                place=where,
                counts_per_rev=abs(config.counts_per_rev),
            )
        turns = setup.read(od.ENCODER_TURNS)
        self._range = (setup.read(od.ENCODER_RANGE) if scaled else counts * max(turns, 1)) or _COUNTER_RANGE
        wait = self._bus.config.sync * self._bus.config.slow_reply_divisor
        between = (MAX_MISSING_REPLIES + 1) * wait * config.max_rpm / 60.0  # Maximum revolutions.
        if self._range < 2.0 * between * counts:
            raise DriverError(
                "{name}: the encoder count wraps around after {range} rev, but the spindle may turn "
                "{between} rev between two responses; use an encoder whose count covers at least "
                "{between2} rev",
                name=config.name,
                range=f"{self._range / counts:.3g}",
                between=f"{between:.2g}",
                between2=f"{2.0 * between:.3g}",
            )

    def _told(self, map_: canopen.pdo.PdoMap) -> None:
        raw = int.from_bytes(map_.data[:4], "little") % self._range
        last, self._raw = self._raw, raw
        now, self.missing_reply_count = self._asked, 0
        if last is None:
            last = raw
        half = self._range // 2
        moved = (raw - last + half) % self._range - half
        self._counts += moved
        if self._reads:
            self._doubt(abs(moved), now - self._reads[-1][0])
        if not self._reads or now > self._reads[-1][0]:
            self._reads.append((now, self._counts / self._config.counts_per_rev))
        while self._reads[-1][0] - self._reads[0][0] > _SPEED_WINDOW_S:
            self._reads.popleft()

    def _doubt(self, moved: int, passed: float) -> None:
        turns = moved / abs(self._config.counts_per_rev)
        most = (
            _MAX_SPEED_FACTOR
            * self._config.max_rpm
            / 60.0
            * max(passed, self._bus.config.sync * self._bus.config.slow_reply_divisor)
        )
        if turns > most:
            self._wrong(
                "the encoder count jumped by {revolutions} revolutions in one step; check cable and shield",
                revolutions=f"{turns:.2f}",
            )

    def _heartbeat(self, state: int) -> None:
        self._heard = self._bus.clock.now()
        if state == 0:
            self._wrong("the encoder has restarted")

    def _emergency(self, error: EmcyError) -> None:
        if error.code & 0xFF00:
            self._wrong(
                Message(
                    "{description} (EMCY {code})",
                    description=error.get_desc().lower() or "device error",
                    code=f"{error.code:04X}",
                )
            )

    def _wrong(self, what: str, **values: object) -> None:
        what = Message(what, **values) if values else what
        self.failure = self.failure or Fault(
            "spindle encoder {name}: {what}", "spindle-encoder", name=self._config.name, what=what
        )


def _setup_of(config: EncoderConfig, bus: CanBus) -> NodeSetup:
    assert config.node is not None  # Otherwise the encoder is the second input of a drive.
    objects = od.load_object_dictionary(config.name, config.node.eds, od.build_encoder_dictionary)
    return NodeSetup(bus, config.name, config.node.id, objects)


class MeasuredSpindle:
    """``core.ports.Spindle`` of a bus that has no spindle drive.

    If the machine has an encoder, this object returns the measured speed. If an inverter drives the
    spindle, the inverter driver replaces this object.
    """

    def __init__(self, encoder: CanEncoder | None) -> None:
        self._encoder = encoder

    def set_speed(self, rpm: float) -> None:
        """Raise DriverError unless ``rpm`` is 0, because the bus has no spindle drive."""
        if rpm:
            raise DriverError(
                "this bus has no spindle drive; check spindle.driver", "spindle-off", reason="no-drive"
            )

    def start_coasting(self) -> None:
        """Do nothing, because the bus has no spindle drive."""

    def speed(self) -> float:
        """Return the measured speed in rpm, signed, or 0 if the machine has no encoder."""
        return self._encoder.measure_rpm() if self._encoder is not None else 0.0

    def read_angle(self) -> tuple[float, float] | None:
        """Return the time of the last encoder reply in seconds, and the revolutions at that time.

        Return None before the first reply or if the machine has no encoder.
        """
        return self._encoder.read_angle() if self._encoder is not None else None

    def read_fault(self) -> str:
        """Return the reason why the encoder measurement is invalid, or an empty string if it is valid."""
        return self._encoder.read_fault() if self._encoder is not None else ""
