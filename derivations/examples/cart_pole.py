"""A cart swings its pole up: from rest with the pole hanging to rest with the pole upright, a given distance away.

The data are those of Kelly, An introduction to trajectory optimization, SIAM Review 59 (2017), appendix E.1: a cart of
1 kg, a pole of 0.3 kg and 0.5 m, a displacement of 1 m in 2 s, and a force of at most 20 N. The cost is the integral of
the square of the force.
"""

from sympy import cos, sin

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("q1", "q_1", "m", meaning="position of the cart"),
    Variable("q2", "q_2", "rad", meaning="angle of the pole from the hanging position", kind="angle"),
    Variable("v1", "v_1", "m/s", meaning="velocity of the cart"),
    Variable("v2", "v_2", "rad/s", meaning="angular velocity of the pole"),
)
CONTROLS = (Variable("u", "u", "N", meaning="force on the cart"),)
PARAMETERS = (
    Variable("m1", "m_1", "kg", meaning="mass of the cart", default=1.0, positive=True),
    Variable("m2", "m_2", "kg", meaning="mass at the end of the pole", default=0.3, positive=True),
    Variable("l", r"\ell", "m", meaning="length of the pole", default=0.5, positive=True),
    Variable("g", "g", "m/s^2", meaning="acceleration of gravity", default=9.81, positive=True),
)
q1, q2, v1, v2 = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)
m1, m2, l, g = symbols_of(PARAMETERS)  # noqa: E741
inertia = m1 + m2 * sin(q2) ** 2

cart_pole = Problem(
    name="cart_pole",
    title="Minimum-effort swing-up of a cart-pole",
    model=FirstOrder(
        name="cart_and_pole",
        title="Cart with a pole",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={
            q1: v1,
            q2: v2,
            v1: (l * m2 * sin(q2) * v2**2 + u + m2 * g * cos(q2) * sin(q2)) / inertia,
            v2: -(l * m2 * cos(q2) * sin(q2) * v2**2 + u * cos(q2) + (m1 + m2) * g * sin(q2)) / (l * inertia),
        },
    ),
    running_cost=u**2,
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Minimum-effort swing-up of a cart-pole": "Ayunan ke atas kereta-tiang dengan upaya minimum",
        "Cart with a pole": "Kereta dengan tiang",
        "position of the cart": "posisi kereta",
        "angle of the pole from the hanging position": "sudut tiang dari posisi menggantung",
        "velocity of the cart": "kecepatan kereta",
        "angular velocity of the pole": "kecepatan sudut tiang",
        "force on the cart": "gaya pada kereta",
        "mass of the cart": "massa kereta",
        "mass at the end of the pole": "massa di ujung tiang",
        "length of the pole": "panjang tiang",
        "acceleration of gravity": "percepatan gravitasi",
    },
}

PROBLEMS = (cart_pole,)
