# SPDX-License-Identifier: BSD-3-Clause
"""Sets up matplotlib without a screen, a style, and Okabe and Ito's colours, which differ for every eye and in grey."""
import os

# No matplotlibrc has an effect, neither one in the current folder nor the user's.
FOLDER = os.getcwd()
os.chdir(os.path.dirname(os.path.abspath(__file__)))
try:
    import matplotlib
finally:
    os.chdir(FOLDER)
matplotlib.rcdefaults()
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402, F401  (the backend is chosen before pyplot is loaded)

BLUE, ORANGE, GREEN, RED, PURPLE, GREY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#666666"
STYLE = {"font.size": 9, "axes.titlesize": 9.5, "axes.titleweight": "bold", "axes.titlelocation": "left",
         "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.25,
         "lines.linewidth": 1.3, "legend.frameon": False, "legend.fontsize": 8, "figure.dpi": 110}
