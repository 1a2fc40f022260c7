# SPDX-License-Identifier: GPL-2.0-or-later
"""Nine hundred and fifty problems of strangers: scenes over everything that a scene can say, drawn before anything was computed.

problem(number), number from 1 to COUNT, is the same whatever the machine: only random.Random, seeded with SEED and the
number, is asked. What a problem must satisfy is decided by these rules of dimensions alone, never by what the program
answers. In them L is the block's length, p the mean pressure on the part that touches, D the drop of mu, W the largest
-mu'(v), E and nu of the material on the floor, E*v = 4 g (l + g) / (l + 2 g) with g = eta1/2, l = eta2 the viscous modulus
of a half-plane.

1. Resolvable: lambda = E*v / (W p), below which viscosity outweighs weakening, is 0.08 to 1.2 of L. With the elastic length
   it decides how l_c compares with L. A mesh of 160 cells has at least 12 in it.
2. Damping: L over eta1 / sqrt(rho E) of the body, 0.03 to 3; eta2/eta1 0, or 0.1 to 10.
3. Small strains: p/E at most 0.02, mu_S p/G at most 0.04 on the floor.
4. The rod goes with 3e-4 to 0.3 of v_c, where 1/e of the weakening is spent (W v_c = D for the two built-in laws).
5. It does not tip: mu_S times the rod's height is at most 0.3 of the contact's extent. The rod's strip lies on the trailing
   face, on one material.
6. Pads are no taller than long. A gap is 0.2 to 2 times what p presses into a half-plane as long as the gap is.
7. The run is as long as loading to 1.6 mu_S and 14 drops of 0.6 D take by the compliance of block, feet, layer and machine,
   estimated.
8. A mesh has 32 to 64 cells along the contact (a pad at least 6), and its bulk is as fine or coarser.

From 601 on the draw is wider: feet of unequal height, holes, slots, and blocks and pads in space (two problems of twenty); machines of
1/100 of the block's stiffness up; damping L sqrt(rho E)/eta1 of 0.005 to 12; ramps of the load, and holds of the rod; laws with memory. For them

9. Slip distance: the length over which slip of D_c takes the drop off, G D_c/(D p), of rate-and-state G D_c/(b p), is 0.15 to 1.2 of L.
10. Time at rest: ageing's theta_0 is 0.01 to 1 of D_c/V, slip-weakening's t_h 0.01 to 0.3, so that a contact heals between two slidings.
11. Rate-and-state: b is 2 to 8 % of mu, a 0.3 to 0.9 of b; the drop D is that of slip 10^5 times as fast.
12. In space there are 8 to 14 cells along the block.

Units: E = rho = 1 and either eta1 = 1 (L follows) or L = 1 (eta1 follows); or SI, of a material from a list."""
import hashlib
import math
import random
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SEED = 36
COUNT = 950
FIRST_WIDE = 601        # from here on the draw is wider
TUNING = 850            # the first: rules have been chosen by them; the others are judged once
ELEMENTS = {"T3": ("triangle", 1, 0), "T6": ("triangle", 2, 0), "Q4": ("quad", 1, 0), "Q8": ("quad", 2, 1), "Q9": ("quad", 2, 0)}
SHAPES = ("block", "pads", "layers", "grooves", "block", "feet", "soft pads", "block", "arch", "layers",
          "pads", "block", "wedge", "feet", "block", "soft pads", "grooves", "block", "layers", "pads")   # in turn
WIDE_SHAPES = ("uneven feet", "hole", "pads", "block", "slot", "space block", "layers", "uneven feet", "grooves", "hole",
               "soft pads", "block", "feet", "slot", "space pads", "arch", "block", "wedge", "uneven feet", "pads")
LAWS = (("linear-weakening", 40), ("exponential-weakening", 20), ("table", 20), ("formula", 20))
WIDE_LAWS = (("linear-weakening", 25), ("exponential-weakening", 12), ("table", 10), ("formula", 13), ("ageing", 15),
             ("slip-weakening", 12), ("rate-and-state", 13))
