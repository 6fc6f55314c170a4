"""A desk at which people sign in with their PINs."""

from __future__ import annotations

from app.extras.access.sign_in import SignIn, sign_in_of
from core.extras.access import pins
from core.extras.access.pins import hashed
from core.store.people import PersonRow
from tests.desk.levels_room import LEVELS, LIMIT, Room

TODAY = pins.COST  # before a test makes it cheap
PINS = {"ANNA": "4711", "BEN": "2580", "CARLA": "9035"}


class PinRoom(Room):
    """Signs in as an operator does."""

    @property
    def session(self) -> SignIn:
        """How people sign in here."""
        return sign_in_of(self.access)

    def settle(self) -> None:
        """Until what was asked of workers and of the disk is there."""
        self.session.worker.settle(LIMIT)
        super().settle()

    def enter_people(self) -> None:
        """With their PINs."""
        for name, pin in PINS.items():
            self.journal.opened().people.save_person(PersonRow(name, LEVELS[name], *hashed(pin))).result()
        self.access.reload()

    def sign_in(self, name: str, pin: str = "") -> None:
        """Enter a PIN."""
        row = self.access.people.named(name)
        assert row is not None
        self.session.sign_in(row, pin or PINS[name])
        self.settle()
