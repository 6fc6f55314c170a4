"""A desk at which people sign in with their PINs."""

from __future__ import annotations

from app.extras.access.sign_in import PinSignIn, get_pin_sign_in
from core.extras.access import pins
from core.extras.access.pins import hash_pin
from core.store.user_records import UserRow
from tests.desk.levels_room import LEVELS, LIMIT, Room

TODAY = pins.DEFAULT_COST  # before a test makes it cheap
PINS = {"ANNA": "4711", "BEN": "2580", "CARLA": "9035"}


class PinRoom(Room):
    """Signs in as an operator does."""

    @property
    def session(self) -> PinSignIn:
        """How people sign in here."""
        return get_pin_sign_in(self.access)

    def settle(self) -> None:
        """Until what was asked of workers and of the disk is there."""
        self.session.worker.wait_for_results(LIMIT)
        super().settle()

    def enter_people(self) -> None:
        """With their PINs."""
        for name, pin in PINS.items():
            self.journal.require_store().people.save_user(
                UserRow(name, LEVELS[name], *hash_pin(pin))
            ).result()
        self.access.reload()

    def sign_in(self, name: str, pin: str = "") -> None:
        """Enter a PIN."""
        row = self.access.user_list.find_user(name)
        assert row is not None
        self.session.sign_in(row, pin or PINS[name])
        self.settle()
