"""Why programs cannot be shared just now: one cause a sentence, with what to do."""

from __future__ import annotations

import errno
from enum import Enum

from core.coded_error import CodedError

_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
_NO_RIGHT = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})
_NOT_THERE = frozenset({errno.ENOENT, errno.ENOTDIR})


class Cause(Enum):
    """What is in the way, and what to do about it."""

    AWAY = "{place} does not answer ({why}); this desk works on and shares when it does again"
    NO_RIGHT = "{place} may not be used so by this user ({why}); ask whoever looks after it for the right"
    NOT_THERE = "{place} is not there ({why}); is it mounted, is its name right?"
    NOT_BEGUN = (
        "{place} holds no shared programs; is it mounted, is its name right? Where it is new: "
        "turndesk share begin"
    )
    NEWER = "{place} was laid out by a newer TurnDesk (format {why}); update the one on this desk"
    OTHER = "{place} is not laid out as shared programs are ({why}); name another place"
    FULL = "the disk of {place} is full; make room there"
    REFUSED = "{place} refuses it: {why}"
    DAMAGED = "{place}: {why}"
    UNKNOWN_HOST = (
        "the computer of {place} is not known here ({why}); log in there once by ssh, as the user of this "
        "desk, and compare its key"
    )
    OTHER_HOST = (
        "the computer of {place} shows another key than before ({why}); ask whoever looks after it, and "
        "let ssh-keygen -R forget the old one only then"
    )
    NO_GIT = "the command git is not on this computer; install git"
    NO_SSH = "{place} is reached by ssh, which is not on this computer; install openssh-client"
    NO_GIT_THERE = (
        "the computer of {place} answers, but not as git does ({why}); is git installed there, and may this "
        "user start it by ssh?"
    )
    UNREADABLE = (
        "[sharing] postgresql cannot be read as a connection string; write a value with blanks in quotation "
        "marks, and / and @ of a password in an address as %2F and %40"
    )
    WRONG_PASSWORD = "{place} refuses the user or the password ({why}); correct them in [sharing] postgresql"
    NOT_TRUSTED = (
        "the certificate of {place} cannot be verified ({why}); name the certificate of whoever issued it "
        "as sslrootcert=FILE in [sharing] postgresql"
    )
    GIT_NOT_TRUSTED = (
        "the certificate of {place} cannot be verified ({why}); name the certificate of whoever issued it: "
        "git config --global http.sslCAInfo FILE"
    )
    NO_TLS = (
        "{place} offers no TLS ({why}); turn it on there, or, where everybody in the network is trusted, "
        "write sslmode=disable in [sharing] postgresql"
    )
    TLS_ONLY = "{place} accepts TLS only ({why}); remove sslmode from [sharing] postgresql"
    NO_PSYCOPG = "[sharing] postgresql wants psycopg, which is not installed; install turndesk[postgresql]"
    NAME_TAKEN = (
        "{place}: another desk is called {why} too; give this one its own name (desk in [sharing]), "
        "or, where that computer is gone: turndesk share publish --claim"
    )

    @property
    def code(self) -> str:
        """Return the code of the error: the name in kebab case, such as ``no-right``."""
        return "disk-full" if self is Cause.FULL else self.name.lower().replace("_", "-")

    def error(self, place: str, why: object = "") -> SharingError:
        """The sentence for it, on one line."""
        made = SharingError(self.value.format(place=place, why=" ".join(str(why).split())), self.code)
        made.cause = self
        return made


class SharingError(CodedError):
    """Sharing cannot do what it was asked; nothing that was there has changed."""

    cause: Cause
    told = ""  # all that a command said, where one was asked


def of_system(place: str, error: OSError) -> SharingError:
    """The sentence for what the system says."""
    why = error.strerror or str(error)
    if error.errno in _FULL:
        return Cause.FULL.error(place)
    if error.errno in _NO_RIGHT:
        return Cause.NO_RIGHT.error(place, why)
    if error.errno in _NOT_THERE:
        return Cause.NOT_THERE.error(place, why)
    if error.errno == errno.EINVAL:  # a file that is none of ours: core/regular_file.py
        return Cause.DAMAGED.error(place, why)
    return Cause.AWAY.error(place, why)
