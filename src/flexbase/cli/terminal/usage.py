"""Words for a command line that cannot be read: an unknown command or option, a missing or surplus word."""

from __future__ import annotations

from collections.abc import Sequence

from cyclopts import (
    CycloptsError,
    MissingArgumentError,
    RepeatArgumentError,
    UnknownCommandError,
    UnusedCliTokensError,
)

from flexbase.cli.catalogue import RENAMED
from flexbase.errors import nearest_name


def command_line_fault(fault: CycloptsError, commands: Sequence[str]) -> str:
    """What is wrong with a command line, in a line."""
    fault.verbose = False
    usage = " ".join(["flexbase", *(fault.command_chain or ()), "--help"])
    word = fault.unused_tokens[0] if fault.unused_tokens else ""
    option = fault.argument.name if fault.argument is not None else ""
    match fault:
        case UnknownCommandError() if word.startswith("-"):
            return f'unknown option "{word}". Options come after a command: {", ".join(commands)}.'
        case UnknownCommandError() if word in RENAMED:
            return f'"{word}" is now called {RENAMED[word]}.'
        case UnknownCommandError():
            return f'unknown command "{word}". {nearest_name(word, commands)}'
        case MissingArgumentError() if fault.keyword:
            return f"{fault.keyword}: a value must follow. See {usage}"
        case MissingArgumentError():
            return f"{option} is missing. See {usage}"
        case RepeatArgumentError():
            return f"{fault.token.keyword}: given more than once. Give it once."
        case UnusedCliTokensError() if word.lstrip("-+.").partition(".")[0].isdigit():
            return f'"{word}" is one word too many. Write a list of numbers with commas only: 0.33,-0.25.'
        case UnusedCliTokensError():
            return f'"{word}" is one word too many. See {usage}'
    text = str(fault)
    return f"{text[0].lower()}{text[1:]}" + ("" if "Did you mean" in text else f" See {usage}")
