"""What the commands of the shell that are written in Python share."""

from __future__ import annotations

import os
import pathlib
import sys
import tomllib
from collections.abc import Callable, Mapping
from typing import Any

from .errors import _KINDS, Error, InputError, UsageError
from .study.designs import Range, Values


# What a key's value may be.
KINDS = {str: "a text", int: "a whole number", float: "a number", bool: "true or false",
         list: "a list", dict: "a table"}


def is_kind(value: Any, kind: type) -> bool:
    if kind in (int, float) and isinstance(value, bool):
        return False
    return isinstance(value, (int, float) if kind is float else kind)


def read_toml(file: str, keys: Mapping[str, type], page: str) -> dict[str, Any]:
    """The table of a file that may have these keys, with values of these kinds."""
    try:
        table = tomllib.loads(pathlib.Path(file).read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(str(error), f"see {page}", file) from None
    for key in table:
        if key not in keys:
            raise InputError(f"unknown key '{key}'", f"one of {', '.join(sorted(keys))}", file)
        if not is_kind(table[key], keys[key]):
            raise InputError(f"'{key}' is {table[key]!r}", f"expected {KINDS[keys[key]]}; see {page}",
                             file)
    return table


def values_of(key: str, value: Any, file: str) -> Values:
    """A range or a list of a file."""
    if isinstance(value, list) and value:
        return value
    if isinstance(value, dict):
        unknown = set(value) - {"low", "high", "log", "grid", "values"}
        if not unknown and "values" in value:
            return values_of(key, value["values"], file)
        kinds = {"low": float, "high": float, "log": bool, "grid": int}
        if not unknown and {"low", "high"} <= set(value) and all(
                is_kind(v, kinds[k]) for k, v in value.items()):
            return Range(**value)
    raise InputError(f"'{key}' is no range and no list",
                     "{ low = 1e3, high = 1e4, log = true }, or [0.3, 0.4]", file)


def new_folder(given: str | None, file: str) -> pathlib.Path:
    """The folder to write: that of --out, or out/NAME, numbered if taken. It does not exist, or is
    empty."""
    if given:
        folder = pathlib.Path(given)
        if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
            raise UsageError(f"{folder} exists", "name another folder, or remove it")
        return folder
    first = pathlib.Path("out") / pathlib.Path(file).stem
    folder, number = first, 1
    while folder.exists():
        number += 1
        folder = first.with_name(f"{first.name}-{number}")
    return folder


def show(line: str, last: bool) -> None:
    """A line of progress, which the next one replaces on a terminal."""
    terminal = sys.stderr.isatty()
    print(("\r\033[K" if terminal else "") + line, end="\n" if last or not terminal else "",
          file=sys.stderr, flush=True)


def guarded(act: Callable[[], int], interrupted: str) -> int:
    """The exit code of a command, with its errors said on standard error."""
    try:
        return act()
    except KeyboardInterrupt:
        print(f"\nsinew: interrupted{interrupted}", file=sys.stderr)
        return 130
    except Error as error:
        print(f"sinew: {error}", file=sys.stderr)
        return next((code for code, kind in _KINDS.items() if isinstance(error, kind)), 1)
    except BrokenPipeError:  # whoever read the output has gone
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        print(f"sinew: {error}\n  remedy: check the file and its permissions", file=sys.stderr)
        return 6


def table_of(spec: Mapping[str, Any], key: str, file: str, page: str) -> Mapping[str, Any]:
    value = spec.get(key)
    if not isinstance(value, dict) or not value:
        raise InputError(f"a table [{key}] is missing", f"see {page}", file)
    return value
