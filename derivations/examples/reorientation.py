"""Minimum-time rest-to-rest reorientation of a rigid body, with a torque about each axis.

The problem is that of Bilimoria and Wie, Time-optimal three-axis reorientation of a rigid spacecraft, Journal of
Guidance, Control, and Dynamics 16 (1993): moments of inertia and maximum torques are one, and the body turns by 180
degrees about its third axis. A rotation about that axis alone does not take the minimum time.
"""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    *(Variable(f"q{k}", f"q_{k}", meaning=f"component {k} of the quaternion") for k in (1, 2, 3, 4)),
    *(Variable(f"w{k}", rf"\omega_{k}", meaning=f"angular velocity about axis {k}") for k in (1, 2, 3)),
)
CONTROLS = tuple(Variable(f"u{k}", f"u_{k}", meaning=f"torque about axis {k}") for k in (1, 2, 3))
PARAMETERS = tuple(
    Variable(f"I{k}", f"I_{k}", meaning=f"moment of inertia about axis {k}", default=1.0, positive=True)
    for k in (1, 2, 3)
)
q1, q2, q3, q4, w1, w2, w3 = symbols_of(STATES)
u1, u2, u3 = symbols_of(CONTROLS)
I1, I2, I3 = symbols_of(PARAMETERS)

reorientation = Problem(
    name="reorientation",
    title="Minimum-time rest-to-rest reorientation of a rigid body",
    model=FirstOrder(
        name="rigid_body",
        title="Rigid body with three control torques",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={
            q1: (w1 * q4 - w2 * q3 + w3 * q2) / 2,
            q2: (w1 * q3 + w2 * q4 - w3 * q1) / 2,
            q3: (-w1 * q2 + w2 * q1 + w3 * q4) / 2,
            q4: -(w1 * q1 + w2 * q2 + w3 * q3) / 2,
            w1: (u1 - (I3 - I2) * w2 * w3) / I1,
            w2: (u2 - (I1 - I3) * w3 * w1) / I2,
            w3: (u3 - (I2 - I1) * w1 * w2) / I3,
        },
    ),
    running_cost=1,
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Minimum-time rest-to-rest reorientation of a rigid body": (
            "Reorientasi benda tegar dari diam ke diam dengan waktu minimum"
        ),
        "Rigid body with three control torques": "Benda tegar dengan tiga torsi kontrol",
        "component 1 of the quaternion": "komponen ke-1 kuaternion",
        "component 2 of the quaternion": "komponen ke-2 kuaternion",
        "component 3 of the quaternion": "komponen ke-3 kuaternion",
        "component 4 of the quaternion": "komponen ke-4 kuaternion",
        "angular velocity about axis 1": "kecepatan sudut terhadap sumbu 1",
        "angular velocity about axis 2": "kecepatan sudut terhadap sumbu 2",
        "angular velocity about axis 3": "kecepatan sudut terhadap sumbu 3",
        "torque about axis 1": "torsi terhadap sumbu 1",
        "torque about axis 2": "torsi terhadap sumbu 2",
        "torque about axis 3": "torsi terhadap sumbu 3",
        "moment of inertia about axis 1": "momen inersia terhadap sumbu 1",
        "moment of inertia about axis 2": "momen inersia terhadap sumbu 2",
        "moment of inertia about axis 3": "momen inersia terhadap sumbu 3",
    },
}

PROBLEMS = (reorientation,)
