"""Sounds of the desk: what is played for what, once; and what is said where nothing can be heard."""

from __future__ import annotations

import io
import shutil
import threading
import wave
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.status import sounds
from app.desk.status.sounds import SoundPlayer, make_tone_wav, play_wav
from app.special.lamps_and_sound import EventSoundPlayer
from core.executor.snapshot import MachineState, Snapshot
from core.machine.hardware_model import MACHINE_SIGNALS
from tests.texts import text as wording

REST = Snapshot(state=MachineState.IDLE)


class Heard:
    """A loudspeaker that says when it has played."""

    def __init__(self, trouble: str = "") -> None:
        self.trouble, self.count, self.there = trouble, 0, threading.Semaphore(0)

    def __call__(self, _sound: bytes) -> None:
        self.count += 1
        self.there.release()
        if self.trouble:
            raise OSError(self.trouble)


class Noted(SoundPlayer):
    """Keeps what is to be played."""

    def __init__(self) -> None:
        super().__init__()
        self.asked: list[tuple[int, ...]] = []

    def play_tones(self, frequencies_hz: object, volume: int) -> None:  # noqa: ARG002
        self.asked.append(cast("tuple[int, ...]", frequencies_hz))


def desk_sounds(volume: int = 50, silent: frozenset[str] = frozenset()) -> tuple[EventSoundPlayer, list[str]]:
    said: list[str] = []
    keep = Persistence({"sound": {"volume": volume, "silent": sorted(silent)}})
    return EventSoundPlayer(cast("Desk", SimpleNamespace(say=said.append)), keep, Noted()), said


def day(made: EventSoundPlayer, *snapshots: Snapshot) -> list[tuple[int, ...]]:
    for snapshot in snapshots:
        made.play_new_event_sounds(snapshot)
    return cast("Noted", made.sound_player).asked


RUNS = replace(REST, state=MachineState.RUN)


def test_cycle_end_stop_and_alarm_sound_once() -> None:
    made, _ = desk_sounds()
    held, fault = replace(REST, state=MachineState.HOLD), replace(REST, state=MachineState.FAULT)
    done = replace(REST, ends=1)
    assert day(made, REST, RUNS, RUNS, held, held, RUNS, done, done, fault, fault) == [
        MACHINE_SIGNALS["stop"].tones_hz,
        MACHINE_SIGNALS["part"].tones_hz,
        MACHINE_SIGNALS["alarm"].tones_hz,
    ]


def test_part_followed_by_another_makes_no_sound() -> None:
    made, _ = desk_sounds()
    assert day(made, RUNS, replace(RUNS, ends=1), replace(RUNS, ends=2)) == []


def test_end_of_tool_life_sounds_during_the_cycle() -> None:
    made, _ = desk_sounds()
    assert day(made, RUNS, replace(RUNS, next_barred="T1"), replace(RUNS, next_barred="T1")) == [
        MACHINE_SIGNALS["tool-life"].tones_hz
    ]


def test_disabled_or_zero_volume_sound_is_not_played() -> None:
    assert day(desk_sounds(silent=frozenset({"stop"}))[0], RUNS, replace(REST, state=MachineState.HOLD)) == []
    assert day(desk_sounds(volume=0)[0], RUNS, replace(REST, state=MachineState.FAULT)) == []
    fresh = EventSoundPlayer(cast("Desk", SimpleNamespace()), Persistence(), Noted())
    assert day(fresh, RUNS, replace(REST, state=MachineState.FAULT)) == []  # off by default


def test_alarm_present_at_startup_makes_no_sound() -> None:
    assert day(desk_sounds()[0], replace(REST, state=MachineState.FAULT)) == []


@pytest.mark.parametrize("kept", [7, {"volume": "loud"}, {"volume": 5}, [], {"volume": 10**9, "silent": [3]}])
def test_invalid_sound_setting_is_ignored(kept: object) -> None:
    made = EventSoundPlayer(cast("Desk", SimpleNamespace()), Persistence({"sound": kept}), Noted())
    made.load_settings()
    assert 0 <= made.volume_percent <= 100


def test_failure_to_play_is_reported_once() -> None:
    made, said = desk_sounds()
    made.sound_player.error_text = "no such device"
    day(made, RUNS, REST, RUNS)
    assert said == [wording("desk.no-sound", why="no such device")]


def test_sound_is_played_in_a_thread_and_its_error_is_stored() -> None:
    heard = Heard("no loudspeaker")
    played = SoundPlayer(heard)
    played.play_tones((440,), 0)
    played.play_tones((), 50)
    played.play_tones((440,), 50)
    assert heard.there.acquire(timeout=60)
    played.close()
    assert played._thread is not None
    played._thread.join(60)
    assert (heard.count, played.error_text) == (1, "no loudspeaker")


def test_tone_has_its_pitch_and_volume() -> None:
    with wave.open(io.BytesIO(make_tone_wav((441,), 50))) as file:
        assert (file.getframerate(), file.getnchannels(), file.getnframes()) == (22_050, 1, 4410)
        samples = np.frombuffer(file.readframes(4410), "<i2").astype(float)
    assert np.abs(samples).max() == pytest.approx(
        0.25 * 32_000, rel=0.01
    )  # half as loud: a quarter of the swing
    crossings = np.count_nonzero(np.diff(np.signbit(samples)))
    assert crossings == pytest.approx(2 * 441 * 0.2, abs=2)


def test_missing_sound_player_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    with pytest.raises(ValueError, match="none of pw-play, paplay and aplay"):
        play_wav(b"")


def test_next_sound_player_is_tried_if_one_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, text in (("paplay", "echo connection refused >&2; exit 1"), ("aplay", f"cp $2 {tmp_path}/out")):
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    monkeypatch.setattr(sounds, "AUDIO_PLAYERS", (("paplay",), ("aplay", "-q")))
    play_wav(b"RIFF")
    assert (tmp_path / "out").read_bytes() == b"RIFF"
    (tmp_path / "aplay").write_text("#!/bin/sh\nexit 3\n")
    with pytest.raises(ValueError, match="connection refused"):
        play_wav(b"RIFF")
