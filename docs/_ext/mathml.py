"""Formulas as MathML, which browsers draw themselves: no LaTeX to build the site, no script and no font to read it."""

import re
from typing import Any

from docutils.nodes import SkipNode
from docutils.utils.math import latex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

# what the converter makes of an accented letter with an index: index and accent below and above the letter
ACCENT_AND_INDEX = re.compile(
    r"<munderover>\s*(<mi>[^<]*</mi>)\s*(<mi>[^<]*</mi>)\s*(<mo[^>]*>[¨˙ˉ˜~^ˆ]</mo>)\s*</munderover>"
)
NORM_BAR = re.compile(r"<mo[^>]*>‖</mo>")


def _mended(drawn: str) -> str:
    drawn = ACCENT_AND_INDEX.sub(r"<msub><mover>\1\3</mover>\2</msub>", drawn)
    return NORM_BAR.sub('<mo stretchy="false" lspace="0" rspace="0">‖</mo>', drawn)


def _mathml(node: Any, as_block: bool) -> str:
    source = node.astext()
    try:
        return _mended(str(latex2mathml.tex2mathml(source, as_block=as_block)))
    except Exception as fault:
        logging.getLogger(__name__).warning("formula not understood: %s (%s)", source, fault, location=node)
        return f"<code>{source}</code>"


def _inline(translator: Any, node: Any) -> None:
    translator.body.append(_mathml(node, as_block=False))
    raise SkipNode


def _block(translator: Any, node: Any) -> None:
    translator.body.append(f'<div class="formula">{_mathml(node, as_block=True)}</div>\n')
    raise SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.connect("config-inited", lambda _, config: setattr(config, "html_math_renderer", "mathml"))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
