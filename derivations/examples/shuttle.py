"""A space shuttle enters the atmosphere and glides to the maximum cross-range (Betts 2010, section 6.1).

The controls are the angle of attack and the bank angle. The lift coefficient is linear in the angle of attack, the drag
coefficient quadratic; the bank angle rotates the lift about the velocity. The maximum latitude is 34.1411843 degrees
if heating is not limited. It depends on the bounds of the bank angle, because a vehicle with these coefficients would
glide even further if it flew upside down with negative lift. In the second problem, the heating rate of the leading
edge of the wing, which depends on the angle of attack, is bounded.
"""

from dataclasses import replace

from sympy import Rational, cos, exp, sin

from satsym.symbolic import Box, FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("h", "h", "ft", "altitude", typical=(80000.0, 260000.0)),
    Variable("phi", r"\phi", "rad", "longitude", kind="angle", typical=(0.0, 1.0)),
    Variable("theta", r"\theta", "rad", "latitude", typical=(0.0, 1.0)),
    Variable("v", "v", "ft/s", "speed", positive=True, typical=(2500.0, 26000.0)),
    Variable("gamma", r"\gamma", "rad", "flight-path angle", typical=(-0.1, 0.1)),
    Variable("psi", r"\psi", "rad", "azimuth", typical=(0.0, 1.6)),
)
CONTROLS = (
    Variable("alpha", r"\alpha", "deg", "angle of attack", typical=(0.0, 30.0)),
    Variable("beta", r"\beta", "rad", "bank angle", kind="angle"),
)
PARAMETERS = (
    Variable("mu", r"\mu", "ft^3/s^2", "gravitational parameter", 0.14076539e17, positive=True),
    Variable("r_e", "r_e", "ft", "radius of the Earth", 20902900.0, positive=True),
    Variable("rho_0", r"\rho_0", "slug/ft^3", "density at the ground", 0.002378, positive=True),
    Variable("h_r", "h_r", "ft", "scale height", 23800.0, positive=True),
    Variable("area", r"A_{\mathrm{ref}}", "ft^2", "reference area", 2690.0, positive=True),
    Variable("m", "m", "slug", "mass", 203000.0 / 32.174, positive=True),
    Variable("a_0", "a_0", meaning="lift coefficient at zero angle of attack", default=-0.20704),
    Variable("a_1", "a_1", "1/deg", "slope of the lift coefficient", 0.029244, positive=True),
    Variable("b_0", "b_0", meaning="drag coefficient at zero angle of attack", default=0.07854, positive=True),
    Variable("b_1", "b_1", "1/deg", "slope of the drag coefficient at zero angle of attack", -0.61592e-2),
    Variable("b_2", "b_2", "1/deg^2", "quadratic coefficient of the drag", 0.621408e-3, positive=True),
)
h, phi, theta, v, gamma, psi = symbols_of(STATES)
alpha, beta = symbols_of(CONTROLS)
mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = symbols_of(PARAMETERS)

r = r_e + h
pressure = rho_0 * exp(-h / h_r) * v**2 / 2
lift = pressure * area * (a_0 + a_1 * alpha) / m
drag = pressure * area * (b_0 + b_1 * alpha + b_2 * alpha**2) / m
gravity = mu / r**2

shuttle = Problem(
    name="shuttle",
    title="Space shuttle entry with maximum cross-range",
    model=FirstOrder(
        name="entry",
        title="Gliding entry over a spherical, non-rotating Earth",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={
            h: v * sin(gamma),
            phi: v * cos(gamma) * sin(psi) / (r * cos(theta)),
            theta: v * cos(gamma) * cos(psi) / r,
            v: -drag - gravity * sin(gamma),
            gamma: lift * cos(beta) / v + cos(gamma) * (v / r - gravity / v),
            psi: lift * sin(beta) / (v * cos(gamma)) + v * cos(gamma) * sin(psi) * sin(theta) / (r * cos(theta)),
        },
    ),
    running_cost=0,
    terminal_cost=theta,
    maximise=True,
    control_sets={"attack": Box("alpha"), "bank": Box("beta")},
)

