"""Runs of the program: the JSON of a command as dicts and arrays, its refusals as exceptions."""
import json
import os
import re
import shutil
import signal
import subprocess
from dataclasses import dataclass

import numpy as np

LINE = re.compile(r"(?P<file>.+?):(?P<line>\d+):(?P<column>\d+): (?:(?P<severity>warning|note): )?(?P<text>.*)")
DOUBTFUL = 1  # computed, and not to be trusted as it stands


@dataclass(frozen=True)
class Message:
    """What was said: file, line and column are None where the text concerns the whole."""

    text: str
    severity: str = "error"
    file: str = None
    line: int = None
    column: int = None

    def __str__(self):
        place = f"{self.file}:{self.line}:{self.column}: " if self.line is not None else f"{self.file}: " if self.file else ""
        return visible(f"{place}{'' if self.severity == 'error' else self.severity + ': '}{self.text}")


class RotidError(Exception):
    """A refusal: `messages` with their places, `code`, the exit code of the program (2 input, 3 files and memory)."""

    def __init__(self, messages, code=2):
        self.messages = [Message(m) if isinstance(m, str) else m for m in messages]
        self.code = code
        super().__init__("\n".join(map(str, self.messages)) or f"rotid ended with exit code {code}")


class Result(dict):
    """The JSON of a command; lists of numbers are arrays, null in them is nan. `code` is 0, or 1 where the result is not to be
    trusted as it stands; `messages` is what the program said."""

    def __init__(self, values, code, messages):
        super().__init__(values)
        self.code, self.messages = code, messages


def visible(text):
    """Nothing of a file steers a terminal: control characters become U+FFFD."""
    return "".join(c if c.isprintable() or c == "\n" else "\ufffd" for c in text)


def arrays(value):
    """A value of JSON with its lists of numbers as arrays, of one or two dimensions."""
    if isinstance(value, dict):
        return {key: arrays(item) for key, item in value.items()}
    if not isinstance(value, list):
        return value
    if value and all(item is None or is_number(item) for item in value) and any(map(is_number, value)):
        return np.array([np.nan if item is None else item for item in value])
    items = [arrays(item) for item in value]
    same = len(items) > 0 and all(isinstance(item, np.ndarray) and item.shape == items[0].shape for item in items)
    return np.array(items) if same else items


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def program_of(program):
    """The program: as given, else the variable ROTID, else by PATH."""
    found = program or os.environ.get("ROTID") or shutil.which("rotid")
    if not found:
        raise RotidError(["the program rotid is not on the PATH, expected it there, in the variable ROTID or as program="], 3)
    return str(found)


def said(text):
    messages = []
    for line in text.splitlines():
        m = LINE.fullmatch(line)
        if m:
            messages.append(Message(m["text"], m["severity"] or "error", m["file"], int(m["line"]), int(m["column"])))
        elif line.strip():
            severity = "warning" if line.startswith(("rotid: warning: ", "warning: ")) else "error" if line.startswith("rotid: ") else "note"
            messages.append(Message(re.sub(r"^(rotid: )?(warning: )?", "", line), severity))
    return messages


def words(options):
    """reduction="NONE" of set={...} and plain options: {"set": {"FIT.MODES": "1-4"}, "no_baseline": True} as arguments."""
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            yield option
        elif isinstance(value, dict):
            for key, item in value.items():
                yield from (option, f"{key}={item}")
        else:
            yield from (option, str(value))


def call(program, *arguments):
    """Exit code, standard output, standard error. The program ends with the call, whatever ends the call."""
    child = subprocess.Popen([program_of(program), *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True, encoding="utf-8", errors="replace")
    try:
        out, err = child.communicate()
    except BaseException:
        child.send_signal(signal.SIGTERM)
        child.communicate()
        raise
    return child.returncode, out, err


def no_constant(name):
    raise ValueError(f"{name} is no JSON")


def run(command, deck, *files, program=None, **options):
    """`rotid COMMAND DECK` with options by their long names, `-` written `_`: run("identify", "rotor.inp", set={"FIT.MODES": "1-4"}).
    A Result; RotidError where the program refuses."""
    code, out, err = call(program, command, deck, *files, "--json", "-", "--quiet", *words(options))
    try:
        values = json.loads(out, parse_constant=no_constant) if out.strip() else None
    except ValueError as error:
        raise RotidError([*said(err), f"the output of rotid {command} is no JSON: {error}"], code or 3) from None
    if values is None or code not in (0, DOUBTFUL):
        raise RotidError(said(err), code)
    return Result(arrays(values), code, said(err))
