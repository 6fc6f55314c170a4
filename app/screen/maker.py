"""Which pages there are: each by its name, made when it is first opened."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtWidgets import QWidget

from app.desk.pages import MENU
from app.screen.menu import MenuPage
from app.screen.pages import Host, Page

MakePage = Callable[[Host, QWidget], Page]

MAKERS: Mapping[str, MakePage] = {
    MENU: MenuPage,
}
