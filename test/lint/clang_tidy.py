# SPDX-License-Identifier: BSD-3-Clause
"""Names and likely faults by clang-tidy (.clang-tidy) in the sources of src/, test/ and bench/ that the build compiles:
those whose code changed in the working tree or within four hours before its commit, and a twelfth of all, which the
number of commits chooses. That twelfth is read as the build compiles it, several sources at once: a third of the time;
so are three and more that changed of those compiled at once.
--all, or sources without git: every one, by itself.

usage: clang_tidy.py [--all] BUILD_FOLDER

A file without findings is remembered in ${XDG_CACHE_HOME:-~/.cache}/harmonic_joint_twin/clang_tidy and checked again
only after a change of the file, of a header that it includes, of the compiler's options, of .clang-tidy or of the tool.
"""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import zlib

import project

FOLDERS = ("src", "test", "bench")
# The first that is installed. From 22 on, declarations of system headers are skipped: half the time.
TOOLS = ("clang-tidy-22", "clang-tidy")
VERSIONS = (14, 22)  # that the sources are written for: the checks of others differ
PARTS = 12  # of all that the build compiles, one of which a commit has checked
TOGETHER = 3  # changed sources of one compiled file, from which on it is read as a whole
CHANGED_BEFORE = 14400  # changed files: by how much their commit may be older than the last [s]
KEPT_DAYS = 60  # what no run has asked for since then is removed


def text_hash(data):
    return hashlib.sha256(data).hexdigest()


@functools.lru_cache(maxsize=None)
def file_hash(path):
    with open(path, "rb") as file:
        return text_hash(file.read())


@functools.lru_cache(maxsize=None)
def changed(path):
    return os.path.getmtime(path)


def output(command, folder=None):
    return subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False).stdout


def cache_folder():
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    folder = os.path.join(home, "harmonic_joint_twin", "clang_tidy")
    os.makedirs(folder, exist_ok=True)
    for entry in os.scandir(folder):
        if entry.stat().st_mtime < time.time() - KEPT_DAYS * 86400:
            os.remove(entry.path)
    return folder


def turn(root):
    """What changed, and whether it is a file's turn by the commit of the tree. None: all files' turn."""
    def git(*arguments):
        return output(["git", "-C", root, "-c", f"safe.directory={root}", *arguments]).decode(errors="replace").strip()

    def code(revision, name):
        return re.sub(r"\s*//.*", "", git("show", f"{revision}:{name}"))

    commits, last = git("rev-list", "--count", "HEAD"), git("log", "-1", "--format=%ct")
    if not commits or not last or git("rev-parse", "--show-toplevel") != os.path.realpath(root):
        return None
    since = int(last) - CHANGED_BEFORE
    before = git("rev-list", "-1", "--first-parent", f"--before={since}", "HEAD")
    fresh = git("log", "--first-parent", "-m", f"--since={since}", "--name-only", "--format=").splitlines()
    fresh = {name for name in set(fresh) if not before or code(before, name) != code("HEAD", name)}
    fresh |= set(git("diff", "HEAD", "--name-only").splitlines())
    fresh |= set(git("ls-files", "--others", "--exclude-standard").splitlines())
    return fresh, lambda path: zlib.crc32(path.encode()) % PARTS == int(commits) % PARTS


def members(entry):
    """The sources that a file of CMake's unity build includes; the file itself if it is none."""
    path = os.path.normpath(os.path.join(entry["directory"], entry["file"]))
    if os.path.basename(os.path.dirname(path)) != "Unity":
        return [path]
    with open(path, encoding="utf-8") as file:
        names = re.findall(r'^#include "(.*)"$', file.read(), flags=re.MULTILINE)
    return [os.path.normpath(name) for name in names]


def command(entry, path):
    """That which compiles `path` as `entry` compiles its file, without the precompiled header: a source must include
    what it uses."""
    compiled = os.path.normpath(os.path.join(entry["directory"], entry["file"]))
    arguments = entry.get("arguments") or shlex.split(entry["command"])
    arguments = [path if os.path.normpath(word) == compiled else word for word in arguments]
    # The rule of a unity file names the headers of the other sources as well.
    rules = [f"{arguments[arguments.index('-o') + 1]}.d"] if "-o" in arguments and path == compiled else []
    for index in reversed([i for i, word in enumerate(arguments) if word.endswith("cmake_pch.hxx")]):
        rules += [f"{arguments[index]}.gch.d"] if rules else []
        del arguments[index - 1:index + 1]
    arguments = [word for word in arguments if word != "-Winvalid-pch"]
    return {"directory": entry["directory"], "file": path, "arguments": arguments, "rules": rules}


