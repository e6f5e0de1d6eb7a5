"""The lines that find a root: Newton's method, kept between ends that enclose it and to steps that shrink.

Both forms do the same, and always as often: a few steps more than doubling from one, and halving down to the last
digits, can take. Where the slope vanishes nowhere, the result is no number.
"""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from satsym.symbolic.functions.roots import Root

STEPS, POLISHED = 60, 3
"""Steps between ends, and steps of Newton's method after that."""

FARTHEST_ROOT, SMALLEST_CURVATURE = 1e150, 1e-100
"""Beyond this nothing is looked for; a curvature below the other counts as that."""

LAST_STEP = 1e-9
"""The last step, relative to one plus the size of the root, at most."""


def lines(name: str, root: Root, form: str, code: Callable[[sp.Expr], str]) -> list[str]:
    """Statements that give a name the value of a root.

    Parameters
    ----------
    name
        Of the result; others begin with it.
    form
        ``"math"`` or ``"np"``.
    code
        Prints expressions in that form.
    """

    def chosen(left: str, right: str, one: str, other: str) -> str:
        """One where the left is less than the right, else the other."""
        return (
            f"np.where({left} < {right}, {one}, {other})" if form == "np" else f"{one} if {left} < {right} else {other}"
        )

    absolute = "np.abs" if form == "np" else "math.fabs"
    low, high, step, last, longest, value, curved, ahead = (
        f"{name}_{part}" for part in ("low", "high", "step", "last", "longest", "value", "curved", "ahead")
    )
    lower, upper = (_end(end, code) for end in root.args[:2])
    unknown = sp.Symbol(name, real=True)
    slope = root.at().xreplace({root.unknown: unknown})
    shared, (first, second) = sp.cse(
        [slope, sp.diff(slope, unknown)], sp.utilities.numbered_symbols(f"{name}_part", real=True), order="canonical"
    )
    evaluated = [f"{s.name} = {code(e)}" for s, e in shared]
    evaluated += [f"{value} = {code(first)}", f"{curved} = {code(second)}"]
    evaluated += [f"{curved} = {chosen(curved, repr(SMALLEST_CURVATURE), repr(SMALLEST_CURVATURE), curved)}"]
    return [
        f"{low} = {chosen(lower, repr(-FARTHEST_ROOT), repr(-FARTHEST_ROOT), lower)}",
        f"{high} = {chosen(repr(FARTHEST_ROOT), upper, repr(FARTHEST_ROOT), upper)}",
        f"{name} = {chosen('0.0', low, low, '0.0')}",
        f"{name} = {chosen(high, name, high, name)}",
        f"{last} = {FARTHEST_ROOT!r}",
        f"for _ in range({STEPS}):",
        *(f"    {line}" for line in evaluated),
        f"    {low} = {chosen(value, '0.0', name, low)}",
        f"    {high} = {chosen('0.0', value, name, high)}",
        f"    {longest} = 1.0 + {absolute}({name})",
        f"    {step} = -{value}/{curved}",
        f"    {ahead} = 0.5*({low} + {high}) - {name}",
        f"    {last} = 0.5*{last} + 1e-12*{longest}",
        f"    {last} = {chosen(f'{absolute}({step})', last, last, '-1.0')}",
        f"    {last} = {chosen(high, f'{name} + {step}', '-1.0', last)}",
        f"    {last} = {chosen(f'{name} + {step}', low, '-1.0', last)}",
        f"    {step} = {chosen(last, '0.0', ahead, step)}",
        f"    {step} = {chosen(longest, step, longest, step)}",
        f"    {step} = {chosen(step, f'-{longest}', f'-{longest}', step)}",
        f"    {name} = {name} + {step}",
        f"    {last} = {absolute}({step})",
        f"for _ in range({POLISHED}):",
        *(f"    {line}" for line in evaluated),
        f"    {last} = {name}",
        f"    {name} = {name} - {value}/{curved}",
        f"    {name} = {chosen(name, lower, lower, name)}",
        f"    {name} = {chosen(upper, name, upper, name)}",
        f"{last} = {LAST_STEP!r}*(1.0 + {absolute}({name})) - {absolute}({name} - {last})",
        f"{name} = {name} + 0.0*{form}.sqrt({last})",
    ]


def _end(end: sp.Expr, code: Callable[[sp.Expr], str]) -> str:
    return repr(FARTHEST_ROOT if end is sp.oo else -FARTHEST_ROOT) if end.is_infinite else code(end)
