"""What a function key is called on this machine: a mill has presets, a SINUMERIK lathe G54 to G59."""

from __future__ import annotations

from collections.abc import Mapping

_LABELS: Mapping[str, Mapping[str, str]] = {
    "klartext": {"SECCMP": "PRESETS", "ZERO": "PRESETS"},
    "sinumerik": {"SECCMP": "ZERO"},
}


def label_on(language: str, label: str) -> str:
    """The label of a key on a machine of this language."""
    return _LABELS.get(language, {}).get(label, label)