def commands(build, root):
    """Compile commands of all sources, one each; of all files that the build compiles, with the sources, by their
    first."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        entries = json.load(file)
    of_sources, of_files = {}, {}
    for entry in entries:
        sources = [path for path in members(entry) if os.path.relpath(path, root).split(os.sep)[0] in FOLDERS]
        for path in sources:
            of_sources[path] = command(entry, path)
        if sources:
            compiled = os.path.normpath(os.path.join(entry["directory"], entry["file"]))
            of_files[sources[0]] = command(entry, compiled), sources
    return of_sources, of_files


def chosen(build, root, whole):
    """Compile commands by what is said of each, and how many sources are left to other commits."""
    def named(path):
        return os.path.relpath(path, root)

    of_sources, of_files = commands(build, root)
    by_commit = None if whole else turn(root)
    if not by_commit:
        return {named(path): of_sources[path] for path in sorted(of_sources)}, 0
    names, is_turn = by_commit
    fresh = {path for path in of_sources if named(path) in names}
    found, left = {}, set(of_sources)
    for first, (entry, sources) in sorted(of_files.items()):
        if is_turn(named(first)) or len(fresh.intersection(sources)) >= TOGETHER:
            found[named(first) + (" and what is compiled with it" if sources[1:] else "")] = entry
            fresh.difference_update(sources)
            left.difference_update(sources)
    found.update((named(path), of_sources[path]) for path in sorted(fresh))
    return found, len(left - fresh)


def files_of_rule(rule, entry):
    """What a rule of make depends on."""
    return [os.path.join(entry["directory"], path) for path in re.sub(r"\\\n", " ", rule.decode()).split()[1:]]


def files_of_build(entry):
    """By the rules that the build has left, sooner read than made; none if one is missing, or a file is newer."""
    try:
        rules = [os.path.join(entry["directory"], rule) for rule in entry["rules"]]
        files = [path for rule in rules for path in files_of_rule(pathlib.Path(rule).read_bytes(), entry)]
        return files if max(map(changed, files)) <= changed(rules[0]) else []
    except (IndexError, OSError, ValueError):
        return []


def key(entry, common, root):
    """Of what a verdict depends on: the tool and its configuration, the options, all files read. None if it does not
    compile."""
    arguments = [word for word in entry["arguments"] if word != "-c"]
    if "-o" in arguments:
        place = arguments.index("-o")
        del arguments[place:place + 2]
    options = [word.replace(root, "") for word in arguments]
    files = files_of_build(entry) or files_of_rule(output(arguments + ["-M"], entry["directory"]), entry)
    return text_hash("\n".join([common, *options, *map(file_hash, files)]).encode()) if files else None


def check(build, root=project.ROOT, whole=False):
    tool = next(filter(shutil.which, TOOLS))
    version = output([tool, "--version"])
    if int(re.search(rb"version (\d+)", version).group(1)) not in VERSIONS:
        wanted = " or ".join(map(str, VERSIONS))
        project.skip(f"needs clang-tidy {wanted}, here is {' '.join(version.decode().split())}")
    file_hash.cache_clear()
    changed.cache_clear()
    entries, left = chosen(build, root, whole)
    common = text_hash(version) + file_hash(os.path.join(root, ".clang-tidy"))
    cache = cache_folder()

    def findings(entry):
        """None if the file is known to be clean, else what clang-tidy reports; empty if there is nothing."""
        name, path = key(entry, common, root), entry["file"]
        mark = os.path.join(cache, name) if name else None
        if mark and os.path.exists(mark):
            os.utime(mark)
            return None
        result = subprocess.run([tool, "--quiet", "-p", database, path], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                universal_newlines=True, check=False)
        if result.returncode:
            return (result.stdout.strip() or result.stderr.strip()) or f"{path}: {tool} failed"
        if mark:
            with open(mark, "w", encoding="utf-8"):
                pass
        return ""

    problems = [] if entries or left else ["src: no compiled sources found"]
    with tempfile.TemporaryDirectory() as database, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        with open(os.path.join(database, "compile_commands.json"), "w", encoding="utf-8") as file:
            # clang-tidy takes no other keys than its own.
            json.dump([{key: entry[key] for key in ("directory", "file", "arguments")} for entry in entries.values()],
                      file)
        for said, found in zip(entries, pool.map(findings, entries.values())):
            state = "known to be clean" if found is None else "FAULTS" if found else "clean"
            print(f"{said}: {state}", flush=True)
            if found:
                problems.append(found)
    if left:
        print("Unchanged files are left to other commits")
    return problems


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[1:-1] not in ([], ["--all"]):
        sys.exit(__doc__)
    os.nice(10)  # other tests run beside it
    project.run(lambda root: check(sys.argv[-1], root, len(sys.argv) == 3))
