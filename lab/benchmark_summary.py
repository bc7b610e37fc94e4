# SPDX-License-Identifier: BSD-3-Clause
"""The short page of the benchmark: best peer against ours, levels of detail, cost against teeth."""
import os
import shutil

HEAD = """# Run time against error

Written by `lab/run benchmark`; do not edit. Time that the twin's solvers and other programs need to reach a
given error with the same equations of motion: the dynamic ring of [model.md](model.md) (804 states: every tooth's
mass, wave generator, circular spline), the operating model, and the levels of detail to choose from.

```sh
lab/run benchmark                    # ten minutes: installs the peers, measures; the complete page in out/benchmark
lab/run benchmark --reuse            # writes the pages again from what was measured
```

The complete page has a figure, the quickest solver for each error and every run of each problem, and what was given up.

**Error**: root mean square over the samples, over the standard deviation of the reference, of all angles, tooth
positions or tooth forces. **Time**: of the processor, of one thread, median of the runs; the solvers take turns. Peers:
SUNDIALS (CVODE, IDA, ARKODE), RADAU5, Boost.odeint. They get the analytic sparse Jacobian with SuiteSparse's KLU
and call the twin's own forces. Ours are `joint_twin dynamics --tolerance`: TR-BDF2 and ESDIRK4 with adaptive
steps.
"""
READING = """Above 1 ours are faster. *ours only*, *peer only*: the other does not reach that error. A dash:
nobody reaches that error, or the references differ by more. An error of the tooth forces below
1e-3 needs steps that resolve the vibration of single teeth, a fraction of a microsecond long; in those rows the peer is
Runge-Kutta 4 with steps of equal length.

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
