"""What the pages share of the screen. Whoever imports a part of it has Qt."""

import builtins
from importlib import import_module

# PySide puts an import of its own in place: it reads the source text of every module imported after it,
# in search of a __feature__ that nobody here asks for: 700 texts, a sixth of the desk's start and 18 MiB.
# What was in place before, which it keeps, is put back.
import_module("PySide6.QtCore")
builtins.__import__ = getattr(builtins, "__orig_import__", builtins.__import__)
