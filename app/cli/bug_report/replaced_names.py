"""Replacement of names, paths and addresses in a text that will be published.

Known names (users, programs, this computer) are replaced wherever they occur. Paths, addresses and file
names are recognized by their form. The same value always gets the same replacement, such as ``PERSON-1``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable
from pathlib import PurePath

_SUFFIXES = (
    "nc txt tap cnc prg h mpf spf dxf svg toml hal csv json jsonl html pdf scope ring db zip gz run turndesk"
)
_URL = re.compile(r"\b[A-Za-z][A-Za-z0-9+.-]*://[^\s\"'<>)\]]+")
_MAIL = re.compile(r"[\w.+-]+@[\w-]+(?:\.[\w-]+)*")
_SECRET = re.compile(r"(?i)\b(password|passwd|pwd|token|secret|user|username|host|hostaddr)(\s*[=:]\s*)(\S+)")
_QUOTED_PATH = re.compile(r"(?P<mark>[\"'])(?P<path>(?:/|~/|[A-Za-z]:[\\/]|\\\\)[^\"'\n]*)(?P=mark)")
_PATH = re.compile(r"(?<![\w./:…-])(?:~?/|[A-Za-z]:[\\/]|\\\\)[^\s\"'<>|,;)\]]*[^\s\"'<>|,;:)\]]")
_OWN = re.compile(
    r"(?:^|.*[\\/])(?P<tail>(?:app|core|drivers|resources|site-packages|dist-packages|python3\.\d+)[\\/].*\.pyc?)$"
)
_SYSTEM = re.compile(r"^/(?:dev/(?:tty\w+|serial\d?|null)|proc/\w+|etc/os-release|usr/bin/python[\d.]*)$")
_MAC = re.compile(r"\b[0-9A-Fa-f]{2}(?:[:-][0-9A-Fa-f]{2}){5}\b")
_IP4 = re.compile(r"(?<![\w.])(?:\d{1,3}\.){3}\d{1,3}(?::\d+)?(?![\w.]*\d)")
_IP6 = re.compile(
    r"(?<![\w:])(?:[0-9A-Fa-f]{1,4}:){3,7}[0-9A-Fa-f]{0,4}(?![\w:])|(?<![\w:])[0-9A-Fa-f]{1,4}(?:::?[0-9A-Fa-f]{1,4})*::(?:[0-9A-Fa-f:]+)?(?![\w:])"
)
_HOST = re.compile(
    r"\b(?:[A-Za-z0-9-]+\.)+(?:local|lan|home|internal|intra|corp|com|net|org|de|eu|es|io|uk)\b(?::\d+)?"
)
_FILE = re.compile(rf"(?<![\w./\\-])[\w.()+-]*\w\.(?:{_SUFFIXES.replace(' ', '|')})\b", re.IGNORECASE)
_SHORTEST = 2  # characters of a name that is replaced wherever it occurs


class PrivateValueReplacer:
    """Replacements for the private values in one report.

    ``people`` are names of users, ``programs`` are names of program files, and ``computers`` are names of
    computers. ``public`` are file names that TurnDesk itself ships.
    """

    def __init__(
        self,
        *,
        people: Iterable[str] = (),
        programs: Iterable[str] = (),
        computers: Iterable[str] = (),
        public: Collection[str] = (),
    ) -> None:
        self._given: dict[str, str] = {}
        self._counts: dict[str, int] = {}
        self._public = {name.casefold() for name in public}
        self._known: dict[str, tuple[str, str]] = {}
        for kind, names in (("PERSON", people), ("COMPUTER", computers)):
            for name in names:
                self._know(kind, name, "")
        for name in programs:
            if name.casefold() not in self._public:
                suffix = PurePath(name).suffix
                self._know("PROGRAM", name, suffix)
                self._know("PROGRAM", name.removesuffix(suffix), "")

    def _know(self, kind: str, name: str, suffix: str) -> None:
        name = name.strip()
        if len(name) >= _SHORTEST and any(each.isalpha() for each in name):
            stem = name.removesuffix(suffix) if suffix else name
            self._known.setdefault(name.casefold(), (self.get_placeholder(kind, stem), suffix))

    def get_placeholder(self, kind: str, value: str) -> str:
        """Return the placeholder that replaces a private value in the report.

        Values that differ only in case have the same placeholder.
        """
        key = f"{kind}:{value.casefold()}"
        if key not in self._given:
            self._counts[kind] = self._counts.get(kind, 0) + 1
            self._given[key] = f"{kind}-{self._counts[kind]}"
        return self._given[key]

    def __call__(self, text: str) -> str:
        """Return the text with all private values replaced."""
        for pattern, kind in ((_URL, "URL"), (_MAIL, "MAIL")):
            text = pattern.sub(self._as(kind), text)
        text = _SECRET.sub(lambda found: f"{found[1]}{found[2]}SECRET", text)
        text = _QUOTED_PATH.sub(lambda found: found["mark"] + self._path(found["path"]) + found["mark"], text)
        text = _PATH.sub(lambda found: self._path(found[0]), text)
        text = self._without_known(text)
        for pattern, kind in ((_MAC, "ADDRESS"), (_IP4, "ADDRESS"), (_IP6, "ADDRESS"), (_HOST, "HOST")):
            text = pattern.sub(self._as(kind), text)
        return _FILE.sub(lambda found: self._file(found[0]), text)

    def _as(self, kind: str) -> Callable[[re.Match[str]], str]:
        return lambda found: self.get_placeholder(kind, found[0])

    def _without_known(self, text: str) -> str:
        names = sorted(self._known, key=len, reverse=True)
        if not names:
            return text
        pattern = re.compile(rf"(?<!\w)(?:{'|'.join(map(re.escape, names))})(?!\w)", re.IGNORECASE)
        return pattern.sub(lambda found: "".join(self._known[found[0].casefold()]), text)

    def _path(self, path: str) -> str:
        """Return the text that replaces a path in the report.

        A path in TurnDesk or Python is shortened to the part that starts with its package.
        """
        if own := _OWN.match(path):
            return f"…/{own['tail']}"
        if _SYSTEM.match(path):
            return path
        name = re.split(r"[\\/]", path)[-1]
        if name.casefold() in self._public:
            return f"…/{name}"
        suffix = PurePath(name).suffix if _FILE.fullmatch(name) else ""
        return self.get_placeholder("PATH", path) + suffix

    def _file(self, name: str) -> str:
        if name.casefold() in self._public or re.match(r"[A-Z]+-\d+\.", name):
            return name
        suffix = PurePath(name).suffix
        return self.get_placeholder("FILE", name.removesuffix(suffix)) + suffix
