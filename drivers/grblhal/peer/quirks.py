"""What the look-alike does like the real one, or is made to do; each can be switched."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(slots=True)
class Quirks:
    """As the firmware's simulator, but with an encoder, auxiliary ports and the figures of a machine file."""

    encoder: bool = True
    diameter: bool = False  # comes up in G7, as $N0=G7 would make it
    index_missing: bool = False
    outputs: int = 16
    inputs: int = 8
    lathe: bool = True
    built_for_lathes: bool = False  # always in lathe mode: there is no $32
    homing: int | bool = 0  # its $22; True: 3, axis by axis, and it does not insist
    mute: bool = True  # takes nothing from the wire while a thread waits for its index, as the simulator
    deaf: bool = False  # answers nothing
    garble: list[bytes] = field(default_factory=list)  # instead of the next ``ok``s
    hold_broken: bool = False  # 0x82 does nothing
    stubborn: bool = False  # takes no override
    toggle_broken: bool = False  # 0x9E does nothing
    settings: dict[int, float] = field(default_factory=dict)  # other than the machine file's
