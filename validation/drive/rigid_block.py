# SPDX-License-Identifier: GPL-2.0-or-later
"""A rigid block on a spring: m x'' = F - mu(|x'|) N sign(x'), F = k (V t - x), with friction that weakens linearly.
Stick is exact, slip is stepped by Runge and Kutta's method of order 4. It shares nothing with amontons."""
import math


def runge_kutta(acceleration, t, x, v, step):
    """The velocity after a step of order 4, and the way gone in it."""
    half = step / 2
    a1 = acceleration(t, x, v)
    a2 = acceleration(t + half, x + half * v, v + half * a1)
    a3 = acceleration(t + half, x + half * (v + half * a1), v + half * a2)
    a4 = acceleration(t + step, x + step * (v + half * a2), v + step * a3)
    return v + step * (a1 + 2 * a2 + 2 * a3 + a4) / 6, step * (v + step * (a1 + a2 + a3) / 6)


def cycles(mass, load, stiffness, drive, law, count, step=0.01):
    """The first `count` slips: (t, F) where each begins, (t, F) where it ends, F's largest, the fastest x'.

    law: mu_S, mu_K, v_c."""
    mu_static, mu_kinetic, critical = law
    time = position = 0.0
    found = []

    def acceleration(t, x, v):
        mu = max(mu_kinetic, mu_static - (mu_static - mu_kinetic) * v / critical)
        return (stiffness * (drive * t - x) - mu * load) / mass

    for _ in range(count):
        time = (mu_static * load / stiffness + position) / drive
        slip = {"t_start": time, "F_start": mu_static * load, "fastest": 0.0, "F_max": 0.0}
        velocity = 0.0
        while True:
            t, x, v = time, position, velocity
            ahead, moved = runge_kutta(acceleration, t, x, v, step)
            if ahead <= 0 and v > 0:   # at rest within the step
                part = v / (v - ahead)
                time, position = t + part * step, x + part * moved
                break
            time, position, velocity = t + step, x + moved, ahead
            slip["fastest"] = max(slip["fastest"], velocity)
            slip["F_max"] = max(slip["F_max"], stiffness * (drive * time - position))
        slip.update(t_stop=time, F_stop=stiffness * (drive * time - position))
        found.append(slip)
    return found


def march(mass, load, stiffness, drive, law, until, step=0.02, resting=1.0):
    """The same with a load and a drive that are functions of time, to both sides: lists of (t, F) at the begin and at
    the end of each slip up to the time `until`. Rest ends on a grid of `resting`, refined by halving."""
    mu_static, mu_kinetic, critical = law
    time = position = 0.0
    begins, ends = [], []

    def pull(t, x):
        return stiffness * (drive(t) - x)

    def acceleration(t, x, v):
        mu = max(mu_kinetic, mu_static - (mu_static - mu_kinetic) * abs(v) / critical)
        return (pull(t, x) - side * mu * load(t)) / mass

    while True:
        while abs(pull(time, position)) < mu_static * load(time):
            time += resting
            if time > until:
                return begins, ends
        low, high = time - resting, time
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if abs(pull(middle, position)) < mu_static * load(middle) else (low, middle)
        time, velocity, side = high, 0.0, math.copysign(1, pull(high, position))
        begins.append((time, pull(time, position)))
        while True:
            v = velocity
            velocity, moved = runge_kutta(acceleration, time, position, v, step)
            time, position = time + step, position + moved
            if side * velocity <= 0 and side * v > 0:
                ends.append((time, pull(time, position)))
                break


if __name__ == "__main__":
    for event in cycles(0.5, 0.003, 0.001, 1e-4, (0.38, 0.25, 3.4e-4), 3):
        print({name: float(f"{value:.7g}") for name, value in event.items() if math.isfinite(value)})