DECADES = math.log(1e5)     # of slip rate, over which rate-and-state drops by (b - a) times this
MEMORY = ("ageing", "slip-weakening", "rate-and-state")
PROGRAMS, WIDE_PROGRAMS = (("", 88), ("rod", 8), ("load", 4)), (("", 68), ("rod", 8), ("ramp", 12), ("hold", 12))
SOLIDS = {"PMMA": (3e9, 0.38, 1190), "rubber": (5e6, 0.49, 1100), "gel": (3e4, 0.48, 1000), "steel": (2e11, 0.29, 7800),
          "glass": (7e10, 0.22, 2500), "brake lining": (1e9, 0.25, 2300), "cork": (2e7, 0.1, 200), "ice": (9e9, 0.33, 917)}
PRESSURE_MAX = 1e8      # Pa


@dataclass
class Solid:
    """Numbers of one material, over E, rho of the body and its length."""
    young: float
    poisson: float
    eta1: float
    eta2: float

    @property
    def shear(self):
        return self.young / (2 * (1 + self.poisson))

    @property
    def viscous(self):
        g, l = self.eta1 / 2, self.eta2
        return 4 * g * (l + g) / (l + 2 * g)


@dataclass
class Problem:
    number: int
    shape: str
    wanted: float           # error bar asked for, relative
    whole: bool             # its reference is computed on the unreduced mesh
    scene: str              # YAML; @ stands for the project's folder
    files: dict = field(default_factory=dict)     # name: text, beside the scene
    features: tuple = ()

    @property
    def tuning(self):
        return self.number <= TUNING

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in self.files.items():
            (folder / name).write_text(text)
        path = folder / f"{self.number:03d}.yaml"
        path.write_text(self.scene.replace("@", str(ROOT)))
        return path


def weighted(dice, table):
    return dice.pick(*(name for name, _ in table), weights=[weight for _, weight in table])


class Dice:
    def __init__(self, number):
        self.source = random.Random(f"amontons strangers {SEED} {number}")

    def uniform(self, low, high):
        return low + (high - low) * self.source.random()

    def log(self, low, high):
        return low * (high / low) ** self.source.random()

    def chance(self, part):
        return self.source.random() < part

    def pick(self, *choices, weights=None):
        weights = weights or (1,) * len(choices)
        at = self.source.random() * sum(weights)
        for choice, weight in zip(choices, weights):
            at -= weight
            if at < 0:
                return choice
        return choices[-1]


def number_of(value):
    return f"{value:.5g}"


def flow(entries):
    return "{" + ", ".join(f"{key}: {value}" for key, value in entries.items()) + "}"


@dataclass
class Shape:
    """What a mesh is, all lengths over L."""
    file: str
    lengths: dict           # parameters that are lengths
    others: dict            # and that are not
    top: float              # height of the block
    face: float             # lower end of the part of the trailing face that may be driven
    touching: float         # length in contact
    loaded: float = 1       # length of the top
    pads: tuple = ()        # names of the contact curves, where there are several
    region: str = ""        # surface that may have a material of its own, and lies on the floor
    region_height: float = 0

    @property
    def space(self):
        return "3d" in self.file


def element_of(dice):
    name = dice.pick(*ELEMENTS, weights=(20, 15, 40, 10, 15))
    shape, order, incomplete = ELEMENTS[name]
    return name, {"shape": shape, "order": order} | ({"incomplete": 1} if incomplete else {}), order


def block(dice, cells, order, gapped):
    height = dice.uniform(0.25, 1)
    n, element = cells // order, {}
    element["nx"], element["nz"] = n, max(4, round(n * height * dice.pick(0.5, 1)))
    if not gapped and dice.chance(0.4):
        element["grade_x"] = dice.pick(4, 8)
    if dice.chance(0.3):
        element["grade_z"] = 4
    return Shape("@/meshes/block.geo", {"length": 1, "height": height}, element, height, 0, 1)


