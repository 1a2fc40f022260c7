#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Deliberate mistakes in regions, gaps, laws of contacts, programs, the machine and output by window (scenes.c): the tests
below must fail with each, and pass with none. Prints the table of README.md; the exit status is 1 where one is missed.

    validation/mistakes/scenes.py [--build build] [MISTAKE ...]
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests/end_to_end"
# mistake, in words, the test that is to see it
TABLE = (
    ("region-density", "the density of a region is that of the block", "test_regions.Regions.test_column"),
    ("region-viscosity", "so are its viscosities", "test_regions.Regions.test_column"),
    ("region-key", "a shape is looked for in the cache without its regions", "test_regions.Regions.test_reduced_and_cached"),
    ("one-law", "every contact has the scene's law", "test_friction_contacts.Contacts"),
    ("flat-floor", "radius, gap and profile are passed over", "test_gaps.Gaps.test_hertz"),
    ("flat-mesh", "the gaps that the mesh itself leaves are", "test_gaps.Gaps.test_hertz"),
    ("profile-steps", "a profile is level between its points", "test_gaps.Gaps.test_profile"),
    ("profile-name", "results know a profile by its name, not by its content", "test_gaps.Gaps.test_profile"),
    ("map-turned", "a height map is read with x and y exchanged", "test_space.Space.test_height_map"),
    ("load-stairs", "the load jumps where it should rise", "test_programs.Programs.test_rigid_block"),
    ("load-points", "steps pass over the points of a load's program", "test_programs.Programs.test_schemes_agree"),
    ("rod-way", "U is the velocity of the moment times t", "test_programs.Programs.test_rigid_block"),
    ("machine-rigid", "the spring is twice as stiff in steps", "test_machine.Machine.test_rigid_block"),
    ("machine-force", "its force is 1 % too small", "test_machine.Machine.test_rigid_block"),
    ("window-forgotten", "a checkpoint does not have the window", "test_windows.Windows.test_killed"),
    ("memory-lagged", "friction takes the state that a stage began with", "test_memory.Memory.test_velocity_steps"),
    ("memory-kept", "slip takes nothing away from what is remembered", "test_memory.Memory.test_rigid_block_that_sticks"),
    ("memory-fresh", "contacts have rested for no time when the rod begins", "test_memory.Memory.test_rigid_block_that_sticks"),
    ("memory-grows", "g_theta has the wrong sign in growth rates and certificate", "test_stability.Memory.test_nucleation_length"),
    ("memory-blind", "both leave the states out", "test_stability.Memory.test_nucleation_length"),
    ("memory-clock", "contacts remember on the slow path of `stability` as if it were the drive", "test_stability.Memory.test_runs_agree"),
    ("memory-evolution", "the slip law evolves as the ageing law does", "test_memory.Memory.test_velocity_steps"),
    ("states-start", "laws of one's own begin with twice the states of equilibrium", "test_own_memory.OwnMemory.test_frozen"),
    ("states-fresh", "and have not rested", "test_own_memory.OwnMemory.test_same_as_built_in"),
    ("states-lagged", "their friction takes the states that a stage began with", "test_own_memory.OwnMemory.test_same_as_built_in"),
    ("states-kept", "their contacts heal while they slip as they do at rest", "test_own_memory.OwnMemory.test_explicit_reference"),
    ("states-pressure", "their friction keeps the pressure that it was made with", "test_own_memory.OwnMemory.test_pressure"),
    ("states-cut", "a checkpoint has the first state of each node alone", "test_own_memory.OwnMemory.test_goes_on"),
    ("states-apart", "the rate of a state does not know the other", "test_own_stability.OwnStability.test_two_states"),
    ("states-derivative", "derivatives by the second state are left out", "test_own_stability.OwnStability.test_two_states"),
    ("states-grows", "g_theta of several states has the wrong sign in what is linearised", "test_own_stability.OwnStability.test_two_states"),
    ("states-alone", "there states do not know each other", "test_own_stability.OwnStability.test_two_states"),
    ("states-unsolved", "there (s - g_theta)^-1 is left out", "test_own_stability.OwnStability.test_two_states"),
    ("states-steady", "what `stability` lets slip remembers the start, not steady slip", "test_own_stability.OwnStability.test_two_states"),
    ("states-clock", "a law of one's own remembers on its slow path as if it were the drive",
     "test_own_stability.OwnStability.test_same_as_built_in"),
)


def failures(programs, mistake, test):
    """What of `test` fails, by name and line of the assertion; [] where all passes."""
    environment = dict(os.environ, AMONTONS_SOURCE=str(ROOT), AMONTONS_BIN=str(programs), AMONTONS_MISTAKE=mistake)
    done = subprocess.run([sys.executable, "-m", "unittest", test], cwd=TESTS, env=environment, capture_output=True, text=True)
    found = re.findall(r"^(?:FAIL|ERROR): (\w+)", done.stderr, re.M)
    if (done.returncode == 0) != (not found):
        raise SystemExit(f"{test}: {done.stderr}")
    return sorted(set(found))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("mistakes", nargs="*")
    given = parser.parse_args()
    missed, passed = 0, {}
    with tempfile.TemporaryDirectory(prefix="amontons-mistakes-") as folder:
        programs = Path(folder)
        for item in (given.build / "bin").iterdir():
            (programs / item.name).symlink_to(item.resolve())
        (programs / "amontons").unlink()
        (programs / "amontons").symlink_to(next(given.build.glob("**/amontons_mistaken")).resolve())
        print("| mistake | what is wrong | seen by |\n|---|---|---|")
        for mistake, words, test in TABLE:
            if given.mistakes and mistake not in given.mistakes:
                continue
            if test not in passed:
                passed[test] = not failures(programs, "none", test)
            found = failures(programs, mistake, test)
            seen = ", ".join(f"`{test.split('.')[0]}`: {name}" for name in found) or "**nothing**"
            missed += not found or not passed[test]
            print(f"| {mistake} | {words} | {seen}{'' if passed[test] else ' (fails without it, too)'} |", flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
