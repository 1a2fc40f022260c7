# SPDX-License-Identifier: GPL-2.0-or-later
"""What a stored history says of the interface: profiles, and what the load at a peak is made of."""
import h5py
import numpy as np

LEADING = 2


def same(a, b):
    return abs(a - b) <= 1e-9 * abs(b)


class History:
    def __init__(self, folder):
        with h5py.File(folder / "history.h5") as file:
            read = lambda name: np.asarray(file[name][:], float)  # noqa: E731
            self.U, self.mu, self.front = read("series/rod_displacement"), read("series/mu"), read("series/front")
            self.x, self.weight = read("nodes/x"), read("nodes/weight")
            self.pressure, self.shear = read("interface/pressure"), read("interface/shear")
            self.kind = read("events/kind")
            self.start, self.stop, self.reach = read("events/U_start"), read("events/U_stop"), read("events/reach")
            self.length, self.load = file.attrs["length"], file.attrs["normal_force"]
            self.P, self.mu_static = file.attrs["pressure"], file.attrs["mu_static"]
            self.mu_kinetic = file.attrs["mu_kinetic"]

    def cycles(self):
        """(first row after a sliding has stopped, row of the peak before the next one)."""
        slidings = np.flatnonzero(self.kind == LEADING)
        out = []
        for before, after in zip(slidings[:-1], slidings[1:]):
            rows = np.flatnonzero((self.U > self.stop[before]) & (self.U <= self.start[after]))
            if len(rows) > 2:
                out.append((rows[0], rows[np.argmax(self.mu[rows])]))
        return out

    def ratio(self, row):
        """tau / p at the nodes; nan where open."""
        p = self.pressure[row]
        return np.where(p > 1e-9 * self.P, self.shear[row] / np.where(p > 0, p, 1), np.nan)

    def split(self, row, front):
        """Part of the load up to `front`, and mean tau/p (by load) before and beyond it."""
        normal, shear = self.pressure[row] * self.weight, self.shear[row] * self.weight
        behind = self.x <= front + 1e-9 * self.length
        part = normal[behind].sum() / normal.sum()
        mean = lambda mask: shear[mask].sum() / normal[mask].sum() if normal[mask].sum() > 0 else np.nan  # noqa: E731
        return part, mean(behind), mean(~behind)


def peak_made_of(history):
    """The last peak's mu as load times friction, and its distance from the paper's line:

    mu = f r_b + (1 - f) r_a,   mu - line = (r_b - mu_S) f + (r_a - mu_K) (1 - f) + (mu_S - mu_K) (f - l/L)

    with f the part of the load behind the front l, r_b and r_a mean tau/p behind and ahead of it.
    """
    first, peak = history.cycles()[-1]
    front = history.front[peak]
    f, behind, ahead = history.split(peak, front)
    left = history.split(first, front)[2]         # ahead of l, when sliding had just stopped
    drop = history.mu_static - history.mu_kinetic
    nan_to = lambda value: 0.0 if np.isnan(value) else value  # noqa: E731
    return {
        "mu": history.mu[peak], "l": front / history.length, "f": f, "behind": behind, "ahead": ahead, "left": left,
        "line": history.mu_kinetic + drop * front / history.length,
        "by_behind": nan_to((behind - history.mu_static) * f),
        "by_left": nan_to((left - history.mu_kinetic) * (1 - f)),
        "by_carried": nan_to((ahead - left) * (1 - f)),
        "by_load": drop * (f - front / history.length),
    }
