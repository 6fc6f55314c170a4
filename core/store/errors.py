"""The one error of the store."""

from __future__ import annotations


class StoreError(Exception):
    """The store cannot do what it was asked; the sentence says what, where and what to do.

    ``passing``: what is in the way may go by itself, as a full disk or another program's lock does.
    """

    passing = False
