"""Two oscillators are damped at minimum cost: Van der Pol's with a bounded control, and Rayleigh's.

The first is the example of CasADi (Andersson et al., Mathematical Programming Computation 11, 2019): the motion starts
from (0, 1) and lasts 10, with u in [-0.75, 1]. The second is a tunnel-diode circuit (Jacobson and Mayne, Differential
Dynamic Programming, 1970; Maurer and Augustin, in Online Optimization of Large Scale Systems, 2001). Its motion starts
from (-5, -5) and lasts 4.5, with and without the mixed constraint u + x1/6 <= 0.
"""

from dataclasses import replace

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("x1", "x_1", meaning="state 1"), Variable("x2", "x_2", meaning="state 2"))
CONTROLS = (Variable("u", "u", meaning="control"),)
x1, x2 = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)

van_der_pol_boxed = Problem(
    name="van_der_pol_boxed",
    title="Damping the Van der Pol oscillator with a bounded control",
    model=FirstOrder(
        name="van_der_pol_oscillator",
        title="Van der Pol oscillator",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={x1: (1 - x2**2) * x1 - x2 + u, x2: x1},
    ),
    running_cost=x1**2 + x2**2 + u**2,
    control_set="box",
)

rayleigh = Problem(
    name="rayleigh",
    title="Damping the Rayleigh oscillator",
    model=FirstOrder(
        name="tunnel_diode",
        title="Rayleigh oscillator (tunnel-diode circuit)",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={x1: x2, x2: -x1 + x2 * (1.4 - 0.14 * x2**2) + 4 * u},
    ),
    running_cost=u**2 + x1**2,
)

rayleigh_mixed = replace(
    rayleigh,
    name="rayleigh_mixed",
    title="Damping the Rayleigh oscillator with a state-dependent control bound",
    path_constraints={"bound": u + x1 / 6},
)

TRANSLATIONS = {
    "id": {
        "Damping the Van der Pol oscillator with a bounded control": (
            "Peredaman osilator Van der Pol dengan kontrol terbatas"
        ),
        "Damping the Rayleigh oscillator": "Peredaman osilator Rayleigh",
        "Damping the Rayleigh oscillator with a state-dependent control bound": (
            "Peredaman osilator Rayleigh dengan batas kontrol yang bergantung pada keadaan"
        ),
        "Van der Pol oscillator": "Osilator Van der Pol",
        "Rayleigh oscillator (tunnel-diode circuit)": "Osilator Rayleigh (rangkaian dioda terowongan)",
        "state 1": "variabel keadaan 1",
        "state 2": "variabel keadaan 2",
        "position": "posisi",
        "velocity": "kecepatan",
        "control": "kontrol",
    },
}

PROBLEMS = (van_der_pol_boxed, rayleigh, rayleigh_mixed)
