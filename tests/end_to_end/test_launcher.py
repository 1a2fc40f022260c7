# SPDX-License-Identifier: GPL-2.0-or-later
"""The launcher ./amontons, in a project of its own whose apt-get, dpkg-query, cmake and ctest note
how they are called and act as each test says. (The real ones are used by whoever runs ./amontons
test on a fresh Debian.)"""
import os
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
NOBODY = 65534

# One script under many names. CALLS: the file that notes each call; the rest by environment.
TOOL = r"""#!/bin/bash
printf '%s\n' "$(basename "$0") $*" >>"$CALLS"
case $(basename "$0") in
dpkg-query)
    shift 2
    for name; do
        if [[ " ${MISSING-} " != *" $name "* ]]; then echo "installed $name"
        elif [[ $name == cmake ]]; then echo "config-files $name"   # removed, not purged
        fi
    done ;;
apt-get)
    printf 'env %s %s\n' "${DEBIAN_FRONTEND-}" "${LC_ALL-}" >>"$CALLS"
    if [[ -n ${APT_SAYS-} && $* == *install* ]]; then echo "$APT_SAYS"; exit 100; fi ;;
apt-cache)
    [[ " ${OFFERED-} " == *" $2 "* ]] || exit 100 ;;
sudo)
    [[ -n ${SUDO_SAYS-} ]] && { echo "sudo: $SUDO_SAYS" >&2; exit 1; }
    exec "$@" ;;
cmake)
    if [[ $1 == --build ]]; then
        [[ -n ${BUILD_SAYS-} ]] && { echo "$BUILD_SAYS"; exit 1; }
        [[ -n ${BUILD_EDITS-} ]] && touch "$BUILD_EDITS"
        mkdir -p "$2/bin"
        printf '#!/bin/bash\nprintf "[%%s]" "$@"; pwd; exit ${PROGRAM_STATUS-0}\n' \
            >"$2/bin/amontons"
        chmod +x "$2/bin/amontons"
    else
        mkdir -p "$4/build"
        touch "$4/build/build.ninja"
        printf 'CMAKE_HOME_DIRECTORY:INTERNAL=%s\n%s\n' "$4" \
            "$(tr ' ' '\n' <<<"$*" | sed -n 's/^-D\(BUILD_TESTING\)=/\1:BOOL=/p')" \
            >"$4/build/CMakeCache.txt"
    fi ;;
ctest)
    echo "in $PWD: 100% tests passed, 0 tests failed out of 7"
    exit "${CTEST_STATUS-0}" ;;
esac
"""
TOOLS = ["dpkg-query", "apt-cache", "apt-get", "sudo", "cmake", "ctest"]


def packages(kind):
    """The list `kind`_packages of the launcher."""
    text = (SOURCE / "amontons").read_text()
    return shlex.split(re.search(rf"^{kind}_packages=\((.*?)\)", text, re.M | re.S)[1])


