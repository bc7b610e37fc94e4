# SPDX-License-Identifier: BSD-3-Clause
"""A learner of remaining life on a data set of `joint_twin lives`: its score beside that of the prior, and a figure.

  joint_twin lives PLAN.yaml --out unused --list > prior.csv     (PLAN with many drives and one check-up each)
  lives_learner.py DIR --prior prior.csv --out figure.png

Prints scores at the check-ups of the test drives that came to their end.
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
        with h5py.File(directory + "/" + run["file"], "r") as file:
            windows = {run["duty"] + "." + name: column[:] for name, column in file["indicators"].items()
                       if not name.startswith("window_")}
        means = {name: numpy.nanmean(values) for name, values in windows.items() if numpy.isfinite(values).any()}
        rows.append({**{key: run[key] for key in KEY}, **means})
    indicators = pandas.DataFrame(rows).groupby(KEY).first()
    return indicators.dropna(axis="columns"), index.groupby(KEY).first()


def learn(features, truth):
    """Remaining lives of the training drives [h], and the weight of each in the forecast of each check-up."""
    training = (truth["life.split"] == "train").to_numpy()
    known = truth["life.remaining"].to_numpy()[training]
    forest = RandomForestRegressor(500, min_samples_leaf=5, max_features=0.3, random_state=1)
    forest.fit(features[training], known)
    of_training, of_all = forest.apply(features[training]), forest.apply(features)
    return known, numpy.array([(of_training == leaves).mean(axis=1) for leaves in of_all])


def prior(drives, truth):
    """The same of drives that are only known by the laws: of those of the same duty that last longer."""
    length = drives["life.length"].to_numpy()
    weights = [(drives["life.duty"] == duty).to_numpy() & (length > hours)
               for (_, hours), duty in truth["life.duty"].items()]
    return length, numpy.array(weights, dtype=float)


def quantiles_of(values, weights):
    """10, 50 and 90 % [h]."""
    order = numpy.argsort(values)
    reached = numpy.cumsum(weights[order]) / weights.sum()
    return values[order][numpy.searchsorted(reached, (0.1, 0.5, 0.9)).clip(max=len(values) - 1)]


def crps_of(values, weights, true):
    """Continuous ranked probability score [h]."""
    order = numpy.argsort(values)
    reached = numpy.cumsum(weights[order])[:-1] / weights.sum()
    ordered = values[order]
    spread = (numpy.diff(ordered) * reached * (1.0 - reached)).sum()
    return numpy.abs(values - true).dot(weights) / weights.sum() - spread


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
    parser.add_argument("--prior", required=True, help="index of drives by the laws alone")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    indicators, truth = read(arguments.directory)
    use = pandas.DataFrame({"hours": truth.index.get_level_values(1),
                            "duty": pandas.factorize(truth["life.duty"])[0]}, index=truth.index)
    judged = ((truth["life.split"] == "test") & (truth["life.cause"] != IN_USE)).to_numpy()
    hours = truth.index.get_level_values(1).to_numpy()
    known = truth["life.remaining"].to_numpy()
    print(f"{len(truth)} check-ups of {truth.index.get_level_values(0).nunique()} drives; judged: {judged.sum()} of "
          f"{truth[judged].index.get_level_values(0).nunique()} drives")
    drives = pandas.read_csv(arguments.prior).groupby("life.drive").first()
    lengths, weights = prior(drives, truth)
    print("| forecast | mean absolute error [h] | CRPS [h] | 80 % interval held |\n|---|---|---|---|")
    for name, values, weights in [("prior", None, weights), ("hours, duty", *learn(use, truth)),
                                  ("hours, duty, indicators", *learn(use.join(indicators), truth))]:
        of = [lengths - now if values is None else values for now in hours]
        quantiles = numpy.array([quantiles_of(*each) for each in zip(of, weights)])
        crps = numpy.array([crps_of(*each) for each in zip(of, weights, known)])
        held = (known >= quantiles[:, 0]) & (known <= quantiles[:, 2])
        print(f"| {name} | {numpy.abs(quantiles[:, 1] - known)[judged].mean():.0f} | {crps[judged].mean():.0f} | "
              f"{100.0 * held[judged].mean():.0f} % |")
    test = (truth["life.split"] == "test").to_numpy()
    draw(truth[test], quantiles[test], arguments.out)


if __name__ == "__main__":
    main()
