"""Random models that are right by construction: a control law exists, and every expression is real where it is drawn.

Each is a derivation file as people write them. Coefficients are spread over twelve decades and stated as integers,
fractions, decimals, or parameters with defaults; parts are nested and shared.
"""

from __future__ import annotations

import random
from dataclasses import replace

from tests.support.statements import Declared, Statement

DECADES = (-6.0, 6.0)
"""Of coefficients."""


class Draw:
    """Draws a statement; what it declares on the way is kept."""

    def __init__(self, rng: random.Random, name: str) -> None:
        self.rng, self.name = rng, name
        self.parameters: list[Declared] = []
        self.shared: dict[str, str] = {}
        self.smooth: list[str] = []
        self.above: list[str] = []
        self.far: dict[str, tuple[float, float]] = {}

    # -- numbers

    def size(self, low: float = DECADES[0], high: float = DECADES[1]) -> float:
        """A magnitude, even in its logarithm; half of them within two decades of one."""
        if self.rng.random() < 0.5:
            low, high = max(low, -1.0), min(high, 1.0)
        return float(10.0 ** self.rng.uniform(low, high))

    def coefficient(self, low: float = DECADES[0], high: float = DECADES[1]) -> str:
        """A positive number or parameter, as it is written."""
        size, kind = self.size(low, high), self.rng.random()
        if kind < 0.25:
            name = f"k{len(self.parameters)}"
            default = float(f"{size:.{self.rng.choice((1, 3, 6))}g}")
            self.parameters.append(Declared(name, f", default={default!r}, positive=True"))
            return name
        if kind < 0.55:
            return repr(float(f"{size:.{self.rng.choice((1, 2, 3, 4, 16))}g}"))
        if kind < 0.8:
            q = self.rng.choice((1, 2, 3, 7, 10, 12, 97, 360, 1000, 86400))
            p = max(1, round(size * q))
            return f"Rational({p}, {q})" if size * q >= 1 else f"Rational({q}, {max(1, round(q / size))})"
        return str(max(1, round(size))) if size >= 1 else f"Rational(1, {round(1 / size)})"

    def signed(self, term: str) -> str:
        """The term with a coefficient of either sign."""
        return f"({self.rng.choice(('', '', '-'))}{self.coefficient()})*{term}"

    # -- functions

    def state(self) -> str:
        return self.rng.choice(self.smooth)

    def bounded(self, depth: int = 1) -> str:
        """An expression of moderate size wherever numbers of size one are put in."""
        a, b = self.state(), self.state()
        inner = self.bounded(depth - 1) if depth > 0 and self.rng.random() < 0.4 else a
        c, d = self.coefficient(-1.5, 1.0), self.coefficient(-1.5, 1.5)
        e = self.coefficient()
        less = "+" if a == b and c in ("1", "1.0", "Rational(1, 1)") else "-"  # a - a would be no function at all
        forms: list[str] = [
            *(f"sin({inner})", f"cos({c}*{inner})", f"sin({a} {less} {c}*{b})", f"cos({inner} + {d})"),
            *(
                f"exp(-{c}*({inner})**2)",
                f"exp(-({a})**2/({d} + ({b})**2))",
                f"exp(sin({inner}))",
                f"exp(-{c}*cos({a}))",
            ),
            *(f"({inner})/(1 + {c}*({b})**2)", f"1/({d} + ({a})**2 + ({b})**2)"),
            f"({a} {less} {c}*{b})/(1 + ({inner})**2)",
            *(f"sqrt(1 + {c}*({inner})**2)", f"sqrt({d} + ({a})**2 + ({b})**2)", f"1/sqrt(1 + ({a})**2)**3"),
            *(f"tanh({inner})", f"atan({d}*({a}))", f"log(1 + {e}*({inner})**2)", f"sin({a})*cos({b})"),
            *(f"(1 + {c}*({inner})**2)**-2", f"1/(1 + {e}*({a})**2)", f"(({a})**2 + {d})/(({b})**2 + {c})"),
        ]
        if self.above:
            r = self.rng.choice(self.above)
            forms += [
                f"{r}**-2",
                f"{r}**-3",
                f"sqrt({r})",
                f"log({r})",
                f"{r}**Rational(1, 3)",
                f"{a}/{r}",
                f"1/({r} + {d})",
            ]
            moderate = f"({r}/{self.far[r][0]:g})" if r in self.far else r  # floats have no e^-6500
            forms += [f"exp(-{c}*{moderate})", f"{a}**2/{r}", f"{r}**Rational(-3, 2)"]
        return self.rng.choice(forms)

    def polynomial(self) -> str:
        a, b, c = self.state(), self.state(), self.coefficient(-2.0, 2.0)
        forms = (
            *(a, a, f"({a})**2", f"{a}*{b}", f"({a})**3", f"({a} - {c}*{b})**2", f"({a} + ({b} - {c})**2)**2"),
            *(
                f"{a}*({b})**2",
                f"({a} + {c})*({b} - {a})" if a != b else f"({a} + {c})*{a}",  # a cost must not vanish
                f"({a}*{b} + {c}*({a})**2)*({b} + 1)",
                f"({a} - {c}*({b})**2)**3",
            ),
        )
        return self.rng.choice(forms)

    def function(self) -> str:
        """Any function of the states; a tenth of them of time as well."""
        kind = self.rng.random()
        if kind < 0.3:
            return self.polynomial()
        if kind < 0.7:
            return self.bounded()
        if kind < 0.8:
            return f"{self.bounded(0)}*{self.polynomial()}"
        if kind < 0.93:
            return f"{self.part()}*{self.state()}" if self.rng.random() < 0.5 else self.part()
        return self.rng.choice(
            (f"sin({self.coefficient(-1, 1)}*t)", f"{self.state()}*cos(t)", f"exp(-{self.coefficient(-1, 0)}*t)")
        )

    def part(self) -> str:
        """A shared part: one that is there, or a new one."""
        if not self.shared or (len(self.shared) < 3 and self.rng.random() < 0.4):
            a, c, d = self.state(), self.coefficient(-2.0, 1.0), self.coefficient(-2.0, 2.0)
            made = self.rng.choice(
                (
                    f"exp(-{c}*{self.bounded()})" if self.rng.random() < 0.5 else f"exp(-{c}*({a})**2)",
                    f"sqrt({d} + ({a})**2 + ({self.state()})**2)",
                    f"1/(1 + {d}*({a})**2)",
                    self.bounded(2),
                ),
            )
            self.shared[f"shared{len(self.shared)}"] = made
        return self.rng.choice(list(self.shared))

    def terms(self, least: int, most: int) -> list[str]:
        """Some terms with coefficients."""
        return [self.signed(self.function()) for _ in range(self.rng.randint(least, most))]

    def cost(self) -> list[str]:
        """Of states: mostly squares."""
        found = []
        for _ in range(self.rng.randint(0, 3)):
            a = self.state()
            square = f"({a} - {self.coefficient(-1, 1)})**2" if self.rng.random() < 0.4 else f"({a})**2"
            found.append(f"{self.coefficient()}*{square}" if self.rng.random() < 0.7 else self.signed(self.function()))
        return found + ([self.coefficient(-2, 2)] if self.rng.random() < 0.4 else [])

    # -- motions

    def begin(self, kind: str, least: int = 1, most: int = 6, controls: int = 0) -> Statement:
        """States, controls and a motion without these."""
        n, m = self.rng.randint(least, most), controls or self.rng.choice((1, 1, 2, 2, 3))
        states = []
        for i in range(n):
            name, chance = f"x{i + 1}", self.rng.random()
            if chance < 0.12:
                states.append(Declared(name, ", positive=True"))
                self.above.append(name)
                self.smooth.append(name)
            elif chance < 0.2:
                low = self.rng.choice((2.0, 80.0, 6500.0))
                high = low * self.rng.choice((1.2, 1.5))
                states.append(Declared(name, f", positive=True, typical=({low}, {high})"))
                self.above.append(name)
                self.far[name] = (low, high)
                self.smooth.append(f"({name} - {low:g})" if low < 3 else f"({name}/{low:g})")
            else:
                states.append(Declared(name))
                self.smooth.append(name)
        names = tuple(Declared(f"u{j + 1}") for j in range(m))
        rates = {f"x{i + 1}": self.terms(0 if n > 1 else 1, 3 if n < 4 else 2) for i in range(n)}
        if self.rng.random() < 0.5:  # second order
            for i in range(0, n - 1, 2):
                rates[f"x{i + 1}"] = [f"x{i + 2}"]
        return Statement(self.name, kind, tuple(states), names, rates={x: tuple(terms) for x, terms in rates.items()})

    def driven(self, of: Statement, controls: list[str] | None = None, plain: bool = False) -> Statement:
        """Controls put into the rates, each of them somewhere."""
        rates = {x: list(terms) for x, terms in of.rates.items()}
        moved = [x for x, terms in rates.items() if len(terms) != 1 or "*" in terms[0]] or list(rates)
        for u in controls or [one.name for one in of.controls]:
            for x in self.rng.sample(moved, min(len(moved), self.rng.choice((1, 1, 2)))):
                chance = self.rng.random()
                factor = "" if chance < 0.3 or plain else f"{self.coefficient()}*"
                factor += f"({self.bounded(0)})*" if chance > 0.75 and not plain else ""
                rates[x].append(f"{factor}{u}")
        return replace(of, rates={x: tuple(terms) for x, terms in rates.items()})

    def ended(self, of: Statement, cost: list[str], **more: str) -> Statement:
        """With its cost, what holds at the end, and what was declared on the way."""
        terminal, x = [], self.state()
        if self.rng.random() < 0.35:
            terminal = [f"{self.coefficient()}*({x} - {self.coefficient(-1, 1)})**2"]
            terminal += [self.signed(self.function())] if self.rng.random() < 0.4 else []
        if self.rng.random() < 0.2:
            more["terminal_constraints"] = f"({self.signed(self.function())} - {self.coefficient()},)"
        elif self.rng.random() < 0.1:
            more["terminal_inequalities"] = f'{{"above": {self.coefficient(-1, 1)} - ({x})**2}}'
        if self.rng.random() < 0.08:
            more["convention"] = '"maximum"'
        outputs = (self.function(),) if self.rng.random() < 0.1 else ()
        return replace(
            of,
            cost=tuple(cost),
            terminal=tuple(terminal),
            more=more,
            outputs=outputs,
            shared=dict(self.shared),
            parameters=tuple(self.parameters),
        )
