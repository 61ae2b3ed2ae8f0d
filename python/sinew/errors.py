"""The exceptions of Sinew. Every function raises one of these when it cannot do its task."""

from __future__ import annotations


class Error(Exception):
    """The base of all.

    Attributes:
        message: what is wrong.
        remedy: what to do about it; may be empty.
        file: the file of the fault, or "Scene" for one that was built in Python; empty: none.
        line, column: the place in it, from 1; 0: unknown.
    """

    def __init__(self, message: str, remedy: str = "", file: str = "", line: int = 0,
                 column: int = 0) -> None:
        place = ""
        if file and file != "Scene":  # the lines of a scene built in Python mean nothing
            place = ":".join([file, *(str(n) for n in (line, column) if n > 0)]) + ": "
        super().__init__(place + message + (f"\n  remedy: {remedy}" if remedy else ""))
        self.message = message
        self.remedy = remedy
        self.file = file
        self.line = line
        self.column = column


class InternalError(Error):
    """A fault of Sinew itself."""


class UsageError(Error, ValueError):
    """A wrong call: a value that is not finite, an unknown name, a removed object."""


class InputError(Error, ValueError):
    """A scene, a mesh or a value in them that cannot be used."""


class UnstableError(Error):
    """A step longer than the stable one; nothing was run."""


class DivergedError(Error):
    """The state became infinite, or there is no rest state. A simulation has returned to an
    earlier frame."""


class IoError(Error, OSError):
    """The system refused to read or write a file."""


_KINDS = {1: InternalError, 2: UsageError, 3: InputError, 4: UnstableError, 5: DivergedError,
          6: IoError}


def of_kind(kind: int) -> type[Error]:
    """The class of an error of the compiled part."""
    return _KINDS.get(kind, InternalError)
