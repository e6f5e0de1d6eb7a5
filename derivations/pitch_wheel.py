"""The pitch axis of a satellite with a reaction wheel: a motor spins the wheel up and thereby turns the body back.

The pitch axis is normal to the orbit. The wheel and the orbital motion rotate about it in the negative sense. The speed
of the wheel is measured relative to the body, as by a tachometer. I_y is the moment of inertia of the whole satellite,
including the wheel. The numbers are those of the paper audited in lapan_pitch, which gives no numbers for the motor.
"""

from dataclasses import replace

from sympy import Matrix, cos, diag, factor, sin, sqrt

from satsym.symbolic import (
    COMMAND,
    ClosedLoop,
    Demand,
    Gyrostat,
    Motor,
    Output,
    Problem,
    Reduced,
    Scaled,
    Variable,
    rate_of,
    s,
    symbols_of,
)

STATES = (
    Variable("theta", r"\theta", "rad", "pitch angle from the local vertical"),
    Variable("theta_dot", r"\dot\theta", "rad/s", "rate of the pitch angle"),
    Variable("wheel_speed", r"\Omega", "rad/s", "deviation of the wheel speed from its nominal value"),
)
CONTROLS = (Variable("wheel_torque", "T_w", "N*m", "wheel inertia times angular acceleration relative to the body"),)
PARAMETERS = (
    Variable("I_x", "I_x", "kg*m**2", "moment of inertia of the satellite in roll", 1356.0, positive=True),
    Variable("I_y", "I_y", "kg*m**2", "moment of inertia of the satellite in pitch", 678.0, positive=True),
    Variable("I_z", "I_z", "kg*m**2", "moment of inertia of the satellite in yaw", 1356.0, positive=True),
    Variable("I_wy", "I_{wy}", "kg*m**2", "moment of inertia of the wheel about its axis", 0.09, positive=True),
    Variable("w0", r"\omega_0", "rad/s", "orbital angular velocity", 7.26e-5, positive=True),
    Variable("nominal_speed", r"\Omega_n", "rad/s", "nominal speed of the wheel", 104.71976, positive=True),
)
MOTOR = (
    Variable("R_a", "R_a", "ohm", "armature resistance", 10.0, positive=True),
    Variable("K_t", "K_t", "N*m/A", "torque constant", 0.05, positive=True),
    Variable("K_m", "K_m", "rad/V/s", "speed constant", 20.0, positive=True),
)
MOTOR_TORQUE = Variable("motor_torque", "T_m", "N*m", "torque of the motor between wheel and body")
CURRENT = Variable("current", "i", "A", "current of the motor")
VOLTAGE = Variable("voltage", "V", "V", "voltage across the motor")
POWER = Variable("power", "P", "W", "electrical power of the motor")

theta, theta_dot, wheel_speed = symbols_of(STATES)
(wheel_torque,) = symbols_of(CONTROLS)
I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = symbols_of((*PARAMETERS, *MOTOR))
motor_torque, current, voltage, power = symbols_of((MOTOR_TORQUE, CURRENT, VOLTAGE, POWER))

# gravity pulls the near end of the body more strongly: a torque of 3 w0^2 n x (I n), n pointing to the earth's centre
nadir = Matrix([-sin(theta), 0, cos(theta)])
gravity_gradient = 3 * w0**2 * factor(nadir.cross(diag(I_x, I_y, I_z) * nadir)[1])

pitch_wheel = Gyrostat(
    name="pitch_wheel",
    title="Pitch axis of a satellite with a reaction wheel",
    states=STATES,
    controls=CONTROLS,
    parameters=(*PARAMETERS, *MOTOR),
    angles={theta: theta_dot},
    bodies={
        "body": (I_y - I_wy, theta_dot - w0),
        "wheel": (I_wy, theta_dot - w0 - nominal_speed - wheel_speed),
    },
    torques={"body": gravity_gradient},
    motors=(Motor(MOTOR_TORQUE, drives="body", against="wheel"),),
    drives={wheel_torque: I_wy * rate_of(wheel_speed)},
    demands=(
        Demand(
            I_y - I_wy, "the wheel has at least as much inertia as the whole satellite, wheel included", strict=True
        ),
    ),
    quantities=(
        Output(CURRENT, motor_torque / K_t),
        Output(VOLTAGE, R_a * current + (nominal_speed + wheel_speed) / K_m),
        Output(POWER, voltage * current),
    ),
)

