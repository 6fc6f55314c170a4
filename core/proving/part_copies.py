"""Copies of a part in the making, from which its history goes on."""

from __future__ import annotations

from core.part.field_copies import FieldCopy, copied, restored
from core.proving.milling import Milling
from core.proving.part_making import PartMaking

_EVERY = 16  # blocks from one copy to the next, at first
_MOST_COPIES = 96
_MOST_BYTES = 96e6  # of all copies


class PartCopies:
    """By how many steps were done; of too many every other goes.

    Of a milled part they share the columns that were not touched between two of them.
    """

    def __init__(self) -> None:
        self._copies: dict[int, tuple[PartMaking, FieldCopy | None, float]] = {}
        self._every = _EVERY

    def before(self, done: int) -> int:
        """The last copy that is not behind so many steps."""
        return max(each for each in self._copies if each <= done)

    def copy(self, done: int) -> PartMaking:
        """One to go on from."""
        kept, field, even_with = self._copies[done]
        making = kept.copy()
        if field is not None and making.part is not None:
            making.milling = Milling.of(making.part, restored(field), even_with)
        return making

    def perhaps(self, done: int, making: PartMaking) -> None:
        """Keep one when it is time."""
        if done % self._every == 0 and done not in self._copies:
            self.keep(done, making)

    def keep(self, done: int, making: PartMaking) -> None:
        """Keep a copy of what there is after so many steps."""
        milling = making.milling
        field, even_with = None, 0.0
        if milling is not None:
            near = self._copies.get(max((each for each in self._copies if each < done), default=-1))
            field = copied(milling.field, near[1] if near is not None else None)
            even_with = milling.even_with
        making.milling = None
        self._copies[done] = making.copy(), field, even_with
        making.milling = milling
        while len(self._copies) > _MOST_COPIES or (self._size > _MOST_BYTES and len(self._copies) > 2):
            self._every *= 2
            for each in [each for each in self._copies if each % self._every]:
                del self._copies[each]

    @property
    def _size(self) -> int:
        """Bytes of all of them; what is shared counts once."""
        columns = {
            id(column): column.nbytes
            for _, field, _ in self._copies.values()
            if field is not None
            for column in field.columns.values()
        }
        return sum(columns.values()) + sum(making.nbytes for making, _, _ in self._copies.values())
