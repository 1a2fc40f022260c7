# SPDX-License-Identifier: GPL-2.0-or-later
"""Stick-slip of one mass on a spring and a dashpot, its other end drawn at V, under friction that
weakens linearly: piecewise a linear equation, solved in closed form,

    stick   until G (V t - u) + c V reaches mu_S p
    slip    m v' = G (V t - u) + c (V - v) - p mu(v),   mu one line below v_c, constant above,

with events (start of slip, v = v_c, stop) found by halving. All forces are of a unit length."""
import numpy as np

STIFFNESS, DAMPING, MASS, SPEED = 1 / 2.68, 0.05, 0.5, 2e-4
MU_S, MU_K, V_C = 4e-3, 1e-3, 1e-3
PRESSURE = 0.2 * V_C / (MU_S - MU_K)
LONGEST = 40.0   # a phase of slip ends within it


def slipping(start, u0, v0, threshold, slope):
    """u(t) and v(t) under the friction threshold + slope v: a line V t + d and two exponentials."""
    d = -(threshold + slope * SPEED) / STIFFNESS
    r = np.roots([MASS, DAMPING + slope, STIFFNESS]).astype(complex)
    y, w = u0 - (SPEED * start + d), v0 - SPEED
    a = (w - r[1] * y) / (r[0] - r[1])
    b = y - a

    def place(t):
        return (a * np.exp(r[0] * (t - start)) + b * np.exp(r[1] * (t - start))).real + SPEED * t + d

    def speed(t):
        return (a * r[0] * np.exp(r[0] * (t - start)) + b * r[1] * np.exp(r[1] * (t - start))).real + SPEED
    return place, speed


def first_zero(f, start):
    """The first change of sign after `start`, or infinity."""
    t = np.linspace(start, start + LONGEST, 20001)[1:]
    signs = np.sign(f(t))
    changes = np.nonzero(signs[1:] != signs[:-1])[0]
    if not len(changes):
        return np.inf
    low, high = t[changes[0]], t[changes[0] + 1]
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if np.sign(f(middle)) == signs[changes[0]] else (low, middle)
    return (low + high) / 2


def phases(end):
    """[(from, to, u(t))] from rest at t = 0 to the end."""
    found, t, u, v, sticks = [], 0.0, 0.0, 0.0, True
    while t < end:
        if sticks:
            stop = (MU_S * PRESSURE - DAMPING * SPEED) / (STIFFNESS * SPEED) + u / SPEED
            found.append((t, stop, lambda x, u=u: u + 0 * x))
            t, v, sticks = stop, 0.0, False
            continue
        fast = v >= V_C
        slope = 0.0 if fast else -(MU_S - MU_K) * PRESSURE / V_C
        place, speed = slipping(t, u, v, (MU_K if fast else MU_S) * PRESSURE, slope)
        kink, rest = first_zero(lambda x: speed(x) - V_C, t), first_zero(speed, t)
        stop = min(kink, np.inf if fast else rest)
        found.append((t, stop, place))
        sticks = not fast and rest < kink
        t, u, v = stop, float(place(stop)), 0.0 if sticks else V_C * (1 if not fast else 1 - 1e-15)
    return found


def slip(times):
    """u at each of `times`, and how many events came before the last."""
    u, pieces = np.zeros_like(times), phases(times[-1])
    for start, stop, place in pieces:
        inside = (times >= start) & (times <= stop)
        u[inside] = place(times[inside])
    return u, len(pieces) - 1
