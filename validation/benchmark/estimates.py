# SPDX-License-Identifier: GPL-2.0-or-later
"""Rules that make an error bar of mu_M from its values on meshes whose cells are halved each time, the coarsest first;
and how one judges them. Used by estimators.py."""
import math
import statistics
from dataclasses import dataclass

import numpy

# P. J. Roache, Annu. Rev. Fluid Mech. 29 (1997) 123: 1.25 where three meshes show an order, 3 where two do not.
SAFETY, SAFETY_BLIND = 1.25, 3
ORDERS = (0.5, 2)      # an observed order is taken to lie between these, as is usual; quads of order 1 have 2
ORDER_BLIND = 1        # of mu here (precision.md)
# The program's own rule, src/answers/error_bars.c.
SLOPE, SCATTER, SCATTER_LEVELS, STEPS = 0.5, 0.12, 4, 0.002
STUDENT = {4: 2.78, 5: 2.57}      # by degrees of freedom
SURE = 0.95


def difference(values):
    return abs(values[-1] - values[-2])


def observed_order(values):
    """From three meshes; None: differences grow, or change their sign."""
    first, second = values[-2] - values[-3], values[-1] - values[-2]
    return math.log2(first / second) if first * second > 0 and abs(first) > abs(second) else None


def convergence_index(values):
    """Roache's grid convergence index; None: no order is observed."""
    order = observed_order(values)
    if order is None:
        return None
    return SAFETY * difference(values) / (2 ** min(max(order, ORDERS[0]), ORDERS[1]) - 1)


def convergence_index_or_blind(values):
    found = convergence_index(values)
    return SAFETY_BLIND * difference(values) / (2**ORDER_BLIND - 1) if found is None else found


def fitted_line(values, nodes):
    """Line and scatter, of the mesh part of the program's bar. nodes: in contact, of each mesh."""
    size = nodes[-1] / numpy.array(nodes)
    slope, start = numpy.polyfit(size, values, 1, w=1 / size)
    residual = (((values - start - slope * size) / size) ** 2).sum()
    freedoms = len(nodes) - 2 + SCATTER_LEVELS
    scatter = math.sqrt((residual + SCATTER_LEVELS * (SCATTER / nodes[-1] * values[-1]) ** 2) / freedoms)
    return max(math.hypot(SLOPE * slope, STUDENT[freedoms] * scatter), STEPS * values[-1])


@dataclass(frozen=True)
class Answer:
    """Of one case, over the reference."""
    error: float       # signed
    bar: float         # half its width; None: the rule has none
    seconds: float     # processor time of all runs that went into it


def ranks(values):
    return numpy.argsort(numpy.argsort(values))


def rank_correlation(x, y):
    """Spearman's; 1: what is larger in x is larger in y."""
    return float(numpy.corrcoef(ranks(x), ranks(y))[0, 1])


@dataclass(frozen=True)
class Verdict:
    """Over all cases in which the rule has a bar."""
    held: int
    count: int
    worst: float           # error, in bars
    median: float          # error, in bars
    bar: float             # median
    seconds: float         # median
    factor: float          # bars would have to be so many times as wide that 19 of 20 hold
    correlation: float     # of ranks, bar with error; NaN: bars are all the same


def verdict_of(answers):
    own = [one for one in answers if one.bar is not None]
    errors, bars = [abs(one.error) for one in own], [one.bar for one in own]
    ratios = [error / bar for error, bar in zip(errors, bars)]
    same = len(set(bars)) < 2
    return Verdict(held=sum(ratio <= 1 for ratio in ratios), count=len(own), worst=max(ratios),
                   median=statistics.median(ratios), bar=statistics.median(bars),
                   seconds=statistics.median(one.seconds for one in own),
                   factor=float(numpy.quantile(ratios, SURE)),
                   correlation=math.nan if same else rank_correlation(bars, errors))
