"""Files that appear complete or not at all."""

from __future__ import annotations

import os
import shutil
import uuid
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from lcpstep.errors import NotWritten

LONGEST = 64  # characters of a file's name in that of its draft
DRAFTS: set[Path] = set()  # under way


def file_path(path: object) -> Path:
    """A path that a user gives; TypeError for what is none."""
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"path: expected the name of a file, got {path!r}")
    return Path(path)


@contextmanager
def replacing(file: Path | str) -> Generator[Path, None, None]:
    """A path beside `file` to write to, with the same ending; it takes the place of `file` at the end.

    Folders that are missing are made.

    Until then, and for good where anything fails, `file` is what it was: missing, or the old one. A link stays a link
    to the new file, which has the permissions of the old. What is no regular file is written to as it is.

    Raises
    ------
    NotWritten   an OSError while writing: no space, no permission, no folder
    """
    file = Path(file)
    target = Path(os.path.realpath(file))
    special = target.exists() and not target.is_file()
    draft = target.with_name(f".{target.stem[:LONGEST]}.{uuid.uuid4().hex[:8]}.partial{target.suffix}")
    DRAFTS.add(draft)
    try:
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            yield target if special else draft
            if not special:
                _settle(draft, target)
        finally:
            draft.unlink(missing_ok=True)
            DRAFTS.discard(draft)
    except OSError as error:
        raise NotWritten(file, error) from error


@contextmanager
def naming(file: Path | str) -> Generator[None, None, None]:
    """An OSError of a file that grows as results come in is a NotWritten that names it; what it has is kept."""
    try:
        yield
    except NotWritten:
        raise
    except OSError as error:
        raise NotWritten(file, error) from error


def _settle(draft: Path, target: Path) -> None:
    """Put the draft in the place of the target, once it is on the disk and not only on its way there."""
    with draft.open("rb+") as written:
        os.fsync(written.fileno())
    if target.exists():
        shutil.copymode(target, draft)
    os.replace(draft, target)
