"""The hypersensitive problem: a state moves from one value to another over a long time, mostly staying near zero.

The problem is that of Rao and Mease, Eigenvector approximate dichotomic basis method for solving hyper-sensitive
optimal control problems, Optimal Control Applications and Methods 21 (2000): x' = -x^3 + u from 1 to 1.5. Errors in the
canonical equations grow like exp(t) in either direction of time.
"""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("x", "x", meaning="state"),)
CONTROLS = (Variable("u", "u", meaning="control"),)
(x,) = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)

hypersensitive = Problem(
    name="hypersensitive",
    title="Hypersensitive problem: minimum deviation and effort over a long time",
    model=FirstOrder(
        name="cubic_decay",
        title="Scalar system with cubic decay",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={x: u - x**3},
    ),
    running_cost=(x**2 + u**2) / 2,
)

TRANSLATIONS = {
    "id": {
        "Hypersensitive problem: minimum deviation and effort over a long time": (
            "Masalah hipersensitif: simpangan dan upaya minimum selama waktu yang panjang"
        ),
        "Scalar system with cubic decay": "Sistem skalar dengan peluruhan kubik",
        "state": "keadaan",
        "control": "kontrol",
    },
}

PROBLEMS = (hypersensitive,)
