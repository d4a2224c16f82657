"""The program `flexbase`: its commands, loaded when they are called, and its exit status."""

from __future__ import annotations

import errno
import sys
from collections.abc import Sequence

from cyclopts import App, Group, Parameter

from flexbase import __version__
from flexbase.cli.catalogue import COMMANDS
from flexbase.cli.terminal.faults import one_line_cautions, report, silence_stdout
from flexbase.cli.terminal.screen import Screen

INTERRUPTED, BROKEN_PIPE = 130, 141  # 128 and the number of the signal, as shells have it
EPILOGUE = """Examples:
  flexbase check ueda2003
  flexbase modes ueda2003 --tip 0.33,-0.25
  flexbase design ueda2003 --tip 0.33,-0.25 --out compensator.json

ROBOT is a bundled name (flexbase robots) or the path of a project file.
Exit status: 0 good, 1 the answer is no, 2 the input is wrong, 74 no room for
the output, 70 flexbase itself failed."""

app = App(
    name="flexbase",
    version=f"flexbase {__version__}",
    help="Where may an arm on a flexible base be driven hard? What makes it safe elsewhere?",
    help_format="plaintext",
    help_epilogue=EPILOGUE,
    group_parameters=Group("Options", sort_key=90),
    default_parameter=Parameter(negative=(), show_default=False),
    console=Screen(),
    result_action="return_value",
)
for _name, _purpose in COMMANDS.items():
    _module = _name.replace("-", "_")
    app.command(f"flexbase.cli.commands.{_module}:app", name=_name, help=_purpose, sort_key=list(COMMANDS).index(_name))


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the program and leave with its exit status; `arguments` stand in for those of the process."""
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


def run(arguments: Sequence[str]) -> int:
    """Run one command line; returns the exit status. No fault leaves as a traceback."""
    try:
        with one_line_cautions():
            if sys.stdout is None:  # closed by the caller
                raise OSError(errno.EBADF, "it is closed")
            status = app(list(arguments), exit_on_error=False, print_error=False)
            sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        silence_stdout()
        return BROKEN_PIPE
    except Exception as fault:
        return report(fault, list(COMMANDS))
    return int(status or 0)
