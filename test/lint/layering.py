# SPDX-License-Identifier: BSD-3-Clause
"""Data flows one way: a folder includes itself and the folders it may see, ROS stays in ros_io and the applications,
and few files open others for writing.

Debian keeps ROS' headers in /usr/include, where no include path can keep them from the core.
"""
import re

import project

# Each folder of src/ and the folders that it sees directly; it sees theirs too. docs/architecture.md draws this table.
SEES = {
    "base": [],
    "params": ["base"],
    "gear": ["params"],
    "elements": ["gear"],
    "model": ["elements"],
    "solver": ["model"],
    "statics": ["solver"],
    "surface": ["statics"],
    "sensors": ["gear"],
    "health": ["gear"],
    "twin": ["surface", "sensors", "health"],
    "tracking": ["twin"],
    "arm": ["tracking"],
    "identification": ["arm"],
    "life": ["twin"],
    "studies": ["twin", "life"],
    "python": ["tracking"],
    "live": ["twin"],
    "fmu": ["arm"],
    "output": ["twin"],
    "messages": ["tracking", "life"],
    "bags": ["messages"],
    "datasets": ["arm", "bags", "output"],
    "recordings": ["datasets", "identification"],
    "python/recordings": ["python", "recordings"],
    "ros_control": ["arm"],
    "ros_io": ["live", "messages", "arm"],
    "apps/common": ["recordings"],
    "apps/tool": ["apps/common", "studies", "fmu"],
    "apps": ["apps/tool", "ros_io"],
    "bench": ["apps/common", "studies"],
    "test/core": ["arm", "identification", "studies"],
    "test/ros": ["ros_io", "recordings", "ros_control"],
    "test/outside": ["twin"],
    "test/support": [],
    "test/support/ros_control": [],
}
WITH_ROS = {"messages", "bags", "datasets", "recordings", "output", "python/recordings", "ros_control", "ros_io",
            "apps", "apps/common", "apps/tool", "test/ros", "test/support/ros_control"}
# The core may use the standard library, POSIX and these; everything else is taken for ROS or an application's library.
LIBRARIES = re.compile(r"<([a-z_0-9]+|(dlfcn|fcntl|malloc|sys/file|sys/mman|sys/stat|time|unistd)\.h|"
                       r"(Eigen|boost|unsupported/Eigen|yaml-cpp)/[\w/.-]+)>$")
# Libraries that one folder alone may use.
OWN_LIBRARIES = {
    "live": re.compile(r"<(pthread|pwd|sched|sys/prctl|sys/resource)\.h>$"),
    "arm": re.compile(r"<(console_bridge|kdl|kdl_parser|urdf)/[\w/.-]+>$"),
    "python": re.compile(r"<pybind11/\w+\.h>$"),
    "bench": re.compile(r"<(arkode|benchmark|cvode|ida|nlohmann|nvector|sundials|sunlinsol|sunmatrix|sunnonlinsol)/"
                        r"[\w/.-]+>$|<klu\.h>$"),
    "test/core": re.compile(r"<(g(mock|test)|kdl|kdl_parser)/[\w/.-]+>$"),
    "test/support": re.compile(r"<g(mock|test)/[\w/.-]+>$"),
}
INCLUDE = re.compile(r'\s*#\s*include\s*(<[^>]+>|"[^"]+")')
PUBLIC_HEADER = re.compile(r'"harmonic_joint_twin/([\w/]+)/\w+\.hpp"$')
OWN_HEADER = re.compile(r'"([\w/]+)/\w+\.hpp"$')
MESSAGE_HEADER = re.compile(r'[<"]harmonic_joint_twin/[A-Z]\w*\.h[>"]$')
# What opens files for writing: new ones beside the old under a name that nobody can guess, and never through a link.
# All else takes one of these.
WRITERS = {"base/whole_file.cpp", "bags/bag_writer.cpp", "bags/bag_writer.hpp", "datasets/file_seal.cpp",
           "datasets/hdf5_files.cpp", "datasets/sweep_directory.cpp", "output/output_file.cpp"}
OPENING = re.compile(r"\bo?fstream\s+\w|\bf(re)?open\(|\bO_(WRONLY|RDWR|CREAT)\b|\b(H5Fcreate|creat|mkstemp)\(|"
                     r"bagmode::(Write|Append)")
TEST_HEADERS = ("test/", "bench/")  # helpers of the tests, which benchmarks use too


def visible(folder):
    seen = {folder}
    for other in SEES[folder]:
        seen |= visible(other)
    return seen


def folder_of(path):
    """The longest known folder that `path`, relative to src/, to the public headers or to the root, lies in."""
    parts = path.split("/")[:-1]
    while parts and "/".join(parts) not in SEES:
        parts.pop()
    return "/".join(parts)


def fault(folder, header, public):
    """Why `folder` must not include `header`; None if it may. `public`: the including file is a public header."""
    published = PUBLIC_HEADER.match(header)
    own = published or OWN_HEADER.match(header)
    if own and not header.startswith(tuple(f'"{name}' for name in TEST_HEADERS)):
        if public and not published:
            return f"{header} is no public header: include/ must stand without src/"
        target = folder_of(own.group(1) + "/")
        if not target:
            return f"{header} lies in no known folder"
        if target not in visible(folder):
            return f"{folder} must not include {header}: it does not see {target}"
        return None
    if header.startswith('"') and not MESSAGE_HEADER.match(header):
        if folder.startswith(("test/", "bench")):
            return None
        return f"{header}: own headers are included as \"FOLDER/NAME.hpp\" or \"harmonic_joint_twin/FOLDER/NAME.hpp\""
    allowed = OWN_LIBRARIES.get(folder)
    if folder not in WITH_ROS and not LIBRARIES.match(header) and not (allowed and allowed.match(header)):
        return f"{folder} must not include {header}: only {LIBRARIES.pattern}"
    return None


def check(root):
    problems = []
    suffixes = [".hpp", ".h", ".cpp"]
    places = {"include": "include/harmonic_joint_twin/", "src": "src/", "test": "", "bench": ""}
    sources = [(path, path[len(prefix):]) for top, prefix in places.items()
               for path in project.files(root, top, suffixes)]
    for path, relative in sources:
        folder = folder_of(relative)
        if not folder:
            problems.append(f"{path}:1: not in one of the folders {', '.join(SEES)}")
            continue
        for number, line in project.lines(root, path):
            include = INCLUDE.match(line)
            reason = fault(folder, include.group(1), path.startswith("include/")) if include else None
            if reason:
                problems.append(f"{path}:{number}: {reason}")
            if path.startswith(("src/", "include/")) and relative not in WRITERS and OPENING.search(line):
                problems.append(f"{path}:{number}: opens a file for writing, which {', '.join(sorted(WRITERS))} do")
    return problems if sources else ["include, src: no sources found"]


if __name__ == "__main__":
    project.run(check)
