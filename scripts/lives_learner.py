#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A learner of remaining life on a data set of `joint_twin lives`: its score, beside what hours alone say, and a figure.

  lives_learner.py DIR --out figure.png

Prints mean absolute errors at the check-ups of the test drives that came to their end.
"""
import argparse

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy  # noqa: E402
import pandas  # noqa: E402
from sklearn.ensemble import RandomForestRegressor  # noqa: E402

KEY = ["life.drive", "life.hours"]
IN_USE = "still in use"


def read(directory):
    """(indicators, truth) by drive and hours of use: the means over the windows of each recording."""
    index = pandas.read_csv(directory + "/index.csv")
    index = index[index.status == "ok"]
    rows = []
    for run in index.to_dict("records"):
        with h5py.File(directory + "/" + run["file"]) as file:
            windows = {run["duty"] + "." + name: column[:] for name, column in file["indicators"].items()
                       if not name.startswith("window_")}
        means = {name: numpy.nanmean(values) for name, values in windows.items() if numpy.isfinite(values).any()}
        rows.append({**{key: run[key] for key in KEY}, **means})
    indicators = pandas.DataFrame(rows).groupby(KEY).first()
    return indicators.dropna(axis="columns"), index.groupby(KEY).first()


def forecast(features, truth):
    """Median and the 10 and 90 % quantiles of the trees' leaves [h], trained on the training drives."""
    training = (truth["life.split"] == "train").to_numpy()
    forest = RandomForestRegressor(500, min_samples_leaf=5, max_features=0.3, random_state=1)
    known = truth["life.remaining"].to_numpy()[training]
    forest.fit(features[training], known)
    of_training, of_all = forest.apply(features[training]), forest.apply(features)
    quantiles = []
    for leaves in of_all:
        weight = (of_training == leaves).mean(axis=1)
        order = numpy.argsort(known)
        reached = numpy.cumsum(weight[order]) / weight.sum()
        quantiles.append([known[order][min(numpy.searchsorted(reached, share), len(known) - 1)]
                          for share in (0.1, 0.5, 0.9)])
    return numpy.array(quantiles)


def draw(truth, quantiles, path):
    drives = [drive for drive, life in truth.groupby(level=0) if len(life) > 5][:6]
    figure, grid = plt.subplots(2, 3, figsize=(10.0, 5.2), constrained_layout=True)
    for axes, drive in zip(grid.flat, drives):
        of_drive = truth.index.get_level_values(0) == drive
        hours = truth.index.get_level_values(1)[of_drive] / 1000.0
        axes.fill_between(hours, *(quantiles[of_drive][:, [0, 2]].T / 1000.0), color="tab:blue", alpha=0.25,
                          label="80 % interval")
        axes.plot(hours, quantiles[of_drive][:, 1] / 1000.0, color="tab:blue", label="forecast")
        axes.plot(hours, truth["life.remaining"][of_drive] / 1000.0, color="black", label="true")
        axes.set_title(f"drive {drive}: {truth['life.cause'][of_drive].iloc[0]}", fontsize="medium")
        axes.grid(linewidth=0.4)
    for axes in grid[-1]:
        axes.set_xlabel("hours of use [1000 h]")
    for axes in grid[:, 0]:
        axes.set_ylabel("remaining [1000 h]")
    grid[0, 0].legend(fontsize="small")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    indicators, truth = read(arguments.directory)
    use = pandas.DataFrame({"hours": truth.index.get_level_values(1),
                            "duty": pandas.factorize(truth["life.duty"])[0]}, index=truth.index)
    judged = ((truth["life.split"] == "test") & (truth["life.cause"] != IN_USE)).to_numpy()
    known = truth["life.remaining"].to_numpy()
    drives = truth[judged].index.get_level_values(0).nunique()
    print(f"{len(truth)} check-ups; judged: {judged.sum()} of {drives} drives")
    late = judged & (truth.index.get_level_values(1) > 0.5 * truth["life.length"]).to_numpy()
    for name, features in [("hours and duty", use), ("hours, duty and indicators", use.join(indicators))]:
        quantiles = forecast(features, truth)
        held = (known >= quantiles[:, 0]) & (known <= quantiles[:, 2])
        print(f"{name}: mean absolute error {numpy.abs(quantiles[:, 1] - known)[judged].mean():.0f} h, "
              f"in the second half of each life {numpy.abs(quantiles[:, 1] - known)[late].mean():.0f} h; "
              f"80 % interval held {100.0 * held[judged].mean():.0f} %")
    test = (truth["life.split"] == "test").to_numpy()
    draw(truth[test], quantiles[test], arguments.out)


if __name__ == "__main__":
    main()
