"""A body on a line with a bounded acceleration: minimum time, minimum energy and minimum fuel to a given state.

These are the simplest problems in which optimal controls switch; all three have solutions in closed form.
"""

from dataclasses import replace

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("q", "q", "m", "position"),
    Variable("q_dot", r"\dot q", "m/s", "velocity"),
)
CONTROLS = (Variable("u1", "u_1", "m/s**2", "thrust per unit mass"),)
TIME_WEIGHT = Variable("weight_time", "c_0", "m/s**2", "weight of time relative to fuel", 0.0)
q, q_dot = symbols_of(STATES)
(u1,) = symbols_of(CONTROLS)
(weight_time,) = symbols_of((TIME_WEIGHT,))

motion = FirstOrder(
    name="double_integrator",
    title="Double integrator: a body moving on a line",
    states=STATES,
    controls=CONTROLS,
    parameters=(),
    rates={q: q_dot, q_dot: u1},
)

double_integrator_time = Problem(
    name="double_integrator_time",
    title="Double integrator, minimum time",
    model=motion,
    running_cost=1,
    control_set="box",
)

double_integrator_energy = Problem(
    name="double_integrator_energy",
    title="Double integrator, minimum energy",
    model=motion,
    running_cost=u1**2 / 2,
    control_set="box",
)

double_integrator_fuel = Problem(
    name="double_integrator_fuel",
    title="Double integrator, minimum fuel with a weight on time",
    # Where the final time is free, fuel alone has no minimum: coasting longer is always cheaper.
    model=replace(motion, parameters=(TIME_WEIGHT,)),
    running_cost=weight_time + abs(u1),
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Double integrator, minimum time": "Integrator ganda, waktu minimum",
        "Double integrator, minimum energy": "Integrator ganda, energi minimum",
        "Double integrator, minimum fuel with a weight on time": (
            "Integrator ganda, bahan bakar minimum dengan bobot waktu"
        ),
        "Double integrator: a body moving on a line": "Integrator ganda: benda yang bergerak pada garis lurus",
        "position": "posisi",
        "velocity": "kecepatan",
        "thrust per unit mass": "gaya dorong per satuan massa",
        "weight of time relative to fuel": "bobot waktu terhadap bahan bakar",
    },
}

PROBLEMS = (double_integrator_time, double_integrator_energy, double_integrator_fuel)
