"""A body on a line with a bounded acceleration: minimum time, minimum energy and minimum fuel to a state.

The plainest problems on which optimal controls switch; all three have solutions in closed form.
"""

from dataclasses import replace

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("q", "q", "m", "position"),
    Variable("q_dot", r"\dot q", "m/s", "velocity"),
)
CONTROLS = (Variable("u1", "u_1", "m/s**2", "thrust per unit mass"),)
TIME_WEIGHT = Variable("weight_time", "c_0", "m/s**2", "weight of time against fuel", 0.0)
q, q_dot = symbols_of(STATES)
(u1,) = symbols_of(CONTROLS)
(weight_time,) = symbols_of((TIME_WEIGHT,))

motion = FirstOrder(
    name="double_integrator",
    title="A body on a line, accelerated at will",
    states=STATES,
    controls=CONTROLS,
    parameters=(),
    rates={q: q_dot, q_dot: u1},
)

double_integrator_time = Problem(
    name="double_integrator_time",
    title="Minimum time for a body on a line",
    model=motion,
    running_cost=1,
    control_set="box",
)

double_integrator_energy = Problem(
    name="double_integrator_energy",
    title="Minimum energy for a body on a line",
    model=motion,
    running_cost=u1**2 / 2,
    control_set="box",
)

double_integrator_fuel = Problem(
    name="double_integrator_fuel",
    title="Minimum fuel for a body on a line, weighing time against it",
    # Where the final time is free, fuel alone has no minimum: coasting longer is always cheaper.
    model=replace(motion, parameters=(TIME_WEIGHT,)),
    running_cost=weight_time + abs(u1),
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Minimum time for a body on a line": "Waktu minimum bagi benda pada garis lurus",
        "Minimum energy for a body on a line": "Energi minimum bagi benda pada garis lurus",
        "Minimum fuel for a body on a line, weighing time against it": (
            "Bahan bakar minimum bagi benda pada garis lurus dengan bobot waktu"
        ),
        "A body on a line, accelerated at will": "Benda pada garis lurus yang dipercepat dengan bebas",
        "position": "posisi",
        "velocity": "kecepatan",
        "thrust per unit mass": "gaya dorong per satuan massa",
        "weight of time against fuel": "bobot waktu terhadap bahan bakar",
    },
}

PROBLEMS = (double_integrator_time, double_integrator_energy, double_integrator_fuel)