Q_R = 17700.0 * 0.002378**0.5
HEATING = (
    Variable("q_max", r"q_{\max}", "BTU/ft^2/s", "maximum heating rate of the leading edge", 70.0, positive=True),
    Variable("q_r", "q_r", "BTU/ft^2/s", "heating rate at ground density and reference speed", Q_R, positive=True),
    Variable("v_r", "v_r", "ft/s", "reference speed", 1e4, positive=True),
    Variable("c_0", "c_0", meaning="heating coefficient at zero angle of attack", default=1.0672181),
    Variable("c_1", "c_1", "1/deg", "linear heating coefficient in the angle of attack", -0.19213774e-1),
    Variable("c_2", "c_2", "1/deg^2", "quadratic heating coefficient in the angle of attack", 0.21286289e-3),
    Variable("c_3", "c_3", "1/deg^3", "cubic heating coefficient in the angle of attack", -0.10117249e-5),
)
q_max, q_r, v_r, c_0, c_1, c_2, c_3 = symbols_of(HEATING)
heating = (
    q_r * exp(-h / (2 * h_r)) * (v / v_r) ** Rational(307, 100) * (c_0 + c_1 * alpha + c_2 * alpha**2 + c_3 * alpha**3)
)

shuttle_heating = replace(
    shuttle,
    name="shuttle_heating",
    title="Space shuttle entry with maximum cross-range under a heating limit",
    model=replace(shuttle.model, name="heated_entry", parameters=PARAMETERS + HEATING),
    path_constraints={"heating": heating - q_max},
)

TRANSLATIONS = {
    "id": {
        "Space shuttle entry with maximum cross-range": (
            "Masuk atmosfer pesawat ulang-alik dengan jarak lateral maksimum"
        ),
        "Space shuttle entry with maximum cross-range under a heating limit": (
            "Masuk atmosfer pesawat ulang-alik dengan jarak lateral maksimum dan batas pemanasan"
        ),
        "Gliding entry over a spherical, non-rotating Earth": (
            "Masuk atmosfer dengan terbang luncur di atas Bumi bulat yang tidak berotasi"
        ),
        "altitude": "ketinggian",
        "longitude": "bujur",
        "latitude": "lintang",
        "speed": "laju",
        "flight-path angle": "sudut lintasan terhadap horizontal",
        "azimuth": "azimut",
        "angle of attack": "sudut serang",
        "bank angle": "sudut miring",
        "gravitational parameter": "parameter gravitasi",
        "radius of the Earth": "jari-jari Bumi",
        "density at the ground": "massa jenis udara di permukaan tanah",
        "scale height": "tinggi skala",
        "reference area": "luas acuan",
        "mass": "massa",
        "lift coefficient at zero angle of attack": "koefisien gaya angkat pada sudut serang nol",
        "slope of the lift coefficient": "kemiringan koefisien gaya angkat",
        "drag coefficient at zero angle of attack": "koefisien gaya hambat pada sudut serang nol",
        "slope of the drag coefficient at zero angle of attack": (
            "kemiringan koefisien gaya hambat pada sudut serang nol"
        ),
        "quadratic coefficient of the drag": "koefisien kuadrat gaya hambat",
        "maximum heating rate of the leading edge": "laju pemanasan maksimum tepi depan sayap",
        "heating rate at ground density and reference speed": "laju pemanasan oleh udara permukaan pada laju acuan",
        "reference speed": "laju acuan",
        "heating coefficient at zero angle of attack": "koefisien pemanasan pada sudut serang nol",
        "linear heating coefficient in the angle of attack": "koefisien linear pemanasan terhadap sudut itu",
        "quadratic heating coefficient in the angle of attack": "koefisien kuadrat pemanasan terhadap sudut itu",
        "cubic heating coefficient in the angle of attack": "koefisien kubik pemanasan terhadap sudut itu",
    },
}

PROBLEMS = (shuttle, shuttle_heating)