class Project(unittest.TestCase):
    """A copy of the launcher in "a project", and the tools."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="amontons launcher "))
        self.addCleanup(shutil.rmtree, self.folder)
        self.root = self.folder / "a project"
        self.tools = self.folder / "tools"
        self.calls_file = self.folder / "calls"
        self.root.mkdir()
        self.tools.mkdir()
        self.calls_file.touch()
        shutil.copy(SOURCE / "amontons", self.root)
        for name in ("CMakeLists.txt", "CMakePresets.json", "src/run/a.c", "render/canvas/canvas.c"):
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (self.root / name).touch()
        (self.tools / "tool").write_text(TOOL)
        (self.tools / "tool").chmod(0o755)
        for name in TOOLS:
            (self.tools / name).symlink_to("tool")
        for path in (self.folder, self.root, self.calls_file):
            path.chmod(0o777)
        self.path = f"{self.tools}:/usr/bin:/bin"

    def run_launcher(self, *arguments, cwd=None, script=None, user=None, **environment):
        self.calls_file.write_text("")
        return subprocess.run(
            [script or self.root / "amontons", *arguments], cwd=cwd or self.root, text=True,
            capture_output=True, user=user, timeout=60,
            env={"PATH": self.path, "CALLS": str(self.calls_file), **environment})

    def run_as_user(self, *arguments, **environment):
        user = NOBODY if os.geteuid() == 0 else None
        return self.run_launcher(*arguments, user=user, **environment)

    def run_as_root(self, *arguments, **environment):
        """... whom an ordinary user plays in a name space of his own, where he may have one."""
        if os.geteuid() == 0:
            return self.run_launcher(*arguments, **environment)
        if subprocess.run(["unshare", "--map-root-user", "true"], capture_output=True).returncode:
            self.skipTest("neither root nor a user name space")
        return self.run_launcher("--map-root-user", self.root / "amontons", *arguments,
                                 script="unshare", **environment)

    def calls(self, name=""):
        return [c for c in self.calls_file.read_text().splitlines() if c.startswith(name)]

    def without(self, *names):
        """A PATH that has what the launcher uses, but not the tools called `names`."""
        bare = self.folder / "bare"
        bare.mkdir()
        for name in ["bash", "basename", "cat", "chmod", "cp", "env", "find", "flock", "grep", "mkdir",
                     "mv", "pwd", "readlink", "rm", "sed", "tail", "touch", "tr", *TOOLS]:
            if name not in names:
                (bare / name).symlink_to(
                    self.tools / "tool" if name in TOOLS else shutil.which(name))
        self.path = str(bare)


class PassThrough(Project):
    def setUp(self):
        super().setUp()
        self.run_launcher("demo")

    def test_arguments_status_folder(self):
        done = self.run_launcher("run", "a b.yaml", "--set", "", cwd=self.folder,
                                 PROGRAM_STATUS="2")
        self.assertEqual(done.stdout, f"[run][a b.yaml][--set][]{self.folder}\n")
        self.assertEqual(done.returncode, 2)
        self.assertEqual((self.calls(), done.stderr), ([], ""))

    def test_help_is_the_programs(self):
        """... and says that the launcher has two words more."""
        for word in ("--help", "-h", "help"):
            said = self.run_launcher(word).stdout
            self.assertIn("[--help]", said)
            self.assertRegex(said, "amontons demo.*amontons test")
        self.assertEqual(self.run_launcher("help", "run").stdout, f"[help][run]{self.root}\n")

    def test_from_anywhere(self):
        link = self.folder / "am"
        link.symlink_to(self.root / "amontons")
        self.assertIn("[info]", self.run_launcher("info", cwd="/", script=link).stdout)
        self.assertEqual(self.calls(), [])
        for called in (["./amontons"], ["../a project/amontons"], ["bash", "amontons"]):
            with self.subTest(called):
                done = self.run_launcher(*called[1:], "info", script=called[0])
                self.assertIn("[info]", done.stdout)
                self.assertEqual(self.calls(), [])
        self.path = f"{self.root}:{self.path}"
        done = self.run_launcher("-c", "amontons info", script="/bin/bash", cwd="/")
        self.assertIn("[info]", done.stdout)
        self.assertEqual(self.calls(), [])

    def test_starts_one_other_program(self):
        """`find`, once, to see whether a source is newer: a few milliseconds, counted by starts."""
        program = self.root / "build/bin/amontons"
        program.unlink()
        shutil.copy("/bin/true", program)
        self.calls_file.write_text("")
        alone = self.folder / "alone"     # all that PATH has
        alone.mkdir()
        (alone / "find").write_text('#!/bin/bash\necho find >>"$CALLS"\nexec /usr/bin/find "$@"\n')
        (alone / "find").chmod(0o755)
        done = subprocess.run([self.root / "amontons", "run"], capture_output=True, text=True,
                              env={"PATH": str(alone), "CALLS": str(self.calls_file)})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.calls(), ["find"])

    def test_builds_again_after_a_change(self):
        """An edited, a new and a deleted source, and edited build files: never a stale program."""
        source = self.root / "src/run"
        changes = {
            "edited": lambda: (source / "a.c").write_text("int b;\n"),
            "new": lambda: (source / "b.c").touch(),
            "deleted": lambda: (source / "b.c").unlink(),
            "picture": lambda: (self.root / "render/canvas/canvas.c").touch(),
            "CMakeLists.txt": lambda: (self.root / "CMakeLists.txt").touch(),
            "program": lambda: (self.root / "build/bin/amontons").unlink()}
        for name, change in changes.items():
            with self.subTest(name):
                self.run_launcher("info")
                self.assertEqual(self.calls(), [])
                change()
                done = self.run_launcher("info")
                self.assertEqual(self.calls("cmake"),
                                 [f"cmake --build {self.root}/build --target amontons"])
                self.assertRegex(done.stderr, r"^amontons: building.*\n$")

    def test_change_while_building(self):
        """... is in no program yet, so the next call builds once more."""
        source = self.root / "src/run/a.c"
        source.touch()
        self.run_launcher("info", BUILD_EDITS=str(source))
        self.assertEqual(len(self.calls("cmake --build")), 1)
        self.run_launcher("info")
        self.assertEqual(len(self.calls("cmake --build")), 1)
        self.run_launcher("info")
        self.assertEqual(self.calls(), [])

    def test_changed_source_that_does_not_build(self):
        (self.root / "src/run/a.c").touch()
        for _ in range(2):
            done = self.run_launcher("info", BUILD_SAYS="a.c:1:1: error: no such thing")
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn("no such thing", done.stderr)

    def test_changed_presets(self):
        """Their flags reach the program only where it is configured again."""
        (self.root / "CMakePresets.json").touch()
        self.run_launcher("info")
        self.assertEqual(len(self.calls("cmake --preset")), 1)
        self.run_launcher("demo")
        self.assertEqual(self.calls("cmake --preset"), [])

    def test_without_build_tools(self):
        """A program that is up to date needs none of them."""
        self.without("cmake", "apt-get", "dpkg-query")
        self.assertIn("[info]", self.run_launcher("info").stdout)
        (self.root / "src/run/a.c").touch()
        done = self.run_launcher("info")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("cmake", done.stderr)


class FirstTime(Project):
    def test_help_builds_nothing(self):
        for arguments in ([], ["--help"], ["-h"], ["help"]):
            done = self.run_launcher(*arguments)
            self.assertEqual((done.returncode, self.calls()), (0, []))
            for word in ("demo", "test", "run SCENE"):
                self.assertIn(word, done.stdout)

    def test_demo_when_all_is_installed(self):
        done = self.run_launcher("demo", "--quiet", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"[run][{self.root}/validation/paper/fig1.yaml][-o]"
                      f"[{self.root}/results/fig1][--overwrite][--set][mesh.set.nz=40][--quiet]", done.stdout)
        self.assertIn(f"[report][{self.root}/results/fig1]", done.stdout.splitlines()[-1])
        self.assertEqual(self.calls("apt-get") + self.calls("sudo"), [])
        self.assertEqual(self.calls("cmake"), [
            f"cmake --preset release -S {self.root} -DBUILD_TESTING=OFF",
            f"cmake --build {self.root}/build --target amontons"])
        done = self.run_launcher("demo", script="./amontons")
        self.assertIn("[run][validation/paper/fig1.yaml][-o][results/fig1]", done.stdout)
        self.assertEqual(self.calls(), ["cmake --build ./build --target amontons"])
        self.assertEqual(done.stderr, "")
        self.assertNotIn("[report]", self.run_launcher("demo", "-o", "elsewhere").stdout)
        self.assertIn("[report]", self.run_launcher("demo", "--overwrite").stdout)
        self.assertNotIn("[report]", self.run_launcher("demo", PROGRAM_STATUS="1").stdout)

    def test_other_words_build_first(self):
        done = self.run_launcher("run", "scene.yaml")
        self.assertIn("[run][scene.yaml]", done.stdout)
        self.assertEqual(len(self.calls("cmake")), 2)

    def test_test(self):
        done = self.run_launcher("test", "-R", "base", cwd="/", CTEST_STATUS="8")
        self.assertEqual(done.returncode, 8)
        self.assertEqual(self.calls("ctest"), ["ctest --preset release -j 3 -R base"])
        self.assertEqual(done.stdout,
                         f"in {self.root}: 100% tests passed, 0 tests failed out of 7\n")
        asked = self.calls("dpkg-query")
        self.assertEqual(len(asked), 1)
        wanted = " ".join(packages("build") + packages("test") + packages("docs")).replace("?", "")
        self.assertTrue(asked[0].endswith(wanted))

    def test_test_after_demo_adds_the_tests(self):
        self.run_launcher("demo")
        self.run_launcher("test")
        self.assertIn("-DBUILD_TESTING=ON", " ".join(self.calls("cmake --preset")))
        self.run_launcher("demo")
        self.assertEqual(self.calls("cmake --preset"), [], "demo must not take the tests away")

    def test_moved_folder_is_configured_afresh(self):
        self.run_launcher("demo")
        moved = self.folder / "moved"
        (self.root / "build/CMakeFiles").mkdir()
        self.root.rename(moved)
        self.root = moved
        self.run_launcher("demo")
        self.assertEqual(len(self.calls("cmake --preset")), 1)
        self.assertFalse((self.root / "build/CMakeFiles").exists())

    def test_two_at_once_build_in_turn(self):
        environment = {"PATH": self.path, "CALLS": str(self.calls_file)}
        both = [subprocess.Popen([self.root / "amontons", "demo"], env=environment,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                for _ in range(2)]
        self.assertEqual([one.wait(60) for one in both], [0, 0])
        self.assertEqual(len(self.calls("cmake --preset")), 1)

    def test_failing_build(self):
        done = self.run_launcher("demo", BUILD_SAYS="x.c:3:1: error: no such thing")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("x.c:3:1: error: no such thing", done.stderr)
        self.assertIn("build/build.log", done.stderr)
        self.run_launcher("demo")
        self.assertEqual(len(self.calls("dpkg-query")), 1, "packages are asked for again")

    def test_read_only_folder(self):
        self.root.chmod(0o555)
        done = self.run_as_user("demo")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("cannot write into"), 1, done.stderr)
        self.root.chmod(0o777)
        self.run_launcher("demo")
        (self.root / "src/run/a.c").touch()
        (self.root / "build").chmod(0o555)
        done = self.run_as_user("demo")
        (self.root / "build").chmod(0o777)   # or an ordinary user cannot remove it
        self.assertEqual((done.returncode, done.stderr),
                         (1, f"amontons: cannot write into {self.root}/build\n"))


class Installing(Project):
    MISSING = "cmake libvtk9-dev"

    def test_root(self):
        done = self.run_as_root("demo", MISSING=self.MISSING)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.calls("apt-get"), [
            "apt-get -q update",
            "apt-get -q install -y --no-install-recommends -o DPkg::Lock::Timeout=300 "
            + self.MISSING])
        self.assertEqual(set(self.calls("env")), {"env noninteractive C"})
        self.assertIn("2 packages", done.stderr)
        self.run_as_root("demo", MISSING=self.MISSING)
        self.assertEqual(self.calls("apt-get") + self.calls("dpkg-query"), [], "the stamp stands")

    def test_what_not_every_system_offers(self):
        """A name marked with ? is installed where apt offers it, and missed nowhere else."""
        self.assertIn("libosmesa6?", packages("build"))
        for offered, expected in {"libosmesa6": ["cmake libosmesa6"], "": ["cmake"]}.items():
            with self.subTest(offered=offered):
                (self.root / "build/packages-build.stamp").unlink(missing_ok=True)
                done = self.run_as_root("demo", MISSING="cmake libosmesa6", OFFERED=offered)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual([c.split("=300 ")[1] for c in self.calls("apt-get -q install")], expected)
        shutil.rmtree(self.root / "build", ignore_errors=True)   # none where it could not be run as root
        self.without("sudo")
        done = self.run_as_user("demo", MISSING="libosmesa6")
        self.assertEqual((done.returncode, self.calls("apt-get")), (0, []), done.stderr)

    def test_user_with_sudo(self):
        done = self.run_as_user("demo", MISSING=self.MISSING)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(self.calls("sudo env")), 2)
        self.assertTrue(self.calls("apt-get")[1].endswith(self.MISSING))

    def test_user_without_sudo(self):
        self.without("sudo")
        done = self.run_as_user("demo", MISSING=self.MISSING)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"apt-get install --no-install-recommends {self.MISSING}\n", done.stderr)
        self.assertEqual(self.calls("apt-get"), [])

    def test_user_whom_sudo_refuses(self):
        done = self.run_as_user("demo", MISSING=self.MISSING, SUDO_SAYS="a password is required")
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"as root: apt-get install --no-install-recommends {self.MISSING}",
                      done.stderr)

    def test_failures_are_explained(self):
        for says, expected in {
            "E: Could not get lock /var/lib/dpkg/lock-frontend": "let it finish",
            "W: Temporary failure resolving 'deb.debian.org'": "is there a network",
            "E: You don't have enough free space in /var/cache": "disk is full",
            "E: Unable to locate package libfyaml-dev": "does not offer libfyaml-dev: Debian 12",
            "E: Package 'libvtk9-dev' has no installation candidate": "does not offer libvtk9-dev: ",
            "E: dpkg was interrupted, you must run dpkg --configure -a": "dpkg --configure -a",
        }.items():
            with self.subTest(says):
                done = self.run_as_user("demo", MISSING=self.MISSING, APT_SAYS=says)
                self.assertEqual((done.returncode, done.stdout), (1, ""))
                self.assertIn(expected, done.stderr)
                self.assertIn(self.MISSING, done.stderr)
                self.assertIn("build/install.log", done.stderr)
                self.assertEqual(self.calls("cmake"), [])

    def test_not_debian(self):
        """Without apt-get the launcher says what is needed and tries with what there is."""
        self.without("apt-get", "dpkg-query")
        done = self.run_launcher("demo")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(" ".join(packages("build")).replace("?", ""), done.stderr)


class Packages(unittest.TestCase):
    @unittest.skipUnless(shutil.which("dpkg-query"), "not Debian")
    def test_lists_name_real_packages(self):
        """Whoever runs these tests through ./amontons test has them all, by their listed names."""
        wanted = [name for name in packages("build") + packages("test") if not name.endswith("?")]
        said = subprocess.run(
            ["dpkg-query", "-W", "-f=${db:Status-Status} ${Package}\n", *wanted],
            capture_output=True, text=True).stdout
        installed = {line.split()[1] for line in said.splitlines() if line.startswith("installed")}
        self.assertEqual(set(wanted) - installed, set())

    @unittest.skipUnless(shutil.which("shellcheck"), "no shellcheck here")
    def test_shellcheck(self):
        done = subprocess.run(["shellcheck", "-s", "bash", SOURCE / "amontons", SOURCE / ".ci/run",
                               *(SOURCE / "packaging").glob("*sh")],
                              capture_output=True, text=True)
        self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    unittest.main()
