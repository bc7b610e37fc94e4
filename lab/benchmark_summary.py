# SPDX-License-Identifier: BSD-3-Clause
"""The short page of the benchmark: best peer against ours, levels of detail, cost against teeth."""
import os
import shutil

HEAD = """# Run time against error

`lab/run benchmark` writes this page; do not edit it. The page compares how long the twin's solvers and other programs
take to reach a given error. All solve the same equations of motion. The problems are the dynamic ring of
[model.md](model.md) (804 states: every tooth's mass, wave generator, circular spline), the operating model, and the
levels of detail that a user can choose from.

```sh
lab/run benchmark                    # ten minutes: installs the peers, measures; the complete page in out/benchmark
lab/run benchmark --reuse            # writes the pages again from what was measured
```

The complete page has a figure for each problem, the quickest solver for each error, every run, and the runs that were
given up.

The **error** of a run is the root mean square of its differences from the reference over all samples. It is divided by
the standard deviation of the reference. Angles, tooth positions and tooth forces have an error each. The **time** is
processor time of one thread, the median of the runs; the solvers take turns. The **peers** are SUNDIALS (CVODE, IDA,
ARKODE), RADAU5 and Boost.odeint. They get the analytic sparse Jacobian with SuiteSparse's KLU and call the twin's own
forces. **Our solvers** are TR-BDF2 and ESDIRK4 with adaptive steps (`joint_twin dynamics --tolerance`).
"""
READING = """Above 1 our solver is faster. *ours only* and *peer only* say that the other side does not reach that
error. A dash says that no solver reaches that error, or that the two references differ by more than the error. For
tooth forces an error below 1e-3 needs steps of a fraction of a microsecond, which resolve the vibration of single
teeth. The best peer for such errors is Runge-Kutta 4 with steps of equal length.

![Working drive under a load step: time against error of all solvers](images/benchmark/drive.png)
"""


def write(docs, complete, table, levels, parts, machine):
    """docs/benchmark.md. `table`, `levels`, `parts`: lines of the complete page, in the folder `complete`; of
    the parts without their table."""
    images = os.path.join("images", "benchmark")
    os.makedirs(os.path.join(docs, images), exist_ok=True)
    for name in ("drive", "levels"):
        source, shown = (os.path.join(folder, images, name + ".png") for folder in (complete, docs))
        if os.path.abspath(source) != os.path.abspath(shown):
            shutil.copyfile(source, shown)
    lines = [HEAD, "## Best peer against ours", "", *table, READING, *levels, *parts[:4], "---", "", machine]
    with open(os.path.join(docs, "benchmark.md"), "w", encoding="utf-8") as out:
        out.write("\n".join(lines).rstrip() + "\n")
