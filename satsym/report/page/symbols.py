"""Labels of pictures as text that browsers show without scripts: Greek letters, dots and indices."""

from __future__ import annotations

import re

_NAMES = "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau phi chi psi omega"
_GREEK = dict(zip(_NAMES.split(), "αβγδεζηθικλμνξπρστφχψω", strict=True))
_GREEK |= {"Delta": "Δ", "Omega": "Ω", "Gamma": "Γ", "Vert": "‖", "varphi": "φ", "cos": "cos", "sin": "sin"}
_ACCENTS = {"dot": "\N{COMBINING DOT ABOVE}", "ddot": "\N{COMBINING DIAERESIS}"}
_FORMULA = re.compile(r"\$([^$]*)\$")
_BARE = re.compile(r"\\(?:mathrm|mathbf|text)\s*\{([^{}]*)\}")
_ACCENT = re.compile(r"\\(d?dot)\s*(?:\{([^{}]*)\}|(\\[A-Za-z]+|[A-Za-z]))")
_NAME = re.compile(r"\\([A-Za-z]+) *")
_INDEX = re.compile(r"([_^])(?:\{([^{}]*)\}|(.))")
_TAGS = {"_": "sub", "^": "sup"}


def shown(label: str) -> str:
    r"""A label such as ``$\dot\theta$ [rad/s]`` with the tags ``sub`` and ``sup`` for indices, as HTML."""
    text = label.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return " ".join(_FORMULA.sub(lambda found: _formula(found[1]), text).split())


def _formula(latex: str) -> str:
    text = _BARE.sub(r"\1", latex.replace(r"\,", "\N{THIN SPACE}").replace(r"\!", ""))
    text = _ACCENT.sub(lambda found: (found[2] or found[3]) + " " + _ACCENTS[found[1]], text)
    text = _NAME.sub(lambda found: _GREEK.get(found[1], found[1]), text)
    for accent in _ACCENTS.values():
        text = text.replace(" " + accent, accent)
    while _INDEX.search(text):
        text = _INDEX.sub(lambda found: f"<{_TAGS[found[1]]}>{found[2] or found[3]}</{_TAGS[found[1]]}>", text)
    return text.replace("{", "").replace("}", "")
