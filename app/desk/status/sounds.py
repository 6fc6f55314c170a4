"""Sounds for program ends, stops and alarms, played by an audio program of the computer.

Sounds are off until the operator sets a volume. A thread plays only the newest sound, so that no caller
waits.
"""

from __future__ import annotations

import io
import shutil
import subprocess
import sys
import tempfile
import threading
import wave
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from app.desk.background_work import describe_error
from core.message import Message

AUDIO_PLAYERS = (("pw-play",), ("paplay",), ("aplay", "-q"), ("afplay",))
"""Commands that play a file with PipeWire, PulseAudio, ALSA or macOS.

The first command that works is used.
"""
SAMPLE_RATE_HZ = 22_050  # Samples per second.
TONE, RAMP = 0.2, 0.01  # Seconds of one tone, and of its ramp at the beginning and end.
_PLAY_TIMEOUT_S = 10.0  # Seconds.
PlaySound = Callable[[bytes], None]
"""Function that plays a WAV file to its end. It raises OSError or ValueError with a complete sentence."""


def make_tone_wav(frequencies_hz: Sequence[int], volume: int) -> bytes:
    """Return a sequence of tones as a WAV file.

    Frequencies are in Hz. ``volume`` is from 0 to 100.
    """
    t = np.arange(round(SAMPLE_RATE_HZ * TONE)) / SAMPLE_RATE_HZ
    ramp = np.minimum(1.0, np.minimum(t, TONE - t) / RAMP).clip(0.0)
    waves = [np.sin(2.0 * np.pi * tone * t) * ramp for tone in frequencies_hz] or [np.zeros(0)]
    loud = (min(100, max(0, volume)) / 100.0) ** 2  # Loudness is perceived as the square root of power.
    samples = (np.concatenate(waves) * loud * 32_000).astype("<i2")
    made = io.BytesIO()
    with wave.open(made, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(SAMPLE_RATE_HZ)
        file.writeframes(samples.tobytes())
    return made.getvalue()


def play_wav(wav_bytes: bytes) -> None:
    """Play a WAV file on the computer's loudspeaker.

    Raises OSError or ValueError with the reason if no player works. On Windows, RuntimeError is raised
    instead.
    """
    if sys.platform == "win32":
        import winsound  # noqa: PLC0415 - other systems have none

        winsound.PlaySound(wav_bytes, winsound.SND_MEMORY)
        return
    players = [each for each in AUDIO_PLAYERS if shutil.which(each[0])]
    if not players:
        raise ValueError("this computer has none of pw-play, paplay and aplay (Debian: alsa-utils)")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "sound.wav"
        path.write_bytes(wav_bytes)
        player_errors = [_run_player([*player, str(path)]) for player in players[:1]]
        for player in players[1:]:
            if player_errors[-1]:
                player_errors.append(_run_player([*player, str(path)]))
    if all(player_errors):
        raise ValueError(player_errors[0])


def _run_player(command: list[str]) -> str:
    """Run an audio player, and return the reason if it fails or an empty string if it succeeds."""
    try:
        done = subprocess.run(command, capture_output=True, timeout=_PLAY_TIMEOUT_S, check=False)
    except subprocess.TimeoutExpired:
        return Message("{command} did not finish in time", command=command[0])
    said = done.stderr.decode(errors="replace").strip().splitlines()
    return (
        ""
        if done.returncode == 0
        else (said[-1] if said else Message("{command} failed", command=command[0]))
    )


class SoundPlayer:
    """Player of sounds in a separate thread, so that callers do not wait.

    ``error_text`` is the reason why the last sound failed, or an empty string.
    """

    def __init__(self, play_sound: PlaySound = play_wav) -> None:
        self._play = play_sound
        self._next: bytes | None = None
        self._there = threading.Condition()
        self._closing = False
        self._thread: threading.Thread | None = None
        self.error_text = ""

    def play_tones(self, frequencies_hz: Sequence[int], volume: int) -> None:
        """Play these tones now, and drop a sound that is still waiting."""
        if volume <= 0 or not frequencies_hz:
            return
        with self._there:
            self._next = make_tone_wav(frequencies_hz, volume)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="sounds", daemon=True)
                self._thread.start()
            self._there.notify()

    def close(self) -> None:
        """Stop playing new sounds. The method does not wait for the end of the current sound."""
        with self._there:
            self._closing = True
            self._there.notify()

    def _work(self) -> None:
        while True:
            with self._there:
                self._there.wait_for(lambda: self._next is not None or self._closing)
                sound, self._next = self._next, None
            if self._closing or sound is None:
                return
            try:
                self._play(sound)
                self.error_text = ""
            except (OSError, ValueError, RuntimeError) as error:
                self.error_text = describe_error(error)
