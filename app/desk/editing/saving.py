"""Saving: the file first, then the version; what stood there before is in the history too."""

from __future__ import annotations

from app.desk.editing.bench import Archive
from app.desk.editing.document import Document
from app.desk.editing.files import present, write_whole
from core.store.errors import StoreError

CHANGED = "changed by another program"


def save(document: Document, text: str, archive: Archive, replacing: bool) -> str:
    """Write ``text`` into the file of ``document`` and keep it as a version.

    Answers why no version could be kept, empty when all went well, or ``CHANGED`` when the file is not any
    more what was opened (nothing is written then, unless ``replacing``). Raises SavingError.
    """
    there = present(document.path)
    foreign = there is not None and not _is_opened(document, there)
    if foreign and not replacing:
        return CHANGED
    trouble = ""
    if there is not None:
        trouble = _kept(archive, document.name, there, "as it was before editing")
        if trouble and foreign:
            return CHANGED  # what somebody else wrote is not replaced before it is safe
    data = document.encoded(text)
    write_whole(document.path, data)
    return _kept(archive, document.name, data, "saved in the editor") or trouble


def _is_opened(document: Document, data: bytes) -> bool:
    """Whether the file still holds what was opened or last saved."""
    if document.fresh:
        return False
    return data == document.encoded(document.text) or _decodes_to(document, data)


def _decodes_to(document: Document, data: bytes) -> bool:
    """Files from DOS: other characters, a byte order mark, the old sign for the end of a file."""
    for code in ("utf-8-sig", "cp437", "latin-1"):
        try:
            text = data.decode(code)
        except UnicodeDecodeError:
            continue
        if text.rstrip("\x1a").replace("\r\n", "\n").replace("\r", "\n") == document.text:
            return True
    return False


def _kept(archive: Archive, name: str, data: bytes, why: str) -> str:
    try:
        archive.keep_version(name, data, why)
    except StoreError as error:
        return str(error)
    return ""
