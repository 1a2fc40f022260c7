# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws of friction that are compared, what each holds at rest and in steady slip, and what is varied: for question.py and page.py."""
import math
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SCENE = ROOT / "validation/paper/fig1.yaml"
SHEAR_MODULUS = 1 / (2 * 1.34)
P, V, REST, FAST = 0.003, 1e-5, 200, 3.4e-3   # REST: about the time between two slidings; FAST: 10 v_c
MU_STATIC, MU_KINETIC = 0.38, 0.1
CELLS_ASKED, CELLS_MOST = 8, 160   # on the length over which slip weakens; of one run along the contact
TO = 0.03


# --- laws -----------------------------------------------------------------------------------------

def ageing(healing, static):
    return {"law": "ageing", "mu_static": static, "mu_kinetic": MU_KINETIC, "critical_velocity": 3.4e-4, "healing": healing,
            "healing_time": 10, "slip_distance": 1e-4}


def weakening(distance):
    return {"law": "slip-weakening", "mu_static": MU_STATIC, "mu_kinetic": MU_KINETIC, "healing_time": 30, "slip_distance": distance,
            "rest": REST}


def rate_state(effect, reference, distance, **more):
    return {"law": "rate-and-state", "direct_effect": 0.01, "evolution_effect": effect, "mu_reference": reference,
            "reference_velocity": V, "slip_distance": distance} | more


LAWS = {
    "paper": {},
    "ageing": ageing(0.03, 0.3482),
    "rate-and-state": rate_state(0.043, 0.289, 2.4e-4),
    "ageing, beta 0.1": ageing(0.1, 0.2913),
    "slip-weakening": weakening(1.6e-3),
    "slip-weakening, D_c / 3": weakening(5e-4),
    "rate-and-state, slip law": rate_state(0.043, 0.289, 2.4e-4, evolution="slip"),
    "rate-and-state, D_c / 3": rate_state(0.0368, 0.2566, 7e-5),
    "rate-and-state, D_c / 12": rate_state(0.0324, 0.231, 2e-5),
    "rate-and-state, matched in creep": rate_state(0.058, 0.38, 3.24e-4),
    "rate-and-state, as of rock": rate_state(0.015, 0.38, 8.4e-5),
}
MAIN = ("paper", "ageing", "rate-and-state", "rate-and-state, slip law")


def steady(law, velocity):
    """The local coefficient in steady slip."""
    if law.get("law") == "rate-and-state":
        return law["mu_reference"] - (law["evolution_effect"] - law["direct_effect"]) * math.log(velocity / V)
    if law.get("law") == "slip-weakening":
        part = 1 / (1 + law["healing_time"] * velocity / law["slip_distance"])
        return MU_KINETIC + (MU_STATIC - MU_KINETIC) * part
    linear = max(MU_KINETIC, law.get("mu_static", MU_STATIC) - (law.get("mu_static", MU_STATIC) - MU_KINETIC) * velocity / 3.4e-4)
    return linear * healed(law, law["slip_distance"] / velocity) if law else linear


def healed(law, age):
    return 1 + law["healing"] * math.log(1 + age / law["healing_time"])


def rested(law):
    """What a contact holds after REST (rate and state: at the slip rate V)."""
    if law.get("law") == "rate-and-state":
        return law["mu_reference"] + law["evolution_effect"] * math.log(V * REST / law["slip_distance"])
    if law.get("law") == "ageing":
        return law["mu_static"] * healed(law, REST)
    return MU_STATIC


def length_of(law, pressure=P):
    """G D_c over what p times the drop of the law takes; None: weakening has no slip distance."""
    drop = {"rate-and-state": law.get("evolution_effect"), "slip-weakening": MU_STATIC - MU_KINETIC}.get(law.get("law"))
    return SHEAR_MODULUS * law["slip_distance"] / (drop * pressure) if drop else None


RESTS, REST_CELLS = (1, 10, 100, 1000, 10000, 100000), (28, 40, 56)
COST_LAWS = ("paper", "ageing", "slip-weakening", "rate-and-state", "rate-and-state, slip law")
COST_CELLS = (40, 80)
