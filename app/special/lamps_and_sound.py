"""Lamps and sound: lamp and sound of each event, volume, sound test and lamp test."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet
from app.desk.persistence import Persistence
from app.desk.status.sounds import Sounds
from app.desk.translation import tr
from app.special.special_functions import SpecialFunction
from core.access.access_table import Act
from core.executor.commands import ForceOutput
from core.executor.signal_lamps import SignalKinds
from core.executor.snapshot import Snapshot
from core.machine.hardware_model import SIGNALS, Signal
from core.machine.machine_model import Machine
from core.message import Message
from core.store.store_errors import StoreError

_SETTING = "sound"
_STEP = 20
_LAMPS = {"lamp_red": "RED", "lamp_amber": "AMBER", "lamp_green": "GREEN"}
KINDS = tuple(SIGNALS)


@dataclass(slots=True)
class DeskSounds:
    """Sounds for new events, with ``volume`` 0 by default. The kinds in ``silent`` are muted."""

    desk: Desk
    persistence: Persistence
    sounds: Sounds = field(default_factory=Sounds)
    volume: int = 0
    silent: frozenset[str] = frozenset()
    _signals: SignalKinds = field(default_factory=SignalKinds)
    _before: tuple[str, ...] | None = None
    _told: str = ""
    _read: bool = False

    def see(self, snapshot: Snapshot) -> None:
        """Play the sounds of events that began since the last frame. The first frame is silent."""
        self.recall()
        kinds = self._signals.see(snapshot.state, snapshot.ends, barred=bool(snapshot.next_barred))
        before, self._before = self._before, kinds
        new = [] if before is None else [kind for kind in kinds if kind not in before and self._heard(kind)]
        if self.volume and new:
            self.sounds.play(SIGNALS[min(new, key=KINDS.index)].tones, self.volume)
        self._tell()

    def _heard(self, kind: str) -> bool:
        return kind not in self.silent and bool(SIGNALS[kind].tones)

    def _tell(self) -> None:
        """Report each sound error once."""
        why = self.sounds.trouble
        if why and why != self._told:
            self.desk.say(tr(Message("NO SOUND: {why}", why=why)))
        self._told = why or self._told

    def tried(self) -> None:
        """Play the test sound and report a repeated error again."""
        self._told = self.sounds.trouble = ""
        self.sounds.play(SIGNALS["part"].tones, self.volume)

    def recall(self) -> None:
        """Load the stored settings once."""
        if self._read:
            return
        self._read = True
        try:
            kept = self.persistence.read_setting(_SETTING)
        except StoreError:
            return
        match kept:
            case {"volume": int(volume), "silent": list(silent)}:
                self.volume, self.silent = max(0, min(100, volume)), frozenset(map(str, silent))

    def choose(self, volume: int, silent: frozenset[str]) -> None:
        """Store the volume and the muted kinds. Raises StoreError."""
        before, self.volume, self.silent = self.volume, max(0, min(100, volume)), silent
        self.persistence.save_setting(_SETTING, {"volume": self.volume, "silent": sorted(silent)})
        told = Message(
            "sound volume: {before} → {volume} %, muted: {silent}",
            before=before,
            volume=self.volume,
            silent=", ".join(sorted(silent)) or "nothing",
        )
        self.persistence.note_change(told)

    def close(self) -> None:
        """Stop all sounds."""
        self.sounds.close()


class LampsAndSound(SpecialFunction):
    """Special function with one row per event: its lamp, if fitted, and its sound."""

    name = "LAMPS AND SOUND"
    use = "lamps, sounds, volume, lamp test"

    def __init__(self, desk: Desk, machine: Machine, sounds: DeskSounds) -> None:
        super().__init__(desk)
        self.machine, self.sounds = machine, sounds

    @property
    def count(self) -> int:
        """Number of events."""
        return len(KINDS)

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of lamps and sounds."""
        self.sounds.recall()
        rows = tuple(
            Row((tr(signal.use), self._lamp(signal), self._sound(kind, signal)))
            for kind, signal in SIGNALS.items()
        )
        volume = f"{self.sounds.volume} %" if self.sounds.volume else tr("OFF")
        lamps = ", ".join(self.machine.lamps) or tr(
            "no lamps are defined in the machine file; add lamp_red, lamp_amber, "
            "lamp_green, lamp_buzzer under [io.out]"
        )
        notes = (tr(Message("VOLUME: {volume}", volume=volume)), tr(Message("LAMPS: {names}", names=lamps)))
        heads = ("DESCRIPTION", "LAMP", "SOUND")
        return Sheet("LAMPS AND SOUND", heads, (0.5, 0.32, 0.18), rows, self.marked, notes=notes,
                     raw=frozenset({0, 1, 2}))  # fmt: skip

    def _lamp(self, signal: Signal) -> str:
        words = tr(_LAMPS[signal.lamp]) + (f" {tr('BLINKING')}" if signal.blinks else "")
        buzz = f" + {tr('BUZZER')} {signal.buzz:g} s" if signal.buzz else ""
        return words + buzz

    def _sound(self, kind: str, signal: Signal) -> str:
        if not signal.tones:
            return ""
        return tr("OFF") if kind in self.sounds.silent else tr("ON")

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys for volume, sound test and lamp test."""
        return {
            "F2": Key("SOFTER", lambda: self._louder(-_STEP)),
            "F3": Key("LOUDER", lambda: self._louder(_STEP)),
            "F4": Key("TRY", self.try_out),
            "F5": Key("LAMP TEST", self.test),
        }

    def act(self) -> bool:
        """Turn the sound of the selected event on or off."""
        kind = KINDS[self.marked]
        if SIGNALS[kind].tones:
            silent = self.sounds.silent ^ {kind}
            self._choose(self.sounds.volume, silent)
        else:
            self.desk.say("NO SOUND FOR A RUNNING CYCLE: ONLY THE LAMP SHOWS IT")
        return True

    def _louder(self, by: int) -> None:
        self._choose(self.sounds.volume + by, self.sounds.silent)

    def _choose(self, volume: int, silent: frozenset[str]) -> None:
        self.desk.clear()
        if not self.desk.refused(Act.SCREEN):
            self.desk.keep(lambda: self.sounds.choose(volume, silent))

    def try_out(self) -> None:
        """Play the sound of a finished part at the present volume."""
        if not self.sounds.volume:
            self.desk.say("VOLUME IS ZERO. F3: LOUDER")
        else:
            self.desk.clear()
            self.sounds.tried()

    def test(self) -> None:
        """Turn all lamps on for 2 s, at rest."""
        if not self.machine.lamps:
            self.desk.say("THIS MACHINE HAS NO LAMPS. DEFINE THEM UNDER [io.out] IN THE MACHINE FILE")
        else:
            self.desk.clear()
            self.desk.post(ForceOutput(self.machine.lamps[0], True))

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        return "ENTER: SOUND ON/OFF   F3: LOUDER   F4: TRY   ESC: BACK"