DAMPING = Variable("E", "E", "1/s", "damping parameter; the double pole is at -E", 0.01, positive=True)
STEP = Variable("P_c", "P_c", "rad", "pitch angle commanded at time 0", 0.025, positive=True)
GAINS = (
    Variable("K1", "K_1", "N*m*s", "gain of the rate"),
    Variable("K2", "K_2", "N*m", "gain of the angle"),
)
K1, K2 = symbols_of(GAINS)

pitch_classical = ClosedLoop(
    name="pitch_classical",
    title="Pitch axis under a critically damped proportional-derivative law",
    of=replace(pitch_wheel, parameters=PARAMETERS, motors=pitch_wheel.motors, quantities=()),
    states=STATES,
    controls=(),
    parameters=(*PARAMETERS, DAMPING, STEP),
    follows=theta,
    command=STEP,
    gains=GAINS,
    law=3 * w0**2 * (I_x - I_z) * theta + (K1 * s + K2) * (COMMAND - theta),
    damping=DAMPING,
    where={I_x: I_z},
)

LIMIT = Variable("torque_max", r"T_{\max}", "N*m", "maximum torque of the wheel", positive=True)
SCALED_POWER = Variable("scaled_power", "p", "1", "power relative to the heat dissipated at maximum torque")
C_P = Variable("C_p", "C_p", "1", "weight of the wheel power relative to the heat", 0.1)
SCALED_STATES = (
    Variable("X1", "X_1", "1", "pitch angle"),
    Variable("X2", "X_2", "1", "rate of the pitch angle, in a unit of time set by the maximum torque"),
)
SCALED_CONTROLS = (Variable("U", "U", "1", "torque of the wheel, relative to its maximum"),)
X1, X2 = symbols_of(SCALED_STATES)
(U,) = symbols_of(SCALED_CONTROLS)
torque_max, C_p, scaled_power = symbols_of((LIMIT, C_P, SCALED_POWER))
unit_of_time = sqrt(I_y / torque_max)

pitch_scaled = Scaled(
    name="pitch_scaled",
    title="Pitch axis of a symmetric satellite, nondimensional",
    of=pitch_wheel,
    states=SCALED_STATES,
    controls=SCALED_CONTROLS,
    parameters=(),
    units=(LIMIT,),
    unit_of_time=unit_of_time,
    scaled={X1: theta, X2: theta_dot * unit_of_time, U: wheel_torque / torque_max},
    where={I_x: I_z},
)

# The wheel's speed goes with the rate of the body where both start at rest. What the nominal speed takes, and gives
# back, is left out as it comes to nothing between two states of rest.
relative = 1 - I_wy / I_y
pitch_scaled_power = replace(
    pitch_scaled,
    name="pitch_scaled_power",
    title="Pitch axis of a symmetric satellite with motor power, nondimensional",
    parameters=(C_P,),
    groups={C_p: K_t * I_y / (K_m * R_a * I_wy * relative * torque_max * unit_of_time)},
    along={wheel_speed: I_y * theta_dot / I_wy},
    quantities=(
        Output(
            SCALED_POWER,
            (power - nominal_speed * motor_torque / (K_t * K_m)) * (K_t / (relative * torque_max)) ** 2 / R_a,
        ),
    ),
)

