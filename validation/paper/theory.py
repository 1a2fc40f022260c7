# SPDX-License-Identifier: GPL-2.0-or-later
"""The paper's 1D theory in closed form (supplement), for thin lines; `amontons model1d` has all of it."""
import math

ALPHA, ASPECT = 0.2, 0.5          # the paper's fit; H / L


class Material:
    def __init__(self, name, poisson, mu_static, mu_kinetic, critical_velocity):
        self.name, self.poisson = name, poisson
        self.mu_static, self.mu_kinetic = mu_static, mu_kinetic
        self.critical_velocity = critical_velocity
        self.eta_t = 2.0          # eta1 + eta2
        self.E1 = 1 / ((1 + poisson) * (1 - poisson))
        self.E2 = 1 / (2 * (1 + poisson))

    def pressure(self, length, part):
        """P at which the critical length is `part` of `length`."""
        k = math.pi / (2 * part)
        prefactor = math.pi**2 / (math.pi**2 - 4) * self.critical_velocity * ALPHA * ASPECT \
            / ((self.mu_static - self.mu_kinetic) * part * length)
        stiff = 1 / (ALPHA * ASPECT**2)
        return prefactor * (self.eta_t * k**2 + stiff
                            + 2 * length * math.sqrt(self.E1 * k**2 + 2 * self.E2 * stiff))

    def line(self, part):
        """mu_M at the critical length `part`, over L."""
        return self.mu_kinetic + (self.mu_static - self.mu_kinetic) * min(part, 1)

    def critical_part(self, length, pressure):
        """l_c / L, by bisection in its logarithm; may lie beyond 1."""
        low, high = 1e-6, 1e6     # P falls with l_c
        for _ in range(200):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if self.pressure(length, middle) > pressure else (low, middle)
        return math.sqrt(low * high)

    def mu(self, length, pressure):
        return self.line(self.critical_part(length, pressure))


A = Material("A", 0.34, 0.38, 0.1, 3.4e-4)
B = Material("B", 0.4, 1.2, 0.2, 3.9e-7)