def pads(dice, cells, order, soft=False):
    n = dice.pick(1, 2, 3, 4, 5, 6, weights=(1, 2, 3, 3, 2, 2))
    fill, ratio = dice.uniform(0.35, 0.8), 1 if n == 1 or dice.chance(0.3) else dice.log(0.4, 2.5)
    lengths = [fill * ratio ** (k / max(1, n - 1)) for k in range(n)]
    shortest = min(lengths) * fill / sum(lengths)
    height, tall = dice.uniform(0.3, 0.8), dice.uniform(0.25, 1) * min(shortest, 0.12)
    size = min(fill * order / cells, shortest * order / 6)
    ends = dice.pick("flush", "open")
    gap = (1 - fill) / n if ends == "open" or n == 1 else (1 - fill) / (n - 1)
    shape = Shape("@/meshes/pads.geo", {"length": 1, "total_height": height, "pad_height": tall, "size_contact": size,
                                        "size_bulk": dice.pick(2, 4) * size},
                  {"n": n, "fill": number_of(fill), "pad_ratio": number_of(ratio), "ends": ends}, height, tall, fill,
                  pads=tuple(f"contact_{k + 1}" for k in range(n)) if n > 1 else ())
    if dice.chance(0.4):
        shape.others["grade_contact"] = dice.pick(2, 4, 8)
    if soft:
        shape.region, shape.region_height = "pads", tall
    elif dice.chance(0.3):
        shape.lengths["fillet"] = 0.4 * min(tall, gap / 2)
    return shape


def grooves(dice, cells, order):
    count, width = dice.pick(1, 2, 3, 4), dice.uniform(0.02, 0.08)
    floor, depth, height = width * dice.pick(0.6, 1, 0.6), width * dice.uniform(0.4, 1.2), dice.uniform(0.3, 0.8)
    touching = 1 - count * width
    size = min(touching * order / cells, floor, touching / (count + 1) * order / 8)
    shape = Shape("@/meshes/grooves.geo", {"length": 1, "height": height, "width": width, "floor": floor, "depth": depth,
                                           "size_contact": size, "size_bulk": dice.pick(2, 4) * size},
                  {"grooves": count}, height, 0, touching, pads=tuple(f"contact_{k + 1}" for k in range(count + 1)))
    if dice.chance(0.4):
        shape.others["grade_contact"] = dice.pick(2, 4, 8)
    return shape


def layers(dice, cells, order):
    height, n = dice.uniform(0.3, 0.9), cells // order
    layer = height * dice.log(0.04, 0.4)
    return Shape("@/meshes/layers.geo", {"length": 1, "height": height, "layer": layer},
                 {"nx": n, "nz": max(3, round((height - layer) * n * dice.pick(0.5, 1))), "nz_layer": max(2, round(layer * n))},
                 height, layer, 1, region="layer", region_height=layer)


def arch(dice, cells, order):
    foot = dice.uniform(0.15, 0.4)
    return Shape("@/docs/examples/arch.geo", {}, {"foot": number_of(foot), "rise": number_of(dice.uniform(0.05, 0.35)),
                                                 "size": number_of(2 * foot / cells)},
                 0.5, 0.05, 2 * foot, pads=("contact_1", "contact_2"))


def wedge(dice, cells, order):
    height, back, front = dice.uniform(0.3, 0.8), dice.uniform(-0.2, 0.25), dice.uniform(-0.2, 0.25)
    return Shape("@/validation/strangers/wedge.geo", {"length": 1, "height": height, "back": back, "front": front,
                                                      "size": order / min(cells, 40)}, {}, height, 0, 1, loaded=1 - back - front)


def feet(dice, cells, order):
    first, second = dice.uniform(0.15, 0.4), dice.uniform(0.15, 0.4)
    leg, slant, inset = dice.uniform(0.05, 0.15), dice.uniform(-0.02, 0.04), dice.uniform(0.04, 0.08)
    height = dice.uniform(0.3, 0.7)
    return Shape("@/validation/strangers/feet.geo", {"length": 1, "height": height, "leg": leg, "first": first, "second": second,
                                                     "inset": inset, "slant": slant, "size": (first + second) * order / cells},
                 {}, height + leg, leg, first + second, pads=("contact_1", "contact_2"), region="soles", region_height=leg / 2)


def uneven_feet(dice, cells, order):
    first, second, inset = dice.uniform(0.15, 0.4), dice.uniform(0.15, 0.4), dice.uniform(0.03, 0.08)
    height, touching = dice.uniform(0.35, 0.8), first + second
    legs = {name: dice.uniform(0.05, 0.15) * dice.pick(1, 1.5) for name in ("leg_first", "leg_second")}
    room = 1 - 2 * inset - touching
    return Shape("@/validation/strangers/uneven.geo",
                  {"length": 1, "height": height, **legs, "first": first, "second": second, "inset": inset,
                   "step": inset + first + dice.uniform(0.3, 0.7) * room, "size": touching * order / cells},
                  {}, height, legs["leg_first"], touching, pads=("contact_1", "contact_2"))


