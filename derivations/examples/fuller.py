"""Fuller's problem: a body on a line is brought to rest so that the integral of its squared distance is a minimum.

A. T. Fuller (Relay control systems optimized for various performance criteria, 1960) found that the force switches
infinitely often in finite time: the state of rest is a singular arc of second order, which cannot be joined to a
bang-bang arc (Kelley, Kopp and Moyer, Singular extremals, 1967; Zelikin and Borisov, Theory of Chattering Control,
1994).
"""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("x1", "x_1", meaning="position"), Variable("x2", "x_2", meaning="velocity"))
CONTROLS = (Variable("u", "u", meaning="force per unit mass"),)
x1, x2 = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)

fuller = Problem(
    name="fuller",
    title="Fuller's problem: bringing a body to rest with minimum squared distance",
    model=FirstOrder(
        name="body_on_a_line",
        title="Body moving on a line",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={x1: x2, x2: u},
    ),
    running_cost=x1**2,
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Fuller's problem: bringing a body to rest with minimum squared distance": (
            "Masalah Fuller: membawa benda ke keadaan diam dengan kuadrat jarak minimum"
        ),
        "Body moving on a line": "Benda yang bergerak pada garis lurus",
        "position": "posisi",
        "velocity": "kecepatan",
        "force per unit mass": "gaya per satuan massa",
    },
}

PROBLEMS = (fuller,)
