"""Small systems without units, as in textbook examples; one depends on time, and two have singular arcs.

The first three are examples 2.8 (both systems) and 2.9 of the thesis audited in uny_thesis, the fourth is its example
2.7.
"""

from sympy import cos, sin

from satsym.symbolic import FirstOrder, Linearised, Output, Problem, Variable, symbols_of, t

STATES = tuple(Variable(f"x{k}", f"x_{k}", meaning=f"state {k}") for k in (1, 2, 3))
DEVIATIONS = tuple(Variable(f"z{k}", f"z_{k}", meaning=f"deviation of state {k}") for k in (1, 2))
CONTROL = Variable("u1", "u_1", meaning="control")
EFFECT = Variable("v1", "v_1", meaning="deviation of the control")
OUTPUT = Variable("y1", "y_1", meaning="output")
SIGNAL = Variable("w1", "w_1", meaning="deviation of the output")
x1, x2, x3 = symbols_of(STATES)
z1, z2 = symbols_of(DEVIATIONS)
u1, v1 = symbols_of((CONTROL, EFFECT))

saddle = FirstOrder(
    name="saddle",
    title="A saddle: one state grows, the other decays",
    states=STATES[:2],
    controls=(),
    parameters=(),
    rates={x1: 3 * x1, x2: -2 * x2},
)

stable_node = FirstOrder(
    name="stable_node",
    title="A stable node: both states decay",
    states=STATES[:2],
    controls=(),
    parameters=(),
    rates={x1: -5 * x1, x2: -2 * x2},
)

three_modes = FirstOrder(
    name="three_modes",
    title="Three real modes, two of which grow",
    states=STATES,
    controls=(),
    parameters=(),
    rates={x1: x1, x2: x1 + 2 * x2, x3: x1 - x3},
)

explicit_time = FirstOrder(
    name="explicit_time",
    title="Explicit time dependence and a quadratic output",
    states=STATES[:2],
    controls=(CONTROL,),
    parameters=(),
    rates={x1: -t * x2 + u1, x2: x1 / t},
    outputs=(Output(OUTPUT, x1**2 / t**2 + t * x2**2),),
)

time_varying = Linearised(
    name="time_varying",
    title="Linearisation about a time-varying trajectory",
    of=explicit_time,
    about={x1: t * sin(t), x2: -cos(t), u1: sin(t)},
    states=DEVIATIONS,
    controls=(EFFECT,),
    parameters=(),
    deviations={z1: x1 - t * sin(t), z2: x2 + cos(t), v1: u1 - sin(t)},
    outputs=(Output(SIGNAL, explicit_time.outputs[0].value),),
)

singular_regulator = Problem(
    name="singular_regulator",
    title="Singular regulator: minimum squared deviation, control at no cost",
    # Full control towards zero, where it stays on an arc of order one.
    model=FirstOrder(
        name="integrator", title="Integrator", states=STATES[:1], controls=(CONTROL,), parameters=(), rates={x1: u1}
    ),
    running_cost=x1**2 / 2,
    control_set="box",
)

van_der_pol = Problem(
    name="van_der_pol",
    title="Damping the Van der Pol oscillator, control at no cost",
    # The usual example of a bang-singular optimum: x(0) = (0, 1), |u1| <= 1, t_f = 4.
    model=FirstOrder(
        name="oscillator",
        title="Van der Pol oscillator",
        states=STATES[:2],
        controls=(CONTROL,),
        parameters=(),
        rates={x1: x2, x2: -x1 + x2 * (1 - x1**2) + u1},
    ),
    running_cost=(x1**2 + x2**2) / 2,
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "A saddle: one state grows, the other decays": "Titik pelana: satu keadaan tumbuh, yang lain meluruh",
        "A stable node: both states decay": "Simpul stabil: kedua keadaan meluruh",
        "Three real modes, two of which grow": "Tiga modus real, dua di antaranya tumbuh",
        "Explicit time dependence and a quadratic output": "Gerak dengan waktu eksplisit dan keluaran kuadratik",
        "Linearisation about a time-varying trajectory": ("Linearisasi di sekitar gerak yang berubah terhadap waktu"),
        "Singular regulator: minimum squared deviation, control at no cost": (
            "Kuadrat simpangan minimum tanpa biaya kontrol"
        ),
        "Integrator": "Suatu laju",
        "Damping the Van der Pol oscillator, control at no cost": (
            "Peredaman osilator Van der Pol tanpa biaya kontrol"
        ),
        "Van der Pol oscillator": "Osilator Van der Pol",
        "state 1": "variabel keadaan 1",
        "state 2": "variabel keadaan 2",
        "state 3": "variabel keadaan 3",
        "control": "kontrol",
        "output": "keluaran",
        "position": "posisi",
        "velocity": "kecepatan",
        "deviation of state 1": "simpangan variabel keadaan 1",
        "deviation of state 2": "simpangan variabel keadaan 2",
        "deviation of the control": "simpangan kontrol",
        "deviation of the output": "simpangan keluaran",
    },
}

PROBLEMS = (saddle, stable_node, three_modes, explicit_time, time_varying, singular_regulator, van_der_pol)