def cut(dice, cells, order, slot):
    """A block with a hole or a slot."""
    height = dice.uniform(0.35, 1)
    lengths, kind = {"length": 1, "height": height, "size": order / cells}, dice.pick("top", "leading") if slot else "hole"
    shape = Shape("@/validation/strangers/cut.geo", lengths, {"cut": kind}, height, 0, 1)
    if kind == "hole":
        radius = dice.uniform(0.08, 0.3) * height
        lengths |= {"radius": radius, "x": dice.uniform(0.15 + radius, 0.9 - radius),
                    "z": dice.uniform(1.3 * radius, height - 1.3 * radius)}
    else:
        width = dice.uniform(0.02, 0.08)
        deep = dice.uniform(0.2, 0.7) * (height if kind == "top" else 0.6)
        lengths |= {"width": width, "depth": deep, "x": dice.uniform(0.2, 0.8), "z": dice.uniform(0.3, 0.7) * height}
        shape.loaded = 1 - width if kind == "top" else 1
    return shape


def space_block(dice, order):
    breadth, height, n = dice.uniform(0.3, 1), dice.uniform(0.3, 0.7), max(4, dice.pick(8, 10, 12, 14) // order)
    shape = Shape("@/meshes/block3d.geo", {"length": 1, "breadth": breadth, "height": height},
                  {"nx": n, "ny": max(3, round(n * breadth)), "nz": max(3, round(n * height * dice.pick(0.6, 1)))}, height, 0, 1)
    if dice.chance(0.4):
        shape.others["grade_x"] = dice.pick(2, 4)
    return shape


def space_pads(dice, order):
    n, m = dice.pick(2, 3), dice.pick(1, 2)
    fill_x, fill_y, breadth, body = dice.uniform(0.4, 0.75), dice.uniform(0.5, 0.8), dice.uniform(0.4, 0.8), dice.uniform(0.25, 0.5)
    tall = dice.uniform(0.3, 1) * min(fill_x / n, breadth * fill_y / m, 0.1)
    shape = Shape("@/meshes/pads3d.geo", {"length": 1, "breadth": breadth, "height": body, "pad_height": tall},
                  {"n": n, "m": m, "fill_x": number_of(fill_x), "fill_y": number_of(fill_y), "cells_x": max(2, 4 // order),
                   "cells_y": max(2, 4 // order), "nz": 4}, body + tall, tall, fill_x * fill_y,
                  pads=tuple(f"contact_{k + 1}" for k in range(n * m)))
    if dice.chance(0.5):
        shape.region, shape.region_height = "pads", tall
    return shape


def space_element(dice):
    name = dice.pick("HEX8", "WEDGE6", "HEX27", weights=(65, 25, 10))
    return name, {"shape": "wedge" if name == "WEDGE6" else "hex", "order": 2 if name == "HEX27" else 1}, 2 if name == "HEX27" else 1


def memory_law(dice, name, strength, speeds, softness):
    """Lines of `friction`, over the scales of the block. strength: (mu_S, mu_K, b); speeds: (v_c, V); softness: p/G."""
    (static, kinetic, b), (v_c, drive) = strength, speeds
    lines = {"law": name}
    if name == "rate-and-state":
        a = b - (static - kinetic) / DECADES
        slip = dice.log(0.15, 1.2) * b * softness
        lines |= {"direct_effect": a, "evolution_effect": b, "mu_reference": static, "reference_velocity": drive * dice.log(0.1, 10),
                  "slip_distance": slip}
        once = slip / drive
    else:
        slip = dice.log(0.15, 1.2) * (static - kinetic) * softness
        once = slip / drive * (dice.log(0.01, 1) if name == "ageing" else dice.log(0.01, 0.3))
        lines |= {"mu_static": static, "mu_kinetic": kinetic, "slip_distance": slip, "healing_time": once}
        if name == "ageing":
            lines |= {"critical_velocity": v_c, "healing": dice.uniform(0.01, 0.06)}
    if dice.chance(0.4):
        lines["rest"] = once * dice.log(1, 1000)
    if name == "rate-and-state" and dice.chance(0.3):
        lines["evolution"] = "slip"
    return lines


def law_of(dice, name, static, kinetic, v_c):
    """Lines of `friction`; v_c is scaled so that the largest -mu' is that of the linear law, (static - kinetic) / v_c."""
    drop = static - kinetic
    if name in ("linear-weakening", "exponential-weakening"):
        return {"law": name, "mu_static": number_of(static), "mu_kinetic": number_of(kinetic), "critical_velocity": number_of(v_c)}
    rise = dice.pick(0, dice.uniform(0.02, 0.1)) * drop      # strengthening branch: so much a factor e of velocity
    if name == "formula":
        body = dice.pick(f"exp(-v / {number_of(v_c)})", f"1 / (1 + v / {number_of(v_c)})")
        branch = f" + {number_of(rise)} * log(1 + v / {number_of(5 * v_c)})" if rise else ""
        top = 5 * v_c * math.expm1(min(0.8 * drop / rise, math.log(400))) if rise else 2000 * v_c
        return {"law": name, "formula": f'"{number_of(kinetic)} + {number_of(drop)} * {body}{branch}"',
                "velocity_max": number_of(top)}
    velocity = [0] + [v_c * 0.15 * 2**k * dice.uniform(0.9, 1.1) for k in range(9)]
    spread = [1 / (1 + (v / v_c) ** 2) if v < 0.3 * v_c else math.exp(-(v - 0.3 * v_c) / v_c) / 1.09 for v in velocity]
    mu = [kinetic + drop * part + rise * math.log1p(v / (5 * v_c)) for v, part in zip(velocity, spread)]
    steepest = max(-(mu[k + 1] - mu[k]) / (velocity[k + 1] - velocity[k]) for k in range(9))
    stretch = steepest * v_c / drop
    lines = {"law": "table", "velocity": "[" + ", ".join(number_of(v * stretch) for v in velocity) + "]",
             "mu": "[" + ", ".join(number_of(min(m, static)) for m in mu) + "]"}
    return lines | ({"interpolation": "linear"} if dice.chance(0.3) else {})


def along_of(dice, length):
    """A formula of x whose largest value is 1."""
    points = sorted(dice.uniform(0.05, 0.95) for _ in range(dice.pick(2, 3, 4)))
    factors = [dice.uniform(0.4, 1) for _ in points]
    factors[dice.pick(*range(len(points)))] = 1
    return '"points(x, ' + ", ".join(f"{number_of(x * length)}, {number_of(f)}" for x, f in zip(points, factors)) + ')"'


def gap_of(dice, kind, shape, pressure, floor, strain, length):
    """(entry of `contact`, pressure over the part that still touches, files)."""
    stiff = floor.young / (1 - floor.poisson**2) if strain else floor.young
    if kind == "radius":
        half = dice.uniform(0.3, 0.48)
        middle, radius = float(number_of(length)) / 2, number_of(length * half**2 * math.pi * stiff / (4 * pressure))
        return {"gap": f'"(x - {middle:g})^2 / (2 * {radius})"'}, pressure / (2 * half) * 4 / math.pi, {}
    if kind == "edges":
        wide = dice.uniform(0.05, 0.3)
        high = dice.uniform(0.2, 2) * pressure * wide / stiff
        where = dice.pick("x", f"{number_of(length)} - x", f"min(x, {number_of(length)} - x)")
        factor, wide = number_of(high / wide**2 / length), number_of(wide * length)
        return {"gap": f'"{factor} * max(0, {wide} - {where})^2"'}, pressure * 1.2, {}
    count = dice.pick(8, 11, 16)
    high = [dice.uniform(0, 1) for _ in range(count + 1)]
    least = min(high)
    scale = dice.uniform(0.2, 1) * pressure / count / stiff
    rows = [(length * k / count, length * scale * (h - least)) for k, h in enumerate(high)]
    if kind == "profile":
        return {"profile": "@profile"}, pressure * 1.2, {"@profile": "".join(f"{x:.9g}, {h:.6g}\n" for x, h in rows)}
    return {"gap": '"points(x, ' + ", ".join(f"{number_of(x)}, {number_of(h)}" for x, h in rows) + ')"'}, pressure * 1.2, {}


def program_of(dice, kind, loading):
    """loading: time in which the load comes to mu_S. The load's program ends before the first slidings do, a ramp during them."""
    if kind == "ramp":
        return {"t": f"[0, {number_of(0.2 * loading)}, {number_of(dice.uniform(0.7, 2.5) * loading)}]",
                "factor": f"[1, 1, {number_of(dice.uniform(0.7, 1.4))}]"}
    if kind == "hold":
        moved, held = dice.uniform(0.6, 2.5) * loading, dice.log(0.1, 2) * loading
        if dice.chance(0.5):
            times, factors, more = (0, moved, moved, moved + held), "[1, 1, 0, 0]", {"repeat": "true"}
        else:
            times, factors, more = (0, moved, moved, moved + held, moved + held), "[1, 1, 0, 0, 1]", {}
        return {"t": "[" + ", ".join(map(number_of, times)) + "]", "factor": factors} | more
    if kind == "load":
        return {"t": f"[0, {number_of(0.2 * loading)}, {number_of(0.7 * loading)}]",
                "factor": f"[1, 1, {number_of(dice.uniform(0.7, 1.4))}]"}
    rest = dice.pick(0, 0.2, 0.5)
    times = [0, 0.9 * loading, 0.9 * loading, 1.2 * loading]
    return {"t": "[" + ", ".join(map(number_of, times)) + "]", "factor": f"[1, 1, {rest}, {rest}]", "repeat": "true"}


def shape_of(dice, kind, cells, order, gap):
    if kind.startswith("space"):
        return space_block(dice, order) if kind == "space block" else space_pads(dice, order)
    if kind in ("hole", "slot"):
        return cut(dice, cells, order, kind == "slot")
    if kind == "uneven feet":
        return uneven_feet(dice, cells, order)
    if kind == "block":
        return block(dice, cells, order, bool(gap))
    if kind in ("pads", "soft pads"):
        return pads(dice, cells, order, kind == "soft pads")
    return {"grooves": grooves, "layers": layers, "arch": arch, "wedge": wedge, "feet": feet}[kind](dice, cells, order)


def region_of(dice, shape, body, strain):
    """The material on the floor: the region's, or the body's."""
    if not shape.region or shape.region == "soles" and dice.chance(0.5):
        return body
    young = dice.log(0.01, 5) if shape.region == "layer" else dice.log(0.05, 2)
    eta1 = body.eta1 * young * dice.log(0.3, 3)
    return Solid(young, dice.uniform(0.1, 0.49), eta1, eta1 * (0 if dice.chance(0.15) else dice.log(0.1, 10)))


def rod_of(dice, shape, static):
    """(height, width) of the strip, over L."""
    room = shape.top - shape.face
    width = room * dice.uniform(0.05, 0.2)
    at = dice.pick(dice.uniform(0.1, 0.25), dice.uniform(0.4, 0.6), dice.uniform(0.75, 0.9), weights=(3, 4, 3))
    height = min(shape.face + at * room, max(0.3 / static, shape.face + 0.1 * room))
    return max(shape.face + 0.55 * width, min(height, shape.top - 0.55 * width)), width


def friction_of(dice, shape, lines, static, kinetic, length):
    """Adds to the lines of the law what differs by pad or along the contact. (lines, what is in it)"""
    name, marks = lines["law"], []
    if shape.pads and dice.chance(0.4):
        which = [pad for pad in shape.pads if dice.chance(0.5)] or [shape.pads[0]]
        entries = []
        for pad in which:
            if name.endswith("weakening"):
                less = dice.uniform(0.5, 0.95)
                entries.append(f"{{group: {pad}, mu_static: {number_of(static * less)}, mu_kinetic: {number_of(kinetic * less)}}}")
            else:
                entries.append(f'{{group: {pad}, along: "{number_of(dice.uniform(0.5, 0.95))}"}}')
        lines["contacts"] = "[" + ", ".join(entries) + "]"
        marks.append("by pad")
    elif not shape.pads and dice.chance(0.3):
        lines["along"] = along_of(dice, length)
        marks.append("along")
    return lines, marks


def is_whole(number):
    """One in ten; of the wider ones of each shape in turn."""
    return (number if number < FIRST_WIDE else number + number // 10) % 10 == 7


def problem(number):
    dice = Dice(number)
    wider = number >= FIRST_WIDE
    kind, strain, si = (WIDE_SHAPES if wider else SHAPES)[(number - 1) % len(SHAPES)], dice.chance(0.5), dice.chance(0.3)
    element, words, order = space_element(dice) if kind.startswith("space") else element_of(dice)
    gap = dice.pick("", "radius", "edges", "points", "profile", "crown", "edge_radius",
                    weights=(60, 8, 12, 5, 7, 5, 3)) if kind == "block" else ""
    shape = shape_of(dice, kind, dice.pick(32, 40, 48, 64), order, gap)
    damping = dice.log(0.005, 12) if wider else dice.log(0.03, 3)
    poisson = SOLIDS[solid_name][1] if si and (solid_name := dice.pick(*SOLIDS)) else dice.uniform(0.1, 0.49)
    body = Solid(1, poisson, 1 / damping, (0 if dice.chance(0.15) else dice.log(0.1, 10)) / damping)
    floor = region_of(dice, shape, body, strain)
    static = dice.log(0.2, 1.3)
    kinetic, name, effect = static * dice.uniform(0.1, 0.8), weighted(dice, WIDE_LAWS if wider else LAWS), 0
    if name == "rate-and-state":
        effect = dice.uniform(0.02, 0.08) * static
        kinetic = static - effect * dice.uniform(0.1, 0.7) * DECADES
    highest = min(0.02 * floor.young, 0.04 * floor.shear / static) * shape.touching / shape.loaded
    if si:
        highest = min(highest, PRESSURE_MAX / SOLIDS[solid_name][0])
    pressure = dice.log(highest / 300, highest) if not gap else dice.log(highest / 300, highest / 3)
    pressing = pressure * shape.loaded / shape.touching

    # scales: length, stress, density; the rest follows
    if si:
        young, density, length = SOLIDS[solid_name][0], SOLIDS[solid_name][2], dice.log(5e-3, 0.5)
    else:
        young, density, length = 1, 1, damping if dice.chance(0.6) else 1
    if kind == "arch":
        length = 1
    velocity = math.sqrt(young / density)
    viscosity = young * length / velocity

    contact, files = {}, {}
    if gap in ("crown", "edge_radius"):
        stiff = floor.young / (1 - poisson**2) if strain else floor.young
        if gap == "crown":
            half = dice.uniform(0.3, 0.48)
            shape.lengths["crown"] = pressure / (2 * math.pi * stiff * half**2)
            pressing *= 2 / (math.pi * half)
        else:
            wide = dice.uniform(0.1, 0.3)
            shape.lengths["edge_length"], shape.lengths["edge_radius"] = wide, wide * stiff / (2 * dice.uniform(0.2, 2) * pressure)
            pressing *= 1.2
    elif gap:
        contact, pressing, files = gap_of(dice, gap, shape, pressure, floor, strain, length)
    if kind == "feet" and dice.chance(0.4):
        longest = max(shape.lengths["first"], shape.lengths["second"])
        shape.lengths["crown"] = dice.uniform(0.2, 1) * pressing * longest / 4 / floor.young
        pressing *= 1.3
        gap = "crown"
    if kind == "uneven feet" and dice.chance(0.4):
        tall = max(shape.lengths["leg_first"], shape.lengths["leg_second"])
        shape.lengths[dice.pick("lift_first", "lift_second")] = dice.uniform(0.1, 0.8) * pressing * tall / floor.young
        gap = "lifted"

    slipping = dice.log(0.08, 1.2)
    v_c = (static - kinetic) * pressing * slipping / floor.viscous
    drive = v_c * dice.log(3e-4, 0.3)
    if name in MEMORY:
        scales = {"slip_distance": length, "healing_time": length / velocity, "rest": length / velocity,
                  "critical_velocity": velocity, "reference_velocity": velocity}
        lines = memory_law(dice, name, (static, kinetic, effect), (v_c, drive), pressing / floor.shear)
        lines = {key: value if isinstance(value, str) else number_of(value * scales.get(key, 1)) for key, value in lines.items()}
    else:
        lines = law_of(dice, name, static, kinetic, v_c * velocity)
    friction, marks = friction_of(dice, shape, lines, static, kinetic, length)

    height, width = rod_of(dice, shape, static)
    stiff = 1 / (1 - poisson**2) if strain else 1
    yields = 2 * math.log(2 * shape.top / width) / (math.pi * stiff) + 1 / (2 * stiff * shape.top)
    legs = shape.face - shape.region_height
    yields += shape.region_height / (floor.shear * shape.touching) + 2 * legs / (body.shear * shape.touching)
    rod = {"velocity": None, "height": number_of(height * length), "width": number_of(width * length)}
    if dice.chance(0.3):
        rod["kind"] = "bonded"
        marks.append("bonded")
    if dice.chance(0.4 if wider else 0.25):
        spring = dice.log(0.01 if wider else 0.05, 10) / yields
        rod["stiffness"] = number_of(spring * young)
        yields += 1 / spring
        marks.append("machine")
    rod["velocity"] = number_of(drive * velocity)
    load = pressure * shape.loaded
    until = (1.6 * static + 14 * 0.6 * (static - kinetic)) * load * yields

    program = weighted(dice, WIDE_PROGRAMS if wider else PROGRAMS)
    loads = {"pressure": number_of(pressure * young)}
    if si and dice.chance(0.5):
        loads["pressure"] = number_of(pressure * young / 1e3) + " kPa"
        rod["velocity"] = number_of(drive * velocity * 1e6) + " um/s"
    if program:
        text = flow(program_of(dice, program, static * load * yields / drive * length / velocity))
        (rod if program in ("rod", "hold") else loads)["program"] = text
        marks.append({"ramp": "ramp of the load", "hold": "holds of the rod"}.get(program, f"program of the {program}"))

    settings = {key: number_of(value * length) for key, value in shape.lengths.items()} | shape.others | (words if kind != "arch" else {})
    if kind == "wedge" or kind == "layers":
        settings.pop("incomplete", None)
    material = {"young": number_of(young), "poisson": number_of(body.poisson), "density": number_of(density),
                "eta1": number_of(body.eta1 * viscosity), "eta2": number_of(body.eta2 * viscosity),
                "plane": "strain" if strain else "stress"}
    if shape.space:
        del material["plane"]
    lines = [f"title: Stranger {number}, {kind}", f"units: {'si' if si else 'normalised'}",
             f"mesh: {{file: {shape.file}, set: {flow(settings)}}}", f"material: {flow(material)}"]
    if floor is not body:
        lines.append(f"materials: {{{shape.region}: " + flow(
            {"young": number_of(floor.young * young), "poisson": number_of(floor.poisson),
             "eta1": number_of(floor.eta1 * viscosity), "eta2": number_of(floor.eta2 * viscosity)}) + "}")
        marks.append(f"{shape.region} of E {floor.young:.2g}")
    lines += [f"friction: {flow(friction)}"]
    if contact:
        lines.append(f"contact: {flow(contact)}".replace("@profile", f"{number:03d}.csv"))
        files = {f"{number:03d}.csv": text for text in files.values()}
    lines += [f"load: {flow(loads)}", f"rod: {flow(rod)}", f"time: {{until: {{U: {number_of(until * length)}}}}}", ""]
    features = ("T3" if kind == "arch" else element.replace("Q8", "Q9").replace("Q9", "Q9" if "incomplete" not in settings else "Q8"),
                "space" if shape.space else "strain" if strain else "stress", "SI" if si else "normalised", name, *([gap] if gap else []), *marks)
    return Problem(number, kind, (0.01, 0.02, 0.03)[number % 3], is_whole(number), "\n".join(lines), files, features)


def problems():
    return [problem(number) for number in range(1, COUNT + 1)]


def digest(some):
    """Of all that the problems are."""
    text = repr([(one.number, one.wanted, one.whole, one.scene, sorted(one.files.items())) for one in some])
    return hashlib.sha256(text.encode()).hexdigest()
