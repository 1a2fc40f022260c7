# SPDX-License-Identifier: GPL-2.0-or-later
"""A rigid block on a spring with friction that remembers: m x'' = k (V t - x) - N mu(x', theta), by SciPy's Radau. It
shares nothing with amontons."""
import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

TIGHT = {"method": "Radau", "rtol": 1e-10}


class Ageing:
    """m(v) (1 + beta ln(1 + theta/theta_0)), theta' = 1 - v theta/D_c."""

    def __init__(self, mu_static, mu_kinetic, critical_velocity, healing, healing_time, slip_distance):
        self.numbers = mu_static, mu_kinetic, critical_velocity, healing, healing_time
        self.slip_distance = slip_distance

    def mu(self, v, theta):
        mu_static, mu_kinetic, critical, beta, theta_0 = self.numbers
        return max(mu_kinetic, mu_static - (mu_static - mu_kinetic) * v / critical) * (1 + beta * numpy.log1p(theta / theta_0))

    def rate(self, v, theta):
        return 1 - v * theta / self.slip_distance

    def rested(self, theta, time):
        return theta + time


class SlipWeakening:
    """mu_K + (mu_S - mu_K) phi, phi' = (1 - phi)/t_h - v phi/D_c."""

    def __init__(self, mu_static, mu_kinetic, healing_time, slip_distance):
        self.numbers = mu_static, mu_kinetic
        self.healing_time, self.slip_distance = healing_time, slip_distance

    def mu(self, v, phi):
        return self.numbers[1] + (self.numbers[0] - self.numbers[1]) * phi

    def rate(self, v, phi):
        return (1 - phi) / self.healing_time - v * phi / self.slip_distance

    def rested(self, phi, time):
        return 1 - (1 - phi) * numpy.exp(-time / self.healing_time)


def slips(mass, load, stiffness, drive, law, start, count):
    """The first `count` slips of a law that sticks: (t, F) where each begins and ends, F's largest, the fastest x', and
    the state at both ends and when it has slowed down to the drive's velocity. start: the state at t = 0."""
    time = position = 0.0
    state, found = start, []
    for _ in range(count):
        def excess(t, since=time, at=position, theta=state):
            return stiffness * (drive * t - at) - load * law.mu(0, law.rested(theta, t - since))
        later = time + 1.0
        while excess(later) < 0:
            later += 1.0
        begin = brentq(excess, time, later, xtol=1e-12, rtol=1e-14)
        state = law.rested(state, begin - time)
        slip = {"t_start": begin, "F_start": stiffness * (drive * begin - position), "state_start": state}

        def motion(t, y):
            x, v, theta = y
            v = max(v, 0)
            return [v, (stiffness * (drive * t - x) - load * law.mu(v, theta)) / mass, law.rate(v, theta)]

        def rests(t, y):
            return y[1]
        rests.terminal, rests.direction = True, -1
        # At the onset force and friction are equal, and the way off the fixed point is that of the drive.
        done = solve_ivp(motion, (begin, begin + 1e4), [position, 0.0, state], events=rests, max_step=0.5,
                         dense_output=True, atol=[1e-15, 1e-15, 1e-10], **TIGHT)
        force = stiffness * (drive * done.t - done.y[0])
        time, position, state = done.t[-1], done.y[0, -1], done.y[2, -1]
        slow = brentq(lambda t: done.sol(t)[1] - drive, done.t[done.y[1].argmax()], time)
        slip["state_slow"] = done.sol(slow)[2]   # when it has come down to the drive's velocity
        slip.update(t_stop=time, F_stop=force[-1], F_max=force.max(), fastest=done.y[1].max(), state_stop=state)
        found.append(slip)
    return found


class RateState:
    """a asinh(v/(2 V_0) exp((f_0 + b psi)/a)), psi = ln(V_0 theta/D_c)."""

    def __init__(self, direct, evolution, reference, velocity, slip_distance, slip_law=False):
        self.a, self.b, self.f_0, self.V_0, self.D_c = direct, evolution, reference, velocity, slip_distance
        self.slip_law = slip_law

    def scale(self, psi):
        return 2 * self.V_0 * numpy.exp(-(self.f_0 + self.b * psi) / self.a)

    def rate(self, v, psi):
        if self.slip_law:
            return -v / self.D_c * (psi + numpy.log(max(v, 1e-300) / self.V_0))
        return (self.V_0 * numpy.exp(-psi) - v) / self.D_c


def creep(mass, load, stiffness, law, way, start, times, force=0.0):
    """x, v, psi and the spring's force at the times, from rest under no force (or `force`). way: U of t, a list of
    (time, velocity) from when it has it. In u = asinh(v/v_s(psi)) and the force, of which slow slip is stiff but smooth."""
    found, position, psi = [], 0.0, start
    u = force / (load * law.a)
    starts = [t for t, _ in way] + [times[-1]]
    U = force / stiffness
    for (begin, velocity), end in zip(way, starts[1:]):
        def motion(t, y, begin=begin, velocity=velocity, U=U):
            x, u, psi = y
            scale = law.scale(psi)
            v = scale * numpy.sinh(u)
            rate = law.rate(v, psi)
            pull = stiffness * (U + velocity * (t - begin) - x)
            return [v, (pull - load * law.a * u) / (mass * scale * numpy.cosh(u)) + law.b / law.a * numpy.tanh(u) * rate, rate]
        inside = times[(times >= begin) & (times < end)]
        done = solve_ivp(motion, (begin, end), [position, u, psi], t_eval=numpy.append(inside, end), atol=1e-12, **TIGHT)
        x, u_all, psi_all = done.y
        pull = stiffness * (U + velocity * (done.t - begin) - x)
        found.append(numpy.array([x, law.scale(psi_all) * numpy.sinh(u_all), psi_all, pull])[:, :len(inside)])
        position, u, psi = done.y[:, -1]
        done_end = numpy.array([[position], [law.scale(psi) * numpy.sinh(u)], [psi], [pull[-1]]])
        U += velocity * (end - begin)
    return numpy.concatenate(found + [done_end], axis=1)
