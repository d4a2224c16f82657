"""A sheet with every element, in every medium: the same signs, whatever the names are made of."""

from __future__ import annotations

import io
import sys

import pytest

from flexbase.cli.terminal.screen import put
from flexbase.sheets.html import html
from flexbase.sheets.sheet import (
    NEUTRAL,
    Answer,
    Column,
    Note,
    Sheet,
    answer,
    facts,
    make_sheet,
    table,
    together,
    words,
)
from flexbase.sheets.text import printable, text
from sheets.reading import Page, on_terminal, signs, words_of

HOSTILE = {
    "a tag": "<script>alert('1')</script>&amp;\"",
    "markup of rich": "[red]not red[/red] [/] [link=x]y[/link] :smile:",
    "very long": "long" * 60,
    "many words": "many words " * 40,
    "wide": "ロボットアーム",
    "above one another": "e\u0301\u0302",
    "escape": "\x1b[31mred\x1b[0m \x1b]8;;x\x07",
    "steering": "a\rb\x08c\x00d\te\x9b2J",
    "backwards": "a\u202eb\u2066c",
    "lines": "one\ntwo\n\nthree",
    "nothing": "",
}


def whole(name: str = "arm") -> Sheet:
    """One of everything, each with the name in every place."""
    return make_sheet(
        name,
        f"at {name}",
        facts(("stiffness", "3 N/m"), (name, f"1  2\n3  {name}"), None, heading=f"facts of {name}"),
        table(
            [words(name), Column("force", "N"), Column(name, name), words("remark")],
            [["base", "1.5", "-2", name], [name, "", "10", "a\nb"]],
            heading=f"table of {name}",
        ),
        answer(True, f"{name} runs", "no", f"for {name}"),
        answer(False, "yes", f"{name} does not"),
        Answer(NEUTRAL, name),
        Note(f"a note on {name}"),
        None,
        facts(),
        table([words("none")], []),
        make_sheet(f"part of {name}", "", facts((name, name))),
        cautions=[f"beware of {name}"],
    )


def test_text_of_a_sheet():
    assert (
        text(whole())
        == """\
arm  at arm
  facts of arm:
  stiffness  3 N/m
  arm        1  2
             3  arm

  table of arm:
        force    arm
  arm     [N]  [arm]  remark
  --------------------------
  base    1.5     -2  arm
  arm             10  a
                      b

  arm runs. for arm
  arm does not
  arm
  a note on arm

part of arm
  arm  arm
  caution: beware of arm"""
    )


def test_terminal_of_a_sheet(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    shown = on_terminal(whole(), capsys)
    assert (
        shown
        == """\
arm  at arm

  facts of arm:
  stiffness  3 N/m
  arm        1  2
             3  arm

  table of arm:
         force     arm
  arm      [N]   [arm]   remark
  ─────────────────────────────
  base     1.5      -2   arm
  arm               10   a
                         b

  arm runs. for arm

  arm does not

  arm

  a note on arm

part of arm

  arm  arm
"""
    )  # cautions are not here: the program says them on stderr


def test_html_of_a_sheet():
    page = Page(html(whole()))
    assert page.elements["table"] == page.elements["tbody"] == 3  # facts are tables too
    assert (page.elements["th"], page.elements["caption"]) == (4, 2)
    assert html(whole()).count("color:") == 2  # yes and no; a neutral answer has none
    assert html(whole()).count("monospace") == 2  # the lines of a matrix keep their columns


@pytest.mark.parametrize("columns", [80, 20, 1000])
@pytest.mark.parametrize("name", HOSTILE.values(), ids=HOSTILE.keys())
def test_whatever_a_name_is_made_of_no_sign_is_lost_and_none_steers(name, columns, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    sheet = whole(name)
    shown, plain, page = on_terminal(sheet, capsys), text(sheet), Page(html(sheet))
    assert signs(plain) == signs(page.words) == signs(words_of(sheet))
    if columns > 20:  # below, a table has no room for its columns
        assert signs(shown) == signs(words_of(sheet, cautions=False))
    for medium in (shown, plain, page.words):
        assert printable(medium) == medium
    assert set(page.elements) <= {"div", "p", "strong", "small", "table", "caption", "thead", "tbody", "tr", "th", "td"}


@pytest.mark.parametrize("name", HOSTILE.values(), ids=HOSTILE.keys())
def test_a_terminal_is_never_overrun(name, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    assert max(map(len, on_terminal(whole(name), capsys).split("\n"))) <= 80


def test_colours_are_on_terminals_only(capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert "\x1b[1;32marm runs" in on_terminal(whole(), capsys)
    assert "\x1b" not in text(whole())


def test_signs_that_an_encoding_lacks_are_replaced(monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(raw, encoding="ascii", newline=""))
    put(whole("ロボット"))
    sys.stdout.flush()
    assert "????" in raw.getvalue().decode("ascii")


def test_every_row_has_a_text_for_each_column():
    for row in (["only one"], ["one", "two", "three"]):
        with pytest.raises(ValueError, match="zip"):
            table([words("a"), Column("b")], [row])


def test_sheets_with_one_heading_become_one():
    force, torque = (make_sheet("arm", "ellipsoids", Note("tip"), Note(kind)) for kind in ("force", "torque"))
    other = make_sheet("controller", "", Note("runs"), cautions=["beware"])
    joined = together(force, torque, other)
    assert joined.parts == (Note("tip"), Note("force"), Note("torque"), make_sheet("controller", "", Note("runs")))
    assert joined.cautions == ("beware",)
