"""Special function that shows the lamp and sound of each event, and tests lamps and sound.

The operator turns the sound of each event on or off and sets the volume.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow
from app.desk.persistence import Persistence
from app.desk.status.sounds import SoundPlayer
from app.desk.translation import tr
from app.special.special_functions import SpecialFunction
from core.access.access_table import ProtectedChange
from core.executor.commands import ForceOutput
from core.executor.signal_lamps import SignalSelector
from core.executor.snapshot import Snapshot
from core.machine.hardware_model import MACHINE_SIGNALS, MachineSignal
from core.machine.machine_model import Machine
from core.message import Message
from core.store.store_errors import StoreError

_SETTING = "sound"
_VOLUME_STEP = 20
_LAMP_NAMES = {"lamp_red": "RED", "lamp_amber": "AMBER", "lamp_green": "GREEN"}
EVENT_KINDS = tuple(MACHINE_SIGNALS)


@dataclass(slots=True)
class EventSoundPlayer:
    """Player of the sounds that announce new machine events.

    ``volume_percent`` is 0 by default. The event kinds in ``muted_kinds`` have no sound.
    """

    desk: Desk
    persistence: Persistence
    sound_player: SoundPlayer = field(default_factory=SoundPlayer)
    volume_percent: int = 0
    muted_event_kinds: frozenset[str] = frozenset()
    _signals: SignalSelector = field(default_factory=SignalSelector)
    _before: tuple[str, ...] | None = None
    _told: str = ""
    _read: bool = False

    def play_new_event_sounds(self, snapshot: Snapshot) -> None:
        """Play the sounds of events that have begun since the last frame.

        No sounds are played in the first frame.
        """
        self.load_settings()
        kinds = self._signals.update_signals(
            snapshot.state, snapshot.ends, is_next_part_blocked=bool(snapshot.next_barred)
        )
        before, self._before = self._before, kinds
        new = [] if before is None else [kind for kind in kinds if kind not in before and self._heard(kind)]
        if self.volume_percent and new:
            self.sound_player.play_tones(
                MACHINE_SIGNALS[min(new, key=EVENT_KINDS.index)].tones_hz, self.volume_percent
            )
        self._report()

    def _heard(self, kind: str) -> bool:
        return kind not in self.muted_event_kinds and bool(MACHINE_SIGNALS[kind].tones_hz)

    def _report(self) -> None:
        """Report errors of the sound output, each of them only once."""
        why = self.sound_player.error_text
        if why and why != self._told:
            self.desk.say(tr(Message("NO SOUND: {why}", why=why)))
        self._told = why or self._told

    def play_test_sound(self) -> None:
        """Play the test sound, and report an error even if it has been reported before."""
        self._told = self.sound_player.error_text = ""
        self.sound_player.play_tones(MACHINE_SIGNALS["part"].tones_hz, self.volume_percent)

    def load_settings(self) -> None:
        """Load the stored volume and muted event kinds, unless they are already loaded."""
        if self._read:
            return
        self._read = True
        try:
            kept = self.persistence.read_setting(_SETTING)
        except StoreError:
            return
        match kept:
            case {"volume": int(volume), "silent": list(silent)}:
                self.volume_percent, self.muted_event_kinds = (
                    max(0, min(100, volume)),
                    frozenset(map(str, silent)),
                )

    def save_settings(self, volume_percent: int, muted_kinds: frozenset[str]) -> None:
        """Store the volume and the muted event kinds, and use them immediately.

        The volume is limited to 0 to 100 %. The disk is written later, and a write error is not raised. If
        no store is open, nothing is stored. Raise StoreError if the store is closed or read-only.
        """
        before, self.volume_percent, self.muted_event_kinds = (
            self.volume_percent,
            max(0, min(100, volume_percent)),
            muted_kinds,
        )
        self.persistence.save_setting(
            _SETTING, {"volume": self.volume_percent, "silent": sorted(muted_kinds)}
        )
        change_text = Message(
            "sound volume: {before} → {volume} %, muted: {silent}",
            before=before,
            volume=self.volume_percent,
            silent=", ".join(sorted(muted_kinds)) or "nothing",
        )
        self.persistence.log_change(change_text)

    def close(self) -> None:
        """Stop all sounds."""
        self.sound_player.close()


class LampsAndSoundFunction(SpecialFunction):
    """Special function with one row per machine event, which shows the event's lamp and sound."""

    name = "LAMPS AND SOUND"
    use = "lamps, sounds, volume, lamp test"

    def __init__(self, desk: Desk, machine_name: Machine, sounds: EventSoundPlayer) -> None:
        super().__init__(desk)
        self.machine, self.event_sounds = machine_name, sounds

    @property
    def row_count(self) -> int:
        """Return the number of events."""
        return len(EVENT_KINDS)

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of lamps and sounds."""
        self.event_sounds.load_settings()
        rows = tuple(
            TableRow((tr(signal.description), self._lamp(signal), self._sound(kind, signal)))
            for kind, signal in MACHINE_SIGNALS.items()
        )
        volume = f"{self.event_sounds.volume_percent} %" if self.event_sounds.volume_percent else tr("OFF")
        lamps = ", ".join(self.machine.lamp_outputs) or tr(
            "no lamps are defined in the machine file; add lamp_red, lamp_amber, "
            "lamp_green, lamp_buzzer under [io.out]"
        )
        notes = (tr(Message("VOLUME: {volume}", volume=volume)), tr(Message("LAMPS: {names}", names=lamps)))
        heads = ("DESCRIPTION", "LAMP", "SOUND")
        return TableContent("LAMPS AND SOUND", heads, (0.5, 0.32, 0.18), rows, self.marked, notes=notes,
                     untranslated_columns=frozenset({0, 1, 2}))  # fmt: skip

    def _lamp(self, signal: MachineSignal) -> str:
        words = tr(_LAMP_NAMES[signal.lamp]) + (f" {tr('BLINKING')}" if signal.is_blinking else "")
        buzz = f" + {tr('BUZZER')} {signal.buzzer_time_s:g} s" if signal.buzzer_time_s else ""
        return words + buzz

    def _sound(self, kind: str, signal: MachineSignal) -> str:
        if not signal.tones_hz:
            return ""
        return tr("OFF") if kind in self.event_sounds.muted_event_kinds else tr("ON")

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys for volume, sound test and lamp test."""
        return {
            "F2": FunctionKey("SOFTER", lambda: self._louder(-_VOLUME_STEP)),
            "F3": FunctionKey("LOUDER", lambda: self._louder(_VOLUME_STEP)),
            "F4": FunctionKey("TRY", self.play_part_finished_sound),
            "F5": FunctionKey("LAMP TEST", self.test_lamps),
        }

    def activate_selected_row(self) -> bool:
        """Turn the sound of the selected event on or off."""
        kind = EVENT_KINDS[self.marked]
        if MACHINE_SIGNALS[kind].tones_hz:
            silent = self.event_sounds.muted_event_kinds ^ {kind}
            self._choose(self.event_sounds.volume_percent, silent)
        else:
            self.desk.say("NO SOUND FOR A RUNNING CYCLE: ONLY THE LAMP SHOWS IT")
        return True

    def _louder(self, by: int) -> None:
        self._choose(self.event_sounds.volume_percent + by, self.event_sounds.muted_event_kinds)

    def _choose(self, volume: int, silent: frozenset[str]) -> None:
        self.desk.clear_prompt_line()
        if not self.desk.is_refused(ProtectedChange.SCREEN):
            self.desk.try_save(lambda: self.event_sounds.save_settings(volume, silent))

    def play_part_finished_sound(self) -> None:
        """Play the sound of a finished part at the current volume."""
        if not self.event_sounds.volume_percent:
            self.desk.say("VOLUME IS ZERO. F3: LOUDER")
        else:
            self.desk.clear_prompt_line()
            self.event_sounds.play_test_sound()

    def test_lamps(self) -> None:
        """Turn all lamps on for 2 s. This is possible only while the machine is at rest."""
        if not self.machine.lamp_outputs:
            self.desk.say("THIS MACHINE HAS NO LAMPS. DEFINE THEM UNDER [io.out] IN THE MACHINE FILE")
        else:
            self.desk.clear_prompt_line()
            self.desk.post(ForceOutput(self.machine.lamp_outputs[0], True))

    def prompt_text(self) -> str:
        """Return the prompt for the keys that are available now."""
        return "ENTER: SOUND ON/OFF   F3: LOUDER   F4: TRY   ESC: BACK"
