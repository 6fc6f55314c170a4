"""Screen settings that the operator chooses, such as language, theme, units and readout."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from enum import StrEnum

from app.desk.persistence import Persistence
from core.message import Message
from core.store.store_errors import StoreError

SETTINGS_KEY = "screen"
SYSTEM_THEME = "system"  # Dark or light, whichever the operating system uses.


class DisplayUnits(StrEnum):
    """Unit of displayed values. The operator always enters values in the unit of the control."""

    PROGRAM = "AS THE PROGRAM"
    INCH = "INCH"
    METRIC = "MM"

    def metric(self, is_control_metric: bool) -> bool:
        """Return whether values are displayed in metric units.

        ``is_control_metric`` is True if the control currently uses metric units.
        """
        return is_control_metric if self is DisplayUnits.PROGRAM else self is DisplayUnits.METRIC


@dataclass(frozen=True, slots=True)
class ScreenSettings:
    """All screen settings, with default values for a new machine."""

    theme: str = SYSTEM_THEME
    language: str = "en"
    units: str = DisplayUnits.PROGRAM.value
    readout: str = "POSITION"
    dock: bool = True
    full_screen: bool = False
    first_job: bool = False  # The card of the first job is shown.
    latched: bool = False  # The palm buttons may be pressed one after the other on a simulated machine.


SETTING_CHOICES: Mapping[str, tuple[object, ...]] = {
    "theme": (SYSTEM_THEME, "light", "dark", "contrast"),
    "language": ("en", "es"),
    "units": tuple(unit.value for unit in DisplayUnits),
    "readout": ("POSITION", "DISTANCE TO GO", "FROM HOME"),
    "dock": (True, False),
    "full_screen": (True, False),
    "latched": (True, False),
    "first_job": (True, False),
}


_UNLOGGED_SETTINGS = frozenset({"readout"})  # Settings that change many times per shift and are not logged.


@dataclass(slots=True)
class SettingsStore:
    """The current screen settings, read from the store. Invalid stored values are ignored."""

    persistence: Persistence = field(default_factory=Persistence)
    current_settings: ScreenSettings = field(init=False)

    def __post_init__(self) -> None:
        self.reload()

    def reload(self) -> None:
        """Read the stored settings. If the store cannot be read, the defaults apply."""
        try:
            kept = self.persistence.read_setting(SETTINGS_KEY)
        except StoreError:
            kept = None
        found = kept if isinstance(kept, dict) else {}
        names = {field.name for field in fields(ScreenSettings)}
        self.current_settings = ScreenSettings(
            **{n: v for n, v in found.items() if n in names and _is_choice(n, v)}
        )

    def choose(self, name: str, value: object) -> None:
        """Apply a setting and save it, without waiting for the disk.

        Raises ValueError if the value is invalid, or StoreError if the setting cannot be queued for saving.
        A later write error is not raised.
        """
        if not _is_choice(name, value):
            raise ValueError(f"{name} cannot be {value!r}")
        before = getattr(self.current_settings, name)
        self.current_settings = replace(self.current_settings, **{name: value})  # type: ignore[arg-type]
        self.persistence.save_setting(SETTINGS_KEY, asdict(self.current_settings))
        if name not in _UNLOGGED_SETTINGS:
            self.persistence.log_change(
                Message("screen: {name} {before} → {value}", name=name, before=before, value=value)
            )

    def find_next_choice(self, name: str) -> object:
        """Return the choice of a setting that follows its current choice, wrapping to the first choice."""
        choices = SETTING_CHOICES[name]
        return choices[(choices.index(getattr(self.current_settings, name)) + 1) % len(choices)]

    @property
    def display_units(self) -> DisplayUnits:
        """Return the unit of displayed values."""
        return DisplayUnits(self.current_settings.units)


def _is_choice(name: str, value: object) -> bool:
    return any(value == choice and type(value) is type(choice) for choice in SETTING_CHOICES.get(name, ()))