# From rest, the wheel's speed follows from the rate of the body, as all that turns the one turns the other back.
pitch_symmetric = Reduced(
    name="pitch_symmetric",
    title="Pitch axis of a symmetric satellite starting from rest",
    of=pitch_wheel,
    states=STATES[:2],
    controls=CONTROLS,
    parameters=(*PARAMETERS[1:2], *PARAMETERS[3:4], *PARAMETERS[5:], *MOTOR),
    where={I_x: I_z},
    along={wheel_speed: I_y * theta_dot / I_wy},
)
pitch_minimum_energy = Problem(
    name="pitch_minimum_energy",
    title="Pitch manoeuvre with minimum electrical energy",
    model=pitch_symmetric,
    running_cost=power,
    control_set="box",
)
pitch_minimum_time = Problem(
    name="pitch_minimum_time",
    title="Minimum-time pitch manoeuvre",
    model=pitch_symmetric,
    running_cost=1,
    control_set="box",
)
pitch_scaled_energy = Problem(
    name="pitch_scaled_energy",
    title="Minimum-energy pitch manoeuvre, nondimensional",
    model=pitch_scaled_power,
    running_cost=scaled_power,
    control_set="box",
)
pitch_scaled_time = Problem(
    name="pitch_scaled_time",
    title="Minimum-time pitch manoeuvre, nondimensional",
    model=pitch_scaled,
    running_cost=1,
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "body": "benda",
        "wheel": "roda",
        "Pitch axis of a satellite with a reaction wheel": "Sumbu angguk satelit dengan roda reaksi",
        "Pitch axis under a critically damped proportional-derivative law": (
            "Sumbu angguk dengan hukum proporsional-derivatif, teredam kritis"
        ),
        "Pitch axis of a symmetric satellite, nondimensional": "Sumbu angguk satelit simetris, tak berdimensi",
        "Pitch axis of a symmetric satellite with motor power, nondimensional": (
            "Sumbu angguk satelit simetris dengan daya motornya, tak berdimensi"
        ),
        "Pitch axis of a symmetric satellite starting from rest": (
            "Sumbu angguk satelit simetris yang mulai dari keadaan diam"
        ),
        "Pitch manoeuvre with minimum electrical energy": "Manuver angguk dengan energi listrik minimum",
        "Minimum-time pitch manoeuvre": "Manuver angguk dengan waktu minimum",
        "Minimum-energy pitch manoeuvre, nondimensional": "Manuver angguk dengan energi minimum, tak berdimensi",
        "Minimum-time pitch manoeuvre, nondimensional": "Manuver angguk dengan waktu minimum, tak berdimensi",
        "pitch angle from the local vertical": "sudut angguk dari vertikal setempat",
        "rate of the pitch angle": "laju perubahan sudut angguk",
        "deviation of the wheel speed from its nominal value": "simpangan kecepatan sudut roda dari nominalnya",
        "wheel inertia times angular acceleration relative to the body": (
            "momen inersia roda kali percepatan sudutnya relatif terhadap benda"
        ),
        "moment of inertia of the satellite in roll": "momen inersia guling satelit",
        "moment of inertia of the satellite in pitch": "momen inersia angguk satelit",
        "moment of inertia of the satellite in yaw": "momen inersia geleng satelit",
        "moment of inertia of the wheel about its axis": "momen inersia roda terhadap sumbunya",
        "orbital angular velocity": "kecepatan sudut orbit",
        "nominal speed of the wheel": "kecepatan sudut nominal roda",
        "armature resistance": "hambatan jangkar",
        "torque constant": "konstanta torsi",
        "speed constant": "konstanta kecepatan",
        "torque of the motor between wheel and body": "torsi motor antara roda dan benda",
        "current of the motor": "arus motor",
        "voltage across the motor": "tegangan motor",
        "electrical power of the motor": "daya listrik motor",
        "damping parameter; the double pole is at -E": "redaman: kutub ganda terletak di -E",
        "pitch angle commanded at time 0": "sudut angguk yang diperintahkan pada waktu 0",
        "gain of the rate": "penguatan laju perubahan sudut",
        "gain of the angle": "penguatan sudut",
        "maximum torque of the wheel": "torsi maksimum roda",
        "power relative to the heat dissipated at maximum torque": (
            "daya relatif terhadap daya panas pada torsi maksimum"
        ),
        "weight of the wheel power relative to the heat": "bobot daya roda terhadap panas",
        "pitch angle": "sudut angguk",
        "rate of the pitch angle, in a unit of time set by the maximum torque": (
            "laju perubahan sudut angguk, dengan satuan waktu yang ditentukan oleh torsi maksimum"
        ),
        "torque of the wheel, relative to its maximum": "torsi roda, relatif terhadap maksimumnya",
    },
}

PROBLEMS = (
    pitch_wheel,
    pitch_classical,
    pitch_scaled,
    pitch_minimum_energy,
    pitch_minimum_time,
    pitch_scaled_energy,
    pitch_scaled_time,
)
