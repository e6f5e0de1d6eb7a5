"""LaTeX of control laws: the lesser and the greater of two things, and levels by cases."""

from __future__ import annotations

from collections.abc import Collection


def levels(value: str, threshold: str, low: str, high: str, reverse: bool) -> str:
    """The levels between which a control switches, each with its condition.

    Parameters
    ----------
    threshold
        Weight of the control's magnitude; ``"0"`` where it has none.
    reverse
        Whether the upper bound goes with great values, as where H is maximised.
    """
    above, below = (high, low) if reverse else (low, high)
    if threshold != "0":
        middle = rf"{nearest(low, high)}, & |{value}| \le {threshold}"
        rows = (rf"{above}, & {value} > {threshold}", middle, rf"{below}, & {value} < -{threshold}")
    else:
        middle = rf"\tfrac{{1}}{{2}} ({low} + {high}), & {value} = 0"
        rows = (rf"{above}, & {value} > 0", middle, rf"{below}, & {value} < 0")
    return r"\begin{cases} " + r" \\ ".join(rows) + r" \end{cases}"


def nearest(low: str, high: str) -> str:
    """The value of least magnitude between two bounds."""
    return rf"\max\{{{low},\, \min\{{{high},\, 0\}}\}}"


def letter(taken: Collection[str]) -> str:
    """One that stands for nothing else."""
    return next(one for one in "vzsyxabcd" if one not in taken)


def extreme(operator: str, first: str, second: str) -> str:
    r"""The lesser or the greater of two things; the operator is ``\min`` or ``\max``."""
    bigger = size(first + second)
    left, right = (rf"{bigger}l\{{", rf"{bigger}r\}}") if bigger else (r"\{", r"\}")
    return operator + left + first + r",\, " + second + right


def size(content: str) -> str:
    """Command for delimiters around the content: empty for ordinary ones."""
    for inner, outer in ((r"\bigg", r"\Bigg"), (r"\Bigg", r"\Bigg"), (r"\Big", r"\bigg"), (r"\frac", r"\Big")):
        if inner in content:
            return outer
    return r"\big" if "(" in content else ""
